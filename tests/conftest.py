"""Tests that ask for `system`, `formulation` or `integrator` run once for each row of the core's tables."""

import atexit
import os
import shutil
import tempfile

import pytest

from support import FORMULATIONS, INTEGRATORS, SYSTEMS

TABLES = {"formulation": FORMULATIONS, "integrator": INTEGRATORS}


def pytest_configure():
    """What tests compile is not looked for, nor kept, among what the user has compiled."""
    folder = tempfile.mkdtemp(prefix="zerodrift-tests-")
    os.environ["ZERODRIFT_CACHE"] = folder
    atexit.register(shutil.rmtree, folder, ignore_errors=True)


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
