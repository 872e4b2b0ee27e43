"""Elements of a mechanism by name, and checks of arguments that are bodies, points or joints."""

from __future__ import annotations

import inspect
import keyword
import re
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from ..._private import checks
from ..._private.gateway.mechanisms.element_tables import MAX_READS
from ..._private.types import Bindings, LawLike
from ..._private.verbs import verb
from ...errors import WrongName, WrongType, WrongValue
from ...laws.table import Table
from ...systems.user_callables import arguments
from ..elements.bodies import Body, Ground, Link, Particle, Point
from ..elements.forces import Motor
from ..elements.frames import place
from ..elements.joints import Joint
from ..elements.measures import Measure
from ..elements.own_measures import OwnMeasure
from ..elements.space_bodies import SpaceGround
from ..elements.user_functions import Component, Law
from ..equations.measure_names import is_dynamic, readable, reading


class Elements:
    """Elements of a mechanism by name; the methods of `Mechanism` add to it."""

    name: str
    dimension: int

    def __init_subclass__(cls) -> None:
        """Let errors of arguments name the method."""
        for owner in (cls, Elements):
            for name, method in list(vars(owner).items()):
                if inspect.isfunction(method) and not name.startswith("_") and not hasattr(method, "__wrapped__"):
                    setattr(owner, name, verb(method))

    def __init__(self, parameters: Any) -> None:
        self.ground = SpaceGround() if self.dimension == 3 else Ground()
        self.ground._register = self._register_point
        self.parameters: dict[str, float] = {}
        self._elements: dict[str, Any] = {"ground": self.ground}
        self._shapes: dict[str, Any] = {}
        for name, value in checks.parameters(parameters).items():
            self.parameter(name, value)

    # ---- adding ----

    def parameter(self, name: str, value: float) -> None:
        """Add a user parameter, which laws name, like those of `Mechanism`.

        Parameters
        ----------
        name : str
            An identifier, since it is an argument of callables.
        value : float
            `with_parameters` makes systems with another value.

        Raises
        ------
        TypeError, ValueError
            If the name is that of time, a state or another parameter, or the value is not a finite number.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("sledge")
        >>> sledge = m.particle("sledge", 2.0, at=(0, 0))
        >>> m.parameter("mu", 0.3)
        >>> m.force("drag", sledge, along=(1, 0), value=lambda mu, v: -mu * v, of={"v": "sledge.velocity.x"})
        <force drag at sledge>
        >>> m.with_parameters(mu=0.5).parameters["mu"]
        0.5
        """
        if not next(iter(checks.parameters({name: value}))).isidentifier() or keyword.iskeyword(name):
            raise WrongValue(f"parameters must have names that a callable can take, without a dot, not {name!r}")
        if name in self.parameters:
            raise WrongValue(f"parameter {name!r} is {self.parameters[name]:g} already: with_parameters() changes it",
                             "duplicate-name")
        self.parameters[name] = checks.number(f"parameter {name!r}", value)

    def _new_name(self, name: Any, what: str) -> str:
        return checked_name(name, what, self._elements)

    def _add(self, element: Any) -> Any:
        self._elements[element.name] = element
        if isinstance(element, Body):
            element._register = self._register_point
        return element

    def _register_point(self, point: Point) -> Point:
        if point.name is not None:
            self._elements[self._new_name(point.name, "point")] = point
        return point

    def _in_the_plane(self, what: str) -> None:
        """Check that the mechanism is planar, for elements that exist in the plane only."""
        if self.dimension == 3:
            raise WrongValue(f"{what} is available for mechanisms in the plane, not in space", "wrong-dimension")

    def measure(self, name: str, value: LawLike, *, of: Bindings | None = None, unit: str = "") -> Measure:
        """Add a user-defined measure: a function of time, parameters and other measures, which acts on nothing.

        Solutions, events, outputs, plots and exports use it by its name, like other measures of accelerations.

        Parameters
        ----------
        name : str
        value : callable or SymPy expression
            Its arguments are t, parameters and measures, also reactions and accelerations, as those of the torque of `motor`.
        of : dict of str to measure
            Measures that the callable receives, by argument name.
        unit : str
            For tables and plots.

        Returns
        -------
        Measure

        Raises
        ------
        TypeError, ValueError
            If an argument of the callable is not available, or is another measure of one's own.

        Examples
        --------
        The power with which a spring pulls its second end:

        >>> import zerodrift as zd
        >>> m = zd.Mechanism("swing", gravity=(0, -9.81))
        >>> mass = m.particle("mass", 1.0, at=(0.2, -0.1))
        >>> spring = m.spring("spring", m.ground.point((0, 0)), mass, stiffness=30.0)
        >>> m.measure("power", lambda F, v: -F * v, of={"F": spring.force, "v": spring.speed}, unit="W")
        Measure('power')
        >>> sol = zd.simulate(m, 1.0, step=0.01, events=zd.Event("power"))
        >>> bool(abs(sol["power"] + sol["spring.force"] * sol["spring.speed"]).max() < 1e-12)
        True
        """
        name = self._new_name(name, "measure")
        law = self._law(f"measure {name!r}", value, of, reactions=True)
        if len(law.names) > MAX_READS:
            raise WrongValue(f"{law.what} must read at most {MAX_READS} measures, not {len(law.names)}", "out-of-range")
        return Measure(self._add(OwnMeasure(name, law, checks.instance("unit", unit, str, "a string"))).name)

    # ---- reading arguments ----

    def _named(self, argument: str, value: Any) -> Any:
        """Element of a name, also a link's start or end or a body's center; values other than strings are returned unchanged."""
        if not isinstance(value, str):
            return value
        if value in self._elements:
            return self._elements[value]
        owner, _, side = value.partition(".")
        if side in ("start", "end") and isinstance(link := self._elements.get(owner), Link):
            return getattr(link, side)
        if side == "center" and isinstance(body := self._elements.get(owner), Body):
            return body.center
        known = [*self._elements, *(f"{link.name}.{side}" for link in self._of(Link) for side in ("start", "end"))]
        raise WrongValue(f"{argument} names {value!r}, which is not an element of {self.name!r}; {checks.closest(value, known)}",
                         "wrong-name")

    def _is_own(self, element: Any) -> bool:
        return self._elements.get(element.name) is element

    def _body(self, argument: str, value: Any) -> Body:
        """Body of this mechanism, checked."""
        value = self._named(argument, value)
        checks.instance(argument, value, Body, f"a body of {self.name!r}")
        if not self._is_own(value):
            raise WrongValue(f"{argument} must be a body of {self.name!r}, and {value!r} is not: it belongs to another mechanism",
                             "wrong-element")
        return value

    def _point(self, argument: str, value: Any, *, center: bool = False) -> Point:
        """Point of this mechanism, checked; a particle is its own point, and with `center` a body means its centre of mass."""
        value = self._named(argument, value)
        if isinstance(value, Particle):
            return self._particle_point(argument, value)
        if center and isinstance(value, Body):
            return self._body(argument, value).center
        if isinstance(value, Body):
            raise WrongType(f"{argument} must be a point, not the whole body {value.name!r}: its origin is "
                            f"{value.name}.point({(0.0,) * self.dimension}), a point of the drawing {value.name}.point(at=...)",
                            "wrong-element")
        if isinstance(value, Joint):
            links = "; a link has points, and its mass may be 0" if value.kind == "rod" else ""
            raise WrongType(f"{argument} must be a point of a body, not the {value.kind} {value.name!r}, a joint{links}",
                            "wrong-element")
        checks.instance(argument, value, Point, "a point of a body, such as link.end or body.point((x, y))")
        self._body(argument, value.body)
        return value

    def _particle_point(self, argument: str, particle: Particle) -> Point:
        self._body(argument, particle)
        return Point(particle, np.zeros(self.dimension)) if particle.attachment is None else particle.attachment

    def _joint(self, argument: str, value: Any, coordinate: tuple[str, ...]) -> Joint:
        """Joint of this mechanism, checked to have one of these coordinates, "angle" or "displacement"."""
        value = self._named(argument, value)
        if isinstance(value, Measure):
            raise WrongType(f"{argument} must be a joint, not {value!r}: an angle of a body is prescribed by a constraint, as "
                            f"m.constraint(name, lambda a, t: a - 2.0 * t, of={{'a': {value.name!r}}})")
        checks.instance(argument, value, Joint, "a joint")
        if not self._is_own(value):
            raise WrongValue(f"{argument} must be a joint of {self.name!r}, and {value!r} belongs to another mechanism",
                             "wrong-element")
        if not set(value.coordinates) & set(coordinate):
            raise WrongValue(f"{argument} must be a joint with {' or '.join(coordinate)}, and {value.name!r} is a {value.kind}",
                             "wrong-element")
        particle = next((body for body in value.bodies if not body.turns), None)
        if value.coordinate == "angle" and particle is not None:
            raise WrongValue(f"{argument} {value.name!r} joins the particle {particle.name!r}, which has no angle",
                             "wrong-element")
        return value

    def _joint_angle(self, argument: str, value: Any, coordinate: tuple[str, ...]) -> tuple[Joint, str | None]:
        """The same, also of a joint of two angles by the measure of one, whose name comes second."""
        owner, _, which = (value.name if isinstance(value, Measure) else value if isinstance(value, str) else "").partition(".")
        joint = self._named(argument, owner or value)
        angles = getattr(joint, "angles", ()) if isinstance(joint, Joint) and joint.coordinate is None else ()
        if which in angles and "angle" in coordinate and self._is_own(joint):
            return joint, which if which != "angle" else None
        if len(angles) > 1 and "angle" in coordinate:
            raise WrongValue(f"{argument} must say which angle of {joint.name!r}: "
                             f"{' or '.join(f'{joint.name}.{each}' for each in angles)}", "wrong-element")
        return self._joint(argument, value, coordinate), None

    def _sides(self, name: str, first: Any, second: Any, at: Any) -> tuple[Point, Point]:
        """Points of the first and the second body that a joint connects, in the frames of their bodies."""
        first, second = self._named(f"first of {name!r}", first), self._named(f"second of {name!r}", second)
        is_body = [isinstance(side, Body) and side.turns for side in (first, second)]
        if at is not None and not all(is_body):
            raise WrongType(f"at= of {name!r} must be given with two bodies; with a point, the joint is at the point",
                            "conflicting-arguments")
        if at is not None:
            at = self._drawn("at", at)
            sides = tuple(self._body(side, value).point(at=at) for side, value in (("first", first), ("second", second)))
        else:
            sides = self._given_sides(name, first, second, is_body)
        return self._different(name, *sides)

    def _given_sides(self, name: str, first: Any, second: Any, is_body: list[bool]) -> tuple[Point, Point]:
        if all(is_body):
            raise WrongType(f"{name!r} joins two bodies, {first.name!r} and {second.name!r}: it must have at=, its position as "
                            "drawn, or a point of one of them", "missing-argument")
        if is_body[0]:
            second = self._point("second", second)
            return self._body("first", first).point(at=second.drawn), second
        first = self._point("first", first)
        return first, self._body("second", second).point(at=first.drawn) if is_body[1] else self._point("second", second)

    def _drawn(self, argument: str, value: Any) -> np.ndarray:
        """Position in the drawing, (dimension,): coordinates, or the drawn position of a point."""
        return place(argument, self._named(argument, value), self.dimension)

    def _different(self, name: str, first: Point, second: Point) -> tuple[Point, Point]:
        if first.body is second.body:
            raise WrongValue(f"{name!r} joins {first.body.name!r} to itself: first and second must belong to two bodies",
                             "wrong-element")
        return first, second

    def _turning(self, name: str, what: str, *bodies: Body) -> None:
        """Check that bodies are not particles, which have no orientation."""
        for body in bodies:
            if not body.turns:
                raise WrongValue(f"{what} {name!r} needs an orientation, and {body.name!r} is a particle, which has none",
                                 "wrong-element")

    def _direction(self, argument: str, value: Any) -> np.ndarray:
        """Direction in the drawing, (dimension,), of length one."""
        vector = checks.vector(argument, value, self.dimension)
        length = np.hypot(*vector) if self.dimension == 2 else np.linalg.norm(vector)
        if not length > 0:
            raise WrongValue(f"{argument} must be a direction in the drawing, and {tuple(map(float, vector))} has length zero",
                             "geometry")
        return vector / length

    def _law(self, what: str, given: Any, of: Mapping[str, Any] | None = None, *, positions: bool = False,
             reactions: bool = False, own: Any = None, which: str | None = None) -> Law:
        """User function whose measures exist; with `reactions`, of reactions and accelerations, too.

        `own` is the element that gets it, whose measures it may name, or the joint that the element acts on: `OWN` of its
        measures need no `of`; `which` is the angle of the joint where it has several.
        """
        elements = self._elements if own is None else {**self._elements, own.name: own}
        words = {"angle": which, "speed": f"{which}_speed"} if which else dict(zip(OWN, OWN, strict=True))
        bound = {word: f"{own.name}.{measure}" for word, measure in words.items()
                 if own is not None and reading(f"{own.name}.{measure}", elements)}
        every, dynamic = {**bound, **of} if isinstance(of, Mapping) else bound if of is None else of, []
        law = Law(what, given, of=every, parameters=self.parameters)
        for word in law.names:
            if word in bound and word in self.parameters and word not in (of or {}):
                raise WrongValue(f"{what} asks for {word!r}, which is {bound[word]!r} and a parameter of {self.name!r}: give the "
                                 f"parameter another name, or of={{{word!r}: {bound[word]!r}}}", "duplicate-name")
        for measure in law.measures:
            self._check_measured(what, measure, elements)
            read = reading(measure, elements)
            if reactions and read is None and is_dynamic(measure, elements[measure.partition(".")[0]]):
                dynamic.append(measure)
                continue
            if read is None or len(read.quantities) != 1:
                known = "" if read else f"; {checks.closest(measure, readable(elements[measure.partition('.')[0]]))}"
                kinds = "" if reactions else " of positions and velocities"
                raise WrongValue(f"{what} must depend on scalar measures{kinds}, and {measure!r} is not one{known}",
                                 "wrong-measure")
            if read.is_rate and positions:
                raise WrongValue(f"{what} must depend on measures of positions alone, and {measure!r} is a velocity",
                                 "wrong-measure")
        if dynamic:
            law.read(dynamic)
        if not reactions:
            law.check_smooth(what.split()[0] not in ("speed", "nonholonomic"))
        return law

    def _components(self, what: str, given: Any, size: int, own: Mapping[str, Any], of: Any = None) -> list[Any]:
        """A law for each direction, from a function that returns a vector, or from so many laws, of vectors and others.

        `own` has measures by the words of functions, lists of components for vectors.
        """
        def component(law: Any, index: int | None) -> Any:
            if not callable(law) or isinstance(law, Table):
                return law
            wanted = arguments(what, law, ["t", *self.parameters, *own, *(of or ())], ", and what of= binds to measures")
            if clash := {*wanted} & own.keys() & self.parameters.keys() - (of or {}).keys():
                raise WrongValue(f"{what} asks for {min(clash)!r}, which is its own and a parameter of {self.name!r}",
                                 "duplicate-name")
            return Component(law, {word: word if word in (of or ()) else own.get(word, word) for word in wanted}, index, size)

        if callable(given) and size > 1:
            return [component(given, i) for i in range(size)]
        laws = np.atleast_1d(np.array(given, dtype=object)).tolist()
        if len(laws) != size:
            raise WrongValue(f"{what} must be a function, or one law for each of {size} directions", "shape")
        return [component(each, None) for each in laws]

    def _check_measured(self, what: str, measure: str, elements: Mapping[str, Any] | None = None) -> None:
        """Check that the element of a measure exists."""
        owner, known = measure.partition(".")[0], self._elements if elements is None else elements
        if owner not in known:
            raise WrongValue(f"{what} names {measure!r}, and there is no {owner!r} in {self.name!r}; "
                             f"{checks.closest(owner, known)}", "wrong-name")
        if isinstance(known[owner], OwnMeasure):
            raise WrongValue(f"{what} must read measures of elements, and {measure!r} is one of your own: repeat its formula",
                             "wrong-measure")

    # ---- access ----

    def __getitem__(self, name: str) -> Any:
        """The element of that name."""
        if name not in self._elements:
            raise WrongName(f"nothing in {self.name} is called {name!r}; {checks.closest(name, self._elements)}", "wrong-name")
        return self._elements[name]

    def _of(self, kind: type | tuple[type, ...]) -> list[Any]:
        return [element for element in self._elements.values() if isinstance(element, kind)]

    @property
    def bodies(self) -> tuple[Body, ...]:
        """Bodies, links and particles, in the order in which they were added, without the ground."""
        return tuple(body for body in self._of(Body) if body is not self.ground)

    @property
    def joints(self) -> tuple[Joint, ...]:
        """Joints, in the order in which they were added."""
        return tuple(self._of(Joint))

    @property
    def motors(self) -> tuple[Motor, ...]:
        """Motors, in the order in which they were added."""
        return tuple(self._of(Motor))


OWN = "length", "angle", "displacement", "speed"    # measures that a law of an element has by these names
ALLOWED = re.compile(r"[A-Za-z0-9_\-]([A-Za-z0-9_\- ]*[A-Za-z0-9_\-])?")


def checked_name(name: Any, what: str, taken: Iterable[str]) -> str:
    """Name for a new element, checked: valid and unused."""
    if not isinstance(name, str):
        raise WrongType(f"name of a {what} must be a string, not {checks.shown(name)}")
    if not ALLOWED.fullmatch(name):
        raise WrongValue(f"name of a {what} must be of letters, digits, blanks inside, '_' and '-', not {name!r}")
    if name in taken:
        raise WrongValue(f"name {name!r} is taken: each element of a mechanism has a name of its own", "duplicate-name")
    return name
