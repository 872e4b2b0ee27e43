"""Tables of numbers from which the core makes a system."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from ..._private.gateway.mechanisms import plane as entries
from ..._private.gateway.mechanisms.core import MechanismCore
from ..._private.gateway.mechanisms.element_tables import Group, OutputSpec, component_places
from ..._private.gateway.mechanisms.plane import PlaneCore, Quantity
from ..elements import columns
from ..elements.bodies import Body, Particle, Point
from ..elements.drawing import Drawing, Inertias
from ..elements.forces import Actuator, Bushing, Gravity, Motor
from ..elements.frames import turned
from ..elements.joints import Coupling, Joint
from ..elements.numbers import AS_GIVEN, Numbers
from ..elements.own_measures import OwnMeasure
from ..elements.table_forces import UNITS, TableForce, lengths, paths
from ..loads import teeth
from . import function_calls, transmission
from .measure_names import checked_reading, has_coordinate
from .switch_tables import add_switches
from .tree import Edge, ends, freedoms, inboard_joints

ORIGIN = np.zeros(2)


class Tables:
    """Tables of a mechanism, from which the core makes its system, one entry for each body, joint, constraint and force.

    Attributes
    ----------
    joints : list of Joint
        In the order of the core's table; a contact may have several parts, one after another.
    inboard : list of int
        Inboard joint of each body; -1: the body is free.
    relation_names : list of str
        Name of the element that each relation belongs to.
    """

    entries: Any = entries      # in space others
    masses: Any = Inertias
    kind_of_core: Any = PlaneCore

    def __init__(self, drawing: Drawing, numbers: Numbers, *, in_tree: bool, starts: Mapping[str, float] | None = None) -> None:
        self.drawing, self.numbers, self.starts = drawing, numbers, starts or {}
        self.parameters = {name: numbers.changed.get(name, value) for name, value in drawing.parameters.items()}
        self.parts, self.inertias = drawing.parts(), self.masses(drawing, numbers)
        self.joints = [part for joint in drawing.of(Joint) for part in joint.parts]
        self.number = {"ground": 0, **{body.name: i for i, body in enumerate(self.parts, 1)}}
        self.joint_number = {joint.name: i for i, joint in enumerate(self.joints)}
        self.joint_number |= {joint.name: self.joint_number[joint.parts[0].name] for joint in drawing.of(Joint) if joint.parts}
        self.quantities: list[Any] = []     # Quantity, in space that of space
        self.quantity_number: dict[str, int] = {}
        self.relations: list[entries.Relation] = []
        self.relation_names: list[str] = []
        self.forces: list[entries.GeneralizedForce] = []
        self.observed: list[OutputSpec] = []
        self.groups: list[Group] = []
        self.laws = function_calls.Laws()
        self.inboard = self.tree() if in_tree else [-1] * len(self.parts)
        self.joint_rows = [self._joint(joint) for joint in self.joints]
        self._damp()
        for kind, add in ((Motor, self._motor), (Actuator, self._actuator), (Coupling, self._coupling), (Gravity, self._weights)):
            for element in drawing.of(kind):
                add(element)
        for element in sorted(drawing.of(TableForce), key=lambda element: element.row.number):
            self._table_force(element)
        for measure in drawing.of(OwnMeasure):
            self._own_measure(measure)
        add_switches(self)

    def core(self, quantities: Sequence[Any] | None = None, observed: Sequence[OutputSpec] = ()) -> MechanismCore:
        """Core system of the tables, with the measures `observed` and their marker quantities; left out: without measures."""
        laws = self.laws if self.laws.acting or any(each.kind == "formula" for each in observed) else None
        return self.kind_of_core(self.written(quantities, observed), laws, laws_know_time=self.laws.know_time)

    def written(self, quantities: Sequence[Any] | None = None, observed: Sequence[OutputSpec] = ()) -> entries.Tables:
        """Tables for the core."""
        bodies = [self.entries.Body(*self._inertia(body), not body.turns, inboard)
                  for body, inboard in zip(self.parts, self.inboard, strict=True)]
        quantities = self.quantities if quantities is None else quantities
        return self.entries.Tables(bodies, self.joint_rows, quantities, self.relations, self.forces, observed, self._gravity(),
                                   self.reactions(observed), self._length(), self.groups)

    def _inertia(self, body: Body) -> tuple[float, Any]:
        return self.inertias.of[body.name][:2]

    def reactions(self, observed: Sequence[OutputSpec]) -> dict[str, tuple[int, int]]:
        """Index and component of the measures, if they are there, of reactions and accelerations that user functions read."""
        names = self.drawing.reactions()
        found = component_places(observed if names else (), self.drawing.dimension)
        return {name: found[name] for name in names if name in found}

    def drawn(self) -> np.ndarray:
        """Poses (bodies, 3) of the mass centres as drawn."""
        poses = [(*(body.pose.origin + turned(body.pose.angle, self.inertias.of[body.name][2])), body.pose.angle)
                 for body in self.parts]
        return np.array(poses, dtype=float).reshape(-1, 3)

    def absolute(self) -> Tables:
        """The same tables with all bodies free."""
        other = copy.copy(self)
        other.inboard = [-1] * len(self.parts)
        return other

    def joint_coordinates(self) -> int:
        """Number of coordinates of the bodies along the tree."""
        hung = [(body, self.joints[inboard]) for body, inboard in zip(self.parts, self.inboard, strict=True) if inboard >= 0]
        free = sum(3 if body.turns else 2 for body, inboard in zip(self.parts, self.inboard, strict=True) if inboard < 0)
        return free + sum(freedoms(joint)[joint.bodies[1] is body] for body, joint in hung)

    def _length(self) -> float:
        """Largest distance between ends of joints in the drawing without changed parameters, in m; 1 if there is none."""
        points = np.array([side.drawn_with(AS_GIVEN) for joint in self.joints for side in (joint.first, joint.second)])
        if not len(points):
            return 1.0
        radii, largest = np.linalg.norm(points - points.mean(axis=0), axis=1), 0.0
        for i in np.argsort(-radii):
            if 2 * radii[i] <= largest:     # as no point left is further from the centre
                break
            largest = max(largest, float(np.linalg.norm(points - points[i], axis=1).max()))
        return largest or 1.0

    def _gravity(self) -> Any:
        return tuple(columns.plain(self.numbers.changed.get(f"gravity.{axis}", value))
                     for axis, value in zip("xyz", self.drawing.gravity, strict=False))

    # ---- bodies and joints ----

    def tree(self, *, with_cut: bool = False) -> list[int]:
        """Inboard joint of each body, optionally counting joints that the user has cut."""
        edges = [Edge(i, *ends(joint, self.number), freedoms(joint))
                 for i, joint in enumerate(self.joints) if joint.row.inboard and (with_cut or not joint.cut)]
        weights = [(float(body.turns), self.inertias.of[body.name][0]) for body in self.parts]
        return inboard_joints(len(self.parts), edges, weights)

    def place(self, point: Point) -> tuple[int, tuple[float, float]]:
        return self.number[point.body.name], self.inertias.local(point, self.numbers)

    def _joint(self, joint: Any) -> Any:
        """Entry of the table of joints."""
        (first, point1), (second, point2) = self.place(joint.first), self.place(joint.second)
        axis = (1.0, 0.0) if joint.axis is None else _pair(joint.axis)
        if joint.is_of_one_body:
            return entries.Joint(joint.row.number, second, second, point2, point2, axis)
        return entries.Joint(joint.row.number, first, second, point1, point2, axis, joint.offset_as_drawn(self.numbers), 0.0,
                          joint.angle_as_drawn(), joint.length_with(self.numbers))

    # ---- marker quantities ----

    def _quantity(self, name: str, quantity: Any) -> int:
        self.quantity_number[name] = len(self.quantities)
        self.quantities.append(quantity)
        return self.quantity_number[name]

    def _quantity_of(self, name: str) -> int:
        """Index of the marker quantity of a component of a position, such as "crank.end.position.x", added at first use."""
        known = self.quantity_number.get(name)
        if known is not None:
            return known
        element, word, *axis = name.split(".")
        bushing = self.drawing.elements[element]
        return self._quantity(name, self.bushing_quantities(bushing, word)["xyz".index(*axis or "x")] if isinstance(
            bushing, Bushing) else self._reading_of(name))

    def bushing_quantities(self, bushing: Bushing, word: str) -> tuple[Any, ...]:
        """Marker quantities of a bushing: "displacement", "angle", or "turn", whose rate is the angular velocity."""
        known, n = self._element_quantities(bushing), lengths(bushing.row)
        turns = [each._replace(kind="turn") if each.kind == "rotation" else each for each in known[n:]]
        return tuple(known[:n] if word == "displacement" else turns if word == "turn" else known[n:])

    def _reading_of(self, name: str) -> Any:
        owner, _, quantity = name.rpartition(".")
        if quantity in ("x", "y"):
            return self.place_quantities(self.drawing.measured_at(owner.rpartition(".")[0]))["xy".index(quantity)]
        of = self.drawing.elements[owner]
        if isinstance(of, Joint):
            if quantity == "transmission_angle":
                return self.transmission_quantity(of)
            return self.coordinate_quantity(self.joint_number[owner])
        return self.length_quantity(of) if isinstance(of, TableForce | Actuator) else self.angle_quantity(of)

    def place_quantities(self, of: Body | Point) -> tuple[Any, ...]:
        """Marker quantities x and y of a point, or of the origin of a body's frame."""
        if isinstance(of, Body):
            of = of.attachment if isinstance(of, Particle) and of.attachment else Point(of, ORIGIN)
        body, local = self.place(of)
        return Quantity("x", 0, body, (0.0, 0.0), local), Quantity("y", 0, body, (0.0, 0.0), local)

    def angle_quantity(self, body: Body) -> Quantity:
        """Marker quantity of a body's angle."""
        return Quantity("angle", 0, self.number[body.name])

    def coordinate_quantity(self, joint: int) -> Quantity:
        """Marker quantity of a joint's coordinate."""
        kind, row = self.joints[joint].row, self.joint_rows[joint]
        zero = getattr(row, kind.zero) if kind.zero else 0.0
        return Quantity(kind.quantity, row.first, row.second, row.point1, row.point2, row.axis, zero)

    def transmission_quantity(self, joint: Joint) -> Quantity:
        """Marker quantity of the transmission angle at a hinge."""
        return transmission.quantity(joint, self.joints_by_body, self.numbers, self.number)

    @cached_property
    def joints_by_body(self) -> dict[str, list[Joint]]:
        """Joints of each body, by its name."""
        return transmission.joints_by_body(self.drawing.elements)

    def length_quantity(self, spring: TableForce | Actuator) -> Any:
        """Marker quantity of the length of a spring or an actuator."""
        (first, point1), (second, point2) = self.place(spring.first), self.place(spring.second)
        return self.entries.Quantity("distance", first, second, point1, point2)

    def _damp(self) -> None:
        """Add the damping of joints."""
        for i, joint in enumerate(self.joints):
            if damping := self.numbers(joint, "damping", joint.damping):
                self.forces += [entries.GeneralizedForce("spring", quantity, damping=damping, joint=i)
                                for quantity in self._damped(joint)]

    def _damped(self, joint: Any) -> list[int]:
        """Marker quantities that the damping of a joint acts along."""
        return [self._quantity_of(f"{joint.name}.{joint.coordinate}")] if has_coordinate(joint) else []

    # ---- drives and couplings ----

    def _inputs(self, names: Sequence[str], first: Sequence[int] = ()) -> tuple[list[int], list[tuple[int, bool]]]:
        """Marker quantities of a user function; for each of its measures the index among them and whether the rate is meant."""
        quantities, picks = list(first), []
        for name in names:
            read = checked_reading(name, name, None, self.drawing.elements)
            quantity = self._quantity_of(read.quantities[0])
            if quantity not in quantities:
                quantities.append(quantity)
            picks.append((quantities.index(quantity), read.is_rate))
        return quantities, picks

    def _relation(self, name: str, relation: entries.Relation) -> None:
        self.relation_names.append(name)
        self.relations.append(relation)

    def _motor(self, motor: Motor) -> None:
        joint, coordinate = self.joint_number[motor.joint.name], f"{motor.joint.name}.{motor.coordinate}"
        quantity, measured = self._quantity_of(coordinate), "force" if motor.coordinate == "displacement" else "torque"
        if motor.prescribes:
            index, words = len(self.relations), ("drive", "drive power")
            self._relation(motor.name, self._drive(motor, coordinate, quantity, joint))
        else:
            index, words = len(self.forces), ("force value", "force power")
            self._generalized_force(motor.drives, quantity, motor, joint=joint)
        self.observed.append(OutputSpec(f"{motor.name}.{measured}", UNITS[measured], words[0], index))
        self.observed.append(OutputSpec(f"{motor.name}.power", "W", words[1], index))

    def _drive(self, motor: Motor, coordinate: str, quantity: int, joint: int) -> entries.Relation:
        """Driving constraint of a prescribed motion."""
        law = motor.law
        if law.constant is not None:
            value = self.numbers(motor, motor.drives, law.constant)
            constant, slope = (self.starts.get(coordinate, 0.0), value) if motor.drives == "speed" else (value, 0.0)
            return entries.Relation([quantity], [1.0], constant, slope, joint=joint)
        if motor.drives != "speed":
            return entries.Relation([quantity], law=self.laws.add(function_calls.Motion(law, (), self.parameters)), joint=joint)
        quantities, picks = self._inputs(law.measures, [quantity])
        row = self.laws.add(function_calls.Speed(law, picks, self.parameters))
        return entries.Relation(quantities, nonholonomic=True, law=row, joint=joint)

    def _actuator(self, actuator: Actuator) -> None:
        quantity, law = self._quantity_of(f"{actuator.name}.length"), actuator.law
        index = len(self.relations) if actuator.prescribes else len(self.forces)
        if not actuator.prescribes:
            self._generalized_force("force", quantity, actuator)
        elif law.constant is not None:
            self._relation(actuator.name, entries.Relation([quantity], [1.0], self.numbers(actuator, "length", law.constant)))
        else:
            motion = self.laws.add(function_calls.Motion(law, (), self.parameters))
            self._relation(actuator.name, entries.Relation([quantity], law=motion))
        value, power = ("drive", "drive power") if actuator.prescribes else ("force value", "force power")
        self.observed.append(OutputSpec(f"{actuator.name}.force", "N", value, index))
        self.observed.append(OutputSpec(f"{actuator.name}.power", "W", power, index))

    def _coupling(self, coupling: Coupling) -> None:
        if coupling.law is None:
            quantities = [self._quantity_of(name) for name in coupling.of]
            ratio = self.numbers(coupling, "ratio", coupling.ratio)
            coefficients = teeth.act(self, coupling, ratio, quantities)
            self._relation(coupling.name, entries.Relation(quantities, coefficients))
            return self._observe_coupling(coupling, len(quantities))
        quantities, picks = self._inputs(coupling.of)
        nonholonomic = coupling.kind == "nonholonomic"
        kind = function_calls.Nonholonomic if nonholonomic else function_calls.Holonomic
        row: function_calls.Call = kind(coupling.law, picks, self.parameters)
        if isinstance(row, function_calls.Nonholonomic):
            row.check_linear(len(quantities))
        self._relation(coupling.name, entries.Relation(quantities, nonholonomic=nonholonomic, law=self.laws.add(row)))
        self._observe_coupling(coupling, len(quantities))

    def _mesh_quantities(self, side: teeth.Side, wrench: teeth.Wrench) -> Iterator[tuple[float, Any]]:
        """Marker quantities along which a wrench acts on a wheel at its bearing, with their components."""
        (first, point1), (second, point2) = self.place(side.on_carrier), self.place(side.on_wheel)
        if size := float(np.hypot(*wrench.force[:2])):
            yield size, Quantity("along", first, second, point1, point2, _pair(wrench.force[:2] / size))

    def _observe_coupling(self, coupling: Coupling, terms: int) -> None:
        """Add the efforts of the last relation as measures: that along its value, and that of a cam along its first term."""
        for effort, term in zip(coupling.efforts[:1 if coupling.teeth else 2], (terms, 0), strict=False):
            unit = "N m" if effort.endswith("torque") else "N"
            self.observed.append(OutputSpec(f"{coupling.name}.{effort}", unit, "drive", len(self.relations) - 1, term=term))

    # ---- forces ----

    def _generalized_force(self, path: str, quantity: int, element: Any, sign: float = 1, **more: Any) -> None:
        """Add a generalized force by a number or a user function, times `sign`, with a damping and at a joint by `more`."""
        law = element.laws[path]
        if law.constant is not None:
            value = sign * self.numbers(element, path, law.constant)
            self.forces.append(entries.GeneralizedForce("constant", quantity, value=value, **more))
            return
        kind, first = (function_calls.Stiffness, [quantity]) if path == "stiffness" else (function_calls.ForceLaw, [])
        quantities, picks = self._inputs(law.measures, first)
        reads = tuple(dict.fromkeys(law.reactions.values()))
        picks += [(len(quantities) + reads.index(name), False) for name in law.reactions.values()]
        row = self.laws.add(kind(law, picks, self.parameters, sign))
        given = {"law": row, "inputs": quantities, "reads": reads, "what": law.what, **more}
        self.forces.append(entries.GeneralizedForce("law", quantity, **given))

    def _weights(self, gravity: Gravity) -> None:
        """Add the weight of each body, at its mass centre."""
        for body in self.parts:
            for axis, quantity in zip(gravity.laws, self.place_quantities(body), strict=True):
                centre = quantity._replace(point2=(0.0,) * self.drawing.dimension)
                number = self._quantity(f"{body.name} weight {axis}", centre)
                self._generalized_force(axis, number, gravity, float(self.inertias.of[body.name][0]))

    def _table_force(self, element: TableForce) -> None:
        """Add the generalized force along each marker quantity of an element, and its measures."""
        index, joint = len(self.forces), -1 if element.joint is None else self.joint_number[element.joint.name]
        every, size = [each for part in element.parts for each in enumerate(self._element_quantities(part))], 0
        stiffnesses: Any = element.coupled
        coupled = [] if stiffnesses is None else [self._quantity(f"{element.name} {i}", each) for i, each in every]
        for i, quantity in every:
            path, damped, acting, value = paths(element.row)[i]
            stiffness, damping = (self.numbers(element, each, element.values.get(each, 0.0)) for each in (path, damped))
            acting = element.drives if element.law else acting
            own = element.own(acting, value) if acting in element.laws else ""
            name = f"{element.name} {i}"
            number = coupled[i] if coupled else self._quantity_of(own) if own else self._quantity(name, quantity)
            if acting in element.laws:
                sign = -1 if acting == "stiffness" else element.row.sign
                self._generalized_force(acting, number, element, sign, joint=joint, damping=damping)
            else:
                self.forces += [entries.GeneralizedForce("spring", number, float(stiffnesses[i, j]), inputs=[other])
                                for j, other in enumerate(coupled) if stiffnesses[i, j]]
                if quantity.kind == "rotation":     # damped by the angular velocity, not by the rate of the rotation vector
                    self.forces.append(entries.GeneralizedForce("spring", number, stiffness))
                    number, stiffness = self._quantity(f"{name} turn", quantity._replace(kind="turn")), 0.0
                self.forces.append(entries.GeneralizedForce("spring", number, stiffness, damping, joint=joint))
            size = len(self.forces) - index if i < lengths(element.row) else size
        self.observed += self._efforts(element, index, size)

    def _element_quantities(self, element: TableForce) -> list[Any]:
        (first, point1), (second, point2) = map(self._end, element.ends)
        axis = (1.0, 0.0) if element.axis is None else _pair(element.axis)
        return [Quantity(each.kind, first, second, point1, point2, axis, element.zero(each, self.numbers))
                for each in element.quantities]

    def _own_measure(self, measure: OwnMeasure) -> None:
        reads = (*measure.law.measures, *measure.law.reactions.values())
        picks = [(i, False) for i in range(len(reads))]
        row = self.laws.add(function_calls.Value(measure.law, picks, self.parameters, 1))
        self.observed.append(OutputSpec(measure.name, measure.unit, "formula", row, reads=reads))

    def _end(self, end: Body | Point) -> tuple[int, Any]:
        """Number of a body, and the point of it that a marker quantity belongs to."""
        return (self.number[end.name], (0.0,) * self.drawing.dimension) if isinstance(end, Body) else self.place(end)

    def _efforts(self, element: TableForce, index: int, size: int) -> Iterator[OutputSpec]:
        """Measures of the generalized forces of an element from this index on, of which `size` are along lengths."""
        entry = element.row
        if entry.measure:
            sign = float(entry.sign)
            yield OutputSpec(f"{element.name}.{entry.measure}", UNITS[entry.measure], "force value", index, scale=sign)
            return
        yield OutputSpec(f"{element.name}.force", "N", "force sum", index, size)
        turning = ("torque sum", index + size, len(self.forces) - index - size)
        yield OutputSpec(f"{element.name}.torque", "N m", *(turning if element.dimension == 3 else ("force value", index + size)))


def _pair(vector: np.ndarray) -> tuple[float, float]:
    return float(vector[0]), float(vector[1])
