"""Free memory and free disk space, checked against the size of a record before the run starts."""

from __future__ import annotations

import contextlib
import ctypes
import os
import shutil
import sys
import warnings
from pathlib import Path

from ...errors import CostWarning, NoMemory, NoSpace

CONTROL = Path("/sys/fs/cgroup")        # where Linux limits the memory of containers


def check_memory(rows: int, row: int, stacklevel: int) -> None:
    """Raise MemoryError if `rows` samples of `row` bytes exceed the free memory; warn if they take more than half of it."""
    if (free := free_memory()) is None:
        return
    sentence = (f"{rows} samples take {in_words(rows * row)}, and {in_words(free)} of memory are free: save fewer with "
                "save_every or t_eval, or write them to a file with save_to")
    if rows * row > free:
        raise NoMemory(sentence)
    if rows * row > free / 2:
        warnings.warn(sentence, CostWarning, stacklevel=stacklevel + 1)


def check_disk(rows: int | None, row: int, folder: Path) -> None:
    """Raise OSError if `rows` samples of `row` bytes exceed the free disk space; None: their number is not known in advance."""
    free = free_disk(folder)
    if rows is not None and rows * row > free:
        raise NoSpace(f"{rows} samples take {in_words(rows * row)}, and {in_words(free)} are free in {folder}: save fewer "
                      "with save_every or t_eval")


def free_disk(folder: Path) -> int:
    """Free bytes on the disk of a folder; if it does not exist yet, of its nearest existing parent."""
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    return shutil.disk_usage(folder).free


def free_memory() -> int | None:
    """Bytes that this process can still allocate: the least of what machine, process limit and container limit leave."""
    known = [size for size in (_available(), _left_to_process(), _left_to_container()) if size is not None]
    return min(known, default=None)


class _MemoryStatus(ctypes.Structure):
    """MEMORYSTATUSEX of Windows: sizes of physical and virtual memory in bytes."""

    _fields_ = [("size", ctypes.c_uint32), ("percent_taken", ctypes.c_uint32)] + [(name, ctypes.c_uint64) for name in (
        "memory", "free_memory", "with_page_file", "free_with_page_file", "addresses", "free_addresses", "extended")]


def _available() -> int | None:
    """Free memory of the machine in bytes; None if unknown."""
    if sys.platform == "win32":
        status = _MemoryStatus(ctypes.sizeof(_MemoryStatus))
        known = ctypes.windll.kernel32.GlobalMemoryStatusEx(ctypes.byref(status))
        return min(status.free_memory, status.free_with_page_file) if known else None
    with contextlib.suppress(OSError, ValueError, IndexError):
        for line in Path("/proc/meminfo").read_text().splitlines():
            if line.startswith("MemAvailable:"):
                return 1024 * int(line.split()[1])
    return None


def _left_to_process() -> int | None:
    """Bytes left below the memory limits of the process; None if there are none."""
    with contextlib.suppress(ImportError, OSError, ValueError):
        import resource  # not on Windows

        pages = Path("/proc/self/statm").read_text().split()
        limits = {pages[0]: resource.RLIMIT_AS, pages[5]: resource.RLIMIT_DATA}
        left = [resource.getrlimit(limit)[0] - int(taken) * os.sysconf("SC_PAGE_SIZE") for taken, limit in limits.items()
                if resource.getrlimit(limit)[0] != resource.RLIM_INFINITY]
        return max(0, min(left)) if left else None
    return None


def _left_to_container() -> int | None:
    """Bytes left below the memory limit of the container; None if there is none ("max")."""
    with contextlib.suppress(OSError, ValueError):
        limit, taken = ((CONTROL / name).read_text() for name in ("memory.max", "memory.current"))
        return max(0, int(limit) - int(taken))
    return None


def in_words(size: int) -> str:
    """A size in bytes as text, such as "14.4 GB"."""
    for unit, least in (("TB", 1e12), ("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if size >= least:
            return f"{size / least:.3g} {unit}"
    return f"{size} bytes"
