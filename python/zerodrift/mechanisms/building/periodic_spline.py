"""Periodic quintic splines, for cams that are given by a table."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..._private import checks, gateway
from ...errors import WrongValue
from ...laws.splines import NEIGHBOURS
from ...laws.table import REPEATS, Spline, Table

PERIOD = 2 * np.pi
CLOSING = 1e-9      # rad, and of the largest value: how near the last point of a table is to its first where it closes the turn

# Quintic polynomials in s = 0 ... 1 by their values, first and second derivatives at both ends: rows (y0, y0', y0'', y1, y1',
# y1''), columns 1, s, ..., s**5.
HERMITE = np.array([[1, 0, 0, -10, 15, -6], [0, 1, 0, -6, 8, -3], [0, 0, 0.5, -1.5, 1.5, -0.5],
                    [0, 0, 0, 10, -15, 6], [0, 0, 0, -4, 7, -3], [0, 0, 0, 0.5, -1, 0.5]])


class _Part(Spline):
    """Spline in products whose sum is smooth."""

    def jump(self, derivatives: int) -> None:
        """Nowhere, of the sum."""


def periodic_spline(what: str, angles: Any, values: Any) -> Table:
    """The quintic spline through a table over one turn; it has four continuous derivatives, so that a cam jerks nowhere.

    Parameters
    ----------
    angles, values : array_like (n,)
        The table: angles in rad, increasing, within less than one turn; at least three. A last point one turn after the first
        may be there, with the same value.
    """
    angles = np.asarray(checks.real(f"angles of {what} must hold", angles), dtype=float)
    n = angles.size
    if angles.ndim != 1 or n < 3:
        raise WrongValue(f"angles of {what} must have shape (n,) with n at least 3, not {angles.shape}", "shape")
    values = checks.vector(f"values of {what}", values, n)
    closes = abs(angles[-1] - angles[0] - PERIOD) < CLOSING and abs(values[-1] - values[0]) <= CLOSING * np.abs(values).max()
    if n > 3 and closes:        # it says the same at both ends
        angles, values = angles[:-1], values[:-1]
    ends = np.append(angles, angles[0] + PERIOD)
    widths = np.diff(ends)
    if not (widths > 0).all():
        raise WrongValue(f"angles of {what} must increase and lie within one turn (a point at its end has the value of the "
                         f"first), not {checks.shown(angles)}", "not-increasing")
    made = Table(_products(ends, _coefficients(widths, values)), f"{n} points of a turn")
    made.written_as = {"angles": angles.tolist(), "values": values.tolist()}
    return made


def _coefficients(widths: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The coefficients (n, 6) of the pieces, from a turn amid so many that the ends are not felt."""
    n, turns = values.size, -(-NEIGHBOURS // values.size)
    t = np.append(0.0, np.cumsum(np.tile(widths, 2 * turns + 1)))
    value, rate, second = at = np.zeros((3, t.size, 1))
    value[:, 0] = np.append(np.tile(values, 2 * turns + 1), values[0])
    gateway.quintic_spline(t, value, rate, second)
    at, scale = at[:, turns * n:, 0].T[:n + 1], widths[:, None]**np.arange(3)
    return np.hstack([at[:-1] * scale, at[1:] * scale]) @ HERMITE


def _products(ends: np.ndarray, coefficients: np.ndarray) -> list[list[Spline]]:
    """Its cubic part, and the fourth and fifth powers of the share of the way to the next point."""
    def spline(*powers: Any) -> Spline:     # 3, 2, 1, 0
        knots = np.zeros((ends.size, 5))
        knots[:, 0], knots[-1, 1] = ends, REPEATS
        for i, power in enumerate(powers):
            knots[:-1, 1 + i] = power
        return _Part(knots, "angle")

    scale, (value, slope, square, cubic, fourth, fifth) = 1 / np.diff(ends), coefficients.T
    share = spline(0, 0, scale, 0)
    return [[spline(cubic * scale**3, square * scale**2, slope * scale, value)], [spline(0, 0, 0, fourth), *[share] * 4],
            [spline(0, 0, 0, fifth), *[share] * 5]]
