"""The core compiled with few of its methods, into one file that is kept in the cache."""

from __future__ import annotations

import io
import os
import subprocess
import tempfile
import time
import zipfile
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ..errors import CompilationFailed
from ..symbolics.compile import cache
from ..symbolics.progress_message import Progress
from .core_files import CoreFiles, included

EVERY = 5.0         # s between messages
LATEST = 1000       # objects that are kept
NOTHING: Mapping[str, Any] = MappingProxyType({})


def compiled(files: CoreFiles, command: Sequence[str], options: Sequence[str], *, join: Sequence[str], product: str,
             more: Mapping[str, str] = NOTHING, libraries: Mapping[str, Sequence[str]] = NOTHING) -> bytes:
    """Product of the sources of a core, and of `more` by their names: compiled with `options`, and joined by the command `join`,
    whose next words are the product, the objects, and `libraries`: files by name, each with the command that writes it.

    Raises
    ------
    CompilationFailed
        With the first error of the compiler.
    """
    key = f"core-{cache.digest_of(list(command), list(options), list(join), files.texts, dict(more), dict(libraries))}"
    found = cache.get(key)
    if found is None:
        with tempfile.TemporaryDirectory() as name, Progress("core", shown=True) as say:
            here = Path(name)
            files.write(here)
            for file, text in more.items():
                (here / file).write_text(text, encoding="utf-8")
            objects = _objects(_digests(files, more), here, [*command, *options], libraries, say)
            whole = "zig" in join[0] and not libraries
            say("joining objects" + (", with the C library of zig, which it compiles once" if whole else ""))
            run([*join, product, *objects], here)
            found = (here / product).read_bytes()
        cache.put(key, found)
    return found


def _digests(files: CoreFiles, more: Mapping[str, str]) -> dict[str, str]:
    """Digest of each source with the headers that it includes; that of `more` with all files."""
    texts = files.texts
    own = {path: {each: texts[each] for each in (path, *included(path))} for path in files.sources}
    own |= {path: {**texts, path: text} for path, text in more.items()}
    return {path: cache.digest_of(path, each) for path, each in own.items()}


def _objects(sources: Mapping[str, str], here: Path, compiling: Sequence[str], libraries: Mapping[str, Sequence[str]],
             say: Progress) -> list[str]:
    """Names of libraries and of the objects of sources, by their digests; those of earlier cores are taken from the cache."""
    pack = f"objects-{cache.digest_of(list(compiling))}"
    known = _unpacked(cache.get(pack))
    commands = {**libraries, **{f"{number}.o": [*compiling, "-I.", "-c", "-o", f"{number}.o", path]
                                for number, path in enumerate(sources)}}
    digests = dict(zip(commands, [*(cache.digest_of(list(each)) for each in libraries.values()), *sources.values()], strict=True))
    missing = [name for name, digest in digests.items() if digest not in known]
    for name in digests.keys() - {*missing}:
        (here / name).write_bytes(known[digests[name]])
    said = time.monotonic()
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        made = [pool.submit(run, commands[name], here) for name in missing]
        for count, one in enumerate(as_completed(made)):
            one.result()
            if not count or time.monotonic() - said > EVERY:
                said = time.monotonic()
                say(f"compiling {len(missing)} files with {Path(compiling[0]).name}, once; {count + 1} are done")
    if missing:
        cache.put(pack, _packed({**known, **{digests[name]: (here / name).read_bytes() for name in missing}}))
    return [*commands]


def _unpacked(pack: bytes | None) -> dict[str, bytes]:
    if pack is None:
        return {}
    with zipfile.ZipFile(io.BytesIO(pack)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def _packed(objects: Mapping[str, bytes]) -> bytes:
    """Archive of the latest objects."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for name, content in list(objects.items())[-LATEST:]:
            archive.writestr(name, content)
    return file.getvalue()


def run(line: Sequence[str], here: Path) -> None:
    """Run a command in a folder; the first error that it prints is that of the exception."""
    result = subprocess.run(line, cwd=here, capture_output=True, text=True, check=False)
    if result.returncode:
        lines = result.stderr.strip().splitlines() or ["no message"]
        first = next((each for each in lines if "error:" in each), lines[0])      # warnings may precede it
        raise CompilationFailed(f"{Path(line[0]).name} must compile the core, and failed: {first}")
