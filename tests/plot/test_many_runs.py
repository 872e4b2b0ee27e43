"""Pictures of ensembles show their numbers, and say what they cannot show."""

import matplotlib
import numpy as np
import pytest

import zerodrift as zd
from zerodrift import plot

matplotlib.use("Agg")
from matplotlib import pyplot as plt

TIMES = np.linspace(0, 1, 201)


@pytest.fixture(scope="module")
def spread():
    return zd.ensemble(zd.systems.four_bar(), 1.0, parameters={"gravity": np.linspace(9, 10, 41)}, step=0.01, t_eval=TIMES)


@pytest.fixture(scope="module")
def gridded():
    """Over a grid in no order, where one run fails."""
    def largest(sol):
        if sol.system.parameters["mass"] == 3.0 and sol.system.parameters["stiffness"] == 10.0:
            raise ArithmeticError
        return sol["x"].max()

    return zd.ensemble(zd.systems.oscillator(), 2.0, parameters=zd.grid(mass=[3.0, 1.0, 2.0], stiffness=[20.0, 10.0]), step=0.01,
                       reduce=largest, outputs=["x"])


def test_bands_are_quantiles(spread):
    ax = plot.bands(spread, "alpha2", quantiles=(0.1, 0.5, 0.9))
    ax.figure.canvas.draw()
    (line,), (area,) = ax.lines, ax.collections
    np.testing.assert_allclose(line.get_ydata(), np.median(spread["alpha2"], axis=0), rtol=1e-14)     # another interpolation
    corners = area.get_paths()[0].vertices
    assert corners[:, 1].max() == pytest.approx(np.quantile(spread["alpha2"], 0.9, axis=0).max())
    assert corners[:, 1].min() == pytest.approx(np.quantile(spread["alpha2"], 0.1, axis=0).min())
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["10 ... 90 %", "median"]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("t [s]", "alpha2 [rad]")
    assert not plot.bands(spread, "alpha2", quantiles=(0.0, 1.0), color="red", label="all").lines


def test_bands_are_of_the_runs_that_have_rows():
    system, times = zd.systems.four_bar(), np.linspace(0, 8, 41)
    ens = zd.ensemble(system, 8.0, parameters={"crank_rate": [1.0, 1.1]}, step=0.05, stabilization=None, t_eval=times)
    assert ens.failed.all()
    (line,) = plot.bands(ens, "alpha1", quantiles=[0.5]).lines
    assert np.isnan(line.get_ydata()).tolist() == np.isnan(ens["alpha1"]).all(axis=0).tolist()
    assert np.isnan(line.get_ydata()).any()


def test_outputs_against_parameters(spread, gridded):
    points = plot.against(spread, "gravity", "alpha2", at=0.5).collections[0].get_offsets()
    assert np.array_equal(points, np.column_stack([spread.parameters["gravity"], spread["alpha2"][:, 100]]))
    ax = plot.against(spread, "gravity", spread["alpha2"].max(axis=1), label="largest alpha2 [rad]", marker="s")
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("gravity [m/s^2]", "largest alpha2 [rad]")
    ax = plot.against(gridded, "mass", color_by="stiffness")
    ax.figure.canvas.draw()
    assert ax.lines[0].get_xdata().tolist() == [3.0]        # which failed
    assert np.array_equal(ax.collections[0].get_array(), np.delete(gridded.parameters["stiffness"], 1))
    assert ax.figure.axes[1].get_ylabel() == "stiffness [N/m]"
    ends = plot.against(gridded, "mass", "x")
    assert ends.get_ylabel() == "x [m] at the end"
    assert np.array_equal(ends.collections[0].get_offsets()[:, 1], np.delete(gridded["x"][:, -1], 1))


def test_a_heat_map_has_its_parameters_in_order(gridded):
    ax = plt.figure().subplots()
    assert plot.heat_map(gridded, ax=ax, label="largest x [m]") is ax
    ax.figure.canvas.draw()
    cells = ax.collections[0].get_array()
    assert np.array_equal(cells.filled(np.nan), gridded.values.reshape(3, 2)[[1, 2, 0]][:, [1, 0]].T, equal_nan=True)
    assert [line.get_xydata().tolist() for line in ax.lines] == [[[3.0, 10.0]]]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("mass [kg]", "stiffness [N/m]")
    assert ax.figure.axes[1].get_ylabel() == "largest x [m]"
    plot.heat_map(zd.ensemble(zd.systems.oscillator(), 1.0, parameters=zd.grid(mass=[1.0], stiffness=[1.0]), step=0.1), "x")


def test_what_cannot_be_drawn(spread, gridded):
    vectors = zd.ensemble(zd.models.four_bar(), 0.1, step=0.05, outputs=["C.force"], start={"crank.angle": [0.5, 1.0]})
    assert plot.bands(vectors, "C.force.x").get_ylabel() == "C.force.x [N]"
    free = zd.ensemble(zd.systems.pendulum(), 1.0, parameters={"gravity": [5.0, 10.0]}, integrator="dop853",
                       reduce=lambda sol: "text", outputs=["x"])
    assert plot.against(free, "gravity", "x").collections
    lengths = np.arange(6.0).reshape(2, 3) + 1
    several = zd.ensemble(lambda lengths: zd.systems.oscillator(), 0.1, parameters={"lengths": lengths}, step=0.1)
    for draw, error, said in [
            (lambda: plot.bands(vectors, "C.force"), ValueError, "C.force is a vector, .* 'C.force.x'"),
            (lambda: plot.bands(free, "x"), ValueError, "bands are over times that all runs have"),
            (lambda: plot.bands(spread, "alpha2", quantiles=[0.5, 0.1]), ValueError, "quantiles must increase"),
            (lambda: plot.bands(spread, "alpha2", quantiles=[0.5, 1.1]), ValueError, "quantiles must increase"),
            (lambda: plot.bands(spread, "alpha9"), KeyError, "no output is called 'alpha9'"),
            (lambda: plot.bands(spread[0], "alpha2"), TypeError, "ens must be what zd.ensemble returns"),
            (lambda: plot.against(spread, "weight", "alpha2"), ValueError, "parameter must be one of 'gravity'"),
            (lambda: plot.against(spread, "gravity", "alpha2", at=0.123), ValueError, "at must be one of the times"),
            (lambda: plot.against(free, "gravity", "x", at=0.5), ValueError, "at must be one of the times"),
            (lambda: plot.against(free, "gravity"), ValueError, "what reduce returned, .* a number for each of 2 runs"),
            (lambda: plot.against(free, "gravity", [1.0]), ValueError, "of, .* must be a number for each of 2 runs"),
            (lambda: plot.against(several, "lengths", [1.0, 2.0]), ValueError, "'lengths' has several entries"),
            (lambda: plot.heat_map(spread, "alpha2"), ValueError, r"over zd.grid\(...\) of two parameters")]:
        with pytest.raises(error, match=said):
            draw()
