"""User functions and events that read reactions of the last accepted state, by name."""

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd

X, SPEED = sp.Symbol("pin.force.x"), sp.Symbol("pin.speed")
LAW = -0.1 * X - 0.02 * SPEED * abs(X)
FORMS = {"expression": {"torque": LAW},
         "callable": {"torque": lambda N, w: -0.1 * N - 0.02 * w * abs(N), "of": {"N": "pin.force.x", "w": "pin.speed"}}}
EXTRA = [("joint", False, "expression"), ("absolute", True, "expression"), ("joint", True, "expression"),
         ("joint", False, "callable"), ("absolute", False, "callable")]


def arm(**drive):
    """A pendulum with a motor at its pin."""
    m = zd.Mechanism("arm", gravity=(0, -9.81))
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, link.start)
    m.motor("drive", pin, **drive)
    return m


@zd.every(0.01)
def reaction_as_torque(run):
    run["drive.torque"] = -0.1 * run["pin.force.x"]


@pytest.mark.parametrize(("layout", "compiled"), [("joint", False), ("absolute", False), ("joint", True), ("absolute", True)])
@pytest.mark.parametrize("method", ["rk4", "radau"])
def test_a_law_of_a_reaction_has_the_bits_of_a_controller_that_reads_it_before_each_step(layout, compiled, method):
    settings = {"step": 0.01, "integrator": method, "outputs": ["pin.force.x", "drive.torque"]}
    sol = zd.simulate(arm(torque=-0.1 * X).system(layout, compiled=compiled), 1.0, **settings)
    control = zd.simulate(arm(torque=0.0).system(layout, compiled=compiled), 1.0, **settings, inputs=["drive.torque"],
                          control=reaction_as_torque)
    assert np.array_equal(sol.p, control.p)
    assert np.array_equal(sol.v, control.v)
    assert np.array_equal(sol["drive.torque"], control["drive.torque"])
    assert np.ptp(sol["drive.torque"]) > 0.1
    assert np.allclose(sol["drive.torque"][2:], -0.1 * sol["pin.force.x"][1:-1], rtol=0, atol=1e-12)   # held during the step


@pytest.mark.parametrize(("layout", "compiled", "form"), EXTRA)
def test_a_held_reaction_tends_to_the_reaction_itself(layout, compiled, form):
    """The torque -0.1 N(t), with N from the closed form of a pendulum under this torque: first order in the step."""
    errors = []
    for step in (0.01, 0.005):
        run = zd.Run(arm(**FORMS[form]).system(layout, compiled=compiled), step=step)
        run.advance_to(0.5)
        errors.append(abs(run["pin.angle"] - pendulum()))
    assert errors[1] < 0.6 * errors[0] < 0.01


def pendulum():
    """Angle at 0.5 s: the pin's force along x is -m (c v^2 cos a + c vdot sin a), linear in vdot, and solved for it."""
    from scipy.integrate import solve_ivp

    def rate(t, y):
        a, w = y

        def residual(vdot):
            N = -0.5 * (w * w * np.cos(a) + vdot * np.sin(a))
            return vdot / 3 - (-0.5 * 9.81 * np.cos(a) - 0.1 * N - 0.02 * w * abs(N))

        low, high = -200.0, 200.0
        for _ in range(80):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if residual(middle) < 0 else (low, middle)
        return w, low

    return solve_ivp(rate, (0, 0.5), (0.0, 0.0), rtol=1e-10, atol=1e-12).y[0, -1]


@pytest.mark.parametrize("form", sorted(FORMS))
@pytest.mark.parametrize("steps", [{"step": 0.01}, {"rtol": 1e-6}])
def test_a_restored_run_goes_on_with_the_same_bits(form, steps):
    run = zd.Run(arm(**FORMS[form]), **steps)
    run.step(20)
    state = run.save()
    run.step(30)
    twin = zd.Run(arm(**FORMS[form]), **steps)
    twin.restore(state)
    twin.step(10)
    twin.step(20)
    assert np.array_equal(twin.p, run.p)
    assert np.array_equal(twin.v, run.v)


def test_a_failed_step_does_not_read_reactions_again():
    """A step that is made again has the reaction of the state before it, as a run that did not fail."""
    def run():
        m = arm(torque=-0.1 * X)
        m.force("push", m["link"].end, along=(0, 1), value=0.0)
        return zd.Run(m, step=0.01, inputs={"push.force": (-1.0, 1.0)})

    failed, plain = run(), run()
    for each in (failed, plain):
        each.step(10)
    failed["push.force"] = 2.0
    with pytest.raises(zd.ZerodriftError, match="between -1 and 1"):
        failed.step()
    failed["push.force"] = plain["push.force"] = 0.5
    for each in (failed, plain):
        each.step(10)
    assert np.array_equal(failed.p, plain.p)


def test_a_law_in_space_and_of_an_acceleration():
    m = zd.Mechanism("wheel", dimension=3)
    body = m.body("body", 2.0, (0.5, 0.5, 0.25))
    hinge = m.revolute("hinge", m.ground, body, at=(0, 0, 0), axis=(0, 0, 1))
    m.motor("drive", hinge, torque=lambda t, a: 0.5 - 0.05 * a, of={"a": "hinge.acceleration"})
    run = zd.Run(m, step=0.01)
    run.step(1)
    assert run["hinge.acceleration"] == pytest.approx((0.5 - 0.05 * 2.0) / 0.25, rel=1e-12)     # at first as without the reading
    run.step(200)
    assert run["hinge.acceleration"] == pytest.approx(0.5 / (0.25 + 0.05), rel=1e-9)


def test_a_typing_error_and_a_vector_are_refused_when_a_run_begins():
    with pytest.raises(ValueError, match=r"user functions must depend on scalar measures, and 'pin.tension' is none"):
        zd.simulate(arm(torque=sp.Symbol("pin.tension")), 1.0, step=0.01)
    with pytest.raises(ValueError, match=r"must depend on scalar measures of positions and velocities, and 'pin.force' is none"):
        arm(torque=sp.Symbol("pin.force"))
    with pytest.raises(ValueError, match=r"must depend on scalar measures of positions and velocities"):
        arm(speed=X)


@pytest.mark.parametrize("compiled", [False, True])
@pytest.mark.parametrize("study", [zd.linearize, zd.equilibrium, lambda s: zd.ensemble(s, 1.0, p0=[[0.0], [0.1]], step=0.1),
                                   zd.check, zd.block])
def test_studies_refuse_them(study, compiled):
    with pytest.raises(ValueError, match=r"read pin.force.x of the last accepted state, which a run has"):
        study(arm(torque=LAW).system(compiled=compiled))


def test_measures_that_samples_do_not_determine_must_be_recorded():
    sol = zd.simulate(arm(torque=LAW), 0.1, step=0.01, outputs=["pin.force.x"])
    assert sol["pin.angle"].shape == sol["pin.force.x"].shape
    with pytest.raises(ValueError, match=r"'drive.power' must be recorded by the run, by outputs"):
        sol["drive.power"]
    with pytest.raises(ValueError, match=r"values between samples must be requested by t_eval"):
        sol(0.055)


def test_many_runs_read_their_own_reactions():
    system = arm(torque=LAW).system(compiled=True)
    starts = np.array([[0.1 * i] for i in range(20)])
    runs, speeds = zd.Run(system, runs=20, p0=starts, v0=0 * starts, step=0.01), []
    runs.step(30)
    for start in starts:
        one = zd.Run(system, start, [0.0], step=0.01)
        one.step(30)
        speeds.append(one.v)
    assert np.array_equal(runs.v, speeds)
