"""Mechanisms in space in joint coordinates."""

from __future__ import annotations

import numpy as np

from ...core import lib
from ...rotations import quaternion_of, rotation_of
from ..base import doubles
from ..measures import given
from .space import SpaceCore

POSE, TWIST = 12, 6     # doubles of a body as the core tells it


class SpaceTreeCore(SpaceCore):
    """The core's system of a mechanism in space whose bodies are carried by joints; as `SpaceCore`."""

    made_by = lib.zd_space_tree_create

    def poses(self, p: np.ndarray, v: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray | None]:
        """Poses (bodies, 7) of the mass centres, place and unit quaternion, and where v is given their rates (bodies, 6): the
        velocity in the drawing's axes, and the angular velocity in the body's own.
        """
        count, scratch = len(self.tables.bodies), np.zeros(max(1, lib.zd_space_system(self._mechanism).scratch))
        frames, twists = np.zeros((count, POSE)), None if v is None else np.zeros((count, TWIST))
        lib.zd_space_tree_poses(self._mechanism, doubles(p, self.nq), given(v, self.nv), given(frames, frames.size),
                                given(twists, count * TWIST), doubles(scratch, scratch.size, writable=True))
        R = frames[:, 3:].reshape(-1, 3, 3).transpose(0, 2, 1)        # the core returns axes one after another; they are columns
        poses = np.array([[*each[:3], *quaternion_of(turned)] for each, turned in zip(frames, R, strict=True)]).reshape(-1, 7)
        if twists is not None:
            twists[:, 3:] = np.einsum("kji,kj->ki", R, twists[:, 3:])
        return poses, twists

    def state(self, poses: np.ndarray, rates: np.ndarray | None = None,
              angles: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
        """(p, v) from poses and rates as `poses` returns them, with the joint angles nearest to `angles`, if given. Components
        that tree joints do not allow are ignored.
        """
        R, p, v = rotation_of(poses[:, 3:]), np.zeros(self.nq), np.zeros(self.nv)
        frames = np.ascontiguousarray(np.hstack([poses[:, :3], R.transpose(0, 2, 1).reshape(-1, 9)]))
        twists = None
        if rates is not None:
            twists = np.hstack([rates[:, :3], np.einsum("kij,kj->ki", R, rates[:, 3:])])
        lib.zd_space_tree_state(self._mechanism, doubles(frames, frames.size), given(twists, len(frames) * TWIST),
                                doubles(p, p.size, writable=True), doubles(v, v.size, writable=True))
        if angles is not None:
            p[self._angle_at] += 2 * np.pi * np.round((angles - p[self._angle_at]) / (2 * np.pi))
        return p, v
