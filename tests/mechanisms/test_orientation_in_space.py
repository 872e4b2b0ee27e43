"""Orientations that a start holds, that are recorded, and that joints measure."""

import numpy as np
import pytest

import zerodrift as zd
from support import assert_close, refused
from zerodrift.mechanisms.elements.frames import about

CLOSED = 1e-12      # of assembled positions


def hung(joint="spherical", **given):
    m = zd.Mechanism("m", dimension=3, gravity=(0, 0, -9.81))
    bar = m.link("bar", (0, 0, 0), (1, 0, 0), mass=1.0)
    getattr(m, joint)("A", m.ground, bar.start, **given)
    return m, bar


@pytest.mark.parametrize("axis", [(0, 1, 0), (0, 1, 1), (1, -2, 0.5)])
@pytest.mark.parametrize("angle", [0.1, 2.0, np.pi])
def test_a_start_holds_a_rotation(axis, angle):
    """However far from the drawing, half a turn included, where no small step says which way."""
    m, bar = hung()
    R = about(axis, angle)
    m.start({bar.rotation: R})
    sol = zd.simulate(m, 0.01, step=1e-3)
    assert_close(sol["bar.rotation"][0], R, CLOSED, scale=1.0)
    assert_close(sol["bar.position"][0], np.zeros(3), CLOSED, scale=1.0)
    m.start({bar.rotation: None})
    assert_close(zd.simulate(m, 0.01, step=1e-3)["bar.rotation"][0], np.eye(3), CLOSED, scale=1.0)


def test_a_start_holds_a_quaternion_and_wishes_a_rotation():
    m, bar = hung()
    m.start({bar.rotation: (0, 0, 1, 0)})
    assert_close(zd.simulate(m, 0.01, step=1e-3)["bar.rotation"][0], np.diag([-1.0, 1, -1]), CLOSED, scale=1.0)
    m, bar = hung("revolute", axis=(0, 1, 0))
    m.start(wish={bar.rotation: about((0, 1, 0), 0.5)})
    assert_close(zd.simulate(m, 0.01, step=1e-3)["A.angle"][0], 0.5, CLOSED)


@pytest.mark.parametrize(("value", "code", "message"), [
    (2 * np.eye(3), "geometry", r"held\['bar.rotation'\]"),
    ((1.0, 0.0, 1.0, 0.0), "geometry", r"held\['bar.rotation'\].*length 1"),
    ((1.0, 0.0, 0.0), "shape", r"held\['bar.rotation'\].*3, 3"),
])
def test_what_is_not_a_rotation_is_refused(value, code, message):
    m, bar = hung()
    with refused(code, message):
        m.start({bar.rotation: value})


def test_a_rotation_that_joints_do_not_allow_is_named():
    m, bar = hung("revolute", axis=(0, 1, 0))
    m.start({bar.rotation: about((1, 0, 0), 1.0)})
    with pytest.raises(zd.InconsistentStart, match=r"'bar.rotation\[2, 1\]' by 0.841, "):
        zd.simulate(m, 0.01, step=1e-3)


def test_recorded_rotations_are_matrices_and_turn_vectors():
    m, bar = hung()
    m.start({bar.rotation: about((0, 1, 0), 0.4), bar.angular_velocity: (0.1, 2.0, 1.0)})
    sol = zd.simulate(m, 0.1, step=1e-2, outputs=["bar.rotation"])
    assert sol["bar.rotation"].shape == (11, 3, 3)
    assert_close(sol["bar.rotation"], zd.simulate(m, 0.1, step=1e-2)["bar.rotation"], 0.0)
    own = sol["bar.angular_velocity", "bar"]
    assert_close(own, [R.T @ w for R, w in zip(sol["bar.rotation"], sol["bar.angular_velocity"], strict=True)], 1e-15)


def test_angles_of_a_universal_joint_have_no_singularity():
    """All the way round its second arm, past the right angles at which a shaft through it would be stuck."""
    m = zd.Mechanism("m", dimension=3)
    body = m.body("body", 1.0, (1, 2, 2.5))
    m.universal("u", m.ground, body, axes=((0, 0, 1), (0, 1, 0)), at=(0, 0, 0))
    m.start({"u.angle1_speed": 0.3, "u.angle2_speed": 4.0})
    sol = zd.simulate(m, 2.0, step=2e-3)
    assert np.ptp(sol["u.angle2"]) > 6
    turned = [about((0, 0, 1), one) @ about((0, 1, 0), other)
              for one, other in zip(sol["u.angle1"], sol["u.angle2"], strict=True)]
    assert_close(sol["body.rotation"], np.array(turned), 1e-11, scale=1.0)


@pytest.mark.parametrize(("height", "message"), [(0.8, "is 0.3 m off the plane; draw its centre 0.5 m from it"),
                                                 (0.4, "is 0.1 m in the plane")])
def test_rolling_without_contact_as_drawn_is_refused(height, message):
    m = zd.Mechanism("m", dimension=3, gravity=(0, 0, -9.81))
    ball = m.body("ball", 1.0, (0.1, 0.1, 0.1), at=(0, 0, height))
    with refused("geometry", f"'floor' has no contact as drawn: 'ball' {message}"):
        m.rolling("floor", m.ground, ball, radius=0.5)
