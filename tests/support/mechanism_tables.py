"""Mechanisms as tables of the core, without `zd.Mechanism`: systems from tables, and random ones at consistent states."""

from dataclasses import dataclass

import numpy as np

from zerodrift._private.gateway import Variable
from zerodrift._private.gateway.mechanisms.plane import (
    Body,
    GeneralizedForce,
    Joint,
    OutputSpec,
    PlaneCore,
    Quantity,
    Relation,
    Tables,
    joint_kinds,
)
from zerodrift.systems.base import BaseSystem

KINDS = joint_kinds()
TREE = [name for name, kind in KINDS.items() if kind.inboard]
UNITS = {"x": "m", "y": "m", "angle": "rad", "displacement": "m"}


class Tabled(BaseSystem):
    """The system of tables."""

    def __init__(self, tables, p0=None, v0=None, law=None, **options):
        self._core = core = PlaneCore(tables, law, **options)
        self.name, self.parameters, self.p0, self.v0 = "mechanism", {}, p0, v0
        self.coordinates = tuple(Variable(f"{kind}{body}", UNITS[kind]) for body, kind in core.motions)
        self.velocities = tuple(Variable(f"{name}_dot", f"{unit}/s") for name, unit in self.coordinates)
        self.constraints = tuple(Variable(f"{row.owner}{row.number}.{row.component}", "") for row in core.rows)

    def measured(self, name, t, p, v, vdot=None, multipliers=None):
        """A measure at one state."""
        index = [measure.name for measure in self._core.measures].index(name)
        rows = [None if array is None else np.array(array, dtype=float)[None] for array in (p, v, vdot, multipliers)]
        return self._core.measure(index, np.array([float(t)]), *rows)[0]


def kind(name):
    return KINDS[name].number


def rotation(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def free(tables):
    """The same mechanism in absolute coordinates."""
    return tables._replace(bodies=[body._replace(inboard=-1) for body in tables.bodies])


def in_absolute_coordinates(system, law=None, **options):
    """The same mechanism and its start in absolute coordinates."""
    poses, rates = system._core.poses(system.p0, system.v0)
    other = Tabled(free(system._core.tables), law=law, **options)
    other.p0, other.v0 = other._core.state(poses, rates)
    return other


# ---- measures ----


def joint_measures(joints):
    return [OutputSpec(f"{j}.{what}", unit, f"joint {what}", j) for j in range(len(joints))
            for what, unit in (("force", "N"), ("torque", "N m"))]


def pose_quantities(bodies):
    """Three marker quantities of each body: x, y and angle of its mass centre."""
    return [Quantity(which, 0, b) for b in range(1, len(bodies) + 1) for which in ("x", "y", "angle")]


def pose_measures(bodies):
    return [OutputSpec(f"accelerations{b}", "", "accelerations", 3 * b, 3) for b in range(len(bodies))]


# ---- random mechanisms ----


@dataclass
class Drawing:
    """Reference configuration: poses (x, y, angle) of the mass centres; pose 0 is the ground's."""

    poses: list

    def local(self, body, point):
        """A drawn point in a body's axes, from its mass centre."""
        x, y, angle = self.poses[body]
        return tuple(rotation(angle).T @ (np.asarray(point) - (x, y)))

    def turned(self, body, axis):
        return tuple(rotation(self.poses[body][2]).T @ axis)

    def joint(self, name, first, second, point, rng):
        """A joint as drawn at a point of the second body; that of the first lies somewhere else on the axis, where it may."""
        angle = rng.uniform(0, 2 * np.pi)
        axis = np.array([np.cos(angle), np.sin(angle)])
        apart = rng.uniform(-1, 1) * axis if KINDS[name].takes_axis else np.zeros(2)
        along, across, length = -apart @ axis, 0.0, 0.0
        start = np.asarray(point) + apart
        if name in ("slot", "prismatic"):
            across = rng.uniform(-0.3, 0.3)
            start = start - across * np.array([-axis[1], axis[0]])
            along += rng.uniform(-0.2, 0.2)
        if name == "rod":
            start = start + rng.uniform(0.2, 1, 2)
            length = float(np.linalg.norm(start - point))
        if name == "rolling":
            length = rng.uniform(0.2, 0.5)
            start = start - length * np.array([-axis[1], axis[0]])
        drawn = self.poses[second][2] - self.poses[first][2]
        if name == "rolling":       # the contact as drawn: displacement and angle are both zero
            along = float((np.asarray(point) - start) @ axis)
        return Joint(kind(name), first, second, self.local(first, start), self.local(second, point), self.turned(first, axis),
                     float(along), float(across), float(drawn), length)


def random_tree(rng, bodies, names=TREE, particles=True):
    """Bodies, joints and drawing of a random tree; the first one hangs on the ground or is free."""
    drawing, table, joints = Drawing([(0.0, 0.0, 0.0)]), [], []
    for b in range(1, bodies + 1):
        drawing.poses.append(tuple(rng.uniform(-1, 1, 3)))
        inner = int(rng.choice([i for i in range(b) if i == 0 or not table[i - 1].is_particle]))
        name = str(rng.choice(names))
        is_particle = bool(particles and name == "revolute" and rng.random() < 0.3)
        if rng.random() < 0.15:
            table.append(Body(rng.uniform(1, 3), 0.0 if is_particle else rng.uniform(0.2, 1), is_particle))
        else:
            ends = (inner, b) if rng.random() < 0.5 else (b, inner)
            point = drawing.poses[b][:2] if is_particle else rng.uniform(-1, 1, 2)
            joints.append(drawing.joint(name, *ends, point, rng))
            table.append(Body(rng.uniform(1, 3), 0.0 if is_particle else rng.uniform(0.2, 1), is_particle, len(joints) - 1))
        if is_particle:
            drawing.poses[b] = (*drawing.poses[b][:2], 0.0)
    return table, joints, drawing


def random_springs(rng, table, damped=True):
    """Marker quantities of all kinds between random bodies, and a spring along each, with dampers and a force if `damped`."""
    quantities, forces = [], []
    solid = [0, *(b for b, body in enumerate(table, 1) if not body.is_particle)]
    for which in ("x", "y", "angle", "along", "across", "distance"):
        first, second = rng.choice(solid, 2)
        angle = rng.uniform(0, 6)
        quantities.append(Quantity(which, int(first), int(second), tuple(rng.uniform(2, 3, 2)), tuple(rng.uniform(-1, 1, 2)),
                            (np.cos(angle), np.sin(angle)), rng.uniform(-1, 1)))
        forces.append(GeneralizedForce("spring", len(quantities) - 1, rng.uniform(1, 5), damped * rng.uniform(0, 1)))
    if not damped:
        return quantities, forces
    first, second = int(rng.choice(solid)), int(rng.choice(solid[1:] or [0]))
    quantities.append(Quantity("glide", first, second, axis=(0.6, 0.8), point2=(0.3, -0.2)))
    forces.append(GeneralizedForce("constant", len(quantities) - 1, value=rng.uniform(-5, 5)))
    return quantities, forces


def random_mechanism(seed, bodies=5, loops=0, damped=True, names=TREE):
    """A system at a start that satisfies it, with measures of all joints and accelerations of all bodies."""
    rng = np.random.default_rng(seed)
    table, joints, drawing = random_tree(rng, bodies, names)
    quantities = pose_quantities(table)
    solid = [0, *(b for b, body in enumerate(table, 1) if not body.is_particle)]
    more, forces = random_springs(rng, table, damped)
    forces = [force._replace(quantity=force.quantity + len(quantities)) for force in forces]
    quantities += more
    for _ in range(loops if len(solid) > 2 else 0):
        first, second = rng.choice(solid, 2, replace=False)
        if second == 0:
            first, second = second, first
        name = str(rng.choice(["revolute", "rod", "slot", "rolling", "prismatic"]))
        joints.append(drawing.joint(name, int(first), int(second), rng.uniform(-1, 1, 2), rng))
    measures = joint_measures(joints) + pose_measures(table)
    tables = Tables(table, joints, quantities, (), forces, measures, tuple(rng.uniform(-9, 9, 2)))
    system = Tabled(tables)
    system.p0, _ = system._core.state(np.array(drawing.poses[1:]))
    v = rng.normal(size=system.nv)
    C = system.evaluate(system.p0, v).C if system.m else np.zeros((0, system.nv))
    system.v0 = v - np.linalg.pinv(C) @ (C @ v)
    return system


def determined(system):
    """True if the constraints of a system in absolute coordinates are independent and leave some freedom."""
    C = system.evaluate().C
    return C is None or (len(C) < system.nv and np.linalg.svd(C)[1].min() > 0.02)


__all__ = ["Body", "GeneralizedForce", "Joint", "OutputSpec", "Quantity", "Relation", "Tables"]
