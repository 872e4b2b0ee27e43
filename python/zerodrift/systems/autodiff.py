"""Forward-mode automatic differentiation, for exact Jacobians and accelerations of constraints written in NumPy.

A `Jet` holds a value, its gradient, and its first and second derivative along a curve. NumPy's functions accept arrays of such
objects: they call the method of their own name on each entry. So one evaluation of the constraints gives Phi, dPhi/dp, dPhi/dt
and, along the motion, the right side of (6).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ..errors import WrongType


class Jet:
    """x with gradient dx/dy (k,), and x', x'' along a curve; without gradient x may be an array, of values at several times."""

    __slots__ = ("first", "gradient", "second", "value")

    def __init__(self, value: float, gradient: Any = 0.0, first: float = 0.0, second: float = 0.0) -> None:
        self.value, self.gradient, self.first, self.second = value, gradient, first, second

    log: Callable[[], Jet]      # as other functions of one argument, below
    exp: Callable[[], Jet]

    def _chain(self, value: float, slope: float, curvature: float) -> Jet:
        """phi(x) from phi, phi', phi'' at x.

        Where phi'' is infinite and x' = 0, as of x**1.5 at the 0 of x = y**2, x is at an end of what phi takes, and phi'' does
        not enter: |y|**3 has a second derivative.
        """
        bend = curvature * self.first**2 if isinstance(self.first, np.ndarray) or self.first else 0.0
        return Jet(value, slope * self.gradient, slope * self.first, bend + slope * self.second)

    def __add__(self, other: Any) -> Jet:
        if isinstance(other, np.ndarray):
            return NotImplemented       # so that the array does it entry by entry
        if isinstance(other, Jet):
            return Jet(self.value + other.value, self.gradient + other.gradient, self.first + other.first,
                       self.second + other.second)
        return Jet(self.value + other, self.gradient, self.first, self.second)

    __radd__ = __add__

    def __neg__(self) -> Jet:
        return Jet(-self.value, -self.gradient, -self.first, -self.second)

    def __pos__(self) -> Jet:
        return self

    def __sub__(self, other: Any) -> Jet:
        return NotImplemented if isinstance(other, np.ndarray) else self + -other

    def __rsub__(self, other: Any) -> Jet:
        return -self + other

    def __mul__(self, other: Any) -> Jet:
        if isinstance(other, np.ndarray):
            return NotImplemented       # so that the array does it entry by entry
        if isinstance(other, Jet):
            return Jet(self.value * other.value, self.gradient * other.value + self.value * other.gradient,
                       self.first * other.value + self.value * other.first,
                       self.second * other.value + 2 * self.first * other.first + self.value * other.second)
        return Jet(self.value * other, self.gradient * other, self.first * other, self.second * other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Jet:
        if isinstance(other, np.ndarray):
            return NotImplemented       # so that the array does it entry by entry
        return self * (other.reciprocal() if isinstance(other, Jet) else 1 / other)

    def __rtruediv__(self, other: Any) -> Jet:
        return self.reciprocal() * other

    def reciprocal(self) -> Jet:
        r = _power(self.value, -1)
        return self._chain(r, -r * r, 2 * r * r * r)

    def __pow__(self, n: Any) -> Jet:
        if isinstance(n, np.ndarray):
            return NotImplemented       # so that the array does it entry by entry
        if isinstance(n, Jet):
            return (self.log() * n).exp()
        if n == 0:
            return Jet(1.0, 0.0 * self.gradient)
        if n == 1:
            return self
        x = self.value
        curvature = n * (n - 1) * (_power(x, n - 2) if n != 2 else 1.0)
        return self._chain(_power(x, n), n * _power(x, n - 1), curvature)

    def __rpow__(self, base: float) -> Jet:
        return (self * Jet(base).log().value).exp()

    def __abs__(self) -> Jet:
        return self if self.value >= 0 else -self

    def arctan2(self, x: Any) -> Jet:
        """The angle of the point (x, self)."""
        other: Any = x if isinstance(x, Jet) else Jet(x)
        ratio = (self / other).arctan() if abs(other.value) >= abs(self.value) else -(other / self).arctan()
        return Jet(math.atan2(self.value, other.value), ratio.gradient, ratio.first, ratio.second)

    def hypot(self, other: Any) -> Jet:
        return (self * self + other * other).sqrt()

    def conjugate(self) -> Jet:
        return self

    def __float__(self) -> float:
        raise WrongType("a function that is differentiated must not convert its values to plain numbers: use NumPy's functions "
                        "instead of math's, and np.array or np.stack instead of filling an array; the constraints of a zd.System "
                        "need neither if jacobian and xi are given", "user-function")

    # Comparisons look at the value, so that branches work.
    def __lt__(self, other: Any) -> bool:
        return self.value < value(other)

    def __le__(self, other: Any) -> bool:
        return self.value <= value(other)

    def __gt__(self, other: Any) -> bool:
        return self.value > value(other)

    def __ge__(self, other: Any) -> bool:
        return self.value >= value(other)

    def __eq__(self, other: Any) -> bool:
        return self.value == value(other)

    def __ne__(self, other: Any) -> bool:
        return self.value != value(other)

    def __repr__(self) -> str:
        return f"Jet({self.value}, {self.gradient}, {self.first}, {self.second})"


def _unary(name: str, phi: Callable[[float], float], slopes: Callable[[Any, Any, Any], tuple[Any, Any]]) -> Callable[[Jet], Jet]:
    """The method of a function. Where Python raises an error, the value is NumPy's, and there are no derivatives."""
    of_arrays = getattr(np, name)

    def method(self: Jet) -> Jet:
        x = self.value
        if isinstance(x, np.ndarray):
            return self._chain(y := of_arrays(x), *slopes(x, y, np))
        try:
            return self._chain(y := phi(x), *slopes(x, y, math))
        except (ValueError, ZeroDivisionError, OverflowError):
            with np.errstate(all="ignore"):
                return self._chain(float(of_arrays(x)), math.nan, math.nan)
    return method


def _power(x: float, n: float) -> float:
    """x**n as NumPy has it: no error at 0, no complex numbers below, infinite where it is too large."""
    try:
        y = x ** float(n)
    except (ZeroDivisionError, OverflowError):
        return math.inf
    return math.nan if isinstance(y, complex) else y


# phi, and phi', phi'' from x, phi(x) and the functions of math or NumPy, by the name NumPy calls
FUNCTIONS: dict[str, tuple[Callable[[float], float], Callable[[Any, Any, Any], tuple[Any, Any]]]] = {
    "sin": (math.sin, lambda x, y, of: (of.cos(x), -y)),
    "cos": (math.cos, lambda x, y, of: (-of.sin(x), -y)),
    "tan": (math.tan, lambda x, y, of: (1 + y * y, 2 * y * (1 + y * y))),
    "arcsin": (math.asin, lambda x, y, of: ((1 - x * x) ** -0.5, x * (1 - x * x) ** -1.5)),
    "arccos": (math.acos, lambda x, y, of: (-((1 - x * x) ** -0.5), -x * (1 - x * x) ** -1.5)),
    "arctan": (math.atan, lambda x, y, of: (1 / (1 + x * x), -2 * x / (1 + x * x) ** 2)),
    "sinh": (math.sinh, lambda x, y, of: (of.cosh(x), y)),
    "cosh": (math.cosh, lambda x, y, of: (of.sinh(x), y)),
    "tanh": (math.tanh, lambda x, y, of: (1 - y * y, -2 * y * (1 - y * y))),
    "arcsinh": (math.asinh, lambda x, y, of: ((1 + x * x) ** -0.5, -x * (1 + x * x) ** -1.5)),
    "arccosh": (math.acosh, lambda x, y, of: ((x * x - 1) ** -0.5, -x * (x * x - 1) ** -1.5)),
    "arctanh": (math.atanh, lambda x, y, of: (1 / (1 - x * x), 2 * x / (1 - x * x) ** 2)),
    "exp": (math.exp, lambda x, y, of: (y, y)),
    "expm1": (math.expm1, lambda x, y, of: (of.exp(x), of.exp(x))),
    "log": (math.log, lambda x, y, of: (1 / x, -1 / (x * x))),
    "log1p": (math.log1p, lambda x, y, of: (1 / (1 + x), -1 / (1 + x) ** 2)),
    "log2": (math.log2, lambda x, y, of: (1 / (x * math.log(2)), -1 / (x * x * math.log(2)))),
    "log10": (math.log10, lambda x, y, of: (1 / (x * math.log(10)), -1 / (x * x * math.log(10)))),
    "sqrt": (math.sqrt, lambda x, y, of: (0.5 / y, -0.25 / (y * x))),
    "cbrt": (math.cbrt, lambda x, y, of: (y / (3 * x), -2 * y / (9 * x * x))),
    "radians": (math.radians, lambda x, y, of: (math.pi / 180, 0.0)),
    "degrees": (math.degrees, lambda x, y, of: (180 / math.pi, 0.0)),
}
FUNCTIONS |= {"deg2rad": FUNCTIONS["radians"], "rad2deg": FUNCTIONS["degrees"]}
for _name, _phi in FUNCTIONS.items():
    setattr(Jet, _name, _unary(_name, *_phi))


def value(x: Any) -> Any:
    """Value of a jet or number."""
    return x.value if isinstance(x, Jet) else x


def numbers(array: np.ndarray) -> np.ndarray:
    """An array of objects with the numbers themselves in place of jets."""
    out = np.empty(array.shape, dtype=object)
    for index in np.ndindex(array.shape):
        out[index] = value(array[index])
    return out


def seeds(values: Any, first: Any = None, second: Any = None, gradient: Any = None) -> np.ndarray:
    """An array (n,) of jets; `gradient` (n, k) are their gradients."""
    n = len(values)
    first = np.zeros(n) if first is None else first
    second = np.zeros(n) if second is None else second
    jets = np.empty(n, dtype=object)
    for i in range(n):
        jets[i] = Jet(float(values[i]), 0.0 if gradient is None else gradient[i], float(first[i]), float(second[i]))
    jets.flags.writeable = False
    return jets


def part(array: Any, name: str, size: int | None = None) -> np.ndarray:
    """A given part of all jets of an array, (...,), or (..., size) for gradients; zero derivatives for plain numbers."""
    array = np.asarray(array, dtype=object)
    out = np.zeros(array.shape if size is None else (*array.shape, size))
    for index in np.ndindex(array.shape):
        if isinstance(array[index], Jet):
            out[index] = getattr(array[index], name)
        elif name == "value":
            out[index] = array[index]
    return out
