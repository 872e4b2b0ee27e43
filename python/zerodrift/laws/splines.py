"""Cubic splines: coefficients (4, n) of powers 3, 2, 1, 0 of the distance from each point; after the last one a line goes on."""

from __future__ import annotations

import math

import numpy as np

NEIGHBOURS = 64     # points after which a value's influence has fallen below rounding: at least by half from each to the next
CLOSE = 1e-10       # of the distance wanted, for the weight of the curvature


def interpolating(x: np.ndarray, y: np.ndarray, *, repeats: bool) -> np.ndarray:
    """The spline through all points: not-a-knot, or with the same derivatives at both ends."""
    h, pieces = np.diff(x), x.size - 1
    periods = -(-NEIGHBOURS // pieces) if repeats else 0
    steps, long, second = np.tile(np.diff(y) / h, 2 * periods + 1), np.tile(h, 2 * periods + 1), np.zeros(2)
    if long.size > 1:
        R, first, last = _bands(long), long[0] / long[1], long[-1] / long[-2]
        if long.size == 2:      # a parabola
            first = last = 0.0
        R[0, 1:] += R[0, 0] * np.array([1 + first, -first])
        R[-1, :2] += R[-1, 2] * np.array([-last, 1 + last])
        inner = _solved(R, np.diff(steps))
        second = np.concatenate([[inner[0] - first * (inner[:2][-1] - inner[0])], inner,
                                 [inner[-1] + last * (inner[-1] - inner[-2:][0])]])
    return _pieces(h, y, second[periods * pieces:][:pieces + 1])


def smoothed(x: np.ndarray, y: np.ndarray, distance: float) -> tuple[np.ndarray, float]:
    """The natural spline of least curvature at this root mean square distance from the points, and the weight of its curvature.

    C. Reinsch, "Smoothing by Spline Functions", Numerische Mathematik 10 (1967) 177-183: with the second derivatives c and the
    second differences Q^T y, the distances are w Q c where (R + w Q^T Q) c = Q^T y. They grow with w; logarithms are searched.
    """
    h, line = np.diff(x), np.polynomial.Polynomial.fit(x, y, 1)(x)
    if distance >= _size(y - line):
        return _pieces(h, line, np.zeros(x.size)), math.inf
    n, R, Q = x.size - 2, np.pad(_bands(h), ((0, 0), (1, 1))), np.array([1 / h[:-1], -1 / h[:-1] - 1 / h[1:], 1 / h[1:]]).T
    wide = np.pad(Q, ((2, 2), (2, 2)))
    products = np.array([(Q * wide[2 + k:n + 2 + k, 2 - k:5 - k]).sum(axis=1) for k in range(-2, 3)]).T     # bands of Q^T Q

    def found(log_weight: float) -> tuple[float, np.ndarray, np.ndarray]:
        weight = math.exp(log_weight)
        second = _solved(R + weight * products, np.diff(np.diff(y - line) / h))
        residual = np.sum([np.pad(weight * Q[:, i] * second, (i, 2 - i)) for i in range(3)], axis=0)
        return math.log(_size(residual) / distance), residual, np.pad(second, 1)

    ends = [[at := 3 * math.log(np.mean(h)), found(at)[0]]] * 2
    for side, sign in enumerate((1, -1)):
        while sign * ends[side][1] > 0:
            ends[side] = [at := ends[side][0] - 7 * sign, found(at)[0]]
    for _ in range(100):        # regula falsi, where the value at the end that stays is halved
        (low, at_low), (high, at_high) = ends
        middle = (low * at_high - high * at_low) / (at_high - at_low)
        gap, residual, second = found(middle)
        if abs(gap) < CLOSE:
            break
        side = int(gap > 0)
        ends[1 - side] = [ends[1 - side][0], ends[1 - side][1] / 2]
        ends[side] = [middle, gap]
    return _pieces(h, y - residual, second), math.exp(middle)


def _size(residual: np.ndarray) -> float:
    return float(np.sqrt(np.mean(residual**2)))


def _bands(h: np.ndarray) -> np.ndarray:
    """Bands (n - 2, 3) of the matrix R that makes slopes continuous: R c = Q^T y."""
    return np.array([h[:-1], 2 * (h[:-1] + h[1:]), h[1:]]).T / 6


def _pieces(h: np.ndarray, y: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Coefficients from values and second derivatives at the points."""
    steps = np.diff(y) / h
    slopes = np.append(steps - h * (2 * second[:-1] + second[1:]) / 6, steps[-1] + h[-1] * (second[-2] + 2 * second[-1]) / 6)
    return np.array([np.append(np.diff(second) / (6 * h), 0.0), np.append(second[:-1] / 2, 0.0), slopes, y])


def _solved(bands: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solution (n,) of equations of bands (n, 2 w + 1) about the diagonal, by elimination without pivots."""
    rows, x = bands.tolist(), right.tolist()
    n, w = len(rows), bands.shape[1] // 2
    for i, row in enumerate(rows):
        for j in range(1, min(w, n - 1 - i) + 1):
            factor = rows[i + j][w - j] / row[w]
            for k in range(1, w + 1):
                rows[i + j][w - j + k] -= factor * row[w + k]
            x[i + j] -= factor * x[i]
    for i in range(n - 1, -1, -1):
        for k in range(1, min(w, n - 1 - i) + 1):
            x[i] -= rows[i][w + k] * x[i + k]
        x[i] /= rows[i][w]
    return np.array(x)
