"""A Geneva drive: a pin that enters the slots of a wheel one after the other."""

from __future__ import annotations

import math
from typing import Any

from .. import inertia
from .._private import checks
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked

PLAY = 1e-6         # rad: the lock is open a little longer than a slot is engaged


@checked
def geneva(*, slots: int = 4, crank_length: float = 0.05, speed: float = 2 * math.pi, wheel_mass: float = 0.5) -> Mechanism:
    """Geneva drive: each turn of the crank advances the wheel by one slot, and locks it during the rest of the turn.

    The slots are joints that are released: the pin joins ``slot 1``, ``slot 2``, ... where it enters them, along their axes and
    so without impact, and releases them where it leaves; then ``lock`` holds the wheel. ``slot 1.force`` is that of the wheel on
    the pin. The bodies are ``crank`` and ``wheel``, the motor is ``drive``. The crank starts opposite to the wheel.

    Parameters
    ----------
    slots : int
        At least three.
    crank_length : float
        Distance of the pin from the crank's axis, in m.
    speed : float
        Angular velocity of the crank in rad/s, positive.
    wheel_mass : float
        In kg; the wheel is a disc.

    Returns
    -------
    Mechanism

    References
    ----------
    R. L. Norton, Design of Machinery, on intermittent motion; its closed form gives angle and acceleration of the wheel.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.geneva(), 2.0, step=0.005)
    >>> float(round(sol["axle.angle"][-1], 9))          # two turns of the crank: half a turn back
    -3.141592654
    """
    slots = checks.count("slots", slots, least=3)
    crank_length, speed = checks.number("crank_length", crank_length, above=0), checks.number("speed", speed, above=0)
    mass, half = checks.number("wheel_mass", wheel_mass, above=0), math.pi / slots
    distance = crank_length / math.sin(half)
    radius, engaged = distance * math.cos(half), math.pi / 2 - half         # the crank's angle where the pin enters is -engaged
    m = Mechanism("geneva")
    crank = m.link("crank", (0, 0), (-crank_length, 0), mass=0.0)
    wheel = m.body("wheel", *inertia.disc(mass=mass, radius=radius), at=(distance, 0))
    shaft = m.revolute("shaft", m.ground, crank.start)
    m.revolute("axle", m.ground, wheel.point((0, 0)))
    m.motor("drive", shaft, speed=speed)

    def passes(name: str, angle: float, turns: int) -> Any:
        """Measure that passes through zero upward where the crank is at an angle, once in some turns."""
        return m.measure(name, lambda turned: math.sin((turned + math.pi - angle) / turns), of={"turned": shaft.angle})

    for i in range(slots):
        along = math.pi + half + 2 * half * i
        outward = (math.cos(along), math.sin(along))
        mouth = wheel.point((radius * outward[0], radius * outward[1]))
        slot = m.slot(f"slot {i + 1}", mouth, crank.end, axis=outward, active=False)
        turn = 2 * math.pi * (i + 1)
        m.latch(f"pin {i + 1}", slot, when=passes(f"enters {i + 1}", turn - engaged, slots),
                until=passes(f"leaves {i + 1}", turn + engaged, slots))
    lock = m.weld("lock", m.ground, wheel, at=(distance, 0), active=True)
    m.latch("detent", lock, when=passes("locks", engaged + PLAY, 1), until=passes("unlocks", -engaged - PLAY, 1))
    return m
