"""SymPy expressions of the motion: what they are functions of, and the programs that compute them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from ..._private import gateway
from ..._private.gateway.compiled import programs
from ..._private.gateway.known_events import NUMBER, TIME, VELOCITY, Reading
from ...errors import WrongValue
from ...symbolics.elimination.steps import Unwritten
from ...symbolics.emit import program_writer
from ...symbolics.graph.from_sympy import Reader
from ...symbolics.graph.lowering import Lowering
from ...systems.base import BaseSystem, core_of


class Read(NamedTuple):
    """Expression in scalar quantities of the motion."""

    expression: Any             # in the symbols `atoms`
    atoms: list[Any]            # symbols of the expression
    readings: list[Reading]     # quantity that each symbol stands for
    parameters: frozenset[str]  # names of the parameters of the system that occur


def read(what: str, given: Any, system: BaseSystem, of: Mapping[str, Any], *, is_dynamic: bool = False) -> Read:
    """Identify the names in an expression: t, coordinates, velocities, measures, parameters, and the names bound by `of`.

    `is_dynamic`: reactions and accelerations are accepted, too.
    """
    import sympy  # slow to import

    found: dict[Any, Reading] = {}
    parameters = set()
    for each in sorted(_atoms(sympy.sympify(given)), key=str):
        name = str(each.func) if each.is_Function else str(each)
        if each.is_Derivative:
            found[each] = _rate(what, each, system)
        elif name == "t":
            found[each] = Reading(TIME)
        elif name in of:
            found[each] = system._reading(getattr(of[name], "name", of[name]), f"of[{name!r}] of {what}", is_dynamic=is_dynamic)
        elif name in system.parameters and np.ndim(system.parameters[name]) == 0:
            found[each] = Reading(NUMBER, number=float(system.parameters[name]))
            parameters.add(name)
        else:
            found[each] = system._reading(name, what, is_dynamic=is_dynamic)
    atoms = [sympy.Symbol(f"x{i}", real=True) for i in range(len(found))]
    expression = sympy.sympify(given).xreplace(dict(zip(found, atoms, strict=True)))
    return Read(expression, atoms, list(found.values()), frozenset(parameters))


def _atoms(expression: Any) -> set[Any]:
    """Set of symbols, functions of time and their derivatives in an expression; the argument of a derivative is not listed."""
    from sympy.core.function import AppliedUndef, Derivative

    if isinstance(expression, AppliedUndef | Derivative) or expression.is_Symbol:
        return {expression}
    return set().union(*map(_atoms, expression.args))


def _rate(what: str, derivative: Any, system: BaseSystem) -> Reading:
    """Velocity that is the derivative of a coordinate."""
    coordinates = [variable.name for variable in system.coordinates]
    name = str(getattr(derivative.expr, "func", derivative.expr))
    has_rates = core_of(system).provides & gateway.TERMS["A"].bit
    if has_rates or derivative.derivative_count != 1 or name not in coordinates:
        raise WrongValue(f"{what} has {derivative}, which must be a velocity of {system.name}: "
                         f"{', '.join(variable.name for variable in system.velocities)}", "expression")
    return Reading(VELOCITY, coordinates.index(name))


def line(of: Read) -> tuple[float, float] | None:
    """Slope and constant of a linear function of one quantity; None: it is another function."""
    if len(of.atoms) != 1 or of.readings[0].what in (TIME, NUMBER):
        return None
    slope = of.expression.diff(of.atoms[0])
    if not (slope.is_number and slope.is_real and slope):
        return None
    return float(slope), float(of.expression.xreplace({of.atoms[0]: 0}))


def program(what: str, of: Read) -> tuple[tuple[Any, Any], list[Reading]] | None:
    """A `zd_expressions` of the readings with what it refers to, and its readings; None: the core lacks a function.

    Raises
    ------
    ValueError
        If there is anything else in the expression; `what` it is, is named.
    """
    key = of.expression, *of.atoms
    if key not in _programs:
        reader = Reader()
        node = reader.read(what, of.expression, {atom: reader.graph.leaf("parameter", i) for i, atom in enumerate(of.atoms)})
        lowering = Lowering(reader.graph)
        try:
            written = program_writer.expressions(lowering, [lowering.lower(node)], len(of.atoms))
        except Unwritten:
            return None
        _programs[key] = programs.expressions(written), written.literals
    found, literals = _programs[key]
    return found, [*of.readings, *(Reading(NUMBER, number=each) for each in literals)]


_programs: dict[tuple[Any, ...], tuple[Any, list[float]]] = {}    # by expression and atoms


def in_python(of: Read) -> Callable[..., float]:
    """Python function of the readings for an expression with a function that the core lacks."""
    import sympy

    function = sympy.lambdify(of.atoms, of.expression, "math")
    return lambda *x: float(function(*x))
