"""Units of length, mass and time make no difference: powers of two to the last bit, powers of ten to round-off."""

import numpy as np
import pytest
import sympy

import tolerances as tol
import zerodrift as zd
from support import assert_close, numbers, refused
from units import MECHANISMS, Units, pendulum, run, slider_crank

POWERS_OF_TWO = {"length": Units(length=2.0**-20), "mass": Units(mass=2.0**30), "time": Units(time=2.0**10),
                 "all": Units(2.0**10, 2.0**-30, 2.0**-7)}
POWERS_OF_TEN = {"micrometres": Units(length=1e6), "kilometres": Units(length=1e-3), "nanograms": Units(mass=1e12),
                 "all": Units(1e6, 1e-9, 1e3)}
CHOSEN = {"rtol": 1e-7, "atol": 1e-300, "integrator": "dormand_prince"}     # atol has the units of the state
WAYS = {"rk4": {}, "euler": {"integrator": "euler"}, "energy": {"integrator": "dop853", "energy": True}, "chosen": CHOSEN,
        "baumgarte": {"stabilization": zd.Baumgarte()}, "identity": {"stabilization": zd.Projection(metric="identity")}}
STEPS_CHOSEN = 1e-6         # with adaptive steps at rtol 1e-7: what round-off in estimates makes of them


def assert_same(one, other):
    for key in one:
        assert np.array_equal(one[key], other[key]), key


@pytest.mark.pairs(u=POWERS_OF_TWO, way=list(WAYS))
def test_powers_of_two_change_no_bit(formulation, way, u):
    """Nothing in the core has a size of its own: not a tolerance, not a threshold, not the choice of independent variables."""
    options = {"formulation": formulation, **WAYS[way]}
    assert_same(run("four_bar", u, **options), run("four_bar", Units(), **options))


@pytest.mark.pairs(u=POWERS_OF_TEN, name=list(MECHANISMS))
def test_powers_of_ten_change_round_off(name, formulation, integrator, u):
    options = {"formulation": formulation, "integrator": integrator}
    one, other = run(name, Units(), **options), run(name, u, **options)
    for key in ("t", "p", "v", "multipliers", "kinetic_energy"):
        assert_close(other[key], one[key], tol.STEPPED, what=key)


@pytest.mark.parametrize("u", POWERS_OF_TEN.values(), ids=POWERS_OF_TEN)
def test_adaptive_steps_in_other_units(formulation, u):
    one, other = (run("four_bar", units, formulation=formulation, **CHOSEN) for units in (Units(), u))
    assert len(one["t"]) == len(other["t"])
    assert_close(other["p"], one["p"], STEPS_CHOSEN)


@pytest.mark.parametrize("length", [1e-6, 1e-3, 1.0, 1e3, 1e6])
@pytest.mark.parametrize("make", [slider_crank, pendulum])
def test_the_tolerance_is_a_part_of_the_mechanism(make, length, formulation):
    """Violations stay below tol of the sizes, whatever these are; and these are the mechanism's."""
    system = make(Units(length=length))
    for tolerance in (1e-6, 1e-12):
        sol = zd.simulate(system, 1.0, step=0.02, formulation=formulation, stabilization=zd.Projection(tol=tolerance))
        assert (np.abs(sol.position_violation) <= max(tolerance, 1e-14) * sol.position_size).all()
        assert (sol.position_size > 0.3 * length).all()
        assert (sol.position_size < 3 * length).all()


def test_the_size_of_a_row_is_what_natural_motions_make_of_it(system):
    """max_i |C_ki| times 1 of an angle and the mechanism's length; for angles alone, the largest entry of the row."""
    sol = zd.simulate(system, 0.01, step=0.01)
    C = np.abs(numbers(system, 0.0, system.p0, system.v0).C[:system.mh])
    assert sol.position_size.shape == (system.mh,)
    if not any(variable.unit == "m" for variable in system.coordinates):
        assert_close(sol.position_size, C.max(axis=1, initial=0), tol.SAME)
    assert (sol.position_size > 0).all()


def own_pendulum(scale, units):
    """In numbers of which `scale` make a metre; without units these are nothing but numbers."""
    L, g = 1.0 * scale, 9.81 * scale
    return zd.System(["x", "y"], units=units, mass=np.eye(2), force=np.array([0.0, -g]),
                     constraints=lambda p: np.array([p @ p - L**2]), p0=[L, 0.0])


def symbolic_pendulum(scale, units):
    """The same, compiled."""
    x, y, vx, vy, L, g = sympy.symbols("x y vx vy L g")
    return zd.symbolic([x, y], speeds=[vx, vy], kinetic=(vx**2 + vy**2) / 2, potential=g * y, constraints=[x**2 + y**2 - L**2],
                       units=units, parameters={L: 1.0 * scale, g: 9.81 * scale}, p0=[scale, 0.0])


@pytest.mark.parametrize("own_pendulum", [own_pendulum, symbolic_pendulum])
def test_systems_of_ones_own_say_what_is_a_length(own_pendulum):
    motions = [zd.simulate(own_pendulum(scale, ["mm", "mm"]), 1.0, step=0.01) for scale in (1.0, 1024.0)]
    assert np.array_equal(motions[0].p * 1024, motions[1].p)
    assert np.array_equal(motions[0].iterations, motions[1].iterations)
    assert [c.unit for c in motions[0].system.velocities] == ["mm/s", "mm/s"]
    plain = [zd.simulate(own_pendulum(scale, None), 1.0, step=0.01, stabilization=zd.Projection(tol=1e-6))
             for scale in (1.0, 1024.0)]
    assert not np.array_equal(plain[0].iterations, plain[1].iterations)     # there tol is of numbers, and means another thing


@pytest.mark.parametrize("units", [["m"], "mm", ["m", 1], 3])
def test_units_that_are_none(units):
    with refused("shape", r"units must be 2 strings, one for each coordinate, not|has no len"):
        own_pendulum(1.0, units)
    with refused("shape", r"units must be 2 strings, one for each coordinate, not|has no len"):
        symbolic_pendulum(1.0, units)


@pytest.mark.parametrize("masses", [(1e-9, 1.0, 1e9), (1e9, 1.0, 1e-9), (1.0, 1e-9, 1e9), (1e-9, 1e9, 1e-9)], ids=str)
def test_masses_eighteen_powers_of_ten_apart(masses):
    """Each formulation moves as the others, or says that it cannot."""
    bar, motions = zd.systems.four_bar(masses=masses), {}
    for formulation in zd.formulations():
        try:
            sol = zd.simulate(bar, 0.4, step=0.002, formulation=formulation)     # then the light crank is flung about
        except zd.SingularSystem:
            continue
        assert (np.abs(sol.position_violation) <= 1e-12 * sol.position_size).all()
        motions[formulation] = sol
    assert {"schur", "mixed", "independent"} <= set(motions)
    for formulation, sol in motions.items():
        assert_close(sol.p, motions["independent"].p, 1e-6, what=formulation)
