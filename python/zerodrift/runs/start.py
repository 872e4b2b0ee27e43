"""Initial state of a run, given in coordinates, as an equilibrium or as the state at an instant."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import WrongType, WrongValue
from ..systems.base import BaseSystem, Makes, system_of
from .instant import Reading
from .operations import project


def start_of(system: Any, p0: Any, v0: Any, t0: float) -> tuple[BaseSystem, Any, Any]:
    """System and initial state (p0, v0) from the arguments of a run.

    An equilibrium or a `zerodrift.Instant` gives its position and velocities; these are projected onto drives that move at t0.

    Raises
    ------
    TypeError
        If v0 is given with an equilibrium or an instant as p0.
    ValueError
        If p0 is an equilibrium or an instant of a system with other coordinates.
    """
    if not isinstance(p0, Reading):
        return system_of(system, p0, v0), p0, v0
    if v0 is not None:
        raise WrongType("v0 must be left out where p0 is an equilibrium or an instant, which has its velocities",
                        "conflicting-arguments")
    system = system.system(p0.system.layout) if isinstance(system, Makes) else system
    if [each.name for each in system.coordinates] != [each.name for each in p0.system.coordinates]:
        raise WrongValue(f"p0 must be an equilibrium or an instant of {system.name} in its coordinates, not of {p0.system.name} "
                         "in others", "wrong-element")
    terms = p0.system.evaluate(p0.p, p0.v, t0)
    if terms.Phi_t is None or not np.any(terms.Phi_t):
        return system, p0.p, p0.v
    return system, *project(system, p0.p, p0.v, t0)
