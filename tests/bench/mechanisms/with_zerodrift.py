"""zerodrift: `zd.Mechanism`, its tables interpreted, in joint and in absolute coordinates."""

import itertools
import time

import numpy as np

import zerodrift as zd

TOLERANCES = 10.0 ** -np.arange(2, 13.5, 1.0)
STEPS = (1, 2, 4, 8, 16, 32, 64)        # between outputs
CERTIFIED = 1e-9                        # error asked of the reference, at most


_systems = {}       # by drawing and coordinates: each is made once


def mechanism(drawing):
    """From bodies and joints."""
    m = zd.Mechanism(drawing.name, gravity=(0, -drawing.gravity))
    bodies = {body.name: m.body(body.name, body.mass, body.inertia, at=body.center) for body in drawing.bodies} | {None: m.ground}
    for i, joint in enumerate(drawing.joints):
        if hasattr(joint, "at"):
            m.revolute(f"J{i}", bodies[joint.first], bodies[joint.second], at=joint.at)
        else:
            m.prismatic(f"J{i}", m.ground, bodies[joint.second], axis=(1, 0))
    for i, spring in enumerate(drawing.springs):
        m.spring(f"S{i}", bodies[spring.first].point(at=spring.tail), bodies[spring.second].point(at=spring.tip),
                 stiffness=spring.stiffness, length=spring.length, damping=spring.damping)
    for name, moment in drawing.torques.items():
        m.torque(f"moment of {name}", bodies[name], value=moment)
    return m


def system_of(drawing, coordinates):
    """Made once; coordinates None: the cheaper ones."""
    key = drawing.name, coordinates
    if key not in _systems:
        _systems[key] = mechanism(drawing).system(coordinates)
    return _systems[key]


def sweeps(drawing):
    """The settings of each method."""
    found = {}
    for coordinates, formulation in itertools.product(("joint", "absolute"), ("schur",)):
        label = f"zerodrift, {coordinates}: {formulation}"
        for integrator in ("rk4", "dop853"):
            found[f"{label}, {integrator}, fixed steps"] = [(coordinates, formulation, integrator, k, None) for k in STEPS]
        found[f"{label}, dop853, adaptive steps"] = [(coordinates, formulation, "dop853", None, tol) for tol in TOLERANCES]
    return found


def growth_sweeps():
    """Settings for many bodies, in the default layout of coordinates."""
    return {"zerodrift, rk4": [(None, "schur", "rk4", k, None) for k in STEPS],
            "zerodrift, dop853": [(None, "schur", "dop853", k, None) for k in STEPS],
            "zerodrift, dop853, adaptive steps": [(None, "schur", "dop853", None, tol) for tol in TOLERANCES]}


def solve(drawing, setting):
    """Displacements and rotations of the bodies, (k, n, 3), and time of `simulate` and of their evaluation, s."""
    coordinates, formulation, integrator, steps, tolerance = setting
    system = system_of(drawing, coordinates)
    fine = ({"step": drawing.t_end / drawing.count / steps, "save_every": steps} if steps
            else {"rtol": tolerance, "atol": tolerance, "t_eval": drawing.outputs})
    start = time.process_time()
    solution = zd.simulate(system, drawing.t_end, formulation=formulation, integrator=integrator, **fine)
    moved = motion(drawing, solution)
    return moved, time.process_time() - start


def motion(drawing, solution):
    """Displacements and rotations of the bodies, (k, n, 3)."""
    moved = np.empty((len(solution.t), len(drawing.bodies), 3))
    if solution.system.layout == "absolute":        # whose coordinates these are: mass centre and angle of each body
        moved[:] = solution.p.reshape(moved.shape)
        moved[:, :, :2] -= drawing.centers
        return moved
    for i, body in enumerate(drawing.bodies):
        moved[:, i, :2] = solution[f"{body.name}.position"] - body.center
        moved[:, i, 2] = solution[f"{body.name}.angle"]
    return moved


def reference(drawing):
    """The motion with a certified error, and that error."""
    found = zd.reference(system_of(drawing, "joint"), drawing.t_end, error=CERTIFIED, t_eval=drawing.outputs)
    return motion(drawing, found.solution), found.error
