"""Gears with backlash, one-way clutches, limits of speeds."""

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
    assert list(sol.impacts["name"]) == ["mesh upper", "mesh lower"] * 2


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


def test_a_one_way_clutch_drives_and_is_overrun():
    """The inner wheel drives both by cos t until its torque changes its sign; the outer one then keeps its speed."""
    m = zd.Mechanism("clutch")
    inner, outer = (m.body(name, 1.0, J) for name, J in (("inner", 0.1), ("outer", 0.2)))
    axle = m.revolute("axle", m.ground, inner.point((0, 0)))
    bearing = m.revolute("bearing", inner, outer.point((0, 0)))
    m.stop("clutch", bearing.speed, lower=0.0)
    m.motor("drive", axle, torque=lambda t: np.cos(t))
    sol = zd.simulate(m, 6.0, rtol=1e-10, atol=1e-12)
    assert [phase.state["clutch"] for phase in sol.phases] == ["closed", "open"]
    assert sol.phases[1].t0 == pytest.approx(np.pi / 2, abs=1e-9)
    assert sol["outer.angular_velocity"][-1] == pytest.approx(1 / 0.3, abs=1e-8)
    assert sol["inner.angular_velocity"][-1] == pytest.approx(1 / 0.3 + (np.sin(6) - 1) / 0.1, abs=1e-8)
    assert sol["clutch.torque"][0] == pytest.approx(2 / 3, abs=1e-9)
    assert len(sol.impacts) == 0


@pytest.mark.parametrize("how", [{"rtol": 1e-10, "atol": 1e-12}, {"step": 0.01}], ids=["adaptive", "fixed"])
def test_a_speed_has_a_limit(how):
    """A block under the force 2 N reaches 1 m/s after 1 s; the governor then takes the force."""
    m = zd.Mechanism("governed")
    slide = m.prismatic("slide", m.ground, m.body("block", 2.0, 0.1), axis=(1, 0))
    m.motor("push", slide, force=2.0)
    m.stop("governor", slide.speed, upper=1.0)
    sol = zd.simulate(m, 2.0, **how)
    assert sol.phases[1].t0 == pytest.approx(1.0, abs=1e-12)
    assert sol["slide.speed"][-1] == pytest.approx(1.0, abs=1e-13)
    assert sol["slide.displacement"][-1] == pytest.approx(1.5, abs=1e-10)
    assert sol["governor.force"][-1] == pytest.approx(-2.0, abs=1e-12)
