"""Files of the core that a program with few methods needs: all that its entry points use, found in their text."""

from __future__ import annotations

import functools
import re
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePosixPath

from ..errors import MissingFile

METHODS = "methods.h"       # the lists of the core's tables
ENTRIES = ("block/create.c", "block/settings.c", "block/inputs.c", "simulate.c", "run/create.c", "operations.c")
NAME = re.compile(r"\bzd_\w+")
DEFINITION = re.compile(r"^(?!static|typedef|extern|#)[A-Za-z][\w *]*?\b(zd_\w+)(?:\(|(?:\[\w*\])? = )", re.MULTILINE)
INCLUDE = re.compile(r'^#include "(.+)"', re.MULTILINE)
DECLARATION = re.compile(r"^(?!static)[A-Za-z][^;{}=]*\([^;{}]*\);", re.MULTILINE)
PASTED = re.compile(r"^#define OF\(name\) (\w+)##name$", re.MULTILINE)      # names in text that plane and space share:
SHARED = "of_dimension.h"
COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)


@functools.cache
def folder() -> Path:
    """Folder of the core's sources: in the package, or in the source tree."""
    here = Path(__file__).resolve()
    in_source_tree = here.parents[3] / "csrc"
    found = in_source_tree if in_source_tree.is_dir() else here.parents[1] / "csrc"
    if not (found / METHODS).is_file():
        raise MissingFile(f"the sources of the core must be in {found}: install zerodrift again")
    return found


@functools.cache
def _texts() -> dict[str, str]:
    """Text of each file without comments, by its path."""
    top = folder()
    texts = {path.relative_to(top).as_posix(): COMMENT.sub("", path.read_text(encoding="utf-8")) for path in top.rglob("*.[ch]")
             if "python" not in path.relative_to(top).parts}
    for path, text in texts.items():
        if of := PASTED.search(text):
            names = (name for name in INCLUDE.findall(text) if name.endswith(SHARED))
            shared = (texts[_normal(PurePosixPath(path).parent / name)] for name in names)
            texts[path] += "".join(re.sub(r"\bOF\((\w+)\)", rf"{of[1]}\1", each) for each in shared)
    return texts


@functools.cache
def _definitions() -> dict[str, str]:
    """File in which each function or table is defined."""
    return {name: path for path, text in _texts().items() if path.endswith(".c") for name in DEFINITION.findall(text)}


@functools.cache
def included(path: str) -> frozenset[str]:
    """Headers that a file includes, and those that they include."""
    found, waiting = set[str](), [path]
    while waiting:
        new = _headers(waiting.pop()) - found
        found |= new
        waiting += new
    return frozenset(found)


@functools.cache
def _headers(path: str) -> set[str]:
    """Headers in the lines of a file."""
    names = {name: _normal(PurePosixPath(path).parent / name) for name in INCLUDE.findall(_texts()[path])}
    return {beside if beside in _texts() else name for name, beside in names.items()}


def _normal(path: PurePosixPath) -> str:
    parts: list[str] = []
    for part in path.parts:
        parts = parts[:-1] if part == ".." else [*parts, part]
    return "/".join(parts)


@functools.cache
def _used(path: str) -> frozenset[str]:
    """Names that a source uses, with those in inline functions of the headers it includes, without declarations."""
    return frozenset(NAME.findall(_texts()[path])).union(*map(_used_inline, included(path) - {METHODS}))


@functools.cache
def _used_inline(header: str) -> frozenset[str]:
    """Names in a header, without declarations."""
    return frozenset(NAME.findall(DECLARATION.sub("", _texts()[header])))


class CoreFiles:
    """Core with some of its methods, and mechanisms of some dimensions.

    Parameters
    ----------
    lists : dict of str to sequences of str
        Entries of the lists of ``methods.h`` that are kept, such as ``{"INTEGRATOR": ["zd_rk4"]}``; others are complete.
    entries : sequence of str
        Sources that the program needs.
    """

    def __init__(self, lists: Mapping[str, Iterable[str]], entries: Iterable[str] = ENTRIES) -> None:
        self.lists = {**_lists(), **{name: tuple(kept) for name, kept in lists.items()}}
        self.sources = self._closure(entries)

    def _closure(self, entries: Iterable[str]) -> list[str]:
        tables = {name for kept in self.lists.values() for name in kept}
        defined, found = _definitions(), set()
        waiting = [*entries, *(defined[name] for name in tables)]
        while waiting:
            path = waiting.pop()
            if path not in found:
                found.add(path)
                waiting += [defined[name] for name in _used(path) if name in defined and defined[name] not in found]
        return sorted(found)

    @property
    def methods(self) -> str:
        """Text of ``methods.h`` with these lists."""
        lines = [f"#define ZD_{name}_LIST(X) {' '.join(f'X({entry})' for entry in kept)}".rstrip()
                 for name, kept in self.lists.items()]
        return "\n".join(["/* Entries of the tables of this program. */", "#pragma once", "", *lines, ""])

    @property
    def paths(self) -> list[str]:
        """Sources and headers."""
        return sorted({*self.sources, *(header for source in self.sources for header in included(source))})

    def write(self, to: Path) -> None:
        """Write sources and headers into a folder."""
        for path, text in self.texts.items():
            target = to / path
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")

    @property
    def texts(self) -> dict[str, str]:
        """Text of each file, by its path."""
        return {path: self.methods if path == METHODS else (folder() / path).read_text(encoding="utf-8") for path in self.paths}


@functools.cache
def _lists() -> dict[str, tuple[str, ...]]:
    """Lists of the core's tables."""
    text = _texts()[METHODS].replace("\\\n", " ")
    return {name: tuple(re.findall(r"X\((zd_\w+)\)", entries))
            for name, entries in re.findall(r"^#define ZD_(\w+)_LIST\(X\)(.*)$", text, re.MULTILINE)}


@functools.cache
def _names() -> dict[str, dict[str, str]]:
    """Entries of each list by the name on their card."""
    defined, texts = _definitions(), _texts()
    found: dict[str, dict[str, str]] = {}
    for kind, entries in _lists().items():
        for entry in entries:
            text = texts[defined[entry]]
            card = re.search(rf"\b{entry} = .*?\.name = \"(\w+)\"", text, re.DOTALL)
            if card:
                found.setdefault(kind, {})[card[1]] = entry
    return found


def entry(kind: str, name: str) -> str:
    """Entry of a list, such as ``"INTEGRATOR"``, by the name of the method."""
    return _names()[kind][name]
