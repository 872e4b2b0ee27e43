"""Names of constraints, which the core requests for its messages; they are looked up at that time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from weakref import ref

from .._core import ffi
from .base import Variable


class ConstraintNames:
    """Names of the constraints of a system, read from the system while it exists."""

    def __init__(self) -> None:
        self.handle = ffi.new_handle(self)
        self._system: Any = None

    def take_from(self, system: Any) -> None:
        """Take the names from a system's `constraints`, unless names of an equal system are set."""
        if self._system is None or self._system() is None:
            self._system = ref(system)

    def of(self, row: int) -> str:
        """Name of a constraint; empty if it is only its index."""
        system = self._system and self._system()
        names: Sequence[Variable] = system.constraints if system is not None else ()
        name = names[row].name if row < len(names) else ""
        return "" if name == f"constraint{row}" else name


@ffi.def_extern()
def zd_name_row_in_python(names, row, to, size):
    name = ffi.from_handle(names).of(row).encode()[: size - 1].decode(errors="ignore").encode()
    ffi.memmove(to, name + b"\0", len(name) + 1)
