"""Periodic quintic splines, for cams that are given by a table."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..._private import checks
from ...errors import WrongValue
from ...symbolics.graph.plain_functions import FLOOR
from ...systems import autodiff

PERIOD = 2 * np.pi
CLOSING = 1e-9      # rad, and of the largest value: how near the last point of a table is to its first where it closes the turn

# Quintic polynomials in s = 0 ... 1 by their values, first and second derivatives at both ends: rows (y0, y0', y0'', y1, y1',
# y1''), columns 1, s, ..., s**5.
HERMITE = np.array([[1, 0, 0, -10, 15, -6], [0, 1, 0, -6, 8, -3], [0, 0, 0.5, -1.5, 1.5, -0.5],
                    [0, 0, 0, 10, -15, 6], [0, 0, 0, -4, 7, -3], [0, 0, 0, 0.5, -1, 0.5]])
# Their third and fourth derivatives at both ends.
BEND = np.array([[HERMITE[i] @ np.array([0, 0, 0, 6, 24 * s, 60 * s**2]) for i in range(6)] for s in (0.0, 1.0)])
TWIST = np.array([[HERMITE[i] @ np.array([0, 0, 0, 0, 24, 120 * s]) for i in range(6)] for s in (0.0, 1.0)])


class PeriodicSpline:
    """The quintic spline through a table over one turn; it has four continuous derivatives, so that a cam jerks nowhere.

    Parameters
    ----------
    angles, values : array_like (n,)
        The table: angles in rad, increasing, within less than one turn; at least three. A last point one turn after the first
        may be there, with the same value.
    """

    def __init__(self, what: str, angles: Any, values: Any) -> None:
        self.angles = np.asarray(checks.real(f"angles of {what} must hold", angles), dtype=float)
        n = self.angles.size
        if self.angles.ndim != 1 or n < 3:
            raise WrongValue(f"angles of {what} must have shape (n,) with n at least 3, not {self.angles.shape}", "shape")
        self.values = checks.vector(f"values of {what}", values, n)
        self._drop_closing_point()
        n = self.angles.size
        self._widths = np.diff(self.angles, append=self.angles[0] + PERIOD)
        if not (self._widths > 0).all():
            raise WrongValue(f"angles of {what} must increase and lie within one turn (a point at its end has the value of the "
                             f"first), not {checks.shown(angles)}", "not-increasing")
        self._coefficients = self._solve(n)

    def _drop_closing_point(self) -> None:
        """A table that says the same at both ends of a turn says it once."""
        span, size = self.angles[-1] - self.angles[0], np.abs(self.values).max()
        if self.angles.size > 3 and abs(span - PERIOD) < CLOSING and abs(self.values[-1] - self.values[0]) <= CLOSING * size:
            self.angles, self.values = self.angles[:-1], self.values[:-1]

    def _solve(self, n: int) -> np.ndarray:
        """The coefficients (n, 6) of the pieces: third and fourth derivatives are the same on both sides of every knot."""
        matrix, right = np.zeros((2 * n, 2 * n)), np.zeros(2 * n)
        for knot in range(n):
            for piece, end, sign in ((knot - 1, 1, 1.0), (knot, 0, -1.0)):
                width = self._widths[piece]
                for row, ends, power in ((2 * knot, BEND, 3), (2 * knot + 1, TWIST, 4)):
                    weight = sign * ends[end] / width**power
                    for side, place in ((0, piece % n), (1, (piece + 1) % n)):
                        right[row] -= weight[3 * side] * self.values[place]
                        matrix[row, 2 * place] += weight[3 * side + 1] * width
                        matrix[row, 2 * place + 1] += weight[3 * side + 2] * width**2
        slopes = np.linalg.solve(matrix, right).reshape(n, 2)
        ends = np.stack([np.column_stack([self.values, slopes[:, 0] * self._widths, slopes[:, 1] * self._widths**2]),
                         np.column_stack([np.roll(self.values, -1), np.roll(slopes[:, 0], -1) * self._widths,
                                          np.roll(slopes[:, 1], -1) * self._widths**2])], axis=1)
        return ends.reshape(n, 6) @ HERMITE

    def __call__(self, angle: Any) -> Any:
        turns = np.floor((autodiff.value(angle) - self.angles[0]) / PERIOD)
        angle = angle - turns * PERIOD
        piece = min(int(np.searchsorted(self.angles, autodiff.value(angle), side="right")) - 1, len(self.angles) - 1)
        s = (angle - self.angles[max(piece, 0)]) / self._widths[max(piece, 0)]
        value = 0.0
        for coefficient in self._coefficients[max(piece, 0)][::-1]:
            value = value * s + coefficient
        return value

    def written(self, equations: Any, angle: Any) -> Any:
        """Node of the value, from the node of an angle: the piece's numbers are chosen, so that one polynomial is computed."""
        graph, first = equations.graph, float(self.angles[0])
        turns = graph.call(FLOOR, graph.sum([(angle, 1 / PERIOD), (graph.one, -first / PERIOD)]))
        within = graph.sum([(angle, 1), (turns, -PERIOD)])
        conditions = [graph.comparison("<", within, graph.number(float(end))) for end in self.angles[1:]]

        def chosen(numbers: np.ndarray) -> Any:
            *cases, last = (graph.number(float(number)) for number in numbers)
            return graph.choice(tuple(zip(conditions, cases, strict=True)), last)

        s = graph.times(equations.difference(within, chosen(self.angles)), chosen(1 / self._widths))
        value = graph.zero
        for column in self._coefficients.T[::-1]:
            value = graph.plus(graph.times(value, s), chosen(column))
        return value
