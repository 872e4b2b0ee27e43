"""Fingerprints: hashes that tell whether something is still what it was.

The build of the core runs this file by itself, before there is a package, so it imports the standard library only.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any


def fingerprint(*parts: Any) -> str:
    """The SHA-256 in hexadecimal digits of the parts, one after the other: bytes, or whatever JSON can express."""
    digest = hashlib.sha256()
    for part in parts:
        digest.update(part if isinstance(part, bytes) else json.dumps(part).encode())
    return digest.hexdigest()


def core_fingerprint(root: Path) -> str:
    """The fingerprint of all that the core in the source tree at `root` is compiled from, the compiler's flags included."""
    sources = [*sorted((root / "csrc").rglob("*.[ch]")), root / "python" / "build_core.py"]
    return fingerprint(*(part for path in sources for part in (path.relative_to(root).as_posix(), path.read_bytes())))
