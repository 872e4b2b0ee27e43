"""The transmission angle against the law of cosines, and what has none."""

import numpy as np
import pytest

import zerodrift as zd
from support import refused


def test_of_a_four_bar_it_is_that_of_textbooks():
    """Between coupler and rocker; its extremes are where the crank lies on the ground's line."""
    a, b, c, d = 0.1, 0.25, 0.25, 0.2
    m = zd.models.chebyshev_lambda(crank=a)
    measure = zd.transmission_angle(m, "C")
    assert measure == m["C"].transmission_angle
    turn = zd.trace(m, "crank.angle")
    across = a * a + d * d - 2 * a * d * np.cos(turn.values)
    assert np.abs(np.cos(turn[measure]) - (b * b + c * c - across) / (2 * b * c)).max() < 1e-14
    assert ((turn[measure] > 0) & (turn[measure] < np.pi)).all()
    reach = zd.reach(m, measure)
    for found, span in ((reach.low, d - a), (reach.high, d + a)):
        assert found == pytest.approx(np.arccos((b * b + c * c - span**2) / (2 * b * c)), abs=1e-13)


def test_it_is_an_output_and_an_event():
    m = zd.models.chebyshev_lambda()
    measure = zd.transmission_angle(m, m["C"])
    sol = zd.simulate(m, 1.0, step=1e-3, outputs=[measure], events=[zd.Event(measure, value=1.0)])
    turn = zd.trace(m, "crank.angle", sol["crank.angle"][::100])
    assert np.abs(sol[measure][::100] - turn[measure]).max() < 1e-10       # of steps that are corrected to 1e-12
    assert len(sol.t_events[0]) == 2
    changed = m.with_parameters({"crank.length": 0.12})
    wide = np.ptp(zd.trace(changed, "crank.angle")[measure])
    assert wide > np.ptp(turn[measure])


@pytest.mark.parametrize("by", ["slot", "prismatic"])
def test_at_a_slider_it_is_from_the_normal_of_the_slide(by):
    r, length = 0.5, 1.2
    m = zd.Mechanism("slider-crank")
    crank, rod = m.link("crank", (0, 0), (0, r), mass=1.0), m.link("rod", (0, r), (1, 0), mass=1.0, length=length)
    m.revolute("main", m.ground, crank.start)
    m.revolute("pin", crank.end, rod.start)
    if by == "slot":
        piston = m.particle("piston", 1.0, at=(1, 0))
        m.revolute("wrist", rod.end, piston)
        m.slot("slide", m.ground, piston, axis=(1, 0))
    else:
        piston = m.body("piston", 1.0, 1.0, at=(1, 0), angle=0.3)
        m.revolute("wrist", rod.end, piston.point((0, 0)))
        m.prismatic("slide", m.ground, piston, axis=(1, 0), at=(0, 0))
    turn = zd.trace(m, "crank.angle")
    expected = np.pi / 2 - np.arcsin(r / length * np.sin(turn.values))      # the rod leans by this arcsin
    measured = turn[zd.transmission_angle(m, "wrist")]
    assert min(np.abs(measured - expected).max(), np.abs(np.pi - measured - expected).max()) < 1e-13


def test_through_a_dead_point_it_goes_beyond_zero():
    """On the other branch, coupler and rocker are on the other side of each other."""
    m = zd.linkage({"A": (0, 0), "B": (0.6, 0.8), "C": (2.2, 1.3), "D": (2.2, 0)},
                   {"ground": "AD", "crank": "AB", "coupler": "BC", "rocker": "DC"},
                   lengths={"AB": 1.0, "BC": 1.6, "CD": 1.3, "AD": 2.2}, mass=1.0)
    there_and_back = zd.trace(m, "crank.angle", [0.5, 2.0, 0.5], through=True)[zd.transmission_angle(m, "C")]
    assert there_and_back[0] + there_and_back[2] == pytest.approx(2 * np.pi, abs=1e-13)


def test_at_the_knee_of_two_loops_the_line_goes_to_the_ground():
    """Jansen's leg: three links meet in U, and the bed has joints in V, in W and on the ground."""
    leg = zd.models.jansen()
    turn = zd.trace(leg, "crank.angle")
    V, X, Y = (turn[f"{name}.position"] for name in ("V", "X j", "Y bed"))
    a, b = X - V, Y - V
    expected = np.arctan2(np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), np.sum(a * b, axis=1))
    assert np.abs(turn[zd.transmission_angle(leg, "V")] - expected).max() < 1e-13
    assert zd.transmission_angle(leg, "X k").name == "X k.transmission_angle"      # k's other joints are both in U


def test_what_has_none():
    m = zd.linkage({"A": (0, 0), "B": (0, 1), "C": (2, 2), "D": (3, 0), "E": (1, 3), "F": (4, 3)},
                   {"ground": "AD", "crank": "AB", "plate": "BCE", "rocker": "DC", "arm": "EF", "free": "FD"},
                   mass=1.0)
    loose = m.link("loose", (0, 1), (0, 5), mass=1.0)
    m.revolute("end", m["crank"].end, loose.start)
    for joint, said in (("A", "is fixed to the ground"), ("C", "'plate' has the other joints 'B', 'E', none of them on"),
                        ("end", "'loose' has no other joint")):
        with refused("wrong-element", said):
            zd.transmission_angle(m, joint)
    slide = m.slot("slide", m.ground, loose.end, axis=(0, 1))
    with refused("wrong-element"):
        zd.transmission_angle(m, slide)
    with refused("wrong-type", "joint.*'linkage'"):
        zd.transmission_angle(m, "crank")
    with refused("wrong-type", "^m must"):
        zd.transmission_angle(m.system(), "C")
    with refused("wrong-name"):
        zd.trace(m, "A.transmission_angle")
