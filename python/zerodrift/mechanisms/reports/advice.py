"""Causes of errors that the core reports with numbers: the bodies, joints and motors concerned, and remedies."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from ..._private.gateway import Variable
from ...systems.measure_values import Watching
from ..assembly import space_advice
from ..assembly.nudge import OTHERWISE
from ..assembly.start import Starting
from ..elements.drawing import Drawing, Inertias
from ..elements.forces import Actuator, Bushing, Force, Motor, Spring, Torque, TorsionSpring
from ..elements.numbers import Numbers
from ..elements.space_bodies import SpaceInertias
from ..equations.space_tables import SpaceTables

TAKES_PART = 0.2    # of the largest jump: elements with smaller ones do not matter
BESIDE = np.array([1e-3, 1e-4, 1e-5, 1e-6])    # of the largest entry of a state: distances from it at which forces are evaluated
WITH_LAWS = (Motor, Spring, TorsionSpring, Bushing, Force, Torque)


def at_start(error: str, start: Starting, constraints: Sequence[Variable]) -> str | None:
    """Advice on an error at the start: bodies without mass, or constraints that are singular as drawn."""
    drawing = start.drawing
    if "mass matrix" in error:
        return _of_mass(drawing, start.numbers, "inverts it" in error)
    said = r"(?:\brows? |, | and )(\d+)\b" if "a bifurcation:" in error else r"\brow (\d+)"     # one constraint, or several
    rows = sorted(set(map(int, re.findall(said, error))))
    if not rows or "follow" not in error:
        return None
    is_driven = any(isinstance(drawing.elements.get(constraints[row].name), Motor | Actuator) for row in rows)
    helps = OTHERWISE if is_driven else start.way_out()
    return f"in this pose {drawing.name!r} is singular, {_why(start)}: {helps}"


def _why(start: Starting) -> str:
    """Cause of a singular drawn pose: a cross in the plane of its shafts, otherwise probably links in line."""
    tables, assembly, p = start.closed(0.0)
    flat = space_advice.flat_crosses(tables, assembly.core, p) if isinstance(tables, SpaceTables) else []
    return f"as {' and '.join(flat)}" if flat else "as links in line are"


def _of_mass(drawing: Drawing, numbers: Numbers, can_be_held: bool) -> str | None:
    """Names of the bodies without mass or inertia, and a remedy."""
    inertias = (SpaceInertias if drawing.dimension == 3 else Inertias)(drawing, numbers)
    without = [body.name for body in drawing.parts() if not inertias.is_massive(body)]
    if not without:
        return None
    named, have = ", ".join(map(repr, without)), "has" if len(without) == 1 else "have"
    return f"{named} {have} no mass or no inertia: give some{', or take formulation=' + repr('augmented') if can_be_held else ''}"


def jumping(drawing: Drawing, watching: Watching, t: float, p: np.ndarray, v: np.ndarray, velocity: int) -> str:
    """Names of the forces and torques that jump where a velocity changes its sign, or the coordinate of its number some value."""
    count = 4 * len(BESIDE)
    at_p, at_v = states = [np.repeat(each[None], count, axis=0) for each in (p, v)]
    for state, half in zip(states, np.split(np.arange(count), 2), strict=True):
        aside = BESIDE * (1 + np.abs(state).max())
        state[half, min(velocity, state.shape[1] - 1)] += np.concatenate([aside, -aside])
    jumps: dict[str, float] = {}
    for element in drawing.of(WITH_LAWS):
        for place in (watching.find(f"{element.name}.{quantity}") for quantity in ("force", "torque")):
            if place:
                core = watching.core
                values = core.measure(place.number, np.full(count, t), at_p, at_v, np.zeros((count, core.nv)),
                                      np.zeros((count, core.m)))
                jumps[element.name] = max(_jump(values), jumps.get(element.name, 0.0))
    largest = max(jumps.values(), default=0.0)
    return " or ".join(repr(name) for name, jump in jumps.items() if jump > TAKES_PART * largest)


def _jump(values: np.ndarray) -> float:
    """Largest jump of a quantity, without what is proportional to the distances `BESIDE`, on both sides of two states."""
    ahead, behind = np.moveaxis(values.reshape(2, 2, len(BESIDE), -1), 1, 0)
    differences = ahead - behind
    return float(np.abs(10 * differences[:, 1:] - differences[:, :-1]).max(initial=0.0)) / 9
