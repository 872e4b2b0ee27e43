"""Tests that ask for `system`, `formulation` or `integrator` run once for each row of the core's tables."""

import atexit
import os
import shutil
import tempfile

import pytest

os.environ["ZERODRIFT_CACHE"] = tempfile.mkdtemp(prefix="zerodrift-tests-")    # before anything is compiled: tests start afresh
atexit.register(shutil.rmtree, os.environ["ZERODRIFT_CACHE"], ignore_errors=True)

from support import FORMULATIONS, INTEGRATORS, SYSTEMS

TABLES = {"formulation": FORMULATIONS, "integrator": INTEGRATORS}


def pytest_generate_tests(metafunc):
    if "system" in metafunc.fixturenames:
        metafunc.parametrize("system", SYSTEMS.values(), ids=SYSTEMS.keys())
    for name, rows in TABLES.items():
        if name in metafunc.fixturenames:
            metafunc.parametrize(name, rows)


@pytest.fixture
def bar():
    """The paper's four-bar, for tests that need some particular mechanism."""
    return SYSTEMS["four_bar"]
