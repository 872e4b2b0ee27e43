"""Samples between few adaptive steps: curves and drawings of them are those of the motion, not of a polygon."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import zerodrift as zd
from zerodrift.player.scene import Wanted, scene
from zerodrift.runs.dense_samples import FEW_SAMPLES, dense


@pytest.fixture(scope="module")
def sol():
    """A slider-crank in a few steps."""
    found = zd.simulate(zd.models.slider_crank(), 3.0)
    assert len(found.t) < 20
    return found


def test_its_samples_are_among_them_and_the_others_are_as_fine_steps_give_them(sol):
    found = dense(sol)
    assert len(found.t) >= FEW_SAMPLES
    rows = np.searchsorted(found.t, sol.t)
    assert (found.t[rows] == sol.t).all()
    assert (found.p[rows] == sol.p).all()
    fine = zd.simulate(sol.system, 3.0, t_eval=found.t, rtol=1e-10, atol=1e-12)
    assert abs(found["crank.angle"] - fine["crank.angle"]).max() < 1e-5      # the tolerances of the run are 1e-6 a step
    straight = np.interp(found.t, sol.t, sol["slide.force"][:, 1])
    force = fine["slide.force"][:, 1]
    assert abs(found["slide.force"][:, 1] - force).max() < 0.01 * abs(straight - force).max()
    assert dense(sol) is found


@pytest.mark.parametrize("given", [
    {"step": 0.01}, {"save_every": 2}, {"t_eval": [0.0, 0.5, 1.0]}, {"rtol": 1e-9, "max_step": 0.002}],
    ids=["fixed", "some", "times", "many"])
def test_samples_that_were_chosen_or_are_many_stay(given):
    found = zd.simulate(zd.systems.pendulum(), 1.0, **given)
    assert dense(found) is found


def test_a_run_that_another_would_be_stays():
    """A callable that counts its calls: the run cannot be repeated."""
    calls = iter(range(10**9))
    system = zd.System(1, mass=np.eye(1), force=lambda p, v: np.array([next(calls) * 1e-3]))
    found = zd.simulate(system, 1.0, [0.0], [0.0])
    assert dense(found) is found


def vertices(ax):
    """All vertices of a drawing, (n, 2)."""
    return np.concatenate([path.vertices for each in ax.collections for path in each.get_paths()])


def test_lines_and_drawings_take_them(sol):
    lines = [*zd.plot.measures(sol, ["slide.force", "crank.angle"]).lines, *zd.plot.motion(sol).lines,
             *zd.plot.path(sol, "rod").lines]
    assert min(len(line.get_xdata()) for line in lines) >= FEW_SAMPLES
    assert len(zd.plot.measures(sol, "crank.angle", marker="o").lines[0].get_xdata()) == len(sol.t)
    plt.close("all")
    time = 1.2345
    shown, there = (vertices(zd.plot.mechanism(sol, ghosts=0, **at)) for at in ({"t": time}, {"p": sol(time)[0]}))
    assert shown.shape == there.shape
    assert abs(shown - there).max() < 3.0 / FEW_SAMPLES      # its speeds are some m/s


def test_graphs_of_a_film_take_them(sol):
    film = scene([sol], [""], Wanted(graphs=["slide.force"]))
    most = dense(sol)["slide.force"].max()
    assert film["graphs"][1]["most"] == most > 1.01 * sol["slide.force"].max()
