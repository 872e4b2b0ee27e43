"""Snapshot of a mechanism, from which systems are made; later additions to the mechanism do not change it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from . import columns
from .bodies import Body, Particle, Point
from .contacts import switching
from .forces import Actuator
from .joints import Joint
from .numbers import Numbers
from .own_measures import OwnMeasure


class Drawing(NamedTuple):
    """All elements of a mechanism, its gravity and parameters, and its start."""

    name: str
    gravity: np.ndarray
    parameters: dict[str, float]
    elements: dict[str, Any]
    held: dict[str, Any]
    wished: dict[str, Any]
    is_balanced: bool = False       # the start is an equilibrium near the held positions
    shapes: Mapping[str, Any] = MappingProxyType({})        # radius or corners (n, dimension) of bodies that have one, m

    @property
    def dimension(self) -> int:
        """2 in the plane, 3 in space."""
        return len(self.gravity)

    def measured_at(self, owner: str) -> Any:
        """Body or point whose position a measure reads, by its name: "rod", "rod.end"; of a joint its second point."""
        element, _, end = owner.partition(".")
        found = self.elements[element]
        return found.second if isinstance(found, Joint) else getattr(found, end) if end else found

    def of(self, kind: type | tuple[type, ...]) -> list[Any]:
        """Elements of a kind, in the order in which they were added."""
        return [element for element in self.elements.values() if isinstance(element, kind)]

    @property
    def ground(self) -> Body:
        """The body that does not move."""
        return self.elements["ground"]

    @property
    def free(self) -> Drawing:
        """The drawing without constraints that switch, by which a start is assembled; the drawing itself if it has none."""
        switched = switching(self.elements.values())
        if not switched:
            return self
        others = {element.name: element.unswitched for element in switched}
        removed = {name for name, element in others.items() if element is None}
        others |= {each.name: None for each in self.elements.values()       # forces, which move no start
                   if any(name.partition(".")[0] in removed for law in each.laws.values() for name in law.reactions.values())}
        elements = {name: others.get(name, each) for name, each in self.elements.items()}
        return self._replace(elements={name: each for name, each in elements.items() if each is not None})

    def joined_points(self) -> list[Point]:
        """Points at which joints, springs and bushings connect bodies."""
        sides = (getattr(element, side, None) for element in self.elements.values() for side in ("first", "second"))
        return [point for point in sides if isinstance(point, Point)]

    def reactions(self) -> list[str]:
        """Reactions and accelerations that user functions read, by name."""
        return list(dict.fromkeys(name for law in self.laws for name in law.reactions.values()))

    @property
    def laws(self) -> list[Any]:
        """User functions of elements that act, which measures do not."""
        return [law for each in self.elements.values() if not isinstance(each, OwnMeasure) for law in each.laws.values()]

    def without_drives(self) -> Drawing:
        """The same without motors that prescribe a motion, and with no force of actuators that do, whose measures remain."""
        others = {name: each.idle if isinstance(each, Actuator) and each.prescribes else each
                  for name, each in self.elements.items() if isinstance(each, Actuator) or not getattr(each, "prescribes", False)}
        return self._replace(elements=others)

    def parts(self) -> list[Body]:
        """Bodies with their own coordinates: without the ground and particles that are attached to others."""
        return [body for body in self.of(Body)
                if body is not self.ground and not (isinstance(body, Particle) and body.attachment)]

    def numbers(self, now: Numbers) -> dict[str, float]:
        """Values of all parameters by path, and of the user's own."""
        gravity = {f"gravity.{axis}": float(value) for axis, value in zip("xyz", self.gravity, strict=False)}
        listed = {**gravity, **self.parameters}
        for element in self.elements.values():
            if hasattr(element, "numbers"):
                listed |= {f"{element.name}.{quantity}": value for quantity, value in element.numbers(now).items()}
        return listed


def inertias_of_bodies(drawing: Drawing, numbers: Numbers, combined: Callable[..., Any]) -> dict[str, Any]:
    """Inertia of each body by name: `combined` of its properties and the masses and places of the particles attached to it."""
    masses: dict[str, list[tuple[float, np.ndarray]]] = {}
    for particle in drawing.of(Particle):
        if at := particle.attachment:
            masses.setdefault(at.body.name, []).append((particle.properties(numbers).mass, at.local_with(numbers)))
    return {body.name: combined(*body.properties(numbers), masses.get(body.name, [])) for body in drawing.parts()}


class Inertias:
    """Mass, inertia and centre of mass of each body together with the particles attached to it."""

    def __init__(self, drawing: Drawing, numbers: Numbers) -> None:
        self.of: dict[str, tuple[float, float, np.ndarray]] = inertias_of_bodies(drawing, numbers, _combined)

    def is_massive(self, body: Body) -> bool:
        """True if every motion of a body has inertia."""
        mass, inertia, _ = self.of[body.name]
        return mass > 0 and (inertia > 0 or not body.turns)

    def local(self, point: Point, numbers: Numbers) -> tuple[float, float]:
        """Point relative to its body's mass centre, in the body's axes; on the ground relative to the origin."""
        place = point.local_with(numbers)
        known = self.of.get(point.body.name)
        x, y = place.tolist()       # plain numbers, as arrays of two cost ten times as much
        if known is None:
            return x, y
        com_x, com_y = known[2].tolist()
        return x - com_x, y - com_y


def _combined(mass: float, inertia: float, com: np.ndarray,
              others: list[tuple[float, np.ndarray]]) -> tuple[float, float, np.ndarray]:
    """Mass, moment of inertia and centre of a body with point masses on it."""
    if not others:
        return mass, inertia, com
    total = mass + sum(other for other, _ in others)
    if not total:
        return mass, inertia, com
    centre = (mass * com + sum(other * place for other, place in others)) / total
    shifted = [(mass, com), *others]
    apart = [(part, place - centre) for part, place in shifted]
    return total, inertia + sum(part * columns.plain((way * way).sum()) for part, way in apart), centre
