"""Methods of `Mechanism` made from the core's tables; written by tests/support/stubs.py."""

from ..._private.types import ArrayLike, Bindings, LawLike, Laws
from ..elements import forces
from ..elements.bodies import Body, Point
from ..elements.joints import Joint
from ..elements.measures import Measure, VectorMeasure3
from ..elements.space_joints import SpaceJoint
from ..elements.table_forces import TableForce
from .registry import Elements

PLANE: dict[str, type[Joint]]
FORCES: dict[str, type[TableForce]]
Side = Body | Point | str

class Revolute(Joint):
    angle: Measure
    speed: Measure
    acceleration: Measure
    torque: VectorMeasure3
    position: VectorMeasure3
    velocity: VectorMeasure3
    transmission_angle: Measure

class Prismatic(Joint):
    displacement: Measure
    speed: Measure
    acceleration: Measure
    torque: VectorMeasure3
    first_torque: VectorMeasure3

class Weld(Joint):
    torque: VectorMeasure3
    position: VectorMeasure3
    velocity: VectorMeasure3

class Rod(Joint):
    tension: Measure

class Slot(Joint):
    displacement: Measure
    speed: Measure
    acceleration: Measure

class KnifeEdge(Joint):
    ...

class SpaceCylindrical(SpaceJoint):
    angle: Measure
    displacement: Measure
    angle_speed: Measure
    angle_acceleration: Measure
    displacement_speed: Measure
    displacement_acceleration: Measure
    torque: VectorMeasure3
    first_torque: VectorMeasure3

class SpacePlanar(SpaceJoint):
    angle: Measure
    speed: Measure
    acceleration: Measure
    torque: VectorMeasure3
    first_torque: VectorMeasure3

class SpaceScrew(SpaceJoint):
    angle: Measure
    displacement: Measure
    angle_speed: Measure
    angle_acceleration: Measure
    displacement_speed: Measure
    displacement_acceleration: Measure
    torque: VectorMeasure3
    first_torque: VectorMeasure3

class SpaceSpherical(SpaceJoint):
    torque: VectorMeasure3
    position: VectorMeasure3
    velocity: VectorMeasure3

class SpaceUniversal(SpaceJoint):
    angle1: Measure
    angle2: Measure
    angle1_speed: Measure
    angle1_acceleration: Measure
    angle2_speed: Measure
    angle2_acceleration: Measure
    torque: VectorMeasure3
    position: VectorMeasure3
    velocity: VectorMeasure3

class Spring(forces.Spring):
    stiffness: float
    free_length: float
    damping: float
    force: Measure
    length: Measure
    speed: Measure

class TorsionSpring(forces.TorsionSpring):
    stiffness: float
    angle: float
    damping: float
    torque: Measure

class Bushing(forces.Bushing):
    force: VectorMeasure3
    torque: VectorMeasure3
    displacement: VectorMeasure3
    velocity: VectorMeasure3
    angle: VectorMeasure3
    angular_velocity: VectorMeasure3

class TableVerbs(Elements):
    def revolute(self, name: str, first: Side, second: Side, *, axis: ArrayLike | None = None, at: ArrayLike | None = None,
                 damping: float = 0.0, cut: bool = False, friction_torque: float | tuple[float, float] | None = None,
                 friction: float | tuple[float, float] | None = None, radius: float | None = None,
                 active: bool | None = None) -> Revolute:
        """Rotation about a point of the first body; a particle is fixed at that point.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            Two points; a body and a point; or two bodies, and `at`.
        axis : array_like (3,)
            In space: its direction in the drawing; it turns with the first body.
        at : array_like (2,) or (3,)
            Position of the joint in the drawing, in m.
        damping : float
            Damping of its angle, in N m s, at least 0.
        cut : bool
            True if this joint must close a loop; left out, the joint that closes a loop is chosen.
        friction_torque : float or (float, float), optional
            Bound of dry friction, or the static and the sliding one, in N m.
        friction : float or (float, float), optional
            Coefficients of friction instead, under the load of the joint, which is then constraints, not a coordinate. Axial
            forces and bending moments of a pin, and torsion of a slide, do not count.
        radius : float, optional
            Radius of the pin in m, on which `friction` acts: its torque is at most ``mu r |F|``, with the radial force F.
        active : bool, optional
            Initial state of a joint that can be released and joined, by `Run.release`, `Run.join`, `Mechanism.latch` and
            ``Event(then=)``; it is then constraints, not a coordinate.

        Returns
        -------
        Revolute, in space SpaceJoint
            With ``angle``, ``speed`` and accelerations; angles count turns.

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is out of range, or
            a particle would need an orientation.

        Notes
        -----
        Source: (3), (5).

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("example")
        >>> body = m.body("body", 1.0, 0.1, at=(1, 0))
        >>> m.revolute("joint", m.ground, body, at=(1, 0)).force
        VectorMeasure('joint.force')
        """

    def prismatic(self, name: str, first: Side, second: Side, *, axis: ArrayLike, at: ArrayLike | None = None,
                  damping: float = 0.0, cut: bool = False, friction_force: float | tuple[float, float] | None = None,
                  friction: float | tuple[float, float] | None = None, guide: float | None = None,
                  active: bool | None = None) -> Prismatic:
        """Translation along an axis of the first body, without rotation.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            Two points; a body and a point; or two bodies, and `at`.
        axis : array_like (2,) or (3,)
            Its direction in the drawing; it turns with the first body.
        at : array_like (2,) or (3,)
            Position of the joint in the drawing, in m. Left out for two bodies, it is the second's origin.
        damping : float
            Damping of its displacement, in N s/m, at least 0.
        cut : bool
            True if this joint must close a loop; left out, the joint that closes a loop is chosen.
        friction_force : float or (float, float), optional
            Bound of dry friction, or the static and the sliding one, in N.
        friction : float or (float, float), optional
            Coefficients of friction instead, under the load of the joint, which is then constraints, not a coordinate. Axial
            forces and bending moments of a pin, and torsion of a slide, do not count.
        guide : float, optional
            Length of the guide in m: friction is at most ``mu (|F/2 + M/l| + |F/2 - M/l|)``.
        active : bool, optional
            Initial state of a joint that can be released and joined, by `Run.release`, `Run.join`, `Mechanism.latch` and
            ``Event(then=)``; it is then constraints, not a coordinate.

        Returns
        -------
        Prismatic, in space SpaceJoint
            With ``displacement``, ``speed`` and accelerations.

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is out of range, or
            a particle would need an orientation.

        Notes
        -----
        Source: (3), (5).

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("example")
        >>> body = m.body("body", 1.0, 0.1, at=(1, 0))
        >>> m.prismatic("joint", m.ground, body, at=(1, 0), axis=(1, 0)).force
        VectorMeasure('joint.force')
        """

    def weld(self, name: str, first: Side, second: Side, *, at: ArrayLike | None = None, cut: bool = False,
             active: bool | None = None) -> Weld:
        """Rigid connection of two bodies.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            Two points; a body and a point; or two bodies, and `at`.
        at : array_like (2,) or (3,)
            Position of the joint in the drawing, in m.
        cut : bool
            True if this joint must close a loop; left out, the joint that closes a loop is chosen.
        active : bool, optional
            Initial state of a joint that can be released and joined, by `Run.release`, `Run.join`, `Mechanism.latch` and
            ``Event(then=)``; it is then constraints, not a coordinate.

        Returns
        -------
        Weld, in space SpaceJoint

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is out of range, or
            a particle would need an orientation.

        Notes
        -----
        Source: (3), (5).

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("example")
        >>> body = m.body("body", 1.0, 0.1, at=(1, 0))
        >>> m.weld("joint", m.ground, body, at=(1, 0)).force
        VectorMeasure('joint.force')
        """

    def rod(self, name: str, first: Side, second: Side, *, length: float | None = None, active: bool | None = None) -> Rod:
        """Constant distance of two points: a massless rod with a hinge at each end.

        Parameters
        ----------
        name : str
        first, second : Point, Particle or name
        length : float
            In m, above 0; left out: as drawn.
        active : bool, optional
            Initial state of a joint that can be released and joined, by `Run.release`, `Run.join`, `Mechanism.latch` and
            ``Event(then=)``; it is then constraints, not a coordinate.

        Returns
        -------
        Rod, in space SpaceJoint

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is out of range, or
            a particle would need an orientation.

        Notes
        -----
        Source: (3), (5).

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("example")
        >>> body = m.body("body", 1.0, 0.1, at=(1, 0))
        >>> m.rod("joint", m.ground.point((1, 1)), body.center, length=0.5).force
        VectorMeasure('joint.force')
        """

    def slot(self, name: str, first: Side, second: Side, *, axis: ArrayLike, at: ArrayLike | None = None, cut: bool = False,
             active: bool | None = None) -> Slot:
        """Point of the second body on a line of the first.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            Two points; a body and a point; or two bodies, and `at`.
        axis : array_like (2,) or (3,)
            Its direction in the drawing; it turns with the first body.
        at : array_like (2,) or (3,)
            Position of the joint in the drawing, in m. Left out for two bodies, it is the second's origin.
        cut : bool
            True if this joint must close a loop; left out, the joint that closes a loop is chosen.
        active : bool, optional
            Initial state of a joint that can be released and joined, by `Run.release`, `Run.join`, `Mechanism.latch` and
            ``Event(then=)``; it is then constraints, not a coordinate.

        Returns
        -------
        Slot, in space SpaceJoint
            With ``displacement``, ``speed`` and accelerations.

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is out of range, or
            a particle would need an orientation.

        Notes
        -----
        Source: (3), (5).

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("example")
        >>> body = m.body("body", 1.0, 0.1, at=(1, 0))
        >>> m.slot("joint", m.ground, body, at=(1, 0), axis=(1, 0)).force
        VectorMeasure('joint.force')
        """

    def knife_edge(self, name: str, point: Side, *, along: ArrayLike, normal: ArrayLike | None = None,
                   active: bool | None = None) -> KnifeEdge:
        """No velocity of a point across a direction that turns with its body.

        Parameters
        ----------
        name : str
        point : Point, Body or name
            Point of a body; a body alone: its centre of mass.
        along : array_like (2,) or (3,)
            Its direction in the drawing, in which the point slides; it turns with the body.
        normal : array_like (3,), optional
            In space a direction in the drawing, made perpendicular to `along`; left out: against gravity, or z without gravity.
            The velocity of the point along ``cross(normal, along)`` is zero. This direction turns with the body, also when it
            leans. The joint does not keep the point on a plane.
        active : bool, optional
            Initial state of a joint that can be released and joined, by `Run.release`, `Run.join`, `Mechanism.latch` and
            ``Event(then=)``; it is then constraints, not a coordinate.

        Returns
        -------
        KnifeEdge, in space SpaceJoint

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is out of range, or
            a particle would need an orientation.

        Notes
        -----
        Source: (5).

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("example")
        >>> body = m.body("body", 1.0, 0.1, at=(1, 0))
        >>> m.knife_edge("joint", body, along=(1, 0)).force
        VectorMeasure('joint.force')
        """

    def cylindrical(self, name: str, first: Side, second: Side, *, axis: ArrayLike, at: ArrayLike | None = None,
                    cut: bool = False, active: bool | None = None) -> SpaceCylindrical:
        """Rotation about an axis of the first body, and translation along it.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            Two points; a body and a point; or two bodies, and `at`.
        axis : array_like (3,)
            Its direction in the drawing; it turns with the first body.
        at : array_like (3,)
            Position of the joint in the drawing, in m. Left out for two bodies, it is the second's origin.
        cut : bool
            True if this joint must close a loop; left out, the joint that closes a loop is chosen.
        active : bool, optional
            Initial state of a joint that can be released and joined, by `Run.release`, `Run.join`, `Mechanism.latch` and
            ``Event(then=)``; it is then constraints, not a coordinate.

        Returns
        -------
        SpaceJoint
            With ``angle``, ``displacement``, ``angle_speed``, ``displacement_speed`` and accelerations; angles count turns.

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is out of range, or
            a particle would need an orientation.

        Notes
        -----
        Source: (3), (5).

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("example", dimension=3)
        >>> body = m.body("body", 1.0, (0.1, 0.1, 0.1), at=(1, 0, 0))
        >>> m.cylindrical("joint", m.ground, body, at=(1, 0, 0), axis=(1, 0, 0)).force
        VectorMeasure3('joint.force')
        """

    def planar(self, name: str, first: Side, second: Side, *, normal: ArrayLike, at: ArrayLike | None = None, cut: bool = False,
               active: bool | None = None) -> SpacePlanar:
        """Translation in a plane of the first body, and rotation about its normal.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            Two points; a body and a point; or two bodies, and `at`.
        normal : array_like (3,)
            Normal of the plane of the first body, in the drawing.
        at : array_like (3,)
            Position of the joint in the drawing, in m. Left out for two bodies, it is the second's origin.
        cut : bool
            True if this joint must close a loop; left out, the joint that closes a loop is chosen.
        active : bool, optional
            Initial state of a joint that can be released and joined, by `Run.release`, `Run.join`, `Mechanism.latch` and
            ``Event(then=)``; it is then constraints, not a coordinate.

        Returns
        -------
        SpaceJoint
            With ``angle``, ``speed`` and accelerations; angles count turns.

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is out of range, or
            a particle would need an orientation.

        Notes
        -----
        Source: (3), (5).

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("example", dimension=3)
        >>> body = m.body("body", 1.0, (0.1, 0.1, 0.1), at=(1, 0, 0))
        >>> m.planar("joint", m.ground, body, at=(1, 0, 0), normal=(0, 0, 1)).force
        VectorMeasure3('joint.force')
        """

    def screw(self, name: str, first: Side, second: Side, *, axis: ArrayLike, pitch: float, at: ArrayLike | None = None,
              cut: bool = False, active: bool | None = None) -> SpaceScrew:
        """Rotation about an axis of the first body, with a proportional advance along it.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            Two points; a body and a point; or two bodies, and `at`.
        axis : array_like (3,)
            Its direction in the drawing; it turns with the first body.
        pitch : float
            Advance of the second body along the axis per turn, in m; positive for a right-handed screw.
        at : array_like (3,)
            Position of the joint in the drawing, in m. Left out for two bodies, it is the second's origin.
        cut : bool
            True if this joint must close a loop; left out, the joint that closes a loop is chosen.
        active : bool, optional
            Initial state of a joint that can be released and joined, by `Run.release`, `Run.join`, `Mechanism.latch` and
            ``Event(then=)``; it is then constraints, not a coordinate.

        Returns
        -------
        SpaceJoint
            With ``angle``, ``displacement``, ``angle_speed``, ``displacement_speed`` and accelerations; angles count turns.

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is out of range, or
            a particle would need an orientation.

        Notes
        -----
        Source: (3), (5).

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("example", dimension=3)
        >>> body = m.body("body", 1.0, (0.1, 0.1, 0.1), at=(1, 0, 0))
        >>> m.screw("joint", m.ground, body, at=(1, 0, 0), axis=(1, 0, 0), pitch=0.002).force
        VectorMeasure3('joint.force')
        """

    def spherical(self, name: str, first: Side, second: Side, *, at: ArrayLike | None = None, damping: float = 0.0,
                  cut: bool = False, active: bool | None = None) -> SpaceSpherical:
        """Rotation about a point of the first body; a particle is fixed at that point.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            Two points; a body and a point; or two bodies, and `at`.
        at : array_like (3,)
            Position of the joint in the drawing, in m.
        damping : float
            Damping of its relative angular velocity, in N m s, at least 0.
        cut : bool
            True if this joint must close a loop; left out, the joint that closes a loop is chosen.
        active : bool, optional
            Initial state of a joint that can be released and joined, by `Run.release`, `Run.join`, `Mechanism.latch` and
            ``Event(then=)``; it is then constraints, not a coordinate.

        Returns
        -------
        SpaceJoint

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is out of range, or
            a particle would need an orientation.

        Notes
        -----
        Source: (3), (5).

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("example", dimension=3)
        >>> body = m.body("body", 1.0, (0.1, 0.1, 0.1), at=(1, 0, 0))
        >>> m.spherical("joint", m.ground, body, at=(1, 0, 0)).force
        VectorMeasure3('joint.force')
        """

    def universal(self, name: str, first: Side, second: Side, *, axes: tuple[ArrayLike, ArrayLike], at: ArrayLike | None = None,
                  damping: float = 0.0, cut: bool = False, active: bool | None = None) -> SpaceUniversal:
        """Universal joint: a cross with one axis on each body.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            Two points; a body and a point; or two bodies, and `at`.
        axes : tuple of array_like (3,)
            Axis of the first body and axis of the second in the drawing, not parallel. They keep their angle; if it is not a
            right angle, the joint is cut.
        at : array_like (3,)
            Position of the joint in the drawing, in m.
        damping : float
            Damping of its relative angular velocity, in N m s, at least 0.
        cut : bool
            True if this joint must close a loop; left out, the joint that closes a loop is chosen.
        active : bool, optional
            Initial state of a joint that can be released and joined, by `Run.release`, `Run.join`, `Mechanism.latch` and
            ``Event(then=)``; it is then constraints, not a coordinate.

        Returns
        -------
        SpaceJoint
            With ``angle1``, ``angle2``, ``angle1_speed``, ``angle2_speed`` and accelerations; angles count turns.

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is out of range, or
            a particle would need an orientation.

        Notes
        -----
        Source: (3), (5).

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("example", dimension=3)
        >>> body = m.body("body", 1.0, (0.1, 0.1, 0.1), at=(1, 0, 0))
        >>> m.universal("joint", m.ground, body, at=(1, 0, 0), axes=((1, 0, 0), (0, 1, 0))).force
        VectorMeasure3('joint.force')
        """

    def spring(self, name: str, first: Side, second: Side, *, stiffness: LawLike | None = None, length: ArrayLike | None = None,
               damping: ArrayLike = 0.0, force: LawLike | None = None, of: Bindings | None = None) -> Spring:
        """Spring and damper between two points.

        Parameters
        ----------
        name : str
        first, second : Point, Particle or name
        stiffness : float, callable or SymPy expression
            In N/m, at least 0. As a function, such as ``lambda t: 500 + 20 * t``, it may depend on the same as the torque of
            `motor`; its work is then an input of energy.
        length : float, optional
            Unstressed length in m, at least 0; left out: as drawn.
        damping : float
            In N s/m, at least 0.
        force : float, callable or SymPy expression, instead of `stiffness`
            Tension in N, negative where it pushes; a function of the same as the torque of `motor`. The spring's own ``length``
            and ``speed`` need no `of`: ``force=lambda length, speed: 500 * (length - 0.3)`` restores a length of 0.3 m. Its
            work is an input of energy; only a number as stiffness has a potential.
        of : dict of str to measure
            Measures that the callable receives, by argument name.

        Returns
        -------
        Spring

        Notes
        -----
        Source: (2), (28).

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("example")
        >>> body = m.body("body", 1.0, 0.1, at=(1, 0))
        >>> m.spring("element", m.ground.point((0, 0)), body.center, stiffness=2.0)
        <spring element: ground - body>
        """

    def torsion_spring(self, name: str, joint: Joint | Measure | str, *, stiffness: LawLike | None = None,
                       angle: ArrayLike | None = None, damping: ArrayLike = 0.0, torque: LawLike | None = None,
                       of: Bindings | None = None) -> TorsionSpring:
        """Spring and damper about the axis of a joint.

        Parameters
        ----------
        name : str
        joint : Joint, measure or name
            Joint with one angle, which counts turns; or one of two, such as ``universal.angle1``.
        stiffness : float, callable or SymPy expression
            In N m/rad, at least 0. As a function, such as ``lambda t: 500 + 20 * t``, it may depend on the same as the torque
            of `motor`; its work is then an input of energy.
        angle : float, optional
            Angle of the joint at which the spring is slack, in rad; left out: 0, as drawn.
        damping : float
            In N m s/rad, at least 0.
        torque : float, callable or SymPy expression, instead of `stiffness`
            Torque on the joint's second body in N m; a function of the same as that of `motor`. The joint's own ``angle`` and
            ``speed`` need no `of`: ``torque=lambda angle, speed: -5 * angle`` restores the angle 0. Its work is an input of
            energy; only a number as stiffness has a potential.
        of : dict of str to measure
            Measures that the callable receives, by argument name.

        Returns
        -------
        TorsionSpring

        Notes
        -----
        Source: (2), (28).

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("example")
        >>> body = m.body("body", 1.0, 0.1, at=(1, 0))
        >>> m.torsion_spring("element", m.revolute("hinge", m.ground, body, at=(0, 0)), stiffness=2.0)
        <torsion spring element at hinge>
        """

    def bushing(self, name: str, first: Side, second: Side, *, at: ArrayLike | None = None, stiffness: ArrayLike = 0.0,
                damping: ArrayLike = 0.0, torsion: ArrayLike = 0.0, torsion_damping: ArrayLike = 0.0, force: Laws | None = None,
                torque: Laws | None = None, of: Bindings | None = None, axis: ArrayLike | None = None,
                normal: ArrayLike | None = None) -> Bushing:
        """Elastic joint: springs and dampers along and about the axes of the first body.

        It is slack as drawn. In space the angles about its directions are the components of the rotation vector: the unit axis
        about which the second body has rotated, as seen from the first, times the angle. The angle is counted up to half a
        turn, where the torque of its stiffness changes its sign; in the plane it is counted on. Dampers about the directions
        act on the components of the relative angular velocity. In space `stiffness` may be a symmetric matrix K (6, 6),
        `torsion` included: with x the displacements along its directions and the rotation vector, force and torque are minus
        the gradient of x^T K x / 2, so that positive definite ones restore.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            Two points; a body and a point; or two bodies, and `at`.
        at : array_like (2,) or (3,)
            Position of the element in the drawing, in m.
        stiffness : float or array_like (2,) or (3,)
            In N/m along its directions, at least 0. It is unstressed as drawn.
        damping : float or array_like (2,) or (3,)
            In N s/m along its directions, at least 0.
        torsion : float, in space or array_like (3,)
            In N m/rad about its directions, at least 0.
        torsion_damping : float, in space or array_like (3,)
            In N m s/rad about its directions, at least 0.
        force : callable or array_like of laws, instead of `stiffness`
            Force on the second body along its directions, in N, one number for each: ``force=lambda displacement, velocity:
            -500 * displacement - 5 * velocity`` restores. Arrays of its own ``displacement``, ``velocity``, ``angle`` and
            ``angular_velocity`` need no `of`; the last two are numbers in the plane; a function of the same as the torque of
            `motor`, and an input of energy.
        torque : callable or array_like of laws, instead of `torsion`
            Torque on the second body along its directions, in N m, one number for each: ``torque=lambda angle,
            angular_velocity: -500 * angle - 5 * angular_velocity`` restores. As `force`, a function of the same as the torque
            of `motor`, and an input of energy.
        of : dict of str to measure
            Measures that the callable receives, by argument name.
        axis : array_like (3,), optional
            In space its first direction in the drawing; it turns with the first body. Left out: that body's own axes.
        normal : array_like (3,), optional
            In space its second direction, which is made perpendicular; the third follows.

        Returns
        -------
        Bushing

        Notes
        -----
        Source: (2), (28).

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("example")
        >>> body = m.body("body", 1.0, 0.1, at=(1, 0))
        >>> m.bushing("element", m.ground, body, at=(1, 0), stiffness=2.0)
        <bushing element: ground - body>
        """
