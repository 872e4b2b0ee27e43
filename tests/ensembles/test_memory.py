"""Ensembles whose outputs are larger than memory: refused with their size, or kept in the files of a store."""

import numpy as np
import pytest

import zerodrift as zd
from support import refused
from zerodrift.ensembles import memory
from zerodrift.runs.samples import memory as free_space

BAR = zd.systems.four_bar()
RUNS, ROWS = 20, 101
STUDY = {"parameters": {"gravity": np.linspace(9.0, 10.0, RUNS)}, "step": 0.01, "outputs": ["alpha1", "alpha2"], "chunk": 3}
CHOSEN = {**STUDY, "step": None, "rtol": 1e-8, "integrator": "dop853", "threads": 1}
SIZE = RUNS * ROWS * 2 * 8      # 32,320 bytes


@pytest.fixture
def scarce(monkeypatch):
    """Memory of so many bytes."""
    def only(free):
        monkeypatch.setattr(free_space, "free_memory", lambda: free)
    monkeypatch.setattr(memory, "UNCHECKED_BYTES", 1000)
    return only


def test_sizes_are_those_of_the_arrays():
    """Sizes of coordinates, vectors, components and solutions; unknown with adaptive steps."""
    m = zd.models.four_bar()
    ens = zd.ensemble(m, 1.0, parameters={"crank.mass": [1.0, 2.0]}, step=0.01, outputs=["C.force", "C.force.x", "crank.angle"])
    assert ens._plan.sizes == tuple(ens[name].nbytes for name in ("C.force", "C.force.x", "crank.angle"))
    (kept,) = zd.ensemble(BAR, 1.0, v0=np.zeros((2, 3)), step=0.01, keep="solutions", outputs=[])._plan.sizes
    assert kept == 2 * zd.record_size(BAR, 1.0, step=0.01).total
    assert zd.ensemble(BAR, 1.0, **CHOSEN)._plan.sizes is None
    assert zd.ensemble(BAR, 1.0, **STUDY | {"outputs": None}, reduce=lambda sol: 1.0)._plan.sizes == ()


def test_more_than_memory_is_refused_before_anything_runs(scarce, monkeypatch):
    scarce(1.5 * SIZE - 1)      # the outputs, and one of two besides as they are joined
    begun = []
    with refused("no-memory", r"the outputs of 20 runs take 32\.3 kB, 48\.5 kB while they are joined, and 48\.5 kB "
                                          r"of memory are free: keep fewer outputs .* \(store\) \[zd:no-memory\]$"):
        zd.ensemble(BAR, 1.0, **STUDY, progress=begun.append)
    assert not begun
    scarce(1.5 * SIZE)
    with pytest.warns(zd.CostWarning, match="the outputs of 20 runs take") as told:
        zd.ensemble(BAR, 1.0, **STUDY)
    assert told[0].filename == __file__
    scarce(10)
    assert zd.ensemble(BAR, 1.0, **STUDY | {"t_eval": [1.0]})["alpha1"].shape == (RUNS, 1)     # small
    monkeypatch.setattr(free_space, "free_memory", lambda: None)
    assert len(zd.ensemble(BAR, 1.0, **STUDY)) == RUNS


def test_adaptive_steps_stop_where_memory_gets_short(scarce):
    """With the runs that are done, as long as these can be joined."""
    whole = zd.ensemble(BAR, 1.0, **CHOSEN)
    size = sum(each.nbytes for each in whole._part.arrays.values()) + whole._part.t.nbytes
    assert size == memory.size_of(whole._part)
    scarce(size / 2)
    with refused("no-memory", r"the outputs of \d+ runs, which are done, take .* are free: keep fewer") as caught:
        zd.ensemble(BAR, 1.0, **CHOSEN)
    ens = caught.value.solution
    done = np.flatnonzero(~ens.failed)
    assert RUNS / 2 <= len(done) < RUNS
    for run in done:
        assert np.array_equal(ens["alpha1"][run], whole["alpha1"][run])


@pytest.mark.parametrize("study", [STUDY, CHOSEN], ids=["fixed steps", "adaptive steps"])
def test_a_store_may_be_larger_than_memory(scarce, tmp_path, study):
    """Its outputs stay in its files, some or all of them, and each is read when it is needed."""
    here = zd.ensemble(BAR, 1.0, **study)
    for i, free in enumerate((0, memory.size_of(here._part), 0)):     # none or half of it, and the finished study again
        scarce(free)
        there = zd.ensemble(BAR, 1.0, **study, store=tmp_path / str(i % 2))
        for ens in (there, zd.load(tmp_path / str(i % 2))):
            assert isinstance(ens._part.arrays, memory.Joined)
            assert repr(ens).splitlines()[0] == repr(here).splitlines()[0]
            scarce(10**9)
            for name in study["outputs"]:
                for one, other in zip(ens[name], here[name], strict=True):
                    assert np.array_equal(one, other)
            assert np.array_equal(ens[3]["alpha1"], here[3]["alpha1"])
            scarce(free)
    scarce(0)
    with refused("no-memory", r"'alpha1'.*and 0.*ens\[i\]"):
        there["alpha1"]


def test_parts_that_overlap_and_are_in_files(scarce, tmp_path):
    for i, chunk in enumerate((5, 3, 4)):
        zd.ensemble(BAR, 1.0, **STUDY | {"chunk": chunk}, store=tmp_path / str(i))
        for path in (tmp_path / str(i)).glob("runs*"):
            path.rename(tmp_path / "0" / path.name)
    here = zd.ensemble(BAR, 1.0, **STUDY)
    scarce(0)
    ens = zd.load(tmp_path / "0")
    scarce(10**9)
    assert isinstance(ens._part.arrays, memory.Joined)
    assert np.array_equal(ens["alpha2"], here["alpha2"])


def test_a_disk_without_room_is_refused_before_anything_runs(scarce, tmp_path, monkeypatch):
    scarce(0)
    monkeypatch.setattr(free_space.shutil, "disk_usage", lambda folder: type("Usage", (), {"free": SIZE - 1}))
    with refused("no-space", r"of 20.*take 32\.3.*and 32\.3"):
        zd.ensemble(BAR, 1.0, **STUDY, store=tmp_path / "new" / "study")
    assert not list(tmp_path.iterdir())
