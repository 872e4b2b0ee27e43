"""Tables of numbers from which the core makes a system in space."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ..._gateway import Variable
from ..._gateway.mechanisms import plane as entries
from ..._gateway.mechanisms import space
from ..._gateway.mechanisms.space import AS_DRAWN, Quantity, SpaceCore
from ..._gateway.mechanisms.space_tree import SpaceTreeCore
from ..._rotations import AXES, quaternion_of
from ..elements.bodies import Body, Particle, Point
from ..elements.drawing import Drawing
from ..elements.forces import Actuator, Force, SpaceBushing, Spring, Torque, TorsionSpring
from ..elements.frames import triple
from ..elements.numbers import Numbers
from ..elements.space_bodies import SpaceInertias
from ..elements.space_joints import SpaceJoint
from ..elements.table_forces import MadeForce
from . import space_tree
from .tables import Tables
from .tree import inboard_joints


class SpaceTables(Tables):
    """Tables of a mechanism in space: those of the plane, with marker quantities, joints and bodies of space."""

    joints: list[SpaceJoint]    # type: ignore[assignment]
    inertias: SpaceInertias     # type: ignore[assignment]
    quantities: list[Quantity]         # type: ignore[assignment]

    def __init__(self, drawing: Drawing, numbers: Numbers, *, in_tree: bool = False,
                 starts: Mapping[str, float] | None = None) -> None:
        super().__init__(drawing, numbers, in_tree=in_tree, starts=starts)

    def _masses(self) -> Any:
        return SpaceInertias(self.drawing, self.numbers)

    def core(self, quantities: Sequence[Quantity] | None = None, observed: Sequence[entries.OutputSpec] = ()) -> SpaceCore:     # type: ignore[override]
        """Core system, without measures, or with these; their marker quantities follow those of the tables."""
        made = SpaceCore if max(self.inboard, default=-1) < 0 else SpaceTreeCore
        laws = self.laws if self.laws.rows else None
        return made(self.written(quantities, observed), laws, laws_know_time=self.laws.know_time)

    def written(self, quantities: Sequence[Quantity] | None = None, observed: Sequence[entries.OutputSpec] = ()) -> space.Tables:     # type: ignore[override]
        """Tables for the core."""
        bodies = [space.Body(mass.mass, triple(mass.moments) if body.turns else space.NONE, not body.turns, inboard)
                  for body, inboard in zip(self.parts, self.inboard, strict=True) for mass in [self.inertias.of[body.name]]]
        quantities = self.quantities if quantities is None else quantities
        return space.Tables(bodies, self.joint_rows, quantities, self.relations, self.forces, observed, self._gravity())

    def joint_coordinates(self) -> int:
        """Number of velocities of the bodies along the tree."""
        return len(self.velocities())

    def tree(self, *, with_cut: bool = False) -> list[int]:
        weights = [(float(body.turns), self.inertias.of[body.name].mass) for body in self.parts]
        return inboard_joints(len(self.parts), space_tree.edges(self.joints, self.number, with_cut=with_cut), weights)

    def _carried(self) -> Iterator[tuple[Body, SpaceJoint | None]]:
        """Bodies, each with its inboard joint."""
        for body, inboard in zip(self.parts, self.inboard, strict=True):
            yield body, self.joints[inboard] if inboard >= 0 else None

    def drawn(self) -> np.ndarray:
        """Poses (bodies, 7) of the mass centres as drawn, with the principal axes."""
        poses = []
        for body in self.parts:
            known = self.inertias.of[body.name]
            poses.append([*body.pose.point(known.com), *quaternion_of(body.pose.rotation @ known.axes)])
        return np.array(poses, dtype=float).reshape(-1, 7)

    def coordinates(self) -> tuple[Variable, ...]:
        """The entries of p: of free bodies the places of mass centres, and the quaternions that turn principal axes into the
        drawing's; of others the coordinates of their joints; and angles of joints that carry no body, which follow and count
        turns.
        """
        bodies = (each for body, inboard in self._carried() for each in space_tree.positions(body, inboard))
        others = (joint for i, joint in enumerate(self.joints) if i not in self.inboard)
        return (*bodies, *(Variable(f"{joint.name}.{angle}", "rad") for joint in others for angle in joint.angles))

    def velocities(self) -> tuple[Variable, ...]:
        """Entries of v: of free bodies velocities of mass centres, and angular velocities about their own principal axes."""
        return tuple(each for body, inboard in self._carried() for each in space_tree.rates(body, inboard))

    # ---- joints ----

    def _place(self, point: Point) -> tuple[int, Any]:
        return self.number[point.body.name], triple(self.inertias.local(point, self.numbers))

    def _direction(self, body: Body, local: np.ndarray) -> Any:
        return triple(self.inertias.direction(body, local))

    def _joint(self, joint: SpaceJoint) -> space.Joint:     # type: ignore[override]
        """Entry of the table of joints."""
        (first, point1), (second, point2) = self._place(joint.first), self._place(joint.second)
        frames = (tuple(self._direction(body, row) for row in frame)
                  for body, frame in zip(joint.bodies, joint.frames, strict=True))
        along = joint.offset_as_drawn(self.numbers) if joint.row.axes else 0.0
        return space.Joint(joint.row.number, first, second, point1, point2, *frames, triple(joint.semiaxes_with(self.numbers)),
                           along, joint.length_with(self.numbers))

    # ---- marker quantities ----

    def _reading_of(self, name: str) -> Quantity:     # type: ignore[override]
        owner, _, measured = name.rpartition(".")
        if measured in AXES:
            owner, _, vector = owner.rpartition(".")
            element, _, end = owner.partition(".")
            of = self.drawing.elements[element]
            of = of.second if isinstance(of, SpaceJoint) else getattr(of, end) if end else of
            found = self.place_quantities(of) if vector == "position" else self.spin_quantities(of)
            return found[AXES.index(measured)]
        of = self.drawing.elements[owner]
        return self.coordinate_quantity_of(of, measured) if isinstance(of, SpaceJoint) else self.length_quantity(of)

    def place_quantities(self, of: Body | Point) -> tuple[Quantity, ...]:     # type: ignore[override]
        """Marker quantities x, y and z of a point, or of the origin of a body's frame."""
        if isinstance(of, Body):
            of = of.carrier if isinstance(of, Particle) and of.carrier else Point(of, np.zeros(3))
        body, local = self._place(of)
        return tuple(Quantity(axis, 0, body, point2=local) for axis in AXES)

    def spin_quantities(self, body: Body) -> tuple[Quantity, ...]:
        """Marker quantities of a body's angular velocity, in the drawing's axes."""
        return tuple(Quantity("spin", 0, self.number[body.name], a=axis) for axis in AS_DRAWN)

    def rotation_quantities(self, body: Body) -> tuple[Quantity, ...]:
        """Marker quantities of a body's rotation, row by row: cosines between the drawing's axes and its own."""
        own = [self._direction(body, axis) for axis in np.eye(3)]
        return tuple(Quantity("cosine", 0, self.number[body.name], a=drawn, b=axis) for drawn in AS_DRAWN for axis in own)

    def coordinate_quantity_of(self, joint: SpaceJoint, coordinate: str) -> Quantity:
        """Marker quantity of a joint's coordinate."""
        number = self.joint_number[joint.name]
        angles = sum(len(before.angles) for before in self.joints[:number])
        return space.coordinate_quantity(self.joint_rows[number], joint.coordinates.index(coordinate), angles)

    def length_quantity(self, spring: Spring | Actuator) -> Quantity:     # type: ignore[override]
        """Marker quantity of the length of a spring or an actuator."""
        (first, point1), (second, point2) = self._place(spring.first), self._place(spring.second)
        return Quantity("distance", first, second, point1, point2)

    # ---- drives and couplings ----

    # ---- forces ----

    def _torsion_spring(self, spring: TorsionSpring) -> None:
        quantity = self.coordinate_quantity_of(spring.joint, "angle")
        self._elastic(spring, self._quantity(spring.name, quantity._replace(zero=self.numbers(spring, "angle", spring.angle))))

    def _bushing(self, bushing: SpaceBushing) -> None:     # type: ignore[override]
        """Force along each direction by the displacement, and moment about it by the rotation of the next direction."""
        (first, point1), (second, point2) = self._place(bushing.first), self._place(bushing.second)
        near, far = ([self._direction(side.body, row) for row in frame]
                     for side, frame in zip((bushing.first, bushing.second), bushing.frames, strict=True))
        self.observed.append(entries.OutputSpec(f"{bushing.name}.force", "N", "force sum", len(self.forces), 3))
        self.observed.append(entries.OutputSpec(f"{bushing.name}.torque", "N m", "torque sum", len(self.forces) + 3, 3))
        apart = bushing.frames[0] @ bushing.first.body.pose.local_direction(
            bushing.second.drawn_with(self.numbers) - bushing.first.drawn_with(self.numbers))
        quantities = [Quantity("along", first, second, point1, point2, a=near[i], zero=float(apart[i])) for i in range(3)]
        quantities += [Quantity("angle", first, second, a=near[i - 2], o=near[i - 1], b=far[i - 2]) for i in range(3)]
        parameters = [("stiffness", "damping")] * 3 + [("torsion", "torsion_damping")] * 3
        for (stiffness, damping), quantity, axis in zip(parameters, quantities, (*AXES, *AXES), strict=True):
            number = self._quantity(f"{bushing.name} {stiffness} {axis}", quantity)
            values = (self.numbers(bushing, path, bushing.values[path]) for path in (f"{stiffness}.{axis}", f"{damping}.{axis}"))
            self.forces.append(entries.GeneralizedForce("spring", number, *values))

    def _made_quantity(self, made: MadeForce, kind: str, zero: str | None) -> Quantity:     # type: ignore[override]
        (first, point1), (second, point2) = self._place(made.first), self._place(made.second)
        axis = AS_DRAWN[0] if made.axis is None else self._direction(made.first.body, made.axis)
        return Quantity(kind, first, second, point1, point2, a=axis, zero=made.zero(zero, self.numbers))

    def _force(self, force: Force) -> None:
        body, local = self._place(force.point)
        along = self._direction(force.frame, force.along)
        quantity = self._quantity(force.name, Quantity("glide", self.number[force.frame.name], body, point2=local, a=along))
        self._generalized_force(force.name, "value", quantity, force)
        self._observe_force(force)

    def _torque(self, torque: Torque) -> None:
        """Moment about an axis that turns with a frame without reaction, or with the body that gets the opposite moment."""
        turns_with = torque.frame if torque.against is self.drawing.ground else torque.against
        kind = "spin" if torque.against is self.drawing.ground else "turn"
        axis = self._direction(turns_with, torque.axis)
        first, second = self.number[turns_with.name], self.number[torque.body.name]
        quantity = self._quantity(torque.name, Quantity(kind, first, second, a=axis))
        self._generalized_force(torque.name, "value", quantity, torque)
        self._observe_force(torque)


def tables_of(drawing: Drawing, numbers: Numbers, *, in_tree: bool, starts: Mapping[str, float] | None = None) -> Tables:
    """Tables of a drawing in the plane or in space."""
    return (SpaceTables if drawing.dimension == 3 else Tables)(drawing, numbers, in_tree=in_tree, starts=starts)
