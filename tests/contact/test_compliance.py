"""Compliant contacts and stops, against SciPy and closed forms."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import zerodrift as zd

G = 9.81
FINE = {"rtol": 1e-10, "atol": 1e-12}


def push(depth, rate, stiffness, damping, exponent):
    """Force after Hunt and Crossley, written anew."""
    return 0.0 if depth < 0 else max(0.0, stiffness * depth**exponent * (1 + damping * rate))


def test_a_ball_on_an_elastic_floor_goes_as_deep_as_its_energy():
    m = zd.Mechanism("ball", gravity=(0, -G))
    ball = m.particle("ball", 1.0, at=(0, 1))
    m.contact("floor", ball, m.ground.line((0, 0), (1, 0)), stiffness=1e4)
    turns = zd.Event(ball.velocity.y, direction=1)
    sol = zd.simulate(m, 1.0, events=[turns], **FINE)
    depth = (G + np.sqrt(G**2 + 2e4 * G)) / 1e4
    (t,), = sol.t_events
    assert sol(t)[0][1] == pytest.approx(-depth, rel=1e-9)
    assert np.abs(sol.energy_violation).max() < 1e-9


@pytest.mark.parametrize("how", ["interpreted", "compiled"])
def test_a_damped_stop_is_that_of_scipy(how, tmp_path):
    law = {"stiffness": 1e4, "damping": 0.3, "exponent": 1.5}
    m = zd.Mechanism("slider")
    slide = m.prismatic("slide", m.ground, m.body("block", 2.0, 0.1), axis=(1, 0))
    m.stop("buffer", slide.displacement, lower=-0.1, upper=0.1, **law)
    m.start({slide.speed: 1.0})
    system = zd.load(m.save(tmp_path / "m.json")).system(compiled=how == "compiled")
    sol = zd.simulate(system, 1.0, **FINE)
    found = solve_ivp(lambda t, y: [y[1], (push(-0.1 - y[0], -y[1], **law) - push(y[0] - 0.1, y[1], **law)) / 2], (0, 1), [0, 1],
                      rtol=1e-11, atol=1e-13, max_step=0.01).y[:, -1]
    assert [sol["slide.displacement"][-1], sol["slide.speed"][-1]] == pytest.approx(found, abs=1e-7)
    assert sol["buffer.force"].min() < -50 < 50 < sol["buffer.force"].max()
    assert np.abs(sol.energy_violation).max() < 1e-8


def test_round_bodies_push_each_other_apart_and_a_hole_holds_one():
    m = zd.Mechanism("balls")
    one, two = (m.body(name, mass, 0.01, at=(x, 0)) for name, mass, x in (("one", 1.0, 0.0), ("two", 2.0, 0.5)))
    m.contact("touch", one, two.circle((0.5, 0), 0.1), radius=0.1, stiffness=1e4)
    m.contact("hole", two, m.ground.circle((0, 0), 2.0, outside=False), radius=0.1, stiffness=1e4)
    m.start({one.velocity.x: 1.0})
    sol = zd.simulate(m, 1.0, **FINE)
    assert [sol[f"{name}.velocity.x"][-1] for name in ("one", "two")] == pytest.approx([-1 / 3, 2 / 3], abs=1e-8)
    sol = zd.simulate(m, 5.0, **FINE)
    assert sol["two.position.x"].max() == pytest.approx(1.9 + 2 / 3 * np.sqrt(2 / 1e4), abs=1e-4)
    assert sol["hole.force"][:, 0].min() < 0


@pytest.mark.parametrize(("given", "words"), [({"restitution": 0.5}, "no restitution"), ({"friction": 0.5}, "no friction"),
                                              ({"exponent": 0.5}, "exponent of 'c'"), ({"damping": -1.0}, "damping of 'c'")])
def test_what_does_not_go_together_is_refused(given, words):
    m = zd.Mechanism("m")
    with pytest.raises((ValueError, TypeError), match=words):
        m.contact("c", m.particle("p", 1.0, at=(0, 1)), m.ground.line((0, 0), (1, 0)), **{"stiffness": 1e4, **given})
