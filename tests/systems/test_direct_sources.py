"""Closed-form functions of built-in systems are those that python/write_direct.py writes, and agree with the systems' terms."""

import runpy

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from support import ROOT
from symbolic_counterparts import OF_PARAMETERS

pytest.importorskip("sympy")

# Of each parameter another value than that the functions were written with.
CHANGED = {
    "four_bar": {"lengths": (1.1, 0.35, 0.9, 0.7), "masses": (1.0, 2.0, 4.0), "inertias": (0.02, 0.3, 0.1), "gravity": 5.0},
    "driven_four_bar": {"lengths": (1.1, 0.35, 0.9, 0.7), "masses": (1.0, 2.0, 4.0), "gravity": 5.0, "crank_rate": 0.7,
                        "amplitude": 0.2, "frequency": 3.0, "crank_angle": 1.0},
    "pendulum": {"length": 0.7, "mass": 2.0, "gravity": 5.0, "rate": 1.0},
    "slider_crank": {"crank": 0.4, "rod": 1.3, "crank_inertia": 0.5, "mass": 2.0, "rod_inertia": 0.3, "stiffness": 3.0,
                     "damping": 0.5, "relaxed_length": 0.8, "force": 2.0, "crank_rate": 1.0},
    "chaplygin_sleigh": {"mass": 2.0, "inertia": 0.3, "offset": -0.2, "speed": 1.0},
    "oscillator": {"mass": 2.0, "stiffness": 3.0, "x0": 0.5, "v0": -1.0},
    "knife_edge": {"mass": 2.0, "inertia": 0.3, "gravity": 5.0, "incline": 0.3, "heading": 0.5, "speed": 1.0, "turn_rate": 2.0},
    "vertical_disc": {"mass": 2.0, "radius": 0.4, "axle_inertia": 0.3, "diameter_inertia": 0.1, "heading": 0.5, "turn_rate": 3.0},
}


def test_they_are_what_is_written():
    writer = runpy.run_path(str(ROOT / "python" / "write_direct.py"))
    folder = writer["FOLDER"]
    if (folder / "four_bar.c").read_text().splitlines()[0] != writer["HEADING"]:
        pytest.skip("another version of SymPy may put sums in another order")
    assert {path.name: path.read_text() for path in folder.iterdir()} == writer["sources"]()


@pytest.mark.parametrize("changed", [False, True])
@pytest.mark.parametrize("name", OF_PARAMETERS)
def test_they_move_the_system_as_its_terms_do(name, changed):
    system = getattr(zd.systems, name)(**(CHANGED[name] if changed else {}))
    direct, general = (zd.simulate(system, 1.0, step=0.005, direct=direct) for direct in (None, False))
    assert direct.stats["direct_steps"] > 0.9 * direct.stats["steps"]
    assert general.stats["direct_steps"] == 0
    for column in ("p", "v", "multipliers", "kinetic_energy", "potential_energy", "energy_input"):
        a, b = getattr(direct, column), getattr(general, column)
        if b.size:
            assert np.abs(a - b).max() <= 100 * tol.STEPPED * max(1.0, np.abs(b).max()), column


def test_all_that_have_them_are_compared():
    """And those are all but one, whose pivots would not show where it is singular."""
    bring = {name for name in zd.systems.__all__ if getattr(zd.systems, name)()._core.c.closed_forms}
    assert bring == set(OF_PARAMETERS) == set(CHANGED) == set(zd.systems.__all__) - {"rolling_disc"}
