"""Assembly: from a sketch to positions in which all joints are closed, and velocities that they allow.

The core assembles; here are the conditions in its terms, and the errors where they cannot be met.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from ..._private.gateway.mechanisms import assembly as core_assembly
from ..._private.gateway.mechanisms.assembly import CoreAssembly, CoreTarget, Outcome
from ..._private.gateway.mechanisms.core import MechanismCore
from ...errors import CorrectionFailed, InconsistentStart
from .contradictions import contradiction, unit_of

NUDGE = 1e-3            # step from a singular pose to nearby ones, in rad or parts of the mechanism's length
MIN_RATE = 1e-9         # relative to the largest velocity: rounding error of velocities
MIN_MASS = 1e-6         # of the largest, in the metric of velocities: mass of massless directions
RANK = 1e-9             # of the largest singular value: bound below which rows are redundant
MAX_DENSE = 1000        # constraints or velocities: larger matrices are not dense where all bodies are free and have mass


class Target(NamedTuple):
    """Component of a measure, and its prescribed value."""

    name: str
    measure: int
    component: int
    value: float


class Rates(NamedTuple):
    """Velocities (nv,), and True if they may depend on the motion of what drives carry."""

    v: np.ndarray
    is_relative: bool = False


def is_of_many(core: MechanismCore) -> bool:
    """True if matrices are too large to be dense."""
    has_diagonal_mass = core.packing is not None and core.stored("M") == (core.nv,)
    return has_diagonal_mass and max(core.nv, core.m) > MAX_DENSE


class Assembly:
    """The assembly of one mechanism at one time.

    Parameters
    ----------
    core : MechanismCore
        In absolute coordinates.
    rows : sequence of str
        Name of the element that each row of C belongs to, for errors.
    left_out : sequence of int
        Holonomic rows that are not looked at: of drives whose start value is not known yet.
    length : float
        The size of the mechanism in m.
    couplings : collection of int
        Rows of couplings without a law, as gears are: they belong to the drawing, as joints do.
    """

    def __init__(self, core: MechanismCore, rows: Sequence[str], left_out: Sequence[int], length: float,
                 t: float, couplings: Collection[int] = ()) -> None:
        self.core, self.rows, self.length, self.t = core, rows, length, t
        self.kept = sorted(set(range(core.mh)) - set(left_out))
        roles = ["joint" if core.rows[row].owner == "joint" else "ignored" if row in left_out
                 else "coupling" if row in couplings else "drive" for row in range(core.mh)]
        self.is_joint = np.array([roles[row] == "joint" for row in self.kept], dtype=bool)
        self._core = CoreAssembly(core, roles, length, t, is_of_many=is_of_many(core))
        angles = np.array([coordinate.kind == "angle" for coordinate in core.motions])
        self.scale = np.where(angles, 1.0, length)      # of coordinates: steps are in rad and parts of the length

    def _evaluate(self, p: np.ndarray) -> dict[str, np.ndarray]:
        """All terms at rest, if there are constraints."""
        return self.core.evaluate(self.t, p, np.zeros(self.core.nv))

    # ---- positions ----

    def positions(self, p: np.ndarray, held: Sequence[Target], wished: Sequence[Target],
                  staying: Sequence[Target] = (), drawn: Sequence[Target] = ()) -> np.ndarray:
        """Positions (nq,) nearest to p that satisfy all constraints and held targets, and approach wished targets.

        Staying targets are kept at the values that their coordinates have in the drawing with its joints closed, where that is
        possible; their own values are not used. Drawn targets are met throughout, already while the joints close.
        """
        return self._found("assemble_positions", p, held, wished, staying, drawn)

    def is_closed(self, p: np.ndarray, held: Sequence[Target]) -> bool:
        """True if all constraints and all held targets are satisfied."""
        return self._core.run("assembly_check", p, _targets(held)).outcome == core_assembly.ASSEMBLED

    def led_to(self, p: np.ndarray, held: Sequence[Target] = (), staying: Sequence[Target] = ()) -> np.ndarray:
        """Positions (nq,) that satisfy drives and held targets, followed from closed ones, such as those of another time."""
        return self._found("assembly_lead", p, held, (), staying)

    def nearby(self, p: np.ndarray, left_out: Collection[int] = ()) -> np.ndarray:
        """Positions nearest to p that satisfy all constraints except those left out; p, if there are none."""
        return self._core.run("assembly_project", p, left_out=left_out).found

    def least_open(self, p: np.ndarray) -> np.ndarray:
        """Positions with the smallest gaps in the joints."""
        others = [row for row, each in enumerate(self.core.rows[:self.core.mh]) if each.owner != "joint"]
        return self._core.run("assembly_minimize", p, left_out=others).found

    def _found(self, operation: str, p: np.ndarray, held: Sequence[Target], wished: Sequence[Target],
               staying: Sequence[Target], drawn: Sequence[Target] = ()) -> np.ndarray:
        outcome = self._core.run(operation, p, _targets(held, staying, wished, drawn))
        if outcome.outcome == core_assembly.JOINTS_OPEN:
            raise CorrectionFailed("joints")
        if outcome.outcome:
            raise self._unmet(outcome, [*held, *(staying if operation == "assembly_lead" else ())])
        return outcome.found

    def scaled_rows(self, p: np.ndarray) -> np.ndarray:
        """Rows of C in scaled coordinates, each of length one."""
        rows = self._evaluate(p)["C"] * self.scale if self.core.m else np.zeros((0, self.core.nv))
        size = np.linalg.norm(rows, axis=1, keepdims=True)
        return rows / np.where(size > 1e-9 * self.length, size, self.length)

    def free_motions(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mass matrix (nv, nv) and a basis (nv, k) of the velocities that satisfy all constraints, in scaled coordinates."""
        terms = self._evaluate(p)
        rows = terms["C"] * self.scale if self.core.m else np.zeros((0, self.core.nv))
        return terms["M"] * np.outer(self.scale, self.scale), nullspace(rows)

    def _unmet(self, outcome: Outcome, held: Sequence[Target]) -> Exception:
        """Error that names the unsatisfied held values, drives and couplings, with their residuals."""
        residual, units = (each[:len(self.kept) + len(held)] for each in (outcome.residual, outcome.size))
        names = [*(self.rows[row] for row in self.kept), *(target.name for target in held)]
        movable = np.append(~self.is_joint, np.ones(len(held), dtype=bool))
        size = np.where(movable, np.abs(residual), 0.0)
        if not size.max(initial=0.0) > 0:
            return CorrectionFailed("joints")
        worst = [int(i) for i in np.argsort(-size) if size[i] > 1e-3 * size.max()]
        apart = np.abs(residual) * units
        residuals = ", ".join(f"{names[i]!r} by {apart[i]:.3g} {unit_of(names[i])}".rstrip() for i in worst[:4])
        turns = [target for target in held if unit_of(target.name) == "rad" and abs(target.value) > 2 * np.pi]
        hint = f". Angles are in rad: {turns[0].value:g} degrees are {np.radians(turns[0].value):.4g}" if turns else ""
        return InconsistentStart("the values that the start holds and the drives cannot be met together; the nearest positions "
                                 f"miss {residuals}{hint}")

    # ---- velocities ----

    def velocities(self, p: np.ndarray, held: Sequence[Target], wished: Sequence[Target],
                   staying: Sequence[Target] = ()) -> np.ndarray:
        """Minimum-norm velocities that satisfy all constraints and held targets and approach wished ones as nearly as possible.

        Coordinates that stay are at rest.
        """
        outcome = self._core.velocities(p, _targets(held, staying, wished, are_rates=True))
        if outcome.outcome:
            count = self.core.m + len(held)
            raise contradiction(outcome.residual[:count], outcome.size[:count], self._asked(held), self.rows)
        return outcome.found

    def undetermined(self, p: np.ndarray, v: np.ndarray, given: Sequence[Target],
                     staying: Sequence[Target] = ()) -> np.ndarray:
        """Basis (nv, k) of velocities that constraints and given targets leave undetermined, and staying ones if v meets them."""
        rows = [self._evaluate(p)["C"] * self.scale] if self.core.m else []
        rows += [self._rows_of(p, each) for each in (given, staying if self.meets(p, v, staying) else ())]
        return nullspace(np.vstack(rows)) * self.scale[:, None]

    def with_rates_of(self, p: np.ndarray, v: np.ndarray, targets: Sequence[Target]) -> list[Target]:
        """Targets with the values that they have at velocities v (nv,); those of rounding are zero."""
        least = RANK * np.abs(v / self.scale).max(initial=0.0)
        values = (float(self.core.measure_at(each.measure, self.t, p, v)["value"][each.component]) for each in targets)
        return [each._replace(value=value if abs(value) > least else 0.0) for each, value in zip(targets, values, strict=True)]

    def meets(self, p: np.ndarray, v: np.ndarray, targets: Sequence[Target]) -> bool:
        """True if velocities v (nv,) have the values of the targets."""
        least = RANK * np.abs(v / self.scale).max(initial=0.0)
        pairs = zip(self.with_rates_of(p, v, targets), targets, strict=True)
        return all(abs(one.value - other.value) <= least for one, other in pairs)

    def changed(self, v: np.ndarray, change: np.ndarray) -> np.ndarray:
        """Velocities (nv,) and their change, or v itself where that is of rounding."""
        largest, moved = (np.abs(each / self.scale).max() for each in (v, change))
        return v + change if moved > MIN_RATE * largest else v

    def nearest(self, p: np.ndarray, v: np.ndarray, free: np.ndarray, other: np.ndarray) -> np.ndarray:
        """Velocities (nv,) of least kinetic energy relative to others, by changes of v in the basis `free` (nv, k)."""
        masses = np.diag(self._evaluate(p)["M"]) * self.scale**2
        roots = np.sqrt(np.maximum(masses, MIN_MASS * (masses.max() or 1.0))) / self.scale
        return self.changed(v, free @ np.linalg.lstsq(roots[:, None] * free, roots * (other - v), rcond=None)[0])

    def _rows_of(self, p: np.ndarray, targets: Sequence[Target]) -> np.ndarray:
        """Rows (k, nv) of targets, by scaled coordinates."""
        rest = np.zeros(self.core.nv)
        rows = [self.core.measure_at(each.measure, self.t, p, rest)["row"][each.component] for each in targets]
        return np.array(rows).reshape(-1, self.core.nv) * self.scale

    def _asked(self, held: Sequence[Target]) -> list[str]:
        """Names of the drives, couplings and targets that prescribe velocities, one per constraint; "" for those of joints."""
        owners = ["" if self.core.rows[i].owner == "joint" else self.rows[i] for i in range(self.core.m)]
        return [*owners, *(target.name for target in held)]


def _targets(held: Sequence[Target], staying: Sequence[Target] = (), wished: Sequence[Target] = (),
             drawn: Sequence[Target] = (), *, are_rates: bool = False) -> list[CoreTarget]:
    roles = ((held, core_assembly.HELD), (staying, core_assembly.STAYS), (wished, core_assembly.WISHED),
             (drawn, core_assembly.DRAWN))
    return [CoreTarget(each.measure, each.component, are_rates, each.value, role) for targets, role in roles for each in targets]


def nullspace(rows: np.ndarray) -> np.ndarray:
    """Orthonormal basis (n, k) of the null space of the rows."""
    if not len(rows):
        return np.eye(rows.shape[1])
    _, s, vt = np.linalg.svd(rows)
    rank = int((s > RANK * s.max(initial=0.0)).sum())
    return vt[rank:].T
