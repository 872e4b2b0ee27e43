"""The tangent space, derivatives of residuals, mass matrix, Jacobians and bias, against runs, differences and closed forms."""

import numpy as np
import pytest

import zerodrift as zd
from every_model import moving
from support import drawn_in, refused
from zerodrift.analysis.derivatives import Derivatives, of_residuals_along, residuals
from zerodrift.analysis.state import scales, state
from zerodrift.analysis.tangent import Tangent

MODELS = [("whipple_bicycle", "joint"), ("whipple_bicycle", "absolute"), ("bennett", "absolute"), ("double_wishbone", "joint"),
          ("four_bar", "joint"), ("closed_pendulum", "absolute"), ("heavy_top", "joint"), ("snakeboard", "joint")]


@pytest.mark.parametrize(("name", "layout"), MODELS)
def test_the_basis_is_tangent_and_mass_orthonormal(name, layout):
    system, p, v = moving(0.1, name, layout)
    at = state(system, 0.0, p, v)
    tangent = Tangent(at)
    W, V, M = tangent.displacements, tangent.velocities, at.M
    assert np.abs(W.T @ M @ W - np.eye(W.shape[1])).max() < 1e-9        # rounding times the condition of M, 1e5 at most
    assert np.abs(V.T @ M @ V - np.eye(V.shape[1])).max() < 1e-9
    size = (1 + np.abs(at.C).max(initial=0.0)) * (1 + np.abs(v).max())
    for column in tangent.basis.T:      # the violation of a step h along a tangent is of the order h^2, 1e-12; across it, 1e-6
        there = state(system, 0.0, *np.split(np.concatenate([p, v]) + 1e-6 * column / np.abs(column).max(), [system.nq]))
        assert np.abs(there.Phi).max(initial=0.0) < 1e-10 * size
        assert np.abs(there.C @ there.v + there.Phi_t).max(initial=0.0) < 1e-10 * size
        assert all(abs(np.linalg.norm(there.p[first:first + 4]) - 1) < 1e-11 for first in system.quaternions)


def test_freedoms_of_nonholonomic_and_redundant_constraints():
    for layout in ("joint", "absolute"):
        system = zd.models.whipple_bicycle().system(layout)
        assert Tangent(state(system, 0.0, *system.start_at(0.0))).basis.shape[1] == 7 + 3      # Meijaard et al. 2007, section 3
        system = zd.models.bennett().system(layout)         # one freedom, though Gruebler's count is -2
        assert Tangent(state(system, 0.0, *system.start_at(0.0))).basis.shape[1] == 2


@pytest.mark.parametrize(("name", "layout"), MODELS)
def test_derivatives_of_accelerations_equal_differences_of_projected_states(name, layout):
    system, p, v = moving(0.1, name, layout)
    tangent = Tangent(state(system, 0.0, p, v))
    column = tangent.basis @ drawn_in(tangent.basis, np.random.default_rng(1))
    dp, dv = column[:system.nq], column[system.nq:]
    h = 1e-3 / max(np.abs(column).max(), 1.0)

    def acceleration(k):
        there = zd.project(system, p + k * h * dp, v + k * h * dv, projection=zd.Projection(tol=1e-13))
        return zd.acceleration(system, *there)[0]

    expected = (8 * (acceleration(1) - acceleration(-1)) - acceleration(2) + acceleration(-2)) / (12 * h)
    found = Derivatives(tangent, *zd.acceleration(system, p, v)).of_accelerations(dp, dv)
    assert np.abs(found - expected).max() < 1e-7 * max(np.abs(expected).max(), 1.0)     # rounding of the differences, 1e-13 / h


def test_jacobian_of_a_symbolic_system_is_exact_and_equals_differences():
    system = zd.models.four_bar().system("joint", compiled=True)
    if not system.compiled:
        pytest.skip("there is no compiler")
    p, v = (np.array(each) for each in system.start_at(0.0))
    tangent = Tangent(state(system, 0.0, p, v))
    derivatives = Derivatives(tangent, *zd.acceleration(system, p, v))
    assert derivatives.is_exact
    for column in tangent.basis.T:
        dp, dv = column[:system.nq], column[system.nq:]
        exact, differences = derivatives.of_accelerations(dp, dv), derivatives.both(dp, dv)[0]
        assert np.abs(exact - differences).max() < 1e-11 * np.abs(exact).max()


def test_derivatives_of_residuals_in_closed_form():
    """A pendulum on a torsion spring: r = m l^2 / 3 vdot + k p + c v + m g l / 2 cos(p)."""
    m, k, length = 2.0, 5.0, 0.7
    pendulum = zd.Mechanism("pendulum", gravity=(0, -9.81))
    link = pendulum.link("link", (0, 0), (length, 0), mass=m)
    pin = pendulum.revolute("pin", pendulum.ground, link.start)
    pendulum.torsion_spring("spring", pin, stiffness=k, damping=0.4)
    system = pendulum.system("joint")
    at = state(system, 0.0, np.array([0.3]), np.array([0.2]))
    r = of_residuals_along(at, np.array([1.5]), np.zeros(0), np.array([[1.0]]), np.array([[2.0]]))
    assert r[0, 0] == pytest.approx(k - m * 9.81 * length / 2 * np.sin(0.3) + 2.0 * 0.4, rel=1e-13)
    assert residuals(at, np.zeros(1), np.zeros(0)).shape == (1,)


def test_mass_on_the_tangent_space_is_the_same_in_all_coordinates():
    """Reduced mass of a four-bar at its crank, 2 T / omega^2, from the speeds of its bodies in plain mechanics."""
    bar = zd.models.four_bar()
    inertia = {"crank": (1.5, 0.3), "coupler": (5.0, 1.0), "rocker": (3.0, 0.6)}       # kg and m, of slender rods
    reduced = []
    for layout in ("joint", "absolute"):
        system = bar.system(layout)
        p = system.start_at(0.0)[0]
        J = zd.jacobian(system, ["crank.angular_velocity"], p, tangent=True)
        reduced.append((zd.mass_matrix(system, p, tangent=True) / J[0, 0]**2)[0, 0])
        energy = 0.0
        for body, (mass, length) in inertia.items():
            rates = zd.jacobian(system, [f"{body}.center.velocity", f"{body}.angular_velocity"], p, tangent=True)[:, 0] / J[0, 0]
            energy += mass * (rates[0]**2 + rates[1]**2) + mass * length**2 / 12 * rates[2]**2
        assert reduced[-1] == pytest.approx(energy, rel=1e-12)
    assert reduced[0] == pytest.approx(reduced[1], rel=1e-12)


def test_bias_on_the_tangent_space_gives_the_acceleration():
    system = zd.models.whipple_bicycle().system("absolute")
    p, v = system.start_at(0.0)
    p, v = zd.project(system, p, v)
    Z = zd.jacobian(system, [each.name for each in system.velocities], p, tangent=True)
    f = system.evaluate(p, v).f
    a = np.linalg.solve(zd.mass_matrix(system, p, tangent=True), Z.T @ f - zd.bias(system, p, v, tangent=True))
    terms = system.evaluate(p, v)
    scale = scales(system, p).v
    x = scale * np.linalg.lstsq(terms.C * scale, terms.xi, rcond=1e-10)[0]
    assert np.abs(x + Z @ a - zd.acceleration(system, p, v)[0]).max() < 1e-8


def test_wrong_names_are_refused():
    bar = zd.models.four_bar()
    with refused("wrong-name", r"'crank\.angel'.*crank\.angle"):
        zd.jacobian(bar, "crank.angel")
    with refused("wrong-measure"):
        zd.jacobian(bar, "A.force")


def test_a_motion_without_mass_is_refused():
    m = zd.Mechanism("massless", gravity=(0, -9.81))
    link = m.link("link", (0, 0), (1, 0), mass=0.0)
    m.revolute("pin", m.ground, link.start)
    system = m.system("joint")
    with pytest.raises(zd.SingularSystem, match="no mass"):
        _ = Tangent(state(system, 0.0, np.zeros(1), np.zeros(1))).velocities
