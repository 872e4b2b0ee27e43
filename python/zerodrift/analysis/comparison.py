"""Derivatives of accelerations by states and parameters, beside differences of accelerations."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..errors import WrongValue, ZerodriftError, sentence
from ..runs.arguments.methods import Projection
from ..runs.states.operations import acceleration, project
from ..systems.base import BaseSystem
from . import differences
from .derivatives import Derivatives, residuals
from .state import State, sizes_of, state
from .tangent import Tangent

TIGHT = Projection(tol=1e-13, max_iterations=50)
REDUNDANT = 1e-9                        # of the largest entry of C: a smaller singular value is rounding
SCALES = (1.0, 1e-2, 1e-4)              # of a parameter: that which is varied by one is refused less often
LARGEST_STEP = 8 * differences.STEPS[0]
JUMP = 100.0                            # times the derivative: a larger change over a short step is none of a smooth function
EXACT = 1e-7                            # relative: agreement of derivatives
SMALL_CHANGE = 1e-2                     # of accelerations: a smaller change by a relative one counts as small
ACCURATE = 1e-10                        # relative error of a difference that is good enough


class Compared(NamedTuple):
    """Comparison of a derivative of vdot with differences.

    `given` (nv,): the derivative; `expected` (nv,): by differences, with the estimated `error`; `small`: lower bound of the size
    by which both are divided.
    """

    given: np.ndarray
    expected: np.ndarray
    error: float
    small: float

    @property
    def size(self) -> float:
        """Largest entry of both, at least `small`."""
        return float(max(np.abs(self.given).max(initial=self.small), np.abs(self.expected).max(initial=self.small)))

    @property
    def is_clear(self) -> bool:
        """Differences are accurate enough to compare with."""
        return self.error <= EXACT * self.size / 10

    @property
    def agrees(self) -> bool:
        """Both are equal, or differences are not accurate enough to tell."""
        return not self.is_clear or bool(np.abs(self.given - self.expected).max(initial=0.0) <= EXACT * self.size)


def derivatives_of_accelerations(system: BaseSystem, t: float, p: np.ndarray, v: np.ndarray,
                                 random: np.random.Generator | None = None) -> list[Compared]:
    """Comparisons of the derivatives of vdot along all tangent directions of a state on the constraints, or along a random one.

    The given one is that of `Derivatives`: from the Jacobian of the system, which Radau's method uses, where it has one,
    otherwise from its residuals. The other one needs nothing but accelerations and projections.

    Raises
    ------
    ZerodriftError
        If a state near this one has no acceleration.
    """
    at = state(system, t, p, v)
    tangent = Tangent(at)
    basis = tangent.basis if random is None else tangent.basis @ random.standard_normal((tangent.basis.shape[1], 1))
    derivatives, found = Derivatives(tangent, *acceleration(system, p, v, t, "augmented")), []
    for column in basis.T if tangent.basis.shape[1] else []:
        dp, dv = np.split(column, [system.nq])

        def along(h: float, dp: np.ndarray = dp, dv: np.ndarray = dv) -> np.ndarray:
            there = project(system, p + h * dp, v + h * dv, t, projection=TIGHT, formulation="augmented")
            return acceleration(system, *there, t, "augmented")[0]

        size = float(sizes_of(at, dp[None], dv[None])[0])
        small = _small(derivatives.vdot) * size
        found.append(Compared(derivatives.of_accelerations(dp, dv), *differences.with_error(along, size, small), small))
    return found


def derivatives_by_parameters(system: BaseSystem, t: float, p: np.ndarray, v: np.ndarray) -> dict[str, Compared | str]:
    """Both derivatives by each parameter that is a number, per its magnitude, or a sentence where they cannot be compared.

    A parameter that stands on a bound is varied to one side. Accelerations are compared in the system's coordinates, which must
    not depend on the parameter themselves, as those of bodies in absolute coordinates do on products of inertia.
    """
    at, moving = state(system, t, p, v), acceleration(system, p, v, t, "augmented")
    derivatives = Derivatives(Tangent(at), *moving)
    is_redundant = len(at.C) > np.linalg.matrix_rank(at.C, tol=REDUNDANT * np.abs(at.C).max(initial=0.0))
    found: dict[str, Compared | str] = {}
    for name, value in system.parameters.items():
        if isinstance(value, (float, np.floating)):
            try:
                both, error = _varied(_Varied(at, moving, name, float(value), is_redundant=bool(is_redundant)))
            except (ValueError, TypeError, ZerodriftError) as refused:
                found[name] = sentence(refused)
                continue
            r, s, expected = np.split(both, [system.nv, system.nv + system.m])
            found[name] = Compared(derivatives.solve(r, s)[0], expected, error, _small(moving[0]))
    return found


def _small(vdot: np.ndarray) -> float:
    """A change of the acceleration that counts as small, per characteristic scale."""
    return SMALL_CHANGE * (1.0 + float(np.abs(vdot).max(initial=0.0)))


class _Varied:
    """Residuals (2), (6) and accelerations at a state, as functions of a relative change of a parameter."""

    def __init__(self, at: State, moving: tuple[np.ndarray, np.ndarray], name: str, value: float, *, is_redundant: bool) -> None:
        self.at, self.moving, self.name, self.value, self.is_redundant = at, moving, name, value, is_redundant

    def __call__(self, h: float) -> np.ndarray:
        """(nv + m + nv,)."""
        at, size = self.at, abs(self.value) or 1.0
        there = state(at.system.with_parameters({self.name: self.value + h * size}), at.t, at.p, at.v)
        if self.is_redundant and h and not np.array_equal(there.C, at.C):
            raise WrongValue("it changes constraints that are redundant, which then contradict each other")
        vdot = acceleration(there.system, at.p, at.v, at.t, "augmented")[0]
        return np.concatenate([residuals(there, *self.moving), vdot])

    def is_allowed(self, h: float) -> bool:
        """The system can be evaluated there."""
        try:
            self(h)
        except (ValueError, TypeError, ZerodriftError):
            return False
        return True


def _varied(along: _Varied) -> tuple[np.ndarray, float]:
    """The derivative to both sides or to one, with smaller steps where larger ones are refused or inaccurate.

    Raises
    ------
    ValueError, TypeError, ZerodriftError
        If nothing else than the value itself is allowed, or coordinates depend on the parameter.
    """
    best, least, small = np.zeros(0), np.inf, _small(along.moving[0])
    for scale in SCALES:
        sides = [side for side in (1.0, -1.0) if along.is_allowed(side * scale * LARGEST_STEP)]
        if not sides:
            continue
        found, error = differences.with_error(along, 1 / scale, small) if len(sides) == 2 else (
            differences.one_sided_with_error(along, 1 / scale, sides[0], small))
        best, least = (found, error) if error < least else (best, least)
        h = sides[0] * scale * differences.STEPS[-1]
        if np.abs(along(h) - along(0.0)).max() > JUMP * abs(h) * np.abs(found).max() + REDUNDANT:
            raise WrongValue("the coordinates themselves depend on it")
        if error <= ACCURATE * np.abs(found).max(initial=small):
            break
    if not best.size:
        along(SCALES[-1] * LARGEST_STEP)        # raises
    return best, least
