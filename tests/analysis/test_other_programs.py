"""Derivatives beside automatic differentiation by JAX, and inverse dynamics beside Pinocchio, where these are installed."""

import numpy as np
import pytest

import zerodrift as zd
from four_bar_in_python import AHEAD, GIVEN, four_bar
from zerodrift.analysis.derivatives import Derivatives
from zerodrift.analysis.state import state
from zerodrift.analysis.tangent import Tangent

G = 9.81


def acceleration_in_jax(state_):
    """Vdot (3,) of the paper's four-bar at (p, v), (6,): terms and solve in JAX."""
    import jax.numpy as jnp

    p, v = state_[:3], state_[3:]
    L, m, g = jnp.array(GIVEN["L"]), GIVEN["m"], GIVEN["g"]
    apart = p[:, None] - p
    M, d = jnp.diag(m * L**2 / 12), jnp.zeros(3)
    for j in range(3):
        arms = AHEAD[:, j] * L
        M = M + m[j] * jnp.outer(arms, arms) * jnp.cos(apart)
        d = d + m[j] * arms * (jnp.sin(apart) @ (arms * v**2))
    C = jnp.array([-L * jnp.sin(p), L * jnp.cos(p)])
    xi = jnp.array([(L * v**2) @ jnp.cos(p), (L * v**2) @ jnp.sin(p)])
    matrix = jnp.block([[M, C.T], [C, jnp.zeros((2, 2))]])
    return jnp.linalg.solve(matrix, jnp.concatenate([-g * (AHEAD @ m) * L * jnp.cos(p) - d, xi]))[:3]


def test_derivatives_of_accelerations_equal_automatic_differentiation_through_the_solve():
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    system = four_bar()
    p, v = zd.project(system, system.p0, system.v0, projection=zd.Projection(tol=1e-14))
    exact = np.asarray(jax.jacfwd(acceleration_in_jax)(np.concatenate([p, v])))
    vdot, lam = zd.acceleration(system, p, v)
    tangent = Tangent(state(system, 0.0, p, v))
    found = Derivatives(tangent, vdot, lam)
    for column in tangent.basis.T:
        expected = exact @ column
        assert found.of_accelerations(*np.split(column, [3])) == pytest.approx(expected, abs=1e-13 * np.abs(exact).max())


def arm(rng):
    """A chain of links in space on hinges, as the package and as Pinocchio have it."""
    import pinocchio as pin

    m, model = zd.Mechanism("arm", dimension=3, gravity=(0, 0, -G)), pin.Model()
    model.gravity.linear = np.array([0.0, 0.0, -G])
    parent, before, place = 0, m.ground, np.zeros(3)
    for i in range(5):
        axis = rng.standard_normal(3)
        axis /= np.linalg.norm(axis)
        step, com = rng.uniform(-0.4, 0.4, (2, 3))
        mass, half = rng.uniform(0.5, 2.0), rng.uniform(0.1, 0.4, (3, 3))
        second = half @ half.T      # moments of second order of the mass
        inertia = np.trace(second) * np.eye(3) - second
        place = place + step
        body = m.body(f"B{i}", mass, inertia, at=tuple(place), com=tuple(com))
        m.revolute(f"J{i}", before, body, at=tuple(place), axis=tuple(axis))
        parent = model.addJoint(parent, pin.JointModelRevoluteUnaligned(axis), pin.SE3(np.eye(3), step), f"J{i}")
        model.appendBodyToJoint(parent, pin.Inertia(mass, com, inertia), pin.SE3.Identity())
        before = body
    return m, model


@pytest.mark.parametrize("seed", range(10))
def test_torques_of_open_chains_equal_those_of_pinocchio(seed):
    pin = pytest.importorskip("pinocchio")
    rng = np.random.default_rng(seed)
    m, model = arm(rng)
    q, v, a = rng.uniform(-1, 1, (3, 5))
    system = m.system("joint")
    order = [[each.name for each in system.coordinates].index(f"J{i}.angle") for i in range(5)]
    given = np.zeros((3, 5))
    given[:, order] = q, v, a
    inv = zd.inverse_dynamics(system, 0.0, *given, efforts=[f"J{i}.angle" for i in range(5)])
    expected = pin.rnea(model, model.createData(), q, v, a)
    assert np.array([inv[f"J{i}.angle"][0] for i in range(5)]) == pytest.approx(expected, abs=1e-11 * np.abs(expected).max())
