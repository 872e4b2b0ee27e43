"""Discs, spheres, ellipsoids that roll, and blades that glide, in space."""

import numpy as np
import pytest

import zerodrift as zd
from reference_files import table
from support import assert_close
from zerodrift._private.rotations import rotation_of

EXACT = {"integrator": "dop853", "step": None, "rtol": 1e-12, "atol": 1e-12}


def disc(reference):
    """The thin disc of the reference file, whose axle is the x axis of its frame."""
    at, q, spin = (np.array([reference[name][0] for name in names.split()]) for names in ("x y z", "e0 e1 e2 e3", "w1 w2 w3"))
    m = zd.Mechanism("disc", dimension=3, gravity=(0, 0, -9.81))
    body = m.body("disc", 1.0, (0.125, 0.0625, 0.0625), at=at, rotation=q)
    m.rolling("floor", m.ground, body, radius=0.5, axle=rotation_of(q)[:, 0])
    m.start({"disc.angular_velocity": rotation_of(q) @ spin})
    return m


def test_the_rolling_disc_of_its_reference(formulation):
    reference = table("rolling_disc")
    end = 101 if formulation == "schur" else 11
    sol = zd.simulate(disc(reference), reference["t"][end - 1], t_eval=reference["t"][:end], formulation=formulation, **EXACT)
    for axis in "xyz":
        assert_close(sol[f"disc.position.{axis}"], reference[axis][:end], 1e-9, scale=1.0)
        assert_close(sol[f"disc.velocity.{axis}"], reference[f"v{axis}"][:end], 1e-9, scale=1.0)
    assert_close(sol["floor.force.z"], -reference["lam_N"][:end], 1e-8)
    assert np.abs(sol.energy_violation).max() < 1e-10
    carried = sol["disc.acceleration"] + (0, 0, 9.81)
    assert_close(sol["floor.force"], carried, 1e-8)


def test_a_sphere_down_a_slope():
    """A solid sphere rolls down with 5/7 of what it would slide with; what spins about the normal goes on."""
    slope = np.array([0.0, 0.6, 0.8])
    m = zd.Mechanism("sphere", dimension=3, gravity=(0, 0, -9.81))
    ball = m.body("ball", 2.0, [2 / 5 * 2.0 * 0.01] * 3, at=0.1 * slope + (0.3, 0.4, -0.3))
    m.rolling("slope", m.ground, ball, radius=0.1, normal=slope)
    m.start({ball.angular_velocity: 3.0 * slope})
    sol = zd.simulate(m, 1.0, step=5e-3, integrator="dop853")
    down = np.array([0.0, 0.8, -0.6])
    moved = sol["ball.position"] - sol["ball.position"][0]
    assert_close(moved, 0.5 * 5 / 7 * 9.81 * 0.6 * sol.t[:, None]**2 * down, 1e-11)
    assert_close(sol["ball.angular_velocity"] @ slope, np.full(len(sol.t), 3.0), 1e-11)
    assert_close(sol["slope.force"][50], 2 * 9.81 * (0.8 * slope - 2 / 7 * 0.6 * down), 1e-10)


def test_a_spheroid_that_rolls_on_its_equator_and_one_that_rocks():
    """On a circle of its equator it is a wheel; stood a little aside from its short axis, it rocks and keeps its energy."""
    m = zd.Mechanism("wheel", dimension=3, gravity=(0, 0, -9.81))
    body = m.body("egg", 1.0, (0.1, 0.12, 0.1), at=(0, 0, 0.5))
    m.rolling("floor", m.ground, body, semiaxes=(0.5, 0.2, 0.5))
    m.start({body.angular_velocity: (0, 2.0, 0)})
    sol = zd.simulate(m, 1.0, step=0.02)
    assert_close(sol["egg.position"], np.stack([sol.t, 0 * sol.t, 0 * sol.t + 0.5], axis=1), 1e-10)
    m.start({body.angular_velocity: (0.3, 1.0, 0.2)})
    sol = zd.simulate(m, 1.0, **EXACT)
    assert np.abs(sol.energy_violation).max() < 1e-9
    assert np.ptp(sol["egg.position.z"]) > 0.01


@pytest.mark.parametrize("normal", [None, (0, 0, 1)])
def test_a_sleigh_on_level_ice_is_that_of_the_plane(normal):
    plane = zd.Mechanism("plane")
    sleigh = plane.body("sleigh", 1.0, 0.2, com=(0.3, 0))
    plane.knife_edge("blade", sleigh.point((0, 0)), along=(1, 0))
    plane.start({"sleigh.velocity.x": 1.0, "sleigh.angular_velocity": 2.0})
    space = zd.Mechanism("space", dimension=3)
    body = space.body("sleigh", 1.0, (0.1, 0.15, 0.2), com=(0.3, 0, 0))
    space.planar("ice", space.ground, body, normal=(0, 0, 1))
    blade = space.knife_edge("blade", body.point((0, 0, 0)), along=(1, 0, 0), normal=normal)
    space.start({body.velocity.x: 1.0, body.angular_velocity.z: 2.0})
    one, other = (zd.simulate(m, 2.0, integrator="dop853", step=0.02) for m in (plane.system("absolute"), space))
    for name in ("sleigh.position", "sleigh.velocity", "blade.force"):
        assert_close(other[name][:, :2], one[name], 1e-9)
    assert_close(other["blade.force.z"], np.zeros(len(one.t)), 1e-12, scale=1.0)
    assert str(blade) == "<knife_edge blade: ground - sleigh>"


def test_radii_change_by_path():
    m = disc(table("rolling_disc"))
    system = m.with_parameters({"floor.radius": 0.4})
    axle = rotation_of(system.p0[3:])[:, 0]
    assert_close(system.p0[2], np.float64(0.4 * np.sqrt(1 - axle[2]**2)), 1e-11)
    egg = zd.Mechanism("egg", dimension=3)
    egg.rolling("floor", egg.ground, egg.body("egg", 1.0, (0.1, 0.1, 0.1), at=(0, 0, 0.4)), semiaxes=(0.5, 0.3, 0.4))
    assert egg.with_parameters({"floor.semiaxes.z": 0.6}).p0[2] == pytest.approx(0.6)
