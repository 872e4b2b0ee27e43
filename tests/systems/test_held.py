"""Holding coordinates and velocities of systems that declare their structure: as of twins that declare nothing, at any size."""

import numpy as np
import pytest

import zerodrift as zd
from native_systems import needs_compiler
from random_networks import Network
from structured import Bodies, chain, four_bars
from support import assert_close, refused

AGREES = 1e-11      # of p and v: positions are iterated to 1e-12 of the rows' sizes
SYSTEMS = {"few rows": Bodies(3), "kinematic matrix": Bodies(4, kinematics=True), "many rows": Network(6, bodies=18),
           "redundant rows, singular M": Network(5, bodies=18, redundant=3, massless=3)}


def some_of(system, seed, count):
    """Names of so many coordinates, and of as many velocities."""
    rng = np.random.default_rng(seed)
    names = ([variable.name for variable in group] for group in (system.coordinates, system.velocities))
    return [str(name) for group in names for name in rng.choice(group, size=count, replace=False)]


@pytest.mark.parametrize("bodies", SYSTEMS.values(), ids=SYSTEMS)
def test_what_is_held_of_a_structure_is_held_as_without(bodies):
    packed, dense = bodies.system(), bodies.system(packed=False)
    guess = bodies.p + 0.01 * np.random.default_rng(1).normal(size=bodies.n)
    for seed, count in ((1, 0), (3, max(1, (bodies.n - bodies.m) // 12))):
        names = some_of(packed, seed, count)
        one, other = (zd.assemble(system, guess, bodies.v, hold=names) for system in (packed, dense))
        assert_close(one[0], other[0], AGREES, scale=1.0, what=f"p with {names} held")
        assert_close(one[1], other[1], AGREES, scale=1.0, what=f"v with {names} held")
        held = [i for i, variable in enumerate(packed.coordinates) if variable.name in names]
        assert (one[0][held] == guess[held]).all()


@needs_compiler
@pytest.mark.parametrize("rods", [chain(3000), four_bars(1500)], ids=["chain", "four-bars"])
def test_thousands_of_bodies_are_assembled_with_some_of_them_held(rods):
    """9000 velocities and up to 7500 rows, too many for dense matrices here; of the chain half of the angles are held."""
    system = rods.system()
    count = len(rods.masses)
    held = np.arange(0, count, 2) if 2 * len(rods.pins) == 2 * count else np.array([0])
    guess = rods.p0 + 1e-4 * np.sin(np.arange(3 * count))
    names = [system.coordinates[3 * i + 2].name for i in held] + [system.velocities[2].name]
    p, v = zd.assemble(system, guess, np.full(3 * count, 0.1), hold=names)
    assert (p[3 * held + 2] == guess[3 * held + 2]).all()
    assert abs(v[2] - 0.1) < 1e-12
    sol = zd.simulate(system, 1e-3, p, v, step=1e-3)        # which refuses a start that violates the constraints
    assert np.abs(sol.position_violation[0]).max() <= 1e-12 * sol.position_size.max()


@needs_compiler
def test_what_cannot_be_held_is_reported():
    rods = chain(60, closed=True)
    system = rods.system()
    guess = rods.p0 + 0.1
    with refused("correction-failed"):
        zd.assemble(system, guess, hold=[variable.name for variable in system.coordinates])
