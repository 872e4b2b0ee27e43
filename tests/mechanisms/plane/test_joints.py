"""Every kind of joint of the core's table: its rows, and what they do to the two bodies that it joins."""

import numpy as np
import pytest

import tolerances as tol
from mechanism_tables import KINDS, Body, Joint, OutputSpec, Tabled, Tables, joint_measures, rotation
from support import along, assert_close, numbers

AXIS, FIRST, SECOND = (0.6, 0.8), (0.3, -0.4), (-0.2, 0.7)


@pytest.fixture(params=KINDS)
def joined(request):
    """Two free bodies and a joint between them, at a state that does not satisfy it."""
    kind = KINDS[request.param]
    first = 2 if kind.rows[0].nonholonomic else 1
    joint = Joint(kind.number, first, 2, FIRST, SECOND, AXIS, 0.1, 0.2, 0.3, 0.4)
    rng = np.random.default_rng(11)
    system = Tabled(Tables([Body(1.0, 1.0), Body(1.0, 1.0)], [joint], measures=joint_measures([joint])))
    system.p0, system.v0 = rng.normal(size=6), rng.normal(size=6)
    return kind, joint, system


def test_rows_are_derivatives(joined):
    kind, _, system = joined
    p, v = system.p0, system.v0
    e = numbers(system, 0.0, p, v)
    assert system.mn == sum(row.nonholonomic for row in kind.rows)
    assert system.m == len(kind.rows)
    slopes = [along(lambda p: numbers(system, 0.0, p, v).Phi, (p, w)) for w in np.eye(6)]
    assert_close(e.C[:system.mh], np.array(slopes).T, tol.DIFFERENCE, scale=1, what="C")
    assert_close(e.xi, -along(lambda p: numbers(system, 0.0, p, v).C @ v, (p, v)), tol.DIFFERENCE, scale=1, what="xi")


def test_what_the_rows_do_is_the_joints_force_and_torque(joined):
    """A force at the joint's point of the second body, with a torque, and the opposite of both on the first."""
    kind, joint, system = joined
    multipliers = np.arange(1.0, 1 + system.m)
    poses = {1: system.p0[:3], 2: system.p0[3:]}
    point = poses[2][:2] + rotation(poses[2][2]) @ SECOND
    if kind.rows[0].quantity == "x":       # the points of both bodies are to coincide
        poses[1][:2] = point - rotation(poses[1][2]) @ FIRST
    force, torque = (system.measured(f"0.{what}", 0, system.p0, system.v0, np.zeros(6), multipliers)
                     for what in ("force", "torque"))
    if kind.at_contact:
        e = rotation(poses[1][2]) @ AXIS
        up = np.array([-e[1], e[0]])
        if not kind.takes_axis:
            up = point - (poses[1][:2] + rotation(poses[1][2]) @ FIRST)
            up /= np.linalg.norm(up)
        point = point - joint.length * up
    on_bodies = -numbers(system, 0.0, system.p0, system.v0).C.T @ multipliers
    expected = np.zeros(6)
    for body, sign in ((2, 1), (joint.first, -1))[:1 if joint.first == joint.second else 2]:
        arm = point - poses[body][:2]
        expected[3 * body - 3:3 * body] = sign * np.array([*force, torque[0] + arm[0] * force[1] - arm[1] * force[0]])
    assert_close(on_bodies, expected, tol.SAME, scale=1)


@pytest.mark.parametrize("name", [name for name in KINDS if KINDS[name].tension])
def test_the_tension_pulls_the_bodies_together(name):
    assert KINDS[name].rows[0].quantity == "distance"
    joint = Joint(KINDS[name].number, 1, 2, FIRST, SECOND, length=0.4)
    system = Tabled(Tables([Body(1.0, 1.0), Body(1.0, 1.0)], [joint], measures=[OutputSpec("tension", "N", "joint tension", 0)]))
    state = np.random.default_rng(11).normal(size=(3, 6))
    assert_close(system.measured("tension", 0, *state, np.array([-2.5])), np.array([-2.5]), tol.SAME)
