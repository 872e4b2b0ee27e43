"""zerodrift: `zd.Mechanism` in space, its tables interpreted."""

import time

import numpy as np

import zerodrift as zd

TOLERANCES = 10.0 ** -np.arange(2, 12.5, 1.0)
STEPS = (1, 2, 4, 8, 16, 32)            # between outputs
CERTIFIED = 1e-9                        # error asked of the reference, at most

_systems = {}       # by drawing and coordinates: each is made once


def mechanism(drawing):
    """From bodies and joints."""
    m = zd.Mechanism(drawing.name, dimension=3, gravity=(0, 0, -drawing.gravity))
    bodies = {body.name: m.body(body.name, body.mass, body.inertia, at=body.center) for body in drawing.bodies} | {None: m.ground}
    for i, (kind, first, second, at, axes, _) in enumerate(drawing.joints):
        more = {"axes": axes} if len(axes) == 2 else {"axis": axes[0]} if axes else {}
        getattr(m, kind)(f"J{i}", bodies[first], bodies[second], at=at, **more)
    for i, rod in enumerate(drawing.rods):
        m.rod(f"R{i}", bodies[rod.first].point(at=rod.tail), bodies[rod.second].point(at=rod.tip))
    for i, spring in enumerate(drawing.springs):
        m.spring(f"S{i}", bodies[spring.first].point(at=spring.tail), bodies[spring.second].point(at=spring.tip),
                 stiffness=spring.stiffness, length=spring.length, damping=spring.damping)
    return m


def system_of(drawing, coordinates):
    """Made once."""
    key = drawing.name, coordinates
    if key not in _systems:
        _systems[key] = mechanism(drawing).system(coordinates)
    return _systems[key]


def sweeps(drawing):
    """The settings of each method."""
    found = {}
    for coordinates in ("joint", "absolute"):
        label = f"zerodrift, {coordinates}: schur"
        for integrator in ("rk4", "dop853"):
            found[f"{label}, {integrator}, fixed steps"] = [(coordinates, integrator, k, None) for k in STEPS]
        found[f"{label}, dop853, adaptive steps"] = [(coordinates, "dop853", None, tol) for tol in TOLERANCES]
    return found


def solve(drawing, setting):
    """Positions and rotation matrices of the bodies, (k, n, 12), and time of `simulate` with their output and of reading, s."""
    coordinates, integrator, steps, tolerance = setting
    system = system_of(drawing, coordinates)
    fine = ({"step": drawing.t_end / drawing.count / steps, "save_every": steps} if steps
            else {"rtol": tolerance, "atol": tolerance, "t_eval": drawing.outputs})
    outputs = [f"{body.name}.{what}" for body in drawing.bodies for what in ("position", "rotation")]
    start = time.process_time()
    placed = motion(drawing, zd.simulate(system, drawing.t_end, integrator=integrator, outputs=outputs, **fine))
    return placed, time.process_time() - start


def motion(drawing, solution):
    """Positions and rotation matrices of the bodies, (k, n, 12)."""
    return np.stack([np.hstack([solution[f"{body.name}.position"], solution[f"{body.name}.rotation"].reshape(-1, 9)])
                     for body in drawing.bodies], axis=1)


def reference(drawing):
    """The motion with a certified error, and that error."""
    found = zd.reference(system_of(drawing, "absolute"), drawing.t_end, error=CERTIFIED, t_eval=drawing.outputs)
    return motion(drawing, found.solution), found.error
