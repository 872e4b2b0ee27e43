"""The choice among redundant rows is kept from step to step: it gives what one made anew gives, and its end is seen."""

import numpy as np
import pytest

import zerodrift as zd
from support import assert_close


def hinges(third=1.0, across=(0.0, 0.0, 1.0)):
    """A four-bar of full hinges in space, its rocker's end at this x: three of its twenty rows are redundant."""
    corners = np.array([[0, 0, 0], [0, 0.3, 0], [third, 0.3 if third == 1 else 0.6, 0], [1, 0, 0]], dtype=float)
    m = zd.Mechanism("hinges", dimension=3)
    a, b, c = (m.link(name, corners[i], corners[i + 1], mass=1.0 + i) for i, name in enumerate(("crank", "coupler", "rocker")))
    for name, first, second, at in (("A", m.ground, a, 0), ("B", a, b, 1), ("C", b, c, 2), ("D", m.ground, c, 3)):
        m.revolute(name, first, second, at=corners[at], axis=across)
    m.start({"A.speed": 4.0})
    return m


def cranks(count=3):
    """A bar on so many parallel cranks in the plane: all but two give a redundant row."""
    m = zd.Mechanism("cranks")
    links = [m.link(f"crank{i}", (i, 0.0), (i + 0.5, 0.8), mass=1.0) for i in range(count)]
    bar = m.link("bar", (0.5, 0.8), (count - 0.5, 0.8), mass=2.0)
    for i, link in enumerate(links):
        m.revolute(f"A{i}", m.ground, link, at=(i, 0.0))
        m.revolute(f"B{i}", link, bar, at=(i + 0.5, 0.8))
    m.start({"A0.speed": 1.0})
    return m


SCENES = {"hinges": lambda: hinges(0.9), "Bennett's linkage": zd.models.bennett,
          "cranks": cranks, "nine cranks": lambda: cranks(9)}


@pytest.mark.parametrize("name", SCENES)
def test_a_kept_choice_gives_what_one_made_anew_does(name, formulation):
    """Multipliers of least effect, of each sample, where `zd.acceleration` chooses by itself: however far the mechanism has
    moved since its rows were chosen. To the share of rounding that products of rows keep.
    """
    system = SCENES[name]().system("absolute")
    sol = zd.simulate(system, 0.4, step=2e-3, t_eval=np.linspace(0, 0.4, 9), formulation=formulation)
    assert sol.stats["rank_drops"] == 0
    for p, v, multipliers in zip(sol.p, sol.v, sol.multipliers, strict=True):
        _, expected = zd.acceleration(system, p, v, formulation=formulation)
        assert_close(multipliers, expected, 1e-9, scale=np.abs(expected).max())


@pytest.mark.parametrize("name", SCENES)
def test_rows_between_steps_leave_a_kept_choice_as_it_is(name):
    """To the last bit: what is saved between steps is looked at with a choice of its own, if there has to be one."""
    system = SCENES[name]().system("absolute")
    plain = zd.simulate(system, 0.5, step=0.01, t_eval=[0.0, 0.5])
    watched = zd.simulate(system, 0.5, step=0.01, t_eval=np.linspace(0, 0.5, 84))
    assert np.array_equal(plain.p[-1], watched.p[-1])
    assert np.array_equal(plain.v[-1], watched.v[-1])


def test_a_bifurcation_among_redundant_rows_is_seen(formulation):
    """A parallelogram of full hinges lies flat on its way. Told to go on, it stays the parallelogram that it is."""
    system = hinges().system("absolute")
    with pytest.raises(zd.Bifurcation):
        zd.simulate(system, 0.5, step=1e-3, formulation=formulation)
    sol = zd.simulate(system, 0.5, step=1e-3, formulation=formulation, on_singular="continue")
    assert sol.stats["rank_drops"] > 0
    assert np.abs(sol["A.angle"]).max() > 1.6
    assert_close(sol["A.angle"], sol["D.angle"], 1e-9)


def loosening(p):
    """A circle twice, but the second of its rows leaves the first where x passes 1/2."""
    x, y = p
    circle = x * x + y * y - 1
    return np.array([circle, circle + np.maximum(x - 0.5, 0.0) ** 3])


def test_a_row_that_is_redundant_no_longer_is_not_left_out_in_silence(formulation):
    """The violation of the row left out says so, whatever was chosen before."""
    system = zd.System(["x", "y"], mass=np.eye(2), constraints=loosening, p0=[0.0, 1.0], v0=[1.0, 0.0], potential=0.0,
                       force=[0.0, 0.0])
    with pytest.raises(zd.ZerodriftError):
        zd.simulate(system, 1.5, step=0.01, formulation=formulation)
