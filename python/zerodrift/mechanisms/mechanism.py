"""`Mechanism`: bodies and joints, from which systems are made."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from .._private import checks
from .._private.types import Laws
from .._private.writing import with_suffix, write_atomically
from ..errors import WrongType, WrongValue
from ..systems.base import Makes, Terms
from .building.body_verbs import BodyVerbs
from .building.contact_verbs import ContactVerbs
from .building.coupling_verbs import CouplingVerbs
from .building.force_verbs import ForceVerbs
from .building.joint_verbs import JointVerbs
from .building.plane_to_space import lift
from .building.start_verbs import StartVerbs
from .elements.bodies import Point
from .elements.drawing import Drawing
from .elements.forces import Actuator, Gravity, Motor
from .elements.immutable import Fixed
from .elements.measures import Measure
from .files.to_json import described, text
from .reports.summary import headline, report
from .system import LAYOUTS, MechanismSystem

ROTOR = "rotor", "shaft", "gear"        # elements of a motor whose rotor is geared


class Mechanism(BodyVerbs, JointVerbs, ForceVerbs, CouplingVerbs, ContactVerbs, StartVerbs, Makes):
    """A mechanism in the plane or in space, from bodies and joints.

    Bodies are drawn, joints join them where they are in the drawing, and given lengths override the drawing. Where a verb
    takes a joint, a body or a point, it takes its name as well: ``"pin"``, ``"crank"``, ``"crank.end"``. Every function that
    takes a system takes a mechanism. Elements may be added at any time.

    Parameters
    ----------
    name : str
        For tables and plots.
    dimension : int
        2, the plane, or 3, space: then points and directions have three components, and hinges and sliders an ``axis=``.
        Some elements are not available in space; they raise an error.
    gravity : array_like (dimension,) of numbers or laws, or callable, optional
        In m/s^2, in the drawing's axes; left out: none. A function, such as of ``t``, returns a number for each axis; its work is
        an input of energy.
    parameters : dict of str to float, optional
        User parameters, which callables and expressions may name; `parameter` adds one.

    Attributes
    ----------
    ground : Body
        The body that does not move; its frame is the drawing's.
    bodies, joints, motors : tuple
        In the order in which they were added; ``m["name"]`` is any element.
    p0, v0 : ndarray (nq,), (nv,)
        Initial state of its `system`, in the coordinates of that system.

    Raises
    ------
    ValueError, TypeError
        For a wrong argument.

    Examples
    --------
    The paper's four-bar, from a sketch:

    >>> import numpy as np
    >>> import zerodrift as zd
    >>> bar = zd.Mechanism("four-bar", gravity=(0, -9.81))
    >>> crank = bar.link("crank", (0, 0), (0, 0.3), mass=1.5)
    >>> coupler = bar.link("coupler", (0, 0.3), (0.95, 0.6), mass=5.0, length=1.0)
    >>> rocker = bar.link("rocker", (0.95, 0.6), (1, 0), mass=3.0, length=0.6)
    >>> A, B = bar.revolute("A", bar.ground, crank.start), bar.revolute("B", crank.end, coupler.start)
    >>> C, D = bar.revolute("C", coupler.end, rocker.start), bar.revolute("D", rocker.end, bar.ground.point((1, 0)))
    >>> bar.start({crank.angle: np.pi / 2, crank.angular_velocity: 1.0})
    """

    def __init__(self, name: str, *, dimension: int = 2, gravity: ArrayLike | Laws | None = None,
                 parameters: Mapping[str, float] | None = None) -> None:
        if not isinstance(name, str) or not name:
            raise WrongType(f"name must be a string that is not empty, not {checks.shown(name)}")
        if dimension not in (2, 3) or isinstance(dimension, bool):
            raise WrongValue(f"dimension must be 2, the plane, or 3, space, not {checks.shown(dimension)}", "wrong-dimension")
        self.name, self.dimension = name, int(dimension)
        varies, none = checks.varies(gravity), np.zeros(self.dimension)
        self.gravity = none if gravity is None or varies else checks.vector("gravity", gravity, self.dimension)
        super().__init__(parameters)
        if varies:
            laws = zip("xyz", self._components("gravity", gravity, self.dimension, {}), strict=False)
            self._add(Gravity({axis: self._law(f"gravity.{axis}", law, reactions=True) for axis, law in laws}))

    def system(self, coordinates: Literal["joint", "absolute"] | None = None, compiled: bool | None = None) -> MechanismSystem:
        """Return the equations of the mechanism as it is now; later changes of the mechanism do not affect them.

        Parameters
        ----------
        coordinates : {None, "joint", "absolute"}
            "joint": absolute angles and displacements along a tree of joints; joints that close loops are constraints.
            "absolute": three coordinates a body, and all joints are constraints; the cost is proportional to the number of
            bodies, that of joint coordinates to up to its third power. None: those that cost less, by a count of the operations
            of a step: joint ones for open chains of some twenty bodies and for one or two loops, absolute ones for more. Joint
            ones, too, where a body has no mass, and for `compiled`; absolute ones where all bodies are welded to the ground.
            Loops of hinges and sliders alone in space take absolute ones up to eight times the count, as these go through flat
            poses where joint ones can stop. ``repr`` names the chosen ones, and `print` of a mechanism shows both counts.
            In space, "joint" are the angles, displacements and quaternions of joints along the tree, the positions and
            quaternions of free bodies, and the angles of joints that close loops, which follow from the others; "absolute" are
            seven coordinates and six velocities a body, and the angles of all joints. Absolute coordinates are cheaper for
            chains of ball joints, and for chains of some twenty hinges or more.
        compiled : None or bool
            None: tables are interpreted, and small mechanisms evaluated in closed form by programs that the core runs. A run of
            fixed steps that compilation shortens by more than 5 s, by a count of instructions, compiles the equations before its
            first step; results in closed form stay bitwise the same. ``print(sol)`` of other runs gives the time that `compiled`
            would save. ZERODRIFT_COMPILE=0 in the environment prevents this. False: tables and matrices alone.
            True: the equations are written out, compiled and cached, with closed-form functions where these pay:
            some three times faster for small mechanisms, after a second or more once. `with_parameters` can still change all
            numbers; the code depends on which of them are zero or one and on which points of a body coincide, and is
            compiled again automatically if that changes. User functions must be numbers, expressions of SymPy,
            tables, or functions that can be recorded: ``print(m)`` lists those that cannot. Without a compiler equations are
            evaluated as with None, with a `NoCompilerWarning`.
            In space joint coordinates are written out completely. For absolute ones only closed-form functions are, up to
            some four bodies; all other terms keep the tables. Loops with redundant constraints, such as those of full hinges,
            have no closed-form functions in either.

        Returns
        -------
        MechanismSystem

        Raises
        ------
        ValueError
            If it is to be compiled and a law is a function that cannot be recorded; the element and the reason are named.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("pendulum", gravity=(0, -9.81))
        >>> link = m.link("link", (0, 0), (1, 0), mass=1.0)
        >>> pin = m.revolute("pin", m.ground, link.start)
        >>> m.system("absolute")
        <system of pendulum: absolute coordinates, 3, 2 holonomic and 0 nonholonomic constraints>
        """
        layout = None if coordinates is None else checks.choice("coordinates", coordinates, LAYOUTS)
        if compiled is not None:
            checks.instance("compiled", compiled, bool, "None, True or False")
        return MechanismSystem(self._drawing(), layout, {}, compiled)

    def with_parameters(self, changes: Mapping[str, float] | None = None, /, **changed: float) -> MechanismSystem:
        """The system of this mechanism with some numbers changed, assembled again.

        Parameters
        ----------
        changes : dict of path to float
            Such as ``{"crank.mass": 2.0}``. Quantities that follow from a number, as a link's inertia from its length, change
            with it unless they were given.
        **changed
            The mechanism's own parameters by name.

        Returns
        -------
        MechanismSystem

        Raises
        ------
        ValueError, TypeError
            If there is no such number, or the value is out of range.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("pendulum", gravity=(0, -9.81))
        >>> link = m.link("link", (0, 0), (1, 0), mass=1.0)
        >>> pin = m.revolute("pin", m.ground, link.start)
        >>> m.with_parameters({"link.length": 2.0}).parameters["link.length"]
        2.0
        """
        return self.system().with_parameters(changes, **changed)

    def lifted(self) -> Mechanism:
        """The same mechanism in space, in the plane z = 0; elements in space can be added to it.

        Axes of hinges are along z. A revolute that holds a particle becomes a ball. Where no joint keeps a body in the plane, one
        is added, ``"wheel in its plane"``, a `planar` or, for a particle, a `coupler`. Moments of inertia are those of the plane
        about z, and half as much about x and y, so that motions in the plane are the same. They are given: a link's inertia does
        not change with its length. Bushings with torsion are an exception beyond half a turn: their angle goes on counting in the
        plane, and does not in space.

        Returns
        -------
        Mechanism
            With the same names. Measures of bodies have three components: ``"crank.angular_velocity.z"``,
            ``"crank.rotation"`` in place of an angle.

        Raises
        ------
        ValueError
            If the mechanism is in space already, or an element is not available in space or depends on the angle of a
            body; it is named.

        Examples
        --------
        >>> import zerodrift as zd
        >>> bar = zd.models.four_bar().lifted()
        >>> print(bar)      # doctest: +ELLIPSIS
        <Mechanism four_bar: space, 3 bodies, 4 joints; ...>
         freedom 1 (Gruebler -2); ...
        >>> zd.simulate(bar, 0.1, step=0.01)["A.force"].shape
        (11, 3)
        """
        if self.dimension == 3:
            raise WrongValue(f"{self.name!r} is in space already: lifted() is for mechanisms in the plane", "wrong-dimension")
        made = Mechanism(self.name, dimension=3, gravity=(*self.gravity, 0.0), parameters=self.parameters)
        lift(self._drawing(), made)
        return made

    def remove(self, name: str | Any) -> None:
        """Remove an element, with the start values that belong to it, and with the geared rotor of a motor.

        Parameters
        ----------
        name : str or element
            Such as the motor of a model.

        Raises
        ------
        ValueError
            If other elements or the start depend on it; they are named, and nothing is removed.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.models.scissor_lift()
        >>> m.motors
        (<motor drive: displacement of rail>,)
        >>> m.remove("drive")
        >>> m.motors
        ()
        """
        element = self._own(name)
        gone = {element.name, *(f"{element.name} {part}" for part in ROTOR if isinstance(element, Motor))} & self._elements.keys()
        gone |= {each.name for each in self._of(Point) if each.body is element}
        others = [other.name for other in self._elements.values() if other.name not in gone and other.refers_to & gone]
        if others:
            raise WrongValue(f"{element.name!r} must not be removed, as {', '.join(map(repr, others))} of {self.name!r} depend"
                             f"{'s' * (len(others) == 1)} on it: remove that first", "wrong-element")
        for each in gone:
            del self._elements[each]
            self._shapes.pop(each, None)
        for given in (self._held, self._wished):
            for key in [key for key in given if key.partition(".")[0] in gone]:
                del given[key]

    def replace(self, name: str | Motor | Actuator, **changed: Any) -> Motor | Actuator:
        """Replace a motor or an actuator by one with other arguments, at its joint or between its points, by its name.

        Parameters
        ----------
        name : str, motor or actuator
        **changed
            Arguments of `motor` or `actuator`: ``torque=0.0``, ``speed=lambda t: ...``, ``of=``.

        Returns
        -------
        Motor or Actuator

        Raises
        ------
        TypeError, ValueError
            For an element of another kind or wrong arguments; the mechanism is then as before.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.models.scissor_lift()
        >>> m.replace("drive", force=0.0)
        <motor drive: force of rail>
        """
        element = self._own(name)
        checks.instance("name", element, (Motor, Actuator), "a motor or an actuator: parameters of other elements change by "
                        "with_parameters(), and remove() makes room for others")
        before = dict(self._elements)
        for part in ("", *(f" {part}" for part in ROTOR)):
            self._elements.pop(f"{element.name}{part}", None)
        try:
            if isinstance(element, Motor):
                which = Measure(f"{element.joint.name}.{element.which}") if element.which else element.joint
                made: Any = self.motor(element.name, which, **changed)
            else:
                made = self.actuator(element.name, element.first, element.second, **changed)
        except BaseException:
            self._elements = before
            raise
        after = self._elements
        self._elements = {key: after.get(key, each) for key, each in before.items() if key in after} | after
        return made

    def _own(self, name: Any) -> Any:
        element = self[name] if isinstance(name, str) else name
        if element is self.ground or not isinstance(element, Fixed) or not self._is_own(element):
            raise WrongValue(f"name must be an element of {self.name!r} other than the ground, not {checks.shown(name)}",
                             "wrong-element")
        return element

    @property
    def p0(self) -> np.ndarray:
        return self.system().p0

    @property
    def v0(self) -> np.ndarray:
        return self.system().v0

    def points(self, p: ArrayLike) -> np.ndarray | Any:
        """The drawing at p, as of its `system`: points (n, dimension) in m, joined by lines where not NaN.

        Examples
        --------
        >>> import zerodrift as zd
        >>> bar = zd.models.four_bar()
        >>> bar.points(bar.p0).shape[1]
        2
        """
        return self.system().points(p)

    def evaluate(self, p: ArrayLike | None = None, v: ArrayLike | None = None, t: float = 0.0) -> Terms:
        """The terms of the equations of motion of its `system` at (t, p, v); left out: where it starts.

        Examples
        --------
        >>> import zerodrift as zd
        >>> zd.models.four_bar().evaluate().C.shape
        (2, 3)
        """
        return self.system().evaluate(p, v, t)

    @property
    def measures(self) -> tuple[str, ...]:
        """Names of all measures, such as "pin.force": what ``sol[name]`` of its solutions reads."""
        return self.system().measures

    def save(self, path: str | Path) -> Path:
        """Write the mechanism to a JSON file, without pickle, which `zerodrift.load` reads to the last bit.

        Points, axes and directions are written in the frames of their bodies, lengths, masses and angles as they
        were given; SymPy expressions as lists of operations.

        Parameters
        ----------
        path : str or Path
            The suffix ``.json`` is added where it is missing.

        Returns
        -------
        Path
            Path of the written file.

        Raises
        ------
        ValueError
            If it contains a function that cannot be recorded, which is named with the reason.

        Examples
        --------
        >>> import tempfile, zerodrift as zd
        >>> m = zd.Mechanism("pendulum", gravity=(0, -9.81))
        >>> link = m.link("link", (0, 0), (1, 0), mass=1.0)
        >>> pin = m.revolute("pin", m.ground, link.start)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     zd.load(m.save(folder + "/pendulum")).bodies
        (<link link>,)
        """
        path = with_suffix(path, ".json")
        content = text(described(self._drawing())).encode()
        write_atomically(path, lambda file: file.write(content))
        return path

    def __repr__(self) -> str:
        return headline(self._drawing())

    def __str__(self) -> str:
        return report(self._drawing())

    def _drawing(self) -> Drawing:
        gravity = np.array(checks.vector("gravity", self.gravity, self.dimension))
        laws = [law for element in self._elements.values() for law in element.laws.values()]
        for law in laws:
            law.record(self.parameters)     # anew where what it reads from outside has changed
        if any(law.recorded.has_state for law in laws):
            for law in laws:
                if law.recorded.has_values:
                    law.call("reads numbers or objects, and another law of the mechanism has state")
        return Drawing(self.name, gravity, dict(self.parameters), dict(self._elements), dict(self._held), dict(self._wished),
                       self._is_balanced, dict(self._shapes))
