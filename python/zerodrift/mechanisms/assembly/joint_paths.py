"""Paths between bodies along the joints of a mechanism, and the coordinates that move together.

Edges are the joints of a spanning forest, by the body that a joint of the tree carries, or by -1 - joint where the tree has it
not; a body that the tree leaves free has an edge to the ground by its own number, too. Edges that one closed loop contains move
together. A free body takes part in the motion of a loop only as far as its joints lead it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Sequence


class Reach:
    """Paths between bodies.

    Parameters
    ----------
    inboard : sequence of int
        Inboard joint of each body in the tree; -1: the body is free.
    ends : sequence of (int, int)
        Numbers of the two bodies of each joint; 0 is the ground.
    """

    def __init__(self, inboard: Sequence[int], ends: Sequence[tuple[int, int]]) -> None:
        self.inboard, self.ends = inboard, ends
        self.free = {body for body, joint in enumerate(inboard, 1) if joint < 0}
        self._parent: dict[int, tuple[int, int]] = {}       # by body: the next one towards the root, and the edge
        self._connecting: list[int] = []
        self._grow()

    def _grow(self) -> None:
        """Build the forest: joints of the tree, and other joints that connect bodies which the tree does not connect."""
        root = [0, *range(1, len(self.inboard) + 1)]

        def found(body: int) -> int:
            while root[body] != body:
                root[body] = root[root[body]]
                body = root[body]
            return body

        neighbours: dict[int, list[tuple[int, int]]] = defaultdict(list)
        edge_of = {joint: body for body, joint in enumerate(self.inboard, 1) if joint >= 0}
        self.closing: list[int] = []
        for joint in sorted(range(len(self.ends)), key=lambda joint: joint not in edge_of):
            one, other = self.ends[joint]
            if found(one) == found(other):
                self.closing.append(joint)
                continue
            root[found(one)] = found(other)
            edge = edge_of.get(joint, -1 - joint)
            self._connecting += [] if joint in edge_of else [joint]
            neighbours[one].append((other, edge))
            neighbours[other].append((one, edge))
        self._direct(neighbours)

    def _direct(self, neighbours: dict[int, list[tuple[int, int]]]) -> None:
        """Point each body towards the root of its forest: the ground, if it is connected with it."""
        seen: set[int] = set()
        for start in range(len(self.inboard) + 1):
            left = [] if start in seen else [start]
            seen.add(start)
            while left:
                body = left.pop()
                for other, edge in neighbours[body]:
                    if other not in seen:
                        seen.add(other)
                        self._parent[other] = body, edge
                        left.append(other)

    def between(self, first: int, second: int) -> set[int]:
        """Edges on the path between two bodies; without connecting joints, through the free bodies of the tree."""
        one, other = self._inward(first), self._inward(second)
        if one[0] == other[0]:
            return one[1] ^ other[1]
        return self._in_tree(first) ^ self._in_tree(second)

    def _inward(self, body: int) -> tuple[int, set[int]]:
        """Root of a body's forest, and the edges on the path to it."""
        way = set()
        while body in self._parent:
            body, edge = self._parent[body]
            way.add(edge)
        return body, way

    def _in_tree(self, body: int) -> set[int]:
        """Edges on the path to the ground, along the tree."""
        way = set()
        while body:
            way.add(body)
            joint = self.inboard[body - 1]
            body = 0 if joint < 0 else sum(self.ends[joint]) - body
        return way

    def moving_with(self, forced: Collection[int], touched: Iterable[int], couplings: Iterable[set[int]]) -> set[int]:
        """Edges that move with the `forced` ones; for `touched` ones the others of their loops and couplings."""
        rows = [(row, row) for row in (*(self.between(*self.ends[joint]) | {-1 - joint} for joint in self.closing), *couplings)]
        rows += [(row, row & self.free) for row in self._led()]
        of_edge: dict[int, list[int]] = defaultdict(list)
        for i, (row, _) in enumerate(rows):
            for edge in row:
                of_edge[edge].append(i)
        found, left = set(forced), [*forced, *touched]
        while left:
            for i in of_edge.pop(left.pop(), ()):
                new = rows[i][1] - found
                found |= new
                left += new
        return found

    def _led(self) -> Iterator[set[int]]:
        """For each joint that connects a free body: the edges of the tree between its two bodies."""
        for joint in self._connecting:
            first, second = self.ends[joint]
            yield (self._in_tree(first) ^ self._in_tree(second)) | {-1 - joint}
