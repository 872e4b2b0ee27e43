"""Structures of many rows: S(W) = C W C^T in blocks, and what formulations make of it, beside dense matrices."""

import functools

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from native_systems import needs_compiler
from random_networks import MAX_ROUNDINGS, Network, check_acceleration, check_accelerations, check_motion
from structured import Rods, chain, four_bars
from support import FORMULATIONS, assert_close, condition, numbers, refused, solved

SEEDS = (0, 7, 10, 14, 22)
STEP = {"step": 2e-3}


@pytest.mark.parametrize("seed", SEEDS)
def test_networks_accelerate_as_by_dense_matrices(seed, formulation):
    assert check_acceleration(seed, formulation)


@pytest.mark.parametrize("kind", [{"redundant": 4}, {"massless": 3}, {"redundant": 3, "massless": 3}], ids=str)
def test_networks_of_redundant_rows_and_singular_mass_accelerate_as_by_dense_matrices(kind):
    """Some of their rows have weights that are far apart: seed 5 has one mass of 1e-6 of the largest."""
    off = check_accelerations(5, [each for each in FORMULATIONS if each != "schur"], bodies=20, **kind)
    assert max(off.values()) < MAX_ROUNDINGS


def test_multipliers_of_least_effect_are_found_in_as_many_iterations_as_that_takes():
    """Each iteration reduces the residual of this network to two thirds: after 40 of them, to 3e-10 of the reactions."""
    assert check_accelerations(1362, ["augmented"], bodies=20, redundant=4)["augmented"] < MAX_ROUNDINGS


@pytest.mark.parametrize("road", ["mixed", "independent"])
def test_networks_move_as_by_dense_matrices(road):
    assert check_motion(33, road)      # 42 rows, one of them nonholonomic


def test_some_of_these_networks_are_of_many_rows_some_of_few_and_some_have_a_body_of_many_joints():
    networks = [Network(seed) for seed in SEEDS]
    assert min(each.m for each in networks) <= 40 < max(each.m for each in networks)
    assert max(np.bincount(np.concatenate([blocks for _, blocks in each.groups])).max() for each in networks) > 12


def fan(arms, closed=False):
    """One rod on the ground, and so many that hang on it in a row; closed: every fifth of these ends on the ground, too."""
    centres, angles, pins = [(0.5, 0.0)], [0.0], [(-1, 0, (0.0, 0.0), (-0.5, 0.0))]
    for i in range(arms):
        at, angle = i / arms, -1.0 - 0.5 * i / arms
        middle = np.array([at, 0.0]) + 0.5 * np.array([np.cos(angle), np.sin(angle)])
        centres, angles = [*centres, middle], [*angles, angle]
        pins.append((0, i + 1, (at - 0.5, 0.0), (-0.5, 0.0)))
    if closed:
        end = np.array([(arms - 1) / arms, 0.0]) + np.array([np.cos(angles[-1]), np.sin(angles[-1])])
        pins.append((-1, arms, end, (0.5, 0.0)))
    return Rods(centres, angles, pins)


LARGE_NETWORKS = {"chain": chain(40), "four-bars": four_bars(14), "fan": fan(60), "closed fan": fan(30, closed=True),
         "light and heavy": chain(25, masses=[1.0, 1e-4] * 12 + [1e3])}


@functools.cache
def by_dense_matrices(name):
    """A large network with some velocities, its terms, and its accelerations and multipliers with their bound, by NumPy."""
    rods = LARGE_NETWORKS[name]
    system, twin = rods.system(speed=0.3), rods.system(packed=False, speed=0.3)
    v = np.random.default_rng(3).normal(size=system.nv)
    e = numbers(twin, 0.0, rods.p0, v)
    return system, rods.p0, v, e, *solved(e.M, e.C, e.force, e.xi), 10 * tol.EPS * condition(e.M, e.C)


@needs_compiler
@pytest.mark.parametrize("name", LARGE_NETWORKS)
def test_accelerations_of_many_rows_are_those_of_dense_matrices(name, formulation):
    system, p, v, e, vdot, multipliers, bound = by_dense_matrices(name)
    got, reactions = zd.acceleration(system, p, v, formulation=formulation)
    assert_close(got, vdot, bound, what="vdot")
    assert_close(reactions, multipliers, bound, what="multipliers")
    assert_close(e.C @ got, e.xi, 128 * tol.EPS, scale=np.abs(e.C).max() * np.abs(vdot).max(), what="(6)")


@needs_compiler
@pytest.mark.parametrize("options", [{}, {"stabilization": zd.Projection(metric="identity")}, {"energy": True}], ids=str)
def test_motions_of_many_rows_are_those_of_dense_matrices(options, formulation):
    one, other = (zd.simulate(four_bars(14).system(packed=packed), 0.05, formulation=formulation, **STEP, **options)
                  for packed in (True, False))
    for name in ("p", "v", "multipliers"):
        assert_close(getattr(one, name), getattr(other, name), 1e-10, scale=1.0, what=name)


@needs_compiler
def test_redundant_rows_among_many_are_left_out_and_share_their_reactions(formulation):
    rods = four_bars(14, doubled=True)
    one, other = (zd.simulate(rods.system(packed=packed), 0.02, formulation=formulation, **STEP) for packed in (True, False))
    assert len(one.stats["redundant"]) == len(other.stats["redundant"]) == 2
    assert set(one.stats["redundant"]) <= {0, 1, 2, 3}
    assert one.stats["rank"] == other.stats["rank"] == 2 * len(rods.pins) - 2
    assert_close(one.p, other.p, 1e-10, what="p")
    assert_close(one.multipliers, other.multipliers, 1e-10, what="multipliers")
    assert_close(one.multipliers[:, :2], one.multipliers[:, 2:4], 1e-10, what="reactions of two pins at one place")


@needs_compiler
def test_redundant_rows_are_found_on_a_body_of_many_joints():
    """It is taken as several that are welded: what follows from the others may then be rows of welds."""
    rods = fan(60)
    rods.pins.insert(30, (0, 30, *rods.pins[30][2:]))
    rods.pins.insert(3, rods.pins[2])
    one, other = (zd.simulate(rods.system(packed=packed), 0.004, formulation="independent", **STEP) for packed in (True, False))
    assert one.stats["rank"] == other.stats["rank"] == 2 * len(rods.pins) - 4
    assert len(one.stats["redundant"]) == 4
    assert_close(one.p, other.p, 1e-10, scale=1.0, what="p")
    assert_close(one.multipliers, other.multipliers, 1e-9, what="multipliers")


@needs_compiler
@pytest.mark.parametrize("away", [0.0, 3e4])
@pytest.mark.parametrize(("n", "every"), [(14, 14), (30, 2), (150, 3)])
def test_redundant_rows_are_distinguished_from_a_bifurcation_in_long_rows_far_away(n, every, away):
    """Every so many parallelograms have a second bar, a row of which follows; `away` from the origin, in lengths of a rod."""
    rods = four_bars(n, middle=every)
    rods.p0[::3] += away
    rods.pins = [(a, b, np.add(at, (away * (a == -1), 0)), to) for a, b, at, to in rods.pins]
    sol = zd.simulate(rods.system(), 0.02, **STEP)
    doubled = (n + every - 1) // every
    assert len(sol.stats["redundant"]) == doubled
    assert sol.stats["rank"] == 2 * len(rods.pins) - doubled
    cranks = sol.p[-1, 2 : 6 * n + 3 : 6]
    assert cranks[0] < 1
    assert_close(cranks, np.full(n + 1, cranks[0]), 1e-12 * (1 + away), what="angles of parallel rods")


@needs_compiler
def test_a_long_row_of_parallelograms_moves_as_one_though_its_smallest_pivot_is_small():
    """Solutions are then compared with (6) now and then, and are as accurate in between: all rods turn as one pendulum."""
    n = 500
    sol = zd.simulate(four_bars(n).system(), 0.2, **STEP)
    assert sol.stats["smallest_pivot"] < 1e-3
    pull = 9.81 * ((n + 1) / 2 + n) / ((n + 1) / 3 + n)
    angles = np.polynomial.Polynomial(_pendulum(1.0, pull, 24))(sol.t)
    for rod in (0, 1, n // 2, n):
        assert_close(sol.p[:, 6 * rod + 2], angles, 1e-10, scale=1.0, what=f"angle of crank {rod}")


def _pendulum(angle, pull, terms):
    """Taylor coefficients of angle'' = -pull cos(angle) from rest, by those of the sine and the cosine."""
    a, s, c = [angle, 0.0], [np.sin(angle)], [np.cos(angle)]
    for k in range(terms):
        a.append(-pull * c[k] / ((k + 1) * (k + 2)))
        for one, other, sign in ((s, c, 1), (c, s, -1)):
            one.append(sign * sum((j + 1) * a[j + 1] * other[k - j] for j in range(k + 1)) / (k + 1))
    return a


@needs_compiler
def test_constraints_that_are_only_dependent_where_a_large_structure_begins_are_not_taken_for_redundant(formulation):
    flat = four_bars(14, angle=0.0)
    with pytest.raises(zd.Bifurcation, match=r"rows .* and 6 others follow from the others\); branches of so many constraints"):
        zd.simulate(flat.system(), 0.01, formulation=formulation, **STEP)
    with pytest.raises(zd.Bifurcation):
        zd.simulate(flat.system(packed=False), 0.01, formulation=formulation, **STEP)


def test_rows_of_a_large_structure_that_contradict_each_other_are_named():
    n = 42

    def system(order):      # a slope of each body, and of the first again, which moves
        return zd.System(2 * n, mass=lambda p: np.eye(2 * n), p0=np.zeros(2 * n), v0=np.zeros(2 * n),
                         constraints=lambda p, t: np.append(p[::2] - p[1::2], p[0] - p[1] - t**order),
                         structure=zd.Structure([2] * n, [*((1, [b]) for b in range(n)), (1, [0])], "constant diagonal"))

    with refused("contradicting-constraints", r"\(row \d+ follows from the others, but row \d+ requires"):
        zd.simulate(system(2), 0.01, **STEP)


@needs_compiler
@pytest.mark.parametrize("road", ["augmented", "nullspace", "mixed", "independent"])
def test_a_body_without_mass_among_many(road):
    rods = chain(25, closed=True, masses=[1.0] * 12 + [0.0] + [1.0] * 12)
    system, twin = rods.system(), rods.system(packed=False)
    e = numbers(twin, 0.0, rods.p0, np.zeros(system.nv))
    vdot, multipliers = solved(e.M, e.C, e.force, e.xi)
    got, reactions = zd.acceleration(system, rods.p0, np.zeros(system.nv), formulation=road)
    assert_close(got, vdot, 1e-9, what="vdot")
    assert_close(reactions, multipliers, 1e-9, what="multipliers")
    with refused("mass-not-definite", "'augmented' and 'nullspace'"):
        zd.simulate(system, 0.01, **STEP)


@needs_compiler
def test_nothing_that_has_no_mass_may_be_free():
    system = chain(25, masses=[1.0] * 24 + [0.0]).system()
    with refused("mass-not-definite"):
        zd.simulate(system, 0.01, formulation="augmented", **STEP)


def test_independent_refuses_large_structures_with_a_kinematic_matrix_and_names_what_takes_them():
    n = 303
    system = zd.System(n, mass=lambda p: np.eye(n), kinematics=lambda p: np.eye(n), p0=np.zeros(n),
                       structure=zd.Structure([3] * 101, [], ["constant diagonal"] * 101))
    with pytest.raises(zd.UnsuitedFormulation, match=r"'independent' uses dense matrices for .* kinematic matrix, .* at most 300 "
                                                     r"velocities, not 303; the cost of 'schur', 'augmented', 'nullspace' and "):
        zd.simulate(system, 0.01, formulation="independent", step=1e-2)


def test_bodies_without_constraints_may_be_many(formulation):
    """The size of a structure without constraints is that of its velocities."""
    stiffness = np.random.default_rng(1).uniform(1.0, 2.0, 303)
    system = zd.System(303, mass=lambda p: np.eye(303), force=lambda p: -stiffness * p, p0=np.ones(303),
                       structure=zd.Structure([3] * 101, [], ["constant diagonal"] * 101))
    sol = zd.simulate(system, 0.01, formulation=formulation, step=1e-2, integrator="euler")
    assert_close(sol.v[-1], -0.01 * stiffness, 4 * tol.EPS, scale=1.0, what="v")


@needs_compiler
def test_thousands_of_bodies_keep_their_energy_and_constraints():
    sol = zd.simulate(chain(3000, bend=0.1).system(), 0.02, step=1e-3, save_every=20)
    assert sol.stats["steps"] == 20
    assert np.abs(sol.position_violation).max() <= 1e-12 * sol.position_size.max()
    energy = sol.kinetic_energy + sol.potential_energy
    assert abs(energy[-1] - energy[0]) <= 1e-9 * sol.kinetic_energy[-1]


@needs_compiler
def test_a_small_pivot_is_reported_with_its_row_and_decides_nothing():
    angle = 0.0501
    rods, sine, cosine = four_bars(14, angle=angle), np.sin(angle), np.cos(angle)
    velocity = np.zeros(3 * len(rods.masses))
    velocity[2::6] = -1.0                       # all cranks turn as one, through the position in which all rods lie on a line
    velocity[0::6], velocity[1::6] = 0.5 * sine, -0.5 * cosine
    velocity[3::6], velocity[4::6] = sine, -cosine
    with pytest.warns(zd.AccuracyWarning, match=r"at t = 0\.05, .* was left of constraint '.*' once others are eliminated"):
        sol = zd.simulate(rods.system(gravity=0.0), 0.1, None, velocity, step=1e-3)
    assert "digits      lost near a bifurcation" in repr(sol)
    assert 0 < sol.stats["smallest_pivot"] < 1e-8
    assert_close(sol.p[-1, 2::6], np.full(15, angle - 0.1), 1e-10, scale=1.0, what="angles")
