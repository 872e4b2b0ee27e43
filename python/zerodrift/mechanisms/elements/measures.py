"""Handles of measures: quantities of a motion by the names under which the core knows them."""

from __future__ import annotations

from typing import Any

from ..._private import checks
from ...errors import WrongType


class Measure:
    """Quantity of a motion, such as ``crank.angle``; its name may be used instead of it.

    Attributes
    ----------
    name : str
        ``"crank.angle"``, ``"P.position.x"``.

    Examples
    --------
    >>> import zerodrift as zd
    >>> m = zd.Mechanism("pendulum")
    >>> link = m.link("link", (0, 0), (1, 0), mass=1.0)
    >>> link.angle, link.end.position.y
    (Measure('link.angle'), Measure('link.end.position.y'))
    """

    __slots__ = ("name",)

    def __init__(self, name: str) -> None:
        self.name = name

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name!r})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Measure) and other.name == self.name

    def __hash__(self) -> int:
        return hash(self.name)


def component(axis: str) -> Measure:
    return property(lambda self: Measure(f"{self.name}.{axis}"),        # type: ignore[return-value]
                    doc=f"The component along the drawing's {axis[0]} axis{' of the body axis ' * (len(axis) > 1)}{axis[1:]}.")


class VectorMeasure(Measure):
    """Vector measure, with components that are measures, too: `x`, `y`."""

    __slots__ = ()

    x, y = (component(axis) for axis in "xy")


class VectorMeasure3(VectorMeasure):
    """Vector measure in space, with components `x`, `y`, `z`."""

    __slots__ = ()

    z = component("z")


def name_of(measure: Any, argument: str) -> str:
    """Name of a measure that is given as an object or by name."""
    if isinstance(measure, Measure):
        return measure.name
    if isinstance(measure, str):
        return measure
    raise WrongType(f"{argument} must be a measure, such as crank.angle, or its name, not {checks.shown(measure)}")


def scalar(quantity: str, doc: str) -> Measure:
    """Property of an element for its scalar measure of that name."""
    return property(lambda self: Measure(f"{self.measured_name}.{quantity}"), doc=doc)     # type: ignore[return-value]


def vector(quantity: str, doc: str, in_plane: type[Measure] = VectorMeasure) -> VectorMeasure3:
    """Property of an element for its vector measure of that name."""
    def measure(self: Any) -> Measure:
        return (VectorMeasure3 if getattr(self, "dimension", 2) == 3 else in_plane)(f"{self.measured_name}.{quantity}")

    return property(measure, doc=doc)       # type: ignore[return-value]
