"""References, kinematics and inverse dynamics of mechanisms with contacts, against closed forms."""

import numpy as np
import pytest

import zerodrift as zd
from zerodrift.studies.reference_runs import Motion

G = 9.81


def ball(restitution=0.8, ceiling=None):
    m = zd.Mechanism("ball", gravity=(0, -G))
    body = m.particle("ball", 2.0, at=(0, 1))
    m.contact("floor", body, m.ground.line((0, 0), (1, 0)), restitution=restitution)
    if ceiling:
        m.contact("ceiling", body, m.ground.line((1, ceiling), (0, ceiling)))
    return m


def height(t, restitution):
    """Height of a ball that falls 1 m, in closed form."""
    speed = np.sqrt(2 * G)
    if t < speed / G:
        return 1 - G * t**2 / 2
    t -= speed / G
    while t >= 2 * restitution * speed / G > 1e-9:
        speed *= restitution
        t -= 2 * speed / G
    return max(0.0, restitution * speed * t - G * t**2 / 2)


def box():
    m = zd.Mechanism("box", gravity=(0, -G))
    body = m.body("box", 2.0, 0.1, at=(0, 0.5))
    for name, x in (("left", -0.5), ("right", 0.5)):
        m.contact(name, body.point((x, -0.5)), m.ground.line((0, 0), (1, 0)), friction=(0.5, 0.4))
    return m


# ---- references ----

@pytest.mark.parametrize("restitution", [0.8, 0.3])
def test_a_reference_of_a_ball_that_bounces_is_certified_to_its_closed_form(restitution):
    ref = zd.reference(ball(restitution), 1.5)
    expected = [height(t, restitution) for t in ref.solution.t]
    assert abs(ref.solution["ball.position.y"] - expected).max() <= ref.error < 1e-12
    assert any(f"same sequence of {len(ref.solution.phases)} phases" in each for each in ref.caveats)
    assert any("bounces slower" in each for each in ref.caveats) == (restitution == 0.3)      # it has come to rest


def test_a_reference_names_the_contact_that_is_passed_most_closely():
    low = ball(1.0, ceiling=1.5)
    low.start({"ball.velocity.y": 3.0})
    ref = zd.reference(low, 1.0)
    gap = (0.5 - 9.0 / (2 * G)) / np.hypot(1, 1.5)      # 4 cm above the apex, relative to the size of the drawing
    said = next(each for each in ref.caveats if "smallest gap" in each)
    assert "'ceiling' at t = 0.3" in said
    assert float(said.split("shape is ")[1].split()[0]) == pytest.approx(gap, abs=1e-3)


def test_a_reference_of_friction_that_sticks_and_slides():
    m = zd.Mechanism("slider", gravity=(0, -G))
    slide = m.prismatic("slide", m.ground, m.body("block", 2.0, 0.1), at=(0, 0), axis=(1, 0), friction_force=(2.0, 1.0))
    m.motor("push", slide, force=lambda t: 3 * np.sin(t))
    ref, start = zd.reference(m, 3.0, t_eval=[0.5, 1.0, 2.0, 3.0]), np.arcsin(2 / 3)
    t = ref.solution.t - start
    x = (3 * (np.cos(start) * t - np.sin(ref.solution.t) + np.sin(start)) - t**2 / 2) / 2
    assert abs(ref.solution[slide.displacement] - np.where(t > 0, x, 0)).max() <= ref.error < 1e-12


def test_runs_of_a_reference_must_have_the_same_phases():
    """A ball that is stopped by the floor is not compared with one that bounces, however close they are before."""
    motion = Motion(ball().system(), (0.0, 1.0), None, None, None, "projection", "schur", dict.fromkeys(
        ("first_step", "max_step", "max_move")))
    ways = [zd.simulate(ball(restitution), 1.0, step=0.01, t_eval=motion.t_eval) for restitution in (0.8, 0.0)]
    assert not motion._differs_in_phases(ways[0], ways[0])
    assert motion._differs_in_phases(*ways)
    assert "floor closed in another one" in motion.disagreement


def test_a_reference_beyond_double_precision_is_refused():
    with pytest.raises(ValueError, match="double-double"):
        zd.reference(ball(), 1.0, precision="double-double")


# ---- kinematics and inverse dynamics ----

def test_a_box_is_pushed_along_the_floor():
    """Its height is that of the floor; the force is m a + mu m g, and the load moves to the rear foot by mu m g h."""
    m, t = box(), np.linspace(0.1, 1, 10)
    kin = zd.kinematics(m, {"box.position.x": lambda t: t**2}, t)
    assert kin["box.position.y"] == pytest.approx(np.full(10, 0.5), abs=1e-12)
    assert kin.system.phase == {"left": "closed", "right": "closed"}
    inv = zd.inverse_dynamics(m, kin)
    assert inv.system.phase == {"left": "sliding", "right": "sliding"}
    assert inv["box.position.x"] == pytest.approx(np.full(10, 2 * 2 + 0.4 * 2 * G), rel=1e-12)
    left, right = (inv[f"{name}.force"] for name in ("left", "right"))
    assert right[:, 1] - left[:, 1] == pytest.approx(np.full(10, 2 * 0.4 * 2 * G * 0.5), rel=1e-12)
    assert left + right == pytest.approx(np.tile([-0.4 * 2 * G, 2 * G], (10, 1)), rel=1e-12)


def test_a_contact_that_would_pull_and_friction_beyond_its_bound_are_named():
    m = box()
    m.force("lift", m["box"], along=(0, 1), value=30.0)
    still = 0.0, m.system().p0, np.zeros(3), np.zeros(3)
    with pytest.warns(zd.AccuracyWarning, match=r"pulls with 5\.19"):         # each foot half of 30 N - m g
        zd.inverse_dynamics(m, *still, efforts=[])
    m = box()
    m.force("push", m["box"], along=(1, 0), value=15.0)
    with pytest.warns(zd.AccuracyWarning, match="exceeds its bound"):
        zd.inverse_dynamics(m, *still, efforts=[])


def test_friction_of_a_pin_opposes_the_motion_that_is_given():
    """A rod that swings up past a horizontal one: m g / 2 + mu r |F| at the first sample, of F = (-m w^2 / 2, m g)."""
    m = zd.Mechanism("rod", gravity=(0, -G))
    rod = m.link("rod", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, rod.start, friction=0.3, radius=0.1)
    m.stop("stop", pin.angle, lower=-0.5, upper=0.5)
    kin = zd.kinematics(m, {pin.angle: lambda t: 0.3 * np.sin(2 * t)}, np.linspace(0, 0.7, 8))
    inv = zd.inverse_dynamics(m, kin)
    assert inv[pin.angle][0] == pytest.approx(G / 2 + 0.03 * np.hypot(0.18, G), rel=1e-9)
    with pytest.raises(ValueError, match="'pin' of rod is sliding backward at t = 0 and sliding forward"):
        zd.inverse_dynamics(m, zd.kinematics(m, {pin.angle: lambda t: 0.3 * np.cos(2 * t)}, [0.0, np.pi / 4, 2.0]))
    with pytest.warns(zd.AccuracyWarning, match=r"passes 'stop upper' by 0\.2"):
        far = zd.kinematics(m, {pin.angle: lambda t: 0.8 * np.sin(2 * t)}, np.linspace(0, 0.7, 8))
    with pytest.raises(zd.InconsistentStart, match="stop upper"):
        zd.inverse_dynamics(m, far)
