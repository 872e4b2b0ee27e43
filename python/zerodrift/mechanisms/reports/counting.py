"""Degrees of freedom: velocities, constraints and their rank; redundant constraints and undetermined reactions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..._private.gateway import Variable
from ..._private.gateway.operations import nearest_velocities, redundant_rows
from ...errors import InconsistentStart
from ..assembly import space_advice
from ..assembly.assembly import Assembly, is_of_many
from ..assembly.drawing_changes import DrawingChanges
from ..assembly.nudge import nudged
from ..assembly.start import Starting
from ..elements.drawing import Drawing
from ..elements.forces import Actuator, Motor
from ..elements.numbers import AS_GIVEN
from ..equations.measure_names import constraint_names
from ..equations.space_tables import SpaceTables, tables_of
from .unsaid_rates import moving_unsaid

DEPENDENT = 1e-9        # of a constraint's own size: residual norm of a redundant one


class Count(NamedTuple):
    """Constraints of absolute coordinates at the assembled start.

    Attributes
    ----------
    velocities, rows, rank : int
        Numbers of velocities, constraints and independent constraints.
    redundant : tuple of str
        Names of constraints that are redundant at the start and in a nearby pose.
    undetermined : tuple of str
        Names of constraints whose reactions are undetermined by this redundancy.
    singular : tuple of str
        Names of constraints that are redundant at the start alone.
    is_of_many : bool
        True for so many constraints that the core has found the redundant ones and undetermined reactions are not sought.
    notes : tuple of str
        Sentences on the pose: joints that are drawn open, bodies that start elsewhere than drawn, universal joints
        at a right angle, the cause of a singularity, and a remedy.
    """

    velocities: int
    rows: int
    rank: int
    redundant: tuple[str, ...]
    undetermined: tuple[str, ...]
    singular: tuple[str, ...]
    is_of_many: bool = False
    notes: tuple[str, ...] = ()

    @property
    def freedom(self) -> int:
        """Degrees of freedom: velocities minus independent constraints; drives count as constraints."""
        return self.velocities - self.rank

    @property
    def gruebler(self) -> int:
        """Degrees of freedom by Gruebler's formula: velocities minus constraints."""
        return self.velocities - self.rows


def count(drawing: Drawing) -> Count:
    """Count for a mechanism at its assembled start."""
    start = Starting(drawing, AS_GIVEN)
    tables = tables_of(drawing, AS_GIVEN, in_tree=False, starts=start.drives)
    assembly, p = start.assembled(0.0)
    if is_of_many(assembly.core):
        return _count_of_many(tables, assembly, p)
    rows = assembly.scaled_rows(p)
    names = [variable.name for variable in constraint_names(tables, assembly.core)]
    here = dependent(rows)
    there = dependent(assembly.scaled_rows(nudged(assembly, p, _driven(drawing, assembly)))) if here else set()
    redundant = here & there
    left = _left_null(rows) if redundant else np.zeros((len(rows), 0))
    undetermined = np.flatnonzero(np.abs(left).max(axis=1, initial=0.0) > 1e-6)
    singular = _named(names, here - there)
    return Count(assembly.core.nv, len(rows), len(rows) - len(redundant), _named(names, redundant), _named(names, undetermined),
                 singular, notes=_notes(start, tables, assembly, p, singular))


def _notes(start: Starting, tables: Any, assembly: Assembly, p: np.ndarray, singular: tuple[str, ...]) -> tuple[str, ...]:
    """Sentences on the pose; one on a singular pose comes first."""
    in_space = isinstance(tables, SpaceTables)
    notes = [*DrawingChanges(tables, assembly, p).sentences(),
             *(space_advice.at_right_angles(tables, assembly.core, p) if in_space else ()), *_unsaid(start, tables, assembly, p)]
    if singular:
        why = space_advice.flat_crosses(tables, assembly.core, p) if in_space else []
        reasons = f", as {' and '.join(why)}" if why else ""
        named = f"{', '.join(singular)} {'is' if len(singular) == 1 else 'are'} redundant"
        return f"a singular pose: {named} as drawn, and not nearby{reasons}; {start.way_out()}", *notes
    return tuple(notes)


def _unsaid(start: Starting, tables: Any, assembly: Assembly, p: np.ndarray) -> list[str]:
    """Sentences on undetermined start velocities; none if start velocities contradict each other."""
    try:
        return moving_unsaid(start, tables, assembly, p)
    except InconsistentStart:
        return []


def _count_of_many(tables: Any, assembly: Assembly, p: np.ndarray) -> Count:
    """Count by the core, at a cost proportional to the bodies; a singular pose raises the core's error."""
    core = assembly.core
    named = _Named(constraint_names(tables, core))
    core.names_of_constraints(named)
    v = nearest_velocities(core, assembly.t, p, np.zeros(core.nv))
    redundant = redundant_rows(core, assembly.t, p, v)
    names = [variable.name for variable in named.constraints]
    return Count(core.nv, core.m, core.m - len(redundant), _named(names, set(redundant)), (), (), is_of_many=True,
                 notes=tuple(DrawingChanges(tables, assembly, p).sentences()))


@dataclass(frozen=True)
class _Named:
    """Names of constraints, for the core's errors."""

    constraints: tuple[Variable, ...]


def _driven(drawing: Drawing, assembly: Assembly) -> set[int]:
    """Indices of the constraints of drives."""
    motors = {motor.name for motor in drawing.of((Motor, Actuator))}
    return {i for i, (row, name) in enumerate(zip(assembly.core.rows, assembly.rows, strict=True))
            if row.owner == "relation" and name in motors}


def dependent(rows: np.ndarray) -> set[int]:
    """Rows that depend on those before them: their residual norms, after two orthogonalizations, are rounding."""
    basis, found = np.zeros((0, rows.shape[1])), set()
    for i, row in enumerate(rows):
        left = row - basis.T @ (basis @ row)
        left -= basis.T @ (basis @ left)
        size = np.linalg.norm(left)
        if size <= DEPENDENT * np.linalg.norm(row):
            found.add(i)
        else:
            basis = np.vstack([basis, left / size])
    return found


def _left_null(rows: np.ndarray) -> np.ndarray:
    """Basis (k, n) of the left null space of the rows."""
    u, s, _ = np.linalg.svd(rows)
    return u[:, int((s > 1e-9 * s.max(initial=0.0)).sum()):]


def _named(names: list[str], rows: set[int] | np.ndarray) -> tuple[str, ...]:
    return tuple(names[i] for i in sorted(rows))
