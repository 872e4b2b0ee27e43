"""What a mechanism in space knows of errors that the core tells in numbers.

It is about discs that lie flat, shafts at right angles, and joints that leave no motion.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .._gateway.space import SpaceCore
from .._rotations import rotation_of
from .joints import Joint
from .space_joints import SpaceJoint, SpaceRolling
from .space_tables import SpaceTables

FLAT = 15.0             # degrees between the axle of a disc and the normal: how near to lying flat a run may have failed by that
RIGHT_ANGLE = 10.0      # degrees that shafts are off one
PARALLEL = 1e-4         # degrees
RANK = 1e-9             # of the largest singular value
MOST_ROWS = 300         # whose singular values take a moment
SHAFTS = "revolute", "cylindrical"


def on_failure(tables: SpaceTables, core: SpaceCore, t: float, p: np.ndarray) -> str | None:
    """What stands in the way near the state in which a run has failed; None: nothing that is known here."""
    poses = core.poses(p)[0]
    R = [np.eye(3), *rotation_of(poses[:, 3:])]
    for joint in tables.joints:
        told = _of_disc(tables, joint, R) if isinstance(joint, SpaceRolling) else (
            _of_shafts(tables, joint, R) if joint.kind == "universal" else None)
        if told:
            return f"near t = {t:g} {told}"
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


def _of_shafts(tables: SpaceTables, joint: SpaceJoint, R: Sequence[np.ndarray]) -> str | None:
    """Of a universal joint whose two bodies each turn about an axis of their own."""
    axes, names = [], []
    for body in joint.bodies:
        shaft = next((other for other in tables.joints if other.kind in SHAFTS and body in other.bodies), None)
        if shaft is None:
            return None
        row, side = tables.joint_rows[tables.joint_number[shaft.name]], shaft.bodies.index(body)
        axes.append(R[(row.first, row.second)[side]] @ (row.frame1, row.frame2)[side][0])
        names.append(shaft.name)
    apart = _between(*axes)
    if abs(apart - 90) > RIGHT_ANGLE:
        return None
    return (f"the shafts of universal joint {joint.name!r} about the axes of {names[0]!r} and {names[1]!r} are {apart:.4g} "
            "degrees apart: at a right angle it hands no turning on")


def at_start(tables: SpaceTables, core: SpaceCore, t: float, p: np.ndarray, name: str) -> str | None:
    """Whether the joints leave no motion at all, and which axes may be why; None: they leave some."""
    if core.m > MOST_ROWS:
        return None
    C = core.evaluate(t, p, np.zeros(core.nv))["C"]
    s = np.linalg.svd(C / np.maximum(np.linalg.norm(C, axis=1, keepdims=True), 1e-300), compute_uv=False)
    if np.count_nonzero(s > RANK * s[0]) < core.nv:
        return None
    told = f"the joints of {name!r} leave no body any motion, and yet rows follow from others"
    hinges = [joint for joint in tables.joints if joint.kind == "revolute"]
    if not hinges:
        return told
    off = _off_most(hinges)
    skew = ", ".join(f"{hinge.name!r} {angle:.3g} degrees off"
                     for hinge, angle in zip(hinges, off, strict=True) if angle > PARALLEL)
    if not skew:
        return told
    true = next(hinge.name for hinge, angle in zip(hinges, off, strict=True) if angle <= PARALLEL)
    return f"{told}: hinges of a loop in a plane need parallel axes, and there is {skew} that of {true!r}"


def _off_most(hinges: Sequence[Joint]) -> list[float]:
    """How many degrees the axis of each hinge is off that to which most are parallel."""
    axes = [hinge.axis_as_drawn() for hinge in hinges]
    angles = [[_between(axis, other) for other in axes] for axis in axes]
    return max(angles, key=lambda each: sum(angle <= PARALLEL for angle in each))


def _between(a: np.ndarray, b: np.ndarray) -> float:
    """Degrees between two lines, from 0 to 90."""
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), abs(a @ b))))
