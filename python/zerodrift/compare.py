"""Coordinates and velocities by name, and how far a solution is from a reference."""

from .studies.compare import difference, signals

__all__ = ["difference", "signals"]
