"""Measures of many runs are read in one call of the core, and the system that has them is made when the first is read."""

import sys

import numpy as np
import pytest

import zerodrift as zd
from support import called
from tolerances import SAME
from zerodrift.systems.measure_values import find, view

KINDS = ("position", "velocity", "acceleration")
MODELS = {"plane": (zd.models.four_bar, "crank"), "space": (zd.models.delta_robot, "platform")}


def python_calls(function):
    calls = []
    sys.setprofile(lambda frame, event, argument: calls.append(frame.f_code.co_name) if event == "call" else None)
    try:
        function()
    finally:
        sys.setprofile(None)
    return len(calls)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("model", MODELS)
def test_values_are_those_of_each_run(model, kind):
    """Accelerations to the bit; a program of positions or velocities has its sums in another order."""
    make, body = MODELS[model]
    name, mechanism, error = f"{body}.{kind}", make(), SAME if kind in KINDS[:2] else 0
    runs = zd.ManyRuns(mechanism, runs=3, step=1e-3)
    one = zd.Run(mechanism, step=1e-3)
    for steps in (0, 7):
        runs.step(steps), one.step(steps)
        np.testing.assert_allclose(runs[name], np.tile(one[name], (3, 1)), rtol=error, atol=error)
        np.testing.assert_array_equal(runs[f"{name}.x"], runs[name][:, 0])


@pytest.mark.parametrize(("model", "layout"), [("quick_return", "joint"), ("quick_return", "absolute"), ("heavy_top", "joint"),
                                               ("double_cardan", "joint"), ("spatial_slider_crank", "joint")])
def test_programs_of_measures_are_the_tables(model, layout):
    """Against the tables that the core walks; the last of three runs is evaluated alone, and has the bits of the first."""
    system = getattr(zd.models, model)().system(layout)
    runs = zd.ManyRuns(system, runs=3, step=1e-3)
    runs.step(9)
    runs.reset(where=np.array([False, True, False]))
    runs.step(4)
    core = system._watching.core
    for number, measure in enumerate(core.measures):
        if core.measure_depends(number) == "accelerations":
            continue
        values, size = runs[measure.name].reshape(3, -1), np.abs(runs.p).max() + np.abs(runs.v).max()
        np.testing.assert_allclose(values, core.measure(number, runs.t, runs.p, runs.v), rtol=SAME, atol=SAME * size)
        assert np.array_equal(values[0], values[2])
        assert runs._by_program(system._watching.view(measure.name)) is not None


def test_runs_with_numbers_of_their_own_have_their_own_measures():
    runs = zd.ManyRuns(driven_by(1.0), runs=3, step=0.01, parameters={"arm.length": [1.0, 2.0, 3.0]})
    np.testing.assert_allclose(runs["arm.end.position"], [[1.0, 0.0], [2.0, 0.0], [3.0, 0.0]], atol=SAME)


def driven_by(law):
    m = zd.Mechanism("arm")
    arm = m.link("arm", (0, 0), (1, 0), mass=3.0)
    m.motor("drive", m.revolute("pin", m.ground, arm.start), torque=law)
    return m


def test_measures_that_need_functions_written_in_python_are_those_of_each_run():
    runs = zd.ManyRuns(driven_by(lambda t: 2.0 + t), runs=3, step=1e-3)
    for each, mask in enumerate(np.eye(3, dtype=bool)):
        runs.step(each)
        power = runs["pin.speed"] * (2.0 + runs.t)
        np.testing.assert_allclose(runs["drive.power"], power, rtol=1e-14)
        runs.reset(where=mask)


def test_an_exception_of_such_a_function_is_raised():
    @called
    def law(t):
        if asked:
            raise OverflowError("too late")
        return 2.0

    asked = []
    runs = zd.ManyRuns(driven_by(law), runs=2, step=1e-3)
    runs.step(1)
    asked.append(1)
    with pytest.raises(OverflowError, match="too late"):
        _ = runs["drive.power"]


@pytest.mark.parametrize("kind", KINDS[:2])
def test_calls_do_not_grow_with_the_runs(kind):
    counts = []
    for count in (2, 50):
        runs = zd.ManyRuns(zd.models.four_bar(), runs=count, step=1e-3)
        _ = runs[f"crank.{kind}"]
        counts.append(python_calls(lambda runs=runs: runs[f"crank.{kind}"]))
    assert counts[0] == counts[1]


def test_runs_that_read_nothing_make_no_measures():
    system = zd.models.four_bar().system()
    zd.simulate(system, 0.01, step=1e-3)
    run = zd.Run(system, step=1e-3)
    run.step(1)
    assert "_measuring" not in vars(system)
    assert np.all(np.isfinite(run["crank.position"]))
    assert "_measuring" in vars(system)


@pytest.mark.parametrize(("quantity", "value"), [("torque", 3.0), ("speed", 2.0)])
def test_a_reset_run_is_a_new_one(quantity, value):
    """A reset takes the memory of the run for its inputs, and leaves them as they were where the start is refused."""
    m = zd.Mechanism("arm")
    arm = m.link("arm", (0, 0), (1, 0), mass=3.0)
    m.motor("drive", m.revolute("pin", m.ground, arm.start), **{quantity: 1.0})
    name, settings = f"drive.{quantity}", {"step": 0.01, "runs": 2, "inputs": [f"drive.{quantity}"]}
    runs, new = zd.ManyRuns(m, **settings), zd.ManyRuns(m, **settings)
    runs[name] = value
    runs.step(9)
    with pytest.raises(zd.ZerodriftError):
        runs.reset(np.full(runs.p.shape[1], np.nan), where=np.array([True, False]))
    assert np.all(runs[name] == value)
    runs.step(2)
    runs.reset(where=np.array([True, False]))
    assert list(runs[name]) == [1.0, value]
    runs.step(7), new.step(7)
    assert np.array_equal(runs.p[0], new.p[0])
    assert np.array_equal(runs["pin.speed"][0], new["pin.speed"][0])


def test_a_name_is_found_without_a_search_of_all():
    """The last of many measures is looked up, and none is compared with it."""
    class Known(dict):
        def __iter__(self):
            raise AssertionError("all names are visited")

    known = Known({f"link{i}.angle": (i, 1) for i in range(9)} | {"body.rotation": (9, 9)})
    assert find("link8.angle", known).number == 8
    assert view("body.quaternion", known).number == 9
    assert find("nothing", known) is view("body.nothing", known) is None
