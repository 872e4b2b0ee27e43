"""Check that the forces of all elements have directions at the start of a mechanism."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..._private.rotations import rotation_of
from ...errors import WrongValue
from ..elements.forces import Actuator
from ..elements.frames import turned
from ..elements.table_forces import TableForce, is_between_points, paths
from ..equations.tables import Tables

COINCIDENT = 1e-12      # of the mechanism's size: bound below which points coincide up to rounding
HALF_TURN = 1e-6        # rad: distance from half a turn at which rounding of a start decides on the direction


def check_directions(tables: Tables, poses: np.ndarray, size: float) -> None:
    """Raise `WrongValue` for a spring or an actuator between coincident points, and a bushing in space at half a turn.

    `poses` (bodies, 3), in space (bodies, 7), are those of mass centres, as of `Starting.at`; `size` in m is the mechanism's.
    A spring between coincident points has no force if its free length is zero and it has no damping.
    """
    for element in (*tables.drawing.of(Actuator), *tables.drawing.of(TableForce)):
        if isinstance(element, Actuator) or is_between_points(element.row):
            apart, length, damping = _apart(tables, element, poses)
            if apart <= COINCIDENT * size and (element.law or length > COINCIDENT * size or damping):
                or_slack, otherwise = ("", "") if element.law else (
                    ", unless its length and its damping are 0", "; a bushing has stiffness and damping in each direction there")
                raise WrongValue(f"the points of {element.kind} {element.name!r} must be apart at the start{or_slack}: its force "
                                 f"has no direction where they coincide{otherwise}", "geometry")
        elif any(each.kind == "rotation" for each in element.quantities) and _is_half_turned(tables, element, poses):
            raise WrongValue(f"{element.kind} {element.name!r} must be turned by less than half a turn at the start: there its "
                             "torque has two directions", "geometry")


def _apart(tables: Tables, element: Any, poses: np.ndarray) -> tuple[float, float, float]:
    """Distance of the points of an element in m, its free length and its damping; zero where it has a law."""
    quantity = tables.length_quantity(element)
    first, second = (_place(poses, *each) for each in ((quantity.first, quantity.point1), (quantity.second, quantity.point2)))
    apart = float(np.linalg.norm(second - first))
    if element.law:
        return apart, 0.0, 0.0
    stiffness, damping = (tables.numbers(element, path, element.values[path]) for path in paths(element.row)[0][:2])
    return apart, element.length_with(tables.numbers) if stiffness else 0.0, damping


def _place(poses: np.ndarray, body: int, point: Any) -> np.ndarray:
    """Position of a point of a body, which is given from its mass centre in the axes of the core."""
    if not body:
        return np.array(point)
    pose = poses[body - 1]
    return pose[:2] + turned(pose[2], np.array(point)) if len(point) == 2 else pose[:3] + rotation_of(pose[3:]) @ point


def _is_half_turned(tables: Tables, element: TableForce, poses: np.ndarray) -> bool:
    """True if a bushing in space with torsional stiffness is at half a turn, where the trace of its rotation is -1."""
    about = [(i, path) for i, (path, *_) in enumerate(paths(element.row)) if element.quantities[i].kind == "rotation"]
    if not any(tables.numbers(element, path, element.values[path]) for _, path in about):
        return False
    quantity: Any = tables.quantities[tables.quantity_number[f"{element.name} {about[0][0]}"]]
    first, second = (rotation_of(poses[body - 1][3:]) if body else np.eye(3) for body in (quantity.first, quantity.second))
    return np.trace(second @ np.transpose(quantity.shape) @ first.T) + 1 < HALF_TURN**2
