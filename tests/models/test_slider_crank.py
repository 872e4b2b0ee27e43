"""The slider-cranks of `zd.models` against the built-in one and the reference file."""

import numpy as np
import pytest

import energy_models
import known_motions
import zerodrift as zd
from reference_files import table
from support import assert_close, refused


def test_slider_crank_is_the_built_in_one(formulation):
    """Which loses energy as the reference file says."""
    mine, built_in = energy_models.slider_crank(), zd.systems.slider_crank()
    assert_close(mine.p0, built_in.p0, 1e-15)
    sols = [zd.simulate(system, 10.0, step=0.0025, save_every=100, formulation=formulation) for system in (mine, built_in)]
    assert_close(sols[0].p, sols[1].p, 1e-10)
    assert_close(sols[0].energy_input, sols[1].energy_input, 1e-10)
    reference = table("sundials_slider_crank")
    assert_close(sols[0].p, np.stack([reference[name] for name in ("q", "x", "p")], axis=1), 1e-9)


def test_bodies_and_joints_against_the_reference():
    reference = table("sundials_slider_crank")
    sol = zd.simulate(zd.models.slider_crank(), 10.0, step=0.02, integrator="dop853", t_eval=reference["t"])
    assert known_motions.slider_crank(sol) < 1e-9
    built_in = zd.simulate(zd.systems.slider_crank(), 10.0, step=0.02, integrator="dop853", t_eval=reference["t"])
    assert_close(sol.kinetic_energy, built_in.kinetic_energy, 1e-9)


@pytest.mark.parametrize("model", [zd.models.slider_crank, energy_models.slider_crank])
def test_a_slider_crank_that_cannot_turn(model):
    with refused("geometry", r"^rod must.*of 0\.5.*not 0\.4"):
        model(rod=0.4)
