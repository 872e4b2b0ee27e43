"""`Lock`: at most one writer of a file or a folder, in all processes and threads."""

from __future__ import annotations

import errno
import importlib
import os
import platform
import threading
import warnings
import weakref
from pathlib import Path
from typing import Any

from ..errors import InUse, NoLocksWarning


def _module(name: str) -> Any:
    """A module of the standard library; None where the system is another one."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


fcntl, msvcrt = map(_module, ("fcntl", "msvcrt"))       # of POSIX, and of Windows

BUSY = (errno.EWOULDBLOCK, errno.EAGAIN, errno.EACCES, errno.EDEADLK)
BEHIND = 2**40              # the byte that is locked on Windows, where locked bytes are not readable
ATTEMPTS = 1000             # to find a lock file in its place: some network file systems number an open file otherwise
MOST = 200                  # bytes of a lock file that are read


class Lock:
    """An exclusive lock by a file, which exists while the lock is held. The system releases the lock of a process that ends.

    Parameters
    ----------
    path : Path
        The lock file. One that a killed process has left is taken over.
    refusal : str
        Sentence of the error, which ends with the process that holds the lock.
    """

    def __init__(self, path: Path, refusal: str) -> None:
        self._path, self._refusal = path, refusal
        self._descriptor: int | None = None

    def __enter__(self) -> Lock:
        """Acquire the lock.

        Raises
        ------
        InUse
            If another process, or another thread, holds it.
        """
        attempt = 0
        while not self._acquired(checks=attempt < ATTEMPTS):
            attempt += 1
        _held.add(self)
        return self

    def _acquired(self, *, checks: bool) -> bool:
        """False where the file was removed by the process that had held the lock: there is to be another file."""
        descriptor = os.open(self._path, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            self._lock(descriptor)
            is_there = not checks or _is_named(descriptor, self._path)
            if is_there:
                os.ftruncate(descriptor, 0)
                os.write(descriptor, _owner().encode()[:MOST])
                self._descriptor = descriptor
        finally:
            if self._descriptor is None:
                os.close(descriptor)
        return is_there

    def _lock(self, descriptor: int) -> None:
        try:
            _lock(descriptor)
        except OSError as error:
            if error.errno in BUSY:
                owner = os.read(descriptor, MOST).decode(errors="replace")
                raise InUse(f"{self._refusal} {owner or 'another process'}") from None
            warnings.warn(f"the file system of {self._path.parent} has no locks ({error}): two processes that write to one place "
                          "are not noticed there", NoLocksWarning, stacklevel=4)

    def __exit__(self, *_: object) -> None:
        """Release the lock, and remove its file."""
        descriptor, self._descriptor = self._descriptor, None
        _held.discard(self)
        if descriptor is None:      # in a process that was forked
            return
        if fcntl is not None and _is_named(descriptor, self._path):     # others that have opened the file find that it has gone
            self._path.unlink(missing_ok=True)
        _unlock(descriptor)
        os.close(descriptor)
        if fcntl is None:
            _remove_unless_open(self._path)

    def forget(self) -> None:
        """Close the file in a process that was forked: the lock stays with its parent, and ends with it."""
        if self._descriptor is not None:
            os.close(self._descriptor)
        self._descriptor = None


_held: weakref.WeakSet[Lock] = weakref.WeakSet()


def _forget_all() -> None:
    for lock in list(_held):
        lock.forget()
    _held.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget_all)


def _owner() -> str:
    return f"process {os.getpid()}, thread {threading.current_thread().name}, on {platform.node()}"


def _is_named(descriptor: int, path: Path) -> bool:
    """Return whether a path refers to the file of an open descriptor."""
    try:
        return os.path.samestat(os.fstat(descriptor), path.stat())
    except FileNotFoundError:
        return False


def _lock(descriptor: int) -> None:
    """Lock an open file, or raise an OSError."""
    if fcntl is not None:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return
    os.lseek(descriptor, BEHIND, os.SEEK_SET)
    try:
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
    finally:
        os.lseek(descriptor, 0, os.SEEK_SET)


def _unlock(descriptor: int) -> None:
    if fcntl is not None:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_UN)
        except OSError:     # of a file system without locks
            return
        return
    os.lseek(descriptor, BEHIND, os.SEEK_SET)
    msvcrt.locking(descriptor, msvcrt.LK_UNLCK, 1)


def _remove_unless_open(path: Path) -> None:
    """On Windows a file that another process has open is not removed: that process holds the lock, or tries to."""
    try:
        path.unlink(missing_ok=True)
    except PermissionError:
        return
