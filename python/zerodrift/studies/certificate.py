"""`Reference`: a motion with a certified error."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .._private import checks
from .._private.types import ArrayLike, Bindings
from ..errors import WrongValue
from ..runs.samples.solution import Solution
from .precise_values import EventTimes, Quantity, Runs, Samples, located, value_of
from .reference_runs import Difference


@dataclass(frozen=True, eq=False, repr=False)
class Reference:
    """A solution with a certified bound of its error.

    Attributes
    ----------
    solution : Solution
        The motion.
    error : float
        Bound of ``abs(p + p_low - exact)`` at every sample, each coordinate in its own unit. The exact motion is that of the
        start, the parameters and the times as they are in double precision.
    velocity_error : float
        The same bound for v.
    differences : tuple of Difference(steps, formulation, p, v, integrator, rounded)
        Comparisons: for each other run its number of steps and formulation, its largest differences from the solution in p
        and v, its integrator, and whether its terms were perturbed by rounding.
    caveats : tuple of str
        Known sources of error that the comparisons cannot exclude, a sentence each; empty if there are none.
    low : tuple of ndarray (k, nq), (k, nv), or None
        Low parts of p and v of a motion in double-double arithmetic; None in double precision.
    """

    solution: Solution
    error: float
    velocity_error: float
    differences: tuple[Difference, ...]
    caveats: tuple[str, ...] = ()
    low: tuple[np.ndarray, np.ndarray] | None = None
    _runs: Runs | None = None       # in double-double arithmetic

    @property
    def precision(self) -> str:
        """Arithmetic of the motion: "double" or "double-double"."""
        return "double" if self.low is None else "double-double"

    @property
    def error_in_double(self) -> float:
        """Bound of ``abs(p - exact)`` at every sample: with the rounding of p to doubles, if the motion has more digits."""
        return self.error if self.low is None else self.error + float(np.spacing(np.abs(self.p).max())) / 2

    @property
    def p(self) -> np.ndarray:
        """Coordinates (k, nq) at ``solution.t``, rounded to doubles: p + p_low has the error that is certified."""
        return self.solution.p

    @property
    def v(self) -> np.ndarray:
        """Velocities (k, nv), rounded to doubles."""
        return self.solution.v

    @property
    def p_low(self) -> np.ndarray:
        """Low parts of the coordinates, (k, nq); zero in double precision."""
        return np.zeros(self.p.shape) if self.low is None else self.low[0]

    @property
    def v_low(self) -> np.ndarray:
        """Low parts of the velocities, (k, nv); zero in double precision."""
        return np.zeros(self.v.shape) if self.low is None else self.low[1]

    def at(self, t: ArrayLike) -> Samples:
        """The motion at any times from the first to the last sample, beyond double precision.

        Parameters
        ----------
        t : float or array_like (k,)
            Times in s.

        Returns
        -------
        Samples(t, p, p_low, v, v_low, error, velocity_error)
            p + p_low (k, nq) and v + v_low (k, nv), from the polynomials of all steps, with their own certified errors.

        Raises
        ------
        ValueError
            If the reference is not in double-double arithmetic, or was unpickled; for times outside the samples, or none.

        Examples
        --------
        >>> import zerodrift as zd
        >>> ref = zd.reference(zd.systems.oscillator(), 1.0, precision="double-double")
        >>> now = ref.at(0.3)
        >>> bool(abs(now.p - ref.solution(0.3)[0]).max() <= 1e-12), now.error < 1e-25
        (True, True)
        """
        return self._runs_at(t).samples()

    def measure(self, what: Any, t: ArrayLike | None = None, *, of: Bindings | None = None) -> Quantity:
        """Values of a measure beyond double precision.

        Parameters
        ----------
        what : measure, str or SymPy expression
            A scalar measure of positions or velocities, a coordinate or a velocity, by name; or an expression of these, of ``t``
            and of parameters, in symbols of their names.
        t : float or array_like (k,), optional
            Times in s; by default those of the samples.
        of : dict of str to measure, optional
            Measures that symbols of the expression stand for.

        Returns
        -------
        Quantity(value, low, error)
            value + low (k,), computed with 45 digits from p + p_low and v + v_low, and its certified error.

        Raises
        ------
        ValueError
            If the reference is not in double-double arithmetic, or was unpickled; for measures of forces and accelerations.

        Examples
        --------
        >>> import sympy, zerodrift as zd
        >>> ref = zd.reference(zd.systems.pendulum(), 1.0, precision="double-double")
        >>> x, y = sympy.symbols("x y")
        >>> length, low, error = ref.measure(sympy.sqrt(x**2 + y**2), [0.2, 0.7])
        >>> bool(abs((length - 1.0) + low).max() <= error < 1e-25)
        True
        """
        return self._runs_at(t).values(value_of("what", what, self.solution.system, of or {}))

    def events(self, event: Any) -> EventTimes:
        """Times of an event beyond double precision.

        Parameters
        ----------
        event : Event, measure, str or SymPy expression
            As in `simulate`, but not a function of Python.

        Returns
        -------
        EventTimes(t, low, error, p, p_low, v, v_low)
            Times t + low (k,) in s, by Newton's method on the polynomials of the steps, their certified error, and the state
            then.

        Raises
        ------
        UnreachableTolerance
            If the event touches its value without crossing it.
        ValueError
            As `measure`.

        Examples
        --------
        >>> import math, zerodrift as zd
        >>> ref = zd.reference(zd.systems.oscillator(mass=1.0, stiffness=4.0, x0=0.1), 2.0, precision="double-double")
        >>> found = ref.events("x")
        >>> bool(abs(found.t - math.pi / 4).max() < 1e-15), found.error < 1e-25
        (True, True)
        """
        return located(self._runs_at(None), self.solution, event)

    def _runs_at(self, t: Any) -> Runs:
        """Runs in double-double arithmetic at times; by default those of the samples."""
        if self._runs is None:
            raise WrongValue("values beyond double precision need a reference of double-double arithmetic, "
                             "zd.reference(..., precision='double-double'), as it was computed, not unpickled")
        if t is None:
            return self._runs
        times = np.atleast_1d(checks.times("t", t, self.solution.t[0], self.solution.t[-1]))
        if not times.size:
            raise WrongValue("t must hold at least one time", "shape")
        return self._runs.at(times)

    def __getstate__(self) -> dict[str, Any]:
        return vars(self) | {"_runs": None}     # which has functions at addresses

    def __repr__(self) -> str:
        lines = [f"Reference of {self.solution.system.name}: |error of p| <= {self.error:.2g}, "
                 f"|error of v| <= {self.velocity_error:.2g}, {len(self.solution.t)} samples"
                 + (", double-double arithmetic" if self.low else "")]
        lines += [f"  {d.steps:8} steps, {d.formulation:19} {d.integrator:14} {'rounded otherwise, ' if d.rounded else '':19}"
                  f"differ by {d.p:.2g} in p, {d.v:.2g} in v" for d in self.differences]
        return "\n".join(lines + [f"  not excluded: {caveat}" for caveat in self.caveats])
