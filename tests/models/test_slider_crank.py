"""The slider-crank of `zd.models`, and that of the tests by its energies, against the reference file."""


import energy_models
import known_motions
import zerodrift as zd
from reference_files import table
from support import assert_close, refused


def test_bodies_and_joints_against_the_reference():
    reference = table("sundials_slider_crank")
    sol = zd.simulate(zd.models.slider_crank(), 10.0, step=0.02, integrator="dop853", t_eval=reference["t"])
    assert known_motions.slider_crank(sol) < 1e-9
    energies = zd.simulate(energy_models.slider_crank(), 10.0, step=0.02, integrator="dop853", t_eval=reference["t"])
    assert_close(sol.kinetic_energy, energies.kinetic_energy, 1e-9)


def test_a_slider_crank_that_cannot_turn():
    with refused("geometry", r"^rod must.*of 0\.5.*not 0\.4"):
        zd.models.slider_crank(rod=0.4)
