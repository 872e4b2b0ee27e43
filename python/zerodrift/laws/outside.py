"""Copies of globals, closure, defaults and own object of a function, which it reads while it is recorded.

`math`, builtins that ask for types, and classes' methods have stand-ins, so that a copy of the function computes with quantities.
Whatever a recording could miss is refused by name: state, random numbers, time, other libraries.
"""

from __future__ import annotations

import abc
import bisect
import builtins
import collections
import dis
import enum
import functools
import itertools
import math
import operator
import types
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np

from .formula import IN_NUMPY
from .quantities import UFUNCS, Quantity, Unrecorded, function, largest, of_array, smallest
from .table import Table

PLAIN = (type(None), types.NotImplementedType, bool, int, float, complex, str, bytes, range, slice, Fraction, np.generic,
         np.dtype, enum.Enum, Table)
FREE = {abs, all, any, bool, bytes, callable, chr, dict, divmod, enumerate, filter, frozenset, int, iter, len, list, map,
        next, ord, pow, range, repr, reversed, round, set, slice, sorted, str, sum, super, tuple, zip, Fraction, functools.reduce,
        functools.partial, collections.namedtuple}
MODULES = (math, operator, bisect, itertools)       # whose functions have no state
HANDLERS = {"SETUP_FINALLY", "SETUP_WITH", "PUSH_EXC_INFO"}
STATE = {"STORE_GLOBAL": "sets a global name", "DELETE_GLOBAL": "sets a global name", "STORE_ATTR": "sets an attribute",
         "DELETE_ATTR": "sets an attribute", "IMPORT_NAME": "imports a module"}
UNUSED = {"__init__", "__new__", "__del__", "__getattribute__", "__setattr__"}     # methods that copies do not have
FILES = ("save", "load", "set", "from", "gen", "memmap", "print", "show", "info", "test", "get", "buffer", "apply", "vectorize")
ASKS = ("isscalar", "ndim", "shape", "size", "isreal", "iscomplexobj", "isrealobj")
OWN = 1 << 9        # Py_TPFLAGS_HEAPTYPE, of types made by a class statement
NESTED = 50         # objects within objects, at most
SIZE = 10_000       # entries of a list, a dict, an array that is read, at most


class Outside:
    """Copies of what a function reads.

    Attributes
    ----------
    has_values : bool
        True if numbers or objects are among it: then another function that has state may change the result.
    """

    def __init__(self) -> None:
        self.has_values = False
        self._copies: dict[int, tuple[Any, Any]] = {}       # by identity, with the original, which must stay
        self._classes: dict[type, type] = {}        # classes of copies of objects
        self._changeable: list[tuple[Any, Any]] = []        # copies, and their content
        self._depth = 0

    def of(self, value: Any) -> Any:
        """Stand-in or copy of a value."""
        if isinstance(value, PLAIN) and not _has_methods(type(value)):
            self.has_values = self.has_values or isinstance(value, int | float | np.generic)
            return value
        if id(value) not in self._copies:
            self._depth += 1
            try:
                if self._depth > NESTED:
                    raise Unrecorded("reads objects that are nested too deeply")
                self._copies[id(value)] = value, self._copied(value)
            except Unrecorded:
                self._copies.pop(id(value), None)       # an unfinished copy
                raise
            finally:
                self._depth -= 1
        return self._copies[id(value)][1]

    def changed(self) -> str:
        """Kind of a container that the function has changed; "" if there is none."""
        return next((type(copy).__name__ for copy, content in self._changeable if not _same(_content(copy), content)), "")

    def _copied(self, value: Any) -> Any:
        is_hashable = _is_hashable(value)
        if is_hashable and value in STAND_INS:
            return STAND_INS[value]
        if isinstance(value, types.ModuleType):
            return Numpy(value, self) if value.__name__ in ("numpy", "numpy.linalg") else Module(value, self)
        if isinstance(value, np.ndarray):
            return self._array(value)
        if isinstance(value, types.FunctionType):
            return self._function(value)
        if isinstance(value, functools._lru_cache_wrapper):
            return self.of(value.__wrapped__)
        if isinstance(value, types.MethodType):
            return types.MethodType(self.of(value.__func__), self.of(value.__self__))
        if isinstance(value, functools.partial):
            return functools.partial(self.of(value.func), *map(self.of, value.args),
                                     **{name: self.of(each) for name, each in value.keywords.items()})
        if isinstance(value, list | tuple | dict | set | frozenset) and len(value) <= SIZE:
            return self._container(value)
        if isinstance(value, np.ufunc) or (isinstance(value, type) and (
                issubclass(value, BaseException) or (isinstance(value, enum.EnumType) and not _has_methods(value)))):
            return value
        name = str(getattr(value, "__name__", ""))
        if is_hashable and (value in FREE or any(getattr(module, name, None) is value for module in MODULES)):
            return value
        if callable(value) and not isinstance(value, type) and vars(np).get(name, vars(np.linalg).get(name)) is value:
            return _of_numpy(value)     # type: ignore[arg-type]
        if type(value) is types.SimpleNamespace:
            copy = types.SimpleNamespace(**{key: self.of(each) for key, each in vars(value).items()})
            self._changeable.append((vars(copy), _content(vars(copy))))
            return copy
        return Module(value, self) if type(value) is type and value.__flags__ & OWN else self._object(value)

    def _array(self, value: np.ndarray) -> Any:
        if value.dtype.kind not in "biuf" or value.size > SIZE:
            raise Unrecorded("reads an array that is large or not of numbers")
        copy = value.view(np.ndarray).copy()
        copy.flags.writeable, self.has_values = False, True
        self._changeable.append((copy, _content(copy)))
        return copy

    def _container(self, value: Any) -> Any:
        copy: Any
        kind = type(value)
        if (kind not in (list, tuple, dict, set, frozenset) and not hasattr(value, "_fields")) or _has_methods(kind):
            raise Unrecorded(f"reads a {kind.__name__}")
        if isinstance(value, dict):
            copy = {}
            self._copies[id(value)] = value, copy
            copy.update((key, self.of(each)) for key, each in value.items())
        elif isinstance(value, list):
            copy = []
            self._copies[id(value)] = value, copy
            copy.extend(map(self.of, value))
        elif isinstance(value, tuple):
            parts = map(self.of, value)
            copy = type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
        else:
            copy = type(value)(map(self.of, value))
        self._changeable.append((copy, _content(copy)))
        self.has_values = True
        return copy

    def _function(self, value: types.FunctionType) -> types.FunctionType:
        """Copy of a function whose globals and closure are copies."""
        code, names = value.__code__, _checked(value.__code__, set(value.__code__.co_freevars))
        own: dict[str, Any] = {"__builtins__": vars(builtins), "__name__": value.__module__}
        copy = types.FunctionType(code, own, value.__name__, None, tuple(types.CellType() for _ in value.__closure__ or ()))
        self._copies[id(value)] = value, copy
        for name in names:
            if name in value.__globals__ or hasattr(builtins, name):
                own[name] = _Refused.unless(self, value.__globals__.get(name, getattr(builtins, name, None)))
        for name, cell, given in zip(code.co_freevars, copy.__closure__ or (), value.__closure__ or (), strict=True):
            try:
                cell.cell_contents = given.cell_contents if name == "__class__" else self.of(given.cell_contents)
            except ValueError:      # a name that has no value yet
                raise Unrecorded("reads a name that has no value") from None
        copy.__defaults__ = None if value.__defaults__ is None else tuple(map(self.of, value.__defaults__))
        copy.__dict__.update((name, self.of(each)) for name, each in vars(value).items() if name != "__wrapped__")
        copy.__kwdefaults__ = value.__kwdefaults__ and {name: self.of(each) for name, each in value.__kwdefaults__.items()}
        return copy

    def _object(self, value: Any) -> Any:
        """Copy of an object of a user's class, with copies of its attributes and methods."""
        kind = type(value)
        named = getattr(value, "__qualname__", None) or f"a {kind.__name__}"
        module = getattr(value, "__module__", None)
        is_own = isinstance(kind, type) and kind.__flags__ & OWN
        is_usual = type(kind) in (type, abc.ABCMeta) and not hasattr(kind.__init_subclass__, "__func__")
        if (isinstance(value, type) or not is_own or not is_usual or not hasattr(value, "__dict__") or hasattr(value, "__next__")
                or kind.__getattribute__ is not object.__getattribute__):
            raise Unrecorded(f"uses {module}.{named}" if module and module != "builtins" else f"uses {named}")
        copy: Any = object.__new__(self._class_of(kind))
        self._copies[id(value)] = value, copy
        for name, each in vars(value).items():
            copy.__dict__[name] = _Refused.unless(self, each)
        self.has_values = True
        self._changeable.append((copy.__dict__, _content(copy.__dict__)))
        return copy

    def _class_of(self, kind: type) -> type:
        """Class of copies of a class's objects."""
        if kind in self._classes:
            return self._classes[kind]
        self._classes[kind] = copy_type = type(kind.__name__, (kind,), {"__del__": lambda _: None})
        for base in reversed(kind.__mro__[:-1]):
            for name, each in vars(base).items():
                if name in UNUSED or (name.startswith("__") and not isinstance(each, types.FunctionType)):
                    continue
                if isinstance(each, types.FunctionType | functools._lru_cache_wrapper):
                    setattr(copy_type, name, _Method(each, self))
                elif isinstance(each, property | functools.cached_property):
                    method = each.fget if isinstance(each, property) else each.func
                    setattr(copy_type, name, property(_Method(method, self).function))
                elif isinstance(each, staticmethod | classmethod):
                    setattr(copy_type, name, type(each)(_Refused.unless(self, each.__func__)))      # type: ignore[arg-type]
                else:
                    setattr(copy_type, name, _Refused.unless(self, each))
        return copy_type


class _Method:
    """Method that is copied at its first use, as other methods of its class may not be recordable."""

    def __init__(self, method: Any, outside: Outside) -> None:
        self._method, self._outside = method, outside

    def __get__(self, owner: Any, kind: Any = None) -> Any:
        return types.MethodType(_Refused.unless(self._outside, self._method), owner)    # Python drops errors of the search

    def function(self, owner: Any) -> Any:
        return self._outside.of(self._method)(owner)


class _Refused:
    """Stand-in of an attribute that cannot be copied: every use of it raises Unrecorded."""

    def __init__(self, reason: str) -> None:
        self.__dict__["reason"] = reason

    @classmethod
    def unless(cls, outside: Outside, value: Any) -> Any:
        """Copy of a value, or a stand-in that refuses every use."""
        try:
            return outside.of(value)
        except Unrecorded as error:
            return cls(str(error))

    def __getattr__(self, name: str) -> Any:
        raise Unrecorded(self.__dict__["reason"])

    def _refuse(self, *_: Any, **__: Any) -> Any:
        raise Unrecorded(self.__dict__["reason"])

    __call__ = __getitem__ = __iter__ = __len__ = __bool__ = __add__ = __radd__ = __mul__ = __rmul__ = __sub__ = _refuse
    __rsub__ = __next__ = _refuse
    __truediv__ = __rtruediv__ = __lt__ = __gt__ = __le__ = __ge__ = __eq__ = __contains__ = __pow__ = __neg__ = _refuse
    __hash__ = None     # type: ignore[assignment]


class Module:
    """Stand-in of a module, or of a class that is not called: its names as copies, at use."""

    def __init__(self, module: Any, outside: Outside) -> None:
        self._module, self._outside = module, outside

    def __call__(self, *_: Any, **__: Any) -> Any:
        raise Unrecorded(f"uses {self._module.__module__}.{self._module.__qualname__}")

    def __getattr__(self, name: str) -> Any:
        return self._outside.of(getattr(self._module, name))


class Numpy(Module):
    """Stand-in of NumPy and of numpy.linalg, whose arrays are of objects."""

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._module, name)
        if name.startswith(FILES):
            raise Unrecorded(f"uses np.{name}")
        if isinstance(value, types.ModuleType):
            if value.__name__ != "numpy.linalg":
                raise Unrecorded(f"uses {value.__name__}")
            return self._outside.of(value)
        if name in ASKS:
            return lambda x: getattr(self._module, name)(0.0 if isinstance(x, Quantity) else x)
        if isinstance(value, type):
            return value
        return value if isinstance(value, np.ufunc | float | np.generic) or value is None else _of_numpy(value)


def _of_numpy(given: Callable[..., Any]) -> Callable[..., Any]:
    """Function of NumPy whose arrays of floats are of objects."""
    makes = given.__name__ in ("zeros", "ones", "empty", "full", "array", "asarray", "asanyarray", "zeros_like", "ones_like",
                               "empty_like", "full_like", "eye", "identity")

    @functools.wraps(given, updated=())
    def called(*inputs: Any, **more: Any) -> Any:
        is_default = len(inputs) < 2 or given.__name__.startswith("full")      # else the second argument is the type
        if makes and is_default and more.get("dtype", float) in (float, np.float64, "float", "f8", "d"):
            more = {**more, "dtype": object}
        return of_array(given(*inputs, **more))
    return called


def _checked(code: types.CodeType, free: set[str]) -> list[str]:
    """Names of globals that code reads; code with state, that catches errors or compares identities is refused."""
    found: dict[str, None] = {}
    if code.co_flags & (0x80 | 0x200) or (code.co_flags & 0x20 and code.co_name != "<genexpr>"):     # coroutines, generators
        raise Unrecorded("is a generator")
    last = None
    for each in dis.get_instructions(code):
        if each.opname in HANDLERS:
            raise Unrecorded("has a try or with statement")
        if each.opname in STATE:
            raise Unrecorded(f"{STATE[each.opname]}, {each.argval}" if each.argval else STATE[each.opname])
        if each.opname in ("STORE_DEREF", "DELETE_DEREF") and each.argval in free:
            raise Unrecorded(f"sets the name {each.argval} of another function")
        if each.opname == "IS_OP" and last and (last.opname, last.argval) != ("LOAD_CONST", None) and last.opname != "LOAD_ATTR":
            raise Unrecorded("compares identities by is")
        if each.opname in ("LOAD_GLOBAL", "LOAD_NAME"):
            found[each.argval] = None
        last = each
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            found.update(dict.fromkeys(_checked(constant, set(constant.co_freevars) & free)))
    return [*found]


def _has_methods(kind: type) -> bool:
    """True of a user's class of numbers, tuples or members that has methods, which would not be copies."""
    return any(isinstance(each, types.FunctionType) and each.__module__ == base.__module__ for base in kind.__mro__
               if base.__module__ not in ("enum", "fractions", Table.__module__) for each in vars(base).values())


def _is_hashable(value: Any) -> bool:
    try:
        hash(value)
    except TypeError:
        return False
    return True


def _content(container: Any) -> list[Any]:
    if isinstance(container, np.ndarray):
        return container.tolist() if container.ndim else [container.item()]
    return [each for pair in container.items() for each in pair] if isinstance(container, dict) else list(container)


def _same(one: list[Any], other: list[Any]) -> bool:
    return len(one) == len(other) and all(a is b or (type(a) in (int, float, bool, list) and a == b)
                                          for a, b in zip(one, other, strict=True))


# ---- stand-ins ----

def _of_math(name: str, of: str) -> Callable[..., Any]:
    real = getattr(math, name)

    def recorded(*x: Any) -> Any:
        return UFUNCS[of](*x) if any(isinstance(each, Quantity) for each in x) else real(*x)
    return recorded


def _log(x: Any, base: Any = math.e) -> Any:
    if not (isinstance(x, Quantity) or isinstance(base, Quantity)):
        return math.log(x, base) if base != math.e else math.log(x)
    numerator = function("log", x) if isinstance(x, Quantity) else math.log(x)
    if base == math.e if not isinstance(base, Quantity) else False:
        return numerator
    return numerator / (function("log", base) if isinstance(base, Quantity) else math.log(base))


def _hypot(*x: Any) -> Any:
    if not any(isinstance(each, Quantity) for each in x):
        return math.hypot(*x)
    return abs(x[0]) if len(x) == 1 else functools.reduce(UFUNCS["hypot"], x)


def _extreme(real: Callable[..., Any], of: Callable[..., Any]) -> Callable[..., Any]:
    def extreme(*x: Any, **more: Any) -> Any:
        values = list(x[0]) if len(x) == 1 else x
        return real(values, **more) if more or not any(isinstance(each, Quantity) for each in values) else of(*values)
    return extreme


def _as_float(real: Callable[..., Any]) -> Callable[..., Any]:
    """Function that checks a type; a quantity counts as a float."""
    return lambda x, *more: real(1.5 if isinstance(x, Quantity) else x, *more)


class _Class(type):
    """Stand-in of a class that is called with quantities, which are floats to it."""

    real: type
    of: Callable[[Any], Any]

    def __call__(cls, *x: Any) -> Any:
        return cls.of(x[0]) if len(x) == 1 and isinstance(x[0], Quantity) else cls.real(*x)

    def __instancecheck__(cls, x: Any) -> bool:
        return isinstance(x, cls.real)


def _class(real: type, of: Callable[[Any], Any]) -> Any:
    return _Class(real.__name__, (), {"real": real, "of": staticmethod(of)})


MATH = IN_NUMPY | {"pow": "power"} | {name: name for name in (
    "cbrt", "copysign", "erf", "erfc", "degrees", "exp2", "fabs", "fmod", "isfinite", "isinf", "isnan", "radians", "sqrt")}
STAND_INS: dict[Any, Any] = {
    getattr(math, name): _of_math(name, of) for name, of in MATH.items() if hasattr(math, name)}
STAND_INS |= {math.log: _log, math.hypot: _hypot, max: _extreme(max, largest), min: _extreme(min, smallest),
              isinstance: _as_float(isinstance), hasattr: _as_float(hasattr), type: _class(type, lambda x: STAND_INS[float]),
              float: _class(float, lambda x: x * 1),
              math.fsum: sum, math.floor: math.floor, math.ceil: math.ceil, math.trunc: math.trunc}
