"""Laws as the core evaluates them, and formulas in 50 digits, with their derivatives as differences."""

from fractions import Fraction

import mpmath as mp
import numpy as np

from zerodrift._private.gateway.compiled import programs
from zerodrift.laws.formula import Evaluation
from zerodrift.mechanisms.equations import function_calls, function_programs

DIGITS, STEP = 60, mp.mpf(10) ** -25


def spline(table, x, _):
    """Value of a piecewise cubic within its knots."""
    row = max((row for row in table.knots[:-1] if row[0] <= x), key=lambda row: row[0], default=table.knots[0])
    return mp.polyval([*map(mp.mpf, row[1:])], x - mp.mpf(row[0]))


NAMES = {"Abs": abs, "fmod": lambda x, y: x - y * int(x / y), "ceiling": mp.ceil, "Pow": mp.power, "zd_spline_at": spline,
         "log2": lambda x: mp.log(x, 2)}


class Digits(Evaluation):
    """Values of operations in many digits."""

    def _of(self, kind, content):
        values = self.values
        match kind:
            case "number":
                return number(content)
            case "sum":
                return mp.fsum(values[each] * number(factor) for each, factor in content)
            case "product":
                return mp.fprod(values[each] ** number(exponent) for each, exponent in content)
            case "call":
                return (NAMES.get(content[0]) or getattr(mp, content[0]))(*(values[each] for each in content[1]))
        return super()._of(kind, content)


def number(x):
    return mp.mpf(x.numerator) / x.denominator if isinstance(x, Fraction) else mp.mpf(x)


def value(formula, known):
    with mp.workdps(DIGITS):
        return Digits(formula.operations, {name: mp.mpf(x) for name, x in known.items()})(len(formula.operations) - 1)


def slope_of(formula, known, name):
    """Derivative with respect to a name."""
    with mp.workdps(DIGITS):
        return float((value(formula, {**known, name: known[name] + STEP}) - value(formula, {**known, name: known[name] - STEP}))
                     / (2 * STEP))


def in_core(law, kind=function_calls.ForceLaw):
    """Function of t and of measures that is evaluated by the core: its value, and of a constraint its derivatives."""
    k = len(law.measures)
    row = kind(law, [(i, False) for i in range(k)], {})
    written = function_programs.program_of(row, k)
    program = programs.expressions(written.program)
    numbers = programs.with_addresses(np.array(written.numbers), written.splines)

    def values(t, x):
        return programs.reader(program, numbers, t, x, np.zeros_like(x))().squeeze()
    return values
