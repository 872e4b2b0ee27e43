"""Mechanisms whose long runs of fixed steps are compiled before their first step."""

import os

import pytest

import zerodrift as zd
from caching import cache_folder  # noqa: F401  (a fixture)
from mechanisms.known import four_bar
from native_systems import needs_compiler
from support import called
from zerodrift.mechanisms.reports import cost, in_words

STEPS = in_words.FEWEST_STEPS
RUN = {"t_span": 0.1, "step": 0.1 / STEPS, "save_every": STEPS}


@pytest.fixture(autouse=True)
def gains(monkeypatch):
    """A run of `STEPS` steps of a four-bar is worth compiling."""
    monkeypatch.delenv("ZERODRIFT_COMPILE", raising=False)
    monkeypatch.setattr(in_words, "WORTH_COMPILING", cost.saved(1000.0, STEPS))


def evaluation(sol):
    return next(line for line in str(sol).splitlines() if line.startswith("  evaluation "))


@needs_compiler
def test_a_run_is_compiled_with_the_bits_of_a_system_that_is(cache_folder):  # noqa: F811  (the fixture)
    empty, full = (zd.simulate(four_bar(), **RUN) for _ in range(2))
    asked = zd.simulate(four_bar().system(compiled=True), **RUN)
    assert empty.system.compiled
    assert empty.stats["closed_form_steps"] == STEPS
    assert evaluation(empty).endswith("closed form")
    assert empty.p.tobytes() == full.p.tobytes() == asked.p.tobytes()
    by_tables = zd.simulate(four_bar().system(compiled=False), **RUN)
    assert abs(by_tables.p - empty.p).max() < 1e-10     # rounding of a tenth of a second


@needs_compiler
def test_layouts_and_changed_parameters_are_kept():
    made = four_bar().system("absolute").with_parameters({"gravity.y": -5.0})
    sol = zd.simulate(made, **RUN)
    assert sol.system.compiled
    assert (sol.system.layout, sol.system.parameters["gravity.y"]) == ("absolute", -5.0)
    assert sol.p.shape[1] == made.nq


def refusals():
    yield "shorter", four_bar(), {"t_span": 0.05}, "saves about"
    yield "adaptive", four_bar(), {"step": None, "rtol": 1e-6, "save_every": 1}, "saves about"
    yield "refused", four_bar().system(compiled=False), {}, "saves about"
    yield "by matrices", four_bar(), {"closed_form": False}, "closed_form=False"
    yield "implicit", four_bar(), {"integrator": "trapezoidal"}, "'trapezoidal' has none"
    pushed = four_bar()
    pushed.torque("push", "crank", value=called(lambda t: 0.1))
    yield "called", pushed, {}, "value of torque 'push' must be a function that can be recorded"


@pytest.mark.parametrize(("made", "changed", "reason"), [each[1:] for each in refusals()], ids=[each[0] for each in refusals()])
def test_other_runs_take_tables_and_say_why(made, changed, reason):
    sol = zd.simulate(made, **RUN | changed)
    assert not sol.system.compiled
    assert reason in evaluation(sol)


@pytest.mark.parametrize(("name", "value", "reason"), [("ZERODRIFT_COMPILE", "0", "saves about"),
                                                       ("CC", "no-such-compiler", "there is no C compiler")])
def test_the_environment_refuses(monkeypatch, name, value, reason):
    monkeypatch.setenv(name, value)
    sol = zd.simulate(four_bar(), **RUN)
    assert not sol.system.compiled
    assert reason in evaluation(sol)


@needs_compiler
@pytest.mark.skipif(os.name == "nt", reason="what stands for a compiler is a program of POSIX")
def test_a_compiler_that_fails_leaves_the_tables(monkeypatch, cache_folder):  # noqa: F811  (the fixture)
    monkeypatch.setenv("CC", "false")
    sol = zd.simulate(four_bar(), **RUN)
    assert not sol.system.compiled
    assert "saves about" in evaluation(sol)
    with pytest.raises(zd.CompilationFailed):
        zd.simulate(four_bar().system(compiled=True), **RUN)


def test_runs_of_an_ensemble_have_the_same_bits_alone_and_one_by_one():
    masses = {"crank.mass": [1.0, 2.0]}
    many = zd.ensemble(four_bar(), parameters=masses, outputs=["crank.angle"], **RUN | {"save_every": 100})
    kept = zd.ensemble(four_bar(), parameters=masses, keep="solutions", **RUN | {"save_every": 100})
    made = zd.ensemble(lambda mass: four_bar().with_parameters({"crank.mass": mass}), parameters={"mass": [1.0, 2.0]},
                       outputs=["crank.angle"], **RUN | {"save_every": 100})
    for each in (many[1], kept[1]):
        assert not each.system.compiled
        assert each["crank.angle"].tobytes() == many["crank.angle"][1].tobytes()
    assert made["crank.angle"].tobytes() == many["crank.angle"].tobytes()


def test_compiled_must_be_a_flag():
    with pytest.raises(TypeError, match="compiled must be None, True or False"):
        four_bar().system(compiled=1)
