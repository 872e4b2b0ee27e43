"""Mechanisms from bodies and joints: what is drawn, and the systems that are made from it."""

from . import inertia
from .mechanism import Mechanism

__all__ = ["Mechanism", "inertia"]


def __dir__() -> list[str]:
    return __all__
