"""Shared libraries from C sources, compiled where the cache does not have them.

The cache has libraries, each named by a hash of what it holds, and notes that say which of them belongs to a source, a compiler
and its flags.
"""

from __future__ import annotations

import ctypes
import os
import platform
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from ..._private import gateway
from ..._private.fingerprint import fingerprint
from ...errors import CompilationFailed
from ...systems.native import get_include
from . import cache, compilers

OPTIMIZED = ("-O3",)
# Functions for one trajectory are one expression after the other, of which a compiler that looks for loops and vectors makes the
# same in a third to two thirds more time. Behind functions of vector units, one of GCC's expensive optimizations clears the upper
# halves of registers; else all that follows them is several times as slow.
QUICKLY = ("-O1", "-fexpensive-optimizations", "-fschedule-insns2")
LARGE_SINES_OF_CORE = "ZD_LARGE_SINES_OF_CORE"      # see zerodrift/sines.h
SYMBOLS = ("zd_symbolic_constants", "zd_symbolic_evaluate")     # of the library of a system's terms
PATIENCE = 1800.0       # s, after which a compiler hangs: the largest sources take some minutes
SOURCE, PRODUCT = "system.c", "system.dll" if cache.AS_WINDOWS else "system.so"
PLACE = re.compile(rf"{re.escape(SOURCE)}[:(](\d+)")     # of what a compiler complains about


def library(source: str, progress: Callable[[str], Any] = lambda what: None,
            symbols: Sequence[str] = SYMBOLS, defined: Sequence[str] = (),
            optimized: Sequence[str] = QUICKLY, meanwhile: Callable[[], Any] = lambda: None) -> ctypes.CDLL | None:
    """The library of a C source with these symbols, compiled where the cache does not have it; None: there is no compiler.

    `defined` are macros, as compilers take them: ``["NAME=value"]``; `optimized` are flags that change no bits; `meanwhile` is
    called while a compiler is at work.

    Raises
    ------
    CompilationFailed
        If `CC` cannot be run, the compiler refuses the source, or what it writes cannot be loaded.
    """
    compiler = compilers.find()
    if compiler is None:
        return None
    symbols = *symbols, gateway.SET_SINES_OF_LARGE
    source = compilers.exporting(source, symbols)
    line = compiler.line(SOURCE, PRODUCT, get_include(), optimized, [LARGE_SINES_OF_CORE, *defined])
    note = _note(source, line)
    found = _kept(note)
    if found is None:
        progress("compiling")
        found = _made(source, line, compiler.environment, note, symbols, meanwhile)
    gateway.set_sines_of_large(found)
    return found


def _note(source: str, line: list[str]) -> str:
    """Name of the cache entry of a source: a hash of all that its library depends on."""
    program = Path(line[0]).resolve()
    stamp = program.stat()
    headers = [path.read_text(encoding="utf-8") for path in sorted((Path(get_include()) / "zerodrift").glob("*.h"))]
    return cache.digest_of("library", source, headers, line, str(program), stamp.st_size, stamp.st_mtime_ns,
                           sys.platform, platform.machine())


def _kept(note: str) -> ctypes.CDLL | None:
    """Library that a cache entry refers to; None if it is missing, altered or made for another system."""
    digest = cache.read(note, str)
    data = None if digest is None else cache.get(f"{digest}.so")
    if data is None or _digest(data) != digest:
        return None
    try:
        return _load(f"{digest}.so", data)
    except OSError:
        return None


def _made(source: str, line: list[str], environment: dict[str, str] | None, note: str, symbols: Sequence[str],
          meanwhile: Callable[[], Any]) -> ctypes.CDLL:
    """Compile a library, load it and store it in the cache."""
    data = _build(source, line, environment, meanwhile)
    digest = _digest(data)
    cache.put(f"{digest}.so", data)     # first: there may be no other place to load it from
    try:
        found = _load(f"{digest}.so", data)
        for symbol in symbols:
            gateway.address_of(found, symbol)
    except (OSError, ValueError) as error:
        cache.drop(f"{digest}.so")
        elsewhere = f"if nothing may be executed in {tempfile.gettempdir()}, let TMPDIR name another folder"
        raise _failure(line, f"wrote a file that cannot be loaded ({error})", f". {compilers.advice()}; {elsewhere}") from None
    cache.write(note, digest)
    return found


def _digest(data: bytes) -> str:
    return fingerprint(data)[: cache.DIGITS]


def _load(name: str, data: bytes) -> ctypes.CDLL:
    """Load a library from its bytes, by a copy in a folder private to this process, else from the cache.

    On Windows a loaded file can neither be changed nor removed, so the file in the cache is loaded there.
    """
    if cache.AS_WINDOWS:
        with cache.place(name, data) as path:
            if path is not None:
                return gateway.load_data(data, path, copied=False)
    try:
        return gateway.load_data(data)
    except OSError:     # from some folders nothing is executed
        with cache.place(name, data) as path:
            if path is None:
                raise
            return gateway.load_data(data, path)


# ---- the compiler ----


def _build(source: str, line: list[str], environment: dict[str, str] | None = None,
           meanwhile: Callable[[], Any] = lambda: None) -> bytes:
    """Compile a source; return the bytes of the library."""
    try:
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
            folder = Path(name)
            (folder / SOURCE).write_text(source, encoding="utf-8")
            status, said = _run(line, folder, environment, meanwhile)
            product = folder / PRODUCT
            if status or not product.is_file():
                raise _complaint(line, status, said, source)
            return product.read_bytes()
    except OSError as error:
        raise CompilationFailed(f"there is no space to compile a symbolic system: {error}. Let TMPDIR name a folder with space "
                                "and write permission") from None


def _run(line: list[str], folder: Path, environment: dict[str, str] | None, meanwhile: Callable[[], Any]) -> tuple[int, str]:
    """Run a command in a folder without input; return its status and output. On a time-out it is ended with all its child
    processes.
    """
    with open(folder / "said", "w+b") as said:
        try:
            process = subprocess.Popen(line, cwd=folder, stdin=subprocess.DEVNULL, stdout=said, stderr=said, env=environment,
                                       start_new_session=True, creationflags=compilers.QUIETLY)
        except OSError as error:
            why = "it, or the program that its first line names, is missing or for another machine"
            raise _failure(line, f"cannot be run ({error.strerror})", f": {why}. {compilers.advice()}") from None
        try:
            meanwhile()
            status = _wait(process)
            if status is None:
                raise _failure(line, f"did not end within {PATIENCE:g} s", f". {compilers.advice()}")
        finally:
            _end(process)
        said.seek(0)
        return status, said.read().decode(errors="replace")


def _wait(process: subprocess.Popen[bytes]) -> int | None:
    """Exit status of a process; None after the time limit. `Popen.wait` with a limit sleeps for 50 ms at a time."""
    waiting = threading.Thread(target=process.wait, daemon=True)
    waiting.start()
    waiting.join(PATIENCE)
    return process.returncode


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a running process and its child processes."""
    if process.poll() is None:
        with suppress(OSError):
            if hasattr(os, "killpg"):
                os.killpg(process.pid, signal.SIGKILL)
            else:       # Windows
                subprocess.run([_taskkill(), "/t", "/f", "/pid", str(process.pid)], capture_output=True, check=False,
                               creationflags=compilers.QUIETLY)
        with suppress(OSError):     # itself at least, where there is no such program
            process.kill()
        process.wait()


def _taskkill() -> str:
    """Path of Windows' `taskkill`, given in full as a bare name would search the current folder first."""
    return os.path.join(os.environ.get("SYSTEMROOT", r"C:\Windows"), "System32", "taskkill.exe")


def _complaint(line: list[str], status: int, said: str, source: str) -> CompilationFailed:
    """Error with the compiler's first complaint and the source line that it refers to."""
    spoken = said.strip().splitlines()
    first = next((each for each in spoken if "error" in each), spoken[-1] if spoken else f"status {status}")
    if not status:
        return _failure(line, f"wrote no library{f': {first}' if spoken else ''}", f". {compilers.advice()}")
    lines = source.splitlines()
    where = "".join(f"\n  line {n}: {lines[n - 1].strip()}" for n in map(int, PLACE.findall(first)[:1]) if 0 < n <= len(lines))
    return _failure(line, f"refused the C source: {first}", where or f". {compilers.advice()}")


def _failure(line: list[str], what: str, advice: str) -> CompilationFailed:
    said = f"CC={compilers.said()}" if compilers.said() else "CC is not set"
    return CompilationFailed(f"{line[0]} {what}; {said}, it was run as `{shlex.join(line)}`{advice}")
