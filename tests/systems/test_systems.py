"""Every system against derivatives of itself: (1)-(6), (28), and Lagrange's equations."""

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from support import BUILT_IN, along, assert_close, consistent_states, difference, flowed, numbers, refused, solved
from zerodrift._private import gateway


def columns(size):
    return np.eye(size)


def test_the_start_is_consistent(system):
    e = numbers(system, 0.0, system.p0, system.v0)
    assert np.abs(e.Phi).max(initial=0) <= tol.START
    assert np.abs(e.C @ system.v0 + e.Phi_t).max(initial=0) <= tol.START


def test_mass_matrix_is_symmetric_and_positive_definite(system):
    for t, p, v in consistent_states(system):
        M = numbers(system, t, p, v).M
        assert (M == M.T).all()
        assert np.linalg.eigvalsh(M).min() > 0


def test_constraint_matrix_is_the_derivative_of_the_constraints(system):
    for t, p, v in consistent_states(system):
        e = numbers(system, t, p, v)
        for j, w in enumerate(columns(system.nv)):
            slope = along(lambda p: numbers(system, t, p, v).Phi, (p, e.A @ w))     # noqa: B023
            assert_close(e.C[:system.mh, j], slope, tol.DIFFERENCE, scale=1, what=f"column {j} of C")
        slope = difference(lambda t: numbers(system, t, p, v).Phi, t)               # noqa: B023
        assert_close(e.Phi_t[:system.mh], slope, tol.DIFFERENCE, scale=1, what="Phi_t")


def test_xi_is_what_the_derivative_of_the_velocity_constraints_leaves(system):
    for t, p, v in consistent_states(system):
        def Psi(t, p):
            e = numbers(system, t, p, v)                                            # noqa: B023
            return e.C @ v + e.Phi_t                                                # noqa: B023

        e = numbers(system, t, p, v)
        assert_close(e.xi, -along(Psi, (t, 1.0), (p, e.A @ v)), tol.DIFFERENCE, scale=1, what="xi")     # (6)


def test_energy_balance(system):
    """(28): along the motion, T + V changes by the power, and by what moving constraints put in."""
    if not system.has_energy:
        pytest.skip("declares no potential")

    def energy(t, p, v):
        e = numbers(system, t, p, v)
        return v @ e.M @ v / 2 + e.V

    for t, p, v in consistent_states(system):
        e = numbers(system, t, p, v)
        vdot, multipliers = solved(e.M, e.C, e.force, e.xi)
        gain = along(energy, (t, 1.0), (p, e.A @ v), (v, vdot))
        assert_close(gain, np.float64(e.power + multipliers @ e.Phi_t), tol.DIFFERENCE, scale=1 + abs(energy(t, p, v)))


def test_bias_and_force_are_those_of_lagrange(system):
    """Lagrange's equation if v = pdot and all forces have a potential: f - d = grad (T - V) - Mdot v."""
    e = system.evaluate()
    if e.A is not None or e.power is not None or not system.has_energy:
        pytest.skip("has quasi-velocities, or forces without potential")
    for t, p, v in consistent_states(system):
        def lagrangian(p):
            e = numbers(system, t, p, v)                                            # noqa: B023
            return v @ e.M @ v / 2 - e.V                                            # noqa: B023

        Mdot = along(lambda t, p: numbers(system, t, p, v).M, (t, 1.0), (p, v))     # noqa: B023
        gradient = np.array([along(lagrangian, (p, w)) for w in columns(system.nq)])
        assert_close(numbers(system, t, p, v).force, gradient - Mdot @ v, tol.DIFFERENCE, scale=1)


def test_terms_are_absent_or_have_their_shapes(system):
    sizes = {"nq": system.nq, "nv": system.nv, "mh": system.mh, "m": system.m, "r": system.nv - system.m}
    terms = system.evaluate()
    for name, term in gateway.TERMS.items():
        array = getattr(terms, name)
        assert array is None or array.shape == tuple(sizes[size] for size in term.sizes.strip("()").split(", ") if size)
    assert terms.M is not None
    assert (terms.C is None) == (system.m == 0)
    assert f"M {terms.M.shape}" in repr(terms)


def test_what_is_requested_does_not_depend_on_earlier_requests(system):
    """Terms are pure: the same at the same place, whatever came between."""
    (t, p, v), (_, q, w) = consistent_states(system, 2)
    first, _, again = (numbers(system, t, *state) for state in ((p, v), (q, w), (p, v)))
    for name, value in vars(first).items():
        assert np.array_equal(value, vars(again)[name])


def test_names_are_unique_and_complete(system):
    for group, size in ((system.coordinates, system.nq), (system.velocities, system.nv), (system.constraints, system.m)):
        assert len({variable.name for variable in group}) == len(group) == size
    names = {variable.name for variable in (*system.coordinates, *system.velocities)}
    assert len(names) == system.nq + system.nv      # `hold` of assemble tells them apart by name


@pytest.mark.parametrize("built_in", BUILT_IN.values(), ids=BUILT_IN)
def test_a_system_documents_its_parameters(built_in):
    make = getattr(zd.systems, built_in.name)
    for name in built_in.parameters:
        assert f"{name} : " in make.__doc__
    assert "Source: " in make.__doc__


def test_a_system_is_drawn_where_it_is(system):
    points = system.points(system.p0)
    if points is None:
        return
    assert points.ndim == 2
    assert points.shape[1] in (2, 3)
    moved = system.points(flowed(system, 0.0, system.p0, np.full(system.nv, 0.1)))
    assert not np.array_equal(points, moved, equal_nan=True)


@pytest.mark.parametrize("built_in", BUILT_IN.values(), ids=BUILT_IN)
def test_a_system_repeats_itself(built_in):
    """From its repr, and from the parameters it says it has."""
    for again in (eval(repr(built_in), {"zd": zd}), getattr(zd.systems, built_in.name)(**built_in.parameters)):
        assert again.parameters == built_in.parameters
        assert np.array_equal(again.p0, built_in.p0)
        assert np.array_equal(again.evaluate().M, built_in.evaluate().M)


def test_parameters_may_be_changed(system):
    """The first that is a number; the others stay."""
    key, value = next((key, value) for key, value in system.parameters.items() if isinstance(value, float) and value > 0)
    changed = system.with_parameters(**{key: 1.01 * value})
    assert changed.parameters == system.parameters | {key: 1.01 * value}
    assert system.with_parameters({key: 1.01 * value}).parameters == changed.parameters
    with refused("unknown-choice"):
        system.with_parameters(no_such_thing=1.0)
    with refused("unknown-choice"):
        system.with_parameters({"no.such thing": 1.0})
    with refused("duplicate-name", f"parameter {key!r} is changed twice"):
        system.with_parameters({key: value}, **{key: 1.01 * value})
    with refused("wrong-type", "changes"):
        system.with_parameters([value])
