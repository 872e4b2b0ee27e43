"""A bicycle seen from above: two wheels that do not slip sideways, and a handlebar that a rider turns."""

from __future__ import annotations

from .._private import checks
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked
from ._swing import swing

HANDLEBAR, BEHIND = 0.28, 0.1       # m: half its width; of the wheelbase: how far behind the steering axis it is drawn


@checked
def bicycle(*, wheelbase: float = 1.1, centre: float = 0.5, mass: float = 85.0, inertia: float = 10.0, fork_mass: float = 5.0,
            fork_inertia: float = 0.3, amplitude: float = 0.3, frequency: float = 1.5, stiffness: float = 60.0,
            damping: float = 4.0, thrust: float = 0.0, speed: float = 5.0) -> Mechanism:
    """Planar single-track vehicle: a bicycle that is held upright, a frame and a fork with a blade each.

    A frame with its rider, on a rear wheel, and a fork with the front wheel, whose centre of mass is on the steering axis; this
    is vertical and goes through the front wheel's contact. Neither wheel slips sideways; their rotation stores no energy. The
    rider steers a slalom: a spring pulls the fork towards ``amplitude * sin(frequency * t)``, and a damper resists its motion. A
    thrust pushes along the frame. The bodies are ``frame``, which begins at the rear contact, and ``fork``; the steering axis is
    ``head``, the wheels' contacts ``rear`` and ``front``, and the rider's arms ``arms`` and ``slalom``.

    Parameters
    ----------
    wheelbase, centre : float
        In m: from the rear axle to the front one, and to the centre of mass of the frame.
    mass, inertia, fork_mass, fork_inertia : float
        In kg and kg m^2; moments of inertia are about vertical axes through the centres of mass.
    amplitude, frequency : float
        Amplitude and frequency of the slalom, in rad and rad/s.
    stiffness, damping : float
        Stiffness and damping of the rider's arms, in N m/rad and N m s/rad.
    thrust : float
        In N.
    speed : float
        At the start, in m/s along x.

    Returns
    -------
    Mechanism

    References
    ----------
    The single-track model of P. Riekert and T. E. Schunck, Zur Fahrmechanik des gummibereiften Kraftfahrzeugs,
    Ingenieur-Archiv 11 (1940), with wheels that do not slip at all. The numbers are round ones.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.bicycle(), 2.0, step=0.02)
    >>> bool(abs(sol.velocity_violation).max() < 1e-12)
    True
    """
    m = Mechanism("bicycle")
    wheelbase = checks.number("wheelbase", wheelbase, above=0)
    frame = m.body("frame", mass, inertia, com=(checks.number("centre", centre), 0))
    fork = m.body("fork", fork_mass, fork_inertia, at=(wheelbase, 0))
    rear, front = frame.point((0, 0)), fork.point((0, 0))
    m.revolute("head", frame, front)
    m.knife_edge("rear", rear, along=(1, 0))
    m.knife_edge("front", front, along=(1, 0))
    m.torsion_spring("arms", "head", stiffness=stiffness, damping=damping)
    for side, y in (("left", HANDLEBAR), ("right", -HANDLEBAR)):
        m.point(f"{side} grip", fork, (-BEHIND * wheelbase, y))
    m.motor("slalom", "head", torque=stiffness * swing(amplitude, frequency))
    if thrust:
        m.force("thrust", rear, along=(1, 0), value=thrust, frame=frame)
    m.start({"frame.velocity.x": checks.number("speed", speed)})
    return m
