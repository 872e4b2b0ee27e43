"""The quarter car against eigenvalues of its matrices and their transfer function."""

import numpy as np
import pytest

import zerodrift as zd


@pytest.mark.parametrize("given", [
    {}, {"body_mass": 300.0, "wheel_mass": 40.0, "stiffness": 2e4, "damping": 1200.0, "rate": 40.0}], ids=str)
def test_free_and_forced_motion(given):
    """M x'' + D x' + K x = (0, k_t w + d_t w'): a forced vibration by the transfer function, and modes of the eigenvalues."""
    m, mu, k, d = (given.get(name, value) for name, value in (
        ("body_mass", 2500.0), ("wheel_mass", 320.0), ("stiffness", 80e3), ("damping", 350.0)))
    rate, k_t, d_t = given.get("rate", 2 * np.pi), 500e3, 15020.0
    sol = zd.simulate(zd.models.quarter_car(**given), 1.0, rtol=1e-11, atol=1e-12, integrator="dop853",
                      t_eval=np.linspace(0, 1, 26))
    M, D, K = np.diag([m, mu]), np.array([[d, -d], [-d, d + d_t]]), np.array([[k, -k], [-k, k + k_t]])
    forced = 0.05 * np.linalg.solve(K + 1j * rate * D - rate**2 * M, [0.0, k_t + 1j * rate * d_t])
    first_order = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
    values, modes = np.linalg.eig(first_order)
    v0 = [sol[f"{name} guide.speed"][0] for name in ("body", "wheel")]      # an instant's blow where the road starts
    rest = np.concatenate([[0.0, 0.0], v0]) - np.concatenate([forced.imag, (1j * rate * forced).imag])
    shares = np.linalg.solve(modes, rest)
    for row, name in enumerate(("body", "wheel")):
        expected = (forced[row] * np.exp(1j * rate * sol.t)).imag + (np.exp(np.outer(sol.t, values)) @ (modes[row] * shares)).real
        np.testing.assert_allclose(sol[f"{name} guide.displacement"], expected, atol=1e-9)


def test_it_stands_still_on_a_road_that_does():
    sol = zd.simulate(zd.models.quarter_car(amplitude=0.0), 1.0, step=0.01)
    assert np.abs(sol["body guide.displacement"]).max() < 1e-12
    np.testing.assert_allclose(sol["tyre.force"], -2820.0 * 9.81, rtol=1e-10)


def test_a_car_without_springs():
    with pytest.raises(ValueError, match="stiffness must be greater than 0, not 0"):
        zd.models.quarter_car(stiffness=0.0)
