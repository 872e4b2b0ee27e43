"""Radau's method against its equations solved by SciPy, its closed form, and SciPy's own on stiff systems."""

from functools import partial

import numpy as np
import pytest
import sympy
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

import tolerances as tol
import zerodrift as zd
from few_bodies import crank_and_piston
from support import assert_close, assert_same_bits, rate, refused

C = np.array([(4 - np.sqrt(6)) / 10, (4 + np.sqrt(6)) / 10, 1])
A = np.array([C ** (k + 1) / (k + 1) for k in range(3)]).T @ np.linalg.inv(np.vander(C, increasing=True))     # its collocation


def test_a_step_satisfies_its_equations(system):
    """z_i = h sum_j a_ij f(t + c_j h, y + z_j), with f from NumPy, and not what the projection does to its end."""
    h = 0.02
    sol = zd.simulate(system, 3 * h, step=h, integrator="radau", stabilization=None)
    y = np.hstack([sol.p, sol.v])
    for k in range(3):
        def defect(z, k=k):
            stages = z.reshape(3, -1)
            f = np.array([rate(system, sol.t[k] + c * h, y[k] + stage) for c, stage in zip(C, stages, strict=True)])
            return (stages - h * A @ f).ravel()
        start = np.array([c * h * rate(system, sol.t[k], y[k]) for c in C]).ravel()
        z = fsolve(defect, start, xtol=1e-14).reshape(3, -1)
        assert_close(y[k + 1], y[k] + z[2], tol.STEPPED, scale=np.abs(y[k]).max())


@pytest.mark.parametrize("omega_h", [0.1, 1.0, 30.0, 1e4])
@pytest.mark.filterwarnings("ignore::zerodrift.StabilityWarning", "ignore::zerodrift.AccuracyWarning")
def test_of_an_oscillator_it_is_its_rational_function(omega_h):
    """R(z) = (1 + 2z/5 + z^2/20) / (1 - 3z/5 + 3z^2/20 - z^3/60), of z = h A; beyond all steps that resolve it, it dies out."""
    stiffness, h = 1.0, omega_h
    oscillator = zd.systems.oscillator(mass=1.0, stiffness=stiffness, x0=0.3, v0=-0.2)
    z = h * np.array([[0, 1], [-stiffness, 0]])
    one = np.eye(2)
    R = np.linalg.solve(one - 3 / 5 * z + 3 / 20 * z @ z - z @ z @ z / 60, one + 2 / 5 * z + z @ z / 20)
    sol = zd.simulate(oscillator, 20 * h, step=h, integrator="radau")
    expected = [np.linalg.matrix_power(R, k) @ (0.3, -0.2) for k in range(21)]
    assert_close(np.hstack([sol.p, sol.v]), expected, 1e-12, scale=1)
    if omega_h > 1e3:
        assert np.abs(sol.p[-1]) < 1e-12


def test_stiff_bushings(formulation):
    """Beside an explicit method: as far off as its tolerance says, in a tenth of the steps, and nothing is said of stiffness."""
    system = crank_and_piston(stiffness=1e7, damping=1e3).system()
    with pytest.warns(zd.StabilityWarning, match="stiff for 'dop853'.*; an implicit method, as 'radau', takes longer ones"):
        exact = zd.simulate(system, 0.5, rtol=1e-10, atol=1e-10, integrator="dop853")
    sol = zd.simulate(system, 0.5, rtol=1e-7, atol=1e-7, integrator="radau", formulation=formulation)
    assert np.abs(sol.p[-1] - exact.p[-1]).max() < 1e-6
    assert sol.stats["steps"] < exact.stats["steps"] / 10
    assert np.abs(sol.position_violation).max() <= 1e-12


@pytest.mark.parametrize(("stiffness", "damping"), [(1e8, 1e4), (1e10, 1e6)])
def test_steps_of_fixed_size_are_solved_to_what_stiff_rates_are_rounded_by(formulation, stiffness, damping):
    """That is far above the rounding of the state, and the more the stiffer the bushing. Beside steps that are chosen."""
    system = crank_and_piston(stiffness=stiffness, damping=damping).system()
    exact = zd.simulate(system, 0.2, rtol=1e-9, atol=1e-9, integrator="radau")
    for steps in (200, 2000):
        sol = zd.simulate(system, 0.2, step=0.2 / steps, integrator="radau", formulation=formulation)
        assert np.abs(sol.p[-1] - exact.p[-1]).max() < 1e-7


@pytest.mark.parametrize("variables", ["schur", "mixed", "independent"])
def test_rows_between_long_steps_of_stiff_systems(variables):
    """While the run goes on, and afterwards: a step may then be too long to be solved without the one before."""
    system, times = crank_and_piston(stiffness=1e9, damping=1e4).system(), np.linspace(0, 0.3, 38)
    for rtol in (1e-3, 1e-6, 1e-8):
        options = {"rtol": rtol, "atol": rtol, "integrator": "radau"}
        exact = zd.simulate(system, 0.3, formulation="schur", t_eval=times, **options)
        sol = zd.simulate(system, 0.3, formulation=variables, t_eval=times, **options)
        assert np.abs(sol.p - exact.p).max() < 3 * rtol
        assert np.abs(sol.velocity_violation).max() <= 1e-12 * np.abs(sol.v).max()
        p, v = zd.simulate(system, 0.3, formulation=variables, **options)(times)
        assert np.abs(p - sol.p).max() < rtol
        assert np.abs(v - sol.v).max() < 100 * rtol * np.abs(sol.v).max()       # the polynomial's rate is of order two


def test_steps_do_not_shrink_as_a_bushing_that_turns_becomes_stiffer(formulation):
    """Beside the same crank with a pin that gives nothing. With one J for all stages, steps would go as stiffness^(-1/4)."""
    m = zd.Mechanism("slider-crank", gravity=(0, -9.81))
    crank = m.link("crank", (0, 0), (0.1, 0), mass=0.5)
    rod = m.link("rod", (0.1, 0), (0.4, 0), mass=0.3)
    piston = m.particle("piston", 0.4, at=(0.4, 0))
    for name, a, b in (("main", m.ground, crank.start), ("pin", crank.end, rod.start), ("wrist", rod.end, piston)):
        m.revolute(name, a, b)
    m.slot("cylinder", m.ground, piston, axis=(1, 0))
    options = {"rtol": 1e-5, "atol": 1e-5, "t_eval": np.linspace(0, 0.3, 4)}
    exact = zd.simulate(m.system(), 0.3, integrator="dop853", **options)
    steps = []
    for stiffness in (1e8, 1e10):
        sol = zd.simulate(crank_and_piston(stiffness=stiffness, damping=stiffness / 1e4), 0.3, integrator="radau",
                          formulation=formulation, **options)
        assert np.abs(sol["crank.angle"] - exact["crank.angle"]).max() < 1e-3
        steps.append(sol.stats["steps"])
    assert steps[1] < 2 * steps[0] < 400


@pytest.mark.parametrize("omega", [1e2, 1e5, 1e8])
def test_steps_do_not_shrink_as_a_system_becomes_stiffer(omega):
    """A slow mass, and a light one that follows it by a hard spring and damper: beside SciPy's Radau, which shares no code."""
    system = zd.System(2, mass=np.eye(2), p0=[1.0, 1.0], parameters={"w": omega},
                       force=lambda p, v, w: np.array([-p[0], w * w * (p[0] - p[1]) + 2 * w * (v[0] - v[1])]))
    sol = zd.simulate(system, 3.0, rtol=1e-6, atol=1e-8, integrator="radau")
    other = solve_ivp(lambda t, y: [y[2], y[3], -y[0], omega**2 * (y[0] - y[1]) + 2 * omega * (y[2] - y[3])],
                      (0, 3), [1.0, 1, 0, 0], method="Radau", rtol=1e-6, atol=1e-8)
    assert abs(sol.p[-1, 0] - np.cos(3)) < 1e-5
    assert abs(sol.p[-1, 1] - np.cos(3)) < 1e-5 + 2 / omega**2
    assert sol.stats["steps"] < 1.5 * len(other.t)
    assert sol.stats["evaluations"] < 1.5 * other.nfev + 50 * other.njev


@pytest.mark.parametrize(("stiffness", "damping"), [(1e8, 2e4), (1e6, 2e3), (1e6, 10.0), (1e8, 100.0)])
def test_errors_of_stiff_components_keep_to_the_tolerance(stiffness, damping):
    """A mass whose hard spring and damper follow cos(t + phase), which is its exact motion; the median of six phases."""
    for rtol in (1e-4, 1e-6):
        errors = []
        for phase in range(6):
            force = partial(follow, phase=phase, stiffness=stiffness, damping=damping)
            system = zd.System(1, mass=[[1.0]], force=force, p0=[np.cos(phase)], v0=[-np.sin(phase)])
            sol = zd.simulate(system, 4.0, rtol=rtol, atol=rtol / 100, integrator="radau")
            errors.append(np.abs(sol.v[:, 0] + np.sin(sol.t + phase)).max())
        assert np.median(errors) < 5 * rtol


def follow(t, p, v, *, phase, stiffness, damping):
    return np.array([-np.cos(t + phase) - stiffness * (p[0] - np.cos(t + phase)) - damping * (v[0] + np.sin(t + phase))])


def governor():
    """A flyball governor from its energies: two balls on arms swing a sleeve against a hard spring with a damper."""
    p, v = sympy.symbols("turn swing sleeve"), sympy.symbols("spin swinging sliding")
    length, spin = 0.3, v[0]
    kinetic = (spin**2 + 10 * v[2]**2) / 2 + 5 * length**2 * (v[1]**2 + (sympy.sin(p[1]) * spin)**2)
    potential = -2 * 5 * 9.81 * length * sympy.cos(p[1]) - 98.1 * p[2] + 8e6 * (p[2] - 0.6 * np.cos(0.6))**2 / 2
    return zd.symbolic(p, speeds=v, kinetic=kinetic, potential=potential, constraints=[p[2] - 2 * length * sympy.cos(p[1])],
                       force=[2 - 0.1 * spin, 0, -2e6 * v[2]], p0=[0.0, 0.7, 0.6 * np.cos(0.7)], v0=[0.0, 0, 0])


@pytest.fixture(scope="module")
def stiff_governor():
    return governor()


def rate_of_swing(t, y):
    """Rates of the same governor by hand, in minimal coordinates: turn, swing, momentum of the spin, and rate of the swing."""
    _, swing, momentum, rate = y
    length, sine, cosine = 0.3, np.sin(swing), np.cos(swing)
    spin = momentum / (1 + 10 * length**2 * sine**2)
    sleeve, by_swing = 2 * length * cosine, -2 * length * sine
    mass = 10 * length**2 + 10 * by_swing**2
    force = (10 * length**2 * sine * cosine * spin**2 - 98.1 * length * sine - 40 * length**2 * sine * cosine * rate**2
             - by_swing * (8e6 * (sleeve - 0.6 * np.cos(0.6)) - 98.1 + 2e6 * by_swing * rate))
    return [spin, rate, 2 - 0.1 * spin, force / mass]


def test_a_stiff_governor_as_it_is_by_hand(stiff_governor, formulation):
    """Beside SciPy's Radau in minimal coordinates, which shares neither code nor equations; 1.2e5 1/s over a second."""
    times = np.linspace(0, 1, 6)
    exact = solve_ivp(rate_of_swing, (0, 1), [0, 0.7, 0, 0], method="Radau", rtol=1e-10, atol=1e-12, t_eval=times).y
    sol = zd.simulate(stiff_governor, 1.0, rtol=1e-8, atol=1e-8, integrator="radau", formulation=formulation, t_eval=times)
    assert np.abs(sol.p[:, :2] - exact[:2].T).max() < 1e-7
    assert np.abs(sol.p[:, 2] - 0.6 * np.cos(exact[1])).max() < 1e-7
    assert sol.stats["steps"] < 1000


def without_jacobian(system, monkeypatch):
    monkeypatch.setattr(type(system), "_with_jacobian", lambda self, core, vector="baseline": core)
    return system


@pytest.mark.parametrize("energy", [None, True])
def test_expressions_bring_their_jacobian(stiff_governor, formulation, energy, monkeypatch):
    """The run is the one by differences, except what an iteration leaves; and each Jacobian takes fewer evaluations: of a state
    (p, v) one instead of six; in independent velocities two instead of four, while p and v are found by many more.
    """
    options = {"rtol": 1e-6, "atol": 1e-6, "integrator": "radau", "formulation": formulation, "energy": energy}
    found = zd.simulate(stiff_governor, 1.0, **options)
    other = zd.simulate(without_jacobian(stiff_governor, monkeypatch), 1.0, **options)
    assert abs(found.stats["steps"] - other.stats["steps"]) < 0.1 * other.stats["steps"]
    assert np.abs(found.p[-1] - other.p[-1]).max() < 2e-6
    assert found.stats["evaluations"] < 0.99 * other.stats["evaluations"]


def test_what_changes_the_constraints_takes_differences(stiff_governor, monkeypatch):
    """Baumgarte's terms are not in the system's Jacobian."""
    options = {"rtol": 1e-6, "atol": 1e-6, "integrator": "radau", "stabilization": "baumgarte"}
    found = zd.simulate(stiff_governor, 0.2, **options)
    other = zd.simulate(without_jacobian(stiff_governor, monkeypatch), 0.2, **options)
    assert_same_bits(found, other)


def test_an_ensemble_takes_it_as_a_run_does(stiff_governor):
    options = {"rtol": 1e-6, "atol": 1e-6, "integrator": "radau"}
    ens = zd.ensemble(stiff_governor, 0.5, parameters={}, p0=[stiff_governor.p0] * 2, t_eval=np.linspace(0, 0.5, 6), **options)
    alone = zd.simulate(stiff_governor, 0.5, t_eval=np.linspace(0, 0.5, 6), **options)
    np.testing.assert_array_equal(ens["sleeve"][1], alone["sleeve"])


def test_values_between_are_those_of_its_stages(bar):
    """They err as the steps that are chosen do, and are corrected alike."""
    times = np.linspace(0, 2, 117)
    exact = zd.simulate(bar, 2.0, step=2 / 1600, integrator="dop853")
    for rtol in (1e-5, 1e-8):
        steps = zd.simulate(bar, 2.0, rtol=rtol, atol=rtol, integrator="radau")
        sol = zd.simulate(bar, 2.0, rtol=rtol, atol=rtol, integrator="radau", t_eval=times)
        assert sol.stats["evaluations"] - steps.stats["evaluations"] < 4 * len(times)
        error = max(np.abs(steps.p - exact(steps.t)[0]).max(), rtol)
        assert np.abs(sol.p - exact(times)[0]).max() <= 3 * error
        assert np.abs(sol.position_violation).max() <= 1e-12
        assert np.abs(sol.velocity_violation).max() <= 1e-12


def test_a_jacobian_serves_for_many_steps(bar):
    """Or each step would take as many evaluations more as the state has entries."""
    sol = zd.simulate(zd.systems.oscillator(), 10.0, step=0.01, integrator="radau")
    assert sol.stats["evaluations"] < 1000 * 10


def test_what_it_cannot_solve_is_said(bar):
    with refused("implicit-step", r"'radau' .*; try a smaller step"):
        zd.simulate(bar, 8.0, step=4.0, integrator="radau")
    chain = zd.Mechanism("chain")
    before = chain.ground
    for k in range(101):
        link = chain.link(f"link {k}", (k, 0), (k + 1, 0), mass=1.0)
        chain.revolute(f"pin {k}", before, link.start)
        before = link.end
    with pytest.raises(zd.UnsuitedIntegrator, match=r"'radau' .* must have at most 300 velocities"):
        zd.simulate(chain.system("absolute"), 0.1, step=0.01, integrator="radau")
