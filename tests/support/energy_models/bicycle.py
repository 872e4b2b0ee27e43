"""A bicycle seen from above: two wheels that do not slip sideways, and a handlebar that a rider turns."""

import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

from zerodrift.symbolics.define import symbolic


def bicycle(*, wheelbase=1.1, centre=0.5, mass=85.0, inertia=10.0, fork_mass=5.0,
            fork_inertia=0.3, amplitude=0.3, frequency=1.5, stiffness=60.0,
            damping=4.0, thrust=0.0, speed=5.0):
    """A bicycle that is kept upright: the plane single-track vehicle, with two nonholonomic constraints.

    A frame with its rider, on a rear wheel, and a fork with the front wheel, whose centre of mass is on the steering axis; this
    is vertical and goes through the front wheel's contact. Neither wheel slips sideways; that they roll stores no energy. The
    rider steers a slalom: a spring pulls the fork towards ``amplitude * sin(frequency * t)``, and a damper holds it back. A
    thrust pushes along the frame.

    Coordinates are the rear wheel's contact x, y, the frame's yaw, and the fork's steer angle from the frame.

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

    Examples
    --------
    >>> import zerodrift as zd
    >>> import energy_models
    >>> sol = zd.simulate(energy_models.bicycle(), 10.0, step=0.01)
    >>> bool(abs(sol.velocity_violation).max() < 1e-12)
    True
    """
    x, y, yaw, steer = coordinates = dynamicsymbols("x y yaw steer")
    t = dynamicsymbols._t
    given = {"wheelbase": wheelbase, "centre": centre, "mass": mass, "inertia": inertia, "fork_mass": fork_mass,
             "fork_inertia": fork_inertia, "amplitude": amplitude, "frequency": frequency, "stiffness": stiffness,
             "damping": damping, "thrust": thrust}
    w, b, m, J, m_fork, J_fork, swing, pace, k, c, F = sp.symbols(list(given))

    def direction(angle):
        return sp.Matrix([sp.cos(angle), sp.sin(angle)])

    def sideways(point, angle):
        return point.diff(t).dot(direction(angle + sp.pi / 2))

    rear = sp.Matrix([x, y])
    front, middle = rear + w * direction(yaw), rear + b * direction(yaw)
    heading, wheel = direction(yaw), sp.Rational(3, 10) * direction(yaw + steer)
    return symbolic(
        coordinates,
        kinetic=(m * middle.diff(t).dot(middle.diff(t)) + J * yaw.diff(t)**2
                 + m_fork * front.diff(t).dot(front.diff(t)) + J_fork * (yaw + steer).diff(t)**2) / 2,
        potential=k * (steer - swing * sp.sin(pace * t))**2 / 2,
        force={x: F * heading[0], y: F * heading[1], steer: -c * steer.diff(t)},
        nonholonomic={"rear": sideways(rear, yaw), "front": sideways(front, yaw + steer)},
        parameters=given,
        points=[tuple(point) for point in (rear - heading * sp.Rational(3, 10), front, front + wheel, front - wheel)],
        units=["m", "m", "rad", "rad"],
        p0=[0.0, 0.0, 0.0, 0.0], v0=[speed, 0.0, 0.0, 0.0],
        name="bicycle",
    )
