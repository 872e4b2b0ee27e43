"""Runs that the core makes without Python: many in one call, from tables of parameters and starts."""

from __future__ import annotations

import time
from typing import Any, NamedTuple

import numpy as np

from .. import _check, _gateway
from ..runs import diagnosis, settings
from ..runs import events as events_of
from ..runs.operations import assembly
from ..runs.simulate import solution_of_rows
from ..runs.solution import Solution
from ..systems.base import BaseSystem, core_of, direct_core_of
from ..systems.tables import NumberTables
from .part import ROADS, Part, nothing
from .plan import OPTIONS, Plan

FEW_EVENTS = 16             # of each, in a run: so much room there is for them at first
MOST_NUMBERS = 2**21        # of what one call keeps, so that memory does not grow with the range


class Batch(NamedTuple):
    """What the core is told of all runs of a plan."""

    system: BaseSystem                      # whose numbers vary
    options: Any                            # of the core
    rows: int                               # that a run saves at most
    columns: dict[str, tuple[str, int]]     # where each output is: in "p", "v" or "multipliers"
    direct: tuple[str, bool] | None         # the vector unit of direct functions, and whether they embed; None: none are taken
    assembly: _gateway.Assembly | None      # how starts are made consistent; None: they are taken as they are
    chosen: dict[str, Any]                  # as `Solution.settings` has them; the options refer to the memory of t_eval
    events: _gateway.Watcher | None         # which the core knows

    @property
    def runs_at_once(self) -> int:
        """In one call."""
        groups = {group for group, _ in self.columns.values()}
        of_rows = self.rows * (1 + len(groups) * max(self.system.nq, self.system.nv, self.system.m))
        return max(1, MOST_NUMBERS // (of_rows + FEW_EVENTS * (len(self.events.events) if self.events else 0)))


def batch_of(plan: Plan) -> Batch | None:
    """What is known of a plan; None where its runs need Python, or nobody knows how many rows they have."""
    if "batch" not in plan.remembered:
        plan.remembered["batch"] = _batch(plan)
    return plan.remembered["batch"]


def _batch(plan: Plan) -> Batch | None:
    runs, system, options = plan.runs, plan.runs.made, OPTIONS | plan.options
    if plan.reduce is not None or plan.keeps or not isinstance(system, BaseSystem):
        return None
    watched = events_of.events(options.pop("events"), system)
    if watched is not None and not _are_known(watched, system, set(runs.parameters)):
        return None
    columns = _columns(system, plan.names)
    if columns is None or not plan.is_tabular:
        return None
    found = settings.plan(system, _check.span(plan.t_span), **options)
    if found.rows is None:
        return None
    takes_direct = _gateway.takes_direct(core_of(system), found.options)
    direct = (found.chosen["vector"], _gateway.takes_embeddings(found.options)) if takes_direct else None
    system._number_tables(runs.parameters_from(0, 1), 1, direct)    # what has to be compiled is compiled here, once
    return Batch(system, found.options, found.rows, columns, direct,
                 assembly(system, runs.hold) if runs.assembles(system) else None, found.chosen,
                 None if watched is None else _gateway.Watcher(core_of(system), watched, core_of(system)))


def _are_known(watched: tuple[events_of.Watched, ...], system: BaseSystem, varied: set[str]) -> bool:
    """Whether the core evaluates all events without Python, and they are the same for all runs."""
    has_measures = system._watching.core is core_of(system)
    return all(event.known is not None and (has_measures or not event.known.is_measured) and not event.known.parameters & varied
               for event in watched)


def _columns(system: BaseSystem, names: tuple[str, ...]) -> dict[str, tuple[str, int]] | None:
    """Where outputs are among the numbers of a row; None where one of them is elsewhere."""
    known: dict[str, list[tuple[str, int]]] = {}
    for group, variables in {"p": system.coordinates, "v": system.velocities, "multipliers": system.constraints}.items():
        for column, variable in enumerate(variables):
            known.setdefault(variable.name, []).append((group, column))
    if any(len(known.get(name, ())) != 1 or system._watching.find(name) is not None for name in names):
        return None
    return {name: known[name][0] for name in names}


def batch_range(plan: Plan, batch: Batch, first: int, last: int, stop: _gateway.Stop | None) -> Part:
    """The runs first ... last - 1; fewer where they are stopped."""
    made, tables = _make(plan, batch, first, last, ("t", *(group for group, _ in batch.columns.values())), stop)
    count = int(np.argmax(paused)) if (paused := made.status == _gateway.PAUSED).any() else last - first
    if not count:
        return nothing(0)
    doubtful = ~diagnosis.are_beyond_doubt(made.statistics, made.kinetic, made.energy_error)
    return _part(plan, batch, made, _messages(made, tables), doubtful[:count])


def _make(plan: Plan, batch: Batch, first: int, last: int, wanted: tuple[str, ...],
          stop: _gateway.Stop | None = None) -> tuple[_gateway.BatchResults, NumberTables]:
    tables = batch.system._number_tables(plan.runs.parameters_from(first, last), last - first, batch.direct)
    p0, v0 = plan.runs.starts(tables, first, last)
    room = plan.remembered.setdefault("events", FEW_EVENTS)
    while True:
        made = _gateway.run_batch(tables.core, batch.options, tables.data, tables.size, p0, v0, batch.rows,
                                  tuple(dict.fromkeys(wanted)), batch.assembly, stop, events=batch.events, room=room)
        most = 0 if made.events is None else int(made.events.count.max(initial=0))
        if most <= room:
            return made, tables
        room = plan.remembered["events"] = most     # once more, with room for all


STATES = ("t", "p", "v", "input", "multipliers", *_gateway.COUNTS)


def made_again(plan: Plan, run: int) -> Solution:
    """One run by itself, with the bits that it has among others."""
    return _solution_in_lanes(plan, run) or plan.solution(run)


def _solution_in_lanes(plan: Plan, run: int) -> Solution | None:
    """None where it is not made in lanes."""
    batch, begin = batch_of(plan), time.perf_counter()
    if batch is None:
        return None
    made, _ = _make(plan, batch, run, run + 1, STATES)
    if made.way[0] != _gateway.IN_LANES:
        return None
    states = {name: column[0, :made.rows[0]] for name, column in made.columns.items()}
    system, span = plan.runs.system(run), _check.span(plan.t_span)
    core = direct_core_of(system, batch.chosen["vector"], batch.options)
    p0, v0 = system._state_or_start(*plan.runs.start(run, system, span[0]), t=span[0])
    again, record = _gateway.Run(core, batch.options, p0, v0), _gateway.Record(core, max(1, len(states["t"])))
    again.record_states(record, states)
    rows = record.take()
    for name in ("multipliers", *_gateway.COUNTS):
        rows[name][:] = states[name]
    results = again.results()._replace(statistics=_gateway.Statistics(*made.statistics[0].tolist()),
                                       largest_kinetic=float(made.kinetic[0]))
    return solution_of_rows(system, span, batch.chosen, record, results, time.perf_counter() - begin, int(made.status[0]),
                            made.messages[0] or "done", None if made.events is None else made.events.of(0))


def _part(plan: Plan, batch: Batch, made: _gateway.BatchResults, messages: list[str], doubtful: np.ndarray) -> Part:
    """The first of the runs, as many as were made."""
    count = len(doubtful)
    rows, t = made.rows[:count], made.columns["t"][:count]
    if plan.t_eval is not None:     # a run that ends between two of these has its end besides
        rows = np.minimum(rows, len(plan.t_eval))
        is_other = (rows > 0) & (t[np.arange(count), rows - 1] != plan.t_eval[rows - 1])
        rows = rows - is_other
    kept = np.arange(batch.rows) < rows[:, None]
    longest = t[np.argmax(rows), :rows.max(initial=0)]
    is_shared = (np.where(kept[:, :len(longest)], t[:, :len(longest)], longest) == longest).all()
    none = [None] * count
    t_events = none if made.events is None else [made.events.of(run)[0] for run in range(count)]
    ended = np.isin(made.status[:count], (_gateway.DONE, _gateway.EVENT))
    roads = np.where(made.way[:count] == _gateway.IN_LANES, ROADS.index("vector lanes"), ROADS.index("the ordinary road"))
    return Part(rows, longest.copy() if is_shared else t[kept],
                {name: made.columns[group][:count, :, column][kept] for name, (group, column) in batch.columns.items()},
                ~ended, messages[:count], roads.astype(np.uint8), doubtful, none, t_events, none)


def _messages(made: _gateway.BatchResults, tables: NumberTables) -> list[str]:
    """What happened to each run; to one that did not begin, as its error says it."""
    if not (made.status.any() or tables.refused):
        return ["done"] * len(made.status)
    said = []
    for run, (status, way, message) in enumerate(zip(made.status.tolist(), made.way.tolist(), made.messages, strict=True)):
        if run in tables.refused:
            said.append(tables.refused[run])
        elif status < 0 and way == _gateway.NOT_BEGUN:
            said.append(f"{_gateway.error_name(status)}: {message}")
        else:
            said.append(message or "done")
    return said
