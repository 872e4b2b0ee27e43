"""Compile cache: a folder on disk with derived terms and compiled libraries, shared by processes.

Its content is executed, so it is trusted only if no user except its owner and root can have written it. The folder is opened
first, then its owner and permissions are checked, and files are opened relative to its descriptor: another user who can rename a
parent folder, or change a symbolic link to it, cannot exchange the folder after the check. Files are checked in the same way.
Write access by access control lists shows in the permissions of the group. A folder that other users can change is not used;
results of this process then stay in its memory.

On Windows owner and permissions are not checked, and files are opened by path: the default folder is private to the user there.
If ZERODRIFT_CACHE names another folder, its permissions must be set by the user.

Files are written under a temporary name and renamed, so that other processes never read part of a file. A digest binds the
content of a file to its name; damaged files are written again.
"""

from __future__ import annotations

import json
import os
import re
import secrets
import stat
import sys
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple

from ..._private.fingerprint import fingerprint
from ...errors import CacheWarning

DIGITS = 40             # of the fingerprints that name files
OLD = 3600.0            # s: age from which a temporary file counts as abandoned
TEMPORARY = re.compile(r"\.zerodrift-[0-9a-f]{16}\.tmp")
OTHERS_WRITE = stat.S_IWGRP | stat.S_IWOTH
AS_WINDOWS = os.name == "nt"        # nothing is reached through an open folder there, and its owners are not these
OPENED = "/proc/self/fd"            # where there are paths to what is open
FOLDER = getattr(os, "O_DIRECTORY", 0) | getattr(os, "O_CLOEXEC", 0)
FILE = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0)

_memory: dict[str, bytes] = {}      # what could not be kept elsewhere
_said: set[str] = set()             # warnings, each once


def digest_of(*parts: Any) -> str:
    """Hash of the parts, which may be any JSON values."""
    return fingerprint(parts)[:DIGITS]


# ---- files of any content ----


def put(name: str, data: bytes) -> None:
    """Store a file atomically; if the folder cannot be used, store it in memory for this process."""
    try:
        with _usable(create=True) as folder:
            if folder is not None:
                folder.sweep()
                folder.write(name, data)
                return
    except OSError as error:
        if not name.endswith(".json"):      # which are derived anew in a fraction of a second
            _say(f"compiled systems are not kept: {_chosen()} cannot be written ({error.strerror}). Give it space and write "
                 "permission, or let ZERODRIFT_CACHE name another folder")
    _memory[name] = data


def get(name: str) -> bytes | None:
    """Content of a file; None if there is no trusted file of that name."""
    if name in _memory:
        return _memory[name]
    with _usable() as folder:
        return None if folder is None else folder.read(name)


def drop(name: str) -> None:
    """Remove a file from the cache."""
    _memory.pop(name, None)
    with _usable() as folder:
        if folder is not None:
            folder.remove(name)


@contextmanager
def place(name: str, data: bytes) -> Iterator[str | None]:
    """Path under which the system's loader finds the verified file, if its content is `content`; otherwise None."""
    with _usable() as folder:
        where = folder and folder.seen_by_loader()
        yield f"{where}/{name}" if folder and where and folder.read(name) == data else None


# ---- what JSON can say ----


def write(name: str, content: Any) -> None:
    """Store an object as JSON."""
    put(f"{name}.json", json.dumps({"content": content, "digest": digest_of(name, content)}).encode())


def read(name: str, kind: type) -> Any:
    """Stored object of that name; None if it is missing or damaged."""
    try:
        kept = json.loads(get(f"{name}.json") or b"")
        content = kept["content"]
        return content if isinstance(content, kind) and digest_of(name, content) == kept["digest"] else None
    except (ValueError, KeyError, TypeError):
        return None


# ---- which folder ----


def _chosen() -> Path:
    """Folder that `ZERODRIFT_CACHE` names, or the default folder of the platform."""
    given = os.environ.get("ZERODRIFT_CACHE")
    return Path(os.path.expanduser(given)) if given else _own()


def _own() -> Path:
    home = Path(os.path.expanduser("~"))    # unlike Path.home() this never fails
    if sys.platform == "darwin":
        base = home / "Library" / "Caches"
    elif AS_WINDOWS:
        base = Path(os.environ.get("LOCALAPPDATA") or home / "AppData" / "Local")
    else:
        said = os.environ.get("XDG_CACHE_HOME", "")
        base = Path(said) if os.path.isabs(said) else home / ".cache"
    return base / "zerodrift"


@contextmanager
def _usable(*, create: bool = False) -> Iterator[Folder | None]:
    """The opened folder if it is trusted; None if it is missing, or, with a warning, if it is not trusted. `create` makes it."""
    path = _chosen()
    if str(path).startswith("~"):
        _say(f"compiled systems are not kept: the home folder of {path} is not known. Let ZERODRIFT_CACHE name a folder")
        yield None
        return
    if create:
        _make(path)
    try:
        descriptor = None if AS_WINDOWS else os.open(path, os.O_RDONLY | FOLDER)
    except OSError:     # which is said when something is to be kept
        if create:
            raise
        yield None
        return
    try:
        yield _trusted(path, descriptor)
    finally:
        if descriptor is not None:
            os.close(descriptor)


def _make(path: Path) -> None:
    """Create a folder and its missing parents, accessible to the user only."""
    if path.is_dir():
        return
    for folder in reversed([path, *(above for above in path.parents if not above.exists())]):
        above = folder.absolute().parent
        if not AS_WINDOWS and os.geteuid() == 0 and above.stat().st_uid != 0:      # such as root in the home of another
            raise PermissionError(0, f"{above} belongs to {_name(above.stat().st_uid)}, in whose folders root makes none")
        with suppress(FileExistsError):
            folder.mkdir(0o700)


def _trusted(path: Path, descriptor: int | None) -> Folder | None:
    """The open folder, if only its owner and root can write to it. Write access of others to the default folder is removed."""
    if descriptor is None:
        return Folder(path, None)
    status = os.fstat(descriptor)
    if path == _own() and status.st_uid == os.geteuid() and status.st_mode & OTHERS_WRITE:
        with suppress(OSError):
            os.fchmod(descriptor, 0o700)
        status = os.fstat(descriptor)
    wrong = distrust(status)
    if not wrong:
        return Folder(path, descriptor)
    mend = "" if status.st_uid not in _believed() else f"make it safe by `chmod go-w {path}`, or "
    _say(f"compiled systems are neither taken from {path} nor kept there: it {wrong}, and its files are executed. "
         f"{mend[:1].upper()}{mend[1:]}{'let' if mend else 'Let'} ZERODRIFT_CACHE name a folder of your own")
    return None


def _believed() -> tuple[int, ...]:
    return os.geteuid(), 0


def distrust(status: os.stat_result) -> str:
    """Reason why another user may have written a file or folder, for messages; "" if only the user and root can have."""
    if AS_WINDOWS:
        return ""
    if status.st_uid not in _believed():
        others = " and ".join(f"not to {_name(user)}" for user in dict.fromkeys(_believed()))
        return f"belongs to {_name(status.st_uid)}, {others}"
    if status.st_mode & OTHERS_WRITE:
        return f"belongs to {_name(status.st_uid)}, but others may write it (mode {stat.S_IMODE(status.st_mode):04o})"
    return ""


def _name(user: int) -> str:
    import pwd  # which Windows has not

    try:
        return f"{pwd.getpwuid(user).pw_name} (uid {user})"
    except KeyError:
        return f"uid {user}"


def _say(sentence: str, about: str = "") -> None:
    """Issue a warning, once per message and process."""
    if (about or sentence) not in _said:
        _said.add(about or sentence)
        warnings.warn(sentence, CacheWarning, stacklevel=_depth())


def _depth() -> int:
    """Number of frames between the caller and the nearest code outside this package."""
    depth, frame = 0, sys._getframe()
    while frame.f_back and frame.f_globals.get("__name__", "").partition(".")[0] in (__package__.partition(".")[0], "contextlib"):
        depth, frame = depth + 1, frame.f_back
    return depth


class Folder(NamedTuple):
    """A folder that was opened and is trusted."""

    path: Path
    descriptor: int | None      # None: files are reached by their paths

    def _at(self, name: str) -> str:
        return name if self.descriptor is not None else str(self.path / name)

    def seen_by_loader(self) -> str | None:
        """Path that refers to this open folder; None if the platform has no such path."""
        if self.descriptor is None:
            return str(self.path)
        return f"{OPENED}/{self.descriptor}" if os.path.isdir(OPENED) else None

    def read(self, name: str) -> bytes | None:
        """Content of a file; its owner and permissions are checked after it is opened. None if it cannot be trusted."""
        try:
            with os.fdopen(os.open(self._at(name), os.O_RDONLY | FILE, dir_fd=self.descriptor), "rb") as file:
                status = os.fstat(file.fileno())
                wrong = distrust(status)
                if not wrong:
                    return file.read() if stat.S_ISREG(status.st_mode) else None
        except OSError:     # it is not there, or a link
            return None
        _say(f"{name} in {self.path} is not used, but made anew: it {wrong}. Remove it if it stays there",
             f"{self.path} {wrong}")
        return None

    def write(self, name: str, data: bytes) -> None:
        """Write a file atomically, with the folder's permissions."""
        temporary = f".zerodrift-{secrets.token_hex(8)}.tmp"
        fresh = os.open(self._at(temporary), os.O_WRONLY | os.O_CREAT | os.O_EXCL | FILE, 0o600, dir_fd=self.descriptor)
        try:
            with os.fdopen(fresh, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(fresh)
                if self.descriptor is not None:
                    os.fchmod(fresh, 0o600 | os.fstat(self.descriptor).st_mode & 0o044)
            os.replace(self._at(temporary), self._at(name), src_dir_fd=self.descriptor, dst_dir_fd=self.descriptor)
        except BaseException as error:
            self.remove(temporary)
            # Windows does not replace a file that a process has open. It usually has the same content, from another process.
            if not (AS_WINDOWS and isinstance(error, PermissionError) and self.read(name) == data):
                raise

    def sweep(self) -> None:
        """Remove the temporary files of processes that ended while they wrote."""
        for name in os.listdir(self.path if self.descriptor is None else self.descriptor):
            with suppress(OSError):     # another process may do the same
                if TEMPORARY.fullmatch(name) and time.time() - self._status(name).st_mtime > OLD:
                    self.remove(name)

    def _status(self, name: str) -> os.stat_result:
        return os.stat(self._at(name), dir_fd=self.descriptor, follow_symlinks=False)

    def remove(self, name: str) -> None:
        """Remove a file; a missing file or missing permission is ignored."""
        with suppress(OSError):
            os.unlink(self._at(name), dir_fd=self.descriptor)
