"""The core's system of a mechanism, in the plane or in space, made from tables of numbers."""

from __future__ import annotations

import copy
import functools
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ....errors import WrongValue
from ...core import ffi, lib
from ..base import MESSAGE_SIZE, text
from ..systems import CoreSystem
from .assembly import displaced, displacement
from .element_tables import Row, law_sizes, rows_of, written_elements
from .law_owner import Law, LawOwner, breaks_of, switches_of, table_of_programs


class MechanismCore(CoreSystem):
    """The core's system of a mechanism.

    Parameters
    ----------
    tables : Tables
        Tables of its dimension: `plane.Tables` or `space.Tables`.
    law : callable, optional
        ``law(number, t, x, xdot)`` gives, for a generalized force, (1,): its value; for a relation with k marker quantities
        (k + 3,): g, dg/dx_i, dg/dt, and d(dg/dx_i)/dt xdot_i + d(dg/dt)/dt; for a nonholonomic one 0, a_i, a_0, and
        da_i/dt xdot_i + da_0/dt.
    laws_know_time : bool
        True if a law depends on t explicitly, not only through positions and velocities.

    Attributes
    ----------
    measures : tuple of OutputSpec

    Raises
    ------
    ValueError
        If the tables contradict themselves; the sentence says where.
    """

    dimension: str                          # "plane" or "space": part of the names in the core
    quantity_kinds: Mapping[str, int]       # the core's numbers of marker quantities, by name
    velocities: int                         # largest number of velocities of a body
    made_by: Any                            # function of the core that creates the mechanism
    motions: Any                            # as each dimension has them
    poses: Callable[..., tuple[np.ndarray, Any]]
    angles: Callable[[np.ndarray], np.ndarray]
    state: Callable[..., tuple[np.ndarray, np.ndarray]]

    def __init__(self, tables: Any, law: Law | None = None, *, laws_know_time: bool = True) -> None:
        self.tables, self._law, self._laws_know_time = tables, law, laws_know_time
        self._owner: LawOwner | None = None
        self._numbers, self._has_written_terms = ffi.NULL, False
        self.written_inputs: Any = None
        written, self._words = self.written_tables(tables, law is not None, laws_know_time)
        message = ffi.new("char[]", MESSAGE_SIZE)
        mechanism = self.made_by(ffi.new(f"zd_{self.dimension}_tables *", written), message, MESSAGE_SIZE)
        if not mechanism:
            raise WrongValue(text(message))
        self._mechanism = ffi.gc(mechanism, self._function("free"))
        super().__init__(self._function("system")(self._mechanism), (self._mechanism,))
        self.measures = tuple(tables.measures)

    def joint_of(self, index: int) -> int:
        """As of any system; what acts along the coordinate is part of the joint's reaction."""
        along = self.measures[index]
        return self._reactions.get(f"{along.name.rpartition('.')[0]}.force", -1) if along.size == 1 else -1

    def needs_reactions(self, index: int) -> bool:
        """As of any system, except sums, forces whose laws read no reactions, and measures of one's own that read no others."""
        each = self.measures[index]
        if each.terms:
            return False
        if each.kind == "formula":
            numbers = {other.name: i for i, other in enumerate(self.measures)}
            return any(self.needs_reactions(numbers[name if name in numbers else name.rpartition(".")[0]])
                       for name in each.reads)
        if each.kind in ("force value", "force power", "force sum", "torque sum"):
            return any(force.reads for force in self.tables.forces[each.first:each.first + each.size])
        return super().needs_reactions(index)

    @property
    def joint_forces(self) -> list[str]:
        """Names of the forces of joints."""
        return list(self._reactions)

    @functools.cached_property
    def _reactions(self) -> dict[str, int]:
        """Joints by the names of their forces."""
        return {each.name: each.first for each in self.measures if each.kind == "joint force"}

    @classmethod
    def _function(cls, name: str) -> Any:
        return getattr(lib, f"zd_{cls.dimension}_{name}")

    @classmethod
    def written_tables(cls, tables: Any, has_laws: bool = False, laws_know_time: bool = False) -> tuple[dict[str, Any], Any]:
        """Fields of the core's tables, and the texts that must be kept as long as the objects made from them."""
        bodies, joints = (ffi.new(f"zd_{cls.dimension}_{kind}[]", list(entries))
                          for kind, entries in (("body", tables.bodies), ("joint", tables.joints)))
        quantities = ffi.new(f"zd_{cls.dimension}_quantity[]",
                             [(cls.quantity_kinds[kind], *others) for kind, *others in tables.quantities])
        elements, words = written_elements(tables, has_laws, laws_know_time)
        return {"gravity": tables.gravity, "bodies": len(bodies), "joints": len(joints), "quantities": len(quantities),
                "body": bodies, "joint": joints, "quantity": quantities, "elements": elements}, words

    @functools.cached_property
    def rows(self) -> tuple[Row, ...]:
        """Origin of each constraint, holonomic ones first."""
        return rows_of(self._function("rows")(self._mechanism), self.m)

    moved, apart = displaced, displacement

    def for_run(self) -> MechanismCore:
        """The system; with user functions, a copy that stores their exceptions."""
        if self._law is None:
            return self
        sizes = law_sizes(self.tables)
        owner = LawOwner(self._law, sizes)
        # Written terms have the laws in them, and leave them to measures.
        programs = (ffi.NULL, None) if self._has_written_terms else table_of_programs(self._law, sizes)
        mine = self._with_data(ffi.new_handle(owner), self._numbers, programs)
        mine._owner = owner
        return mine

    def _with_data(self, handle: Any, numbers: Any, programs: tuple[Any, Any] = (ffi.NULL, None)) -> MechanismCore:
        """Copy with other data; user functions whose tables have no ends are not checked."""
        mine = copy.copy(self)
        data = ffi.new("char[]", self._function("data_size")())
        self._function("with")(self._mechanism, handle, programs[0], numbers, data)
        mine.c = ffi.new("zd_system *", self.c[0])
        if handle and not (programs[1] and any(row.has_ends for row in programs[0])):
            mine.c.check_domain = ffi.NULL
        mine.c.breaks, kept = breaks_of(self._law)
        mine.c.switches, keep = switches_of(self._law, programs, ffi.addressof(lib, f"zd_{self.dimension}_compare"))
        mine.c.data, mine._data, mine._numbers = data, (*self._data, handle, *programs, numbers, kept, keep, data), numbers
        return mine

    def meet_breaks(self, t0: float, t1: float) -> None:
        """Find all breaks of user functions in the span of a run, to which this copy belongs."""
        if self._law is not None:
            self.c.breaks, self._breaks = breaks_of(self._law, (t0, t1))

    def many_bodies(self) -> Any:
        """Components of measures for the assembly of many free bodies."""
        components = ffi.addressof(lib, f"zd_{self.dimension}_components")
        return ffi.new("zd_many_bodies *", (self._mechanism, components, self.velocities))

    @property
    def lane_numbers(self) -> Any:
        """Numbers that generated closed-form functions read, an array of C, or None without such functions."""
        return self._numbers if self.has_closed_form and self._numbers else None

    @property
    def calls_python(self) -> bool:
        """True if the mechanism has user functions that are callables, and terms that call them."""
        laws: Any = self._law
        if laws is None or self._has_written_terms:
            return False
        return not hasattr(laws, "programs") or not all(laws.programs(law_sizes(self.tables)))

    @property
    def error(self) -> BaseException | None:
        """Exception raised by a user function, or None."""
        return self._owner.error if self._owner else None

    @property
    def calls(self) -> dict[str, float]:
        """Time spent in user functions that were called, in s, by what they are."""
        return self._owner.calls if self._owner else {}

    @property
    def refusal(self) -> BaseException | None:
        """Error for the last values of a user function that were not finite, which shorter steps may have avoided since."""
        return self._owner.refusal if self._owner else None
