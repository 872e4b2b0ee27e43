"""Pinocchio: the tree of joints, `constraintDynamics` with a point constraint where a loop is cut, integrated by RK4 in Python.

Hinges alone. Nothing corrects what has drifted in the constraints, and Pinocchio has no integrator with loops of its own. The
proximal solver stands the row of a point constraint that says 0 = 0, across the plane.
"""

import time

import numpy as np
import pinocchio as pin
from drawings import tree

STEPS = (1, 2, 4, 8, 16, 32, 64)        # between outputs
PROXIMAL = (1e-13, 1e-10, 20)           # accuracy, mu, iterations, as for the chains of tests/bench/peers


def sweeps(drawing):
    """The settings of each method."""
    return {"Pinocchio, RK4 by hand": [("rk4", k) for k in STEPS]}


def solve(drawing, setting):
    """Displacements and rotations of the bodies, (k, n, 3), and time, s."""
    _, steps = setting
    model, joint_of, constraints = _build(drawing)
    data, held = model.createData(), pin.StdVec_RigidConstraintData()
    for constraint in constraints:
        held.append(constraint.createData())
    pin.initConstraintDynamics(model, data, constraints, held)
    proximal, none = pin.ProximalSettings(*PROXIMAL), np.zeros(model.nv)
    ids, h = [joint_of[body.name] for body in drawing.bodies], drawing.t_end / drawing.count / steps
    moved = np.zeros((drawing.count + 1, len(ids), 3))
    q, v = np.zeros(model.nv), np.zeros(model.nv)

    def acceleration(q, v):
        return pin.constraintDynamics(model, data, q, v, none, constraints, held, proximal).copy()

    start = time.process_time()
    for row in moved[1:]:
        for _ in range(steps):
            q, v = _step(acceleration, q, v, h)
        pin.forwardKinematics(model, data, q)
        row[:] = [_place(data.oMi[i], model.inertias[i].lever) for i in ids]
    seconds = time.process_time() - start
    moved[1:, :, :2] -= drawing.centers
    moved[:, :, 2] = np.unwrap(moved[:, :, 2], axis=0)
    return moved, seconds


def _step(acceleration, q, v, h):
    """Step of RK4."""
    a1 = acceleration(q, v)
    v2 = v + h / 2 * a1
    a2 = acceleration(q + h / 2 * v, v2)
    v3 = v + h / 2 * a2
    a3 = acceleration(q + h / 2 * v2, v3)
    v4 = v + h * a3
    a4 = acceleration(q + h * v3, v4)
    return q + h / 6 * (v + 2 * (v2 + v3) + v4), v + h / 6 * (a1 + 2 * (a2 + a3) + a4)


def _place(frame, lever):
    """Position of a mass centre (x, y), m, and angle of the body, rad."""
    x, y, _ = frame.act(lever)
    return x, y, np.arctan2(frame.rotation[1, 0], frame.rotation[0, 0])


def _build(drawing):
    """The model, the joint of each body, and the constraints; every body's frame stands at its joint."""
    children, closing = tree(drawing)
    bodies = {body.name: body for body in drawing.bodies}
    model = pin.Model()
    model.gravity.linear = np.array([0.0, -drawing.gravity, 0.0])
    joint_of, at = {None: 0}, {None: np.zeros(2)}
    waiting = [(None, *child) for child in children[None]]
    while waiting:      # depth first: Pinocchio takes the joints of a branch to be numbered in succession
        parent, name, _, anchor = waiting.pop()
        place = pin.SE3(np.eye(3), np.array([*(anchor - at[parent]), 0.0]))
        joint_of[name] = model.addJoint(joint_of[parent], pin.JointModelRZ(), place, name)
        body = bodies[name]
        inertia = pin.Inertia(body.mass, np.array([*(body.center - anchor), 0.0]), body.inertia * np.eye(3))
        model.appendBodyToJoint(joint_of[name], inertia, pin.SE3.Identity())
        at[name] = anchor
        waiting += [(name, *child) for child in children.get(name, ())]
    constraints = pin.StdVec_RigidConstraintModel()
    for joint, _ in closing:
        places = [pin.SE3(np.eye(3), np.array([*(joint.at - at[name]), 0.0])) for name in (joint.first, joint.second)]
        ends = joint_of[joint.first], places[0], joint_of[joint.second], places[1]
        constraints.append(pin.RigidConstraintModel(pin.ContactType.CONTACT_3D, model, *ends, pin.ReferenceFrame.LOCAL))
    return model, joint_of, constraints
