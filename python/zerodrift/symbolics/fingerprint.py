"""A name for a definition, so that what was derived from it once is found again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import sympy
from sympy.core.function import AppliedUndef

from .compiling import digest_of


@cache
def _deriver() -> str:
    """What derives: SymPy's version, and this package as it is."""
    files = sorted(Path(__file__).parent.glob("*.py"))
    return digest_of(sympy.__version__, [file.read_text() for file in files])


def fingerprint(definition: Mapping[str, Any]) -> str | None:
    """A hash of expressions in mappings, sequences and strings; None: it has functions that are not SymPy's, which may change."""
    numbers: dict[Any, int] = {}
    said: list[Any] = []
    try:
        return digest_of(_deriver(), _described(definition, numbers, said), said)
    except LookupError:
        return None


def _described(what: Any, numbers: dict[Any, int], said: list[Any]) -> Any:
    if isinstance(what, sympy.Basic) and not isinstance(what, sympy.MatrixBase):
        return _number(what, numbers, said)
    if isinstance(what, Mapping):
        return [[_described(key, numbers, said), _described(value, numbers, said)] for key, value in what.items()]
    if isinstance(what, sympy.MatrixBase):
        return _described(what.tolist(), numbers, said)
    if isinstance(what, Sequence) and not isinstance(what, str):
        return [_described(each, numbers, said) for each in what]
    return what if isinstance(what, str | int | None) else repr(what)


def _number(e: Any, numbers: dict[Any, int], said: list[Any]) -> int:
    """The number of an expression among all there are, each of which is said once by the numbers of its parts."""
    number = numbers.get(e)
    if number is None:
        if not isinstance(e, AppliedUndef) and not type(e).__module__.startswith("sympy."):
            raise LookupError
        parts = [_number(part, numbers, said) for part in e.args]
        number = numbers[e] = len(numbers)
        name = e.name if isinstance(e, sympy.Symbol) else sympy.srepr(e) if not e.args else type(e).__name__
        said.append([type(e).__name__, name, parts])
    return number
