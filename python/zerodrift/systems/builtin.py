"""Systems of the core's table, and the functions in `zerodrift.systems` that make them."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._private import checks, gateway
from .._private.gateway.compiled.precise import Precise
from ..errors import WrongType, WrongValue
from .base import BaseSystem
from .exact_numbers import HELD_AT_START, exact_numbers, exact_start
from .parameter_tables import NumberTables, not_finite, refusals

_KINDS = gateway.kinds()


class SystemOfKind(BaseSystem):
    """A system of a kind that C code describes, with its parameters."""

    def __init__(self, kind: gateway.Kind, parameters: dict[str, Any]) -> None:
        name = kind.card.name
        unknown = set(parameters) - {parameter.name for parameter in kind.parameters}
        if unknown:
            known = ", ".join(parameter.name for parameter in kind.parameters)
            raise WrongType(f"{name} has no parameter {sorted(unknown)[0]!r}; it has {known}", "wrong-name")
        self._kind = kind
        values = [_as_numbers(parameter, parameters.get(parameter.name)) for parameter in kind.parameters]
        self._core, self.p0, self.v0 = kind.make(np.concatenate([*values, []]))
        self.p0.flags.writeable = self.v0.flags.writeable = False
        self.name, self.parameters = name, {p.name: _as_given(p, v) for p, v in zip(kind.parameters, values, strict=True)}
        self._given = {name: self.parameters[name] for name in parameters}     # as checked: a caller's array may change later
        self.coordinates, self.velocities, self.constraints = kind.coordinates, kind.velocities, kind.constraints

    def points(self, p: ArrayLike) -> np.ndarray | Any:
        """The drawing at p: points (n, 2) or (n, 3) in m, joined by lines where not NaN. None: there is no drawing."""
        return self._kind.draw(self._core, checks.vector("p", p, self.nq))

    @property
    def _has_plain_laws(self) -> bool:
        return True

    def _parameter_units(self) -> dict[str, str]:
        return {parameter.name: parameter.unit for parameter in self._kind.parameters}

    def _number_tables(self, parameters: Mapping[str, np.ndarray], count: int,
                       closed_form: tuple[str, bool] | None = None) -> NumberTables | None:
        if not parameters:
            return NumberTables(self._core, None, self._kind.constants, self.p0, self.v0, {})
        columns, wrong = [], not_finite(parameters, count)
        for parameter in self._kind.parameters:
            own = _as_numbers(parameter, self._given.get(parameter.name))
            given = parameters.get(parameter.name)
            if given is not None and (parameter.rule == "choice" or given.size != count * parameter.size):
                return None
            values = np.broadcast_to(own, (count, own.size)) if given is None else given.reshape(count, parameter.size)
            wrong |= _is_too_small(parameter, values).any(axis=1)
            columns.append(values)
        data, p0, v0, reasons = gateway.tables_of_kind(self._kind, np.ascontiguousarray(np.concatenate(columns, axis=1), float))
        wrong[list(reasons)] = True
        return NumberTables(self._core, data, data.shape[1], p0, v0, refusals(self._with, parameters, wrong))


class BuiltIn(SystemOfKind):
    """A system of the core's table."""

    def __init__(self, kind: str, parameters: dict[str, Any]) -> None:
        super().__init__(_KINDS[kind], parameters)

    def _precise_functions(self, vector: str = "baseline") -> Precise | None:
        return self._kind.precise(exact_numbers(self.name, self.parameters))

    def _exact_start(self) -> tuple[np.ndarray, np.ndarray] | None:
        return exact_start(self.name, self.parameters)

    @property
    def _held_at_start(self) -> tuple[list[int], list[int]]:
        return HELD_AT_START.get(self.name, ([], []))

    def __repr__(self) -> str:
        given = ", ".join(f"{name}={value!r}" for name, value in self._given.items())
        return f"zd.systems.{self.name}({given})"

    def __reduce__(self) -> tuple[Any, ...]:
        return BuiltIn, (self.name, self._given)

    def _with(self, changed: dict[str, Any]) -> BuiltIn:
        return BuiltIn(self.name, self._given | changed)

    def _described(self) -> dict[str, Any]:
        return {**super()._described(), "parameters": self._given}


def _as_numbers(parameter: gateway.Parameter, given: Any) -> np.ndarray:
    """Numbers of a parameter for the core."""
    if given is None:
        return np.array(parameter.initial or [np.nan] * parameter.size, dtype=float)
    if parameter.rule == "choice":
        return np.array([float(parameter.words.index(checks.choice(parameter.name, given, parameter.words)))])
    values = np.array([checks.number(parameter.name, given)]) if parameter.size == 1 else checks.vector(
        parameter.name, given, parameter.size)
    if _is_too_small(parameter, values).any():
        raise WrongValue(f"{parameter.name} must be {parameter.rule}, not {given!r}", "out-of-range")
    return values


def _is_too_small(parameter: gateway.Parameter, values: np.ndarray) -> np.ndarray:
    """Mask of the values that violate the parameter's lower bound; derived values are not checked."""
    return {"positive": values <= 0, "not negative": values < 0}.get(parameter.rule, np.zeros(values.shape, dtype=bool))


def _as_given(parameter: gateway.Parameter, values: np.ndarray) -> Any:
    """Value of a parameter as a user would give it; None if it is derived."""
    if parameter.rule == "choice":
        return parameter.words[int(values[0])]
    if np.isnan(values).any():
        return None
    return float(values[0]) if parameter.size == 1 else tuple(map(float, values))


def _documentation(kind: gateway.Kind) -> str:
    card = kind.card
    description = [*textwrap.wrap(card.description, 100), ""] if card.description else []
    lines = [card.summary, "", *description, "Parameters", "----------"]
    for parameter in kind.parameters:
        shape = "" if parameter.size == 1 else f" ({parameter.size},)"
        if parameter.rule == "choice":
            lines.append(f"{parameter.name} : {{{', '.join(map(repr, parameter.words))}}}")
        else:
            unit = f" in {parameter.unit}" if parameter.unit else ""
            lines.append(f"{parameter.name} : float{shape}{unit}, {parameter.rule}")
        lines += [f"    {parameter.text}"] if parameter.text else []
    named = {"Coordinates p": kind.coordinates, "Velocities v": kind.velocities, "Constraints": kind.constraints}
    for title, variables in named.items():
        lines.append(f"\n{title}: {', '.join(f'{name} [{unit}]' for name, unit in variables) or 'none'}.")
    lines += ["", *textwrap.wrap(f"Source: {card.equations}" + (f"; {card.reference}." if card.reference else "."), 100)]
    return "\n".join(lines)


def _factory(kind: str) -> Any:
    def make(**parameters: Any) -> BuiltIn:
        return BuiltIn(kind, parameters)

    row = _KINDS[kind]
    make.__module__, make.__name__, make.__qualname__ = __package__, kind, kind
    make.__doc__ = _documentation(row)
    defaults = [_as_given(p, _as_numbers(p, None)) for p in row.parameters]
    vars(make)["__signature__"] = inspect.Signature(
        [inspect.Parameter(p.name, inspect.Parameter.KEYWORD_ONLY, default=value)
         for p, value in zip(row.parameters, defaults, strict=True)])
    return make


FACTORIES = {kind: _factory(kind) for kind in _KINDS}
