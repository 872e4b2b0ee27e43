"""Tests that ask for `system`, `formulation` or `integrator` run once for each row of the core's tables; those that ask for
a system and an integrator, once for each pair that the core takes.
"""

import atexit
import importlib.util
import os
import shutil
import signal
import tempfile

import pytest

import zerodrift as zd
from caching import cache_folder, compiler  # noqa: F401  (fixtures)
from core_objects import core_objects  # noqa: F401  (a fixture)
from native_systems import PENDULUM, compile_library
from support import FORMULATIONS, INTEGRATORS, SYSTEMS

TAKEN = {f"{name}-{integrator}": (system, integrator)
         for name, system in SYSTEMS.items() for integrator in zd.integrators(system)}
EXTRAS = ("cloudpickle", "distributed", "ipykernel", "mpmath", "nbclient", "nbformat", "numba", "pandas", "scipy", "sympy",
          "tqdm", "xarray")
ABSENT = {name for name in EXTRAS if importlib.util.find_spec(name) is None}


def pytest_configure():
    """Separate the compile cache of the tests from the user's, and let Ctrl-C interrupt also in the background."""
    signal.signal(signal.SIGINT, signal.default_int_handler)    # processes in the background begin with it ignored
    folder = tempfile.mkdtemp(prefix="zerodrift-tests-")
    os.environ["ZERODRIFT_CACHE"] = folder
    atexit.register(shutil.rmtree, folder, ignore_errors=True)


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector):
    """A file that needs a package of the extras which is not installed is left out."""
    return left_out((yield), collector.path)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    """So is a test, which may need it through zerodrift."""
    return left_out((yield), item.path, call)


def left_out(report, path, call=None):
    call = call or getattr(report, "call", None)
    if report.outcome == "failed" and call and call.excinfo and (name := absent(call.excinfo.value)):
        report.outcome, report.longrepr = "skipped", (str(path), 0, f"needs {name}, which is not installed")
    return report


def absent(error):
    """Which package's absence an exception, or what it came from, tells of; None: it is about something else."""
    while error is not None:
        if isinstance(error, ModuleNotFoundError) and (name := str(error.name).partition(".")[0]) in ABSENT:
            return name
        error = error.__cause__ or error.__context__
    return None


def pytest_generate_tests(metafunc):
    wanted = set(metafunc.fixturenames)
    if {"system", "integrator"} <= wanted:
        metafunc.parametrize(("system", "integrator"), TAKEN.values(), ids=TAKEN)
    elif "system" in wanted:
        metafunc.parametrize("system", SYSTEMS.values(), ids=SYSTEMS)
    elif "integrator" in wanted:
        metafunc.parametrize("integrator", INTEGRATORS)
    if "formulation" in wanted:
        metafunc.parametrize("formulation", FORMULATIONS)


@pytest.fixture
def bar():
    """The paper's four-bar, for tests that need some particular mechanism."""
    return SYSTEMS["four_bar"]


@pytest.fixture(scope="session")
def library(tmp_path_factory):
    """The pendulum of tests/native/, for tests of compiled functions."""
    return compile_library(PENDULUM, tmp_path_factory.mktemp("native") / "pendulum.so")
