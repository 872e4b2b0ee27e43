"""Tooth forces of gears against the free bodies of both wheels."""

import numpy as np
import pytest

import zerodrift as zd
from support import refused

PRESSURE = np.radians(20.0)
TORQUE = 7.0


def pair(ratio, *, dimension=2, coordinates=None, swapped=(False, False), torque=TORQUE, **teeth):
    """Two discs on the ground at a distance of 0.3 m, the first at (0.1, 0.2), driven by a torque, at rest."""
    space = (0.0,) * (dimension - 2)
    more = {"axis": (0, 0, 1)} if space else {}
    m = zd.Mechanism("pair", dimension=dimension)
    at = np.array([[0.1, 0.2, *space], [0.1 + 0.3 * np.cos(0.7), 0.2 + 0.3 * np.sin(0.7), *space]])
    inertia = (0.03, 0.03, 0.05) if space else 0.05
    wheels = [m.body(f"wheel{i}", 2.0, inertia, at=at[i]) for i in range(2)]
    for i, (wheel, swap) in enumerate(zip(wheels, swapped, strict=True)):
        m.revolute(f"pin{i}", *((wheel, m.ground) if swap else (m.ground, wheel)), at=at[i], **more)
    m.torque("drive", wheels[0], value=torque, **more)
    signs = [-1 if swap else 1 for swap in swapped]
    m.gear("mesh", "pin0", "pin1", ratio=ratio * signs[0] * signs[1], **teeth)
    return zd.Instant(m.system(coordinates)), at


def forces(ratio, torque=TORQUE):
    """Force on the second wheel, and the pitch point, in the plane."""
    n = np.array([np.cos(0.7), np.sin(0.7)])
    t = np.array([-n[1], n[0]])
    r0, r1 = (0.3 * abs(each / (1 - ratio)) for each in (ratio, 1.0))
    second = ratio * torque / (0.05 * (1 + ratio**2)) * 0.05      # moment on the second wheel: J alpha
    P = np.array([0.1, 0.2]) + (r0 if ratio < 0 or ratio > 1 else -r0) * n
    arm = (P - np.array([0.1, 0.2]) - 0.3 * n) @ n
    tangential = second / arm
    away = n if ratio < 0 else -n
    assert abs(arm) == pytest.approx(r1)
    return tangential * t + abs(tangential) * np.tan(PRESSURE) * away, P


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
@pytest.mark.parametrize("torque", [TORQUE, -TORQUE])
@pytest.mark.parametrize("ratio", [-2.0, -0.4, 3.0, 0.25])
def test_bearings_of_a_pair_contain_the_tooth_force(ratio, torque, coordinates):
    now, _ = pair(ratio, coordinates=coordinates, torque=torque, pressure_angle=PRESSURE)
    force, _ = forces(ratio, torque)
    assert now["pin1.force"] == pytest.approx(-force, rel=1e-9)
    assert now["pin0.force"] == pytest.approx(force, rel=1e-9)
    assert abs(now["mesh.tooth_force"]) * np.hypot(1, np.tan(PRESSURE)) == pytest.approx(np.linalg.norm(force), rel=1e-9)
    plain, _ = pair(ratio, coordinates=coordinates, torque=torque)
    assert now.vdot == pytest.approx(plain.vdot, rel=1e-12)
    assert now["mesh.torque"] == pytest.approx(plain["mesh.torque"], rel=1e-12)
    assert plain["pin1.force"] == pytest.approx(np.zeros(2), abs=1e-9)


@pytest.mark.parametrize("swapped", [(True, False), (False, True), (True, True)])
def test_the_order_of_the_bodies_of_a_joint_does_not_matter(swapped):
    now, _ = pair(-2.0, swapped=swapped, pressure_angle=PRESSURE)
    force, _ = forces(-2.0)
    for pin, swap, expected in zip(("pin0", "pin1"), swapped, (force, -force), strict=True):
        assert now[f"{pin}.force"] == pytest.approx(-expected if swap else expected, rel=1e-9)


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
@pytest.mark.parametrize("ratio", [-2.0, 3.0, 0.25])
def test_helical_gears_in_space(ratio, coordinates):
    """Moments of the axial force tilt the wheels, which the bearings prevent."""
    helix = np.radians(25.0)
    now, at = pair(ratio, dimension=3, coordinates=coordinates, pressure_angle=PRESSURE, helix_angle=helix)
    plane, P = forces(ratio)
    n, t = np.array([np.cos(0.7), np.sin(0.7), 0]), np.array([-np.sin(0.7), np.cos(0.7), 0])
    force = np.array([*plane, 0]) + (np.array([*plane, 0]) @ t) * np.tan(helix) * np.array([0, 0, 1])
    assert abs(n @ t) < 1e-15
    for i, sign in ((1, 1.0), (0, -1.0)):
        moment = np.cross(np.array([*P, 0]) - at[i], sign * force)
        assert now[f"pin{i}.force"] == pytest.approx(-sign * force, rel=1e-9)
        assert now[f"pin{i}.torque"][:2] == pytest.approx(-moment[:2], rel=1e-9)


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_bevel_gears(coordinates):
    """Axes along x and y: the separating force is across the line from their intersection to the pitch point."""
    m, ratio, radius = zd.Mechanism("bevel", dimension=3), -0.75, 0.08
    one = m.body("one", 1.0, (0.02, 0.015, 0.015), at=(0.2, 0, 0))
    other = m.body("other", 1.0, (0.02, 0.03, 0.02), at=(0, 0.25, 0))
    m.revolute("first", m.ground, one, at=(0.2, 0, 0), axis=(1, 0, 0))
    m.revolute("second", m.ground, other, at=(0, 0.25, 0), axis=(0, 1, 0))
    m.torque("drive", one, value=TORQUE, axis=(1, 0, 0))
    m.gear("mesh", "first", "second", ratio=ratio, pressure_angle=PRESSURE, radius=radius)
    now = zd.Instant(m.system(coordinates))
    P = np.array([radius, radius * abs(ratio), 0])       # radii: of the second about y, of the first about x
    moment = 0.03 * ratio * TORQUE / (0.02 + 0.03 * ratio**2)
    tangential = -moment / radius       # along z: moment = (P x F).y = -P.x F
    across = np.array([-P[1], P[0], 0]) / np.linalg.norm(P)      # away from the first wheel's axis, to the second's
    force = np.array([0, 0, tangential]) + abs(tangential) * np.tan(PRESSURE) * across
    for joint, at, sign in (("second", (0, 0.25, 0), 1), ("first", (0.2, 0, 0), -1)):
        assert now[f"{joint}.force"] == pytest.approx(-sign * force, rel=1e-9)
        axis = {"second": 1, "first": 0}[joint]
        whole = np.cross(P - np.array(at), sign * force)
        whole[axis] = 0.0
        assert now[f"{joint}.torque"] == pytest.approx(-whole, rel=1e-9, abs=1e-12)


def planetary(**teeth):
    """Three planets between a sun and a ring that does not turn; the carrier bears 12.5 N m."""
    m = zd.Mechanism("planetary")
    carrier, sun = m.body("carrier", 1.0, 0.01), m.body("sun", 1.0, 0.01)
    m.revolute("main", m.ground, carrier, at=(0, 0))
    m.revolute("sun axle", carrier, sun, at=(0, 0))
    for i, angle in enumerate(2 * np.pi * np.arange(3) / 3):
        at = 0.02 * np.array([np.cos(angle), np.sin(angle)])
        m.revolute(f"pin{i}", carrier, m.body(f"planet{i}", 0.1, 1e-5, at=at), at=at)
        m.gear(f"sun mesh {i}", "sun axle", f"pin{i}", ratio=-2.0, **teeth)
        m.gear(f"ring mesh {i}", "main", f"pin{i}", ratio=-4.0, **teeth)
    m.motor("drive", "main", speed=25.0)
    m.torque("load", sun, value=-12.5 / 3)
    return m


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_the_pin_of_a_planet_bears_its_share(coordinates):
    """2 F per planet: 12.5 N m on three pins at 0.02 m, and the planet's centripetal force; separating forces cancel."""
    sol = zd.simulate(planetary(pressure_angle=PRESSURE).system(coordinates), 0.01, step=1e-3)
    centripetal = 0.1 * 0.02 * 25.0**2
    for i in range(3):
        assert np.linalg.norm(sol[f"pin{i}.force"], axis=1) == pytest.approx(np.hypot(12.5 / 0.06, centripetal), rel=1e-9)
        assert not sol.unique(f"pin{i}.force").any()
    alone = zd.simulate(planetary(), 0.01, step=1e-3)
    assert np.linalg.norm(alone["pin0.force"], axis=1) == pytest.approx(centripetal, rel=1e-9)


def test_files_copies_and_the_plane_in_space(tmp_path):
    m = planetary(pressure_angle=PRESSURE)
    want = zd.Instant(m)["pin1.force"]
    assert zd.Instant(zd.load(m.save(tmp_path / "m")))["pin1.force"] == pytest.approx(want, rel=1e-12)
    assert zd.Instant(m.lifted())["pin1.force"][:2] == pytest.approx(want, rel=1e-9)
    assert zd.Instant(m.system("joint", compiled=True))["pin1.force"] == pytest.approx(want, rel=1e-9)


def test_lanes_have_the_forces_of_single_runs():
    loads = np.linspace(-4.0, 4.0, 9)
    m = planetary(pressure_angle=PRESSURE)
    ens = zd.ensemble(m, 0.02, parameters={"load.value": loads}, step=1e-3, outputs=["pin0.force"])
    single = zd.simulate(m.with_parameters({"load.value": loads[2]}), 0.02, step=1e-3)
    assert ens["pin0.force"][2] == pytest.approx(single["pin0.force"], rel=1e-9)


def test_a_law_reads_a_bearing_with_tooth_forces():
    """Friction of a bearing follows from its load."""
    def made(**teeth):
        m = zd.Mechanism("friction")
        wheels = [m.body(f"wheel{i}", 2.0, 0.05, at=(0.3 * i, 0)) for i in range(2)]
        for i, wheel in enumerate(wheels):
            m.revolute(f"pin{i}", m.ground, wheel, at=(0.3 * i, 0))
        m.gear("mesh", "pin0", "pin1", ratio=-2.0, **teeth)
        m.torque("drive", wheels[0], value=TORQUE)
        m.torque("friction", wheels[1], value=lambda x, y: 0.01 * np.sqrt(x**2 + y**2 + 1e-12),
                 of={"x": "pin1.force.x", "y": "pin1.force.y"})
        return zd.Instant(m)
    now = made(pressure_angle=PRESSURE)
    load = np.linalg.norm(now["pin1.force"])
    assert now["friction.torque"] == pytest.approx(0.01 * load, rel=1e-9)
    assert now["friction.torque"] > 0.1
    assert made()["friction.torque"] < 1e-6


@pytest.mark.parametrize(("given", "code", "name"), [
    ({"helix_angle": 0.1}, "missing-argument", "pressure_angle"), ({"pressure_angle": 20}, "out-of-range", "degrees"),
    ({"pressure_angle": 0.3, "helix_angle": 0.1}, "wrong-dimension", "helix_angle")])
def test_wrong_teeth(given, code, name):
    with refused(code, name):
        pair(-2.0, **given)


def test_teeth_without_a_pitch_point_are_refused():
    with refused("geometry", "mesh"):
        pair(1.0, pressure_angle=PRESSURE)
    m = zd.Mechanism("apart")
    bodies = [m.body(f"b{i}", 1.0, 0.1, at=(i, 0)) for i in range(4)]
    m.revolute("one", bodies[0], bodies[1], at=(0.5, 0))
    m.revolute("other", bodies[2], bodies[3], at=(2.5, 0))
    with refused("wrong-element", "carrier"):
        m.gear("mesh", "one", "other", ratio=-2.0, pressure_angle=PRESSURE)
