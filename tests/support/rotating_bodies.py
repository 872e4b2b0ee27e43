"""Bodies in space whose attitude is a unit quaternion, one point of them being fixed: held by constraints, or without any."""

from functools import cache

import numpy as np
import sympy as sp

import zerodrift as zd

PLACE, TURN = sp.symbols("x y z"), sp.symbols("e0:4")
SPEED, SPIN = sp.symbols("vx vy vz"), sp.symbols("w1:4")


def matrix(e):
    """The axes of a body, as columns, of its unit quaternion, scalar first."""
    w, x, y, z = e
    return sp.Matrix([[w**2 + x**2 - y**2 - z**2, 2 * (x * y - w * z), 2 * (x * z + w * y)],
                      [2 * (x * y + w * z), w**2 - x**2 + y**2 - z**2, 2 * (y * z - w * x)],
                      [2 * (x * z - w * y), 2 * (y * z + w * x), w**2 - x**2 - y**2 + z**2]])


def turning(e, omega):
    """The rate of a quaternion from angular velocity in the body."""
    w, x, y, z = e
    return list(sp.Matrix([[-x, -y, -z], [w, -z, y], [z, w, -x], [-y, x, w]]) * sp.Matrix(omega) / 2)


def gyroscopic(inertia):
    momentum = sp.Matrix([J * w for J, w in zip(inertia, SPIN, strict=True)])
    return list(sp.Matrix(SPIN).cross(momentum))


@cache
def held_at_a_point(mass, inertia, arm, omega, gravity=9.81):
    """A body whose point at -arm from its centre of mass, in the body, stays at the origin; it starts with axes as the room's."""
    velocity = np.cross(omega, arm)
    return zd.symbolic(
        [*PLACE, *TURN], speeds=[*SPEED, *SPIN], kinematics=[*SPEED, *turning(TURN, SPIN)], quaternions=["e0"],
        mass=sp.diag(mass, mass, mass, *inertia), bias=[0, 0, 0, *gyroscopic(inertia)], potential=mass * gravity * PLACE[2],
        constraints=list(sp.Matrix(PLACE) - matrix(TURN) * sp.Matrix(arm)),
        units=["m"] * 3 + [""] * 4 + ["m/s"] * 3 + ["rad/s"] * 3, p0=[*arm, 1, 0, 0, 0], v0=[*velocity, *omega],
        name="body held at a point", progress=False)


@cache
def about_a_point(mass, inertia, arm, omega, gravity=9.81, quaternions=(0,)):
    """The same in its angular velocity alone; inertia is about the centre of mass, and arm along an axis."""
    shifted = [J + mass * (sum(b**2 for b in arm) - a**2) for J, a in zip(inertia, arm, strict=True)]
    return zd.symbolic(
        TURN, speeds=SPIN, kinematics=turning(TURN, SPIN), quaternions=quaternions, mass=sp.diag(*shifted),
        bias=gyroscopic(shifted), potential=mass * gravity * (matrix(TURN) * sp.Matrix(arm))[2], p0=[1, 0, 0, 0], v0=omega,
        name="body about a point", progress=False)
