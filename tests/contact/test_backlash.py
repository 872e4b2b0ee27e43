"""Gears with backlash."""

import numpy as np
import pytest

import zerodrift as zd


def gears(**play):
    m = zd.Mechanism("gears")
    pins = [m.revolute(f"pin{i}", m.ground, m.body(f"wheel{i}", 1.0, 0.1 + 0.1 * i, at=(i, 0)).point((0, 0))) for i in range(2)]
    m.gear("mesh", *pins, ratio=-2.0, **play)
    m.start({pins[0].speed: 1.0, pins[1].speed: 0.0})
    return m


def test_flanks_meet_at_the_times_of_the_closed_form():
    """The play is passed at the relative speed 2 rad/s, times e after each impact; impulses are (1 + e) w / W."""
    sol = zd.simulate(gears(backlash=0.01, restitution=0.5), 0.1)
    W = 1 / 0.2 + 4 / 0.1
    assert sol.impacts["t"] == pytest.approx(0.005 * np.array([0.5, 2.5, 6.5, 14.5]), abs=1e-13)
    assert sol.impacts["impulse"] == pytest.approx(1.5 * 2 / W * 0.5**np.arange(4), rel=1e-12)
    assert sol.impacts["energy_lost"] == pytest.approx(0.75 / 2 * 4 / W * 0.25**np.arange(4), rel=1e-12)
    assert [name for name in sol.impacts["name"]] == ["mesh upper", "mesh lower"] * 2


def test_a_drive_presses_one_flank(tmp_path):
    m = gears(backlash=0.01)
    m.motor("drive", m["pin0"], torque=1.0)
    sol = zd.simulate(zd.load(m.save(tmp_path / "m.json")), 0.5)
    acceleration = 1 / (0.1 + 4 * 0.2)
    assert sol.phases[-1].state == {"mesh lower": "open", "mesh upper": "closed"}
    assert sol["mesh.torque"][-1] == pytest.approx(-2 * acceleration * 0.2, rel=1e-9)
    assert sol["pin1.angle"][-1] + 2 * sol["pin0.angle"][-1] == pytest.approx(0.005, abs=1e-12)


@pytest.mark.parametrize(("play", "words"), [({"backlash": -1.0}, "backlash of 'mesh'"),
                                             ({"backlash": 0.1, "restitution": 2.0}, "restitution of 'mesh' must be at most 1")])
def test_wrong_play_is_named(play, words):
    with pytest.raises(ValueError, match=words):
        gears(**play)
