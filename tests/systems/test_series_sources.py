"""Taylor series of built-in systems are those that python/write_series.py writes, and follow the motion that the terms have."""

import runpy

import numpy as np
import pytest

import zerodrift as zd
from support import ROOT
from symbolic_counterparts import CHANGED

pytest.importorskip("sympy")


def test_they_are_what_is_written():
    writer = runpy.run_path(str(ROOT / "python" / "write_series.py"))
    folder, found = writer["SYSTEMS"], writer["sources"]()
    if writer["HEADING"] not in (folder / "series" / "four_bar.c").read_text().splitlines()[:4]:
        pytest.skip("another version of SymPy may put sums in another order")
    assert {f"series/{path.name}": path.read_text() for path in (folder / "series").iterdir()} == found


@pytest.mark.parametrize("changed", [False, True])
@pytest.mark.parametrize("name", CHANGED)
def test_they_follow_the_motion_of_the_terms(name, changed):
    """Against a method that evaluates the terms alone; both errors are those of their tolerances, multiplied by the motion."""
    system = getattr(zd.systems, name)(**(CHANGED[name] if changed else {}))
    given = {"rtol": 1e-12, "atol": 1e-12, "formulation": "augmented", "t_eval": [0.5, 1.0]}
    series, terms = (zd.simulate(system, 1.0, integrator=integrator, **given) for integrator in ("taylor", "dop853"))
    for column in ("p", "v", "multipliers", "energy_input"):
        a, b = getattr(series, column), getattr(terms, column)
        if b is not None and b.size:
            assert np.abs(a - b).max() <= 1e-9 * max(1.0, np.abs(b).max()), column
    assert series.stats["steps"] < terms.stats["steps"]


@pytest.mark.parametrize("changed", [False, True])
@pytest.mark.parametrize("name", CHANGED)
def test_those_in_double_double_arithmetic_are_of_the_same_motion(name, changed):
    system = getattr(zd.systems, name)(**(CHANGED[name] if changed else {}))
    ref = zd.reference(system, 0.5, error=1e-22, t_eval=[0.0, 0.25, 0.5])
    sol = zd.simulate(system, 0.5, rtol=1e-12, atol=1e-12, t_eval=[0.0, 0.25, 0.5])
    assert ref.precision == "double-double"
    assert np.abs(ref.p - sol.p).max() <= 1e-9 * max(1.0, np.abs(ref.p).max())
    assert 0 < np.abs(ref.p_low).max() <= 2.0**-53 * np.abs(ref.p).max()
