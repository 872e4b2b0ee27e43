"""Fingerprints: hashes that tell whether something is still what it was.

The build of the core runs this file alone, before the package exists, so it imports the standard library only.
"""

from __future__ import annotations

import hashlib
import os
import re
from typing import Any

COMMENT = re.compile(rb"/\*.*?\*/|//[^\n]*", re.DOTALL)
# Structures and enumerations, nested ones up to the brace in the first column
STRUCTURE = re.compile(rb"^(?:typedef )?(?:struct|enum|union)\b[^;(){}]*\{(?:[^{}]*\}|.*?^\})[^;]*;", re.DOTALL | re.MULTILINE)
STATEMENT = re.compile(rb"[^;{}]+")


def fingerprint(*parts: Any) -> str:
    """The SHA-256 in hexadecimal digits of the parts, one after the other: bytes, or whatever JSON can express."""
    import json  # slow to import, and not needed for sources

    digest = hashlib.sha256()
    for part in parts:
        digest.update(part if isinstance(part, bytes) else json.dumps(part).encode())
    return digest.hexdigest()


def core_fingerprint(root: str | os.PathLike[str]) -> str:
    """The fingerprint of all that the core in the source tree at `root` is compiled from, the compiler's flags included."""
    root = os.fspath(root)
    digest = hashlib.sha256()
    for path in [*_sources(root), os.path.join(root, "python", "build_core.py")]:
        content = _read(path)
        digest.update(f"{path[len(root):].replace(os.sep, '/')} {len(content)} ".encode() + content)
    return digest.hexdigest()


def layout_fingerprint(root: str | os.PathLike[str]) -> str:
    """The fingerprint of the memory of a run: structures, enumerations and what takes an arena, without what computes."""
    digested: list[bytes] = []
    for path in _sources(os.fspath(root)):
        code = COMMENT.sub(b"", _read(path))
        digested += STRUCTURE.findall(code)
        digested += [each for each in STATEMENT.findall(code) if b"arena" in each]
    return fingerprint(*(b" ".join(each.split()) for each in digested))


def _sources(root: str) -> list[str]:
    return sorted(os.path.join(folder, name) for folder, _, names in os.walk(os.path.join(root, "csrc")) for name in names
                  if name.endswith((".c", ".h")))


def _read(path: str) -> bytes:
    with open(path, "rb") as file:     # at each import: pathlib takes longer
        return file.read()
