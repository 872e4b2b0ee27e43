"""The core compiled with few of its methods, into one file that is kept in the cache."""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import MappingProxyType

from ..errors import CompilationFailed
from ..symbolics.compile import cache
from .core_files import CoreFiles


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
        with tempfile.TemporaryDirectory() as name:
            here = Path(name)
            files.write(here)
            for file, text in more.items():
                (here / file).write_text(text, encoding="utf-8")
            found = _made([*files.sources, *more], here, [*command, *options], join, product)
        cache.put(key, found)
    return found


def _made(sources: Sequence[str], here: Path, compiling: Sequence[str], join: Sequence[str], product: str) -> bytes:
    def compile_one(number: int) -> str:
        run([*compiling, "-I.", "-c", "-o", f"{number}.o", sources[number]], here)
        return f"{number}.o"

    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        objects = list(pool.map(compile_one, range(len(sources))))
    run([*join, product, *objects], here)
    return (here / product).read_bytes()


def run(line: Sequence[str], here: Path) -> None:
    """Run a command in a folder; the first error that it prints is that of the exception."""
    result = subprocess.run(line, cwd=here, capture_output=True, text=True, check=False)
    if result.returncode:
        told = result.stderr.strip().splitlines() or ["it says nothing"]
        first = next((each for each in told if "error:" in each), told[0])      # warnings may precede it
        raise CompilationFailed(f"{Path(line[0]).name} must compile the core, and failed: {first}")
