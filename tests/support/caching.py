"""For tests of what `symbolic` keeps: an empty cache, and a compiler that counts."""

import os
import stat
from pathlib import Path

import pytest


@pytest.fixture
def cache_folder(tmp_path, monkeypatch):
    """An empty cache, and nothing that this process remembers."""
    from zerodrift.symbolics import define
    from zerodrift.symbolics.compile import cache

    folder = tmp_path / "cache"
    monkeypatch.setenv("ZERODRIFT_CACHE", str(folder))
    monkeypatch.setattr(define, "_derived", {})
    monkeypatch.setattr(cache, "_said", set())
    monkeypatch.setattr(cache, "_memory", {})
    return folder


@pytest.fixture
def compiler(tmp_path, monkeypatch):
    """A compiler that counts its calls."""
    if os.name == "nt":
        pytest.skip("what stands for a compiler is a script of POSIX' shell")
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
