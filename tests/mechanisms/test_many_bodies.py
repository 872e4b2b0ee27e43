"""Mechanisms of so many rows that the core finds their start and what is printed, without dense matrices: as of few."""

import numpy as np
import pytest

import zerodrift as zd
from large_mechanisms import chain, four_bars, spatial_chain, star
from zerodrift.mechanisms import assembly

AGREES = 1e-12
NEAREST = 1e-4      # steps towards the drawing end where they gain a millionth of the distance: a thousandth of a tenth is left


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


@pytest.mark.parametrize("kind", ["spherical", "revolute"])
def test_all_links_of_a_long_chain_are_held(kind):
    """Angular velocities that hinges allow; the links lie along x, so that centres move by their sums. Dense, it is not made."""
    m, n = spatial_chain(200, kind), 200
    rng = np.random.default_rng(0)
    omega = rng.standard_normal((n, 3))
    if kind == "revolute":
        axes = np.array([(0, 1, 0), (0.3, 1, 0.2)])[np.arange(n) % 2]
        omega = np.cumsum(omega[:, :1] * axes, axis=0)
    m.start({f"link{i}.angular_velocity": omega[i] for i in range(n)})
    across = np.cross(omega, (1.0, 0.0, 0.0))
    center = np.cumsum(across, axis=0) - across / 2
    found = m.system("absolute").v0.reshape(n, 6)[:, :3]
    assert np.abs(found - center).max() <= AGREES * np.abs(center).max()


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
    with pytest.raises(zd.InconsistentStart, match=r"velocities of 'rod\d.angular_velocity' and 'rod\d.angular_v.* contradict"):
        zd.simulate(m.system("absolute"), 0.1, step=0.01)
    m = chain(3)
    m.start({"link0.end.position.y": 1.5})                   # of a link that is 1 m long
    with pytest.raises(zd.InconsistentStart, match="are not met: draw it nearer"):
        m.system("absolute").p0.any()
    for wish in ({"link1.angle": 0.3}, {"link1.angular_velocity": 0.3}):
        m = chain(3)
        m.start(wish=wish)
        with pytest.raises(zd.InconsistentStart, match="know no wishes"):
            m.system("absolute").v0.any()


def spatial_chain_of_hinges(n):
    return spatial_chain(n)


@pytest.mark.parametrize(("make", "held"), [
    (chain, {"link1.angle": 0.3}), (chain, {"link1.angle": 0.3, "link3.angle": -0.2, "link2.angular_velocity": 1.0}),
    (chain, {"link4.end.position.y": 1.0}), (doubled, {"rod2.angle": 1.2}), (star, {"link1.angle": 0.2, "hub.angle": 0.1}),
    (spatial_chain_of_hinges, {"link4.end.position.z": -1.0}),
    (spatial_chain_of_hinges, {"link1.end.position.z": -0.3, "link3.start.position.x": 2.9}),
    (spatial_chain_of_hinges, {"link1.end.position.z": -0.3, "link3.angular_velocity.y": 0.2})],
    ids=lambda given: getattr(given, "__name__", str(given)))
def test_positions_that_are_held(make, held, few):
    """The nearest to the drawing, in the mass metric."""
    m = make(5)
    if make is doubled:
        m.start({"rod0.angular_velocity": None})
    m.start(held)
    dense = m.system("absolute")
    p0, v0 = dense.p0, dense.v0
    few()
    found = m.system("absolute")
    assert np.abs(found.p0 - p0).max() <= NEAREST
    assert np.abs(found.v0 - v0).max() <= NEAREST * max(1.0, np.abs(v0).max())


def test_joints_that_are_drawn_open_close(few):
    def drawn():
        m = chain(4)
        last = m.link("last", (4.01, 0.02), (5, 0), mass=1.0)
        m.revolute("open", m["link3"].end, last.start)
        m.motor("drive", m["pin1"], angle=lambda t: 0.1 + t)
        return m.system("absolute")

    dense = drawn()
    p0, v0 = dense.p0, dense.v0
    few()
    assert np.abs(drawn().p0 - p0).max() <= NEAREST
    assert np.abs(drawn().v0 - v0).max() <= NEAREST


def test_of_many_contradictions_some_are_named():
    """The hinges allow nothing of what is held."""
    m, n = spatial_chain(200), 200
    m.start({f"link{i}.angular_velocity": (1.0, 0.0, 0.0) for i in range(n)})
    with pytest.raises(zd.InconsistentStart, match=r"the velocities of .* and \d+ others contradict each other") as error:
        m.system("absolute").v0.any()
    assert len(str(error.value)) < 500


def test_a_position_of_a_long_chain_is_held():
    """Of 340 links one is turned; dense matrices of 1020 columns are not made."""
    m = chain(340)
    m.start({"link200.angle": 0.05})
    p0 = m.system("absolute").p0.reshape(340, 3)
    ends = np.stack([np.cos(p0[:, 2]), np.sin(p0[:, 2])], axis=1)
    assert abs(p0[200, 2] - 0.05) < 1e-12
    assert np.abs(p0[:, :2] - (np.cumsum(ends, axis=0) - ends / 2)).max() < 1e-9      # the joints are closed


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
