"""Batches: many runs in one call of the core, from tables of parameters and initial states, without Python."""

from __future__ import annotations

import time
from typing import Any, NamedTuple

import numpy as np

from .._private import checks, gateway
from ..mechanisms.system import MechanismSystem
from ..runs.arguments import events as events_of
from ..runs.arguments import settings
from ..runs.arguments.inputs import FOLLOWED, Declared
from ..runs.arguments.inputs import declared as declared_inputs
from ..runs.open import diagnosis
from ..runs.open.ending import solution_of_rows
from ..runs.samples.solution import Solution
from ..runs.simulate import simulate
from ..runs.states.operations import assembly
from ..systems.base import BaseSystem, closed_form_core_of, core_of, with_what_it_takes
from ..systems.parameter_tables import NumberTables
from .part import BY_CORE, IN_LANES, Part, nothing
from .plan import Plan

FEW_EVENTS = 16             # occurrences of each event in a run for which memory is allocated initially
MAX_NUMBERS = 2**21        # numbers that one call may return, which bounds its memory


class Batch(NamedTuple):
    """Arguments of the core that all runs of a plan share."""

    system: BaseSystem                      # system whose parameters vary
    core_settings: Any                      # the same as a `zd_settings`
    rows: int                               # largest number of samples of a run
    columns: dict[str, tuple[str, Any]]     # group ("p", "v", "multipliers", "outputs") and column or columns of each output
    outputs: gateway.Outputs | None        # measures that the core records
    closed_form: tuple[str, bool] | None    # vector unit of the closed-form functions, and whether they embed; None: matrix path
    assembly: gateway.Assembly | None      # settings that make starts consistent; None: starts are used unchanged
    settings: dict[str, Any]                # as in `Solution.settings`; keeps t_eval alive, to which `core_settings` points
    events: gateway.Watcher | None         # events that the core evaluates
    numbers: int                            # approximate count of numbers in the tables of one run
    declared: Declared | None               # inputs that events set, in SIMD lanes

    def core_of(self, tables: NumberTables) -> gateway.CoreSystem:
        """System in the core whose functions all runs call."""
        return with_what_it_takes(self.system, tables.core, self.settings["vector"], self.core_settings)

    @property
    def runs_at_once(self) -> int:
        """Largest number of runs in one call."""
        groups = {group for group, _ in self.columns.values()}
        most = max(self.system.nq, self.system.nv, self.system.m, self.outputs.width if self.outputs else 0)
        of_rows = self.rows * (1 + len(groups) * most)
        of_events = FEW_EVENTS * (len(self.events.events) if self.events else 0)
        return max(1, MAX_NUMBERS // max(of_rows + of_events, self.numbers))


def batch_of(plan: Plan) -> Batch | None:
    """Batch of a plan; None if its runs need Python, or if the number of samples is not known in advance."""
    if "batch" not in plan.remembered:
        plan.remembered["batch"] = _batch(plan)
    return plan.remembered["batch"]


def _batch(plan: Plan) -> Batch | None:
    runs, system, options = plan.runs, plan.runs.made, plan.options.copy()
    if plan.reduce is not None or plan.keeps or not isinstance(system, BaseSystem):
        return None
    events = options.pop("events", None)
    watched, places = events_of.events(events, system), None
    declared = declared_inputs(events_of.inputs_of(events, system) or None, system, FOLLOWED, options.get("step"))
    if declared:
        places = declared.places()
        if plan.t_eval is None or places.keys() & runs.parameters.keys():
            return None
    if watched is not None and not _are_known(watched, system, set(runs.parameters)):
        return None
    if not plan.is_tabular:
        return None
    span = checks.span(plan.t_span)
    found = settings.plan(system, span, settings.Arguments(**options))
    if found.rows is None:
        return None
    takes_closed_form = gateway.takes_closed_form(core_of(system), found.core_settings)
    closed_form = (found.settings["vector"], gateway.takes_embeddings(found.core_settings)) if takes_closed_form else None
    tables = runs.tables(system, 0, 1, closed_form)      # closed-form functions are compiled here, once
    found_columns = _columns(system, plan.names, system._watching.core if tables is None else tables.core)
    family = None if tables is None else tables.family
    if found_columns is None or (family is not None and (watched is not None or (family.drives and span[0] != 0))) or (
            declared and (tables is None or tables.data is None)):
        return None
    batch = Batch(system, found.core_settings, found.rows, *found_columns, closed_form,
                  assembly(system, runs.hold) if runs.assembles(system) else None, found.settings,
                  None if watched is None else gateway.Watcher(core_of(system), watched, core_of(system), places=places),
                  0 if family is None else family.numbers, declared)
    if tables is not None:
        batch.core_of(tables)       # raises an error for a system without Taylor coefficients before the runs start
    return batch


def _are_known(watched: tuple[events_of.Watched, ...], system: BaseSystem, varied: set[str]) -> bool:
    """True if the core evaluates all events without Python and none depends on a varied parameter."""
    has_measures = system._watching.core is core_of(system)
    known = [event.known for event in watched if event.known is not None and not event.known.is_called]
    return len(known) == len(watched) and all((has_measures or not event.is_measured) and not event.parameters & varied
                                              for event in known)


ANGLES = ("angle", "angular_velocity")      # measures of bodies that are also coordinates or velocities of the same name


def _columns(system: BaseSystem, names: tuple[str, ...],
             core: gateway.CoreSystem) -> tuple[dict[str, tuple[str, Any]], gateway.Outputs | None] | None:
    """Columns of the outputs in a sample, and the measures to record; None if the core cannot record one of the outputs."""
    groups = "p", "v", "multipliers"
    known = {name: [(groups[group], column) for group, column in found] for name, found in system._columns_of.items()}
    measured = {name: place for name in names if (place := system._watching.find(name)) is not None
                and not (len(known.get(name, ())) == 1 and name.rpartition(".")[2] in ANGLES)}
    if any(len(known.get(name, ())) != 1 for name in names if name not in measured):
        return None
    numbers = list(dict.fromkeys(place.number for place in measured.values()))
    outputs = gateway.Outputs(numbers, system._watching.core, core) if numbers else None
    sizes = outputs.sizes if outputs else ()
    ends = np.cumsum([0, *sizes]).tolist()
    columns: dict[str, tuple[str, Any]] = {name: known[name][0] for name in names if name not in measured}
    for name, place in measured.items():
        begin, size = ends[numbers.index(place.number)], sizes[numbers.index(place.number)]
        is_one = size == 1 or place.component is not None
        columns[name] = "outputs", begin + (place.component or 0) if is_one else slice(begin, begin + size)
    return {name: columns[name] for name in names}, outputs


def batch_range(plan: Plan, batch: Batch, first: int, last: int, stop: gateway.Stop | None) -> tuple[Part, list[int]] | None:
    """Make the runs first ... last - 1, or fewer if stopped; also return the indices of those left for `simulate`.

    None if the runs differ in more than numbers and must be made individually.
    """
    tables = plan.runs.tables(batch.system, first, last, batch.closed_form)
    if tables is None:
        return None
    made = _make(plan, batch, tables, first, last, ("t", *(group for group, _ in batch.columns.values())), stop)
    count = int(np.argmax(paused)) if (paused := made.status == gateway.PAUSED).any() else last - first
    if not count:
        return nothing(0), []
    doubtful = ~diagnosis.are_beyond_doubt(made.statistics, made.kinetic, made.energy_error)
    left = np.flatnonzero((made.way[:count] == gateway.UNUSUAL) | plan.runs.are_not_finite(first, first + count))
    return _part(plan, batch, made, _messages(made, tables), doubtful[:count]), (left + first).tolist()


def _make(plan: Plan, batch: Batch, tables: NumberTables, first: int, last: int, wanted: tuple[str, ...],
          stop: gateway.Stop | None = None) -> gateway.BatchResults:
    p0, v0 = plan.runs.starts(tables, first, last)
    core, inputs = batch.core_of(tables), None
    if batch.declared:
        inputs, (core,) = batch.declared.bound(core)
    systems = tables._replace(core=core, p0=p0, v0=v0)
    room = plan.remembered.setdefault("events", FEW_EVENTS)     # occurrences of an event that fit into memory
    while True:
        made = gateway.run_batch(systems, batch.core_settings, last - first, batch.rows, tuple(dict.fromkeys(wanted)),
                                  batch.assembly, stop, outputs=batch.outputs, events=batch.events, room=room,
                                  inputs=inputs)
        most = 0 if made.events is None else int(made.events.counts.max(initial=0))
        if most <= room:
            return made
        room = plan.remembered["events"] = most     # repeat with memory for all occurrences


STATES = ("t", "p", "v", "input", "multipliers", *gateway.COUNTS)


def made_again(plan: Plan, run: int) -> Solution:
    """Repeat one run individually, bitwise equal to the run in the batch; to rounding, if events set inputs."""
    batch = batch_of(plan)
    tables = None if batch is None else plan.runs.tables(batch.system, run, run + 1, batch.closed_form)
    if batch is None or tables is None or batch.declared:
        return plan.solution(run)
    if tables.family is not None:
        return _solution_of_family(plan, batch, tables, run)
    return _solution_in_lanes(plan, batch, tables, run) or plan.solution(run)


def _solution_of_family(plan: Plan, batch: Batch, tables: NumberTables, run: int) -> Solution:
    """Solution from the start that the core assembled, which differs from Python's by rounding."""
    start = tables.family.start(0, batch.system.nq, batch.system.nv)
    if plan.runs.states or start is None:
        return plan.solution(run)
    p0, v0, places = start
    recorded = [name for name, (group, _) in batch.columns.items() if group == "outputs"]
    system = plan.runs.system(run)
    if places and isinstance(system, MechanismSystem):
        system = system._driven_from(places)
    return simulate(system, plan.t_span, p0, v0, **plan.options, outputs=recorded or None)


def _solution_in_lanes(plan: Plan, batch: Batch, tables: NumberTables, run: int) -> Solution | None:
    """Solution of a run made in SIMD lanes; None if this run is not."""
    begin = time.perf_counter()
    made = _make(plan, batch, tables, run, run + 1, STATES)
    if made.way[0] != gateway.IN_LANES:
        return None
    states = {name: column[0, :made.samples[0]] for name, column in made.columns.items()}
    system, span = plan.runs.system(run), checks.span(plan.t_span)
    core = closed_form_core_of(system, batch.settings["vector"], batch.core_settings)
    p0, v0 = system._state_or_start(*plan.runs.start(run, system, span[0]), t=span[0])
    again, record = gateway.Run(core, batch.core_settings, p0, v0), gateway.Record(core, max(1, len(states["t"])))
    again.record_states(record, states)
    rows = record.take()
    for name in ("multipliers", *gateway.COUNTS):
        rows[name][:] = states[name]
    results = again.results()._replace(statistics=gateway.Statistics(*made.statistics[0].tolist()),
                                       largest_kinetic=float(made.kinetic[0]))
    return solution_of_rows(system, span, batch.settings, record, results, time.perf_counter() - begin, int(made.status[0]),
                            made.messages[0] or "done", None if made.events is None else made.events.of(0), again.transitions)


def _part(plan: Plan, batch: Batch, made: gateway.BatchResults, messages: list[str], doubtful: np.ndarray) -> Part:
    """Part with the runs that were made."""
    count = len(doubtful)
    rows, t, kept = _kept(plan, made.samples[:count], made.columns["t"][:count])
    none = [None] * count
    t_events = none if made.events is None else [made.events.of(run)[0] for run in range(count)]
    status = made.status[:count]
    ended = (status == gateway.DONE) | (status == gateway.EVENT)
    paths = np.where(made.way[:count] == gateway.IN_LANES, IN_LANES, BY_CORE).astype(np.uint8)
    arrays = {name: _rows(made.columns[group][:count, :, column], kept) for name, (group, column) in batch.columns.items()}
    arrays |= {name: place.pick(arrays[name]) for name in arrays if (place := batch.system._watching.find(name)) and place.form}
    return Part(rows, t, arrays, ~ended, messages[:count], paths, doubtful, none, t_events, none)


def _kept(plan: Plan, rows: np.ndarray, t: np.ndarray) -> tuple[np.ndarray, np.ndarray, slice | np.ndarray]:
    """Numbers of samples that each run keeps, their times in the layout of `Part.t`, and a mask or slice that selects them."""
    wanted, count = plan.t_eval, rows[0]
    times = t[0, :count] if wanted is None else wanted
    if count == len(times) and (rows == count).all() and (t[:, :count] == times).all():     # the usual case
        return rows, times.copy(), slice(count)
    if wanted is not None:      # a run that ends between two output times has its end as an additional sample: drop it
        rows = np.minimum(rows, len(wanted))
        is_other = (rows > 0) & (t[np.arange(len(rows)), rows - 1] != wanted[rows - 1])
        rows = rows - is_other
    kept = np.arange(t.shape[1]) < rows[:, None]
    longest = t[np.argmax(rows), :rows.max(initial=0)]
    is_shared = (np.where(kept[:, :len(longest)], t[:, :len(longest)], longest) == longest).all()
    return rows, longest.copy() if is_shared else t[kept], kept


def _rows(column: np.ndarray, kept: slice | np.ndarray) -> np.ndarray:
    """Samples that are kept of a column (n, rows, ...), concatenated over the runs."""
    return np.array(column[:, kept]).reshape(-1, *column.shape[2:]) if isinstance(kept, slice) else column[kept]


def _messages(made: gateway.BatchResults, tables: NumberTables) -> list[str]:
    """Message of each run; for a run that could not start, its error."""
    if not (made.status.any() or tables.refused):
        return ["done"] * len(made.status)
    said = []
    for run, (status, way, message) in enumerate(zip(made.status.tolist(), made.way.tolist(), made.messages, strict=True)):
        if run in tables.refused:
            said.append(tables.refused[run])
        elif status < 0 and way == gateway.NOT_BEGUN:
            said.append(f"{gateway.error_name(status)}: {message}")
        else:
            said.append(message or "done")
    return said
