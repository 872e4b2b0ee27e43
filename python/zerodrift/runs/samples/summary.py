"""Summaries of a solution and of an open run, as `print` shows them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..._private.gateway import WARNING_LIMITS
from ..arguments.settings import corrections_of

MAX_NAMED = 8              # redundant constraints named in the summary
MAX_VALUES = 6             # coordinates of an open run
PART = 2**26        # bytes of a column that are read at once


def summary(solution: Any) -> str:
    """Lines on methods, cost, violation of constraints and energy error of a solution."""
    s, stats = solution.settings, solution.stats
    steps = max(1, stats.get("steps", 1))
    lines = [
        f"Solution of {solution.system.name}: {len(solution.t)} samples, t = {solution.t_span[0]:g} ... {solution._last_time:g} "
        f"s, {solution.message}",
        f"  how         {s['formulation']}, {s['integrator']}, {step_sizes(s)}, "
        + ", ".join(map(str, corrections_of(s) if s["stabilization"] else ["no stabilization", *corrections_of(s)])),
    ]
    if stats:       # absent for a killed run
        lines.append(
            f"  cost        {_duration(stats['seconds'])}, {steps} steps of {_duration(stats['seconds'] / steps)}, "
            f"{stats['evaluations'] / steps:.3g} evaluations and {stats['factorizations'] / steps:.3g} factorizations each")
    lines += _evaluation(stats)
    if calls := stats.get("calls"):
        lines.append(f"  in Python   {sum(calls.values()) / stats['seconds']:.0%} of the time: {calls_in_words(calls)}")
    if solution.system.m:
        lines.append(f"  violation   max |Phi| = {_largest(solution.position_violation)}, "
                     f"max |Psi| = {_largest(solution.velocity_violation)}")
    if stats.get("redundant"):
        names = [solution.system.constraints[row].name for row in stats["redundant"][:MAX_NAMED]]
        if (more := len(stats["redundant"]) - len(names)) > 0:
            names.append(f"{more} others")
        lines.append(f"  redundant   {', '.join(names)}: rank {stats['rank']} of {solution.system.m}")
    if stats.get("rank_drops"):
        lines.append(f"  singular    the rank dropped in {stats['rank_drops']} steps")
    if 0 < stats.get("smallest_pivot", 0) < WARNING_LIMITS.pivot:
        lines.append(f"  digits      lost near a bifurcation: relative pivot {stats['smallest_pivot']:.1g} of "
                     f"{solution.system.constraints[stats['smallest_pivot_row']].name} at t = {stats['smallest_pivot_time']:.6g}")
    if solution.energy_violation is not None:
        lines.append(f"  energy      max |Psi_E| = {_largest(solution.energy_violation)} J")
    return "\n".join(lines)


def _evaluation(stats: dict[str, Any]) -> list[str]:
    interpreted, reason = stats.get("interpreted"), stats.get("matrix_path_reason")
    more = f"; {interpreted}" if interpreted else ""
    if stats.get("closed_form_steps"):
        left = stats["steps"] - stats["closed_form_steps"]
        return ["  evaluation  closed form" + (" by tables" if more else "") +
                (f" ({left} of {stats['steps']} steps by matrices)" if left else "") + more]
    return [f"  evaluation  matrices, no closed form: {reason}{more}"] if reason else []


def calls_in_words(calls: Mapping[str, float]) -> str:
    """User functions that were called, with their time, the slowest first."""
    slowest = sorted(calls.items(), key=lambda each: -each[1])
    more = len(slowest) - MAX_NAMED
    return ", ".join([f"{what} ({_duration(seconds)})" for what, seconds in slowest[:MAX_NAMED]] + [f"{more} more"] * (more > 0))


def _duration(seconds: float) -> str:
    for unit, size in (("s", 1.0), ("ms", 1e-3)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{1e6 * seconds:.3g} us"


def step_sizes(settings: dict[str, Any]) -> str:
    if settings["step"] is None:
        return f"rtol {settings['rtol']:g}, atol {settings['atol']:g}"
    return f"step {settings['step']:g} s"


def _largest(violation: np.ndarray) -> str:
    """Largest magnitude in a column, which may be larger than memory, as text."""
    size = violation.itemsize * max(1, violation[:1].size)
    parts = (violation[i:i + max(1, PART // size)] for i in range(0, len(violation), max(1, PART // size)))
    return f"{max((np.abs(part).max(initial=0.0) for part in parts), default=0.0):.2g}"


def run_summary(run: Any, stats: dict[str, Any]) -> str:
    """Lines on the present time, the methods, the evaluation of steps, the inputs and the state of a run."""
    s, system = run.settings, run.system
    corrections = corrections_of(s) if s["stabilization"] else ["no stabilization", *corrections_of(s)]
    lines = [
        f"Run of {system.name}: t = {run.t:.9g} s after {run.steps} steps",
        f"  how         {s['formulation']}, {s['integrator']}, {step_sizes(s)}, {', '.join(map(str, corrections))}",
        *_evaluation(stats),
        f"  positions   {_values(system.coordinates, run.p)}",
        f"  velocities  {_values(system.velocities, run.v)}",
    ]
    if declared := run._ready.declared:
        values = zip(declared.names, run.inputs, declared.of.units, strict=True)
        shown = (f"{name} = {value:.6g} {unit}".rstrip() for name, value, unit in values)
        lines.insert(2, f"  inputs      {', '.join(shown)}")
    return "\n".join(lines)


def _values(variables: Sequence[Any], values: Sequence[float]) -> str:
    shown = [f"{variable.name} = {value:.6g}{' ' + variable.unit if variable.unit else ''}"
             for variable, value in zip(variables[:MAX_VALUES], values, strict=False)]
    more = len(variables) - len(shown)
    return ", ".join([*shown, *([f"{more} more"] if more else [])]) or "none"
