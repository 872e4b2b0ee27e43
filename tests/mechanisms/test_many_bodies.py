"""Mechanisms of so many rows that the core finds their start and what is printed, without dense matrices: as of few."""

import numpy as np
import pytest

import zerodrift as zd
from large_mechanisms import chain, four_bars, star
from zerodrift.mechanisms import assembly

AGREES = 1e-12


def doubled(n):
    """Parallelograms with a pin that is there twice."""
    m = four_bars(n)
    m.revolute("A0 again", m.ground, m["rod0"].start)
    return m


@pytest.fixture
def few(monkeypatch):
    """Takes what is done for many rows from the first one on, once it is called."""
    return lambda: monkeypatch.setattr(assembly, "MOST_DENSE", 0)


@pytest.mark.parametrize(("make", "held"), [
    (four_bars, {}), (doubled, {}), (star, {"link3.angular_velocity": 2.0}), (chain, {}),
    (chain, {"link3.angular_velocity": 1.0, "link7.end.velocity.y": -0.2, "pin5.speed": 0.5}),
    (chain, {"link2.angle": 0.0, "link4.angular_velocity": 1.0})], ids=lambda given: getattr(given, "__name__", str(given)))
def test_velocities_that_are_held(make, held, few):
    """The least that all rows allow, in the mass metric."""
    m = make(9)
    m.start(held)
    dense = m.system("absolute").v0
    few()
    assert np.abs(m.system("absolute").v0 - dense).max() <= AGREES * max(1.0, np.abs(dense).max())


def test_velocities_of_drives(few):
    """Rows that ask for velocities themselves, and a link that is held beside them."""
    m = chain(5)
    m.motor("drive", m["pin1"], speed=0.7)
    m.start({"link4.angular_velocity": -1.0})
    dense = m.system("absolute").v0
    few()
    assert np.abs(m.system("absolute").v0 - dense).max() <= AGREES
    assert np.abs(dense).max() > 0.5


def test_what_cannot_be_met_is_told(few):
    few()
    m = four_bars(3)
    m.start({"rod1.angular_velocity": 1.0})         # beside that of rod0, which is parallel to it
    with pytest.raises(zd.InconsistentStart, match=r"'rod\d.angular_velocity' asks for a velocity that the joints, or what else"):
        zd.simulate(m.system("absolute"), 0.1, step=0.01)
    m = chain(3)
    m.start({"link1.angle": 0.3})
    with pytest.raises(zd.InconsistentStart, match="start from positions as they are drawn"):
        zd.simulate(m.system("absolute"), 0.1, step=0.01)


@pytest.mark.parametrize("make", [chain, four_bars, doubled, star])
def test_what_is_printed_is_what_dense_matrices_say(make, few):
    """But for reactions that are not determined, and of the rows that follow from others which of those that do."""
    dense = str(make(4)).splitlines()
    few()
    found = str(make(4)).splitlines()
    assert found[0] == dense[0]
    assert found[1].partition(" from others: ")[0] == dense[1].partition(" from others: ")[0]
    assert found[-1] == dense[-1]
    assert any("was not looked for among so many rows" in line for line in found) == (make is doubled)


def test_a_thousand_bodies_are_printed_and_start():
    """Dense matrices of 1800 rows are refused: what asked for them was refused, too."""
    m = four_bars(300)
    assert "freedom 1 (Gruebler 1); joint coordinates 601, 600 rows closing 300 loops at C0, C1, " in str(m)
    assert " and 260 others; absolute 1803, 1802 rows; no redundant rows" in str(m)
    sol = zd.simulate(m, 2e-3, step=1e-3)
    assert np.abs(sol.v[0][2:903:3] + 1.0).max() < 1e-10      # passed on by 300 couplers
