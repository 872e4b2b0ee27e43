"""Many runs: each as it is by itself, failures as data, and what is refused before anything runs."""

import itertools
import threading

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from small_studies import pendulum
from support import refused
from zerodrift.ensembles import ensemble as module


def test_runs_are_those_that_simulate_makes():
    masses = np.linspace(1.0, 2.0, 7)
    m, times = zd.models.four_bar(), np.linspace(0, 1, 5)
    ens = zd.ensemble(m, 1.0, parameters={"crank.mass": masses, "rocker.mass": 2.5}, step=0.01, t_eval=times,
                      outputs=["crank.angle", m["C"].force], threads=3)
    assert (len(ens), ens.shape, ens["crank.angle"].shape, ens["C.force"].shape) == (7, (7,), (7, 5), (7, 5, 2))
    assert not ens.failed.any()
    assert np.array_equal(ens.t, times)
    assert np.array_equal(ens.parameters["rocker.mass"], np.full(7, 2.5))
    for i, mass in enumerate(masses):
        sol = zd.simulate(m.with_parameters({"crank.mass": mass, "rocker.mass": 2.5}), 1.0, step=0.01, t_eval=times)
        assert np.abs(ens["crank.angle"][i] - sol["crank.angle"]).max() < 1e-12     # starts differ by rounding
        assert np.abs(ens["C.force"][i] - sol["C.force"]).max() < 1e-10
    again = ens[-1]
    assert np.array_equal(again["crank.angle"], ens["crank.angle"][6])
    assert again.system.parameters["crank.mass"] == 2.0


def test_a_function_of_the_parameters_makes_the_systems():
    ens = zd.ensemble(pendulum, 1.0, parameters=zd.grid(length=[0.5, 1.0], gravity=[1.0, 9.81, 20.0]), step=0.01,
                      reduce=lambda sol: sol["link.angle"].min(), threads=2)
    assert ens.shape == (2, 3)
    values = ens.values.reshape(ens.shape)
    for (i, length), (j, gravity) in itertools.product(enumerate([0.5, 1.0]), enumerate([1.0, 9.81, 20.0])):
        assert values[i, j] == zd.simulate(pendulum(length, gravity), 1.0, step=0.01)["link.angle"].min()
    assert ens.parameters["gravity"].tolist() == [1.0, 9.81, 20.0] * 2
    assert repr(ens).startswith("<ensemble of 2 x 3 runs over length, gravity: 101 samples each, none failed\n in ")
    with refused("wrong-name"):
        _ = ens["link.angle"]


def test_starts_vary_too():
    bar = zd.systems.four_bar()
    speeds = np.linspace(0.5, 2.0, 4)
    starts = [zd.assemble(bar, bar.p0, speed * bar.v0, hold="alpha1_dot") for speed in speeds]
    ens = zd.ensemble(bar, 0.5, v0=[v for _, v in starts], step=0.01)
    for i, (_, v) in enumerate(starts):
        sol = zd.simulate(bar, 0.5, bar.p0, v, step=0.01)
        assert np.abs(ens["alpha2"][i] - sol["alpha2"]).max() < 1e-12       # in vector lanes, rounded otherwise
        assert np.array_equal(ens["alpha2"][i], ens[i]["alpha2"])
    held = zd.ensemble(zd.models.four_bar(), 0.5, start={"crank.angular_velocity": speeds, "crank.angle": 1.0}, step=0.01,
                       outputs=["crank.angle", "crank.angular_velocity"])
    assert np.abs(held["crank.angular_velocity"][:, 0] - speeds).max() < 1e-13
    assert np.abs(held["crank.angle"][:, 0] - 1.0).max() < 1e-13


def test_a_start_is_made_consistent_after_a_change():
    """A rod that is longer than it was: its end has to move, or nothing can start."""
    import sympy as sp
    from sympy.physics.mechanics import dynamicsymbols

    x, y = dynamicsymbols("x y")
    L, m, g = sp.symbols("L m g", positive=True)
    t = dynamicsymbols._t
    system = zd.symbolic([x, y], kinetic=m * (x.diff(t)**2 + y.diff(t)**2) / 2, potential=m * g * y,
                         constraints={"rod": x**2 + y**2 - L**2}, parameters={L: 1.0, m: 1.0, g: 9.81}, p0=[0.6, -0.8],
                         v0=[0.0, 0.0], name="rod")
    lengths = [0.9, 1.0, 1.1]
    ens = zd.ensemble(system, 0.2, parameters={"L": lengths}, step=0.01)
    assert not ens.failed.any()
    assert np.abs(np.hypot(ens["x"], ens["y"]) - np.array(lengths)[:, None]).max() < 1e-12
    raw = zd.ensemble(system, 0.2, parameters={"L": lengths}, step=0.01, assemble=False)
    assert raw.failed.tolist() == [True, False, True]
    assert "InconsistentStart" in raw.messages[0]
    held = zd.ensemble(system, 0.2, parameters={"L": lengths}, step=0.01, hold=["x"])
    assert np.array_equal(held["x"][:, 0], np.full(3, 0.6))


def test_failed_runs_are_data():
    """One that cannot be made, one that cannot start, one that breaks down on its way, and one whose function raises."""
    def made(case):
        if case == 1:
            raise RuntimeError("no such thing")
        m = pendulum(length=0.0 if case == 2 else 1.0)
        if case == 3:
            m.torque("load", "link", value=lambda angle: 1 / 0 if angle < -0.5 else 0.0, of={"angle": "link.angle"})
        return m

    ens = zd.ensemble(made, 1.0, parameters=[{"case": i} for i in range(4)], step=0.01, outputs=["link.angle"],
                      reduce=lambda sol: len(sol.t), threads=2)
    assert ens.failed.tolist() == [False, True, True, True]
    assert ens.messages[1] == "RuntimeError: no such thing"
    assert ens.messages[2].startswith("ValueError: ")
    assert "ZeroDivisionError" in ens.messages[3]
    assert not np.isnan(ens["link.angle"][0]).any()
    assert np.isnan(ens["link.angle"][1:3]).all()
    assert ens.values[0] == 101
    assert np.isnan(ens.values[1:]).all()
    assert "3 failed, the first because RuntimeError: no such thing" in repr(ens)
    with pytest.raises(RuntimeError, match="no such thing"):
        _ = ens[1]


def test_the_first_run_may_fail_as_any_other():
    def made(case):
        if not case:
            raise RuntimeError("no such thing")
        m = pendulum()
        m.torque("load", "link", value=lambda angle: 1 / 0 if case < 2 else 0.0, of={"angle": "link.angle"})
        return m

    for cases in ([0, 2], [1, 2]):
        ens = zd.ensemble(made, 0.1, parameters={"case": cases}, step=0.01)
        assert ens.failed.tolist() == [True, False]
        assert np.isnan(ens["link.angle"][0]).all()
        assert np.isfinite(ens["link.angle"][1]).all()


def test_a_run_that_breaks_down_keeps_its_rows():
    bar = zd.systems.four_bar()
    ens = zd.ensemble(bar, 8.0, parameters={"crank_rate": [1.0, 1.1]}, step=0.05, stabilization=None)
    assert ens.failed.all()
    alone = zd.simulate(bar, 8.0, step=0.05, stabilization=None, on_failure="return")
    rows = len(alone.t)
    assert np.array_equal(ens["alpha1"][0, :rows], alone["alpha1"])
    assert np.isnan(ens["alpha1"][0, rows:]).all()
    assert ens.messages[0] == alone.message


def test_runs_that_end_by_an_event_have_rows_of_their_own():
    falls = zd.Event("link.angle", value=-0.5, terminal=True)
    ens = zd.ensemble(pendulum, 2.0, parameters={"gravity": [5.0, 10.0]}, step=0.01, events=[falls], outputs=["link.angle"])
    assert ens.t is None
    assert not ens.failed.any()
    assert [len(each) for each in ens["link.angle"]] == [len(ens[i].t) for i in range(2)]
    ends = [float(times[0][0]) for times in ens.t_events]
    assert ends[0] / ends[1] == pytest.approx(np.sqrt(2), rel=1e-6)
    assert "times of their own" in repr(ens)


def test_with_requested_times_all_rows_stack():
    """A run that an event ends between two of them has its end in `t_events`."""
    times = np.linspace(0, 2, 21)
    falls = zd.Event("link.angle", value=-0.5, terminal=True)
    ens = zd.ensemble(pendulum, 2.0, parameters={"gravity": [5.0, 1e-3, 10.0]}, step=0.01, events=[falls], t_eval=times,
                      outputs=["link.angle", "link.end.position"])
    assert np.array_equal(ens.t, times)
    assert ens["link.end.position"].shape == (3, 21, 2)
    for i, (angles, (ended,)) in enumerate(zip(ens["link.angle"], ens.t_events, strict=True)):
        reached = times <= (ended[0] if len(ended) else 2.0)
        assert np.array_equal(angles[reached], ens[i]["link.angle"][:reached.sum()])
        assert np.isnan(angles[~reached]).all()
    assert [len(ended) for ended, in ens.t_events] == [1, 0, 1]


def test_progress_is_that_of_the_runs():
    seen = []
    zd.ensemble(pendulum, 50.0, parameters={"gravity": np.linspace(1, 20, 20)}, step=1e-3, save_every=1000, progress=seen.append)
    assert seen == sorted(seen)
    assert 0 <= seen[0] < seen[-1] == 1


def test_solutions_can_be_kept():
    ens = zd.ensemble(pendulum, 0.1, parameters={"gravity": [5.0, 10.0]}, step=0.01, keep="solutions")
    assert ens[0] is ens[0]
    assert list(ens._ipython_key_completions_()) == ["link.angle"]
    with refused("wrong-type", "an ensemble must not be iterated"):
        list(ens)


def test_one_run_and_no_parameters():
    ens = zd.ensemble(zd.systems.four_bar(), 0.5, step=0.01, reduce=lambda sol: "done")
    assert (len(ens), ens.values) == (1, ["done"])


def test_ctrl_c_leaves_what_was_done(monkeypatch):
    """As when it comes while the threads are waited for."""
    begun = threading.Event()

    def slow(sol):
        begun.set()
        return 1.0

    class Interrupting(threading.Thread):
        def join(self, timeout=None):
            begun.wait(tol.HUNG)
            if timeout is not None:
                raise KeyboardInterrupt
            super().join()

    monkeypatch.setattr(module.threading, "Thread", Interrupting)
    with pytest.raises(zd.Interrupted, match=r"the ensemble was interrupted: .* of 400 runs are done") as caught:
        zd.ensemble(pendulum, 5.0, parameters={"gravity": np.linspace(1, 20, 400)}, step=1e-3, reduce=slow, threads=1)
    done = caught.value.solution
    assert 1 <= (~done.failed).sum() < 400
    assert "was not started" in done.messages[-1]
    assert f"none failed, {len(done) - int((~done.failed).sum())} not started" in repr(done)


def test_ctrl_c_in_the_first_run():
    def pressed(sol):
        raise KeyboardInterrupt

    with pytest.raises(zd.Interrupted, match="0 of 3 runs are done") as caught:
        zd.ensemble(pendulum, 0.1, parameters={"gravity": [1.0, 2.0, 3.0]}, step=0.01, reduce=pressed)
    assert caught.value.solution.failed.all()


@pytest.mark.parametrize(("arguments", "code", "said"), [
    ({"parameters": {"crank.mass": [1, 2], "rocker.mass": [1, 2, 3]}}, "shape",
     r"parameters\['crank.mass'\].*has 2.*parameters\['rocker.mass'\].*has 3.*zd.grid"),
    ({"parameters": {"crank.mass": [1, 2]}, "start": {"crank.angle": [1, 2, 3]}}, "shape", r"start\['crank.angle'\].*has 3"),
    ({"parameters": {"krank.mass": [1, 2]}}, "unknown-choice", "parameter"),
    ({"parameters": {"crank.mass": []}}, "shape", None),
    ({"parameters": {"crank.mass": ["a"]}}, "wrong-type", "must hold real numbers"),
    ({"parameters": [{"crank.mass": 1}, {"rocker.mass": 1}]}, "wrong-name", r"parameters\[1\] and parameters\[0\]"),
    ({"parameters": []}, "shape", None),
    ({"parameters": 3}, "wrong-type", "parameters"),
    ({"outputs": ["crank.angel"]}, "wrong-name", "'crank.angel'.*four_bar.*crank.angle"),
    ({"outputs": [3]}, "wrong-type", "each of outputs must be a measure"),
    ({"steps": 3}, "wrong-name", "'steps'"),
    ({"on_failure": "raise"}, "wrong-name", "'on_failure'"),
    ({"progress": 3}, "wrong-type", "progress"),
    ({"p0": [1.0, 2.0]}, "shape", "^p0 must.*have 3.*four_bar"),
    ({"events": [3]}, "wrong-type", r"events\[0\]"),
    ({"formulation": "best"}, "unknown-choice", "formulation"),
    ({"reduce": 3}, "wrong-type", "reduce"),
    ({"threads": 0}, "out-of-range", "threads.*between 1"),
    ({"keep": "all"}, "unknown-choice", "^keep must"),
    ({"assemble": "yes"}, "wrong-type", "assemble"),
    ({"p0": np.zeros((2, 2, 2))}, "shape", "^p0 must"),
    ({"start": {"crank.force": 1.0}}, "wrong-name", None),
])
def test_what_is_refused(arguments, code, said):
    with refused(code, said):
        zd.ensemble(zd.models.four_bar(), 0.1, **({"step": 0.01} | arguments))


def test_what_a_grid_refuses():
    assert repr(zd.grid({"crank.mass": [1.0, 2.0]}, damping=[0.1, 0.2, 0.3])) == "<grid of 2 crank.mass x 3 damping>"
    with refused("missing-argument"):
        zd.grid()
    with refused("missing-argument"):
        zd.grid(a=1.0)
    with refused("duplicate-name", "'a'"):
        zd.grid({"a": [1]}, a=[2])
    with refused("wrong-type", "values"):
        zd.grid([1, 2])


def test_functions_that_make_no_systems():
    with refused("user-function", "not 3"):
        zd.ensemble(lambda: 3, 1.0, step=0.1)
    with refused("user-function", "1.0.*'mass'"):
        zd.ensemble(pendulum, 1.0, parameters={"mass": [1.0, 2.0]}, step=0.1)


def test_keys_that_are_none():
    ens = zd.ensemble(pendulum, 0.1, parameters={"gravity": [5.0, 10.0]}, step=0.01)
    with refused("wrong-index", "below 2"):
        _ = ens[2]
    with refused("wrong-type", "key of an ensemble must be"):
        _ = ens[0.5]
