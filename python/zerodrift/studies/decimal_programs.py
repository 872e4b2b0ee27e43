"""Values of a program in decimal arithmetic of 45 digits: measures of a motion that is known beyond double precision."""

from __future__ import annotations

import decimal
import math
from collections.abc import Callable, Sequence
from decimal import Decimal
from typing import Any, NamedTuple

import numpy as np

from ..systems.exact_numbers import turned

DIGITS = 45
Decimals = Sequence[Decimal]


class Program(NamedTuple):
    """Operations of a `Lowering`, the one whose value is wanted, and the parameters (k, 2), pairs of doubles, that they read."""

    lowering: Any
    wanted: int
    parameters: np.ndarray

    def value(self, t: Decimal, p: Decimals, v: Decimals) -> Decimal:
        """Value at a state, in the current decimal context."""
        operations, exact = self.lowering.operations, self.lowering.exact
        leaves = {"t": [t], "p": p, "v": v, "parameter": decimals(self.parameters)}
        known: dict[int, Decimal] = {}
        for number in self._needed():
            code, arguments, _ = operations[number]
            if code == "leaf":
                kind, place = arguments
                known[number] = leaves[kind][place]
            elif code == "number":
                known[number] = _number(arguments[0], exact.get(repr(arguments[0])))
            else:
                function = FUNCTIONS[arguments[0].__name__ if code == "call" else code]
                known[number] = function(*(known[operand] for operand in self.lowering.operands(operations[number])))
        return known[self.wanted]

    def _needed(self) -> list[int]:
        """Operations that the value depends on, in order."""
        found, waiting = set[int](), [self.wanted]
        while waiting:
            number = waiting.pop()
            if number not in found:
                found.add(number)
                waiting += self.lowering.operands(self.lowering.operations[number])
        return sorted(found)


def context() -> Any:
    """Decimal context of all values."""
    return decimal.localcontext(decimal.Context(prec=DIGITS))


def decimals(x: np.ndarray) -> list[Decimal]:
    """Decimal numbers of pairs of doubles (n, 2)."""
    return [Decimal(high) + Decimal(low) for high, low in x.tolist()]


def pair(x: Decimal) -> tuple[float, float]:
    """High and low part, as doubles, of a decimal number."""
    high = float(x)
    return high, float(x - Decimal(high)) if math.isfinite(high) else 0.0


def _number(value: float, exact: str | None) -> Decimal:
    if not exact:
        return Decimal(value)
    above, below = exact.split("/")
    return Decimal(above) / Decimal(below)


def _angle(y: Decimal, x: Decimal) -> Decimal:
    """Polar angle: that in double precision, and the arc tangent of what is missing, which is too small for its third power."""
    nearly = Decimal(math.atan2(y, x))
    sine, cosine = turned(nearly)
    missing = (y * cosine - x * sine) / (x * cosine + y * sine)
    return nearly + missing - missing**3 / 3


FUNCTIONS: dict[str, Callable[..., Decimal]] = {
    "+": Decimal.__add__, "-": Decimal.__sub__, "*": Decimal.__mul__, "/": Decimal.__truediv__, "negative": Decimal.__neg__,
    "root": Decimal.sqrt, "power": Decimal.__pow__, "atan2": _angle, "sin": lambda x: turned(x)[0], "cos": lambda x: turned(x)[1],
    "floor": lambda x: x.to_integral_value(decimal.ROUND_FLOOR)}
