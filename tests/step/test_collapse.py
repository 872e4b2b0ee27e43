"""Steps that get nowhere, as at friction that is the sign of a speed, end a run early; fast but smooth motions do not."""

import re

import numpy as np
import pytest

import zerodrift as zd
from support import refused

STOP = 2.0 / 2.943      # s: speed over deceleration
METHODS = ("radau", "dop853", "dormand_prince")


def sledge(force, *, push=0.0):
    m = zd.Mechanism("sledge")
    body = m.body("body", 1.0)
    rail = m.prismatic("rail", m.ground, body, axis=(1, 0))
    m.force("friction", body, along=(1, 0), value=force, of={"v": rail.speed})
    m.force("push", body, along=(1, 0), value=push)
    m.start({rail.speed: 0.0 if push else 2.0})
    return m


def dry(v):
    return -2.943 * np.sign(v)


def called(v, seen=[]):     # noqa: B006
    seen[:] = [v]
    return -2.943 * np.sign(v)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rtol", [1e-6, 1e-9])
def test_a_law_that_jumps_back_is_reported_at_its_instant(method, rtol):
    with refused("step-collapse", "a force law jumps back immediately") as failed:
        zd.simulate(sledge(dry), 2.0, rtol=rtol, atol=1e-3 * rtol, integrator=method)
    assert failed.value.__notes__ == ["velocity 0 is 'rail.speed'; 'friction' jumps there"]
    assert abs(failed.value.solution.t[-1] - STOP) < rtol
    assert failed.value.solution.stats["steps"] < 60


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rtol", [1e-6, 1e-9])
def test_a_call_that_jumps_at_rest_is_reported_with_its_place(method, rtol):
    with refused("step-collapse", "collapsed 50 times between t = ") as failed:
        zd.simulate(sledge(called), 2.0, rtol=rtol, atol=1e-3 * rtol, integrator=method)
    low, high = map(float, re.search(r"between t = (\S+) and ([^,]+),", str(failed.value)).groups())
    assert abs(low - STOP) < 20 * rtol
    assert 0 < high - low < 20 * rtol
    assert failed.value.__notes__ == ["velocity 0 is 'rail.speed'; 'friction' jumps there"]
    partial = failed.value.solution
    assert abs(partial.t[-1] - STOP) < 20 * rtol
    assert partial.stats["steps"] < 200
    assert partial.stats["part"] == 0


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_of_two_bodies_the_one_is_named_whose_rate_jumps(layout):
    m = zd.Mechanism("arm", gravity=(0, -9.81))
    upper, lower = m.link("upper", (0, 0), (1, 0), mass=1.0), m.link("lower", (1, 0), (2, 0), mass=1.0)
    m.revolute("shoulder", m.ground, upper.start)
    elbow = m.revolute("elbow", upper.end, lower.start)
    m.spring("spring", m.ground.point((0, 1)), lower.end, stiffness=100.0, length=1.0, damping=5.0)
    m.torque("brake", lower, against=upper, value=lambda w: -20 * np.sign(w), of={"w": elbow.speed})
    with refused("step-collapse") as failed:
        zd.simulate(m.system(layout), 2.0, integrator="radau")
    assert re.fullmatch(r"velocity \d is 'lower.angular_velocity'; 'brake' jumps there", failed.value.__notes__[0])


@pytest.mark.parametrize("method", ["dop853", "dormand_prince"])
def test_a_force_that_jumps_at_the_start_is_reported_too(method):
    for law in (dry, called):
        with refused("step-collapse"):
            zd.simulate(sledge(law, push=1.0), 2.0, integrator=method)


def test_an_open_run_returns_to_its_last_step():
    run = zd.Run(sledge(dry), rtol=1e-6, integrator="radau")
    run.advance_to(0.5)
    with refused("step-collapse") as failed:
        run.advance_to(2.0)
    assert failed.value.__notes__ == ["velocity 0 is 'rail.speed'; 'friction' jumps there"]
    assert abs(run.t - STOP) < 1e-6


def test_without_a_bound_of_the_steps_the_run_goes_on():
    run = zd.Run(sledge(dry), rtol=1e-6, integrator="radau", max_steps=None)
    run.step(300)
    assert STOP < run.t < STOP + 1e-6


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rtol", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("law", [lambda v: -2.943 * np.tanh(v / 1e-5), lambda v: -1e5 * v, lambda v: -1e8 * np.tanh(v)],
                         ids=["steep", "stiff", "very stiff"])
def test_fast_smooth_motions_are_not(method, rtol, law):
    """They end, or take too many steps for an explicit method."""
    sol = zd.simulate(sledge(law), 2.0, rtol=rtol, atol=1e-3 * rtol, integrator=method, max_steps=400, on_failure="return")
    assert sol.success or "max_steps = 400 steps were taken" in sol.message


@pytest.mark.filterwarnings("ignore::zerodrift.errors.StabilityWarning")
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rtol", [1e-3, 1e-6, 1e-9])
def test_stiff_impacts_are_not(method, rtol):
    """A ball on a floor of 1e9 N/m: contacts of 1e-4 s, flights of 0.9 s."""
    m = zd.Mechanism("ball", gravity=(0, -9.81))
    ball = m.particle("ball", 1.0, at=(0, 1))
    m.force("floor", ball, along=(0, 1), value=lambda y: np.where(y < 0, -1e9 * y, 0.0), of={"y": ball.position.y})
    assert zd.simulate(m, 2.0, rtol=rtol, atol=1e-3 * rtol, integrator=method).success
