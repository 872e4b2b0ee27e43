"""Callables of a user: each is called with the arguments that it names, and its results are checked."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from .._private import checks
from ..errors import WrongType, WrongValue
from . import autodiff

# How to call a callable whose arguments are these of t, p, v. Its parameters are bound beforehand. Each gets views of its own, as
# the shape of an array can be set even where its numbers cannot.
_CALLS: dict[frozenset[str], Callable[..., Any]] = {
    frozenset(""): lambda f, t, p, v: f(),
    frozenset("t"): lambda f, t, p, v: f(t=t),
    frozenset("p"): lambda f, t, p, v: f(p=p.view()),
    frozenset("v"): lambda f, t, p, v: f(v=v.view()),
    frozenset("tp"): lambda f, t, p, v: f(t=t, p=p.view()),
    frozenset("tv"): lambda f, t, p, v: f(t=t, v=v.view()),
    frozenset("pv"): lambda f, t, p, v: f(p=p.view(), v=v.view()),
    frozenset("tpv"): lambda f, t, p, v: f(t=t, p=p.view(), v=v.view()),
}
_DOUBLE = np.dtype(np.float64)


class Function:
    """A callable called with the arguments that it names, or a constant."""

    def __init__(self, name: str, given: Any, parameters: dict[str, Any]) -> None:
        self.name = name
        if callable(given):
            names = arguments(name, given, [*checks.STATE, *parameters])
            bound = {key: _view(parameters[key]) for key in names if key in parameters}
            self.state_arguments = frozenset(names) - frozenset(bound)
            self._function = functools.partial(given, **bound) if bound else given
        else:
            value = checks.frozen(checks.real(f"{name} must be a callable, or", given, objects=True).astype(float))
            self.state_arguments, self._function = frozenset(), lambda: value
        self._call = _CALLS[self.state_arguments]

    def _tell(self, error: BaseException, t: float, how: str = "") -> None:
        checks.tell(error, f"in {self.name}, called at t = {t:g}{how}")

    def value(self, t: float, p: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Result of the user's function, checked to be real; its exceptions get a note with the function and t."""
        try:
            value = self._call(self._function, t, p, v)
        except BaseException as error:
            self._tell(error, t)
            raise
        if type(value) is np.ndarray and value.dtype is _DOUBLE:
            return value
        return checks.real(f"{self.name} must return", value, f" (at t = {t:g})", objects=True)

    def write(self, out: np.ndarray, t: float, p: np.ndarray, v: np.ndarray) -> None:
        """Write the checked value to an array of the core."""
        value = self.value(t, p, v)
        if value.shape != out.shape:
            raise WrongValue(f"{self.name} must return shape {out.shape}, not {value.shape} (at t = {t:g})", "shape")
        out[...] = value

    def evaluate_jets(self, shape: tuple[int, ...], t: Any, p: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Value with derivatives, an array of jets."""
        try:
            returned, where = self._call(self._function, t, p, v), f" (at t = {autodiff.value(t):g})"
        except BaseException as error:
            self._tell(error, autodiff.value(t), " for its derivatives (forward-mode automatic differentiation)")
            raise
        result = np.asarray(returned, dtype=object)
        numbers = returned if checks.is_masked(returned) else autodiff.numbers(result)
        if checks.real(f"{self.name} must return", numbers, where, objects=True).shape != shape:
            raise WrongValue(f"{self.name} must return shape {shape}, not {result.shape}{where}", "shape")
        return result


def _view(value: Any) -> Any:
    return value.view(np.ndarray) if isinstance(value, np.ndarray) else value


def arguments(name: str, given: Callable[..., Any], allowed: list[str], more: str = "") -> list[str]:
    """Names of the arguments that a callable takes, all of them `allowed`; errors list these, and then `more`."""
    wants, there_is = [], f"there is {', '.join(allowed)}{more}"
    for argument in _signature(name, given, there_is):
        if argument.kind in (argument.VAR_POSITIONAL, argument.VAR_KEYWORD):
            raise WrongType(f"{name} has {str(argument)!r}, and must name its arguments; {there_is}", "user-function")
        if argument.name in allowed:
            if argument.kind is argument.POSITIONAL_ONLY:
                raise WrongType(f"{name} takes {argument.name!r} by position only, and must take it by name: leave out the '/'",
                                "user-function")
            wants.append(argument.name)
        elif argument.default is argument.empty:
            raise WrongType(f"{name} has the argument {argument.name!r}; {there_is}", "user-function")
    return wants


def _signature(name: str, given: Callable[..., Any], there_is: str) -> Iterable[inspect.Parameter]:
    try:
        return inspect.signature(given).parameters.values()
    except (TypeError, ValueError) as error:
        raise WrongType(f"{name} must be a function that names its arguments, and {given!r} does not; {there_is}",
                        "user-function") from error
