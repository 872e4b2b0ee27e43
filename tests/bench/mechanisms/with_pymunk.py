"""pymunk: Chipmunk's rigid bodies and joints, solved by iterated impulses, semi-implicit steps of order one.

What remains open in a joint after a step is closed over the next ones; how fast is `error_bias`. Its default is for games, at
60 steps a second; here half of it is to be gone after a step.
"""

import time

import numpy as np
import pymunk
from drawings import Revolute

STEPS = (1, 4, 16, 64, 256)     # between outputs
ITERATIONS = (30, 300)


def sweeps(drawing):
    """The settings of each method."""
    return {f"pymunk, {iterations} iterations": [(iterations, k) for k in STEPS] for iterations in ITERATIONS}


def solve(drawing, setting):
    """Displacements and rotations of the bodies, (k, n, 3), and time, s."""
    iterations, steps = setting
    h = drawing.t_end / drawing.count / steps
    space, bodies = _build(drawing, iterations, h)
    moved = np.zeros((drawing.count + 1, len(bodies), 3))
    driven = [(bodies[name], moment) for name, moment in drawing.torques.items()]
    start = time.process_time()
    for row in moved[1:]:
        for _ in range(steps):
            for body, moment in driven:
                body.torque = moment
            space.step(h)
        row[:] = [(*body.position, body.angle) for body in bodies.values()]
    moved[1:, :, :2] -= drawing.centers
    return moved, time.process_time() - start


def _build(drawing, iterations, step):
    space = pymunk.Space()
    space.gravity, space.iterations = (0.0, -drawing.gravity), iterations
    bodies = {}
    for body in drawing.bodies:
        bodies[body.name] = pymunk.Body(body.mass, body.inertia)
        bodies[body.name].position = tuple(map(float, body.center))
    space.add(*bodies.values())
    either, joints = bodies | {None: space.static_body}, []
    for joint in drawing.joints:
        if isinstance(joint, Revolute):
            joints.append(pymunk.PivotJoint(either[joint.first], either[joint.second], tuple(map(float, joint.at))))
        else:
            body = either[joint.second]
            joints += [pymunk.GrooveJoint(space.static_body, body, (-10.0, 0.0), (10.0, 0.0), (0.0, 0.0)),
                       pymunk.GearJoint(space.static_body, body, 0.0, 1.0)]
    for joint in joints:
        joint.error_bias, joint.max_bias = 0.5 ** (1 / step), float("inf")
    for spring in drawing.springs:
        ends = either[spring.first], either[spring.second]
        joints.append(pymunk.DampedSpring(*ends, *(body.world_to_local(tuple(map(float, at))) for body, at in
                                                   zip(ends, (spring.tail, spring.tip), strict=True)),
                                          spring.length, spring.stiffness, spring.damping))
    space.add(*joints)
    return space, bodies
