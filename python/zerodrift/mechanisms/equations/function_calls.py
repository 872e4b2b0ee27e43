"""User functions as the core calls them, with exact derivatives: in constraints and forces, in Python or as nodes of a graph."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...errors import WrongValue
from ...laws import breaks, switches
from ...laws.formula import Formula
from ...systems.autodiff import Jet
from ..elements.user_functions import InputLaw, Law
from . import function_programs


class Call:
    """User function with its arguments: `picks` has, for each measure, its marker quantity and whether the rate is meant.

    Reactions that it reads follow the marker quantities.
    """

    sign: float = 1     # factor of a generalized force

    def __init__(self, law: Law | InputLaw, picks: Sequence[tuple[int, bool]], parameters: Mapping[str, float]) -> None:
        self.law, self.picks, self.parameters = law, tuple(picks), parameters

    @property
    def numbers(self) -> Mapping[str, float]:
        """Parameters that it is computed from, or the numbers of an input, by name."""
        law, own = self.law, self.parameters
        return law.numbers if isinstance(law, InputLaw) else {name: own[name] for name in law.names if name in own}

    def _numbers(self, t: float, x: np.ndarray, xdot: np.ndarray) -> float:
        values = [float((xdot if is_rate else x)[place]) for place, is_rate in self.picks]
        return self.law.number(t, values, self.parameters)

    def node(self, law: Law | InputLaw, equations: Any, values: Sequence[Any], rates: Sequence[Any]) -> Any:
        """Node of a user function of its measures."""
        return law.written(equations, [(rates if is_rate else values)[place] for place, is_rate in self.picks])

    def written(self, equations: Any, values: Sequence[Any], rates: Sequence[Any]) -> Any:
        """Node of the residual or force; `values` and `rates` are those of its marker quantities."""
        return self.node(self.law, equations, values, rates)

    def held(self) -> tuple[Call, Mapping[str, Formula]]:
        """The same with a number for each switch, 0 where its comparison decides, and the differences by the names of these.

        Of forces only: constraints do not jump.
        """
        return self, {}

    def said(self, leaves: Any, node: Any) -> Sequence[Any]:
        """Node of what the core reads, from the node of the residual or force; here for a holonomic constraint."""
        return leaves.holonomic(node)


class ForceLaw(Call):
    """Generalized force: a force or torque, times `sign`."""

    def __init__(self, law: Law | InputLaw, picks: Sequence[tuple[int, bool]], parameters: Mapping[str, float],
                 sign: float = 1) -> None:
        super().__init__(law, picks, parameters)
        self.sign = sign

    def __call__(self, t: float, x: np.ndarray, xdot: np.ndarray) -> Any:
        return (self.sign * self._numbers(t, x, xdot),)

    def written(self, equations: Any, values: Sequence[Any], rates: Sequence[Any]) -> Any:
        return equations.graph.sum([(super().written(equations, values, rates), self.sign)])

    def said(self, leaves: Any, node: Any) -> Sequence[Any]:
        return (node,)

    def held(self) -> tuple[Call, Mapping[str, Formula]]:
        law = self.law
        if isinstance(law, InputLaw) or law.formula is None:
            return self, {}
        formula, differences = switches.held(law.formula, frozenset(law.picked), tuple(self.numbers.items()))
        if not differences:
            return self, {}
        sides = dict.fromkeys(differences, 0.0)
        row = type(self)(law.of_formula(formula, sides), self.picks, {**self.parameters, **sides}, self.sign)
        return row, differences


class Stiffness(ForceLaw):
    """Generalized force: a stiffness times the first of its marker quantities."""

    def __call__(self, t: float, x: np.ndarray, xdot: np.ndarray) -> Any:
        return (self.sign * self._numbers(t, x, xdot) * x[0],)

    def written(self, equations: Any, values: Sequence[Any], rates: Sequence[Any]) -> Any:
        return equations.graph.times(super().written(equations, values, rates), values[0])


class Value(ForceLaw):
    """Measure of one's own, which acts on nothing."""

    held = Call.held


class Motion(Call):
    """Driving constraint x = f(t)."""

    def __call__(self, t: float, x: np.ndarray, xdot: np.ndarray) -> Any:
        f = self.law.jet(Jet(t, 0.0, 1.0, 0.0), (), self.parameters)
        return x[0] - f.value, 1.0, -f.first, -f.second

    def written(self, equations: Any, values: Sequence[Any], rates: Sequence[Any]) -> Any:
        return equations.difference(values[0], super().written(equations, values, rates))


class Speed(Call):
    """Nonholonomic driving constraint xdot = f(t, x)."""

    def __call__(self, t: float, x: np.ndarray, xdot: np.ndarray) -> Any:
        at = [Jet(float(x[place]), 0.0, float(xdot[place]), 0.0) for place, _ in self.picks]
        f = self.law.jet(Jet(t, 0.0, 1.0, 0.0), at, self.parameters)
        return 0.0, 1.0, *[0.0] * (len(x) - 1), -f.value, -f.first

    def written(self, equations: Any, values: Sequence[Any], rates: Sequence[Any]) -> Any:
        return equations.difference(rates[0], super().written(equations, values, rates))

    def said(self, leaves: Any, node: Any) -> Sequence[Any]:
        return leaves.nonholonomic(node)


class Holonomic(Call):
    """Holonomic constraint g(t, x) = 0."""

    def __call__(self, t: float, x: np.ndarray, xdot: np.ndarray) -> Any:
        axes = np.eye(len(x) + 1)
        at = [Jet(float(x[place]), axes[place], float(xdot[place]), 0.0) for place, _ in self.picks]
        g = self.law.jet(Jet(t, axes[-1], 1.0, 0.0), at, self.parameters)
        return np.concatenate([[g.value], np.broadcast_to(g.gradient, len(axes)), [g.second]])


class Nonholonomic(Call):
    """Nonholonomic constraint h(t, x, xdot) = 0, linear in xdot."""

    def __call__(self, t: float, x: np.ndarray, xdot: np.ndarray) -> Any:
        h = self.at(t, x, xdot)
        slopes = np.broadcast_to(h.gradient, len(x))
        return np.concatenate([[0.0], slopes, [h.value - slopes @ xdot, h.first]])

    def said(self, leaves: Any, node: Any) -> Sequence[Any]:
        return leaves.nonholonomic(node)

    def at(self, t: float, x: np.ndarray, xdot: np.ndarray) -> Jet:
        """Value of h, its gradient in the rates, and its derivative along the motion at constant rates."""
        axes = np.eye(len(x))
        still = 0.0 * axes[0]
        at = [Jet(float(xdot[place]), axes[place], 0.0, 0.0) if is_rate else Jet(float(x[place]), still, float(xdot[place]), 0.0)
              for place, is_rate in self.picks]
        return self.law.jet(Jet(t, still, 1.0, 0.0), at, self.parameters)

    def check_linear(self, size: int) -> None:
        """Check that h is linear in velocities, at two of them."""
        x, one, other = (np.cos(np.arange(1.0, size + 1.0) + shift) for shift in (0.0, 0.5, 1.5))
        first, second = slopes = [np.broadcast_to(self.at(0.3, x, rate).gradient, size) for rate in (one, other)]
        if np.isfinite(slopes).all() and not np.allclose(first, second, rtol=1e-9, atol=1e-12):
            raise WrongValue(f"{self.law.what} must be linear in measures of velocities, and is not", "user-function")


class Laws:
    """All user functions of a mechanism, as the core calls them."""

    def __init__(self) -> None:
        self.rows: list[Any] = []       # of Call
        self._programs: list[Any] = []
        self.differences: dict[int, function_programs.Differences] = {}     # by user function; known with the programs
        self._breaks: dict[Any, list[breaks.Break]] = {}        # by span

    def add(self, row: Call) -> int:
        """Index under which the core calls it."""
        self.rows.append(row)
        return len(self.rows) - 1

    def __call__(self, number: int, t: float, x: np.ndarray, xdot: np.ndarray) -> Any:
        values, law = self.rows[number](t, x, xdot), self.rows[number].law
        if len(values) > 1 and not np.isfinite(values).all():
            raise WrongValue(f"{law.what} must be finite, with its derivatives, at t = {t:g}", "not-finite")
        return values

    def programs(self, sizes: Mapping[int, tuple[int, int]]) -> list[Any]:
        """Result of `function_programs.program` for each user function; `sizes` has the number of its marker quantities."""
        if len(self._programs) < len(sizes):
            held = [row.held() for row in self.rows[:len(sizes)]]
            self._programs = [function_programs.program(row, sizes[i][0]) for i, (row, _) in enumerate(held)]
            self.differences = {i: function_programs.differences(row, sizes[i][0], found)
                                for i, (row, found) in enumerate(held) if found and self._programs[i]}
        return self._programs[:len(sizes)]

    @property
    def jump(self) -> bool:
        """True if one jumps where a comparison of the motion changes."""
        return any(row.held()[1] for row in self.rows)

    @property
    def tables(self) -> list[Any]:
        """Tables, in the order of the user functions that they are."""
        return list(dict.fromkeys(table for row in self.rows for table in row.law.tables))

    @property
    def acting(self) -> list[Any]:
        """User functions of constraints and forces, which stand before those of measures."""
        return [row for row in self.rows if not isinstance(row, Value)]

    def breaks(self, span: tuple[float, float] | None = None) -> list[breaks.Break]:
        """Times at which adaptive steps end: those that are known at once, and others in a span."""
        if span not in self._breaks:
            self._breaks[span] = sorted({each for row in self.acting for each in row.law.breaks(row.parameters, span)})
        return self._breaks[span]

    def check_written(self) -> None:
        """Check that code can be generated for all that act: they must not be callables."""
        for row in self.acting:
            row.law.check_written()

    @property
    def know_time(self) -> bool:
        """True if one that acts depends on t."""
        return any(row.law.depends_on_time for row in self.acting)
