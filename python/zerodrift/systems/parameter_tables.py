"""Number tables of many systems that differ only in parameters; the core makes their runs without Python."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from .._private.gateway import CoreSystem
from ..errors import described


class NumberTables(NamedTuple):
    """k systems."""

    core: CoreSystem                # whose functions all of them have
    data: np.ndarray | None         # (k, size): parameters passed to its functions; None: the core's own
    size: int                       # of that, in doubles; 0: it consists of something else
    p0: np.ndarray | None           # (k, nq) or (nq,): their starts; None: they have none
    v0: np.ndarray | None           # (k, nv) or (nv,)
    refused: dict[int, str]         # why some of them cannot be
    family: Any = None              # the core's own way to make each, and to find its start where p0 is None; None: there is none


def refusals(make: Callable[..., Any], parameters: Mapping[str, np.ndarray], wrong: np.ndarray) -> dict[int, str]:
    """Error messages for the runs that are marked as suspicious (k,), from making their systems individually, by run."""
    refused = {}
    for run in np.flatnonzero(wrong).tolist():
        try:
            make({name: each[run].item() if each.ndim == 1 else np.array(each[run]) for name, each in parameters.items()})
        except Exception as error:      # a user's parameters may be refused by anything
            refused[run] = described(error)
    return refused


def not_finite(parameters: Mapping[str, np.ndarray], count: int) -> np.ndarray:
    """Flags of the runs that have a parameter that is not finite (count,)."""
    wrong = np.zeros(count, dtype=bool)
    for each in parameters.values():
        wrong |= ~np.isfinite(each).reshape(count, -1).all(axis=1)
    return wrong
