"""The numbers of many systems that differ in their parameters alone: what the core makes their runs from, without Python."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from .._gateway import CoreSystem


class NumberTables(NamedTuple):
    """k systems."""

    core: CoreSystem                # whose functions all of them have
    data: np.ndarray | None         # (k, size): what these are handed; None: the core's own
    size: int                       # of that, in doubles; 0: it consists of something else
    p0: np.ndarray | None           # (k, nq) or (nq,): their starts; None: they have none
    v0: np.ndarray | None           # (k, nv) or (nv,)
    refused: dict[int, str]         # why some of them cannot be
    family: Any = None              # the core's own way to make each, and to find its start where p0 is None; None: there is none


def refusals(make: Callable[..., Any], parameters: Mapping[str, np.ndarray], wrong: np.ndarray) -> dict[int, str]:
    """What the systems of these runs say as they are made one by one, of those whose parameters look wrong (k,)."""
    refused = {}
    for run in np.flatnonzero(wrong).tolist():
        try:
            make({name: each[run].item() if each.ndim == 1 else np.array(each[run]) for name, each in parameters.items()})
        except Exception as error:      # a user's parameters may be refused by anything
            refused[run] = f"{type(error).__name__}: {error}"
    return refused


def not_finite(parameters: Mapping[str, np.ndarray], count: int) -> np.ndarray:
    """Of which of so many runs a parameter is not finite (count,)."""
    wrong = np.zeros(count, dtype=bool)
    for each in parameters.values():
        wrong |= ~np.isfinite(each).reshape(count, -1).all(axis=1)
    return wrong
