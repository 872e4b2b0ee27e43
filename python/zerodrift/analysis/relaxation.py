"""Motion towards rest: the system is integrated, and stopped at each maximum of its kinetic energy."""

from __future__ import annotations

import warnings

import numpy as np

from ..errors import ZerodriftError
from ..runs.arguments.events import Event
from ..runs.simulate import simulate
from ..runs.states.operations import acceleration
from ..systems.base import BaseSystem
from .state import scales, state

STOPS = 60
HORIZON = 20.0      # of a run between two stops, in times that the acceleration takes for a characteristic length
DISTANT = 100.0     # characteristic scales: what has moved so far falls, or turns on
CLOSE = 1e-3        # of the first acceleration: a position from where Newton's method goes on


def settled(system: BaseSystem, p: np.ndarray) -> np.ndarray:
    """A position near a stable equilibrium: velocities are set to zero wherever the power of all forces turns negative.

    The motion loses its kinetic energy at each stop, so that it settles also where nothing damps it.

    Raises
    ------
    ZerodriftError
        If a run fails, or leads far away.
    """
    scale, first, start = scales(system, p).p, 0.0, p
    for _ in range(STOPS):
        rest = np.zeros(system.nv)
        at = state(system, 0.0, p, rest)
        rate = float(np.abs(at.A @ acceleration(system, p, rest)[0] / scale).max(initial=0.0))
        first = first or rate
        if rate <= CLOSE * first:
            break
        p = _to_the_fastest(system, p, rest, HORIZON / np.sqrt(rate))
        if np.abs((p - start) / scale).max(initial=0.0) > DISTANT:
            raise ZerodriftError("nothing stops the motion towards rest")
    return p


def _to_the_fastest(system: BaseSystem, p: np.ndarray, rest: np.ndarray, horizon: float) -> np.ndarray:
    """The position of the next maximum of kinetic energy, or that after the horizon."""
    def power(t: float, p: np.ndarray, v: np.ndarray) -> float:
        return float(v @ state(system, t, p, v).force)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")     # the way to rest need not be accurate
        sol = simulate(system, horizon, p, rest, integrator="dormand_prince", rtol=1e-4, atol=1e-6, max_steps=5000,
                       events=[Event(power, terminal=True, direction=-1)])
    if not len(sol.t):
        raise ZerodriftError("the motion towards rest did not begin")
    return np.array(sol.p[-1])
