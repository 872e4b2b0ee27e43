"""Memory: where it ends that is said, nothing leaks, and long runs take no more than short ones."""

import gc
import os
import subprocess
import sys
import textwrap
from collections import Counter

import numpy as np
import pytest

import zerodrift as zd
from support import refused
from watched import At, pendulum, throw
from zerodrift._private.gateway import runs

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


def wide(n=40):
    """A system of many coordinates."""
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


class Counting:
    """The core's functions; those that make and free runs are counted."""

    def __init__(self, lib):
        self._lib, self.alive = lib, 0

    def __getattr__(self, name):
        return getattr(self._lib, name)

    def zd_run_create(self, *arguments):
        run = self._lib.zd_run_create(*arguments)
        self.alive += bool(run)
        return run

    def zd_run_free(self, run):
        self.alive -= 1
        self._lib.zd_run_free(run)


def objects_of_the_package():
    gc.collect()
    kinds = [type(each) for each in gc.get_objects()]
    return Counter(kind.__qualname__ for kind in kinds if str(kind.__module__).startswith("zerodrift"))


@pytest.mark.filterwarnings("ignore::zerodrift.StabilityWarning")
@pytest.mark.parametrize("what", [diverging, raising, inconsistent, stopped, succeeding])
def test_nothing_leaks(what, monkeypatch):
    """Each run of the core is freed, and no object stays; that nothing of a run is left, .ci/sanitize and test_core.py show."""
    monkeypatch.setattr(runs, "lib", counting := Counting(runs.lib))
    what()      # fills caches
    before = objects_of_the_package()
    for _ in range(10):
        what()
    assert objects_of_the_package() == before
    assert counting.alive == 0


def test_records_beyond_memory(bar):
    with refused("no-memory", r"^\d+ samples take [\d.e+]+ TB, and [\d.]+ [GM]B of memory are free: save fewer"):
        zd.simulate(bar, 1e4, step=1e-10)


def test_a_long_run_takes_no_more_memory(bar, monkeypatch):
    """Its samples have their place from the start; that steps allocate nothing, test_core.py counts."""
    monkeypatch.setattr(runs.Record, "grow", None)
    sol = zd.simulate(bar, 30.0, step=1e-3, save_every=1000)
    assert len(sol.t) == 31
