"""Looks at steps are far between where all is well, and close together again as soon as it is not."""

import warnings

import numpy as np
import pytest

import zerodrift as zd

OMEGA, STEP, LATE = 1.0, 0.02, 1000     # rad/s, s, steps: looks are 64 steps apart long before
SOON = 24                               # steps: looks are then eight apart again, and three of them have to agree


def oscillators(late, mass=1e-3):
    """A heavy one at rate OMEGA, and another, on which the force `late` (t, x, v) acts: at first it does little."""
    return zd.System(["heavy", "other"], mass=np.diag([1.0, mass]), p0=[1.0, 0.0],
                     force=lambda t, p, v: np.array([-OMEGA**2 * p[0], late(t, p[1], v[1])]))


def listened(system, steps, **options):
    """A run, and what is said of it."""
    with warnings.catch_warnings(record=True) as said, np.errstate(all="ignore"):
        warnings.simplefilter("always")
        sol = zd.simulate(system, steps * STEP, step=STEP, on_failure="return", **options)
    return sol, [str(warning.message) for warning in said]


@pytest.mark.parametrize("method", ["heun", "rk4", "dormand_prince"])
def test_a_spring_that_stiffens_late_is_noticed_soon(method):
    """Steps in which it oscillates at 4 / STEP are unstable, and nothing of it was to be seen until then."""
    def held(t, x, v):
        stiffness = 1e-3 * (1.0 if t <= LATE * STEP else (4 / STEP) ** 2)
        return -stiffness * (x - 1e-3 * np.sin(t))

    calm, said = listened(oscillators(held), LATE, integrator=method)
    assert calm.stats["too_long"] == 0
    assert not said
    sol, said = listened(oscillators(held), LATE + SOON, integrator=method)
    assert sol.stats["too_long"] >= 3
    assert sol.stats["omega_h"] > 3
    assert any("is stable for" in sentence for sentence in said)


@pytest.mark.parametrize("method", ["heun", "trapezoidal"])
def test_a_low_inertia_component_that_is_hit_late_is_named(method):
    """It weighs too little for the energy balance, and swings at 0.6 / STEP: steps miss its phase."""
    def hit(t, x, v):
        return 1e-9 * (-(0.6 / STEP) ** 2 * x + (4e4 if LATE * STEP < t <= (LATE + 1) * STEP else 0.0))

    sol, said = listened(oscillators(hit, mass=1e-9), 2 * LATE, integrator=method)
    assert np.abs(sol.p[LATE + 1:, 1]).max() > 1
    assert any("do not resolve the motion of 'other'" in sentence for sentence in said)
    assert LATE * STEP < sol.stats["unresolved_time"] < 1.1 * LATE * STEP


@pytest.mark.parametrize("period", [32, 64])
def test_the_largest_kinetic_energy_is_found_in_step_with_the_looks(period):
    """All looks that are far between would come where t cos(omega t) turns back."""
    omega = 2 * np.pi / (period * STEP)
    system = zd.System(["x"], mass=np.eye(1), p0=[0.0], v0=[1.0], potential=lambda p: omega**2 * p[0] ** 2 / 2,
                       force=lambda t, p: np.array([-omega**2 * p[0] - 2 * omega * np.sin(omega * t)]))
    sol, _ = listened(system, 40 * period, integrator="dormand_prince")
    assert 0.5 < sol.stats["largest_kinetic"] / sol.kinetic_energy.max() <= 1 + 1e-12
