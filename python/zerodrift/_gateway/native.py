"""Systems whose evaluation is compiled code: the core calls it directly, and Python is not involved."""

from __future__ import annotations

import ctypes
import hashlib
import shutil
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from .._core import ffi
from .base import TERMS, doubles
from .systems import CoreSystem

FAILURE = ffi.new("char[]", b"the native function reported a failure")


class NativeCore(CoreSystem):
    """A system whose terms the function at `address`, a `zd_evaluate`, computes.

    Its sizes are (nq, nv, mh, mn), its terms those named; it is handed `data`, and `scratch` doubles to keep what it likes.
    What must live as long as the system goes into `keep`.
    """

    def __init__(self, sizes: tuple[int, int, int, int], names: Iterable[str], address: int, data: np.ndarray | None, *,
                 scratch: int = 0, keep: Any = None) -> None:
        system = ffi.new("zd_system *")
        system.nq, system.nv, system.mh, system.mn = sizes
        for name in names:
            system.provides |= TERMS[name][0]
        system.scratch, system.failure = scratch, FAILURE
        system.evaluate = ffi.cast("zd_evaluate *", address)
        memory = None if data is None else doubles(data, data.size)
        system.data = ffi.NULL if memory is None else memory
        super().__init__(system, (memory, keep))


_loaded: dict[Path, str] = {}     # digest of what each path held when it was loaded from there


def load_library(path: str | Path) -> ctypes.CDLL:
    """A shared library as it is on disk now.

    The system's loader gives back what it loaded before from the same path, whatever the file holds meanwhile: a file that has
    changed since is loaded from a copy.
    """
    path = Path(path).resolve()
    digest = digest_of(path)
    if _loaded.setdefault(path, digest) == digest:
        return ctypes.CDLL(str(path))
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        return ctypes.CDLL(shutil.copy(path, Path(folder) / f"{digest[:16]}-{path.name}"))


def digest_of(path: Path) -> str:
    """What a file holds, as a hash."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def address_of(library: ctypes.CDLL, symbol: str) -> int:
    """Where a symbol of a library is; ValueError where there is none."""
    return ctypes.addressof(ctypes.c_char.in_dll(library, symbol))
