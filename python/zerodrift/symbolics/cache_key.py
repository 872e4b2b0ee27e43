"""Cache key of a definition: names the file that holds the terms derived from it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import sympy
from sympy.core.function import AppliedUndef

from .compile.cache import digest_of


@cache
def _deriving_code() -> str:
    """Fingerprint of the derivation code: SymPy's version and the files of this package."""
    files = sorted(Path(__file__).parent.rglob("*.py"))
    return digest_of(sympy.__version__, [file.read_text(encoding="utf-8") for file in files])


def fingerprint(definition: Mapping[str, Any]) -> str | None:
    """A hash of expressions in mappings, sequences and strings; None: it has functions that are not SymPy's, which may change."""
    numbers: dict[Any, int] = {}
    table: list[Any] = []
    try:
        return digest_of(_deriving_code(), _as_json(definition, numbers, table), table)
    except LookupError:
        return None


def _as_json(what: Any, numbers: dict[Any, int], table: list[Any]) -> Any:
    if isinstance(what, sympy.Basic) and not isinstance(what, sympy.MatrixBase):
        return _number_of(what, numbers, table)
    if isinstance(what, Mapping):
        return [[_as_json(key, numbers, table), _as_json(value, numbers, table)] for key, value in what.items()]
    if isinstance(what, sympy.MatrixBase):
        return _as_json(what.tolist(), numbers, table)
    if isinstance(what, Sequence) and not isinstance(what, str):
        return [_as_json(each, numbers, table) for each in what]
    return what if isinstance(what, str | int | None) else repr(what)


def _number_of(e: Any, numbers: dict[Any, int], table: list[Any]) -> int:
    """The number of an expression in a table of all expressions, in which each stands once with the numbers of its parts."""
    number = numbers.get(e)
    if number is None:
        if not isinstance(e, AppliedUndef) and not type(e).__module__.startswith("sympy."):
            raise LookupError
        parts = [_number_of(part, numbers, table) for part in e.args]
        number = numbers[e] = len(numbers)
        name = e.name if isinstance(e, sympy.Symbol) else sympy.srepr(e) if not e.args else type(e).__name__
        table.append([type(e).__name__, name, parts])
    return number
