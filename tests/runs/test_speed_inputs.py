"""Speeds as inputs: jumps by an impulse, ramps in adaptive steps, and starts that do not fit."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import zerodrift as zd
from few_bodies import driven_four_bar
from runs.test_inputs import LAYOUTS, wheel
from support import refused

G, CART, ROD, HALF = 9.81, 3.0, 2.0, 0.5       # m/s^2, kg, kg, m: rod on a cart, its center from the pin
INERTIA = ROD * HALF**2 * 4 / 3                 # kg m^2, about the pin
GIVEN = {"inputs": ["drive.speed"]}


def cart(speed):
    """A rod on a cart whose speed is prescribed, at rest against it in the horizontal."""
    m = zd.Mechanism("cart", gravity=(0, -G))
    box = m.body("cart", CART, 1.0)
    rod = m.link("rod", (0, 0), (1, 0), mass=ROD)
    rail = m.prismatic("rail", m.ground, box, axis=(1, 0))
    m.revolute("pin", box.point((0, 0)), rod.start)
    m.motor("drive", rail, speed=speed)
    return m


@pytest.mark.parametrize(("layout", "compiled"), LAYOUTS)
def test_a_flywheel_jumps(layout, compiled):
    """Impulse I dw, work I (w dw + dw^2 / 2)."""
    system = wheel(speed=2.0).system(layout, compiled=compiled)
    run = zd.Run(system, step=0.01, **GIVEN, hold=True, record=True, save_every=2)
    run.step(10)
    assert run.jump is None
    run["drive.speed"] = 5.0
    run.step(10)
    jump, sol = run.jump, run.solution()
    assert jump.t == pytest.approx(0.1)
    assert jump.impulses["drive"] == pytest.approx(0.25 * 3.0, rel=1e-13)
    assert jump.work == pytest.approx(0.25 * (2.0 * 3.0 + 4.5), rel=1e-13)
    assert jump.works == {"drive": pytest.approx(jump.work, rel=1e-13)}
    assert sol["hinge.speed"][5] == pytest.approx(2.0, rel=1e-13)
    assert sol["hinge.speed"][6] == pytest.approx(5.0, rel=1e-13)
    assert np.flatnonzero(sol["drive.impulse"]).tolist() == np.flatnonzero(sol["drive.impulse_work"]).tolist() == [6]
    assert sol.energy_input[-1] == sol["drive.impulse_work"][6] == jump.work
    assert abs(sol.energy_violation).max() < 1e-13


@pytest.mark.parametrize("form", sorted(zd.formulations()))
@pytest.mark.parametrize("steps", [{"step": 0.002}, {"rtol": 1e-8}, {"step": 0.002, "integrator": "radau"}],
                         ids=["fixed", "adaptive", "implicit"])
def test_the_rod_on_a_cart_that_jumps_keeps_its_moment_of_momentum_about_the_pin(form, steps):
    run = zd.Run(cart(0.5), formulation=form, **steps, **GIVEN, hold=True, record=True)
    run.advance_to(0.2)
    before, angle = run["pin.speed"], run["rod.angle"]
    run["drive.speed"] = -1.0
    run.step()
    turn = ROD * HALF * np.sin(angle) * -1.5 / INERTIA
    jump = run.jump
    assert jump.impulses["drive"] == pytest.approx((CART + ROD) * -1.5 - ROD * HALF * np.sin(angle) * turn, rel=1e-9)
    assert jump.work == jump.works["drive"] == pytest.approx(jump.impulses["drive"] * -0.25, rel=1e-9)
    run.advance_to(0.3)
    after = solve_ivp(lambda t, y: (y[1], -ROD * HALF * G / INERTIA * np.cos(y[0])), (0.2, 0.3), (angle, before + turn),
                      rtol=1e-11, atol=1e-11).y[:, -1]
    assert np.allclose((run["rod.angle"], run["pin.speed"]), after, rtol=0, atol=1e-6)
    assert run["cart.position.x"] == pytest.approx(0.5 * 0.2 - 0.1, abs=1e-9)
    sol = run.solution()
    assert abs(sol.energy_violation).max() < 1e-6 * sol.kinetic_energy.max()


def test_speeds_of_a_four_bar_jump_in_proportion():
    """Its velocities are proportional to that of the crank, so that the work is three times the kinetic energy before."""
    values = iter([1.0, 2.0, 2.0])
    system = driven_four_bar(speed=1.0).system()

    def set_next(run):
        run["drive.speed"] = next(values)

    sol = zd.simulate(system, 0.3, step=0.01, **GIVEN, hold=True, control=zd.every(0.1, set_next))
    assert np.flatnonzero(sol["drive.impulse_work"]).tolist() == [11]
    assert sol["drive.impulse_work"][11] == pytest.approx(3 * sol.kinetic_energy[10], rel=1e-12)
    assert np.allclose(sol["crank.angular_velocity"], 1.0 + (sol.t > 0.1001), rtol=1e-9)
    assert abs(sol.energy_violation).max() < 1e-6 * sol.kinetic_energy.max()
    again = zd.simulate(system, 0.05, **{name: value for name, value in sol.settings.items()})
    assert np.array_equal(again.p[-1], sol.p[5])


def follow(rtol, **options):
    """The rod's angle and speed at 1 s under a speed of the cart that is set at 0.2 s, and again while it is followed."""
    run = zd.Run(cart(0.0), rtol=rtol, atol=rtol, **GIVEN, ramp=0.3, **options)
    for t, speed in ((0.2, 2.0), (0.35, -1.0)):
        run.advance_to(t)
        run["drive.speed"] = speed
    run.advance_to(1.0)
    return run


@pytest.mark.parametrize("rtol", [1e-5, 1e-9])
@pytest.mark.parametrize("options", [{}, {"formulation": "independent"}, {"integrator": "radau"}], ids=str)
def test_a_ramp_of_adaptive_steps_keeps_the_tolerance(rtol, options):
    pieces = [(0.0, 0.2, 0.0), (0.2, 0.35, 2 / 0.3), (0.35, 0.65, -2 / 0.3), (0.65, 1.0, 0.0)]    # s, s, m/s^2
    y = 0.0, 0.0
    for begin, end, a in pieces:
        y = solve_ivp(lambda t, y, a=a: (y[1], ROD * HALF / INERTIA * (a * np.sin(y[0]) - G * np.cos(y[0]))), (begin, end), y,
                      rtol=1e-12, atol=1e-12).y[:, -1]
    run = follow(rtol, **options)
    assert np.allclose((run["rod.angle"], run["pin.speed"]), y, rtol=0, atol=100 * rtol)    # errors of steps, grown over 1 s
    assert run["cart.position.x"] == pytest.approx(0.5 * 1.0 * 0.15 - 0.35, abs=100 * rtol)
    assert run["rail.speed"] == pytest.approx(-1.0, abs=1e-9)


def test_a_step_ends_with_the_ramp_and_an_event_within_it_ends_the_run():
    def begin(run):
        run["drive.speed"] = 3.0

    given = {**GIVEN, "ramp": 0.125, "rtol": 1e-8, "control": zd.every(0.5, begin)}
    sol = zd.simulate(wheel(speed=1.0), 0.4, **given)
    assert 0.125 in sol.t
    angle = 1.0 * 0.125 + 0.5 * 16.0 * 0.125**2 + 3.0 * 0.275
    assert sol["hinge.angle"][-1] == pytest.approx(angle, rel=1e-9)
    sol = zd.simulate(wheel(speed=1.0), 0.4, **given, events=zd.Event("hinge.speed", value=2.0, terminal=True))
    assert sol.t[-1] == pytest.approx(0.0625, rel=1e-9)
    times = np.array([0.0625, 0.125, 0.2])
    sol = zd.simulate(wheel(speed=1.0), 0.4, **given, t_eval=times)
    assert np.allclose(sol["hinge.speed"], [2.0, 3.0, 3.0], rtol=1e-9)


@pytest.mark.parametrize("settings", [{"step": 0.002, "hold": True}, {"rtol": 1e-6, "hold": True}, {"rtol": 1e-6, "ramp": 0.3}],
                         ids=["jump", "adaptive jump", "ramp"])
def test_a_restored_run_goes_on_with_the_same_bits(settings):
    run, twin = (zd.Run(cart(0.5), **GIVEN, **settings) for _ in range(2))
    run.step(3)
    run["drive.speed"] = 1.0
    run.step(2)
    twin.restore(run.save())
    for each in (run, twin):
        each.step(2)
        each["drive.speed"] = -1.0
        each.step(30)
    assert np.array_equal(twin.p, run.p)
    assert np.array_equal(twin.v, run.v)
    assert twin.save() == run.save()
    assert (run.jump is None) == ("ramp" in settings)
    if "ramp" in settings:
        with pytest.raises(zd.ZerodriftError, match="of a run with the same settings"):
            zd.Run(cart(0.5), **GIVEN, **settings | {"ramp": 0.2}).restore(run.save())
    assert twin.jump == run.jump


@pytest.mark.parametrize("settings", [{"step": 0.002}, {"step": 0.002, "hold": True}, {"rtol": 1e-6, "ramp": 0.3}],
                         ids=["one step", "jump", "ramp"])
def test_a_failed_step_follows_the_speed_when_it_is_made_again(settings):
    def run(fails):
        def event(t, p, v):
            if fails:
                fails.pop()
                raise RuntimeError("no signal")
            return 1.0

        return zd.Run(cart(0.5), **GIVEN, **settings, events=event)

    failures = []
    failed, plain = run(failures), run([])
    for each in (failed, plain):
        each.step(3)
        each["drive.speed"] = 1.0
    failures.append(True)
    with pytest.raises(RuntimeError, match="no signal"):
        failed.step()
    assert failed.jump is None
    for each in (failed, plain):
        each.step(5)
    assert np.array_equal(failed.p, plain.p)
    assert np.array_equal(failed.v, plain.v)
    assert failed.jump == plain.jump


@pytest.mark.parametrize(("layout", "compiled"), LAYOUTS)
def test_a_start_that_does_not_fit_a_speed(layout, compiled):
    system = wheel(speed=2.0).system(layout, compiled=compiled)
    fitting = wheel(speed=3.0).system(layout, compiled=compiled)
    state = fitting.p0, fitting.v0
    with refused("inconsistent-start", r"input 0 must begin with 3, which fits.*not with 2; it is 'drive\.speed', and hold"):
        zd.Run(system, *state, step=0.01, **GIVEN)
    run = zd.Run(system, *state, step=0.01, **GIVEN, hold=True, record=True)
    run.step(2)
    assert run.jump.t == 0
    assert run.jump.impulses["drive"] == pytest.approx(-0.25, rel=1e-12)
    assert run["hinge.speed"] == pytest.approx(2.0, rel=1e-12)
    assert abs(run.solution().energy_violation).max() < 1e-13


def test_another_violation_of_the_start_is_reported():
    system = driven_four_bar(speed=2.0).system()
    p, v = system.p0.copy(), system.v0.copy()
    v[2] += 0.1
    with refused("inconsistent-start", "most in row . 'C"):
        zd.Run(system, p, v, step=0.01, **GIVEN, hold=True)


def test_forces_that_change_make_no_jump():
    m = wheel(speed=2.0)
    m.torque("brake", m["body"], axis=(0, 0, 1), value=0.0)
    run = zd.Run(m, step=0.01, inputs=["drive.speed", "brake.torque"], hold=True)
    run["brake.torque"] = -1.0
    run.step(2)
    assert run.jump is None
    assert run["drive.torque"] == pytest.approx(1.0, rel=1e-9)


def test_many_runs_jump_each_by_itself():
    runs = zd.ManyRuns(wheel(speed=1.0), runs=3, step=0.01, **GIVEN, hold=True)
    runs["drive.speed"] = [1.0, 2.0, 3.0]
    runs.step()
    assert np.allclose(runs["hinge.angle"], [0.01, 0.02, 0.03], rtol=1e-12)


def test_wrong_arguments_say_what_is_allowed():
    with refused("step-size", r"'drive\.speed' must be followed over a given time.*ramp=.*hold=True"):
        zd.Run(wheel(speed=1.0), **GIVEN)
    for wrong in ({"step": 0.01, "ramp": 0.1}, {"hold": True, "ramp": 0.1}):
        with refused("conflicting-arguments", "ramp must be left out"):
            zd.Run(wheel(speed=1.0), **GIVEN, **wrong)
    with refused("conflicting-arguments", "no input is a speed"):
        zd.simulate(wheel(torque=1.0), 1.0, step=0.1, inputs=["drive.torque"], hold=True)
