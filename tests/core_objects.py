"""The core's sources, compiled once for all tests that link them with programs of their own or look at their symbols."""

import os
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor

import pytest

from support import ROOT

CSRC = ROOT / "csrc"
SOURCES = sorted(CSRC.rglob("*.c"))
CC = os.environ.get("CC", "cc")
needs_compiler = pytest.mark.skipif(not shutil.which(CC) or not SOURCES, reason="no C compiler, or no sources of the core")
# Without -fPIC, constants with addresses in them stay read-only data, so that symbols tell what could change.
FLAGS = ("-O0", "-std=c11", "-ffp-contract=off", "-fno-pic", "-I", CSRC)


def unit_of(path):
    """A source file and its header are one: their path in csrc/ without its ending."""
    return path.relative_to(CSRC).with_suffix("").as_posix()


@pytest.fixture(scope="session")
def core_objects(tmp_path_factory):
    """The object of each source, by unit."""
    if not shutil.which(CC) or not SOURCES:
        pytest.skip("no C compiler, or no sources of the core")
    folder, order = shared_folder(tmp_path_factory) / "core", SOURCES
    folder.mkdir(exist_ok=True)
    if os.environ.get("PYTEST_XDIST_WORKER", "gw0") != "gw0":
        order = SOURCES[::-1]       # two processes of pytest-xdist meet in the middle
    objects = {unit_of(path): folder / (unit_of(path).replace("/", "-") + ".o") for path in SOURCES}

    def compile_one(path):
        if not (target := objects[unit_of(path)]).exists():
            unfinished = target.with_suffix(f".{os.getpid()}")
            subprocess.run([CC, "-c", *FLAGS, "-o", unfinished, path], check=True)
            unfinished.replace(target)

    with ThreadPoolExecutor(2) as pool:
        list(pool.map(compile_one, order))
    return objects


def shared_folder(tmp_path_factory):
    """Temporary folder that all processes of the session share."""
    base = tmp_path_factory.getbasetemp()
    return base.parent if "PYTEST_XDIST_WORKER" in os.environ else base


def linked(program, source, objects, *options):
    """A program of a test's own source and objects of the core."""
    subprocess.run([CC, *FLAGS, "-no-pie", "-o", program, source, *objects, *options, "-lm"], check=True)
    return program
