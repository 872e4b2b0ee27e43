"""Reference motion of start velocities: that of bodies which drives move or carry.

A drive that moves while all others stand still determines the velocities of some bodies. Connected bodies that it leaves
undetermined, a group, move rigidly with one of these if no constraint prevents it: that body carries them. If the drive moves no
body to which the group is connected, the group translates with the driven point. Motions of several drives add up.

Elements between two bodies never prevent a rigid motion of both, nor do guides in the plane of a motion. A constraint may allow a
motion in one pose by accident; therefore it must allow it in a nearby pose, too.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..._private.rotations import AXES, rotation_of
from .assembly import RANK, Assembly, nullspace
from .nudge import nudged

COMPATIBLE = 1e-7       # of the largest velocity: rate at which a constraint is not violated


class Pose(NamedTuple):
    """Constraints (m, nv), rigid motions (nv, 6) of all bodies by their twist, and velocities (nv,) that a drive prescribes.

    Velocities are in parts of the length and in rad. Twists (6,) are the velocity of the origin and the angular velocity.
    """

    rows: np.ndarray
    rigid: np.ndarray
    x: np.ndarray

    def rigid_with(self, body: np.ndarray) -> np.ndarray:
        """Motion (nv,) of all bodies with the one of these coordinates; with a particle they translate."""
        turns = not self.rigid[body, :3].any(axis=1).all()
        return self._rigid(self.rigid[body], self.x[body], turns=turns)

    def translation(self, group: np.ndarray) -> np.ndarray:
        """Translation (nv,) of all bodies that meets the constraints of a group, by least squares."""
        rows = self.rows[:, group]
        return self._rigid(rows @ self.rigid[group], rows @ self.x[group], turns=False)

    def allows(self, group: np.ndarray, motion: np.ndarray) -> bool:
        """True if a group can move like this while the other bodies move as the drive prescribes."""
        left = self.rows[:, group] @ (motion - self.x)[group]
        return bool(np.abs(left).max(initial=0.0) <= COMPATIBLE * np.abs(self.x).max())

    def _rigid(self, rows: np.ndarray, right: np.ndarray, *, turns: bool) -> np.ndarray:
        count = 6 if turns else 3
        return self.rigid[:, :count] @ np.linalg.lstsq(rows[:, :count], right, rcond=RANK)[0]


def motion_of_drives(assembly: Assembly, p: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Velocities (nv,) of all bodies that drives move or carry; v (nv,) satisfies all constraints."""
    rows = assembly.scaled_rows(p)
    drives = list(_drives(assembly, rows, v / assembly.scale))
    near = nudged(assembly, p, {int(i) for each in drives for i in np.flatnonzero(each)})
    places = [(rows, rigid_motions(assembly, p)), (assembly.scaled_rows(near), rigid_motions(assembly, near))]
    bodies = np.array([body for body, _ in assembly.core.motions])
    is_free = np.abs(nullspace(rows)).max(axis=1, initial=0.0) > RANK
    led, free = set(bodies) - set(bodies[is_free]), np.isin(bodies, bodies[is_free])
    groups, found = list(_groups(rows, bodies, free)), np.zeros(len(v))
    for rates in drives:
        poses = [Pose(*each, np.linalg.lstsq(each[0], rates, rcond=RANK)[0]) for each in places]
        found[~free] += poses[0].x[~free]
        for group in groups:
            touched = set(bodies[rows[rows[:, group].any(axis=1)].any(axis=0)])
            found[group] += _carried(poses, group, [bodies == body for body in sorted(led & touched)])[group]
    return found * assembly.scale


def _carried(poses: list[Pose], group: np.ndarray, beside: list[np.ndarray]) -> np.ndarray:
    """Motion (nv,) of all bodies in which a group follows one of the bodies beside it, or translates; else zeros."""
    here, still = poses[0], COMPATIBLE * np.abs(poses[0].x).max()
    moving = [body for body in beside if np.abs(here.x[body]).max() > still]
    ways = [[pose.rigid_with(body) for pose in poses] for body in moving] or [[pose.translation(group) for pose in poses]]
    able = [way[0] for way in ways if all(pose.allows(group, each) for pose, each in zip(poses, way, strict=True))]
    is_one = able and all(np.abs((each - able[0])[group]).max() <= still for each in able)
    return able[0] if is_one else np.zeros(len(here.x))


def _drives(assembly: Assembly, rows: np.ndarray, x: np.ndarray) -> list[np.ndarray]:
    """Rates (m,) of the constraints that each drive prescribes; of all at once where one cannot move alone."""
    rates = rows @ x
    names = np.array(assembly.rows)
    moving = dict.fromkeys(names[np.abs(rates) > COMPATIBLE * np.abs(x).max()])
    alone = [np.where(names == name, rates, 0.0) for name in moving]
    is_able = all(np.abs(rows @ np.linalg.lstsq(rows, each, rcond=RANK)[0] - each).max() <= COMPATIBLE * np.abs(each).max()
                  for each in alone)
    return alone if is_able else [rates]


def _groups(rows: np.ndarray, bodies: np.ndarray, free: np.ndarray) -> Iterator[np.ndarray]:
    """Coordinates of undetermined bodies that constraints connect with each other."""
    left = free
    while left.any():
        group, grown = np.zeros_like(left), bodies == bodies[left][0]
        while (grown != group).any():
            group = grown
            touched = rows[rows[:, group].any(axis=1)].any(axis=0)
            grown = group | free & np.isin(bodies, bodies[touched])
        yield group
        left = left & ~group


def rigid_motions(assembly: Assembly, p: np.ndarray) -> np.ndarray:
    """Velocities (nv, 6) of all bodies, in parts of the length and in rad, by the twist of which they all are part."""
    place, axes, about = _poses(*assembly.core.poses(p))
    place = (place - place.mean(axis=0)) / assembly.length
    rows = np.zeros((assembly.core.nv, 6))
    for row, (body, kind) in zip(rows, assembly.core.motions, strict=True):
        if kind == "angle":
            row[3:] = axes[body - 1][:, about[body - 1].pop(0)]
        else:
            row[AXES.index(kind)] = 1.0
            row[3:] = np.cross(place[body - 1], row[:3])
    return rows


def _poses(poses: np.ndarray, _: np.ndarray) -> tuple[np.ndarray, np.ndarray, list[list[int]]]:
    """Places (bodies, 3) of mass centres, axes (bodies, 3, 3), and numbers of those about which coordinates turn each body."""
    if poses.shape[1] == 7:
        return poses[:, :3], rotation_of(poses[:, 3:]), [[0, 1, 2] for _ in poses]
    place = np.pad(poses[:, :2], [(0, 0), (0, 1)])
    return place, np.tile(np.eye(3), (len(poses), 1, 1)), [[2] for _ in poses]
