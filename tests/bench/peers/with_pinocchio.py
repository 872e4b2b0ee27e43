"""Pinocchio: `constraintDynamics` with a point constraint at the tip, integrated by RK4 written by hand, or by SciPy's DOP853.

Coordinates are the angles of the joints. The proximal solver stands a constraint that says 0 = 0, which a point constraint does
across the plane.
"""

import time

import numpy as np
import pinocchio as pin
from problems import GRAVITY
from scipy.integrate import solve_ivp

TOLERANCES = 10.0 ** -np.arange(2, 13.5, 0.5)
STEPS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64)      # between outputs
PROXIMAL = (1e-13, 1e-10, 20)       # accuracy, mu, iterations: no larger error of any run, at one or two iterations


def sweeps(chain):
    """The settings of each method."""
    return {"Pinocchio, RK4 by hand": [("rk4", k) for k in STEPS],
            "Pinocchio, SciPy DOP853": [("DOP853", tolerance) for tolerance in TOLERANCES]}


def solve(chain, setting):
    """Angles (k, n) at the outputs, and seconds."""
    method, fine = setting
    acceleration = _accelerations(chain)
    q0, v0 = np.diff(chain.p0, prepend=0), np.diff(chain.v0, prepend=0)
    integrate = _rk4 if method == "rk4" else _dop853
    start = time.process_time()
    q = integrate(chain, acceleration, q0, v0, fine)
    return q.cumsum(axis=1), time.process_time() - start


def _accelerations(chain):
    model = pin.Model()
    model.gravity.linear = np.array([0.0, -GRAVITY, 0.0])
    joint, place = 0, np.zeros(3)
    for i in range(chain.n):
        joint = model.addJoint(joint, pin.JointModelRZ(), pin.SE3(np.eye(3), place), f"joint {i}")
        length, middle = chain.lengths[i], np.array([chain.lengths[i] / 2, 0, 0])
        model.appendBodyToJoint(joint, pin.Inertia(chain.masses[i], middle, chain.inertias[i] * np.eye(3)), pin.SE3.Identity())
        place = np.array([length, 0, 0])
    tip = pin.RigidConstraintModel(pin.ContactType.CONTACT_3D, model, joint, pin.SE3(np.eye(3), place), 0,
                                   pin.SE3(np.eye(3), np.array([chain.distance, 0, 0])), pin.ReferenceFrame.LOCAL)
    data, constraints, held = model.createData(), pin.StdVec_RigidConstraintModel(), pin.StdVec_RigidConstraintData()
    constraints.append(tip)
    held.append(tip.createData())
    pin.initConstraintDynamics(model, data, constraints, held)
    proximal, none = pin.ProximalSettings(*PROXIMAL), np.zeros(chain.n)
    return lambda q, v: pin.constraintDynamics(model, data, q, v, none, constraints, held, proximal)


def _rk4(chain, acceleration, q, v, steps):
    """Angles of the joints at the outputs, with so many steps between them."""
    saved, h = [q], chain.spacing / steps
    for step in range(1, steps * (len(chain.outputs) - 1) + 1):
        a1 = acceleration(q, v).copy()
        v2 = v + h / 2 * a1
        a2 = acceleration(q + h / 2 * v, v2).copy()
        v3 = v + h / 2 * a2
        a3 = acceleration(q + h / 2 * v2, v3).copy()
        v4 = v + h * a3
        a4 = acceleration(q + h * v3, v4)
        q, v = q + h / 6 * (v + 2 * (v2 + v3) + v4), v + h / 6 * (a1 + 2 * (a2 + a3) + a4)
        if step % steps == 0:
            saved.append(q)
    return np.array(saved)


def _dop853(chain, acceleration, q, v, tolerance):
    n = chain.n
    solution = solve_ivp(lambda t, y: np.concatenate([y[n:], acceleration(y[:n], y[n:])]), (0, chain.t_end),
                         np.concatenate([q, v]), "DOP853", t_eval=chain.outputs, rtol=tolerance, atol=tolerance)
    return solution.y[:n].T
