"""`stability_map`: success and error of methods over the step and one parameter."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._private import checks, gateway
from .._private.types import ArrayLike, SystemLike
from ..errors import Interrupted, WrongValue
from ..runs.arguments import methods, settings
from ..runs.open.keyboard import progress_of
from ..runs.open.threads import side_by_side
from ..runs.samples.solution import Solution
from ..systems.base import BaseSystem, system_of, unswitched
from . import reference as certified
from .bench import Bench, Row, Setting
from .work_precision import default_steps, not_excluded

GAINS = tuple(np.geomspace(1.0, 1000.0, 13))    # 1/s: default values of the parameter, alpha of Baumgarte's method
OPTIONS = {"formulation": settings.FORMULATION, "integrator": settings.INTEGRATOR, "stabilization": settings.STABILIZATION,
           "energy": None}


def _critically_damped(gain: float) -> dict[str, Any]:
    return {"stabilization": methods.Baumgarte(gain, gain**2 / 4)}


WAYS: dict[str, Any] = {"nothing": {"stabilization": None}, "Baumgarte": _critically_damped, "projection": {},
                        "projection, energy": {"energy": True}}


@dataclass(frozen=True, eq=False, repr=False)
class StabilityMap:
    """Results of runs for each method, value of the parameter, and step.

    Attributes
    ----------
    parameter : str
        Name of the varied parameter with its unit.
    values : ndarray (n,)
    steps : ndarray (k,)
        In s.
    rows : dict of str to tuple of tuple of Row
        For each method, (n,) times (k,) entries as in `WorkPrecision`; after Ctrl-C, only for finished methods.
    reference_error : float
        The largest certified error of the references.
    reference_caveats : tuple of str
        Sources of error that their certificates do not exclude, see `Reference.caveats`.
    """

    parameter: str
    values: np.ndarray
    steps: np.ndarray
    rows: dict[str, tuple[tuple[Row, ...], ...]]
    reference_error: float
    reference_caveats: tuple[str, ...] = ()

    def survived(self, way: str) -> np.ndarray:
        """Mask (n, k) of the runs with that method that reached their end."""
        return self._column(way, "success").astype(bool)

    def error(self, way: str) -> np.ndarray:
        """Error ``max |p - p_ref|`` (n, k) of the runs with that method; NaN for runs that did not reach their end."""
        return self._column(way, "error").astype(float)

    def _column(self, way: str, name: str) -> np.ndarray:
        rows = self.rows[checks.choice("way", way, self.rows)]
        return np.array([[getattr(row, name) for row in line] for line in rows])

    def __repr__(self) -> str:
        lines = [f"StabilityMap over {len(self.steps)} steps of {self.steps[0]:.2g} ... {self.steps[-1]:.2g} s and "
                 f"{len(self.values)} values of {self.parameter}"]
        for way in self.rows:
            survived, error = self.survived(way), self.error(way)
            best = f"least error {np.nanmin(error):.2g}" if survived.any() else ""
            lines.append(f"  {way:20} {survived.sum():4} of {survived.size} survive  {best}".rstrip())
        return "\n".join(lines + not_excluded(self.reference_caveats))


def stability_map(
    system: SystemLike | Callable[[float], SystemLike],
    t_span: float | tuple[float, float],
    p0: ArrayLike | None = None,
    v0: ArrayLike | None = None,
    *,
    steps: Iterable[float] | None = None,
    parameter: str | None = None,
    values: Iterable[float] = GAINS,
    ways: Mapping[str, Mapping[str, Any] | Callable[[float], Mapping[str, Any]]] | None = None,
    reference: Solution | certified.Reference | Callable[[float], Any] | None = None,
    progress: bool | Callable[[float], None] = False,
) -> StabilityMap:
    """Simulate with several methods over steps and values of one parameter, and compare with a reference.

    Runs execute in one thread per available processor, or sequentially if the system needs Python. Results are bitwise those
    of single runs; `Row.seconds` includes the influence of parallel runs.

    Parameters
    ----------
    system : system, or callable value -> system
        A callable if the parameter is one of the system, such as a mass.
    t_span : float or (float, float)
        End time, or start and end, in s.
    p0, v0 : array_like (nq,), (nv,), optional
        Initial state; by default that of the system.
    steps : iterable of float, optional
        Fixed steps in s. By default 4, 2, 1, 1/2 ... 1/16 times the mean adaptive step of the integrator of highest order at a
        tolerance of 1e-6.
    parameter : str, optional
        Name of the varied parameter with its unit, for labels; by default Baumgarte's gain.
    values : iterable of float
        Values of the parameter. By default 1 to 1000, for Baumgarte's gain alpha in 1/s with beta = alpha**2 / 4.
    ways : mapping of str to dict, or to callable value -> dict, optional
        Methods by name: arguments of `simulate` among ``formulation, integrator, stabilization, energy``, or a function of the
        value that returns them. By default no stabilization, Baumgarte's method, projection, and projection with energy
        correction.
    reference : Reference, Solution or callable, optional
        Motion to which runs are compared. By default, and if the system varies, the most accurate that `reference` certifies.
    progress : bool or callable
        As in `simulate`.

    Returns
    -------
    StabilityMap
        `zerodrift.plot.stability_map` draws it.

    Raises
    ------
    Interrupted
        On Ctrl-C; its attribute `solution` is the StabilityMap of the finished methods.

    Examples
    --------
    >>> import zerodrift as zd
    >>> found = zd.stability_map(zd.systems.four_bar(), 1.0, steps=[0.01, 0.02], values=[1.0, 1000.0])
    >>> found.survived("Baumgarte").tolist()
    [[True, True], [False, False]]
    """
    span = checks.span(t_span)
    values = np.array([checks.number("values", value) for value in values])
    if not values.size:
        raise WrongValue("values must have at least one entry", "missing-argument")
    benches = _benches(system, span, p0, v0, values, reference)
    steps = default_steps(benches[0].system, span, p0, v0) if steps is None else steps
    steps = np.unique([checks.number("steps", step, above=0, code="step-size") for step in steps])
    if not steps.size:
        raise WrongValue("steps must have at least one entry", "missing-argument")
    combinations = {name: [_settings(name, way(value) if callable(way) else way, steps) for value in values]
                    for name, way in (WAYS if ways is None else ways).items()}
    label = parameter or ("gain α of Baumgarte's method [1/s]" if ways is None else "value")
    of_references = (max(bench.reference_error for bench in benches),
                     tuple(dict.fromkeys(caveat for bench in benches for caveat in bench.caveats)))
    cells = _Cells(benches, combinations)
    try:
        cells.measure(progress)
    except KeyboardInterrupt:
        rows = cells.done()
        partial = StabilityMap(label, values, steps, rows, *of_references)
        raise Interrupted(f"interrupted from the keyboard after {len(rows)} of {len(combinations)} ways", partial) from None
    return StabilityMap(label, values, steps, cells.done(), *of_references)


def _benches(system: Any, span: tuple[float, float], p0: Any, v0: Any, values: np.ndarray, reference: Any) -> list[Bench]:
    """Benches, one for each value of the parameter; the same one if the system does not depend on it."""
    def bench(system: BaseSystem, reference: Any) -> Bench:
        reference = certified.reference(system, span, p0, v0, error=None) if reference is None else reference
        return Bench(system, span, p0, v0, reference)

    system = unswitched(system_of(system, p0, v0), "a stability map")
    if isinstance(system, BaseSystem) or not callable(system):
        return [bench(system, reference)] * len(values)
    return [bench(system_of(system(value), p0, v0), None) for value in values]


def _settings(name: str, options: Mapping[str, Any], steps: np.ndarray) -> tuple[Setting, ...]:
    for option in options:
        checks.choice(f"an option of the way {name!r}", option, OPTIONS)
    chosen = OPTIONS | dict(options)
    corrections = settings.stabilization(chosen["stabilization"]), settings.energy(chosen["energy"])
    return tuple(Setting(chosen["formulation"], chosen["integrator"], float(step), None, *corrections) for step in steps)


class _Cells:
    """Cells of a map by method: a line of steps for each value of the parameter; lines that do not depend on it are run once."""

    def __init__(self, benches: list[Bench], combinations: dict[str, list[tuple[Setting, ...]]]) -> None:
        self._keys = {name: list(zip(benches, lines, strict=True)) for name, lines in combinations.items()}
        self._lines = dict.fromkeys(key for keys in self._keys.values() for key in keys)
        self._rows: dict[Any, tuple[Row, ...]] = {}
        for bench, line in self._lines:
            bench.prepare(line[0])

    def measure(self, progress: Any) -> None:
        """Run all lines, in threads unless runs call Python functions."""
        show, close = progress_of(progress)
        try:
            side_by_side(self._measure, list(self._lines), lambda: show(len(self._rows) / len(self._lines)),
                         in_threads=not any(bench.needs_python for bench, _ in self._lines))
        finally:
            close()

    def _measure(self, key: tuple[Bench, tuple[Setting, ...]], stop: gateway.Stop | None) -> None:
        bench, line = key
        if rows := bench.rows(line, stop):
            self._rows[key] = tuple(rows)

    def done(self) -> dict[str, tuple[tuple[Row, ...], ...]]:
        """Entries of the methods whose lines are finished."""
        return {name: tuple(self._rows[key] for key in keys)
                for name, keys in self._keys.items() if self._rows.keys() >= set(keys)}
