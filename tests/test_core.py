"""The core by itself: it allocates once for each run, in one file, keeps no global state; and a stale one is noticed."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import zerodrift as zd
from support import FORMULATIONS
from zerodrift import _core

ROOT = Path(__file__).resolve().parent.parent
SOURCES = sorted((ROOT / "csrc").rglob("*.c"))
CC = os.environ.get("CC", "cc")
needs_compiler = pytest.mark.skipif(not shutil.which(CC), reason="no C compiler")
linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs the tools of GNU")
ALLOCATING = ("malloc", "calloc", "realloc", "aligned_alloc")
pytestmark = pytest.mark.skipif(not SOURCES, reason="no sources of the core")


def compiled(tmp_path, *arguments):
    """What the compiler leaves in a folder of its own."""
    subprocess.run([CC, "-O1", "-std=c11", "-ffp-contract=off", "-I", ROOT / "csrc", *arguments], cwd=tmp_path, check=True)
    return tmp_path


@needs_compiler
@linux
def test_steps_allocate_nothing(tmp_path):
    """One allocation makes a run and another, freed at once, its start; none moves it: counted in each system, formulation and
    integrator, corrections on and off.
    """
    wrap = [f"-Wl,--wrap={name}" for name in ALLOCATING]
    compiled(tmp_path, "-o", "allocations", ROOT / "tests" / "allocations.c", *SOURCES, *wrap, "-lm")
    output = subprocess.run([tmp_path / "allocations"], check=True, capture_output=True, text=True).stdout
    lines = [line for line in output.splitlines() if line.startswith("allocations")]
    taken = sum(len(zd.integrators(getattr(zd.systems, name)())) for name in zd.systems.__all__)
    assert len(lines) == 2 * taken * len(FORMULATIONS)
    for line in lines:
        assert re.match(r"allocations 2 0 .*, status 0, 51 rows$", line)


@needs_compiler
@linux
def test_only_the_workspace_allocates_and_nothing_is_global(tmp_path):
    """By the symbols of the object files. Data that could change would be of kind B, C or D: without -fPIC, constants are R."""
    compiled(tmp_path, "-fno-pic", "-c", *SOURCES)
    for path in tmp_path.glob("*.o"):
        symbols = subprocess.run(["nm", path], check=True, capture_output=True, text=True).stdout
        assert not re.search(r" [BbCDd] ", symbols), path.name
        if path.stem != "workspace":
            assert not re.search(rf" U ({'|'.join(ALLOCATING)}|free)$", symbols, re.MULTILINE), path.name


@needs_compiler
def test_whatever_is_handed_in_does_no_harm(tmp_path):
    """Systems, settings and states from bytes, through all entry points, under sanitizers; see tests/fuzz/."""
    plain = ["-DREPLAY", "-o", "fuzz_core", ROOT / "tests" / "fuzz" / "fuzz_core.c", *SOURCES, "-lm"]
    try:
        compiled(tmp_path, "-fsanitize=address,undefined", "-fno-sanitize-recover=all", *plain)
    except subprocess.CalledProcessError:       # a compiler without them
        compiled(tmp_path, *plain)
    clean = {key: value for key, value in os.environ.items() if key != "LD_PRELOAD"}
    command = [tmp_path / "fuzz_core", "-random", "10000", "1"]
    result = subprocess.run(command, capture_output=True, text=True, check=False, env=clean)
    assert result.returncode == 0, result.stderr
    assert result.stdout == "10000 inputs\n"


@needs_compiler
def test_the_public_header_stands_alone(tmp_path):
    (tmp_path / "alone.c").write_text('#include "zerodrift.h"\nint main(void) { return zd_rows(ZD_SYSTEMS) == 0; }\n')
    compiled(tmp_path, "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only", "alone.c")


@pytest.fixture
def tree(tmp_path):
    """A copy of the source tree with its compiled core."""
    for name in ("csrc", "python"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info", "*.so", "*.pyd"))
    shutil.copy(_core.__file__, tmp_path / "python" / "zerodrift")
    return tmp_path


def imported(tree):
    """The outcome of importing the package of a tree."""
    code = "import zerodrift; print(zerodrift.__file__)"
    return subprocess.run([sys.executable, "-c", code], env=os.environ | {"PYTHONPATH": str(tree / "python")}, cwd=tree,
                          capture_output=True, text=True, check=False)


def test_a_fresh_core_is_taken(tree):
    result = imported(tree)
    assert str(tree) in result.stdout, result.stderr


@pytest.mark.parametrize("change", [
    lambda csrc: (csrc / "linalg" / "newton.c").write_text((csrc / "linalg" / "newton.c").read_text() + "\n"),
    lambda csrc: (csrc / "zerodrift.h").write_text((csrc / "zerodrift.h").read_text() + "\n"),
    lambda csrc: (csrc / "integrators" / "new.c").touch(),
    lambda csrc: (csrc / "linalg" / "newton.c").unlink(),
    lambda csrc: (csrc / "linalg" / "newton.c").rename(csrc / "linalg" / "newtons.c"),
    lambda csrc: (csrc.parent / "python" / "build_core.py").write_text(
        (csrc.parent / "python" / "build_core.py").read_text().replace("-O3", "-O2")),
], ids=["source", "header", "new file", "no file", "renamed", "flags"])
def test_a_stale_core_is_noticed(tree, change):
    change(tree / "csrc")
    result = imported(tree)
    assert result.returncode
    assert f"StaleCore: the compiled core is older than {tree / 'csrc'}; rebuild it with: pip install -e {tree}" in result.stderr


def test_matplotlib_waits_until_something_is_drawn():
    code = "import sys, zerodrift as zd; zd.simulate(zd.systems.four_bar(), 1, step=0.05); print('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "False\n"


def test_the_examples_of_the_docstrings():
    import doctest
    import importlib
    import pkgutil

    rooms = [importlib.import_module(f"zerodrift.{room}") for room in ("runs", "studies", "systems")]
    names = [name for room in rooms for _, name, _ in pkgutil.iter_modules(room.__path__, f"{room.__name__}.")]
    tried = [doctest.testmod(importlib.import_module(name)) for name in names]
    assert sum(result.attempted for result in tried) >= 20
    assert not sum(result.failed for result in tried)
