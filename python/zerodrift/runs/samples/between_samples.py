"""States of a solution between its samples: a part of the step to the next sample is made again."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..._private import gateway
from ...errors import WrongValue
from ...systems.base import closed_form_core_of
from ..arguments.inputs import Declared
from ..arguments.settings import core_settings
from .phases import state_from_samples


def states_between(solution: Any, rows: np.ndarray, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates (k, nq) and velocities (k, nv) at increasing times (k,), each in the step that begins at sample `rows` (k,)."""
    settings = core_settings(solution.t_span, solution.settings)
    samples = (solution.t, solution.p, solution.v, solution.energy_input, solution.status == gateway.EVENT)
    p, v = np.empty((len(times), solution.p.shape[1])), np.empty((len(times), solution.v.shape[1]))
    is_own = "inputs" in solution.settings
    state = state_from_samples(solution.t, solution.transitions)
    for core, part in _cores(solution, settings, rows):
        p[part], v[part] = gateway.states_between(core, settings, *samples, times[part], state=state, is_own=is_own)
    return p, v


def _cores(solution: Any, settings: Any, rows: np.ndarray) -> Iterator[tuple[Any, np.ndarray]]:
    """The core's system with the inputs of these steps, and which of them have these."""
    system, vector = solution.system, solution.settings.get("vector") or "baseline"
    names = solution.settings.get("inputs", ())
    if not names:
        yield closed_form_core_of(system, vector, settings), np.ones(len(rows), dtype=bool)
        return
    of = system._with_inputs(names)
    given = np.column_stack([solution[name] for name in names])
    declared = Declared(tuple(names), given[0], given[0], of, gateway.Following())
    inputs, (core, _) = declared.bound(closed_form_core_of(of.system, vector, settings), of.system._watching.core)
    if any(inputs.c.place[i].is_speed for i in range(inputs.c.places)):
        raise _wrong("a speed is an input")
    each, which = np.unique(given[rows + 1], axis=0, return_inverse=True)
    for i, values in enumerate(each):
        inputs.set_constant(values)
        yield core, which.reshape(-1) == i


def _wrong(reason: str) -> Exception:
    return WrongValue(f"values between samples must be requested by t_eval, as {reason}", "not-available")
