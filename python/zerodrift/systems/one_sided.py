"""`OneSided`: a gap that must not be negative, with restitution and dry friction, of systems of one's own."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .._private import checks
from .._private.types import Expression, UserFunction
from ..errors import WrongType, WrongValue
from .user_callables import arguments


@dataclass(frozen=True)
class OneSided:
    """A one-sided constraint of `zerodrift.symbolic` or `zerodrift.System`, as a contact or a stop.

    ``sol[name]`` is its multiplier, minus the contact force, and ``sol["name.slip"]`` minus the friction.

    Parameters
    ----------
    gap : Expr, or callable -> float
        The gap, a function of the coordinates and of time as the constraints of the system are, in m or rad.
    restitution : float
        Coefficient of restitution, 0 to 1.
    slip : Expr, or callable -> (nv,)
        The slip velocity, linear in the velocities: as the nonholonomic constraints of the system are.
    friction : float or (float, float)
        Coefficients of static and sliding friction, or one for both; they need `slip`.

    Raises
    ------
    ValueError, TypeError
        If a number is out of range.

    Examples
    --------
    >>> import sympy as sp, zerodrift as zd
    >>> x, y, vx, vy = sp.symbols("x y vx vy")
    >>> ball = zd.symbolic(
    ...     [x, y], speeds=[vx, vy], kinetic=(vx**2 + vy**2) / 2, potential=9.81 * y, p0=[0.0, 1.0],
    ...     one_sided={"floor": zd.OneSided(y, restitution=0.5, slip=vx, friction=0.3)})
    >>> sol = zd.simulate(ball, 2.0)
    >>> sol.phases[-1].state
    {'floor': 'sticking'}
    """

    gap: Expression | UserFunction
    restitution: float = 0.0
    slip: Expression | UserFunction | None = None
    friction: float | tuple[float, float] = 0.0

    def __post_init__(self) -> None:
        checks.restitution("restitution", self.restitution)
        if self.coefficients[0] and self.slip is None:
            raise WrongValue("friction must be given with slip, the slip velocity", "missing-argument")

    @property
    def coefficients(self) -> tuple[float, float]:
        """Coefficients of static and of sliding friction."""
        return checks.friction("friction", self.friction)


class Switched(NamedTuple):
    """A group of one row of the constraints that switches."""

    name: str
    kind: str           # "one-sided" or "friction"
    first: int          # its row, holonomic ones first
    normal: int         # friction: 1 + index of the group whose force bounds it
    restitution: float
    friction: tuple[float, float]


def checked(given: Mapping[str, OneSided] | None) -> dict[str, OneSided]:
    """The argument `one_sided`."""
    found = {} if given is None else given
    if not isinstance(found, Mapping) or not all(isinstance(each, OneSided) for each in found.values()):
        raise WrongType(f"one_sided must be a dict of names and zd.OneSided, not {checks.shown(given)}")
    return {str(name): each for name, each in found.items()}


def switched(given: Mapping[str, OneSided], variables: Sequence[str], mh: int, mn: int) -> list[Switched]:
    """Groups of a system whose last holonomic constraints, of mh, are the gaps, and whose last nonholonomic ones, of mn, slip.

    `variables` : names of its coordinates and velocities.
    """
    slips = [name for name, each in given.items() if each.slip is not None]
    names = [*variables, *given, *(f"{name}.slip" for name in slips)]
    if twice := [name for name in names[len(variables):] if names.count(name) > 1]:
        raise WrongValue("one_sided must have other names than the coordinates, the velocities and the slip of each other, and "
                         f"has {twice[0]!r}", "duplicate-name")
    groups = [Switched(name, "one-sided", mh - len(given) + i, 0, float(each.restitution), (0.0, 0.0))
              for i, (name, each) in enumerate(given.items())]
    return groups + [Switched(name, "friction", mh + mn - len(slips) + i, 1 + list(given).index(name), 0.0,
                              given[name].coefficients) for i, name in enumerate(slips)]


def together(what: str, given: Any, more: Mapping[str, Any], parameters: Mapping[str, Any]) -> Callable[..., Any] | None:
    """A callable with the rows of `given`, which may be None, and then one for each of `more`."""
    functions = ([] if given is None else [(what, given)]) + [(f"one_sided[{name!r}]", each) for name, each in more.items()]
    if not more:
        return given
    for name, each in more.items():
        if not callable(each):
            raise WrongType(f"gap and slip of {name!r} must be callables, not {checks.shown(each)}", "user-function")
    named = [(each, arguments(name, each, [*checks.STATE, *parameters])) for name, each in functions]
    first = 0 if given is None else 1

    def rows(**values: Any) -> Any:
        found = [each(**{key: values[key] for key in names}) for each, names in named]
        own = [*found[0]] if first else []
        return np.array([*own, *found[first:]])

    wanted = dict.fromkeys(name for _, names in named for name in names)
    rows.__signature__ = inspect.Signature(     # type: ignore[attr-defined]
        [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY) for name in wanted])
    return rows
