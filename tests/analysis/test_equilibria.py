"""Paths of equilibria: the Von Mises truss through both of its limit points, in closed form."""

import numpy as np
import pytest

import zerodrift as zd
from covering import draws
from support import refused

B, HEIGHT, K = 1.0, 0.3, 1000.0
LENGTH = np.hypot(B, HEIGHT)


def truss(layout="joint"):
    """A load on an apex that is guided, between two springs."""
    m = zd.Mechanism("truss", parameters={"load": 0.0})
    apex = m.body("apex", 1.0, 1e-2, at=(0.0, HEIGHT))
    m.prismatic("rail", m.ground, apex, axis=(0, 1))
    m.spring("left", m.ground.point((-B, 0)), apex.point((0, 0)), stiffness=K, length=LENGTH)
    m.spring("right", m.ground.point((B, 0)), apex.point((0, 0)), stiffness=K, length=LENGTH)
    m.force("weight", apex, along=(0, -1), value=lambda load: load)
    return m.system(layout)


def load(y):
    """The load that holds the apex at a height."""
    return -2 * K * y * (1 - LENGTH / np.hypot(B, y))


CREST = np.sqrt((LENGTH * B**2)**(2 / 3) - B**2)        # d load / d y = 0


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_truss_snaps_through_both_limit_points(layout):
    top = 1.2 * load(CREST)
    path = zd.equilibria(truss(layout), "load", np.linspace(0.0, top, 5))
    assert [each.value for each in path.limit_points] == pytest.approx([load(CREST)], rel=1e-9)
    path = zd.equilibria(truss(layout), "load", np.linspace(-top, top, draws(6, 12)))
    assert [each.value for each in path.limit_points] == pytest.approx([load(CREST), load(-CREST)], rel=1e-9)
    y = path["apex.position.y"]
    assert load(y) == pytest.approx(path.values, abs=1e-8 * top)
    assert (np.diff(y) < 0).all()
    assert (path.stable == (np.abs(y) > CREST)).all()
    assert len(path) > draws(6, 12)        # the values between the limit points come three times
    assert "limit points at" in repr(path)


def test_wrong_arguments_are_refused():
    with refused("unknown-choice", "parameter"):
        zd.equilibria(truss(), "lode", [0.0, 1.0])
    with refused("not-increasing", "values"):
        zd.equilibria(truss(), "load", [0.0, 1.0, 0.5])
