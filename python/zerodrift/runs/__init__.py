"""One run of a system: its arguments, the loop that drives the core, and the solution."""
