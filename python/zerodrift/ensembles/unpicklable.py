"""`unpicklable`: name of the function that prevents an object from being pickled."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from types import CodeType, FunctionType, MethodType
from typing import Any

from .._private import checks
from .runs import named


def unpicklable(what: Any, fits: Callable[[Any], bool]) -> str:
    """Beginning of an error: the innermost function that refers to the first part of an object with `fits` false; "" if none."""
    path, known = [what], {id(what): what}
    while (part := next((each for each in _parts(path[-1]) if id(each) not in known and not fits(each)), known)) is not known:
        path.append(part)
        known[id(part)] = part      # the object, too: else another may get its address
    functions = [each for each in path if callable(each) and not isinstance(each, type)]
    if not functions:
        return ""
    reason = "" if functions[-1] is path[-1] else f" refers to {checks.shown(path[-1])}"
    return f"{_named(functions[-1])}{reason}: "


def _named(function: Any) -> str:
    module = getattr(function, "__module__", None)
    return f"{named(function)} of {module}" if module and hasattr(function, "__qualname__") else named(function)


def _parts(what: Any) -> Iterator[Any]:
    """Objects that an object consists of or refers to."""
    match what:
        case dict():
            yield from what.values()
        case list() | tuple() | set() | frozenset():
            yield from what
        case functools.partial():
            yield from (what.func, what.args, what.keywords)
        case MethodType():
            yield from (what.__self__, what.__func__)
        case FunctionType():
            yield from _referred(what)
        case _:
            yield from _reduced(what)


def _referred(function: FunctionType) -> Iterator[Any]:
    """Values that a function closes over, its defaults, and the global variables that it reads."""
    for cell in function.__closure__ or ():
        try:
            yield cell.cell_contents
        except ValueError:      # a name that has no value yet
            continue
    yield from (function.__defaults__, function.__kwdefaults__)
    yield from (function.__globals__[name] for name in _names(function.__code__) if name in function.__globals__)


def _names(code: CodeType) -> list[str]:
    """Names that code reads, and the code of functions within it."""
    return [*code.co_names, *(name for each in code.co_consts if isinstance(each, CodeType) for name in _names(each))]


def _reduced(what: Any) -> Iterator[Any]:
    """Objects from which unpickling would recreate an object."""
    try:
        reduced = what.__reduce_ex__(4)
    except Exception:       # of any object
        return
    if isinstance(reduced, tuple):
        _, arguments, state, items, pairs, *_ = (*reduced, None, None, None, None)
        yield from (arguments, state, list(items or ()), dict(pairs or ()))
