"""Files are there as a whole or not at all: what was saved before survives a disk that is full, and a process that is killed."""

import os
import signal
import stat
import subprocess
import sys

import numpy as np
import pytest

import zerodrift as zd
from support import environment_of_tests, refused
from zerodrift._private import writing
from zerodrift._private.writing import write_atomically

posix = pytest.mark.skipif(os.name == "nt", reason="limits, permissions and signals of POSIX")
resource = pytest.importorskip("resource") if os.name != "nt" else None


def solution(size):
    return zd.simulate(zd.systems.four_bar(), 0.1 * size, step=0.01)


def study(size):
    return zd.ensemble(zd.systems.four_bar(), 0.1 * size, parameters={"gravity": [9.0, 10.0]}, step=0.01)


def mechanism(size):
    m = zd.Mechanism("particles", gravity=(0, -9.81))
    for i in range(3 * size):
        m.particle(f"bob {i}", 1.0, at=(i, 0))
    return m


def comparison(size):
    made = zd.work_precision(zd.systems.oscillator(), 0.1, steps=[0.01], integrators=["rk4"])
    return type("Table", (), {"save": lambda self, path: type(made)(**{**vars(made), "rows": made.rows * size}).to_csv(path)})()


SAVED = {"run.npz": solution, "study.npz": study, "particles.json": mechanism, "table.csv": comparison}


@posix
@pytest.mark.parametrize("name", SAVED)
def test_an_older_file_survives_a_disk_that_is_full(tmp_path, name):
    """The operating system refuses what is longer than a limit, as a full disk does, after a part was written."""
    path = tmp_path / name
    SAVED[name](1).save(path)
    before, longer = path.read_bytes(), SAVED[name](30)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(before) + 100, limits[1]))
    try:
        with pytest.raises(OSError, match="File too large") as caught:
            longer.save(path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert caught.value.__notes__ == [f"{path} is as it was"]
    assert path.read_bytes() == before
    assert [each.name for each in tmp_path.iterdir()] == [name]
    longer.save(path)
    assert path.stat().st_size > len(before) + 100


KILLED = """
import os, signal, sys
from zerodrift._private.writing import write_atomically

def write(file):
    file.write(b"half of it")
    file.flush()
    os.kill(os.getpid(), signal.SIGKILL)

write_atomically(sys.argv[1], write)
"""


@posix
def test_an_older_file_survives_a_process_that_is_killed(tmp_path):
    path = tmp_path / "run"
    path.write_bytes(b"what was there")
    done = subprocess.run([sys.executable, "-c", KILLED, path], check=False, env=environment_of_tests())
    assert done.returncode == -signal.SIGKILL
    assert path.read_bytes() == b"what was there"


def test_the_file_is_on_the_disk_before_it_has_its_name(tmp_path, monkeypatch):
    """Data are synchronized before the file is renamed, and its name after it."""
    seen, real = [], {name: getattr(os, name) for name in ("fsync", "replace")}
    for name in real:
        monkeypatch.setattr(writing.os, name, lambda *given, name=name: (seen.append(name), real[name](*given)))
    write_atomically(tmp_path / "run", lambda file: file.write(b"new"))
    assert seen == ["fsync", "replace"] + (["fsync"] if os.name != "nt" else [])


@posix
def test_permissions_links_and_devices(tmp_path):
    path, link = tmp_path / "run", tmp_path / "link"
    path.write_bytes(b"old")
    path.chmod(0o640)
    link.symlink_to(path)
    write_atomically(link, lambda file: file.write(b"new"))
    assert link.is_symlink()
    assert path.read_bytes() == b"new"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    write_atomically(tmp_path / "fresh", lambda file: file.write(b""))
    (tmp_path / "plain").touch()
    assert (tmp_path / "fresh").stat().st_mode == (tmp_path / "plain").stat().st_mode
    write_atomically("/dev/null", lambda file: file.write(b"new"))
    assert stat.S_ISCHR(os.stat("/dev/null").st_mode)


def test_a_protected_file_and_a_folder_that_is_not_there(tmp_path, monkeypatch):
    path = tmp_path / "run"
    path.write_bytes(b"old")
    monkeypatch.setattr(writing.os, "access", lambda path, mode: False)      # as for all users except the superuser
    with pytest.raises(PermissionError) as caught:
        write_atomically(path, lambda file: file.write(b"new"))
    assert caught.value.filename == str(path)
    assert path.read_bytes() == b"old"
    with pytest.raises(FileNotFoundError) as caught:
        solution(1).save(tmp_path / "no" / "run.npz")
    assert caught.value.filename == str(tmp_path / "no" / "run.npz")


# ---- files that are torn, as a copy may be ----


@pytest.mark.parametrize("part", [0.5, 0.99])
@pytest.mark.parametrize("name", ["run.npz", "study.npz", "particles.json"])
def test_a_file_that_is_cut_short_is_refused_with_its_path(tmp_path, name, part):
    path = tmp_path / name
    SAVED[name](1).save(path)
    content = path.read_bytes()
    path.write_bytes(content[:int(part * len(content))])
    with refused("unreadable-file", name):
        zd.load(path)


@pytest.mark.parametrize("name", ["run.npz", "study.npz"])
def test_missing_arrays_are_named(tmp_path, name):
    """Whole ZIP files that lack some of their members, which a save that stopped in between leaves behind."""
    path = tmp_path / name
    SAVED[name](1).save(path)
    with np.load(path) as file:
        arrays = dict(file)
    for each in set(arrays) - {"zerodrift"}:
        np.savez(path, **{other: array for other, array in arrays.items() if other != each})
        lacking = rf"{name} must contain .*{each.removeprefix('runs.')}\b.* was not written to its end"
        with refused("unreadable-file", lacking):
            zd.load(path)
