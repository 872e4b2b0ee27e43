"""Measures of groups of bodies, and the resultant on the ground: weight less the rate of the total momentum.

Forces between bodies cancel in the sum over all, so that what a mechanism exerts on the ground follows from its motion.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ..._private.gateway.mechanisms.element_tables import OutputSpec
from ..elements.bodies import Body, Particle, Point
from ..elements.forces import Gravity
from ..elements.own_measures import Group


class Sums:
    """Marker quantities of bodies and their coefficients, which are appended to `quantities`.

    Of each body the positions of its mass centre with its mass, and its angle or its spins about principal axes with the moments.
    """

    def __init__(self, tables: Any, bodies: Sequence[Body], quantities: list[Any]) -> None:
        self.tables, self.dimension = tables, tables.drawing.dimension
        self.size = self.dimension + 2 * self.dimension - 3
        self.terms: list[int] = []
        self.coefficients: list[Any] = []
        for body in bodies:
            for quantity, coefficient in self._of(body):
                self.terms.append(len(quantities))
                self.coefficients.append(coefficient)
                quantities.append(quantity)
        self.mass = sum(self.coefficients[::self.size])

    def _of(self, body: Body) -> Iterator[tuple[Any, Any]]:
        mass, inertia, com = body.properties(self.tables.numbers)
        at = body if isinstance(body, Particle) else Point(body, com)
        place = self.tables.place_quantities(at)
        yield from ((quantity, mass) for quantity in place)
        if not body.turns:
            yield from ((place[0], 0.0) for _ in range(2 * self.dimension - 3))
        elif self.dimension == 2:
            yield self.tables.angle_quantity(body), inertia
        else:
            yield from self.tables.principal_spins(body, inertia)

    def along(self, kind: str, name: str, unit: str, factor: Any, constant: Sequence[Any] = ()) -> OutputSpec:
        """Measure of the sums of positions, their rates or accelerations times the masses and a factor, plus a constant."""
        terms: list[int] = []
        coefficients: list[Any] = []
        for i in range(self.dimension):
            terms += self.terms[i::self.size]
            coefficients += [each * factor for each in self.coefficients[i::self.size]]
            if len(constant):
                terms.append(-1)
                coefficients.append(constant[i])
        return OutputSpec(name, unit, kind, len(terms) // self.dimension, len(terms), 1.0, 0, (), terms, coefficients)

    def about(self, kind: str, name: str, unit: str, scale: float, constant: Sequence[Any] = ()) -> OutputSpec:
        """Measure of the angular momentum about the origin, or of its rate less the moment of a gravity."""
        terms, coefficients = [*self.terms, *(-1 for _ in constant)], [*self.coefficients, *constant]
        return OutputSpec(name, unit, kind, self.size, len(terms), scale, 0, (), terms, coefficients)


def group_measures(tables: Any, quantities: list[Any]) -> Iterator[OutputSpec]:
    """Measures of all groups, and of the ground; none of that where gravity is a function."""
    for group in tables.drawing.of(Group):
        sums, name = Sums(tables, group.bodies, quantities), group.name
        yield sums.along("sum", f"{name}.center.position", "m", 1 / sums.mass)
        yield sums.along("sum of rates", f"{name}.center.velocity", "m/s", 1 / sums.mass)
        yield sums.along("sum of rates", f"{name}.momentum", "kg m/s", 1.0)
        yield sums.about("angular momentum", f"{name}.angular_momentum", "kg m^2/s", 1.0)
    bodies = [body for body in tables.drawing.of(Body) if body is not tables.drawing.ground]
    if bodies and not tables.drawing.of(Gravity):
        sums, gravity = Sums(tables, bodies, quantities), tables._gravity()
        yield sums.along("sum of accelerations", "ground.force", "N", -1.0, [sums.mass * each for each in gravity])
        yield sums.about("inertia torque", "ground.torque", "N m", -1.0, gravity)
