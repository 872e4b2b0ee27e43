"""Runs that `reference` compares: with fixed steps, in any formulation, optionally perturbed by rounding."""

from __future__ import annotations

import copy
import itertools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .._private import gateway
from ..errors import ZerodriftError
from ..runs.arguments import methods, settings
from ..runs.open.diagnosis import unwarned
from ..runs.open.threads import side_by_side
from ..runs.samples.solution import Solution
from ..runs.simulate import simulate
from ..systems.base import BaseSystem, core_of

SERIES: Any = "taylor"   # integrator of arbitrary order
EPS = float(np.finfo(float).eps)
PROBE = 1e-5        # tolerance of the adaptive run that determines the number of steps
SAMPLES = 240       # of a motion with contacts, at least
ONE_INSTANT = 1e-9  # part of the span; changes of phase that are closer count as one
UNIT = 3            # numbers of steps are multiples of this, as other runs have two and five thirds of them


class Difference(NamedTuple):
    """Largest differences of a run from the solution, with the settings of the run."""

    steps: int
    formulation: str
    p: float
    v: float
    integrator: str
    rounded: bool


class Perturbed(BaseSystem):
    """A system whose arguments and terms are perturbed by rounding."""

    def __init__(self, system: BaseSystem, seed: int, size: float = EPS) -> None:
        self.name, self.parameters, self.p0, self.v0 = system.name, system.parameters, None, None
        self.coordinates, self.velocities, self.constraints = system.coordinates, system.velocities, system.constraints
        self._core, self._system = gateway.perturbed(core_of(system), size, seed), system
        self._groups, self._latches, self._watching = system._groups, system._latches, system._watching

    def _with_series(self, core: Any, vector: str = "baseline") -> gateway.CoreSystem:
        return self._system._with_series_of_perturbed(core, vector)

    def shifted(self, x: np.ndarray, seed: int) -> np.ndarray:
        """A state with each entry perturbed by one or two units of rounding."""
        return x * (1.0 + EPS * np.random.default_rng(seed).choice([-2.0, -1.0, 1.0, 2.0], x.shape))


@dataclass(frozen=True)
class Way:
    """Settings of a run: number of steps, formulation, integrator, and seed of its perturbation by rounding (0: none)."""

    steps: int
    formulation: Any
    integrator: Any
    rounding: int = 0
    is_elsewhere: bool = False      # in the other coordinates of a mechanism


class Motion:
    """The motion of a reference: its runs, its size and its speed."""

    def __init__(self, system: BaseSystem, span: tuple[float, float], p0: Any, v0: Any, t_eval: Any, stabilization: Any,
                 formulation: Any, bounds: dict[str, Any]) -> None:
        self.system, self.span, self.t_eval, self.stabilization = system, span, t_eval, stabilization
        self.start = system._state_or_start(p0, v0, t=span[0])
        self.is_own_start = p0 is None and v0 is None
        self._made_before: dict[tuple[Way, int | None], Solution | Exception | None] = {}
        self.bounded = bounds["max_step"] is not None
        self.is_plain = system._has_plain_laws
        self.elsewhere: Any = system._in_other_coordinates() if p0 is None and v0 is None else None
        self.elsewhere_failed = False
        taken = methods.evaluating_integrators(system)
        self.method, self.other = sorted(taken, key=lambda name: -taken[name].order)[:2]    # stable: table order for equal orders
        with unwarned():
            probe = simulate(system, span, p0, v0, rtol=PROBE, atol=PROBE, formulation=formulation, integrator=self.method,
                             stabilization=stabilization, closed_form=False, **bounds)
        self.size, self.probe, self.bounds = float(np.abs(probe.p).max()), probe, bounds
        self.speed = float(_rates(probe.t, probe.p).max(initial=0.0))
        max_move = bounds.get("max_move")
        longest = min(bounds["max_step"] or math.inf, max_move / self.speed if max_move and self.speed else math.inf)
        self.most = math.ceil((span[1] - span[0]) / longest) or 1
        self.steps = UNIT * math.ceil(max(probe.stats["steps"], self.most) / UNIT)
        self.disagreement = ""      # first difference between the phases of runs, in words
        if system._groups and t_eval is None:       # steps end at changes of phase, each run's own
            self.t_eval = np.linspace(*span, max(self.steps, SAMPLES) + 1)
        self.shift = [_shift(probe.t, x) for x in (probe.p, probe.v)]

    def shift_at(self, samples: np.ndarray) -> list[float]:
        """Largest changes of p and v at samples by rounding of the time."""
        return [_shift(self.probe.t, x, samples) for x in (self.probe.p, self.probe.v)]

    def follows_series(self, formulation: Any) -> bool:
        """True if Taylor's method can integrate the system in this formulation."""
        chosen = self.probe.settings | {"integrator": SERIES, "formulation": formulation}
        return self.system._brings_perturbed_series and not settings.disagreement(chosen)

    def by_series(self, formulation: Any) -> Motion:
        """The same motion by Taylor's method in this formulation; the method used so far becomes the one that checks it."""
        found = copy.copy(self)
        found.method, found.other = SERIES, self.method
        with unwarned():
            probe = simulate(self.system, self.span, *self.start, rtol=PROBE, atol=PROBE, formulation=formulation,
                             integrator=SERIES, stabilization=self.stabilization, closed_form=False, **self.bounds)
        found.steps = UNIT * math.ceil(max(probe.stats["steps"], self.most) / UNIT)
        return found

    def run(self, way: Way, rows: int | None = None) -> Solution | None:
        """Solution of a run with `rows` samples after the first; None if it failed, as its steps were too long."""
        if (way, rows) in self._made_before:
            made = self._made_before.pop((way, rows))
            if isinstance(made, Exception):
                raise made
            return made
        with unwarned():
            return self._run(way, rows)

    def run_side_by_side(self, ways: Sequence[Way], steps: int) -> None:
        """Make the runs that `difference` will need in advance, in threads, unless they call Python functions."""
        def make(asked: tuple[Way, int], stop: gateway.Stop | None) -> None:
            try:
                self._made_before[asked] = self._run(*asked, stop)
            except Exception as error:      # raised by `run`
                self._made_before[asked] = error

        self._made_before.clear()
        if core_of(self.system).for_run() is core_of(self.system):
            with unwarned():        # around all threads, which share the filters of warnings
                side_by_side(make, [(way, math.gcd(steps, way.steps)) for way in ways], in_threads=True)

    def _run(self, way: Way, rows: int | None, stop: gateway.Stop | None = None) -> Solution | None:
        def look(part: float) -> None:
            if stop and stop():
                raise KeyboardInterrupt

        system, start = self.system, list[Any](self.start)
        if way.is_elsewhere:
            system, start = self.elsewhere, [None, None]
        if way.rounding:
            system = Perturbed(system, way.rounding)
            start = [system.shifted(x, way.rounding + i) for i, x in enumerate(start)]
        saved = {"save_every": way.steps // (rows or way.steps)} if self.t_eval is None else {"t_eval": self.t_eval}
        try:
            return simulate(system, self.span, start[0], start[1], step=(self.span[1] - self.span[0]) / way.steps,
                            formulation=way.formulation, integrator=way.integrator, stabilization=self.stabilization,
                            closed_form=False, progress=look if stop else False, **saved)
        except ZerodriftError as error:
            if error.solution is None:      # the run could not start
                raise
            return None

    def _in_own_coordinates(self, run: Solution, way: Way) -> Iterable[np.ndarray]:
        """Coordinates and velocities of the motion in a run, of which they are measures if it has others."""
        if not way.is_elsewhere:
            return run.p, run.v
        with unwarned():
            return [np.column_stack([run[variable.name] for variable in group])
                    for group in (self.system.coordinates, self.system.velocities)]

    def difference(self, way: Way, motion: Solution, steps: int, run: Solution | None = None) -> Difference:
        """Difference of a run from the motion with `steps` steps, at common samples."""
        rows = math.gcd(steps, way.steps)
        run = run or self.run(way, rows)
        p, v = math.inf, math.inf
        if run is not None and not self._differs_in_phases(motion, run):
            every, its = (1, 1) if self.t_eval is not None else (steps // rows, (len(run.t) - 1) // rows)
            p, v = (float(np.abs(own[::every] - others[::its]).max()) for own, others in zip(
                (motion.p, motion.v), self._in_own_coordinates(run, way), strict=True))
        equations = f"{way.formulation}, {self.elsewhere.layout}" if way.is_elsewhere else way.formulation
        return Difference(way.steps, equations, p, v, way.integrator, way.rounding > 0)


    def _differs_in_phases(self, motion: Solution, run: Solution) -> bool:
        """True if the phases of two runs are not the same; the first difference is noted."""
        differ = (each for each in itertools.zip_longest(*map(_sequence, (motion, run)), fillvalue="the end")
                  if each[0].partition(": ")[2] != each[1].partition(": ")[2])
        if apart := next(differ, None):
            self.disagreement = f"{apart[0]} in one run, and {apart[1]} in another one"
        return apart is not None


def _sequence(run: Solution) -> list[str]:
    """The phases of a run in words; of changes at one instant, which rounding orders, the last."""
    return [str(phase) for phase in run.phases if phase.t1 - phase.t0 > ONE_INSTANT * (run.t[-1] - run.t[0])]


def _rates(t: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Largest rate of change of x between samples, (k - 1,); 0 where it jumps."""
    step = np.diff(t)
    return np.divide(np.abs(np.diff(x, axis=0)).max(axis=1), step, out=np.zeros(len(step)), where=step > 0)


def _shift(t: np.ndarray, x: np.ndarray, samples: np.ndarray | None = None) -> float:
    """Largest change of x by rounding of the time and of the elapsed time; at samples, with the rates around them."""
    by_step = _rates(t, x) * (np.abs(t) + t - t[0])[1:]
    if samples is not None:
        steps = np.clip(np.searchsorted(t, samples) - 1, 0, len(by_step) - 1)
        by_step = by_step[np.clip(np.add.outer((-1, 0, 1), steps), 0, len(by_step) - 1)]
    return float(EPS * by_step.max(initial=0.0))
