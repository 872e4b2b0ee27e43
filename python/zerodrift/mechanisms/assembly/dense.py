"""Assembly: from a sketch to positions in which all joints are closed, and velocities that they allow.

The unknowns are absolute coordinates, of the mass centres, so that the start is the same whatever coordinates a simulation takes.
Steps are least in the mass metric.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Collection, Sequence
from typing import Any

import numpy as np

from ..._gateway.mechanisms.plane import MechanismCore
from ...errors import CorrectionFailed, InconsistentStart
from .contradictions import contradiction, unit_of
from .least_squares import ATTEMPTS, Attempt, Damping, least_along, levenberg_marquardt, nullspace, shortest, units
from .sparse_constraints import Target

CLOSED = 1e-12          # of a constraint, relative to its size: largest residual of a closed joint
SMALLEST = 1e-3         # of the largest constraint, and of the length: lower bound of a constraint's size
CLOSING = Damping(refused=4, accepted=5, minimum=1e-12, solved=1e-12, least_gain=1e-14, least_absolute_gain=0.0)
NEARER = 50             # steps towards the drawing, at most
TRACKED = 0.1           # step of a target, at most, in rad or parts of the mechanism's length
LONGEST = 0.4           # step of any coordinate, at most, in the same units
NUDGE = 1e-3            # step from a singular pose to nearby ones, in the same units
LEAST_MASS = 1e-6       # of the largest mass, in the metric: mass of massless directions
MET = 1e-9              # of the largest prescribed or computed velocity: tolerance of prescribed velocities


class Assembly:
    """The assembly of one mechanism at one time.

    Parameters
    ----------
    core : MechanismCore
        In absolute coordinates.
    rows : sequence of str
        What each row of C belongs to, for errors.
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
        self.of_drawing = np.array([core.rows[row].owner == "joint" or row in couplings for row in self.kept], dtype=bool)
        self.is_joint = np.array([core.rows[row].owner == "joint" for row in self.kept], dtype=bool)
        angles = np.array([coordinate.kind == "angle" for coordinate in core.motions])
        self.scale = np.where(angles, 1.0, length)      # of coordinates: steps are in rad and parts of the length
        self._size: dict[int, np.ndarray] = {}
        self._weigh()

    def _weigh(self) -> None:
        """Set the square root of the mass metric in scaled coordinates; massless directions get `LEAST_MASS` of the largest."""
        M = self.core.evaluate_stored(self.t, self.core.origin, np.zeros(self.core.nv))["M"]
        mass = (np.diag(M) if self.core.packing is None else M) * self.scale**2     # a diagonal if all bodies are free
        largest = mass.max(initial=0.0) or 1.0
        self.weight = np.sqrt(np.maximum(mass, LEAST_MASS * largest))

    def _moved(self, p: np.ndarray, step: np.ndarray) -> np.ndarray:
        """Positions after a step in scaled coordinates."""
        return self.core.moved(p, step * self.scale)

    def _apart(self, p: np.ndarray, other: np.ndarray) -> np.ndarray:
        """Step in scaled coordinates from `other` to p."""
        return self.core.apart(p, other) / self.scale

    def _evaluate(self, p: np.ndarray) -> dict[str, np.ndarray]:
        """All terms at rest, if there are constraints."""
        return self.core.evaluate(self.t, p, np.zeros(self.core.nv))

    # ---- positions ----

    def positions(self, p: np.ndarray, held: Sequence[Target], wished: Sequence[Target],
                  staying: Sequence[Target] = ()) -> np.ndarray:
        """Nearest positions that satisfy all constraints and held targets, and approach wished ones as nearly as possible.

        Coordinates that stay are as in the drawing with its joints closed, whatever the values of these targets.
        """
        kept: list[Target] = []
        if not self.is_closed(p, held):
            p, kept = self._met(p, held, staying)
        elif wished:
            kept = self._as_they_are(p, staying)
        return self._approach(p, [*held, *kept], wished) if wished else p

    def _met(self, drawn: np.ndarray, held: Sequence[Target],
             staying: Sequence[Target]) -> tuple[np.ndarray, list[Target]]:
        """Positions that satisfy constraints and held targets: joints are closed first, then drives and targets approached."""
        closed = self._close(drawn)
        as_drawn = self._newton(closed, self._drawing) if staying else None
        if as_drawn is not None:
            as_drawn = self._nearest(drawn, as_drawn, self._drawing)
            kept = self._as_they_are(as_drawn, staying)
            with contextlib.suppress(InconsistentStart, CorrectionFailed):
                p = self._track(as_drawn, [*held, *kept])
                return self._nearest(as_drawn, p, lambda p: self._residual(p, [*held, *kept])), kept
        return self._nearest(drawn, self._track(closed, held), lambda p: self._residual(p, held)), []

    def _as_they_are(self, p: np.ndarray, staying: Sequence[Target]) -> list[Target]:
        """The targets with their values at p."""
        values = [self.core.measure_at(each.measure, self.t, p, np.zeros(self.core.nv))["value"] for each in staying]
        return [each._replace(value=float(value[each.component])) for each, value in zip(staying, values, strict=True)]

    def is_closed(self, p: np.ndarray, held: Sequence[Target]) -> bool:
        """True if all constraints and all held targets are satisfied."""
        if not held and self._rows_are_met(p):
            return True     # for any sizes of the constraints, whose computation needs the Jacobian
        residual, _ = self._residual(p, held)
        return bool(np.abs(residual).max(initial=0.0) <= CLOSED)

    def _rows_are_met(self, p: np.ndarray) -> bool:
        """True if all constraints are satisfied to the tightest tolerance, whatever their sizes."""
        stored = self.core.evaluate_stored(self.t, p, np.zeros(self.core.nv))
        Phi = stored["Phi"][self.kept] if self.core.mh else np.zeros(0)
        return bool(np.abs(Phi).max(initial=0.0) <= CLOSED * SMALLEST * self.length)

    def led_to(self, p: np.ndarray, held: Sequence[Target] = (), staying: Sequence[Target] = ()) -> np.ndarray:
        """Positions that satisfy drives and held targets, from closed ones, such as those of another time."""
        return self._track(p, [*held, *self._as_they_are(p, staying)])

    def _residual(self, p: np.ndarray, targets: Sequence[Target]) -> tuple[np.ndarray, Any]:
        """Residuals of all constraints and targets, divided by their sizes, and the Jacobian in scaled coordinates."""
        terms = self._evaluate(p)
        values = terms["Phi"][self.kept] if self.core.mh else np.zeros(0)
        rows = terms["C"][self.kept] if self.core.mh else np.zeros((0, self.core.nv))
        for target in targets:
            found = self.core.measure_at(target.measure, self.t, p, np.zeros(self.core.nv))
            values = np.append(values, found["value"][target.component] - target.value)
            rows = np.vstack([rows, found["jacobian"][target.component]])
        rows = rows * self.scale
        size = self._sizes(np.linalg.norm(rows, axis=1), targets)
        return values / size, rows / size[:, None]

    def _sizes(self, lengths: np.ndarray, targets: Sequence[Target]) -> np.ndarray:
        """Sizes of the constraints, fixed at their first evaluation: units must not change during a minimization."""
        known = self._size.get(len(targets))
        if known is None:
            known = self._size[len(targets)] = np.maximum(lengths, SMALLEST * lengths.max(initial=self.length))
        return known

    def _close(self, p: np.ndarray) -> np.ndarray:
        """Positions with closed joints, by damped least squares from the sketch."""
        p, residual = self._least_squares(p, self._joints)
        if np.abs(residual).max(initial=0.0) > 1e3 * CLOSED:
            raise CorrectionFailed("joints")
        return p

    def _joints(self, p: np.ndarray) -> tuple[np.ndarray, Any]:
        """Residuals of the joints alone, and their Jacobian."""
        residual, rows = self._residual(p, ())
        return residual[self.is_joint], rows[self.is_joint]

    def _drawing(self, p: np.ndarray) -> tuple[np.ndarray, Any]:
        """Residuals of joints and of couplings without user functions, and their Jacobian."""
        residual, rows = self._residual(p, ())
        return residual[self.of_drawing], rows[self.of_drawing]

    def scaled_rows(self, p: np.ndarray) -> np.ndarray:
        """Rows of C in scaled coordinates, each of length one."""
        rows = self._evaluate(p)["C"] * self.scale if self.core.m else np.zeros((0, self.core.nv))
        size = np.linalg.norm(rows, axis=1, keepdims=True)
        return rows / np.where(size > 1e-9 * self.length, size, self.length)

    def nearby(self, p: np.ndarray, left_out: Collection[int] = ()) -> np.ndarray:
        """Positions nearest to p that satisfy all constraints except those left out; p, if there are none."""
        kept = [i for i, row in enumerate(self.kept) if row not in left_out]

        def system(p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            residual, rows = self._residual(p, ())
            return residual[kept], rows[kept]

        found = self._newton(p, system)
        return p if found is None else found

    def least_open(self, p: np.ndarray) -> np.ndarray:
        """Positions with the smallest gaps in the joints."""
        return self._least_squares(p, lambda p: self._residual(p, ()))[0]

    def free_motions(self, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mass matrix (nv, nv) and a basis (nv, k) of the velocities that satisfy all constraints, in scaled coordinates."""
        terms = self._evaluate(p)
        rows = terms["C"] * self.scale if self.core.m else np.zeros((0, self.core.nv))
        return terms["M"] * np.outer(self.scale, self.scale), nullspace(rows)

    def _track(self, p: np.ndarray, held: Sequence[Target]) -> np.ndarray:
        """Positions after drives, couplings and held targets have moved to their values in small steps on one branch."""
        start = self._residual(p, held)[0]
        start[: len(self.kept)][self.is_joint] = 0.0
        way = self._way(p, held)
        parts = min(200, max(1, int(np.ceil(way / TRACKED))))
        for part in range(parts):
            left = 1.0 - (part + 1) / parts
            moved = self._newton(p, lambda p, left=left: self._shifted(p, held, left * start))
            if moved is None:
                break
            p = moved
        else:
            return p
        for begin in (p, self._aside(p)):
            closest, residual = self._least_squares(begin, lambda p: self._residual(p, held))
            if np.abs(residual).max(initial=0.0) <= 1e3 * CLOSED:
                return closest
        raise self._unmet(self._left_over(p, held, residual), held)

    def _aside(self, p: np.ndarray) -> np.ndarray:
        """Positions perturbed slightly: at a dead centre, or in a straight chain, no step leads away from it."""
        step = NUDGE * np.random.default_rng(0).standard_normal(self.core.nv)
        closed = self._newton(self._moved(p, step), self._joints)
        return p if closed is None else closed

    def _left_over(self, p: np.ndarray, held: Sequence[Target], residual: np.ndarray) -> np.ndarray:
        """Residuals where held values are as near as closed joints allow; those of least squares where drives are not met."""
        if not self.is_joint.all() or not held:
            return residual
        return self._residual(self._approach(self._aside(p), (), held), held)[0]

    def _nearest(self, drawn: np.ndarray, p: np.ndarray, system: Callable) -> np.ndarray:
        """Positions nearest to the drawing on the branch of the closed positions p, by the Gauss-Newton method."""
        distance = np.linalg.norm(self._apart(p, drawn) * self.weight)
        for _ in range(NEARER):
            residual, rows = system(p)
            step = self._apart(drawn, p)
            step = step - self._least_step(rows, rows @ step + residual)
            step *= min(1.0, TRACKED / max(np.abs(step).max(initial=0.0), 1e-300))
            tried = self._newton(self._moved(p, step), system)
            if tried is None:
                break
            nearer = np.linalg.norm(self._apart(tried, drawn) * self.weight)
            if not nearer < distance * (1 - 1e-6):
                break
            p, distance = tried, nearer
        return p

    def _shifted(self, p: np.ndarray, held: Sequence[Target], shift: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        residual, rows = self._residual(p, held)
        return residual - shift, rows

    def _way(self, p: np.ndarray, held: Sequence[Target]) -> float:
        """Largest deviation of drives, couplings and targets from their prescribed values, in rad or parts of the length."""
        residual, _ = self._residual(p, held)
        residual[: len(self.kept)][self.is_joint] = 0.0
        return float(np.abs(residual).max(initial=0.0))

    def _newton(self, p: np.ndarray, system: Callable) -> np.ndarray | None:
        """Minimum-norm Newton steps in the mass metric until the residual stops decreasing; None if it stays too large."""
        residual, rows = system(p)
        best = np.abs(residual).max(initial=0.0)
        for _ in range(40):
            if best < 1e-15:
                break
            step = -self._least_step(rows, residual)
            if np.abs(step).max(initial=0.0) > LONGEST:
                step *= LONGEST / np.abs(step).max()
            tried = self._moved(p, step)
            tried_residual, tried_rows = system(tried)
            error = np.abs(tried_residual).max(initial=0.0)
            if not error < best:
                break
            p, residual, rows, best = tried, tried_residual, tried_rows, error
        return p if best <= CLOSED else None

    def _least_step(self, rows: Any, right: np.ndarray) -> np.ndarray:
        """Solution of rows @ step = right of minimum norm in the mass metric, in scaled coordinates."""
        return shortest(rows, self.weight, right)

    def _least_squares(self, p: np.ndarray, system: Callable) -> tuple[np.ndarray, np.ndarray]:
        """Positions and remaining residual of a Levenberg-Marquardt minimization, completed by Newton steps."""
        def attempt(p: np.ndarray) -> Attempt:
            residual, rows = system(p)
            return Attempt(p, residual, rows, float(residual @ residual))

        def damped(at: Attempt) -> Callable[[float], Attempt]:
            u, s, vt = np.linalg.svd(at.rows, full_matrices=False)
            largest, along = s.max(initial=1.0), u.T @ at.residual

            def tried(damping: float) -> Attempt:
                step = -vt.T @ (along * s / (s**2 + damping * largest**2))
                return attempt(self._moved(at.p, step * min(1.0, LONGEST / max(np.abs(step).max(initial=0.0), 1e-300))))
            return tried

        p = levenberg_marquardt(attempt(p), damped, CLOSING).p
        polished = self._newton(p, system)
        p = p if polished is None else polished
        return p, system(p)[0]

    def _approach(self, p: np.ndarray, held: Sequence[Target], wished: Sequence[Target]) -> np.ndarray:
        """Positions that approach the wishes as nearly as the held targets allow."""
        count = len(self.kept) + len(held)
        for _ in range(ATTEMPTS):
            residual, rows = self._residual(p, [*held, *wished])
            free = nullspace(rows[:count])
            step = free @ least_along(rows[count:], free, -residual[count:])
            step *= min(1.0, TRACKED / max(np.abs(step).max(initial=0.0), 1e-300))
            nearer = self._nearer(p, step, held, wished)
            if nearer is None:
                break
            p = nearer
        return p

    def _nearer(self, p: np.ndarray, step: np.ndarray, held: Sequence[Target], wished: Sequence[Target]) -> np.ndarray | None:
        """Positions after the longest step, among successive halves, that reduces the wishes' residual; None if none does."""
        def error(p: np.ndarray) -> float:
            return float(np.linalg.norm(self._residual(p, wished)[0][len(self.kept):]))

        before = error(p)
        for _ in range(20):
            moved = self._newton(self._moved(p, step), lambda p: self._residual(p, held))
            if moved is not None and error(moved) < before * (1 - 1e-9):
                return moved
            step = step / 2
        return None

    def _unmet(self, residual: np.ndarray, held: Sequence[Target]) -> Exception:
        """Error that names the unsatisfied held values, drives and couplings, with their residuals."""
        names = [*(self.rows[row] for row in self.kept), *(target.name for target in held)]
        movable = np.append(~self.is_joint, np.ones(len(held), dtype=bool))
        size = np.where(movable, np.abs(residual), 0.0)
        if not size.max(initial=0.0) > 0:
            return CorrectionFailed("joints")
        worst = [int(i) for i in np.argsort(-size) if size[i] > 1e-3 * size.max()]
        apart = np.abs(residual) * self._size[len(held)]
        residuals = ", ".join(f"{names[i]!r} by {apart[i]:.3g} {unit_of(names[i])}".rstrip() for i in worst[:4])
        turns = [target for target in held if unit_of(target.name) == "rad" and abs(target.value) > 2 * np.pi]
        hint = f". Angles are in rad: {turns[0].value:g} degrees are {np.radians(turns[0].value):.4g}" if turns else ""
        return InconsistentStart(f"what the start holds and what is driven cannot be met together; nearest to it there are left: "
                                 f"{residuals}{hint}")

    # ---- velocities ----

    def velocities(self, p: np.ndarray, held: Sequence[Target], wished: Sequence[Target],
                   staying: Sequence[Target] = ()) -> np.ndarray:
        """Minimum-norm velocities that satisfy all constraints and held targets and approach wished ones as nearly as possible.

        Coordinates that stay are at rest.
        """
        if self._may_rest(p) and not held and not wished:
            return np.zeros(self.core.nv)
        if staying:
            with contextlib.suppress(InconsistentStart):
                return self.velocities(p, [*held, *staying], wished)
        rows, right, names = self._rates(p, held)
        if not right.any() and not wished:
            return np.zeros(self.core.nv)
        size = np.linalg.norm(rows, axis=1)
        size[size < 1e-9 * self.length] = self.length
        rows, right = rows / size[:, None], right / size
        scaled = self._least_step(rows, right)
        left = rows @ scaled - right
        if np.abs(left).max(initial=0.0) > MET * max(np.abs(right).max(initial=0.0), np.abs(scaled).max(initial=0.0)):
            unit = units(rows, self.weight)
            raise contradiction(left * unit, size / unit, names, self.rows)
        if wished:
            wish, wanted, _ = self._rates(p, wished, only=True)
            free = nullspace(rows / self.weight) / self.weight[:, None]
            scaled = scaled + free @ least_along(wish, free, wanted - wish @ scaled)
        return scaled * self.scale

    def _may_rest(self, p: np.ndarray) -> bool:
        """True if no constraint depends on time, so that zero velocities satisfy all of them."""
        Phi_t = self.core.evaluate_stored(self.t, p, np.zeros(self.core.nv)).get("Phi_t")
        return Phi_t is None or not Phi_t.any()

    def _rates(self, p: np.ndarray, held: Sequence[Target], *, only: bool = False) -> tuple[np.ndarray, np.ndarray, list[str]]:
        """Rows (k, nv) in scaled coordinates, right sides and names of all conditions on the velocities."""
        zero, terms = np.zeros(self.core.nv), self._evaluate(p)
        m = 0 if only else self.core.m
        rows = [terms["C"] * self.scale] if m else []
        right = [-terms["Phi_t"] if terms.get("Phi_t") is not None else np.zeros(m)] if m else []
        for target in held:
            found = self.core.measure_at(target.measure, self.t, p, zero)
            rows.append(found["jacobian"][target.component : target.component + 1] * self.scale)
            right.append(np.array([target.value - found["value"][target.component]]))
        stacked = np.vstack(rows) if rows else np.zeros((0, self.core.nv))
        return stacked, np.concatenate([*right, []]), self._asked(held)[self.core.m - m:]

    def _asked(self, held: Sequence[Target]) -> list[str]:
        """Names of the drives, couplings and targets that prescribe velocities, one per constraint; "" for those of joints."""
        owners = ["" if self.core.rows[i].owner == "joint" else self.rows[i] for i in range(self.core.m)]
        return [*owners, *(target.name for target in held)]
