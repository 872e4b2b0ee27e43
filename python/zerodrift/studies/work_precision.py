"""`work_precision`: what an error costs, measured for any combination of methods."""

from __future__ import annotations

import csv
import io
import itertools
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .. import _check
from .._writing import write_whole
from ..errors import Interrupted, SingularSystem
from ..runs import settings
from ..runs.operations import acceleration
from ..runs.progress import progress_of
from ..runs.simulate import simulate
from ..runs.solution import Solution
from ..systems.base import BaseSystem, system_of
from . import reference as certified
from .bench import Bench, Row, Setting

PROBE = 1e-6                                        # tolerance of the run whose mean step the default steps are multiples of
STEPS = tuple(2.0**-k for k in range(-2, 5))        # those multiples
TOLERANCES = tuple(10.0**-k for k in range(3, 12))


@dataclass(frozen=True, eq=False, repr=False)
class WorkPrecision:
    """What was measured.

    Attributes
    ----------
    system : system
    t_span : (float, float)
    rows : tuple of Row
        One per way to simulate, failures included.
    reference_error : float
        Certified error of the reference; NaN where it was given without one. Errors below it say nothing.
    rounds : int
        How often each was timed.
    complete : bool
        False after Ctrl-C.
    reference_caveats : tuple of str
        What the certificate of the reference did not exclude, see `Reference.caveats`.
    """

    system: BaseSystem
    t_span: tuple[float, float]
    rows: tuple[Row, ...]
    reference_error: float
    rounds: int
    complete: bool = True
    reference_caveats: tuple[str, ...] = ()

    def pareto(self) -> tuple[Row, ...]:
        """The rows than which none is both faster and more accurate, from the fastest on.

        Errors below the reference's own count as that.
        """
        front: list[Row] = []
        floor = np.nan_to_num(self.reference_error)
        done = (row for row in self.rows if row.success and np.isfinite(row.error))
        for row in sorted(done, key=lambda row: (row.seconds, row.error)):
            if not front or max(row.error, floor) < max(front[-1].error, floor):
                front.append(row)
        return tuple(front)

    def to_csv(self, path: str | Path) -> Path:
        """Write all rows as comma-separated values.

        Parameters
        ----------
        path : str or Path

        Returns
        -------
        Path
            Where it was written.
        """
        table = io.StringIO(newline="")
        writer = csv.DictWriter(table, [*Setting._fields, *Row._fields[1:]])
        writer.writeheader()
        writer.writerows(row.flat() for row in self.rows)
        write_whole(path, lambda file: file.write(table.getvalue().encode()))
        return Path(path)

    def to_dataframe(self) -> Any:
        """All rows as a pandas.DataFrame, if pandas is installed."""
        try:
            import pandas
        except ImportError:
            raise ImportError("to_dataframe needs pandas, which is not installed: pip install pandas") from None
        return pandas.DataFrame([row.flat() for row in self.rows], columns=[*Setting._fields, *Row._fields[1:]])

    def __repr__(self) -> str:
        failed = sum(not row.success for row in self.rows)
        title = (f"WorkPrecision of {self.system.name}, t = {self.t_span[0]:g} ... {self.t_span[1]:g} s: {len(self.rows)} rows, "
                 f"{failed} failed{'' if self.complete else ', interrupted'}; reference known to {self.reference_error:.2g}")
        table = [("error", "time [ms]", "evaluations", "integrator", "formulation", "steps by", "corrections")]
        table += [_cells(row) for row in self.pareto()]
        widths = [max(map(len, column)) for column in zip(*table, strict=True)]
        lines = ["  ".join(cell.ljust(width) for cell, width in zip(cells, widths, strict=True)).rstrip() for cells in table]
        return "\n".join([title, *("  " + line for line in lines), *not_excluded(self.reference_caveats)])


def not_excluded(caveats: Iterable[str]) -> list[str]:
    """Lines that say what was not excluded of the reference."""
    return [f"  not excluded of the reference: {caveat}" for caveat in caveats]


def _cells(row: Row) -> tuple[str, ...]:
    setting = row.setting
    fineness = f"step {setting.step:.3g} s" if setting.tolerance is None else f"tolerance {setting.tolerance:.2g}"
    corrections = type(setting.stabilization).__name__ if setting.stabilization else "none"
    return (f"{row.error:.2g}", f"{1e3 * row.seconds:.3g}", str(row.evaluations), setting.integrator, setting.formulation,
            fineness, corrections + (", energy" if setting.energy else ""))


def work_precision(
    system: BaseSystem,
    t_span: float | tuple[float, float],
    p0: Any = None,
    v0: Any = None,
    *,
    formulations: Iterable[str] | None = None,
    integrators: Iterable[str] | None = None,
    steps: Iterable[float] | None = None,
    tolerances: Iterable[float] | None = None,
    stabilizations: Iterable[str | settings.Stabilization] = (settings.STABILIZATION,),
    energy: Iterable[bool | settings.EnergyCorrection | None] = (None,),
    reference: certified.Reference | Solution | Callable[[float], Any] | None = None,
    direct: bool | None = False,
    progress: bool | Callable[[float], None] = False,
    rounds: int = 3,
) -> WorkPrecision:
    """Measure time and error of all combinations of what is chosen.

    Time is what the core needs for a run that saves every step. All runs are made once, then all again, `rounds` times, and
    the least time of each counts: so what else the machine does for a while slows all alike, and the least is hardly slowed.
    Errors come from further runs, which go side by side in threads while nothing is timed.

    Parameters
    ----------
    system : system
        One of `zerodrift.systems`, or a `zerodrift.System`.
    t_span : float or (float, float)
        End time, or start and end, in s.
    p0, v0 : array_like (nq,), (nv,), optional
        Start; left out: the system's own.
    formulations, integrators : iterable of str, optional
        Left out: all there are that can take the system.
    steps : iterable of float, optional
        Fixed steps in s, for every integrator. Left out: 4, 2, 1, 1/2 ... 1/16 times the mean step that the integrator of
        highest order chooses at a tolerance of 1e-6.
    tolerances : iterable of float, optional
        rtol and atol, for the integrators that choose their steps. Left out: 1e-3, 1e-4 ... 1e-11.
    stabilizations, energy : iterable, optional
        Values of `stabilization` and `energy` as `simulate` takes them. Left out: projection, and no energy correction.
    reference : Reference, Solution or callable, optional
        What errors are measured against; left out: the best that `reference` certifies. Errors are measured at its times.
    direct : None or False
        As in `simulate`. Left out: False, so that formulations differ.
    progress : bool or callable
        As in `simulate`.
    rounds : int
        How often each run is timed.

    Returns
    -------
    WorkPrecision
        A run that fails is a row, too, with its message.

    Raises
    ------
    Interrupted
        On Ctrl-C; its `.solution` is the WorkPrecision of what was measured until then.

    Examples
    --------
    >>> import zerodrift as zd
    >>> wp = zd.work_precision(zd.systems.pendulum(), 1.0, formulations=["schur"], integrators=["rk4", "dop853"], rounds=1)
    >>> len(wp.rows), wp.rows[0].setting.integrator
    (23, 'rk4')
    >>> bool(wp.pareto()[-1].error < 1e-9)
    True
    """
    system, span = system_of(system, p0, v0), _check.span(t_span)
    taken, able = settings.integrators(system), _able(system, span, p0, v0) if formulations is None else formulations
    formulations = _names("formulations", settings.formulations(), able)
    integrators = _names("integrators", settings.integrators(), taken if integrators is None else integrators)
    stabilizations, energy = map(settings.stabilization, stabilizations), map(settings.energy, energy)
    steps = default_steps(system, span, p0, v0) if steps is None else [_check.number("steps", h, above=0) for h in steps]
    tolerances = TOLERANCES if tolerances is None else [_check.number("tolerances", tol, above=0) for tol in tolerances]
    combinations = [
        Setting(formulation, integrator, *fineness, stabilization, corrected)
        for formulation, integrator, stabilization, corrected in itertools.product(
            formulations, integrators, stabilizations, energy)
        for fineness in _steps_and_tolerances(integrator, steps, tolerances)]
    combinations = [setting for setting in combinations if not settings.disagreement(setting.settings)]
    if not combinations:
        raise ValueError("there is nothing to measure: fixed steps need `steps`, and `tolerances` an integrator that chooses its")
    rounds = _check.count("rounds", rounds)
    reference = certified.reference(system, span, p0, v0, error=None) if reference is None else reference
    return measured(Bench(system, span, p0, v0, reference, direct), combinations, rounds, progress)


def measured(bench: Bench, combinations: Sequence[Setting], rounds: int, progress: Any = False) -> WorkPrecision:
    """All combinations, `rounds` times in turn."""
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
    """What was measured so far."""
    return WorkPrecision(bench.system, bench.span, tuple(rows), bench.reference_error, rounds, complete, bench.caveats)


def _able(system: BaseSystem, span: tuple[float, float], p0: Any, v0: Any) -> list[str]:
    """The formulations that can take the system where it starts: some invert a mass matrix that may be singular."""
    def can(name: str) -> bool:
        try:
            acceleration(system, *system._state_or_start(p0, v0, t=span[0]), span[0], name)
        except SingularSystem:
            return False
        return True

    return [name for name in settings.formulations(system) if can(name)]


def _names(table: str, available: Iterable[str], chosen: Iterable[str] | None) -> list[str]:
    """Those chosen of a table, or all."""
    if isinstance(chosen, str):
        raise TypeError(f"{table} must be a list of names, not {chosen!r}")
    return [_check.choice(table, name, available) for name in (available if chosen is None else chosen)]


def _steps_and_tolerances(integrator: str, steps: Iterable[float], tolerances: Iterable[float]) -> list[tuple[Any, Any]]:
    """Pairs (step, tolerance), one of them None."""
    chooses = settings.integrators()[integrator].error_order
    return [(step, None) for step in steps] + [(None, tolerance) for tolerance in tolerances if chooses]


def default_steps(system, span, p0, v0) -> list[float]:
    """Fixed steps around the mean one of an accurate run, in s."""
    method = max(settings.evaluating_integrators(system).values(), key=lambda card: card.order).name
    probe = simulate(system, span, p0, v0, rtol=PROBE, atol=PROBE, integrator=method,
                     formulation=next(iter(settings.formulations(system))))
    return [factor * (span[1] - span[0]) / probe.stats["steps"] for factor in STEPS]
