"""Mechanisms of so many rows that the core finds their start and what is printed, without dense matrices: as of few."""

import numpy as np
import pytest

import zerodrift as zd
from covering import draws
from large_mechanisms import chain, chain_of_balls, four_bars, spatial_chain, star
from zerodrift.mechanisms.assembly import assembly

AGREES = 1e-12
NEAREST = 1e-4      # steps towards the drawing end where they gain a millionth of the distance: a thousandth of a tenth is left,
ENDS = 0.1          # or as much as that where each step is four fifths of the one before, and none is stretched


def doubled(n):
    """Parallelograms with a pin that is there twice."""
    m = four_bars(n)
    m.revolute("A0 again", m.ground, m["rod0"].start)
    return m


@pytest.fixture
def few(monkeypatch):
    """Takes what is done for many rows from the first one on, once it is called."""
    return lambda: monkeypatch.setattr(assembly, "MAX_DENSE", 0)


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


def test_what_cannot_be_met_is_reported(few):
    few()
    m = four_bars(3)
    m.start({"rod1.angular_velocity": 1.0})         # beside that of rod0, which is parallel to it
    with pytest.raises(zd.InconsistentStart, match=r"velocities of 'rod\d.angular_velocity' and 'rod\d.angular_v.* contradict"):
        zd.simulate(m.system("absolute"), 0.1, step=0.01)
    m = chain(3)
    m.start({"link0.end.position.y": 1.5})          # of a link that is 1 m long
    with pytest.raises(zd.InconsistentStart, match=r"cannot be met .*nearest positions miss 'link0.end.position.y' by 0.5 m"):
        m.system("absolute").p0.any()
    m = chain(3)
    m.rod("rod", m["link0"].end, m["link2"].end, length=2.5)     # two links reach 2 m
    with pytest.raises(zd.CorrectionFailed, match=r"cannot all close: .*'rod' by "):
        m.system("absolute").p0.any()


def spatial_chain_of_hinges(n):
    return spatial_chain(n)


def distance(p, other):
    """From other positions, in the mass metric, of five links of 1 kg and 1 m; or of six with a hub, each row x, y, angle."""
    if p.size % 3 == 0:
        return np.linalg.norm((p - other).reshape(-1, 3) * np.sqrt([1.0, 1.0, 1 / 12]))
    p, other = p[:35].reshape(5, 7), other[:35].reshape(5, 7)
    half_angles = np.arccos(np.minimum(np.abs((p[:, 3:] * other[:, 3:]).sum(axis=1)), 1.0))
    return np.sqrt(((p - other)[:, :3]**2).sum() + (4 * half_angles**2).sum() / 12)       # they hardly turn about themselves


@pytest.mark.parametrize(("make", "held"), [
    (chain, {"link1.angle": 0.3}), (chain, {"link1.angle": 0.3, "link3.angle": -0.2, "link2.angular_velocity": 1.0}),
    (chain, {"link4.end.position.y": 1.0}), (doubled, {"rod2.angle": 1.2}), (star, {"link1.angle": 0.2, "hub.angle": 0.1}),
    (spatial_chain_of_hinges, {"link4.end.position.z": -1.0}),
    (spatial_chain_of_hinges, {"link1.end.position.z": -0.3, "link3.start.position.x": 2.9}),
    (spatial_chain_of_hinges, {"link1.end.position.z": -0.3, "link3.angular_velocity.y": 0.2})],
    ids=lambda given: getattr(given, "__name__", str(given)))
def test_positions_that_are_held(make, held, few):
    """The nearest to the drawing, in the mass metric: both ways end where a step gains less than a millionth of the distance."""
    m = make(5)
    if make is doubled:
        m.start({"rod0.angular_velocity": None})
    drawn = make(5).system("absolute").p0
    m.start(held)
    dense = m.system("absolute")
    p0, v0 = dense.p0, dense.v0
    few()
    found = m.system("absolute")
    assert np.abs(found.p0 - p0).max() <= ENDS
    assert np.abs(found.v0 - v0).max() <= ENDS * max(1.0, np.abs(v0).max())
    assert distance(found.p0, drawn) <= distance(p0, drawn) * (1 + NEAREST)


@pytest.mark.parametrize(("make", "held", "wish"), [
    (chain, {}, {"link1.angle": 0.3}), (chain, {"link3.angle": 0.1}, {"link1.angle": 0.3, "link4.angular_velocity": 1.0}),
    (four_bars, {}, {"rod1.angle": 1.2, "rod2.angle": 1.3, "rod2.angular_velocity": 3.0}),
    (spatial_chain_of_hinges, {"link2.angular_velocity.y": 0.1},
     {"link4.end.position.z": -0.5, "link4.end.velocity": (1, 1, 1)})],
    ids=lambda given: getattr(given, "__name__", None))
def test_wishes(make, held, wish, few):
    """As nearly as what is held allows: all of a single angle's, the mean of two that are one and the same."""
    def started():
        m = make(5)
        m.start({"rod0.angular_velocity": None} if make is four_bars else {})
        m.start(held, wish=wish)
        sol = zd.simulate(m.system("absolute"), 1e-3, step=1e-3)
        return [sol[name][0] for name in (*held, *wish)]

    dense = started()
    few()
    for name, value, expected in zip((*held, *wish), started(), dense, strict=True):
        assert np.abs(value - expected).max() <= NEAREST, name


@pytest.mark.parametrize(("make", "held"), [
    (chain, {"link9.end.position.x": 5.0}), (chain, {"link9.end.position.x": 5.0, "link9.end.position.y": 0.0}),
    (chain, {"link4.end.position.y": -4.5}), (chain_of_balls, {"link4.end.position.z": -4.0, "link9.end.position.y": 3.0}),
    (four_bars, {"bar2.angle": 0.3})], ids=lambda given: getattr(given, "__name__", None))
def test_what_is_far_from_the_drawing_is_reached(make, held, few):
    """From dead centres, too: the chain is drawn straight, and is pushed together; a parallelogram's bar turns only in a line."""
    few()
    m = make(10)
    if make is four_bars:
        m.start({"rod0.angular_velocity": None})
    m.start(held)
    sol = zd.simulate(m.system("absolute"), 1e-3, step=1e-3)      # which refuses positions that violate rows
    for name, value in held.items():
        assert abs(sol[name][0] - value) <= 1e-9


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


def test_a_truss_that_is_drawn_open_closes():
    """Two diagonals in each of 70 bays: bars are redundant, and each is drawn a hundredth aside."""
    rng, pins, bars = np.random.default_rng(0), {}, []
    m = zd.Mechanism("truss", gravity=(0, -9.81))
    for i in range(70):
        for a, b in (((i, 0), (i + 1, 0)), ((i, 1), (i + 1, 1)), ((i, 0), (i + 1, 1)), ((i + 1, 0), (i, 1)),
                     ((i + 1, 0), (i + 1, 1))):
            aside = 0.01 * rng.standard_normal(2)
            bar = m.link(f"bar{len(bars)}", a + aside, b + aside, mass=1.0)
            bars.append((a, b))
            for node, end in ((a, bar.start), (b, bar.end)):
                if node in pins:
                    m.revolute(f"pin{len(bars)}-{node[0]}-{node[1]}", pins[node], end)
                pins.setdefault(node, end)
    m.revolute("support", m.ground, pins[0, 0])
    p0 = m.system("absolute").p0.reshape(-1, 3)
    assert p0.size > 1000
    half = np.linalg.norm(np.diff(bars, axis=1)[:, 0], axis=1) / 2
    along = half[:, None] * np.stack([np.cos(p0[:, 2]), np.sin(p0[:, 2])], axis=1)
    places = {node: [] for node in pins}
    for (a, b), start, end in zip(bars, p0[:, :2] - along, p0[:, :2] + along, strict=True):
        places[a].append(start)
        places[b].append(end)
    assert max(np.ptp(at, axis=0).max() for at in places.values()) < 1e-10
    assert max(np.abs(at[0] - node).max() for node, at in places.items()) < 0.1


def test_joints_of_a_long_chain_that_cannot_close_are_named():
    m = chain(400)
    m.rod("rod", m["link0"].end, m["link2"].end, length=2.5)     # two links reach 2 m
    with pytest.raises(zd.CorrectionFailed, match=r"cannot all close: .*'rod' by "):
        m.system("absolute").p0.any()


def test_of_many_contradictions_some_are_named():
    """The hinges allow nothing of what is held."""
    m, n = spatial_chain(200), 200
    m.start({f"link{i}.angular_velocity": (1.0, 0.0, 0.0) for i in range(n)})
    with pytest.raises(zd.InconsistentStart, match=r"the velocities of .* and \d+ others contradict each other") as error:
        m.system("absolute").v0.any()
    assert len(str(error.value)) < 500


@pytest.mark.parametrize(("make", "n", "held"), [(chain, draws(60, 340), {"link50.end.position.y": -0.5}),
                                                 (chain_of_balls, draws(40, 170), {"link30.end.position.z": -0.5})])
def test_an_end_within_a_long_chain_is_held(make, n, held, few):
    """The minimum displacement in the mass metric bends few links, and these strongly; without dense matrices for any number."""
    few()
    m = make(n)
    m.start(held)
    p0 = m.system("absolute").p0.reshape(n, -1)
    number, across = int(next(iter(held))[4:].partition(".")[0]), p0.shape[1] == 7
    if across:      # along x as quaternion: ends are half a link from the centre
        w, x, y, z = p0[:, 3:].T
        ends = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], axis=1)
    else:
        ends = np.stack([np.cos(p0[:, 2]), np.sin(p0[:, 2])], axis=1)
    reached = np.cumsum(ends, axis=0)
    assert abs(reached[number, -1] + 0.5) < 1e-9
    assert np.abs(p0[:, : ends.shape[1]] - (reached - ends / 2)).max() < 1e-9        # the joints are closed


@pytest.mark.parametrize("make", [chain, four_bars, doubled, star])
def test_what_is_printed_is_what_dense_matrices_say(make, few):
    """Except reactions that are not determined, and of the redundant rows which of those that do."""
    dense = str(make(4)).splitlines()
    few()
    found = str(make(4)).splitlines()
    assert found[0] == dense[0]
    assert found[1].partition(" redundant: ")[0] == dense[1].partition(" redundant: ")[0]
    assert found[-1] == dense[-1]
    assert any("undetermined reactions are not listed for so many constraints" in line for line in found) == (make is doubled)


def test_a_thousand_bodies_are_printed_and_start():
    """Dense matrices of 1800 rows are refused: what asked for them was refused, too."""
    m = four_bars(300)
    assert "freedom 1 (Gruebler 1); joint coordinates 601, 600 constraints closing 300 loops at C0, C1, " in str(m)
    assert " and 260 others; absolute 1803, 1802 constraints; no redundant constraints" in str(m)
    sol = zd.simulate(m, 2e-3, step=1e-3)
    assert np.abs(sol.v[0][2:903:3] + 1.0).max() < 1e-10      # passed on by 300 couplers


def test_reactions_of_hundreds_of_bodies_are_read_from_a_run():
    """A pin bears what accelerates all links beyond it; a mechanism has some twenty measures for each body."""
    m, n, kept = chain(500), 500, 497
    sol = zd.simulate(m, 2e-3, step=1e-3)
    assert len(m.measures) > 8192
    beyond = sum(m[f"link{i}"].mass * (sol[f"link{i}.acceleration"][-1] - m.gravity) for i in range(kept, n))
    assert np.abs(sol[f"pin{kept}.force"][-1] - beyond).max() < 1e-9 * np.abs(beyond).max()
