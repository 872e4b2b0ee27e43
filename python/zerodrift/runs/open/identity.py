"""Digests that identify a study: of its numbers and settings, and of name, code, defaults and closure of its functions."""

from __future__ import annotations

import copyreg
import functools
import hashlib
import inspect
import sys
from collections.abc import Iterable, Mapping
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np

from ..._private import gateway

LENGTH = 24         # hexadecimal digits of a digest
PLAIN = (type(None), bool, int, float, complex, str, bytes)
CONSTANT = (*PLAIN, FunctionType)
WITH_STATE = ("zerodrift", "sympy", "numpy", "scipy", "functools", "builtins")  # modules whose objects do not change in a run


def version() -> str:
    """Version of the package with the first digits of the fingerprint of the sources of its core."""
    return f"{sys.modules[__package__.partition('.')[0]].__version__} ({gateway.FINGERPRINT[:LENGTH]})"


class Identity:
    """Digests of objects that are equal wherever and whenever the same objects are made.

    An object is what it pickles as, but that functions count by what they do and not by where they are, and that what a
    cached property has found does not count. Values of global variables that functions read are not seen.

    Attributes
    ----------
    functions : dict of str to dict
        For each function met: its name, and the digests of its code, defaults and closure.
    """

    _other_flags = 0        # of code, which do not count

    def __init__(self) -> None:
        self.functions: dict[str, dict[str, str]] = {}
        self._known: dict[int, tuple[str, Any]] = {}        # the object, too: else another may get its address
        self._open: list[int] = []

    def of(self, what: Any) -> str:
        """Digest of an object."""
        if isinstance(what, PLAIN):
            return _digest(type(what).__name__, repr(what))
        if id(what) in self._known:
            return self._known[id(what)][0]
        if id(what) in self._open:          # it is a part of itself
            return _digest("again", str(len(self._open) - self._open.index(id(what))))
        self._open.append(id(what))
        found = _digest(*self._parts(what))
        self._open.pop()
        self._known[id(what)] = found, what
        return found

    def _parts(self, what: Any) -> Iterable[str | bytes]:
        """Byte strings from which the digest of an object is computed."""
        match what:
            case np.ndarray() if what.dtype != object:
                return "array", what.dtype.str, str(what.shape), np.ascontiguousarray(what).tobytes()
            case np.generic():
                return "number", what.dtype.str, what.tobytes()
            case list() | tuple():
                return type(what).__name__, *map(self.of, what)
            case set() | frozenset():
                return "set", *sorted(map(self.of, what))
            case dict():
                return "dict", *(self.of(each) for pair in what.items() for each in pair)
            case FunctionType():
                return self._function(what)
            case MethodType():
                return "method", self.of(what.__self__), self.of(what.__func__)
            case CodeType():
                return self._code(what)
            case type() | BuiltinFunctionType() | ModuleType():
                return "name", _named(what)
            case _:
                return self._object(what)

    def _function(self, what: FunctionType) -> Iterable[str]:
        name = _named(what)
        closure = [cell.cell_contents for cell in what.__closure__ or () if not _is_empty(cell)]
        parts = {"code": self.of(what.__code__), "defaults": self.of((what.__defaults__, what.__kwdefaults__)),
                 "closure": self.of(closure)}
        key, number = name, 1
        while self.functions.get(key, parts) != parts:      # as lambdas of one function have one name
            number += 1
            key = f"{name} ({number})"
        self.functions[key] = parts
        attributes = [self.of(each) for each in sorted(vars(what).items())]     # as an event's direction
        return "function", name, *parts.values(), *attributes

    def _code(self, what: CodeType) -> Iterable[str | bytes]:
        counts = (what.co_argcount, what.co_posonlyargcount, what.co_kwonlyargcount, what.co_flags & ~self._other_flags)
        names = (what.co_names, what.co_varnames, what.co_freevars, what.co_cellvars)
        return "code", what.co_code, str(counts), str(names), self.of(what.co_consts)

    def _object(self, what: Any) -> Iterable[str]:
        reduce = copyreg.dispatch_table.get(type(what))
        reduced = reduce(what) if reduce else what.__reduce_ex__(4)
        if isinstance(reduced, str):
            return "global", reduced
        made, arguments, state, items, pairs = (*reduced, None, None, None)[:5]
        if isinstance(state, dict):
            state = {name: value for name, value in state.items()
                     if not isinstance(getattr(type(what), name, None), functools.cached_property)}
        return "object", _named(made), *map(self.of, (arguments, state, list(items or ()), list(pairs or ())))


class Definition(Identity):
    """Digests of definitions of systems, which are equal in all processes, and while functions and objects of the caller work.

    Functions count by their code, whatever their names, and by constants in their defaults and closures. Objects of the caller
    count by their class and the code of its ``__call__``, as their state may change from call to call.
    """

    _other_flags = inspect.CO_NESTED

    def _function(self, what: FunctionType) -> Iterable[str]:
        closure = [cell.cell_contents for cell in what.__closure__ or () if not _is_empty(cell)]
        values = [*(what.__defaults__ or ()), *(what.__kwdefaults__ or {}).values(), *closure]
        return "function", self.of(what.__code__), *(self.of(each) for each in values if isinstance(each, CONSTANT))

    def _object(self, what: Any) -> Iterable[str]:
        kind = type(what)
        if kind.__module__.partition(".")[0] not in WITH_STATE:
            call = getattr(kind, "__call__", None)      # noqa: B004 - its code, not whether there is any
            return "object", kind.__qualname__, *([self.of(call)] if isinstance(call, FunctionType) else [])
        if kind.__qualname__ == "Dummy":    # of SymPy: numbered anew in each process
            return "symbol", what.name
        depth = len(self._open)
        try:
            return super()._object(what)
        except Exception:       # it has no parts that pickle: its class counts alone
            del self._open[depth:]
            return "object", kind.__qualname__


def _is_empty(cell: Any) -> bool:
    """True if a cell of a closure has no value yet."""
    try:
        return cell.cell_contents is cell       # which no cell contains
    except ValueError:
        return True


def _named(what: Any) -> str:
    module = getattr(what, "__module__", None) or ""
    return f"{module}.{getattr(what, '__qualname__', what.__name__)}".lstrip(".")


def _digest(*parts: str | bytes) -> str:
    """Digest of byte strings, including their number and lengths."""
    whole = hashlib.sha256()
    for part in parts:
        data = part.encode() if isinstance(part, str) else part
        whole.update(f"{len(data)} ".encode() + data)
    return whole.hexdigest()[:LENGTH]


def differences(name: str, then: Any, now: Any) -> list[str]:
    """Descriptions of the differences between two values; dicts are compared by entry."""
    if isinstance(then, Mapping) and isinstance(now, Mapping):
        return [each for key in [*then, *(key for key in now if key not in then)]
                for each in differences(f"{name}[{key!r}]" if name else key, then.get(key), now.get(key))]
    if then == now:
        return []
    return [f"{name} was {_shown(then)} and is {_shown(now)}"]


def _shown(value: Any) -> str:
    return "not there" if value is None else str(value)
