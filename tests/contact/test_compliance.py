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


RADIUS, LOW, HIGH = 0.5, 0.3, 2.5       # of an arc


def on_segment(place):
    """Its point (2,) that is nearest."""
    return np.array([min(max(place[0], 0), 1), 0])


def on_arc(place):
    middle = (LOW + HIGH) / 2
    off = (np.arctan2(place[1], place[0]) - middle + np.pi) % (2 * np.pi) - np.pi
    return at(middle + min(max(off, LOW - middle), HIGH - middle))


def at(angle):
    return RADIUS * np.array([np.cos(angle), np.sin(angle)])


SHAPES = {"segment": (on_segment, lambda body: body.segment((0, 0), (1, 0))),
          "arc": (on_arc, lambda body: body.arc((0, 0), at(LOW), at(HIGH))),
          "hole": (on_arc, lambda body: body.arc((0, 0), at(LOW), at(HIGH), outside=False))}


@pytest.mark.parametrize(("shape", "start", "speed"), [
    ("segment", (1.05, 0.3), (0, 0)), ("segment", (0.97, 0.3), (0.3, 0)), ("segment", (-0.3, -0.02), (2, 3)),
    ("segment", (0.5, -0.3), (0.5, 3)), ("arc", (0.1, 0.8), (0.3, 0)), ("arc", (0.46, 0.5), (0, 0)), ("hole", (0, 0), (1.5, 2))])
def test_the_nearest_point_of_a_bounded_shape_pushes(shape, start, speed, tmp_path):
    """Over its ends, on both sides, as a program of its own has it."""
    nearest, made = SHAPES[shape]
    law = {"stiffness": 2e3, "damping": 0.1, "exponent": 1.5}
    m = zd.Mechanism("ball", gravity=(0, -G))
    ball = m.body("ball", 1.0, 0.01, at=start)
    m.contact("edge", ball, made(m.ground), radius=0.1, **law)
    m.start({ball.velocity: speed})
    sol = zd.simulate(zd.load(m.save(tmp_path / "m.json")), 0.6, **FINE)

    def rates(t, y):
        away = y[:2] - nearest(y[:2])
        along = away / np.hypot(*away)
        return [*y[2:], *(push(0.1 - np.hypot(*away), -along @ y[2:], **law) * along - [0, G])]
    found = solve_ivp(rates, (0, 0.6), [*start, *speed], rtol=1e-10, atol=1e-12, max_step=5e-3).y[:, -1]
    assert [*sol["ball.position"][-1], *sol["ball.velocity"][-1]] == pytest.approx(found, abs=1e-6)
    assert np.abs(sol["edge.force"]).max() > 5
    assert np.abs(sol.energy_violation).max() < 1e-9


@pytest.mark.parametrize("stiffness", [1e3, 1e4, 1e5])
def test_vibrations_on_a_stiff_floor_that_is_hardly_pressed(stiffness):
    """The depth at rest, G / stiffness, is much less than the length of the segment."""
    m = zd.Mechanism("ball", gravity=(0, -G))
    ball = m.body("ball", 1.0, 0.01, at=(0.5, 0.08))
    m.contact("floor", ball, m.ground.segment((0, 0), (1, 0)), radius=0.1, stiffness=stiffness)
    found = zd.linearize(m, zd.equilibrium(m)).frequencies
    assert found == pytest.approx(np.full(2, np.sqrt(stiffness) / (2 * np.pi)), rel=1e-6)


@pytest.mark.parametrize(("given", "words"), [({"restitution": 0.5}, "no restitution"), ({"friction": 0.5}, "no friction"),
                                              ({"stiffness": None, "damping": 0.5}, "must be given with stiffness="),
                                              ({"exponent": 0.5}, "exponent of 'c'"), ({"damping": -1.0}, "damping of 'c'")])
def test_what_does_not_go_together_is_refused(given, words):
    m = zd.Mechanism("m")
    with pytest.raises((ValueError, TypeError), match=words):
        m.contact("c", m.particle("p", 1.0, at=(0, 1)), m.ground.line((0, 0), (1, 0)), **{"stiffness": 1e4, **given})
    with pytest.raises(TypeError, match="radius= for a shape with ends"):
        m.contact("c", m["p"], m.ground.segment((0, 0), (1, 0)), stiffness=1e4)
