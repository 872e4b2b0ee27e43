"""Drives that push a mechanism beyond its reach: one message for all methods and steps, with the limit of its geometry."""

import numpy as np
import pytest

import zerodrift as zd

SETTINGS = [{"step": 0.01}, {}, {"integrator": "radau"}, {"on_singular": "continue"}]


def rocker():
    """Double rocker of sides 0.8, 0.3, 0.5 and 1 m, driven at 1 rad/s; coupler and rocker in line: cos = 0.625, from 0.5 rad."""
    k = np.array([0.8 * np.cos(0.5), 0.8 * np.sin(0.5)])
    d = np.array([1.0, 0.0]) - k
    D = np.hypot(*d)
    x = (0.09 - 0.25 + D * D) / (2 * D)
    pin = k + x * d / D + np.sqrt(0.09 - x * x) * np.array([-d[1], d[0]]) / D
    m = zd.Mechanism("double rocker")
    a, b, c = (m.link(*each, mass=1.0) for each in (("a", (0, 0), k), ("b", k, pin), ("c", (1, 0), pin)))
    m.revolute("A", m.ground, a.start), m.revolute("B", a.end, b.start), m.revolute("C", b.end, c.end)
    m.revolute("D", m.ground.point((1, 0)), c.start)
    return m


def driven(space):
    m = rocker()
    m.motor("drive", "A", speed=1.0)
    return m.lifted() if space else m


def boom(space):
    """A cylinder of the longest length 2 m, at 0.3 m/s from the square root of 2."""
    m = zd.Mechanism("boom", gravity=(0, -9.81))
    link = m.link("link", (0, 0), (2, 0), mass=100.0)
    m.revolute("foot", m.ground, link.start)
    m.actuator("cylinder", m.ground.point((0, -1)), link.point((1.0, 0)), length=lambda t: 2**0.5 + 0.3 * t)
    return m.lifted() if space else m


CASES = [(driven, np.arccos(0.625) - 0.5, "A.angle", np.arccos(0.625) - 0.5, "'drive'"),
         (boom, (2 - 2**0.5) / 0.3, "cylinder.length", 2.0, "'cylinder'")]


@pytest.mark.parametrize(("build", "t", "measure", "limit", "drive"), CASES, ids=["rocker", "boom"])
@pytest.mark.parametrize("space", [False, True], ids=["plane", "space"])
@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("settings", SETTINGS, ids=["fixed", "adaptive", "radau", "continue"])
def test_a_run_beyond_the_reach_of_a_drive_names_it_and_its_limit(build, t, measure, limit, drive, space, layout, settings):
    with pytest.raises(zd.CorrectionFailed) as caught:
        zd.simulate(build(space).system(layout), 3.0, **settings)
    said = str(caught.value)
    assert said.startswith(f"{drive} must not drive")
    assert f"dead point, {measure} = {limit:.6f}"[:-1].rstrip("0").rstrip(".") in said
    assert f"at t = {t:.6f}"[:-1] in said
    assert not any(word in said for word in ("on_singular", "tol"))
    assert caught.value.solution.t[-1] <= t + 0.01


def test_an_open_run_says_the_same():
    run = zd.Run(driven(False), step=0.01)
    with pytest.raises(zd.CorrectionFailed, match=r"'drive' must not drive .* dead point, A.angle = 0\.39566"):
        run.step(100)


@pytest.mark.parametrize("settings", [{"step": 0.01}, {}], ids=["fixed", "adaptive"])
@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_open_runs_that_are_advanced_together_say_the_same(layout, settings):
    runs = zd.ManyRuns(driven(False).system(layout), runs=2, **settings)
    runs.advance_to(0.3)
    assert runs.messages == ["", ""]
    runs.advance_to(1.0)
    assert runs.failed.all()
    assert all(said.startswith("'drive' must not drive") and "dead point, A.angle = 0.395664" in said for said in runs.messages)


def test_the_limit_is_that_of_kinematics():
    with pytest.warns(zd.LockedWarning, match=r"dead point, A.angle = 0\.39566"):
        zd.kinematics(rocker(), {"A.angle": np.linspace(0, 0.5, 11)})


@pytest.mark.parametrize("space", [False, True], ids=["plane", "space"])
def test_samples_that_come_back_into_reach_are_found(space):
    """There and back: where it is within reach, the rocker has the angle that it had on the way there."""
    m, limit = rocker(), np.arccos(0.625) - 0.5
    there = np.linspace(0.0, limit + 0.03, 9)
    angle = np.concatenate([there, there[::-1]])
    with pytest.warns(zd.LockedWarning, match=f"{2 * (there > limit).sum()} samples beyond it are NaN"):
        kin = zd.kinematics(m.lifted() if space else m, {"A.angle": angle}, 0.1 * np.arange(len(angle)))
    found = kin["D.angle"]
    assert (np.isfinite(found) == (angle < limit)).all()
    assert found[9:][::-1][there < limit] == pytest.approx(found[:9][there < limit], abs=1e-10)


def test_no_drive_is_named_within_its_reach():
    """A force that ends a run near no dead point."""
    m = driven(False)
    m.torque("load", "c", value=lambda t: 1 / 0 if t > 0.1 else 0.0)
    with pytest.raises(ZeroDivisionError):
        zd.simulate(m, 0.3, step=0.01)


def test_only_the_drive_that_ends_is_named():
    """Another one turns a wheel, and a lock of constant length holds a third body; none of them matters."""
    m = driven(False)
    wheel, post = m.link("wheel", (3, 0), (3.2, 0), mass=1.0), m.link("post", (5, 0), (5, 1), mass=1.0)
    m.revolute("axle", m.ground.point((3, 0)), wheel.start), m.revolute("foot", m.ground.point((5, 0)), post.start)
    m.motor("spin", "axle", speed=7.0)
    m.actuator("lock", m.ground.point((6, 0)), post.end, length=2**0.5)
    with pytest.raises(zd.CorrectionFailed, match=r"^'drive' must not drive .* dead point, A.angle = 0\.395664794, where"):
        zd.simulate(m, 1.0, step=0.01)


def test_two_drives_that_contradict_each_other_are_both_named():
    """A hinge and a cylinder over it move together until t = 0.1."""
    m = zd.Mechanism("twice driven")
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    m.revolute("A", m.ground, link.start)
    m.motor("hinge", "A", angle=lambda t: 0.1 * t)
    m.actuator("cylinder", m.ground.point((0, -1)), link.end,
               length=lambda t: np.sqrt(2 + 2 * np.sin(0.1 * t)) + 10 * max(t - 0.1, 0.0)**2)
    with pytest.raises(zd.CorrectionFailed, match=r"^'hinge' and 'cylinder' must .*, A.angle = 0\.0100.*, cyl\w*.length = 1.4"):
        zd.simulate(m, 0.3, step=0.01)


def test_a_drive_that_jumps_comes_to_no_dead_point():
    m = rocker()
    m.motor("drive", "A", angle=lambda t: 0.1 * t + (2.5 if t > 0.1 else 0.0))
    with pytest.raises(zd.ZerodriftError) as caught:
        zd.simulate(m, 0.3, step=0.01)
    assert "dead point" not in str(caught.value)
