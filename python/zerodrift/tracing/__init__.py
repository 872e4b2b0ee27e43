"""Motions without forces: positions of a mechanism along its one freedom."""
