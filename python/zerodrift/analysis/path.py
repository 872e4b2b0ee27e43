"""A path of equilibria over a parameter, followed by predictor and corrector along its arc length.

With z on the basis V of the free directions and m the scaled parameter, the balance V^T (f - d) = 0 leaves a curve, whose
tangent solves K z' = g m': K is the stiffness, g the derivative of the balance by the parameter, the constraints kept. At a
limit point m' = 0 and K is singular, while the matrix with the tangent as its last row is regular.

E. Riks, An incremental approach to the solution of snapping and buckling problems, Int. J. Solids Structures 15 (1979).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..errors import EquilibriumFailed, ZerodriftError
from ..systems.base import BaseSystem
from .rest import Balance
from .retraction import moved, onto

FIRST_STEP, LARGEST_STEP, SMALLEST_STEP = 0.02, 0.1, 1e-8       # characteristic scales of position and parameter
ITERATIONS = 8
CONVERGED = 1e-11           # last step of Newton's method
DIFFERENCE = 1e-4           # of the parameter's scale: half of a central difference
LARGEST_TURN = 0.3          # of the unit tangent in a step
LEVEL = 1e-11               # slope of the parameter that counts as zero


class Knot(NamedTuple):
    """A point of the path: balance, parameter, and unit tangent in scaled displacements (nv,) and the scaled parameter."""

    balance: Balance
    value: float
    eta: np.ndarray
    slope: float


class Curve:
    """Equilibria of a system over one of its parameters.

    Parameters
    ----------
    system : BaseSystem
    parameter : str
    t : float
    size : float
        The scale of the parameter.
    """

    def __init__(self, system: BaseSystem, parameter: str, t: float, size: float) -> None:
        self.system, self.parameter, self.t, self.size = system, parameter, t, size

    def balance(self, p: np.ndarray, value: float) -> Balance:
        """Balance of forces at a value of the parameter, at the position nearest to p that satisfies the constraints."""
        system = self.system.with_parameters({self.parameter: float(value)})
        return Balance(system, self.t, onto(system, self.t, p), {})

    def _by_parameter(self, here: Balance, value: float) -> np.ndarray:
        """G (k,): the derivative of the balance by the scaled parameter, multipliers frozen, constraints kept."""
        ends = []
        for sign in (1, -1):
            there = self.balance(here.at.p, value + sign * DIFFERENCE * self.size)
            ends.append(here.V.T @ (there.at.force - there.at.C.T @ here.multipliers))
        return (ends[0] - ends[1]) / (2 * DIFFERENCE)

    def knot(self, here: Balance, value: float, eta: np.ndarray, slope: float) -> Knot:
        """Point of the path at a balance; its tangent is on the same side as the direction (eta, slope)."""
        matrix = np.column_stack([here.stiffness, -self._by_parameter(here, value)])
        null = np.linalg.svd(matrix)[2][-1]
        found, m = here.V @ null[:-1] / here.tangent.scale, float(null[-1])
        length = float(np.sqrt(found @ found + m * m))
        sign = 1.0 if found @ eta + m * slope >= 0 else -1.0
        return Knot(here, value, sign * found / length, sign * m / length)

    def step(self, knot: Knot, length: float) -> Knot | None:
        """Point of the path at a distance `length` along the tangent of a point; None if Newton's method finds none there."""
        at, value = knot.balance.at, knot.value + length * knot.slope * self.size
        try:
            here = self.balance(moved(at, length * knot.eta * knot.balance.tangent.scale), value)
            for _ in range(ITERATIONS):
                z, dm = self._correction(here, value, knot)
                value += dm * self.size
                moves = float(np.abs(here.V @ z / here.tangent.scale).max(initial=0.0)) + abs(dm)
                here = self.balance(moved(here.at, here.V @ z), value)
                if moves < CONVERGED:
                    return self._near(knot, self.knot(here, value, knot.eta, knot.slope), length)
                if not moves < 1.0:
                    break
        except (ZerodriftError, ArithmeticError, np.linalg.LinAlgError):
            pass
        return None

    def _correction(self, here: Balance, value: float, knot: Knot) -> tuple[np.ndarray, float]:
        """Newton's step (k,) and that of the scaled parameter, across the tangent of a knot."""
        across = knot.eta @ (here.V / here.tangent.scale[:, None])
        matrix = np.block([[here.stiffness, -self._by_parameter(here, value)[:, None]], [across, np.array([[knot.slope]])]])
        found = np.linalg.solve(matrix, np.append(here.force, 0.0))
        return found[:-1], float(found[-1])

    @staticmethod
    def _near(knot: Knot, found: Knot, length: float) -> Knot | None:
        """The point, where the tangent turns little on the way to it."""
        turned = np.sqrt(np.sum((found.eta - knot.eta)**2) + (found.slope - knot.slope)**2)
        return found if turned <= LARGEST_TURN or abs(length) < SMALLEST_STEP else None

    def advance(self, knot: Knot, length: float) -> tuple[Knot, float]:
        """The next point, and the length of the step to it.

        Raises
        ------
        EquilibriumFailed
            If the path cannot be followed.
        """
        while length > SMALLEST_STEP:
            found = self.step(knot, length)
            if found is not None:
                return found, length
            length /= 2
        raise EquilibriumFailed(f"the path of equilibria of {self.system.name} must be a smooth curve to be followed, and is not "
                                f"at {self.parameter} = {knot.value:.9g}: branches may meet there")

    def limit_point(self, knot: Knot, last: Knot, length: float) -> Knot:
        """The point between two, a step apart, at which the parameter turns back, by regula falsi (Illinois)."""
        (low, below), (high, above), best = (0.0, knot.slope), (length, last.slope), last
        for _ in range(60):
            middle = (low * above - high * below) / (above - below)
            best = self.step(knot, middle) or best
            if abs(best.slope) < LEVEL or abs(middle - high) < 1e-15 * length:
                break
            if best.slope * above < 0:
                low, below = high, above
            else:
                below /= 2
            high, above = middle, best.slope
        return best

    def between(self, first: Knot, last: Knot, value: float) -> Knot:
        """The point between two at which the parameter has a value."""
        part = (value - first.value) / (last.value - first.value)
        here = self.balance(first.balance.at.p + part * (last.balance.at.p - first.balance.at.p), value)
        for _ in range(ITERATIONS):
            z = np.linalg.lstsq(here.stiffness, here.force, rcond=here.zero)[0]
            if here.size(z) < CONVERGED:
                break
            here = self.balance(moved(here.at, here.V @ z), value)
        return Knot(here, value, first.eta, first.slope)
