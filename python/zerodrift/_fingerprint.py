"""Fingerprints: hashes that tell whether something is still what it was.

The build of the core runs this file by itself, before there is a package, so it imports the standard library only.
"""

from __future__ import annotations

import hashlib
import os
from typing import Any


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
    sources = sorted(os.path.join(folder, name) for folder, _, names in os.walk(os.path.join(root, "csrc")) for name in names
                     if name.endswith((".c", ".h")))
    digest = hashlib.sha256()
    for path in [*sources, os.path.join(root, "python", "build_core.py")]:      # read at each import: pathlib takes longer
        with open(path, "rb") as file:
            content = file.read()
        digest.update(f"{path[len(root):].replace(os.sep, '/')} {len(content)} ".encode() + content)
    return digest.hexdigest()
