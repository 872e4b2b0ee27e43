"""Functions of time and of measures that users give to forces and motions, made from data."""
