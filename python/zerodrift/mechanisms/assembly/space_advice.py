"""Causes of failures of mechanisms in space: discs that lie flat, shafts at right angles, joints that leave no motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..._private.gateway.mechanisms.core import MechanismCore
from ..._private.rotations import rotation_of
from ..elements.bodies import Body
from ..elements.joints import Joint
from ..elements.space_joints import SpaceJoint, SpaceRolling
from ..equations.space_tables import SpaceTables

FLAT = 15.0             # degrees between the axle of a disc and the normal: below it, a failure is attributed to a flat disc
RIGHT_ANGLE = 10.0      # degrees from a right angle between shafts, at most
PARALLEL = 1e-4         # degrees, at most, between parallel axes
MEETS = 1e-6            # of the distance: deviation of an axis from a point that it passes through, at most
RANK = 1e-9             # of the largest singular value
LOCKED = "leave no body any motion, and yet rows follow from others"
MAX_ROWS = 300         # constraints, at most, for a singular value decomposition
SHAFTS = "revolute", "cylindrical"


def on_failure(tables: SpaceTables, core: MechanismCore, t: float, p: np.ndarray) -> str | None:
    """Known cause near the state in which a run has failed, or None."""
    R = _rotations(core, p)
    for joint in tables.joints:
        advice = _of_disc(tables, joint, R) if isinstance(joint, SpaceRolling) else (
            _of_shafts(tables, joint, R) if joint.kind == "universal" else None)
        if advice:
            return f"near t = {t:g} {advice}"
    return None


def _of_disc(tables: SpaceTables, joint: SpaceRolling, R: Sequence[np.ndarray]) -> str | None:
    if min(joint.semiaxes) > 0:
        return None
    row = tables.joint_rows[tables.joint_number[joint.name]]
    off = _between(R[row.first] @ row.frame1[0], R[row.second] @ row.frame2[0])
    if off > FLAT:
        return None
    return (f"disc {joint.second.body.name!r} of {joint.name!r} falls flat: its axle is {off:.3g} degrees off the normal, and a "
            "disc that lies flat does not roll. End the run before, as by an event")


def _of_shafts(tables: SpaceTables, joint: SpaceJoint, R: Sequence[np.ndarray], off: float = RIGHT_ANGLE) -> str | None:
    """Sentence on a universal joint that connects two shafts with bearings at nearly a right angle, or None."""
    axes, names = _shafts(tables, joint, R)
    if len(axes) < 2 or abs((apart := _between(*axes)) - 90) > off:
        return None
    return (f"the shafts of universal joint {joint.name!r} about the axes of {names[0]!r} and {names[1]!r} are {apart:.4g} "
            "degrees apart: at a right angle it hands no turning on")


def _shafts(tables: SpaceTables, joint: SpaceJoint, R: Sequence[np.ndarray]) -> tuple[list[np.ndarray], list[str]]:
    """Axes of the bearings in which the two bodies of a universal joint turn, and these bearings, as far as there are any."""
    axes, names = [], []
    for body in joint.bodies:
        shaft = _shaft(tables, body)
        if shaft is not None:
            row, side = tables.joint_rows[tables.joint_number[shaft.name]], shaft.bodies.index(body)
            axes.append(R[(row.first, row.second)[side]] @ (row.frame1, row.frame2)[side][0])
            names.append(shaft.name)
    return axes, names


def at_right_angles(tables: SpaceTables, core: MechanismCore, p: np.ndarray) -> list[str]:
    """Sentences on universal joints whose shafts are, and stay, at a right angle."""
    R = _rotations(core, p)
    advice = [_of_shafts(tables, joint, R, PARALLEL) for joint in _with_shafts(tables)]
    return [each for each in advice if each]


def flat_crosses(tables: SpaceTables, core: MechanismCore, p: np.ndarray) -> list[str]:
    """Sentence on each universal joint whose cross lies in the plane of both shafts, where its arms stay perpendicular."""
    R, advice = _rotations(core, p), []
    for joint in _with_shafts(tables):
        axes, names = _shafts(tables, joint, R)
        row = tables.joint_rows[tables.joint_number[joint.name]]
        across = np.cross(R[row.first] @ row.frame1[0], R[row.second] @ row.frame2[1])
        if all(90 - _between(across, axis) <= PARALLEL for axis in axes):
            advice.append(f"the cross of universal joint {joint.name!r} lies in the plane of its shafts, the axes of "
                        f"{names[0]!r} and {names[1]!r}")
    return advice


def of_angles(tables: SpaceTables, core: MechanismCore, p: np.ndarray, names: Sequence[str]) -> str:
    """Sentence on universal joints whose angles cannot be met: the angle that bearings keep between the shafts; or ""."""
    R, advice = _rotations(core, p), []
    for joint in _with_shafts(tables):
        if {f"{joint.name}.angle1", f"{joint.name}.angle2"} & set(names):
            axes, bearings = _shafts(tables, joint, R)
            advice.append(f"; the shafts of universal joint {joint.name!r} stay {_between(*axes):.4g} degrees apart in "
                        f"{bearings[0]!r} and {bearings[1]!r}, which limits its angles")
    return "".join(advice)


def _with_shafts(tables: SpaceTables) -> list[SpaceJoint]:
    """Universal joints between two shafts whose axes meet at its centre and whose bearings belong to the same body."""
    found = []
    for joint in tables.joints:
        shafts = [_shaft(tables, body) for body in joint.bodies] if joint.kind == "universal" else [None]
        if all(shaft is not None and _passes_through(shaft, joint, body)
               for shaft, body in zip(shafts, joint.bodies, strict=False)):
            holding = {other for shaft in shafts if shaft for other in shaft.bodies if other not in joint.bodies}
            found += [joint] if len(holding) == 1 else []
    return found


def _shaft(tables: SpaceTables, body: Body) -> SpaceJoint | None:
    """Bearing in which a body turns about an axis, or None."""
    return next((joint for joint in tables.joints if joint.kind in SHAFTS and body in joint.bodies), None)


def _passes_through(shaft: SpaceJoint, joint: SpaceJoint, body: Body) -> bool:
    """True if the axis of the bearing passes through the joint, in the drawing of the body that both share."""
    places = [(each.first, each.second)[each.bodies.index(body)].drawn for each in (shaft, joint)]
    way = places[1] - places[0]
    return bool(np.linalg.norm(np.cross(shaft.axis_as_drawn(), way)) <= MEETS * max(float(np.linalg.norm(way)), 1e-300))


def _rotations(core: MechanismCore, p: np.ndarray) -> list[np.ndarray]:
    """Rotations (3, 3) of the ground and the bodies."""
    return [np.eye(3), *rotation_of(core.poses(p)[0][:, 3:])]


def at_start(tables: SpaceTables, core: MechanismCore, t: float, p: np.ndarray, name: str) -> str | None:
    """Sentence on joints that leave no motion, with the axes that may cause it; None if they leave some."""
    if core.m > MAX_ROWS:
        return None
    C = core.evaluate(t, p, np.zeros(core.nv))["C"]
    s = np.linalg.svd(C / np.maximum(np.linalg.norm(C, axis=1, keepdims=True), 1e-300), compute_uv=False)
    if np.count_nonzero(s > RANK * s[0]) < core.nv:
        return None
    return locked(tables, name) or f"the joints of {name!r} {LOCKED}"


def locked(tables: SpaceTables, name: str) -> str | None:
    """Sentence on axes that may prevent any motion; None if the axes of all hinges are parallel."""
    hinges = [joint for joint in tables.joints if joint.kind == "revolute"]
    off = _off_most(hinges) if hinges else []
    skew = ", ".join(f"{hinge.name!r} {angle:.3g} degrees off"
                     for hinge, angle in zip(hinges, off, strict=True) if angle > PARALLEL)
    if not skew:
        return None
    true = next(hinge.name for hinge, angle in zip(hinges, off, strict=True) if angle <= PARALLEL)
    return (f"the joints of {name!r} {LOCKED}: hinges of a loop in a plane need parallel axes, and there is {skew} "
            f"that of {true!r}")


def _off_most(hinges: Sequence[Joint]) -> list[float]:
    """Angle of each hinge's axis from the direction that most axes share, in degrees."""
    axes = [hinge.axis_as_drawn() for hinge in hinges]
    angles = [[_between(axis, other) for other in axes] for axis in axes]
    return max(angles, key=lambda each: sum(angle <= PARALLEL for angle in each))


def _between(a: np.ndarray, b: np.ndarray) -> float:
    """Angle between two lines in degrees, from 0 to 90."""
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), abs(a @ b))))
