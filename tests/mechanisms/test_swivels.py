"""Damping, drives and springs of spherical and universal joints, against closed forms and Euler's equations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import zerodrift as zd
from support import refused

LAYOUTS = ["joint", "absolute"]


def ball(kind, inertia=(0.5, 0.7, 0.9), first=None, **given):
    """A body about its mass centre."""
    m = zd.Mechanism("ball", dimension=3)
    body = m.body("b", 1.0, inertia)
    getattr(m, kind)("s", m.ground if first is None else first(m), body, at=(0, 0, 0), **given)
    return m


@pytest.mark.parametrize("closed_form", [None, False])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_damped_ball_joint_slows_a_body_down_as_euler_says(layout, closed_form):
    inertia, c, w0 = np.array([0.5, 0.7, 0.9]), 0.3, np.array([1.0, 2.0, -1.5])
    m = ball("spherical", inertia, damping=c)
    m.start({"b.angular_velocity": w0})
    sol = zd.simulate(m.system(layout), 1.0, rtol=1e-11, atol=1e-12, closed_form=closed_form)
    own = solve_ivp(lambda t, w: (-np.cross(w, inertia * w) - c * w) / inertia, (0, 1), w0, rtol=1e-12, atol=1e-13).y[:, -1]
    assert sol["b.rotation"][-1].reshape(3, 3).T @ sol["b.angular_velocity"][-1] == pytest.approx(own, abs=1e-9)
    assert sol["s.torque"] == pytest.approx(-c * sol["b.angular_velocity"], abs=1e-12)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_damped_universal_joint_slows_both_angles_down(layout):
    """The angles of a body with three equal moments do not act on each other."""
    m, c, t = ball("universal", (0.4, 0.4, 0.4), axes=((1, 0, 0), (0, 0, 1)), damping=0.2), 0.2, 0.8
    m.start({"s.angle1_speed": 2.0, "s.angle2_speed": -3.0})
    sol = zd.simulate(m.system(layout), t, rtol=1e-11, atol=1e-12)
    for angle, speed in (("angle1", 2.0), ("angle2", -3.0)):
        assert sol[f"s.{angle}_speed"][-1] == pytest.approx(speed * np.exp(-c / 0.4 * t), abs=1e-9)


@pytest.mark.parametrize("kind", ["spherical", "universal"])
def test_damping_between_moving_bodies_keeps_their_angular_momentum(kind):
    m = zd.Mechanism("two", dimension=3)
    a, b = m.body("a", 2.0, (1.0, 2.0, 1.5)), m.body("b", 1.0, (0.5, 0.8, 0.7), at=(1, 0, 0))
    axes = {} if kind == "spherical" else {"axes": ((1, 0, 0), (0, 1, 0))}
    getattr(m, kind)("s", a, b, at=(0.5, 0.1, 0), damping=0.7, **axes)
    apart = {"b.angular_velocity": (0.0, 1.0, 0.5)} if kind == "spherical" else {"s.angle1_speed": 1.0, "s.angle2_speed": -2.0}
    m.start({"a.angular_velocity": (1.0, -0.5, 2.0), "a.velocity": (0.0, 0.0, 0.0), **apart})
    sol = zd.simulate(m, 1.0, rtol=1e-11, atol=1e-12)

    def momentum(k):
        L = np.zeros(3)
        for name, mass, inertia in (("a", 2.0, (1.0, 2.0, 1.5)), ("b", 1.0, (0.5, 0.8, 0.7))):
            R = sol[f"{name}.rotation"][k].reshape(3, 3)
            L += R @ (np.array(inertia) * (R.T @ sol[f"{name}.angular_velocity"][k]))
            L += mass * np.cross(sol[f"{name}.position"][k], sol[f"{name}.velocity"][k])
        return L

    apart = sol["b.angular_velocity"] - sol["a.angular_velocity"]
    assert momentum(-1) == pytest.approx(momentum(0), abs=1e-9)
    assert np.linalg.norm(apart[-1]) < 0.9 * np.linalg.norm(apart[0])
    if kind == "spherical":
        assert sol["s.torque"] == pytest.approx(-0.7 * apart, abs=1e-12)


def test_its_damping_is_a_parameter_and_is_saved(tmp_path):
    m = ball("spherical", damping=0.3)
    m.start({"b.angular_velocity": (0, 0, 1.0)})
    again = zd.load(m.save(tmp_path / "m"))
    assert again["s"].damping == 0.3
    system = again.system().with_parameters({"s.damping": 0.9})
    assert zd.simulate(system, 1.0, rtol=1e-11)["b.angular_velocity.z"][-1] == pytest.approx(np.exp(-1.0), abs=1e-9)


def test_a_particle_has_no_damping_at_a_ball_joint():
    m = zd.Mechanism("string", dimension=3)
    with refused("wrong-element", "damping of 's'"):
        m.spherical("s", m.body("b", 1.0, (1, 1, 1)).point((1, 0, 0)), m.particle("p", 1.0, at=(1, 0, 0)), damping=1.0)


INERTIA = 0.5, 0.9, 0.7


def cross(Q, start, end):
    """Angles and speeds of a body on a cross with axes x and z by Lagrange's equations; Q(t, angles, speeds) (2,)."""
    Ix, Iy, Iz = INERTIA

    def rates(t, y):
        c, s = np.cos(y[1]), np.sin(y[1])
        Q1, Q2 = Q(t, y[:2], y[2:])
        first = (Q1 - 2 * (Iy - Ix) * s * c * y[2] * y[3]) / (Ix * c**2 + Iy * s**2)
        return [*y[2:], first, (Q2 + (Iy - Ix) * s * c * y[2]**2) / Iz]

    return solve_ivp(rates, (0, end), [0, 0, *start], method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]


@pytest.mark.parametrize("closed_form", [None, False])
@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("is_swapped", [False, True])
def test_motors_springs_and_dampers_on_either_angle_are_those_of_lagrange(layout, closed_form, is_swapped):
    m = zd.Mechanism("cross", dimension=3)
    body = m.body("b", 1.0, INERTIA)
    axes = ((1, 0, 0), (0, 0, 1))
    sides = (body, m.ground) if is_swapped else (m.ground, body)
    u = m.universal("u", *sides, at=(0, 0, 0), axes=axes[::-1] if is_swapped else axes)
    first, second = (u.angle2, u.angle1) if is_swapped else (u.angle1, u.angle2)
    sign = -1.0 if is_swapped else 1.0      # the ground turns back against the body
    m.motor("drive", first, torque=lambda t, speed: sign * 2 * np.cos(t) - 0.3 * speed)
    m.torsion_spring("spring", second, stiffness=4.0, angle=sign * 0.2, damping=0.1)
    m.torsion_spring("law", second.name, torque=lambda angle, speed: -3 * angle**3 - 0.2 * speed)
    m.start({f"{first.name}_speed": sign, f"{second.name}_speed": sign * 0.5})
    sol = zd.simulate(m.system(layout), 1.5, rtol=1e-11, atol=1e-12, closed_form=closed_form)
    own = cross(lambda t, q, v: (2 * np.cos(t) - 0.3 * v[0], -4 * (q[1] - 0.2) - 0.3 * v[1] - 3 * q[1]**3), (1.0, 0.5), 1.5)
    found = [sol[name][-1] for name in (first.name, second.name, f"{first.name}_speed", f"{second.name}_speed")]
    assert found == pytest.approx(sign * own, abs=1e-9)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_driven_angle_needs_the_torque_of_lagrange(layout):
    m, (Ix, Iy, Iz) = ball("universal", INERTIA, axes=((1, 0, 0), (0, 0, 1))), INERTIA
    m.motor("spin", "u.angle1".replace("u", "s"), angle=lambda t: 2 * t)
    m.motor("nod", m["s"].angle2, angle=lambda t: 0.5 * t**2)
    kin = zd.kinematics(m.system(layout), t=np.linspace(0, 1, 21))
    inv, q, v = zd.inverse_dynamics(m.system(layout), kin), kin["s.angle2"], kin["s.angle2_speed"]
    assert inv["spin.torque"] == pytest.approx((Iy - Ix) * np.sin(2 * q) * 2 * v, abs=1e-9)
    assert inv["nod.torque"] == pytest.approx(Iz * np.ones(21) - (Iy - Ix) / 2 * np.sin(2 * q) * 4, abs=1e-9)
    assert inv["spin.power"] == pytest.approx(2 * inv["spin.torque"], abs=1e-9)


def test_drives_of_universal_joints_are_saved_and_say_which_angle(tmp_path):
    m = ball("universal", axes=((1, 0, 0), (0, 0, 1)))
    m.motor("spin", m["s"].angle1, speed=2.0)
    m.torsion_spring("spring", m["s"].angle2, stiffness=2.0)
    again = zd.load(m.save(tmp_path / "m"))
    assert (again["spin"].which, again["spring"].which) == ("angle1", "angle2")
    assert repr(again["spin"]) == "<motor spin: speed of s.angle1>"
    assert zd.simulate(again, 0.5)["s.angle1"][-1] == pytest.approx(1.0, abs=1e-9)
    with refused("wrong-element", "s.angle1 or s.angle2"):
        m.motor("other", "s", torque=1.0)
    with refused("wrong-element", "s.angle1 or s.angle2"):
        m.torsion_spring("other", "s", stiffness=1.0)
    with refused("prescribed-twice", "spin"):
        m.motor("other", m["s"].angle1, angle=0.0)


SKEW = np.array([-0.25, 0.96, 0.1])


def skew(layout, carried):
    """A body on a skew cross, on the ground or on another body, with a drive on each angle."""
    m = zd.Mechanism("skew", dimension=3, gravity=(0.2, -0.3, -9.81))
    base = m.body("base", 2.0, (1.0, 1.2, 0.8)) if carried else m.ground
    if carried:
        m.spherical("socket", m.ground, base, at=(-0.3, 0.1, 0.0))
    body = m.body("b", 1.0, INERTIA, at=(0.4, 0.1, 0), rotation=np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]]), com=(0.1, 0.2, 0))
    u = m.universal("u", base, body, at=(0.3, 0, 0), axes=((1, 0, 0), SKEW), damping=0.1)
    m.motor("drive", u.angle1, torque=lambda t: 0.5 * np.cos(t))
    m.torsion_spring("spring", u.angle2, stiffness=2.0, damping=0.05)
    return m, m.system(layout)


@pytest.mark.parametrize("carried", [False, True])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_skew_universal_joint_keeps_the_angle_of_its_axes_and_its_angles_are_turns_about_them(layout, carried):
    """The rotation of the second body in the first is one about the first axis, then one about the second."""
    sol = zd.simulate(skew(layout, carried)[1], 1.0, rtol=1e-11, atol=1e-12)
    axis, normal = np.array([1.0, 0, 0]), SKEW / np.linalg.norm(SKEW)
    drawn = np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]])
    for k in (0, len(sol.t) // 2, -1):
        R = sol["base.rotation"][k].reshape(3, 3) if carried else np.eye(3)
        q1, q2 = sol["u.angle1"][k], sol["u.angle2"][k]
        turned = Rotation.from_rotvec(q1 * axis) * Rotation.from_rotvec(q2 * normal)
        assert sol["b.rotation"][k].reshape(3, 3) == pytest.approx(R @ turned.as_matrix() @ drawn, abs=1e-9)
        rates = sol["u.angle1_speed"][k] * axis + sol["u.angle2_speed"][k] * Rotation.from_rotvec(q1 * axis).apply(normal)
        spin = sol["b.angular_velocity"][k] - (sol["base.angular_velocity"][k] if carried else 0)
        assert spin == pytest.approx(R @ rates, abs=1e-9)
    assert abs(sol["u.angle1"][-1]) > 0.01


@pytest.mark.parametrize("closed_form", [None, False])
def test_a_skew_cross_moves_as_lagrange_says(closed_form):
    """A body of three equal moments about its mass centre: both angles are coupled by the cosine of their axes alone."""
    m = zd.Mechanism("skew", dimension=3)
    body, cosine, J = m.body("b", 1.0, (0.5, 0.5, 0.5)), SKEW[0] / np.linalg.norm(SKEW), 0.5
    u = m.universal("u", m.ground, body, at=(0, 0, 0), axes=((1, 0, 0), SKEW))
    m.motor("drive", u.angle1, torque=2.0)
    m.torsion_spring("spring", u.angle2, stiffness=3.0, angle=0.4)

    def rates(t, y):
        M = J * np.array([[1, cosine], [cosine, 1]])
        return [*y[2:], *np.linalg.solve(M, [2.0, -3 * (y[1] - 0.4)])]

    end = solve_ivp(rates, (0, 2), [0, 0, 0, 0], rtol=1e-12, atol=1e-13).y[:, -1]
    sol = zd.simulate(m, 2.0, rtol=1e-11, atol=1e-12, closed_form=closed_form)
    assert [sol[f"u.{each}"][-1] for each in ("angle1", "angle2", "angle1_speed", "angle2_speed")] == pytest.approx(end, abs=1e-8)


def test_skew_joints_are_cut_and_saved(tmp_path):
    m, _ = skew(None, True)
    again = zd.load(m.save(tmp_path / "m"))
    one, other = (each.system("absolute")._measuring.tables for each in (m, again))
    assert one.joints == other.joints
    assert again["u"].cut
    with refused("geometry", "parallel"):
        m.universal("flat", m.ground, m["b"], at=(0, 0, 0), axes=((1, 0, 0), (-1, 0, 0)))
