"""Positions on the manifold: a guess projected onto the holonomic constraints and onto prescribed values of quantities."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from .. import _check, _gateway
from ..errors import CorrectionFailed
from ..systems.base import BaseSystem, core_of
from .quantities import find, rates_of, values_of
from .state import State, scales, small_core, state
from .tangent import DEPENDENT, inverse_of_products, norms

ITERATIONS = 30
SHORT_ROW = 1e-3        # of the longest row: residuals of shorter ones are compared with that
CONVERGED = 1e-13       # of the characteristic scales: the last step of Newton's method
SMALLEST_PART = 1e-4    # of the way to a position that is led to
QUADRATIC = 1e-5        # characteristic scales: steps that converge quadratically
STAGNATED = 1e-9        # a last step of this size counts where the next ones are not smaller


def moved(at: State, delta: np.ndarray) -> np.ndarray:
    """The position after a displacement in quasi-coordinates, with unit quaternions and followers restored."""
    return consistent(at.system, at.p + at.A @ delta)


def consistent(system: BaseSystem, p: np.ndarray) -> np.ndarray:
    """A position whose quaternions have length one, and whose counted angles follow them."""
    p = np.array(p)
    for first in system.quaternions:
        p[first:first + 4] /= math.sqrt(p[first:first + 4] @ p[first:first + 4])
    _gateway.follow(core_of(system), p)
    return p


def onto(system: BaseSystem, t: float, p: np.ndarray, held: Mapping[str, np.ndarray] | None = None) -> np.ndarray:
    """The position that Newton's method finds from a guess, with minimum-norm steps in characteristic scales.

    Parameters
    ----------
    system : BaseSystem
    t : float
    p : ndarray (nq,)
    held : dict of str to ndarray, optional
        Values of quantities of positions, such as measures.

    Raises
    ------
    CorrectionFailed
        If it does not converge.
    """
    held, p = held or {}, consistent(system, p)
    scale = scales(system, p)
    target = np.concatenate([np.ravel(each) for each in held.values()]) if held else np.zeros(0)
    last = np.inf
    for _ in range(ITERATIONS):
        A, residual, rows = _position_terms(system, t, p, held, target)
        if not residual.size:
            return p
        step, off, is_independent = _least_step(rows, residual, scale.v)
        change = A @ step
        size = float(np.abs(change / scale.p).max())
        contradict = size < STAGNATED and off > 1e3 * max(size, CONVERGED)     # rows that are met as nearly as can be
        if contradict or not np.isfinite(size) or size > 1e3:
            break
        p = consistent(system, p + change)
        if size < CONVERGED or (size < STAGNATED and size > last / 4):
            return p
        is_quadratic = is_independent and size < QUADRATIC and last < np.inf
        if is_quadratic and size**3 < CONVERGED * last**2 / 10:     # as large as the next step would be
            return p
        last = size
    raise CorrectionFailed(f"no position satisfies the constraints{' and ' + ', '.join(held) if held else ''} near the guess: "
                           f"the last step was {last:.3g} of the size")


def _position_terms(system: BaseSystem, t: float, p: np.ndarray, held: Mapping[str, np.ndarray],
                    target: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A (nq, nv), violations (mh + held,) and their rows (mh + held, nv)."""
    core = small_core(system)
    at = np.array([float(t)]), np.ascontiguousarray(p)[None], np.zeros((1, core.nv))
    terms = core.evaluate_states(("A", "Phi", "C"), *at)
    A = terms["A"][0] if "A" in terms else np.eye(core.nv)
    C, Phi = terms["C"][0][:core.mh] if core.mh else np.zeros((0, core.nv)), terms["Phi"][0] if core.mh else np.zeros(0)
    C = core.rows_above_rounding(float(t), *(each[0] for each in at[1:]), C)
    if not held:
        return A, Phi, C
    found = rates_of(system, tuple(held), "hold", *at)
    return A, np.concatenate([Phi, found["value"][0] - target]), np.vstack([C, found["row"][0]])


def _least_step(rows: np.ndarray, residual: np.ndarray, scale: np.ndarray) -> tuple[np.ndarray, float, bool]:
    """Minimum-norm solution of rows x = -residual in scaled velocities, the largest residual in these units, and independence."""
    rows = rows * scale
    length = norms(rows)
    longest = length.max(initial=0.0) or 1.0
    length = np.maximum(length, max(DEPENDENT * longest, 1e-300))
    off = np.abs(residual) / np.maximum(length, max(SHORT_ROW * longest, 1e-300))
    unit, right = rows / length[:, None], -residual / length
    if (inverse := inverse_of_products(unit)) is not None:
        return scale * (unit.T @ (inverse @ right)), float(off.max()), True
    return scale * np.linalg.lstsq(unit, right, rcond=DEPENDENT)[0], float(off.max()), False


def near_to(system: BaseSystem, near: Any, t: float) -> np.ndarray:
    """The position that an argument `near` means: coordinates, or values of quantities; None: the start."""
    if near is not None and not isinstance(near, Mapping):
        return onto(system, t, _check.vector("near", near, system.nq))
    p = np.array(system._state_or_start(None, None, "near", "v", t)[0])
    return p if near is None else _led(system, t, p, values_of(near, "near"))


def _led(system: BaseSystem, t: float, p: np.ndarray, values: Mapping[str, Any]) -> np.ndarray:
    """The position with these values of quantities, reached from another in parts of the way, with the smallest moves."""
    at = state(system, t, p, np.zeros(system.nv))
    first = {name: find(at, name, "near").value for name in values}
    last = {name: _check.vector(f"near[{name!r}]", np.atleast_1d(value), len(first[name])) for name, value in values.items()}
    done, part = 0.0, 0.25
    while done < 1.0:
        part = min(part, 1.0 - done)
        target = {name: first[name] + (done + part) * (last[name] - first[name]) for name in values}
        try:
            p, done, part = onto(system, t, p, target), done + part, 2 * part
        except CorrectionFailed:
            part /= 2
            if part < SMALLEST_PART:
                raise
    return p
