"""Springs and actuators between points that coincide: an anchor of free length zero has a force, all others have no direction."""

import numpy as np
import pytest

import zerodrift as zd
from support import assert_close, refused

WAYS = [(2, "joint", False), (2, "absolute", False), (2, "joint", True), (3, "joint", False), (3, "absolute", False)]


def anchored(dimension, at=0.0, **given):
    """A particle of 1 kg in a gravity of 1 m/s^2 along -y, `at` above the point where a spring of 1 N/m is anchored."""
    m = zd.Mechanism("anchor", dimension=dimension, gravity=(0, -1, 0)[:dimension])
    particle = m.particle("particle", 1.0, at=(0, at, 0)[:dimension])
    m.spring("rope", m.ground.point((0,) * dimension), particle, stiffness=1.0, **given)
    return m


@pytest.mark.parametrize(("dimension", "layout", "compiled"), WAYS)
@pytest.mark.parametrize("at", [0.0, -2.0])
def test_a_spring_of_free_length_zero_swings_through_its_anchor(dimension, layout, compiled, at):
    """Oscillation y'' = -1 - y, from the anchor and from below, where it comes back to it."""
    sol = zd.simulate(anchored(dimension, at, length=0.0).system(layout, compiled=compiled), 7.0, step=0.01)
    assert_close(sol["particle.position"][:, 1], -1 + (at + 1) * np.cos(sol.t), 1e-8)
    assert_close(sol["rope.force"], np.abs(sol["particle.position"][:, 1]), 1e-12)


@pytest.mark.parametrize(("dimension", "layout", "compiled"), WAYS)
def test_a_force_without_a_direction_is_refused_by_name(dimension, layout, compiled):
    for given in ({"length": 0.5}, {"length": 0.0, "damping": 1.0}):
        with refused("geometry", "'rope'.*bushing"):
            zd.simulate(anchored(dimension, **given).system(layout, compiled=compiled), 0.1)
    m = anchored(dimension, length=0.0)
    m.actuator("jack", m.ground.point((0,) * dimension), m["particle"], force=1.0)
    with refused("geometry", "'jack'"):
        zd.simulate(m.system(layout, compiled=compiled), 0.1)
    m.start({"particle.position.x": 0.1})       # not as drawn
    assert zd.simulate(m.system(layout, compiled=compiled), 0.1, step=0.01)["jack.force"][0] == 1.0


@pytest.mark.parametrize("dimension", [2, 3])
def test_terms_between_coincident_points_are_finite(dimension):
    """A motion may bring them together; no force acts there."""
    system = anchored(dimension, 1.0, length=0.5, damping=1.0).system("absolute")
    terms = system.evaluate(np.zeros(dimension), np.ones(dimension))
    assert_close(terms.f, np.array([0.0, -1.0, 0.0][:dimension]), 0.0)
