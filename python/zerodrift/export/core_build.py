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

from ..errors import CompilationFailed
from ..symbolics.compile import cache
from ..symbolics.progress_message import Progress
from .core_files import CoreFiles, included

EVERY = 5.0         # s between messages
LATEST = 1000       # objects that are kept


def compiled(files: CoreFiles, command: Sequence[str], options: Sequence[str], *, join: Sequence[str], product: str,
             more: Mapping[str, str] = MappingProxyType({})) -> bytes:
    """Product of the sources of a core, and of `more` by their names: compiled with `options`, and joined by the command `join`,
    whose next words are the product and the objects.

    Raises
    ------
    CompilationFailed
        With the first error of the compiler.
    """
    key = f"core-{cache.digest_of(list(command), list(options), list(join), files.texts, dict(more))}"
    found = cache.get(key)
    if found is None:
        with tempfile.TemporaryDirectory() as name, Progress("core", shown=True) as say:
            here = Path(name)
            files.write(here)
            for file, text in more.items():
                (here / file).write_text(text, encoding="utf-8")
            objects = _objects(_digests(files, more), here, [*command, *options], say)
            say("joining objects" + (", with the C library of zig, which it compiles once" if "zig" in join[0] else ""))
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


def _objects(sources: Mapping[str, str], here: Path, compiling: Sequence[str], say: Progress) -> list[str]:
    """Names of the objects of sources, by their digests; those of earlier cores are taken from the cache, where all are kept."""
    pack = f"objects-{cache.digest_of(list(compiling))}"
    known = _unpacked(cache.get(pack))
    names = {path: f"{number}.o" for number, path in enumerate(sources)}
    missing = [path for path, digest in sources.items() if digest not in known]
    for path in sources.keys() - {*missing}:
        (here / names[path]).write_bytes(known[sources[path]])
    said = time.monotonic()
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        made = [pool.submit(run, [*compiling, "-I.", "-c", "-o", names[path], path], here) for path in missing]
        for count, one in enumerate(as_completed(made)):
            one.result()
            if not count or time.monotonic() - said > EVERY:
                said = time.monotonic()
                say(f"compiling {len(missing)} files with {Path(compiling[0]).name}, once; {count + 1} are done")
    if missing:
        cache.put(pack, _packed({**known, **{sources[path]: (here / names[path]).read_bytes() for path in missing}}))
    return list(names.values())


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
        told = result.stderr.strip().splitlines() or ["it says nothing"]
        first = next((each for each in told if "error:" in each), told[0])      # warnings may precede it
        raise CompilationFailed(f"{Path(line[0]).name} must compile the core, and failed: {first}")
