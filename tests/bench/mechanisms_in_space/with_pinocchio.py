"""Pinocchio: a tree of joints, `constraintDynamics` with point constraints where loops are cut, integrated in Python or by SciPy.

What it cannot do: it has no integrator for loops, so that the loop over steps is Python's, and nothing projects what has
drifted in the constraints. Baumgarte's terms, which it has, are left at zero: with gains of 10 and 100 1/s RK4 was at most 4 %
more accurate. `constraintDynamics` takes no external forces: springs are torques of joints, made in NumPy, along a slider from
its coordinate alone. There is no rod among its constraints, which hold points or frames: a massless rod is a universal and a
spherical joint in the tree, and the spherical joint there was closes a loop instead. Spherical joints turn by three angles:
coordinates are a vector, which any integrator takes, but singular at a right angle, which these mechanisms are far from.
"""

import math
import time

import numpy as np
import pinocchio as pin
from scipy.integrate import solve_ivp

STEPS = (1, 2, 4, 8, 16, 32, 64)        # between outputs
TOLERANCES = 10.0 ** -np.arange(2, 12.5, 1.0)
PROXIMAL = (1e-13, 1e-10, 20)           # accuracy, mu, iterations, as for the chains of tests/bench/peers


def sweeps(drawing):
    """The settings of each method."""
    return {"Pinocchio, RK4 by hand": [("rk4", k) for k in STEPS],
            "Pinocchio, SciPy DOP853": [("DOP853", tolerance) for tolerance in TOLERANCES]}


def solve(drawing, setting):
    """Positions and rotation matrices of the bodies, (k, n, 12), and time, s."""
    method, fine = setting
    model, joint_of, levers, constraints = _build(drawing)
    data, held = model.createData(), pin.StdVec_RigidConstraintData()
    for constraint in constraints:
        held.append(constraint.createData())
    pin.initConstraintDynamics(model, data, constraints, held)
    proximal, torques = pin.ProximalSettings(*PROXIMAL), _springs(drawing, model, data, joint_of, levers)
    bodies = [(joint_of[body.name], body.center - levers[body.name]) for body in drawing.bodies]
    placed = np.zeros((drawing.count + 1, len(bodies), 12))

    def acceleration(q, v):
        return pin.constraintDynamics(model, data, q, v, torques(q, v), constraints, held, proximal).copy()

    start = time.process_time()
    motion = (_by_rk4 if method == "rk4" else _by_scipy)(acceleration, model.nv, drawing, fine)
    for row, q in zip(placed, motion, strict=True):
        pin.forwardKinematics(model, data, q)
        for own, (joint, middle) in zip(row, bodies, strict=True):
            own[:3], own[3:] = data.oMi[joint].act(middle), data.oMi[joint].rotation.ravel()
    return placed, time.process_time() - start


def _by_rk4(acceleration, count, drawing, steps):
    """Coordinates at the outputs."""
    q, v, h = np.zeros(count), np.zeros(count), drawing.t_end / drawing.count / steps
    yield q
    for _ in range(drawing.count):
        for _ in range(steps):
            q, v = _step(acceleration, q, v, h)
        yield q


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


def _by_scipy(acceleration, count, drawing, tolerance):
    """Coordinates at the outputs, by steps that are chosen."""
    def rate(t, y):
        return np.concatenate([y[count:], acceleration(y[:count], y[count:])])

    found = solve_ivp(rate, (0, drawing.t_end), np.zeros(2 * count), "DOP853", drawing.outputs, rtol=tolerance, atol=tolerance)
    return found.y[:count].T


def _springs(drawing, model, data, joint_of, levers):
    """A callable that gives the torques (nv,) of all springs: those along sliders need their coordinates alone."""
    sliding = [spring for spring in drawing.springs if _is_along_slider(drawing, spring)]
    column = np.array([model.joints[joint_of[spring.second]].idx_v for spring in sliding], dtype=int)
    stretched, stiffness, damping = np.array([(np.linalg.norm(s.tip - s.tail) - s.length, s.stiffness, s.damping)
                                              for s in sliding]).reshape(-1, 3).T
    others = [_free_spring(spring, model, data, joint_of, levers) for spring in drawing.springs
              if not _is_along_slider(drawing, spring)]

    def torques(q, v):
        torque = np.zeros(model.nv)
        torque[column] = -stiffness * (q[column] + stretched) - damping * v[column]
        if others:
            J = pin.computeJointJacobians(model, data, q)
            for other in others:
                torque += other(J, v)
        return torque

    return torques


def _is_along_slider(drawing, spring):
    """True if the spring acts on a slider along its axis, from the point about which the slider's guide turns."""
    of = {joint.second: joint for joint in drawing.joints if not joint.closes}
    slide = of[spring.second]
    guide = of.get(slide.first)
    if slide.kind != "prismatic" or guide is None or guide.first != spring.first:
        return False
    along = (spring.tip - spring.tail) / np.linalg.norm(spring.tip - spring.tail)
    return np.array_equal(guide.at, spring.tail) and np.allclose(along, slide.axes[0] / np.linalg.norm(slide.axes[0]))


def _free_spring(spring, model, data, joint_of, levers):
    """A callable that gives the torques (nv,) of one spring, from all joints' columns (6, nv) at the origin, and v.

    Both ends lie on the line of its force, which therefore has one wrench about the origin: the columns of the joints
    that carry one end alone, times it, are how fast the spring grows.
    """
    (first, tail), (second, tip) = [(data.oMi[joint_of[name]], place - levers[name])
                                    for name, place in ((spring.first, spring.tail), (spring.second, spring.tip))]
    carried = np.zeros((len(model.joints), model.nv))
    for joint in range(1, len(model.joints)):
        for above in list(model.supports[joint])[1:]:
            own = model.joints[above]
            carried[joint, own.idx_v:own.idx_v + own.nv] = 1
    sign = carried[joint_of[spring.second]] - carried[joint_of[spring.first]]
    length, stiffness, damping = spring.length, spring.stiffness, spring.damping

    def torques(J, v):
        end = second.act(tip)
        apart = end - first.act(tail)
        long = math.sqrt(apart @ apart)
        (a, b, c), (x, y, z) = end.tolist(), (apart / long).tolist()
        growth = np.array([x, y, z, b * z - c * y, c * x - a * z, a * y - b * x]) @ J * sign
        return growth * (stiffness * (length - long) - damping * (growth @ v))

    return torques


def _build(drawing):
    """The model, the joint of each body, where it stands in the drawing, and the constraints."""
    bodies = {body.name: body for body in drawing.bodies}
    inside, closing = _tree(drawing)
    model = pin.Model()
    model.gravity.linear = np.array([0.0, 0.0, -drawing.gravity])
    joint_of, levers, waiting = {None: 0}, {None: np.zeros(3)}, [joint for joint in inside if joint[0] is None]
    while waiting:      # depth first: Pinocchio takes the joints of a branch to be numbered in succession
        first, second, start, end, kind = waiting.pop()
        joint_of[second] = model.addJoint(joint_of[first], kind, _at(start - levers[first]), second)
        body, levers[second] = bodies[second], end
        model.appendBodyToJoint(joint_of[second], pin.Inertia(body.mass, body.center - end, body.inertia), pin.SE3.Identity())
        waiting += [joint for joint in inside if joint[0] == second]
    constraints = pin.StdVec_RigidConstraintModel()
    for joint in closing:
        ends = [part for name in (joint.first, joint.second) for part in (joint_of[name], _at(joint.at - levers[name]))]
        constraints.append(pin.RigidConstraintModel(pin.ContactType.CONTACT_3D, model, *ends, pin.ReferenceFrame.LOCAL))
    return model, joint_of, levers, constraints


def _tree(drawing):
    """Joints of the tree: both bodies, where it begins and ends, and its kind. And those that close loops.

    A body on a rod hangs on it alone.
    """
    inside = [(rod.first, rod.second, rod.tail, rod.tip, _rod(rod.tip - rod.tail)) for rod in drawing.rods]
    on_rods, closing = {rod.second for rod in drawing.rods}, []
    for joint in drawing.joints:
        if joint.closes or joint.second in on_rods:
            assert joint.kind == "spherical", "a point constraint holds nothing else"
            closing.append(joint)
        else:
            inside.append((joint.first, joint.second, joint.at, joint.at, _kind(joint)))
    return inside, closing


def _kind(joint):
    """A joint of Pinocchio's; its frame is parallel to the drawing's at the start."""
    axes = [axis / np.linalg.norm(axis) for axis in joint.axes]
    return {"revolute": pin.JointModelRevoluteUnaligned, "prismatic": pin.JointModelPrismaticUnaligned,
            "universal": pin.JointModelUniversal, "spherical": pin.JointModelSphericalZYX}[joint.kind](*axes)


def _rod(along):
    """A massless rod, which turns about two axes across it, and has a spherical joint at its end."""
    side = np.cross(along, np.eye(3)[int(np.argmin(np.abs(along)))])
    side /= np.linalg.norm(side)
    both = pin.JointModelComposite(pin.JointModelUniversal(side, np.cross(along, side) / np.linalg.norm(along)))
    return both.addJoint(pin.JointModelSphericalZYX(), _at(along))


def _at(place):
    return pin.SE3(np.eye(3), np.asarray(place, dtype=float))
