"""Sentences on a mechanism's system: its cost, its start, and causes of failures."""

from __future__ import annotations

import functools
import os
from collections.abc import Iterable
from typing import Any

import numpy as np

from ..._private.gateway.mechanisms.assembly import CoreAssembly
from ...errors import WrongType, WrongValue, ZerodriftError, sentence
from ...symbolics.compile import compilers
from ...symbolics.compile.closed_form_library import NO_COMPILER
from ...systems.base import BaseSystem
from ..assembly import space_advice
from ..assembly.drive_starts import driven_coordinate
from ..assembly.free_coordinates import is_driven
from ..assembly.start import Starting, size_of
from ..elements.drawing import Drawing
from ..elements.forces import Actuator, Motor
from ..elements.numbers import Numbers
from ..equations.space_tables import SpaceTables
from ..equations.tables import Tables
from . import advice, cost

MANY = 32       # joint coordinates: their cost is reported only from this number on
SMALL_SIZE = 30         # velocities and constraints up to which generated code is known to pay
FEWEST_STEPS = 10_000   # of a run that may gain by compiling: no system of that size takes a millisecond for a step
WORTH_COMPILING = 5.0   # s that a run must gain: compiling takes one or two


class Reported(BaseSystem):
    """System of a mechanism, which names bodies, joints and drives in its sentences."""

    layout: str
    _drawing: Drawing
    _numbers: Numbers
    _tables: Tables
    _started_tables: Any                # with the initial positions of drives of constant speed
    _interpreted: Any                   # core of these
    _start: Starting
    _is_written_out: Any
    compiled: Any
    _compiled: Any
    _written: Any
    _closed_form: Any
    start_at: Any

    def _check_written(self) -> None: ...

    @functools.cached_property
    def _cost(self) -> cost.Cost | None:
        """Computing cost, for many joint coordinates, as absolute ones may be cheaper; None for few or for generated code."""
        return cost.cost(self._tables) if self.layout == "joint" and self.nq >= MANY and not self._is_written_out else None

    def _what_it_costs(self, steps: int | None) -> str | None:
        return cost.of_a_run(self._cost, steps) if self._cost else None

    @functools.cached_property
    def _operations(self) -> float:
        """Operations of a corrected step of "rk4"."""
        found = cost.cost(self._tables)
        return found.absolute if self.layout == "absolute" else found.joint

    def _gains_by_compiling(self, steps: int) -> bool:
        """True if a run of so many fixed steps saves more than compiling takes, and ZERODRIFT_COMPILE is not 0."""
        is_long = steps >= FEWEST_STEPS and os.environ.get("ZERODRIFT_COMPILE") != "0"
        is_worth = is_long and self._why_not_compiled() is None and self._saved(steps) >= WORTH_COMPILING
        return is_worth and compilers.find() is not None

    def _saved(self, steps: float) -> float:
        """Approximate time in s that compiled equations save in so many corrected steps of "rk4"."""
        instructions = self._instructions()
        return cost.saved_from_programs(instructions, steps) if instructions else cost.saved(self._operations, steps)

    @property
    def _can_be_eliminated(self) -> bool:
        """True if the mechanism is small, and its coordinates such that closed forms are known to pay."""
        return (self.layout == "joint" or self._drawing.dimension == 2) and 0 < max(self.nv, self.m) <= SMALL_SIZE

    def _why_not_compiled(self) -> str | None:
        """Reason why equations cannot be compiled; "": the mechanism is too large for that to pay; None: they can be."""
        if not self._can_be_eliminated:
            return ""
        try:
            self._check_written()
        except WrongValue as error:
            return sentence(error)
        return None

    @functools.cached_property
    def _takes_programs(self) -> bool:
        """True if closed-form functions may be programs that the core runs: equations are not compiled, but could be."""
        if self.compiled or self._compiled is False or self._why_not_compiled() is not None:
            return False
        try:
            return self._written is not None
        except (WrongType, WrongValue):     # an expression has a function that C lacks
            return False

    def _instructions(self) -> int:
        """Instructions of the programs of a corrected step of "rk4"; 0: there are none."""
        found = self._closed_form[1].programs if self._takes_programs else None
        return found[0].instructions if found else 0

    def _why_interpreted(self, steps: float) -> str | None:
        if self._is_written_out or self._groups or self._why_not_compiled() is not None:
            return None
        saved = float(f"{self._saved(steps):.1g}")     # digits that the count has
        if saved >= WORTH_COMPILING and compilers.find() is None:
            return NO_COMPILER
        return f"m.system(compiled=True) saves about {cost.in_words(saved)} of such a run"

    def _advice(self, error: Exception) -> str | None:
        """Advice for a singular start, or None."""
        if isinstance(self._tables, SpaceTables) and "follow" in sentence(error):
            tables, assembly, p = self._start.closed(0.0)
            if isinstance(tables, SpaceTables) and (
                    reason := space_advice.at_start(tables, assembly.core, assembly.t, p, self.name)):
                return reason
        return advice.at_start(sentence(error), self._start, self.constraints)

    def _drawn_open(self, also_held: Iterable[str] = ()) -> str | None:
        """As of any system; None, too, if it cannot be assembled."""
        try:
            self.start_at(0.0)
        except ZerodriftError:
            return None
        drawn_open = self._start.changes and self._start.changes.warning(also_held)
        return drawn_open or (None if also_held else self._start.moved_drives(0.0))

    def _why_locked(self) -> str | None:
        """Sentence on skew axes; None if drives move what joints alone would lock."""
        if not isinstance(self._tables, SpaceTables) or is_driven(self._drawing):
            return None
        return space_advice.locked(self._tables, self.name)

    def _advice_on_failure(self, t: float, p: np.ndarray) -> str | None:
        """Known cause of a failure at p in space: a disc lying flat, or shafts at a right angle."""
        tables = self._started_tables
        return space_advice.on_failure(tables, self._interpreted, t, p) if isinstance(tables, SpaceTables) else None

    def _beyond_reach(self, t: float, p: np.ndarray, ahead: float) -> str:
        """Sentence on the drive, and the dead point to which it moves the mechanism within a time ahead."""
        core = self._watching.core
        core.names_of_constraints(self)
        driven = {each.name: driven_coordinate(each) for each in self._drawing.of((Motor, Actuator))}
        measures = [self._watching.known.get(driven.get(each.name), (-1, 0))[0] for each in self.constraints[:self.mh]]
        return CoreAssembly(core, (), size_of(self._drawing, self._numbers), t).beyond_reach(p, measures, ahead)

    def _advice_on_collapse(self, t: float, p: np.ndarray, v: np.ndarray, velocity: int) -> str:
        """Also the forces and torques that jump there."""
        found = advice.jumping(self._drawing, self._watching, t, p, v, velocity)
        return super()._advice_on_collapse(t, p, v, velocity) + (f"; {found} jumps there" if found else "")
