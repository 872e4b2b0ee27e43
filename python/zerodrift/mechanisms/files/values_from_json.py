"""Parts of elements from JSON: points, directions, user functions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..._private import checks
from ...errors import WrongValue
from ...laws import table
from ..elements.bodies import Point
from .expressions_json import from_json

UNIT = 1e-9         # deviation of a direction's length from one, at most


def place_from_json(m: Any, given: Any) -> Any:
    """Point from its name, or from its body and its coordinates in the body's frame."""
    if isinstance(given, str):
        return m._named("a point", given)
    if not isinstance(given, Mapping) or set(given) != {"body", "local"}:
        raise WrongValue(f"a point must be a name, or have a body and local coordinates, not {checks.shown(given)}",
                         "unreadable-file")
    return m._body("body", given["body"]).point(given["local"])


def direction_from_json(what: str, given: Any, dimension: int = 2) -> np.ndarray:
    """Direction (dimension,) of length one, as stored."""
    direction = checks.vector(what, given, dimension)
    if abs(np.linalg.norm(direction) - 1) > UNIT:
        raise WrongValue(f"{what} must have length 1, not {checks.shown(given)}", "unreadable-file")
    return direction


def law_and_of(given: Any, what: str) -> tuple[Any, Any]:
    """Arguments of a method for a user function: its value and its `of`."""
    if not isinstance(given, Mapping):
        return given, None
    if set(given) == {"table", "of"}:
        return table.from_json(given["table"]), given["of"]
    if set(given) != {"expression", "of"}:
        raise WrongValue(f"{what} must be a number, or have an expression or a table, and of, not {checks.shown(given)}",
                         "unreadable-file")
    return from_json(given["expression"], what), given["of"]


def point_of_body(m: Any, given: Any) -> Point:
    """Point of a description whose body is needed."""
    return checks.instance("a point", place_from_json(m, given), Point, "a point of a body")
