"""The phase of a given motion: constraints of contacts, stops and dry friction that are active by its positions and rates."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from .._private import gateway
from ..errors import AccuracyWarning, InconsistentStart, WrongValue
from ..runs.samples.phases import WORDS
from ..systems.base import BaseSystem, core_of
from .phase import CLOSED, in_phase
from .state import State, scales, state

TOLERANCE = 1e-6        # gap, rate and acceleration that are zero, relative to their sizes; of a motion that is given
TOUCHING = 1e-9         # gap, in units of its scale, of a contact that is closed at the start of a motion
FORWARD, BACKWARD = 2, 3
SLIDING = {FORWARD: "sliding forward", BACKWARD: "sliding backward"}


def of_motion(system: BaseSystem, samples: tuple[np.ndarray, ...]) -> Any:
    """The system in the phase of a motion t (k,), p (k, nq), v (k, nv), vdot (k, nv), samples that are not finite left out.

    A contact is closed where its gap, its rate and its acceleration are zero. Friction opposes the slip, or the acceleration from
    rest; without both it sticks.

    Raises
    ------
    ValueError
        If the phase changes.
    InconsistentStart
        If the motion penetrates a contact.
    """
    if not system._groups:
        return system
    first: tuple[float, list[int]] | None = None
    for t, p, v, vdot in zip(*samples, strict=True):
        if not (np.isfinite(p).all() and np.isfinite(vdot).all()):
            continue
        found = _state_at(system, state(system, t, p, v), vdot)
        first = first or (t, found)
        if found != first[1]:
            g = next(g for g, both in enumerate(zip(first[1], found, strict=True)) if both[0] != both[1])
            name, kind = system._groups[g]
            before, now = (SLIDING.get(each[g]) or WORDS[kind][each[g]] or "open" for each in (first[1], found))
            raise WrongValue(f"motion must be in one phase, and {name!r} of {system.name} is {before} at t = {first[0]:g} and "
                             f"{now} at t = {t:g}: give the samples of each phase separately", "not-available")
    return in_phase(system, first[1]) if first else system


def _state_at(system: BaseSystem, at: State, vdot: np.ndarray) -> list[int]:
    core, scale = core_of(system), scales(system, at.p)
    speed = 1.0 + np.abs(at.v / scale.v).max(initial=0.0)
    sizes = 1.0, speed, 1.0 + np.abs(vdot / scale.v).max(initial=0.0) + speed**2
    rates, seconds = at.C @ at.v + at.Phi_t, at.C @ vdot - at.xi
    found: list[int] = []
    for g, (name, kind) in enumerate(system._groups):
        group = core.c.group[g]
        unit = TOLERANCE * (group.scale or scale.length)
        rows = slice(group.first, group.first + group.rows)
        moving = [(np.linalg.norm(value[rows]) if group.rows == 2 else value[group.first]) / (unit * size)
                  for value, size in zip((rates, seconds), sizes[1:], strict=True)]
        if kind == "two-sided":
            found.append(CLOSED if group.is_active else 0)
        elif kind == "friction":
            slip = next((each for each in moving if abs(each) > 1), 0.0)
            is_present = not group.normal or found[group.normal - 1] == CLOSED
            found.append((FORWARD if slip > 0 else BACKWARD if slip < 0 else CLOSED) if is_present else 0)
        elif kind in ("one-sided", "one-way"):
            if kind == "one-way":
                moving[0] -= group.value / (unit * sizes[1])
            gap = [(at.Phi[group.first] - group.value) / unit] if kind == "one-sided" else []
            leaving = next((group.sign * each for each in gap + moving if abs(each) > 1), 0.0)
            is_beside = group.range and not group.lower <= at.Phi[group.range - 1] <= group.upper
            if leaving < 0 and not is_beside and not (group.opposite and abs(gap[0]) > 1):
                raise InconsistentStart(f"the motion must not pass contact {name!r} of {system.name}, and does at t = {at.t:g}")
            found.append(CLOSED if leaving == 0 and not is_beside else 0)
        else:
            found.append(0)
    return found


def at_start(system: BaseSystem, t: float, p: np.ndarray) -> Any:
    """The system with the joints that are active and the contacts that touch at a position, without friction."""
    gaps, core = gateway.gaps(core_of(system), t, p), core_of(system)
    Phi = state(system, t, p, np.zeros(system.nv)).Phi
    groups = [core.c.group[g] for g in range(len(system._groups))]
    closed = [group.is_active if kind == "two-sided" else
              g in gaps and abs(gaps[g]) <= TOUCHING and (not group.range or group.lower <= Phi[group.range - 1] <= group.upper)
              for g, (group, (_, kind)) in enumerate(zip(groups, system._groups, strict=True))]
    return in_phase(system, [int(each) for each in closed])


def warn_of_gaps(system: Any, t: np.ndarray, p: np.ndarray) -> None:
    """Warns of contacts with unbounded shapes that a motion in a phase passes."""
    full = core_of(system.phases_of)
    worst: dict[str, tuple[float, float]] = {}
    for when, where in zip(t, p, strict=True):
        for g, gap in gateway.gaps(full, when, where).items() if np.isfinite(where).all() else ():
            name = system.phases_of._groups[g][0]
            if not full.c.group[g].range and gap < min(-TOUCHING, worst.get(name, (0.0,))[0]):
                worst[name] = gap * (full.c.group[g].scale or full.c.length or 1.0), when
    if worst:
        said = ", ".join(f"{name!r} by {-gap:.3g} at t = {when:g}" for name, (gap, when) in worst.items())
        warnings.warn(f"the prescribed motion of {system.name} must not pass contacts that are open at its start, and passes "
                      f"{said}", AccuracyWarning, stacklevel=3)


def warn_of_forces(system: Any, t: np.ndarray, multipliers: np.ndarray) -> None:
    """Warns of contacts that would pull, and of friction beyond its bound, by multipliers (k, m) of a phase."""
    core: Any = core_of(system)
    worst: dict[str, tuple[float, str]] = {}
    for when, all_rows in zip(t, core.expanded(np.nan_to_num(multipliers)), strict=True):
        for name, excess, how in _excesses(system.phases_of._groups, core, all_rows):
            if excess > TOLERANCE * np.abs(all_rows).max() and excess > worst.get(name, (0.0, ""))[0]:
                worst[name] = excess, f"{name!r} {how} {excess:.3g} (N or N m) at t = {when:g}"
    if worst:
        warnings.warn(f"contacts must push and friction must be within its bounds in this motion of {system.name}, and "
                      + "; ".join(said for _, said in worst.values()), AccuracyWarning, stacklevel=3)


def _excesses(groups: Sequence[tuple[str, str]], core: Any, multipliers: np.ndarray) -> Iterator[tuple[str, float, str]]:
    for g, (name, kind) in enumerate(groups):
        group = core.full.c.group[g]
        force = multipliers[group.first:group.first + group.rows] if core.state[g] == CLOSED else np.zeros(1)
        if kind in ("one-sided", "one-way"):
            yield name, group.sign * force[0], "pulls with"
        elif kind == "friction":
            yield name, float(np.linalg.norm(force)) - core.friction_bound(g, multipliers), "exceeds its bound by"
