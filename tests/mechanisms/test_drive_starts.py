"""Starts of drives that prescribe a speed: the driven coordinate keeps its drawn value, unless the start moves it."""

import functools
import warnings

import numpy as np
import pytest
from scipy.optimize import fsolve

import zerodrift as zd
from support import assert_close

LAYOUTS = ["joint", "absolute"]
SPEEDS = {"number": 10.0, "function": lambda t: 10.0 + t}
LENGTH = np.hypot(0.8, 0.4)


def four_bar(dimension, speed=10.0, start=None, wish=None, coupler=None):
    """Crank of 0.2 m drawn upright; the coupler may have another length than drawn."""
    m, z = zd.Mechanism("four-bar", dimension=dimension), (0,) * (dimension - 2)
    axis = {"axis": (0, 0, 1)} if dimension == 3 else {}
    a = m.link("crank", (0, 0, *z), (0, 0.2, *z), mass=1.0)
    b = m.link("coupler", (0, 0.2, *z), (0.8, 0.6, *z), mass=2.0, **({"length": coupler} if coupler else {}))
    c = m.link("rocker", (0.8, 0.6, *z), (0.9, 0, *z), mass=1.5)
    for name, one, other in (("A", m.ground, a.start), ("B", a.end, b.start), ("C", b.end, c.start),
                             ("D", c.end, m.ground.point((0.9, 0, *z)))):
        m.revolute(name, one, other, **axis)
    m.motor("drive", "A", speed=speed)
    m.start(start, wish=wish)
    return m


def rocker_turn(coupler):
    """Turn of the ground against the rocker at D, with the crank upright: by the circles about the crank's tip and about D."""
    rocker = np.hypot(0.1, 0.6)
    tip = fsolve(lambda x: [np.hypot(x[0], x[1] - 0.2) - coupler, np.hypot(x[0] - 0.9, x[1]) - rocker], (0.8, 0.6), xtol=1e-14)
    return np.arctan2(0.6, -0.1) - np.arctan2(tip[1], tip[0] - 0.9)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("speed", SPEEDS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_changed_length_leaves_a_driven_crank_as_drawn(dimension, speed, layout):
    system = four_bar(dimension, SPEEDS[speed]).system(layout)
    for coupler in (LENGTH - 1e-3, LENGTH, LENGTH + 1e-3, 1.2):
        changed = system.with_parameters({"coupler.length": coupler})
        sol, run = zd.simulate(changed, 1e-3, step=1e-3), zd.Run(changed, step=1e-3)
        for names in (sol["A.angle"][0], run["A.angle"]):
            assert_close(names, 0.0, 1e-13, scale=1.0)
        assert_close(sol["D.angle"][0], rocker_turn(coupler), 1e-12, scale=1.0)
        assert_close(sol["A.speed"][0], 10.0, 1e-12)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("inputs", [None, ["drive.speed"]])
def test_many_runs_start_as_single_ones(dimension, inputs):
    m, lengths = four_bar(dimension), LENGTH + np.array([-1e-3, 0.0, 1e-3, 0.3])
    ens = zd.ensemble(m, 2e-3, parameters={"coupler.length": lengths}, step=1e-3, outputs=["A.angle", "D.angle"])
    assert_close(ens["A.angle"][:, 0], np.zeros(4), 1e-13, scale=1.0)
    assert_close(ens["D.angle"][:, 0], [rocker_turn(each) for each in lengths], 1e-12, scale=1.0)
    runs = zd.ManyRuns(m, runs=4, parameters={"coupler.length": lengths}, step=1e-3, inputs=inputs)
    assert_close(runs["A.angle"], np.zeros(4), 1e-13, scale=1.0)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("speed", SPEEDS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_the_start_may_move_a_driven_crank(dimension, speed, layout):
    made = functools.partial(four_bar, dimension, SPEEDS[speed], coupler=1.0)
    for given, measure, value in (({"A.angle": 0.1}, "A.angle", 0.1), ({"D.angle": 0.05}, "D.angle", 0.05)):
        for m in (made(start=given), made(wish=given)):
            assert_close(zd.simulate(m.system(layout), 1e-3, step=1e-3)[measure][0], value, 1e-11)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_sketch_leaves_the_drawn_crank(dimension, layout):
    """A coupler of which the length moves a free crank by half a radian."""
    sol = zd.simulate(four_bar(dimension, coupler=1.3).system(layout), 1e-3, step=1e-3)
    assert_close(sol["A.angle"][0], 0.0, 1e-13, scale=1.0)


def five_bar(held=None):
    """Two driven cranks, of which the coupled links are drawn too short by a hundredth."""
    m = zd.Mechanism("five-bar")
    links = [m.link(name, *ends, 1.0, **more) for name, ends, more in (
        ("a", ((0, 0), (0, 1)), {}), ("b", ((0, 1), (1, 2)), {"length": 1.43}), ("c", ((1, 2), (2, 1)), {"length": 1.44}),
        ("d", ((2, 1), (2, 0)), {}))]
    points = [m.ground, *(link.start for link in links[1:]), m.ground.point((2, 0))]
    for name, one, other in zip("ABCDE", points, (links[0].start, *(link.end for link in links)), strict=True):
        m.revolute(name, one, other)
    m.motor("left", "A", speed=1.0)
    m.motor("right", "E", speed=lambda t: -2.0)
    m.start(held)
    return m


@pytest.mark.parametrize("layout", LAYOUTS)
def test_of_two_drives_the_one_that_the_start_does_not_move_stays(layout):
    for held, places in ((None, (0.0, 0.0)), ({"a.angle": np.pi / 2 + 0.1}, (0.1, 0.0))):
        sol = zd.simulate(five_bar(held).system(layout), 1e-3, step=1e-3)
        assert_close([sol["A.angle"][0], sol["E.angle"][0]], places, 1e-12, scale=1.0)
        assert_close([sol["A.speed"][0], sol["E.speed"][0]], [1.0, -2.0], 1e-12)


def slider_crank(dimension, law):
    """A driven piston, and a rod that is a millimetre longer than drawn."""
    m, z = zd.Mechanism("pump", dimension=dimension), (0,) * (dimension - 2)
    axis = {"axis": (0, 0, 1)} if dimension == 3 else {}
    crank = m.link("crank", (0, 0, *z), (0.1, 0.1, *z), mass=1.0)
    rod = m.link("rod", (0.1, 0.1, *z), (0.5, 0, *z), mass=1.0, length=np.hypot(0.4, 0.1) + 1e-3)
    piston = m.body("piston", 0.1, 1e-3 if dimension == 2 else (1e-3,) * 3, at=(0.5, 0, *z))
    m.revolute("main", m.ground, crank.start, **axis)
    m.revolute("pin", crank.end, rod.start, **axis)
    m.revolute("wrist", rod.end, piston.point((0, 0, *z)), **axis)
    m.prismatic("cylinder", m.ground, piston, axis=(1, 0, *z), at=(0.5, 0, *z))
    m.motor("drive", "cylinder", **law)
    return m


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_driven_slider_stays_as_drawn_and_an_absolute_law_has_its_own_value(dimension, layout):
    laws = ({"speed": 0.3}, 0.0), ({"speed": lambda t: 0.3 + t}, 0.0), ({"displacement": lambda t: 0.002 + 0.3 * t}, 0.002)
    for law, place in laws:
        sol = zd.simulate(slider_crank(dimension, law).system(layout), 1e-3, step=1e-3)
        assert_close([sol["cylinder.displacement"][0], sol["cylinder.speed"][0]], [place, 0.3], 1e-12)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("speed", SPEEDS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_drive_that_cannot_start_as_drawn_is_named(dimension, speed, layout):
    """The tip of the upright crank is 0.92 m away from D, coupler and rocker reach 0.86 m."""
    system = four_bar(dimension, SPEEDS[speed]).system(layout).with_parameters({"coupler.length": 0.25})
    with pytest.warns(zd.DrawingWarning, match="drive 'drive' of 'four-bar' must start as drawn, at A.angle = 0"):
        sol = zd.simulate(system, 1e-3, step=1e-3)
    assert abs(sol["A.angle"][0]) > 0.1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        told = four_bar(dimension, SPEEDS[speed], {"A.angle": -1.2}).system(layout).with_parameters({"coupler.length": 0.25})
        assert_close(zd.simulate(told, 1e-3, step=1e-3)["A.angle"][0], -1.2, 1e-12)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_later_start_has_its_drives_where_they_have_come_to(layout):
    """Numbers count from t = 0; functions of speed from the start."""
    for speed, turn in (("number", 0.5), ("function", 0.0)):
        sol = zd.simulate(four_bar(2, SPEEDS[speed], coupler=0.9).system(layout), (0.05, 0.051), step=1e-3)
        assert_close(sol["A.angle"][0], turn, 1e-12, scale=1.0)
