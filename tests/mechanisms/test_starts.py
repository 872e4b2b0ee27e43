"""Starts: what nothing forces stays as drawn and at rest, in joint and in absolute coordinates alike; what moved is printed."""

import warnings

import numpy as np
import pytest
from scipy.optimize import minimize

import zerodrift as zd
from few_bodies import crank_and_piston
from mechanisms.random_starts import outcome
from support import assert_close

LAYOUTS = ["joint", "absolute"]


def first(m, layout, *names):
    """Measures at t = 0."""
    sol = zd.simulate(m.system(layout), 1e-4, step=1e-4)
    return [sol[name][0] for name in names]


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_pole_rests_on_a_cart_whose_speed_is_held(layout):
    m = zd.Mechanism("cart", gravity=(0, -9.81))
    cart, pole = m.body("cart", 1.0, 1.0), m.link("pole", (0, 0), (0, 1), mass=1.0)
    m.prismatic("rail", m.ground, cart, axis=(1, 0))
    m.revolute("hinge", cart, pole.start)
    m.start({"rail.speed": 1.0})
    assert_close(first(m, layout, "rail.speed", "hinge.speed", "hinge.angle"), [1.0, 0.0, 0.0], 1e-13)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("held", [{"A.angle": 0.5}, {"a.angle": 0.5 - np.pi / 2}])
def test_a_double_pendulum_does_not_fold(layout, held):
    m = zd.Mechanism("double pendulum", gravity=(0, -9.81))
    a, b = m.link("a", (0, 0), (0, -1), mass=1.0), m.link("b", (0, -1), (0, -2), mass=1.0)
    m.revolute("A", m.ground, a.start)
    m.revolute("B", a.end, b.start)
    m.start(held)
    assert_close(first(m, layout, "A.angle", "B.angle", "b.angle"), [0.5, 0.0, 0.5 - np.pi / 2], 1e-12)


def door(hinges):
    m = zd.Mechanism("door", dimension=3, gravity=(0, 0, -9.81))
    leaf = m.body("door", 20.0, (3.0, 2.0, 1.0), at=(0.4, 0, 1.0))
    for name, height in (("low", 0.3), ("high", 1.7))[:hinges]:
        m.revolute(name, m.ground, leaf, at=(0.05 * (height - 0.3), 0, height), axis=(0.05, 0, 1))
    p = m.link("handle", (0.7, 0, 1.0), (0.7, -0.1, 0.8), mass=1.0)
    m.revolute("pin", leaf, p.start, axis=(0, 1, 0.5))
    m.start({"low.speed": 2.0})
    return m


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("hinges", [1, 2])
def test_a_second_hinge_does_not_change_a_start(layout, hinges):
    speed, pin = first(door(hinges), layout, "low.speed", "pin.speed")
    assert_close([speed, pin], [2.0, 0.0], 1e-12)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_pendulum_on_a_moved_linkage_keeps_its_angle_and_the_linkage_moves(layout):
    """The loop contains the held angle, the pendulum on its coupler does not."""
    m = zd.Mechanism("four-bar with a pendulum", gravity=(0, -9.81))
    crank, coupler = m.link("crank", (0, 0), (0, 0.3), mass=1.0), m.link("coupler", (0, 0.3), (1.0, 0.8), mass=1.0)
    rocker = m.link("rocker", (1.2, 0), (1.0, 0.8), mass=1.0)
    bob = m.link("bob", (0.5, 0.55), (0.5, 0.1), mass=0.2)
    for name, one, other in (("A", m.ground, crank.start), ("B", crank.end, coupler.start), ("C", coupler.end, rocker.end),
                             ("D", m.ground.point((1.2, 0)), rocker.start)):
        m.revolute(name, one, other)
    m.revolute("hook", coupler, bob.start)
    m.start({"crank.angle": np.pi / 2 - 0.4, "crank.angular_velocity": 3.0})
    angle, hook, speed, rocker_speed = first(m, layout, "crank.angle", "hook.angle", "hook.speed", "rocker.angular_velocity")
    assert_close([angle, hook, speed], [np.pi / 2 - 0.4, 0.0, 0.0], 1e-11)
    assert abs(rocker_speed) > 0.1


def test_what_moves_with_a_loop_moves_least():
    """A slider on a rod whose end is driven: among all velocities that the joints allow, those of least kinetic energy."""
    m = zd.Mechanism("two sliders")
    heavy, light = m.particle("heavy", 10.0, at=(1, 0)), m.particle("light", 0.1, at=(0, 1))
    tip = m.particle("tip", 1.0, at=(1, 1))
    m.rod("one", heavy, tip)
    m.rod("other", light, tip)
    m.start({"tip.velocity.x": 1.0})
    v = m.system("absolute").v0
    masses = np.array([10, 10, 0.1, 0.1, 1, 1.0])
    rows = np.array([[0, 1, 0, 0, 0, -1.0], [0, 0, 1, 0, -1, 0], [0, 0, 0, 0, 1, 0]])
    found = minimize(lambda x: masses @ x**2, np.zeros(6), jac=lambda x: 2 * masses * x, method="SLSQP", tol=1e-14,
                     constraints={"type": "eq", "fun": lambda x: rows @ x - [0, 0, 1], "jac": lambda x: rows})
    assert_close(v, found.x, 1e-7, scale=1.0)       # bodies are in the order in which they were added


def test_a_joint_that_is_drawn_open_is_named_with_what_moves():
    told = str(crank_and_piston((0.44, 0.03)))
    assert "drawn open, and closed at the start (m, or rad): 'wrist' by 0.05" in told
    line = next(each for each in told.splitlines() if "moved from the drawing" in each)
    assert "'piston' by 0.0415 m" in line
    assert "'rod'" in line


def test_nothing_is_named_where_the_drawing_closes():
    told = str(crank_and_piston((0.4, 0.0001)))
    assert "drawn open" not in told
    assert "moved" not in told


def test_what_a_held_value_moves_is_named():
    m = crank_and_piston((0.4, 0.0))
    m.start({"crank.angle": 0.3})
    assert "moved from the drawing: 'crank' by 0.0149 m and 0.3 rad" in str(m)


def test_a_driven_shaft_with_a_universal_joint_is_not_locked():
    """Two shafts at 0.5 rad through Hooke's joint: tan(out) = tan(in) / cos 0.5; three rows are redundant, and all moves."""
    m = zd.Mechanism("shafts", dimension=3)
    one, other = (m.body(name, 1.0, (0.1, 0.1, 0.1)) for name in ("one", "other"))
    m.revolute("in", m.ground, one, axis=(1, 0, 0), at=(0, 0, 0))
    m.revolute("out", m.ground, other, axis=(np.cos(0.5), np.sin(0.5), 0), at=(0, 0, 0))
    m.universal("cross", one, other, axes=((0, 0, 1), (-np.sin(0.5), np.cos(0.5), 0)), at=(0, 0, 0))
    m.motor("drive", "in", speed=1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sol = zd.simulate(m, 1.0, step=1e-2, integrator="dop853")
    angle = sol["in.angle"]
    assert_close(sol["out.angle"], np.arctan2(np.sin(angle) * np.cos(0.5), np.cos(angle)), 1e-9, scale=1.0)


@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_no_coordinate_moves_that_no_loop_connects_with_the_held_one(layout, in_space):
    """A sample of the stress run; it has to hold starts in which others stay."""
    words = [outcome(seed, in_space, layout)[0] for seed in range(40, 56)]
    assert "others move" not in words
    assert words.count("the others stay") > 2


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_particle_that_is_part_of_a_link_starts_where_it_is_put(layout, dimension):
    """A pendulum by the place and the velocity of a mass on its rod: sin(angle) = 0.3 / 0.5, and 0.5 m times the rate."""
    m = zd.Mechanism("pendulum", dimension=dimension)
    link = m.link("link", (0, 0, 0)[:dimension], (1, 0, 0)[:dimension], mass=1.0)
    m.particle("mass", 1.0, at=link.point((0.5, 0, 0)[:dimension]))
    m.revolute("pin", m.ground, link.start, **({"axis": (0, 0, 1)} if dimension == 3 else {}))
    m.start({"mass.position.y": 0.3, "mass.velocity.y": 0.8})
    assert_close(first(m, layout, "pin.angle", "pin.speed"), [np.arcsin(0.6), 2.0], 1e-11)
