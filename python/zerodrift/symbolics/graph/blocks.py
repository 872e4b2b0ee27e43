"""Schedule of operations: each is computed with the smallest set of requested terms that need it.

Operations on parameters alone are executed once, when the parameters are set. Values of t and p that several terms share are
stored in the scratch memory until t or p changes. They form groups: a group holds all operations needed by the same set of terms,
and is computed when the first of these is requested. Shared values that depend on v are computed at each call that requests one
of their terms.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from .graph import FIXED, PLACED
from .lowering import SIMPLE, Lowering

Terms = frozenset[str]
GROUPS = 31     # that are kept: one bit each says which of them are computed; further ones are not kept


@dataclass
class Block:
    """Operations that are computed together, in order, when one of `terms` is wanted."""

    terms: Terms
    operations: list[int] = field(default_factory=list)


class Blocks:
    """The operations of a program by when they are computed.

    Attributes
    ----------
    constants : list of int
        Operations on parameters.
    kept, shared, own : list of Block
        On t and p, by several terms; on v too, by several terms; for one term.
    stored : dict
        The constants and the kept operations that are needed outside of their block, and where each is stored.
    """

    def __init__(self, lowering: Lowering, outputs: dict[str, list[int]]) -> None:
        self.lowering, self.outputs = lowering, outputs
        self.users = self._users()
        self.constants: list[int] = []
        groups: dict[tuple[str, Terms], Block] = {}
        self.home: dict[int, tuple[str, Terms]] = {}
        for number, operation in enumerate(lowering.operations):
            terms = self.users[number]
            if not terms or operation.code in SIMPLE:
                continue
            if operation.stage == FIXED:
                self.constants.append(number)
                self.home[number] = ("constants", frozenset())
                continue
            kind = "own" if len(terms) == 1 else "kept" if operation.stage == PLACED else "shared"
            self.home[number] = (kind, terms)
            groups.setdefault((kind, terms), Block(terms)).operations.append(number)
        kept, shared, self.own = (
            sorted((block for (kind, _), block in groups.items() if kind == which), key=lambda block: -len(block.terms))
            for which in ("kept", "shared", "own"))
        self.kept = kept[:GROUPS]
        self.shared = sorted([*kept[GROUPS:], *shared], key=lambda block: -len(block.terms))
        self.stored = self._stored()

    def _users(self) -> list[Terms]:
        users: list[set[str]] = [set() for _ in self.lowering.operations]
        for term, numbers in self.outputs.items():
            for number in numbers:
                users[number].add(term)
        self._propagate(users)
        self._join_sines(users)
        self._propagate(users)
        return [frozenset(terms) for terms in users]

    def _propagate(self, users: list[set[str]]) -> None:
        for number in reversed(range(len(users))):
            for argument in self.lowering.operands(self.lowering.operations[number]):
                users[argument] |= users[number]

    def _join_sines(self, users: list[set[str]]) -> None:
        """Pair sine and cosine of the same angle, which are computed in one call."""
        seen: dict[int, int] = {}
        for number, operation in enumerate(self.lowering.operations):
            if operation.code == "call" and operation.arguments[0].__name__ in ("sin", "cos") and users[number]:
                other = seen.setdefault(operation.arguments[1], number)
                users[number] |= users[other]
                users[other] |= users[number]

    def _stored(self) -> dict[int, int]:
        outside = {number for numbers in self.outputs.values() for number in numbers}
        for number, operation in enumerate(self.lowering.operations):
            if self.users[number]:
                outside.update(argument for argument in self.lowering.operands(operation)
                               if self.home.get(argument) != self.home.get(number))
        constants = [number for number in self.constants if number in outside]
        kept = [number for block in self.kept for number in block.operations if number in outside]
        return {number: place for numbers in (constants, kept) for place, number in enumerate(numbers)}
