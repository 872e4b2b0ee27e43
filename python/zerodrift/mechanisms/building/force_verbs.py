"""Methods of `Mechanism` that add drives, springs, dampers and loads."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..._private import checks
from ..._private.types import ArrayLike, Bindings, LawLike
from ...errors import WrongType, WrongValue
from ..elements.bodies import Body, Particle, Point
from ..elements.forces import Actuator, Force, Motor, Torque
from ..elements.joints import Joint
from ..elements.measures import Measure
from .registry import Elements

VECTORS = {2: "(0.0, -10.0)", 3: "(0.0, 0.0, -10.0)"}      # examples in messages
DRIVES = {"angle": ("angle",), "displacement": ("displacement",), "speed": ("angle", "displacement"), "torque": ("angle",),
          "force": ("displacement",)}


class ForceVerbs(Elements):
    """Methods of `Mechanism` that add drives, springs and forces.

    A callable that gives a force or a motion receives its arguments by name: ``t``, parameters, and the measures that ``of=``
    binds to names. It is recorded, if possible: its computation becomes a formula that the core evaluates like an expression.
    Numbers that it reads from outside keep the values that they have when `simulate` or `Run` makes the mechanism's system;
    ``inputs=`` changes numbers within a run. A function with state, random numbers, conversions (``int``, ``round``), ``try``,
    or calls of other libraries is called instead, up to ninety times slower, and cannot be compiled, saved or exported;
    ``print(m)`` gives the reason.
    """

    def motor(self, name: str, joint: Joint | Measure | str, *, angle: LawLike | None = None, displacement: LawLike | None = None,
              speed: LawLike | None = None, torque: LawLike | None = None, force: LawLike | None = None,
              of: Bindings | None = None, rotor: float = 0.0, ratio: float = 1.0) -> Motor:
        """Drive a joint.

        Parameters
        ----------
        name : str
        joint : Joint, measure or name
            Joint with an angle or a displacement; or one of two angles, such as ``universal.angle1``.
        angle, displacement : float, callable or SymPy expression of t
            Prescribed coordinate of the joint, in rad or m, zero in the drawing; t counts from 0. Callables use NumPy's
            functions.
        speed : float, callable or expression
            The rate of that coordinate, in rad/s or m/s: a number, or a function of t, parameters and measures of positions.
        torque, force : float, callable or expression
            Torque or force on the joint's second body, with the opposite on the first, in N m or N; a function of t, parameters
            and measures of positions and velocities, and of reactions and accelerations, such as ``"pin.force.x"``. Reactions
            are solved for together with the accelerations; `NoUniqueMotion` is raised where they have no unique solution.
        of : dict of str to measure
            Measures that the callable receives, by argument name. The joint's own ``angle`` or ``displacement``, and ``speed``,
            need none: ``torque=lambda speed: 3 - 0.1 * speed``.
        rotor : float
            Moment of inertia J of the motor's rotor about the joint's axis in kg m^2: it adds the energy ``J * (a.w1 + ratio *
            q')**2 / 2``, with the axis a, the first body's angular velocity w1, and q the joint's angle or, in space,
            displacement; an angle of a universal joint has none. The rotor's mass and its transverse inertia must be included
            in the first body. It is a body without mass, ``"name rotor"``, that turns about ``"name shaft"`` by
            ``"name gear"``.
        ratio : float
            Angle of the rotor for q = 1, in rad/rad or rad/m; negative where it turns the other way.

        Returns
        -------
        Motor

        Raises
        ------
        TypeError, ValueError
            If not exactly one of the five is given, the joint has no such coordinate, another motor prescribes its motion
            already, or a callable has an argument that is not available.

        Examples
        --------
        >>> import numpy as np
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("crank")
        >>> crank = m.link("crank", (0, 0), (1, 0), mass=1.0)
        >>> pin = m.revolute("pin", m.ground, crank.start)
        >>> m.motor("drive", pin, angle=lambda t: 0.5 * np.sin(3 * t))
        <motor drive: angle of pin>
        """
        name = self._new_name(name, "motor")
        given = {"angle": angle, "displacement": displacement, "speed": speed, "torque": torque, "force": force}
        words = [word for word, value in given.items() if value is not None]
        if len(words) != 1:
            raise WrongType(f"motor {name!r} must have one of {', '.join(given)}, not {' and '.join(words) or 'none'}",
                            "conflicting-arguments")
        drives = words[0]
        joint, which = self._joint_angle(f"joint of motor {name!r}", joint, DRIVES[drives])
        if joint.coordinate is None and drives == "speed" and which is None:
            raise WrongValue(f"motor {name!r}: joint {joint.name!r} has two coordinates, {' and '.join(joint.coordinates)}; give "
                             "displacement= or angle= instead of speed=", "missing-argument")
        is_effort = drives in ("torque", "force")
        law = self._law(f"{drives} of motor {name!r}", given[drives], of, positions=not is_effort, reactions=is_effort,
                        own=joint if is_effort else None, which=which)
        if drives in ("angle", "displacement") and law.measures:
            raise WrongValue(f"{law.what} must be a function of t, and depends on {', '.join(law.measures)}: use constraint()",
                             "user-function")
        motor = Motor(name, joint, drives, law, which)
        rival = next((other for other in self.motors if other.joint is joint and other.prescribes
                      and other.coordinate == motor.coordinate), None)
        if motor.prescribes and rival is not None:
            raise WrongValue(f"motors {rival.name!r} and {name!r} both prescribe {joint.name!r}: one freedom takes one motor",
                             "prescribed-twice")
        if checks.number(f"rotor of motor {name!r}", rotor, least=0):
            self._add_rotor(motor, rotor, ratio)
        return self._add(motor)

    def _add_rotor(self: Any, motor: Motor, inertia: float, ratio: float) -> None:
        """Add a body that turns on the first body about the joint's axis, geared to the coordinate that the motor drives."""
        joint, at, axis = motor.joint, motor.joint.second.drawn, {}
        if not checks.number(f"ratio of motor {motor.name!r}", ratio):
            raise WrongValue(f"ratio of motor {motor.name!r} must not be 0", "out-of-range")
        if motor.which or (self.dimension == 2 and motor.coordinate != "angle"):
            raise WrongValue(f"rotor of motor {motor.name!r} needs an axis that turns with the first body: of an angle, or in "
                             "space of a displacement", "wrong-element")
        if self.dimension == 3:
            axis = {"axis": joint.axis_as_drawn()}
            inertia = inertia * np.outer(axis["axis"], axis["axis"])
        body = self.body(f"{motor.name} rotor", 0.0, inertia, at=at)
        shaft = self.revolute(f"{motor.name} shaft", joint.bodies[0], body, at=at, **axis)
        if motor.coordinate == "angle":
            self.gear(f"{motor.name} gear", joint, shaft, ratio=ratio)
        else:
            self.rack_pinion(f"{motor.name} gear", shaft, joint, ratio=1 / ratio)

    def actuator(self, name: str, first: Point | Particle | str, second: Point | Particle | str, *, length: LawLike | None = None,
                 force: LawLike | None = None, of: Bindings | None = None) -> Actuator:
        """Drive two points apart or together, as a hydraulic cylinder does.

        Parameters
        ----------
        name : str
        first, second : Point, Particle or name
        length : float, callable or SymPy expression of t
            The distance of the points, in m; t counts from 0. Callables use NumPy's functions.
        force : float, callable or expression
            Force that pushes the points apart, in N; a function of the same as the torque of `motor`.
        of : dict of str to measure
            Measures that the callable receives, by argument name. The actuator's own ``length`` and ``speed`` need none:
            ``force=lambda length, speed: -100 * (length - 0.3) - 5 * speed`` is a spring and a damper, since a positive
            force pushes.

        Returns
        -------
        Actuator

        Raises
        ------
        TypeError, ValueError
            If not exactly one of length and force is given, or a callable has an argument that is not available.

        Examples
        --------
        >>> import numpy as np
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("digger")
        >>> arm = m.link("arm", (0, 0), (2, 0), mass=100.0)
        >>> hinge = m.revolute("hinge", m.ground, arm.start)
        >>> m.actuator("cylinder", m.ground.point((0, -1)), arm.point((1, 0)), length=lambda t: 1.4 + 0.1 * np.sin(t))
        <actuator cylinder: length between ground and arm>
        """
        name = self._new_name(name, "actuator")
        first, second = self._different(name, self._point("first", first), self._point("second", second))
        if (length is None) == (force is None):
            raise WrongType(f"actuator {name!r} must have length or force, not {'neither' if length is None else 'both'}",
                            "conflicting-arguments")
        drives, given = ("length", length) if force is None else ("force", force)
        law = self._law(f"{drives} of actuator {name!r}", given, of, reactions=drives == "force",
                        own=Actuator(name, first, second, drives, None) if drives == "force" else None)
        if drives == "length" and law.measures:
            raise WrongValue(f"{law.what} must be a function of t, and depends on {', '.join(law.measures)}: use constraint()",
                             "user-function")
        if drives == "length" and law.constant is not None:
            checks.number(law.what, law.constant, above=0)
        return self._add(Actuator(name, first, second, drives, law))

    def force(self, name: str, point: Point | Body | str, along: ArrayLike | None = None, *,
              value: LawLike | ArrayLike | None = None, of: Bindings | None = None, frame: Body | str | None = None,
              against: Point | Body | str | None = None) -> Force:
        """Apply a force at a point.

        Parameters
        ----------
        name : str
        point : Point, Body or name
            Point of application; a body alone: its centre of mass.
        along : array_like (2,) or (3,)
            Direction of the force in the drawing; the length of the vector is ignored. Left out where `value` is a
            vector.
        value : float, callable, SymPy expression, or array_like (2,) or (3,)
            In N, a function of the same as the torque of `motor`; or a constant force as a vector in the drawing.
        of : dict of str to measure
            Measures that the callable receives, by argument name.
        frame : Body or name, optional
            Body with which the direction turns; left out: the direction is fixed.
        against : Body, Point or name, optional
            Body or point on which the opposite acts. On a body it acts at the same position, without a free moment; `frame` must
            then be that body or left out (along a third body: three forces along the drawing's axes, whose laws read its
            ``rotation``). At a point, also that of a particle, it acts there: the pair has a free moment, value times the
            distance of the lines of action, which ``print(m)`` reports. Left out: the ground.

        Returns
        -------
        Force

        Raises
        ------
        TypeError, ValueError
            If the magnitude or the direction is missing, or the direction is given twice.

        Notes
        -----
        A stop or a contact can be a steep smooth law, such as ``value=lambda y: 1e5 * max(0.0, -y)**1.5``.

        Examples
        --------
        >>> import numpy as np
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("rocket")
        >>> rocket = m.body("rocket", 1.0, 0.1)
        >>> m.force("thrust", rocket, along=(0, 1), value=lambda t: 20.0 * np.exp(-t), frame=rocket)
        <force thrust at rocket>
        >>> m.force("wind", rocket, value=(0.5, 0.0))
        <force wind at rocket>

        A spring along the drawing's axes between two bodies pulls the second back:

        >>> load = m.body("load", 1.0, 0.1, at=(0.2, 0))
        >>> m.force("tie", load, along=(1, 0), value=lambda a, b: -50.0 * (b - a - 0.2), against=rocket.center,
        ...         of={"a": rocket.position.x, "b": load.position.x})
        <force tie at load>
        """
        name = self._new_name(name, "force")
        along, value = self._direction_and_magnitude(name, along, value)
        point = self._point("point", point, center=True)
        frame = self.ground if frame is None else self._body("frame", frame)
        self._turning(name, "the frame of", frame)
        if point.body is self.ground:
            raise WrongValue(f"force {name!r} acts on the ground, which does not move: point must be of another body",
                             "wrong-element")
        against = self._reacting(name, point.body, frame, against)
        law = self._law(f"value of force {name!r}", value, of, reactions=True)
        return self._add(Force(name, point, frame.pose.local_direction(along), frame, law, against))

    def _reacting(self, name: str, body: Body, frame: Body, given: Any) -> Body | Point | None:
        """Body or point on which the opposite of a force acts; None: the ground."""
        against = self._named("against", given)
        if against is None or against is self.ground or (isinstance(against, Point) and against.body is self.ground):
            return None
        is_body = isinstance(against, Body) and not isinstance(against, Particle)
        against = self._body("against", against) if is_body else self._point("against", against)
        if body is getattr(against, "body", against):
            raise WrongValue(f"force {name!r} acts on {body.name!r} and against it: two different bodies are needed",
                             "wrong-element")
        if is_body and frame not in (self.ground, against):
            raise WrongValue(f"frame of force {name!r} must be {against.name!r}, against which it acts, or left out, not "
                             f"{frame.name!r}; against=, as a point, takes any frame", "conflicting-arguments")
        return against

    def _direction_and_magnitude(self, name: str, along: Any, value: Any) -> tuple[np.ndarray, Any]:
        """Unit vector of a force in the drawing, (dimension,), and the magnitude along it."""
        is_vector = isinstance(value, (list, tuple, np.ndarray)) and np.ndim(value) == 1
        if value is None:
            raise WrongType(f"force {name!r} must have value=, its magnitude in N along along=; or value= as a vector, "
                            f"such as {VECTORS[self.dimension]}", "missing-argument")
        if is_vector and along is not None:
            raise WrongValue(f"value of force {name!r} must be a number or a function, not a vector, where along= is given",
                             "conflicting-arguments")
        if is_vector:
            return self._direction(f"value of force {name!r}", value), float(np.linalg.norm(value))
        if along is None:
            raise WrongType(f"force {name!r} must have along=, its direction in the drawing, such as {VECTORS[self.dimension]}, "
                            "as value= is its magnitude", "missing-argument")
        return self._direction(f"along of {name!r}", along), value

    def torque(self, name: str, body: Body | str, *, value: LawLike, of: Bindings | None = None,
               against: Body | str | None = None, axis: ArrayLike | None = None, frame: Body | str | None = None) -> Torque:
        """Apply a moment to a body.

        Parameters
        ----------
        name : str
        body : Body or name
        value : float, callable or SymPy expression
            In N m, counter-clockwise, in space right-handed about the axis; a function of the same as the torque of
            `motor`.
        of : dict of str to measure
            Measures that the callable receives, by argument name.
        against : Body or name, optional
            Body on which the opposite acts; left out: the ground.
        axis : array_like (3,)
            In space: direction of the moment in the drawing. It is fixed, or turns with `frame` or `against`.
        frame : Body or name, optional
            In space: body with which the axis turns, without a moment on it; may be the body itself.

        Returns
        -------
        Torque

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("fan")
        >>> fan = m.body("fan", 1.0, 0.1)
        >>> m.torque("air", fan, value=lambda w: -0.01 * w * abs(w), of={"w": fan.angular_velocity})
        <torque air on fan>
        """
        name = self._new_name(name, "torque")
        body = self._body("body", body)
        against = self.ground if against is None else self._body("against", against)
        self._turning(name, "torque", body, against)
        if body is against:
            raise WrongValue(f"torque {name!r} acts on {body.name!r} and against it: two different bodies are needed",
                             "wrong-element")
        law = self._law(f"value of torque {name!r}", value, of, reactions=True)
        if self.dimension == 3:
            return self._space_torque(name, body, against, law, axis, frame)
        if axis is not None or frame is not None:
            raise WrongValue(f"axis and frame of {name!r} are for mechanisms in space: in the plane it is about its normal",
                             "wrong-dimension")
        return self._add(Torque(name, body, against, law))

    def _space_torque(self, name: str, body: Body, against: Body, law: Any, axis: Any, frame: Any) -> Torque:
        if axis is None:
            raise WrongType(f"torque {name!r} must have axis=, the direction about which it acts", "missing-argument")
        frame = self.ground if frame is None else self._body("frame", frame)
        self._turning(name, "the frame of", frame)
        if against is not self.ground and frame is not self.ground:
            raise WrongValue(f"torque {name!r} acts against {against.name!r}, with which its axis turns: leave frame out",
                             "conflicting-arguments")
        turns_with = frame if against is self.ground else against
        axis = turns_with.pose.local_direction(self._direction(f"axis of {name!r}", axis))
        return self._add(Torque(name, body, against, law, axis=axis, frame=frame))
