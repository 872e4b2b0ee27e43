"""Arguments of `symbolic`: checked, and converted to one form."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from typing import Any

import sympy
from sympy.core.function import AppliedUndef

from .._private import checks
from ..errors import WrongType, WrongValue
from .graph.derivation import Given
from .graph.from_sympy import Reader, namesake
from .graph.graph import MOVING, Node


class Definition:
    """Checked definition of a system: its expressions as nodes, and the values of its parameters.

    Attributes
    ----------
    expressions : dict
        All expressions that the terms are derived from; the cache key is computed from these.
    values : dict of str to float
        The parameters.
    """

    def __init__(self, coordinates: Any, kinetic: Any, potential: Any, force: Any, constraints: Any, nonholonomic: Any,
                 speeds: Any, kinematics: Any, parameters: Mapping[Any, float], time: Any, mass_and_bias: tuple[Any, Any],
                 points: Any) -> None:
        mass, bias = mass_and_bias
        self.time = _time() if time is None else time
        if not isinstance(self.time, sympy.Symbol):
            raise WrongType(f"time must be a symbol, not {time!r}")
        self.coordinates = _variables("coordinates", coordinates)
        self.rates = [q.diff(self.time) if isinstance(q, AppliedUndef) else None for q in self.coordinates]
        self._check_times()
        if (kinetic is None) == (mass is None):
            raise WrongType("either kinetic or mass is needed", "conflicting-arguments")
        if mass is None and bias is not None:
            raise WrongType("bias must be left out with kinetic, from which it is derived", "conflicting-arguments")
        self.speed_definitions = dict(speeds) if isinstance(speeds, Mapping) else {}
        self.speeds = self._speeds(speeds, kinematics)
        holonomic, names = _named("constraints", constraints, "constraint")
        rows, more = _named("nonholonomic", nonholonomic, "nonholonomic")
        self.constraint_names = tuple(names + more)
        self.values, self._parameters = _parameters(parameters)
        self.expressions = {
            "time": self.time, "coordinates": self.coordinates, "speeds": self.speeds, "meaning": self.speed_definitions,
            "kinetic": kinetic, "potential": potential, "force": self._force(force, kinematics), "holonomic": holonomic,
            "nonholonomic": rows, "kinematics": self._kinematics(kinematics), "mass": _matrix("mass", mass),
            "bias": None if bias is None else _listed("bias", bias),
            "points": [_listed(f"point {i}", point) for i, point in enumerate(_listed("points", points or ()))],
            "names": self.constraint_names, "parameters": [list(self.values), self._parameters]}
        self.coordinate_names = tuple(_name(q) for q in self.coordinates)
        self.velocity_names = tuple(f"{_name(u.expr)}_dot" if isinstance(u, sympy.Derivative) else _name(u) for u in self.speeds)
        for name in self.values:
            if name in (*self.coordinate_names, *self.velocity_names, self.time.name):
                raise WrongValue(f"parameter {name} is a coordinate, a velocity or time", "duplicate-name")

    def named(self, given: Any) -> Any:
        """Coordinates and speeds given by name, as symbols."""
        listed = _listed("quaternions", given, "coordinates")
        return [self.coordinate_names[self.coordinates.index(q)] if q in self.coordinates else q for q in listed]

    def _check_times(self) -> None:
        for q in self.coordinates:
            if isinstance(q, AppliedUndef) and q.args != (self.time,):
                raise WrongValue(f"coordinate {q} must be a function of {self.time} alone", "expression")

    def _speeds(self, speeds: Any, kinematics: Any) -> list[Any]:
        if speeds is not None:
            found = _variables("speeds", list(speeds) if isinstance(speeds, Mapping) else speeds)
            if kinematics is None and len(found) != len(self.coordinates):
                raise WrongValue(f"there are {len(found)} speeds for {len(self.coordinates)} coordinates: "
                                 "then kinematics is needed", "missing-argument")
            return found
        if kinematics is not None:
            raise WrongType("kinematics must be given with speeds=, their names", "conflicting-arguments")
        plain = [q for q, rate in zip(self.coordinates, self.rates, strict=True) if rate is None]
        if plain:
            raise WrongType(f"speeds are needed: coordinate {plain[0]} is a symbol, which has no derivative by time "
                            "(dynamicsymbols have)", "missing-argument")
        return list(self.rates)

    def _kinematics(self, given: Any) -> list[Any] | None:
        """Expressions of pdot in the speeds, one for each coordinate; None: pdot is v."""
        if given is None:
            return None
        if isinstance(given, Mapping):
            missing = [rate for rate in self.rates if rate not in given]
            if missing:
                raise WrongValue(f"kinematics has nothing for {missing[0] if missing[0] is not None else self.coordinates}",
                                 "missing-argument")
            return [given[rate] for rate in self.rates]
        matrix = sympy.Matrix(_matrix("kinematics", given))
        if matrix.shape == (len(self.coordinates), len(self.speeds)) and matrix.shape[1] > 1:
            return list(matrix * sympy.Matrix(self.speeds))
        if matrix.shape == (len(self.coordinates), 1):
            return list(matrix)
        shape = len(self.coordinates), len(self.speeds)
        raise WrongValue(f"kinematics must have one expression for each of {shape[0]} coordinates, or be a matrix of "
                         f"shape {shape}, not {matrix.shape}", "shape")

    def _force(self, given: Any, kinematics: Any) -> list[Any] | None:
        if given is None:
            return None
        if isinstance(given, Mapping):
            force: list[Any] = [0] * len(self.speeds)
            for key, value in given.items():
                places = [i for names in (self.speeds, [] if kinematics is not None else self.coordinates)
                          for i, name in enumerate(names) if name == key]
                if not places:
                    raise WrongValue(f"force must be given for velocities: {key} is not one"
                                     f"{namesake(key, [*self.speeds, *self.coordinates])}", "wrong-name")
                force[places[0]] = value
            return force
        force = _listed("force", given)
        if len(force) != len(self.speeds):
            raise WrongValue(f"force must have {len(self.speeds)} entries, one for each velocity, not {len(force)}", "shape")
        return force

    # ---- nodes ----

    def read(self) -> tuple[Reader, Given]:
        """All expressions except those of the drawing, converted to nodes."""
        reader, e = Reader(), self.expressions
        graph, nq, nv = reader.graph, len(self.coordinates), len(self.speeds)
        self.placed = self._known(reader)
        v = [graph.leaf("v", i) for i in range(nv)]
        moving = self.placed | dict(zip(self.speeds, v, strict=True))

        def each(what: str, expressions: Sequence[Any], known: Mapping[Any, Node]) -> list[Node]:
            return [reader.read(f"{what} {i}" if len(expressions) > 1 else what, x, known) for i, x in enumerate(expressions)]

        A, pdot = None, v
        if e["kinematics"] is not None:
            pdot = each("kinematics", e["kinematics"], moving)
            A = [[graph.derivative_along({u: graph.one})(row) for u in v] for row in pdot]
            self._check_kinematics(graph, A, pdot, v)
        moving |= {rate: node for rate, node in zip(self.rates, pdot, strict=True) if rate is not None and rate not in moving}
        given = Given(
            nq, nv, A,
            kinetic=None if e["kinetic"] is None else reader.read("kinetic", e["kinetic"], self._for_energy(reader, moving)),
            mass=None if e["mass"] is None else [each(f"mass, row {i}, entry", row, moving) for i, row in enumerate(e["mass"])],
            bias=None if e["bias"] is None else each("bias", e["bias"], moving),
            force=None if e["force"] is None else each("force", e["force"], moving),
            potential=None if e["potential"] is None else reader.read("potential", e["potential"], moving),
            holonomic=each("constraints", e["holonomic"], moving), nonholonomic=each("nonholonomic", e["nonholonomic"], moving))
        self._check_stages(given)
        return reader, given

    def _known(self, reader: Reader) -> dict[Any, Node]:
        """Nodes of time, coordinates and parameters, by their symbols."""
        graph = reader.graph
        known: dict[Any, Node] = {self.time: graph.leaf("t", 0)}
        known |= {q: graph.leaf("p", i) for i, q in enumerate(self.coordinates)}
        taken = {*known, *self.speeds}
        by_name: dict[str, Any] = {}
        for symbol in sorted(_symbols(self.expressions) - taken, key=str):
            if symbol.name not in self.values:
                continue
            if by_name.setdefault(symbol.name, symbol) != symbol:
                raise WrongValue(f"there are two different symbols named {symbol.name!r} (their assumptions differ)",
                                 "duplicate-name")
            known[symbol] = graph.leaf("parameter", list(self.values).index(symbol.name))
        return known

    def _for_energy(self, reader: Reader, moving: Mapping[Any, Node]) -> dict[Any, Node]:
        """Nodes of the symbols of `kinetic`; with `kinematics`, rates of coordinates and speeds defined by these."""
        if self.expressions["kinematics"] is None:
            return dict(moving)
        rates = {rate: reader.graph.leaf("rate", i) for i, rate in enumerate(self.rates) if rate is not None}
        known = self.placed | rates
        speed_definitions = {u: reader.read(f"speed {u}", value, known) for u, value in self.speed_definitions.items()}
        used = {u for u in self.speeds if u not in speed_definitions and sympy.sympify(self.expressions["kinetic"]).has(u)}
        if used:
            raise WrongValue(f"kinetic has speed {min(used, key=str)}, and there are kinematics: write it with derivatives of "
                             "coordinates, or define this speed in the dict speeds", "expression")
        return known | speed_definitions

    @staticmethod
    def _check_kinematics(graph: Any, A: list[list[Node]], pdot: list[Node], v: list[Node]) -> None:
        at_rest = graph.substitution(dict.fromkeys(v, graph.zero))
        for i, row in enumerate(A):
            if any(entry.stage >= MOVING for entry in row) or at_rest(pdot[i]) is not graph.zero:
                raise WrongValue(f"kinematics {i} must be linear in the speeds, pdot = A v, with nothing added", "expression")

    def _check_stages(self, given: Given) -> None:
        for i, row in enumerate(given.holonomic):
            if row.stage >= MOVING:
                raise WrongValue(f"constraint {self.constraint_names[i]!r} must not depend on velocities: take nonholonomic",
                                 "expression")
        if given.mass is not None:
            if {len(given.mass), *map(len, given.mass)} != {given.nv}:
                raise WrongValue(f"mass must have shape {(given.nv, given.nv)}", "shape")
            if any(entry.stage >= MOVING for row in given.mass for entry in row):
                raise WrongValue("mass must not depend on velocities", "expression")
            if given.bias is not None and len(given.bias) != given.nv:
                raise WrongValue(f"bias must have {given.nv} entries, not {len(given.bias)}", "shape")

    def check_linearity(self, terms: Mapping[str, list[Node]]) -> None:
        """Refuses nonholonomic constraints that are not linear."""
        nv = len(self.speeds)
        for place, node in enumerate(terms.get("C", ())):
            if node.stage >= MOVING:
                raise WrongValue(f"constraint {self.constraint_names[place // nv]!r} must be linear in the velocities",
                                 "expression")

    def drawing(self, reader: Reader) -> list[list[Node]]:
        """Points of the drawing, converted to nodes."""
        given = self.expressions["points"]
        points = [[reader.read(f"point {i}", x, self.placed) for x in point] for i, point in enumerate(given)]
        if points and (len(points[0]) not in (2, 3) or any(len(point) != len(points[0]) for point in points)):
            raise WrongValue("points must all have two or three coordinates", "shape")
        return points

    def heading(self) -> list[str]:
        """Comment of the C source: names of the entries of p, of v, and of the parameters."""
        rows = [("p", self.coordinate_names), ("v", self.velocity_names), ("k", tuple(self.values))]
        return [f"{letter}: {', '.join(names)}" for letter, names in rows if names]


def _time() -> sympy.Symbol:
    """Symbol of time of `dynamicsymbols` if the caller has imported `sympy.physics`, otherwise the symbol t."""
    vector = sys.modules.get("sympy.physics.vector")
    return vector.dynamicsymbols._t if vector else sympy.Symbol("t")


def _variables(what: str, given: Any) -> list[Any]:
    found = [given] if isinstance(given, sympy.Expr) else _listed(what, given, "symbols or functions of time")
    for each in found:
        if not isinstance(each, sympy.Symbol | AppliedUndef | sympy.Derivative):
            raise WrongType(f"{what} must be symbols or functions of time, not {each!r}")
    if not found or len(set(found)) != len(found):
        raise WrongValue(f"{what} must be different symbols, at least one, not {given!r}", "duplicate-name")
    return found


def _listed(what: str, given: Any, of: str = "expressions") -> list[Any]:
    try:
        return list(given)
    except TypeError:
        raise WrongType(f"{what} must be a sequence of {of}, not {given!r}") from None


def _named(what: str, given: Any, word: str) -> tuple[list[Any], list[str]]:
    if isinstance(given, Mapping):
        return list(given.values()), [str(name) for name in given]
    found = [given] if isinstance(given, sympy.Expr | sympy.Equality) else _listed(what, () if given is None else given)
    return found, [f"{word}{i}" for i in range(len(found))]


def _parameters(given: Mapping[Any, float]) -> tuple[dict[str, float], list[Any]]:
    """Parameter values by name, and the symbols that were given as keys."""
    if not isinstance(given, Mapping):
        raise WrongType(f"parameters must be a dict of symbols or names and their values, not {given!r}")
    values: dict[str, float] = {}
    for key, value in given.items():
        if not isinstance(key, str | sympy.Symbol):
            raise WrongType(f"parameters must be symbols or names, not {key!r}")
        name = key if isinstance(key, str) else key.name
        if name in values:
            raise WrongValue(f"there are two parameters named {name!r}", "duplicate-name")
        values[name] = checks.number(f"parameter {name!r}", value)
    return values, [key for key in given if isinstance(key, sympy.Symbol)]


def _matrix(what: str, given: Any) -> list[list[Any]] | None:
    try:
        return None if given is None else sympy.Matrix(given).tolist()
    except (TypeError, ValueError):
        raise WrongType(f"{what} must be a matrix, or a sequence of rows of equal length, not {given!r}",
                        "shape") from None


def _symbols(what: Any) -> set[Any]:
    """The free symbols of expressions in mappings and sequences."""
    if isinstance(what, Mapping):
        return set().union(*(_symbols(each) for pair in what.items() for each in pair)) if what else set()
    if isinstance(what, sympy.Basic):
        return what.free_symbols
    if isinstance(what, Sequence) and not isinstance(what, str):
        return set().union(*map(_symbols, what)) if what else set()
    return set()


def _name(variable: Any) -> str:
    return variable.name if isinstance(variable, sympy.Symbol) else type(variable).__name__
