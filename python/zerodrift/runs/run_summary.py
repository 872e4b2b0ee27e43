"""Summary of an open run, as `print(run)` shows it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .settings import corrections_of
from .summary import step_sizes

MAX_VALUES = 6     # coordinates shown


def run_summary(run: Any) -> str:
    """Lines on the present time, the methods, the inputs and the state of a run."""
    s, system = run.settings, run.system
    corrections = corrections_of(s) if s["stabilization"] else ["no stabilization", *corrections_of(s)]
    lines = [
        f"Run of {system.name}: t = {run.t:.9g} s after {run.steps} steps",
        f"  how         {s['formulation']}, {s['integrator']}, {step_sizes(s)}, {', '.join(map(str, corrections))}",
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
