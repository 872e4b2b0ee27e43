"""Studies that compare several runs: certified errors, time against accuracy, stability maps, tuning, and checks of systems."""
