"""An anchor escapement: a pendulum that lets a wheel go tooth by tooth, and is pushed by it."""

from __future__ import annotations

import math

import numpy as np

from .. import inertia
from .._private import checks
from ..errors import WrongValue
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked

LENGTH = 1.5        # of a pallet's face before the part that is used at amplitudes of the lift, relative to that part


@checked
def anchor_escapement(*, teeth: int = 15, wheel_radius: float = 0.04, wheel_mass: float = 0.02,
                      torque: float = 2e-3, lift: float = math.radians(3), drop: float = math.radians(2),
                      pendulum_length: float = 0.25, bob_mass: float = 0.5, damping: float = 1e-3, restitution: float = 0.3,
                      friction: float = 0.1, angle: float = math.radians(7)) -> Mechanism:
    """Anchor escapement with recoil: each swing of a pendulum lets half a tooth of a wheel pass, which pushes the pendulum.

    All teeth are points that touch the straight faces of the two pallets, which are segments of the anchor: ``entry 1`` is the
    contact of the first tooth with the left one, ``exit 1`` that with the right one. The pallets, at angles s on both sides, span
    half a pitch more than a quarter of the teeth, and their arms are tangents of the wheel: the anchor's axle is at
    wheel_radius / cos(s) above the wheel's. While the anchor turns from ``lift`` to ``-lift``, a tooth slides along a face,
    through half a pitch less the drop, and drops off its end; beyond, the pendulum turns the wheel back. The bodies are
    ``wheel``, which turns clockwise, and ``anchor`` with the pendulum; their joints are ``arbor`` and ``pivot``.

    Parameters
    ----------
    teeth : int
        At least four.
    wheel_radius : float
        In m.
    wheel_mass, bob_mass : float
        In kg; the wheel is a disc, the bob a point.
    torque : float
        Torque of the weight on the wheel, in N m, clockwise.
    lift, drop : float
        Angle of the anchor to each side within which it is pushed, and angle through which the wheel is free, in rad.
    pendulum_length : float
        In m.
    damping : float
        Damping of the pendulum, in N m s/rad.
    restitution, friction : float
        Coefficients of the contacts.
    angle : float
        Angle of the pendulum at the start, where it is at rest, in rad; greater than the lift and less than four times the lift.

    Returns
    -------
    Mechanism

    References
    ----------
    W. J. Gazeley, Clock and Watch Escapements, on the anchor (recoil) escapement, whose pallets are tangent to the wheel. The
    numbers are round ones of a bracket clock.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.anchor_escapement(), 2.5)
    >>> sorted({str(name).split()[0] for name in sol.impacts["name"]})
    ['entry', 'exit']
    >>> int(sol["arbor.angle"][-1] // (3.14159265 / 15))          # half a tooth in each half second
    -6
    """
    teeth = checks.count("teeth", teeth, least=4)
    radius, length, lift, drop = (
        checks.number(name, value, above=0) for name, value in
        (("wheel_radius", wheel_radius), ("pendulum_length", pendulum_length), ("lift", lift), ("drop", drop)))
    pitch = 2 * math.pi / teeth
    side, push = ((teeth + 1) // 4 + 0.5) * pitch / 2, pitch / 4 - drop / 2      # push: half the wheel's angle along a face
    if not push > 0:
        raise WrongValue(f"drop must be less than half a pitch, {pitch / 2:g}, not {drop:g}", "out-of-range")
    angle = checks.number("angle", angle)
    if not lift < angle < 4 * lift:
        raise WrongValue(f"angle must be between lift, {lift:g}, and {4 * lift:g}, not {angle:g}", "out-of-range")
    axle = np.array([0.0, radius / math.cos(side)])

    def tooth(at: float, tilt: float = 0.0) -> np.ndarray:
        """Position in the drawing of a tooth clockwise of the top, seen from an anchor that is tilted."""
        x, y = radius * np.array([math.sin(at), math.cos(at)]) - axle
        return axle + np.array([math.cos(tilt) * x + math.sin(tilt) * y, math.cos(tilt) * y - math.sin(tilt) * x])

    m = Mechanism("anchor_escapement", gravity=(0.0, -9.81))
    wheel = m.body("wheel", *inertia.disc(mass=checks.number("wheel_mass", wheel_mass, above=0), radius=radius), at=(0, 0))
    anchor = m.body("anchor", 0.0, at=axle)
    m.particle("bob", checks.number("bob_mass", bob_mass, above=0), at=anchor.point((0, -length)))
    m.revolute("arbor", m.ground, wheel.point((0, 0)))
    pivot = m.revolute("pivot", m.ground, anchor.point((0, 0)))
    m.torsion_spring("air", pivot, stiffness=0.0, damping=checks.number("damping", damping, least=0))
    m.torque("weight", wheel, value=-checks.number("torque", torque))
    faces = {}
    for name, sign in (("entry", -1), ("exit", 1)):
        start, end = tooth(sign * side - push, -sign * lift), tooth(sign * side + push, sign * lift)
        faces[name] = np.array([start + LENGTH * (start - end), end])
    shapes = {name: anchor.segment(*face) for name, face in faces.items()}
    # the first tooth is half a drop before the face of the entry, a line at a distance and an angle from the wheel's axle
    root, end = (complex(*(each - axle)) * complex(math.cos(angle), math.sin(angle)) for each in faces["entry"])
    free = (root - end) * 1j / abs(root - end)
    distance = ((end + complex(*axle)) * free.conjugate()).real
    first = math.pi - math.asin(distance / radius) - math.atan2(free.imag, free.real) - drop / 2
    for i in range(teeth):
        point = wheel.point(tooth(first + i * pitch))
        for name, shape in shapes.items():
            m.contact(f"{name} {i + 1}", point, shape, restitution=restitution, friction=friction)
    _draw(m, faces, axle, [tooth(first + i * pitch) for i in range(teeth)], pitch, length)
    m.start({pivot.angle: angle})
    return m


def _draw(m: Mechanism, faces: dict[str, np.ndarray], axle: np.ndarray, tips: list[np.ndarray], pitch: float,
          length: float) -> None:
    """Shapes of the wheel, whose teeth point forward, and of the anchor with its pendulum."""
    def root(tip: np.ndarray, angle: float) -> np.ndarray:
        return 0.75 * np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]) @ tip
    m.draw("wheel", [corner for tip in tips for corner in (root(tip, 0.6 * pitch), tip, root(tip, 0.15 * pitch))])
    (entry, entry_end), (exit_, exit_end) = faces["entry"] - axle, faces["exit"] - axle
    width, thick = 0.05 * abs(exit_end[1]), np.array([0.3 * abs(exit_end[0]), 0.0])
    bob = [0.1 * length * np.array([math.sin(each), math.cos(each) - 10]) for each in np.linspace(-0.1, 0.1 - 2 * math.pi, 17)]
    m.draw("anchor", [(-width, 0.45 * entry_end[1]), *bob, (width, 0.45 * entry_end[1]), exit_, exit_end, exit_end + thick / 2,
                      exit_ + thick, (width, width), (-width, width), entry, entry_end])
