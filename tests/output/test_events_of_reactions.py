"""Events that read reactions and accelerations: those of the state at which they are evaluated."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import zerodrift as zd

G, LEVEL = 9.81, 15.0
FORCE, ROOM = "pin.force.y", 1e-8       # s, rad: ten times the error of the motions below
FORMS = {"measure": zd.Event(FORCE, value=LEVEL), "expression": zd.Event(sp.Symbol(FORCE) - LEVEL),
         "callable": zd.Event(lambda t, F: F - LEVEL, of={"F": FORCE})}
STEPS = {"fixed": {"step": 0.002}, "dense": {"rtol": 1e-10, "atol": 1e-12}, "implicit": {"step": 0.002, "integrator": "radau"},
         "mixed": {"step": 0.002, "formulation": "mixed", "stabilization": zd.Projection(every=3)}}


def rod(**motor):
    """A rod of 1 kg and 1 m on a pin, at rest in the horizontal."""
    m = zd.Mechanism("pendulum", gravity=(0, -G))
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, link.start)
    if motor:
        m.motor("drive", pin, **motor)
    return m


def crossings():
    """Times and angles at which m g (5/2 sin^2 a + 1/4 cos^2 a) is the level, from energy and moments about the pin."""
    angle = -np.arcsin(np.sqrt((LEVEL / G - 0.25) / 2.25))
    angles = [angle, -np.pi - angle]
    passes = [lambda t, y, a=a: y[0] - a for a in angles]
    found = solve_ivp(lambda t, y: (y[1], -1.5 * G * np.cos(y[0])), (0, 1.0), (0.0, 0.0), rtol=1e-12, atol=1e-13, events=passes)
    return [times[0] for times in found.t_events], angles


@pytest.mark.parametrize(("form", "steps"),
                         [*(("measure", steps) for steps in STEPS), ("expression", "fixed"), ("callable", "dense")])
@pytest.mark.parametrize(("layout", "compiled"), [("joint", False), ("absolute", True)])
def test_the_force_of_a_pin_passes_a_level(form, steps, layout, compiled):
    times, angles = crossings()
    sol = zd.simulate(rod().system(layout, compiled=compiled), 1.0, **STEPS[steps], events=FORMS[form])
    assert np.allclose(sol.t_events[0], times, rtol=0, atol=ROOM)
    states = [zd.Instant(sol.system, t, p, v) for t, p, v in
              zip(sol.t_events[0], sol.p_events[0], sol.v_events[0], strict=True)]
    assert np.allclose([each["pin.angle"] for each in states], angles, rtol=0, atol=ROOM)
    assert np.allclose([each[FORCE] for each in states], LEVEL, rtol=0, atol=1e-9)


@pytest.mark.parametrize("steps", sorted(STEPS))
def test_a_terminal_event_ends_the_run_there(steps):
    times, angles = crossings()
    event = zd.Event(FORCE, value=LEVEL, direction=-1, terminal=True)
    sol = zd.simulate(rod(), 1.0, **STEPS[steps], events=event, outputs=[FORCE])
    assert sol.t[-1] == sol.t_events[0][-1] == pytest.approx(times[1], rel=0, abs=ROOM)
    assert sol["pin.angle"][-1] == pytest.approx(angles[1], rel=0, abs=ROOM)
    assert sol[FORCE][-1] == pytest.approx(LEVEL, rel=0, abs=1e-9)
    assert np.array_equal(sol.p[-1], sol.p_events[0][-1])


@pytest.mark.parametrize("steps", [{"step": 0.005}, {"rtol": 1e-10, "atol": 1e-12}], ids=["fixed", "adaptive"])
def test_a_rope_goes_slack(steps):
    """A mass with v^2 = 7/2 g L at the bottom of its circle: its force m g (3 cos a + 3/2) vanishes 120 degrees on."""
    m = zd.Mechanism("rope", gravity=(0, -G))
    m.particle("mass", 2.0, (0, -0.8))
    m.rod("rope", m.ground.point((0, 0)), m["mass"])
    event = zd.Event("rope.tension", direction=-1, terminal=True)
    sol = zd.simulate(m.system(), 2.0, (0, -0.8), (np.sqrt(3.5 * G * 0.8), 0), **steps, events=event, outputs=["rope.tension"])
    assert abs(sol["rope.tension"][-1]) < 1e-9
    assert np.allclose(sol.p[-1], (0.8 * np.sqrt(0.75), 0.4), rtol=0, atol=1e-6 if "step" in steps else 1e-8)


@pytest.mark.parametrize("steps", [{"step": 0.01}, {"rtol": 1e-6}], ids=["fixed", "adaptive"])
def test_an_acceleration_that_jumps_with_an_input_is_reported_after_the_jump(steps):
    def push(run):
        run["drive.torque"] = 5.0 * (run.t > 0.15)

    m = rod(torque=0.0)
    m.gravity = (0, 0)
    sol = zd.simulate(m, 0.5, **steps, inputs=["drive.torque"], control=zd.every(0.1, push),
                      events=zd.Event("pin.acceleration", value=7.5))
    assert sol.t_events[0] == pytest.approx([0.2], rel=1e-14)
    assert sol.t_events[0] > 0.2


@pytest.mark.parametrize("steps", ["fixed", "dense", "mixed"])
def test_the_run_is_the_same_without_the_event(steps):
    some, others = (zd.simulate(rod(), 1.0, **STEPS[steps], save_every=10, events=event) for event in (FORMS["measure"], None))
    assert np.array_equal(some.p, others.p)
    assert np.array_equal(some.v, others.v)


@pytest.mark.parametrize("form", ["measure", "callable"])
def test_a_restored_run_finds_the_same_event(form):
    event = zd.Event(FORMS[form].what, FORMS[form].value, terminal=True, of=FORMS[form].of)
    run, twin = (zd.Run(rod(), rtol=1e-8, events=event) for _ in range(2))
    run.advance_to(0.2)
    twin.restore(run.save())
    for each in (run, twin):
        each.advance_to(1.0)
    assert run.t == twin.t == pytest.approx(crossings()[0][0], rel=0, abs=1e-6)
    assert np.array_equal(run.p, twin.p)


def test_ensembles_have_the_events_of_single_runs():
    system, starts = rod().system(compiled=True), np.array([[0.0], [-0.1], [-0.2]])
    many = zd.ensemble(system, 1.0, p0=starts, step=0.01, events=FORMS["measure"])
    for times, start in zip(many.t_events, starts, strict=True):
        assert np.array_equal(times[0], zd.simulate(system, 1.0, start, step=0.01, events=FORMS["measure"]).t_events[0])


def test_what_is_not_a_scalar_is_refused():
    with pytest.raises(ValueError, match=r"must be a scalar measure, and 'pin.force' has 2 components: 'pin.force.x'"):
        zd.simulate(rod(), 1.0, step=0.01, events="pin.force")
