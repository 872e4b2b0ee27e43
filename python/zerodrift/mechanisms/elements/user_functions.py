"""User functions: prescribed motions, forces and constraints as numbers, callables or SymPy expressions."""

from __future__ import annotations

import copy
import functools
from collections.abc import Callable, Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np

from ..._private import checks
from ...errors import WrongType, WrongValue, sentence
from ...laws import breaks, recording
from ...laws.formula import Formula, of_expression
from ...laws.table import Spline, recognised
from ...systems import autodiff
from ...systems.user_callables import arguments
from .measures import name_of


class Law:
    """User function: a number that may depend on t, on measures and on the mechanism's own parameters.

    Attributes
    ----------
    what : str
        Whose it is, for errors: ``"speed of motor 'drive'"``.
    measures : tuple of str
        The measures of positions and velocities it depends on, in the order in which `value` takes them.
    reactions : dict of str to str
        Reactions and accelerations by its own names; `value` takes them after the measures.
    constant : float or None
        Its value where it is a plain number.
    formula : Formula or None
        Formula of an expression, or of a function that could be recorded.
    why_called : str
        Reason why a function was not recorded, and is called instead; empty for others.
    """

    input: str | None = None        # name of the input that takes its place in a run
    is_speed = False
    reactions: Mapping[str, str] = MappingProxyType({})
    recorded = recording.Recorded(None)
    formula: Formula | None = None
    constant: float | None = None
    why_called = ""

    def __init__(self, what: str, given: Any, *, of: Mapping[str, Any] | None = None,
                 parameters: Mapping[str, float] = MappingProxyType({})) -> None:
        self.what = what
        self._function: Any = None
        bound = {name: name_of(measure, f"of[{name!r}]") for name, measure in _of(what, of).items()}
        given = recognised(given)
        if hasattr(given, "free_symbols"):
            given = self._read(given)
        if isinstance(given, Formula | Expression | Component):
            self._names = [self._wanted(name, bound, parameters) for name in sorted(given.names)]
            self.formula, self._function = (given, None) if isinstance(given, Formula) else (None, given)
        elif callable(given):
            self._names, self._function = _wanted(what, given, ["t", *parameters, *bound]), given
        elif isinstance(given, tuple | list | dict) or np.ndim(given):
            raise WrongType(f"{what} must be a number, a function, an expression of SymPy, or zd.table(t, y) of data, "
                            f"not {checks.shown(given)}")
        else:
            self.constant, self._names = checks.number(what, given), []
        self._bound = {name: bound.get(name, name) for name in self._names if name in bound or "." in name}
        self.measures = tuple(self._bound.values())
        self.depends_on_time = "t" in self._names
        self.record(parameters)

    @property
    def reads(self) -> tuple[str, ...]:
        """Measures and reactions that it depends on, by name."""
        return tuple(self._bound.values())

    @property
    def kind(self) -> str:
        """"graph", with functions whose bits differ by machine; "table"; or "call" with the reason; empty for a number."""
        if self.constant is not None:
            return ""
        if self.formula is None:
            return f"call: {self.why_called}" if self.why_called else "table"
        named = self.formula.of_library
        return f"graph, not portable to the bit: {', '.join(named)}" if named else "graph"

    def call(self, why: str) -> None:
        """Keep a function as a call, though it could be recorded."""
        self.formula, self.why_called = None, why

    def _read(self, expression: Any) -> Formula | Expression:
        """Formula of an expression of SymPy; one with a function that the core lacks is called."""
        try:
            return of_expression(self.what, expression)
        except WrongValue as error:
            self.why_called = sentence(error)
            return Expression(expression)

    def _wanted(self, name: str, bound: Mapping[str, str], parameters: Mapping[str, float]) -> str:
        """Name of an expression, checked; those in `of` stand for their measures."""
        if name != "t" and "." not in name and name not in bound and name not in parameters:
            raise WrongType(f"{self.what} has the argument {name!r}; available are {', '.join(['t', *parameters, *bound])}, and "
                            "measures", "user-function")
        return name

    def record(self, parameters: Mapping[str, float]) -> None:
        """Record a function; numbers that it reads from outside count as they are now."""
        if self._function is not None and not self._is_written and not isinstance(self._function, Expression):
            self.recorded = recording.record(self._function, self._names, parameters, self.formula)
            self.formula, self.why_called, _ = self.recorded

    def read(self, reactions: Iterable[str]) -> None:
        """Take these of its measures as reactions."""
        among = frozenset(reactions)
        self.reactions = {name: measure for name, measure in self._bound.items() if measure in among}
        self.measures = tuple(self._bound[name] for name in self.picked)

    def of_formula(self, formula: Formula, more: Iterable[str] = ()) -> Law:
        """The same with another formula, which has more parameters."""
        other = copy.copy(self)
        other.formula, other._names = formula, [*self._names, *more]
        return other

    @property
    def picked(self) -> list[str]:
        """Own names of its measures without reactions."""
        return [name for name in self._bound if name not in self.reactions]

    def _known(self, t: Any, x: Iterable[Any], parameters: Mapping[str, Any]) -> dict[str, Any]:
        """All its arguments by their own names."""
        return {**parameters, "t": t, **dict(zip((*self.picked, *self.reactions), x, strict=True))}

    def value(self, t: Any, x: Iterable[Any], parameters: Mapping[str, Any]) -> Any:
        """Value at a time and values of its measures; with derivatives (`autodiff.Jet`) if these have them."""
        if self.constant is not None:
            return self.constant
        known = self._known(t, x, parameters)
        try:
            if self.formula is not None:
                return self.formula.value(known)
            return self._function(**{name: known[name] for name in self._names})
        except BaseException as error:
            checks.tell(error, f"in {self.what}, called at t = {autodiff.value(t):g}")
            raise

    def number(self, t: float, x: Iterable[float], parameters: Mapping[str, Any]) -> float:
        """Value, checked to be a finite number."""
        value = self.value(t, x, parameters)
        if type(value) is float and -np.inf < value < np.inf:
            return value
        return checks.number(f"{self.what} at t = {t:g}", value[()] if isinstance(value, np.ndarray) else value)

    def jet(self, t: Any, x: Iterable[Any], parameters: Mapping[str, Any]) -> autodiff.Jet:
        """Value with derivatives, which are zero where the function is constant."""
        x = tuple(x)
        try:
            value = self.value(t, x, parameters)
        except (TypeError, AttributeError) as error:
            if not self._has_value(t, x, parameters):
                raise
            raise WrongType(f"{self.what} must have derivatives: an expression of SymPy, or a function of arithmetic and smooth "
                            "NumPy functions (np.sin, np.exp, np.sqrt); np.interp, np.floor and % have none. zd.table(t, y) is a "
                            "smooth function through data", "user-function") from error
        value = value[()] if isinstance(value, np.ndarray) else value
        return value if isinstance(value, autodiff.Jet) else autodiff.Jet(checks.number(self.what, value))

    def _has_value(self, t: Any, x: Iterable[Any], parameters: Mapping[str, Any]) -> bool:
        """True if an evaluation with floats instead of jets succeeds."""
        try:
            self.value(autodiff.value(t), [autodiff.value(each) for each in x], parameters)
        except Exception:
            return False
        return True

    @property
    def is_plain(self) -> bool:
        """True if it depends on no measure, or is a polynomial of measures and of sines and cosines of them."""
        return not self.measures or (self.formula is not None and self.formula.is_plain(set(self.picked)))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of its arguments: t, parameters, and its own names of measures and reactions."""
        return tuple(self._names)

    def check_written(self) -> None:
        """Check that code can be generated."""
        if not self.has_nodes:
            raise WrongValue(f"{self.what} must be a function that can be recorded, for equations to be written of it: it "
                             f"{self.why_called}", "not-portable")

    @property
    def tables(self) -> list[Spline]:
        """Splines of the tables that it reads, or of the one that it is."""
        if self.formula is not None:
            return self.formula.tables
        return getattr(self._function, "tables", []) if self._is_written else []

    def check_smooth(self, derivatives: int) -> None:
        """Check that tables do not jump, with 1 also that their slopes do not."""
        for each in self.tables:
            if (x := each.jump(derivatives)) is not None:
                raise WrongValue(f"{self.what} must have no jump of its speed, and that of the table jumps at "
                                 f"{each.argument} = {x:g}: "
                                 'give kind="smooth", with beyond="error", "line" or "period"', "user-function")

    def breaks(self, parameters: Mapping[str, float], span: tuple[float, float] | None = None) -> Iterable[breaks.Break]:
        """Times at which it jumps or bends, if it depends on t alone there."""
        if self.depends_on_time and self.formula is not None:
            yield from breaks.of_formula(self.formula, parameters, span)
        elif self.depends_on_time:
            for each in self.tables:
                if each.argument == "t":
                    yield from breaks.of_spline(each)

    @property
    def _is_written(self) -> bool:
        """True of a table and of functions made here, which write their nodes."""
        return type(self._function).__module__.startswith("zerodrift.") and hasattr(self._function, "written")

    @property
    def has_nodes(self) -> bool:
        """True if `written` gives its node: the computation of what is called is known to Python only."""
        return self._function is None or self.formula is not None or self._is_written

    def written(self, equations: Any, x: Iterable[Any]) -> Any:
        """Node of its value, from the nodes x of its measures."""
        known = self._known(equations.t, x, equations.parameters)
        if self.constant is not None:
            return equations.graph.number(self.constant)
        named = {name: known[name] for name in self._names}
        return self._function.written(equations, **named) if self.formula is None else self.formula.written(equations, named)

    def __getstate__(self) -> dict[str, Any]:
        """A function that could be recorded is sent as its formula, which other processes have without its module."""
        is_formula = self.formula is not None and not self._is_written
        return {**vars(self), "_function": None} if is_formula else vars(self)

    def __deepcopy__(self, known: Any) -> Law:
        other = object.__new__(Law)
        vars(other).update(vars(self))
        return other


class Expression:
    """Expression of SymPy with a function that the core lacks, as a function of its names."""

    def __init__(self, expression: Any) -> None:
        self.expression = expression

    @property
    def names(self) -> list[str]:
        """Names of its symbols."""
        return [str(symbol) for symbol in self.expression.free_symbols]

    @functools.cached_property
    def _call(self) -> Callable[..., Any]:
        import sympy

        return sympy.lambdify(list(self.expression.free_symbols), self.expression)

    def __call__(self, **x: Any) -> Any:
        return self._call(*(x[name] for name in self.names))

    def __getstate__(self) -> dict[str, Any]:
        return {"expression": self.expression}


class Component:
    """Function of vectors as one of their components: of its numbers that of this index, or its one number without an index.

    `wanted` has its arguments, each with a name, or with the names of a vector's components; it returns so many numbers.
    """

    def __init__(self, function: Callable[..., Any], wanted: Mapping[str, Any], index: int | None, size: int) -> None:
        self.function, self.wanted, self.index, self.size = function, wanted, index, size

    @property
    def names(self) -> set[str]:
        """Names of all components."""
        return {name for names in self.wanted.values() for name in ([names] if isinstance(names, str) else names)}

    def __call__(self, **x: Any) -> Any:
        result = self.function(**{argument: x[names] if isinstance(names, str) else np.array([x[name] for name in names])
                                  for argument, names in self.wanted.items()})
        if self.index is None:
            return result
        if np.shape(result) != (self.size,):
            raise WrongValue(f"the function must return {self.size} numbers, not {result!r}", "shape")
        return result[self.index]


class InputLaw:
    """The number that a run sets, in the place of a `Law`.

    It has no `__dict__`, as generated code must not depend on `initial`.
    """

    __slots__ = ("initial", "input", "is_speed", "what")

    measures: tuple[str, ...] = ()
    reactions: Mapping[str, str] = MappingProxyType({})
    names: tuple[str, ...] = ()
    tables: Sequence[Spline] = ()
    constant = formula = None
    is_plain, has_nodes, why_called, kind = True, True, "", ""
    breaks = staticmethod(lambda parameters, span: ())

    def __init__(self, name: str, initial: float, *, is_speed: bool) -> None:
        self.what, self.input, self.initial, self.is_speed = f"input {name!r}", name, initial, is_speed

    def __repr__(self) -> str:
        return f"<input {self.input}>"

    @property
    def depends_on_time(self) -> bool:
        """True of a speed, which follows the input linearly over a step."""
        return self.is_speed

    @property
    def numbers(self) -> dict[str, float]:
        """Numbers that it is computed from, by name: the input, and of a speed its rate and the time from which it counts."""
        more = {f"{self.input} rate": 0.0, f"{self.input} time": 0.0} if self.is_speed else {}
        return {self.input: self.initial, **more}

    def check_written(self) -> None:
        """Code can be generated."""

    def written(self, equations: Any, x: Iterable[Any] = ()) -> Any:
        """Node of its value."""
        numbers = [equations.parameters[name] for name in self.numbers]
        if not self.is_speed:
            return numbers[0]
        graph, (speed, rate, begin) = equations.graph, numbers
        return graph.plus(speed, graph.times(rate, graph.plus(equations.t, graph.minus(begin))))

    def number(self, t: float, x: Iterable[float], parameters: Mapping[str, Any]) -> float:
        """Initial value, before a run sets others."""
        return self.initial

    def jet(self, t: Any, x: Iterable[Any], parameters: Mapping[str, Any]) -> autodiff.Jet:
        """Initial value with its derivatives, which are zero."""
        return autodiff.Jet(self.initial)

    value = number


def _of(what: str, of: Any) -> Mapping[str, Any]:
    if of is None:
        return {}
    if not isinstance(of, Mapping) or not all(isinstance(name, str) and name.isidentifier() for name in of):
        raise WrongType(f"of= of {what} must be a dict of measures by the names of its arguments, not {checks.shown(of)}")
    return of


def _wanted(what: str, given: Callable[..., Any], allowed: list[str]) -> list[str]:
    """Names of the arguments of a callable; a NumPy function, such as np.sin, is one of t."""
    return ["t"] if isinstance(given, np.ufunc) else arguments(what, given, allowed, ", and what of= binds to measures")
