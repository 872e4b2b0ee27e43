"""Stores: what was finished stays, is not made again, and belongs to one study."""

import itertools
import json
import os
import re
import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from small_studies import lowest, pendulum, slow, waits
from support import environment_of_tests, refused
from zerodrift._private import writing
from zerodrift.ensembles import store as module
from zerodrift.runs.open.identity import Identity

GRAVITIES = np.linspace(5.0, 10.0, 12)
STUDY = {"parameters": {"gravity": GRAVITIES}, "step": 0.01, "outputs": ["link.angle"], "reduce": lowest}


def same(one, other):
    """True if two ensembles are bitwise the same."""
    return (np.array_equal(one["link.angle"], other["link.angle"], equal_nan=True) and one.messages == other.messages
            and np.array_equal(one.values, other.values, equal_nan=True) and np.array_equal(one.failed, other.failed))


def test_a_finished_study_is_read_and_not_run(tmp_path, monkeypatch):
    alone = zd.ensemble(pendulum, 1.0, **STUDY)
    first = zd.ensemble(pendulum, 1.0, store=tmp_path / "study", chunk=5, **STUDY)
    assert same(alone, first)
    assert sorted(path.name for path in (tmp_path / "study").iterdir()) == [
        "manifest.json", *(f"runs_{i:09}_{min(i + 5, 12):09}.npz" for i in (0, 5, 10)), "study.npz"]
    monkeypatch.delattr("zerodrift.ensembles.plan.simulate")
    seen = []
    again = zd.ensemble(pendulum, 1.0, store=tmp_path / "study", chunk=2, progress=seen.append, **STUDY)
    assert same(alone, again)
    assert seen[-1] == 1.0


KILLED = """
import os, signal, sys
import numpy as np
import zerodrift as zd
from small_studies import pendulum, slow

zd.ensemble(pendulum, 1.0, parameters={"gravity": np.linspace(5.0, 10.0, 60)}, step=0.01, reduce=slow, outputs=["link.angle"],
            chunk=3, threads=2, store=sys.argv[1], progress=lambda part: part > 0.2 and os.kill(os.getpid(), signal.SIGKILL))
"""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="processes of this system are not killed by signals")
def test_a_killed_study_goes_on(tmp_path, monkeypatch):
    """With another number of runs in a chunk and of threads; nothing that was finished is made again."""
    folder, counted = tmp_path / "study", tmp_path / "counted"
    environment = environment_of_tests(ZERODRIFT_COUNTED=str(counted))
    monkeypatch.setenv("ZERODRIFT_COUNTED", str(counted))
    killed = subprocess.run([sys.executable, "-c", KILLED, folder], env=environment, timeout=tol.HUNG)
    assert killed.returncode == -signal.SIGKILL
    began, done = len(counted.read_text().splitlines()), int((~zd.load(folder).failed).sum())
    assert (folder / module.LOCK).exists()      # of a process that is dead
    assert 12 <= done <= began <= done + 6      # two chunks of three may have been under way
    study = STUDY | {"parameters": {"gravity": np.linspace(5.0, 10.0, 60)}, "reduce": slow}
    whole = zd.ensemble(pendulum, 1.0, store=folder, chunk=7, threads=3, **study)
    assert len(counted.read_text().splitlines()) - began == 60 - done
    assert same(whole, zd.ensemble(pendulum, 1.0, **study | {"reduce": lowest}))
    assert not (folder / module.LOCK).exists()


def test_an_interrupted_study_goes_on(tmp_path):
    """Ctrl-C within a chunk: the runs of it that were done are kept, too."""
    def stops(part):
        if part > 0:
            raise KeyboardInterrupt

    study = STUDY | {"parameters": {"gravity": np.linspace(5.0, 10.0, 80)}, "reduce": waits, "chunk": 20}
    with pytest.raises(zd.Interrupted) as caught:
        zd.ensemble(pendulum, 1.0, store=tmp_path / "study", progress=stops, **study)
    done = ~caught.value.solution.failed
    loaded = zd.load(tmp_path / "study")
    assert same(caught.value.solution, loaded)
    assert 0 < done.sum() < 80
    assert "was not started" in loaded.messages[-1]
    assert same(zd.ensemble(pendulum, 1.0, store=tmp_path / "study", **study),
                zd.ensemble(pendulum, 1.0, **study | {"reduce": lowest}))


def test_a_part_is_there_as_a_whole_or_not_at_all(tmp_path, monkeypatch):
    """A full disk, and a file that another program has cut short."""
    def full(source, target):
        raise OSError("no space left")

    study = zd.ensemble(pendulum, 1.0, store=tmp_path / "study", chunk=5, **STUDY)
    (tmp_path / "study" / "runs_000000005_000000010.npz").unlink()
    with monkeypatch.context() as patched:
        patched.setattr(writing.os, "replace", full)
        with pytest.raises(OSError, match="no space left"):
            zd.ensemble(pendulum, 1.0, store=tmp_path / "study", chunk=5, **STUDY)
    assert not [path for path in (tmp_path / "study").iterdir() if path.name.startswith(".")]
    assert zd.load(tmp_path / "study").failed.sum() == 5
    assert same(study, zd.ensemble(pendulum, 1.0, store=tmp_path / "study", **STUDY))
    path = tmp_path / "study" / "runs_000000000_000000005.npz"
    path.write_bytes(path.read_bytes()[:100])
    with refused("unreadable-file", "runs_000000000_000000005.npz"):
        zd.ensemble(pendulum, 1.0, store=tmp_path / "study", **STUDY)


@pytest.mark.parametrize("refusals", [2, 4])
def test_what_others_look_at_is_renamed_a_moment_later_on_windows(tmp_path, monkeypatch, refusals):
    seen, replace = [], os.replace

    def in_use(source, target):
        seen.append(target.name)
        if seen.count("study.npz") <= refusals and target.name == "study.npz":
            raise PermissionError("in use")
        replace(source, target)

    monkeypatch.setattr(writing, "AS_WINDOWS", True)
    monkeypatch.setattr(writing, "PAUSES", (0.0, 0.0, 0.0))
    monkeypatch.setattr(writing.os, "replace", in_use)
    if refusals > len(writing.PAUSES):
        with pytest.raises(PermissionError, match="in use"):
            zd.ensemble(pendulum, 1.0, store=tmp_path / "study", **STUDY)
        return
    zd.ensemble(pendulum, 1.0, store=tmp_path / "study", **STUDY)
    assert seen.count("study.npz") == refusals + 1
    assert not zd.load(tmp_path / "study").failed.any()


def test_two_processes_may_work_at_one_study(tmp_path):
    """Each writes its own parts, and they overlap; all orders of these give one ensemble."""
    alone = zd.ensemble(pendulum, 1.0, **STUDY)
    for i, chunk in enumerate((5, 4, 3)):
        zd.ensemble(pendulum, 1.0, store=tmp_path / str(i), chunk=chunk, **STUDY)
    for path in itertools.chain((tmp_path / "1").glob("runs*"), (tmp_path / "2").glob("runs*")):
        path.rename(tmp_path / "0" / path.name)
    assert same(alone, zd.load(tmp_path / "0"))


IN_USE = "store '.*study' must be that of one ensemble at a time; it is in use by process "
ANOTHER = """
import sys
import numpy as np
import zerodrift as zd
from small_studies import lowest, pendulum

zd.ensemble(pendulum, 1.0, parameters={"gravity": np.linspace(5.0, 10.0, 12)}, step=0.01, outputs=["link.angle"], reduce=lowest,
            store=sys.argv[1])
"""


def test_a_store_in_use_is_refused(tmp_path, monkeypatch):
    """To a thread and to a process, for the same study; its own call goes on, and a finished study may be read by many."""
    seen, environment = [], environment_of_tests()
    write = module.Store.write

    def again(self, first, part):
        write(self, first, part)
        if seen:
            return
        with pytest.raises(zd.InUse, match=IN_USE) as caught:
            zd.ensemble(pendulum, 1.0, store=tmp_path / "study", **STUDY)
        seen.append(caught)
        assert len(zd.load(tmp_path / "study")) == 12
        there = subprocess.run([sys.executable, "-c", ANOTHER, tmp_path / "study"], env=environment, timeout=tol.HUNG,
                               capture_output=True, text=True)
        assert re.search("zerodrift.errors.InUse: " + IN_USE, there.stderr)

    monkeypatch.setattr(module.Store, "write", again)
    made = zd.ensemble(pendulum, 1.0, store=tmp_path / "study", **STUDY | {"chunk": 2, "threads": 1})
    assert seen
    assert same(made, zd.ensemble(pendulum, 1.0, **STUDY))
    with module.Lock(tmp_path / "study" / module.LOCK, "in use by"):
        assert same(made, zd.ensemble(pendulum, 1.0, store=tmp_path / "study", **STUDY))


@pytest.mark.parametrize("others", [{"step": 0.02}, {}], ids=["two studies", "one study"])
def test_two_that_begin_at_one_moment(tmp_path, others):
    """One of them is refused, or comes later: a store has the runs of its own parameters in every case."""
    alone = [zd.ensemble(zd.systems.oscillator(), 0.2, parameters={"mass": np.linspace(1, 2, 8)}, **{"step": 0.01} | more)
             for more in ({}, others)]
    refusals = []
    for i in range(25):
        ready = threading.Barrier(2)

        def made(more, store=tmp_path / str(i), ready=ready):
            ready.wait()
            try:
                return zd.ensemble(zd.systems.oscillator(), 0.2, parameters={"mass": np.linspace(1, 2, 8)}, store=store, chunk=1,
                                   threads=1, **{"step": 0.01} | more)
            except ValueError as error:
                return error

        with ThreadPoolExecutor(2) as pool:
            found = list(pool.map(made, ({}, others)))
        for ens, expected in zip(found, alone, strict=True):
            if isinstance(ens, Exception):
                assert isinstance(ens, zd.InUse) or "belongs to another study" in str(ens)
                refusals.append(ens)
            else:
                assert np.array_equal(ens["x"], expected["x"])
        loaded = zd.load(tmp_path / str(i))
        assert any(np.array_equal(loaded["x"], expected["x"]) for expected in alone)
    assert refusals


def test_a_study_that_was_killed_as_it_began_is_begun_anew(tmp_path):
    """All that a process leaves before the manifest is written; what is not its own is not touched."""
    folder, other = tmp_path / "study", tmp_path / "other"
    for each in (folder, other):
        zd.ensemble(pendulum, 1.0, store=each, **STUDY)
        (each / module.MANIFEST).unlink()
        for path in each.glob("runs*"):
            path.unlink()
        (each / module.LOCK).touch()
        (each / ".0123456789abcdef.part").write_bytes(b"half of it")
    made = zd.ensemble(pendulum, 1.0, store=folder, **STUDY)
    assert same(made, zd.load(folder))
    assert not [path for path in folder.iterdir() if path.name.startswith(".")]
    np.savez(other / module.STUDY, mine=np.ones(3))
    with refused("other-study"):
        zd.ensemble(pendulum, 1.0, store=other, **STUDY)


def made_by(factor, shift=1.0):
    """Functions that differ by what they close over, by their defaults, or by their code."""
    def reduce(sol, shift=shift):
        return factor * sol.t[-1] + shift
    return reduce


def otherwise(factor, shift=1.0):
    """The same, with another code."""
    def reduce(sol, shift=shift):
        return factor * sol.t[-1] - shift
    reduce.__qualname__ = "made_by.<locals>.reduce"
    return reduce


BASE = {"parameters": {"gravity": GRAVITIES, "length": 1.0}, "step": 0.01, "outputs": ["link.angle"], "reduce": made_by(1.0)}


@pytest.mark.parametrize(("changes", "said"), [
    ({"reduce": made_by(2.0)}, r"functions\['.*made_by.<locals>.reduce'\]\['closure'\] was .* and is"),
    ({"reduce": made_by(1.0, shift=2.0)}, r"\['defaults'\] was"),
    ({"reduce": otherwise(1.0)}, r"\['code'\] was"),
    ({"reduce": None}, "reduce was .* and is not there"),
    ({"step": 0.02}, r"settings\['step'\] was 0.01 and is 0.02"),
    ({"formulation": "augmented"}, r"settings\['formulation'\] was not there and is augmented"),
    ({"outputs": ["link.angular_velocity"]}, r"outputs was \['link.angle'\] and is \['link.angular_velocity'\]"),
    ({"parameters": {"gravity": GRAVITIES + (np.arange(12) > 6), "length": 1.0}},
     r"parameters\['gravity'\] of 5 runs, first run 7, where it was .*8.1.* and is .*9.1"),
    ({"parameters": {"gravity": GRAVITIES[:6], "length": 1.0}}, "runs was 12 and is 6"),
    ({"parameters": {"gravity": GRAVITIES}}, r"parameters\['length'\] was there and is not there"),
    ({"start": {"link.angle": 0.1}}, r"start\['link.angle'\] was not there and is there"),
    ({"vector": "baseline"}, "vector was .* and is baseline"),
    ({"t_span": 2.0}, r"t_span was \[0.0, 1.0\] and is \[0.0, 2.0\]"),
    ({"assemble": False}, "assemble was True and is False"),
    ({"events": [zd.Event("link.angle", value=-1.0)]}, r"settings\['events'\] was not there and is"),
    ({"system": zd.models.four_bar(), "outputs": ["crank.angle"], "parameters": None},
     "system was .* and is {'name': 'four_bar'"),
])
def test_a_store_of_another_study_is_refused(tmp_path, changes, said):
    """Every difference is named, before anything runs and without a trace in the folder."""
    if changes.get("vector") == "baseline" and zd.simulate(zd.systems.four_bar(), 0.1, step=0.1).settings["vector"] == "baseline":
        changes, said = {"vector": "baseline", "step": 0.02}, "step"
    call = {"system": pendulum, "t_span": 1.0} | BASE
    zd.ensemble(**call, store=tmp_path / "study")
    before = {path: path.stat().st_mtime_ns for path in (tmp_path / "study").iterdir()}
    with refused("other-study", f"store .*study' belongs to another study: .*{said}"):
        zd.ensemble(**call | changes, store=tmp_path / "study")
    assert {path: path.stat().st_mtime_ns for path in (tmp_path / "study").iterdir()} == before
    zd.ensemble(**call, store=tmp_path / "study")


def test_parameters_of_a_system_are_named(tmp_path):
    study = {"v0": [[0.1], [0.2]], "step": 0.1, "store": tmp_path / "study"}
    zd.ensemble(zd.systems.oscillator(), 1.0, **study)
    with refused("other-study", r"system\['parameters'\]\['mass'\].*was 1.0 and is 2.0"):
        zd.ensemble(zd.systems.oscillator(mass=2.0), 1.0, **study)
    with refused("other-study", "of 1.*run 1.*0.2.*0.3"):
        zd.ensemble(zd.systems.oscillator(), 1.0, **study | {"v0": [[0.1], [0.3]]})


def test_the_vector_unit_of_the_beginning_stays(tmp_path, monkeypatch):
    """A study is continued with its first vector unit if none is given; a processor without it raises an error."""
    study = {"step": 0.1, "store": tmp_path / "study"}
    zd.ensemble(zd.systems.four_bar(), 0.3, vector="baseline", **study)
    assert not zd.ensemble(zd.systems.four_bar(), 0.3, **study).failed.any()
    path = tmp_path / "study" / "manifest.json"
    path.write_text(path.read_text().replace('"baseline"', '"avx512"'))
    monkeypatch.setattr(module.gateway, "PROCESSOR_UNIT", 0)
    with refused("other-study", '"avx2".*"baseline"'):
        zd.ensemble(zd.systems.four_bar(), 0.3, **study)


@pytest.mark.parametrize(("change", "code", "said"), [
    ({"format": 2}, "unreadable-file", "format 2.*format 1"), ({"version": "another"}, "other-study", None),
    ({"what": "something"}, "unreadable-file", None), (None, "unreadable-file", None)])
def test_manifests_of_others(tmp_path, change, code, said):
    study = {"step": 0.1, "store": tmp_path / "study"}
    zd.ensemble(zd.systems.oscillator(), 1.0, **study)
    path = tmp_path / "study" / "manifest.json"
    path.write_text("{" if change is None else json.dumps(json.loads(path.read_text()) | change))
    with refused(code, said):
        zd.ensemble(zd.systems.oscillator(), 1.0, **study)


def test_what_a_store_refuses(tmp_path):
    (tmp_path / "other").write_text("something else")
    with refused("other-study"):
        zd.ensemble(zd.systems.oscillator(), 1.0, step=0.1, store=tmp_path)
    with refused("wrong-type", "store"):
        zd.ensemble(zd.systems.oscillator(), 1.0, step=0.1, store=3)
    with refused("conflicting-arguments", "^keep must"):
        zd.ensemble(zd.systems.oscillator(), 1.0, step=0.1, store=tmp_path / "new", keep="solutions")
    with refused("not-portable", "reduce"):
        zd.ensemble(zd.systems.oscillator(), 1.0, step=0.1, store=tmp_path / "new", reduce=lambda sol: object())
    with refused("unreadable-file"):
        zd.load(tmp_path)


IDENTITIES = """
import numpy as np
import zerodrift as zd
from small_studies import pendulum
from zerodrift.runs.open.identity import Identity

def decorated(p, L):
    return np.array([(p @ p - L**2) / 2]) if {"a", "b", "c"} else None

system = zd.System(["x", "y"], mass=lambda m: m * np.eye(2), constraints=decorated, parameters={"m": 1.0, "L": 1.0}, p0=[1, 0])
loaded = pendulum()
loaded.torque("load", "link", value=lambda angle: -angle, of={"angle": "link.angle"})
for each in (zd.systems.four_bar(), system, zd.models.slider_crank().system(), loaded.system(),
             np.sin, decorated, pendulum().system().evaluate):
    before = Identity().of(each)
    if hasattr(each, "evaluate"):
        zd.simulate(each, 0.05, step=0.01)
    print(before, Identity().of(each) == before)
"""


def test_identities_do_not_depend_on_the_process(capsys):
    """Nor on what a system has found out meanwhile; strings hash otherwise in each process."""
    environment = environment_of_tests()
    there = subprocess.run([sys.executable, "-c", IDENTITIES], env=environment, check=True, text=True, capture_output=True).stdout
    exec(IDENTITIES, {"__name__": "__main__"})
    assert capsys.readouterr().out == there
    assert there.count("True") == len(set(there.splitlines())) == 7


def test_identities_of_what_refers_to_itself():
    one, other = [1.0], [1.0]
    one.append(one)
    other.append(other)
    assert Identity().of(one) == Identity().of(other) != Identity().of([1.0, [1.0]])

    def recursive(n):
        return later(n) if n else recursive(n - 1)

    before = Identity().of(recursive)       # one of its names has no value yet
    later = abs
    assert Identity().of(recursive) != before
