"""Events that act: inputs that they set and states that they change, against closed forms, with any steps."""

import dataclasses

import numpy as np
import pytest

import zerodrift as zd
from support import assert_close, refused, relay

G = 9.81
STEPS = {"adaptive": {}, "fixed": {"step": 0.01}, "not dividing": {"step": 0.07, "integrator": "dormand_prince"},
         "radau": {"integrator": "radau"}, "matrices": {"closed_form": False}, "samples": {"t_eval": np.linspace(0, 3, 31)}}


def ball_and_floor(restitution=0.5, **event):
    m = zd.Mechanism("ball", gravity=(0, -G))
    ball = m.body("ball", at=(0, 1), mass=1.0, inertia=0.1)

    def bounce(run):
        run.set_state(v=run.v * [1, -restitution, 1])

    return m, zd.Event(ball.position.y, direction=-1, then=bounce, **event)


def bounces(until, restitution=0.5):
    t, speed, found = np.sqrt(2 / G), np.sqrt(2 * G), []
    while t < until and len(found) < 8:
        found.append(t)
        speed *= restitution
        t += 2 * speed / G
    return np.array(found)


def height(t, restitution=0.5):
    """Height of the ball at times of which none is a bounce."""
    at = bounces(10.0)
    number = np.searchsorted(at, t)
    since = np.where(number == 0, t, t - at[number - 1])
    speed = np.where(number == 0, 0.0, np.sqrt(2 * G) * restitution**number)
    return (number == 0) + speed * since - G / 2 * since**2


@pytest.mark.parametrize("steps", STEPS)
def test_a_ball_bounces(steps):
    m, floor = ball_and_floor()
    sol = zd.simulate(m, 1.2, events=floor, **STEPS[steps] | ({"t_eval": np.linspace(0, 1.2, 13)} if steps == "samples" else {}))
    assert_close(sol.t_events[0], bounces(1.2), 1e-13, scale=1.0)
    assert np.abs(sol.energy_violation).max() < 1e-11
    t = np.array([0.1, 0.4, 0.5, 0.8, 1.0, 1.1])
    if steps == "samples":
        assert_close(sol.p[1:, 1], height(sol.t[1:]), 1e-12, scale=1.0)
    else:
        assert_close(sol(t)[0][:, 1], height(t), 1e-12, scale=1.0)
        twice = np.flatnonzero(np.diff(sol.t) == 0)       # the states before and after
        assert_close(sol.t[twice], bounces(1.2), 1e-13, scale=1.0)
        assert_close(sol.v[twice + 1, 1], -0.5 * sol.v[twice, 1], 1e-12, scale=1.0)


def test_fixed_steps_return_to_their_grid():
    m, floor = ball_and_floor()
    sol = zd.simulate(m, 1.2, events=floor, step=0.1)
    grid = [t for t in sol.t if np.abs(bounces(1.2) - t).min() > 1e-9]
    assert_close(grid, 0.1 * np.arange(13), 1e-15, scale=1.0)


def test_bounces_without_end_are_an_error():
    """The time between bounces goes to zero; a ball that stays on the floor needs a contact."""
    m, floor = ball_and_floor()
    with refused("event-chatter", "again and again"):
        zd.simulate(m, 2.0, events=floor)


def arm(torque=2.0):
    m = zd.Mechanism("arm")
    link = m.link("arm", (0, 0), (1, 0), mass=3.0)
    m.motor("drive", m.revolute("pin", m.ground, link.start), torque=torque)
    return m


@pytest.mark.parametrize("steps", STEPS)
def test_a_motor_is_switched_off_at_an_angle(steps):
    off = zd.Event("pin.angle", value=1.0, direction=1, then={"drive.torque": 0.0})
    sol = zd.simulate(arm(), 3.0, events=off, **STEPS[steps])
    assert_close(sol.t_events[0], [1.0], 1e-14, scale=1.0)
    assert_close(sol["pin.speed"], 2 * np.minimum(sol.t, 1), 1e-12, scale=1.0)
    assert_close([sol["drive.torque"][1], sol["drive.torque"][-1]], [2.0, 0.0], 1e-15, scale=1.0)
    assert np.abs(sol.energy_violation).max() < 1e-11
    if steps != "samples":
        assert_close(sol([0.5, 2.0])[0][:, 0], [0.25, 3.0], 1e-12, scale=1.0)


@pytest.mark.parametrize("steps", ["adaptive", "fixed"])
def test_a_relay_switches_between_two_speeds(steps):
    low = zd.Event("pin.speed", value=-0.5, direction=-1, then={"drive.torque": 2.0})
    high = zd.Event("pin.speed", value=0.5, direction=1, then=lambda run: run.__setitem__("drive.torque", -2.0))
    sol = zd.simulate(arm(), 10.0, events=[low, high], **STEPS[steps])
    assert_close(sol.t_events[1], 0.25 + np.arange(10), 1e-11, scale=1.0)
    assert_close(sol.t_events[0], 0.75 + np.arange(10), 1e-11, scale=1.0)
    third = zd.Event("pin.speed", value=0.5, direction=1, then={"drive.torque": -2.0}, terminal=3)
    assert_close(zd.simulate(arm(), 10.0, events=[low, third], **STEPS[steps]).t[-1], 2.25, 1e-11, scale=1.0)


def test_an_event_that_turns_its_function_back_occurs_once():
    """The torque is reversed where the speed reaches 0.5: it falls at once, and passes 0.5 no second time."""
    turn = zd.Event("pin.speed", value=0.5, then={"drive.torque": -2.0})
    sol = zd.simulate(arm(), 1.0, events=turn)
    assert_close(sol.t_events[0], [0.25], 1e-12, scale=1.0)


def test_open_runs_act_and_are_restored():
    m, floor = ball_and_floor()
    run = zd.Run(m, events=floor)
    for t in (0.3, 0.6, 1.0):
        run.advance_to(t)
        assert_close([run.t, run.p[1]], [t, height(t)], 1e-12, scale=1.0)
        again = zd.Run(m, events=floor)
        again.restore(run.save())
        again.advance_to(1.1)
        assert_close(again.p[1], height(1.1), 1e-12, scale=1.0)
    run = zd.Run(m, events=floor, step=0.01, record=True)
    run.step(60)
    assert run.steps == 60
    assert run.solution().t_events[0].size == 1


@pytest.mark.parametrize("steps", ["adaptive", "fixed", "matrices"])
def test_data_acts_as_runs_that_are_glued_by_hand(steps):
    """A relay: each event ends a run of a mechanism with another torque, from where the one before ended."""
    given, (m, events) = STEPS[steps] | ({} if steps == "fixed" else {"rtol": 1e-11, "atol": 1e-11}), relay()
    sol = zd.simulate(m, 5.0, events=events, **given)
    t, p, v, torque, found = 0.0, np.zeros(1), np.zeros(1), 2.0, []
    while t < 5.0:
        last = [dataclasses.replace(each, then=None, terminal=True) for each in events]
        part = zd.simulate(relay(torque)[0].system("joint"), (t, 5.0), p, v, events=last, **given)
        t, p, v = part.t[-1], part.p[-1], part.v[-1]
        which = np.argmax([len(times) for times in part.t_events])
        torque = events[which].then["drive.torque"]
        found.append((t, f"events[{which}]"))
    tolerance = 1e-6 if steps == "fixed" else 1e-9      # steps begin at the event there, and at the grid here
    assert len(found) == 5
    assert_close(sol.jumps["t"], [t for t, _ in found[:-1]], tolerance, scale=1.0)
    assert sol.jumps["name"].tolist() == [name for _, name in found[:-1]]
    assert_close([*sol.p[-1], *sol.v[-1]], [*p, *v], 10 * tolerance, scale=1.0)


@pytest.mark.parametrize("steps", ["adaptive", "fixed"])
def test_ensembles_act_as_single_runs(steps):
    m, events = relay()
    v0, given = np.linspace(0, 1, 3)[:, None], {"events": events, "t_eval": np.linspace(0, 5, 11), **STEPS[steps]}
    many = zd.ensemble(m, 5.0, p0=np.zeros((3, 1)), v0=v0, outputs=["pin.angle", "drive.torque"], **given)
    for i, start in enumerate(v0):
        one = zd.simulate(m.system("joint"), 5.0, np.zeros(1), start, **given)
        np.testing.assert_array_equal([many["pin.angle"][i], many["drive.torque"][i]], [one["pin.angle"], one["drive.torque"]])
        np.testing.assert_array_equal(np.concatenate(many.t_events[i]), np.concatenate(one.t_events))
    assert many[1].jumps.size == 4


def test_jumps_are_in_the_balance_and_saved(tmp_path):
    m, floor = ball_and_floor()
    sol = zd.simulate(m, 1.2, events=floor)
    assert_close(sol.jumps["t"], bounces(1.2), 1e-13, scale=1.0)
    assert_close(sol.jumps["energy"], -0.75 * G * 0.25**np.arange(3), 1e-12, scale=1.0)
    assert_close(np.diff(sol.kinetic_energy + sol.potential_energy).sum(), sol.jumps["energy"].sum(), 1e-12, scale=1.0)
    sol.save(tmp_path / "ball.npz")
    np.testing.assert_array_equal(zd.load(tmp_path / "ball.npz").jumps, sol.jumps)
    m = zd.Mechanism("cart")
    m.prismatic("rail", m.ground, m.body("cart", at=(0, 0), mass=2.0, inertia=1.0), axis=(1, 0))
    m.motor("drive", "rail", speed=lambda t: 1.0 if t < 1 else 3.0)
    sol = zd.simulate(m, 2.0)
    assert sol.jumps["name"].tolist() == ["break"]
    assert_close([*sol.jumps["t"], *sol.jumps["energy"]], [1.0, 8.0], 1e-12, scale=1.0)


def test_several_events_act_in_order():
    seen = []
    events = [zd.Event("pin.angle", value=1.0, then=lambda run, i=i: seen.append((i, run.t))) for i in range(3)]
    zd.simulate(arm(), 2.0, events=events)
    assert [i for i, _ in seen] == [0, 1, 2]


@pytest.mark.parametrize("steps", ["adaptive", "fixed"])
def test_several_events_act_within_one_step_and_at_one_instant_in_order(steps):
    """A drive that is switched on and off again within a step of 0.01 s; two that set it at one instant: the last one counts."""
    m = zd.Mechanism("cart")
    slide = m.prismatic("slide", m.ground, m.body("cart", 1.0, 1.0), axis=(1, 0))
    m.motor("push", slide, force=0.0)
    m.start({slide.speed: 1.0})
    events = [zd.Event("slide.displacement", value=at, then={"push.force": force})
              for at, force in ((0.1236, 3.0), (0.1236, 0.0), (0.1234, 1.0), (0.2, 2.0), (0.2, -2.0))]
    given = {"step": 0.01} if steps == "fixed" else {"rtol": 1e-11, "atol": 1e-13}
    sol = zd.simulate(m, 0.3, events=[*events, zd.Event("slide.displacement", value=0.1235)], **given)
    speed = np.sqrt(1 + 2 * 0.0002)
    off = 0.1234 + speed - 1
    assert sol.jumps["name"].tolist() == [f"events[{i}]" for i in (2, 0, 1, 3, 4)]
    assert_close([float(t[0]) for t in sol.t_events[:3]], [off, off, 0.1234], 1e-12, scale=1.0)
    assert_close(sol.t_events[5], [0.1234 + np.sqrt(1.0002) - 1], 1e-12, scale=1.0)
    assert_close(sol["slide.speed"][-1], speed - 2 * (0.3 - off - (0.2 - 0.1236) / speed), 1e-11, scale=1.0)
    runs = zd.ensemble(m, 0.3, v0=[[1.0], [1.0]], events=events, **given)
    assert (runs[1].v[-1] == zd.simulate(m, 0.3, events=events, **given).v[-1]).all()


def test_states_that_break_constraints_are_refused():
    run = zd.Run(zd.systems.four_bar(), step=0.01)
    run.step(10)
    p, v = run.p, run.v
    with refused("inconsistent-start"):
        run.set_state(v=v + np.array([1.0, 0, 0]))
    assert_close([*run.p, *run.v], [*p, *v], 1e-15, scale=1.0)
    run.set_state(v=-v)
    run.step(10)
    assert_close(run.p, zd.systems.four_bar().p0, 1e-7, scale=1.0)     # back where it began, to the error of the method


@pytest.mark.parametrize("steps", ["adaptive", "fixed", "radau"])
def test_a_sample_at_the_instant_is_the_one_before(steps):
    m = zd.Mechanism("body")
    body = m.particle("body", 1.0, at=(0, 0))
    m.start({body.velocity.x: 1.0})
    turn = zd.Event(lambda t: t - 1.0, then=lambda run: run.set_state(v=-run.v))
    sol = zd.simulate(m, 2.0, events=turn, t_eval=[0.5, 1.0, 1.5], **STEPS[steps])
    assert_close(sol.v[:, 0], [1.0, 1.0, -1.0], 1e-15, scale=1.0)


def test_refusals():
    with refused("in-use"):
        zd.simulate(arm(), 2.0, events=zd.Event("pin.angle", value=1.0, then=lambda run: run.step()))
    with refused("not-available", "events.then must be a dict of inputs"):
        zd.ensemble(arm(), 1.0, v0=[[0.0], [1.0]], events=zd.Event("pin.angle", value=1.0, then=lambda run: None))
    with refused("wrong-type", "then of events"):
        zd.simulate(arm(), 2.0, events=zd.Event("pin.angle", then=3))
    with pytest.raises(ZeroDivisionError) as found:
        zd.simulate(arm(), 2.0, events=zd.Event("pin.angle", value=1.0, then=lambda run: 1 / 0))
    assert "in then of events, called at t = 1" in found.value.__notes__
