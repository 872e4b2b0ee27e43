"""Operations whose Taylor coefficients can be computed order by order, converted from a program.

The coefficients of a product are sums over those of its factors, c_k = sum_j a_j b_(k-j); those of all other functions follow
from differential equations that have only products:

    c' = w u'       along:      c = exp u, w = c; sin u, cos u; tan u, 1 + c^2; sinh u, cosh u; tanh u, 1 - c^2
    q c' = u'       against:    c = log u, q = u; atan u, 1 + u^2; asin u, sqrt(1 - u^2); and so on

Logistic functions are written by tanh, 1 / (c + exp u) = (1 - tanh((u - log c) / 2)) / (2 c): exp u overflows where they are long
since zero.

E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd edition, 1993, section I.8.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ..elimination.steps import Unwritten

SAME_IN_C = ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "exp",
             "log", "floor", "erf")
IN_C = {"Pow": "pow", "Abs": "fabs", "ceiling": "ceil"} | {name: name for name in SAME_IN_C}    # functions, and what C calls them
MIRRORED = {"cos": "sin", "cosh": "sinh"}       # functions that are found together with others


class Jet(NamedTuple):
    """An operation: `kind` applied to those before it that `arguments` numbers.

    Kinds are leaf (kind, index), number, those of a program's arithmetic, and calls: fixed, along (u, w), against (u, q),
    atan2 (y, x, q). The w of an along may come after it: its coefficients are needed one order later.
    """

    kind: str
    arguments: tuple[Any, ...]
    name: str = ""          # of a function
    is_fixed: bool = False  # whether it depends on parameters alone


class Jets:
    """Taylor operations of some terms of a program, in order of evaluation, without duplicates."""

    def __init__(self, program: dict[str, Any], names: tuple[str, ...]) -> None:
        self.operations: list[Jet] = []
        self._numbers: dict[tuple[Any, ...], int] = {}
        self._program, self._made = program["operations"], dict[int, int]()
        self.terms = {name: [self._of(number) for number in program["terms"][name]] for name in names if name in program["terms"]}

    def _emit(self, kind: str, *arguments: Any, name: str = "") -> int:
        key = (kind, name, *arguments)
        if key not in self._numbers:
            fixed = kind == "number" or (kind == "leaf" and arguments[0] == "parameter") or (
                kind != "leaf" and all(self.operations[argument].is_fixed for argument in arguments))
            self._numbers[key] = len(self.operations)
            self.operations.append(Jet(kind, arguments, name, fixed))
        return self._numbers[key]

    def _of(self, wanted: int) -> int:
        """Number of the Taylor operation of an operation of the program; its operands are converted first."""
        waiting = [wanted]
        while waiting:
            code, *arguments = self._program[waiting[-1]]
            needed = _operands(code, arguments)
            more = [number for number in needed if number not in self._made]
            if not more:
                self._made[waiting.pop()] = self._translated(code, arguments, [self._made[number] for number in needed])
            waiting += more
        return self._made[wanted]

    def _translated(self, code: str, arguments: list[Any], operands: list[int]) -> int:
        if code in ("leaf", "number"):
            return self._emit(code, *arguments)
        if code == "call":
            return self._call(arguments[0], *operands)
        if code in ("choice", "comparison", "logic"):
            raise Unwritten("a choice between cases has none")
        if code == "/":
            logistic = self._logistic(operands[1])
            return self._emit("/", *operands) if logistic is None else self._emit("*", operands[0], logistic)
        return self._power(*operands) if code == "power" else self._emit(code, *operands)

    # ---- functions ----

    def _call(self, name: str, u: int, *others: int) -> int:
        if self.operations[u].is_fixed and all(self.operations[other].is_fixed for other in others):
            if name not in IN_C:
                raise Unwritten(f"no series is written with {name}")
            return self._emit("fixed", u, *others, name=IN_C[name])
        if name == "Pow":
            return self._power(u, *others)
        if name == "atan2":
            x, = others
            return self._emit("atan2", u, x, self._emit("+", self._square(x), self._square(u)), name=name)
        if name in ("sin", "cos", "sinh", "cosh"):
            return self._pair(MIRRORED.get(name, name), u)[name in MIRRORED]
        if name in ("exp", "tan", "tanh"):
            return self._along(name, u)
        return self._against(name, u)

    def _pair(self, name: str, u: int) -> tuple[int, int]:
        """Sine and cosine of an angle; their coefficients are computed together."""
        key = (name, u)
        if key not in self._numbers:
            first = self._numbers[key] = len(self.operations)
            other = next(mirrored for mirrored, of in MIRRORED.items() if of == name)
            self.operations += [Jet("along", (u, first + 1), name), Jet("along", (u, first), other)]
        first = self._numbers[key]
        return first, first + 1

    def _along(self, name: str, u: int) -> int:
        key = (name, u)
        if key not in self._numbers:
            number = self._numbers[key] = len(self.operations)
            self.operations.append(Jet("along", (u, number), name))
            if name != "exp":
                slope = self._emit("+" if name == "tan" else "-", self._emit("number", 1.0), self._square(number))
                self.operations[number] = Jet("along", (u, slope), name)
        return self._numbers[key]

    def _against(self, name: str, u: int) -> int:
        one, square = self._emit("number", 1.0), self._square(u)
        if name == "log":
            slope = u
        elif name in ("atan", "atanh"):
            slope = self._emit("+" if name == "atan" else "-", one, square)
        elif name in ("asin", "acos", "asinh"):
            slope = self._emit("root", self._emit("+" if name == "asinh" else "-", one, square))
        elif name == "acosh":
            slope = self._emit("root", self._emit("-", square, one))
        else:
            raise Unwritten(f"no Taylor series is known of {name}")
        return self._emit("against", u, slope, name=name)

    def _logistic(self, below: int) -> int | None:
        """Logistic operation if a divisor is c + exp u with a positive number c; otherwise None."""
        jet = self.operations[below]
        if jet.kind != "+":
            return None
        for c, power in (jet.arguments, jet.arguments[::-1]):
            number, of = self.operations[c], self.operations[power]
            if number.kind == "number" and number.arguments[0] > 0 and (of.kind, of.name) == ("along", "exp"):
                half = self._emit("number", 0.5)
                shifted = self._emit("-", of.arguments[0], self._emit("fixed", c, name="log"))
                above = self._emit("-", self._emit("number", 1.0), self._along("tanh", self._emit("*", half, shifted)))
                return self._emit("*", self._emit("/", half, c), above)
        return None

    def _power(self, base: int, exponent: int) -> int:
        order = self.operations[exponent]
        if order.kind == "number" and order.arguments[0] < 0 and (logistic := self._logistic(base)) is not None:
            return self._power(logistic, self._emit("number", -order.arguments[0]))
        if self.operations[base].is_fixed and self.operations[exponent].is_fixed:
            return self._emit("fixed", base, exponent, name="pow")
        if self.operations[exponent].is_fixed:
            return self._emit("power", base, exponent)
        logarithm = self._emit("fixed", base, name="log") if self.operations[base].is_fixed else self._against("log", base)
        return self._along("exp", self._emit("*", exponent, logarithm))

    def _square(self, u: int) -> int:
        return self._emit("*", u, u)


def _operands(code: str, arguments: list[Any]) -> list[int]:
    if code in ("leaf", "number"):
        return []
    return arguments[1:] if code in ("call", "comparison", "logic") else arguments
