"""`work_precision`: time and error of runs, measured for combinations of methods."""

from __future__ import annotations

import csv
import io
import itertools
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from .._private import checks
from .._private.types import ArrayLike, EnergyCorrection, Formulation, Integrator, StabilizationName, SystemLike
from .._private.writing import write_atomically
from ..errors import Interrupted, MissingPackage, SingularSystem, WrongType, WrongValue
from ..runs.arguments import methods, settings
from ..runs.open.keyboard import progress_of
from ..runs.samples.solution import Solution
from ..runs.simulate import simulate
from ..runs.states.operations import acceleration
from ..systems.base import BaseSystem, system_of
from . import reference as certified
from .bench import Bench, Row, Setting

PROBE = 1e-6                                        # tolerance of the run whose mean step defines the default steps
STEPS = tuple(2.0**-k for k in range(-2, 5))        # default steps as multiples of it
TOLERANCES = tuple(10.0**-k for k in range(3, 12))


@dataclass(frozen=True, eq=False, repr=False)
class WorkPrecision:
    """Measured times and errors of many settings.

    Attributes
    ----------
    system : system
    t_span : (float, float)
    rows : tuple of Row
        One entry for each setting, including failed runs.
    reference_error : float
        Certified error of the reference; NaN if it has none. Measured errors below it are not significant.
    rounds : int
        Number of timings of each run.
    complete : bool
        False after Ctrl-C.
    reference_caveats : tuple of str
        Sources of error that the certificate of the reference does not exclude, see `Reference.caveats`.
    """

    system: BaseSystem
    t_span: tuple[float, float]
    rows: tuple[Row, ...]
    reference_error: float
    rounds: int
    complete: bool = True
    reference_caveats: tuple[str, ...] = ()

    def pareto(self) -> tuple[Row, ...]:
        """Pareto front: entries than which no other is both faster and more accurate, fastest first.

        Errors below that of the reference count as equal to it.
        """
        front: list[Row] = []
        floor = np.nan_to_num(self.reference_error)
        done = (row for row in self.rows if row.success and np.isfinite(row.error))
        for row in sorted(done, key=lambda row: (row.seconds, row.error)):
            if not front or max(row.error, floor) < max(front[-1].error, floor):
                front.append(row)
        return tuple(front)

    @property
    def smallest_error(self) -> float:
        """Smallest error of a run that was measured, at least that of the reference; NaN if none succeeded.

        With steps fine enough, it is the error that double precision leaves on this motion.
        """
        errors = [row.error for row in self.rows if row.success and np.isfinite(row.error)]
        return max(min(errors), float(np.nan_to_num(self.reference_error))) if errors else math.nan

    def to_csv(self, path: str | Path) -> Path:
        """Write all entries to a CSV file.

        Parameters
        ----------
        path : str or Path

        Returns
        -------
        Path
            The file.
        """
        table = io.StringIO(newline="")
        writer = csv.DictWriter(table, [*Setting._fields, *Row._fields[1:]])
        writer.writeheader()
        writer.writerows(row.flat() for row in self.rows)
        write_atomically(path, lambda file: file.write(table.getvalue().encode()))
        return Path(path)

    def to_dataframe(self) -> Any:
        """All entries as a pandas.DataFrame; pandas must be installed."""
        try:
            import pandas
        except ImportError:
            raise MissingPackage("to_dataframe needs pandas, which is not installed: pip install pandas") from None
        return pandas.DataFrame([row.flat() for row in self.rows], columns=[*Setting._fields, *Row._fields[1:]])

    def __repr__(self) -> str:
        failed = sum(not row.success for row in self.rows)
        title = (f"WorkPrecision of {self.system.name}, t = {self.t_span[0]:g} ... {self.t_span[1]:g} s: {len(self.rows)} rows, "
                 f"{failed} failed{'' if self.complete else ', interrupted'}; reference known to {self.reference_error:.2g}, "
                 f"smallest error of a run {self.smallest_error:.2g}")
        table = [("error", "time [ms]", "evaluations", "integrator", "formulation", "steps by", "corrections"),
                 *map(_cells, self.pareto())]
        widths = [max(map(len, column)) for column in zip(*table, strict=True)]
        lines = ["  ".join(cell.ljust(width) for cell, width in zip(cells, widths, strict=True)).rstrip() for cells in table]
        return "\n".join([title, *("  " + line for line in lines), *not_excluded(self.reference_caveats)])


def not_excluded(caveats: Iterable[str]) -> list[str]:
    """Lines on the errors that the certificate of the reference does not exclude."""
    return [f"  not excluded of the reference: {caveat}" for caveat in caveats]


def _cells(row: Row) -> tuple[str, ...]:
    setting = row.setting
    fineness = f"step {setting.step:.3g} s" if setting.tolerance is None else f"tolerance {setting.tolerance:.2g}"
    corrections = type(setting.stabilization).__name__ if setting.stabilization else "none"
    return (f"{row.error:.2g}", f"{1e3 * row.seconds:.3g}", str(row.evaluations), setting.integrator, setting.formulation,
            fineness, corrections + (", energy" if setting.energy else ""))


def work_precision(
    system: SystemLike,
    t_span: float | tuple[float, float],
    p0: ArrayLike | None = None,
    v0: ArrayLike | None = None,
    *,
    formulations: Iterable[Formulation] | None = None,
    integrators: Iterable[Integrator] | None = None,
    steps: Iterable[float] | None = None,
    tolerances: Iterable[float] | None = None,
    stabilizations: Iterable[StabilizationName | settings.Stabilization] = (settings.STABILIZATION,),
    energy: Iterable[bool | EnergyCorrection | None] = (None,),
    reference: certified.Reference | Solution | Callable[[float], Any] | None = None,
    closed_form: Literal[False] | None = False,
    progress: bool | Callable[[float], None] = False,
    rounds: int = 3,
) -> WorkPrecision:
    """Measure time and error of all combinations of methods, steps and tolerances.

    The time of a run is that spent in the core when every step is saved. All runs are timed `rounds` times in turn, and the
    minimum of each counts, which reduces the influence of other load. Errors come from separate runs in threads, during which
    nothing is timed.

    Parameters
    ----------
    system : system
        System or Mechanism, as in `simulate`.
    t_span : float or (float, float)
        End time, or start and end, in s.
    p0, v0 : array_like (nq,), (nv,), optional
        Initial state; by default that of the system.
    formulations, integrators : iterable of str, optional
        Names of methods; by default all that suit the system.
    steps : iterable of float, optional
        Fixed steps in s, for every integrator. By default 4, 2, 1, 1/2 ... 1/16 times the mean adaptive step of the integrator
        of highest order at a tolerance of 1e-6.
    tolerances : iterable of float, optional
        Values of rtol = atol for integrators with adaptive steps. By default 1e-3, 1e-4 ... 1e-11.
    stabilizations, energy : iterable, optional
        Values of `stabilization` and `energy`, as in `simulate`. By default projection without energy correction.
    reference : Reference, Solution or callable, optional
        Motion to which runs are compared, at its times. By default the most accurate that `reference` can certify.
    closed_form : None or False
        As in `simulate`. The default False uses the matrices of each formulation, so that formulations differ.
    progress : bool or callable
        As in `simulate`.
    rounds : int
        Number of timings of each run.

    Returns
    -------
    WorkPrecision
        Failed runs are included with their message.

    Raises
    ------
    Interrupted
        On Ctrl-C; its attribute `solution` is the WorkPrecision of the measurements so far.

    Examples
    --------
    >>> import zerodrift as zd
    >>> wp = zd.work_precision(zd.systems.pendulum(), 1.0, formulations=["schur"], integrators=["rk4", "dop853"], rounds=1)
    >>> len(wp.rows), wp.rows[0].setting.integrator
    (23, 'rk4')
    >>> bool(wp.pareto()[-1].error < 1e-9)
    True
    """
    system, span = system_of(system, p0, v0), checks.span(t_span)
    taken, able = methods.integrators(system), _able(system, span, p0, v0) if formulations is None else formulations
    formulations = _names("formulations", methods.formulations(), able)
    integrators = _names("integrators", methods.integrators(), taken if integrators is None else integrators)
    steps = default_steps(system, span, p0, v0) if steps is None else [
        checks.number("steps", each, above=0, code="step-size") for each in steps]
    tolerances = TOLERANCES if tolerances is None else [
        checks.number("tolerances", each, above=0, code="tolerance") for each in tolerances]
    combinations = [
        Setting(formulation, integrator, *fineness, stabilization, corrected)
        for formulation, integrator, stabilization, corrected in itertools.product(
            formulations, integrators, map(settings.stabilization, stabilizations), map(settings.energy, energy))
        for fineness in _steps_and_tolerances(integrator, steps, tolerances)]
    combinations = [setting for setting in combinations if not settings.disagreement(setting.settings)]
    if not combinations:
        raise WrongValue("at least one combination must be possible: steps, or tolerances with an integrator of adaptive steps")
    rounds = checks.count("rounds", rounds)
    reference = certified.reference(system, span, p0, v0, error=None) if reference is None else reference
    return measured(Bench(system, span, p0, v0, reference, closed_form), combinations, rounds, progress)


def measured(bench: Bench, combinations: Sequence[Setting], rounds: int, progress: Any = False) -> WorkPrecision:
    """Time all combinations, `rounds` times in turn."""
    rows: dict[Setting, Row] = {}
    show, close = progress_of(progress)
    try:
        first, later = bench.timed(combinations), itertools.chain.from_iterable([combinations] * (rounds - 1))
        for done, row in enumerate(itertools.chain(first, (bench.timed_again(rows[setting]) for setting in later))):
            rows[row.setting] = row
            show((done + 1) / (rounds * len(combinations)))
    except KeyboardInterrupt:
        partial = found(bench, rows.values(), rounds, complete=False)
        raise Interrupted(f"interrupted from the keyboard after {len(rows)} of {len(combinations)} rows", partial) from None
    finally:
        close()
    return found(bench, rows.values(), rounds)


def found(bench: Bench, rows: Iterable[Row], rounds: int, complete: bool = True) -> WorkPrecision:
    """WorkPrecision of the entries measured so far."""
    return WorkPrecision(bench.system, bench.span, tuple(rows), bench.reference_error, rounds, complete, bench.caveats)


def _able(system: BaseSystem, span: tuple[float, float], p0: Any, v0: Any) -> list[str]:
    """Formulations that suit the system at its start: some invert a mass matrix that may be singular."""
    def can(name: Any) -> bool:
        try:
            acceleration(system, *system._state_or_start(p0, v0, t=span[0]), span[0], name)
        except SingularSystem:
            return False
        return True

    return [name for name in methods.formulations(system) if can(name)]


def _names(table: str, available: Iterable[str], chosen: Iterable[str] | None) -> list[str]:
    """Chosen names of a table, checked; all if none are chosen."""
    if isinstance(chosen, str):
        raise WrongType(f"{table} must be a list of names, not {chosen!r}")
    return [checks.choice(table, name, available) for name in (available if chosen is None else chosen)]


def _steps_and_tolerances(integrator: Any, steps: Iterable[float], tolerances: Iterable[float]) -> list[tuple[Any, Any]]:
    """Pairs (step, tolerance), one of them None."""
    chooses = methods.integrators()[integrator].error_order
    return [(step, None) for step in steps] + [(None, tolerance) for tolerance in tolerances if chooses]


def default_steps(system: BaseSystem, span: tuple[float, float], p0: Any, v0: Any) -> list[float]:
    """Default fixed steps in s: multiples of the mean adaptive step of an accurate run."""
    known = methods.evaluating_integrators(system)
    method = max(known, key=lambda name: known[name].order)
    probe = simulate(system, span, p0, v0, rtol=PROBE, atol=PROBE, integrator=method,
                     formulation=next(iter(methods.formulations(system))))
    return [factor * (span[1] - span[0]) / probe.stats["steps"] for factor in STEPS]
