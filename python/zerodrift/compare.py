"""Coordinates and velocities by name, and differences between a solution and a reference."""

from .studies.compare import difference, signals

__all__ = ["difference", "signals"]


def __dir__() -> list[str]:
    return __all__      # and not what is imported
