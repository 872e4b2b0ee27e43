"""Names of elements: one namespace, so that ``"tie rod.force"`` means one thing."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from .. import _check

ALLOWED = re.compile(r"[A-Za-z0-9_\-]([A-Za-z0-9_\- ]*[A-Za-z0-9_\-])?")


def checked(name: Any, what: str, taken: Iterable[str]) -> str:
    """A name for a new element, if it is one and nothing else has it."""
    if not isinstance(name, str):
        raise TypeError(f"name of a {what} must be a string, not {_check.shown(name)}")
    if not ALLOWED.fullmatch(name):
        raise ValueError(f"name of a {what} must be of letters, digits, blanks inside, '_' and '-', not {name!r}")
    if name in taken:
        raise ValueError(f"name {name!r} is taken: each element of a mechanism has a name of its own")
    return name
