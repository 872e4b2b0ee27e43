"""Bushings in space: against a linear model, their twins in the plane, and what forces and moments have to be."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

import zerodrift as zd
from support import assert_close
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
