"""`Structure`: the block structure of A, M and C by bodies and groups of constraints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._private import checks, gateway
from ..errors import WrongType, WrongValue, sentence

WORDS = {"": 0, "constant": gateway.CONSTANT, "diagonal": gateway.DIAGONAL,
         "constant diagonal": gateway.CONSTANT | gateway.DIAGONAL}


@dataclass(frozen=True)
class Structure:
    """Block structure of a system: its bodies, and the bodies that each group of constraints couples.

    The core then stores and multiplies only these entries of the kinematic matrix A, the mass matrix M and the constraint matrix
    C: A and M block by block, C group by group, each as a small row-major matrix whose columns are the velocities of the blocks
    of the group. From 41 constraints or 301 velocities on, formulations use no dense matrices, so that cost and memory are
    proportional to the blocks; bifurcations are then not detected (`simulate`, `on_singular`). Implicit integrators except RATTLE
    accept up to 300 velocities, and so does "independent" with a kinematic matrix.

    Parameters
    ----------
    blocks : int or sequence of int or of (int, int)
        For each body, in the order of v, its number of velocities; with a kinematic matrix, its numbers of coordinates and
        velocities. M has no entries between different blocks.
    groups : sequence of (int, sequence of int)
        For each group of constraints, in order, its number of constraints and the indices of its blocks: C has no entries for
        other blocks. A group must be either holonomic or nonholonomic.
    mass : str or sequence of str
        Property of each block of M: "", "constant", "diagonal" (only its diagonal is stored) or "constant diagonal". One word
        holds for all blocks.

    Attributes
    ----------
    nq, nv, m : int
        Numbers of coordinates, velocities and constraints.

    Raises
    ------
    TypeError, ValueError
        If a size is not a valid count, or the blocks of a group do not exist or are not in increasing order.

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

    blocks: Sequence[Any]
    groups: Sequence[Any] = ()
    mass: str | Sequence[str] = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "blocks", _blocks(self.blocks))
        object.__setattr__(self, "groups", tuple(_group(i, each, len(self.blocks)) for i, each in enumerate(
            _sequence("groups", self.groups, "of (rows, blocks)"))))
        object.__setattr__(self, "mass", _words(self.mass, len(self.blocks)))

    @cached_property
    def _packing(self) -> gateway.Packing:
        sizes = zip(self.blocks, self.mass, strict=True)
        return gateway.Packing([(p, v, WORDS[word]) for (p, v), word in sizes], self.groups)

    nq = property(lambda self: self._packing.shapes["A"][0])
    nv = property(lambda self: self._packing.shapes["A"][1])
    m = property(lambda self: self._packing.shapes["C"][0])

    def size(self, term: str) -> int:
        """Number of stored entries of "A", "M" or "C"."""
        return self._packing.size(checks.choice("term", term, gateway.PACKED))

    def offsets(self, term: str) -> tuple[int, ...]:
        """Offset of each block or group among the stored entries of "A", "M" or "C", and the end."""
        return self._packing.offsets[checks.choice("term", term, gateway.PACKED)]

    def places(self, term: str) -> list[int]:
        """Index of each stored entry in the dense row-major matrix "A", "M" or "C"."""
        return self._packing.places(checks.choice("term", term, gateway.PACKED))

    def expand(self, term: str, packed: ArrayLike) -> np.ndarray:
        """The dense matrix "A" (nq, nv), "M" (nv, nv) or "C" (m, nv) of what is stored of it."""
        return self._packing.expand(term, checks.vector("packed", packed, self.size(term)))

    def pack(self, term: str, dense: ArrayLike) -> np.ndarray:
        """Stored entries of a dense matrix "A", "M" or "C"; ValueError if it has an entry outside all blocks and groups."""
        self.size(term)
        given = checks.real("dense must be", dense).astype(float)
        if given.shape != self._packing.shapes[term]:
            raise WrongValue(f"dense must be of shape {self._packing.shapes[term]}, not {given.shape}", "declared-structure")
        try:
            return self._packing.pack(term, given)
        except ValueError as error:
            raise WrongValue(f"{term}{sentence(error)}", "declared-structure") from None


def of_core(core: gateway.CoreSystem) -> Structure | None:
    """Structure of a system of the core."""
    packing = core.packing
    if packing is None:
        return None
    words = {bits: word for word, bits in WORDS.items()}
    return Structure([(p, v) for p, v, _ in packing.blocks], packing.groups, [words[bits] for *_, bits in packing.blocks])


def checked(structure: Any, sizes: tuple[int, int, int, int], has_A: bool) -> gateway.Packing | None:
    """Core object of a structure, checked against the sizes (nq, nv, mh, mn) of a system."""
    if structure is None:
        return None
    checks.instance("structure", structure, Structure, "a zd.Structure")
    nq, nv, mh, mn = sizes
    for what, there, has in (("coordinates", structure.nq, nq), ("velocities", structure.nv, nv),
                             ("constraints", structure.m, mh + mn)):
        if there != has:
            raise WrongValue(f"structure has {there} {what} in its {'groups' if what == 'constraints' else 'blocks'}, and the "
                             f"system has {has}", "declared-structure")
    for b, (p, v) in enumerate(structure.blocks):
        if p != v and not has_A:
            raise WrongValue(f"structure: block {b} has {p} coordinates and {v} velocities: then a kinematic matrix is needed",
                             "declared-structure")
    ends = np.cumsum([0, *(rows for rows, _ in structure.groups)])
    if mh not in ends:
        g = int(np.searchsorted(ends, mh)) - 1
        raise WrongValue(f"structure: group {g} has rows {ends[g]} to {ends[g + 1] - 1}, of which the first {mh} are holonomic; "
                         "it must be of one kind", "declared-structure")
    return structure._packing


def _sequence(name: str, given: Any, of: str) -> Sequence[Any] | np.ndarray:
    if isinstance(given, str) or not isinstance(given, Sequence | np.ndarray):
        raise WrongType(f"{name} must be a sequence {of}, not {checks.shown(given)}", "declared-structure")
    return given


def _blocks(given: Any) -> tuple[tuple[int, int], ...]:
    listed = _sequence("blocks", given, "of counts, or of (coordinates, velocities)")
    pairs = [each if isinstance(each, Sequence | np.ndarray) and not isinstance(each, str) else (each, each) for each in listed]
    if not pairs:
        raise WrongValue("blocks must be at least one", "declared-structure")
    for b, pair in enumerate(pairs):
        if len(pair) != 2:
            raise WrongValue(f"blocks[{b}] must be a count or (coordinates, velocities), not {checks.shown(listed[b])}",
                             "declared-structure")
    return tuple((checks.count(f"blocks[{b}]", p), checks.count(f"blocks[{b}]", v)) for b, (p, v) in enumerate(pairs))


def _group(g: int, given: Any, blocks: int) -> tuple[int, tuple[int, ...]]:
    name = f"groups[{g}]"
    pair = _sequence(name, given, "(rows, blocks)")
    if len(pair) != 2:
        raise WrongValue(f"{name} must be (rows, blocks), not {checks.shown(given)}", "declared-structure")
    listed = _sequence(f"the blocks of {name}", pair[1], "of indices")
    touched = tuple(checks.count(f"a block of {name}", b, least=0) for b in listed)
    for b in touched:
        if b >= blocks:
            raise WrongValue(f"{name} touches block {b}, and there are blocks 0 to {blocks - 1}", "declared-structure")
    if not touched or list(touched) != sorted(set(touched)):
        raise WrongValue(f"{name} must touch at least one block, in increasing order, not {checks.shown(pair[1])}",
                         "declared-structure")
    return checks.count(f"the rows of {name}", pair[0]), touched


def _words(given: Any, blocks: int) -> tuple[str, ...]:
    words = (given,) * blocks if isinstance(given, str) else tuple(_sequence("mass", given, "of words"))
    if len(words) != blocks:
        raise WrongValue(f"mass must be one word, or {blocks}, one for each block, not {len(words)}", "declared-structure")
    return tuple(checks.choice("mass", word, WORDS) for word in words)
