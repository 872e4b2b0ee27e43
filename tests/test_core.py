"""The core by itself: it allocates in one file, ordinary steps allocate nothing, and it keeps no global state."""

import itertools
import os
import re
import subprocess
import sys

import pytest

import zerodrift as zd
from core_objects import CC, CSRC, linked, needs_compiler
from support import FORMULATIONS, ROOT

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs the tools of GNU")
ALLOCATING = ("malloc", "calloc", "realloc", "aligned_alloc")
INPUTS = 50_000     # of the fuzzer; .ci/sanitize hands in as many, under sanitizers


@needs_compiler
@linux
def test_ordinary_steps_allocate_nothing(tmp_path, core_objects):
    """One allocation makes a run and another, freed at once, its start; none moves it: counted in each built-in system,
    formulation and integrator, corrections on and off, on motions whose constraints stay far from dependent ones.
    """
    wrap = [f"-Wl,--wrap={name}" for name in ALLOCATING]
    program = linked(tmp_path / "allocations", ROOT / "tests" / "support" / "allocations.c", core_objects.values(), *wrap)
    output = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    lines = [line for line in output.splitlines() if line.startswith("allocations")]
    taken = sum(len(zd.integrators(getattr(zd.systems, name)())) for name in zd.systems.__all__)
    assert len(lines) + output.count("methods that disagree") == 2 * taken * len(FORMULATIONS)
    for line in lines:
        assert re.match(r"allocations 2 0 .*, status 0, 51 rows$", line)


@needs_compiler
@linux
def test_runs_that_pass_bifurcations_allocate_nothing(tmp_path, core_objects):
    """They come to their end where nothing is granted after their creation, and all that they had is freed."""
    wrap = [f"-Wl,--wrap={name}" for name in ("aligned_alloc", "free")]
    program = linked(tmp_path / "rare_memory", ROOT / "tests" / "native" / "rare_memory.c", core_objects.values(), *wrap)
    lines = subprocess.run([program], check=True, capture_output=True, text=True).stdout.splitlines()
    cases = itertools.product(FORMULATIONS, ("rk4", "euler", "dormand_prince"))
    assert lines == [f"{formulation} {integrator} 0 0 0 " for formulation, integrator in cases]


@needs_compiler
@linux
def test_only_the_workspace_allocates_and_nothing_is_global(core_objects):
    """By the symbols of the object files. Data that could change would be of kind B, C or D."""
    symbols = subprocess.run(["nm", "-A", *core_objects.values()], check=True, capture_output=True, text=True).stdout
    assert not re.findall(r".* [BbCDd] .*", symbols)
    allocating = re.findall(rf"^(.*): +U (?:{'|'.join(ALLOCATING)}|free)$", symbols, re.MULTILINE)
    assert set(allocating) == {str(core_objects["workspace"])}


@needs_compiler
@linux
def test_whatever_is_handed_in_does_no_harm(tmp_path, core_objects):
    """Systems, settings and states from bytes, through all entry points; see tests/fuzz/. That each ends at all, and without a
    signal, is what this can see; what reads or writes where it must not, .ci/sanitize does.
    """
    program = linked(tmp_path / "fuzz_core", ROOT / "tests" / "fuzz" / "fuzz_core.c", core_objects.values(), "-DREPLAY")
    clean = {key: value for key, value in os.environ.items() if key != "LD_PRELOAD"}
    result = subprocess.run([program, "-random", str(INPUTS), "1"], capture_output=True, text=True, check=False, env=clean)
    assert result.returncode == 0, result.stderr
    assert result.stdout == f"{INPUTS} inputs\n"


@needs_compiler
def test_the_public_header_stands_alone(tmp_path):
    (tmp_path / "alone.c").write_text('#include "zerodrift.h"\nint main(void) { return zd_entry_count(ZD_SYSTEMS) == 0; }\n')
    strict = [CC, "-std=c11", "-I", CSRC, "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only", "alone.c"]
    subprocess.run(strict, cwd=tmp_path, check=True)
