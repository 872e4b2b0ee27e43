"""MuJoCo: a tree of hinges and slides, loops closed by equality constraints that are as stiff as MuJoCo lets them be.

Its constraints are soft by design. `solimp` has the largest impedance there is, 0.9999, everywhere; the time constant of `solref`
is two steps, the least that is stable, or ten. All that is not needed is off, and the loop over steps is MuJoCo's own.
"""

import time

import mujoco
import numpy as np
from drawings import Revolute, tree

STEPS = (1, 2, 4, 8, 16, 32, 64, 128, 256, 512)     # between outputs
METHODS = (("implicitfast", 2, 128), ("RK4", 2, 512), ("RK4", 10, 512))     # integrator, time constant, most steps

mujoco.set_mju_user_warning(lambda message: None)     # counted in the data, too; else it is written to a file


def sweeps(drawing):
    """The settings of each method."""
    return {f"MuJoCo {integrator}, solref {constant} steps": [(integrator, constant, k) for k in STEPS if k <= most]
            for integrator, constant, most in METHODS}


def solve(drawing, setting):
    """Displacements and rotations of the bodies, (k, n, 3), and time, s."""
    integrator, constant, steps = setting
    h = drawing.t_end / drawing.count / steps
    model = mujoco.MjModel.from_xml_string(described(drawing, integrator, h, constant * h))
    data = mujoco.MjData(model)
    ids = [model.body(body.name).id for body in drawing.bodies]
    for name, moment in drawing.torques.items():
        data.xfrc_applied[model.body(name).id, 5] = moment
    moved = np.zeros((drawing.count + 1, len(ids), 3))
    start = time.process_time()
    for row in moved[1:]:
        mujoco.mj_step(model, data, nstep=steps)
        mujoco.mj_kinematics(model, data)
        row[:, :2] = data.xipos[ids, :2]
        row[:, 2] = 2 * np.arctan2(data.xquat[ids, 3], data.xquat[ids, 0])
    moved[1:, :, :2] -= drawing.centers
    moved[:, :, 2] = np.unwrap(moved[:, :, 2], axis=0)
    seconds = time.process_time() - start
    if sum(warning.number for warning in data.warning):
        raise RuntimeError("MuJoCo warns that the simulation is unstable")
    return moved, seconds


def described(drawing, integrator, step, constant):
    """The model's text: every body's frame stands at its joint in the tree, parallel to the drawing's at the start."""
    children, closing = tree(drawing)
    solver = f'solref="{constant!r} 1" solimp="0.9999 0.9999 0.001"'
    closed = "".join(f'<connect body1="{joint.second}" {f"body2={chr(34)}{joint.first}{chr(34)}" if joint.first else ""} '
                     f'anchor="{_text(joint.at - at)}" {solver}/>' for joint, at in closing)
    at = {name: anchor for branch in children.values() for name, _, anchor in branch} | {None: np.zeros(2)}
    sites = {name: "" for name in at}
    tendons = ""
    for i, spring in enumerate(drawing.springs):
        sites[spring.first] += f'<site name="tail{i}" pos="{_text(spring.tail - at[spring.first])}"/>'
        sites[spring.second] += f'<site name="tip{i}" pos="{_text(spring.tip - at[spring.second])}"/>'
        tendons += (f'<spatial springlength="{spring.length!r}" stiffness="{spring.stiffness!r}" damping="{spring.damping!r}">'
                    f'<site site="tail{i}"/><site site="tip{i}"/></spatial>')
    bodies = {body.name: body for body in drawing.bodies}

    def below(parent):
        text = sites[parent]
        for name, joint, anchor in children.get(parent, ()):
            body = bodies[name]
            kind = 'axis="0 0 1"' if isinstance(joint, Revolute) else 'type="slide" axis="1 0 0"'
            inertia = " ".join(3 * [repr(float(body.inertia))])
            text += (f'<body name="{name}" pos="{_text(anchor - at[parent])}"><joint {kind}/><inertial mass="{body.mass!r}" '
                     f'pos="{_text(body.center - anchor)}" diaginertia="{inertia}"/>{below(name)}</body>')
        return text

    return f"""<mujoco>
      <compiler angle="radian" balanceinertia="true"/>
      <option integrator="{integrator}" timestep="{step!r}" gravity="0 {-drawing.gravity} 0" tolerance="1e-14" iterations="20">
        <flag contact="disable"/>
      </option>
      <worldbody>{below(None)}</worldbody>
      <equality>{closed}</equality>
      <tendon>{tendons}</tendon>
    </mujoco>"""


def _text(point):
    return f"{float(point[0])!r} {float(point[1])!r} 0"
