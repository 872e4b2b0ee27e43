"""`SymbolicSystem`, the result of `zerodrift.symbolic`. It does not need SymPy, so it can be unpickled where SymPy is missing."""

from __future__ import annotations

import ctypes
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._private import checks, gateway
from .._private.gateway import NativeCore, Variable
from .._private.gateway.compiled import programs
from .._private.gateway.compiled.precise import Precise
from .._private.gateway.compiled.programs import ProgramCore
from .._private.gateway.inputs import Bound, Place
from ..errors import NeedsCompiler, NoCompilerWarning, UnsuitedIntegrator, WrongValue
from ..systems.base import BaseSystem
from ..systems.defaults import WithInputs
from ..systems.one_sided import Switched
from ..systems.parameter_tables import NumberTables, not_finite, refusals
from ..systems.structure import Structure, checked
from ..systems.variables import quaternion_places, with_units
from . import rounding_factors
from .compile import compilers, shared_library
from .compile.closed_form_library import CLOSED_FORM, ClosedFormFunctions, without_rows
from .compile.series_library import JacobianFunctions, PreciseFunctions, SeriesFunctions
from .emit.program_writer import Expressions, Terms
from .graph.smoothness import is_plain_program


@dataclass(frozen=True)
class Code:
    """Derived system, independent of the values of its parameters. All attributes can be written as JSON."""

    coordinates: tuple[str, ...]
    velocities: tuple[str, ...]
    constraints: tuple[str, ...]
    parameters: tuple[str, ...]
    sizes: tuple[int, int, int, int]    # nq, nv, mh, mn
    structure: dict[str, Any] | None    # the arguments of `zerodrift.Structure`, where one pays
    provides: tuple[str, ...]
    timeless: bool                      # no term depends on t
    constants: int                      # that follow from the parameters
    scratch: int
    c_source: str
    programs: Any                       # of the terms, where they are not compiled, or why there are none
    drawing: int                        # dimension; 0: there is none
    drawing_program: Any                # or why there is none
    program: dict[str, Any] | str       # from which closed-form functions are written, or why they are not

    @classmethod
    def from_json(cls, content: dict[str, Any]) -> Code:
        fields: dict[str, Any] = {key: tuple(value) if isinstance(value, list) else value for key, value in content.items()}
        return cls(**fields)

    def as_json(self) -> dict[str, Any]:
        return asdict(self)


class SymbolicSystem(BaseSystem):
    """A mechanism whose terms were derived from expressions and compiled.

    Made by `zerodrift.symbolic` and `zerodrift.from_mechanics`; a system like any other.

    Attributes
    ----------
    parameters : dict of str to float
    compiled : bool
        False where there was no compiler, and programs are interpreted.
    """

    _core: NativeCore

    def __init__(self, code: Code, parameters: Mapping[str, float], units: Sequence[str] | None = None, p0: Any = None,
                 v0: Any = None, name: str = "symbolic", progress: Callable[[str], Any] = lambda what: None,
                 quaternions: Sequence[int | str] = (), closed_form: ClosedFormFunctions | None = None,
                 inputs: Sequence[str] = (), groups: Sequence[Switched] = ()) -> None:
        self._inputs, self._switched = tuple(inputs), list(groups)
        self._code, self.name, self.parameters, self._units = code, name, dict(parameters), units
        self._places = quaternion_places(quaternions, code.coordinates, "A" in code.provides)
        self.coordinates, self.velocities = with_units(code.coordinates, code.velocities, units, "A" not in code.provides,
                                                       self._places)
        self.constraints = tuple(Variable(row, "") for row in code.constraints)
        self._packing = checked(code.structure and Structure(**code.structure), code.sizes, "A" in code.provides)
        self._set_start(p0, v0)
        self._values = np.array([checks.number(f"parameter {key!r}", parameters[key]) for key in code.parameters])
        is_length = [gateway.is_length(variable) for variable in (*self.coordinates, *self.velocities)]
        free = without_rows(code.program, code.sizes, {group.first for group in self._switched})
        self._closed_form = closed_form or ClosedFormFunctions(
            *free, self._values, self.p0, np.array(is_length), len(self._values) + code.constants,
            inputs=[code.parameters.index(name) for name in self._inputs])
        self._series = SeriesFunctions(code.program, code.sizes)
        self._precise = PreciseFunctions(code.program, code.sizes)
        self._jacobian = JacobianFunctions(code.program, code.sizes)
        self._perturbed: SeriesFunctions | None = None      # of the same off by rounding
        self._library = shared_library.library(code.c_source, progress, meanwhile=self._closed_form.prepare)
        self.compiled = self._library is not None
        if not self.compiled:
            warnings.warn(f"there is no C compiler (looked for {compilers.looked_for()}): {self.name} is interpreted, "
                          f"several times slower", NoCompilerWarning, stacklevel=3)
        self._core = self._native() if self.compiled else self._program_core()
        self._groups = gateway.switch(self._core, self._switched)
        self._with_closed_form: dict[tuple[str, bool], NativeCore] = {}     # by vector unit, and whether they embed

    def _native(self) -> NativeCore:
        code, address = self._code, gateway.address_of(self._library, "zd_symbolic_evaluate")
        return NativeCore(code.sizes, code.provides, address, self._data(), (*self.coordinates, *self.velocities),
                                   scratch=code.scratch, keep=self._library, timeless=code.timeless, quaternions=self._places,
                                   packing=self._packing)

    def _data(self) -> np.ndarray:
        """Data of the compiled function: the parameters, the constants computed from them, and one spare double."""
        data = np.zeros(len(self._values) + self._code.constants + 1)
        data[:len(self._values)] = self._values
        if self._library is not None:
            self._library.zd_symbolic_constants(ctypes.c_void_p(data.ctypes.data))
        data.flags.writeable = False
        return data

    def _closed_form_core(self, vector: str = "baseline", embeds: bool = False) -> gateway.CoreSystem:
        functions, core = self._functions(embeds), self._core
        if isinstance(core, ProgramCore):
            return self._with_programs(core, embeds)
        library = functions.library(vector)
        if library is None:
            return core
        if (vector, embeds) not in self._with_closed_form:
            data = self._with_closed_form_data(library, functions)
            address = gateway.address_of(library, CLOSED_FORM)
            self._with_closed_form[vector, embeds] = core.with_closed_form(address, data, library)
        return self._with_closed_form[vector, embeds]

    def _why_no_closed_form(self, embeds: bool = False) -> str:
        return self._functions(embeds).why_none

    def _with_series(self, core: Any, vector: str = "baseline") -> gateway.CoreSystem:
        if not self.compiled:
            return core
        if self._series.why_none:
            raise UnsuitedIntegrator(f"{self.name} has no Taylor series: {self._series.why_none}")
        library = self._series.library(vector)
        return core.with_series(gateway.address_of(library, SeriesFunctions.symbol), library)

    def _precise_functions(self, vector: str = "baseline") -> Precise | None:
        library = self._precise.library(vector) if self.compiled else None
        if library is None:
            return None
        numbers = np.stack([self._values, np.zeros(len(self._values))], axis=-1)
        return Precise(gateway.address_of(library, PreciseFunctions.symbol), numbers, self._code.sizes, library)

    def _with_jacobian(self, core: Any, vector: str = "baseline") -> gateway.CoreSystem:
        library = self._jacobian.library(vector) if self.compiled else None
        if library is None:
            return core
        return core.with_jacobian(gateway.address_of(library, JacobianFunctions.symbol), library)

    def _with_series_of_perturbed(self, core: gateway.PerturbedCore, vector: str) -> gateway.CoreSystem:
        parameters, program = self._values, self._code.program
        if not self._brings_series or isinstance(program, str):
            return core
        if self._perturbed is None:
            program = rounding_factors.perturbed(program, core.shapes, len(parameters))
            self._perturbed = SeriesFunctions(program, self._code.sizes, rounding_factors.NUMBERS)
        library = self._perturbed.library(vector)
        if library is None:
            return core
        return core.with_series(gateway.address_of(library, SeriesFunctions.symbol), parameters, library)

    @property
    def _brings_series(self) -> bool:
        return self.compiled and not self._series.why_none

    @property
    def _brings_perturbed_series(self) -> bool:
        return self._brings_series

    @property
    def _has_plain_laws(self) -> bool:
        return is_plain_program(self._code.program)

    def _functions(self, embeds: bool) -> ClosedFormFunctions:
        return self._closed_form.embedding if embeds else self._closed_form

    def _with_inputs(self, names: Sequence[str]) -> WithInputs:
        for name in names:
            if name not in self._inputs:
                known = f"; {checks.closest(name, self._inputs)}" if self._inputs else ""
                raise WrongValue(f"inputs of {self.name} must be declared, zd.symbolic(..., inputs=[...]), and {name!r} is not"
                                 f"{known}", "wrong-name")
        return WithInputs(self, [self.parameters[name] for name in names], [""] * len(names), self._bound)

    def _names_of_inputs(self) -> list[str]:
        return list(self._inputs)

    def _bound(self, core: NativeCore, names: Sequence[str]) -> Bound:
        """The system of one run, with data of its own."""
        if isinstance(core, ProgramCore):
            numbers = core.numbers.copy()
            mine, pointer = core.with_numbers(numbers), gateway.doubles(numbers, numbers.size)
            return Bound(mine, [Place(name, False, pointer + self._code.parameters.index(name)) for name in names], [], numbers)
        alone = core.without_lanes or core
        libraries = [self._library, next((functions.library(vector) for (vector, embeds), known in self._with_closed_form.items()
                                          for functions in [self._functions(embeds)] if known is alone), None)]
        derive = zip(libraries, ("zd_symbolic_constants", f"{CLOSED_FORM}_constants"), strict=True)
        mine, pointer, memory = core.with_copied_data()
        places = [Place(name, False, pointer + self._code.parameters.index(name)) for name in names]
        return Bound(mine, places, [(gateway.address_of(*each), pointer) for each in derive if each[0]], memory)

    def _core_in_lanes(self, vector: str, embeds: bool = False) -> gateway.CoreSystem:
        """System of one run with functions for SIMD lanes as well; these do not support independent velocities."""
        core = self._closed_form_core(vector, embeds)
        library = self._closed_form.library_in_lanes(vector) if self.compiled and not embeds and core is not self._core else None
        return core if library is None else core.with_lanes(gateway.address_of(library, CLOSED_FORM), library)

    def _with_closed_form_data(self, library: ctypes.CDLL, functions: ClosedFormFunctions) -> np.ndarray:
        """Data of the compiled function followed by the constants of the closed-form functions."""
        data = np.concatenate([self._data(), np.zeros(functions.constants)])
        library.zd_symbolic_closed_form_constants(ctypes.c_void_p(data.ctypes.data))
        return data

    def _number_tables(self, parameters: Mapping[str, np.ndarray], count: int,
                       closed_form: tuple[str, bool] | None = None) -> NumberTables | None:
        if not self.compiled:
            return super()._number_tables(parameters, count, closed_form)
        if any(each.ndim > 1 for each in parameters.values()):
            return None
        vector, embeds = closed_form or ("", False)
        core, functions = self._core_in_lanes(vector, embeds) if closed_form else self._core, self._functions(embeds)
        library = self._library if core is self._core else functions.library(vector)
        further = 0 if library is self._library else functions.constants
        data = np.zeros((count, len(self._values) + self._code.constants + 1 + further))
        data[:, :len(self._values)] = self._values
        for name, each in parameters.items():
            data[:, self._code.parameters.index(name)] = each
        gateway.derive(gateway.address_of(self._library, "zd_symbolic_constants"), data)
        if library is not self._library:
            gateway.derive(gateway.address_of(library, f"{CLOSED_FORM}_constants"), data)
        refused = refusals(self._with, parameters, not_finite(parameters, count))
        return NumberTables(core, data, data.shape[1], self.p0, self.v0, refused)

    def _program_core(self) -> ProgramCore:
        code = self._code
        if isinstance(code.programs, str):
            raise NeedsCompiler(f"{self.name} has no C compiler, and no programs: {code.programs}")
        return ProgramCore(Terms(*code.programs), self._values, code.sizes, (*self.coordinates, *self.velocities),
                              timeless=code.timeless, quaternions=self._places, packing=self._packing)

    def _with_programs(self, core: ProgramCore, embeds: bool) -> gateway.CoreSystem:
        """System with closed-form functions by programs, if there are any."""
        if ("", embeds) not in self._with_closed_form:
            found = self._functions(embeds).interpreted(self._values)
            self._with_closed_form["", embeds] = core.with_closed_forms(*found) if found else core
        return self._with_closed_form["", embeds]

    @property
    def c_source(self) -> str:
        """The C code that is compiled."""
        return self._code.c_source

    def _with(self, changed: dict[str, Any]) -> SymbolicSystem:
        other = self._copied()
        other._with_closed_form = {}
        other.parameters, other._values = self.parameters | changed, self._values.copy()
        for key, value in changed.items():
            other._values[self._code.parameters.index(key)] = checks.number(f"parameter {key!r}", value)
        other._core = (self._core.with_numbers(other._values) if isinstance(self._core, ProgramCore)
                       else self._core.with_data(other._data()))
        gateway.switch(other._core, self._switched)
        return other

    def starting(self, p0: Any = None, v0: Any = None) -> SymbolicSystem:
        """Copy of the system with another start; omitted values stay unchanged."""
        other = self._copied()
        other._set_start(self.p0 if p0 is None else p0, self.v0 if v0 is None else v0)
        return other

    def _set_start(self, p0: Any, v0: Any) -> None:
        self.p0 = None if p0 is None else checks.vector("p0", p0, self._code.sizes[0])
        self.v0 = None if v0 is None else checks.vector("v0", v0, self._code.sizes[1])
        for x in (self.p0, self.v0):
            if x is not None:
                x.flags.writeable = False

    def _copied(self) -> SymbolicSystem:
        """Shallow copy, which shares the loaded library; a pickled copy would have to find it again."""
        other = object.__new__(type(self))
        vars(other).update(vars(self))
        return other

    def points(self, p: ArrayLike) -> np.ndarray | Any:
        """Points of the drawing at p, (n, 2) or (n, 3), joined by lines except at NaN; None without a drawing."""
        if not self._code.drawing:
            return None
        if isinstance(self._code.drawing_program, str):
            raise NeedsCompiler(f"{self.name} has no drawing: {self._code.drawing_program}")
        written = Expressions(*self._code.drawing_program)
        at, t = checks.vector("p", p, self.nq)[None], np.zeros(1)
        drawn = programs.reader(programs.expressions(written), [*self._values, *written.literals], t, at, t[:0])()
        return drawn.reshape(-1, self._code.drawing)

    def __repr__(self) -> str:
        how = self._closed_form.in_words if self.compiled else ", interpreted"
        return f"<zd.symbolic {self.name}: {self._sizes_in_words()}{how}>"

    def _definition(self) -> Any:
        return (self._code.c_source, [tuple(group) for group in self._switched]) if self._switched else self._code.c_source

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._code, self.parameters, self._units, self.p0, self.v0, self.name, self._places, self._closed_form,
                           self._inputs, self._switched)


def _restored(code: Code, parameters: dict[str, float], units: Any, p0: Any, v0: Any, name: str, places: tuple[int, ...],
              closed_form: ClosedFormFunctions, inputs: tuple[str, ...] = (), groups: Sequence[Switched] = ()) -> SymbolicSystem:
    return SymbolicSystem(code, parameters, units, p0, v0, name, quaternions=places, closed_form=closed_form, inputs=inputs,
                          groups=groups)
