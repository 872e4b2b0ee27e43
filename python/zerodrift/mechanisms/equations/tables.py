"""Tables of numbers from which the core makes a system."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from ..._gateway import Variable
from ..._gateway import mechanisms as rows
from ..._gateway.element_tables import Observed
from ..._gateway.mechanisms import Gauge, MechanismCore
from ..elements import columns
from ..elements.bodies import Body, Particle, Point
from ..elements.drawing import Drawing, Inertias
from ..elements.forces import Actuator, Bushing, Force, Motor, Spring, Torque, TorsionSpring
from ..elements.frames import turned
from ..elements.joints import Coupling, Joint
from ..elements.numbers import Numbers
from ..elements.space_joints import SpaceJoint
from ..elements.table_forces import ELEMENTS, MadeForce
from . import function_calls, transmission
from .measure_names import has_coordinate, reading
from .tree import Edge, carriers

ORIGIN = np.zeros(2)


class Tables:
    """Tables of a mechanism, built element by element.

    Attributes
    ----------
    joints : list of Joint
        In the order of the core's table.
    carrier : list of int
        The joint that carries each part; -1: it is free.
    relation_names : list of str
        What each relation belongs to.
    """

    def __init__(self, drawing: Drawing, numbers: Numbers, *, in_tree: bool, starts: Mapping[str, float] | None = None) -> None:
        self.drawing, self.numbers, self.starts = drawing, numbers, starts or {}
        self.parameters = {name: numbers.changed.get(name, value) for name, value in drawing.parameters.items()}
        self.parts, self.joints, self.inertias = drawing.parts(), drawing.of(Joint), self._masses()
        self.number = {"ground": 0, **{body.name: i for i, body in enumerate(self.parts, 1)}}
        self.joint_number = {joint.name: i for i, joint in enumerate(self.joints)}
        self.gauges: list[Gauge] = []
        self.gauge_number: dict[str, int] = {}
        self.relations: list[rows.Relation] = []
        self.relation_names: list[str] = []
        self.efforts: list[rows.Effort] = []
        self.effort_of: dict[str, int] = {}
        self.observed: list[Observed] = []
        self.laws = function_calls.Laws()
        self.carrier = self.tree() if in_tree else [-1] * len(self.parts)
        self.joint_rows = [self._joint(joint) for joint in self.joints]
        self._damp()
        for kind, add in ((Motor, self._motor), (Actuator, self._actuator), (Coupling, self._coupling),
                          (Spring, self._spring), (Bushing, self._bushing), (TorsionSpring, self._torsion_spring),
                          (Force, self._force), (Torque, self._torque), (MadeForce, self._made_force)):
            for element in drawing.of(kind):
                add(element)

    def _masses(self) -> Any:
        return Inertias(self.drawing, self.numbers)

    def core(self, gauges: Sequence[Gauge] | None = None, observed: Sequence[Observed] = ()) -> MechanismCore:
        """Core system, without measures, or with these; their marker quantities follow those of the tables."""
        laws = self.laws if self.laws.rows else None
        return MechanismCore(self.written(gauges, observed), laws, laws_know_time=self.laws.know_time)

    def written(self, gauges: Sequence[Gauge] | None = None, observed: Sequence[Observed] = ()) -> rows.Tables:
        """Tables for the core."""
        bodies = [rows.Body(*self.inertias.of[body.name][:2], not body.turns, carrier)
                  for body, carrier in zip(self.parts, self.carrier, strict=True)]
        return rows.Tables(bodies, self.joint_rows, self.gauges if gauges is None else gauges, self.relations, self.efforts,
                           observed, self._gravity())

    def drawn(self) -> np.ndarray:
        """Poses (bodies, 3) of the mass centres as drawn."""
        poses = [(*(body.pose.origin + turned(body.pose.angle, self.inertias.of[body.name][2])), body.pose.angle)
                 for body in self.parts]
        return np.array(poses, dtype=float).reshape(-1, 3)

    def absolute(self) -> Tables:
        """The same tables with all bodies free."""
        other = copy.copy(self)
        other.carrier = [-1] * len(self.parts)
        return other

    def joint_coordinates(self) -> int:
        """Number of coordinates of the bodies along the tree."""
        hung = [(body, self.joints[carrier]) for body, carrier in zip(self.parts, self.carrier, strict=True) if carrier >= 0]
        free = sum(3 if body.turns else 2 for body, carrier in zip(self.parts, self.carrier, strict=True) if carrier < 0)
        return free + sum(_freedoms(joint)[joint.bodies[1] is body] for body, joint in hung)

    def _gravity(self) -> Any:
        return tuple(columns.plain(self.numbers.changed.get(f"gravity.{axis}", value))
                     for axis, value in zip("xyz", self.drawing.gravity, strict=False))

    # ---- bodies and joints ----

    def tree(self, *, with_cut: bool = False) -> list[int]:
        """Inboard joint of each body, optionally counting joints that the user has cut."""
        edges = [Edge(i, *(self.number[body.name] for body in joint.bodies), _freedoms(joint))
                 for i, joint in enumerate(self.joints) if joint.row.carrier and (with_cut or not joint.cut)]
        weights = [(float(body.turns), self.inertias.of[body.name][0]) for body in self.parts]
        return carriers(len(self.parts), edges, weights)

    def _place(self, point: Point) -> tuple[int, tuple[float, float]]:
        return self.number[point.body.name], self.inertias.local(point, self.numbers)

    def _joint(self, joint: Joint) -> rows.Joint:
        """Entry of the table of joints."""
        (first, point1), (second, point2) = self._place(joint.first), self._place(joint.second)
        axis = (1.0, 0.0) if joint.axis is None else _pair(joint.axis)
        if joint.is_of_one_body:
            return rows.Joint(joint.row.number, second, second, point2, point2, axis)
        along = joint.offset_as_drawn(self.numbers) if joint.axis is not None else 0.0
        return rows.Joint(joint.row.number, first, second, point1, point2, axis, along, 0.0, joint.angle_as_drawn(),
                          joint.length_with(self.numbers))

    # ---- marker quantities ----

    def _gauge(self, name: str, gauge: Gauge) -> int:
        self.gauge_number[name] = len(self.gauges)
        self.gauges.append(gauge)
        return self.gauge_number[name]

    def _gauge_of(self, name: str) -> int:
        """Index of the marker quantity of a component of a position, such as "crank.end.position.x", added at first use."""
        known = self.gauge_number.get(name)
        return self._gauge(name, self._reading_of(name)) if known is None else known

    def _reading_of(self, name: str) -> Gauge:
        owner, _, quantity = name.rpartition(".")
        if quantity in ("x", "y"):
            owner, _, _ = owner.rpartition(".")
            element, _, end = owner.partition(".")
            of = self.drawing.elements[element]
            of = of.second if isinstance(of, Joint) else getattr(of, end) if end else of
            return self.place_gauges(of)["xy".index(quantity)]
        of = self.drawing.elements[owner]
        if isinstance(of, Joint):
            if quantity == "transmission_angle":
                return self.transmission_gauge(of)
            return self.coordinate_gauge(self.joint_number[owner])
        return self.length_gauge(of) if isinstance(of, Spring | Actuator) else self.angle_gauge(of)

    def place_gauges(self, of: Body | Point) -> tuple[Gauge, Gauge]:
        """Marker quantities x and y of a point, or of the origin of a body's frame."""
        if isinstance(of, Body):
            of = of.carrier if isinstance(of, Particle) and of.carrier else Point(of, ORIGIN)
        body, local = self._place(of)
        return Gauge("x", 0, body, (0.0, 0.0), local), Gauge("y", 0, body, (0.0, 0.0), local)

    def angle_gauge(self, body: Body) -> Gauge:
        """Marker quantity of a body's angle."""
        return Gauge("angle", 0, self.number[body.name])

    def coordinate_gauge(self, joint: int) -> Gauge:
        """Marker quantity of a joint's coordinate."""
        kind, row = self.joints[joint].row, self.joint_rows[joint]
        zero = getattr(row, kind.zero) if kind.zero else 0.0
        return Gauge(kind.gauge, row.first, row.second, row.point1, row.point2, row.axis, zero)

    def transmission_gauge(self, joint: Joint) -> Gauge:
        """Marker quantity of the transmission angle at a hinge."""
        return transmission.gauge(joint, self.joints_by_body, self.numbers, self.number)

    @cached_property
    def joints_by_body(self) -> dict[str, list[Joint]]:
        """Joints of each body, by its name."""
        return transmission.joints_by_body(self.drawing.elements)

    def length_gauge(self, spring: Spring | Actuator) -> Gauge:
        """Marker quantity of the length of a spring or an actuator."""
        (first, point1), (second, point2) = self._place(spring.first), self._place(spring.second)
        return Gauge("distance", first, second, point1, point2)

    def _damp(self) -> None:
        """Add the damping of joints."""
        for i, joint in enumerate(self.joints):
            damping = self.numbers(joint, "damping", joint.damping) if has_coordinate(joint) else 0.0
            if damping:
                gauge = self._gauge_of(f"{joint.name}.{joint.coordinate}")
                self.efforts.append(rows.Effort("spring", gauge, damping=damping, joint=i))

    # ---- drives and couplings ----

    def _inputs(self, names: Sequence[str], first: Sequence[int] = ()) -> tuple[list[int], list[tuple[int, bool]]]:
        """Marker quantities of a user function; for each of its measures the index among them and whether the rate is meant."""
        gauges, picks = list(first), []
        for name in names:
            read = reading(name, self.drawing.elements)
            gauge = self._gauge_of(read.gauges[0])
            if gauge not in gauges:
                gauges.append(gauge)
            picks.append((gauges.index(gauge), read.is_rate))
        return gauges, picks

    def _relation(self, name: str, relation: rows.Relation) -> None:
        self.relation_names.append(name)
        self.relations.append(relation)

    def _motor(self, motor: Motor) -> None:
        joint, coordinate = self.joint_number[motor.joint.name], f"{motor.joint.name}.{motor.coordinate}"
        gauge, quantity = self._gauge_of(coordinate), "torque" if motor.coordinate == "angle" else "force"
        unit = {"torque": "N m", "force": "N"}[quantity]
        if motor.prescribes:
            index, words = len(self.relations), ("drive", "drive power")
            self._relation(motor.name, self._drive(motor, coordinate, gauge, joint))
        else:
            index, words = len(self.efforts), ("effort", "effort power")
            self._effort(motor.name, motor.drives, gauge, motor, joint)
        self.observed.append(Observed(f"{motor.name}.{quantity}", unit, words[0], index))
        self.observed.append(Observed(f"{motor.name}.power", "W", words[1], index))

    def _drive(self, motor: Motor, coordinate: str, gauge: int, joint: int) -> rows.Relation:
        """Driving constraint of a prescribed motion."""
        law = motor.law
        if law.constant is not None:
            value = self.numbers(motor, motor.drives, law.constant)
            constant, slope = (self.starts.get(coordinate, 0.0), value) if motor.drives == "speed" else (value, 0.0)
            return rows.Relation([gauge], [1.0], constant, slope, joint=joint)
        if motor.drives != "speed":
            return rows.Relation([gauge], law=self.laws.add(function_calls.Motion(law, (), self.parameters)), joint=joint)
        gauges, picks = self._inputs(law.measures, [gauge])
        row = self.laws.add(function_calls.Speed(law, picks, self.parameters))
        return rows.Relation(gauges, nonholonomic=True, law=row, joint=joint)

    def _actuator(self, actuator: Actuator) -> None:
        gauge, law = self._gauge_of(f"{actuator.name}.length"), actuator.law
        index = len(self.relations) if actuator.prescribes else len(self.efforts)
        if not actuator.prescribes:
            self._effort(actuator.name, "force", gauge, actuator)
        elif law.constant is not None:
            self._relation(actuator.name, rows.Relation([gauge], [1.0], self.numbers(actuator, "length", law.constant)))
        else:
            motion = self.laws.add(function_calls.Motion(law, (), self.parameters))
            self._relation(actuator.name, rows.Relation([gauge], law=motion))
        word = "drive" if actuator.prescribes else "effort"
        self.observed.append(Observed(f"{actuator.name}.force", "N", word, index))
        self.observed.append(Observed(f"{actuator.name}.power", "W", f"{word} power", index))

    def _coupling(self, coupling: Coupling) -> None:
        if coupling.law is None:
            gauges = [self._gauge_of(name) for name in coupling.of]
            ratio = self.numbers(coupling, "ratio", coupling.ratio)
            self._relation(coupling.name, rows.Relation(gauges, [-ratio, 1.0]))
            self._observe_coupling(coupling, [0, 1])
            return
        gauges, picks = self._inputs(coupling.of)
        nonholonomic = coupling.kind == "nonholonomic"
        row = (function_calls.Nonholonomic if nonholonomic else function_calls.Holonomic)(coupling.law, picks, self.parameters)
        if nonholonomic:
            row.check_linear(len(gauges))
        self._relation(coupling.name, rows.Relation(gauges, nonholonomic=nonholonomic, law=self.laws.add(row)))
        self._observe_coupling(coupling, [gauge for gauge, _ in picks])

    def _observe_coupling(self, coupling: Coupling, terms: Sequence[int]) -> None:
        """Add the forces of the last relation as measures: `terms` are the indices of the coupled measures."""
        for effort, of in coupling.efforts.items():
            unit = "N m" if effort.endswith("torque") else "N"
            self.observed.append(Observed(f"{coupling.name}.{effort}", unit, "drive", len(self.relations) - 1, term=terms[of]))

    # ---- forces ----

    def _effort(self, name: str, quantity: str, gauge: int, element: Any, joint: int = -1) -> None:
        """Add a generalized force by a number or a user function."""
        self.effort_of[name] = len(self.efforts)
        if element.law.constant is not None:
            value = self.numbers(element, quantity, element.law.constant)
            self.efforts.append(rows.Effort("constant", gauge, value=value, joint=joint))
            return
        gauges, picks = self._inputs(element.law.measures)
        row = self.laws.add(function_calls.Effort(element.law, picks, self.parameters))
        self.efforts.append(rows.Effort("law", gauge, law=row, inputs=gauges, joint=joint))

    def _observe_effort(self, element: Any) -> None:
        """Add the scalar measure that the core's table defines for an element."""
        kind = ELEMENTS[element.kind]
        if kind.effort:
            unit = "N m" if kind.effort == "torque" else "N"
            self.observed.append(Observed(f"{element.name}.{kind.effort}", unit, "effort", self.effort_of[element.name],
                                          scale=float(kind.sign)))

    def _spring(self, spring: Spring) -> None:
        gauge = self.length_gauge(spring)._replace(zero=spring.free_length_with(self.numbers))
        self._elastic(spring, self._gauge(spring.name, gauge))

    def _torsion_spring(self, spring: TorsionSpring) -> None:
        first, second = (self.number[body.name] for body in spring.joint.bodies)
        zero = spring.joint.angle_as_drawn() + self.numbers(spring, "angle", spring.angle)
        self._elastic(spring, self._gauge(spring.name, Gauge("angle", first, second, zero=zero)))

    def _elastic(self, spring: Spring | TorsionSpring, gauge: int) -> None:
        self.effort_of[spring.name] = len(self.efforts)
        self.efforts.append(rows.Effort("spring", gauge, self.numbers(spring, "stiffness", spring.stiffness),
                                            self.numbers(spring, "damping", spring.damping)))
        self._observe_effort(spring)

    def _bushing(self, bushing: Bushing) -> None:
        (first, point1), (second, point2) = self._place(bushing.first), self._place(bushing.second)
        frame = bushing.first.body.pose
        apart = frame.local_direction(bushing.second.drawn_with(self.numbers) - bushing.first.drawn_with(self.numbers))
        zero = {"along": columns.plain(apart[0]), "across": columns.plain(apart[1]),
                "angle": bushing.second.body.pose.angle - frame.angle}
        paths = {"along": ("stiffness.x", "damping.x"), "across": ("stiffness.y", "damping.y"),
                 "angle": ("torsion", "torsion_damping")}
        self.observed.append(Observed(f"{bushing.name}.force", "N", "effort force", len(self.efforts), 2))
        self.observed.append(Observed(f"{bushing.name}.torque", "N m", "effort", len(self.efforts) + 2))
        for word, (stiffness, damping) in paths.items():
            gauge = self._gauge(f"{bushing.name} {word}", Gauge(word, first, second, point1, point2, zero=zero[word]))
            self.efforts.append(rows.Effort("spring", gauge, self.numbers(bushing, stiffness, bushing.values[stiffness]),
                                                self.numbers(bushing, damping, bushing.values[damping])))

    def _force(self, force: Force) -> None:
        body, local = self._place(force.point)
        frame = self.number[force.frame.name]
        gauge = self._gauge(force.name, Gauge("glide", frame, body, (0.0, 0.0), local, _pair(force.along)))
        self._effort(force.name, "value", gauge, force)
        self._observe_effort(force)

    def _torque(self, torque: Torque) -> None:
        gauge = self._gauge(torque.name, Gauge("angle", self.number[torque.against.name], self.number[torque.body.name]))
        self._effort(torque.name, "value", gauge, torque)
        self._observe_effort(torque)


    def _made_gauge(self, made: MadeForce, kind: str, zero: str | None) -> Gauge:
        (first, point1), (second, point2) = self._place(made.first), self._place(made.second)
        axis = (1.0, 0.0) if made.axis is None else _pair(made.axis)
        return Gauge(kind, first, second, point1, point2, axis, made.zero(zero, self.numbers))

    def _made_force(self, made: MadeForce) -> None:
        """Add the force along each marker quantity; the measure is that of the first."""
        index = len(self.efforts)
        for i, (kind, zero) in enumerate(made.row.gauges):
            number = self._gauge(f"{made.name} {i}", self._made_gauge(made, kind, zero))
            if made.law is not None:
                self._effort(made.name, "value", number, made)
                continue
            stiffness, damping = (made.paths(quantity)[i] for quantity in ("stiffness", "damping"))
            self.efforts.append(rows.Effort("spring", number, self.numbers(made, stiffness, made.values[stiffness]),
                                            self.numbers(made, damping, made.values[damping])))
        self.effort_of[made.name] = index
        self._observe_effort(made)


def _freedoms(joint: Joint) -> tuple[int, int]:
    """Numbers of coordinates with which the joint is the inboard joint of its first body, and of its second."""
    if joint.row.carrier == "turns":
        return tuple(int(body.turns) for body in joint.bodies)
    return (0, 0) if joint.row.carrier == "fixed" else (1, 1)


def _pair(vector: np.ndarray) -> tuple[float, float]:
    return float(vector[0]), float(vector[1])


def constraint_names(tables: Tables, core: MechanismCore) -> tuple[Variable, ...]:
    """Names and units of the constraints: the joint and its marker quantity, or the drive or coupling."""
    named = []
    for row in core.rows:
        if row.owner == "relation":
            named.append(Variable(tables.relation_names[row.index], ""))
            continue
        joint = tables.joints[row.index]
        if isinstance(joint, SpaceJoint):
            named.append(joint.row_named(row.component))
            continue
        rows = joint.row.rows
        gauge = rows[row.component].gauge
        unit = "rad" if gauge == "angle" else "m"
        named.append(Variable(joint.name if len(rows) == 1 else f"{joint.name}.{gauge}", unit))
    return tuple(named)
