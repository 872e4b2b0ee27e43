"""Bushings in space: against a linear model, their twins in the plane, and what forces and moments have to be."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

import zerodrift as zd
from support import assert_close, refused
from zerodrift.mechanisms.elements.frames import about

R = about((0.3, 0.6, -0.2), 0.7)        # so that no direction is one of the drawing's
STIFFNESS, TORSION = np.array([200.0, 300.0, 500.0]), np.array([20.0, 45.0, 30.0])
DAMPING, TORSION_DAMPING = np.array([3.0, 5.0, 2.0]), np.array([0.4, 0.2, 0.3])


def mounted(**held):
    """A body on a bushing at its mass centre, whose directions are those of R."""
    m = zd.Mechanism("mount", dimension=3)
    block = m.body("block", 2.0, (0.3, 0.4, 0.5), rotation=R)
    m.bushing("mount", m.ground, block, at=(0, 0, 0), axis=R[:, 0], normal=R[:, 1], stiffness=STIFFNESS, damping=DAMPING,
              torsion=TORSION, torsion_damping=TORSION_DAMPING)
    m.start(held)
    return m


def test_small_motions_are_those_of_six_oscillators():
    small = 1e-5
    x0, w0 = small * np.array([1.0, -2.0, 0.5]), small * np.array([3.0, 2.0, -4.0])
    sol = zd.simulate(mounted(**{"block.position": R @ x0, "block.angular_velocity": R @ w0}), 1.0, step=5e-3)
    turned = Rotation.from_matrix(R.T @ sol["block.rotation"]).as_rotvec()
    for i in range(3):
        for mass, k, c, start, found in ((2.0, STIFFNESS[i], DAMPING[i], [x0[i], 0.0], (sol["block.position"] @ R)[:, i]),
                                         ((0.3, 0.4, 0.5)[i], TORSION[i], TORSION_DAMPING[i], [0.0, w0[i]], turned[:, i])):
            step = expm(5e-3 * np.array([[0, 1], [-k / mass, -c / mass]]))
            expected = [np.array(start)]
            for _ in sol.t[1:]:
                expected.append(step @ expected[-1])
            assert_close(found, np.array(expected)[:, 0], 1e-4)     # of second order in what is small, and of RK4's steps


@pytest.mark.parametrize("axis", range(3))
def test_a_large_turn_about_one_direction_is_linear(axis):
    m = mounted(**{"block.rotation": about(R[:, axis], 1.2) @ R})
    sol = zd.simulate(m, 1e-4, step=1e-4)
    assert_close(sol["mount.torque"][0], -TORSION[axis] * 1.2 * R[:, axis], 1e-11)
    assert_close(sol["mount.force"][0], np.zeros(3), 1e-12, scale=1.0)


def test_energy_and_momentum_of_two_bodies():
    """Its forces are those of a potential, and what it does to one body it does the opposite of to the other."""
    m = zd.Mechanism("pair", dimension=3)
    one = m.body("one", 2.0, (0.3, 0.4, 0.5), rotation=R)
    other = m.body("other", 1.0, (0.2, 0.1, 0.2), at=(0.4, 0.1, 0.0))
    m.bushing("mount", one, other, at=(0.3, 0.2, -0.1), stiffness=STIFFNESS, torsion=TORSION)
    m.start({"one.angular_velocity": (2.0, -1.0, 0.5), "other.velocity": (0.3, 0.5, -0.2)})
    sol = zd.simulate(m, 1.0, step=2e-3, integrator="dop853")
    assert np.abs(sol.energy_violation).max() < 1e-9
    linear = 2.0 * sol["one.velocity"] + sol["other.velocity"]
    assert_close(linear, np.tile(linear[0], (len(sol.t), 1)), 1e-11)
    assert_close(sol["other.center.acceleration"], sol["mount.force"], 1e-11)
    total = np.zeros((len(sol.t), 3))
    for name, mass, moments in (("one", 2.0, (0.3, 0.4, 0.5)), ("other", 1.0, (0.2, 0.1, 0.2))):
        turned = sol[f"{name}.rotation"]
        total += np.einsum("kij,j,klj,kl->ki", turned, moments, turned, sol[f"{name}.angular_velocity"])
        total += mass * np.cross(sol[f"{name}.position"], sol[f"{name}.velocity"])
    assert_close(total, np.tile(total[0], (len(sol.t), 1)), 1e-10)


def test_it_is_that_of_the_plane():
    def rocking(dimension):
        more, inertia = ((), 0.4) if dimension == 2 else ((0.0,), (0.4, 0.4, 0.4))
        m = zd.Mechanism("rocking", dimension=dimension, gravity=(0, -9.81, *more))
        block = m.body("block", 2.0, inertia, at=(0.3, 0.1, *more))
        three = dimension == 3
        m.bushing("mount", m.ground, block, at=(0.1, 0.2, *more), stiffness=(300.0, 500.0, *([900.0] if three else [])),
                  damping=(2.0, 3.0, *more), torsion=(50.0, 60.0, 8.0) if three else 8.0,
                  torsion_damping=(0.0, 0.0, 0.3) if three else 0.3)
        return zd.simulate(m.system("absolute"), 1.0, step=5e-3, integrator="dop853")

    space, plane = rocking(3), rocking(2)
    assert_close(space["block.position"][:, :2], plane["block.position"], 1e-9)
    assert_close(space["mount.force"][:, :2], plane["mount.force"], 1e-9)
    assert_close(space["mount.torque"][:, 2], plane["mount.torque"], 1e-9)


def test_its_numbers_have_paths():
    system = mounted().with_parameters({"mount.stiffness.x": 100.0, "mount.torsion.z": 5.0})
    assert system.parameters["mount.torsion_damping.y"] == 0.2
    p = system.p0.copy()
    p[:3] = R @ (0.01, 0.02, 0.0)
    assert_close(system.evaluate(p, system.v0).f[:3], R @ (-1.0, -6.0, 0.0), 1e-12)


# ---- large rotations ----


def turned(of):
    """Rotation vector of the block of `mounted`, in the axes of the bushing."""
    return Rotation.from_matrix(R.T @ of).as_rotvec()


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_the_torque_is_the_gradient_of_the_energy_of_the_rotation_vector(layout):
    """Up to 170 degrees about any axis; V is SciPy's rotation vector, and its gradient a difference of order four."""
    rng, h = np.random.default_rng(3), 1e-3
    for angle in np.radians([1e-6, 5.0, 60.0, 90.0, 120.0, 170.0]):
        rotation = R @ about(rng.normal(size=3), angle)
        system = mounted(**{"block.rotation": rotation}).system(layout)

        def potential(axis, step, rotation=rotation):
            return 0.5 * TORSION @ turned(about(axis, step) @ rotation)**2

        expected = [-(8 * (potential(e, h) - potential(e, -h)) - potential(e, 2 * h) + potential(e, -2 * h)) / (12 * h)
                    for e in np.eye(3)]
        sol = zd.simulate(system, 1e-9, step=1e-9)
        assert_close(sol["mount.torque"][0], np.array(expected), 1e-10, scale=TORSION.max())     # h^4 / 30 of fifth derivatives
        assert_close(system.evaluate(system.p0, system.v0).V, potential(np.eye(3)[0], 0.0), 1e-13, scale=1.0)


def test_turns_beyond_a_quarter_about_several_directions():
    """Oscillation by 118 degrees that wobbles, against quaternions and rotation vectors in SciPy."""
    m = zd.Mechanism("mount", dimension=3)
    block = m.body("block", 1.0, (0.1, 0.1, 0.1))
    m.bushing("rubber", m.ground, block, at=(0, 0, 0), stiffness=1.0, torsion=1.0)
    m.start({"block.angular_velocity": (6.5, 0.01, 0.01)})

    def rates(t, y):
        q, w = Rotation.from_quat(y[:4], scalar_first=True), y[4:]
        return np.concatenate([[-y[1:4] @ w / 2], (y[0] * w + np.cross(w, y[1:4])) / 2, -10.0 * q.as_rotvec()])

    times = np.linspace(0.0, 1.0, 6)
    other = solve_ivp(rates, (0.0, 1.0), [1, 0, 0, 0, 6.5, 0.01, 0.01], rtol=1e-11, atol=1e-12, t_eval=times).y
    sol = zd.simulate(m, 1.0, rtol=1e-11, atol=1e-12, t_eval=times)
    expected = Rotation.from_quat(other[:4].T, scalar_first=True).as_matrix()
    assert_close(sol["block.rotation"], expected, 1e-9)
    assert Rotation.from_matrix(expected).magnitude().max() > np.radians(110)
    assert_close(sol["block.angular_velocity"], other[4:].T, 1e-8)
    assert np.abs(sol.energy_violation).max() < 1e-8


def test_half_a_turn_has_two_directions():
    with refused("geometry", "'mount'"):
        zd.simulate(mounted(**{"block.rotation": about(R[:, 1], np.pi) @ R}), 0.1)
    m = zd.Mechanism("mount", dimension=3)
    block = m.body("block", 2.0, (0.3, 0.4, 0.5))
    m.bushing("mount", m.ground, block, at=(0, 0, 0), stiffness=STIFFNESS)
    m.start({"block.rotation": np.diag([1.0, -1.0, -1.0])})
    assert_close(zd.simulate(m, 0.1, step=0.1)["block.rotation"][-1], np.diag([1.0, -1.0, -1.0]), 1e-14)     # no torsion
    m = zd.Mechanism("mount", dimension=3)      # dampers have a direction there
    block = m.body("block", 2.0, (0.3, 0.4, 0.5))
    m.bushing("mount", m.ground, block, at=(0, 0, 0), torsion_damping=TORSION_DAMPING)
    m.start({"block.rotation": np.diag([1.0, -1.0, -1.0]), "block.angular_velocity": (1.0, 2.0, 3.0)})
    assert_close(zd.Instant(m)["mount.torque"], -TORSION_DAMPING * (1.0, 2.0, 3.0), 1e-13)


# ---- dampers ----


def joined(angle, damping, inertia=(0.3, 0.4, 0.5)):
    """Two bodies joined by dampers about the directions of R in the first, turned by `angle` about an axis between them."""
    m = zd.Mechanism("joined", dimension=3)
    one = m.body("one", 2.0, (0.5, 0.6, 0.7), rotation=R)
    other = m.body("other", 1.0, inertia, rotation=R)
    m.bushing("damper", one, other, at=(0, 0, 0), torsion_damping=damping)
    turn = about((0.2, -0.7, 0.4), 0.8)
    m.start({"one.rotation": turn @ R, "other.rotation": turn @ R @ about((0.6, 0.3, 0.5), angle),
             "one.angular_velocity": (0.3, -0.4, 0.2), "other.angular_velocity": (-0.5, 0.7, 1.1)})
    return m


@pytest.mark.parametrize("angle", [0.0, 0.5, 2.0, 3.1])
@pytest.mark.parametrize("compiled", [False, True])
@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_torque_of_dampers_is_of_the_relative_angular_velocity_at_any_pose(layout, compiled, angle):
    system = joined(angle, TORSION_DAMPING).system(layout, compiled=compiled)
    axes = about((0.2, -0.7, 0.4), 0.8) @ R
    w = np.subtract((-0.5, 0.7, 1.1), (0.3, -0.4, 0.2))
    torque, now = -axes @ (TORSION_DAMPING * (axes.T @ w)), system.evaluate(system.p0, system.v0)
    assert_close(zd.Instant(system)["damper.torque"], torque, 1e-12)
    other = axes @ about((0.6, 0.3, 0.5), angle)
    expected = np.concatenate([np.zeros(3), -axes.T @ torque, np.zeros(3), other.T @ torque])
    if layout == "absolute":
        assert_close(now.f, expected, 1e-12)
    assert_close(now.power, torque @ w, 1e-12)


def test_equal_dampers_slow_a_ball_alike_in_all_directions():
    """Exponential decay of the angular velocity of a body with equal moments, through more than half a turn; energy balance."""
    m = zd.Mechanism("ball", dimension=3)
    ball = m.body("ball", 1.0, (0.1, 0.1, 0.1))
    m.bushing("damper", m.ground, ball, at=(0, 0, 0), torsion_damping=0.2)
    w0 = np.array([3.0, 4.0, -5.0])
    m.start({"ball.angular_velocity": w0})
    for layout, compiled in (("joint", False), ("absolute", False), ("absolute", True)):
        system = m.system(layout, compiled=compiled)
        for integrator in ("rk4", "radau"):
            sol = zd.simulate(system, 1.5, step=0.01, integrator=integrator)
            assert_close(sol["ball.angular_velocity"], w0 * np.exp(-2.0 * sol.t)[:, None], 1e-7)
            assert np.abs(sol.energy_violation).max() < 1e-6
        together = zd.ensemble(system, 1.5, parameters={"damper.torsion_damping.x": [0.2, 0.1, 0.2]}, step=0.01,
                               outputs=["ball.angular_velocity"])
        assert_close(together["ball.angular_velocity"][::2, -1], np.tile(w0 * np.exp(-3.0), (2, 1)), 1e-7)


def symmetric(seed=5):
    """A positive definite stiffness (6, 6) that couples all directions."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(6, 6)) * np.array([12.0, 12.0, 12.0, 3.0, 3.0, 3.0])[:, None]
    return root @ root.T


def coupled_pair(K):
    m = zd.Mechanism("pair", dimension=3)
    one = m.body("one", 2.0, (0.3, 0.4, 0.5), rotation=R)
    other = m.body("other", 1.0, (0.2, 0.1, 0.2), at=(0.4, 0.1, 0.0))
    m.bushing("mount", one, other, at=(0.3, 0.2, -0.1), stiffness=K, damping=(0.3, 0.2, 0.1), torsion_damping=0.05)
    m.start({"one.angular_velocity": (2.0, -1.0, 0.5), "other.velocity": (0.3, 0.5, -0.2)})
    return m


def energy_of(K, poses):
    """x^T K x / 2 of the displacement and the rotation vector in the axes of the first body, as drawn with `coupled_pair`."""
    (r1, R1), (r2, R2) = poses
    place = np.array([0.3, 0.2, -0.1])
    P, Q = r1 + R1 @ (R.T @ place), r2 + R2 @ (place - [0.4, 0.1, 0.0])
    x = np.concatenate([R1.T @ (Q - P), Rotation.from_matrix(R1.T @ R2 @ R).as_rotvec()])
    return x @ K @ x / 2, x


@pytest.mark.parametrize("closed_form", [None, False])
def test_a_coupled_stiffness_is_the_gradient_of_its_energy(closed_form):
    """Forces and torques on both bodies by differences of x^T K x / 2, and the energy of a run."""
    K = symmetric()
    m = coupled_pair(K)
    m.start({"other.position": (0.5, 0.0, 0.1), "other.rotation": about((0.3, -1, 2), 1.3)})
    system = m.system("absolute")
    sol = zd.simulate(system, 1e-3, step=1e-3, closed_form=closed_form)
    poses = [(sol[f"{name}.position"][0], sol[f"{name}.rotation"][0].reshape(3, 3)) for name in ("one", "other")]

    def varied(body, axis, h, turns):
        d = np.eye(3)[axis] * h
        moved = [tuple(pose) for pose in poses]
        r, A = moved[body]
        moved[body] = (r, Rotation.from_rotvec(d).as_matrix() @ A) if turns else (r + d, A)
        return energy_of(K, moved)[0]

    h = 1e-5
    gradient = {(body, turns): np.array([(varied(body, i, h, turns) - varied(body, i, -h, turns)) / (2 * h) for i in range(3)])
                for body in (0, 1) for turns in (False, True)}
    Q = poses[1][0] + poses[1][1] @ (np.array([0.3, 0.2, -0.1]) - [0.4, 0.1, 0.0])
    still = zd.simulate(coupled_at(m), 1e-6, step=1e-6, closed_form=closed_form)
    force, about_com = still["mount.force"][0], still["mount.torque"][0] + np.cross(Q - poses[1][0], still["mount.force"][0])
    assert_close(force, -gradient[1, False], 1e-7)
    assert_close(about_com, -gradient[1, True], 1e-7)
    assert_close(-force, -gradient[0, False], 1e-7)
    assert_close(-(still["mount.torque"][0] + np.cross(Q - poses[0][0], force)), -gradient[0, True], 1e-7)


def coupled_at(m):
    """The same at rest, where dampers do nothing."""
    m.start({"one.angular_velocity": (0, 0, 0), "other.velocity": (0, 0, 0), "other.angular_velocity": (0, 0, 0),
             "one.velocity": (0, 0, 0)})
    return m.system("absolute")


@pytest.mark.parametrize("closed_form", [None, False])
def test_energy_is_kept_with_a_coupled_stiffness(closed_form):
    K = symmetric()
    m = zd.Mechanism("free", dimension=3)
    block = m.body("block", 2.0, (0.3, 0.4, 0.5), rotation=R)
    m.bushing("mount", m.ground, block, at=(0, 0, 0), axis=R[:, 0], normal=R[:, 1], stiffness=K)
    m.start({"block.angular_velocity": (2.0, -1.0, 0.5), "block.velocity": (0.3, 0.5, -0.2)})
    sol = zd.simulate(m, 0.5, rtol=1e-13, atol=1e-14, closed_form=closed_form)
    assert np.abs(sol.energy_violation).max() < 1e-12       # of 1.4 J


def test_a_diagonal_matrix_is_a_bushing_as_before_and_others_are_saved(tmp_path):
    m = zd.Mechanism("mount", dimension=3)
    block = m.body("block", 2.0, (0.3, 0.4, 0.5))
    K = symmetric()
    for name, matrix in (("plain", np.diag([*STIFFNESS, *TORSION])), ("mixed", K)):
        m.bushing(name, m.ground, block, at=(0, 0, 0), stiffness=matrix)
    assert m["plain"].values == m.bushing("same", m.ground, block, at=(0, 0, 0), stiffness=STIFFNESS, torsion=TORSION).values
    again = zd.load(m.save(tmp_path / "m"))
    assert np.array_equal(again["mixed"].coupled, m["mixed"].coupled)
    with refused("shape", "symmetric"):
        m.bushing("skew", m.ground, block, at=(0, 0, 0), stiffness=K + np.eye(6, k=1))
    with refused("conflicting-arguments", "torsion"):
        m.bushing("twice", m.ground, block, at=(0, 0, 0), stiffness=K, torsion=1.0)
