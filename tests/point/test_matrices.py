"""Packed matrices of a system with a declared structure give the results of its dense twin, in all uses of the core."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tolerances as tol
import zerodrift as zd
from native_systems import needs_compiler
from structured import Bodies, bodies_library, chain, four_bars
from support import FORMULATIONS, along, assert_close, condition, numbers, refused, solved
from zerodrift._private.gateway.compiled.functions import load_library

STEPS = dict(step=0.01)
SPAN = 0.2
# Both paths end within rounding of the exact solution of each linear system; what a step does with it, the next ones multiply.
SAME = 1e-10
RODS = {"open chain": chain(6), "closed chain": chain(5, closed=True), "four-bars": four_bars(3)}


def twins(rods, **options):
    return rods.system(**options), rods.system(packed=False, **options)


def assert_same_motion(one, other, tolerance=SAME):
    for name in ("t", "p", "v", "multipliers", "kinetic_energy", "potential_energy", "energy_violation"):
        assert_close(getattr(one, name), getattr(other, name), tolerance, scale=1.0, what=name)
    for name in ("position_violation", "velocity_violation"):
        assert_close(getattr(one, name), getattr(other, name), 1e-11, scale=1.0, what=name)


# ---- terms ----


@needs_compiler
@pytest.mark.parametrize("rods", RODS.values(), ids=RODS)
def test_terms_are_those_of_the_twin_and_the_derivatives_of_the_constraints(rods):
    system, twin = twins(rods, speed=0.3)
    rng = np.random.default_rng(1)
    p, v, t = rods.p0 + 0.1 * rng.normal(size=system.nq), rng.normal(size=system.nv), 0.3
    one, other = numbers(system, t, p, v), numbers(twin, t, p, v)
    for name in ("M", "C", "Phi", "Phi_t", "xi", "force", "V"):
        assert np.all(getattr(one, name) == getattr(other, name)), name

    def rate(t, p, v):
        e = numbers(system, t, p, v)
        return e.C @ v + e.Phi_t

    assert_close(rate(t, p, v), along(lambda t, p: numbers(system, t, p, v).Phi, (t, 1.0), (p, v)), 1e-9)
    assert_close(-one.xi, along(lambda t, p: rate(t, p, v), (t, 1.0), (p, v)), 1e-9, scale=1.0)


@needs_compiler
def test_products_are_those_with_the_dense_matrices():
    system, twin = twins(RODS["closed chain"])
    rng = np.random.default_rng(2)
    terms = twin.evaluate()
    for name, matrix in (("M", terms.M), ("C", terms.C)):
        for transposed in (False, True):
            x = rng.normal(size=matrix.shape[0 if transposed else 1])
            for each in (system, twin):
                assert_close(each.product(name, x, transposed=transposed), (matrix.T if transposed else matrix) @ x, 8 * tol.EPS)
    with refused("unknown-choice", "^term must.*'M', 'C', not 'A'"):
        system.product("A", np.zeros(15))


@needs_compiler
def test_large_systems_are_not_made_dense():
    system = chain(400).system()
    with refused("wrong-value", r"up to 1000 rows, and here these would have 1200: sol\[\.\.\.\] .*product\(\)"):
        system.evaluate()
    speed = np.zeros(1200)
    speed[-1] = 1.0
    assert np.count_nonzero(system.product("C", speed)) == 2
    assert "at least 400" in str(system)


# ---- formulations, corrections, integrators ----


@needs_compiler
@pytest.mark.parametrize("rods", RODS.values(), ids=RODS)
def test_accelerations_are_those_of_the_twin(rods, formulation):
    system, twin = twins(rods, speed=0.3)
    v = np.random.default_rng(3).normal(size=system.nv)
    e = numbers(twin, 0.0, rods.p0, v)
    vdot, multipliers = solved(e.M, e.C, e.force, e.xi)
    bound = 1e3 * tol.EPS * condition(e.M, e.C)
    got, reactions = zd.acceleration(system, rods.p0, v, formulation=formulation)
    assert_close(got, vdot, bound, scale=10.0)
    assert_close(reactions, multipliers, bound, scale=10.0)


CORRECTIONS = {
    "none": {"stabilization": None}, "projection": {}, "identity metric": {"stabilization": zd.Projection(metric="identity")},
    "every third": {"stabilization": zd.Projection(every=3)}, "Baumgarte": {"stabilization": zd.Baumgarte()},
    "energy": {"energy": True},
}


@needs_compiler
@pytest.mark.pairs(correction=list(CORRECTIONS), rods=RODS)
def test_motions_are_those_of_the_twin(rods, correction, formulation):
    for speed in (0.0, 0.2):
        system, twin = twins(rods, speed=speed)
        p, v = zd.assemble(twin, rods.p0, np.zeros(system.nv))
        one, other = (zd.simulate(each, SPAN, p, v, formulation=formulation, **STEPS, **CORRECTIONS[correction])
                      for each in (system, twin))
        assert_same_motion(one, other)


@needs_compiler
def test_motions_of_all_integrators_are_those_of_the_twin(integrator):
    for speed in (0.0, 0.2):
        system, twin = twins(RODS["four-bars"], speed=speed)
        p, v = zd.assemble(twin, RODS["four-bars"].p0, np.zeros(system.nv))
        one, other = (zd.simulate(each, SPAN, p, v, integrator=integrator, **STEPS) for each in (system, twin))
        assert_same_motion(one, other)


@needs_compiler
def test_redundant_rows_are_found_and_their_reactions_shared_out(formulation):
    system, twin = twins(four_bars(2, doubled=True))
    one, other = (zd.simulate(each, SPAN, formulation=formulation, **STEPS) for each in (system, twin))
    assert one.stats["redundant"] == other.stats["redundant"]
    assert len(one.stats["redundant"]) == 2
    assert_same_motion(one, other)


@needs_compiler
def test_parallelograms_that_become_flat_are_passed_on_the_same_branch():
    rods = four_bars(2, angle=0.3)
    system, twin = twins(rods, gravity=0.0)
    velocity = np.zeros(system.nv)
    velocity[2] = -1.0
    p, v = zd.assemble(twin, rods.p0, velocity, ["p2_dot"])
    one, other = (zd.simulate(each, 0.6, p, v, step=0.01, on_singular="continue") for each in (system, twin))
    assert one.p[0, 2] * one.p[-1, 2] < 0
    assert_same_motion(one, other, 1e-6)


@needs_compiler
def test_events_and_times_between_steps():
    results = []
    for each in twins(RODS["open chain"]):
        results.append(zd.simulate(each, SPAN, t_eval=np.linspace(0, SPAN, 17), events=[lambda t, p, v: p[2] + 0.8], **STEPS))
    assert_same_motion(*results)
    assert_close(results[0].t_events[0], results[1].t_events[0], SAME)


@needs_compiler
def test_states_are_assembled_with_what_is_held():
    rods = RODS["closed chain"]
    system, twin = twins(rods)
    p = rods.p0 + 0.02 * np.random.default_rng(5).normal(size=system.nq)
    for held in ((), ("p2", "p2_dot")):
        results = [zd.assemble(each, p, np.ones(system.nv), held) for each in (system, twin)]
        for one, other in zip(*results, strict=True):
            assert_close(one, other, SAME)


@needs_compiler
def test_a_wrong_jacobian_is_noticed():
    rods = chain(3)
    zd.check(rods.system())
    system = zd.System(2, mass=np.eye(2), constraints=lambda p: np.array([p[0] * p[0] - 1.0, p[1] * p[1] - 1.0]),
                       jacobian=lambda p: np.diag([2 * p[0], 3 * p[1]]), p0=[1.0, 1.0],
                       structure=zd.Structure([1, 1], [(1, [0]), (1, [1])]))
    with refused("wrong-jacobian", r"row 1 of the Jacobian, for velocity 1, .*: it is 3, and differences .* 2"):
        zd.simulate(system, 1.0, step=0.1)


def test_a_mass_matrix_that_is_not_symmetric_is_named():
    mass = np.eye(4)
    mass[3, 2] = 0.5
    system = zd.System(4, mass=mass, p0=np.zeros(4), structure=zd.Structure([2, 2]))
    with refused("mass-not-symmetric", r"M\[3, 2\] = 0.5, and M\[2, 3\] = 0"):
        zd.simulate(system, 1.0, step=0.1)


@pytest.mark.parametrize("words", ["", "diagonal"])
def test_a_mass_that_is_nothing_is_refused_or_held(words):
    """By 'schur' named; others take it where a constraint holds it."""
    options = {"mass": np.diag([1.0, 0.0]), "constraints": lambda p: np.array([p[1] - p[0]]), "p0": [0.0, 0.0],
               "force": [1.0, 0.0]}
    system = zd.System(2, structure=zd.Structure([1, 1], [(1, [0, 1])], words), **options)
    with refused("mass-not-definite", "velocity 1"):
        zd.simulate(system, 1.0, step=0.1)
    for formulation in set(FORMULATIONS) - {"schur"}:
        assert zd.simulate(system, 1.0, step=0.1, formulation=formulation).p[-1] == pytest.approx([0.5, 0.5])
    free = zd.System(2, mass=np.diag([1.0, 0.0]), p0=[0.0, 0.0], structure=zd.Structure([1, 1], mass=words))
    with refused("mass-not-definite"):
        zd.simulate(free, 1.0, step=0.1, formulation="augmented")


# ---- any structure ----


def compared(random, **options):
    system, twin = random.system(**options), random.system(packed=False, **options)
    e = numbers(twin, 0.0, random.p, random.v)
    bound = condition(e.M, e.C)
    return system, twin, e, bound


ANY = settings(max_examples=25, deadline=None, derandomize=True)


@ANY
@given(st.integers(0, 10**6), st.booleans(), st.booleans())
def test_accelerations_of_random_structures(seed, kinematics, nonholonomic):
    random = Bodies(seed, kinematics, nonholonomic)
    system, _, e, bound = compared(random)
    if bound > 1e6:
        return
    vdot, multipliers = solved(e.M, e.C, e.force, e.xi)
    for formulation in FORMULATIONS:
        got, reactions = zd.acceleration(system, random.p, random.v, formulation=formulation)
        assert_close(got, vdot, 1e3 * tol.EPS * bound, scale=1.0, what=formulation)
        assert_close(reactions, multipliers, 1e3 * tol.EPS * bound, scale=1.0, what=formulation)


@settings(max_examples=8, deadline=None, derandomize=True)
@given(st.integers(0, 10**6), st.booleans())
def test_motions_of_random_structures(seed, kinematics):
    random = Bodies(seed, kinematics)
    system, twin, _, bound = compared(random)
    if bound > 1e3:
        return
    p, v = zd.project(twin, random.p, random.v)
    for formulation in FORMULATIONS:
        one, other = (zd.simulate(each, 0.05, p, v, step=0.005, formulation=formulation) for each in (system, twin))
        assert_same_motion(one, other, 1e-8)


# ---- the limits of the coupled rows ----


@needs_compiler
@pytest.mark.parametrize("ratio", [1e-3, 1e-6, 1e-9, 1e-12])
def test_light_rods_between_heavy_ones_lose_no_digits(ratio):
    """C M^-1 C^T has the square of the condition: what that costs is corrected."""
    rods = chain(5, closed=True, masses=[1.0, ratio, 1.0, ratio, 1.0])
    system, twin = twins(rods)
    v = zd.project(twin, rods.p0, np.ones(system.nv))[1]
    one, other = (zd.acceleration(each, rods.p0, v, formulation="schur") for each in (system, twin))
    e = numbers(twin, 0.0, rods.p0, v)
    assert np.abs(e.C @ one[0] - e.xi).max() <= 1e2 * tol.EPS * np.abs(one[0]).max()
    assert_close(one[0], other[0], 1e-9)
    assert_close(one[1], other[1], 1e-9)


# ---- described by a library ----


@needs_compiler
def test_a_kind_in_c_declares_its_structure():
    system = zd.native(bodies_library(), symbol="two_rods", parameters={})
    structure = zd.Structure([3, 3], [(2, [0]), (2, [0, 1])], "constant diagonal")
    assert system.structure == structure
    other = zd.native(bodies_library(), symbol="two_rods", parameters={"gravity": 5.0})
    twin = chain(2, bend=0.0).system(packed=False, gravity=5.0)
    assert_close(zd.simulate(other, SPAN, **STEPS).p, zd.simulate(twin, SPAN, **STEPS).p, SAME)


@needs_compiler
def test_products_that_a_system_brings_are_what_the_core_multiplies_by():
    """C v where velocities are corrected, and for each sample; M x of implicit methods. Held coordinates, where C has more
    rows, do without.
    """
    library = load_library(bodies_library())
    plain, own = (zd.native(bodies_library(), symbol=f"two_rods{which}", parameters={}) for which in ("", "_with_products"))
    at = [0.5, 0.0, 0.0, 1.5, 0.1, 0.2]
    for formulation in FORMULATIONS:
        options = STEPS | {"formulation": formulation, "energy": True}
        before = library.count_products()
        sol = zd.simulate(own, SPAN, **options)
        corrected = sol.stats["velocity_corrections"]
        assert library.count_products() >= before + len(sol.t) + corrected
        assert_same_motion(sol, zd.simulate(plain, SPAN, **options))
        for hold in ([], ["a2"]):
            (one, _), (other, _) = (zd.assemble(system, at, hold=hold) for system in (own, plain))
            assert_close(one, other, SAME)
