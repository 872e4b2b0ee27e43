"""Runs of a motion that is to be known: with steps of one size, in any formulation, and with everything off by rounding."""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from .. import _gateway
from ..errors import ZerodriftError
from ..runs import settings
from ..runs.diagnosis import unwarned
from ..runs.simulate import simulate
from ..runs.solution import Solution
from ..runs.threads import side_by_side
from ..systems.base import BaseSystem, core_of

SERIES = "taylor"   # the integrator whose order is as high as one wants
ROUNDING = np.finfo(float).eps
PROBE = 1e-5        # tolerance of the run that tells how many steps the motion takes
_NOT_MADE = object()
UNIT = 3            # numbers of steps are multiples of this, as two and five thirds of them are taken


class Difference(NamedTuple):
    """How far a run is from the solution."""

    steps: int
    formulation: str
    p: float
    v: float
    integrator: str
    rounded: bool


class Perturbed(BaseSystem):
    """A system that is off by rounding."""

    def __init__(self, system: BaseSystem, seed: int, size: float = ROUNDING) -> None:
        self.name, self.parameters, self.p0, self.v0 = system.name, system.parameters, None, None
        self.coordinates, self.velocities, self.constraints = system.coordinates, system.velocities, system.constraints
        self._core, self._system = _gateway.perturbed(core_of(system), size, seed), system

    def _with_series(self, core: _gateway.CoreSystem, vector: str = "baseline") -> _gateway.CoreSystem:
        return self._system._with_series_of_perturbed(core, vector)

    def shifted(self, x: np.ndarray, seed: int) -> np.ndarray:
        """A state off by a rounding or two."""
        return x * (1.0 + ROUNDING * np.random.default_rng(seed).choice([-2.0, -1.0, 1.0, 2.0], x.shape))


class Rows(NamedTuple):
    """Times, coordinates and velocities of a run that was made in other coordinates."""

    t: np.ndarray
    p: np.ndarray
    v: np.ndarray


@dataclass(frozen=True)
class Way:
    """How a run is made: its steps, equations and method, and how it is rounded (0: as it comes)."""

    steps: int
    formulation: str
    integrator: str
    rounding: int = 0
    is_elsewhere: bool = False      # in the other coordinates of the system


class Motion:
    """What is to be known: runs of it, and how large and fast it is."""

    def __init__(self, system, span, p0, v0, t_eval, stabilization, formulation, bounds) -> None:
        self.system, self.span, self.t_eval, self.stabilization = system, span, t_eval, stabilization
        self.start = system._state_or_start(p0, v0, t=span[0])
        self._made_before: dict[tuple[Way, int], Solution | Exception | None] = {}
        self.bounded = bounds["max_step"] is not None
        self.is_plain = system._has_plain_laws
        self.elsewhere = system._in_other_coordinates() if p0 is None and v0 is None else None
        self.elsewhere_failed = False
        taken = settings.evaluating_integrators(system)
        cards = sorted(taken.values(), key=lambda card: -card.order)    # as they stand, where equal
        self.method, self.other = cards[0].name, cards[1].name
        with unwarned():
            probe = simulate(system, span, p0, v0, rtol=PROBE, atol=PROBE, formulation=formulation, integrator=self.method,
                             stabilization=stabilization, direct=False, **bounds)
        self.size, self.probe, self.bounds = float(np.abs(probe.p).max()), probe, bounds
        self.speed = float(np.abs(np.diff(probe.p, axis=0) / np.diff(probe.t)[:, None]).max(initial=0.0))
        most_move = bounds.get("max_move")
        longest = min(bounds["max_step"] or math.inf, most_move / self.speed if most_move and self.speed else math.inf)
        self.most = math.ceil((span[1] - span[0]) / longest) or 1
        self.steps = UNIT * math.ceil(max(probe.stats["steps"], self.most) / UNIT)
        self.shift = [_shift(probe.t, x) for x in (probe.p, probe.v)]

    def follows_series(self, formulation: str) -> bool:
        """Whether Taylor's method takes the system so."""
        chosen = self.probe.settings | {"integrator": SERIES, "formulation": formulation}
        return self.system._brings_series and not settings.disagreement(chosen)

    def by_series(self, formulation: str) -> Motion:
        """The same by Taylor's method, and by what it was found by before for the check."""
        found = copy.copy(self)
        found.method, found.other = SERIES, self.method
        with unwarned():
            probe = simulate(self.system, self.span, *self.start, rtol=PROBE, atol=PROBE, formulation=formulation,
                             integrator=SERIES, stabilization=self.stabilization, direct=False, **self.bounds)
        found.steps = UNIT * math.ceil(max(probe.stats["steps"], self.most) / UNIT)
        return found

    def run(self, way: Way, rows: int | None = None) -> Solution | None:
        """A run, of which so many rows after the first are saved; None where its steps were too long for it."""
        made = self._made_before.pop((way, rows), _NOT_MADE)
        if isinstance(made, Exception):
            raise made
        if made is not _NOT_MADE:
            return made
        with unwarned():
            return self._run(way, rows)

    def run_side_by_side(self, ways: Sequence[Way], steps: int) -> None:
        """Makes runs that `difference` to the motion of so many steps will ask for, in threads, if no Python is in the way."""
        def make(asked: tuple[Way, int], stop: _gateway.Stop | None) -> None:
            try:
                self._made_before[asked] = self._run(*asked, stop)
            except Exception as error:      # raised when the run is asked for
                self._made_before[asked] = error

        self._made_before.clear()
        if core_of(self.system).for_run() is core_of(self.system):
            with unwarned():        # around all threads, which share the filters of warnings
                side_by_side(make, [(way, math.gcd(steps, way.steps)) for way in ways], in_threads=True)

    def _run(self, way: Way, rows: int | None, stop: _gateway.Stop | None = None) -> Solution | None:
        def look(part: float) -> None:
            if stop():
                raise KeyboardInterrupt

        system, (p0, v0) = self.system, self.start
        if way.is_elsewhere:
            system, p0, v0 = self.elsewhere, None, None
        if way.rounding:
            system = Perturbed(system, way.rounding)
            p0, v0 = (system.shifted(x, way.rounding + i) for i, x in enumerate((p0, v0)))
        saved = {"save_every": way.steps // (rows or way.steps)} if self.t_eval is None else {"t_eval": self.t_eval}
        try:
            run = simulate(system, self.span, p0, v0, step=(self.span[1] - self.span[0]) / way.steps,
                           formulation=way.formulation, integrator=way.integrator, stabilization=self.stabilization,
                           direct=False, progress=look if stop else False, **saved)
            return self._in_own_coordinates(run) if way.is_elsewhere else run
        except ZerodriftError as error:
            if error.solution is None:      # it did not even start
                raise
            return None

    def _in_own_coordinates(self, run: Solution) -> Rows:
        """A run in other coordinates, in those of the motion: these are measures there."""
        own = ([run[variable.name] for variable in group] for group in (self.system.coordinates, self.system.velocities))
        return Rows(run.t, *(np.column_stack(columns) for columns in own))

    def difference(self, way: Way, motion: Solution, steps: int, run: Solution | None = None) -> Difference:
        """How far that run is from the motion of so many steps, at the rows that both have."""
        rows = math.gcd(steps, way.steps)
        run = run or self.run(way, rows)
        apart = [math.inf, math.inf]
        if run is not None:
            every, its = (1, 1) if self.t_eval is not None else (steps // rows, (len(run.t) - 1) // rows)
            apart = [float(np.abs(getattr(motion, name)[::every] - getattr(run, name)[::its]).max()) for name in "pv"]
        equations = f"{way.formulation}, {self.elsewhere.layout}" if way.is_elsewhere else way.formulation
        return Difference(way.steps, equations, *apart, way.integrator, way.rounding > 0)


def _shift(t: np.ndarray, x: np.ndarray) -> float:
    """The most that a rounding of the time, and of the time that has passed, makes of x."""
    rates = np.abs(np.diff(x, axis=0)).max(axis=1) / np.diff(t)
    return float(ROUNDING * (rates * (np.abs(t) + t - t[0])[1:]).max())
