"""Mechanism in space in a pose: positions of its points, for `arrows`."""

from __future__ import annotations

import numpy as np

from ..._private.rotations import rotation_of
from ..elements.bodies import Body, Point
from ..elements.contacts import PlaneContact, SphereContact
from ..elements.drawing import Drawing
from ..elements.numbers import Numbers
from ..elements.space_bodies import SpaceInertias
from ..elements.space_joints import SpaceRolling


class SpacePosed:
    """Mechanism with its mass centres at poses (bodies, 7), with principal axes."""

    def __init__(self, drawing: Drawing, numbers: Numbers, inertias: SpaceInertias, poses: np.ndarray) -> None:
        self._numbers, self._inertias = numbers, inertias
        self._at = {"ground": (np.zeros(3), np.eye(3))}
        for body, pose in zip(drawing.parts(), poses, strict=True):
            self._at[body.name] = pose[:3], rotation_of(pose[3:])

    def at(self, point: Point) -> np.ndarray:
        """Position of a point, (3,)."""
        centre, R = self._at[point.body.name]
        return centre + R @ np.asarray(self._inertias.local(point, self._numbers))

    def direction(self, body: Body, local: np.ndarray) -> np.ndarray:
        """Direction (3,) in the drawing, from one in a body's axes."""
        return self._at[body.name][1] @ np.asarray(self._inertias.direction(body, local))

    def contact(self, joint: SpaceRolling | PlaneContact | SphereContact) -> np.ndarray:
        """Contact point of a round body, (3,): with a plane the point of its ellipsoid farthest along the reversed normal."""
        if isinstance(joint, SphereContact):
            apart = self.at(joint.second) - self.at(joint.first)
            return self.at(joint.second) - joint.length_with(self._numbers) * apart / np.linalg.norm(apart)
        normal = self.direction(joint.bodies[0], joint.frames[0][0])
        axes = np.array([self.direction(joint.bodies[1], row) for row in joint.frames[1]])
        scaled = axes * np.array(joint.semiaxes_with(self._numbers))[:, None]
        shaped = scaled.T @ (scaled @ normal)
        reach = np.sqrt(normal @ shaped)
        return self.at(joint.second) - (shaped / reach if reach else 0.0)
