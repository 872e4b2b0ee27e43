"""Taylor's method on compiled systems: its orders, steps beside other methods and known motions, and what it cannot take."""

import mpmath
import numpy as np
import pytest
import sympy

import tolerances as tol
import zerodrift as zd
from support import assert_close

x, y, t, w = sympy.symbols("x y t w", real=True)
rates = sympy.symbols("xdot ydot")
KINETIC = (rates[0]**2 + rates[1]**2) / 2
FINE = {"rtol": 1e-13, "atol": 1e-13, "integrator": "taylor"}


def swinging(gravity=9.81, **more):
    """A particle on a circle."""
    return zd.symbolic([x, y], speeds=rates, kinetic=KINETIC, potential=gravity * y, **{
        "constraints": [x**2 + y**2 - 1], "p0": [1.0, 0.0], "v0": [0.0, 0.5], **more})


@pytest.fixture(scope="module")
def pendulum():
    return swinging()


@pytest.fixture(scope="module")
def linkage():
    """The paper's four-bar, from its energies."""
    p, v, like = sympy.symbols("p:3"), sympy.symbols("v:3"), zd.systems.four_bar()
    at, kinetic, potential = sympy.Matrix([0, 0]), 0, 0
    for angle, rate, length, mass in zip(p, v, (0.3, 1.0, 0.6), (1.5, 5.0, 3.0), strict=True):
        middle = at + length / 2 * sympy.Matrix([sympy.cos(angle), sympy.sin(angle)])
        at = 2 * middle - at
        speed = middle.jacobian(p) * sympy.Matrix(v)
        kinetic += mass / 2 * (speed.dot(speed) + length**2 / 12 * rate**2)
        potential += 9.81 * mass * middle[1]
    return zd.symbolic(p, speeds=v, kinetic=kinetic, potential=potential, constraints=[at[0] - 1, at[1]], p0=like.p0, v0=like.v0)


def of_order(order):
    return zd.integrators()["taylor"].settings(order=order)


@pytest.mark.parametrize("order", [2, 3, 5, 8])
@pytest.mark.parametrize("equations", zd.formulations())
def test_observed_order_is_the_one_asked_for(linkage, equations, order):
    exact = zd.simulate(linkage, 0.5, rtol=1e-13, atol=1e-13, integrator="dop853").p[-1]
    steps = {2: 256, 3: 128, 5: 48, 8: 24}[order]       # whose errors are far above rounding
    ends = [zd.simulate(linkage, 0.5, step=0.5 / count, integrator=of_order(order), formulation=equations).p[-1]
            for count in (steps, 2 * steps)]
    errors = [np.abs(end - exact).max() for end in ends]
    assert abs(np.log2(errors[0] / errors[1]) - order) <= tol.HIGH_ORDER


def test_a_step_is_the_sum_of_the_series(linkage):
    """By the coefficients as they are handed over, summed in NumPy."""
    order, h = 9, 0.03
    p, v, _ = linkage._with_series(linkage._core).series(order, 0.0, linkage.p0, linkage.v0)
    sol = zd.simulate(linkage, h, step=h, integrator=of_order(order), stabilization=None)
    powers = h ** np.arange(order + 1)
    assert_close(sol.p[-1], powers @ p, tol.STEPPED)
    assert_close(sol.v[-1], powers @ v, tol.STEPPED)


@pytest.mark.parametrize("equations", zd.formulations())
@pytest.mark.parametrize("rtol", [1e-4, 1e-7, 1e-10, 1e-13])
def test_adaptive_steps_keep_to_the_tolerance(linkage, equations, rtol):
    """Errors against the built-in four-bar by another method at its finest; the motion amplifies the errors of the steps."""
    exact = zd.simulate(zd.systems.four_bar(), 2.0, rtol=3e-14, atol=3e-14, integrator="dop853").p[-1]
    sol = zd.simulate(linkage, 2.0, rtol=rtol, atol=rtol, integrator="taylor", formulation=equations)
    assert np.abs(sol.p[-1] - exact).max() < 100 * rtol
    assert np.abs(sol.position_violation).max() <= 1e-12
    assert np.abs(sol.velocity_violation).max() <= 1e-12
    assert sol.stats["rejected"] == 0


def test_energy_stays_to_rounding(pendulum):
    sol = zd.simulate(pendulum, 20.0, **FINE)
    assert np.abs(sol.energy_violation).max() < 1e-12
    corrected = zd.simulate(pendulum, 20.0, **FINE, energy=True)
    assert np.abs(corrected.energy_violation).max() <= np.abs(sol.energy_violation).max()


def test_a_pendulum_by_elliptic_functions():
    """From rest at 90 degrees: sin(angle / 2) = k sn(K - omega t, k), with k^2 = 1/2."""
    system = swinging().starting(v0=[0.0, 0.0])
    times = np.linspace(0, 5, 41)
    sol = zd.simulate(system, 5.0, **FINE, t_eval=times)
    with mpmath.workdps(30):
        K, omega = mpmath.ellipk(0.5), mpmath.sqrt(mpmath.mpf(9.81))
        half = [mpmath.sqrt(0.5) * mpmath.ellipfun("sn", K - omega * mpmath.mpf(at), m=0.5) for at in times]
        exact = np.array([[2 * s * mpmath.sqrt(1 - s * s), 2 * s * s - 1] for s in half], dtype=float)
    assert np.abs(sol.p - exact).max() < 2e-13


@pytest.mark.parametrize("equations", zd.formulations())
def test_energy_that_comes_in_has_its_series(equations):
    """A damper takes it out, and a circle that is moved about puts it in: the balance (28) holds to the error of the steps."""
    system = swinging(force=[-0.3 * rate for rate in rates], constraints=[(x - sympy.sin(t) / 5)**2 + y**2 - 1], time=t,
                      v0=[0.2, 0.5])
    sol = zd.simulate(system, 5.0, **FINE, formulation=equations)
    other = zd.simulate(system, 5.0, rtol=1e-13, atol=1e-13, integrator="dop853")
    assert np.abs(sol.p[-1] - other.p[-1]).max() < 1e-11
    assert np.abs(sol.energy_input[-1] - other.energy_input[-1]) < 1e-11
    assert np.abs(sol.energy_input[-1]) > 0.1
    assert np.abs(sol.energy_violation).max() < 1e-11


@pytest.mark.parametrize("equations", ["augmented", "mixed"])
def test_kinematics_and_nonholonomic_rows(equations):
    """A sleigh whose speeds are its own, along and about: with A, and a constraint on velocities besides."""
    a, (s, side, turn) = sympy.Symbol("a"), sympy.symbols("s side turn")
    mass = sympy.Matrix([[1, 0, sympy.cos(a) / 10], [0, 1, 0.2], [sympy.cos(a) / 10, 0.2, 0.5]])
    system = zd.symbolic([x, y, a], speeds=[s, side, turn], potential=None, mass=mass,
                         force=[side * turn + 0.1, -s * turn, -0.1 * turn],
                         kinematics=[s * sympy.cos(a) - side * sympy.sin(a), s * sympy.sin(a) + side * sympy.cos(a), turn],
                         nonholonomic=[side + 0.1 * turn], p0=[0.0, 0, 0.3], v0=[1.0, -0.2, 2.0])
    sol = zd.simulate(system, 3.0, **FINE, formulation=equations)
    other = zd.simulate(system, 3.0, rtol=1e-13, atol=1e-13, integrator="dop853")
    assert np.abs(sol.p[-1] - other.p[-1]).max() < 1e-11
    assert sol.stats["steps"] < other.stats["steps"]


@pytest.mark.parametrize("equations", zd.formulations())
def test_redundant_constraints(pendulum, equations):
    """The same circle twice: the motion is that of one of them."""
    twice = swinging(constraints=[x**2 + y**2 - 1, 2 * x**2 + 2 * y**2 - 2])
    found, exact = zd.simulate(twice, 3.0, **FINE, formulation=equations), zd.simulate(pendulum, 3.0, **FINE)
    assert found.stats["rank"] == 1
    assert np.abs(found.p[-1] - exact.p[-1]).max() < 1e-11


@pytest.mark.parametrize("equations", ["mixed", "independent"])
@pytest.mark.parametrize("closed_form", [False, None])
def test_states_in_independent_velocities(pendulum, equations, closed_form):
    """Through several choices of variables, by matrices and in closed form: against all of (p, v)."""
    times = np.linspace(0, 4, 33)
    sol = zd.simulate(pendulum, 4.0, **FINE, formulation=equations, closed_form=closed_form, t_eval=times)
    other = zd.simulate(pendulum, 4.0, **FINE, t_eval=times)
    assert sol.stats["repartitions"] > 2
    assert max(np.abs(sol.p - other.p).max(), np.abs(sol.v - other.v).max() / 5) < 1e-12
    assert np.abs(sol.velocity_violation).max() <= 1e-13


@pytest.mark.parametrize("equations", ["mixed", "independent"])
def test_states_of_bodies_with_quaternions(equations):
    """A heavy top, whose independent coordinates are increments about the start of each step."""
    top = zd.models.heavy_top().system("absolute", compiled=True)
    sol, other = (zd.simulate(top, 0.3, integrator=method, rtol=1e-12, atol=1e-12, formulation=equations)
                  for method in ("taylor", "dop853"))
    assert np.abs(sol.p[-1] - other.p[-1]).max() < 1e-10


@pytest.mark.parametrize("equations", ["mixed", "independent"])
def test_states_near_a_bifurcation(equations):
    """A parallelogram through its flat positions, where these formulations step (p, v) for a while: it stays one."""
    bar = zd.systems.four_bar(lengths=(1.0, 0.4, 1.0, 0.4), crank_angle=0.5, crank_rate=8.0, gravity=0.0)
    sol, other = (zd.simulate(bar, 2.0, integrator=method, rtol=1e-10, atol=1e-10, formulation=equations, on_singular="continue")
                  for method in ("taylor", "dop853"))
    assert np.abs(np.sin(sol.p[:, 1])).max() < 1e-9
    assert np.abs(sol.p[-1] - other.p[-1]).max() < 1e-7
    assert sol.stats["steps"] < other.stats["steps"]


def test_values_between_are_the_series(linkage):
    """They err as the steps do, satisfy the constraints, and no series more is found for them."""
    times = np.linspace(0, 2, 117)
    steps = zd.simulate(linkage, 2.0, **FINE)
    sol = zd.simulate(linkage, 2.0, **FINE, t_eval=times)
    exact = zd.simulate(linkage, 2.0, rtol=1e-13, atol=1e-13, integrator="dop853", t_eval=times)
    assert np.abs(sol.p - exact.p).max() < 1e-11
    assert np.abs(sol.position_violation).max() <= 1e-12
    assert sol.stats["steps"] == steps.stats["steps"]
    again, _ = steps(times)
    np.testing.assert_array_equal(again, sol.p)


def test_events_between_steps(pendulum):
    """Each time at which the particle is lowest, compared with the same event by another method."""
    found = [zd.simulate(pendulum, 5.0, rtol=1e-13, atol=1e-13, integrator=method, events=[lambda t, p, v: p[0]])
             for method in ("taylor", "dop853")]
    times = [sol.t_events[0] for sol in found]
    assert len(times[0]) == len(times[1]) > 3
    np.testing.assert_allclose(*times, atol=1e-11)


def test_the_bits_are_those_of_any_vector_unit(linkage):
    units = ("baseline", "avx2", "avx512")[:zd._private.gateway.PROCESSOR_UNIT + 1]
    first, *others = [linkage._with_series(linkage._core, unit).series(20, 0.0, linkage.p0, linkage.v0) for unit in units]
    for other in others:
        np.testing.assert_array_equal(np.hstack(first[:2]), np.hstack(other[:2]))


def test_what_it_does_not_take_is_said(linkage):
    spring = zd.System(1, mass=[[1.0]], force=lambda t, p, v: -p, p0=[1.0])
    with pytest.raises(zd.UnsuitedIntegrator, match="'taylor' must have a system that provides Taylor series"):
        zd.simulate(spring, 1.0, step=0.01, integrator="taylor")
    with pytest.raises(zd.UnsuitedIntegrator, match=r"run without 'baumgarte', .*'projection' does not"):
        zd.simulate(linkage, 1.0, step=0.01, integrator="taylor", stabilization="baumgarte")
    assert "taylor" in zd.integrators(linkage)
    assert "taylor" not in zd.integrators(spring)


@pytest.mark.parametrize(("force", "why"), [
    (sympy.Abs(y), "Abs"), (sympy.Piecewise((y, y > 0), (2 * y, True)), "choice"), (sympy.erf(y), "erf"),
    (sympy.gamma(w), "gamma"),
], ids=["absolute", "cases", "erf", "gamma"])
def test_functions_without_series_are_named(force, why):
    system = swinging(force=[force, 0], parameters={w: 2.0})
    assert "taylor" not in zd.integrators(system)
    with pytest.raises(zd.UnsuitedIntegrator, match=f"has no Taylor series: .*({why})"):
        zd.simulate(system, 1.0, step=0.01, integrator="taylor")


def test_parameters_change_and_pickles_keep_it():
    import pickle

    system = swinging(w, parameters={w: 9.81})
    other = pickle.loads(pickle.dumps(system)).with_parameters(w=5.0)
    np.testing.assert_array_equal(zd.simulate(other, 1.0, **FINE).p, zd.simulate(system.with_parameters(w=5.0), 1.0, **FINE).p)
    assert np.abs(zd.simulate(other, 1.0, **FINE).p[-1] - zd.simulate(system, 1.0, **FINE).p[-1]).max() > 0.1


@pytest.mark.parametrize("steps", [{"step": 0.01}, {"rtol": 1e-10, "atol": 1e-10}], ids=["fixed", "chosen"])
def test_runs_of_an_ensemble_are_those_that_simulate_makes(steps):
    """All runs have one start, so that data left over from an earlier run would show."""
    gravity, times = np.linspace(5, 15, 5), np.linspace(0, 2, 5)
    system, options = swinging(w, parameters={w: 9.81}), {"integrator": "taylor", "t_eval": times, **steps}
    ens = zd.ensemble(system, 2.0, parameters={"w": gravity}, threads=1, **options)
    assert not ens.failed.any()
    assert np.ptp(ens["x"][:, -1]) > 0.1
    for i, each in enumerate(gravity):
        sol = zd.simulate(system.with_parameters(w=each), 2.0, **options)
        np.testing.assert_array_equal(ens["x"][i], sol.p[:, 0])
        np.testing.assert_array_equal(ens[i].p, sol.p)


def test_an_ensemble_says_what_it_does_not_take(pendulum):
    spring = zd.System(1, mass=[[1.0]], force=lambda t, p, v: -p, p0=[1.0], v0=[0.0])

    def made(system, **options):
        return zd.ensemble(system, 1.0, v0=[system.v0] * 2, step=0.01, integrator="taylor", **options)

    assert all("'taylor' must have a system that provides Taylor series" in said for said in made(spring).messages)
    other = made(pendulum, stabilization="baumgarte")
    assert other.failed.all()
    assert all("must be run without 'baumgarte'" in said for said in other.messages)
    with pytest.raises(zd.UnsuitedIntegrator, match=r"has no Taylor series: .*Abs"):
        made(swinging(force=[sympy.Abs(y), 0]))


LAWS = {        # flat where a step begins, and steep further on: force, p0, v0, end
    "friction": (lambda x, u, t: -sympy.tanh(1000 * u), 0.0, 1.0, 2.0),
    "wall": (lambda x, u, t: sympy.exp(-1000 * (x + 1)), 0.0, -1.0, 3.0),
    "soft wall": (lambda x, u, t: 5 * sympy.log(1 + sympy.exp(-2000 * (x + 1))), 0.0, -1.0, 3.0),
    "gate": (lambda x, u, t: sympy.tanh(1000 * (t - 1)), 0.0, 0.0, 2.0),
    "logistic gate": (lambda x, u, t: 5 / (1 + sympy.exp(-1000 * (t - 1))), 0.0, 0.0, 2.0),
    "logistic gate of another size": (lambda x, u, t: 5 / (3 + sympy.exp(-1000 * (t - 1))), 0.0, 0.0, 2.0),
}


@pytest.mark.parametrize("law", LAWS)
def test_laws_that_are_flat_and_then_steep_are_not_leapt_over(law):
    """Against dop853, whose stages lie within the step; both within some hundred tolerances of a step."""
    force, p0, v0, end = LAWS[law]
    x, u, t = sympy.symbols("x u t")
    system = zd.symbolic([x], speeds=[u], kinetic=u**2 / 2, force=[force(x, u, t)], time=t, p0=[p0], v0=[v0])
    series, stages = (zd.simulate(system, end, rtol=1e-9, atol=1e-9, integrator=method) for method in ("taylor", "dop853"))
    assert_close(series.p[-1], stages.p[-1], 1e-6, scale=1.0)
    assert_close(series.v[-1], stages.v[-1], 1e-6, scale=1.0)
