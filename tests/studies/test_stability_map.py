"""`zd.stability_map`: what its cells say is what the runs themselves say."""

import matplotlib
import numpy as np
import pytest

import zerodrift as zd
from support import SYSTEMS
from watched import pendulum
from zerodrift.studies.stability_map import WAYS

matplotlib.use("Agg")
from matplotlib import pyplot as plt

BAR = SYSTEMS["four_bar"]
STEPS, GAINS = (0.01, 0.02), (1.0, 10.0, 1000.0)


@pytest.fixture(scope="module")
def found():
    return zd.stability_map(BAR, 1.0, steps=STEPS, values=GAINS)


def test_cells_are_the_errors_of_the_runs():
    exact = zd.reference(BAR, 1.0, error=1e-10, t_eval=np.linspace(0, 1, 41))
    found = zd.stability_map(BAR, 1.0, steps=STEPS, values=GAINS, reference=exact)
    for row, gain in enumerate(GAINS):
        for column, step in enumerate(STEPS):
            sol = zd.simulate(BAR, 1.0, step=step, stabilization=zd.Baumgarte(gain, gain**2 / 4), on_failure="return")
            error = np.abs(sol(exact.solution.t)[0] - exact.solution.p).max() if sol.success else np.nan
            assert found.survived("Baumgarte")[row, column] == sol.success
            np.testing.assert_allclose(found.error("Baumgarte")[row, column], error, atol=2 * exact.error)


def test_a_gain_beyond_the_stability_limit_of_the_step_does_not_survive(found):
    """The double root -gain/2 of (23) times the step is -5 and -10; the limit of RK4 is -2.79."""
    assert not found.survived("Baumgarte")[2].any()
    assert found.survived("Baumgarte")[:2].all()
    assert np.isnan(found.error("Baumgarte")[2]).all()


def test_what_does_not_depend_on_the_parameter_is_run_once(found):
    assert len({id(line) for line in found.rows["projection"]}) == 1
    assert len({id(line) for line in found.rows["Baumgarte"]}) == len(GAINS)


def test_the_parameter_may_be_one_of_the_system():
    found = zd.stability_map(lambda mass: zd.systems.pendulum(mass=mass), 1.0, values=[1.0, 2.0], steps=[0.01],
                             parameter="mass [kg]", ways={"projection": {}})
    error = found.error("projection")
    assert error.shape == (2, 1)
    np.testing.assert_allclose(error[0], error[1], rtol=1e-3)       # the motion of a pendulum does not depend on its mass


def test_any_option_of_a_run_may_vary():
    methods = {4: "rk4", 8: "dop853"}
    exact = zd.reference(BAR, 0.5, error=1e-9)
    found = zd.stability_map(BAR, 0.5, steps=[0.01], values=methods, parameter="order", reference=exact,
                             ways={"mixed": lambda order: {"formulation": "mixed", "integrator": methods[order]}})
    assert found.error("mixed")[1, 0] < 1e-3 * found.error("mixed")[0, 0]
    assert found.rows["mixed"][1][0].setting.formulation == "mixed"


def test_the_defaults_reach_from_lost_to_accurate():
    found = zd.stability_map(BAR, 1.0)
    assert found.steps.size >= 5
    assert not found.survived("Baumgarte").all()
    assert np.nanmin(found.error("projection, energy")) < 1e-6
    assert "projection, energy" in repr(found)


def test_the_picture_crosses_out_what_failed(found):
    axes = zd.plot.stability_map(found)
    assert [ax.get_title() for ax in axes] == list(found.rows)
    for ax, way in zip(axes, found.rows, strict=True):
        assert len(ax.lines[0].get_xdata()) == (~found.survived(way)).sum()
        assert ax.collections[0].get_array().size == len(STEPS) * len(GAINS)
    figure, own = plt.subplots(1, 4)
    assert zd.plot.stability_map(found, own)[0].figure is figure


def test_one_step_and_negative_values_are_drawn_too():
    found = zd.stability_map(BAR, 0.2, steps=[0.01], values=[-1.0, 1.0], ways={"any": {}})
    assert zd.plot.stability_map(found)[0].get_yscale() == "linear"


def test_ctrl_c_keeps_the_ways_that_are_done():
    """It comes while runs go on in threads, each of which takes longer than the look at the keyboard."""
    def interrupt(part):
        raise KeyboardInterrupt

    with pytest.raises(zd.Interrupted, match=r"after \d of 4 ways") as caught:
        zd.stability_map(BAR, 0.2, steps=[1e-6], values=GAINS, reference=lambda t: np.zeros(3), progress=interrupt)
    rows = caught.value.solution.rows
    assert set(rows) < set(WAYS)
    assert all(len(lines) == len(GAINS) and all(len(line) == 1 for line in lines) for lines in rows.values())


def test_ctrl_c_between_runs_in_python_keeps_the_ways_that_are_done():
    """These go one after the other, in the order of the ways."""
    def interrupt(part):
        raise KeyboardInterrupt

    with pytest.raises(zd.Interrupted, match="after 1 of 4 ways") as caught:
        zd.stability_map(pendulum(), 0.05, steps=[0.01], values=GAINS, reference=lambda t: np.zeros(2), progress=interrupt)
    assert list(caught.value.solution.rows) == ["nothing"]


def test_progress_goes_from_nothing_to_all():
    parts = []
    zd.stability_map(BAR, 0.2, steps=STEPS, values=GAINS, progress=parts.append)
    assert parts == sorted(parts)
    assert parts[-1] == 1.0


@pytest.mark.parametrize(("wrong", "says"), [
    ({"steps": []}, "steps"), ({"steps": [-0.1]}, "steps"), ({"values": []}, "values"), ({"values": ["a"]}, "values"),
    ({"ways": {"x": {"step": 0.1}}}, "step"), ({"ways": {"x": {"formulation": "hamilton"}}}, "hamilton"),
    ({"ways": {"x": {"stabilization": 3}}}, "stabilization"),
])
def test_bad_input_is_named(wrong, says):
    with pytest.raises((ValueError, TypeError), match=says):
        zd.stability_map(BAR, 0.2, **({"steps": STEPS, "values": GAINS} | wrong))
