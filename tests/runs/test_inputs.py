"""Inputs of runs: they hold from the next step on, do work, and are refused where they must not be used."""

import numpy as np
import pytest

import zerodrift as zd
from few_bodies import driven_four_bar
from native_systems import PENDULUM, compile_library, needs_compiler, pendulum
from support import refused


def wheel(**drives):
    """A wheel in space, whose motion under a torque is known."""
    m = zd.Mechanism("wheel", dimension=3)
    body = m.body("body", 2.0, (0.5, 0.5, 0.25))
    hinge = m.revolute("hinge", m.ground, body, at=(0, 0, 0), axis=(0, 0, 1))
    m.motor("drive", hinge, **drives)
    return m


LAYOUTS = [(layout, compiled) for layout in ("joint", "absolute") for compiled in (False, True)]


@pytest.mark.parametrize(("layout", "compiled"), LAYOUTS)
def test_an_input_at_its_first_value_has_the_bits_of_a_number(layout, compiled):
    system = driven_four_bar(torque=1.5).system(layout, compiled=compiled)
    run, sol = zd.Run(system, step=2.0**-8, inputs=["drive.torque"]), zd.simulate(system, 0.5, step=2.0**-8)
    run.step(128)
    assert run["drive.torque"] == 1.5
    exact = np.array_equal if not compiled else lambda a, b: np.allclose(a, b, rtol=1e-13, atol=1e-13)  # other code: rounding
    assert exact(run.p, sol.p[-1])
    assert exact(run.v, sol.v[-1])


@pytest.mark.parametrize(("layout", "compiled"), LAYOUTS)
def test_an_input_is_a_torque_that_is_a_function_of_time(layout, compiled):
    """The same torque as a law: constant within each step, so that RK4 steps are the same to rounding."""
    steps = [3.0, -2.0, 0.5, 7.0]
    run = zd.Run(driven_four_bar(torque=0.0).system(layout, compiled=compiled), step=2.0**-7, inputs=["drive.torque"],
                 record=True)
    for value in steps:
        run["drive.torque"] = value
        run.step(16)
    parts = [zd.Run(driven_four_bar(torque=value).system(layout, compiled=compiled), *state, step=2.0**-7) for value, state in
             zip(steps[:1], [(None, None)], strict=True)]
    parts[0].step(16)
    for value in steps[1:]:
        last = parts[-1]
        parts.append(zd.Run(driven_four_bar(torque=value).system(layout, compiled=compiled), last.p, last.v, t0=last.t,
                            step=2.0**-7))
        parts[-1].step(16)
    assert np.allclose(run.p, parts[-1].p, rtol=1e-12, atol=1e-12)
    assert np.allclose(run.v, parts[-1].v, rtol=1e-11, atol=1e-11)
    sol = run.solution()
    assert sol["drive.torque"].tolist() == [3.0, *np.repeat(steps, 16)]


@pytest.mark.parametrize("form", ["schur", "augmented", "nullspace", "mixed", "independent"])
@pytest.mark.parametrize("method", ["rk4", "radau", "rattle", "extrapolation"])
def test_work_of_inputs_is_in_the_energy_balance(form, method):
    run = zd.Run(driven_four_bar(torque=0.0), step=0.001, formulation=form, integrator=method, inputs=["drive.torque"],
                 record=True)
    for value in (20.0, -15.0, 5.0):
        run["drive.torque"] = value
        run.step(100)
    sol = run.solution()
    assert np.ptp(sol.energy_input) > 1.0
    size = 1e-3 if method == "rattle" else 1e-7      # of second order, and of the fourth and higher ones, at this step
    assert abs(sol.energy_violation).max() < size * sol.kinetic_energy.max()


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_torque_in_space_turns_a_wheel(layout):
    run = zd.Run(wheel(torque=0.0).system(layout), step=0.01, inputs=["drive.torque"])
    run["drive.torque"] = 0.5
    run.advance_to(1.0)
    run["drive.torque"] = -0.25
    run.advance_to(2.0)
    assert run["hinge.angle"] == pytest.approx(0.5 * 2.0 + 2.0 - 0.5, rel=1e-9)     # accelerations 2 and -1 rad/s^2
    assert run["drive.torque"] == -0.25
    assert run["hinge.torque.z"] == pytest.approx(-0.25, abs=1e-9)


@pytest.mark.parametrize(("layout", "compiled"), LAYOUTS)
@pytest.mark.parametrize("made", [driven_four_bar, wheel])
def test_a_speed_is_followed_linearly_over_one_step(made, layout, compiled):
    m = made(speed=0.0)
    joint = "A" if made is driven_four_bar else "hinge"
    run = zd.Run(m.system(layout, compiled=compiled), step=0.002, inputs=["drive.speed"], record=True)
    run["drive.speed"] = 2.0
    run.step()
    assert run[f"{joint}.speed"] == pytest.approx(2.0, rel=1e-10)
    run.step(99)
    run["drive.speed"] = -1.0
    run.step(50)
    sol = run.solution()
    moved = 2.0 * 0.001 + 2.0 * 0.198 + 0.5 * 0.002 - 0.098     # two ramps, and constant speeds
    angle = sol[f"{joint}.angle"]
    assert angle[-1] - angle[0] == pytest.approx(moved, rel=1e-9)
    assert abs(sol.velocity_violation).max() < 1e-9
    assert abs(sol.energy_violation).max() < 1e-6 * max(1.0, sol.kinetic_energy.max())


def test_every_kind_of_load_can_be_an_input():
    m = zd.Mechanism("loads", gravity=(0, 0))
    body = m.body("body", 2.0, 0.5)
    m.force("thrust", body, along=(1, 0), value=0.0)
    m.torque("spin", body, value=0.0)
    other = m.particle("other", 1.0, at=(3, 0))
    m.actuator("ram", body.point((0, 0)), other, force=0.0)
    run = zd.Run(m, step=0.01, inputs=["thrust.force", "spin.torque", "ram.force"])
    run.inputs[:] = 4.0, 1.0, 0.0
    run.advance_to(1.0)
    assert run["body.velocity.x"] == pytest.approx(2.0, rel=1e-9)
    assert run["body.angular_velocity"] == pytest.approx(2.0, rel=1e-9)
    run.inputs[:] = 0.0, 0.0, 3.0
    before = run["other.velocity.x"]
    run.advance_to(1.01)
    assert run["other.velocity.x"] - before == pytest.approx(0.03, rel=1e-3)


def test_symbols_that_are_declared_are_inputs():
    sp = pytest.importorskip("sympy")
    x, v, u, k = sp.symbols("x v u k")
    system = zd.symbolic([x], speeds=[v], kinetic=v**2 / 2, potential=0, force=[k * u], inputs=[u], parameters={k: 2.0}, p0=[0.0])
    run = zd.Run(system, step=0.01, inputs=["u"], record=True)
    run["u"] = 3.0
    run.advance_to(1.0)
    assert run.p[0] == pytest.approx(3.0, rel=1e-12)
    assert run.solution().energy_input[-1] == pytest.approx(18.0, rel=1e-12)
    with refused("wrong-name", r"zd\.symbolic.*'k'"):
        zd.Run(system, step=0.01, inputs=["k"])


def test_numbers_among_the_parameters_of_a_system_are_inputs():
    system = zd.System(2, mass=np.eye(2), force=lambda u, gain: gain * u, parameters={"u": np.zeros(2), "gain": 1.0},
                       p0=[0.0, 0.0])
    run, other = (zd.Run(system, step=0.01, inputs=["u[0]", "u[1]", "gain"]) for _ in range(2))
    run.inputs[:] = 1.0, -1.0, 3.0
    for each in (run, other):
        each.step(100)
    assert np.allclose(run.p, [1.5, -1.5], rtol=1e-12)
    assert not other.p.any()
    with refused("wrong-name", "'w'"):
        zd.Run(system, step=0.01, inputs=["w"])


def test_arrays_among_the_parameters_of_a_system_are_inputs():
    gains = np.array([[2.0, 0.0], [1.0, -1.0]])
    system = zd.System(2, mass=np.eye(2), force=lambda u, K: K @ u, parameters={"u": np.zeros(2), "K": gains}, p0=[0.0, 0.0])
    run = zd.Run(system, step=0.01, inputs={"u": (-5.0, 5.0), "K": None}, record=True)
    entries = zd.Run(system, step=0.01, inputs=["u[0]", "u[1]", "K[0, 0]", "K[0, 1]", "K[1, 0]", "K[1, 1]"])
    many = zd.ManyRuns(system, runs=2, step=0.01, inputs=["u"])
    many["u"] = [[3.0, -1.0], [0.0, 0.0]]
    run["u"] = [3.0, -1.0]
    entries["u[0]"], entries["u[1]"] = 3.0, -1.0
    for each in (run, entries, many):
        each.step(50)
    assert np.allclose(run.p, [6.0 / 8, 4.0 / 8], rtol=1e-12)     # K u t^2 / 2
    assert np.array_equal(many.p, [run.p, [0.0, 0.0]])
    state = run.save()
    run["K"] = 2 * gains
    run["K[0, 1]"] = 0.5
    entries["K"] = [[4.0, 0.5], [2.0, -2.0]]                        # all of its entries are inputs
    for each in (run, entries):
        each.step(50)
    assert np.array_equal(run.p, entries.p)
    assert run["K"].tolist() == [[4.0, 0.5], [2.0, -2.0]]
    sol = run.solution()
    assert sol["u"].tolist() == [[3.0, -1.0]] * 101
    assert sol["K"][-1].tolist() == [4.0, 0.5, 2.0, -2.0]
    assert sol["K[0, 1]"][[50, 51]].tolist() == [0.0, 0.5]
    run.restore(state)
    assert run["K"].tolist() == gains.tolist()
    run["u"] = [6.0, 0.0]
    with pytest.raises(zd.InputRefused, match=r"input 'u\[0\]' must be between -5 and 5, not 6"):
        run.step()
    with refused("shape", r"input 'u' must be set to real numbers of shape \(2,\)"):
        run["u"] = [1.0, 2.0, 3.0]
    with refused("duplicate-name", r"'u\[1\]' is named more often"):
        zd.Run(system, step=0.01, inputs=["u", "u[1]"])


@needs_compiler
def test_parameters_of_a_native_system_are_inputs(tmp_path):
    library = compile_library(PENDULUM, tmp_path / "pendulum.so")
    system = pendulum(library)
    run, same = (zd.Run(system, step=0.01, inputs=["gravity", "mass"]) for _ in range(2))
    run["gravity"] = 1.62
    on_the_moon = zd.Run(pendulum(library, parameters=system.parameters | {"gravity": 1.62}), step=0.01)
    on_earth = zd.Run(system, step=0.01)
    for each in (run, same, on_the_moon, on_earth):
        each.step(50)
    assert np.array_equal(run.p, on_the_moon.p)
    assert np.array_equal(same.p, on_earth.p)
    assert system.parameters["gravity"] == 9.81
    with refused("wrong-name", "'wind'"):
        zd.Run(system, step=0.01, inputs=["wind"])


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 5.5, -2.5])
def test_an_input_that_must_not_be_used_makes_no_step(value):
    run = zd.Run(driven_four_bar(torque=0.0), step=0.01, inputs={"drive.torque": (-2.0, 5.0)})
    run["drive.torque"] = 5.0
    run.step(3)
    p = run.p
    run["drive.torque"] = value
    rule = "between -2 and 5" if np.isfinite(value) else "finite"
    with pytest.raises(zd.InputRefused, match=rf"at t = 0\.03: input 'drive\.torque' must be {rule}.*\[zd:input-refused\]"):
        run.step()
    assert run.steps == 3
    assert np.array_equal(run.p, p)
    run["drive.torque"] = -2.0
    run.step()
    assert run.steps == 4


def test_wrong_inputs_say_what_is_allowed():
    m = driven_four_bar(speed=1.0)
    with refused("wrong-name", r"'drive\.torque'.*'drive'"):
        zd.Run(m, step=0.01, inputs=["drive.torque"])
    with refused("step-size", r"'drive\.speed'"):
        zd.Run(m, inputs=["drive.speed"])
    with refused("wrong-value", "must begin with a number"):
        zd.Run(driven_four_bar(torque=lambda t: t), step=0.01, inputs=["drive.torque"])
    with refused("duplicate-name"):
        zd.Run(m, step=0.01, inputs=["drive.speed", "drive.speed"])
    with refused("shape"):
        zd.Run(m, step=0.01, inputs={"drive.speed": (1.0, 0.0)})
    with refused("not-available"):
        zd.Run(zd.systems.four_bar(), step=0.01, inputs=["mass"])
    run = zd.Run(m, step=0.01)
    with refused("wrong-name", r"'drive\.speed'"):
        run["drive.speed"] = 1.0
    with refused("wrong-name", r"'A\.angle'"):
        run["A.angle"] = 1.0


def test_many_steps_with_changing_inputs_give_no_false_warning(recwarn):
    run = zd.Run(driven_four_bar(torque=0.0), step=0.001, inputs=["drive.torque"], record=True)
    for k in range(500):
        run["drive.torque"] = 30.0 * (-1) ** k
        run.step()
    run.solution()
    assert not recwarn.list


def test_a_run_prints_its_inputs():
    run = zd.Run(driven_four_bar(torque=0.0), step=0.01, inputs=["drive.torque"])
    run["drive.torque"] = 2.5
    assert "  inputs      drive.torque = 2.5 N m\n" in repr(run)


@pytest.mark.parametrize("steps", [{"step": 0.002}, {"rtol": 1e-9}])
def test_simulate_with_a_controller_has_the_bits_of_a_run_with_it(steps):
    """A spring and a damper that are sampled: each torque is that of the state at the instant before."""

    @zd.every(0.01)
    def spring(run):
        run["drive.torque"] = 20.0 - 30.0 * run["A.angle"] - 4.0 * run["A.speed"]

    m = driven_four_bar(torque=0.0)
    sol = zd.simulate(m, 0.5, inputs=["drive.torque"], control=spring, **steps)
    run = zd.Run(m, inputs=["drive.torque"], control=spring, record=True, **steps)
    run.advance_to(0.5)
    assert np.array_equal(run.solution().p[:-1], sol.p[:-1])
    for k in range(50):
        at = np.searchsorted(sol.t, 0.01 * k - 1e-9)
        wanted = 20.0 - 30.0 * sol["A.angle"][at] - 4.0 * sol["A.speed"][at]
        held = sol["drive.torque"][(sol.t > 0.01 * k + 1e-9) & (sol.t < 0.01 * k + 0.0099)]
        assert np.allclose(held, wanted, rtol=1e-9)
    assert abs(sol.energy_violation).max() < 1e-7 * sol.kinetic_energy.max()


def test_first_and_restored_inputs_must_be_within_their_limits():
    m, between = driven_four_bar(torque=0.0), {"drive.torque": (1.0, 2.0)}
    run = zd.Run(m, step=0.01, inputs=between)
    with refused("input-refused", r"'drive\.torque' must be between 1 and 2, not 0"):
        run.step()
    assert run.steps == 0
    run["drive.torque"] = 1.5
    run.step()
    free = zd.Run(m, step=0.01, inputs=["drive.torque"])
    free["drive.torque"] = 5.0
    free.step()
    run.restore(free.save())
    with refused("input-refused", "must be between 1 and 2, not 5"):
        run.step()
    run["drive.torque"] = 2.0
    run.step()
    assert run.steps == 2


@pytest.mark.parametrize(("count", "compiled"), [(2, False), (16, True)])
def test_first_inputs_of_many_runs_must_be_within_their_limits(count, compiled):
    runs = zd.ManyRuns(driven_four_bar(torque=0.0).system(compiled=compiled), runs=count, step=0.01,
                       inputs={"drive.torque": (1.0, 2.0)})
    runs["drive.torque"] = [0.0, *[1.5] * (count - 1)]
    runs.step(2)
    assert runs.failed.tolist() == [True, *[False] * (count - 1)]
    assert "must be between 1 and 2, not 0" in runs.messages[0]
    assert runs.t.tolist() == [0.0, *[0.02] * (count - 1)]


def test_a_controller_that_raises_leaves_a_partial_solution():
    def broken(run):
        if run.t > 0.1:
            raise RuntimeError("no signal")

    with pytest.raises(RuntimeError, match="no signal") as caught:
        zd.simulate(driven_four_bar(torque=0.0), 1.0, step=0.01, inputs=["drive.torque"], control=zd.every(0.05, call=broken))
    assert caught.value.solution.t[-1] == pytest.approx(0.15)
    with pytest.raises(zd.InputRefused, match="must be finite") as caught:
        zd.simulate(driven_four_bar(torque=0.0), 1.0, step=0.01, inputs=["drive.torque"],
                    control=zd.every(0.05, call=lambda run: run.inputs.fill(np.nan if run.t > 0.1 else 0.0)))
    assert caught.value.solution.t[-1] == pytest.approx(0.15)


@pytest.mark.parametrize(("layout", "compiled"), LAYOUTS)
def test_reactions_read_afterwards_are_those_under_the_inputs(layout, compiled):
    """The torque of the last step holds at a sample: the same reactions as of runs with that torque as a number."""
    system = driven_four_bar(torque=0.0).system(layout, compiled=compiled)
    run = zd.Run(system, step=2.0**-7, inputs=["drive.torque"],
                 record=True)
    for value in (3.0, -20.0, 3.0):
        run["drive.torque"] = value
        run.step(3)
    sol = run.solution()
    for k in (1, 3, 4, 6, 9):
        alone = driven_four_bar(torque=float(sol["drive.torque"][k])).system(layout)
        known = zd.Instant(alone, sol.t[k], sol.p[k], sol.v[k])
        for name in ("A.force", "crank.angular_acceleration", "drive.power"):
            assert np.allclose(sol[name][k], known[name], rtol=1e-10, atol=1e-10)
    assert not np.allclose(sol["A.force"][6], zd.Instant(system, sol.t[6], sol.p[6], sol.v[6])["A.force"], rtol=1e-3)
    with refused("not-available", "outputs="):
        sol.at(0.01)["A.force"]


def test_accelerations_under_a_speed_that_is_an_input_are_recorded():
    run = zd.Run(driven_four_bar(speed=1.0), step=0.01, inputs=["drive.speed"], record=True)
    run["drive.speed"] = 2.0
    run.step(3)
    sol = run.solution()
    assert np.isclose(sol["crank.angular_velocity"][-1], 2.0, rtol=1e-10)
    with pytest.raises(ValueError, match="must be recorded by the run"):
        sol["A.force"]


@pytest.mark.parametrize("compiled", [False, True])
def test_values_between_samples_have_the_inputs_of_their_step(compiled):
    system, numbers = driven_four_bar(torque=0.0).system(compiled=compiled), iter([3.0, -2.0, 8.0, 0.5])

    def set_next(run):
        run["drive.torque"] = next(numbers)

    given = {"step": 0.02, "inputs": ["drive.torque"]}
    sol = zd.simulate(system, 0.4, **given, control=zd.every(0.1, set_next))
    times, numbers = np.array([0.05, 0.11, 0.25, 0.39]), iter([3.0, -2.0, 8.0, 0.5])
    exact = zd.simulate(system, 0.4, **given, control=zd.every(0.1, set_next), t_eval=times)   # ends at the last of these
    p, v = sol(times)
    assert np.array_equal(p, exact.p)
    assert np.array_equal(v, exact.v)


def test_values_between_samples_need_t_eval_if_a_speed_is_an_input():
    sol = zd.simulate(driven_four_bar(speed=1.0), 0.1, step=0.01, inputs=["drive.speed"])
    with pytest.raises(ValueError, match="values between samples must be requested by t_eval, as a speed is an input"):
        sol(0.055)
