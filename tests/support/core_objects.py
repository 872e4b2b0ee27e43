"""The core's sources, compiled once for all tests that link them with programs of their own or look at their symbols."""

import ctypes
import hashlib
import os
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from support import ROOT

CSRC = ROOT / "csrc"
SOURCES = sorted(CSRC.rglob("*.c"))
CC = os.environ.get("CC", "cc")
needs_compiler = pytest.mark.skipif(not shutil.which(CC) or not SOURCES, reason="no C compiler, or no sources of the core")
# Without -fPIC, constants with addresses in them stay read-only data, so that symbols tell what could change.
PLAIN, AT_FIXED_PLACES = (("-fno-pic",), ("-no-pie",)) if sys.platform == "linux" else ((), ())    # to compile, and to link
FLAGS = ("-O0", "-std=c11", "-ffp-contract=off", *PLAIN, "-I", CSRC)
STRICT = ("-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wstrict-prototypes", "-Werror")


def unit_of(path):
    """A source file and its header are one: their path in csrc/ without its ending."""
    return path.relative_to(CSRC).with_suffix("").as_posix()


@pytest.fixture(scope="session")
def core_objects(tmp_path_factory):
    """The object of each source, by unit."""
    if not shutil.which(CC) or not SOURCES:
        pytest.skip("no C compiler, or no sources of the core")
    return {unit_of(path): compiled for path, compiled in objects_of(SOURCES, CSRC, shared_folder(tmp_path_factory)).items()}


def objects_of(sources, include, shared):
    """The object of each source, compiled without a warning and once for all processes that share a folder.

    Its name is a hash of the source and the headers that it includes, so that exported copies of the core are not compiled again.
    """
    folder = shared / "objects"
    folder.mkdir(exist_ok=True)
    flags = [*FLAGS[:-1], include]
    if os.environ.get("PYTEST_XDIST_WORKER", "gw0") != "gw0":
        sources = sources[::-1]     # two processes of pytest-xdist meet in the middle

    def compile_one(source):
        texts = sorted(with_headers(source, Path(include), {}).values())
        target = folder / f"{hashlib.sha256(chr(0).join(texts).encode()).hexdigest()[:32]}.o"
        if not target.exists():
            unfinished = folder / f"{target.stem}.{os.getpid()}"
            subprocess.run([CC, "-c", *flags, *STRICT, "-o", unfinished, source], check=True)
            unfinished.replace(target)
        return target

    with ThreadPoolExecutor(2) as pool:
        return dict(zip(sources, pool.map(compile_one, sources), strict=True))


def with_headers(path, include, found):
    """Text of a file and of all headers of the core that it includes, by their path."""
    path = path.resolve()
    if path not in found:
        found[path] = path.read_text(encoding="utf-8")
        for name in re.findall(r'^#include "(.+)"', found[path], re.MULTILINE):
            beside = path.parent / name
            with_headers(beside if beside.is_file() else include / name, include, found)
    return found


def library_of(folder, program, *units):
    """A program of native/ and units of the core as a shared library, loaded."""
    target = folder / f"{program}.so"
    sources = [ROOT / "tests" / "native" / f"{program}.c", *(CSRC / f"{unit}.c" for unit in units)]
    subprocess.run([CC, "-O2", "-std=c11", "-shared", "-fPIC", "-I", CSRC, "-o", target, *sources, "-lm"], check=True)
    return ctypes.CDLL(target)


def shared_folder(tmp_path_factory):
    """Temporary folder that all processes of the session share."""
    base = tmp_path_factory.getbasetemp()
    return base.parent if "PYTEST_XDIST_WORKER" in os.environ else base


def linked(program, source, objects, *options):
    """A program of a test's own source and objects of the core."""
    subprocess.run([CC, *FLAGS, *AT_FIXED_PLACES, "-o", program, source, *objects, *options, "-lm"], check=True)
    return program
