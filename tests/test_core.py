"""The core by itself: it allocates in one file, ordinary steps allocate nothing, and it keeps no global state."""

import os
import re
import shutil
import subprocess
import sys

import pytest

import zerodrift as zd
from support import FORMULATIONS, ROOT

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


@pytest.fixture(scope="module")
def core(tmp_path_factory):
    """All of it as one object."""
    return compiled(tmp_path_factory.mktemp("core"), "-r", "-nostdlib", "-o", "core.o", *SOURCES) / "core.o"


@needs_compiler
@linux
def test_ordinary_steps_allocate_nothing(tmp_path, core):
    """One allocation makes a run and another, freed at once, its start; none moves it: counted in each built-in system,
    formulation and integrator, corrections on and off, on motions whose rows stay far from dependent ones. Near these see below.
    """
    wrap = [f"-Wl,--wrap={name}" for name in ALLOCATING]
    compiled(tmp_path, "-o", "allocations", ROOT / "tests" / "allocations.c", core, *wrap, "-lm")
    output = subprocess.run([tmp_path / "allocations"], check=True, capture_output=True, text=True).stdout
    lines = [line for line in output.splitlines() if line.startswith("allocations")]
    taken = sum(len(zd.integrators(getattr(zd.systems, name)())) for name in zd.systems.__all__)
    assert len(lines) == 2 * taken * len(FORMULATIONS)
    for line in lines:
        assert re.match(r"allocations 2 0 .*, status 0, 51 rows$", line)


@needs_compiler
@linux
def test_memory_that_ends_where_rows_come_to_depend_ends_the_run(tmp_path, core):
    """Steps near a bifurcation take memory when they first need it. Wherever it is refused, the run ends there and says so, and
    all that it had is freed. Where nothing is refused, the same run comes to its end.
    """
    wrap = [f"-Wl,--wrap={name}" for name in ("aligned_alloc", "free")]
    compiled(tmp_path, "-o", "rare_memory", ROOT / "tests" / "native" / "rare_memory.c", core, *wrap, "-lm")
    output = subprocess.run([tmp_path / "rare_memory"], check=True, capture_output=True, text=True).stdout
    lines = [line.split(" ", 4) for line in output.splitlines()]
    for name in FORMULATIONS:
        *refused, (_, granted, *last) = [line for line in lines if line[0] == name]
        assert int(granted) == len(refused) >= 3        # the rows that count, limits, and what the crossing is told by
        assert last == ["0", "0", ""]
        for _, _, status, blocks, message in refused:
            assert (status, blocks) == ("-9", "0")
            assert re.fullmatch(r"at t = \S+ \(step \d+ of 200\): there is no memory for this", message)


@needs_compiler
@linux
def test_only_the_workspace_allocates_and_nothing_is_global(tmp_path):
    """By the symbols of the object files. Data that could change would be of kind B, C or D: without -fPIC, constants are R."""
    workspace = ROOT / "csrc" / "workspace.c"
    others = [path for path in SOURCES if path != workspace]
    # One object each, as files of two folders may have one name.
    for name, sources in (("workspace.o", [workspace]), ("others.o", others)):
        compiled(tmp_path, "-fno-pic", "-r", "-nostdlib", "-o", name, *sources)
        symbols = subprocess.run(["nm", tmp_path / name], check=True, capture_output=True, text=True).stdout
        assert not re.findall(r".* [BbCDd] .*", symbols)
        assert workspace in sources or not re.findall(rf" U (?:{'|'.join(ALLOCATING)}|free)$", symbols, re.MULTILINE)


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
