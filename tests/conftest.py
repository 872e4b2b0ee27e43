"""Tests with an argument `system`, `formulation` or `integrator` run once for each entry of the core's tables, and those with a
system and an integrator once for each pair that the core accepts.

With all three, or with more axes by ``@pytest.mark.pairs(name=values, ...)``, they run for cases in which each pair of values of
two axes occurs. With ``@pytest.mark.each_value`` each value of each axis occurs, where other tests have the pairs. They run
for the whole product with ZERODRIFT_PRODUCTS=1 in the environment, and for each value only with ZERODRIFT_EACH_VALUE=1.
"""

import atexit
import functools
import importlib.util
import os
import random
import shutil
import signal
import tempfile

import pytest

import zerodrift as zd
from browser import browser  # noqa: F401  (a fixture)
from caching import cache_folder, compiler  # noqa: F401  (fixtures)
from core_objects import core_objects  # noqa: F401  (a fixture)
from covering import EACH_VALUE, WHOLE, covering, product
from native_systems import PENDULUM, compile_library
from support import FORMULATIONS, INTEGRATORS, SYSTEMS
from zerodrift.export import fmu_libraries

TABLES = {"system": SYSTEMS, "integrator": {name: name for name in INTEGRATORS},
          "formulation": {name: name for name in FORMULATIONS}}
TAKEN = {(name, integrator) for name, system in SYSTEMS.items() for integrator in zd.integrators(system)}
EXTRAS = ("cloudpickle", "distributed", "ipykernel", "mpmath", "nbclient", "nbformat", "numba", "pandas", "scipy", "sympy",
          "tqdm", "xarray")
ABSENT = {name for name in EXTRAS if importlib.util.find_spec(name) is None}


def pytest_configure(config):
    """Separate the compile cache of the tests from the user's, compile only what a test wants, and let Ctrl-C interrupt also
    in the background.
    """
    signal.signal(signal.SIGINT, signal.default_int_handler)    # processes in the background begin with it ignored
    if not WHOLE:
        fmu_libraries.FLAGS = ("-O0", *fmu_libraries.FLAGS[1:])     # FMUs: the same bits, in a third of the compiler's time
    if not hasattr(config, "workerinput"):      # processes of pytest-xdist share the cache of the one that started them
        folder = tempfile.mkdtemp(prefix="zerodrift-tests-")
        os.environ |= {"ZERODRIFT_CACHE": folder, "ZERODRIFT_COMPILE": "0"}
        atexit.register(shutil.rmtree, folder, ignore_errors=True)


def pytest_collection_modifyitems(items):
    """Random order of files, and of tests in them, with ZERODRIFT_ORDER as the seed; tests of a file stay together."""
    if seed := os.environ.get("ZERODRIFT_ORDER"):
        draw = random.Random(seed)
        place = {path: draw.random() for path in dict.fromkeys(item.path for item in items)}
        draw.shuffle(items)
        items.sort(key=lambda item: place[item.path])


def pytest_xdist_auto_num_workers(config):
    """The whole suite runs in one process per CPU, at most eight, as each collects all tests; files and folders in this one."""
    whole = config.args_source == config.ArgsSource.TESTPATHS
    return min(8, len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()) if whole else 0


def pytest_terminal_summary(terminalreporter):
    """Count of tests skipped for lack of a browser or of node, which no extra of the package installs."""
    skipped = [report.longrepr for report in terminalreporter.stats.get("skipped", [])]
    reasons = [str(each[2]) for each in skipped if isinstance(each, tuple)]
    for program in ("Chromium", "node"):
        if count := sum(f"there is no {program}" in reason for reason in reasons):
            terminalreporter.write_line(f"{count} tests skipped: there is no {program}")


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
    axes = {name: values for name, values in TABLES.items() if name in metafunc.fixturenames}
    for mark in metafunc.definition.iter_markers("pairs"):
        axes |= {name: values if isinstance(values, dict) else {str(value): value for value in values}
                 for name, values in mark.kwargs.items()}
    if axes:
        strength = 1 if EACH_VALUE or metafunc.definition.get_closest_marker("each_value") else 2
        cases = cases_of(tuple((name, tuple(values)) for name, values in axes.items()), strength)
        metafunc.parametrize(tuple(axes), [[axes[name][key] for name, key in case.items()] for case in cases],
                             ids=["-".join(case.values()) for case in cases])


@functools.cache
def cases_of(axes, strength):
    """Cases for axes, pairs of a name and its values, which several tests have in common."""
    return product(dict(axes), is_accepted) if WHOLE else covering(dict(axes), is_accepted, strength)


def is_accepted(system=None, integrator=None, **_):
    """True unless the core refuses this integrator for this system."""
    return system is None or integrator is None or (system, integrator) in TAKEN


@pytest.fixture
def few_places(monkeypatch):
    """References look for what acts in a narrow place with a tenth of the steps: for systems that have no such place."""
    if not WHOLE:
        monkeypatch.setattr("zerodrift.studies.reference_search.DENSE", 900)


@pytest.fixture
def bar():
    """The paper's four-bar, for tests that need some particular mechanism."""
    return SYSTEMS["four_bar"]


@pytest.fixture(scope="session")
def library(tmp_path_factory):
    """The pendulum of tests/native/, for tests of compiled functions."""
    return compile_library(PENDULUM, tmp_path_factory.mktemp("native") / "pendulum.so")
