"""Places of inputs in the data of a mechanism: in the numbers of its user functions, and in those of generated code."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...core import ffi
from ..base import doubles
from ..inputs import Bound, Place
from .element_tables import law_sizes
from .law_owner import LawOwner, table_of_programs


class WrittenInputs(NamedTuple):
    """Numbers of generated code: which are inputs, and the functions that compute others from them."""

    numbers: np.ndarray
    first: Mapping[str, int]            # of the first number of each input
    derivations: Sequence[int]          # addresses


def bound(core: Any, names: Sequence[str]) -> Bound:
    """The core's system of a mechanism for one run, with the places of its inputs."""
    written, laws, sizes = core.written_inputs, core._law, law_sizes(core.tables)
    owner = LawOwner(laws, sizes)
    found = (ffi.NULL, None) if core._has_written_terms else table_of_programs(laws, sizes)
    numbers, pointer = None, core._numbers
    if written is not None:
        numbers = written.numbers.copy()
        pointer = doubles(numbers, numbers.size)
    mine = core._with_data(ffi.new_handle(owner), pointer, found)
    mine._owner = owner
    places = [*(_of_laws(laws, found[1][0], names) if found[1] else ()), *(_of_code(written, pointer, names) if written else ())]
    derivations = [(address, pointer) for address in written.derivations] if written else []
    return Bound(mine, places, derivations, (owner, numbers, found))


def _of_laws(laws: Any, numbers: Sequence[Any], names: Sequence[str]) -> list[Place]:
    rows = [(row, memory) for row, memory in zip(laws.rows, numbers, strict=False) if memory is not None]
    return list({row.law.input: Place(row.law.input, row.law.is_speed, memory) for row, memory in rows
                 if row.law.input in names}.values())


def _of_code(written: WrittenInputs, pointer: Any, names: Sequence[str]) -> list[Place]:
    return [Place(name, name.endswith(".speed"), pointer + written.first[name]) for name in names]
