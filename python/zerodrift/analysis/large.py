"""Equilibria of mechanisms of many bodies in the plane, without dense matrices.

Newton's method of `rest`, on the equations

    [ K  C^T ] [   z   ]   [ f ]
    [ C   0  ] [ dlam  ] = [ 0 ]

with sparse factors. K has the columns of the residual C^T lambda - f, multipliers frozen, by central differences along many
bodies at once: bodies whose rows do not meet have a common difference. Projection (25a) is the retraction, and the norm of the
acceleration in the mass metric is what has to vanish.
"""

from __future__ import annotations

import importlib
import importlib.util
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from .._private.gateway import CoreSystem, acceleration
from .._private.gateway.packed_layout import Packing
from ..errors import EquilibriumFailed, ZerodriftError
from ..runs.arguments import methods, settings
from ..runs.states.operations import project
from ..systems.base import BaseSystem, core_of
from .state import scales

MANY = 200              # velocities: with fewer, dense matrices are faster
ITERATIONS = 600
STEP = 1e-4             # of a central difference, in characteristic scales
LARGEST_STEP = 1.0      # largest change of a coordinate in a step, in characteristic scales
LARGEST_MOVE = 30.0     # the same before it is shortened: longer ones have the direction of a stiffness that is almost singular
SMALLEST_PART = 1e-9
BALANCED = 1e-12        # relative to the magnitudes of the forces
ROUNDED = 1e-9          # a balance that no step improves counts up to here
DEPENDENT = 1e-13       # of the rows of C: regularization of redundant constraints
STIFF = 1e7             # weight of the constraints where the sign of the stiffness is determined


def blocks_that_meet(system: BaseSystem) -> list[set[int]] | None:
    """The bodies on whose position the residual of each body depends; None where dense matrices serve."""
    core, drawing = core_of(system), getattr(system, "_drawing", None)
    if core.nv <= MANY or not core.packing or drawing is None or drawing.dimension != 2 or not _has_scipy():
        return None
    parts = {body.name: i for i, body in enumerate(drawing.parts())}
    if len(parts) != len(core.packing.blocks) or core.c.followers or "Phi_t" in core.evaluate_stored(0.0, *_start(system)):
        return None
    groups = [touched for _, touched in core.packing.groups]
    for element in drawing.elements.values():
        if element.name in parts or element is drawing.ground or hasattr(element, "bodies"):
            continue
        if type(element).__name__ != "Spring":
            return None
        ends = (getattr(end, "body", end).name for end in (element.first, element.second))
        groups.append(tuple(parts[name] for name in ends if name in parts))
    meet = [{i} for i in range(len(parts))]
    for touched in groups:
        for one, other in combinations(touched, 2):
            meet[one].add(other)
            meet[other].add(one)
    return meet


def _has_scipy() -> bool:
    return importlib.util.find_spec("scipy") is not None


def _start(system: BaseSystem) -> tuple[np.ndarray, np.ndarray]:
    return np.array(system._state_or_start(None, None, "p", "v", 0.0)[0]), np.zeros(system.nv)


def packing_of(core: CoreSystem) -> Packing:
    """Storage of a system for which `blocks_that_meet` found some."""
    assert core.packing is not None
    return core.packing


class SparseBalance:
    """Terms, accelerations and multipliers of a system that is let go at a position."""

    def __init__(self, system: BaseSystem, t: float, p: np.ndarray) -> None:
        self.system, self.t, self.core = system, t, core_of(system)
        self.packing = packing_of(self.core)
        self.p, self.rest = np.ascontiguousarray(p), np.zeros(system.nv)
        self.terms = self.core.evaluate_stored(t, self.p, self.rest)
        self.vdot, self.lam = acceleration(self.core, methods.row_of("formulations", "augmented"),
                                           settings.on_singular_row("stop"), t,
                                           self.p, self.rest)
        self.unbalanced = self.core.times("M", self.terms["M"], self.vdot, t, self.p, self.rest)     # f - C^T lambda
        self.residual = float(np.sqrt(self.vdot @ self.unbalanced))

    @property
    def force(self) -> np.ndarray:
        """Generalized forces f, (nv,)."""
        return self.terms["f"]

    def size(self, z: np.ndarray) -> float:
        """Largest change of a coordinate by a displacement, in characteristic scales."""
        return float(np.abs(self._along(z) / scales(self.system, self.p).p).max(initial=0.0))

    def moved(self, z: np.ndarray) -> np.ndarray:
        """The position (nq,) on the constraints after a displacement (nv,) in quasi-coordinates."""
        guess = self.p + self._along(z)
        tight = methods.Projection(tol=1e-13)
        return project(self.system, guess, self.rest, self.t, projection=tight, formulation="augmented")[0]

    def _along(self, z: np.ndarray) -> np.ndarray:
        return self.core.times("A", self.terms["A"], z, self.t, self.p, self.rest) if "A" in self.terms else z

    def magnitude(self) -> float:
        """Norm of the magnitudes of forces and reactions in the mass metric, by the diagonal of M."""
        reactions = self.packing.times("C", np.abs(self.terms["C"]), np.abs(self.lam), transposed=True)
        size = self.core.force_magnitudes(self.t, self.p, self.rest) + reactions
        return float(np.linalg.norm(size / np.sqrt(np.maximum(sparse(self, "M").diagonal(), 1e-300))))

    def stiffness(self, pattern: list[Entries]) -> Any:
        """K (nv, nv), sparse."""
        scale, values = scales(self.system, self.p).v, []
        for moved, rows, columns in pattern:
            z = np.zeros(self.system.nv)
            z[moved] = STEP * scale[moved]
            step = self._along(z)
            change = self._residual(self.p + step) - self._residual(self.p - step)
            values.append(change[rows] / (2 * z[columns]))
        place = tuple(np.concatenate([entries[k] for entries in pattern]) for k in (1, 2))
        K = _scipy().csc_matrix((np.concatenate(values), place), shape=(self.system.nv, self.system.nv))
        return (K + K.T) / 2

    def _residual(self, p: np.ndarray) -> np.ndarray:
        terms = self.core.evaluate_stored(self.t, np.ascontiguousarray(p), self.rest)
        return self.packing.times("C", terms["C"], self.lam, transposed=True) - terms["f"]


def _scipy() -> Any:
    return importlib.import_module("scipy.sparse")


def sparse(balance: SparseBalance, name: str) -> Any:
    """C or M as a sparse matrix."""
    packing = balance.packing
    place, shape = np.array(packing.places(name)), packing.shapes[name]
    return _scipy().csc_matrix((balance.terms[name], np.divmod(place, shape[1])), shape=shape)


class Entries(NamedTuple):
    """Velocities that are varied together, and rows and columns of the entries of K that follow from it."""

    moved: np.ndarray
    rows: np.ndarray
    columns: np.ndarray


def pattern_of(system: BaseSystem, meet: list[set[int]]) -> list[Entries]:
    """The entries of K, by groups of bodies no two of which meet a common one."""
    sizes = [block[1] for block in packing_of(core_of(system)).blocks]
    starts = np.cumsum([0, *sizes])
    touched = [np.concatenate([np.arange(starts[j], starts[j + 1]) for j in sorted(near)]) for near in meet]
    entries = []
    for blocks in _apart(meet):
        for k in range(max(sizes[i] for i in blocks)):
            able = [i for i in blocks if k < sizes[i]]
            moved = starts[able] + k
            entries.append(Entries(moved, np.concatenate([touched[i] for i in able]),
                                   np.repeat(moved, [len(touched[i]) for i in able])))
    return entries


def _apart(meet: list[set[int]]) -> list[list[int]]:
    """Groups of bodies no two of which meet a common one."""
    colour: list[int] = [-1] * len(meet)
    for i, near in enumerate(meet):
        taken = {colour[k] for j in near for k in meet[j]}
        colour[i] = next(c for c in range(len(meet)) if c not in taken)
    groups: list[list[int]] = [[] for _ in range(max(colour, default=-1) + 1)]
    for i, c in enumerate(colour):
        groups[c].append(i)
    return groups


def found(system: BaseSystem, t: float, p: np.ndarray, meet: list[set[int]]) -> tuple[SparseBalance, bool | None, int]:
    """The balance found downhill from a position, its stability, and the number of iterations.

    Raises
    ------
    EquilibriumFailed
    """
    pattern = pattern_of(system, meet)
    here = SparseBalance(system, t, project(system, p, np.zeros(system.nv), t, projection=methods.Projection(tol=1e-13))[0])
    iterations = 0
    while iterations < ITERATIONS:
        if here.residual <= BALANCED * here.magnitude():
            break
        there = _step(here, _downhill(here, here.stiffness(pattern)))
        if there is None:
            break
        here, iterations = there, iterations + 1
    if here.residual > ROUNDED * here.magnitude():
        raise EquilibriumFailed(f"{system.name} must have a position in which its forces balance, and none was found: a force of "
                                f"{here.residual:.3g} N/sqrt(kg) in the mass metric remains; start the search elsewhere with "
                                "near=")
    return here, _is_stable(here, here.stiffness(pattern)), iterations


def _downhill(here: SparseBalance, K: Any) -> np.ndarray:
    """Newton's step z (nv,), with as much of M added to K as makes it short enough and the forces do work along it."""
    C, M, added = sparse(here, "C"), sparse(here, "M"), 0.0
    for _ in range(30):
        z = _solved(K + added * M, C, here.unbalanced)
        if np.isfinite(z).all() and z @ here.unbalanced > 0 and here.size(z) < LARGEST_MOVE:
            return z
        added = 10 * added or 1e-6 * float(max(np.abs(K.diagonal() / M.diagonal()).max(), np.abs(here.vdot).max()))
    return here.vdot


def _solved(K: Any, C: Any, force: np.ndarray) -> np.ndarray:
    size = DEPENDENT * float(np.abs(C).max()) / max(float(np.abs(K).max()), 1e-300)
    matrix = _scipy().bmat([[K, C.T], [C, -size * _scipy().identity(C.shape[0])]], format="csc")
    try:
        factor = importlib.import_module("scipy.sparse.linalg").splu(matrix)
    except RuntimeError:        # singular
        return np.full(len(force), np.nan)
    return factor.solve(np.concatenate([force, np.zeros(C.shape[0])]))[:len(force)]


def _step(here: SparseBalance, z: np.ndarray) -> SparseBalance | None:
    """The balance after as much of a step as the forces do work along; None: no part of it is."""
    part = min(1.0, LARGEST_STEP / max(here.size(z), 1e-300))
    while part > SMALLEST_PART:
        try:
            there = SparseBalance(here.system, here.t, here.moved(part * z))
            work = float(z @ (here.force + there.force))
            if there.residual <= 0.5 * here.residual or (work > 0 and there.residual > BALANCED * there.magnitude()):
                return there
        except ZerodriftError:
            pass
        part /= 4
    return None


def _is_stable(here: SparseBalance, K: Any) -> bool | None:
    """True if K with stiff constraints is positive definite, as all pivots are positive; None where that does not decide."""
    mass = _scipy().diags(1 / np.sqrt(np.maximum(sparse(here, "M").diagonal(), 1e-300)))
    K, C = mass @ K @ mass, sparse(here, "C") @ mass
    products = C.T @ C
    matrix = (K + STIFF * float(np.abs(K).max() / np.abs(products).max()) * products).tocsc()
    try:
        factor = importlib.import_module("scipy.sparse.linalg").splu(
            matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError:        # a pivot is zero
        return None
    is_symmetric = bool((factor.perm_r == factor.perm_c).all())
    return True if is_symmetric and bool((factor.U.diagonal() > 0).all()) else None
