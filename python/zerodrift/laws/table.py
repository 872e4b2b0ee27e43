"""User functions from data: piecewise cubics, that is splines, lines, steps, and sums of products of these on a grid."""

from __future__ import annotations

import csv
import functools
import inspect
import math
from pathlib import Path
from typing import Any

import numpy as np

from .._private import checks
from .._private.gateway.compiled import programs
from .._private.types import ArrayLike
from ..errors import WrongType, WrongValue
from ..symbolics.graph.plain_functions import SPLINE
from ..systems import autodiff
from . import splines

END_ROUNDING = 1e-9     # of the table's length: rounding beyond its ends that is accepted; of the largest value or slope: no jump
BEND = 1e-3             # of the largest difference of values: change of the third derivative times the cube of a piece's length
KINDS, BEYOND = ("smooth", "linear", "steps"), ("error", "hold", "line", "period")
ERROR, CONTINUES, REPEATS = programs.BEYOND


def table(x: ArrayLike | tuple[ArrayLike, ArrayLike], y: ArrayLike | None = None, *, argument: str | tuple[str, str] = "t",
          beyond: str = "error", kind: str = "smooth", noise: float | None = None) -> Table:
    """A function through measured data, for prescribed motions and for forces.

    Parameters
    ----------
    x, y : array_like (n,)
        The data, at least two points; x increases. In the units of the law's argument and value: s, m, rad, N, N m.
        Instead of both, the path of a CSV file of two columns, ``zd.table("data.csv")``; its first line may name them.
        On a grid x is a tuple of two arrays, (n,) and (k,), and y has shape (n, k).
    argument : str
        The name of x as the law has it: "t", or for a force the name in its ``of``; on a grid a tuple of two names.
    beyond : {"error", "hold", "line", "period"}
        Values beyond the ends. "error": a motion beyond the table ends with an error, see Notes; "hold": the last value;
        "line": the straight line with the last slope; "period": the table repeats, and its first and last values must be
        equal or, for angles, differ by whole turns, which are added at each period.
    kind : {"smooth", "linear", "steps"}
        "smooth": the cubic spline, with continuous first and second derivatives, and a continuous third one at the second and
        the last but one point (not-a-knot, as SciPy's ``CubicSpline``); through two or three points the straight line or the
        parabola. "linear": straight lines. "steps": each value holds from its point to the next.
    noise : float, optional
        Standard deviation of y, in its unit: the natural spline of least curvature whose mean squared distance from y is
        noise**2, or the best straight line if that is not farther. Only for kind "smooth", without a period.

    Returns
    -------
    callable
        For any argument of a mechanism that may be a function; it has its own derivatives. It prints its kind and the
        smoothing parameter, which is the weight of the integral of the squared second derivative beside the sum of squared
        distances.

    Raises
    ------
    ValueError, TypeError
        If x does not increase, or sizes differ, or a value is not finite, or a file does not have two columns of numbers; if the
        ends of a period differ. A prescribed position, angle or length, a coupler, a constraint and a cam refuse tables by
        which their speed jumps: kinds "linear" and "steps", and "hold" where the slope at an end is not zero. A prescribed speed
        refuses "steps".

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
    >>> zd.table([0.0, 25.0, 50.0], [4.0, 3.0, 0.0], argument="w", kind="linear", beyond="hold")
    <table of 3 points, w = 0 ... 50, linear, hold>

    Notes
    -----
    With ``beyond="error"`` the end of a step must be within the ends of the table, up to ten times the tolerance of the step and
    1e-9 of the table's length. Trial stages of a step may be beyond: the first and the last piece are continued there.
    """
    checks.choice("beyond", beyond, BEYOND)
    checks.choice("kind", kind, KINDS)
    if noise is not None and (kind != "smooth" or beyond == "period" or isinstance(x, tuple)):
        raise WrongValue('noise of a table must be left out on a grid, and where kind is not "smooth" or beyond is "period"',
                         "conflicting-arguments")
    if isinstance(x, str | Path):
        if y is not None:
            raise WrongType("y of a table must be left out where x is the path of a file", "conflicting-arguments")
        x, y = _read(Path(x))
    elif y is None:
        raise WrongType(f"a table must have x and y, or the path of a CSV file, not {type(x).__name__} alone")
    names: Any = argument if isinstance(x, tuple) else (argument,)
    arrays = x if isinstance(x, tuple) else (x,)
    axes = [_increasing("x", each) for each in arrays]
    if not len(names) == len(axes) <= 2:
        raise WrongValue("a table on a grid must have a tuple of two arrays x, and one of two names, argument", "shape")
    sides, weight = _sides(axes, y), math.inf
    if noise is not None:
        pieces, weight = splines.smoothed(axes[0], sides[0][0], checks.number("noise", noise, above=0.0))
        products = [[Spline(_with_ends(axes[0], pieces, kind, beyond), names[0])]]
    else:
        products = [[Spline(_with_ends(at, _pieces(at, values, kind, beyond), kind, beyond), name)
                     for at, values, name in zip(axes, product, names, strict=True)] for product in zip(*sides, strict=True)]
    spans = [f"{name} = {at[0]:g} ... {at[-1]:g}" for name, at in zip(names, axes, strict=True)]
    words = [word for word in (kind, beyond) if word not in ("smooth", "error")]
    words += [] if noise is None else [f"smoothing parameter {weight:.6g}"]
    return Table(products, ", ".join([f"{' x '.join(str(at.size) for at in axes)} points", *spans, *words]))


def _increasing(name: str, x: Any) -> np.ndarray:
    x = np.array(checks.real(f"{name} of a table must hold", x), dtype=float)
    if x.ndim != 1 or x.size < 2:
        raise WrongValue(f"{name} of a table must have shape (n,) with n at least 2, not {x.shape}", "shape")
    for place in np.flatnonzero(~(np.diff(x) > 0)):
        raise WrongValue(f"{name} of a table must increase, and {name}[{place + 1}] = {x[place + 1]:g} follows {name}[{place}] = "
                         f"{x[place]:g}", "not-increasing")
    return x


def _sides(axes: list[np.ndarray], y: Any) -> list[np.ndarray]:
    """Values along each axis, whose products add up to y: singular vectors, as splines are linear in what they interpolate."""
    if len(axes) == 1:
        return [checks.vector("y of a table", y, axes[0].size)[None]]
    z, shape = np.array(checks.real("y of a table must hold", y), dtype=float), tuple(at.size for at in axes)
    if z.shape != shape or not np.isfinite(z).all():
        raise WrongValue(f"y of a table on a grid must be finite, of shape {shape}, not {z.shape}", "shape")
    left, sizes, right = np.linalg.svd(z, full_matrices=False)
    rank = max(1, int((sizes > np.finfo(float).eps * sizes[0]).sum()))
    return [(left * sizes).T[:rank], right[:rank]]


def _pieces(x: np.ndarray, y: np.ndarray, kind: str, beyond: str) -> np.ndarray:
    """Coefficients (4, n) of the pieces, as of `splines`."""
    if kind == "smooth":
        return splines.interpolating(x, y, repeats=beyond == "period")
    zero, steps = np.zeros(x.size), np.diff(y) / np.diff(x)
    return np.array([zero, zero, zero if kind == "steps" else np.append(steps, steps[-1]), y])


def _with_ends(x: np.ndarray, pieces: np.ndarray, kind: str, beyond: str) -> np.ndarray:
    """The core's numbers (n, 5) of a `zd_spline`: what holds or goes on as a line is one more piece on each side."""
    rows, change = np.column_stack([x, pieces.T]), 0.0
    if beyond == "period":
        (first, last), turn = pieces[3, [0, -1]], 2 * np.pi
        change = turn * round((last - first) / turn)
        if abs(last - first - change) > END_ROUNDING * (1 + np.abs(pieces[3]).max()):
            raise WrongValue("a table that repeats must have equal values at both ends, or angles that differ by turns, "
                             f"not {first:g} and {last:g}", "out-of-range")
    if beyond == "period" or (beyond == "error" and kind != "steps"):
        rows[-1, 1:] = REPEATS if beyond == "period" else ERROR, 0.0, 0.0, change
        return rows
    if beyond == "error":       # the last value holds to a new end
        return np.vstack([rows, [x[-1] + END_ROUNDING * (x[-1] - x[0]), ERROR, 0.0, 0.0, 0.0]])
    if beyond == "hold":
        rows[-1, 3] = 0.0
    h, value, slope = x[1] - x[0], rows[0, 4], 0.0 if beyond == "hold" else rows[0, 3]
    return np.vstack([[x[0] - h, 0.0, 0.0, slope, value - slope * h], rows, [2 * x[-1] - x[-2], CONTINUES, 0.0, 0.0, 0.0]])


def _read(path: Path) -> np.ndarray:
    """The two columns of a CSV file; the first line is a heading if it has no number."""
    with path.open(newline="", encoding="utf-8-sig") as file:
        lines = [(number, line) for number, line in enumerate(csv.reader(file), 1) if any(map(str.strip, line))]
    if lines and not any(_is_number(entry) for entry in lines[0][1]):
        del lines[0]
    for number, line in lines:
        if len(line) != 2 or not all(map(_is_number, line)):
            raise WrongValue(f"a table's file must have two numbers in each line, separated by a comma; line {number} of "
                             f"{path} is {','.join(line)!r}", "unreadable-file")
    return np.array([line for _, line in lines], dtype=float).reshape(-1, 2).T


def _is_number(entry: str) -> bool:
    try:
        float(entry)
    except ValueError:
        return False
    return True


class Spline:
    """Piecewise cubic of one argument; `knots` (n, 5) are the core's numbers of a `zd_spline`."""

    def __init__(self, knots: np.ndarray, argument: str) -> None:
        self.knots, self.argument = knots, checks.instance("argument", argument, str, "a name")

    def __call__(self, at: Any) -> Any:
        if hasattr(at, "sheet"):     # while a function that reads the table is recorded
            return at.read(self)
        value, (first, last), allowed = float(autodiff.value(at)), self.knots[[0, -1], 0], END_ROUNDING * np.ptp(self.knots[:, 0])
        if self.knots[-1, 1] == ERROR and not first - allowed <= value <= last + allowed:
            raise WrongValue(f"the table goes from {self.argument} = {first:g} to {last:g}, and its value at {value:.12g} was "
                             'requested: add points beyond its ends, or give beyond="hold", "line" or "period"', "out-of-range")
        found = programs.spline_at(self.address, value)
        return at._chain(*found) if isinstance(at, autodiff.Jet) else found[0]

    @property
    def x(self) -> np.ndarray:
        """Abscissas of its knots."""
        return self.knots[:, 0]

    def _jumps(self, derivatives: int) -> np.ndarray:
        """True for each point after the first where its value or, with 1, its slope jumps."""
        x, (cubic, square, slope, value) = self.knots[:, 0], self.knots[:-1, 1:].T
        h = np.diff(x)
        ends = np.array([((cubic * h + square) * h + slope) * h + value, (3 * cubic * h + 2 * square) * h + slope])
        starts = np.array([[*value[1:], value[0] + self.knots[-1, 4]], [*slope[1:], slope[0]]])
        if self.knots[-1, 1] != REPEATS:
            starts[:, -1] = ends[:, -1]
        sizes = np.abs(np.array([starts, ends, [value, (ends[0] - value) / h]])).max(axis=(0, 2))
        return (np.abs(starts - ends) > END_ROUNDING * sizes[:, None])[:derivatives + 1].any(axis=0)

    def jump(self, derivatives: int) -> float | None:
        """The first argument where its value or, with 1, its slope jumps; None: nowhere."""
        found = np.flatnonzero(self._jumps(derivatives))
        return float(self.x[found[0] + 1]) if found.size else None

    def breaks(self) -> tuple[np.ndarray, float]:
        """Arguments where it jumps, or bends by more than `BEND` within a piece, and its period, 0 without one."""
        x, cubic, value, repeats = self.x, self.knots[:-1, 1], self.knots[:-1, 4], self.knots[-1, 1] == REPEATS
        h, following = np.diff(x), np.append(cubic[1:], cubic[0] if repeats else cubic[-1])
        bends = np.abs(following - cubic) * np.maximum(h, np.append(h[1:], h[0])) ** 3 > BEND * np.ptp(value)
        return x[1:][self._jumps(1) | bends], float(x[-1] - x[0]) if repeats else 0.0

    def to_json(self) -> dict[str, Any]:
        """Its data in a file, which `spline_from_json` reads."""
        return {"argument": self.argument, "knots": self.knots.tolist()}

    @functools.cached_property
    def _spline(self) -> Any:
        return programs.spline(self.knots)

    @property
    def address(self) -> float:
        """The number that stands for it in programs, as long as it lives."""
        return programs.address(self._spline)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "_spline"}


class Table:
    """Sum of products of splines: a single one, or of each argument one."""

    written_as: Any = None      # form in files, if it has its own

    def __init__(self, products: list[list[Spline]], said: str) -> None:
        (first, *_), self.products, self.said = products, products, said
        self.__signature__ = inspect.Signature([inspect.Parameter(each.argument, inspect.Parameter.POSITIONAL_OR_KEYWORD)
                                                for each in first])

    def _at(self, given: Any, named: Any) -> dict[str, Any]:
        return {**dict(zip(self.__signature__.parameters, given, strict=False)), **named}

    def __call__(self, *given: Any, **named: Any) -> Any:
        at = self._at(given, named)
        return sum(math.prod(each(at[each.argument]) for each in product) for product in self.products)

    def written(self, equations: Any, *given: Any, **named: Any) -> Any:
        """Node of its value."""
        graph, at = equations.graph, self._at(given, named)
        return graph.sum((functools.reduce(graph.times, (graph.call(SPLINE, equations.spline(each), at[each.argument], graph.zero)
                                                         for each in product)), 1) for product in self.products)

    @property
    def tables(self) -> list[Spline]:
        """All splines that it is computed from."""
        return [each for product in self.products for each in product]

    def to_json(self) -> dict[str, Any]:
        """Its data in a file, which `from_json` reads."""
        return {"said": self.said, "arguments": list(self.__signature__.parameters),
                "products": [[each.knots.tolist() for each in product] for product in self.products]}

    def __repr__(self) -> str:
        return f"<table of {self.said}>"


def spline_from_json(given: Any) -> Spline:
    """The spline of a file; errors are of type ValueError and TypeError."""
    given = dict(given)
    knots = np.array(given.get("knots"), dtype=float)
    _increasing("knots", checks.vector("knots", knots.ravel(), knots.size).reshape(-1, 5)[:, 0])
    return Spline(knots.reshape(-1, 5), given.get("argument", ""))


def from_json(given: Any) -> Table:
    """The table of a file; errors are of type ValueError and TypeError."""
    given = dict(given)
    made = Table([[Spline(np.array(knots, dtype=float).reshape(-1, 5), name) for knots, name in
                   zip(product, given.get("arguments", ()), strict=True)] for product in given.get("products", ())],
                 str(given.get("said")))
    for each in made.tables:
        _increasing("knots", checks.vector("knots", each.knots.ravel(), each.knots.size).reshape(-1, 5)[:, 0])
    return made


def recognised(given: Any) -> Any:
    """Table of t from a spline of SciPy; anything else unchanged."""
    if type(given).__module__.startswith("scipy.interpolate") and hasattr(given, "c") and hasattr(given, "x"):
        x, c = np.asarray(given.x, dtype=float), np.asarray(given.c, dtype=float)
        if c.ndim == 2 and len(c) <= 4 and c.shape[1] == x.size - 1:
            pieces = np.zeros((4, x.size))
            pieces[4 - len(c):, :-1] = c
            return Table([[Spline(_with_ends(x, pieces, "smooth", "error"), "t")]],
                         f"{x.size} points, t = {x[0]:g} ... {x[-1]:g}")
    return given
