"""The orientation of bodies in space, of which the core reads the nine cosines."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._rotations import angles_of, quaternions_of
from ..systems.watching import Watching


def orientation(watching: Watching, name: Any, solution: Any) -> np.ndarray | None:
    """What is called "body.rotation", (k, 3, 3), "body.quaternion", (k, 4), or "body.euler.zyx", (k, 3); None: nothing is."""
    if not isinstance(name, str):
        return None
    body, _, quantity = name.partition(".")
    word, _, order = quantity.partition(".")
    if word not in ("rotation", "quaternion", "euler") or (word != "euler") == bool(order):
        return None
    cosines = watching.values(f"{body}.rotation", solution)
    if cosines is None or (word == "euler" and not _is_order(order)):
        return None
    R = cosines.reshape(-1, 3, 3)
    return R if word == "rotation" else quaternions_of(R) if word == "quaternion" else angles_of(R, order)


def _is_order(order: str) -> bool:
    return len(order) == 3 and set(order) <= set("xyz") and order[0] != order[1] != order[2]
