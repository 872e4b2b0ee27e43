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
FLAGS = ("-O1", "-std=c11", "-ffp-contract=off", "-fno-pic", "-I", CSRC)


def unit_of(path):
    """A source file and its header are one: their path in csrc/ without its ending."""
    return path.relative_to(CSRC).with_suffix("").as_posix()


@pytest.fixture(scope="session")
def core_objects(tmp_path_factory):
    """The object of each source, by unit."""
    if not shutil.which(CC) or not SOURCES:
        pytest.skip("no C compiler, or no sources of the core")
    folder = tmp_path_factory.mktemp("core")
    objects = {unit_of(path): folder / (unit_of(path).replace("/", "-") + ".o") for path in SOURCES}

    def compile_one(path):
        subprocess.run([CC, "-c", *FLAGS, "-o", objects[unit_of(path)], path], check=True)

    with ThreadPoolExecutor(2) as pool:
        list(pool.map(compile_one, SOURCES))
    return objects


def linked(program, source, objects, *options):
    """A program of a test's own source and objects of the core."""
    subprocess.run([CC, *FLAGS, "-no-pie", "-o", program, source, *objects, *options, "-lm"], check=True)
    return program
