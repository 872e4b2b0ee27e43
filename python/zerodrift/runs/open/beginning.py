"""Beginning of a run: its arguments, checked, and the core's run and record that are made from them."""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ..._private import checks, gateway
from ...errors import CompilationFailed, CostWarning, DrawingWarning, SingularSystem, WrongValue, advised
from ...systems.base import BaseSystem, closed_form_core_of, core_of, switches_of
from ..arguments import events as _events
from ..arguments import outputs as _outputs
from ..arguments import settings
from ..arguments.inputs import FOLLOWED, Declared, Speeds
from ..arguments.inputs import declared as declared_inputs
from ..arguments.settings import Arguments
from ..samples import recording
from ..states.instant import start_of

NOMINAL_STEPS = 1000    # of the span that serves the checks of the start as a scale of time, with fixed steps
NOMINAL_SPAN = 1.0      # s: the same with adaptive steps


class Prepared(NamedTuple):
    """Arguments of a run, checked and translated for the core."""

    system: BaseSystem              # as given; that of the run has inputs in the place of numbers
    span: tuple[float, float]       # s
    settings: dict[str, Any]        # by name, as in `Solution.settings`
    core_settings: Any              # the same as a `zd_settings`
    core: gateway.CoreSystem
    rows: int | None                # number of samples; None: not known in advance
    p0: np.ndarray
    v0: np.ndarray
    events: Any
    watcher: gateway.Watcher | None
    recorded: _outputs.Recorded | None
    path: Any                       # of the file that samples are written to; None: memory
    declared: Declared | None       # inputs
    inputs: gateway.Inputs | None
    source: gateway.CoreSystem     # core before it became that of one run
    measured_with_inputs: gateway.CoreSystem | None = None   # the system that has the measures, where there are inputs

    @property
    def outputs(self) -> gateway.Outputs | None:
        """Measures that are recorded."""
        return self.recorded.core if self.recorded else None

    def created(self, kind: Any = gateway.Run, saved: Any = None) -> Any:
        """The core's run; the error of a singular system is extended by the system's advice."""
        try:
            return kind(self.core, self.core_settings, self.p0, self.v0, self.watcher, self.outputs, self.inputs, saved)
        except SingularSystem as error:
            advice = self.system._advice(error)
            if advice is None:
                raise
            raise advised(error, advice) from None

    def record(self, run: gateway.Run) -> Any:
        """New record for the samples of the core's run, in memory or in the file, whose header is written."""
        if self.path:
            record = recording.file_of_samples().SampleFile(self.path, self.core, self.outputs, self.rows)
            recorded = self.recorded
            sizes = dict(zip(recorded.names, recorded.core.sizes, strict=True)) if recorded and recorded.core else {}
            record.begin({"settings": self.settings, "system": self.system, "t_span": self.span}, run.results().sizes, sizes)
            return record
        recording.check_memory(self.rows or 0, gateway.row_bytes(self.core, self.outputs), stacklevel=3)
        return gateway.Record(self.core, self.rows or recording.FIRST_BLOCK, self.outputs)

    @property
    def of(self) -> BaseSystem:
        """The system that is run, with inputs in the place of numbers."""
        return self.declared.of.system if self.declared else self.system

    @property
    def measured(self) -> gateway.CoreSystem | None:
        """The system that has the measures, with memory of one run, which is made when the first is read."""
        return self.measured_with_inputs or self.of._watching.core.for_run()

    def with_own(self, values: np.ndarray | None = None) -> Prepared:
        """The same with the memory of one run: inputs, in `values` if given, and records of events and outputs."""
        core, measured, inputs, recorded, watcher = self.source, None, None, None, None
        if self.declared:
            inputs, (core, measured) = self.declared.bound(core, self.of._watching.core, values=values)
        if (names := self.settings.get("outputs")) is not None:
            recorded = _outputs.Recorded(names, self.of, core, measured)
        if self.events is not None:
            watcher = gateway.Watcher(core, self.events, measured or self.of._watching.core, is_own=inputs is not None,
                                      places={**switches_of(self.of), **(self.declared.places() if self.declared else {})})
        return self._replace(core=core, measured_with_inputs=measured, inputs=inputs, recorded=recorded, watcher=watcher)


def prepared(system: Any, span: tuple[float, float], p0: Any, v0: Any, events: Any, outputs: Any, save_to: Any,
             arguments: Arguments, *, inputs: Any = None, speeds: Speeds = FOLLOWED, is_open: bool = False,
             stacklevel: int = 2) -> Prepared:
    """Check the arguments of a run. `is_open`: it has no end; `span` only serves the checks of its start."""
    system, p0, v0 = start_of(system, p0, v0, span[0])
    core_of(system)
    inputs = _with_inputs(inputs, _events.inputs_of(events, system))
    declared = declared_inputs(inputs, system, speeds, arguments.step)
    of = declared.of.system if declared else system
    if speeds.hold and of._groups:
        raise WrongValue(f"hold must be False for {of.name}, as impulses of drives do not know its contacts, stops and joints "
                         "that switch", "not-available")
    plan = settings.plan(of, span, arguments)
    plan.core_settings.is_open = is_open
    takes = not is_open and gateway.takes_closed_form(core_of(of), plan.core_settings)
    with contextlib.suppress(CompilationFailed):    # tables serve, as code was not asked for
        if takes and (steps := plan.steps) and (compiled := system._compiled_for(steps)) is not None:
            return prepared(compiled, span, p0, v0, events, outputs, save_to, arguments, inputs=inputs, speeds=speeds,
                            stacklevel=stacklevel + 1)
    core = closed_form_core_of(of, plan.settings["vector"], plan.core_settings)
    unit = gateway.closed_form_unit(core, plan.core_settings)
    plan.settings["vector"] = None if unit is None else settings.VECTOR_UNITS[unit]
    if declared:
        plan.settings.update(speeds.settings())
        if declared.names:
            plan.settings["inputs"] = list(declared.names)
    if outputs is not None:
        plan.settings["outputs"] = _outputs.names(outputs, of)
    starts_as_drawn = p0 is None and v0 is None
    p0, v0 = of._state_or_start(p0, v0, t=span[0])
    if starts_as_drawn and (said := of._drawn_open()):
        warnings.warn(said, DrawingWarning, stacklevel=stacklevel + 1)
    path = None if save_to is None else recording.file_of_samples().checked(save_to)
    if not is_open and (told := system._what_it_costs(plan.steps)):
        warnings.warn(told, CostWarning, stacklevel=stacklevel + 1)
    rows = None if is_open else plan.rows
    watched = _events.events(events, of, may_act=True)
    ready = Prepared(system, span, plan.settings, plan.core_settings, core, rows, p0, v0, watched, None, None,
                     path, declared, None, core)
    return ready.with_own()


def _with_inputs(inputs: Any, more: list[str]) -> Any:
    """The argument `inputs` with others."""
    if not more or isinstance(inputs, Mapping):
        return inputs if not more else {**dict.fromkeys(more), **inputs}
    given = [] if inputs is None else [inputs] if isinstance(inputs, str) or hasattr(inputs, "name") else list(inputs)
    return [*given, *(name for name in more if name not in [getattr(each, "name", each) for each in given])]


def nominal_span(t0: float, step: Any) -> tuple[float, float]:
    """Time span of a run without an end, which serves the checks of its start."""
    return t0, t0 + (NOMINAL_SPAN if step is None else NOMINAL_STEPS * checks.number("step", step, above=0, code="step-size"))
