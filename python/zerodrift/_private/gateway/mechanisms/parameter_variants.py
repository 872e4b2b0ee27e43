"""Mechanisms that differ in numbers only: the core makes each from its own entries of these tables and assembles it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...core import ffi, lib
from ..base import doubles
from .assembly import HELD
from .plane import PlaneCore, Tables


class Held(NamedTuple):
    """Component of a measure that the start prescribes: a `zd_target`."""

    measure: int
    component: int
    is_rate: bool
    value: float
    role: int = HELD


class Varied:
    """Tables of `count` mechanisms.

    Parameters
    ----------
    moving, drawn : Tables
        In the coordinates of the runs, with all measures; and in absolute coordinates, with the measures held at the start.
        Numbers that vary have `values` (count,).
    count : int
    poses : ndarray (count, bodies, 3)
        Mass centres in the reference configuration. NaN: the caller assembles the mechanism in Python.
    length : ndarray (count,)
        Characteristic length of each, in m.
    held : sequence of Held
    drives : sequence of int
        Relations that prescribe constant speeds, from the coordinates of the start at t = 0.
    starts_are_known : bool
        True if the starts need no assembly.
    """

    def __init__(self, moving: Tables, drawn: Tables, count: int, poses: np.ndarray, length: np.ndarray, held: Sequence[Held],
                 drives: Sequence[int], starts_are_known: bool) -> None:
        self._keep: list[Any] = []
        self.drives = len(drives)
        self.numbers = sum(array.nbytes for array in (poses, length)) // (8 * count)       # that each has, about
        gravity = np.stack([_spread(each, count) for each in moving.gravity], axis=1)
        members = {
            "moving": self._tables(moving, count), "drawn": self._tables(drawn, count), "gravity": self._doubles(gravity),
            "length": self._doubles(length), "targets": len(held),
            "target": self._kept(ffi.new("zd_target[]", [tuple(each) for each in held])),
            "drives": len(drives), "drive": self._kept(ffi.new("int[]", list(drives))),
            **({} if starts_are_known else {"poses": self._doubles(poses)})}
        of = self._kept(ffi.new("zd_varied *", members))
        self.c = ffi.new("zd_family *", {"of": of, "make": ffi.addressof(lib, "zd_varied_make"),
                                         "free": ffi.addressof(lib, "zd_varied_free")})

    def start(self, run: int, nq: int, nv: int) -> tuple[np.ndarray, np.ndarray, list[float]] | None:
        """Start of one mechanism, p (nq,) and v (nv,), and its drives; None: it must be assembled in Python."""
        p, v, made = np.zeros(nq), np.zeros(nv), ffi.new("void **")
        found = self.c.make(self.c.of, run, doubles(p, nq, writable=True), doubles(v, nv, writable=True), made)
        places = [lib.zd_varied_place(self.c.of, made[0], drive) for drive in range(self.drives)] if found else []
        self.c.free(made[0])
        return (p, v, places) if found else None

    def _kept(self, what: Any) -> Any:
        self._keep.append(what)
        return what

    def _doubles(self, array: np.ndarray) -> Any:
        array = self._kept(np.ascontiguousarray(array, dtype=float))
        return doubles(array, array.size)

    def _tables(self, tables: Tables, count: int) -> dict[str, Any]:
        """Fields of a `zd_plane_tables`: the entries of all mechanisms, one after the other."""
        written, words = PlaneCore.written_tables(_first(tables))
        self._kept((written, words))
        changes = {"body": _fields(tables.bodies), "joint": _fields(tables.joints), "quantity": _fields(tables.quantities),
                   "term": _coefficients(tables), "relation": _fields(tables.relations), "force": _fields(tables.forces)}
        for name, found in changes.items():
            place = written if name in written else written["elements"]
            place[name] = self._repeated(place[name], count, list(found))
        return written

    def _repeated(self, array: Any, count: int, changes: list[tuple[int, str, int, Any]]) -> Any:
        """C array repeated `count` times, with some of its fields replaced by columns of numbers."""
        size, kind = ffi.sizeof(array), ffi.typeof(array).item
        if not size:
            return array
        self.numbers += size // 8
        many = self._kept(np.tile(np.frombuffer(ffi.buffer(array), np.uint8), (count, 1)))
        for row, field, component, column in changes:
            begin = row * ffi.sizeof(kind) + ffi.offsetof(kind, field) + 8 * component
            many[:, begin:begin + 8] = np.ascontiguousarray(column.values, dtype=float).view(np.uint8).reshape(count, 8)
        return self._kept(ffi.from_buffer(f"{kind.cname}[]", many))


def _spread(number: Any, count: int) -> np.ndarray:
    return np.broadcast_to(getattr(number, "values", number), count)


def _is_column(number: Any) -> bool:
    return hasattr(number, "values")


def _single(number: Any) -> Any:
    """First value of a column; a number is returned unchanged."""
    if isinstance(number, tuple) and not hasattr(number, "_fields"):
        return tuple(map(_single, number))
    return float(number.values[0]) if _is_column(number) else number


def _first(tables: Tables) -> Tables:
    """Tables of the first mechanism."""
    def one(row: Any) -> Any:
        return type(row)(*([_single(each) for each in field] if isinstance(field, list) else _single(field) for field in row))
    first: dict[str, Any] = {name: [one(row) for row in getattr(tables, name)]
                             for name in ("bodies", "joints", "quantities", "relations", "forces", "measures")}
    return tables._replace(gravity=_single(tuple(tables.gravity)), **first)


def _fields(rows: Sequence[Any]) -> Iterator[tuple[int, str, int, Any]]:
    """Varying fields of table entries: index of the entry, name of the field, component, and column of values."""
    for i, row in enumerate(rows):
        for field, value in zip(row._fields, row, strict=True):
            for component, each in enumerate(value if isinstance(value, tuple) else (value,)):
                if _is_column(each):
                    yield i, field, component, each


def _coefficients(tables: Tables) -> Iterator[tuple[int, str, int, Any]]:
    """Varying coefficients of relations and measures, likewise."""
    first = 0
    of_forces = [((), len(force.inputs)) for force in tables.forces]
    of_measures = [(each.coefficients, len(each.reads) + len(each.terms)) for each in tables.measures]
    for coefficients, size in [*((row.coefficients, len(row.quantities)) for row in tables.relations), *of_forces, *of_measures]:
        for i, each in enumerate(coefficients):
            if _is_column(each):
                yield first + i, "coefficient", 0, each
        first += size
