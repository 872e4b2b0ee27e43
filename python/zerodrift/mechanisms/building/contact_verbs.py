"""Methods of `Mechanism` for contacts and stops."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..._private import checks
from ..._private.types import Expression, MeasureLike
from ...errors import WrongType, WrongValue
from ..elements.bodies import Body, Point
from ..elements.contacts import Compliance, Contact, Latch, LineContact, PlaneContact, RoundContact, SphereContact, Stop
from ..elements.frames import Circle, Line, Plane, Sphere
from ..elements.immutable import amend
from ..elements.joints import Joint
from ..elements.measures import Measure, name_of
from ..elements.numbers import AS_GIVEN
from ..elements.space_joints import TABLE
from ..elements.switches import Switched
from ..equations.measure_names import checked_reading
from .registry import Elements

if TYPE_CHECKING:
    from ...runs.arguments.events import Event

Friction = float | tuple[float, float]

# Contacts by the kinds of shapes of each dimension, and the verbs that make these.
SHAPES: dict[int, tuple[dict[type, Any], str]] = {
    2: ({Line: LineContact, Circle: RoundContact},
        "body.line(a, b), body.segment(a, b), body.circle(center, radius) or body.arc(center, a, b)"),
    3: ({Plane: PlaneContact, Sphere: SphereContact}, "body.plane(point, normal) or body.sphere(center, radius)")}


class ContactVerbs(Elements):
    """One-sided constraints and latches."""

    def contact(self, name: str, first: Body | Point | str, shape: Line | Circle | Plane | Sphere, *, radius: float = 0.0,
                restitution: float = 0.0, friction: Friction = 0.0, stiffness: float | None = None, damping: float = 0.0,
                exponent: float = 1.0) -> Contact:
        """Add a contact of a point or a round body with a shape of another body: it may rest, slide, stick, roll, lift off
        and bounce.

        Parameters
        ----------
        name : str
        first : Point, Body or name
            The point that touches, or with `radius` the centre of the round body.
        shape : Line, Circle, Plane or Sphere
            Made by its body: in the plane `Body.line`, free on its left side, `Body.segment`, `Body.circle` or `Body.arc`; in
            space `Body.plane`, free on the side of its normal, or `Body.sphere`.
        radius : float
            Radius of the round body, in m.
        restitution : float
            Coefficient of restitution, 0 to 1.
        friction : float or (float, float)
            Coefficient of friction; or the coefficients of static and of sliding friction.
        stiffness, damping, exponent : float
            Law of a compliant contact instead, after Hunt and Crossley: its force at a depth d is
            ``stiffness * d**exponent * (1 + damping * d')``, at least 0; damping in s/m. It has no restitution
            and no friction. The nearest point of a segment or an arc pushes a round body away, from both sides.

        Returns
        -------
        Contact
            Its `force` acts on `first`, friction included, in the drawing's axes.

        Raises
        ------
        ValueError, TypeError
            For a wrong argument; a start that penetrates is an error of the run.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("ball", gravity=(0, -9.81))
        >>> ball = m.particle("ball", 1.0, at=(0, 1))
        >>> m.contact("floor", ball, m.ground.line((0, 0), (1, 0)), restitution=0.8).force
        VectorMeasure('floor.force')
        """
        name = self._new_name(name, "contact")
        kinds, verbs = SHAPES[self.dimension]
        kind = kinds.get(type(shape))
        if kind is None:
            raise WrongType(f"shape of {name!r} must be a shape of a body, {verbs}, not {checks.shown(shape)}")
        radius = checks.number(f"radius of {name!r}", radius, least=0)
        if isinstance(shape, Circle | Sphere) and not shape.outside and not radius < shape.radius:
            raise WrongValue(f"radius of {name!r} must be less than that of the hole, and {radius:g} is not less than "
                             f"{shape.radius:g}", "out-of-range")
        if isinstance(shape, Circle | Sphere) and not radius and not shape.radius:
            raise WrongValue(f"radius of {name!r} must be greater than 0 for a {type(shape).__name__.lower()} of radius 0",
                             "out-of-range")
        given = self._named("first", first)
        if isinstance(given, Body) and given.turns:
            given = self._body("first", given).point(np.zeros(self.dimension))
        point = self._point("first", given)
        self._body(f"body of the shape of {name!r}", shape.body)
        one, other = self._different(name, shape.body.point(shape.start), point)
        self._turning(name, "line of", one.body)
        if radius or any(checks.friction(f"friction of {name!r}", friction)):
            self._turning(name, "friction or radius of", *(body for body in (other.body,) if radius))
        e, mu = checks.restitution(f"restitution of {name!r}", restitution), checks.friction(f"friction of {name!r}", friction)
        made = kind(name, one, other, radius, shape, e, mu, _compliance(name, stiffness, damping, exponent))
        if made.compliance and (restitution or any(made.friction) or (made.bounds(AS_GIVEN) and not radius)):
            raise WrongType(f"{name!r} with stiffness= must have no restitution, no friction, and radius= for a shape with ends",
                            "conflicting-arguments")
        return self._add(made)

    def stop(self, name: str, measure: Measure | str, *, lower: float | None = None, upper: float | None = None,
             restitution: float = 0.0, stiffness: float | None = None, damping: float = 0.0,
             exponent: float = 1.0) -> Stop:
        """Keep a measure within limits, as an end stop or a slack rope does; or a rate, as a one-way clutch or a
        speed limit does.

        Parameters
        ----------
        name : str
        measure : Measure or name
            Scalar measure of positions or velocities: an angle, a displacement, a length, a coordinate of a point, a speed.
        lower, upper : float, optional
            Limits, in the unit of the measure; at least one.
        restitution : float
            Coefficient of restitution, 0 to 1; 0 for a rate.
        stiffness, damping, exponent : float
            Law of a compliant stop instead, after Hunt and Crossley: its effort at a depth d is
            ``stiffness * d**exponent * (1 + damping * d')``, at least 0; damping in s/m or s/rad.
            It has no restitution.

        Returns
        -------
        Stop
            Its `force`, or its `torque` if the measure is an angle or its rate, acts on the measure and is positive upward.

        Raises
        ------
        ValueError, TypeError
            For a wrong argument; a start beyond a limit is an error of the run.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("buffer")
        >>> block = m.body("block", 1.0, 0.1)
        >>> slide = m.prismatic("slide", m.ground, block, axis=(1, 0))
        >>> m.stop("wall", slide.displacement, upper=0.12, restitution=0.4)
        <stop wall: slide.displacement>
        """
        name = self._new_name(name, "stop")
        of = name_of(measure, f"measure of {name!r}")
        read = checked_reading(f"measure of stop {name!r}", of, 0.0, self._elements)
        if read.is_rate and restitution:
            raise WrongValue(f"restitution of stop {name!r} must be 0, as {of!r} is a rate", "conflicting-arguments")
        lower, upper = (None if value is None else checks.number(f"{word} of {name!r}", value)
                        for word, value in (("lower", lower), ("upper", upper)))
        if lower is None and upper is None:
            raise WrongType(f"stop {name!r} must have lower=, upper= or both", "missing-argument")
        if lower is not None and upper is not None and not lower < upper:
            raise WrongValue(f"lower of {name!r} must be less than upper, and {lower:g} is not less than {upper:g}",
                             "out-of-range")
        quantity, = read.quantities
        effort = "torque" if "ang" in quantity.rpartition(".")[2] else "force"
        compliance = _compliance(name, stiffness, damping, exponent)
        if compliance and (restitution or read.is_rate):
            raise WrongType(f"stop {name!r} with stiffness= must be of positions, and have no restitution",
                            "conflicting-arguments")
        restitution = checks.restitution(f"restitution of {name!r}", restitution)
        return self._add(Stop(name, of, lower, upper, restitution, effort, quantity, read.is_rate, compliance))


    def latch(self, name: str, joint: Joint | str, *, when: MeasureLike | Expression | Event | None = None,
              until: Any = None) -> Latch:
        """Join a joint at one event and release it at another.

        Parameters
        ----------
        name : str
        joint : Joint or name
            A joint made with ``active=``. It joins the bodies in their current position, with a plastic impact (25b),
            listed in `Solution.impacts`.
        when, until : measure, text, SymPy expression or Event, optional
            Quantities: the joint is joined when the first crosses zero upward, and released when the second does. A text
            contains names of measures, of which the longest match counts, numbers, + - * / and brackets.

        Returns
        -------
        Latch

        Raises
        ------
        ValueError, TypeError
            For a joint without ``active=``; a text that is not an expression is an error of the run.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("wheel")
        >>> wheel = m.body("wheel", 1.0, 0.1)
        >>> axle = m.revolute("axle", m.ground, wheel, at=(0, 0))
        >>> pawl = m.weld("pawl", m.ground, wheel, at=(0, 0), active=False)
        >>> m.latch("catch", pawl, when="axle.angle - 0.5")
        <latch catch: pawl>
        >>> m.start({"wheel.angular_velocity": 1.0})
        >>> sol = zd.simulate(m, 1.0)
        >>> [float(round(each, 9)) for each in (sol.impacts["t"][0], sol[axle.angle][-1], sol.impacts["energy_lost"][0])]
        [0.5, 0.5, 0.05]
        """
        name = self._new_name(name, "latch")
        joint = self._named(f"joint of {name!r}", joint)
        if not isinstance(joint, Joint) or joint.switched is None or joint.switched.active is None:
            raise WrongValue(f"joint of latch {name!r} must be one that was made with active=True or active=False",
                             "wrong-element")
        when, until = (given.name if isinstance(given, Measure) else given for given in (when, until))
        return self._add(Latch(name, joint.name, when, until))


# Arguments of joints that switch: kinds of joints that take them, all if there are none; and their type.
BOUND = "float | tuple[float, float] | None"
SWITCHED: dict[str, tuple[tuple[str, ...], str]] = {
    "friction_torque": (("revolute",), BOUND), "friction_force": (("prismatic",), BOUND),
    "friction": (("revolute", "prismatic"), BOUND), "radius": (("revolute",), "float | None"),
    "guide": (("prismatic",), "float | None"), "active": ((), "bool | None")}


def with_switches(m: Elements, joint: Joint, given: Mapping[str, Any]) -> Joint:
    """The joint with dry friction, or one that can be released and joined, by the arguments of its verb."""
    if not given:
        return joint
    name = joint.name
    values: dict[str, Any] = {}
    if "active" in given:
        values["active"] = checks.instance(f"active of {name!r}", given["active"], bool, "True or False")
    for word in ("friction_torque", "friction_force", "friction"):
        if word in given:
            values["friction" if word == "friction" else "bounds"] = checks.friction(f"{word} of {name!r}", given[word])
    if len({"bounds", "friction"} & values.keys()) > 1:
        raise WrongType(f"friction of {name!r} must be given by its load or by bounds, not both", "conflicting-arguments")
    if ("radius" in given or "guide" in given or joint.coordinate == "angle") and ("radius" in given) != (
            "friction" in values and joint.coordinate == "angle"):
        raise WrongType(f"friction of {name!r} must be given with radius=, that of the pin", "missing-argument")
    values |= {word: checks.number(f"{word} of {name!r}", given[word], above=0) for word in ("radius", "guide") if word in given}
    joint._switched = Switched(**values)
    if joint._switched.needs_rows:
        amend(joint, cut=True)
    if joint._switched.friction and joint.dimension == 3 and joint.coordinate == "angle":
        amend(joint, row=TABLE["bearing"])     # its first multipliers are the radial force
    return joint


def _compliance(name: str, stiffness: Any, damping: Any, exponent: Any) -> Compliance | None:
    """Law of a compliant contact, checked; None: it is rigid."""
    if stiffness is None:
        if damping or exponent != 1.0:
            raise WrongType(f"damping= and exponent= of {name!r} must be given with stiffness=, of a compliant contact or stop",
                            "conflicting-arguments")
        return None
    return Compliance(checks.number(f"stiffness of {name!r}", stiffness, above=0),
                      checks.number(f"damping of {name!r}", damping, least=0),
                      checks.number(f"exponent of {name!r}", exponent, least=1))
