"""User functions of forces that read reactions and accelerations, by name: these are solved for at each evaluation."""

import numpy as np
import pytest
import sympy as sp

import friction_loops as loops
import zerodrift as zd
from friction_chains import accelerations, critical, mechanism, random_chain, reference

X, SPEED = sp.Symbol("pin.force.x"), sp.Symbol("pin.speed")
LAW = -0.1 * X - 0.02 * SPEED * abs(X)
FORMS = {"expression": {"torque": LAW},
         "callable": {"torque": lambda N, w: -0.1 * N - 0.02 * w * abs(N), "of": {"N": "pin.force.x", "w": "pin.speed"}}}
BOTH = [(layout, form) for layout in ("joint", "absolute") for form in FORMS]


def arm(**drive):
    """A pendulum with a motor at its pin."""
    m = zd.Mechanism("arm", gravity=(0, -9.81))
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, link.start)
    m.motor("drive", pin, **drive)
    return m


@pytest.mark.parametrize(("layout", "form"), BOTH)
@pytest.mark.parametrize("steps", [{"rtol": 1e-10, "atol": 1e-12}, {"rtol": 1e-10, "atol": 1e-12, "integrator": "dop853"},
                                   {"integrator": "radau", "rtol": 1e-9, "atol": 1e-11}, {"step": 0.001, "integrator": "rk4"}])
def test_the_motion_is_that_of_the_law_itself(layout, form, steps):
    run = zd.Run(arm(**FORMS[form]).system(layout), **steps)
    run.advance_to(0.5)
    assert run["pin.angle"] == pytest.approx(pendulum(), abs=3e-9)


def test_the_trapezoidal_rule_is_of_second_order():
    errors = []
    for step in (0.01, 0.005):
        run = zd.Run(arm(**FORMS["callable"]), step=step, integrator="trapezoidal")
        run.advance_to(0.5)
        errors.append(abs(run["pin.angle"] - pendulum()))
    assert 0.2 * errors[0] < errors[1] < 0.3 * errors[0] < 1e-3


def test_the_torque_is_that_of_the_sample_itself():
    sol = zd.simulate(arm(torque=-0.1 * X), 1.0, step=0.01, outputs=["pin.force.x", "drive.torque"])
    assert np.allclose(sol["drive.torque"], -0.1 * sol["pin.force.x"], rtol=0, atol=1e-12)
    assert np.ptp(sol["drive.torque"]) > 0.1


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("seed", range(6))
def test_accelerations_of_chains_are_those_of_newton_and_euler(seed, dimension, layout):
    chain = random_chain(seed, dimension)
    system, n = mechanism(chain).system(layout), len(chain.masses)
    expected, _ = accelerations(chain, 0 * chain.speeds, chain.speeds)
    for formulation in zd.formulations():
        if formulation == "minimal" and dimension == 3 and layout == "absolute":
            continue
        run = zd.Run(system, formulation=formulation, step=1e-3)
        assert [run[f"pin{i}.acceleration"] for i in range(n)] == pytest.approx(expected, rel=1e-9, abs=1e-9), formulation


@pytest.mark.parametrize(("seed", "dimension", "layout"),
                         [(1, 2, "joint"), (1, 3, "absolute"), (2, 2, "absolute"), (0, 3, "joint")])
def test_the_motion_of_chains_is_that_of_newton_and_euler(seed, dimension, layout):
    chain = random_chain(seed, dimension)
    run = zd.Run(mechanism(chain).system(layout), integrator="dop853", rtol=1e-10, atol=1e-12)
    run.advance_to(0.05)
    assert [run[f"pin{i}.angle"] for i in range(len(chain.masses))] == pytest.approx(reference(chain, 0.05)[0], rel=0, abs=1e-8)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize(("seed", "dimension"), [(3, 2), (4, 2), (5, 2), (1, 3), (2, 3)])
def test_friction_of_long_arms_up_to_painleve_is_solved_and_beyond_refused(seed, dimension, layout):
    """Lever arms of 0.2 to 1 m: half of the friction with which the motion has no continuation, and 1.2 times that."""
    strong = critical(random_chain(seed, dimension))
    half = strong._replace(c=0.5 * strong.c)
    run = zd.Run(mechanism(half).system(layout), step=1e-3)
    expected, _ = accelerations(half, 0 * half.speeds, half.speeds)
    assert [run[f"pin{i}.acceleration"] for i in range(len(half.c))] == pytest.approx(expected, rel=1e-9, abs=1e-9)
    with pytest.raises(zd.NoUniqueMotion, match="reactions have no unique solution"):
        zd.Run(mechanism(strong._replace(c=1.2 * strong.c)).system(layout)).step(1)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("seed", range(3))
def test_accelerations_of_loops_are_those_of_dense_equations(seed, dimension, layout):
    strong = loops.critical(loops.random_loop(seed, dimension))
    loop, equations = strong._replace(c=0.4 * strong.c), loops.Equations(strong)
    twists = equations.start().reshape(3, 6)
    expected = equations.solve([np.eye(3)] * 3, twists[:, 3:], loop.c)[0].reshape(3, 6)[0, 3:] @ loop.axes[0]
    run = zd.Run(loops.mechanism(loop).system(layout), step=1e-3)
    assert run["A.acceleration"] == pytest.approx(expected, rel=1e-9, abs=1e-9)
    with pytest.raises(zd.NoUniqueMotion, match="must depend less on those that it reads"):
        zd.Run(loops.mechanism(strong._replace(c=1.1 * strong.c)).system(layout)).step(1)


@pytest.mark.parametrize(("seed", "dimension", "layout"), [(0, 2, "absolute"), (3, 3, "joint")])
def test_the_motion_of_loops_is_that_of_dense_equations(seed, dimension, layout):
    strong = loops.critical(loops.random_loop(seed, dimension))
    loop = strong._replace(c=0.3 * strong.c)
    run = zd.Run(loops.mechanism(loop).system(layout), integrator="dop853", rtol=1e-10, atol=1e-12)
    run.advance_to(0.01)
    assert run["A.angle"] == pytest.approx(loops.reference(loop, 0.01)[0], rel=0, abs=1e-9)


@pytest.mark.parametrize("method", ["taylor", "rattle"])
def test_methods_that_do_not_evaluate_accelerations_refuse_by_name(method):
    with pytest.raises(zd.UnsuitedIntegrator, match=f"'{method}' must have"):
        zd.Run(arm(torque=LAW), integrator=method, step=0.01)


def acceleration(a, w):
    """The pin's force along x is -m (c v^2 cos a + c vdot sin a), linear in vdot, and solved for it."""
    def residual(vdot):
        N = -0.5 * (w * w * np.cos(a) + vdot * np.sin(a))
        return vdot / 3 - (-0.5 * 9.81 * np.cos(a) - 0.1 * N - 0.02 * w * abs(N))

    low, high = -200.0, 200.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if residual(middle) < 0 else (low, middle)
    return low


def pendulum():
    """Angle at 0.5 s."""
    from scipy.integrate import solve_ivp

    return solve_ivp(lambda t, y: (y[1], acceleration(*y)), (0, 0.5), (0.0, 0.0), rtol=1e-10, atol=1e-12).y[0, -1]


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


def test_a_failed_step_leaves_nothing_behind():
    """A step that is made again has the bits of a run that did not fail."""
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
    assert run["hinge.acceleration"] == pytest.approx(0.5 / (0.25 + 0.05), rel=1e-12)


def test_a_typing_error_and_a_vector_are_refused_when_a_run_begins():
    with pytest.raises(ValueError, match=r"user functions must depend on scalar measures, and 'pin.tension' is not one"):
        zd.simulate(arm(torque=sp.Symbol("pin.tension")), 1.0, step=0.01)
    with pytest.raises(ValueError, match=r"must depend on scalar measures, and 'pin.force' is not one"):
        arm(torque=sp.Symbol("pin.force"))
    with pytest.raises(ValueError, match=r"must depend on scalar measures of positions and velocities"):
        arm(speed=X)


def test_compiled_mechanisms_and_blocks_refuse_by_name():
    with pytest.raises(ValueError, match=r"user functions of arm must read no reactions .*, and read pin.force.x"):
        arm(torque=LAW).system(compiled=True)
    with pytest.raises(ValueError, match=r"must depend on t, positions and velocities in a block, and some of arm read"):
        zd.block(arm(torque=LAW), step=0.01)


def test_measures_of_samples_have_the_forces_of_their_instant():
    sol = zd.simulate(arm(torque=LAW), 0.1, step=0.01)
    force, speed = sol["pin.force.x"], sol["pin.speed"]
    assert np.allclose(sol["drive.power"], speed * (-0.1 * force - 0.02 * speed * abs(force)), rtol=0, atol=1e-12)
    assert np.allclose(sol["pin.acceleration"], [acceleration(*each) for each in zip(sol["pin.angle"], speed, strict=True)],
                       rtol=0, atol=1e-11)


def test_each_function_is_called_a_few_times_for_an_evaluation():
    calls = {"friction": 0, "other": 0}

    def friction(N, M, w):
        calls["friction"] += 1
        return -0.01 * np.hypot(N, M) * np.tanh(w)

    def other(w):
        calls["other"] += 1
        return -0.1 * w

    m = arm(torque=friction, of={"N": "pin.force.x", "M": "pin.force.y", "w": "pin.speed"})
    m.motor("damper", m["pin"], torque=other, of={"w": "pin.speed"})
    run = zd.Run(m, step=0.01, integrator="rk4")
    run.step(2)
    calls.update(friction=0, other=0)
    run.step(10)
    assert calls["other"] <= 10 * 5
    assert calls["friction"] <= 10 * 5 * 5


def test_friction_without_bound_ends():
    m = arm(torque=lambda N, w: -1e5 * abs(N) * np.tanh(w / 0.1), of={"N": "pin.force.y", "w": "pin.speed"})
    with pytest.raises(zd.NoUniqueMotion, match=r"torque of motor 'drive' must depend less .* is -\d.* \(condition \d"):
        zd.Run(m, rtol=1e-6).advance_to(1.0)


@pytest.mark.parametrize("steps", [{"step": 0.01}, {"rtol": 1e-9, "atol": 1e-11}])
@pytest.mark.parametrize("form", sorted(FORMS))
def test_states_between_samples_are_those_that_the_run_requests(form, steps):
    sol = zd.simulate(arm(**FORMS[form]), 0.5, **steps)
    p, _ = sol(0.255)
    asked = zd.simulate(arm(**FORMS[form]), 0.5, t_eval=[0.0, 0.255, 0.5], **steps)
    assert np.allclose(p, asked.p[1], rtol=0, atol=1e-7)


def test_many_runs_read_their_own_reactions():
    system = arm(torque=LAW).system()
    starts = np.array([[0.1 * i] for i in range(20)])
    runs, speeds = zd.ManyRuns(system, runs=20, p0=starts, v0=0 * starts, step=0.01), []
    runs.step(30)
    for start in starts:
        one = zd.Run(system, start, [0.0], step=0.01)
        one.step(30)
        speeds.append(one.v)
    assert np.array_equal(runs.v, speeds)


def test_studies_leave_out_methods_that_do_not_suit():
    wp = zd.work_precision(arm(torque=LAW), 0.05, steps=[0.01], tolerances=[1e-4], formulations=["schur"], rounds=1)
    assert all(row.success for row in wp.rows)
    assert {"rk4", "radau"} <= {row.setting.integrator for row in wp.rows}
