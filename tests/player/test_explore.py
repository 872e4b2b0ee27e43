"""Sliders: values change the motion, refused ones say why, and the widget follows them."""

import pytest

import zerodrift as zd
from support import refused


@pytest.fixture
def crank():
    return zd.explore(zd.models.slider_crank(), {"spring.stiffness": (0.5, 5.0)}, 1.0, step=0.01, graphs=["crank.angle"])


def test_it_starts_at_the_values_of_the_system(crank):
    assert crank.values == {"spring.stiffness": 1.0}
    known = zd.simulate(zd.models.slider_crank(), 1.0, step=0.01)
    assert (crank.solution.p == known.p).all()


def test_a_value_makes_another_motion(crank):
    known = zd.simulate(zd.models.slider_crank().with_parameters({"spring.stiffness": 4.0}), 1.0, step=0.01)
    assert (crank.set({"spring.stiffness": 4.0}).solution.p == known.p).all()
    assert "crank.angle" in crank.film.page


def test_lengths_are_arguments_of_a_function_and_what_cannot_be_built_says_why():
    def rocker(coupler):
        m = zd.Mechanism("rocker", gravity=(0, -9.81))
        links = [m.link("crank", (0, 0), (0, 1), mass=1.0), m.link("coupler", (0, 1), (2, 2), mass=1.0, length=coupler),
                 m.link("rocker", (2, 2), (2, 0), mass=1.0, length=2.0)]
        m.revolute("A", m.ground, links[0].start)
        m.revolute("B", links[0].end, links[1].start)
        m.revolute("C", links[1].end, links[2].start)
        m.revolute("D", links[2].end, m.ground.point((2, 0)))
        return m
    made = zd.explore(rocker, {"coupler": (0.2, 3.0)}, 0.1, step=0.01)
    assert made.values["coupler"] == pytest.approx(1.6)
    assert made.solution.success
    made.set(coupler=30.0)
    assert made.film is None
    assert made.message
    assert made.set(coupler=2.0).message == ""


def test_sliders_move_the_film(crank):
    pytest.importorskip("ipywidgets")
    slider, picture, behind = crank.widget().children
    before = picture.value
    assert (picture.layout.display, behind.layout.display) == (None, "none")
    assert (slider.min, slider.max, slider.value) == (0.5, 5.0, 1.0)
    slider.value = 3.0
    assert crank.values == {"spring.stiffness": 3.0}
    assert picture.value == before      # it stays behind the new one, which asks it for its time
    assert behind.value != before
    assert (picture.layout.display, behind.layout.display) == ("none", None)
    assert 'sandbox="allow-scripts allow-downloads"' in behind.value
    assert crank.group in behind.value


@pytest.mark.parametrize(("parameters", "code", "words"), [
    ({}, "wrong-type", "dict of ranges"), ({"spring.stiffness": 1.0}, "wrong-type", "two numbers"),
    ({"spring.stiffness": (2.0, 1.0)}, "not-increasing", None),
    ({"spring.stifness": (1.0, 2.0)}, "wrong-name", None),
])
def test_what_is_refused(parameters, code, words):
    with refused(code, words):
        zd.explore(zd.models.slider_crank(), parameters, 1.0, step=0.01)


def test_only_its_own_parameters_are_set(crank):
    with refused("wrong-name"):
        crank.set({"rod.mass": 1.0})
