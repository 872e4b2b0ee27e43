"""Closed-form functions of built-in systems are those of python/write_closed_form.py, and agree with the systems' terms."""

import runpy

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from support import ROOT
from symbolic_counterparts import CHANGED, OF_PARAMETERS

pytest.importorskip("sympy")


def test_they_are_what_is_written():
    writer = runpy.run_path(str(ROOT / "python" / "write_closed_form.py"))
    folder = writer["FOLDER"]
    if (folder / "four_bar.c").read_text().splitlines()[0] != writer["HEADING"]:
        pytest.skip("another version of SymPy may put sums in another order")
    assert {path.name: path.read_text() for path in folder.iterdir()} == writer["sources"]()


@pytest.mark.parametrize("changed", [False, True])
@pytest.mark.parametrize("name", OF_PARAMETERS)
def test_they_move_the_system_as_its_terms_do(name, changed):
    system = getattr(zd.systems, name)(**(CHANGED[name] if changed else {}))
    closed_form, general = (zd.simulate(system, 1.0, step=0.005, closed_form=closed_form) for closed_form in (None, False))
    assert closed_form.stats["closed_form_steps"] > 0.9 * closed_form.stats["steps"]
    assert general.stats["closed_form_steps"] == 0
    for column in ("p", "v", "multipliers", "kinetic_energy", "potential_energy", "energy_input"):
        a, b = getattr(closed_form, column), getattr(general, column)
        if b.size:
            assert np.abs(a - b).max() <= 100 * tol.STEPPED * max(1.0, np.abs(b).max()), column


def test_all_that_have_them_are_compared():
    bring = {name for name in zd.systems.__all__ if getattr(zd.systems, name)()._core.c.closed_forms}
    assert bring == set(OF_PARAMETERS) == set(CHANGED)
