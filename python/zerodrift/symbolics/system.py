"""`SymbolicSystem`, the result of `zerodrift.symbolic`. It does not need SymPy, so it can be unpickled where SymPy is missing."""

from __future__ import annotations

import ctypes
import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._private import checks, gateway
from .._private.gateway import TERMS, NativeCore, Variable
from .._private.gateway.compiled.precise import Precise
from .._private.gateway.inputs import Bound, Place
from ..errors import NeedsCompiler, NoCompilerWarning, UnsuitedIntegrator, WrongValue
from ..systems.base import BaseSystem
from ..systems.defaults import WithInputs
from ..systems.parameter_tables import NumberTables, not_finite, refusals
from ..systems.structure import Structure, checked
from ..systems.variables import quaternion_places, with_units
from . import rounding_factors
from .compile import compilers, shared_library
from .compile.closed_form_library import CLOSED_FORM, NO_COMPILER, ClosedFormFunctions
from .compile.series_library import JacobianFunctions, PreciseFunctions, SeriesFunctions
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
    python_source: str
    drawing: tuple[int, int]            # points, dimension
    drawing_source: str
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
        False where there was no compiler and it is evaluated in Python.
    """

    def __init__(self, code: Code, parameters: Mapping[str, float], units: Sequence[str] | None = None, p0: Any = None,
                 v0: Any = None, name: str = "symbolic", progress: Callable[[str], Any] = lambda what: None,
                 quaternions: Sequence[int | str] = (), closed_form: ClosedFormFunctions | None = None,
                 inputs: Sequence[str] = ()) -> None:
        self._inputs = tuple(inputs)
        self._code, self.name, self.parameters, self._units = code, name, dict(parameters), units
        self._places = quaternion_places(quaternions, code.coordinates, "A" in code.provides)
        self.coordinates, self.velocities = with_units(code.coordinates, code.velocities, units, "A" not in code.provides,
                                                       self._places)
        self.constraints = tuple(Variable(row, "") for row in code.constraints)
        self._packing = checked(code.structure and Structure(**code.structure), code.sizes, "A" in code.provides)
        self._set_start(p0, v0)
        self._values = np.array([checks.number(f"parameter {key!r}", parameters[key]) for key in code.parameters])
        is_length = [gateway.is_length(variable) for variable in (*self.coordinates, *self.velocities)]
        self._closed_form = closed_form or ClosedFormFunctions(
            code.program, code.sizes, self._values, self.p0, np.array(is_length), len(self._values) + code.constants)
        self._series = SeriesFunctions(code.program, code.sizes)
        self._precise = PreciseFunctions(code.program, code.sizes)
        self._jacobian = JacobianFunctions(code.program, code.sizes)
        self._perturbed: SeriesFunctions | None = None      # of the same off by rounding
        self._library = shared_library.library(code.c_source, progress, meanwhile=self._closed_form.prepare)
        self.compiled = self._library is not None
        if not self.compiled:
            warnings.warn(f"there is no C compiler (looked for {compilers.looked_for()}): {self.name} is evaluated in Python, "
                          f"some hundred times slower", NoCompilerWarning, stacklevel=3)
        self._core = self._native() if self.compiled else self._in_python()
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
        library = functions.library(vector) if self.compiled else None
        if library is None or not isinstance(core, NativeCore):
            return core
        if (vector, embeds) not in self._with_closed_form:
            data = self._with_closed_form_data(library, functions)
            address = gateway.address_of(library, CLOSED_FORM)
            self._with_closed_form[vector, embeds] = core.with_closed_form(address, data, library)
        return self._with_closed_form[vector, embeds]

    def _why_no_closed_form(self, embeds: bool = False) -> str:
        return self._functions(embeds).why_none if self.compiled else NO_COMPILER

    def _with_series(self, core: gateway.CoreSystem, vector: str = "baseline") -> gateway.CoreSystem:
        if not isinstance(core, NativeCore):
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

    def _with_jacobian(self, core: gateway.CoreSystem, vector: str = "baseline") -> gateway.CoreSystem:
        library = self._jacobian.library(vector) if self.compiled else None
        if library is None or not isinstance(core, NativeCore):
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
        if not self.compiled:
            raise WrongValue(f"inputs of {self.name} need a C compiler", "not-available")
        return WithInputs(self, [self.parameters[name] for name in names], [""] * len(names), self._bound)

    def _names_of_inputs(self) -> list[str]:
        return list(self._inputs)

    def _bound(self, core: NativeCore, names: Sequence[str]) -> Bound:
        """The system of one run, with data of its own."""
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
        library = None if embeds or core is self._core else self._closed_form.library_in_lanes(vector)
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

    def _in_python(self) -> gateway.PythonCore:
        code, written = self._code, _InPython(self._code.python_source, self._values.tolist())
        return gateway.PythonCore(code.sizes, code.provides, written, (*self.coordinates, *self.velocities),
                                   timeless=code.timeless, quaternions=self._places, packing=self._packing)

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
        other._core = (self._core.with_data(other._data()) if isinstance(self._core, NativeCore)
                       else other._in_python())
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
        count, dimension = self._code.drawing
        if not count:
            return None
        drawing = np.empty(count * dimension)
        values = [self.parameters[key] for key in self._code.parameters]
        _compiled(self._code.drawing_source)(
            {"points"}, 0.0, checks.vector("p", p, self.nq).tolist(), (), values, {"points": drawing})
        return drawing.reshape(count, dimension)

    def __repr__(self) -> str:
        how = self._closed_form.in_words if self.compiled else ", evaluated in Python"
        return f"<zd.symbolic {self.name}: {self._sizes_in_words()}{how}>"

    def _definition(self) -> str:
        return self._code.python_source

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._code, self.parameters, self._units, self.p0, self.v0, self.name, self._places, self._closed_form,
                           self._inputs)


def _restored(code: Code, parameters: dict[str, float], units: Any, p0: Any, v0: Any, name: str, places: tuple[int, ...],
              closed_form: ClosedFormFunctions, inputs: tuple[str, ...] = ()) -> SymbolicSystem:
    return SymbolicSystem(code, parameters, units, p0, v0, name, quaternions=places, closed_form=closed_form, inputs=inputs)


# ---- without a compiler ----


class _InPython:
    """Writes the wanted terms into the core's arrays."""

    def __init__(self, source: str, values: list[float]) -> None:
        self._evaluate, self._values = _compiled(source), values

    def __call__(self, want: int, t: float, arrays: dict[str, np.ndarray]) -> None:
        names = {name for name, term in TERMS.items() if want & term.bit}
        out = {name: arrays[name].reshape(-1) for name in names}
        self._evaluate(names, t, arrays["p"].tolist(), arrays["v"].tolist(), self._values, out)

    @staticmethod
    def not_finite(name: str, t: float, value: np.ndarray) -> Exception:
        return WrongValue(f"{name} is not finite at t = {t:g}: {value}", "not-finite")


@cache
def _compiled(source: str) -> Callable[..., None]:
    """Function compiled from the Python source that `emission` wrote."""
    names: dict[str, Any] = {"math": _Mathematics, "divide": _divide, "power": _guarded(math.pow), "missing": _missing,
                             "root": _guarded(math.sqrt)}
    exec(compile(source, "<zerodrift.symbolic>", "exec"), names)
    return names["evaluate"]


def _guarded(function: Callable[..., float]) -> Callable[..., float]:
    """Wrap a function so that it returns NaN or an infinity, as in C, instead of raising."""
    def guarded(*arguments: float) -> float:
        try:
            return float(function(*arguments))
        except (ValueError, OverflowError, ZeroDivisionError):
            return _as_in_c(function.__name__, arguments)
    return guarded


# where NumPy calls them otherwise
NUMPY = {"pow": np.power, "asin": np.arcsin, "acos": np.arccos, "acosh": np.arccosh, "atanh": np.arctanh}


def _as_in_c(name: str, arguments: tuple[float, ...]) -> float:
    function = NUMPY.get(name) or getattr(np, name, None)
    if function is None:    # of the gamma functions, which Python raises errors for at poles, and where they overflow
        return math.inf if name == "lgamma" or arguments[0] > 0 else math.nan
    with np.errstate(all="ignore"):
        return float(function(*arguments))


class _Guards(type):
    def __getattr__(cls, name: str) -> Any:
        found = getattr(math, name)
        return _guarded(found) if callable(found) else found


class _Mathematics(metaclass=_Guards):
    """The functions of `math`, guarded."""


def _divide(a: float, b: float) -> float:
    if b == 0:
        return math.nan if a == 0 or a != a else math.copysign(math.inf, a) * math.copysign(1.0, b)
    return a / b


def _missing(name: str) -> float:
    raise NeedsCompiler(f"Python has no {name}; with a C compiler it can be evaluated")
