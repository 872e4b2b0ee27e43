"""Methods of `Mechanism` made from the core's tables; written by tests/mechanisms/stub_of_verbs.py."""

from typing import Any

from ..elements.bodies import Body, Point
from ..elements.space_joints import SpaceJoint
from .registry import Elements

Side = Body | Point | str

class TableVerbs(Elements):
    def revolute(self, name: str, first: Side, second: Side, *, axis: Any = None, at: Any = None, damping: float = 0.0,
                 cut: bool = False) -> Any:
        """Turns one body about a point of the other; a particle is held at that point.

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
            Of its angle, in N m s, at least 0.
        cut : bool
            True if this joint must close a loop; left out, the joint that closes a loop is chosen.

        Returns
        -------
        Revolute, in space SpaceJoint
            With ``angle``, ``speed`` and accelerations; angles count turns.

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is not what it may
            be, or a particle would need an orientation.

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

    def prismatic(self, name: str, first: Side, second: Side, *, axis: Any, at: Any = None, damping: float = 0.0,
                  cut: bool = False) -> Any:
        """Slides one body along an axis that turns with the other.

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
            Of its displacement, in N s/m, at least 0.
        cut : bool
            True if this joint must close a loop; left out, the joint that closes a loop is chosen.

        Returns
        -------
        Prismatic, in space SpaceJoint
            With ``displacement``, ``speed`` and accelerations.

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is not what it may
            be, or a particle would need an orientation.

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

    def weld(self, name: str, first: Side, second: Side, *, at: Any = None, cut: bool = False) -> Any:
        """Fixes one body to the other.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            Two points; a body and a point; or two bodies, and `at`.
        at : array_like (2,) or (3,)
            Position of the joint in the drawing, in m.
        cut : bool
            True if this joint must close a loop; left out, the joint that closes a loop is chosen.

        Returns
        -------
        Weld, in space SpaceJoint

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is not what it may
            be, or a particle would need an orientation.

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

    def rod(self, name: str, first: Side, second: Side, *, length: float | None = None) -> Any:
        """Keeps two points at a distance, as a massless rod with a hinge at each end.

        Parameters
        ----------
        name : str
        first, second : Point, Particle or name
        length : float
            In m, above 0; left out: as drawn.

        Returns
        -------
        Rod, in space SpaceJoint

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is not what it may
            be, or a particle would need an orientation.

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

    def cylindrical(self, name: str, first: Side, second: Side, *, axis: Any, at: Any = None, cut: bool = False) -> SpaceJoint:
        """Turns one body about an axis of the other, and slides it along.

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

        Returns
        -------
        SpaceJoint
            With ``angle``, ``displacement``, ``angle_speed``, ``displacement_speed`` and accelerations; angles count turns.

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is not what it may
            be, or a particle would need an orientation.

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

    def planar(self, name: str, first: Side, second: Side, *, normal: Any, at: Any = None, cut: bool = False) -> SpaceJoint:
        """Slides one body on a plane of the other, and turns it about the plane's normal.

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

        Returns
        -------
        SpaceJoint
            With ``angle``, ``speed`` and accelerations; angles count turns.

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is not what it may
            be, or a particle would need an orientation.

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

    def screw(self, name: str, first: Side, second: Side, *, axis: Any, pitch: float, at: Any = None,
              cut: bool = False) -> SpaceJoint:
        """Turns one body about an axis of the other, along which it advances.

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

        Returns
        -------
        SpaceJoint
            With ``angle``, ``displacement``, ``angle_speed``, ``displacement_speed`` and accelerations; angles count turns.

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is not what it may
            be, or a particle would need an orientation.

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

    def spherical(self, name: str, first: Side, second: Side, *, at: Any = None, cut: bool = False) -> SpaceJoint:
        """Turns one body about a point of the other; a particle is held at that point.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            Two points; a body and a point; or two bodies, and `at`.
        at : array_like (3,)
            Position of the joint in the drawing, in m.
        cut : bool
            True if this joint must close a loop; left out, the joint that closes a loop is chosen.

        Returns
        -------
        SpaceJoint

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is not what it may
            be, or a particle would need an orientation.

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

    def universal(self, name: str, first: Side, second: Side, *, axes: tuple[Any, Any], at: Any = None,
                  cut: bool = False) -> SpaceJoint:
        """Joins two bodies by a cross, with an axis on each that are perpendicular.

        Parameters
        ----------
        name : str
        first, second : Body, Point or name
            Two points; a body and a point; or two bodies, and `at`.
        axes : tuple of array_like (3,)
            Axis of the first body and axis of the second, perpendicular, in the drawing.
        at : array_like (3,)
            Position of the joint in the drawing, in m.
        cut : bool
            True if this joint must close a loop; left out, the joint that closes a loop is chosen.

        Returns
        -------
        SpaceJoint
            With ``angle1``, ``angle2``, ``angle1_speed``, ``angle2_speed`` and accelerations; angles count turns.

        Raises
        ------
        ValueError, TypeError
            If the name is taken, a point belongs to no body of this mechanism, both sides to one, a number is not what it may
            be, or a particle would need an orientation.

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

    def spring(self, name: str, first: Side, second: Side, *, stiffness: Any, damping: Any = 0.0, length: Any = None) -> Any:
        """Spring with a damper between two points.

        Parameters
        ----------
        name : str
        first, second : Point, Particle or name
        stiffness : float
            In N/m, at least 0.
        damping : float
            In N s/m, at least 0.
        length : float, optional
            Unstressed length in m, at least 0; left out: as drawn.

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
