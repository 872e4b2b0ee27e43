"""Parts of elements as JSON: numbers, points, user functions."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from ...errors import WrongValue
from ...laws.table import Table
from ..elements.bodies import Particle, Point, _Center
from ..elements.drawing import Drawing
from ..elements.user_functions import Law
from .expressions_json import to_json


def numbers(array: Any) -> Any:
    """Vector, or matrix row by row, as floats."""
    return np.asarray(array, dtype=float).tolist()


def place(point: Point, drawing: Drawing) -> Any:
    """JSON of a point: its name, such as ``"crank.end"``, or its body and its coordinates in that body's frame."""
    body = point.body
    if isinstance(body, Particle):
        return body.name
    for end in ("start", "end"):
        if getattr(body, end, None) is point:
            return f"{body.name}.{end}"
    if isinstance(point, _Center):
        return f"{body.name}.center"
    if point.name is not None and drawing.elements.get(point.name) is point:
        return point.name
    return {"body": body.name, "local": numbers(point.local)}


def sides(element: Any, drawing: Drawing) -> dict[str, Any]:
    """JSON of an element's two points."""
    return {"first": place(element.first, drawing), "second": place(element.second, drawing)}


def law_to_json(law: Law) -> Any:
    """JSON of a user function: a number, or an expression or a table and the measures of its names."""
    if law.constant is not None:
        return law.constant
    bound = {name: measure for name, measure in law._bound.items() if "." not in name}
    if isinstance(law._function, Table):
        return {"table": law._function.to_json(), "of": bound}
    return {"expression": formula_to_json(law), "of": bound}


def formula_to_json(law: Law, leaves: Mapping[str, Any] = MappingProxyType({})) -> Any:
    """JSON of an expression, or of a function that could be recorded; `leaves` replace some of its names."""
    if law.formula is None:
        raise WrongValue(f"{law.what} must be a number, an expression or a function that can be recorded, to be saved: it "
                         f"{law.why_called}", "not-portable")
    return to_json(law.formula, law.what, leaves)
