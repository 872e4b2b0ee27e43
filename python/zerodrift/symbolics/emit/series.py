"""Taylor coefficients of a motion as C: `zd_series` of the core's interface, and `zd_precise` in double-double arithmetic.

Arithmetic is written as macros of zerodrift/series.h, so that the same source serves both precisions.

Terms of order k have in them the coefficients of order k of what they depend on, times known numbers, and sums over those of
lower orders. The latter are independent of each other, and are formed for all products at once, side by side in the lanes of a
vector; the former are a straight line. Then

    [M_0  C_0^T] [a_k     ]   [f_k - d_k - sum_(j < k) (M_(k-j) a_j + C_(k-j)^T lambda_j)]
    [C_0    0  ] [lambda_k] = [xi_k      - sum_(j < k)  C_(k-j) a_j                      ]        (8)

with one inverse for all orders, v_(k+1) = a_k / (k + 1) and p_(k+1) = (A v)_k / (k + 1).
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from functools import partial
from typing import Any

from ..elimination.steps import Unwritten
from . import residuals
from .taylor import Jet, Jets
from .writers import indented

TERMS = ("A", "M", "d", "f", "C", "xi", "power", "Phi_t")
SERIES, PRECISE = "zd_symbolic_series", "zd_symbolic_precise"       # names of the descriptors in their libraries
ROUNDED = ("erf", "erfc", "gamma", "loggamma", "expm1", "log1p", "log2", "log10", "hypot")     # of double precision alone
MAX_STATEMENTS = 2000              # of one order
TURNS = ("sin", "cos")
HEAD = ["/* Written by zerodrift.symbolic. */", "#include <math.h>", "#include <zerodrift/series.h>",
        "#include <zerodrift/system.h>", "", "const int zd_interface_version = ZD_INTERFACE_VERSION;", ""]
TOGETHER = 8                        # sums are formed of so many products: ZD_SERIES_TOGETHER
SIGNATURE = ["ZD_SERIES_ON static int evaluate(const void *data, const double *inputs, int orders, zd_number t,",
             "    const zd_number *restrict p, const zd_number *restrict v, zd_number *restrict P, zd_number *restrict V,",
             "    zd_number *restrict E, zd_number *restrict scratch)"]

Row = tuple[str, int]       # of coefficients: ("jet", number), ("weighted", number), ("a", j), ("lambda", l), ("v", j)


class _Sums:
    """Convolution sums sum_(0 < j < k) x_j y_(k-j) that are needed, each once."""

    def __init__(self) -> None:
        self.pairs: dict[tuple[Row, Row], int] = {}

    def of(self, x: Row, y: Row) -> str:
        """C name of the sum of products of the coefficients of x and y."""
        if x[0] != "weighted" and y < x:
            x, y = y, x
        return f"sum[{self.pairs.setdefault((x, y), len(self.pairs))}]"


class Writer:
    """Writer of both parts of the function: values at the start, and coefficients of one order."""

    def __init__(self, program: dict[str, Any], sizes: tuple[int, int, int, int], terms: tuple[str, ...] = TERMS) -> None:
        self.nq, self.nv, mh, mn = sizes
        self.m, self.jets, self.sums = mh + mn, Jets(program, terms), _Sums()
        self._exact = program.get("exact", {})
        self.operations, self.terms = self.jets.operations, self.jets.terms

    # ---- values ----

    def values(self) -> list[str]:
        """Statements of all operations, at the beginning; sines and cosines side by side."""
        lines: list[str] = []
        numbers = list(range(len(self.operations)))
        while numbers:
            turns, later, waiting = [], [], set[int]()
            for number in numbers:
                if not waiting.isdisjoint(self._needed(number)):
                    later.append(number)
                    waiting.add(number)
                elif self.operations[number].name in TURNS:
                    turns.append(number)
                    waiting.add(number)
                else:
                    lines.append(f"const zd_number z{number} = {self._value(self.operations[number])};")
            lines += self._turned(turns) if turns else []
            numbers = later
        return lines

    def _needed(self, number: int) -> Iterable[int]:
        jet = self.operations[number]
        if jet.kind in ("leaf", "number"):
            return ()
        return jet.arguments[:1] if jet.kind in ("along", "against") else jet.arguments

    def _turned(self, turns: list[int]) -> list[str]:
        angles = list(dict.fromkeys(self.operations[number].arguments[0] for number in turns))
        first, count = turns[0], len(angles)
        lines = [f"const zd_number angle{first}[{count}] = {{{', '.join(f'z{angle}' for angle in angles)}}};",
                 f"zd_number sin{first}[{count}], cos{first}[{count}];",
                 f"ZD_TURNS({count}, angle{first}, sin{first}, cos{first});"]
        return lines + [f"const zd_number z{number} = {jet.name}{first}[{angles.index(jet.arguments[0])}];"
                        for number in turns for jet in [self.operations[number]]]

    def _value(self, jet: Jet) -> str:
        kind, arguments = jet.kind, jet.arguments
        if kind == "leaf":
            return {"parameter": f"k[{arguments[1]}]", "t": "t"}.get(arguments[0], f"{arguments[0]}[{arguments[1]}]")
        if kind == "number":
            return self._number(float(arguments[0]))
        names = [f"z{argument}" for argument in arguments]
        if kind in MACROS:
            return f"{MACROS[kind]}({', '.join(names)})"
        named = {"power": "ZD_CALL(pow)({0}, {1})", "atan2": "ZD_CALL(atan2)({0}, {1})",
                 "along": f"ZD_CALL({jet.name})({{0}})", "against": f"ZD_CALL({jet.name})({{0}})"}
        return named[kind].format(*names) if kind in named else f"ZD_CALL({jet.name})({', '.join(names)})"

    def _number(self, value: float) -> str:
        """A number; fractions that no double has are pairs of doubles."""
        exact = self._exact.get(repr(value))
        low = float(Fraction(exact) - Fraction(value)) if exact else 0.0
        return f"ZD_PAIR({value!r}, {low!r})" if low else f"ZD_NUM({value!r})"

    # ---- coefficients ----

    def coefficients(self) -> list[str]:
        """C statements, one for each time-dependent operation, that compute its Taylor coefficient of the present order."""
        return [f"const zd_number y{number} = {self._coefficient(number, jet)};"
                for number, jet in enumerate(self.operations) if not jet.is_fixed]

    def _coefficient(self, number: int, jet: Jet) -> str:
        kind, arguments = jet.kind, jet.arguments
        if kind == "leaf":
            name, place = arguments
            return "ZD_NUM(order == 1)" if name == "t" else f"{name.upper()}[order * {self._size(name)} + {place}]"
        if kind in ("+", "-"):
            return self._sum(kind, *arguments)
        return getattr(self, f"_of_{NAMES.get(kind, kind)}")(number, *arguments)

    def _size(self, leaf: str) -> int:
        return self.nq if leaf == "p" else self.nv

    def _is_fixed(self, number: int) -> bool:
        return self.operations[number].is_fixed

    def _sum(self, sign: str, a: int, b: int) -> str:
        if self._is_fixed(a):
            return f"y{b}" if sign == "+" else minus(f"y{b}")
        return f"y{a}" if self._is_fixed(b) else f"{MACROS[sign]}(y{a}, y{b})"

    def _of_negative(self, number: int, a: int) -> str:
        return minus(f"y{a}")

    def _of_product(self, number: int, a: int, b: int) -> str:
        if self._is_fixed(a) or self._is_fixed(b):
            return times(f"z{a}", f"y{b}") if self._is_fixed(a) else times(f"y{a}", f"z{b}")
        ends = times(times("ZD_NUM(2)", f"z{a}"), f"y{a}") if a == b else plus(times(f"z{a}", f"y{b}"), times(f"y{a}", f"z{b}"))
        return plus(self.sums.of(("jet", a), ("jet", b)), ends)

    def _of_quotient(self, number: int, a: int, b: int) -> str:
        if self._is_fixed(b):
            return over(f"y{a}", f"z{b}")
        above = plus(self.sums.of(("jet", number), ("jet", b)), times(f"z{number}", f"y{b}"))
        return over(minus(above) if self._is_fixed(a) else less(f"y{a}", above), f"z{b}")

    def _of_root(self, number: int, a: int) -> str:
        return over(times("ZD_NUM(0.5)", less(f"y{a}", self.sums.of(("jet", number), ("jet", number)))), f"z{number}")

    def _of_power(self, number: int, a: int, exponent: int) -> str:
        of_base = self.sums.of(("weighted", a), ("jet", number))
        of_power = self.sums.of(("weighted", number), ("jet", a))
        by_base = times(f"z{exponent}", plus(times(f"y{a}", f"z{number}"), times("share", of_base)))
        return over(less(by_base, times("share", of_power)), f"z{a}")

    def _of_along(self, number: int, u: int, w: int) -> str:
        value = plus(times(f"z{w}", f"y{u}"), times("share", self.sums.of(("weighted", u), ("jet", w))))
        return minus(value) if self.operations[number].name == "cos" else value

    def _of_against(self, number: int, u: int, q: int) -> str:
        above = minus(f"y{u}") if self.operations[number].name == "acos" else f"y{u}"
        return over(less(above, times("share", self.sums.of(("weighted", number), ("jet", q)))), f"z{q}")

    def _of_atan2(self, number: int, y: int, x: int, q: int) -> str:
        parts = [times(f"z{x}", f"y{y}"), times(minus(f"z{y}"), f"y{x}")]
        parts = [part for part, of in zip(parts, (y, x), strict=True) if not self._is_fixed(of)]
        if not (self._is_fixed(x) or self._is_fixed(y)):
            crossed = less(self.sums.of(("weighted", y), ("jet", x)), self.sums.of(("weighted", x), ("jet", y)))
            parts.append(times("share", crossed))
        return over(less(plus(*parts), times("share", self.sums.of(("weighted", number), ("jet", q)))), f"z{q}")

    # ---- the equations ----

    def entry(self, name: str, place: int) -> int | None:
        """The operation of an entry of a term; None: the system has no such term, or it is zero."""
        numbers = self.terms.get(name)
        if not numbers:
            return None
        jet = self.operations[numbers[place]]
        return None if jet.kind == "number" and jet.arguments[0] == 0 else numbers[place]

    def _varying(self, name: str, place: int) -> int | None:
        number = self.entry(name, place)
        return None if number is None or self._is_fixed(number) else number

    def leading(self) -> list[str]:
        """Statements of the matrix and right side of (8) at the start."""
        n, size, lines = self.nv, self.nv + self.m, []
        for i in range(n):
            lines += [f"L[{i * size + j}] = z{entry};" for j in range(n) if (entry := self.entry("M", i * n + j)) is not None]
            lines.append(f"right[{i}] = {less(self.value_of('f', i), self.value_of('d', i))};")
        for k in range(self.m):
            for j in range(n):
                if (entry := self.entry("C", k * n + j)) is not None:
                    lines.append(f"L[{(n + k) * size + j}] = L[{j * size + n + k}] = z{entry};")
            lines.append(f"right[{n + k}] = {self.value_of('xi', k)};")
        return lines

    def value_of(self, name: str, place: int) -> str:
        """C name of an entry's value."""
        entry = self.entry(name, place)
        return ZERO if entry is None else f"z{entry}"

    def right_sides(self) -> list[str]:
        """Right sides of one order, from its known part and from all lower orders."""
        n, lines = self.nv, []
        for i in range(n):
            right = ZERO
            for name, to in (("f", plus), ("d", less)):
                if (entry := self._varying(name, i)) is not None:
                    right = to(right, f"y{entry}")
            taken = [self._taken("M", i * n + j, ("a", j)) for j in range(n)]
            taken += [self._taken("C", k * n + i, ("lambda", k)) for k in range(self.m)]
            lines.append(f"right[{i}] = {less(right, *filter(None, taken))};")
        for k in range(self.m):
            entry = self._varying("xi", k)
            taken = [self._taken("C", k * n + j, ("a", j)) for j in range(n)]
            lines.append(f"right[{n + k}] = {less(ZERO if entry is None else f'y{entry}', *filter(None, taken))};")
        return lines

    def _taken(self, name: str, place: int, row: Row) -> str:
        entry = self._varying(name, place)
        return "" if entry is None else plus(self.sums.of(("jet", entry), row), times(f"y{entry}", f"first[{self._place(row)}]"))

    def _place(self, row: Row) -> int:
        return row[1] if row[0] == "a" else self.nv + row[1]

    def rates_of_positions(self, at_start: bool) -> list[str]:
        """The next coefficients of p."""
        if "A" not in self.terms:
            return [f"P[(order + 1) * {self.nq} + {i}] = {times('next', f'V[order * {self.nv} + {i}]')};" for i in range(self.nq)]
        lines = []
        for i in range(self.nq):
            parts = []
            for j in range(self.nv):
                entry = self.entry("A", i * self.nv + j)
                if entry is not None:
                    parts.append(times(f"z{entry}", f"V[order * {self.nv} + {j}]"))
                    if not (at_start or self._is_fixed(entry)):
                        parts += [self.sums.of(("jet", entry), ("v", j)), times(f"y{entry}", f"v[{j}]")]
            lines.append(f"P[(order + 1) * {self.nq} + {i}] = {times('next', plus(*parts) if parts else ZERO)};")
        return lines

    def power(self, at_start: bool) -> list[str]:
        """The next coefficient of the energy that has come in, (28)."""
        if "power" not in self.terms and "Phi_t" not in self.terms:
            return []
        letter, parts = "z" if at_start else "y", [ZERO]
        entry = (self.entry if at_start else self._varying)("power", 0)
        parts += [] if entry is None else [f"{letter}{entry}"]
        for k in range(self.m):
            entry = self.entry("Phi_t", k)
            if entry is not None:
                parts.append(times(f"z{entry}", f"x[{self.nv + k}]"))
                if not (at_start or self._is_fixed(entry)):
                    parts += [self.sums.of(("jet", entry), ("lambda", k)), times(f"y{entry}", f"first[{self.nv + k}]")]
        return [f"if (E) E[order + 1] = {times('next', plus(*parts))};"]

    # ---- rows ----

    def stored(self) -> list[str]:
        """Statements that store the coefficients of this order that sums of higher orders need."""
        return [f"{array}[order * ROWS + {place}] = {self._stored(row)};"
                for pair, place in self.sums.pairs.items() for array, row in zip("XY", pair, strict=True)]

    def _stored(self, row: Row) -> str:
        kind, number = row
        if kind in ("jet", "weighted"):
            value = ZERO if self._is_fixed(number) else f"y{number}"
            return times("ZD_NUM(order)", value) if kind == "weighted" else value
        return f"V[order * {self.nv} + {number}]" if kind == "v" else f"x[{self._place(row)}]"


NAMES = {"*": "product", "/": "quotient"}
MACROS = {"+": "ZD_ADD", "-": "ZD_SUB", "*": "ZD_MUL", "/": "ZD_DIV", "negative": "ZD_NEG", "root": "ZD_ROOT"}
ZERO = "ZD_NUM(0.0)"


def _joined(macro: str, first: str, *others: str) -> str:
    """C of an operation on several values, from the left."""
    for other in others:
        first = f"{macro}({first}, {other})"
    return first


plus, less, times, over = (partial(_joined, MACROS[sign]) for sign in "+-*/")


def minus(value: str) -> str:
    return f"ZD_NEG({value})"


def write(program: dict[str, Any] | str, sizes: tuple[int, int, int, int], data: str = "data") -> str:
    """The C source; raises `Unwritten` where some function has no series, or there are too many operations."""
    if isinstance(program, str):
        raise Unwritten(program)
    return "\n".join([*HEAD, *functions(program, sizes, data), f"const zd_series {SERIES} = {{2 * ROWS, evaluate}};", ""])


def write_precise(program: dict[str, Any] | str, sizes: tuple[int, int, int, int], data: str = "data") -> str:
    """The C source in double-double arithmetic, of the numbers that `data` points to; raises `Unwritten` as `write` does."""
    if isinstance(program, str):
        raise Unwritten(program)
    missing = {name for code, *arguments in program["operations"] if code == "call" for name in arguments[:1]} & set(ROUNDED)
    if missing:
        raise Unwritten(f"double-double arithmetic has no {missing.pop()}")
    head = [f"#define ZD_SERIES_SIZE {sum(sizes) - sizes[0]}", "#define ZD_SERIES_DOUBLE_DOUBLE", *HEAD]
    return "\n".join([*head, *functions(program, sizes, data), *residuals.function(Writer(program, sizes, residuals.TERMS)),
                      *residuals.WRAPPED,
                      f"const zd_precise {PRECISE} = {{2 * ROWS, precise_series, precise_residuals, zd_series_value}};", ""])


def functions(program: dict[str, Any], sizes: tuple[int, int, int, int], data: str) -> list[str]:
    """C function of the coefficients; the header that is included determines its precision."""
    writer = Writer(program, sizes)
    body = _of_one_order(writer)
    if len(body) > MAX_STATEMENTS:
        raise Unwritten(f"their series would have more than {MAX_STATEMENTS} statements")
    rows = max(TOGETHER, -(-len(writer.sums.pairs) // TOGETHER) * TOGETHER)
    lines = [f"const zd_number *restrict const k = {data};",
             "zd_number *restrict const X = scratch, *restrict const Y = X + (orders + 1) * ROWS;",
             *_of_beginning(writer), "for (int order = 1; order < orders; order++) {",
             *indented(["const zd_number share = ZD_DIV(ZD_NUM(1.0), ZD_NUM(order));",
                        "const zd_number next = ZD_DIV(ZD_NUM(1.0), ZD_NUM(order + 1));", "(void)share;",
                        "zd_series_sum(ROWS, order, X, Y, sum);", *body]), "}", "return ZD_DONE;"]
    return [f"enum {{ ROWS = {rows} }};", "", *SIGNATURE, "{", *indented(residuals.used(lines)), "}", ""]


def _of_beginning(writer: Writer) -> list[str]:
    """Statements that are executed once: all values, the inverse, and the coefficients of the lowest orders."""
    n, m = writer.nv, writer.m
    size = n + m
    next_ones = [*(f"V[{n + i}] = x[{i}];" for i in range(n)), *writer.power(True), *writer.rates_of_positions(True)]
    return [f"zd_number L[{size * size}] = {{{ZERO}}}, right[{size}], x[{size}], first[{size}], sum[ROWS];",
            f"double sizes[{size}];", f"ZD_INVERSE(G, {size * size}, L);",
            "(void)k, (void)inputs, (void)t, (void)sum, (void)first;", *writer.values(), *writer.leading(),
            f"if (ZD_INVERT({n}, {m}, L, G, sizes)) return ZD_NOT_DEFINITE;", f"ZD_SOLVE({size}, L, G, right, x);",
            f"for (int i = 0; i < {size}; i++) first[i] = x[i];", f"for (int i = 0; i < {writer.nq}; i++) P[i] = p[i];",
            f"for (int i = 0; i < {n}; i++) V[i] = v[i];", f"if (E) E[0] = {ZERO};",
            "{", *indented(["const int order = 0;", "const zd_number next = ZD_NUM(1.0);", *next_ones]), "}"]


def _of_one_order(writer: Writer) -> list[str]:
    """Statements that compute the next order of the coefficients of p and v."""
    n, size = writer.nv, writer.nv + writer.m
    body = [*writer.coefficients(), *writer.right_sides(), f"ZD_SOLVE({size}, L, G, right, x);",
            *(f"V[(order + 1) * {n} + {i}] = {times('next', f'x[{i}]')};" for i in range(n)), *writer.power(False),
            *writer.rates_of_positions(False)]
    return body + writer.stored()
