"""Measures of one's own and groups of bodies, as defined."""

from __future__ import annotations

from .bodies import Body
from .immutable import Fixed
from .measures import Measure, VectorMeasure3, vector
from .user_functions import Law


class OwnMeasure(Fixed):
    """A function of time and measures that acts on nothing, `Mechanism.measure`.

    Attributes
    ----------
    name : str
    law : Law
    unit : str
    """

    kind = "measure"

    def __init__(self, name: str, law: Law, unit: str) -> None:
        self.name, self.law, self.unit = name, law, unit

    def __repr__(self) -> str:
        return f"<measure {self.name}>"


class Group(Fixed):
    """Bodies that are measured together; `Mechanism.group` makes it.

    Attributes
    ----------
    name : str
    bodies : tuple of Body
    """

    kind = "group"

    def __init__(self, name: str, bodies: tuple[Body, ...]) -> None:
        self.name, self.bodies = name, bodies

    momentum = vector("momentum", "Their momentum, in the drawing's axes, in kg m/s.")
    angular_momentum = vector("angular_momentum", "Their moment of momentum about the drawing's origin, in kg m^2/s; in space a "
                              "vector in the drawing's axes.", Measure)

    @property
    def dimension(self) -> int:
        """2 in the plane, 3 in space."""
        return self.bodies[0].dimension

    @property
    def center(self) -> Center:
        """Their common centre of mass, measured as ``group.center.position``."""
        return Center(self)

    def __repr__(self) -> str:
        return f"<group {self.name}: {', '.join(body.name for body in self.bodies)}>"


class Center:
    """Centre of mass of a group."""

    def __init__(self, group: Group) -> None:
        self.measured_name, self.dimension = f"{group.name}.center", group.dimension

    position: VectorMeasure3 = vector("position", "Position of the centre, in the drawing's axes, in m.")
    velocity: VectorMeasure3 = vector("velocity", "Its velocity, in the drawing's axes, in m/s.")
