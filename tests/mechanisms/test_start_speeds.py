"""Start velocities that drives leave undetermined: least kinetic energy relative to driven bodies."""

import itertools

import numpy as np
import pytest
from scipy.optimize import minimize

import zerodrift as zd
from support import assert_close

LAYOUTS = ["joint", "absolute"]
SPEED = 2 * np.pi       # m/s of the shaker at the start: 0.02 m sin(100 pi t)
TIP = 0.3 * np.array([np.sin(0.3), np.cos(0.3)])


def shake(t):
    return 0.02 * np.sin(100 * np.pi * t)


def placed(m, *place):
    return (*place, *(0,) * (m.dimension - 2))


def about_z(m):
    return {"axis": (0, 0, 1)} if m.dimension == 3 else {}


def prismatic_body(m, mass=0.01):
    pivot = m.body("pivot", mass, 1e-6 if m.dimension == 2 else (1e-6,) * 3, at=placed(m, 0, 0))
    m.prismatic("shaker", m.ground, pivot, axis=placed(m, 0, 1))
    return pivot.point(placed(m, 0, 0))


def moved_body(m):
    pivot = prismatic_body(m)
    m.motor("drive", "shaker", displacement=shake)
    return pivot


def heavy_body(m):
    pivot = prismatic_body(m, 100.0)
    m.motor("drive", "shaker", speed=SPEED)
    return pivot


def related_body(m):
    pivot = prismatic_body(m)
    m.constraint("relation", lambda y, t: y - 0.02 * np.sin(100 * np.pi * t), of={"y": "shaker.displacement"})
    return pivot


def pushed_body(m):
    pivot = prismatic_body(m)
    m.actuator("cylinder", m.ground.point(placed(m, 0, -1)), pivot, length=lambda t: 1 + 0.02 * np.sin(100 * np.pi * t))
    return pivot


def moved_particle(m):
    pivot = m.particle("pivot", 0.01, at=placed(m, 0, 0))
    m.motor("drive", m.slot("shaker", m.ground, pivot, axis=placed(m, 0, 1)), displacement=shake)
    return pivot


def prescribe(m, place):
    for axis in "xyz"[:m.dimension]:
        law = (lambda y, t: y - 0.02 * np.sin(100 * np.pi * t)) if axis == "y" else lambda y, t: y
        m.constraint(axis, law, of={"y": getattr(place.position, axis)})


def prescribed_particle(m):
    pivot = m.particle("pivot", 0.01, at=placed(m, 0, 0))
    prescribe(m, pivot)
    return pivot


SHAKERS = [moved_body, heavy_body, related_body, pushed_body, moved_particle, prescribed_particle]


def hang_rod(m, pivot):
    m.rod("rod", pivot, m.particle("bob", 0.1, at=placed(m, *TIP)))


def hang_link(m, pivot):
    bar = m.link("bar", placed(m, 0, 0), placed(m, *TIP), mass=0.1)
    m.revolute("pin", pivot, bar.start) if m.dimension == 2 else m.spherical("pin", pivot, bar.start)
    return bar


def hang_links(m, pivot):
    other = m.link("other", placed(m, *TIP), placed(m, 0.5, 0.5), mass=0.3)
    m.revolute("elbow", hang_link(m, pivot).end, other.start, **about_z(m))
    m.rod("rod", other.end, m.particle("bob", 0.1, at=placed(m, 0.7, 0.1)))


def rates(m, layout):
    """Velocities (bodies, dimension) and angular velocities at the start, in the order of the bodies."""
    sol = zd.simulate(m.system(layout), 1e-5, step=1e-5)
    turning = [f"{body.name}.angular_velocity" for body in m.bodies if body.turns]
    return np.array([sol[f"{body.name}.velocity"][0] for body in m.bodies]), np.array([sol[name][0] for name in turning])


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("shaker", SHAKERS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_what_hangs_on_a_shaker_starts_with_it(dimension, shaker, layout):
    for hang in (hang_rod, hang_link, hang_links):
        m = zd.Mechanism("shaken", dimension=dimension, gravity=(0, -9.81, 0)[:dimension])
        hang(m, shaker(m))
        velocity, spin = rates(m, layout)
        assert_close(velocity, np.tile(placed(m, 0, SPEED), (len(velocity), 1)), 1e-11)
        assert_close(spin, np.zeros_like(spin), 1e-10, scale=1.0)


def slotted(m, bar):
    m.motor("drive", m.slot("shaker", m.ground, bar.start, axis=placed(m, 0, 1)), displacement=shake)


def pushed(m, bar):
    m.slot("shaker", m.ground, bar.start, axis=placed(m, 0, 1))
    m.actuator("cylinder", m.ground.point(placed(m, 0, -1)), bar.start, length=lambda t: 1 + 0.02 * np.sin(100 * np.pi * t))


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("drive", [slotted, pushed, lambda m, bar: prescribe(m, bar.start)])
def test_a_bar_whose_end_is_driven_translates(drive, layout):
    """Also in space, where a joint at another point keeps it in its plane."""
    m = zd.Mechanism("bar", gravity=(0, -9.81))
    drive(m, m.link("bar", (0, 0), TIP, mass=0.1))
    flat = zd.Mechanism("bar", dimension=3)
    bar = flat.link("bar", (0, 0, 0), (*TIP, 0), mass=0.1)
    drive(flat, bar)
    flat.planar("plane", flat.ground, bar, normal=(0, 0, 1), at=(0.1, 0.1, 0))
    for each in (m, flat):
        velocity, spin = rates(each, layout)
        assert_close(velocity[0], placed(each, 0, SPEED), 1e-11)
        assert_close(spin, np.zeros_like(spin), 1e-10, scale=1.0)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_load_on_a_rope_that_shortens_starts_along_the_rope_beside_its_trolley(dimension, layout):
    m = zd.Mechanism("crane", dimension=dimension)
    trolley, load = m.particle("trolley", 1.0, at=placed(m, 0, 0)), m.particle("load", 50.0, at=placed(m, 0.6, -0.8))
    m.motor("drive", m.slot("rail", m.ground, trolley, axis=placed(m, 1, 0)), speed=2.0)
    m.actuator("rope", trolley, load, length=lambda t: 1 - 0.5 * t)
    velocity, _ = rates(m, layout)
    assert_close(velocity, [placed(m, 2, 0), placed(m, 2 - 0.5 * 0.6, 0.5 * 0.8)], 1e-12)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_what_hangs_on_a_driven_crank_turns_with_it(dimension, layout):
    for hang in ("rod", "link"):
        m = zd.Mechanism("crank", dimension=dimension)
        crank = m.link("crank", placed(m, 0, 0), placed(m, 0, 1), mass=1.0)
        m.motor("drive", m.revolute("pin", m.ground, crank.start, **about_z(m)), speed=3.0)
        if hang == "rod":
            m.rod("rod", crank.end, m.particle("bob", 2.0, at=placed(m, 0.5, 0.4)))
        else:
            m.revolute("hinge", crank.end, m.link("bob", placed(m, 0.5, 0.4), placed(m, 0, 1), mass=2.0).end, **about_z(m))
        velocity, _ = rates(m, layout)
        assert_close(velocity[1], placed(m, -3 * 0.4, 3 * 0.5), 1e-12)


def five_bar(dimension):
    m = zd.Mechanism("five-bar", dimension=dimension)
    places = [placed(m, *each) for each in ((0, 0), (0, 1), (1, 2), (2, 1), (2, 0))]
    links = [m.link(name, *ends, mass=1.0) for name, ends in zip("abcd", itertools.pairwise(places), strict=True)]
    for name, one, other in zip("ABCDE", [m.ground, *(link.end for link in links)],
                                [*(link.start for link in links), m.ground.point(places[-1])], strict=True):
        m.revolute(name, one, other, **about_z(m))
    m.motor("left", "A", speed=1.0)
    return m


def five_bar_rates(dimension):
    """Angular velocities of least kinetic energy of four links of 1 kg, from the places of the hinges; thick ones in space."""
    places = np.array([(0, 0), (0, 1), (1, 2), (2, 1), (2, 0)], dtype=float)
    arms, lengths = np.diff(places, axis=0), np.hypot(*np.diff(places, axis=0).T)

    def ends(w):
        return np.vstack([np.zeros(2), np.cumsum(w[:, None] * np.stack([-arms[:, 1], arms[:, 0]], axis=1), axis=0)])

    def energy(w):
        middle = (ends(w)[1:] + ends(w)[:-1]) / 2
        return np.sum(middle**2) + np.sum(lengths**2 * (1 / 12 + (dimension - 2) / 6400) * w**2)

    rows = [{"type": "eq", "fun": lambda w: w[0] - 1}, {"type": "eq", "fun": lambda w: ends(w)[-1]}]
    return minimize(energy, np.zeros(4), constraints=rows, method="SLSQP", tol=1e-15).x


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_loop_moves_with_least_energy_and_is_listed(dimension, layout):
    m = five_bar(dimension)
    _, spin = rates(m, layout)
    assert_close(spin.reshape(4, -1)[:, -1], five_bar_rates(dimension), 1e-6)
    assert "starts moving, with the least energy: B.speed = -1.57 rad/s, D.speed = -0.714 rad/s, E.speed = 0.143 rad/s" in str(m)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_loop_on_a_moving_base_moves_in_it_as_on_the_ground(layout):
    m = zd.Mechanism("five-bar on a trolley")
    trolley = m.body("trolley", 1.0, 1.0, at=(0, 0))
    m.motor("drive", m.prismatic("rail", m.ground, trolley, axis=(1, 0)), speed=4.0)
    places = (0, 0), (0, 1), (1, 2), (2, 1), (2, 0)
    links = [m.link(name, *ends, mass=1.0) for name, ends in zip("abcd", itertools.pairwise(places), strict=True)]
    for name, one, other in zip("ABCDE", [trolley.point((0, 0)), *(link.end for link in links)],
                                [*(link.start for link in links), trolley.point((2, 0))], strict=True):
        m.revolute(name, one, other)
    m.motor("left", "A", speed=1.0)
    _, spin = rates(m, layout)
    assert_close(spin[1:], five_bar_rates(2), 1e-6)


def test_nothing_is_listed_that_drives_determine_or_that_rests():
    for m in (zd.models.four_bar(), zd.models.delta_robot()):
        assert "starts moving" not in str(m)
    m = zd.Mechanism("shaken")
    hang_link(m, m.body("pivot", 1.0, 1.0, at=(0, 0)))
    assert "starts moving" not in str(m)


def robot(dimension):
    """Three driven joints, a link that hangs on the last arm, and a particle that hangs by a rod on the link."""
    m = zd.Mechanism("robot", dimension=dimension, gravity=(0, -9.81, 0)[:dimension])
    places = [placed(m, *each) for each in ((0, 0), (0, 1), (0.8, 1.4), (1.5, 1.1), (1.6, 0.6))]
    before = m.ground
    for i, ends in enumerate(itertools.pairwise(places)):
        arm = m.link(f"arm{i}", *ends, mass=1.0 + i)
        pin = m.revolute(f"pin{i}", before, arm.start, **about_z(m))
        if i < 3:
            m.motor(f"drive{i}", pin, speed=(1.0, -3.0, 2.5)[i])
        before = arm.end
    m.rod("rod", before, m.particle("bob", 0.5, at=placed(m, 1.3, 0.4)))
    return m


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_what_hangs_on_a_robot_moves_with_its_last_arm_and_is_listed(dimension, layout):
    m = robot(dimension)
    velocity, spin = rates(m, layout)
    turns = np.cumsum([1.0, -3.0, 2.5, 0.0])
    joints, bob = np.array([(0, 0), (0, 1), (0.8, 1.4)]), np.array([1.3, 0.4])
    expected = sum(rate * np.array([-each[1], each[0]]) for rate, each in zip((1.0, -3.0, 2.5), bob - joints, strict=True))
    assert_close(spin.reshape(4, -1)[:, -1], turns, 1e-11)
    assert_close(velocity[-1, :2], expected, 1e-11)
    assert "starts moving, at rest relative to what it hangs on: arm3" in str(m)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_constraints_that_agree_by_accident_carry_nothing(layout):
    """A crank whose tip moves along the slot of the last link's end: all could translate with the tip, at this instant only."""
    found = []
    for x in (0.0, 1e-6):
        m = zd.Mechanism("crank")
        links = [m.link(name, *ends, mass=1.0) for name, ends in
                 zip("abc", itertools.pairwise([(0, 0), (x, 1), (1, 2), (2, 1)]), strict=True)]
        for name, one, link in zip("ABC", [m.ground, *(link.end for link in links[:-1])], links, strict=True):
            m.revolute(name, one, link.start)
        m.slot("slot", m.ground, links[-1].end, axis=(1, 0))
        m.motor("drive", "A", speed=1.0)
        found.append(rates(m, layout)[1])
    assert_close(found[0], found[1], 1e-5)
    assert np.abs(found[0][1:]).min() > 0.1


def test_many_runs_start_as_single_ones():
    m = zd.Mechanism("shaken", gravity=(0, -9.81))
    hang_link(m, moved_particle(m))
    driven = five_bar(2)
    for each, name, values in ((m, "bar.mass", [0.1, 0.2, 0.3]), (driven, "b.mass", [1.0, 2.0, 3.0])):
        measure = "bar.angular_velocity" if each is m else "E.speed"
        ens = zd.ensemble(each, 1e-3, parameters={name: values}, step=1e-3, outputs=[measure])
        single = [zd.simulate(each.with_parameters({name: value}), 1e-3, step=1e-3)[measure][0] for value in values]
        assert_close(ens[measure][:, 0], single, 1e-11, scale=1.0)
