"""Samples of a run: their record in memory and in files, and the solution that has them."""
