"""Python in WebAssembly lacks threads, processes, signals and programs: what needs them is off, and refused on request.

A process of this machine takes them away; the wheel for Pyodide itself is not run here.
"""

import subprocess
import sys

import tolerances as tol
from support import environment_of_tests

LACKS = """
import concurrent.futures, os, subprocess, sys, threading, _signal
import numpy as np

def absent(*_, **__):
    raise OSError("not in WebAssembly")

sys.platform = "emscripten"
os.environ["CC"] = sys.executable
threading.Thread.start = subprocess.Popen.__init__ = _signal.signal = absent
sys.modules["_multiprocessing"] = None
import zerodrift as zd
m = zd.models.slider_crank()
ONE = {"parameters": {"spring.length": np.array([0.9, 1.0, 1.1])}, "outputs": ["slider.position"], "step": 0.01}
"""
WORKS = """
sol = zd.simulate(m, 0.5, step=0.01)
assert sol.t[-1] == 0.5
assert not zd.ensemble(m, 0.1, **ONE).failed.any()
runs = zd.ManyRuns(m, step=0.01, runs=64)
runs.step(3)
print("works")
"""
REFUSED = """
import warnings
warnings.simplefilter("error")
for request in (lambda: zd.ensemble(m, 0.1, executor="processes", **ONE), lambda: zd.ensemble(m, 0.1, threads=2, **ONE),
                lambda: zd.Run(m, step=0.01).save(), lambda: zd.simulate(m.system(compiled=True), 0.1, step=0.01)):
    try:
        request()
        print("accepted")
    except Exception as error:
        print(error)
"""


def run(script):
    result = subprocess.run([sys.executable, "-c", LACKS + script], capture_output=True, text=True, check=False, timeout=tol.HUNG,
                            env=environment_of_tests())
    assert result.returncode == 0, result.stderr
    return result.stdout.splitlines()


def test_what_is_left_works():
    assert run(WORKS) == ["works"]


def test_what_is_missing_is_refused_with_a_sentence():
    executor, threads, state, compiler = run(REFUSED)
    assert executor.startswith("executor must be None in WebAssembly: there are no other processes")
    assert threads.startswith("threads must be 1 in WebAssembly: runs are made one after the other")
    assert state.startswith("the state of a run must be saved on another machine in WebAssembly: addresses have four bytes")
    assert "looked for none, as Python in WebAssembly starts no programs" in compiler
