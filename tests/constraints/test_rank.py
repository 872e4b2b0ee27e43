"""Constraints that are redundant wherever the system goes, and masses that are singular."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import tolerances as tol
import zerodrift as zd
from covering import draws
from random_ranks import CHECKS
from support import FORMULATIONS, assert_close, refused

# Draws of each kind; tests/stress/random_systems.py takes as many as wanted. One of a bifurcation takes a third of a second.
SEEDS = dict.fromkeys(CHECKS, draws(8, 60)) | {"bifurcation": draws(3, 20)}


@pytest.mark.parametrize("name", CHECKS)
def test_random_systems_of_random_rank(name):
    """Against NumPy; the check itself tells whether a draw has what it is about."""
    assert sum(CHECKS[name](seed) for seed in range(SEEDS[name])) > 0.3 * SEEDS[name]


# ---- redundant constraints ----

LENGTHS = np.array([0.3, 1.0, 0.6])
TILT = np.array([[2.0, -1.0], [-1.0, 2.0], [-2.0, -2.0]]) / 3     # a plane in space, by orthonormal columns
BAR = zd.systems.four_bar()


def closure(p, t=0.0):
    x, y = LENGTHS @ np.cos(p) - 1, LENGTHS @ np.sin(p)
    return np.array([x, y])


def bar(constraints, scale=(1.0, 1.0, 1.0), **more):
    """A four-bar of its own masses, its coordinates in units of `scale`."""
    scale = np.array(scale)

    def mass(p):
        p = p * scale
        M = np.diag([2.0, 3.0, 1.0]) + 0.5 * np.cos(p[:, None] - p[None, :])
        return M * np.outer(scale, scale)

    def force(p):
        return -9.81 * scale * np.array([2.0, 1.5, 0.5]) * np.cos(p * scale)

    def potential(p):
        return 9.81 * np.array([2.0, 1.5, 0.5]) @ np.sin(p * scale)

    return zd.System(["a", "b", "c"], mass=mass, force=force, potential=potential,
                     constraints=lambda p, t: constraints(p * scale, t), p0=BAR.p0 / scale, v0=BAR.v0 / scale, **more)


REDUNDANT = {
    "the same loop twice": (lambda p, t: np.concatenate([closure(p), closure(p)]), [2, 3]),
    "the same loop twice, in millimetres": (lambda p, t: np.concatenate([1e3 * closure(p), closure(p)]), [2, 3]),
    "a planar loop in space": (lambda p, t: np.array([closure(p)[0], closure(p)[1], 0 * p[0]]), [2]),
    "a planar loop in a tilted plane": (lambda p, t: TILT @ closure(p), [2]),
    "redundant on the manifold only": (lambda p, t: np.append(closure(p), closure(p) @ [2 + p[0], p[1]]), [2]),
    "units of their own": (lambda p, t: np.append(closure(p), 1e-6 * closure(p)[0] - 1e-6 * closure(p)[1]), [2]),
}


@pytest.mark.parametrize("name", REDUNDANT)
def test_redundant_constraints_change_no_motion(name, formulation):
    """To what the tolerance of Phi leaves: other rows are iterated to it."""
    constraints, redundant = REDUNDANT[name]
    options = {"step": 0.01, "formulation": formulation, "energy": True}
    expected, sol = (zd.simulate(bar(rows), draws(0.2, 2.0), **options) for rows in (lambda p, t: closure(p), constraints))
    assert sol.stats["redundant"] == redundant
    assert (sol.stats["rank"], sol.stats["rank_drops"]) == (2, 0)
    assert "rank 2 of" in repr(sol)
    assert expected.stats["redundant"] == []
    assert_close(sol.p, expected.p, 1e-9)
    assert_close(sol.v, expected.v, 1e-9)
    unit = 1e3 if "milli" in name else 1.0
    assert np.abs(sol.position_violation).max() <= 1e-12 * unit
    assert np.abs(sol.velocity_violation).max() <= 1e-11 * unit


def smallest(system, p, vdot):
    """The multipliers of (7) that are least where each is measured by the acceleration that its own reaction causes."""
    e = system.evaluate(p)
    root = np.linalg.cholesky(np.linalg.inv(e.M)).T
    size = np.linalg.norm(root @ e.C.T, axis=0)
    size[size == 0] = 1.0
    return np.linalg.lstsq(root @ e.C.T / size, root @ (e.f - e.M @ vdot), rcond=1e-9)[0] / size


@pytest.mark.parametrize("name", REDUNDANT)
def test_multipliers_of_redundant_constraints_are_the_smallest(name, formulation):
    system = bar(REDUNDANT[name][0])
    vdot, multipliers = zd.acceleration(system, system.p0, system.v0, formulation=formulation)
    expected = smallest(system, system.p0, vdot)
    size = np.linalg.norm(system.evaluate().C, axis=1)
    assert_close(size * multipliers, size * expected, 1e-11)
    sol = zd.simulate(system, 0.2, step=0.01, formulation=formulation)
    assert_close(size * sol.multipliers[0], size * multipliers, tol.STEPPED)


def test_more_constraints_than_velocities(formulation):
    """The driven bar with its loop closed twice does not move but as it is driven: five rows for three velocities."""
    def driven(p, t):
        return np.append(closure(p), p[0] - np.pi / 2 - t)

    def twice(p, t):
        return np.concatenate([closure(p), driven(p, t)])

    expected, sol = (zd.simulate(bar(rows), draws(0.5, 2.0), step=0.01, formulation=formulation) for rows in (driven, twice))
    assert sol.stats["rank"] == 3
    assert_close(sol.p, expected.p, 1e-10)
    assert_close(sol.energy_input, expected.energy_input, 1e-8)     # the power of the drive, whichever reactions are chosen


def test_redundant_nonholonomic_constraints(formulation):
    """Two wheels of one axle do not slip along it: one of them would do."""
    def axle(p):
        row = [-np.sin(p[2]), np.cos(p[2]), 0.0]
        return np.array([row, row])

    terms = {"mass": np.diag([2.0, 2.0, 1.0]), "force": np.array([1.0, 0.0, 0.1]), "p0": [0.0, 0.0, 0.0], "v0": [1.0, 0.0, 1.0]}
    expected = zd.simulate(zd.System(3, nonholonomic=lambda p: axle(p)[:1], **terms), 2.0, step=0.01, formulation=formulation)
    sol = zd.simulate(zd.System(3, nonholonomic=axle, **terms), 2.0, step=0.01, formulation=formulation)
    assert sol.stats["redundant"] == [1]
    assert_close(sol.p, expected.p, 1e-11)
    assert_close(sol.multipliers, np.repeat(expected.multipliers, 2, axis=1) / 2, 1e-9)


@pytest.mark.each_value
@pytest.mark.pairs(options={str(each): each for each in (
    {"integrator": "dormand_prince"}, {"integrator": "trapezoidal", "step": 0.01}, {"step": 0.01, "stabilization": "baumgarte"},
    {"step": 0.01, "stabilization": zd.Projection(metric="identity")})})
def test_redundant_constraints_with_other_methods(options, formulation):
    expected, sol = (zd.simulate(bar(rows), 1.0, formulation=formulation, **options)
                     for rows in (lambda p, t: closure(p), REDUNDANT["a planar loop in a tilted plane"][0]))
    assert_close(sol.p[-1], expected.p[-1], 1e-8)
    assert_close(sol(0.513)[0], expected(0.513)[0], 1e-8)


@pytest.mark.parametrize("scale", [(1, 1, 1), (1e-5, 1, 1e4), (1e6, 1e6, 1e6)], ids=str)
def test_units_of_coordinates_do_not_change_the_rank(scale, formulation):
    one, two = (bar(rows, scale) for rows in (lambda p, t: closure(p), REDUNDANT["a planar loop in a tilted plane"][0]))
    for system in (one, two):
        vdot, _ = zd.acceleration(system, system.p0, system.v0, formulation=formulation)
        assert_close(vdot * scale, zd.acceleration(bar(lambda p, t: closure(p)), BAR.p0, BAR.v0)[0], 1e-10)


@pytest.mark.parametrize("mass", [1e-12, 1e-18, 1e-24])
def test_a_light_link_does_not_make_constraints_dependent(mass):
    """In the metric of M^-1 alone it would: there, both rows would be little else than its motion."""
    light = zd.systems.four_bar(masses=(1.5, 5.0, mass))
    zd.acceleration(light, light.p0, light.v0, formulation="augmented")


def test_contradicting_constraints_are_named(formulation):
    """Positions and velocities agree at the start; accelerations do not, or later positions do not."""
    def rows(order):
        return bar(lambda p, t: np.append(closure(p), closure(p)[0] - t**order))

    with refused("contradicting-constraints", r"row \d follows from the others, but row \d requires"):
        zd.simulate(rows(2), 1.0, step=0.01, formulation=formulation)
    with pytest.raises(zd.ZerodriftError) as caught:
        zd.simulate(rows(3), 1.0, step=0.01, formulation=formulation)
    assert caught.value.code in ("correction-failed", "dependent-coordinates", "contradicting-constraints")


def test_the_smallest_correction_from_a_singular_guess():
    """All links along the x axis: what can be corrected is, by the least that does it."""
    p, v = zd.project(BAR, [0.0, 0.0, np.pi], [1.0, 1.0, 1.0], projection=zd.Projection(positions=False))
    C, M = BAR.evaluate(p).C[1:], BAR.evaluate(p).M
    expected = 1 - np.linalg.solve(M, C.T) @ np.linalg.solve(C @ np.linalg.solve(M, C.T), C @ np.ones(3))      # (27b)
    assert_close(v, expected, tol.STEPPED)


# ---- singular masses ----


def slack(mass=(1.0, 1.0, 0.0)):
    """A pendulum in Cartesian coordinates, with its angle as a coordinate that has no mass."""
    return zd.System(["x", "y", "angle"], mass=np.diag(mass), force=np.array([0.0, -9.81, 0.0]), potential=lambda p: 9.81 * p[1],
                     constraints=lambda p: np.array([p[0] - np.sin(p[2]), p[1] + np.cos(p[2])]), p0=[1.0, 0.0, np.pi / 2])


INVERTING = "schur"


@pytest.mark.parametrize("name", [name for name in FORMULATIONS if name != INVERTING])
def test_coordinates_without_mass(name):
    exact = solve_ivp(lambda t, y: [y[1], -9.81 * np.sin(y[0])], (0, 1), [np.pi / 2, 0], method="DOP853", rtol=1e-12,
                      atol=1e-12).y[:, -1]
    sol = zd.simulate(slack(), 1.0, step=0.005, formulation=name, energy=True)
    assert_close([sol.p[-1, 2], sol.v[-1, 2]], exact, 1e-8)
    assert np.abs(sol.position_violation).max() <= 1e-12
    assert zd.check(slack())


def test_what_inverts_the_mass_names_what_has_none():
    with refused("mass-not-definite", r"first seen at velocity 2\), and 'schur' inverts it; '"):
        zd.simulate(slack(), 1.0, step=0.01, formulation=INVERTING)


def test_a_mass_that_is_missing_where_nothing_holds_it_or_is_negative(formulation):
    with refused("mass-not-definite"):
        zd.simulate(slack((0.0, 0.0, 0.0)), 1.0, step=0.01, formulation=formulation)
    with refused("mass-not-definite", "first seen at velocity 2"):
        zd.simulate(slack((1.0, 1.0, -1e-3)), 1.0, step=0.01, formulation=formulation)


@pytest.mark.usefixtures("few_places")
def test_a_reference_where_the_mass_is_singular():
    assert zd.reference(slack(), 0.1).error < 1e-9
