"""Assembly of many bodies at a cost proportional to their number, without dense matrices.

Steps onto the constraints have minimum norm in rad and parts of the mechanism's length. In the mass metric a long chain would
bend strongly in few links, since all bodies beyond these must move, and Newton's method would converge slowly.
Only the distance to the drawing is measured in the mass metric.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Collection, Sequence
from typing import Any

import numpy as np

from ..._gateway.mechanisms.assembly import Outcome
from ..._gateway.mechanisms.plane import MechanismCore
from ..._gateway.sparse_state import nearest_velocities
from ...errors import CorrectionFailed, InconsistentStart
from .contradictions import contradiction
from .dense import NUDGE, Assembly, Target
from .least_squares import Attempt, Damping, levenberg_marquardt
from .sparse_constraints import SparseRows, are_met, read_targets, sparse_rows

CLOSED = 1e-12          # of a constraint, relative to its size: largest residual of a closed joint
SMALLEST = 1e-3         # of the largest constraint, and of the length: lower bound of a constraint's size
NEARER = 50             # steps towards the drawing, at most
TRACKED = 0.1           # step of a target, at most, in rad or parts of the mechanism's length
LONGEST = 0.4           # step of any coordinate, at most, in the same units
MET = 1e-9              # of the largest prescribed or computed velocity: tolerance of prescribed velocities
MOST_DENSE = 1000       # constraints or velocities: larger matrices are not dense where all bodies are free and have mass
HALVINGS = 6            # of a Newton step that does not reduce the residual, at most
SMALLEST_PART = 1e-3    # of the way of drives and targets: smallest step of the continuation
MOST_TIMES = 20.0       # factor by which a step towards the drawing is lengthened or shortened, at most
WISHED = 1e-6           # weight of a wish relative to the norm of a step
APPROACHING = Damping(refused=10, accepted=10, minimum=WISHED**2, solved=0.0, least_gain=1e-6, least_absolute_gain=CLOSED**2)


def assembly_of(core: MechanismCore, rows: Sequence[str], left_out: Sequence[int], length: float, t: float,
                couplings: Collection[int] = ()) -> Assembly:
    """Assembly object for a mechanism, dense or sparse by the number of bodies."""
    return (AssemblyOfMany if is_of_many(core) else Assembly)(core, rows, left_out, length, t, couplings)


def is_of_many(core: MechanismCore) -> bool:
    """True if matrices are too large to be dense."""
    has_diagonal_mass = core.packing is not None and core.stored("M") == (core.nv,)
    return has_diagonal_mass and max(core.nv, core.m) > MOST_DENSE


class AssemblyOfMany(Assembly):
    """Assembly of a mechanism of many bodies, all of them free and with mass; see `Assembly`."""

    def __init__(self, core: MechanismCore, rows: Sequence[str], left_out: Sequence[int], length: float,
                 t: float, couplings: Collection[int] = ()) -> None:
        super().__init__(core, rows, left_out, length, t, couplings)
        self.of_drawing = self.is_joint | np.isin(self.kept, list(couplings))
        self._size: dict[int, np.ndarray] = {}
        mass = self.core.evaluate_stored(t, core.origin, np.zeros(core.nv))["M"] * self.scale**2
        self.weight = np.sqrt(mass)

    def _moved(self, p: np.ndarray, step: np.ndarray) -> np.ndarray:
        """Positions after a step in scaled coordinates."""
        return self.core.moved(p, step * self.scale)

    def _apart(self, p: np.ndarray, other: np.ndarray) -> np.ndarray:
        """Step in scaled coordinates from `other` to p."""
        return self.core.apart(p, other) / self.scale

    # ---- positions ----

    def positions(self, p: np.ndarray, held: Sequence[Target], wished: Sequence[Target],
                  staying: Sequence[Target] = ()) -> np.ndarray:
        """Positions (nq,) nearest to p that satisfy all constraints and held targets, and approach wished targets.

        Staying targets are kept at the values that their coordinates have in the drawing with its joints closed, where that is
        possible; their own values are not used.
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

    def led_to(self, p: np.ndarray, held: Sequence[Target] = (), staying: Sequence[Target] = ()) -> np.ndarray:
        """Positions (nq,) that satisfy drives and held targets, followed from closed ones, such as those of another time."""
        return self._track(p, [*held, *self._as_they_are(p, staying)])

    def is_closed(self, p: np.ndarray, held: Sequence[Target]) -> bool:
        allowed = CLOSED * SMALLEST * self.length
        if self._rows_are_met(p) and are_met(self.core, p, held, allowed):
            return True
        return bool(np.abs(self._residual(p, held)[0]).max(initial=0.0) <= CLOSED)

    def _residual(self, p: np.ndarray, targets: Sequence[Target]) -> tuple[np.ndarray, SparseRows]:
        stored = self.core.evaluate_stored(self.t, p, np.zeros(self.core.nv))
        rows, off = sparse_rows(self.core, stored, p, targets)
        is_kept = np.ones(self.core.m + len(targets), dtype=bool)
        is_kept[: self.core.m] = np.isin(np.arange(self.core.m), self.kept)
        rows = rows[is_kept] * self.scale
        size = self._sizes(rows.lengths(), targets)
        return np.concatenate([stored["Phi"][self.kept] if self.core.mh else [], off]) / size, rows / size

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

    def _rows_are_met(self, p: np.ndarray) -> bool:
        """True if all constraints are satisfied to the tightest tolerance, whatever their sizes."""
        stored = self.core.evaluate_stored(self.t, p, np.zeros(self.core.nv))
        Phi = stored["Phi"][self.kept] if self.core.mh else np.zeros(0)
        return bool(np.abs(Phi).max(initial=0.0) <= CLOSED * SMALLEST * self.length)

    def _aside(self, p: np.ndarray) -> np.ndarray:
        """Positions perturbed slightly: at a dead centre, or in a straight chain, no step leads away from it."""
        step = NUDGE * np.random.default_rng(0).standard_normal(self.core.nv)
        closed = self._newton(self._moved(p, step), self._joints)
        return p if closed is None else closed

    def _shifted(self, p: np.ndarray, held: Sequence[Target], shift: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        residual, rows = self._residual(p, held)
        return residual - shift, rows

    def _least_step(self, rows: SparseRows, right: np.ndarray) -> np.ndarray:
        return (rows * (1 / self.weight)).least(right) / self.weight

    def _newton(self, p: np.ndarray, system: Callable) -> np.ndarray | None:
        """Minimum-norm Newton steps in rad and parts of the length, halved until they reduce the residual; None on failure."""
        residual, rows = system(p)
        best = np.abs(residual).max(initial=0.0)
        for _ in range(40):
            if best < 1e-15:
                break
            tried = self._gaining(p, _at_most(LONGEST, -rows.least(residual)), system, best)
            if tried is None:
                break
            p, residual, rows, best = tried
        return p if best <= CLOSED else None

    def _gaining(self, p: np.ndarray, step: np.ndarray, system: Callable,
                 best: float) -> tuple[np.ndarray, np.ndarray, SparseRows, float] | None:
        """Positions and residual after a step, or after its longest half that reduces the residual; None if none does."""
        for _ in range(1 + HALVINGS):
            tried = self._moved(p, step)
            residual, rows = system(tried)
            error = np.abs(residual).max(initial=0.0)
            if error < best:
                return tried, residual, rows, error
            if best <= CLOSED:      # the residual is rounding
                return None
            step = step / 2
        return None

    def _track(self, p: np.ndarray, held: Sequence[Target]) -> np.ndarray:
        """Leads drives, couplings and held targets from where they are to where they shall be, in parts as long as can be.

        On failure, the residuals are minimized.
        """
        start = self._residual(p, held)[0]
        start[: len(self.kept)][self.is_joint] = 0.0
        done, part = 0.0, min(1.0, TRACKED / max(np.abs(start).max(initial=0.0), TRACKED))
        while done < 1.0 and part >= SMALLEST_PART:
            reached = min(1.0, done + part)
            moved = self._newton(p, lambda p, left=1.0 - reached: self._shifted(p, held, left * start))
            if moved is None:
                part /= 4
            else:
                p, done, part = moved, reached, 2 * part
        if done >= 1.0:
            return p
        for begin in (p, self._aside(p)):
            closest, residual = self._least_squares(begin, lambda p: self._residual(p, held))
            if np.abs(residual).max(initial=0.0) <= 1e3 * CLOSED:
                return closest
        raise self._unmet(Outcome(1, p, self._left_over(p, held, residual), self._size[len(held)]), held)

    def _left_over(self, p: np.ndarray, held: Sequence[Target], residual: np.ndarray) -> np.ndarray:
        """Residuals at the positions nearest to drives, couplings and held values that closed joints allow."""
        is_soft = np.append(~self.is_joint, np.ones(len(held), dtype=bool))
        return self._residual(self._nearest_to_soft(self._aside(p), lambda p: self._residual(p, held), is_soft), held)[0]

    def _approach(self, p: np.ndarray, held: Sequence[Target], wished: Sequence[Target]) -> np.ndarray:
        is_wish = np.repeat([False, True], [len(self.kept) + len(held), len(wished)])
        return self._nearest_to_soft(p, lambda p: self._residual(p, [*held, *wished]), is_wish)

    def _nearest(self, drawn: np.ndarray, p: np.ndarray, system: Callable) -> np.ndarray:
        """Positions that satisfy `system`, nearest to the drawing, by steps with lengths of Barzilai and Borwein."""
        distance, last, times = self._distance(p, drawn), None, 1.0
        for _ in range(NEARER):
            residual, rows = system(p)
            way = self._apart(drawn, p)
            step = way - self._least_step(rows, rows @ way + residual)
            longest = self._times(step, last, times)
            for times in (longest, longest / 4, longest / 16, longest / 64):
                tried = self._newton(self._moved(p, _at_most(TRACKED, times * step)), system)
                if tried is not None and (nearer := self._distance(tried, drawn)) < distance * (1 - 1e-6):
                    break
            else:
                break
            p, distance, last = tried, nearer, step
        return p

    def _distance(self, p: np.ndarray, other: np.ndarray) -> float:
        return float(np.linalg.norm(self._apart(p, other) * self.weight))

    def _times(self, step: np.ndarray, last: np.ndarray | None, times: float) -> float:
        """Factor by which a step is lengthened or shortened, from the last step and its factor `times`."""
        if last is None:
            return 1.0
        before, less = last * self.weight, (last - step) * self.weight
        return float(np.clip(times * (before @ before) / max(before @ less, 1e-300), 1 / MOST_TIMES, MOST_TIMES))

    def _nearest_to_soft(self, p: np.ndarray, system: Callable, is_soft: np.ndarray) -> np.ndarray:
        """Positions with the least squares of the soft rows' residuals that the others allow, which are met where it begins.

        Damped steps are taken among those that the others allow, and led back onto them.
        """
        def others(p: np.ndarray) -> tuple[np.ndarray, SparseRows]:
            residual, rows = system(p)
            return residual[~is_soft], rows[~is_soft]

        def attempt(p: np.ndarray | None) -> Attempt | None:
            if p is None:
                return None
            residual, rows = system(p)
            return Attempt(p, residual, rows, float(residual[is_soft] @ residual[is_soft]))

        def damped(at: Attempt) -> Callable[[float], Attempt | None]:
            def tried(damping: float) -> Attempt | None:
                step = _at_most(TRACKED, -at.rows.damped(at.residual, is_soft, damping))
                return attempt(self._newton(self._moved(at.p, step), others))
            return tried

        start = attempt(p)
        return p if start is None else levenberg_marquardt(start, damped, APPROACHING).p

    def _least_squares(self, p: np.ndarray, system: Callable) -> tuple[np.ndarray, np.ndarray]:
        """Newton's method; on failure, damped steps that minimize the residuals of all rows."""
        found = self._newton(p, system)
        if found is None:
            p = self._nearest_to_soft(p, system, np.ones(len(system(p)[0]), dtype=bool))
            found = self._newton(p, system)
        p = p if found is None else found
        return p, system(p)[0]

    # ---- velocities ----

    def _may_rest(self, p: np.ndarray) -> bool:
        """True if no constraint depends on time, so that zero velocities satisfy all of them."""
        Phi_t = self.core.evaluate_stored(self.t, p, np.zeros(self.core.nv)).get("Phi_t")
        return Phi_t is None or not Phi_t.any()

    def _as_they_are(self, p: np.ndarray, staying: Sequence[Target]) -> list[Target]:
        values = read_targets(self.core, p, staying)[1] if staying else ()
        return [each._replace(value=each.value + float(value)) for each, value in zip(staying, values, strict=True)]

    def velocities(self, p: np.ndarray, held: Sequence[Target], wished: Sequence[Target],
                   staying: Sequence[Target] = ()) -> np.ndarray:
        if staying and (held or wished or not self._may_rest(p)):
            with contextlib.suppress(InconsistentStart):
                return self.velocities(p, [*held, *staying], wished)
        if not held and not wished:
            return nearest_velocities(self.core, self.t, p, np.zeros(self.core.nv))
        stored = self.core.evaluate_stored(self.t, p, np.zeros(self.core.nv))
        rows, off = sparse_rows(self.core, stored, p, [*held, *wished])
        rows, right = rows * (self.scale / self.weight), np.concatenate([-stored.get("Phi_t", np.zeros(self.core.m)), -off])
        is_wish = np.arange(len(right)) >= self.core.m + len(held)
        asked, asked_right = rows[~is_wish], right[~is_wish]
        x = asked.least(asked_right)
        size = asked.lengths()
        size[size == 0.0] = 1.0
        left = (asked @ x - asked_right) / size
        if np.abs(left).max() > MET * max(np.abs(asked_right / size).max(), np.abs(x).max()):
            raise contradiction(left, size, self._asked(held), self.rows)
        return (x + _towards(rows, right - rows @ x, is_wish)) / self.weight * self.scale


def _towards(rows: SparseRows, right: np.ndarray, is_wish: np.ndarray) -> np.ndarray:
    """Smallest change that leaves all other rows unchanged and brings wishes as near to their right sides as that allows.

    It is computed twice, as damping leaves a share of each wish after the first.
    """
    x = np.zeros(sum(rows.sizes))
    size = np.abs(right[is_wish]).max(initial=0.0)
    if not size:
        return x
    lengths = np.where(is_wish, rows.lengths()[is_wish].max(), 1.0)
    rows, right = rows / lengths, np.where(is_wish, right / lengths, 0.0)
    for _ in range(2):
        left = np.where(is_wish, right - rows @ x, 0.0)
        x = x + rows.damped(left, is_wish, WISHED**2)
    return x


def _at_most(longest: float, step: np.ndarray) -> np.ndarray:
    """Step, shortened so that no coordinate moves farther than `longest`."""
    return step * min(1.0, longest / max(np.abs(step).max(initial=0.0), 1e-300))
