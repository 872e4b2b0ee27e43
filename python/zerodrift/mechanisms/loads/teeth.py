"""Forces between the teeth of a gear, on each wheel from the pitch point, in the axes of the body on which both wheels turn.

Wheels turn by phi_1 and phi_2 = rho phi_1 on their carrier, about axes a_i through O_i. They roll on one another at the pitch
point P, where a_1 x (P - O_1) = rho a_2 x (P - O_2). The tangential force F t acts on the second wheel at P, and its opposite on
the first; with t along a_2 x (P - O_2) and F = torque / |a_2 x (P - O_2)| their moments about the axes are those of the coupling.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ..._private.gateway.mechanisms.element_tables import GeneralizedForce, OutputSpec
from ...errors import WrongValue
from ..elements.bodies import Body, Point
from ..elements.joints import Coupling, Joint
from ..elements.numbers import Numbers

PARALLEL = 1e-9         # sine of the angle between axes, and distance of axes relative to a radius, at most
NORMAL = np.array([0.0, 0.0, 1.0])      # of the plane


class Wrench(NamedTuple):
    """Force and moment (3,) about a wheel's bearing for a unit torque of the coupling, in the carrier's axes."""

    force: np.ndarray
    moment: np.ndarray


class Bearing(NamedTuple):
    """A wheel's joint: its points, the position O and the axis (3,) in the carrier's axes, and the axis in the wheel's.

    The angle of the joint is `sign` times that of the wheel on the carrier.
    """

    joint: Joint
    on_carrier: Point
    on_wheel: Point
    at: np.ndarray
    axis: np.ndarray
    axis_on_wheel: np.ndarray
    sign: int


class Side(NamedTuple):
    """A wheel with the action of the teeth on it for a torque of 1 N m, and of its bearing against the separating force."""

    joint: Joint
    on_carrier: Point
    on_wheel: Point
    axis: np.ndarray
    axis_on_wheel: np.ndarray
    tooth: Wrench
    separation: Wrench


class Mesh(NamedTuple):
    """Both wheels, and the tangential force for a torque of 1 N m, in 1/m."""

    sides: tuple[Side, Side]
    tangential: float


def act(tables: Any, coupling: Coupling, ratio: Any, quantities: list[int]) -> list[Any]:
    """Coefficients of the constraint of a gear or a rack; `quantities` has the measures that it couples.

    With teeth it acts at the pitch point: quantities that the bearings of the wheels keep at zero are added. The separating
    forces and the measure of the tangential force are added to the tables.
    """
    coefficients = [-ratio, 1.0]
    if not coupling.teeth:
        return coefficients
    found, row, name = mesh(coupling, tables.drawing.elements, ratio, tables.numbers), len(tables.relations), coupling.name
    for side in found.sides:
        for i, (size, quantity) in enumerate(tables._mesh_quantities(side, side.tooth)):
            quantities.append(tables._quantity(f"{name} {side.joint.name} tooth {i}", quantity))
            coefficients.append(size)
        for i, (size, quantity) in enumerate(tables._mesh_quantities(side, side.separation)):
            number = tables._quantity(f"{name} {side.joint.name} separation {i}", quantity)
            tables.forces.append(GeneralizedForce("separation", number, size, relation=row,
                                                  joint=tables.joint_number[side.joint.name]))
    tables.observed.append(OutputSpec(f"{name}.tooth_force", "N", "drive", row, 1, found.tangential, len(quantities)))
    return coefficients


def mesh(coupling: Coupling, elements: Mapping[str, Any], ratio: float, numbers: Numbers) -> Mesh:
    """Actions of the teeth of a gear on its wheels.

    Raises
    ------
    ValueError
        If the wheels do not turn on one body, or no pitch point follows from their axes.
    """
    assert coupling.teeth
    pressure, helix, radius = coupling.teeth
    joints = [elements[measure.rpartition(".")[0]] for measure in coupling.of]
    carrier = _carrier(coupling, joints)
    one, other = (_bearing(joint, carrier, numbers) for joint in joints)
    rho = float(ratio) * one.sign * other.sign
    if np.linalg.norm(np.cross(one.axis, other.axis)) <= PARALLEL:
        rho *= float(np.sign(one.axis @ other.axis))
        P, along, is_ring = _on_cylinders(coupling, one, other, rho), one.axis, 0 < rho < 1
    else:
        P, along, is_ring = *_on_cones(coupling, one, other, rho, radius), False
    arm = P - other.at - (P - other.at) @ other.axis * other.axis
    size = float(np.linalg.norm(arm))
    t = np.cross(other.axis, arm) / size
    inward = np.cross(t, along)
    inward = inward * -np.sign(inward @ arm) / size
    push = np.tan(pressure) * (-inward if is_ring else inward)
    slope = np.tan(helix) * np.sign(t @ np.cross(one.axis, other.at - one.at))
    pull = other.sign * (t + slope * along) / size
    return Mesh((_side(one, -pull, -push, P), _side(other, pull, push, P)), 1 / size)


def _side(of: Bearing, tooth: np.ndarray, push: np.ndarray, P: np.ndarray) -> Side:
    tooth_wrench, separation = (Wrench(force, np.cross(P - of.at, force)) for force in (tooth, -push))
    return Side(of.joint, of.on_carrier, of.on_wheel, of.axis, of.axis_on_wheel, tooth_wrench, separation)


def _carrier(coupling: Coupling, joints: list[Any]) -> Body:
    """Body on which both wheels turn."""
    common = [body for body in joints[0].bodies if body in joints[1].bodies]
    if len(common) != 1:
        raise WrongValue(f"teeth of gear {coupling.name!r} need one body on which both wheels turn, and {joints[0].name!r} and "
                         f"{joints[1].name!r} have {'two' if common else 'none'} in common: couple joints of the carrier",
                         "wrong-element")
    return common[0]


def _bearing(joint: Any, carrier: Body, numbers: Numbers) -> Bearing:
    is_first = joint.bodies[0] is carrier
    points = (joint.first, joint.second) if is_first else (joint.second, joint.first)
    axes = [NORMAL, NORMAL] if joint.dimension == 2 else [frame[0] for frame in joint.frames]
    local = [float(each) for each in points[0].local_with(numbers)]
    at = np.array([*local, 0.0][:3])
    axis, axis_on_wheel = axes if is_first else axes[::-1]
    return Bearing(joint, points[0], points[1], at, axis, axis_on_wheel, 1 if is_first else -1)


def _on_cylinders(coupling: Coupling, one: Bearing, other: Bearing, rho: float) -> np.ndarray:
    """P (3,) of parallel axes, halfway between the bearings along them."""
    between = other.at - one.at
    along = (between @ one.axis) * one.axis
    if np.linalg.norm(between - along) <= PARALLEL * np.linalg.norm(between) or rho == 1:
        raise WrongValue(f"teeth of gear {coupling.name!r} need axes at a distance, and wheels of two radii if one is in the "
                         "other", "geometry")
    return one.at + along / 2 + rho / (rho - 1) * (between - along)


def _on_cones(coupling: Coupling, one: Bearing, other: Bearing, rho: float,
              radius: float | None) -> tuple[np.ndarray, np.ndarray]:
    """P (3,) of axes that intersect, at the radius of the second wheel, and its direction (3,) from their intersection."""
    between, normal = other.at - one.at, np.cross(one.axis, other.axis)
    if radius is None:
        raise WrongValue(f"radius of gear {coupling.name!r} must be given where axes intersect: the pitch radius of the second "
                         "wheel, in the middle of its teeth", "missing-argument")
    if abs(between @ normal) > PARALLEL * radius:
        raise WrongValue(f"teeth of gear {coupling.name!r} need axes that are parallel or intersect", "geometry")
    apex = one.at + np.cross(between, other.axis) @ normal / (normal @ normal) * one.axis
    line = one.axis - rho * other.axis
    line = line / np.linalg.norm(np.cross(other.axis, line))
    side = float(line @ (one.at + other.at - 2 * apex))
    if abs(side) <= PARALLEL * radius:
        raise WrongValue(f"joints of gear {coupling.name!r} must be drawn beside the point where their axes intersect, on the "
                         "side of the teeth", "geometry")
    line = line if side > 0 else -line
    return apex + radius * line, line / np.linalg.norm(line)
