"""Many open runs: each has the bits that it has alone, fails alone and is reset alone."""

import numpy as np
import pytest

import zerodrift as zd
from few_bodies import cart_pole, driven_four_bar
from support import refused
from zerodrift._private import gateway


@pytest.mark.parametrize("compiled", [False, True])
@pytest.mark.parametrize("runs", [3, 150])
def test_each_run_has_the_bits_that_it_has_alone(compiled, runs):
    """150 runs are advanced in several parts, by threads."""
    system, force = cart_pole().system(compiled=compiled), np.random.default_rng(1).uniform(-10, 10, (10, runs))
    p0 = np.random.default_rng(2).uniform(-0.1, 0.1, (runs, 2))
    many = zd.ManyRuns(system, p0, runs=runs, step=0.02, inputs=["drive.force"])
    before = many["hinge.force"]
    for values in force:
        many["drive.force"] = values
        many.step(3)
    for i in (0, runs // 2, runs - 1):
        one = zd.Run(system, p0[i], step=0.02, inputs=["drive.force"])
        for value in force[:, i]:
            one["drive.force"] = value
            one.step(3)
        assert np.array_equal(many.p[i], one.p)
        assert np.array_equal(many.v[i], one.v)
        assert many.t[i] == one.t
        assert many["hinge.force"][i].tolist() == pytest.approx(one["hinge.force"].tolist(), rel=1e-12)
        assert not np.array_equal(many["hinge.force"][i], before[i])


def test_parameters_differ_between_runs():
    masses = np.array([0.1, 0.2, 0.4])
    many = zd.ManyRuns(cart_pole().system(compiled=True), runs=3, step=0.01, parameters={"pole.mass": masses},
                       inputs=["drive.force"])
    many["drive.force"] = 1.0
    many.step(50)
    for i, mass in enumerate(masses):
        one = zd.Run(cart_pole().system(compiled=True).with_parameters({"pole.mass": mass}), step=0.01, inputs=["drive.force"])
        one["drive.force"] = 1.0
        one.step(50)
        assert np.array_equal(many.p[i], one.p)
    with refused("shape", "have 3"):
        zd.ManyRuns(cart_pole(), runs=3, step=0.01, parameters={"pole.mass": [1.0, 2.0]})


def test_runs_are_reset_by_a_mask():
    many = zd.ManyRuns(cart_pole(), runs=4, step=0.01, inputs=["drive.force"])
    many["drive.force"] = [1.0, 2.0, 3.0, 4.0]
    many.step(10)
    p = many.p
    many.reset(where=np.array([False, True, False, True]))
    assert many.t.tolist() == pytest.approx([0.1, 0.0, 0.1, 0.0])
    assert many["drive.force"].tolist() == [1.0, 0.0, 3.0, 0.0]
    assert np.array_equal(many.p[[0, 2]], p[[0, 2]])
    many["drive.force"] = [1.0, 2.0, 3.0, 4.0]
    many.step(10)
    assert np.array_equal(many.p[[1, 3]], p[[1, 3]])
    many.reset(p0=[[0.5, 0.0]], where=np.array([True, False, False, False]))
    assert many.p[0].tolist() == [0.5, 0.0]
    with refused("shape", "where.*be 4"):
        many.reset(where=[True])
    with refused("shape", "^p0 must.*2.*4, 2"):
        many.reset(p0=[1.0])


def test_a_run_that_fails_stays_and_the_others_go_on():
    many = zd.ManyRuns(cart_pole(), runs=3, step=0.01, inputs={"drive.force": (-10.0, 10.0)})
    many["drive.force"] = [1.0, 11.0, np.nan]
    many.step(5)
    assert many.failed.tolist() == [False, True, True]
    assert many.t.tolist() == pytest.approx([0.05, 0.0, 0.0])
    assert "between -10 and 10, not 11" in many.messages[1]
    assert "must be finite" in many.messages[2]
    assert "2 failed" in repr(many)
    many.reset(where=many.failed)
    many.step(5)
    assert not many.failed.any()
    assert many.t.tolist() == pytest.approx([0.1, 0.05, 0.05])


def test_systems_in_python_can_be_many():
    system = zd.System(["x"], mass=np.eye(1), force=lambda u: u, parameters={"u": np.zeros(1)}, p0=[0.0])
    many = zd.ManyRuns(system, runs=3, step=0.1, inputs=["u[0]"])
    many["u[0]"] = [0.0, 1.0, 2.0]
    many.advance_to(1.0)
    assert np.allclose(many.p[:, 0], [0.0, 0.5, 1.0], rtol=1e-12)


def test_wrong_arguments_of_many_runs_are_refused():
    with refused("wrong-name", "no setting 'parameters'"):
        zd.Run(cart_pole(), step=0.01, parameters={"pole.mass": 1.0})
    with refused("out-of-range", "^runs must.*between 1"):
        zd.ManyRuns(cart_pole(), runs=0, step=0.01)
    many = zd.ManyRuns(cart_pole(), runs=2, step=0.01)
    with refused("wrong-name"):
        many["drive.force"] = 1.0


# ---- SIMD lanes ----


class Pair:
    """Many runs, and the same ones alone: whatever is done to both, they have the same bits."""

    def __init__(self, system, count, **settings):
        self.many = zd.ManyRuns(system, runs=count, **settings)
        self.alone = [zd.Run(system, **settings) for _ in range(count)]
        self.dead = set()

    def set(self, name, values):
        self.many[name] = values
        for run, value in zip(self.alone, values, strict=True):
            run[name] = value

    def step(self, steps):
        self.many.step(steps)
        for i, run in enumerate(self.alone):
            if i not in self.dead:
                try:
                    run.step(steps)
                except zd.ZerodriftError:
                    self.dead.add(i)
        assert set(np.flatnonzero(self.many.failed).tolist()) == self.dead
        assert np.array_equal(self.many.t, [run.t for run in self.alone])
        assert np.array_equal(self.many.p, [run.p for run in self.alone])
        assert np.array_equal(self.many.v, [run.v for run in self.alone])

    def reset(self, where):
        self.many.reset(where=where)
        for i in np.flatnonzero(where).tolist():
            self.alone[i].reset()
            self.dead.discard(i)

    def save(self):
        return self.many.save(), [run.save() for run in self.alone]

    def restore(self, states, where):
        self.many.restore([states[0][i] for i in np.flatnonzero(where)], where=where)
        for i in np.flatnonzero(where).tolist():
            self.alone[i].restore(states[1][i])


CASES = {       # system, input and its range, step; the third one leaves the closed form in one of ten steps, and may fail
    "cart-pole": (lambda: cart_pole().system(compiled=True), "drive.force", 10.0, 0.02),
    "crank": (lambda: driven_four_bar(torque=0.0).system(compiled=True), "drive.torque", 10.0, 0.005),
    "violent crank": (lambda: driven_four_bar(torque=0.0).system(compiled=True), "drive.torque", 60.0, 0.03),
    "built in": (zd.systems.four_bar, None, 0.0, 0.01),
}


@pytest.mark.parametrize("vector", ["baseline", None])
@pytest.mark.parametrize("case", CASES)
def test_runs_in_lanes_have_the_bits_that_they_have_alone(case, vector):
    """Inputs jump, runs are saved, restored and reset, in any order; 18 runs fill no number of lanes."""
    make, name, largest, step = CASES[case]
    rng, settings = np.random.default_rng(4), {"inputs": [name]} if name else {}
    pair = Pair(make(), 18, step=step, vector=vector, **settings)
    unit = pair.many.settings["vector"]
    assert all(map(bool, pair.many._core.lanes)) == gateway.has_lanes(unit)
    states = pair.save()
    for action in ("step", "save", "step", "reset", "step", "restore", "step", "save", "restore", "step", "reset", "step"):
        where = (rng.random(18) < 0.4) & [i not in pair.dead for i in range(18)]
        if action == "save":
            states = pair.save()
        elif action == "restore":
            pair.restore(states, where)
        elif action == "reset":
            pair.reset(where)
        for _ in range(5 if action == "step" else 0):
            if name and rng.random() < 0.7:
                pair.set(name, rng.uniform(-largest, largest, 18))
            pair.step(int(rng.integers(1, 12)))
    for i, run in enumerate(pair.alone):
        ours, its = pair.many._core[i].results().statistics, run._core.results().statistics
        assert (ours.steps, ours.closed_form_steps) == (its.steps, its.closed_form_steps)


def test_constants_that_follow_from_inputs_are_computed_for_each_lane():
    sp = pytest.importorskip("sympy")
    x, v, u, k = sp.symbols("x v u k")
    system = zd.symbolic([x], speeds=[v], kinetic=v**2 / 2, potential=0, force=[sp.sqrt(k * u + 2) * sp.cos(x)], inputs=[u],
                         parameters={k: 2.0}, p0=[0.0])
    pair = Pair(system, 16, step=0.01, inputs=["u"])
    for offset in (0.0, 5.0):
        pair.set("u", offset + np.arange(16.0))
        pair.step(20)
    assert len(np.unique(pair.many.p)) == 16


@pytest.mark.parametrize("how", ["reset", "restore"])
def test_runs_in_lanes_keep_their_states_while_others_are_put_back(how):
    many = zd.ManyRuns(cart_pole().system(compiled=True), runs=16, step=0.02, inputs=["drive.force"])
    first, where = many.save(), np.arange(16) % 3 == 0
    many["drive.force"] = np.arange(16.0)
    many.step(5)
    p, v = many.p, many.v
    many.reset(where=where) if how == "reset" else many.restore(first[0], where=where)
    assert many.t.tolist() == np.where(where, 0.0, 5 * 0.02).tolist()
    assert np.array_equal(many.p[~where], p[~where])
    assert np.array_equal(many.v[~where], v[~where])


def test_a_state_from_a_lane_continues_in_one_run():
    system = cart_pole().system(compiled=True)
    many = zd.ManyRuns(system, runs=16, step=0.02, inputs=["drive.force"])
    many["drive.force"] = np.linspace(-1.0, 1.0, 16)
    many.step(7)
    one = zd.Run(system, step=0.02, inputs=["drive.force"])
    one.restore(many.save()[15])
    many.step(50)
    one.step(50)
    assert np.array_equal(one.p, many.p[15])
    assert one["hinge.force"].tolist() == many["hinge.force"][15].tolist()


def test_lanes_reach_times_between_steps_and_go_on():
    pair = Pair(cart_pole().system(compiled=True), 16, step=0.02, inputs=["drive.force"])
    pair.set("drive.force", np.linspace(-1.0, 1.0, 16))
    for t in (0.1, 0.205, 0.3):
        pair.many.advance_to(t)
        for run in pair.alone:
            run.advance_to(t)
        assert pair.many.t.tolist() == [run.t for run in pair.alone]
        pair.step(3)
    pair.reset(np.ones(16, dtype=bool))
    pair.step(3)


def test_a_run_in_a_lane_with_a_refused_input_stays_and_the_others_go_on():
    many = zd.ManyRuns(cart_pole().system(compiled=True), runs=16, step=0.01, inputs={"drive.force": (-10.0, 10.0)})
    many.step(2)
    many["drive.force"] = [11.0, np.nan, *[1.0] * 14]
    many.step(5)
    assert many.failed.tolist() == [True, True, *[False] * 14]
    assert many.t.tolist() == pytest.approx([0.02, 0.02, *[0.07] * 14])
    assert "between -10 and 10, not 11" in many.messages[0]
    assert "must be finite" in many.messages[1]
    many.reset(where=many.failed)
    many.step(1)
    assert many.t.tolist() == pytest.approx([0.01, 0.01, *[0.08] * 14])
