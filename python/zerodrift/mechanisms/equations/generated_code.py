"""Equations of a mechanism as compiled code, instead of tables that the core interprets.

The numbers of the core's plan, except zeros and ones, are arguments of the compiled functions. Everything else that the equations
depend on is in the plan with nodes for numbers: equal plans share their code.

In space, absolute coordinates keep the terms of the tables, whose products use more structure of joints than the entries of C
have; only closed-form functions are generated.
"""

from __future__ import annotations

import ctypes
import warnings
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ..._private import gateway
from ..._private.gateway.compiled.precise import Precise
from ..._private.gateway.compiled.programs import with_addresses
from ..._private.gateway.mechanisms import space_plans
from ..._private.gateway.mechanisms.compiled_terms import WrittenTerms, with_functions
from ..._private.gateway.mechanisms.core import MechanismCore
from ..._private.gateway.mechanisms.law_inputs import WrittenInputs
from ..._private.gateway.mechanisms.plans import plan_of
from ..._private.gateway.mechanisms.space import SpaceCore
from ...errors import NoCompilerWarning, UnsuitedIntegrator
from ...symbolics.compile import cache as kept
from ...symbolics.compile import compilers, shared_library
from ...symbolics.compile.closed_form_library import CLOSED_FORM, ClosedFormFunctions
from ...symbolics.compile.series_library import JacobianFunctions, PreciseFunctions, SeriesFunctions
from ...symbolics.graph.plain_functions import Plain
from ...systems.exact_numbers import low_parts_of_frames
from . import nodes, space_nodes
from .function_calls import Laws
from .measure_tables import read
from .tables import Tables

DATA = "*(const double *const *)data"       # the doubles that functions receive: csrc/mechanisms/plane/tables.h
MAX_VELOCITIES = 400   # with six a body, each of which takes more than ten operations: see closed_form_writer.MAX_OPERATIONS
FOLLOWED = "coordinates that follow from others have none"
CLOSED_FORM_DATA = f"(ZD_LANES == 1 ? {DATA} : (const double *)data)"      # in SIMD lanes these alone differ between groups


@dataclass(frozen=True)
class Code:
    """Generated code without its numbers: equal plans share it. All fields can be written as JSON."""

    provides: list[str]
    timeless: bool
    constants: int
    scratch: int
    c_source: str
    program: dict[str, Any] | str       # as of symbolics/system.py


class Written:
    """Compiled functions of a mechanism, and their numbers.

    Parameters
    ----------
    core : MechanismCore or SpaceCore
        The interpreted system.
    laws : Laws
    parameters : dict of str to float
        The mechanism's own.
    name : str
        For a warning.
    compiles : bool
        False: no code is compiled, and closed-form functions are programs that the core runs.
    has_inputs : bool
        True: some of the parameters change within a run.

    Attributes
    ----------
    core : MechanismCore or SpaceCore
        The compiled system; where there is no compiler, the interpreted one.
    is_compiled : bool
        True if a compiler was found.
    key : str
        The name of the code: two mechanisms of the same differ in numbers alone.
    """

    def __init__(self, core: MechanismCore | SpaceCore, laws: Laws, parameters: dict[str, float], name: str,
                 *, compiles: bool = True, has_inputs: bool = False) -> None:
        self._interpreted, self._sizes = core, (core.nq, core.nv, core.mh, core.mn)
        is_in_space = isinstance(core, SpaceCore)
        # Matrices of compiled mechanisms are interpreted where user functions have tables, whose ends are said, or jump.
        self._has_terms = compiles and not laws.tables and not laws.jump and (not is_in_space or core.packing is None)
        reader = Plain()
        number = nodes.Numbering(reader.graph)
        room, planned = (space_nodes, space_plans.plan_of) if is_in_space else (nodes, plan_of)
        plan = room.with_nodes(planned(core), number)
        first, own = len(number.values), _own_numbers(number, parameters, laws)
        self._index = {key: first + i for i, key in enumerate(own)}
        self._splines = {self._index[table]: table for table in laws.tables}
        self._values, self._frames = np.array(number.values), room.frames_of(plan)
        self._inputs = range(len(number.values) - len(own), len(number.values)) if has_inputs else range(0)
        self.key = kept.digest_of(_writing_code(), repr(plan), repr(own), self._sizes,
                                  core.packing is None, _described(laws.rows), compiles)
        self._code = _kept_code(self.key) or self._derive(lambda: room.Equations(plan, reader, self._sizes, laws, own))
        self._library = shared_library.library(self._code.c_source) if self._has_terms else None
        self.is_compiled = self._library is not None or (compiles and not self._has_terms and compilers.find() is not None)
        if compiles and not self.is_compiled:
            warnings.warn(f"there is no C compiler (looked for {compilers.looked_for()}): the tables of {name} are interpreted",
                          NoCompilerWarning, stacklevel=6)
        program = FOLLOWED if core.c.followers else self._code.program
        self._jacobian = JacobianFunctions(self._code.program, self._sizes, DATA)
        self._series, self._precise = SeriesFunctions(program, self._sizes, DATA), PreciseFunctions(program, self._sizes)
        self.core = self._compiled(None) if self.is_compiled else core

    def _derive(self, written: Callable[[], nodes.Equations | space_nodes.Equations]) -> Code:
        """Code of the equations; it is stored for equal plans."""
        code = self._code_of(written()) if self._has_terms else self._closed_form_alone(written)
        kept.write(self.key, asdict(code))
        _codes[self.key] = code
        return code

    def _closed_form_alone(self, written: Callable[[], nodes.Equations | space_nodes.Equations]) -> Code:
        """Code for the closed form alone; with too many velocities only the reason why there is none."""
        from ...symbolics.emit import closed_form, closed_form_writer
        from ...symbolics.graph.lowering import Lowering

        if self._sizes[1] > MAX_VELOCITIES:
            return Code([], False, 0, 0, "", closed_form_writer.TOO_LARGE)
        equations = written()
        lowering = Lowering(equations.graph, equations.values)
        outputs = {name: [lowering.lower(node) for node in nodes] for name, nodes in equations.terms().items()}
        return Code([], False, 0, 0, "", closed_form.as_json(lowering, outputs))

    def _code_of(self, equations: nodes.Equations | space_nodes.Equations) -> Code:
        from ...symbolics.emit import closed_form, splitting
        from ...symbolics.graph.blocks import Blocks
        from ...symbolics.graph.lowering import Lowering

        terms, packing = equations.terms(), self._interpreted.packing
        lowering = Lowering(equations.graph, equations.values)
        outputs = {name: [lowering.lower(node) for node in nodes] for name, nodes in terms.items()}
        packed = {name: [outputs[name][place] for place in packing.places(name)] for name in ("M", "C")
                  if packing and name in outputs}
        blocks = Blocks(lowering, outputs | packed)
        c_source, constants, scratch = splitting.source(blocks, ["A mechanism."], len(self._values), DATA)
        knows_time = any(operation.code == "leaf" and operation.arguments[0] == "t" for operation in lowering.operations)
        return Code(list(terms), not knows_time, constants, scratch, c_source, closed_form.as_json(lowering, outputs))

    def _compiled(self, closed_form: ClosedFormFunctions | None, vector: str = "baseline", jacobian: Any = None,
                  series: Any = None) -> MechanismCore | SpaceCore:
        """System with compiled functions."""
        code = self._code
        further = np.zeros(code.constants + (closed_form.constants if closed_form else 0) + 1)
        numbers = np.concatenate([with_addresses(self._values, self._splines), further])
        libraries: list[Any] = [self._library]
        address = terms = None
        if self._library is not None:
            self._library.zd_symbolic_constants(ctypes.c_void_p(numbers.ctypes.data))
            evaluate = gateway.address_of(self._library, "zd_symbolic_evaluate")
            terms = WrittenTerms(evaluate, code.provides, code.timeless, code.scratch)
        if closed_form:
            libraries.append(closed_form.library(vector))
            libraries[1].zd_symbolic_closed_form_constants(ctypes.c_void_p(numbers.ctypes.data))
            address = gateway.address_of(libraries[1], CLOSED_FORM)
        numbers.flags.writeable = False
        rates = jacobian and gateway.address_of(jacobian, JacobianFunctions.symbol)
        coefficients = series and gateway.address_of(series, SeriesFunctions.symbol)
        keep = [*libraries, jacobian, series, self._splines]
        core = with_functions(self._interpreted, numbers, keep, terms=terms, closed_forms=address,
                              jacobian=rates, series=coefficients)
        derive = zip(libraries, ("zd_symbolic_constants", f"{CLOSED_FORM}_constants"), strict=False)
        core.written_inputs = WrittenInputs(numbers, self._index, [gateway.address_of(*each) for each in derive if each[0]])
        return core

    def with_jacobian(self, vector: str) -> MechanismCore | SpaceCore:
        """Core system with the Jacobian of its rates for a vector unit, if that can be generated; otherwise the core system."""
        library = self._jacobian.library(vector) if self.is_compiled else None
        return self._compiled(None, vector, library) if library else self.core

    @property
    def why_no_series(self) -> str:
        """Reason why there is no Taylor series; empty if there is one."""
        return self._series.why_none

    def with_series(self, vector: str) -> MechanismCore | SpaceCore:
        """Core system with the Taylor series of its motion for a vector unit; raises UnsuitedIntegrator if there is none."""
        if self.why_no_series:
            raise UnsuitedIntegrator(f"the mechanism has no Taylor series: {self.why_no_series}")
        return self._compiled(None, vector, series=self._series.library(vector))

    def precise(self, vector: str) -> Precise | None:
        """Functions in double-double arithmetic, with numbers that make frames orthonormal to it; None: there are none."""
        library = self._precise.library(vector) if self.is_compiled else None
        if library is None:
            return None
        numbers = _pairs(self._values, self._frames)
        return Precise(gateway.address_of(library, PreciseFunctions.symbol), numbers, self._sizes, library)

    def closed_form_functions(self, p0: np.ndarray | None, is_length: np.ndarray) -> ClosedFormFunctions:
        """Closed-form functions, with elimination orders for these numbers and the start p0."""
        return ClosedFormFunctions(self._code.program, self._sizes, self._values, p0, is_length,
                               len(self._values) + self._code.constants, CLOSED_FORM_DATA, inputs=self._inputs,
                               splines=self._splines)

    def with_programs(self, closed_form: ClosedFormFunctions) -> MechanismCore | SpaceCore:
        """Core system with closed-form functions as programs, if there are any; otherwise the core system."""
        found = closed_form.interpreted(with_addresses(self._values, self._splines))
        if found is None:
            return self.core
        forms, keep, numbers = found
        core = with_functions(self._interpreted, numbers, (forms, keep, self._splines), closed_forms=forms)
        core.written_inputs = WrittenInputs(numbers, self._index, [])
        return core

    def with_closed_form(self, closed_form: ClosedFormFunctions, vector: str) -> MechanismCore | SpaceCore:
        """Core system with closed-form functions for a vector unit, if these can be generated; otherwise the core system."""
        return self._compiled(closed_form, vector) if self.is_compiled and closed_form.library(vector) else self.core


def measure_program(tables: Tables, name: str) -> tuple[Any, list[int], np.ndarray] | None:
    """Operations of a measure of positions or velocities: the lowering, the operations whose values its components are, and the
    parameters (k, 2) that are read, as pairs of doubles; None for other measures.
    """
    from ...symbolics.graph.lowering import Lowering

    quantities, measures = read(tables, {name})
    measure = next((each for each in measures if each.name == name), None)
    if measure is None:
        return None
    core, reader = tables.core(quantities, measures), Plain()
    number = nodes.Numbering(reader.graph)
    room, planned = (space_nodes, space_plans.plan_of) if isinstance(core, SpaceCore) else (nodes, plan_of)
    plan = planned(core, range(measure.first, measure.first + measure.size))
    plan, own = room.with_nodes(plan, number), {key: number.new(value) for key, value in tables.parameters.items()}
    equations = room.Equations(plan, reader, (core.nq, core.nv, core.mh, core.mn), tables.laws, own)
    lowering, frames = Lowering(reader.graph, equations.values), room.frames_of(plan)
    found = [lowering.lower(rate if measure.kind == "rates" else value) for value, rate in equations.readings[-measure.size:]]
    return lowering, found, _pairs(np.array(number.values), frames)


def _own_numbers(number: nodes.Numbering, parameters: Mapping[str, float], laws: Laws) -> dict[Any, Any]:
    """Nodes of the mechanism's parameters, and of the numbers that stand for tables."""
    return {key: number.new(value) for key, value in {**parameters, **dict.fromkeys(laws.tables, 0.0)}.items()}


def _pairs(values: np.ndarray, frames: Any) -> np.ndarray:
    """Numbers (k, 2) as pairs of doubles, with which the frames of joints are orthonormal."""
    return np.stack([values, low_parts_of_frames(frames, values)], axis=-1)


# ---- the key ----

_codes: dict[str, Code] = {}


def _kept_code(key: str) -> Code | None:
    """Code derived earlier from an equal plan, or None."""
    if key not in _codes and (found := kept.read(key, dict)) is not None:
        _codes[key] = Code(**found)
    return _codes.get(key)


@cache
def _writing_code() -> str:
    """Fingerprint of the generating code."""
    package = Path(__file__).parents[2]
    files = [file for room in ("symbolics", "mechanisms", "laws") for file in sorted((package / room).rglob("*.py"))]
    return kept.digest_of([file.read_text(encoding="utf-8") for file in files])


def _described(what: Any) -> Any:
    """User functions as JSON: all that their nodes depend on."""
    if isinstance(what, np.ndarray):
        return what.tolist()
    if isinstance(what, Mapping):
        left_out = {"parameters", "what", "_spline", *(["_function"] if what.get("formula") else [])}
        return [[key, _described(value)] for key, value in what.items() if key not in left_out]
    if isinstance(what, list | tuple):
        return [_described(each) for each in what]
    return [type(what).__name__, _described(vars(what))] if hasattr(what, "__dict__") else repr(what)
