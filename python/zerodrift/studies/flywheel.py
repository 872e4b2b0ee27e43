"""`flywheel`: the inertia that limits the fluctuation of a machine's speed.

Turns of the machine under a constant torque are simulated. After each, the torque is corrected by the energy gained, the
speed at the start by the mean speed, and the inertia by the fluctuation, to which it is nearly in inverse proportion.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .._private import checks
from .._private.types import MeasureLike, SystemLike
from ..errors import WrongType, WrongValue, ZerodriftError
from ..mechanisms.elements.bodies import Body
from ..mechanisms.elements.forces import Torque
from ..mechanisms.elements.joints import Joint
from ..mechanisms.elements.measures import name_of
from ..mechanisms.elements.user_functions import Law
from ..mechanisms.equations.measure_names import is_rate
from ..mechanisms.system import MechanismSystem
from ..runs.arguments.events import Event
from ..runs.samples.solution import Solution
from ..runs.simulate import simulate
from ..runs.states.instant import Instant
from ..runs.states.operations import assemble
from ..systems.base import system_of

DRIVE = "torque of the flywheel's shaft"
STEADY = 1e-5               # fluctuation at which the speed is constant for the formula
RUNS = 60                   # turns that are simulated, at most
CLOSE = 1e-9                # of the speed, and of the fluctuation: error that ends the iteration
STEPS = 200                 # of a turn, at least
TOLERANCE = 1e-12


@dataclass(frozen=True, repr=False)
class Flywheel:
    """Result of `flywheel`.

    Attributes
    ----------
    inertia : float
        Moment of inertia of the flywheel in kg m^2; 0 if the machine needs none.
    fluctuation : float
        (wmax - wmin) / wmean of the run; less than requested where `inertia` is 0.
    formula : float
        Inertia in kg m^2 by the formula of textbooks, energy / (fluctuation speed^2).
    energy : float
        Largest difference of the energy given by the torque less the load since the start of a turn, at constant speed, in J.
    torque : float
        Constant torque that drives the machine, in N m.
    sol : Solution
        One turn of the run with this flywheel, which repeats.
    """

    inertia: float
    fluctuation: float
    formula: float
    energy: float
    torque: float
    sol: Solution

    def __repr__(self) -> str:
        return (f"flywheel of {self.inertia:.6g} kg m^2: the speed fluctuates by {100 * self.fluctuation:.4g} % under a constant "
                f"torque of {self.torque:.6g} N m\n formula: {self.formula:.6g} kg m^2, from an energy of {self.energy:.6g} J")


def flywheel(system: SystemLike, shaft: MeasureLike, *, speed: float, fluctuation: float = 0.02) -> Flywheel:
    """Find the flywheel with which the speed of a machine fluctuates by so much under a constant torque.

    The machine has one freedom. The motor or actuator that prescribes its motion is left out, and a constant torque drives the
    shaft. Loads depend on positions and velocities, not on the time.

    Parameters
    ----------
    system : system
        A mechanism.
    shaft : measure or str
        Angle that turns once in a period: that of a body in the plane, or of a revolute on the ground.
    speed : float
        Mean angular velocity, one turn over its time, in rad/s.
    fluctuation : float
        Coefficient (wmax - wmin) / wmean, between 0 and 1.

    Returns
    -------
    Flywheel

    Raises
    ------
    ValueError, TypeError
        For a wrong argument.
    ZerodriftError
        If no such motion is found.

    References
    ----------
    R. L. Norton, Design of Machinery, McGraw-Hill, section 11.11.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> m = zd.Mechanism("press")
    >>> crank = m.body("crank", 5.0, 0.1)
    >>> pin = m.revolute("pin", m.ground, crank.point((0, 0)))
    >>> m.torque("load", crank, value=lambda a: -50 * (1 + np.cos(a)), of={"a": crank.angle})
    <torque load on crank>
    >>> zd.flywheel(m, crank.angle, speed=10.0, fluctuation=0.05)
    flywheel of 19.8969 kg m^2: the speed fluctuates by 5 % under a constant torque of 50 N m
     formula: 20 kg m^2, from an energy of 100 J
    """
    name = name_of(shaft, "shaft")
    speed = checks.number("speed", speed)
    if not speed:
        raise WrongValue("speed must not be 0", "out-of-range")
    fluctuation = checks.number("fluctuation", fluctuation)
    if not 0 < fluctuation < 1:
        raise WrongValue(f"fluctuation must be between 0 and 1, not {fluctuation:g}", "out-of-range")
    system = system_of(system)
    if not isinstance(system, MechanismSystem):
        raise WrongType(f"system must be a mechanism, and {system.name!r} is not")
    machine = _Machine(system, name, speed)
    calm = machine.settled(STEADY, machine.turn(1e3 * machine.own, 0.0, speed))
    energy = (calm.inertia + machine.own) * calm.fluctuation * speed**2
    formula = energy / (fluctuation * speed**2)
    first = machine.turn(max(formula - machine.own, 0.0), calm.torque, speed)
    found = machine.settled(fluctuation, first) if calm.fluctuation else first
    return Flywheel(found.inertia, found.fluctuation, formula, energy, found.torque, found.sol)


class _Turn(NamedTuple):
    """A turn under a constant torque: its initial values and its results."""

    inertia: float          # kg m^2: of the flywheel
    torque: float           # N m
    start: float            # rad/s
    fluctuation: float
    mean: float             # rad/s
    gain: float             # J: of kinetic energy
    change: float           # rad/s: of the speed
    sol: Solution


class _Machine:
    """A machine whose shaft has a flywheel and is driven by a constant torque.

    Attributes
    ----------
    own : float
        Moment of inertia about the shaft in kg m^2 that the machine has without the flywheel, at the start.
    """

    def __init__(self, system: MechanismSystem, name: str, speed: float) -> None:
        drawing, owner = system._drawing, name.rpartition(".")[0]
        self.name, self.speed, (body, axis) = name, speed, _body(drawing, name)
        self.rate = f"{owner}.speed" if isinstance(drawing.elements[owner], Joint) else f"{owner}.angular_velocity"
        self.angle = float(Instant(system)[name])
        drive = Torque(DRIVE, body, drawing.ground, Law("torque", 0.0), axis=axis, frame=None if axis is None else drawing.ground)
        elements = drawing.without_drives().elements
        held = {key: value for key, value in drawing.held.items() if not is_rate(key, drawing.elements)}
        drawing = drawing._replace(elements={**elements, DRIVE: drive}, held=held, is_balanced=False)
        self.system = MechanismSystem(drawing, system.layout, system._changed, system._compiled)
        self.inertias = _shares(body, axis, self.system.parameters)
        p, v = self._start(self.system, speed)
        self.own = float(v @ self.system.product("M", v, p, v)) / speed**2

    def _start(self, system: MechanismSystem, speed: float) -> tuple[np.ndarray, np.ndarray]:
        return assemble(system, {self.name: self.angle, self.rate: speed})

    def turn(self, inertia: float, torque: float, start: float) -> _Turn:
        """One turn with a flywheel of this inertia."""
        changed = {path: value + share * inertia for path, (value, share) in self.inertias.items()}
        system = self.system.with_parameters(changed | {f"{DRIVE}.value": torque})
        sign, period = np.sign(self.speed), 2 * np.pi / abs(self.speed)
        end = Event(self.name, value=self.angle + sign * 2 * np.pi, terminal=True)
        sol = simulate(system, 3 * period, *self._start(system, start), events=end, integrator="dop853", rtol=TOLERANCE,
                       atol=TOLERANCE, max_step=period / STEPS)
        w = sign * sol[self.rate]
        if sol.t[-1] >= 3 * period or w.min() <= 0:
            raise ZerodriftError(f"{self.system.name!r} stops within a turn with a flywheel of {inertia:.6g} kg m^2 and a torque "
                                 f"of {torque:.6g} N m")
        mean = 2 * np.pi / float(sol.t[-1])
        spread = _largest(sol.t, w) + _largest(sol.t, -w)
        return _Turn(inertia, torque, start, spread / mean, sign * mean, float(sol.kinetic_energy[-1] - sol.kinetic_energy[0]),
                     float(w[-1] - w[0]), sol)

    def settled(self, wanted: float, turn: _Turn) -> _Turn:
        """The turn that repeats with this fluctuation and the mean speed."""
        for _ in range(RUNS):
            close = CLOSE * turn.fluctuation
            is_wanted = abs(turn.fluctuation - wanted) <= CLOSE * wanted or (not turn.inertia and turn.fluctuation <= wanted)
            if is_wanted and abs(turn.change) <= close * abs(self.speed) and abs(turn.mean / self.speed - 1) <= CLOSE:
                return turn
            inertia = (turn.inertia + self.own) * turn.fluctuation / wanted - self.own
            turn = self.turn(max(inertia, 0.0), turn.torque - np.sign(self.speed) * turn.gain / (2 * np.pi),
                             turn.start * self.speed / turn.mean)
        raise ZerodriftError(f"no turn of {self.system.name!r} repeats with a fluctuation of {wanted:g} at {self.speed:g} rad/s")


def _largest(t: np.ndarray, w: np.ndarray) -> float:
    """Largest value between the samples next to the largest one, by a parabola through three."""
    i = int(np.argmax(w))
    if not 0 < i < len(w) - 1:
        return float(w[i])
    left, right = (w[i] - w[i - 1]) / (t[i] - t[i - 1]), (w[i + 1] - w[i]) / (t[i + 1] - t[i])
    bend = (left - right) / (t[i + 1] - t[i - 1])
    slope = left - bend * (t[i] - t[i - 1])
    return float(w[i] + (slope**2 / (4 * bend) if bend > 0 else 0.0))


def _shares(body: Body, axis: np.ndarray | None, parameters: dict[str, float]) -> dict[str, tuple[float, float]]:
    """Moments of inertia of a body by their paths, each with the part of a flywheel's moment that it has: of a thin disc."""
    if axis is None:
        return {f"{body.name}.inertia": (parameters[f"{body.name}.inertia"], 1.0)}
    along = body.pose.local_direction(axis)
    disc = (np.eye(3) + np.outer(along, along)) / 2
    paths = (f"{body.name}.inertia.{one}{other}" for i, one in enumerate("xyz") for other in "xyz"[i:])
    return {path: (parameters[path], float(disc["xyz".index(path[-2]), "xyz".index(path[-1])])) for path in paths}


def _body(drawing: Any, name: str) -> tuple[Body, np.ndarray | None]:
    """The body that turns by an angle, and in space its axis in the drawing."""
    owner, _, quantity = name.rpartition(".")
    element = drawing.elements.get(owner)
    if quantity == "angle" and isinstance(element, Body) and element.turns and drawing.dimension == 2:
        return element, None
    is_hinge = quantity == "angle" and isinstance(element, Joint) and element.coordinate == "angle"
    if is_hinge and element.bodies[0] is drawing.ground:
        return element.bodies[1], None if drawing.dimension == 2 else element.axis_as_drawn()
    kinds = "a revolute on the ground" if drawing.dimension == 3 else "a body, or of a revolute on the ground"
    raise WrongValue(f"shaft must be the angle of {kinds}, not {name!r}", "wrong-measure")
