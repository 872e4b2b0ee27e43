"""`write_atomically`: files that are replaced as a whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import stat
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import checks

if TYPE_CHECKING:
    import numpy as np

AS_WINDOWS = os.name == "nt"        # a file that another process has open is not replaced there
PAUSES = 0.01, 0.1, 1.0             # s, before it is tried again
SUFFIX = ".part"                    # of temporary files


def with_suffix(path: str | Path, suffix: str) -> Path:
    """The path, with the suffix added where it is missing."""
    path = Path(path)
    return path if path.suffix == suffix else path.with_name(path.name + suffix)


def write_arrays(path: str | Path, arrays: Mapping[str, np.ndarray], save: Callable[..., None]) -> None:
    """Write arrays by name to an NPZ file as `write_atomically` does; `save` is `numpy.savez` or `numpy.savez_compressed`."""
    write_atomically(path, lambda file: save(file, **arrays))


def write_atomically(path: str | Path, write: Callable[[Any], Any]) -> None:
    """Write a file beside its place, sync it to the disk, and rename it.

    An older file stays as it was if writing fails, and if the process or the machine stops meanwhile. Its permissions are kept.
    A symbolic link stays one, and the file that it leads to is replaced. Devices and pipes are written directly.

    Parameters
    ----------
    path : str or Path
    write : callable
        Called with a binary file.

    Raises
    ------
    OSError
        If the file cannot be written. The older one is unchanged then.
    """
    path = Path(path)
    if path.exists() and not path.is_file():
        with path.open("wb") as file:
            write(file)
        return
    target = Path(os.path.realpath(path))
    mode = _mode(target, path)
    temporary = temporary_beside(target)
    try:
        _write_new(temporary, write, path)
        if mode is not None:
            with contextlib.suppress(OSError):
                temporary.chmod(mode)
        replace(temporary, target)
        sync_folder(target.parent)
    except BaseException as error:
        if mode is not None:
            checks.tell(error, f"{path} is as it was")
        raise
    finally:
        temporary.unlink(missing_ok=True)


def _mode(target: Path, path: Path) -> int | None:
    """Permissions of the older file; None: there is none. One that is protected is refused, as open() refuses it."""
    try:
        mode = stat.S_IMODE(target.stat().st_mode)
    except FileNotFoundError:
        return None
    if not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
    return mode


def _write_new(temporary: Path, write: Callable[[Any], Any], path: Path) -> None:
    """The file under its temporary name; an error that it cannot be made names its place."""
    try:
        file = temporary.open("xb")
    except OSError as error:
        raise type(error)(error.errno, error.strerror, str(path)) from None
    with file:
        write(file)
        file.flush()
        os.fsync(file.fileno())


def is_temporary(path: Path) -> bool:
    """Return whether a file has the name of a temporary file of `write_atomically`."""
    return re.fullmatch(rf"\.[0-9a-f]{{16}}\{SUFFIX}", path.name) is not None


def sweep(folder: Path) -> None:
    """Remove what killed processes left of files that they wrote to a folder, to which no process writes now."""
    for path in folder.iterdir():
        if is_temporary(path):
            path.unlink(missing_ok=True)


def temporary_beside(path: Path) -> Path:
    """A new name in the folder of a file."""
    return path.with_name(f".{os.urandom(8).hex()}{SUFFIX}")


def replace(temporary: Path, target: Path) -> None:
    """Rename a file; on Windows, where other processes and virus scanners may have it open, again after a while."""
    for pause in PAUSES if AS_WINDOWS else ():
        try:
            return os.replace(temporary, target)
        except PermissionError:
            time.sleep(pause)
    return os.replace(temporary, target)


def sync_folder(folder: Path) -> None:
    """Sync the names in a folder to the disk, where the file system does that."""
    if AS_WINDOWS:
        return
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
