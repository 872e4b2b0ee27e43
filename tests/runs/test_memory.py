"""Memory: where it ends that is said, nothing leaks, and long runs take no more than short ones."""

import gc
import os
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest

import zerodrift as zd
from support import refused
from watched import At, pendulum, throw

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks into /proc")


def limited(before, code, mebibytes):
    """Output of a process with a limit of memory, in MiB, beyond that used by imports and by the code `before`."""
    limit = f"""
    pages = int(open("/proc/self/statm").read().split()[0])
    resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + {mebibytes} * 2**20,) * 2)
    """
    imports = "import resource, numpy as np, zerodrift as zd\n"
    code = imports + textwrap.dedent(before) + textwrap.dedent(limit) + textwrap.dedent(code)
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                          env=os.environ | {"OPENBLAS_NUM_THREADS": "1"}).stdout


@linux
def test_no_memory_for_a_run_is_an_error_with_its_size():
    output = limited("""
    def system(n):
        return zd.System(n, mass=np.eye(n), p0=np.zeros(n))

    small, large = system(20), system(600)      # M of the latter takes 3 MiB
    zd.simulate(small, 1.0, step=0.1)           # imports what is imported at first use
    """, """
    for call in (lambda: zd.simulate(large, 1.0, step=0.1), lambda: zd.acceleration(large, large.p0, large.p0),
                 lambda: zd.project(large, large.p0, large.p0)):
        try:
            call()
        except MemoryError as error:
            print(error)
    print(zd.simulate(small, 1.0, step=0.1).message)
    """, 6)
    lines = output.splitlines()
    assert len(lines) == 4
    assert all(line.startswith("there is no memory for this: ") and line.endswith(" MiB [zd:no-memory]") for line in lines[:3])
    assert lines[3] == "done"


@linux
def test_a_record_that_outgrows_memory_keeps_what_was_computed():
    output = limited("""
    pendulum = zd.systems.pendulum()
    zd.simulate(pendulum, 1.0, rtol=1e-9, integrator="dormand_prince")
    """, """
    try:
        zd.simulate(pendulum, 1e9, rtol=1e-9, max_step=1e-3, integrator="dormand_prince")
    except MemoryError as error:
        sol = error.solution
        print(error)
        print(len(sol.t) > 1000, bool(np.isfinite(sol.p).all()), sol.success, sol.message.startswith("stopped by NoMemory"))
    """, 48)
    lines = output.splitlines()
    assert "samples need" in lines[0]
    assert lines[1] == "True True False True"


def resident():
    """Bytes of memory in use."""
    gc.collect()
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def wide(n=40):
    """A system whose runs take some 100 KiB."""
    return zd.System(n, mass=np.eye(n), force=lambda v: np.full(n, 1 / (1 - v[0])), p0=np.zeros(n), potential=0.0)


def diverging():
    with pytest.raises(zd.ZerodriftError):
        zd.simulate(zd.systems.four_bar(), 8.0, step=0.5, stabilization=None)


def raising():
    with pytest.raises(ZeroDivisionError):
        zd.simulate(pendulum(At(60, throw(ZeroDivisionError()))), 1.0, step=0.05)


def inconsistent():
    with pytest.raises(zd.InconsistentStart):
        zd.simulate(zd.systems.four_bar(), 8.0, [1, 1, 1], step=0.1)


def stopped():
    with pytest.raises(ZeroDivisionError):
        zd.simulate(wide(), 0.1, step=0.05, progress=At(1, throw(ZeroDivisionError())))


def succeeding():
    zd.simulate(wide(), 0.1, step=0.05)


@linux
@pytest.mark.filterwarnings("ignore::zerodrift.StabilityWarning")
@pytest.mark.parametrize("what", [diverging, raising, inconsistent, stopped, succeeding])
def test_nothing_leaks(what):
    growths = []
    for _ in range(5):
        before = resident()
        for _ in range(100):
            what()
        growths.append(resident() - before)
    # A leak makes each hundred grow: by some 350 KiB with the smallest system and what Python keeps of a run. What Python
    # and the allocator keep for later, after the many tests before this one, makes one of them grow.
    assert min(growths) < 100 * 1024, growths


def test_records_beyond_memory(bar):
    with refused("no-memory", r"^\d+ samples take [\d.e+]+ TB, and [\d.]+ [GM]B of memory are free: save fewer"):
        zd.simulate(bar, 1e4, step=1e-10)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks into /proc")
def test_a_long_run_takes_no_more_memory(bar):
    sizes = []

    def look(part):
        sizes.append(int(Path("/proc/self/statm").read_text().split()[1]))

    zd.simulate(bar, 1500.0, step=1e-3, save_every=10**5, progress=look)
    assert len(sizes) > 3
    assert sizes[-1] - sizes[1] < 1000      # pages: all samples would take more than ten thousand
