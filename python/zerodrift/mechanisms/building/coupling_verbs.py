"""Methods of `Mechanism` that couple measures: gears, cams, and the user's own constraints."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..._private import checks
from ..._private.types import ArrayLike, Bindings, LawLike, Values
from ...errors import WrongType, WrongValue
from ...laws.formula import Formula, of_expression
from ..elements.joints import Coupling, Joint, Teeth
from ..elements.measures import Measure, name_of
from ..elements.numbers import AS_GIVEN
from ..equations.measure_names import checked_reading
from ..loads.teeth import mesh
from .periodic_spline import periodic_spline
from .registry import Elements


class CouplingVerbs(Elements):
    """Couplings of measures, one constraint each."""

    def gear(self, name: str, first: Joint | str, second: Joint | str, *, ratio: float, pressure_angle: float | None = None,
             helix_angle: float = 0.0, radius: float | None = None, backlash: float = 0.0, restitution: float = 0.0) -> Coupling:
        """Couple two hinges by gears: ``second.angle = ratio * first.angle``, as measured by their joints.

        Parameters
        ----------
        name : str
        first, second : Joint or name
            Two revolutes.
        ratio : float
            Negative for external gears.
        pressure_angle : float, optional
            In rad, in the plane of the wheels, such as ``np.radians(20)``. The teeth then act where the pitch circles touch, on
            two wheels that turn on one body, such as the ground or the carrier of a planet: by a tangential force, and by that
            times the tangent of this angle, which pushes the wheels apart on either flank. Reactions of bearings include both.
        helix_angle : float
            In space, in rad: adds an axial force, the tangential one times the tangent of this angle. With the axis a of the
            first joint and t = a x (from the first axis to the second), the axial force on the second wheel is along a if the
            tangential one is along t.
        radius : float, optional
            For bevel gears, whose axes intersect: pitch radius of the second wheel, in the middle of its teeth, in m. For
            parallel axes the radii follow from their distance and the ratio.
        backlash : float
            Free play between the flanks, in rad of the second angle, which starts in the middle of it; 0: none.
        restitution : float
            With `backlash`: coefficient of restitution of flanks that meet, 0 to 1.

        Returns
        -------
        Coupling

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("gears")
        >>> wheels = [m.body(f"wheel{i}", 1.0, 0.1, at=(i, 0)) for i in range(2)]
        >>> pins = [m.revolute(f"pin{i}", m.ground, wheel.point((0, 0))) for i, wheel in enumerate(wheels)]
        >>> m.gear("mesh", *pins, ratio=-2.0)
        <gear mesh: pin0.angle, pin1.angle>

        Notes
        -----
        The gear acts along the two angles, between the two bodies of each joint. Its effort is its own measure: ``mesh.torque``,
        in N m, acts on ``second.angle`` and is positive where it drives that angle up; ``-ratio * mesh.torque`` acts on
        ``first.angle``. `force` and `torque` of the joints exclude it, and also the side load of the teeth on the bearings,
        unless `pressure_angle` is given; ``mesh.tooth_force`` is then the tangential force. The motion is the same. Only the
        joints that the gear couples bear the separating force, even if a wheel has other bearings.
        """
        return self._linear(name, "gear", (first, ("angle",)), (second, ("angle",)), ratio,
                            self._teeth(name, pressure_angle, helix_angle, radius),
                            backlash=checks.number(f"backlash of {name!r}", backlash, least=0),
                            restitution=checks.restitution(f"restitution of {name!r}", restitution))

    def _teeth(self, name: Any, pressure_angle: Any, helix_angle: Any, radius: Any) -> Teeth | None:
        """Geometry of the teeth of a gear; None: without tooth forces."""
        helix = checks.number(f"helix_angle of {name!r}", helix_angle)
        if pressure_angle is None:
            if helix or radius is not None:
                raise WrongValue(f"pressure_angle of {name!r} must be given with helix_angle or radius", "missing-argument")
            return None
        pressure = checks.number(f"pressure_angle of {name!r}", pressure_angle)
        if not 0 <= pressure < 1 or not -1.5 < helix < 1.5:
            raise WrongValue(f"pressure_angle of {name!r} must be between 0 and 1 rad, and helix_angle between -1.5 and 1.5 rad, "
                             f"not {pressure:g} and {helix:g}: np.radians(20) is 20 degrees", "out-of-range")
        if helix and self.dimension == 2:
            raise WrongValue(f"helix_angle of {name!r} is for mechanisms in space", "wrong-dimension")
        return Teeth(pressure, helix, None if radius is None else checks.number(f"radius of {name!r}", radius, above=0))

    def rack_pinion(self, name: str, pinion: Joint | str, rack: Joint | str, *, ratio: float) -> Coupling:
        """Couple a hinge and a slider: ``rack.displacement = ratio * pinion.angle``.

        Parameters
        ----------
        name : str
        pinion, rack : Joint or name
            A revolute, and a prismatic or a slot.
        ratio : float
            In m/rad.

        Returns
        -------
        Coupling

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("steering")
        >>> wheel, bar = m.body("wheel", 1.0, 0.1), m.body("bar", 2.0, 0.1)
        >>> pinion = m.revolute("pinion", m.ground, wheel.point((0, 0)))
        >>> rack = m.prismatic("rack", m.ground, bar, axis=(1, 0))
        >>> m.rack_pinion("teeth", pinion, rack, ratio=0.02)
        <rack_pinion teeth: pinion.angle, rack.displacement>

        Notes
        -----
        The teeth act along the two coordinates, between the two bodies of each joint. Their effort is a measure of its own:
        ``teeth.force``, in N, acts on ``rack.displacement`` and is positive where it drives the rack forward;
        ``-ratio * teeth.force``, in N m, acts on ``pinion.angle``. `force` and `torque` of the joints exclude it, and the side
        load of the teeth on the bearings is not modelled.
        """
        return self._linear(name, "rack_pinion", (pinion, ("angle",)), (rack, ("displacement",)), ratio)

    def _linear(self, name: Any, kind: str, first: Any, second: Any, ratio: Any, teeth: Teeth | None = None,
                **play: float) -> Coupling:
        name = self._new_name(name, kind)
        joints = [self._joint(f"{side} of {name!r}", *given) for side, given in (("first", first), ("second", second))]
        if joints[0] is joints[1]:
            raise WrongValue(f"{name!r} couples {joints[0].name!r} to itself: first and second must be two joints",
                             "wrong-element")
        ratio = checks.number(f"ratio of {name!r}", ratio)
        if not ratio:
            raise WrongValue(f"ratio of {name!r} must not be 0", "out-of-range")
        return self._couple(name, kind, tuple(
            f"{joint.name}.{joint.coordinate or given[1][0]}" for joint, given in zip(joints, (first, second), strict=True)),
            ratio=ratio, teeth=teeth, **play)

    def _couple(self, name: str, kind: str, of: tuple[str, ...], **how: Any) -> Coupling:
        """Add a coupling of measures; its effort is a torque if all are angles, rates of angles or cosines of a rotation."""
        bases = [base.partition(".")[2] for each in of for base in checked_reading(each, each, None, self._elements).quantities]
        effort = "torque" if all("ang" in base or "rotation" in base for base in bases) else "force"
        coupling = Coupling(name, kind, of, effort, **how)
        if coupling.teeth:
            mesh(coupling, self._elements, how["ratio"], AS_GIVEN)
        return self._add(coupling)

    def coupler(self, name: str, value: LawLike | Values, *, of: Bindings | None = None) -> Coupling:
        """Couple measures of positions by a function of them that must be zero; the same as `constraint`, for joints.

        Parameters
        ----------
        name : str
        value : callable, SymPy expression, or dict of measure to float
            Expression that is constrained to zero; a dict is a sum of measures by their coefficients.
        of : dict of str to measure
            Measures that the callable receives, by argument name.

        Returns
        -------
        Coupling

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("differential")
        >>> wheels = [m.body(f"wheel{i}", 1.0, 0.1) for i in range(3)]
        >>> pins = [m.revolute(f"pin{i}", m.ground, wheel.point((0, 0))) for i, wheel in enumerate(wheels)]
        >>> m.coupler("cage", {pins[0].angle: 1.0, pins[1].angle: 1.0, pins[2].angle: -2.0})
        <coupler cage: pin0.angle, pin1.angle, pin2.angle>

        Notes
        -----
        The coupler acts along its measures: along the coordinate of a joint between the two bodies of that joint. Its effort is
        its own measure, ``cage.torque`` in N m if all of its measures are angles, else ``cage.force`` in N, for a `value` in m.
        It is positive where it drives `value` up, and acts on each measure times the derivative of `value` with respect to that.
        `force` and `torque` of joints exclude it, and side loads, such as those of teeth on bearings, are not modelled.
        """
        name = self._new_name(name, "coupler")
        if isinstance(value, Mapping):
            terms = {name_of(measure, f"value of coupler {name!r}"): checks.number(f"coefficient in {name!r}", coefficient)
                     for measure, coefficient in value.items()}
            value, of = _Sum(tuple(terms.values())), {f"x{i}": measure for i, measure in enumerate(terms)}
        return self._by_law(name, "coupler", value, of)

    def cam(self, name: str, cam: Joint | str, follower: Joint | Measure | str, *,
            profile: LawLike | tuple[ArrayLike, ArrayLike]) -> Coupling:
        """Couple a follower to the angle of a cam: ``follower = profile(angle)``.

        Parameters
        ----------
        name : str
        cam : Joint or name
            A revolute.
        follower : Joint, measure, or name of one
            The measure that follows, or the joint whose coordinate does.
        profile : callable, SymPy expression, or (angles, values)
            Follower's coordinate in rad or m, as a function of the angle. A table over one turn becomes a periodic quintic
            spline; its last point may repeat the first, a turn later.

        Returns
        -------
        Coupling

        Examples
        --------
        >>> import numpy as np
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("valve")
        >>> shaft, valve = m.body("shaft", 1.0, 0.1), m.body("valve", 0.1)
        >>> turn = m.revolute("turn", m.ground, shaft.point((0, 0)))
        >>> lift = m.prismatic("lift", m.ground, valve, axis=(0, 1))
        >>> m.cam("cam", turn, lift, profile=lambda angle: 0.01 * (1 - np.cos(angle)))
        <cam cam: turn.angle, lift.displacement>

        Notes
        -----
        The cam acts along the two coordinates, between the two bodies of each joint. Its effort is its own measure: on the
        follower, ``cam.force`` in N or, where the follower is an angle, ``cam.torque`` in N m, positive where it drives the
        follower up; on the cam, ``cam.cam_torque`` in N m, positive where it drives the angle up. `force` and `torque` of the
        joints exclude it, and the side load on guides and bearings is not modelled. A cam also pulls: its follower does not
        lift off where the force is negative.
        """
        name = self._new_name(name, "cam")
        cam = self._joint(f"cam of {name!r}", cam, ("angle",))
        if isinstance(follower, str) and "." not in follower:       # a name with a dot is that of a measure
            follower = self._named(f"follower of {name!r}", follower)
        if isinstance(follower, Joint):
            follower = self._joint(f"follower of {name!r}", follower, ("angle", "displacement"))
            follower = f"{follower.name}.{follower.coordinate}"
        if isinstance(profile, tuple):
            if len(profile) != 2:
                raise WrongValue(f"profile of {name!r} must be (angles, values), not {len(profile)} things", "shape")
            profile = periodic_spline(f"profile of {name!r}", *profile)
        elif isinstance(profile, Formula) or hasattr(profile, "free_symbols"):
            profile = _Profile(f"profile of {name!r}", profile)
        elif not callable(profile):
            raise WrongType(f"profile of {name!r} must be a callable, a SymPy expression or (angles, values), "
                            f"not {checks.shown(profile)}")
        return self._by_law(name, "cam", _Follows(profile), {"angle": Measure(f"{cam.name}.angle"), "follower": follower})

    def constraint(self, name: str, value: LawLike | Values, *, of: Bindings | None = None) -> Coupling:
        """Add a user-defined constraint of positions.

        Parameters
        ----------
        name : str
        value : callable or SymPy expression
            Expression that is constrained to zero: of t, parameters, and measures of positions. Callables are built of
            operators and NumPy's functions, and their derivatives are exact.
        of : dict of str to measure
            Measures that the callable receives, by argument name.

        Returns
        -------
        Coupling

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("bead")
        >>> bead = m.particle("bead", 0.1, at=(1, 1))
        >>> m.constraint("wire", lambda x, y: y - x**2, of={"x": bead.position.x, "y": bead.position.y})
        <constraint wire: bead.position.x, bead.position.y>

        Notes
        -----
        Its effort is a measure, here ``wire.force``, like that of a `coupler`.
        """
        return self._by_law(self._new_name(name, "constraint"), "constraint", value, of)

    def nonholonomic(self, name: str, value: LawLike | Values, *, of: Bindings | None = None) -> Coupling:
        """Add a user-defined nonholonomic constraint.

        Parameters
        ----------
        name : str
        value : callable or SymPy expression
            Expression that is constrained to zero: of t, parameters, measures of positions, and linear in measures of
            velocities.
        of : dict of str to measure
            Measures that the callable receives, by argument name.

        Returns
        -------
        Coupling

        Examples
        --------
        >>> import numpy as np
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("sleigh")
        >>> sleigh = m.body("sleigh", 1.0, 0.1)
        >>> m.nonholonomic("blade", lambda a, u, v: u * np.sin(a) - v * np.cos(a),
        ...                of={"a": sleigh.angle, "u": sleigh.velocity.x, "v": sleigh.velocity.y})
        <nonholonomic blade: sleigh.angle, sleigh.velocity.x, sleigh.velocity.y>

        Notes
        -----
        Its effort is a measure, here ``blade.force``, like that of a `coupler`; it acts on each velocity times the factor of
        that velocity.
        """
        return self._by_law(self._new_name(name, "nonholonomic constraint"), "nonholonomic", value, of)

    def _by_law(self, name: str, kind: str, value: Any, of: Any) -> Coupling:
        law = self._law(f"{kind} {name!r}", value, of, positions=kind != "nonholonomic")
        if not law.measures:
            raise WrongValue(f"{kind} {name!r} depends on no measure: bind some, of={{'x': body.position.x}}", "missing-argument")
        return self._couple(name, kind, law.measures, law=law)


class _Sum:
    """Sum of measures, as a callable of x0, x1, ..."""

    def __init__(self, coefficients: tuple[float, ...]) -> None:
        self.coefficients = coefficients
        import inspect

        kind = inspect.Parameter.KEYWORD_ONLY
        self.__signature__ = inspect.Signature([inspect.Parameter(f"x{i}", kind) for i in range(len(coefficients))])

    def __call__(self, **x: Any) -> Any:
        return sum(coefficient * x[f"x{i}"] for i, coefficient in enumerate(self.coefficients))

    def written(self, equations: Any, **x: Any) -> Any:
        """Node of the result, from nodes of the measures."""
        return equations.graph.sum((x[f"x{i}"], coefficient) for i, coefficient in enumerate(self.coefficients))


class _Follows:
    """Residual of a cam's follower: its displacement less that prescribed by the cam."""

    def __init__(self, profile: Any) -> None:
        self.profile = profile
        self.tables = getattr(profile, "tables", [])

    def __call__(self, angle: Any, follower: Any) -> Any:
        return follower - self.profile(angle)

    @property
    def written(self) -> Any:
        """Function that builds this constraint as a node of an expression graph; missing if the profile is a user's callable."""
        profile = self.profile.written
        return lambda equations, angle, follower: equations.difference(follower, profile(equations, angle))


class _Profile:
    """Formula of one name, the angle, as a callable."""

    def __init__(self, what: str, given: Any) -> None:
        self.formula = given if isinstance(given, Formula) else of_expression(what, given)
        if len(self.formula.names) != 1:
            raise WrongValue(f"{what} must be an expression of one symbol, the angle, not of "
                             f"{', '.join(sorted(self.formula.names)) or 'none'}", "expression")

    def __call__(self, angle: Any) -> Any:
        return self.formula.value({self.formula.names[0]: angle})

    def written(self, equations: Any, angle: Any) -> Any:
        """Node of the result, from the node of the angle."""
        return self.formula.written(equations, {self.formula.names[0]: angle})
