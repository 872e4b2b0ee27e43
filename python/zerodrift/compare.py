"""Coordinates and velocities by name, and how far a solution is from a reference."""

from .studies.compare import difference, signals

__all__ = ["difference", "signals"]


def __dir__() -> list[str]:
    return __all__      # and not what is imported
