"""Open runs: chained advances are one, failures leave the run where it was, and values are those of `simulate`."""

import warnings

import numpy as np
import pytest

import zerodrift as zd
from support import refused


def dyadic(system, **settings):
    """A run whose fixed step is exact in doubles, so that its times are those of `simulate`."""
    return zd.Run(system, step=2.0**-6, **settings)


@pytest.mark.parametrize("energy", [None, True])
def test_chained_advances_have_the_bits_of_one_run(formulation, energy):
    bar = zd.systems.four_bar()
    sol = zd.simulate(bar, 2.0, step=2.0**-6, formulation=formulation, energy=energy)
    run = dyadic(bar, formulation=formulation, energy=energy)
    for steps in (1, 2, 30, 0, 31, 64):
        run.step(steps)
    assert run.steps == 128
    assert run.t == 2.0
    assert np.array_equal(run.p, sol.p[-1])
    assert np.array_equal(run.v, sol.v[-1])
    assert np.array_equal(run.multipliers, sol.multipliers[-1])


@pytest.mark.parametrize("method", zd.integrators())
def test_chains_and_times_are_alike_with_every_integrator(method):
    one, chain = (dyadic(zd.systems.four_bar(), integrator=method) for _ in range(2))
    one.step(40)
    for k in range(1, 41):
        chain.advance_to(k * 2.0**-6)
    assert np.array_equal(one.p, chain.p)
    assert np.array_equal(one.v, chain.v)
    assert one.t == chain.t


def test_adaptive_steps_chain_too():
    bar = zd.systems.four_bar()
    one, chain = zd.Run(bar, rtol=1e-8), zd.Run(bar, rtol=1e-8)
    one.step(12)
    for _ in range(12):
        chain.step()
    assert np.array_equal(one.p, chain.p)
    assert one.t == chain.t


def test_adaptive_steps_end_at_the_time_and_are_not_shorter_for_it():
    run = zd.Run(zd.systems.four_bar(), rtol=1e-8)
    run.step(5)
    size = run.t
    run.step()
    size = run.t - size
    run.advance_to(run.t + 1e-3 * size)
    before = run.t
    run.step()
    assert run.t - before > 0.3 * size


def test_fixed_steps_are_counted_from_a_time_between_two_of_them():
    run = zd.Run(zd.systems.oscillator(), step=0.1)
    run.advance_to(0.25)
    assert run.t == 0.25
    assert run.steps == 3
    run.step(2)
    assert run.t == 0.25 + 2 * 0.1
    assert run.steps == 5
    run.advance_to(0.55)
    assert run.t == 0.25 + 3 * 0.1
    assert run.steps == 6
    fine = zd.simulate(zd.systems.oscillator(), 0.55, step=0.001)
    assert run.p[0] == pytest.approx(fine.p[-1, 0], abs=1e-4)       # of RK4 at this step


def test_many_short_advances_do_not_add_up_rounding():
    run = zd.Run(zd.systems.oscillator(), step=0.1, record=True)
    for k in range(1, 301):
        run.advance_to(k / 10)
    assert run.steps == 300
    assert np.array_equal(run.solution().t, 0.1 * np.arange(301))


def test_what_is_read_is_what_a_solution_has():
    m = zd.models.slider_crank()
    sol = zd.simulate(m, 0.5, step=2.0**-8)
    run = zd.Run(m, step=2.0**-8)
    run.advance_to(0.5)
    for name in ("crank.angle", "slide.force", "slide.force.x", "slider.position", "crank.angular_velocity",
                 *(variable.name for variable in (*sol.system.coordinates, *sol.system.velocities))):
        assert np.asarray(run[name]).shape == np.asarray(sol[name][-1]).shape
        assert np.allclose(run[name], sol[name][-1], rtol=1e-13, atol=1e-13), name
    assert isinstance(run["crank.angle"], float)


def test_orientations_in_space_are_read():
    m = zd.models.space.gyroscope()
    sol, run = zd.simulate(m, 0.125, step=2.0**-8), zd.Run(m, step=2.0**-8)
    run.advance_to(0.125)
    names = [name for name in sol.measures if name.endswith(".rotation")]
    assert names
    for name in names:
        assert np.array_equal(np.ravel(run[name]), np.ravel(sol[name][-1]))


def test_names_that_nothing_has_are_refused():
    run = zd.Run(zd.models.slider_crank(), step=0.01)
    with refused("wrong-name", r"'crank\.angel'.*crank\.angle"):
        run["crank.angel"]
    with refused("wrong-name", "'formulations'"):
        zd.Run(zd.systems.four_bar(), step=0.01, formulations="schur")


def test_reading_does_not_change_the_bits_of_what_follows():
    m = zd.models.slider_crank()
    quiet, read = (zd.Run(m, step=0.01, formulation="augmented") for _ in range(2))
    for _ in range(50):
        quiet.step()
        read.step()
        _ = read["slide.force"], read.multipliers, read.vdot, repr(read)
    assert np.array_equal(quiet.p, read.p)
    assert np.array_equal(quiet.v, read.v)



def test_a_failed_step_leaves_the_run_at_its_start():
    system = zd.System(["x"], mass=np.eye(1), force=lambda t, p, v: np.array([np.nan]) if p[0] < -0.5 else np.array([-9.81]),
                       p0=[0.0], v0=[0.0])
    run = zd.Run(system, step=0.01, record=True)
    with refused("not-finite") as caught:
        run.step(1000)
    t, p = run.t, run.p
    assert 0.3 < t < 0.32
    assert p[0] > -0.5
    assert p[0] == pytest.approx(-9.81 / 2 * t**2, rel=1e-12)
    assert caught.value.solution.t[-1] == t
    with refused("not-finite"):
        run.step()
    assert run.t == t
    assert np.array_equal(run.p, p)


@pytest.mark.parametrize("method", ["rk4", "radau", "rattle", "trapezoidal"])
def test_a_run_goes_on_after_a_failure_as_if_it_had_not_been_tried(method):
    hot = {"is": False}

    def force(t, p, v):
        if hot["is"]:
            raise RuntimeError("overheated")
        return np.array([-p[0]])

    system = zd.System(["x"], mass=np.eye(1), force=force, p0=[1.0], v0=[0.0])
    run = zd.Run(system, step=0.01, integrator=method)
    run.step(50)
    hot["is"] = True
    with pytest.raises(RuntimeError, match="overheated"):
        run.step()
    hot["is"] = False
    assert run.t == 0.5
    run.step(50)
    assert run.t == 1.0
    assert run.p[0] == pytest.approx(np.cos(1.0), abs=1e-4)


def test_a_diverging_run_says_so_and_stays():
    run = zd.Run(zd.systems.four_bar(), step=2.0, stabilization=None, integrator="euler")
    with pytest.raises(zd.ZerodriftError) as caught:
        run.step(1000)
    assert np.isfinite(run.p).all()
    assert run.steps < 1000
    assert caught.value.code


def test_events_are_found_and_a_terminal_one_stops():
    event = zd.Event("x", value=0.0, terminal=True)
    run = zd.Run(zd.systems.oscillator(), step=0.01, events=event)
    run.step(10_000)
    first = run.t
    assert run.event == 0
    assert run.p[0] == pytest.approx(0.0, abs=1e-9)
    run.step(3)
    assert run.event is None
    assert run.t == pytest.approx(first + 0.03, rel=1e-14)
    run.step(10_000)
    assert run.event == 0
    assert run.t > first + 0.1


def test_ctrl_c_in_an_event_leaves_the_run_at_its_start():
    def impatient(t, p, v):
        if t > 0.1:
            raise KeyboardInterrupt
        return 1.0

    run = zd.Run(zd.systems.oscillator(), step=0.01, events=impatient)
    with pytest.raises(KeyboardInterrupt):
        run.step(100)
    assert run.t == pytest.approx(0.1, rel=1e-12)


@pytest.mark.parametrize("steps", [-1, 1.5, "2", None])
def test_steps_must_be_counted(steps):
    for record in (False, True):
        with pytest.raises((TypeError, ValueError)):
            zd.Run(zd.systems.oscillator(), step=0.01, record=record).step(steps)


def test_time_does_not_go_back():
    run = zd.Run(zd.systems.oscillator(), step=0.01, t0=2.0)
    run.advance_to(2.1)
    with refused("out-of-range", r"^t must.*least 2\.1, not 2"):
        run.advance_to(2.0)
    run.advance_to(run.t)
    assert run.steps == 10


def test_a_record_grows_and_a_solution_is_a_copy_of_it():
    bar = zd.systems.four_bar()
    run, sol = dyadic(bar, record=True, save_every=2), zd.simulate(bar, 64.0, step=2.0**-6, save_every=2)
    run.step(100)
    first = run.solution()
    run.step(64 * 64 - 100)
    assert len(first.t) == 51
    last = run.solution()
    for name in ("t", "p", "v", "multipliers", "energy_violation", "position_violation"):
        assert np.array_equal(getattr(last, name), getattr(sol, name)), name
    assert last.t_span == (0.0, 64.0)
    assert last.stats["steps"] == 64 * 64
    assert np.array_equal(first.p, sol.p[:51])


def test_samples_go_to_a_file(tmp_path):
    bar = zd.systems.four_bar()
    with zd.Run(bar, step=2.0**-6, save_to=tmp_path / "samples.npy") as run:
        run.step(128)
        with pytest.raises(zd.InUse):
            zd.Run(bar, step=2.0**-6, save_to=tmp_path / "samples.npy")
    sol = zd.simulate(bar, 2.0, step=2.0**-6)
    assert np.array_equal(zd.load(tmp_path / "samples.npy").p, sol.p)


@pytest.mark.parametrize("back", ["reset", "restore"])
def test_a_file_of_samples_begins_anew_where_the_run_does(tmp_path, back):
    """With the samples of the same run in memory; the first ones are longer than a buffer."""
    m = zd.Mechanism("arm")
    arm = m.link("arm", (0, 0), (1, 0), mass=3.0)
    m.motor("drive", m.revolute("pin", m.ground, arm.start), torque=0.0)
    solutions = []
    for to in ({"save_to": tmp_path / "samples"}, {"record": True}):
        run = zd.Run(m, step=0.01, inputs=["drive.torque"], **to)
        run.step(3)
        state = run.save()
        run["drive.torque"] = 2.0
        run.step(20_000)
        run.reset() if back == "reset" else run.restore(state)
        run["drive.torque"] = 7.0
        run.step(4)
        solutions.append(run.solution())
    for each in (solutions[0], zd.load(tmp_path / "samples.npy")):
        for name in ("t", "p", "v", "energy_violation"):
            assert np.array_equal(getattr(each, name), getattr(solutions[1], name)), name
        assert 4 <= len(each.t) <= 5
        assert set(each["drive.torque"]) == {7.0}
        assert np.array_equal(each["pin.torque"], solutions[1]["pin.torque"])
    assert sorted(each.name for each in tmp_path.iterdir()) == ["samples.json", "samples.npy"]


def test_inputs_are_in_a_file_once_the_run_has_ended(tmp_path):
    m = zd.Mechanism("arm")
    m.motor("drive", m.revolute("pin", m.ground, m.link("arm", (0, 0), (1, 0), mass=3.0).start), torque=0.0)
    run = zd.Run(m, step=0.01, inputs=["drive.torque"], save_to=tmp_path / "samples")
    run.step(3)
    with refused("unreadable-file", "a run must have ended before inputs are read"):
        zd.load(tmp_path / "samples.npy")["drive.torque"]
    run["drive.torque"] = 2.0
    run.step(2)
    run.solution()
    assert zd.load(tmp_path / "samples.npy")["drive.torque"].tolist() == [0.0, 0.0, 0.0, 0.0, 2.0, 2.0]


def test_a_run_that_records_nothing_has_no_solution():
    with refused("not-available"):
        zd.Run(zd.systems.oscillator(), step=0.01).solution()


def test_a_run_prints_itself():
    run = zd.Run(zd.systems.oscillator(), step=0.01)
    run.step(3)
    assert repr(run).startswith("Run of oscillator: t = 0.03 s after 3 steps\n")
    assert "x = " in repr(run)


@pytest.mark.parametrize("step", [0.002, None])
def test_controllers_are_called_at_multiples_of_their_period(step):
    called = {0.01: [], 0.03: []}
    control = [zd.every(period, call=lambda run, times=times: times.append(run.t)) for period, times in called.items()]
    run = zd.Run(zd.systems.oscillator(), step=step, control=control)
    run.advance_to(0.05)
    run.advance_to(0.12)
    for period, times in called.items():
        expected = period * np.arange(round(0.12 / period))
        assert np.allclose(times, expected, rtol=1e-15, atol=1e-15), period


@pytest.mark.parametrize("step", [0.01, None])
@pytest.mark.parametrize("t0", [0.0, 7.3])
def test_controllers_are_called_at_multiples_of_their_period_after_shortened_steps(step, t0):
    """To times between the ends of fixed steps, from a restored state, and to a terminal event."""
    called = {0.05: [], 0.02: []}
    control = [zd.every(period, call=lambda run, times=times: times.append(run.t)) for period, times in called.items()]

    def crossing(t, p, v):
        return p[0]
    crossing.terminal = True

    run = zd.Run(zd.systems.oscillator(), [0.0115], [-1.0], step=step, t0=t0, control=control, events=crossing)
    run.advance_to(t0 + 0.5)
    assert run.event == 0
    for k in range(1, 21):
        if k == 12:
            with pytest.warns(zd.StateWarning):
                run.restore(run.save())
        run.advance_to(t0 + 0.025 * k)
    for period, times in called.items():
        assert np.allclose(times, t0 + period * np.arange(round(0.5 / period)), rtol=1e-15, atol=1e-15), period


def test_a_time_within_rounding_of_the_present_one_is_reached_without_a_step():
    run = zd.Run(zd.systems.oscillator(), step=0.01, control=zd.every(1.0, call=lambda run: None))
    run.step(100)
    run.advance_to(1.0 + 5e-10)     # less than 1e-9 of the steps made, by which the core does not shorten one
    assert run.steps == 100


def test_a_step_that_does_not_divide_the_period_is_refused_with_one_that_does():
    with refused("step-size", r"^step must.*period 0\.01.*and 0\.003.*0\.00333"):
        zd.Run(zd.systems.oscillator(), step=0.003, control=zd.every(0.01, call=print))
    with refused("wrong-type", r"control.*zd\.every"):
        zd.Run(zd.systems.oscillator(), step=0.003, control=print)
    with refused("wrong-type", "^call must"):
        zd.every(0.01, call=3)


def test_what_a_controller_raises_says_when_and_leaves_the_run():
    def broken(run):
        if run.t > 0.045:
            raise RuntimeError("no signal")

    run = zd.Run(zd.systems.oscillator(), step=0.01, control=zd.every(0.01, call=broken))
    with pytest.raises(RuntimeError, match="no signal") as caught:
        run.step(100)
    assert run.t == 0.05
    assert run.steps == 5
    assert any("every 0.01 s" in note and "t = 0.05" in note for note in caught.value.__notes__)


def test_the_error_of_a_user_function_is_raised_once():
    """A later one is not hidden by it."""
    raised = []

    def pull(t):
        if t > 0.5 and not raised:
            raised.append(t)
            raise RuntimeError("no signal")
        return float("nan") if t > 0.75 else 1.0

    m = zd.Mechanism("slide")
    slide = m.prismatic("slide", m.ground, m.body("block", mass=1.0, inertia=0.1), axis=(1, 0))
    m.motor("drive", slide, force=pull)
    run = dyadic(m.system())
    with pytest.raises(RuntimeError, match="no signal"):
        run.step(40)
    with refused("not-finite", "force of motor 'drive'"):
        run.step(40)


@pytest.mark.parametrize("move", [lambda run: run.step(), lambda run: run.advance_to(5.0), lambda run: run.reset(),
                                  lambda run: run.restore(run.save()), lambda run: run.close(), lambda run: run.__exit__()])
def test_a_controller_must_not_move_the_run_that_calls_it(move):
    def control(run):
        if run.t > 0.02:
            move(run)

    given = {"step": 0.01, "control": zd.every(0.01, call=control)}
    with refused("in-use", r"^a controller must not"), warnings.catch_warnings():
        warnings.simplefilter("ignore", zd.errors.StateWarning)
        zd.simulate(zd.systems.oscillator(), 0.1, **given)
    run = zd.Run(zd.systems.oscillator(), record=True, **given)
    with refused("in-use", r"^a controller must not"), warnings.catch_warnings():
        warnings.simplefilter("ignore", zd.errors.StateWarning)
        run.step(10)
    assert (run.t, run.steps, len(run.solution().t)) == (0.03, 3, 4)
    run.reset()
    run.step(2)
    assert run.steps == 2


def test_a_controller_must_not_finish_the_file_of_its_run(tmp_path):
    finish = zd.every(0.01, call=lambda run: run.steps and run.solution())
    run = zd.Run(zd.systems.oscillator(), step=0.01, save_to=tmp_path / "run.npy", control=finish)
    with refused("in-use", r"^a controller must not"), run:
        run.step(2)
    assert np.array_equal(zd.load(tmp_path / "run.npy").t, [0.0, 0.01])


def test_a_controller_looks_ahead_with_a_copy():
    """Its prediction of the state after one period is the state there."""
    ahead = []

    def predict(run):
        if len(ahead) <= run.steps:         # a copy has the same controllers
            ahead.append(None)
            twin = run.copy()
            twin.step()
            ahead[run.steps] = twin.p

    run = zd.Run(zd.systems.oscillator(), step=0.01, control=zd.every(0.01, call=predict))
    for k in range(4):
        run.step()
        assert np.array_equal(ahead[k], run.p)
