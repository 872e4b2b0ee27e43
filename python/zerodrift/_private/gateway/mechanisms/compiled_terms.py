"""Systems of mechanisms whose functions were written out and compiled."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...core import ffi, lib
from ..base import TERMS, doubles
from .core import MechanismCore


class WrittenTerms(NamedTuple):
    """Compiled function of terms: its address, the terms, and the number of doubles that it stores."""

    address: int
    provides: list[str]
    timeless: bool
    scratch: int


def with_functions(core: MechanismCore, numbers: np.ndarray, keep: Any, *, terms: WrittenTerms | None = None,
                   closed_forms: Any = None, jacobian: int | None = None,
                   series: int | None = None) -> MechanismCore:
    """Copy of the system with these terms and closed-form functions; measures are evaluated as before.

    The `data` of the functions begins with a pointer to `numbers`; `closed_forms` is an array of `zd_closed_form`, or the address
    of one, `jacobian` that of a `zd_jacobian`, `series` that of a `zd_series`. What is None stays.
    """
    mine = core._with_data(ffi.NULL, doubles(numbers, numbers.size))
    if terms is not None:
        mine.c.evaluate, mine.c.scratch = ffi.cast("zd_evaluate *", terms.address), terms.scratch
        mine.c.operations = ffi.NULL        # these read what the interpreted terms leave in the scratch
        mine.c.provides = sum(TERMS[name].bit for name in terms.provides) | (lib.ZD_TIMELESS if terms.timeless else 0)
        mine.provides, mine.timeless = mine.c.provides & ~lib.ZD_TIMELESS, terms.timeless
        mine._has_written_terms = True
    if closed_forms is not None:
        mine.c.closed_forms = 1 if isinstance(closed_forms, int) else len(closed_forms)
        mine.c.closed_form = ffi.cast("const zd_closed_form *", closed_forms)
    if jacobian is not None:
        mine.c.jacobian = ffi.cast("const zd_jacobian *", jacobian)
    if series is not None:
        mine.c.series = ffi.cast("const zd_series *", series)
    mine._data = (*mine._data, keep)
    return mine
