"""The energy balance (28), where nothing corrects it."""

import numpy as np

import tolerances as tol
from support import assert_close, motion, numbers, with_energy


def test_energy_balance_holds_along_the_motion(system, formulation):
    """E - E0 - input of (28), where nothing corrects it: as small as the motion is exact."""
    sol = motion(with_energy(system), 0.5, 500, formulation=formulation)
    kept = sol.kinetic_energy + sol.potential_energy - sol.energy_input
    scale = np.abs(sol.kinetic_energy).max() + np.abs(sol.potential_energy).max()
    assert_close(sol.energy_violation, kept - kept[0], tol.SAME, scale=scale)
    assert np.abs(sol.energy_violation).max() <= tol.CONVERGED * scale


def test_recorded_energies_are_those_of_the_states(system):
    sol = motion(with_energy(system), 0.5, 25)
    for k, (t, p, v) in enumerate(zip(sol.t, sol.p, sol.v, strict=True)):
        e = numbers(system, t, p, v)
        assert_close(sol.kinetic_energy[k], v @ e.M @ v / 2, tol.SAME)
        assert_close(sol.potential_energy[k], e.V, tol.SAME)
