"""Assembly of mechanisms in absolute coordinates by the core: positions that close all joints, and velocities that they allow."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...core import ffi, lib
from ..base import MESSAGE_SIZE, doubles, error_of, text
from ..systems import CoreSystem

ROLES = {"joint": lib.ZD_ROLE_JOINT, "coupling": lib.ZD_ROLE_COUPLING, "drive": lib.ZD_ROLE_DRIVE,
         "ignored": lib.ZD_ROLE_IGNORED}
HELD, STAYS, WISHED, DRAWN = (getattr(lib, f"ZD_TARGET_{role}") for role in ("HELD", "STAYS", "WISHED", "DRAWN"))
ASSEMBLED, JOINTS_OPEN, TARGETS_UNMET = lib.ZD_ASSEMBLED, lib.ZD_JOINTS_OPEN, lib.ZD_TARGETS_UNMET


class CoreTarget(NamedTuple):
    """A `zd_target`: component of a measure, and the value that the start prescribes."""

    measure: int
    component: int
    is_rate: bool
    value: float
    role: int


class Outcome(NamedTuple):
    """Result of an assembly: ASSEMBLED, JOINTS_OPEN or TARGETS_UNMET; positions or velocities found; residuals of the conditions
    that are not met, divided by their sizes, and these sizes.
    """

    outcome: int
    found: np.ndarray
    residual: np.ndarray
    size: np.ndarray


class CoreAssembly:
    """Assembly of a system at one time.

    Parameters
    ----------
    core : MechanismCore
        In absolute coordinates.
    roles : sequence of str
        Role of each holonomic constraint, a key of ROLES.
    length : float
        Characteristic length in m.
    is_of_many : bool
        True for sparse matrices, at a cost proportional to the bodies, all of which must be free and have mass.
    """

    def __init__(self, core: Any, roles: Sequence[str], length: float, t: float, *, is_of_many: bool = False) -> None:
        self.core, self.length, self.t, self.error = core, length, t, None
        self._many = core.many_bodies() if is_of_many else ffi.NULL
        self._roles = ffi.new("int[]", [ROLES[role] for role in roles])
        self._nudge = np.random.default_rng(0).standard_normal(core.nv)

    def run(self, operation: str, p: np.ndarray, targets: Sequence[CoreTarget] = (), *,
            left_out: Collection[int] = ()) -> Outcome:
        """Outcome of a function of the core that changes positions, ``zd_<operation>``, from p (nq,) on.

        Constraints in `left_out` are ignored, too.
        """
        found = np.array(p, dtype=float)
        return self._called(operation, targets, left_out, found, doubles(found, self.core.nq, writable=True))

    def velocities(self, p: np.ndarray, targets: Sequence[CoreTarget]) -> Outcome:
        """Velocities (nv,) at p."""
        v, p = np.zeros(self.core.nv), np.ascontiguousarray(p, dtype=float)
        return self._called("assemble_velocities", targets, (), v, doubles(p, self.core.nq), doubles(v, v.size, writable=True))

    def beyond_reach(self, p: np.ndarray, measures: Sequence[int], ahead: float) -> str:
        """Sentence on drives that come to a dead point within a time ahead in s; "" if none does.

        `measures` are those of the coordinates that the holonomic constraints drive; -1: none.
        """
        message, p = ffi.new("char[]", MESSAGE_SIZE), np.ascontiguousarray(p, dtype=float)
        self._called("assembly_explain_reach", (), (), p, doubles(p, self.core.nq), ffi.new("int[]", measures), ahead, message,
                     MESSAGE_SIZE)
        return text(message)

    def _called(self, operation: str, targets: Sequence[CoreTarget], left_out: Collection[int], found: np.ndarray,
                *arrays: Any) -> Outcome:
        core, roles = self.core.for_run(), self._roles
        if left_out:
            roles = ffi.new("int[]", [ROLES["ignored"] if i in left_out else role for i, role in enumerate(self._roles)])
        residual, size = np.zeros((2, core.m + len(targets)))
        handle, self.error = ffi.new_handle(self), None
        target, inputs = ffi.new("zd_target[]", list(targets)), core.initial_inputs()
        given = ffi.new("zd_assembly_problem *", {
            "system": core.c, "inputs": inputs, "t": self.t, "length": self.length, "role": roles,
            "targets": len(targets), "target": target, "nudge": doubles(self._nudge, core.nv), "many": self._many,
            "interrupted": lib.zd_interrupted_in_python, "owner": handle,
            "residual": doubles(residual, residual.size, writable=True), "size": doubles(size, size.size, writable=True)})
        outcome = getattr(lib, f"zd_{operation}")(given, *arrays)
        if outcome < 0 or self.error:
            raise self.error or core.error or error_of(outcome, "the system's evaluation failed")
        return Outcome(outcome, found, residual, size)


def displaced(core: CoreSystem, p: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Positions (nq,) after a displacement (nv,): places move, and bodies turn about an axis of their own."""
    to, p, step = np.empty(core.nq), np.ascontiguousarray(p, dtype=float), np.ascontiguousarray(step, dtype=float)
    lib.zd_displace(core.c, doubles(p, core.nq), doubles(step, core.nv), doubles(to, core.nq, writable=True))
    return to


def displacement(core: CoreSystem, p: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Displacement (nv,) from other positions to p, by the shorter rotation of each body."""
    step, p, other = np.empty(core.nv), np.ascontiguousarray(p, dtype=float), np.ascontiguousarray(other, dtype=float)
    lib.zd_displacement(core.c, doubles(p, core.nq), doubles(other, core.nq), doubles(step, core.nv, writable=True))
    return step
