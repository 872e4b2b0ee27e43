"""The comparison with other programs: all of them solve the problem that zerodrift solves."""

import functools
import importlib

import numpy as np
import pytest

import energy_models
import tolerances as tol
import zerodrift as zd
from support import ROOT

PEERS = ROOT / "tests" / "bench" / "peers"
SETTINGS = {    # module: package, one cheap setting of each kind of method
    "scipy": ("scipy", [("DOP853", 1e-6), ("LSODA", 1e-7)]),
    "sundials": ("sksundae", [("CVODE Adams", 1e-8), ("IDA", 1e-7)]),
    "exudyn": ("exudyn", [("trapezoidal, index 2", 32), ("generalized alpha", 32)]),
    "pinocchio": ("pinocchio", [("rk4", 8), ("DOP853", 1e-6)]),
    "mujoco": ("mujoco", [("RK4", 2, 64)]),
    "heyoka": ("heyoka", [("velocities eliminated", 1e-9), ("multipliers eliminated", 1e-9)]),
    "numba": ("numba", [("SciPy DOP853", 1e-8), ("DOP853 by hand", 1e-8)]),
    "numbalsoda": ("numbalsoda", [("LSODA", 1e-9), ("DOP853", 1e-8)]),
}
CLOSE = 1e-2        # rad: what is wrong in a model or its start, is so by more within seconds


@pytest.fixture(scope="module", autouse=True)
def _path():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(PEERS.parent)
        patch.syspath_prepend(PEERS)
        yield


@pytest.fixture(scope="module", params=["four_bar", 4])
def chain(request):
    problems = importlib.import_module("problems")
    return problems.four_bar() if request.param == "four_bar" else problems.pendulum_chain(request.param)


def test_accelerations_are_those_of_the_system(chain):
    problems, ours = importlib.import_module("problems"), importlib.import_module("with_zerodrift")
    p, v = zd.assemble(ours.python_system(chain), chain.p0, chain.v0 + 0.3)
    expected = problems.accelerations(chain)(p, v)
    for kind in ours.kinds(chain):
        found = zd.acceleration(ours.system_of(chain, kind), p, v)[0]
        np.testing.assert_allclose(found, expected, rtol=0, atol=tol.STEPPED * np.abs(expected).max())


def test_equations_that_are_written_out_are_those_of_the_system(chain):
    problems, equations = importlib.import_module("problems"), importlib.import_module("equations")
    ours = importlib.import_module("with_zerodrift")
    p, v = zd.assemble(ours.python_system(chain), chain.p0, chain.v0 + 0.3)
    expected, pair = problems.accelerations(chain)(p, v), equations.least_parallel(p, np.sin)
    free = [i for i in range(chain.n) if i not in pair]
    close = {"rtol": 0, "atol": tol.STEPPED * np.abs(expected).max()}
    np.testing.assert_allclose(equations.with_multipliers(chain, p, v, np.sin, np.cos), expected, **close)
    np.testing.assert_allclose(equations.reduced(chain, p, v, pair, np.sin, np.cos), expected, **close)
    np.testing.assert_allclose(equations.reduced(chain, p, None, pair, np.sin, np.cos)(v[free]), v, **close)


def test_andrews_mechanism_is_the_model():
    """Its equations are derived apart from those of the model: with multipliers, without, and in the crank's velocity."""
    problem, functions = importlib.import_module("andrews").Squeezer(), {"sin": np.sin, "cos": np.cos, "sqrt": np.sqrt}
    system = energy_models.andrews()
    np.testing.assert_array_equal(problem.p0, system.p0)
    p, v = zd.assemble(system, problem.p0, problem.spread(problem.p0, 40.0, functions))
    expected = zd.acceleration(system, p, v)[0]
    close = {"rtol": 0, "atol": tol.STEPPED * np.abs(expected).max()}
    np.testing.assert_allclose(problem.spread(p, v[0], functions), v, **close)
    for found in (problem.accelerations(), *(functools.partial(written, functions=functions) for written in (
            problem.reduced, problem.with_multipliers))):
        np.testing.assert_allclose(found(p, v), expected, **close)


def test_the_four_bar_is_the_paper_s():
    bar, chain = zd.systems.four_bar(), importlib.import_module("problems").four_bar()
    np.testing.assert_allclose(chain.p0, bar.p0, atol=tol.STEPPED)
    np.testing.assert_allclose(chain.v0, bar.v0, atol=tol.STEPPED)


@pytest.mark.filterwarnings("default")      # what other packages warn of is not ours
@pytest.mark.parametrize("peer", SETTINGS)
def test_a_peer_that_is_installed_finds_the_same_motion(chain, peer):
    package, settings = SETTINGS[peer]
    pytest.importorskip(package)
    module, ours = importlib.import_module(f"with_{peer}"), importlib.import_module("with_zerodrift")
    exact, _ = ours.reference(chain, 1e-8)
    until = chain.outputs <= 2.0
    for setting in settings:
        p, seconds = module.solve(chain, setting)
        assert seconds > 0
        assert np.abs(p - exact)[until].max() < CLOSE, setting


@pytest.mark.parametrize(("heading", "package", "close"), [
    ("Pinocchio", "pinocchio", 1e-9),       # both prescribe the motion: round-off
    ("PyDy", "pydy", 1e-3)])                # its crank is driven by a torque, and slower by 1e-4
def test_the_reaction_on_the_page_for_newcomers_is_ours(heading, package, close):
    pytest.importorskip(package)
    page = (ROOT / "notebooks" / "start" / "coming_from.md").read_text(encoding="utf-8")
    ours, theirs = {}, {}
    exec(page.partition("```python\n")[2].partition("```")[0].replace("m, 1.0)", "m, 0.01, step=1e-4)"), ours)
    exec(page.partition(f"## {heading}\n")[2].partition("```{code-block} python\n")[2].partition("```")[0], theirs)
    expected = ours["sol"]["main.force"][-1]
    np.testing.assert_allclose(theirs["reaction"], expected, rtol=0, atol=close * np.abs(expected).max())
