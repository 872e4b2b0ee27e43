"""`Reference`: a motion with a certified error."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..runs.solution import Solution
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

    def __repr__(self) -> str:
        lines = [f"Reference of {self.solution.system.name}: |error of p| <= {self.error:.2g}, "
                 f"|error of v| <= {self.velocity_error:.2g}, {len(self.solution.t)} samples"
                 + (", double-double arithmetic" if self.low else "")]
        lines += [f"  {d.steps:8} steps, {d.formulation:19} {d.integrator:14} {'rounded otherwise, ' if d.rounded else '':19}"
                  f"differ by {d.p:.2g} in p, {d.v:.2g} in v" for d in self.differences]
        return "\n".join(lines + [f"  not excluded: {caveat}" for caveat in self.caveats])
