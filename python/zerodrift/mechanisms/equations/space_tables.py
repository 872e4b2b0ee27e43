"""Tables of numbers from which the core makes a system in space."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ..._private.gateway import Variable
from ..._private.gateway.mechanisms import space
from ..._private.gateway.mechanisms.element_tables import ElementQuantity, three
from ..._private.gateway.mechanisms.space import AS_DRAWN, Quantity, SpaceCore
from ..._private.gateway.mechanisms.space_tree import SpaceTreeCore
from ..._private.rotations import AXES, COMPONENTS, quaternion_of
from ..elements.bodies import Body, Particle, Point
from ..elements.drawing import Drawing
from ..elements.frames import triple
from ..elements.joints import Joint
from ..elements.numbers import Numbers
from ..elements.space_bodies import SpaceInertias
from ..elements.space_joints import SpaceJoint, swivels
from ..elements.table_forces import ROTATIONS, TableForce
from ..loads.teeth import Side, Wrench
from . import space_tree
from .tables import Tables
from .tree import inboard_joints


class SpaceTables(Tables):
    """Tables of a mechanism in space, from which the core makes its system; built as in the plane, see `Tables`."""

    joints: list[SpaceJoint]
    inertias: SpaceInertias

    entries: Any = space

    masses: Any = SpaceInertias

    @property
    def kind_of_core(self) -> Any:      # type: ignore[override]
        """Class of the core's system."""
        return SpaceCore if max(self.inboard, default=-1) < 0 else SpaceTreeCore

    def _inertia(self, body: Body) -> tuple[float, Any]:
        mass = self.inertias.of[body.name]
        return mass.mass, triple(mass.moments) if body.turns else space.NONE

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
            rotation = body.pose.rotation @ known.axes      # type: ignore[attr-defined]
            poses.append([*body.pose.point(known.com), *quaternion_of(rotation)])
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

    def place(self, point: Point) -> tuple[int, Any]:
        return self.number[point.body.name], triple(self.inertias.local(point, self.numbers))

    def _direction(self, body: Body, local: np.ndarray) -> Any:
        return triple(self.inertias.direction(body, local))

    def _joint(self, joint: SpaceJoint) -> space.Joint:
        """Entry of the table of joints."""
        (first, point1), (second, point2) = self.place(joint.first), self.place(joint.second)
        frame1, frame2 = (three(self._direction(body, row) for row in frame)
                          for body, frame in zip(joint.bodies, joint.frames, strict=True))
        return space.Joint(joint.row.number, first, second, point1, point2, frame1, frame2,
                           triple(joint.semiaxes_with(self.numbers)), joint.along_with(self.numbers),
                           joint.length_with(self.numbers))

    # ---- marker quantities ----

    def _reading_of(self, name: str) -> Quantity:
        owner, _, measured = name.rpartition(".")
        if owner.endswith(".rotation"):
            body = self.drawing.elements[owner.removesuffix(".rotation")]
            return self.rotation_quantities(body)[COMPONENTS[9].index(measured)]
        if measured in AXES:
            owner, _, vector = owner.rpartition(".")
            of = self.drawing.measured_at(owner)
            found: tuple[Quantity, ...] = self.place_quantities(of) if vector == "position" else self.spin_quantities(of)
            return found[AXES.index(measured)]
        of = self.drawing.elements[owner]
        return self.coordinate_quantity_of(of, measured) if isinstance(of, SpaceJoint) else self.length_quantity(of)

    def place_quantities(self, of: Body | Point) -> tuple[Quantity, ...]:
        """Marker quantities x, y and z of a point, or of the origin of a body's frame."""
        if isinstance(of, Body):
            of = of.attachment if isinstance(of, Particle) and of.attachment else Point(of, np.zeros(3))
        body, local = self.place(of)
        return tuple(Quantity(axis, 0, body, point2=local) for axis in AXES)

    def spin_quantities(self, body: Body) -> tuple[Quantity, ...]:
        """Marker quantities whose rates are the three components of a body's angular velocity in the drawing's axes."""
        return tuple(Quantity("spin", 0, self.number[body.name], a=axis) for axis in AS_DRAWN)

    def principal_spins(self, body: Body, inertia: np.ndarray) -> Iterator[tuple[Quantity, float]]:
        """Marker quantities whose rates are angular velocities about a body's own principal axes, with the moments of inertia."""
        number, (moments, axes) = self.number[body.name], np.linalg.eigh(np.zeros((3, 3)) + inertia)
        for moment, axis in zip(moments, axes.T, strict=True):
            yield Quantity("spin", number, number, a=self._direction(body, axis)), float(moment)

    def rotation_quantities(self, body: Body) -> tuple[Quantity, ...]:
        """Marker quantities of a body's rotation, row by row: cosines between the drawing's axes and its own."""
        own = [self._direction(body, axis) for axis in np.eye(3)]
        return tuple(Quantity("cosine", 0, self.number[body.name], a=drawn, b=axis) for drawn in AS_DRAWN for axis in own)

    def coordinate_quantity_of(self, joint: Joint, coordinate: str) -> Quantity:
        """Marker quantity of a joint's coordinate."""
        number = self.joint_number[joint.name]
        angles = sum(len(before.angles) for before in self.joints[:number])
        return space.coordinate_quantity(self.joint_rows[number], joint.coordinates.index(coordinate), angles)

    def _mesh_quantities(self, side: Side, wrench: Wrench) -> Iterator[tuple[float, Quantity]]:
        (first, point1), (second, point2) = self.place(side.on_carrier), self.place(side.on_wheel)
        carrier = side.on_carrier.body
        if size := float(np.linalg.norm(wrench.force)):
            yield size, Quantity("along", first, second, point1, point2, a=self._direction(carrier, wrench.force / size))
        across = np.cross(wrench.moment, side.axis)     # the axis times it is the moment without its part about the axis
        if size := float(np.linalg.norm(across)):
            yield size, Quantity("cosine", first, second, a=self._direction(carrier, across / size),
                                 b=self._direction(side.on_wheel.body, side.axis_on_wheel))

    def _damped(self, joint: Any) -> list[int]:
        if not swivels(joint.row):
            return super()._damped(joint)
        first, second = (self.number[body.name] for body in joint.bodies)
        return [self._quantity(f"{joint.name} turn {i}", Quantity("turn", first, second, a=a)) for i, a in enumerate(AS_DRAWN)]

    def _element_quantities(self, element: TableForce) -> list[Quantity]:
        if element.joint is not None:
            known = self.coordinate_quantity_of(element.joint, element.which or "angle")
            return [known._replace(zero=element.zero(each, self.numbers)) for each in element.quantities]
        ends, bodies = list(map(self._end, element.ends)), (element.axes_of, getattr(element.ends[1], "body", element.ends[1]))
        near, far = ([self._direction(body, row) for row in (() if frame is None else frame)]
                     for body, frame in zip(bodies, element.frames or ((), ()), strict=True))
        return [self._along(each, ends, near, far)._replace(zero=element.zero(each, self.numbers)) for each in element.quantities]

    def _along(self, quantity: ElementQuantity, ends: list[Any], near: list[Any], far: list[Any]) -> Quantity:
        """Marker quantity of two ends, along directions of the first body, rows of `near`, and of the second."""
        (first, point1), (second, point2), a = *ends, quantity.of_first
        if quantity.kind == "angle":
            return Quantity("angle", first, second, a=near[a], o=near[a - 2], b=far[quantity.of_second])
        if quantity.kind == "rotation":
            shape = three(map(triple, np.transpose(near) @ far))
            return Quantity("rotation", first, second, a=near[a], shape=shape)
        places = {} if quantity.kind in ROTATIONS else {"point1": point1, "point2": point2}
        return Quantity(quantity.kind, first, second, **places, **({"a": near[a]} if near else {}))


def tables_of(drawing: Drawing, numbers: Numbers, *, in_tree: bool, starts: Mapping[str, float] | None = None) -> Tables:
    """Tables of a mechanism, for the core: `Tables` in the plane, `SpaceTables` in space.

    `in_tree`: in joint coordinates of a tree; otherwise in absolute coordinates.
    """
    return (SpaceTables if drawing.dimension == 3 else Tables)(drawing, numbers, in_tree=in_tree, starts=starts)
