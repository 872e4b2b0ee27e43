"""Rows of parallelograms that swing through the line in which all links lie: the loss of digits there is reported, also where
constraints are redundant.
"""

import numpy as np
import pytest

import zerodrift as zd

G = 9.81
ANGLE, SPEED = 0.0501, -1.0     # of all cranks where they begin: at 0.05 s they are a ten-thousandth from the line


def parallelograms(count, doubled=0, angle=ANGLE, gravity=0.0):
    """So many, in absolute coordinates, and velocities with which all cranks turn alike. Some first pins are there twice."""
    m = zd.Mechanism(f"{count} parallelograms", gravity=(0, -gravity))
    tip = np.array([np.cos(angle), np.sin(angle)])
    feet = np.column_stack([np.arange(count + 1), np.zeros(count + 1)])
    cranks = [m.link(f"crank{i}", foot, foot + tip, mass=1.0) for i, foot in enumerate(feet)]
    for i, crank in enumerate(cranks):
        m.revolute(f"A{i}", m.ground, crank.start)
    for i in range(count):
        bar = m.link(f"bar{i}", feet[i] + tip, feet[i + 1] + tip, mass=1.0)
        m.revolute(f"B{i}", cranks[i].end, bar.start)
        m.revolute(f"C{i}", bar.end, cranks[i + 1].end)
    for i in range(doubled):
        m.revolute(f"A{i} again", m.ground, cranks[i].start)
    system, across = m.system("absolute"), SPEED * np.array([-tip[1], tip[0], 0])
    v = np.concatenate([np.tile(across / 2 + [0, 0, SPEED], count + 1), np.tile(across, count)])
    return system, v


def swung(count, doubled=0, formulation="schur"):
    """Through the line; how far the angles are off at the end."""
    system, v = parallelograms(count, doubled)
    with pytest.warns(zd.AccuracyWarning, match=r"at t = 0\.05, .* was left of constraint '[ABC]\d+.*\.[xy]' once") as told:
        sol = zd.simulate(system, 0.1, None, v, step=1e-3, formulation=formulation)
    assert len(told) == 1
    assert "digits      lost near a bifurcation" in repr(sol)
    return sol, np.abs(sol.p[-1, 2 : 3 * (count + 1) : 3] - (ANGLE + 0.1 * SPEED)).max()


def test_long_chains_that_lose_digits_say_so():
    """200 parallelograms in a row against the equation of the one angle of all cranks: no warning and no error before the first
    passage of the line, both after it.
    """
    count = 200
    weight, inertia = (count + 1) / 2 + count, (count + 1) / 3 + count      # of uniform cranks and couplers, 1 m, 1 kg
    angle = zd.System(1, mass=np.eye(1), force=lambda p: -9.81 * weight / inertia * np.cos(p), p0=[np.pi / 2], v0=[SPEED])
    swing = zd.simulate(angle, 3.5, step=1e-3, integrator="dop853")
    system, v = parallelograms(count, angle=np.pi / 2, gravity=9.81)

    def off(sol):
        return np.abs(sol.p[-1, 2 : 3 * (count + 1) : 3] - swing.p[len(sol.t) - 1]).max()

    early = zd.simulate(system, 0.7, None, v, step=1e-3)
    assert off(early) < 1e-10
    assert "digits" not in repr(early)
    with pytest.warns(zd.AccuracyWarning, match=r"was left of constraint '[ABC]\d+\.[xy]' once others are eliminated"):
        late = zd.simulate(system, 3.5, None, v, step=1e-3)
    assert "digits      lost near a bifurcation" in repr(late)
    assert off(late) > 100 * off(early)


def test_every_formulation_tells_of_a_small_pivot_which_decides_nothing(formulation):
    """All rows count from the first step to the last, none of which is made in parts, and the cranks turn as they have to."""
    sol, off = swung(14, formulation=formulation)
    stats = sol.stats
    assert (sol.success, stats["steps"], stats["rank"], stats["subdivided"]) == (True, 100, sol.system.m, 0)
    assert (stats["redundant"], stats["rank_drops"]) == ([], 0)
    assert 0 < stats["smallest_pivot"] < 1e-8       # squares of the distance from the line, 1e-4
    assert abs(stats["smallest_pivot_time"] - 0.05) < 2e-3
    assert off < 1e-10


def test_small_pivots_are_watched_where_constraints_are_redundant():
    """As much is left there as without the pins that are there twice, and the motion is the same."""
    (plain, off), (doubled, off_too) = swung(14), swung(14, doubled=2)
    assert doubled.stats["rank"] == plain.stats["rank"] == 86
    assert 0.2 < doubled.stats["smallest_pivot"] / plain.stats["smallest_pivot"] < 5        # orders of elimination differ
    assert max(off, off_too) < 1e-10


def test_a_mechanism_whose_constraints_are_redundant_moves_as_without_these():
    """All of its joints are revolute, so that C is only evaluated because of these rows: it has to be that of the point."""
    (plain, v), (doubled, _) = parallelograms(14), parallelograms(14, doubled=2)
    v = 3 * v
    one, other = (zd.simulate(system, 0.01, None, v, step=1e-3) for system in (plain, doubled))
    assert np.abs(one.p - other.p).max() < 1e-12
    assert np.abs(one.v - other.v).max() < 1e-11
    assert np.abs(other.energy_violation).max() < 1e-10


def knee(rise):
    """A load where two rods meet that lie almost in a line, and a chain of 20 links whose first pin is there twice."""
    m = zd.Mechanism("knee", gravity=(0, -G))
    end = m.ground.point((0, 0))
    for i in range(20):
        link = m.link(f"link{i}", (i, 0), (i + 1, 0), mass=1.0)
        m.revolute(f"pin{i}", end, link.start)
        end = link.end
    m.revolute("pin0 again", m.ground, m["link0"].start)
    load = m.particle("load", 1.0, at=(1, -3 - rise))
    m.rod("left", m.ground.point((0, -3)), load)
    m.rod("right", m.ground.point((2, -3)), load)
    return m.system("absolute")


@pytest.mark.filterwarnings("ignore::zerodrift.AccuracyWarning")       # of a pivot 4 rise^2, where it is below 1e-8
@pytest.mark.parametrize("rise", [1e-2, 1e-3, 1e-4, 1e-5, 1e-6])
def test_small_singular_values_cost_no_more_digits_than_their_size(rise, formulation):
    """The load stands still on rods whose forces follow from their rise; the rounding of their directions is 2^-52 / rise."""
    sol = zd.simulate(knee(rise), 1e-3, step=5e-4, formulation=formulation)
    off = 16 * 2.0**-52 / rise
    assert len(sol.stats["redundant"]) == 2
    assert np.abs(sol["load.acceleration"]).max() < off * G
    assert np.abs(sol["load.velocity"]).max() < off * G * 1e-3
    np.testing.assert_allclose(sol["left.tension"], G / (2 * rise) * np.hypot(1, rise), rtol=off)
