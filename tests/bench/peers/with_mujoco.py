"""MuJoCo: hinges, and an equality constraint that connects the tip, as stiff as MuJoCo lets it be.

Its constraints are soft by design. `solimp` has the largest impedance there is, 0.9999, everywhere; the time constant of `solref`
is two steps, the least that is stable, or ten. All that is not needed is off, and the loop over steps is MuJoCo's own.
"""

import time

import mujoco
import numpy as np
from problems import GRAVITY

STEPS = (4, 8, 16, 32, 64, 128, 256, 512, 1024)     # between outputs
METHODS = (("Euler", 2, 256), ("implicitfast", 2, 256), ("RK4", 2, 1024), ("RK4", 10, 1024))   # time constant, most steps

mujoco.set_mju_user_warning(lambda message: None)     # counted in the data, too; else it is written to a file


def sweeps(chain):
    """The settings of each method."""
    return {f"MuJoCo {integrator}, solref {constant} steps": [(integrator, constant, k) for k in STEPS if k <= most]
            for integrator, constant, most in METHODS}


def solve(chain, setting):
    """Angles (k, n) at the outputs, and seconds."""
    integrator, constant, steps = setting
    h = chain.spacing / steps
    model = mujoco.MjModel.from_xml_string(_described(chain, integrator, h, constant * h))
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = np.diff(chain.p0, prepend=0), np.diff(chain.v0, prepend=0)
    q = np.empty((len(chain.outputs), chain.n))
    q[0] = data.qpos
    start = time.process_time()
    for row in q[1:]:
        mujoco.mj_step(model, data, nstep=steps)
        row[:] = data.qpos
    seconds = time.process_time() - start
    if sum(warning.number for warning in data.warning):
        raise RuntimeError("MuJoCo warns that the simulation is unstable")
    return q.cumsum(axis=1), seconds


def _described(chain, integrator, step, constant):
    rods, before = "", 0.0
    for length, mass, inertia in np.stack([chain.lengths, chain.masses, chain.inertias]).T.tolist():
        rods += (f'<body pos="{before!r} 0 0"><joint axis="0 0 1"/><inertial pos="{length / 2!r} 0 0" mass="{mass!r}" '
                 f'diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>')
        before = float(length)
    return f"""<mujoco>
      <compiler angle="radian"/>
      <option integrator="{integrator}" timestep="{step!r}" gravity="0 {-GRAVITY} 0" tolerance="1e-14" iterations="20">
        <flag contact="disable"/>
      </option>
      <worldbody>
        <site name="end" pos="{chain.distance} 0 0"/>
        {rods}<site name="tip" pos="{before!r} 0 0"/>{"</body>" * chain.n}
      </worldbody>
      <equality>
        <connect site1="tip" site2="end" solref="{constant!r} 1" solimp="0.9999 0.9999 0.001"/>
      </equality>
    </mujoco>"""
