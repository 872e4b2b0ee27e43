"""Forces of a mechanism in a solution and their points of application, drawn as arrows."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ..._private import checks
from ..elements.drawing import Drawing
from ..elements.forces import Actuator, Bushing, Force
from ..elements.joints import Joint
from ..elements.table_forces import TableForce, has
from .plane_pose import Posed
from .space_pose import SpacePosed

SHOWN = Joint, Bushing, Force       # shown by default
HAVE_FORCES = (*SHOWN, Actuator, TableForce)


def chosen(drawing: Drawing, names: Any) -> list[Any]:
    """Elements whose forces are requested: by name, as elements, or, by True, all joints, bushings and forces."""
    if names is True:
        return drawing.of(SHOWN)
    names = [names] if isinstance(names, str) or not isinstance(names, Iterable) else list(names)
    known = {element.name: element for element in drawing.of(HAVE_FORCES)
             if not isinstance(element, TableForce) or element.row.measure != "torque"}
    return [known[checks.choice("each of forces", getattr(name, "name", name), list(known))] for name in names]


def is_rolling(element: Any) -> bool:
    """Force at a point that moves on both bodies."""
    return isinstance(element, Joint) and element.kind in ("rolling", "contact")


def acting(element: Any, moments: Sequence[Posed] | Sequence[SpacePosed], values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points of application (k, d) in m and forces (k, d) in N at the moments, from the values (k,) or (k, d) of its measure."""
    point = element.point if isinstance(element, Force) else element.second
    places = np.array([posed.contact(element) if is_rolling(element) else posed.at(point) for posed in moments])
    if values.ndim == 2:
        return places, values
    return places, values[:, None] * np.array([_direction(element, posed) for posed in moments])


def _direction(element: Any, posed: Posed | SpacePosed) -> np.ndarray:
    """Unit vector (2,) or (3,) of a force on its second point whose measure is positive."""
    if isinstance(element, TableForce) and not has(element.row, "distance"):
        axis: Any = element.axis if element.frames is None else element.frames[0][0]
        along = posed.direction(element.axes_of, axis)
        return along if not has(element.row, "across", "skid") else np.array([-along[1], along[0]])
    apart = posed.at(element.second) - posed.at(element.first)
    pulls = isinstance(element, TableForce) and element.row.sign < 0
    return (-apart if pulls else apart) / max(float(np.linalg.norm(apart)), 1e-300)
