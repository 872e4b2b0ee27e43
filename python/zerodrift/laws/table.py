"""User functions from measured data: a cubic spline with two continuous derivatives."""

from __future__ import annotations

import csv
import functools
import inspect
from pathlib import Path
from typing import Any

import numpy as np

from .._private import checks
from .._private.gateway.compiled import programs
from .._private.types import ArrayLike
from ..errors import WrongType, WrongValue
from ..symbolics.graph.plain_functions import SPLINE
from ..systems import autodiff

BEYOND = 1e-9       # of the table's length: rounding beyond its ends that is accepted


def table(x: ArrayLike, y: ArrayLike | None = None, *, argument: str = "t") -> Table:
    """A smooth function through measured data, for prescribed motions and for forces.

    The cubic spline with continuous first and second derivatives, and a continuous third one at the second and the last but one
    point (not-a-knot, as SciPy's ``CubicSpline``); through two or three points the straight line or the parabola. A prescribed
    motion has the speed and the acceleration of the spline.

    Parameters
    ----------
    x, y : array_like (n,)
        The data, at least two points; x increases. In the units of what the law takes and gives: s, m, rad, N, N m.
        Instead of both, the path of a CSV file of two columns, ``zd.table("data.csv")``; its first line may name them.
    argument : str
        The name of x as the law has it: "t", or of a force the name in its ``of``.

    Returns
    -------
    callable
        To be given wherever a mechanism takes a function. Beyond its ends it raises ValueError.

    Raises
    ------
    ValueError, TypeError
        If x does not increase, or sizes differ, or a value is not finite, or a file does not have two columns of numbers.

    Examples
    --------
    >>> import numpy as np, zerodrift as zd
    >>> m = zd.Mechanism("crank")
    >>> link = m.link("link", (0, 0), (1, 0), mass=1.0)
    >>> pin = m.revolute("pin", m.ground, link.start)
    >>> t = np.linspace(0, 1, 11)
    >>> drive = m.motor("drive", pin, angle=zd.table(t, 0.2 * t**3))
    >>> sol = zd.simulate(m, 1.0, step=0.01)
    >>> bool(abs(sol["pin.speed"] - 0.6 * sol.t**2).max() < 1e-12)
    True
    """
    if isinstance(x, str | Path):
        if y is not None:
            raise WrongType("y of a table must be left out where x is the path of a file", "conflicting-arguments")
        x, y = _read(Path(x))
    elif y is None:
        raise WrongType(f"a table must have x and y, or the path of a CSV file, not {type(x).__name__} alone")
    x = np.array(checks.real("x of a table must hold", x), dtype=float)
    if x.ndim != 1 or x.size < 2:
        raise WrongValue(f"x of a table must have shape (n,) with n at least 2, not {x.shape}", "shape")
    y = checks.vector("y of a table", y, x.size)
    if not (np.diff(x) > 0).all():
        place = int(np.flatnonzero(~(np.diff(x) > 0))[0])
        raise WrongValue(f"x of a table must increase, and x[{place + 1}] = {x[place + 1]:g} follows x[{place}] = {x[place]:g}",
                         "not-increasing")
    return Table(x, _coefficients(x, y), argument)


def _read(path: Path) -> tuple[list[float], list[float]]:
    """The two columns of a CSV file; the first line is a heading if it has no number."""
    with path.open(newline="", encoding="utf-8-sig") as file:
        lines = [(number, line) for number, line in enumerate(csv.reader(file), 1) if any(map(str.strip, line))]
    if lines and not any(_is_number(entry) for entry in lines[0][1]):
        del lines[0]
    for number, line in lines:
        if len(line) != 2 or not all(map(_is_number, line)):
            raise WrongValue(f"a table's file must have two numbers in each line, separated by a comma; line {number} of "
                             f"{path} is {','.join(line)!r}", "unreadable-file")
    return [float(line[0]) for _, line in lines], [float(line[1]) for _, line in lines]


def _is_number(entry: str) -> bool:
    try:
        float(entry)
    except ValueError:
        return False
    return True


class Table:
    """Piecewise cubic; `coefficients` (4, n - 1) of powers 3, 2, 1, 0 of the distance from the previous point."""

    def __init__(self, x: np.ndarray, coefficients: np.ndarray, argument: str) -> None:
        self.x, self.coefficients, self.argument = x, coefficients, checks.instance("argument", argument, str, "a name")
        self.__signature__ = inspect.Signature([inspect.Parameter(argument, inspect.Parameter.POSITIONAL_OR_KEYWORD)])

    def __call__(self, *given: Any, **named: Any) -> Any:
        at, = (*given, *named.values())
        if hasattr(at, "sheet"):     # while a function that reads the table is recorded
            return at.read(self)
        value = float(autodiff.value(at))
        if not self.x[0] - self._allowed <= value <= self.x[-1] + self._allowed:
            raise WrongValue(f"the table goes from {self.argument} = {self.x[0]:g} to {self.x[-1]:g}, "
                             f"and its value at {value:g} was requested: add points beyond its ends", "out-of-range")
        piece = min(max(int(np.searchsorted(self.x, value, side="right")) - 1, 0), self.x.size - 2)
        s, result = at - float(self.x[piece]), 0.0
        for coefficient in self.coefficients[:, piece]:
            result = result * s + float(coefficient)
        return result

    def written(self, equations: Any, **at: Any) -> Any:
        """Node of its value."""
        graph, (x,) = equations.graph, at.values()
        return graph.call(SPLINE, equations.spline(self), x, graph.zero)

    @property
    def knots(self) -> np.ndarray:
        """The core's numbers (n, 5) of a `zd_spline`."""
        return np.vstack([np.column_stack([self.x[:-1], self.coefficients.T]), [self.x[-1], *[0.0] * 4]])

    @functools.cached_property
    def _spline(self) -> Any:
        return programs.spline(self.knots)

    @property
    def address(self) -> float:
        """The number that stands for it in programs, as long as it lives."""
        return programs.address(self._spline)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "_spline"}

    @property
    def _allowed(self) -> float:
        return BEYOND * (self.x[-1] - self.x[0])

    def __repr__(self) -> str:
        return f"<table of {self.x.size} points, {self.argument} = {self.x[0]:g} ... {self.x[-1]:g}>"


def recognised(given: Any) -> Any:
    """Table of t from a spline of SciPy; anything else unchanged."""
    if type(given).__module__.startswith("scipy.interpolate") and hasattr(given, "c") and hasattr(given, "x"):
        x, c = np.asarray(given.x, dtype=float), np.asarray(given.c, dtype=float)
        if c.ndim == 2 and c.shape[1] == x.size - 1:
            return Table(x, c, "t")
    return given


def _coefficients(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Coefficients (4, n - 1) of the spline, from its slopes at the points."""
    h, steps = np.diff(x), np.diff(y) / np.diff(x)
    slopes = _slopes(h, steps)
    bend = (slopes[:-1] + slopes[1:] - 2 * steps) / h
    return np.array([bend / h, (steps - slopes[:-1]) / h - bend, slopes[:-1], y[:-1]])


def _slopes(h: np.ndarray, steps: np.ndarray) -> np.ndarray:
    """Slopes (n,) that make second derivatives continuous, by elimination of a tridiagonal system."""
    n = h.size + 1
    if n == 2:
        return np.array([steps[0], steps[0]])
    if n == 3:      # a parabola
        middle = (h[1] * steps[0] + h[0] * steps[1]) / (h[0] + h[1])
        return np.array([2 * steps[0] - middle, middle, 2 * steps[1] - middle])
    below, diagonal, above, right = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    below[1:-1], diagonal[1:-1], above[1:-1] = h[1:], 2 * (h[:-1] + h[1:]), h[:-1]
    right[1:-1] = 3 * (h[1:] * steps[:-1] + h[:-1] * steps[1:])
    diagonal[0], above[0], right[0] = _end(h[0], h[1], steps[0], steps[1])
    diagonal[-1], below[-1], right[-1] = _end(h[-1], h[-2], steps[-1], steps[-2])
    for i in range(1, n):
        factor = below[i] / diagonal[i - 1]
        diagonal[i] -= factor * above[i - 1]
        right[i] -= factor * right[i - 1]
    slopes = right / diagonal
    for i in range(n - 2, -1, -1):
        slopes[i] -= above[i] / diagonal[i] * slopes[i + 1]
    return slopes


def _end(h: float, next_h: float, step: float, next_step: float) -> tuple[float, float, float]:
    """Equation at an end in its own slope and the next: the third derivative is continuous at the next point."""
    both = h + next_h
    return next_h, both, ((h + 2 * both) * next_h * step + h**2 * next_step) / both
