"""`Structure`: of which bodies a system consists, and which of its constraints join which."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from .. import _check, _gateway

WORDS = {"": 0, "constant": _gateway.CONSTANT, "diagonal": _gateway.DIAGONAL,
         "constant diagonal": _gateway.CONSTANT | _gateway.DIAGONAL}


@dataclass(frozen=True)
class Structure:
    """Of which bodies a system consists, and which of its constraints join which.

    Where it is declared, the core stores and multiplies nothing else of the kinematic matrix A, the mass matrix M and the
    constraint matrix C: A and M block after block, C group after group, each a small row-major matrix whose columns are the
    velocities of the blocks that the group touches. From 41 rows or 301 velocities on, formulations make no dense matrix at all:
    cost and memory follow the blocks. Then bifurcations are not looked for (`simulate`, `on_singular`). Up to 300 velocities
    are taken by implicit integrators, but RATTLE takes any number; and by "independent" where there is a kinematic matrix.

    Parameters
    ----------
    blocks : int or sequence of int or of (int, int)
        For each body, in the order of v, how many velocities it has; with a kinematic matrix, how many coordinates and how many
        velocities. M has no entries between different blocks.
    groups : sequence of (int, sequence of int)
        For each group of constraints, in the order of their rows, how many rows it has, and which blocks these touch: C has no
        entries for others. No group has holonomic and nonholonomic rows.
    mass : str or sequence of str
        What is known of each block of M: "", "constant", "diagonal" (then only its diagonal is stored) or "constant diagonal".
        One word is for all.

    Attributes
    ----------
    nq, nv, m : int
        Coordinates, velocities and rows in all.

    Raises
    ------
    TypeError, ValueError
        If something is no count, a group touches a block that there is not, or not in increasing order.

    Examples
    --------
    Two bodies in the plane, the first held by a pin, both joined by another:

    >>> import zerodrift as zd
    >>> structure = zd.Structure(blocks=[3, 3], groups=[(2, [0]), (2, [0, 1])], mass="diagonal")
    >>> structure.nv, structure.m, structure.size("M"), structure.size("C")
    (6, 4, 6, 18)
    >>> structure.offsets("C")
    (0, 6, 18)
    """

    blocks: Any
    groups: Any = ()
    mass: Any = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "blocks", _blocks(self.blocks))
        object.__setattr__(self, "groups", tuple(_group(i, each, len(self.blocks)) for i, each in enumerate(
            _sequence("groups", self.groups, "of (rows, blocks)"))))
        object.__setattr__(self, "mass", _words(self.mass, len(self.blocks)))

    @cached_property
    def _packing(self) -> _gateway.Packing:
        sizes = zip(self.blocks, self.mass, strict=True)
        return _gateway.Packing([(p, v, WORDS[word]) for (p, v), word in sizes], self.groups)

    nq = property(lambda self: self._packing.shapes["A"][0])
    nv = property(lambda self: self._packing.shapes["A"][1])
    m = property(lambda self: self._packing.shapes["C"][0])

    def size(self, term: str) -> int:
        """How many entries are stored of "A", "M" or "C"."""
        return self._packing.size(_check.choice("term", term, _gateway.PACKED))

    def offsets(self, term: str) -> tuple[int, ...]:
        """Where, of what is stored of "A", "M" or "C", the matrix of each block or group begins; and the end."""
        return self._packing.offsets[_check.choice("term", term, _gateway.PACKED)]

    def places(self, term: str) -> list[int]:
        """Where, in the dense matrix "A", "M" or "C" row by row, each stored entry stands."""
        return self._packing.places(_check.choice("term", term, _gateway.PACKED))

    def expand(self, term: str, packed: Any) -> np.ndarray:
        """The dense matrix "A" (nq, nv), "M" (nv, nv) or "C" (m, nv) of what is stored of it."""
        return self._packing.expand(term, _check.vector("packed", packed, self.size(term)))

    def pack(self, term: str, dense: Any) -> np.ndarray:
        """What is stored of a dense matrix "A", "M" or "C"; ValueError where it has an entry that no block or group has."""
        self.size(term)
        given = _check.real("dense must be", dense).astype(float)
        if given.shape != self._packing.shapes[term]:
            raise ValueError(f"dense must be of shape {self._packing.shapes[term]}, not {given.shape}")
        try:
            return self._packing.pack(term, given)
        except ValueError as error:
            raise ValueError(f"{term}{error}") from None


def of_core(core: _gateway.CoreSystem) -> Structure | None:
    """The structure that a system of the core has."""
    packing = core.packing
    if packing is None:
        return None
    words = {bits: word for word, bits in WORDS.items()}
    return Structure([(p, v) for p, v, _ in packing.blocks], packing.groups, [words[bits] for *_, bits in packing.blocks])


def checked(structure: Any, sizes: tuple[int, int, int, int], has_A: bool) -> _gateway.Packing | None:
    """What the gateway knows a structure by, where it fits a system of these sizes (nq, nv, mh, mn)."""
    if structure is None:
        return None
    _check.instance("structure", structure, Structure, "a zd.Structure")
    nq, nv, mh, mn = sizes
    for what, there, has in (("coordinates", structure.nq, nq), ("velocities", structure.nv, nv),
                             ("constraints", structure.m, mh + mn)):
        if there != has:
            raise ValueError(f"structure has {there} {what} in its {'groups' if what == 'constraints' else 'blocks'}, and the "
                             f"system has {has}")
    for b, (p, v) in enumerate(structure.blocks):
        if p != v and not has_A:
            raise ValueError(f"structure: block {b} has {p} coordinates and {v} velocities: then a kinematic matrix is needed")
    ends = np.cumsum([0, *(rows for rows, _ in structure.groups)])
    if mh not in ends:
        g = int(np.searchsorted(ends, mh)) - 1
        raise ValueError(f"structure: group {g} has rows {ends[g]} to {ends[g + 1] - 1}, of which the first {mh} are holonomic; "
                         "it has to be of one kind")
    return structure._packing


def _sequence(name: str, given: Any, of: str) -> Sequence[Any]:
    if isinstance(given, str) or not isinstance(given, Sequence | np.ndarray):
        raise TypeError(f"{name} must be a sequence {of}, not {_check.shown(given)}")
    return given


def _blocks(given: Any) -> tuple[tuple[int, int], ...]:
    listed = _sequence("blocks", given, "of counts, or of (coordinates, velocities)")
    pairs = [each if isinstance(each, Sequence | np.ndarray) and not isinstance(each, str) else (each, each) for each in listed]
    if not pairs:
        raise ValueError("blocks must be at least one")
    for b, pair in enumerate(pairs):
        if len(pair) != 2:
            raise ValueError(f"blocks[{b}] must be a count or (coordinates, velocities), not {_check.shown(listed[b])}")
    return tuple((_check.count(f"blocks[{b}]", p), _check.count(f"blocks[{b}]", v)) for b, (p, v) in enumerate(pairs))


def _group(g: int, given: Any, blocks: int) -> tuple[int, tuple[int, ...]]:
    name = f"groups[{g}]"
    pair = _sequence(name, given, "(rows, blocks)")
    if len(pair) != 2:
        raise ValueError(f"{name} must be (rows, blocks), not {_check.shown(given)}")
    listed = _sequence(f"the blocks of {name}", pair[1], "of indices")
    touched = tuple(_check.count(f"a block of {name}", b, least=0) for b in listed)
    for b in touched:
        if b >= blocks:
            raise ValueError(f"{name} touches block {b}, and there are blocks 0 to {blocks - 1}")
    if not touched or list(touched) != sorted(set(touched)):
        raise ValueError(f"{name} must touch at least one block, in increasing order, not {_check.shown(pair[1])}")
    return _check.count(f"the rows of {name}", pair[0]), touched


def _words(given: Any, blocks: int) -> tuple[str, ...]:
    words = (given,) * blocks if isinstance(given, str) else tuple(_sequence("mass", given, "of words"))
    if len(words) != blocks:
        raise ValueError(f"mass must be one word, or {blocks}, one for each block, not {len(words)}")
    return tuple(_check.choice("mass", word, WORDS) for word in words)
