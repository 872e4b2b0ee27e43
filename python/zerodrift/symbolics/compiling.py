"""Shared libraries from C sources, kept from one process to the next.

The cache is a folder of libraries, each named by a hash of what it holds, and of notes that say which of them belongs to a
source, a compiler and its flags. Files are written beside their place and moved there, so that no process sees half of one; a
library that is not what its name says is built anew.
"""

from __future__ import annotations

import ctypes
import json
import os
import platform
import shlex
import shutil
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from .. import _gateway
from .._fingerprint import fingerprint
from ..errors import CacheWarning, CompilationFailed
from ..systems.native import get_include

FLAGS = ("-O3", "-std=c11", "-ffp-contract=off", "-Werror=implicit-function-declaration", "-shared", "-fPIC")
CANDIDATES = ("cc", "gcc", "clang")
DIGITS = 40         # of the fingerprints that name files


def compiler() -> list[str] | None:
    """The command of the C compiler: what `CC` says, or the first there is; None: there is none."""
    given = os.environ.get("CC", "").strip()
    for command in [shlex.split(given)] if given else [[name] for name in CANDIDATES]:
        program = shutil.which(command[0])
        if program:
            return [program, *command[1:]]
    return None


def looked_for() -> str:
    """Where `compiler` looks, for messages."""
    given = os.environ.get("CC", "").strip()
    return f"CC={given}" if given else ", ".join(CANDIDATES)


def library(source: str, progress: Callable[[str], Any] = lambda what: None) -> ctypes.CDLL | None:
    """The library of a C source, compiled where the cache does not have it; None: there is no compiler.

    Raises
    ------
    CompilationFailed
        If the compiler refuses the source.
    """
    command = compiler()
    if command is None:
        return None
    note = _note(source, command)
    digest = read(note, str)
    path = None if digest is None else _intact(f"{digest}.so", digest)
    if path is None:
        progress("compiling")
        digest, path = _build(source, command)
        write(note, digest)
    try:
        return _gateway.load_library(path)
    except OSError:     # from some folders nothing is executed
        return _gateway.load_library(_put(Path(_temporary().name), path.name, path.read_bytes()))


def _note(source: str, command: list[str]) -> str:
    """The name of what the cache says of a source: whatever the library depends on is in it."""
    program = Path(command[0]).resolve()
    stamp = program.stat()
    header = (Path(get_include()) / "zerodrift" / "system.h").read_text()
    return digest_of("library", source, header, command, str(program), stamp.st_size, stamp.st_mtime_ns, FLAGS, sys.platform,
                     platform.machine())


def digest_of(*parts: Any) -> str:
    """A name for the parts, which may be whatever JSON can express."""
    return fingerprint(parts)[:DIGITS]


def _build(source: str, command: list[str]) -> tuple[str, Path]:
    """Compile; the digest of the library, and where it now is."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        path, product = Path(folder) / "system.c", Path(folder) / "system.so"
        path.write_text(source)
        done = subprocess.run([*command, *FLAGS, f"-I{get_include()}", "-o", product.name, path.name, "-lm"], cwd=folder,
                              capture_output=True, text=True, errors="replace", check=False)
        if done.returncode or not product.is_file():
            raise CompilationFailed(_complaint(command, done, source))
        data = product.read_bytes()
    digest = fingerprint(data)[:DIGITS]
    return digest, put(f"{digest}.so", data)


def _complaint(command: list[str], done: subprocess.CompletedProcess[str], source: str) -> str:
    """What the compiler says first, with the line it says it of."""
    said = done.stderr.strip().splitlines()
    first = next((line for line in said if "error" in line), said[-1] if said else f"status {done.returncode}")
    numbers = [int(part) for part in first.split(":")[1:2] if part.isdigit()]
    lines = source.splitlines()
    where = "".join(f"\n  line {n}: {lines[n - 1].strip()}" for n in numbers if n <= len(lines))
    return f"{command[0]} refused the C source: {first}{where}"


# ---- the cache ----


def _chosen() -> Path:
    given = os.environ.get("ZERODRIFT_CACHE")
    if given:
        return Path(os.path.expanduser(given))
    home = Path(os.path.expanduser("~"))    # unlike Path.home() this never fails
    if sys.platform == "darwin":
        base = home / "Library" / "Caches"
    elif os.name == "nt":
        base = Path(os.environ.get("LOCALAPPDATA") or home / "AppData" / "Local")
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache")
    return base / "zerodrift"


def folders() -> list[Path]:
    """Where compiled systems are looked for: what `ZERODRIFT_CACHE` names or the platform's place, and where that cannot be
    written, a folder that lasts as long as this process.
    """
    return [_chosen(), Path(_temporary().name)] if _warned else [_chosen()]


@cache
def _temporary() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory(prefix="zerodrift-", ignore_cleanup_errors=True)


_warned: set[Path] = set()


def put(name: str, data: bytes) -> Path:
    """Write a file of the cache, whole or not at all; where it is."""
    chosen = _chosen()
    if chosen not in _warned:
        try:
            chosen.mkdir(parents=True, exist_ok=True)
            return _put(chosen, name, data)
        except OSError as error:
            _warned.add(chosen)
            warnings.warn(f"compiled systems are not kept: {chosen} cannot be written ({error.strerror})", CacheWarning,
                          stacklevel=2)
    return _put(Path(_temporary().name), name, data)


def _put(folder: Path, name: str, data: bytes) -> Path:
    descriptor, temporary = tempfile.mkstemp(dir=folder)
    with os.fdopen(descriptor, "wb") as file:
        file.write(data)
    os.replace(temporary, folder / name)
    return folder / name


def _intact(name: str, digest: str) -> Path | None:
    """Where a library is that is what it should be."""
    for path in (folder / name for folder in folders()):
        try:
            if fingerprint(path.read_bytes())[:DIGITS] == digest:
                return path
        except OSError:
            continue
    return None


def write(name: str, content: Any) -> None:
    """Keep what JSON can say."""
    put(f"{name}.json", json.dumps({"content": content, "digest": digest_of(content)}).encode())


def read(name: str, kind: type) -> Any:
    """What was kept under that name; None where there is nothing, or what there is is damaged."""
    for folder in folders():
        try:
            kept = json.loads((folder / f"{name}.json").read_bytes())
            content = kept["content"]
            if isinstance(content, kind) and digest_of(content) == kept["digest"]:
                return content
        except (OSError, ValueError, KeyError, TypeError):
            continue
    return None
