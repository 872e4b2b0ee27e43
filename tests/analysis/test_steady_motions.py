"""Steady motions are orbits of a symmetry: closed forms of those that are, and what is steady for an instant only."""
import numpy as np
import pytest
from scipy.optimize import brentq

import zerodrift as zd

G = 9.81
LAYOUTS = ["joint", "absolute"]


def rotor(dimension, layout, gravity=None):
    """A disc of 10 kg on a spring of 4e4 N/m, its mass centre 1 mm aside of the spring's point."""
    z = (0.0,) * (dimension - 2)
    m = zd.Mechanism("rotor", dimension=dimension, gravity=gravity)
    disc = m.body("disc", 10.0, 0.02 if dimension == 2 else (0.02, 0.02, 0.02), com=(1e-3, 0, *z))
    if dimension == 3:
        m.planar("table", m.ground, disc, normal=(0, 0, 1), at=(0, 0, 0))
    m.bushing("support", m.ground.point((0, 0, *z)), m.point("hub", disc, (0, 0, *z)), stiffness=4e4)
    return m.system(layout)


@pytest.mark.parametrize(("ratio", "dimension", "layout"), [(0.5, 2, "absolute"), (1.5, 2, "joint"), (0.5, 3, "joint"),
                                                            (1.5, 3, "absolute")])
def test_an_unbalanced_rotor_whirls(ratio, dimension, layout):
    """Its centre on a circle of e r^2 / |1 - r^2|, r the speed by the critical one."""
    turns = "disc.angular_velocity" + ("" if dimension == 2 else ".z")
    eq = zd.equilibrium(rotor(dimension, layout), v={turns: ratio * np.sqrt(4e4 / 10)})
    assert np.hypot(*eq["hub.position"][:2]) == pytest.approx(1e-3 * ratio**2 / abs(1 - ratio**2), rel=1e-7)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("speed", [1.0, 3.0])
def test_a_puck_on_a_spring_circles(speed, layout):
    """Drawn with the spring slack; k (r - L) = m v^2 / r."""
    m = zd.Mechanism("puck")
    puck = m.particle("puck", 2.0, at=(1, 0))
    m.spring("spring", m.ground.point((0, 0)), puck, stiffness=200.0, length=1.0)
    eq = zd.equilibrium(m.system(layout), v={"puck.velocity.x": 0.0, "puck.velocity.y": speed})
    assert np.hypot(*eq["puck.position"]) == pytest.approx((1 + np.sqrt(1 + 8 * speed**2 / 200)) / 2, rel=1e-9)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_satellite_circles_a_centre_aside_of_the_origin(layout):
    m = zd.Mechanism("satellite")
    body = m.particle("body", 1.0, at=(3.3, 1.0))
    of = {"x": body.position.x, "y": body.position.y}
    m.force("pull x", body, along=(1, 0), value=lambda x, y: -4 * (x - 2) / ((x - 2)**2 + (y - 1)**2)**1.5, of=of)
    m.force("pull y", body, along=(0, 1), value=lambda x, y: -4 * (y - 1) / ((x - 2)**2 + (y - 1)**2)**1.5, of=of)
    eq = zd.equilibrium(m.system(layout), v={"body.velocity.x": 0.0, "body.velocity.y": 1.6})
    assert np.hypot(*(eq["body.position"] - (2, 1))) == pytest.approx(4 / 1.6**2, rel=1e-8)


def conical(layout):
    m = zd.Mechanism("conical", dimension=3, gravity=(0, 0, -G))
    bob = m.particle("bob", 1.0, at=(0.5 * np.sin(0.6), 0, -0.5 * np.cos(0.6)))
    m.rod("rod", m.ground.point((0, 0, 0)), bob)
    return m.system(layout)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_conical_pendulum_and_its_small_motions(layout):
    """G tan(a) = L w^2 sin(a), and the angle oscillates with w sqrt(1 + 3 cos(a)^2)."""
    speed = 1.2
    angle = brentq(lambda a: 0.5 * G * np.sin(a)**2 / np.cos(a) - speed**2, 0.1, 1.5)
    eq = zd.equilibrium(conical(layout), v={"bob.velocity.x": 0.0, "bob.velocity.y": speed})
    assert -eq["bob.position.z"] == pytest.approx(0.5 * np.cos(angle), rel=1e-8)
    small = speed / (0.5 * np.sin(angle)) * np.sqrt(1 + 3 * np.cos(angle)**2)
    assert sorted(np.abs(eq.eigenvalues)) == pytest.approx([small, small], rel=1e-7)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_bob_on_a_driven_shaft(layout):
    """On a rod hinged aside of the axis: w^2 (b + l sin(a)) l cos(a) = G l sin(a)."""
    m, speed = zd.Mechanism("governor", dimension=3, gravity=(0, 0, -G)), 7.0
    shaft = m.body("shaft", 1.0, (0.1, 0.1, 0.1), at=(0, 0, 0))
    bob = m.particle("bob", 1.0, at=(0.1 + 0.4 * np.sin(0.7), 0, -0.4 * np.cos(0.7)))
    bearing = m.revolute("bearing", m.ground, shaft, at=(0, 0, 0), axis=(0, 0, 1))
    m.rod("rod", shaft.point((0.1, 0, 0)), bob)
    m.motor("motor", bearing, speed=speed)
    m.start({"bob.velocity.y": speed * (0.1 + 0.4 * np.sin(0.7))})
    angle = brentq(lambda a: speed**2 * (0.1 + 0.4 * np.sin(a)) * np.cos(a) - G * np.sin(a), 0.1, 1.5)
    eq = zd.equilibrium(m.system(layout), v={"bearing.speed": speed})
    assert eq["bob.position.z"] == pytest.approx(-0.4 * np.cos(angle), rel=1e-8)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_block_slides_down_against_viscous_friction(layout):
    m = zd.Mechanism("incline", gravity=(0, -G))
    block = m.body("block", 2.0, 0.1, at=(0, 0))
    m.prismatic("slope", m.ground, block, axis=(np.cos(0.3), -np.sin(0.3)), at=(0, 0), damping=3.0)
    assert zd.equilibrium(m.system(layout), v={})["slope.speed"] == pytest.approx(2 * G * np.sin(0.3) / 3, rel=1e-10)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_what_is_steady_for_an_instant_is_refused(layout):
    """The force that changes is named: the support of a rotor whose weight turns, a spring, a pin."""
    m = zd.Mechanism("slack")
    puck = m.particle("puck", 2.0, at=(1, 0))
    m.spring("spring", m.ground.point((0, 0)), puck, stiffness=200.0, length=1.0)
    with pytest.raises(zd.EquilibriumFailed, match=r"'spring\.force' changes along its orbit"):
        zd.equilibrium(m.system(layout), v={"puck.velocity.x": 1.0, "puck.velocity.y": 0.0})
    with pytest.raises(zd.EquilibriumFailed, match=r"'support\.force' changes along its orbit"):
        zd.equilibrium(rotor(2, layout, gravity=(0, -G)), v={"disc.angular_velocity": 30.0})
    m = zd.Mechanism("pinned", gravity=(0, -G))
    m.revolute("pin", m.ground, m.body("disc", 10.0, 0.02, com=(1e-3, 0)), at=(0, 0))
    with pytest.raises(zd.EquilibriumFailed, match=r"'pin\.force' changes along its orbit"):
        zd.equilibrium(m.system(layout), v={"pin.speed": 30.0})


def test_a_rotor_at_its_centre_is_not_linearized_as_steady():
    """A state that is steady for an instant is flagged there, too."""
    system = rotor(2, "absolute")
    with pytest.warns(zd.AccuracyWarning, match="not in an equilibrium or a steady motion"):
        zd.linearize(system, (0.0, system.p0, [0.0, 0.06, 60.0]))


def test_a_crank_is_not_a_steady_motion():
    with pytest.raises(zd.EquilibriumFailed, match="changes along its orbit"):
        zd.equilibrium(zd.models.slider_crank(), v={"crank.angular_velocity": 5.0})
