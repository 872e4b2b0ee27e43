"""The progress of a run: a bar of tqdm, or a callable of the user."""

import sys
import types

import pytest

import zerodrift as zd
from support import motion, refused


def test_a_progress_bar_needs_tqdm(bar, monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with refused("missing-package", r"^progress=True shows a bar with tqdm, which is not installed: pip install tqdm "):
        zd.simulate(bar, 1, step=0.1, progress=True)


def test_an_exception_of_the_progress_callable_surfaces(bar):
    def show(part):
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        motion(bar, 1.0, 20, progress=show)


def test_the_bar_of_tqdm_is_closed(bar, monkeypatch):
    """Also where the run fails."""
    calls = []

    class Bar:
        def __init__(self, **options):
            self.n = 0

        def refresh(self):
            calls.append(self.n)

        def close(self):
            calls.append("closed")

    module = types.ModuleType("tqdm.auto")
    module.tqdm = Bar
    monkeypatch.setitem(sys.modules, "tqdm", types.ModuleType("tqdm"))
    monkeypatch.setitem(sys.modules, "tqdm.auto", module)
    with pytest.raises(zd.Diverged):
        zd.simulate(bar, 8.0, step=0.05, stabilization=None, progress=True)
    assert calls[-1] == "closed"
    assert 0.9 < calls[-2] < 1
