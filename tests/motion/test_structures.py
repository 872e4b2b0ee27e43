"""Structures of many rows in every integrator, correction and way to save a motion: as their twins, whose matrices are dense.

A row of any of the core's tables is tested without being named here.
"""

import numpy as np
import pytest

import zerodrift as zd
from native_systems import needs_compiler
from structured import chain, four_bars
from support import INTEGRATORS, assert_close

pytestmark = needs_compiler
RODS = four_bars(7)                     # 22 pins of two rows: more than the 40 up to which matrices are dense
SPAN, STEP = 0.04, {"step": 4e-3}
AGREES = 1e-10                          # round-off times the condition, of angles and metres of about 1
SETTLED = {"baumgarte": {"alpha": 20.0, "beta": 100.0}}       # settings of corrections that do nothing by default


def twins(rods=RODS, **options):
    return (rods.system(packed=packed, **options) for packed in (True, False))


def assert_same_motion(one, other, allowed=AGREES):
    assert_close(one.t, other.t, allowed, scale=1.0, what="t")
    for name in ("p", "v"):
        assert_close(getattr(one, name), getattr(other, name), allowed, scale=1.0, what=name)
    assert_close(one.multipliers, other.multipliers, allowed, scale=10.0, what="multipliers")     # weights of about 10 N
    assert_close(one.energy_violation, other.energy_violation, allowed, scale=10.0, what="energy")


def test_every_integrator(integrator):
    one, other = (zd.simulate(each, SPAN, integrator=integrator, **STEP) for each in twins())
    assert_same_motion(one, other)
    assert one.stats["evaluations"] > 0


@pytest.mark.parametrize("chosen", [name for name in INTEGRATORS if zd.integrators()[name].error_order])
def test_steps_that_are_chosen(chosen):
    """Times of steps differ with the rounding of the error estimate, so that only what is between them is compared."""
    one, other = (zd.simulate(each, SPAN, integrator=chosen, rtol=1e-9, atol=1e-9, t_eval=[0, SPAN]) for each in twins())
    assert one.stats["steps"] == other.stats["steps"]
    assert_same_motion(one, other, 1e-8)


@pytest.mark.parametrize("name", zd.corrections())
def test_every_correction(name, formulation):
    """One by one, each with every step and with every second, where it has that; by drift where none holds the constraints."""
    row = zd.corrections()[name]
    for every in (1, 2) if "every" in (parameter.name for parameter in row.parameters) else (None,):
        given = SETTLED.get(name, {}) | ({"every": every} if every else {})
        one, other = (zd.simulate(each, SPAN, stabilization=None, correction=row.settings(**given),
                                  formulation=formulation, **STEP) for each in twins())
        assert_same_motion(one, other)


@pytest.mark.parametrize("given", [{"metric": "identity"}, {"positions": False}, {"velocities": False}], ids=str)
def test_every_way_of_projecting(given):
    one, other = (zd.simulate(each, SPAN, stabilization=zd.Projection(**given), **STEP) for each in twins())
    assert_same_motion(one, other)


def test_moving_constraints_and_energy_input():
    one, other = (zd.simulate(each, SPAN, *zd.assemble(each, RODS.p0), energy=True, **STEP) for each in twins(speed=0.3))
    assert_same_motion(one, other)
    assert_close(one.energy_input, other.energy_input, AGREES, scale=1.0, what="energy input")


def test_events_and_what_is_saved():
    """An event that is passed, one that ends the run, times between steps, every third step, values between rows."""
    rods, results = chain(25), []
    for each in twins(rods):
        events = [lambda t, p, v: p[2] + 0.75, zd.Event(lambda t, p, v: p[2] + 0.8, terminal=True)]
        results.append(zd.simulate(each, 0.5, t_eval=np.linspace(0, 0.5, 40), events=events, step=5e-3))
    one, other = results
    assert one.status == other.status != 0
    assert len(one.t_events[0]) == 1
    for a, b in zip(one.t_events, other.t_events, strict=True):
        assert_close(a, b, 1e-9, scale=1.0, what="times of events")
    assert_same_motion(one, other, 1e-9)
    assert_same_motion(*(zd.simulate(each, SPAN, save_every=3, **STEP) for each in twins()))
    one, other = (zd.simulate(each, SPAN, **STEP) for each in twins())
    assert_close(np.hstack(one(0.0131)), np.hstack(other(0.0131)), AGREES, scale=1.0, what="between rows")


@pytest.mark.usefixtures("few_places")
def test_reference():
    one, other = (zd.reference(each, 0.002, t_eval=[0.0, 0.002]) for each in twins())
    assert max(one.error, other.error) < 1e-9
    assert_close(one.solution.p, other.solution.p, one.error + other.error, what="p")


# ---- RATTLE beyond the size that matrices are made of ----


def test_rattle_takes_more_velocities_than_dense_matrices_are_made_of():
    """Its steps are the same, its iterations learn the same, and both hold the constraints."""
    one, other = (zd.simulate(each, 4e-3, step=1e-3, integrator="rattle", stabilization=None) for each in twins(chain(101)))
    assert_same_motion(one, other)
    assert one.stats["implicit_iterations"] <= other.stats["implicit_iterations"] + 4
    assert np.abs(one.position_violation).max() <= 1e-13 * 101
    assert np.abs(one.velocity_violation).max() <= 1e-11


def test_rattle_keeps_the_energy_of_thousands_of_bodies():
    sol = zd.simulate(chain(2000, bend=0.1).system(), 0.02, step=1e-3, integrator="rattle", save_every=20)
    energy = sol.kinetic_energy + sol.potential_energy
    assert abs(energy[-1] - energy[0]) <= 1e-6 * sol.kinetic_energy[-1]     # (h omega)^2 of what swings with 1 rad/s
    assert np.abs(sol.position_violation).max() <= 1e-12 * sol.position_size.max()
    assert sol.stats["implicit_iterations"] < 6 * sol.stats["steps"]


def test_implicit_methods_with_dense_matrices_say_so():
    with pytest.raises(zd.UnsuitedIntegrator, match=r"'trapezoidal' .* must have at most 300 velocities, not 303"):
        zd.simulate(chain(101).system(), 0.1, step=0.01, integrator="trapezoidal")


def refined(K, right, steps=12):
    """The solution of K x = right, refined with residuals in extended precision, where the machine has any."""
    x, inverse = np.zeros(len(K), dtype=np.longdouble), np.linalg.inv(K)
    exact = K.astype(np.longdouble)
    for _ in range(steps):
        x = x + inverse @ np.asarray(right - exact @ x, dtype=float)
    return x


def scaled_rows_and_mass(e):
    """The matrix of (8), its scale, and its right side."""
    K, right = np.block([[e.M, e.C.T], [e.C, np.zeros((len(e.C), len(e.C)))]]), np.concatenate([e.f, e.xi])
    mass = np.diag(e.M)
    scale = 1 / np.sqrt(np.concatenate([mass, (e.C**2 / mass).sum(axis=1)]))
    return K * np.outer(scale, scale), scale, right * scale


@pytest.mark.each_value
@pytest.mark.pairs(rods={
    "bent": chain(50, closed=True), "nearly straight": chain(50, closed=True, bend=0.05),
    "of masses from 1e-4 to 1": chain(50, closed=True, masses=list(10.0 ** np.random.default_rng(0).uniform(-4, 0, 50)))})
def test_multipliers_of_a_long_closed_chain_within_a_run(rods, formulation):
    """Condition 1e4 to 1e6. Most of a run's solutions are not compared with what they have to satisfy: these are among them."""
    system = rods.system()
    start = zd.assemble(system, system.p0, 0.3 * np.random.default_rng(1).standard_normal(system.nv))
    sol = zd.simulate(system, 0.03, *start, step=1e-4, save_every=100, formulation=formulation)
    for p, v, multipliers in zip(sol.p, sol.v, sol.multipliers, strict=True):
        K, scale, right = scaled_rows_and_mass(system.evaluate(p, v))
        expected = (refined(K, right) * scale)[system.nv:]
        assert np.abs(multipliers - expected).max() <= 2.0**-52 * np.linalg.cond(K) * np.abs(expected).max()
