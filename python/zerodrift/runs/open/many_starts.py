"""Starts of many open runs by values of measures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..._private import checks
from ...errors import WrongType, WrongValue
from .beginning import Prepared


def assembled(ready: list[Prepared], start: Any) -> list[tuple[Any, Any]]:
    """States of runs with values of measures; those of one system are assembled together."""
    count = len(ready)
    if not isinstance(start, Mapping) or any(not hasattr(each.of, "_assembled_each") for each in ready):
        raise WrongType(f"start must be a dict of values by measure, of a mechanism, not {checks.shown(start)}")
    values: list[dict[str, Any]] = [{} for _ in ready]
    for measure, given in start.items():
        name: str = getattr(measure, "name", str(measure))
        size = ready[0].of._watching.size(name) if ready else 1
        array = checks.real(f"start[{name!r}] must hold", given).astype(float)
        if array.size not in (size, size * count):
            raise WrongValue(f"start[{name!r}] must have {size} components, for each of {count} runs or for all, not shape "
                             f"{array.shape}", "shape")
        each = array.reshape(-1, size)
        for i, mine in enumerate(values):
            row = each[i if len(each) == count else 0]
            mine[name] = float(row[0]) if size == 1 else row
    found: list[Any] = [None] * count
    for of in {id(each.of): each.of for each in ready}.values():
        own = [i for i, each in enumerate(ready) if each.of is of]
        made = of._assembled_each([values[i] for i in own], ready[own[0]].span[0])    # type: ignore[attr-defined]
        for i, state in zip(own, made, strict=True):
            found[i] = state
    return found
