"""Samples that a run writes to a file: the bits of those in memory, and files that any NumPy opens whatever happens."""

import errno
import json
import os
import re
import subprocess
import sys
import textwrap
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields
from types import SimpleNamespace

import numpy as np
import pytest

import zerodrift as zd
from covering import draws
from support import assert_same_bits, refused
from watched import At, throw
from zerodrift._private.gateway import operations
from zerodrift.runs.samples import mapped_samples, memory, sample_file

not_on_windows = pytest.mark.skipif(os.name == "nt", reason="Windows removes no file that is mapped into memory")
linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="limits and kills as Linux does")
WAYS = {
    "steps": {"step": 0.01}, "fewer": {"step": 0.01, "save_every": 7, "energy": True},
    "times": {"step": 0.01, "t_eval": np.linspace(0, 2, 777)},
    "adaptive steps": {"rtol": 1e-8, "integrator": "dop853"},
    "times in adaptive steps": {"rtol": 1e-8, "integrator": "dop853", "t_eval": np.linspace(0, 2, 777)},
    "events": {"rtol": 1e-8, "integrator": "dormand_prince", "t_eval": np.linspace(0, 2, 77),
               "events": lambda t, p, v: np.sin(p[0])},
}


def ends(t, p, v):
    return t - 0.555


ends.terminal = True


def names_in(folder):
    return sorted(path.name for path in folder.iterdir())


def is_in_file(array):
    """True if the array is a view of mapped memory."""
    return isinstance(array, np.memmap) or (array.base is not None and is_in_file(array.base))


def assert_alike(one, other):
    """All fields, to the bit."""
    for name in (field.name for field in fields(zd.Solution)):
        a, b = getattr(one, name), getattr(other, name)
        if isinstance(a, np.ndarray):
            assert a.dtype == b.dtype
            assert a.shape == b.shape
            assert a.tobytes() == b.tobytes(), name
            assert not b.flags.writeable
    for name in ("status", "success", "message", "t_span"):
        assert getattr(one, name) == getattr(other, name)
    assert {**one.stats, "seconds": 0} == {**other.stats, "seconds": 0}


@pytest.mark.parametrize("block", [1, sample_file.BLOCK])
@pytest.mark.parametrize("way", WAYS)
def test_bits_are_those_of_a_run_in_memory(bar, tmp_path, monkeypatch, way, block):
    monkeypatch.setattr(sample_file, "BLOCK", block)
    here, there = (zd.simulate(bar, 2.0, save_to=to, **WAYS[way]) for to in (None, tmp_path / "run"))
    again = zd.load(tmp_path / "run.npy")
    for sol in (there, again):
        assert_alike(here, sol)
        assert is_in_file(sol.p)
    for ours, theirs in zip(here.t_events or (), again.t_events or (), strict=True):
        assert ours.tobytes() == theirs.tobytes()
    assert repr(again).splitlines()[3:] == repr(here).splitlines()[3:]


@pytest.mark.parametrize("way", ["steps", "adaptive steps", "cut short"])
@pytest.mark.parametrize("name", ["four_bar", "oscillator", "mechanism"])
def test_values_between_rows_have_the_bits_of_a_run_in_memory(tmp_path, name, way):
    """The core reads the columns in the file; a measure behind them widens its rows."""
    system = zd.models.four_bar() if name == "mechanism" else getattr(zd.systems, name)()
    options = {"steps": {"step": 0.01}, "cut short": {"step": 0.01, "events": [ends]},
               "adaptive steps": {"rtol": 1e-8, "integrator": "dop853", "energy": name != "mechanism"}}[way]
    options |= {"outputs": ["C.position"]} if name == "mechanism" and way == "steps" else {}
    here, there = (zd.simulate(system, 1.0, save_to=to, **options) for to in (None, tmp_path / "run"))
    times = np.concatenate([np.linspace(0, here.t[-1], 23), here.t[:3], here.t[-1:]])
    for sol in (there, zd.load(tmp_path / "run.npy")):
        assert is_in_file(sol.p)
        for one, other in zip(here(times), sol(times), strict=True):
            assert one.tobytes() == other.tobytes()
        assert sol(0.123)[0].tobytes() == here(0.123)[0].tobytes()


def test_values_between_rows_read_the_file_where_it_is(bar, tmp_path, monkeypatch):
    """The core is given the columns in the file, none is copied, and times are found without all of them."""
    sol = zd.simulate(bar, 1.0, step=1e-3, save_to=tmp_path / "run")
    passed, strided = [], operations.strided_doubles
    monkeypatch.setattr(operations, "strided_doubles", lambda array, size: passed.append(array) or strided(array, size))
    for name in ("searchsorted", "ascontiguousarray"):      # which copy columns of a file
        monkeypatch.setattr(np, name, None)
    sol([0.1234567, 0.3456789])
    assert {len(array) for array in passed} == {1001}
    assert all(map(is_in_file, passed))


def test_measures_are_recorded_and_read_from_it(tmp_path, monkeypatch):
    m = zd.Mechanism("pendulum", gravity=(0, -9.81))
    pin = m.revolute("pin", m.ground, m.link("link", (0, 0), (1, 0), mass=1.0).start)
    options = {"step": 0.01, "outputs": [pin.force, pin.angle, "link.angle"]}
    here, there = (zd.simulate(m, 1.0, save_to=to, **options) for to in (None, str(tmp_path / "run.npy")))
    monkeypatch.setattr("zerodrift.systems.measure_values.PART", 80)      # bytes: measures are evaluated at ten rows together
    again = zd.load(tmp_path / "run.npy")
    for name in ("pin.force", "pin.force.y", "pin.angle", "link.angle", "link.end.velocity"):
        assert here[name].tobytes() == there[name].tobytes() == again[name].tobytes()
    again.outputs.clear()
    np.testing.assert_allclose(again["pin.force"], here["pin.force"], rtol=1e-12, atol=1e-12)     # evaluated anew


def ran(code, *given, expect=0):
    """Lines that a process prints."""
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(code), *map(str, given)], capture_output=True, text=True,
                          check=False, env=os.environ | {"OPENBLAS_NUM_THREADS": "1"})
    assert done.returncode == expect, done.stderr
    return done.stdout.splitlines()


@linux
def test_a_record_that_memory_has_no_room_for(tmp_path):
    """A record of 72 MB with 48 MB of memory allowed."""
    lines = ran("""
    import resource, sys, numpy as np, zerodrift as zd
    bar, options = zd.systems.four_bar(), {"step": 1e-6, "closed_form": None}
    zd.simulate(bar, 1e-3, save_to=sys.argv[1], **options)
    taken = int(open("/proc/self/statm").read().split()[5]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_DATA, (taken + 48 * 2**20,) * 2)
    try:
        zd.simulate(bar, 0.5, **options)
    except MemoryError as error:
        print(error)
    sol = zd.simulate(bar, 0.5, save_to=sys.argv[1], **options)
    print(sol.message, len(sol.t), sol.p.shape, zd.load(sys.argv[1] + ".npy").t[-1], len(str(sol)) > 100)
    """, tmp_path / "run")
    assert re.fullmatch(r"500001 samples take 72 MB, and (4\d|50)(\.\d)? MB of memory are free: save fewer with save_every or "
                        r"t_eval, or write them to a file with save_to \[zd:no-memory\]", lines[0])
    assert lines[1] == "done 500001 (500001, 3) 0.5 True"


@linux
def test_a_run_that_is_killed_leaves_its_rows(bar, tmp_path):
    ran("""
    import os, signal, sys, zerodrift as zd
    def look(part):
        if part > 0.01:
            os.kill(os.getpid(), signal.SIGKILL)
    zd.simulate(zd.systems.four_bar(), 1000.0, step=1e-3, save_to=sys.argv[1], progress=look)
    """, tmp_path / "run.npy", expect=-9)
    assert (tmp_path / ".run.npy.lock").exists()
    sol = zd.load(tmp_path / "run.npy")
    rows = len(sol.t)
    assert 1e3 < rows < 1e6
    assert_same_bits(zd.simulate(bar, sol.t[-1] + 0.01, step=1e-3), sol, slice(rows))
    assert not sol.success
    assert sol.message == f"stopped from outside, or has not ended yet: there are {rows} samples, the last at t = {sol.t[-1]:.6g}"
    assert sol.stats == {}
    assert f"{rows} samples" in repr(sol)
    with (tmp_path / "run.npy").open("r+b") as file:
        file.truncate((tmp_path / "run.npy").stat().st_size - 5)
    assert len(zd.load(tmp_path / "run.npy").t) == rows - 1
    zd.simulate(bar, 0.1, step=0.01, save_to=tmp_path / "run")      # no lock stays behind
    assert names_in(tmp_path) == ["run.json", "run.npy"]


@linux
def test_a_run_that_is_killed_at_any_time_leaves_what_it_flushed(bar, tmp_path, monkeypatch):
    """Random times; NumPy opens the samples without this package, and they are those of a run in memory."""
    code = """
    import sys, zerodrift as zd
    from zerodrift.runs.samples import sample_file
    sample_file.BLOCK = 20_000
    zd.simulate(zd.systems.four_bar(), 0.01, step=1e-3, save_to=sys.argv[1] + "first")
    print("runs", flush=True)
    zd.simulate(zd.systems.four_bar(), 1e4, step=1e-3, save_to=sys.argv[1])
    """
    whole = zd.simulate(bar, 10.0, step=1e-3)
    for wait in np.random.default_rng(37).uniform(0, 0.05, draws(6, 20)):
        path = tmp_path / "run.npy"
        with subprocess.Popen([sys.executable, "-c", textwrap.dedent(code), path], stdout=subprocess.PIPE) as run:
            assert run.stdout.readline() == b"runs\n"
            while not path.exists():
                time.sleep(1e-4)
            time.sleep(wait)
            run.kill()
        samples, sol = np.load(path, mmap_mode="r"), zd.load(path)
        assert len(sol.t) == len(samples)
        rows = min(len(samples), len(whole.t) - 1)      # the last step of the whole run ends at its t1: another size by rounding
        for name in ("t", "p", "v", "multipliers", "kinetic_energy", "iterations"):
            assert samples[name][:rows].tobytes() == getattr(whole, name)[:rows].tobytes() == getattr(sol, name)[:rows].tobytes()
        assert not sol.success
        path.unlink()


def test_numpy_alone_opens_the_samples(bar, tmp_path):
    sol = zd.simulate(bar, 1.0, step=0.01, save_to=tmp_path / "run")
    for samples in (np.load(tmp_path / "run.npy"), np.load(tmp_path / "run.npy", mmap_mode="r")):
        for name in samples.dtype.names:
            assert samples[name].tobytes() == getattr(sol, name).tobytes()
    described = json.loads((tmp_path / "run.json").read_bytes())
    assert described["solution"]["system"]["name"] == "four_bar"
    assert [name for name, *_ in described["solution"]["system"]["coordinates"]] == [each.name for each in bar.coordinates]


def test_a_description_of_other_samples_is_refused(bar, tmp_path):
    zd.simulate(bar, 0.1, step=0.05, save_to=tmp_path / "run")
    zd.simulate(zd.systems.oscillator(), 0.1, step=0.05, save_to=tmp_path / "other")
    (tmp_path / "run.json").write_bytes((tmp_path / "other.json").read_bytes())
    with refused("unreadable-file", r"run\.json.*of 144"):
        zd.load(tmp_path / "run.npy")


def test_one_that_was_killed_at_once_has_no_rows(bar, tmp_path):
    zd.simulate(bar, 0.1, step=0.05, save_to=tmp_path / "run")
    path = tmp_path / "run.npy"
    empty = np.load(path)[:0]
    np.save(path, empty)
    sol = zd.load(path)
    assert len(sol.t) == 0
    assert sol.p.shape == (0, 3)
    assert "no samples" in sol.message


def test_what_follows_the_rows_may_be_missing(bar, tmp_path):
    whole = zd.simulate(bar, 1.0, step=0.01, save_to=tmp_path / "run")
    path = tmp_path / "cut.npy"
    path.write_bytes((tmp_path / "run.npy").read_bytes()[:-100])
    (tmp_path / "cut.json").write_bytes((tmp_path / "run.json").read_bytes())
    sol = zd.load(path)
    assert_same_bits(whole, sol)
    assert not sol.success


@pytest.mark.parametrize("length", [20, 100])
def test_a_header_that_is_cut_short_is_refused(bar, tmp_path, length):
    zd.simulate(bar, 0.1, step=0.05, save_to=tmp_path / "run")
    path = tmp_path / "run.npy"
    path.write_bytes(path.read_bytes()[:length])
    with refused("unreadable-file", r"run\.npy"):
        zd.load(path)


def test_ctrl_c_keeps_what_was_written(bar, tmp_path):
    with pytest.raises(zd.Interrupted) as caught:
        zd.simulate(bar, 100.0, step=1e-3, save_to=tmp_path / "run", progress=At(3, throw(KeyboardInterrupt())))
    sol = caught.value.solution
    assert 1 < len(sol.t) < 1e5
    assert_alike(sol, zd.load(tmp_path / "run.npy"))
    assert sol.message == "interrupted from the keyboard"


def test_runs_that_fail_say_so_in_the_file(bar, tmp_path):
    with pytest.raises(zd.ZerodriftError) as caught:
        zd.simulate(bar, 8.0, step=0.5, stabilization=None, save_to=tmp_path / "run")
    assert_alike(caught.value.solution, zd.load(tmp_path / "run.npy"))
    with pytest.raises(zd.InconsistentStart):
        zd.simulate(bar, 8.0, [1, 1, 1], step=0.1, save_to=tmp_path / "never")
    assert not (tmp_path / "never.npy").exists()


@pytest.mark.parametrize("after", [5, 10**9], ids=["in a run", "at its end"])
def test_a_disk_that_is_full_stops_the_run_and_keeps_its_rows(bar, tmp_path, monkeypatch, after):
    monkeypatch.setattr(sample_file, "BLOCK", 1000)
    puts, put = [], sample_file.SampleFile._put

    def full(self, content):
        puts.append(content)
        if len(puts) > after or bytes(content)[:2] == b"PK":        # of what follows the rows
            self._file.write(bytes(content)[:7])
            raise OSError(errno.ENOSPC, "No space left on device")
        put(self, content)

    monkeypatch.setattr(sample_file.SampleFile, "_put", full)
    with pytest.raises(OSError, match="No space left") as caught:
        zd.simulate(bar, 1.0, step=0.01, save_to=tmp_path / "run")
    sol = caught.value.solution
    assert len(sol.t) == (12 if after == 5 else 101)
    again = zd.load(tmp_path / "run.npy")
    assert_same_bits(sol, again)


@not_on_windows
def test_an_older_run_keeps_its_rows_where_its_file_is_replaced(bar, tmp_path):
    first = zd.simulate(bar, 1.0, step=0.01, save_to=tmp_path / "run")
    kept = first.p.copy()
    second = zd.simulate(bar, 0.1, step=0.01, save_to=tmp_path / "run")
    assert first.p.tobytes() == kept.tobytes()
    assert len(zd.load(tmp_path / "run.npy").t) == len(second.t) == 11


def test_a_file_that_cannot_be_removed_is_not_replaced(bar, tmp_path, monkeypatch):
    """On Windows its rows are in use; elsewhere the refusal is made up."""
    def refuse(path, missing_ok=False):
        raise PermissionError("denied")

    first = zd.simulate(bar, 1.0, step=0.01, save_to=tmp_path / "run")
    if os.name != "nt":
        monkeypatch.setattr(sample_file, "AS_WINDOWS", True)
        monkeypatch.setattr(sample_file.Path, "unlink", lambda path, missing_ok=False: path.suffix == ".lock" or refuse(path))
    with refused("file-in-use", r"save_to.*'.*run\.npy'"):
        zd.simulate(bar, 0.1, step=0.01, save_to=tmp_path / "run")
    assert_same_bits(first, zd.load(tmp_path / "run.npy"))


@not_on_windows
def test_an_older_file_stays_where_no_header_can_be_written(bar, tmp_path, monkeypatch):
    def full(self, content):
        raise OSError(errno.ENOSPC, "No space left on device")

    first = zd.simulate(bar, 1.0, step=0.01, save_to=tmp_path / "run")
    with monkeypatch.context() as patched:
        patched.setattr(sample_file.SampleFile, "_put", full)
        with pytest.raises(OSError, match="No space left"):
            zd.simulate(bar, 2.0, step=0.01, save_to=tmp_path / "run")
    assert_same_bits(first, zd.load(tmp_path / "run.npy"))
    assert names_in(tmp_path) == ["run.json", "run.npy"]


@not_on_windows
def test_a_file_that_is_moved_while_a_run_goes_on_keeps_its_rows(bar, tmp_path):
    """And so does the solution, which reads the file that was written and not another one of that name."""
    def move(part):
        if not (tmp_path / "other.npy").exists():
            for ending in (".npy", ".json"):
                (tmp_path / "run").with_suffix(ending).rename((tmp_path / "other").with_suffix(ending))
                (tmp_path / "run").with_suffix(ending).write_text("notes")

    sol = zd.simulate(bar, 1.0, step=0.01, save_to=tmp_path / "run", progress=move)
    here = zd.simulate(bar, 1.0, step=0.01)
    assert_same_bits(here, sol)
    assert_same_bits(here, zd.load(tmp_path / "other.npy"))
    assert (tmp_path / "run.npy").read_text() == (tmp_path / "run.json").read_text() == "notes"


# ---- one writer ----


@pytest.mark.parametrize("executed", ["in a thread", "in a process"])
def test_a_second_run_that_saves_to_a_file_in_use_is_refused(bar, tmp_path, executed):
    """Both orders end well: the first has its rows, and the name is free when it has ended."""
    refusal = r"save_to must be a file that no other run writes to, and '.*run\.npy' is being written by process \d+, thread "
    code = "import sys, zerodrift as zd; zd.simulate(zd.systems.pendulum(), 1.0, step=0.01, save_to=sys.argv[1])"
    seen = []

    def again(part):
        if not seen and executed == "in a thread":
            with ThreadPoolExecutor(1) as pool, pytest.raises(zd.InUse, match=refusal) as caught:
                pool.submit(zd.simulate, zd.systems.pendulum(), 1.0, step=0.01, save_to=tmp_path / "run.npy").result()
            seen.append(caught.value)
        elif not seen:
            done = subprocess.run([sys.executable, "-c", code, tmp_path / "run"], capture_output=True, text=True, check=False)
            assert re.search("InUse: " + refusal, done.stderr)
            seen.append(done)

    sol = zd.simulate(bar, 1.0, step=0.01, save_to=tmp_path / "run", progress=again)
    assert seen
    assert_same_bits(zd.simulate(bar, 1.0, step=0.01), sol)
    assert_same_bits(sol, zd.load(tmp_path / "run.npy"))
    assert names_in(tmp_path) == ["run.json", "run.npy"]
    if os.name != "nt":
        assert zd.simulate(bar, 0.1, step=0.01, save_to=tmp_path / "run").success


def test_a_run_that_fails_frees_its_file(bar, tmp_path):
    for _ in range(2):
        with pytest.raises(zd.ZerodriftError) as caught:
            zd.simulate(bar, 8.0, step=0.5, stabilization=None, save_to=tmp_path / "run")
        assert not isinstance(caught.value, zd.InUse)
        with pytest.raises(zd.InconsistentStart):
            zd.simulate(bar, 8.0, [1, 1, 1], step=0.1, save_to=tmp_path / "run")
        if os.name == "nt":     # where the rows in use keep the file
            del caught


def test_what_is_refused_names_the_argument(bar, tmp_path):
    (tmp_path / "mine.npy").write_text("notes")
    (tmp_path / "folder.npy").mkdir()
    (tmp_path / "text.json").write_text("notes")
    for to, error, message in ((3, TypeError, "save_to must be the path of a file, or None, not 3"),
                               (tmp_path / "a.npz", ValueError, "save_to must not end in .npz, which is what Solution.save"),
                               (tmp_path / "no" / "a", FileNotFoundError, "save_to must be in a folder that is there"),
                               (tmp_path / "mine", FileExistsError, "save_to must be a new file, or one that a run has"),
                               (tmp_path / "text", FileExistsError, "save_to must be a new file"),
                               (tmp_path / "folder", FileExistsError, "save_to must be a new file")):
        with pytest.raises(error, match=message):
            zd.simulate(bar, 1.0, step=0.1, save_to=to)
    with refused("conflicting-arguments", "save_every.*be 1.*t_eval"):
        zd.simulate(bar, 1.0, step=0.1, save_to=tmp_path / "a", save_every=2, t_eval=[0.5])
    assert (tmp_path / "mine.npy").read_text() == "notes"


def test_another_byte_order_is_refused(bar, tmp_path, monkeypatch):
    zd.simulate(bar, 0.1, step=0.01, save_to=tmp_path / "run")
    monkeypatch.setattr(mapped_samples.sys, "byteorder", "middle")
    with refused("unreadable-file", r"run\.npy"):
        zd.load(tmp_path / "run.npy")


# ---- the size, before anything runs ----


def test_size_is_that_of_the_arrays(bar):
    for options in ({"step": 0.01}, {"step": 0.01, "save_every": 9}, {"step": 0.01, "t_eval": [0.1, 0.5]}):
        sol, size = zd.simulate(bar, 1.0, **options), zd.record_size(bar, 1.0, **options)
        arrays = [sol.t, sol.p, sol.v, sol.multipliers, sol.position_violation, sol.velocity_violation, sol.kinetic_energy,
                  sol.potential_energy, sol.energy_input, sol.energy_violation, sol.iterations, sol.energy_skipped]
        assert size.rows == len(sol.t)
        assert size.total == sum(array.nbytes for array in arrays) == size.rows * size.row
    assert zd.record_size(bar, 1.0) == (None, size.row, None)
    assert str(zd.record_size(bar, 1.0)) == "samples of 144 bytes"
    m = zd.Mechanism("pendulum")
    m.revolute("pin", m.ground, m.link("link", (0, 0), (1, 0), mass=1.0).start)
    assert zd.record_size(m, 1.0, outputs=["pin.force"]).row == zd.record_size(m, 1.0).row + 16


@pytest.mark.parametrize(("size", "words"), [(999, "999 bytes"), (1000, "1 kB"), (2.5e6, "2.5 MB"), (72e9, "72 GB")])
def test_sizes_in_words(size, words):
    assert memory.in_words(size) == words


def test_more_than_half_of_memory_is_reported_before_anything_runs(bar, monkeypatch):
    monkeypatch.setattr("zerodrift.runs.samples.recording.UNCHECKED_BYTES", 1000)
    monkeypatch.setattr(memory, "free_memory", lambda: 20000)
    with pytest.warns(zd.CostWarning, match=r"101 samples take 14\.5 kB, and 20 kB of memory are free: save fewer") as told:
        zd.simulate(bar, 1.0, step=0.01)
    assert told[0].filename == __file__
    steps = At(1, throw(AssertionError("it runs")))
    with refused("no-memory", r"201.*take 28\.9"):
        zd.simulate(bar, 2.0, step=0.01, progress=steps)
    monkeypatch.setattr(memory, "free_memory", lambda: None)
    assert len(zd.simulate(bar, 2.0, step=0.01).t) == 201


def test_adaptive_steps_stop_where_no_more_rows_have_room(bar, monkeypatch):
    monkeypatch.setattr("zerodrift.runs.samples.recording.UNCHECKED_BYTES", 1000)
    monkeypatch.setattr("zerodrift.runs.samples.recording.FIRST_BLOCK", 16)
    monkeypatch.setattr(memory, "free_memory", lambda: 20000)
    with pytest.warns(zd.CostWarning), refused("no-memory") as caught:
        zd.simulate(bar, 20.0, rtol=1e-8, integrator="dop853")
    assert len(caught.value.solution.t) == 256


def test_a_disk_without_room_is_refused_before_anything_runs(bar, tmp_path, monkeypatch):
    monkeypatch.setattr(memory.shutil, "disk_usage", lambda folder: type("Usage", (), {"free": 10**4}))
    with refused("no-space", r"101.*take 14\.5.*and 10"):
        zd.simulate(bar, 1.0, step=0.01, save_to=tmp_path / "run")
    assert not list(tmp_path.iterdir())


def test_limits_of_containers_count(tmp_path, monkeypatch):
    monkeypatch.setattr(memory, "CONTROL", tmp_path)
    (tmp_path / "memory.current").write_text("400\n")
    (tmp_path / "memory.max").write_text("max\n")
    plain = memory.free_memory()
    (tmp_path / "memory.max").write_text("1000\n")
    assert memory.free_memory() == 600
    assert plain is None or plain > 600


def test_what_windows_says_of_its_memory(monkeypatch):
    """By its own function there, elsewhere by one that answers as its documentation says."""
    def answer(reference):
        status = reference._obj
        assert status.size == 64
        status.free_memory, status.free_with_page_file = 300, 200
        return 1

    if os.name == "nt":
        assert 2**20 < memory.free_memory() < 2**50
    monkeypatch.setattr(memory, "sys", SimpleNamespace(platform="win32"))
    kernel = SimpleNamespace(GlobalMemoryStatusEx=answer)
    monkeypatch.setattr(memory.ctypes, "windll", SimpleNamespace(kernel32=kernel), raising=False)
    assert memory._available() == 200
