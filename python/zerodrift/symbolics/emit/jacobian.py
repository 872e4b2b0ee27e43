"""Derivatives of a motion's rates by its state as C: `zd_jacobian` of the core's interface.

With vdot and lambda of (8) at (t, p, v) held, residuals change along each entry x of p and v by

    dynamics     r = M_x vdot + d_x - f_x + C_x^T lambda
    constraints  s = C_x vdot - xi_x

and one inverse serves all of them: [vdot_x; lambda_x] = -[M C^T; C 0]^-1 [r; s]. Derivatives are taken operation by operation in
forward mode, for each entry only of those operations that depend on it. Formulations in independent velocities want to know, too,
how the velocity constraints (5) change with p: C_x v + Phi_t,x.
"""

from __future__ import annotations

from typing import Any

from ..elimination.steps import Unwritten
from .series import HEAD, TERMS, Writer
from .taylor import Jet
from .writers import indented

JACOBIAN = "zd_symbolic_jacobian"       # what the descriptor is called in its library
MAX_STATEMENTS = 4000
SIGNATURE = ["static int {0}(const void *data, const double *inputs, double t, const double *restrict p,",
             "    const double *restrict v, double *restrict {1}, double *restrict scratch)", "{{"]

Leaf = tuple[str, int]      # ("p", i) or ("v", j)


class _Slopes(Writer):
    """Derivatives of all operations that the terms need: for each operation, C names by the entry of the state."""

    def __init__(self, program: dict[str, Any], sizes: tuple[int, int, int, int], terms: tuple[str, ...] = TERMS) -> None:
        super().__init__(program, sizes, terms)
        self.slopes: list[dict[Leaf, str]] = []
        self.statements: list[str] = []
        for number, jet in enumerate(self.operations):
            self.slopes.append(self._slopes_of(number, jet))
            if len(self.statements) > MAX_STATEMENTS:
                raise Unwritten(f"their Jacobian would have more than {MAX_STATEMENTS} statements")

    def _slopes_of(self, number: int, jet: Jet) -> dict[Leaf, str]:
        if jet.kind == "leaf":
            return {jet.arguments: "1.0"} if jet.arguments[0] in ("p", "v") else {}     # not of t
        if jet.is_fixed:
            return {}
        factors = self._factors(number, jet)
        found: dict[Leaf, str] = {}
        for leaf in dict.fromkeys(leaf for argument, _ in factors for leaf in self.slopes[argument]):
            parts = [_times(factor, self.slopes[argument][leaf]) for argument, factor in factors if leaf in self.slopes[argument]]
            found[leaf] = f"y{number}_{leaf[0]}{leaf[1]}"
            self.statements.append(f"const double {found[leaf]} = {' + '.join(parts)};")
        return found

    def _factors(self, number: int, jet: Jet) -> list[tuple[int, str]]:
        """Operands of an operation, and the partial derivative with respect to each."""
        a, *others = jet.arguments
        z = [f"z{argument}" for argument in jet.arguments]
        match jet.kind:
            case "+" | "-":
                return [(a, "1.0"), (others[0], f"{jet.kind}1.0".removeprefix("+"))]
            case "negative":
                return [(a, "-1.0")]
            case "*":
                return [(a, z[1]), (others[0], z[0])]
            case "/":
                return [(a, f"1 / {z[1]}"), (others[0], f"-z{number} / {z[1]}")]
            case "root":
                return [(a, f"0.5 / z{number}")]
            case "power":
                return [(a, f"{z[1]} * pow({z[0]}, {z[1]} - 1)")]
            case "along":
                return [(a, f"-{z[1]}" if jet.name == "cos" else z[1])]
            case "against":
                return [(a, f"{'-' if jet.name == 'acos' else ''}1 / {z[1]}")]
            case _:     # atan2
                return [(a, f"{z[1]} / {z[2]}"), (others[0], f"-{z[0]} / {z[2]}")]

    def _of_entry(self, name: str, place: int, leaf: Leaf) -> str | None:
        """The derivative of an entry of a term; None: it is zero."""
        number = self.entry(name, place)
        return None if number is None else self.slopes[number].get(leaf)

    def of_constraints(self) -> list[str]:
        """Statements of the derivatives of (5) by p."""
        lines = []
        for k in range(self.m):
            factors = [*(("C", k * self.nv + j, f"v[{j}]") for j in range(self.nv)), ("Phi_t", k, "1.0")]
            parts = [self._products(("p", i), *factors) for i in range(self.nq)]
            lines += [f"Psi_p[{k * self.nq + i}] = {' + '.join(part) or '0.0'};" for i, part in enumerate(parts)]
        return lines

    # ---- a column ----

    def column(self, leaf: Leaf) -> list[str]:
        """Statements of the derivatives of all rates by an entry of p or v."""
        n, size = self.nv, self.nv + self.m
        rows = [self._of_dynamics(i, leaf) for i in range(n)] + [self._of_constraint(k, leaf) for k in range(self.m)]
        lines = self._of_positions(leaf)
        if any(rows):
            lines += [f"right[{i}] = -({' + '.join(row) or '0.0'});" for i, row in enumerate(rows)]
            lines += [f"zd_series_solve({size}, G, right, x);",
                      f"for (int i = 0; i < {n}; i++) {self._at(f'({self.nq} + i)', leaf)} = x[i];"]
        return lines + self._slope_of_power(leaf, any(rows))

    def _at(self, row: str | int, leaf: Leaf) -> str:
        return f"J[{row} * {self.nq + self.nv} + {leaf[1] if leaf[0] == 'p' else self.nq + leaf[1]}]"

    def _products(self, leaf: Leaf, *factors: tuple[str, int, str]) -> list[str]:
        """Products of the derivatives of entries with their constant factors."""
        slopes = [(self._of_entry(name, place, leaf), by) for name, place, by in factors]
        return [_times(by, slope) for slope, by in slopes if slope is not None]

    def _of_dynamics(self, i: int, leaf: Leaf) -> list[str]:
        n = self.nv
        return self._products(leaf, *(("M", i * n + j, f"vdot[{j}]") for j in range(n)), ("d", i, "1.0"), ("f", i, "-1.0"),
                              *(("C", k * n + i, f"lambda[{k}]") for k in range(self.m)))

    def _of_constraint(self, k: int, leaf: Leaf) -> list[str]:
        return self._products(leaf, *(("C", k * self.nv + j, f"vdot[{j}]") for j in range(self.nv)), ("xi", k, "-1.0"))

    def _of_positions(self, leaf: Leaf) -> list[str]:
        kind, place = leaf
        if "A" not in self.terms:
            return [f"{self._at(place, leaf)} = 1;"] if kind == "v" else []
        lines = []
        for i in range(self.nq):
            parts = self._products(leaf, *(("A", i * self.nv + j, f"v[{j}]") for j in range(self.nv)))
            entry = self.entry("A", i * self.nv + place) if kind == "v" else None
            parts += [] if entry is None else [f"z{entry}"]
            lines += [f"{self._at(i, leaf)} = {' + '.join(parts)};"] if parts else []
        return lines

    def _slope_of_power(self, leaf: Leaf, is_solved: bool) -> list[str]:
        """Derivative of the power in (28): of forces, and of moving constraints with their multipliers."""
        parts = self._products(leaf, ("power", 0, "1.0"), *(("Phi_t", k, f"lambda[{k}]") for k in range(self.m)))
        moving = [(k, self.entry("Phi_t", k)) for k in range(self.m)] if is_solved else []
        parts += [f"x[{self.nv + k}] * z{entry}" for k, entry in moving if entry is not None]
        return [f"{self._at(self.nq + self.nv, leaf)} = {' + '.join(parts)};"] if parts else []


def _times(factor: str, slope: str) -> str:
    if factor == "1.0" or slope == "1.0":
        return slope if factor == "1.0" else f"({factor})"
    return f"-{slope}" if factor == "-1.0" else f"({factor}) * {slope}"


def write(program: dict[str, Any] | str, sizes: tuple[int, int, int, int], data: str = "data") -> str:
    """The C source; raises `Unwritten` where some function has no derivative that is known, or there are too many operations."""
    if isinstance(program, str):
        raise Unwritten(program)
    both = [*_function("evaluate", "J", _of_rates(_Slopes(program, sizes)), data),
            *_function("constraints", "Psi_p", _of_constraints(_Slopes(program, sizes, ("C", "Phi_t"))), data)]
    return "\n".join([*HEAD, *both, f"const zd_jacobian {JACOBIAN} = {{0, evaluate, constraints}};", ""])


def _function(name: str, result: str, body: list[str], data: str) -> list[str]:
    lines = [f"const double *restrict const k = {data};", "(void)k, (void)inputs, (void)t, (void)p, (void)v, (void)scratch;",
             *body]
    return [*(line.format(name, result) for line in SIGNATURE), *indented([*lines, "return ZD_DONE;"]), "}", ""]


def _bounded(*parts: list[str]) -> list[str]:
    if sum(map(len, parts)) > MAX_STATEMENTS:
        raise Unwritten(f"their Jacobian would have more than {MAX_STATEMENTS} statements")
    return [line for part in parts for line in part]


def _of_rates(writer: _Slopes) -> list[str]:
    n, size, columns = writer.nv, writer.nv + writer.m, writer.nq + writer.nv
    has_power = "power" in writer.terms or "Phi_t" in writer.terms
    leaves = [("p", i) for i in range(writer.nq)] + [("v", j) for j in range(n)]
    return [f"double G[{size * size}] = {{0}}, right[{size}], x[{size}], first[{size}], sizes[{size}];",
            "double *const L = G;", f"const double *const vdot = first, *const lambda = first + {n};",
            "(void)vdot, (void)lambda;", *writer.values(), *writer.leading(),
            f"if (zd_series_invert({n}, {writer.m}, G, sizes)) return ZD_NOT_DEFINITE;",
            f"zd_series_solve({size}, G, right, first);",
            f"for (int i = 0; i < {(columns + has_power) * columns}; i++) J[i] = 0;",
            *_bounded(writer.statements, [line for leaf in leaves for line in writer.column(leaf)])]


def _of_constraints(writer: _Slopes) -> list[str]:
    return [*writer.values(), *_bounded(writer.statements, writer.of_constraints())]
