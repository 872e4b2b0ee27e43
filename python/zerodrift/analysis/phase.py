"""Phases at single states: the constraints of contacts, stops, joints that switch and dry friction that are active there."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

from .._private import gateway
from ..errors import EquilibriumFailed
from ..runs.arguments.methods import row_of
from ..runs.samples.phases import words
from ..runs.states.operations import phase_at as phase_of_run
from ..systems.base import BaseSystem, core_of
from .rest import Balance, Search
from .retraction import near_to, onto
from .state import State, scales, state

CLOSED, SLIDING, IDLE = 1, (2, 3), 4     # states of a group as `zd_transition` has them
PHASES = 50             # tried for one equilibrium
AT_REST = 1e-7          # acceleration, relative to the largest one of the mechanism without constraints, that is rounding
TOUCHING = 1e-10        # gap, in units of its scale, beyond which a step has passed a contact
BISECTIONS = 60


def at_state(system: BaseSystem, t: float, p: np.ndarray, v: np.ndarray) -> BaseSystem:
    """The system in the phase with which a run from a state begins."""
    return in_phase(system, _found(system, t, np.array(p, dtype=float), np.array(v, dtype=float)).state)


def _found(system: BaseSystem, t: float, p: np.ndarray, v: np.ndarray) -> Any:
    return phase_of_run(system, t, p, v, row_of("formulations", system._formulation))


def in_phase(system: BaseSystem, state: Any) -> Any:
    """The system with the constraints that are active in one phase; its attribute `phase` has its words by name."""
    core, measuring = (gateway.in_phase(each, state) for each in (core_of(system), system._watching.core))
    twin = copy.copy(system)
    twin.__class__ = _class_of(type(system))
    for name in ("_watching", "_columns_of"):
        twin.__dict__.pop(name, None)
    twin.__dict__ |= {"_core": core, "_measuring": measuring, "constraints": tuple(system.constraints[i] for i in core.active),
                      "phase": words(np.array(state), system._groups), "phases_of": system}
    return twin


_classes: dict[type, type] = {}


def _class_of(of: type) -> type:
    """The class of systems in one phase, which have no groups that switch; they are pickled by their system and phase."""
    members = {"_groups": (), "__reduce__": lambda self: (in_phase, (self.phases_of, self._core.state))}
    return _classes.setdefault(of, type("InPhase", (of,), members))


class _Touched(Exception):
    """A search that reaches a contact which is open."""

    def __init__(self, p: np.ndarray, group: int) -> None:
        self.p, self.group = p, group


class _Approach(Search):
    """A search that ends where it reaches an open contact."""

    system: Any     # in a phase
    watched: tuple[int, ...] = ()

    def _step(self, here: Balance, z: np.ndarray) -> Balance | None:
        there = super()._step(here, z)
        if there is not None and (group := self._passed(there.at.p)) is not None:
            raise _Touched(*self._reached(here.at.p, there.at.p, group))
        return there

    def _gaps(self, p: np.ndarray) -> dict[int, float]:
        found = gateway.gaps(core_of(self.system.phases_of), self.t, p)
        return {group: found[group] for group in self.watched}

    def _passed(self, p: np.ndarray) -> int | None:
        found = self._gaps(p)
        group = min(found, key=found.__getitem__, default=None)
        return group if group is not None and found[group] < -TOUCHING else None

    def _reached(self, start: np.ndarray, end: np.ndarray, group: int) -> tuple[np.ndarray, int]:
        """The last position before a contact between two positions, and the contact."""
        low, high, p = 0.0, 1.0, start
        for _ in range(BISECTIONS):
            middle = (low + high) / 2
            between = onto(self.system, self.t, start + middle * (end - start))
            if (passed := self._passed(between)) is None:
                low, p = middle, between
            else:
                high, group = middle, passed
        return p, group


def resting(system: BaseSystem, t: float, near: Any, *, is_downhill: bool) -> tuple[Balance, int, Any]:
    """The balance in the phase in which a system with contacts rests, its iterations, and the core's phase.

    The search begins in the phase that follows at rest, in which friction that exceeds its bound is left out, and goes on in
    the next one where it reaches a contact, or where the balance needs a force that pulls.
    """
    core, zero = core_of(system), np.zeros(system.nv)
    released = in_phase(system, [CLOSED if kind == "two-sided" and core.c.group[g].is_active else 0
                                 for g, (_, kind) in enumerate(system._groups)])
    p, iterations, forced = near_to(released, near, t), 0, None
    _check_drives(state(released, t, p, zero))
    for _ in range(PHASES):
        found = _found(system, t, p, zero)
        if _is_at_rest(system, t, p, found.vdot):
            here = in_phase(system, found.state)
            return Balance(here, t, onto(here, t, p), {}), iterations, found
        active = [0 if each in SLIDING else each for each in found.state]
        if forced is not None:
            active[forced] = active[forced] or CLOSED
        search = _Approach(in_phase(system, active), t, {}, is_downhill=is_downhill)
        search.watched = tuple(g for g, (_, kind) in enumerate(system._groups) if kind == "one-sided" and not active[g])
        try:
            balance, is_found = search.run(p)
        except _Touched as touched:
            still = np.abs((touched.p - p) / scales(system, p).p).max(initial=0.0) < TOUCHING
            p, forced = touched.p, touched.group if still else None
            iterations += search.iterations
            continue
        iterations += search.iterations
        moved = np.abs((balance.at.p - p) / scales(system, p).p).max(initial=0.0)
        if not is_found or (moved < TOUCHING and forced is None):
            break
        p, forced = balance.at.p, None
    last = ", ".join(f"{name} {word}" for name, word in in_phase(system, found.state).phase.items())
    raise EquilibriumFailed(f"{system.name} must have a position in which its forces balance with contacts that push and "
                            f"friction within its bounds, and none was found; the last phase is: {last}")


def _check_drives(at: State) -> None:
    """Refuses drives that move, as contacts follow from the forces of their motion, not from those of a drive that is held."""
    rates = np.maximum(np.abs(at.Phi_t), np.abs(at.xi))
    if rates.max(initial=0.0) > AT_REST * scales(at.system, at.p).length:
        row = int(rates.argmax())
        name, speed, acceleration = at.system.constraints[row].name, abs(at.Phi_t[row]), abs(at.xi[row])
        raise EquilibriumFailed(f"drives of a system with contacts must be at rest in its equilibrium, and {name!r} of "
                                f"{at.system.name} moves at t = {at.t:g}, with a speed of {speed:.3g} and an acceleration of "
                                f"{acceleration:.3g}: hold it by a constant, or give a t at which it rests")


def _is_at_rest(system: BaseSystem, t: float, p: np.ndarray, vdot: np.ndarray) -> bool:
    """Accelerations are rounding, compared with those that the terms of the forces would give to free bodies."""
    at = state(in_phase(system, [0] * len(system._groups)), t, p, np.zeros(system.nv))
    free = at.magnitudes / np.maximum(np.abs(np.diag(at.M)), 1e-300)
    return bool(np.abs(vdot).max(initial=0.0) <= AT_REST * free.max(initial=0.0))
