"""Ensembles: many runs of a system, or of systems that a function makes, with varied parameters and initial states."""
