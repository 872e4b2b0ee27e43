"""Mechanisms that balance wherever they are put: weights in balance with springs or with other weights, whose moments cancel."""
import numpy as np
import pytest

import zerodrift as zd

G = 9.81
ANGLES = np.linspace(-2.9, 3.0, 6)


def mechanism(dimension):
    return zd.Mechanism("scene", dimension=dimension, gravity=(0, -G) if dimension == 2 else (0, 0, -G))


def on_hinge(m, angle, distances, masses, sprung=0.0, stiffness=0.0):
    """Bodies on one hinge at the origin, and a spring of length zero from above it to a point of the first body."""
    def along(x):
        return (x * np.cos(angle), x * np.sin(angle)) if m.dimension == 2 else (0.0, x * np.cos(angle), x * np.sin(angle))
    bodies = [m.body(f"body{i}", mass, 0.01 if m.dimension == 2 else (0.01, 0.02, 0.03), at=along(x))
              for i, (x, mass) in enumerate(zip(distances, masses, strict=True))]
    origin = along(0.0)
    m.revolute("hinge", m.ground, bodies[0], at=origin, **({} if m.dimension == 2 else {"axis": (1, 0, 0)}))
    for other in bodies[1:]:
        m.weld(f"{other.name} weld", bodies[0], other, at=origin)
    if stiffness:
        above, point = m.ground.point((*origin[:-1], 0.3)), bodies[0].point(along(sprung - distances[0]))
        m.spring("spring", above, point, stiffness=stiffness, length=0.0)
    return m


def lamp(dimension, angle, excess=0.0):
    """An arm of 1.3 kg whose spring balances it: stiffness * height * lever = weight * distance."""
    return on_hinge(mechanism(dimension), angle, [0.35], [1.3], sprung=0.1, stiffness=(1 + excess) * 1.3 * G * 0.35 / (0.3 * 0.1))


def see_saw(dimension, angle):
    return on_hinge(mechanism(dimension), angle, [0.37, -0.37 / 1.7], [1.1, 1.1 * 1.7])


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("scene", [lamp, see_saw])
def test_what_balances_anywhere_stays(scene, dimension, coordinates):
    for angle in ANGLES:
        system = scene(dimension, angle).system(coordinates)
        eq = zd.equilibrium(system)
        np.testing.assert_allclose(eq.p, system.p0, rtol=0, atol=1e-9)
        assert len(eq.free) == 1
        assert eq.stable


@pytest.mark.parametrize(("excess", "angle"), [(1e-2, np.pi / 2), (-1e-4, -np.pi / 2), (1e-6, np.pi / 2)])
def test_a_lamp_out_of_balance_leaves(excess, angle):
    """The spring lifts it upright, or its weight lets it hang, however little of them is left."""
    eq = zd.equilibrium(lamp(2, 0.4, excess).system("joint"))
    assert eq["hinge.angle"] + 0.4 == pytest.approx(angle, abs=1e-7)
    assert eq.stable
    assert not eq.free


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_a_ball_joint_in_balance_is_free_about_three_axes(coordinates):
    m = mechanism(3)
    arm = m.body("arm", 2.0, (0.01, 0.02, 0.02), at=(0.12, 0.16, 0.15))
    m.spherical("socket", m.ground, arm, at=(0, 0, 0))
    m.spring("spring", m.ground.point((0, 0, 0.4)), arm.point((-0.06, -0.08, -0.075)), stiffness=2 * G / (0.4 * 0.5), length=0.0)
    eq = zd.equilibrium(m.system(coordinates))
    np.testing.assert_allclose(eq["arm.position"], (0.12, 0.16, 0.15), atol=1e-9)
    assert len(eq.free) == 3


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_balloon_is_free_in_all_directions(dimension):
    m = mechanism(dimension)
    balloon = m.particle("balloon", 0.7, at=(0.3, -0.2, 0.1)[:dimension])
    m.force("lift", balloon, along=(0, 0, 1)[3 - dimension:], value=0.7 * G)
    assert len(zd.equilibrium(m).free) == dimension


def test_a_lamp_of_two_arms_stays_where_it_is_put():
    m = mechanism(2)
    lower, guide = m.link("lower", (0, 0), (0.12, 0.38), mass=0.3), m.link("guide", (0.04, 0), (0.16, 0.38), mass=0.1)
    elbow, upper = m.link("elbow", (0.12, 0.38), (0.16, 0.38), mass=0.2), m.link("upper", (0.12, 0.38), (0.46, 0.56), mass=0.8)
    for i, (one, other) in enumerate([(m.ground, lower.start), (m.ground, guide.start), (lower.end, elbow.start),
                                      (guide.end, elbow.end), (elbow, upper.start)]):
        m.revolute(f"pin{i}", one, other)
    low = (0.3 / 2 + 0.1 / 2 + 0.2 + 0.8) * G * np.hypot(0.12, 0.38)
    m.spring("low", m.ground.point((0, 0.12)), lower.point((0.08, 0)), stiffness=low / (0.08 * 0.12), length=0.0)
    m.spring("high", elbow.point((0, 0.12)), upper.point((0.08, 0)), stiffness=0.4 * G * np.hypot(0.34, 0.18) / (0.08 * 0.12),
             length=0.0)
    for a, b in [(0.7, -0.5), (1.5, 0.3), (2.3, 1.1)]:
        eq = zd.equilibrium(m, near={"lower.angle": a, "upper.angle": b})
        assert (eq["lower.angle"], eq["upper.angle"]) == pytest.approx((a, b), abs=1e-9)
        assert len(eq.free) == 2
