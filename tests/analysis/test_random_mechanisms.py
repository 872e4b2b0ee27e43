"""Random mechanisms with loops, redundant joints, drives and forces: the same results in joint and in absolute coordinates."""

import numpy as np
import pytest

import zerodrift as zd
from covering import draws
from mechanisms.random_mechanisms import Maker
from mechanisms.random_starts import mechanism

# Blades leave families of equilibria.
SEEDS = [seed for seed in range(draws(10, 24)) if "blade" not in Maker(seed).m._elements]


def both(seed):
    m = Maker(seed).m
    return [m.system(layout) for layout in ("joint", "absolute")]


@pytest.mark.parametrize("seed", SEEDS)
def test_equilibria_and_spectra_are_the_same(seed):
    spectra = []
    for system in both(seed):
        try:
            eq = zd.equilibrium(system)
        except zd.EquilibriumFailed:
            spectra.append(None)        # forces of the sample may have no balance
            continue
        terms = system.evaluate(eq.p, eq.v)
        left = terms.f - (0 if terms.d is None else terms.d) - (0 if terms.C is None else terms.C.T @ eq.multipliers)
        assert np.abs(left).max() < 1e-9 * (np.abs(terms.f).max() + np.abs(eq.multipliers).max(initial=1.0))
        spectra.append(zd.linearize(system, eq).eigenvalues)
    one, other = spectra
    assert (one is None) == (other is None)
    if one is not None:
        assert len(one) == len(other)
        assert max((np.abs(other - each).min() for each in one), default=0.0) < 1e-7 * np.abs(one).max(initial=1.0)


def test_a_family_of_equilibria_on_a_curve_is_a_free_direction():
    """A body that hangs between joints may turn about a curved axis: its neighbours follow in second order."""
    found = [zd.equilibrium(mechanism(104, in_space=True)[0].system(layout)) for layout in ("joint", "absolute")]
    energies = [eq.system.evaluate(eq.p, eq.v).V for eq in found]
    assert energies[0] == pytest.approx(energies[1], rel=1e-12)
    for eq in found:
        assert eq.stable is True
        assert [name.partition(" ")[2] for name in eq.free] == ["rotation about y"]     # both b1 and b2 turn


@pytest.mark.parametrize("seed", SEEDS)
def test_the_free_motion_needs_no_effort(seed):
    for system in both(seed):
        p, v = system.start_at(0.0)
        vdot, _ = zd.acceleration(system, p, v)
        efforts = [each.name for each in system.velocities]
        inv = zd.inverse_dynamics(system, 0.0, p, v, vdot, efforts=efforts)
        assert max(np.abs(inv[each]).max() for each in efforts) < 1e-8 * max(1.0, np.abs(system.evaluate(p, v).f).max())
