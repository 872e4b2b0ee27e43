"""Masses and moments of inertia of plain shapes, about the centre of mass: ``m.body("disc", *zd.inertia.disc(...))``."""

from __future__ import annotations

import math
from typing import NamedTuple

from ._private import checks
from .errors import WrongType, WrongValue

__all__ = ["Inertia", "box", "disc", "rod"]


def __dir__() -> list[str]:
    return __all__


class Inertia(NamedTuple):
    """A mass in kg and its moment of inertia about the centre of mass in kg m^2, as `Mechanism.body` takes them."""

    mass: float
    moment: float


def rod(*, length: float, mass: float | None = None, density: float | None = None) -> Inertia:
    """A uniform slender rod.

    Parameters
    ----------
    length : float
        In m.
    mass, density : float
        One of the two: in kg, or in kg/m.

    Returns
    -------
    Inertia
        (mass, moment).

    Examples
    --------
    >>> import zerodrift as zd
    >>> zd.inertia.rod(mass=3.0, length=2.0)
    Inertia(mass=3.0, moment=1.0)
    """
    length = checks.number("length", length, above=0)
    mass = _mass(mass, density, length, "kg/m")
    return Inertia(mass, mass * length**2 / 12)


def disc(*, radius: float, mass: float | None = None, density: float | None = None, inner: float = 0.0) -> Inertia:
    """A uniform disc, or a ring.

    Parameters
    ----------
    radius : float
        In m.
    mass, density : float
        One of the two: in kg, or in kg/m^2.
    inner : float
        The radius of the hole of a ring, in m.

    Returns
    -------
    Inertia
        (mass, moment).

    Examples
    --------
    >>> import zerodrift as zd
    >>> zd.inertia.disc(mass=2.0, radius=0.5)
    Inertia(mass=2.0, moment=0.25)
    """
    radius, inner = checks.number("radius", radius, above=0), checks.number("inner", inner, least=0)
    if inner >= radius:
        raise WrongValue(f"inner must be less than radius, {radius:g}, not {inner:g}", "out-of-range")
    mass = _mass(mass, density, math.pi * (radius**2 - inner**2), "kg/m^2")
    return Inertia(mass, mass * (radius**2 + inner**2) / 2)


def box(*, width: float, height: float, mass: float | None = None, density: float | None = None) -> Inertia:
    """A uniform rectangle.

    Parameters
    ----------
    width, height : float
        In m.
    mass, density : float
        One of the two: in kg, or in kg/m^2.

    Returns
    -------
    Inertia
        (mass, moment).

    Examples
    --------
    >>> import zerodrift as zd
    >>> zd.inertia.box(mass=12.0, width=3.0, height=4.0)
    Inertia(mass=12.0, moment=25.0)
    """
    width, height = checks.number("width", width, above=0), checks.number("height", height, above=0)
    mass = _mass(mass, density, width * height, "kg/m^2")
    return Inertia(mass, mass * (width**2 + height**2) / 12)


def _mass(mass: float | None, density: float | None, size: float, unit: str) -> float:
    if (mass is None) == (density is None):
        raise WrongType(f"either mass in kg or density in {unit} must be given, not {'both' if mass is not None else 'neither'}",
                        "conflicting-arguments")
    return checks.number("mass", mass, above=0) if density is None else checks.number("density", density, above=0) * size
