"""Benchmark problems for all programs: chains of uniform rods between two fixed points, in a plane, under gravity.

The paper's four-bar is such a chain of three rods. Coordinates are the absolute angles of the rods from the x axis.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

GRAVITY = 9.81


@dataclass(frozen=True, eq=False)
class Chain:
    """Rods in a row: the first turns about the origin, the tip of the last is held at (distance, 0)."""

    name: str
    lengths: np.ndarray     # (n,) m
    masses: np.ndarray      # (n,) kg
    distance: float         # m
    p0: np.ndarray          # (n,) rad
    v0: np.ndarray          # (n,) rad/s
    t_end: float            # s
    spacing: float = 0.1    # s between outputs

    @property
    def n(self):
        return len(self.lengths)

    @cached_property
    def outputs(self):
        """Times at which all are compared, (k,)."""
        return self.spacing * np.arange(round(self.t_end / self.spacing) + 1)

    @cached_property
    def inertias(self):
        """About the midpoints, (n,) kg m^2."""
        return self.masses * self.lengths**2 / 12

    @cached_property
    def coupling(self):
        """M_ij / cos(p_i - p_j), (n, n): what hangs beyond the inner of the two, and the outer's own half."""
        beyond = self.masses[::-1].cumsum()[::-1] - self.masses
        i, j = np.indices((self.n, self.n))
        outer = np.maximum(i, j)
        return (self.masses[outer] / 2 + beyond[outer]) * np.outer(self.lengths, self.lengths) + np.diag(
            self.inertias - self.masses * self.lengths**2 / 4)

    @cached_property
    def weight(self):
        """-f_i / cos(p_i), (n,) N m."""
        beyond = self.masses[::-1].cumsum()[::-1] - self.masses
        return GRAVITY * (self.masses / 2 + beyond) * self.lengths

    def midpoints(self, p):
        """Midpoints of the rods, (n, 2) m."""
        rods = self.lengths[:, None] * np.stack([np.cos(p), np.sin(p)], axis=1)
        return rods.cumsum(axis=0) - rods / 2


def accelerations(chain):
    """The function (p, v) -> vdot of the index-1 equations (8), as whoever brings an integrator would write it."""
    if hasattr(chain, "terms"):
        return chain.accelerations()
    n, K, w, lengths = chain.n, chain.coupling, chain.weight, chain.lengths
    leading, right = np.zeros((n + 2, n + 2)), np.empty(n + 2)
    M, C, Ct = leading[:n, :n], leading[n:, :n], leading[:n, n:]
    turn, solve = np.empty((2, n)), np.linalg.solve

    def vdot(p, v):
        turn[0], turn[1] = np.cos(p), np.sin(p)
        c, s = turn
        rods, squares = lengths * turn, v * v
        np.multiply(K, turn.T @ turn, out=M)
        C[0], C[1] = -rods[1], rods[0]
        Ct[:] = C.T
        Ks = K @ (s * squares), K @ (c * squares)
        right[:n] = c * Ks[0] - s * Ks[1] - w * c
        right[n:] = rods @ squares
        return solve(leading, right)[:n]

    return vdot


def four_bar():
    """The paper's example 1: what `zerodrift.systems.four_bar()` is when nothing else is said."""
    lengths, distance = np.array([0.3, 1.0, 0.6]), 1.0
    p = _closed(lengths, distance, np.array([np.pi / 2, 0.3, -1.5]), held=0)
    sine = np.sin(p[2] - p[1])
    v = np.array([1.0, 0.3 * np.sin(p[0] - p[2]) / sine, 0.3 / 0.6 * np.sin(p[1] - p[0]) / sine])
    return Chain("four-bar", lengths, np.array([1.5, 5.0, 3.0]), distance, p, v, 8.0, spacing=0.05)


def pendulum_chain(n):
    """A slack chain of n equal rods, 1.5 m and 3 kg in all, held 1 m apart, let go from where it does not hang."""
    lengths = np.full(n, 1.5 / n)
    place = np.linspace(-1, 1, n)
    p = _closed(lengths, 1.0, 0.9 * place + 0.5 * np.cos(np.pi * place))
    return Chain(f"chain of {n}", lengths, np.full(n, 3.0 / n), 1.0, p, np.zeros(n), 4.0)


def _closed(lengths, distance, p, held=None):
    """The nearest angles by Newton's method that close the loop, one of them held."""
    free = np.arange(len(p)) != held
    for _ in range(50):
        gap = [lengths @ np.cos(p) - distance, lengths @ np.sin(p)]
        C = np.stack([-lengths * np.sin(p), lengths * np.cos(p)]) * free
        p = p - np.linalg.lstsq(C, np.array(gap), rcond=None)[0]
    return p
