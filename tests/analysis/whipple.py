"""Whipple's bicycle from its energies, as `zd.symbolic` takes it: a second model beside that of the mechanism.

Coordinates are the place (x, y) of the rear contact, yaw, lean and pitch of the frame, the steer angle, and the turns of the
wheels about their axles. One holonomic constraint keeps the front wheel on the ground, four nonholonomic ones let both
wheels roll. x is forward, y to the right, z down.
"""

import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

import zerodrift as zd

REAR, FRONT = sp.Rational(3, 10), sp.Rational(35, 100)      # m, radii
BASE, TRAIL, TILT, G = 1.02, 0.08, sp.pi / 10, 9.81         # m, m, rad, m/s^2
UP = sp.Matrix([0, 0, 1])


def rotation(axis, angle):
    """Rodrigues' matrix about a unit vector."""
    n = sp.Matrix(axis)
    cross = sp.Matrix([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return sp.eye(3) + sp.sin(angle) * cross + (1 - sp.cos(angle)) * cross * cross


def whipple(speed):
    """The bicycle upright and straight ahead at a speed in m/s."""
    x, y, yaw, lean, pitch, steer, rear, front = q = dynamicsymbols("x y yaw lean pitch steer rear front")
    t = dynamicsymbols._t
    turn = rotation((0, 0, 1), yaw) * rotation((1, 0, 0), lean)
    frame = turn * rotation((0, 1, 0), pitch)
    axis = sp.Matrix([sp.sin(TILT), 0, sp.cos(TILT)])
    steered = rotation(axis, steer)
    fork = frame * steered
    hub = sp.Matrix([x, y, 0]) - turn * UP * REAR
    head = sp.Matrix([BASE + TRAIL, 0, REAR])       # a point of the steering axis, from the rear hub

    def of_frame(place):
        return hub + frame * (sp.Matrix(place) + UP * REAR)

    def of_fork(place):
        return hub + frame * head + fork * (sp.Matrix(place) + UP * REAR - head)

    body, handlebar, wheel = of_frame((0.3, 0, -0.9)), of_fork((0.9, 0, -0.7)), of_fork((BASE, 0, -FRONT))
    w = frame.T * (yaw.diff(t) * UP + lean.diff(t) * rotation((0, 0, 1), yaw) * sp.Matrix([1, 0, 0])
                   + pitch.diff(t) * frame * sp.Matrix([0, 1, 0]))          # angular velocity in axes of the frame
    w_fork = steered.T * (w + steer.diff(t) * axis)
    y_axis = sp.Matrix([0, 1, 0])
    spins = w + rear.diff(t) * y_axis, w_fork + front.diff(t) * y_axis
    parts = [(2.0, hub, spins[0], sp.diag(0.0603, 0.12, 0.0603)), (3.0, wheel, spins[1], sp.diag(0.1405, 0.28, 0.1405)),
             (85.0, body, w, sp.Matrix([[9.2, 0, 2.4], [0, 11.0, 0], [2.4, 0, 2.8]])),
             (4.0, handlebar, w_fork, sp.Matrix([[0.05892, 0, -0.00756], [0, 0.06, 0], [-0.00756, 0, 0.00708]]))]
    kinetic = sum(m * p.diff(t).dot(p.diff(t)) + rate.dot(inertia * rate) for m, p, rate, inertia in parts) / 2
    potential = -sum(m * G * p[2] for m, p, _, _ in parts)
    axle = fork * y_axis
    down = (UP - axle[2] * axle) / sp.sqrt(1 - axle[2]**2)      # from the front hub to its contact
    slip_rear = hub.diff(t) + (frame * spins[0]).cross(turn * UP * REAR)
    slip_front = wheel.diff(t) + (fork * spins[1]).cross(down * FRONT)
    slips = {"rear": slip_rear, "front": slip_front}
    rolling = {f"{end} {axis}": slip[i] for end, slip in slips.items() for i, axis in enumerate("xy")}
    return zd.symbolic(q, kinetic=kinetic, potential=potential, nonholonomic=rolling,
                       constraints={"front": wheel[2] + FRONT * sp.sqrt(1 - axle[2]**2)},
                       units=["m", "m", *["rad"] * 6], p0=[0.0] * 8,
                       v0=[speed, 0, 0, 0, 0, 0, -speed / float(REAR), -speed / float(FRONT)], name="whipple")
