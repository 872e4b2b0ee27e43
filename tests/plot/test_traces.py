"""Pictures of traces."""

import matplotlib
import numpy as np
import pytest

import zerodrift as zd

matplotlib.use("Agg")
from matplotlib import pyplot as plt

from support import refused


@pytest.fixture(scope="module")
def bar():
    """A four-bar whose crank does not turn, through both dead points and back."""
    m = zd.linkage({"A": (0, 0), "B": (0.6, 0.8), "C": (2.2, 1.3), "D": (2.2, 0)},
                   {"ground": "AD", "crank": "AB", "coupler": "BC", "rocker": "DC"},
                   lengths={"AB": 1.0, "BC": 1.6, "CD": 1.3, "AD": 2.2}, mass=1.0)
    return zd.trace(m, "crank.angle", count=41)


def test_a_measure_over_the_traced_one_and_its_dead_points(bar):
    ax = zd.plot.trace(bar, "rocker.angle")
    ax.figure.canvas.draw()
    line, dead = ax.lines
    assert np.array_equal(line.get_xdata(), bar.values)
    assert np.array_equal(line.get_ydata(), bar["rocker.angle"])
    assert list(dead.get_xdata()) == [point.value for point in bar.dead_points]
    assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_legend()) == ("crank.angle [rad]", "rocker.angle [rad]", None)


def test_several_measures_in_degrees(bar):
    given = plt.figure().add_subplot()
    ax = zd.plot.trace(bar, ["rocker.angle", "C.position.x"], given, degrees=True, linewidth=3)
    assert ax is given
    assert np.array_equal(ax.lines[0].get_ydata(), np.degrees(bar["rocker.angle"]))
    assert np.array_equal(ax.lines[2].get_ydata(), bar["C.position.x"])
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("crank.angle [°]", "[°, m]")
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["rocker.angle", "C.position.x"]
    assert ax.lines[0].get_linewidth() == 3


def test_positions_and_paths(bar):
    given = plt.figure().add_subplot()
    ax = zd.plot.positions(bar, [0, 10, -1], given, path="C", names=True)
    ax.figure.canvas.draw()
    assert ax is given
    path = next(line for line in ax.lines if line.get_label() == "_path")
    assert np.array_equal(path.get_xydata(), bar["C.position"])
    ghosts = next(each for each in ax.collections if each.get_label() == "_ghosts")
    assert len(ghosts.get_segments()) == 2 * 3      # of three links
    assert any(text.get_text() == "coupler" for text in ax.texts)
    (low, high), (left, right) = ax.get_ylim(), ax.get_xlim()
    for (least, most), places in (((left, right), bar["C.position.x"]), ((low, high), bar["C.position.y"])):
        assert least < places.min() < places.max() < most
    ghosts = next(each for each in zd.plot.positions(bar).collections if each.get_label() == "_ghosts")
    assert len(ghosts.get_segments()) == 8 * 3


@pytest.mark.parametrize(("draw", "code", "said"), [
    (lambda trace: zd.plot.trace(trace, "C.position"), "wrong-measure", "plot.positions"),
    (lambda trace: zd.plot.trace(trace, "C.place"), "wrong-name", "'C.place'"),
    (lambda trace: zd.plot.trace(trace, [3]), "wrong-type", "each of names must be a measure"),
    (lambda trace: zd.plot.trace(trace.system, "C.angle"), "wrong-type", "traced.*zd.trace"),
    (lambda trace: zd.plot.positions(trace.system), "wrong-type", "traced"),
    (lambda trace: zd.plot.positions(trace, [0, 43]), "wrong-index", "^at must.*of 43"),
    (lambda trace: zd.plot.positions(trace, [0.5]), "wrong-type", "^at must"),
    (lambda trace: zd.plot.positions(trace, path="Q"), "wrong-name", r"Q.position"),
    (lambda trace: zd.plot.positions(trace, ax=3), "wrong-type", "^ax must"),
])
def test_what_cannot_be_drawn(bar, draw, code, said):
    with refused(code, said):
        draw(bar)
