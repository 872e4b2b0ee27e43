"""Ensembles in NPZ files: arrays, and a description in JSON; no pickle."""

from __future__ import annotations

import json
import zipfile
import zlib
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .._private import checks
from .._private.writing import write_arrays
from ..errors import WrongType, ZerodriftError
from ..runs.samples import saving
from ..systems.base import BaseSystem
from .part import Part
from .plan import Plan
from .runs import Runs

KEY = "zerodrift"       # of the description among the arrays
WHAT = "ensemble"
DONE = "done"           # what most runs say, which is not written


# ---- parts ----


def packed_part(part: Part) -> dict[str, np.ndarray]:
    """A part as arrays, one of which is a JSON text."""
    arrays = {"rows": part.rows, "t": part.t, "failed": part.failed, "roads": part.paths,
              "doubtful": part.doubtful}
    arrays |= {place: part.arrays[name] for name, place in places_of(part.arrays).items()}
    values, stacked = _packed_values(part.values)
    return {KEY: np.array(json.dumps({
        "outputs": list(part.arrays), "messages": {i: each for i, each in enumerate(part.messages) if each != DONE},
        "values": values, "t_events": [None if each is None else [times.tolist() for times in each] for each in part.t_events],
    })), **arrays, **stacked}


def places_of(names: Iterable[str]) -> dict[str, str]:
    """Name of the array of each output in a file."""
    return {name: f"outputs.{i}" for i, name in enumerate(names)}


def _packed_values(values: list[Any]) -> tuple[Any, dict[str, np.ndarray]]:
    """Values of `reduce`: arrays of equal shape as one array, others as JSON."""
    known = [each for each in values if each is not None]
    if known and all(isinstance(each, np.ndarray) and each.dtype == known[0].dtype and each.shape == known[0].shape
                     and each.dtype.kind in "biufc" for each in known):
        return [each is not None for each in values], {"values": np.stack(known)}
    return {"json": [value_as_json(each) for each in values]}, {}


def unpacked_part(arrays: dict[str, np.ndarray]) -> Part:
    """Part from the arrays of a file."""
    described = json.loads(str(arrays[KEY]))
    messages, count = described["messages"], len(arrays["rows"])
    events = [None if each is None else tuple(np.array(times, dtype=float) for times in each) for each in described["t_events"]]
    return Part(arrays["rows"], arrays["t"], {name: arrays[place] for name, place in places_of(described["outputs"]).items()},
                arrays["failed"], [messages.get(str(i), DONE) for i in range(count)], arrays["roads"],
                arrays["doubtful"], _unpacked_values(described["values"], arrays), events, [None] * count)


def _unpacked_values(described: Any, arrays: dict[str, np.ndarray]) -> list[Any]:
    if isinstance(described, dict):
        return [value_from_json(each) for each in described["json"]]
    known = iter(arrays["values"])
    return [next(known) if there else None for there in described]


def value_as_json(value: Any) -> Any:
    """A value that `reduce` returned, in the types of JSON.

    Raises
    ------
    TypeError
        If it is of a kind that would not come back as it is.
    """
    if isinstance(value, np.generic) and value.dtype.kind in "biuf":
        return value.item()
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, np.ndarray) and value.dtype.kind in "biuf":
        return {"array": value.tolist(), "dtype": value.dtype.str, "shape": value.shape}
    if isinstance(value, list):
        return [value_as_json(each) for each in value]
    if isinstance(value, tuple) and not hasattr(value, "_fields"):
        return {"tuple": [value_as_json(each) for each in value]}
    if isinstance(value, dict) and all(isinstance(key, str) for key in value):
        return {"dict": {key: value_as_json(each) for key, each in value.items()}}
    raise WrongType(f"reduce must return what a file keeps: numbers, strings, arrays of numbers, and lists, tuples and dicts of "
                    f"these, not {checks.shown(value)}", "not-portable")


def value_from_json(value: Any) -> Any:
    """Value of `reduce` from its JSON."""
    if isinstance(value, list):
        return [value_from_json(each) for each in value]
    if not isinstance(value, dict):
        return value
    if "array" in value:
        return np.array(value["array"], dtype=value["dtype"]).reshape(value["shape"])
    if "tuple" in value:
        return tuple(value_from_json(each) for each in value["tuple"])
    return {key: value_from_json(each) for key, each in value["dict"].items()}


# ---- plans ----


def packed_plan(plan: Plan | Kept) -> dict[str, np.ndarray]:
    """A plan without its functions, as arrays, one of which is a JSON text."""
    runs = plan.runs
    starts = {name: array for name, (array, _) in runs.start_values.items()}
    groups = {"parameters": runs.parameters, "start": starts, "states": runs.states}
    description = {
        "kind": WHAT, "t_span": list(checks.span(plan.t_span)), "names": plan.names, "units": plan.units, "shape": runs.shape,
        "count": runs.count,
        "settings": {name: saving.to_json(value.item() if isinstance(value, np.generic) else value)
                     for name, value in plan.options.items() if name != "events"},
        "assembles": runs.may_assemble, "hold": names_of(runs.hold),
        "varies": [varies for _, varies in runs.start_values.values()],
        "is_tabular": plan.is_tabular if isinstance(plan, Kept) else plan.is_tabular and plan.reduce is None and not plan.keeps,
        "system": runs.made._described() if isinstance(runs.made, BaseSystem) else None, "why_not": why_not(plan),
        **{kind: list(group) for kind, group in groups.items()}}
    arrays = {f"{kind}.{i}": array for kind, group in groups.items() for i, array in enumerate(group.values())}
    return {KEY: np.array(json.dumps(description)), **arrays}


def why_not(plan: Plan | Kept) -> str | None:
    """Reason why runs cannot be repeated from a saved plan; None if they can."""
    if isinstance(plan, Kept):
        return plan.why_not
    if not isinstance(plan.runs.made, BaseSystem):
        return "a function made its system, which a file does not keep"
    return None if plan.options.get("events") is None else "it had events, which a file does not keep"


def names_of(hold: Any) -> list[str]:
    """Names in the argument `hold`."""
    several = [hold] if isinstance(hold, str) or hasattr(hold, "name") else hold
    return [getattr(each, "name", each) for each in several]


class Kept(NamedTuple):
    """Saved part of a plan, for reading results; runs can be repeated from it if the plan had no functions."""

    runs: Runs
    t_span: Any
    options: dict[str, Any]
    names: tuple[str, ...]
    units: dict[str, str]
    is_tabular: bool        # whether the core made its runs from tables, which tells their bits
    why_not: str | None     # why runs cannot be made again

    @property
    def t_eval(self) -> np.ndarray | None:
        """Output times; None if each run has its own."""
        return self.options.get("t_eval")

    def to_run(self, run: int) -> Plan:
        """Plan by which a run can be repeated; an error if functions are missing."""
        if self.why_not:
            raise ZerodriftError(f"run {run} cannot be made again, as {self.why_not}: call zd.ensemble again")
        return Plan(self.runs, self.t_span, self.options, self.names, is_tabular=self.is_tabular)


def unpacked_plan(arrays: dict[str, np.ndarray], rebuilt: Callable[[dict[str, Any]], Any]) -> Kept:
    """Plan from the arrays of a file; `rebuilt` makes the system of a mechanism from JSON."""
    described = json.loads(str(arrays[KEY]))
    names = {kind: described[kind] for kind in ("parameters", "start", "states")}
    table = {kind: {name: arrays[f"{kind}.{i}"] for i, name in enumerate(each)} for kind, each in names.items()}
    made, reason = None, described["why_not"]
    if described["system"] is not None:
        made = saving.restored_system(described["system"], rebuilt)
        made = made._by_matrices() if names["parameters"] else made
        if isinstance(made, saving.Described):
            reason = f"of {made.name} only the description was kept"
    runs = object.__new__(Runs)
    vars(runs).update(made=made, parameters=table["parameters"], states=table["states"], count=described["count"],
                      start_values={name: (array, varies) for (name, array), varies
                             in zip(table["start"].items(), described["varies"], strict=True)},
                      shape=tuple(described["shape"]), hold=described["hold"], may_assemble=described["assembles"])
    settings = {name: saving.from_json(value) for name, value in described["settings"].items()}
    return Kept(runs, tuple(described["t_span"]), settings, tuple(described["names"]), described["units"],
                described["is_tabular"], reason)


# ---- files ----


def write(path: Path, plan: Plan | Kept, part: Part) -> None:
    """Write an ensemble to an NPZ file."""
    arrays = {f"runs.{name}": array for name, array in packed_part(part).items()}
    arrays |= packed_plan(plan)
    write_arrays(path, arrays, np.savez_compressed)


def read(path: str | Path, rebuilt: Callable[[dict[str, Any]], BaseSystem]) -> tuple[Kept, Part] | None:
    """Ensemble in a file; None if the file has something else."""
    if not is_ensemble(path):
        return None
    arrays = saving.read_arrays(path)
    part = {name.removeprefix("runs."): array for name, array in arrays.items() if name.startswith("runs.")}
    return unpacked_plan(arrays, rebuilt), unpacked_part(saving.Arrays(path, part))


def is_ensemble(path: str | Path) -> bool:
    """Return whether a file has an ensemble."""
    try:
        with open(path, "rb") as opened, np.load(opened, allow_pickle=False) as file:
            return KEY in file.files and json.loads(str(file[KEY])).get("kind") == WHAT
    except (zipfile.BadZipFile, zlib.error, ValueError, EOFError):      # a file that is cut short, or of another kind
        return False
