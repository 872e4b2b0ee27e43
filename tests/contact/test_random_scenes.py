"""Random scenes with contacts, stops and dry friction against time stepping, and time stepping against closed forms.

All 1,000 scenes with lines are in `stress/contact_scenes.md`; seeds from 1,000 on have other shapes. Those in space are in
`stress/contact_scenes_in_space.md`.
"""

import math

import numpy as np
import pytest

from contact import moreau_in_space as space
from contact import space_scenes
from contact.moreau import GROUND, Body, Pin, Scene, Slider, simulate
from contact.random_scenes import KINDS, SAMPLES, SHAPED, compared, outcome, scene_of
from contact.shapes import Contact

SEEDS = (0, 1, 2, 3, 4, 5, 7, 8, 9, 12, 20, 24, 26, 43, 52, 76, 79, 84, 134, 1000, 1001, 1010, 1012, 1013, 1014, 1015, 1027)
IN_SPACE = (47, 51, 61, 66, 75)         # by coarser time stepping: it is slow
G = 9.81


@pytest.mark.parametrize("seed", SEEDS)
def test_scenes_move_as_by_time_stepping(seed):
    finding, details = outcome(seed)
    assert finding == "agree", details
    assert details["compared"] > 0.1


@pytest.mark.parametrize("seed", IN_SPACE)
def test_scenes_in_space_move_as_by_time_stepping(seed):
    kind, *scene = space_scenes.scene_of(seed)
    finding, details = compared(kind, lambda: space_scenes.motion_of(*scene, *space_scenes.settings_of(seed)),
                                lambda step: space.simulate(*scene, SAMPLES, 5 * step))
    assert finding == "agree", details
    assert details["compared"] > 0.1


def test_the_sample_has_all_kinds():
    assert {scene_of(seed)[0] for seed in SEEDS} == {kind.__name__[1:] for kind in KINDS + SHAPED}


def at_the_end(scene, end, step=2e-3):
    q, v = simulate(scene, [end], step, step / 2**14)
    return q[0], v[0]


def test_time_stepping_of_a_ball():
    ball = Scene((0, -G), [Body(1, 0, (0, 1, 0), (0.3, 0, 0))], [Contact(0, (0, 0), GROUND, (0, 0), 0.0, 0, 0.8, 0.0)], [])
    t, v = math.sqrt(2 / G), 0.8 * math.sqrt(2 * G)
    rest = 1.0 - t
    assert at_the_end(ball, 1.0)[0] == pytest.approx([0.3, v * rest - G * rest * rest / 2, 0], abs=1e-5)


@pytest.mark.parametrize("mu", [0.5, 0.3])
def test_time_stepping_of_a_box_on_an_incline(mu):
    a = 0.4
    box = Scene((0, -G), [Body(1, 0.1, (-0.1 * math.sin(a), 0.1 * math.cos(a), a), (0, 0, 0))],
                [Contact(0, (x, -0.1), GROUND, (0, 0), a, 0, 0, mu) for x in (-0.2, 0.2)], [])
    q, _ = at_the_end(box, 1.0)
    along = q[0] * math.cos(a) + q[1] * math.sin(a)
    assert along == pytest.approx(-max(0, G * (math.sin(a) - mu * math.cos(a))) / 2, abs=1e-9)


def test_time_stepping_of_a_rocking_block():
    b, h, th = 0.2, 0.5, 0.1
    c, s = math.cos(th), math.sin(th)
    block = Scene((0, -G), [Body(1, (b * b + h * h) / 3, (c * b - s * h, s * b + c * h, th), (0, 0, 0))],
                  [Contact(0, (x, -h), GROUND, (0, 0), 0, 0, 0, 0.9) for x in (-b, b)], [])
    times = np.linspace(0, 1, 1001)
    q, v = simulate(block, times, 2e-3, 2e-3 / 2**14)
    after = int(np.argmax(q[:, 2] < 0))         # the first sample that leans on the other corner
    energies = [3 / 2 * 4 * (b * b + h * h) / 9 * v[i, 2]**2 + G * q[i, 1] for i in (after - 1, after)]
    rise = G * h                                # of the block that stands
    share = (energies[1] - rise) / (energies[0] - rise)
    assert share == pytest.approx((1 - 1.5 * math.sin(math.atan2(b, h))**2)**2, abs=1e-6)


def test_time_stepping_of_a_slider_between_stops():
    slider = Scene((0, -G), [Body(1, 1, (0, 0, 0), (2, 0, 0))], [], [Slider(GROUND, (0, 0), 0, 0, 1.0, -0.3, 0.4, 0.9)])
    x, v = 0.4, 0.9 * math.sqrt(4 - 0.8)
    x, v = -0.3, 0.9 * math.sqrt(v * v - 1.4)
    assert at_the_end(slider, 4.0)[0][0] == pytest.approx(x + v * v / 2, abs=1e-5)


def test_time_stepping_of_a_pendulum():
    pendulum = Scene((0, -G), [Body(1, 0.1, (0.5, 0, 0), (0, 0, 0))], [], [Pin(GROUND, (0, 0), 0, (-0.5, 0))])
    k = 0.5 * G / (0.1 + 0.25)                  # 1/s^2
    _, v = simulate(pendulum, [0.5], 1e-3, 1e-7)
    q, _ = simulate(pendulum, [0.5], 1e-3, 1e-7)
    assert v[0, 2]**2 / 2 == pytest.approx(-k * math.sin(q[0, 2]), rel=1e-5)


def test_time_stepping_of_a_ball_in_space():
    """Slides until it rolls, with the velocity v - 2/7 of the slip; and one that bounces."""
    r, v, w, mu = 0.1, np.array([2.0, 1.0, 0]), np.array([5.0, 0, 3.0]), 0.3
    ball = space.Body(2.0, np.full(3, 0.4 * 2 * r**2), np.array([0, 0, r]), np.eye(3), v, w)
    floor = space.Contact(0, np.zeros(3), r, GROUND, np.zeros(3), np.array([0, 0, 1.0]), 0.0, 0.0, mu)
    slip = v + np.cross(w, (0, 0, -r))
    way = np.linalg.norm(slip)
    t = 2 * way / (7 * mu * G)
    end = v * t - mu * G / 2 * slip / way * t * t + (v - slip * 2 / 7) * (1 - t)
    assert space.simulate([ball], [floor], [1.0], 2e-3)[0][:3] == pytest.approx([*end[:2], r], abs=1e-4)
    dropped = ball._replace(x=np.array([0, 0, 1 + r]), v=np.zeros(3), w=np.zeros(3))
    t, up = math.sqrt(2 / G), 0.8 * math.sqrt(2 * G)
    found = space.simulate([dropped], [floor._replace(e=0.8)], [1.0], 2e-3)[0]
    assert found[2] - r == pytest.approx(up * (1 - t) - G * (1 - t)**2 / 2, abs=1e-5)
