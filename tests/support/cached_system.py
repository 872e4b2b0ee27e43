"""For tests of what `symbolic` keeps: a system, made here and in another process."""

import os
import subprocess
import sys

import pytest
import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

import zerodrift as zd
from zerodrift.symbolics import define

Q = dynamicsymbols("q")
A = sp.Symbol("a")
GIVEN = {"kinetic": Q.diff() ** 2 / 2, "potential": A * sp.cos(Q), "parameters": {A: 2.0}}
SCRIPT = """
import sys, sympy as sp
from sympy.physics.mechanics import dynamicsymbols
import zerodrift as zd
Q, A = dynamicsymbols("q"), sp.Symbol("a")
system = zd.symbolic([Q], kinetic=Q.diff() ** 2 / 2, potential=A * sp.cos(Q), parameters={A: 2.0})
print(*system.evaluate([0.5]).f)
"""


def made():
    """The system, by a process that remembers nothing."""
    define._derived.clear()
    system = zd.symbolic([Q], **GIVEN)
    assert system.evaluate([0.5]).f == pytest.approx(2.0 * 0.479425538604203)
    return system


def elsewhere(environment=None, before=""):
    """The same in a process of its own, which does something else before."""
    return subprocess.Popen([sys.executable, "-W", "error", "-c", before + SCRIPT], env=os.environ | (environment or {}),
                            text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def said(process):
    out, err = process.communicate()
    assert process.returncode == 0, err
    return float(out)
