"""Choice of orders of elimination: their pivots are large at the start and at configurations around it.

Configurations are random and projected onto the constraints by Newton's method. The search for an order is greedy: among the
solves whose determinants are large in all configurations that remain, the next one has the fewest constraints, then the least
fill-in. If no determinant is large in all of them, some configurations are left to the next order; the start never is. Two or
three varying constraints are solved together if that serves as many configurations, as one division takes less time than two
consecutive ones.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from itertools import combinations

import numpy as np

from .steps import Order, Solve, Unwritten

Evaluate = Callable[[np.ndarray, np.ndarray], dict[str, np.ndarray]]
MOST = 4                # orders, as the interface has it
SAMPLES = 384
ITERATIONS = 12         # of Newton's method
REGULARIZATION = 1e-12  # in parts of the trace of C C^T: added to its diagonal
CLOSED = 1e-9           # in parts of its row: a violation that is none
DETERMINANTS = {1: 0.5, 2: 0.1, 3: 0.05}      # of a determinant of so many rows, in parts of the largest entries of these
USABLE = {size: share / 4 for size, share in DETERMINANTS.items()}      # a step may begin with 2^-3: csrc/step_limits.h
TRIPLES = 9             # rows and columns up to which three at a time are tried
SPREADS = (0.2, 0.7, 2.0)       # of configurations around the start, in rad or parts of the mechanism's length


def choose(evaluate: Evaluate, sizes: tuple[int, int, int, int], p0: np.ndarray | None, lengths: np.ndarray,
           embeds: bool = False) -> list[Order]:
    """The orders to be written, best first; raises `Unwritten` where no order serves the start.

    Parameters
    ----------
    evaluate : callable
        A, if it is not the identity, Phi and C by name, each (k, size), at t (k,) and p (k, nq).
    embeds : bool
        True: the orders are for formulations in independent velocities, and each is for another set of these.
    lengths : ndarray (nq + nv,) of bool
        Which coordinates and velocities are lengths.
    p0 : ndarray (nq,), optional
        The start.
    """
    m = sizes[2] + sizes[3]
    if not m:
        return [()]
    if m > sizes[1]:
        raise Unwritten("there are more constraints than velocities")
    C = _configurations(evaluate, sizes, p0, lengths)
    orders = [] if not len(C) else _for_sets(C) if embeds else _for_places(C / _largest(C))
    if not orders:
        raise Unwritten("constraints depend on each other at the start, or nearly")
    return orders


def _largest(C: np.ndarray) -> np.ndarray:
    """The largest entry of each row, for all of it."""
    rows = np.abs(C).max(axis=2, keepdims=True)
    return np.where(rows == 0, 1.0, rows)


def _for_places(C: np.ndarray) -> list[Order]:
    """An order, and others for where it does not serve."""
    orders: list[Order] = []
    while len(orders) < MOST and len(C):
        order, served = max((_Search(C, DETERMINANTS, at_once).run() for at_once in (True, False)),
                            key=lambda each: each[1].sum())
        if not served.any() and not orders:     # the start ought to be served, if less well
            order, served = _Search(C, USABLE).run()
        if not served.any():
            break
        orders.append(order)
        C = C[~served]
    return orders


def _for_sets(C: np.ndarray) -> list[Order]:
    """An order for each of the sets of dependent velocities that formulations choose most often, that of the start first."""
    sets = [tuple(np.flatnonzero(row).tolist()) for row in _dependent(C / _largest(C[:1]))]
    found = [(chosen, C[[other == chosen for other in sets]]) for chosen, _ in Counter(sets).most_common()]
    orders: list[Order] = []
    for chosen, where in sorted(found, key=lambda each: each[0] != sets[0]):
        order, served = _Search((where / _largest(where))[:, :, chosen], USABLE).run()
        if served.any():
            orders.append(tuple(Solve(solve.rows, tuple(chosen[j] for j in solve.columns)) for solve in order))
    return orders[:MOST]


def _dependent(C: np.ndarray) -> np.ndarray:
    """Which velocities (k, nv) complete pivoting solves for in each of C (k, m, nv)."""
    C, each = C.copy(), np.arange(len(C))
    k, m, nv = C.shape
    left, found = np.ones((k, m), dtype=bool), np.zeros((k, nv), dtype=bool)
    for _ in range(m):
        row, column = np.divmod(np.where(left[:, :, None], np.abs(C), -1.0).reshape(k, -1).argmax(axis=1), nv)
        pivot = C[each, row]
        share = C[each, :, column] / np.where(pivot[each, column] == 0, 1.0, pivot[each, column])[:, None]
        left[each, row], found[each, column] = False, True
        C -= np.where(left, share, 0.0)[:, :, None] * pivot[:, None, :]
        C[each, :, column] = 0.0
    return found


def _configurations(evaluate: Evaluate, sizes: tuple[int, int, int, int], p0: np.ndarray | None,
                    lengths: np.ndarray) -> np.ndarray:
    """C (k, m, nv) in characteristic scales, at the start and at random configurations around it."""
    nq, nv, mh, _ = sizes
    chance = np.random.default_rng(20)
    start = np.zeros(nq) if p0 is None else p0
    length = np.abs(start[lengths[:nq]]).max(initial=0.0) or 1.0
    unit_p, unit_v = (np.where(part, length, 1.0) for part in (lengths[:nq], lengths[nq:]))
    t = np.concatenate([[0.0], chance.uniform(0, 10, SAMPLES)])
    spread = np.repeat(SPREADS, SAMPLES // len(SPREADS))[:, None]
    p = start + np.concatenate([np.zeros((1, nq)), spread * chance.uniform(-1, 1, (SAMPLES, nq))]) * unit_p
    found = evaluate(t, p)
    is_open = _open(found, mh, unit_v)
    for _ in range(ITERATIONS if mh else 0):
        if not is_open.any():
            break
        p[is_open] -= _newton({name: value[is_open] for name, value in found.items()}, sizes)
        for name, value in evaluate(t[is_open], p[is_open]).items():
            found[name][is_open] = value
        is_open = _open(found, mh, unit_v)
    return found["C"].reshape(len(t), -1, nv)[~is_open] * unit_v


def _open(found: dict[str, np.ndarray], mh: int, unit_v: np.ndarray) -> np.ndarray:
    """Which configurations (k,) violate the constraints."""
    C = found["C"].reshape(len(found["C"]), -1, len(unit_v)) * unit_v
    closed = np.isfinite(C).all(axis=(1, 2))
    if mh:
        closed &= (np.abs(found["Phi"]) <= CLOSED * _largest(C)[:, :mh, 0]).all(axis=1)
    return ~closed


def _newton(found: dict[str, np.ndarray], sizes: tuple[int, int, int, int]) -> np.ndarray:
    """Minimum-norm Newton corrections dp = A w (k, nq) with C w = Phi; zero for configurations without one."""
    nq, nv, mh, _ = sizes
    k = len(found["Phi"])
    C = np.nan_to_num(found["C"].reshape(k, -1, nv)[:, :mh])
    CCt = C @ C.swapaxes(1, 2)
    CCt += REGULARIZATION * (np.trace(CCt, axis1=1, axis2=2)[:, None, None] + 1.0) * np.eye(mh)   # for dependent rows
    w = (C.swapaxes(1, 2) @ np.linalg.solve(CCt, np.nan_to_num(found["Phi"])[:, :, None]))[:, :, 0]
    return (found["A"].reshape(k, nq, nv) @ w[:, :, None])[:, :, 0] if "A" in found else w


class _Search:
    """Search for one elimination order that is valid in as many configurations C (k, m, nv) as possible, the first above all."""

    def __init__(self, C: np.ndarray, large: dict[int, float], at_once: bool = False) -> None:
        self.large, self.at_once = large, at_once
        self.C, self.entries = C.copy(), C != 0
        self.entries[:] = self.entries.any(axis=0)
        self.served = np.ones(len(C), dtype=bool)
        self.rows, self.columns = set(range(C.shape[1])), set(range(C.shape[2]))

    def run(self) -> tuple[Order, np.ndarray]:
        """Find the order; return it and a mask of the configurations in which it is valid."""
        order = []
        while self.rows:
            solve = self._best()
            if solve is None:
                return (), np.zeros_like(self.served)
            order.append(solve)
            self._eliminate(solve)
        return tuple(order), self.served

    def _best(self) -> Solve | None:
        """The smallest solve whose determinant is large in all configurations; else the one that is large in the most of them."""
        partial: list[tuple[int, Solve, np.ndarray]] = []
        for size in self._sizes():
            full = []
            for solve, determinants in self._candidates(size):
                large = (determinants >= self.large[size]) & self.served
                if large.sum() == self.served.sum():
                    full.append((self._fill(solve), -determinants[self.served].min(), solve))
                elif large[0] or not self.served[0]:
                    partial.append((int(large.sum()), solve, large))
            if full:
                return min(full)[2]
        if not partial:
            return None
        count, solve, large = max(partial, key=lambda each: (each[0], -len(each[1].rows)))
        self.served = large
        return solve if count else None

    def _sizes(self) -> list[int]:
        """Numbers of constraints solved together, in order of preference."""
        sizes = list(range(1, min(3, len(self.rows)) + 1))
        moving = np.ptp(self.C[:, sorted(self.rows)], axis=0).any(axis=1)
        return sizes[::-1] if self.at_once and len(self.rows) <= 3 and moving.all() else sizes

    def _candidates(self, size: int) -> Iterator[tuple[Solve, np.ndarray]]:
        """Candidate solves of `size` rows, and the magnitudes of their determinants (k,)."""
        if size == 3 and (len(self.rows) > TRIPLES or len(self.columns) > TRIPLES):
            return
        for rows in combinations(sorted(self.rows), size):
            columns = [j for j in sorted(self.columns) if self.entries[0, list(rows), j].any()]
            for chosen in combinations(columns, size):
                yield Solve(rows, chosen), np.abs(np.linalg.det(self.C[:, rows][:, :, chosen]))

    def _fill(self, solve: Solve) -> int:
        """Maximum number of entries that an elimination fills in."""
        others = [k for k in self.rows if k not in solve.rows and self.entries[0, k, list(solve.columns)].any()]
        width = self.entries[0, list(solve.rows)].any(axis=0).sum() - len(solve.columns)
        return int(len(others) * width)

    def _eliminate(self, solve: Solve) -> None:
        rows, columns = list(solve.rows), list(solve.columns)
        self.rows -= set(rows)
        self.columns -= set(columns)
        B = self.C[:, rows][:, :, columns]
        B = np.where(self.served[:, None, None], B, np.eye(len(rows)))
        for k in self.rows:
            if self.entries[0, k, columns].any():
                share = np.linalg.solve(np.swapaxes(B, 1, 2), self.C[:, k, columns][:, :, None])[:, :, 0]
                self.C[:, k] -= np.einsum("ka,kaj->kj", share, self.C[:, rows])
                self.entries[:, k] |= self.entries[:, rows].any(axis=1)
                self.C[:, k, columns] = 0
