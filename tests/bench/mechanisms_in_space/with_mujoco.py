"""MuJoCo: a tree of hinges, slides and balls, loops and rods closed by equality constraints as stiff as MuJoCo lets them be.

What it cannot do: its constraints are soft by design, so that no step makes the error of a loop vanish. `solimp` has the
largest impedance there is, 0.9999; the time constant of `solref` is two steps, the least that is stable, or ten. There is no rod,
whose place a tendon of constant length takes, and no universal joint, whose place two hinges take. Its steps are fixed.
"""

import time

import mujoco
import numpy as np

STEPS = (1, 2, 4, 8, 16, 32, 64, 128, 256)     # between outputs
METHODS = (("implicitfast", 2, 128), ("RK4", 2, 256), ("RK4", 10, 256))     # integrator, time constant, most steps

mujoco.set_mju_user_warning(lambda message: None)     # counted in the data, too; else it is written to a file


def sweeps(drawing):
    """The settings of each method."""
    return {f"MuJoCo {integrator}, solref {constant} steps": [(integrator, constant, k) for k in STEPS if k <= most]
            for integrator, constant, most in METHODS}


def solve(drawing, setting):
    """Positions and rotation matrices of the bodies, (k, n, 12), and time, s."""
    integrator, constant, steps = setting
    h = drawing.t_end / drawing.count / steps
    model = mujoco.MjModel.from_xml_string(described(drawing, integrator, h, constant * h))
    data = mujoco.MjData(model)
    ids = [model.body(body.name).id for body in drawing.bodies]
    middles = [model.site(f"c {body.name}").id for body in drawing.bodies]
    placed = np.zeros((drawing.count + 1, len(ids), 12))
    start = time.process_time()
    for i, row in enumerate(placed):
        if i:
            mujoco.mj_step(model, data, nstep=steps)
        mujoco.mj_kinematics(model, data)
        row[:, :3], row[:, 3:] = data.site_xpos[middles], data.xmat[ids]
    seconds = time.process_time() - start
    if sum(warning.number for warning in data.warning):
        raise RuntimeError("MuJoCo warns that the simulation is unstable")
    return placed, seconds


def described(drawing, integrator, step, constant):
    """The model's text: every body's frame stands at its joint in the tree, parallel to the drawing's at the start."""
    solver = f'solref="{constant!r} 1" solimp="0.9999 0.9999 0.001"'
    inside = [joint for joint in drawing.joints if not joint.closes]
    at = {joint.second: joint.at for joint in inside} | {None: np.zeros(3)}
    closed = "".join(f'<connect body1="{joint.second}" body2="{joint.first}" anchor="{_text(joint.at - at[joint.second])}" '
                     f'{solver}/>' for joint in drawing.joints if joint.closes)
    sites, tendons = {name: "" for name in at}, ""
    for i, link in enumerate([*drawing.rods, *drawing.springs]):
        sites[link.first] += f'<site name="tail{i}" pos="{_text(link.tail - at[link.first])}"/>'
        sites[link.second] += f'<site name="tip{i}" pos="{_text(link.tip - at[link.second])}"/>'
        is_rod = i < len(drawing.rods)
        soft = "" if is_rod else f'springlength="{link.length!r}" stiffness="{link.stiffness!r}" damping="{link.damping!r}"'
        tendons += f'<spatial name="t{i}" {soft}><site site="tail{i}"/><site site="tip{i}"/></spatial>'
        closed += f'<tendon tendon1="t{i}" {solver}/>' if is_rod else ""
    bodies = {body.name: body for body in drawing.bodies}

    def below(parent):
        text = sites[parent]
        for joint in inside:
            if joint.first == parent:
                body = bodies[joint.second]
                middle, J = body.center - joint.at, body.inertia
                inertia = " ".join(repr(float(J[i, j])) for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)))
                text += (f'<body name="{body.name}" pos="{_text(joint.at - at[parent])}">{_freedoms(joint)}'
                         f'<inertial mass="{body.mass!r}" pos="{_text(middle)}" fullinertia="{inertia}"/>'
                         f'<site name="c {body.name}" pos="{_text(middle)}"/>{below(body.name)}</body>')
        return text

    return f"""<mujoco>
      <compiler angle="radian"/>
      <option integrator="{integrator}" timestep="{step!r}" gravity="0 0 {-drawing.gravity}" tolerance="1e-14" iterations="30">
        <flag contact="disable"/>
      </option>
      <worldbody>{below(None)}</worldbody>
      <equality>{closed}</equality>
      <tendon>{tendons}</tendon>
    </mujoco>"""


def _freedoms(joint):
    if joint.kind == "spherical":
        return '<joint type="ball"/>'
    kind = "slide" if joint.kind == "prismatic" else "hinge"
    return "".join(f'<joint type="{kind}" axis="{_text(axis / np.linalg.norm(axis))}"/>' for axis in joint.axes)


def _text(place):
    return " ".join(repr(float(each)) for each in place)
