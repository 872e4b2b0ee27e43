"""Operations outside a run: states between samples, accelerations, projection, and redundant constraints of many bodies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..core import ffi, lib
from .base import MESSAGE_SIZE, cards, doubles, error_of, row_named, strided_doubles, text
from .runs import Run, settings
from .systems import CoreSystem


def _columns(columns: dict[str, tuple[np.ndarray, int]]) -> tuple[dict[str, Any], int]:
    """Pointers to columns with `count` entries, and their stride (0: contiguous). Columns of a file are read in place."""
    strides = {array.strides[0] for array, _ in columns.values()}
    if len(strides) == 1 and not all(array.flags.c_contiguous for array, _ in columns.values()):
        return {name: strided_doubles(array, size) for name, (array, size) in columns.items()}, strides.pop() // 8
    return {name: doubles(np.ascontiguousarray(array), size) for name, (array, size) in columns.items()}, 0


def states_between(core: CoreSystem, settings: Any, t: np.ndarray, p: np.ndarray, v: np.ndarray, energy_input: np.ndarray | None,
                   ends_in_event: bool, times: np.ndarray, *, state: np.ndarray | None = None,
                   is_own: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """`zd_states_between`: p (k, nq) and v (k, nv) at times (k,) between the samples t, p, v of a run.

    state: (k, groups) of the groups of constraints from each sample on. is_own: the system's data belong to the caller.
    """
    core, message, rows, count = core if is_own else core.for_run(), ffi.new("char[]", MESSAGE_SIZE), len(t), len(times)
    columns = {"t": (t, rows), "p": (p, rows * core.nq), "v": (v, rows * core.nv)}
    if energy_input is not None:
        columns["input"] = energy_input, rows
    memory, stride = _columns(columns)
    if state is not None:
        memory["state"] = ffi.from_buffer("signed char[]", state)
    saved = ffi.new("zd_saved *", {"samples": rows, "ends_in_event": ends_in_event, "stride": stride, **memory})
    found_p, found_v = np.empty((count, core.nq)), np.empty((count, core.nv))
    found = doubles(found_p, count * core.nq, writable=True), doubles(found_v, count * core.nv, writable=True)
    status = lib.zd_states_between(core.c, settings, saved, count, doubles(times, count), *found, message, MESSAGE_SIZE)
    if status:
        raise core.error or error_of(status, text(message))
    return found_p, found_v


def acceleration(core: CoreSystem, formulation: int, on_singular: int, t: float, p: np.ndarray,
                 v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations vdot (nv,) and multipliers (m,) at a state."""
    vdot, multipliers, _ = accelerations(core, formulation, on_singular, np.array([float(t)]), p, v)
    return vdot[0], multipliers[0]


def accelerations(core: CoreSystem, formulation: int, on_singular: int, t: np.ndarray, p: np.ndarray, v: np.ndarray, *,
                  is_own: bool = False) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """`zd_accelerations`: vdot (k, nv) and multipliers (k, m), which are a choice where flagged, at t (k,), p (k, nq), v (k, nv).

    is_own: the system's data belong to the caller.
    """
    core, k = core if is_own else core.for_run(), len(t)
    vdot, multipliers, message = np.empty((k, core.nv)), np.empty((k, core.m)), ffi.new("char[]", MESSAGE_SIZE)
    flags = np.zeros(k, dtype=np.intc)
    status = lib.zd_accelerations(core.c, formulation, on_singular, k, doubles(t, k), doubles(p, k * core.nq),
                                  doubles(v, k * core.nv), doubles(vdot, vdot.size, writable=True),
                                  doubles(multipliers, multipliers.size, writable=True),
                                  ffi.from_buffer("int[]", flags, require_writable=True), ffi.NULL, message, MESSAGE_SIZE)
    if status:
        raise core.error or error_of(status, text(message))
    return vdot, multipliers, flags != 0


def accelerations_with(core: CoreSystem, formulation: int, t: np.ndarray, p: np.ndarray, v: np.ndarray,
                       multipliers: np.ndarray) -> np.ndarray:
    """`zd_accelerations_with`: vdot (k, nv) of a system with groups of constraints, whose multipliers (k, m) are known."""
    core, k = core.for_run(), len(t)
    vdot, message = np.empty((k, core.nv)), ffi.new("char[]", MESSAGE_SIZE)
    status = lib.zd_accelerations_with(core.c, formulation, k, doubles(t, k), doubles(p, k * core.nq), doubles(v, k * core.nv),
                                       doubles(np.ascontiguousarray(multipliers), k * core.m),
                                       doubles(vdot, vdot.size, writable=True), message, MESSAGE_SIZE)
    if status:
        raise core.error or error_of(status, text(message))
    return vdot


def needed_efforts(core: CoreSystem, states: Sequence[np.ndarray], rows: np.ndarray, weight: np.ndarray, length: float,
                   scale: np.ndarray, force: np.ndarray | None) -> list[np.ndarray] | int:
    """`zd_inverse_dynamics` at states t (k,), p (k, nq), v (k, nv), vdot (k, nv).

    Efforts act along quantities with these rows (k, j, nv) and are weighted (j,); length and scale (nv,) are characteristic; the
    force (k, nv) replaces that of the system. Efforts (k, j), multipliers (k, m), norms of the force that efforts do not give and
    that they should give (k,), their power (k,) and rank (k,); or the index of a state that violates constraints, or where an
    allowed motion has no mass.
    """
    core, (k, j, _) = core.for_run(), rows.shape
    found = [np.empty(shape) for shape in ((k, j), (k, core.m), k, k, k, k)]
    to = ffi.new("zd_needed_efforts *", [doubles(each, each.size, writable=True) for each in found])
    *moving, forces, along, weights, scales, inverse = (doubles(each, each.size) for each in map(
        np.ascontiguousarray, (*states, rows if force is None else force, rows, weight, scale, 1 / scale)))
    motion = ffi.new("zd_given_motion *",
                     (core.c, k, *moving, ffi.NULL if force is None else forces, j, along, weights, length, scales, inverse))
    status = lib.zd_inverse_dynamics(motion, to)
    if status in (lib.ZD_BAD_START, lib.ZD_NOT_DEFINITE):
        return to.sample
    if status:
        raise core.error or error_of(status, "the system's evaluation failed")
    return found


def project(core: CoreSystem, settings: Any, t: float, p: np.ndarray, v: np.ndarray,
            hold_p: list[int] | None = None, hold_v: list[int] | None = None) -> int:
    """`zd_project`: corrects p and v in place; the number of iterations."""
    core = core.for_run()
    iterations, message = ffi.new("int *"), ffi.new("char[]", MESSAGE_SIZE)
    held = [ffi.NULL if hold is None else ffi.new("int[]", hold) for hold in (hold_p, hold_v)]
    status = lib.zd_project(core.c, settings, t, doubles(p, core.nq, writable=True), doubles(v, core.nv, writable=True),
                            *held, iterations, message, MESSAGE_SIZE)
    if status:
        raise core.error or error_of(status, text(message))
    return iterations[0]


def nearest_velocities(core: CoreSystem, t: float, p: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Consistent velocities nearest to `v` in the mass metric at (t, p); the positions may violate their constraints."""
    nearest = np.array(v, dtype=float)
    project(core, _settings(t, positions=0.0), t, np.array(p, dtype=float), nearest)
    return nearest


def redundant_rows(core: CoreSystem, t: float, p: np.ndarray, v: np.ndarray) -> list[int]:
    """Indices of redundant constraints, determined by the core at a consistent state.

    Raises
    ------
    Bifurcation
        If constraints are redundant at this state only.
    """
    return Run(core, _settings(t), p, v).results().redundant


def _settings(t: float, **given: float) -> Any:
    """Settings of a run that is created but makes no steps."""
    parameters = next(card.parameters for card in cards("corrections") if card.name == "projection")
    values = [given.get(parameter.name, parameter.initial[0]) for parameter in parameters if parameter.initial]
    return settings({"formulation": row_named("formulations", "augmented"), "t0": t, "t1": t + 1.0, "step": 1.0, "save_every": 1,
                     "correction": {"projection": values}})
