"""For tests of what `symbolic` keeps: an empty cache, a compiler that counts, a system of both, here and in another process."""

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest
import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

import zerodrift as zd
from zerodrift.symbolics import cache, define

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


@pytest.fixture
def cache_folder(tmp_path, monkeypatch):
    """An empty cache, and nothing that this process remembers."""
    folder = tmp_path / "cache"
    monkeypatch.setenv("ZERODRIFT_CACHE", str(folder))
    monkeypatch.setattr(define, "_derived", {})
    monkeypatch.setattr(cache, "_said", set())
    monkeypatch.setattr(cache, "_memory", {})
    return folder


@pytest.fixture
def compiler(tmp_path, monkeypatch):
    """A compiler that counts its calls."""
    log, script = tmp_path / "calls", tmp_path / "compiler"
    script.write_text(f"#!/bin/sh\necho called >> '{log}'\nexec cc \"$@\"\n")
    script.chmod(script.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("CC", str(script))
    return Compiler(script, log)


class Compiler:
    def __init__(self, script: Path, log: Path) -> None:
        self.script, self.log = script, log

    @property
    def calls(self):
        return len(self.log.read_text().splitlines()) if self.log.exists() else 0


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
