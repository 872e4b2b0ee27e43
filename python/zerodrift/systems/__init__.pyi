"""Systems of the core's table; written by tests/support/stubs.py."""

from typing import Literal

from numpy.typing import ArrayLike

from .builtin import BuiltIn as BuiltIn

def four_bar(*, lengths: ArrayLike = (1.0, 0.3, 1.0, 0.6), masses: ArrayLike = (1.5, 5.0, 3.0), inertias: ArrayLike | None = None,
             gravity: float = 9.81, assembly: Literal['open', 'crossed'] = 'open', crank_angle: float = 1.5707963267948966,
             crank_rate: float = 1.0) -> BuiltIn:
    """Four-bar mechanism under gravity, cut open at its last joint: the paper's example 1.

    Three links that turn about joints, described by their absolute angles from the x axis; the tip of
    the last is held at a fixed point. One degree of freedom, two constraints. It is the paper's example
    for drift, stabilization and energy.

    Parameters
    ----------
    lengths : float (4,) in m, positive
        ground l0 and links l1, l2, l3
    masses : float (3,) in kg, positive
        of links 1, 2, 3
    inertias : float (3,) in kg m^2, not negative
        about the link midpoints; left out: slender rods, m l^2 / 12
    gravity : float in m/s^2, any
        downwards, along -y
    assembly : {'open', 'crossed'}
    crank_angle : float in rad, any
        alpha1 at the start
    crank_rate : float in rad/s, any
        its rate at the start

    Coordinates p: alpha1 [rad], alpha2 [rad], alpha3 [rad].

    Velocities v: alpha1_dot [rad/s], alpha2_dot [rad/s], alpha3_dot [rad/s].

    Constraints: closure_x [m], closure_y [m].

    Source: section 4.1; W. Blajer, Elimination of constraint violation and accuracy aspects in
    numerical simulation of multibody systems, Multibody System Dynamics 7 (2002) 265-284, section 4.1.
    """

def oscillator(*, mass: float = 1.0, stiffness: float = 10.0, x0: float = 0.1, v0: float = 0.0) -> BuiltIn:
    """Mass on a spring, without constraints: the paper's example 2.

    One degree of freedom and no constraint, with a solution in closed form: it shows the effects of
    integrators and energy correction alone.

    Parameters
    ----------
    mass : float in kg, positive
    stiffness : float in N/m, positive
        of the spring
    x0 : float in m, any
        position at the start, from where the spring is relaxed
    v0 : float in m/s, any
        velocity at the start

    Coordinates p: x [m].

    Velocities v: x_dot [m/s].

    Constraints: none.

    Source: section 4.2; W. Blajer, Elimination of constraint violation and accuracy aspects in
    numerical simulation of multibody systems, Multibody System Dynamics 7 (2002) 265-284, section 4.2.
    """

def pendulum(*, length: float = 1.0, mass: float = 1.0, gravity: float = 9.81, angle: float = 1.5707963267948966,
             rate: float = 0.0) -> BuiltIn:
    """Point mass on a massless rod, in Cartesian coordinates.

    The smallest system that can drift from its constraint. The constraint is divided by twice the
    length, so that its violation is the distance from the circle in m, and the multiplier is the
    tension of the rod in N.

    Parameters
    ----------
    length : float in m, positive
        of the rod
    mass : float in kg, positive
    gravity : float in m/s^2, any
        downwards, along -y
    angle : float in rad, any
        at the start, from hanging straight down towards +x
    rate : float in rad/s, any
        its rate at the start

    Coordinates p: x [m], y [m].

    Velocities v: x_dot [m/s], y_dot [m/s].

    Constraints: rod [m].

    Source: IFToMM benchmark A01; IFToMM library of computational benchmark problems, A01; SUNDIALS,
    example cvPendulum.
    """

def knife_edge(*, mass: float = 1.25, inertia: float = 0.13, gravity: float = 9.81, incline: float = 0.7853981633974483,
               heading: float = 0.0, speed: float = 0.0, turn_rate: float = 1.0471975511965979) -> BuiltIn:
    """Knife edge on an inclined plane: one nonholonomic constraint.

    A skate slides along itself and turns, but does not slip sideways. Released at the top of the plane
    with some spin it does not slide down: it moves sideways on a cycloid.

    Parameters
    ----------
    mass : float in kg, positive
    inertia : float in kg m^2, positive
        about the normal of the plane
    gravity : float in m/s^2, any
    incline : float in rad, any
        of the plane, downwards along +x
    heading : float in rad, any
        at the start, from the x axis
    speed : float in m/s, any
        along the edge at the start
    turn_rate : float in rad/s, any
        at the start; it stays

    Coordinates p: x [m], y [m], phi [rad].

    Velocities v: x_dot [m/s], y_dot [m/s], phi_dot [rad/s].

    Constraints: slip [m/s].

    Source: Bloch, section 1.6; A. M. Bloch, Nonholonomic Mechanics and Control, 2nd edition, Springer,
    2015, section 1.6.
    """
