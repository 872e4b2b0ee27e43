"""Contacts with segments, arcs and circles against closed forms."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import zerodrift as zd

G, R, BALL = 9.81, 1.0, 0.1
FINE = {"rtol": 1e-10, "atol": 1e-12}


def disc(m, at, name="disc", radius=BALL):
    return m.body(name, 1.0, 0.5 * radius**2, at=at)


def on_table(friction=0.0, radius=BALL, speed=0.05):
    """A disc or a point on a table that ends at the origin."""
    m = zd.Mechanism("table", gravity=(0, -G))
    body = disc(m, (-0.01, radius))
    m.contact("table", body, m.ground.segment((-1, 0), (0, 0)), radius=radius, friction=friction)
    m.start({body.velocity.x: speed, body.angular_velocity: -speed / radius if radius and friction else 0.0})
    return m


def test_a_point_passes_beside_the_end_of_a_segment():
    sol = zd.simulate(on_table(radius=0.0), 1.0, **FINE)
    assert [phase.state["table left"] for phase in sol.phases] == ["closed", "open"]
    assert sol.phases[1].t0 == pytest.approx(0.2, abs=1e-13)
    assert sol["disc.position"][-1] == pytest.approx([0.04, -G * 0.8**2 / 2], abs=1e-12)


def test_a_disc_slides_around_the_end_of_a_segment_until_it_flies():
    """As a particle on a circle of its radius: m g cos = m v^2 / r, with v^2 = v0^2 + 2 g r (1 - cos)."""
    sol = zd.simulate(on_table(), 1.0, **FINE)
    end = next(phase for phase in sol.phases if phase.state["table end"] == "closed")
    height = sol["disc.position"][np.searchsorted(sol.t, end.t1), 1] / BALL
    assert end.t0 == pytest.approx(0.2, abs=1e-12)
    assert height == pytest.approx(2 / 3 + 0.05**2 / (3 * G * BALL), abs=1e-9)
    assert np.abs(sol.energy_violation).max() < 1e-9


def test_a_disc_rolls_over_the_end_of_a_segment_without_loss():
    sol = zd.simulate(on_table(friction=0.9), 0.6, **FINE)
    sticking = [[name for name, word in phase.state.items() if word == "sticking"] for phase in sol.phases]
    assert sticking == [["table left"], ["table end"]]
    assert np.abs(sol.energy_violation).max() < 1e-10
    angle = np.pi / 2 - np.arctan2(*reversed(sol["disc.position"][-1]))
    assert sol["disc.angle"][-1] == pytest.approx(-0.01 / BALL - angle, abs=1e-9)


def test_a_segment_has_two_sides():
    m = zd.Mechanism("two sides", gravity=(0, G))
    for name, y in (("above", -1.0), ("below", 1.0)):
        m.contact(f"on {name}", m.particle(name, 1.0, at=(0.2, y)), m.ground.segment((-1, 0), (1, 0)), restitution=0.5)
    sol = zd.simulate(m, 0.6)
    assert {name: round(t, 12) for t, name, *_ in sol.impacts} == {"on above right": round(np.sqrt(2 / G), 12)}
    assert sol["above.position.y"].max() <= 1e-9
    assert sol["below.position.y"][-1] == pytest.approx(1 + G * 0.18)


def test_a_disc_rolls_in_a_bowl_as_a_pendulum():
    """(R - r) phi'' = -2/3 g sin phi, and the disc turns by -(R - r) / r times its angle in the bowl."""
    m, start = zd.Mechanism("bowl", gravity=(0, -G)), 0.3
    ends = [R * np.array([np.sin(each), -np.cos(each)]) for each in (-1.0, 1.0)]
    m.contact("bowl", disc(m, (R - BALL) * np.array([np.sin(start), -np.cos(start)])), m.ground.arc((0, 0), *ends, outside=False),
              radius=BALL, friction=0.9)
    sol = zd.simulate(m, 3.0, **FINE)
    swing = solve_ivp(lambda t, y: [y[1], -2 / 3 * G / (R - BALL) * np.sin(y[0])], (0, 3), [start, 0], rtol=1e-12, atol=1e-13)
    found = swing.y[0, -1]
    x, y = sol["disc.position"][-1]
    assert np.arctan2(x, -y) == pytest.approx(found, abs=1e-9)
    assert sol["disc.angle"][-1] == pytest.approx(-(R - BALL) / BALL * (found - start), abs=1e-8)


def test_discs_hand_on_their_speed():
    m = zd.Mechanism("cradle")
    discs = [disc(m, (0.3 * i, 0), f"disc{i}") for i in range(4)]
    for i in range(3):
        m.contact(f"c{i}", discs[i + 1], discs[i].circle((0.3 * i, 0), BALL), radius=BALL, restitution=1.0)
    m.start({discs[0].velocity.x: 1.0})
    sol = zd.simulate(m, 1.0)
    assert sol.impacts["t"] == pytest.approx([0.1, 0.2, 0.3], abs=1e-13)
    assert [sol[f"disc{i}.velocity.x"][-1] for i in range(4)] == pytest.approx([0, 0, 0, 1], abs=1e-12)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_an_oblique_impact_with_friction_conserves_both_momenta(layout):
    """Impulses by Newton and Coulomb: normal (1 + e) w / W, tangential mu of it as it slides on, at the point that touches."""
    m = zd.Mechanism("oblique")
    one, two = disc(m, (0, 0), "one"), m.body("two", 2.0, 0.02, at=(1, 0.1))
    m.contact("touch", one, two.circle((1, 0.1), 0.2), radius=BALL, restitution=0.7, friction=0.05)
    m.start({one.velocity.x: 1.0})
    sol = zd.simulate(m.system(layout), 2.0, **FINE)
    normal = np.array([-np.sqrt(0.3**2 - 0.1**2), -0.1]) / 0.3     # towards the first disc
    pressed = -1.7 * normal[0] / (1 + 1 / 2)
    tangent = np.array([normal[1], -normal[0]])
    impulse = pressed * (normal - 0.05 * np.sign(tangent[0]) * tangent)
    assert sol.impacts["impulse"] == pytest.approx([pressed], rel=1e-10)
    assert sol["one.velocity"][-1] == pytest.approx(np.array([1, 0]) + impulse, abs=1e-10)
    assert sol["two.velocity"][-1] == pytest.approx(-impulse / 2, abs=1e-10)
    turn = np.array([cross(-BALL * normal, impulse) / 0.005, cross(0.2 * normal, -impulse) / 0.02])
    assert [sol[f"{name}.angular_velocity"][-1] for name in ("one", "two")] == pytest.approx(turn, abs=1e-10)


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def test_what_slides_off_an_arc_flies_on_and_falls_below_it():
    m = zd.Mechanism("ramp", gravity=(0, -G))
    point = m.particle("point", 1.0, at=(-1.0, 0.0))
    m.contact("ramp", point, m.ground.arc((0, 0), (-1, 0), (0, -1), outside=False))
    m.start({point.velocity.y: -2.0})
    sol = zd.simulate(m, 1.2, **FINE)
    assert [phase.state["ramp"] for phase in sol.phases] == ["closed", "open"]
    left, speed = sol.phases[1].t0, np.sqrt(4 + 2 * G)
    assert sol(left)[0] == pytest.approx([0, -1], abs=1e-9)
    assert sol["point.position"][-1] == pytest.approx([speed * (1.2 - left), -1 - G * (1.2 - left)**2 / 2], abs=1e-8)


def test_a_contact_of_several_parts_has_one_force():
    m = on_table(friction=0.9)
    sol = zd.simulate(m, 0.6, **FINE)
    acceleration = sol["disc.acceleration"]
    assert sol["table.force"] == pytest.approx(acceleration + np.array([0, G]), abs=1e-9)


def test_shapes_are_saved_and_drawn(tmp_path):
    m = on_table(friction=(0.9, 0.5))
    other = disc(m, (3, 0), "other")
    m.contact("bowl", other, m.ground.arc((3, 0), (2, 0), (4, 0), outside=False), radius=BALL)
    m.contact("hill", other, m["disc"].circle((-0.01, 0.1), 0.05), radius=BALL)
    again = zd.load(m.save(tmp_path / "m.json"))
    one, two = (zd.simulate(each, 0.5) for each in (m, again))
    np.testing.assert_array_equal(one.p, two.p)
    kinds = [shape.kind for shape in m.system()._sketches([m.system().p0])[0]]
    assert kinds.count("surface") == 3


@pytest.mark.parametrize("far", [1.0, 100.0])
def test_small_shapes_on_a_long_way_are_met(far):
    """Steps of free flight are longer than the shape; its gap has a kink where it is passed."""
    m = zd.Mechanism("flight")
    ball = disc(m, (-far, 0))
    m.contact("peg", ball, m.ground.circle((0, 0), 0.1), radius=BALL, restitution=1.0)
    m.start({ball.velocity.x: 10.0})
    sol = zd.simulate(m, far / 4)
    assert sol.impacts["t"] == pytest.approx([(far - 0.2) / 10], rel=1e-12)
    assert sol["disc.velocity.x"][-1] == pytest.approx(-10.0)


@pytest.mark.parametrize("way", [{}, {"max_step": 0.05}], ids=["long", "short"])
def test_a_short_way_through_an_arc_is_not_passed_over(way):
    """A bounce near the end of an arc: the gap is below zero in a sixteenth of the long step, after a rise."""
    m, half, radius = zd.Mechanism("hill", gravity=(0, -0.03 * G)), 1.13, 0.01724
    ends = [radius * np.array([np.sin(each), np.cos(each)]) for each in (half, -half)]
    point = m.body("point", 0.43, 2.43e-6, at=(0.014659, 0.014827))
    m.contact("hill", point, m.ground.arc((0, 0), *ends), restitution=0.3976, friction=0.388)
    m.start({point.velocity: (-0.020472, -0.0040368)})
    sol = zd.simulate(m, 1.0, rtol=1e-9, atol=1e-11, **way)
    assert sol.impacts["t"] == pytest.approx([0.1208, 0.3007], abs=1e-3)


@pytest.mark.parametrize(("change", "words"), [
    (lambda m: m.contact("c", m["disc"], m.ground.circle((0, 5), 0.0)), "for a circle of radius 0"),
    (lambda m: m.contact("c", m["disc"], m.ground.circle((0, 5), 0.05, outside=False), radius=BALL), "less than that of the"),
    (lambda m: m.ground.arc((0, 0), (1, 0), (2, 0)), "two directions from its centre"),
    (lambda m: m.ground.segment((1, 0), (1, 0)), "two places"),
    (lambda m: m.ground.circle((1, 0), -1.0), "radius of a circle must be"),
])
def test_wrong_shapes_are_refused_by_name(change, words):
    with pytest.raises((ValueError, TypeError), match=words):
        change(on_table())


def test_a_round_body_across_a_segment_is_named():
    m = zd.Mechanism("across", gravity=(0, -G))
    m.contact("c", disc(m, (0, 0.02)), m.ground.segment((-1, 0), (1, 0)), radius=BALL)
    with pytest.raises(zd.InconsistentStart, match="contact 'c left' must not penetrate"):
        zd.simulate(m, 1.0)
