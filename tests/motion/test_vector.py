"""Vector unit of closed-form functions: by argument, by environment variable, or the processor's; and its report."""

import os

import numpy as np
import pytest

import symbolic_counterparts
import tolerances as tol
import zerodrift as zd
from native_systems import needs_compiler
from support import refused
from zerodrift._private.core import lib
from zerodrift.runs.arguments import settings

UNITS = settings.VECTOR_UNITS[: lib.zd_processor_unit() + 1]
SYSTEMS = {"built in": zd.systems.four_bar, "symbolic": symbolic_counterparts.four_bar}
ON_WINDOWS = pytest.mark.skipif(os.name == "nt", reason="with gcc there are no vector units on Windows")
NAMES = ["built in", pytest.param("symbolic", marks=ON_WINDOWS)]
pytestmark = needs_compiler


def run(name, **options):
    return zd.simulate(SYSTEMS[name](), 1.0, step=0.01, **options)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("vector", UNITS)
def test_it_is_reported_and_a_run_made_again_has_the_same_bits(name, vector):
    sol = run(name, vector=vector)
    assert sol.settings["vector"] == vector
    assert sol.stats["closed_form_steps"] == sol.stats["steps"]
    again = zd.simulate(sol.system, sol.t_span, **sol.settings)
    assert np.array_equal(again.p, sol.p)
    assert np.array_equal(sol(0.123)[0], run(name, vector=vector, t_eval=[0.123]).p[0])


@pytest.mark.parametrize("name", NAMES)
def test_units_differ_in_rounding_from_the_baseline_and_not_among_each_other(name):
    baseline, *units = (run(name, vector=vector) for vector in UNITS)
    for sol in units:
        assert not np.array_equal(sol.p, baseline.p)
        assert np.abs(sol.p - baseline.p).max() <= tol.STEPPED * np.abs(baseline.p).max()
        assert np.array_equal(sol.p, units[0].p)


def test_the_environment_is_read_where_the_argument_says_nothing(monkeypatch):
    for vector in UNITS:
        monkeypatch.setenv("ZERODRIFT_VECTOR", vector)
        assert run("built in").settings["vector"] == vector
        assert run("built in", vector="baseline").settings["vector"] == "baseline"
    monkeypatch.delenv("ZERODRIFT_VECTOR")
    assert run("built in").settings["vector"] == UNITS[-1]


def test_the_core_knows_which_units_there_are():
    assert [lib.zd_processor_has(unit) != 0 for unit in range(len(settings.VECTOR_UNITS))] == [
        unit <= lib.zd_processor_unit() for unit in range(len(settings.VECTOR_UNITS))]


def test_what_there_is_not_is_refused(monkeypatch):
    with refused("unknown-choice", r"^vector must be "):
        run("built in", vector="neon")
    monkeypatch.setattr(zd._private.gateway, "PROCESSOR_UNIT", 1)
    with refused("wrong-value", r"^vector must be 'baseline' or 'avx2', which this processor has, not 'avx512' "):
        run("built in", vector="avx512")
    monkeypatch.setenv("ZERODRIFT_VECTOR", "avx1024")
    with refused("unknown-choice", r"^ZERODRIFT_VECTOR must be "):
        run("built in")


@pytest.mark.parametrize("vector", UNITS[1:])
def test_where_the_compiler_has_no_vectors_the_baseline_is_reported(vector):
    system = symbolic_counterparts.four_bar()
    plain = system._closed_form.library_of("0x40000000")     # no set that a compiler could write
    system._closed_form._libraries[f"ZD_SET_{vector.upper()}_1"] = plain
    sol = zd.simulate(system, 1.0, step=0.01, vector=vector)
    assert sol.settings["vector"] == "baseline"
    assert sol.stats["closed_form_steps"] == sol.stats["steps"]
    assert np.array_equal(sol.p, run("symbolic", vector="baseline").p)


def test_a_run_on_the_matrix_path_used_none():
    assert run("built in", integrator="rattle").settings["vector"] is None


def test_solutions_of_before_used_none():
    assert settings.core_settings((0.0, 1.0), {k: v for k, v in run("built in").settings.items() if k != "vector"}).vector == 0


def test_all_other_paths_have_the_same_bits_with_all_units():
    general = [run("built in", closed_form=False, vector=vector).p for vector in UNITS]
    assert all(np.array_equal(each, general[0]) for each in general)
