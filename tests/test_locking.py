"""A lock has one holder, and ends with its process."""

import errno
import os
import signal
import subprocess
import sys
import threading

import pytest

import tolerances as tol
import zerodrift as zd
from support import environment_of_tests
from zerodrift._private import locking
from zerodrift._private.locking import Lock

posix = pytest.mark.skipif(os.name == "nt", reason="signals and forks of POSIX")


def test_one_holder_and_no_file_afterwards(tmp_path):
    path = tmp_path / "lock"
    with Lock(path, "held by"):
        with pytest.raises(zd.InUse, match=rf"^held by process {os.getpid()}, thread MainThread, on "), Lock(path, "held by"):
            pass
        assert path.exists()
    assert not path.exists()
    with Lock(path, "held by"):
        pass


def test_many_threads_hold_it_one_after_the_other(tmp_path):
    """A file that is removed as another thread opens it is not a lock: there would be two holders."""
    holders, most, refused = [], [], []

    def work():
        for _ in range(200):
            try:
                with Lock(tmp_path / "lock", "held by"):
                    holders.append(1)
                    most.append(len(holders))
                    holders.pop()
            except zd.InUse:
                refused.append(1)

    threads = [threading.Thread(target=work) for _ in range(8)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert len(most) + len(refused) == 1600
    assert set(most) == {1}
    assert list(tmp_path.iterdir()) == []


HOLDER = """
import os, signal, sys
from pathlib import Path
from zerodrift._private.locking import Lock

with Lock(Path(sys.argv[1]), "held by"):
    if sys.argv[2] == "forked" and os.fork() == 0:
        sys.stdin.read()        # outlives its parent
        os._exit(0)
    os.kill(os.getpid(), signal.SIGKILL)
"""


@posix
@pytest.mark.parametrize("which", ["alone", "forked"])
def test_a_killed_process_holds_nothing(tmp_path, which):
    """Nor do the processes that it has forked, which go on."""
    path = tmp_path / "lock"
    holder = subprocess.Popen([sys.executable, "-c", HOLDER, path, which], stdin=subprocess.PIPE, env=environment_of_tests())
    assert holder.wait() == -signal.SIGKILL
    assert path.exists()
    for _ in range(100 * tol.HUNG):     # until the child has closed what it inherited
        try:
            with Lock(path, "held by"):
                break
        except zd.InUse:
            threading.Event().wait(0.01)
    else:
        pytest.fail("the lock is held by a process that is dead")
    holder.stdin.close()


@posix
def test_a_lock_file_that_the_user_removed_is_not_that_of_the_next(tmp_path):
    path = tmp_path / "lock"
    with Lock(path, "held by"):
        path.unlink()
        second = Lock(path, "held by")
        second.__enter__()
    assert path.exists()
    second.__exit__()


def test_a_file_system_that_numbers_open_files_otherwise(tmp_path, monkeypatch):
    """There a lock file is not recognized in its place, and is taken in the end: the second is refused all the same."""
    monkeypatch.setattr(locking, "_is_named", lambda descriptor, path: False)
    with Lock(tmp_path / "lock", "held by"), pytest.raises(zd.InUse), Lock(tmp_path / "lock", "held by"):
        pass


def test_a_file_system_without_locks_is_reported(tmp_path, monkeypatch):
    def lacks(descriptor):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(locking, "_lock", lacks)
    said = r"has no locks .*No locks available.*two processes.* \[zd:no-locks\]$"
    with pytest.warns(zd.errors.NoLocksWarning, match=said), Lock(tmp_path / "lock", ""):
        pass


@posix
def test_the_calls_of_windows(tmp_path, monkeypatch):
    """As its documentation has them: a byte behind the text is locked, at the place of the file, which is then unlocked."""
    seen = []

    class Windows:
        LK_NBLCK, LK_UNLCK = "lock", "unlock"

        @staticmethod
        def locking(descriptor, what, count):
            seen.append((what, os.lseek(descriptor, 0, os.SEEK_CUR), count))
            if what == "lock" and seen.count(("lock", locking.BEHIND, 1)) > 1:
                raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr(locking, "fcntl", None)
    monkeypatch.setattr(locking, "msvcrt", Windows)
    with Lock(tmp_path / "lock", "held by"):
        content = (tmp_path / "lock").read_text()
        with pytest.raises(zd.InUse, match="held by process"), Lock(tmp_path / "lock", "held by"):
            pass
    assert content.startswith("process ")
    assert len(content) < 200
    assert seen == [("lock", locking.BEHIND, 1)] * 2 + [("unlock", locking.BEHIND, 1)]
    assert not (tmp_path / "lock").exists()
