"""Tree of inboard joints of a mechanism in joint coordinates; joints outside the tree close loops."""

from __future__ import annotations

import heapq
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from ..._private.gateway import Variable


class Edge(NamedTuple):
    """Joint that can be an inboard joint: `freedoms` are its numbers of coordinates for the first body and for the second."""

    joint: int
    first: int
    second: int
    freedoms: tuple[int, int]


def ends(joint: Any, number: Mapping[str, int]) -> tuple[int, int]:
    """Numbers of the two bodies of a joint."""
    first, second = joint.bodies
    return number[first.name], number[second.name]


def inboard_joints(bodies: int, edges: Sequence[Edge], weights: Sequence[tuple[float, ...]]) -> list[int]:
    """Inboard joint of each body, numbered from 1; -1 for a free body.

    The tree grows from the ground, body 0, by the joint of fewest degrees of freedom, and among these by the one nearest to the
    ground: so loops are cut at joints of most degrees of freedom, and branches are short. Bodies without a connection to the
    ground get a free root, the heaviest body by `weights`.
    """
    around: list[list[Edge]] = [[] for _ in range(bodies + 1)]
    for edge in edges:
        around[edge.first].append(edge)
        around[edge.second].append(edge)
    inboard, reached, frontier = [-1] * (bodies + 1), [False] * (bodies + 1), list[tuple[int, ...]]()
    for roots in (lambda: [0], lambda: sorted(range(1, bodies + 1), key=lambda body: weights[body - 1], reverse=True)):
        for root in roots() if not all(reached) else []:
            if not reached[root]:
                reached[root] = True
                _offer(frontier, around[root], root, 0)
                _grow(frontier, around, inboard, reached)
    return inboard[1:]


def _grow(frontier: list, around: list[list[Edge]], inboard: list[int], reached: list[bool]) -> None:
    """Extend the tree by all that can be reached from the frontier."""
    while frontier:
        _, depth, joint, outer = heapq.heappop(frontier)
        if not reached[outer]:
            reached[outer], inboard[outer] = True, joint
            _offer(frontier, around[outer], outer, depth)


def _offer(frontier: list, edges: list[Edge], inner: int, depth: int) -> None:
    """Add a body's joints to the frontier."""
    for edge in edges:
        side = 1 if edge.first == inner else 0
        heapq.heappush(frontier, (edge.freedoms[side], depth + 1, edge.joint, edge.second if side else edge.first))


def loop(inboard: Sequence[int], ends: Sequence[tuple[int, int]], joint: int) -> tuple[list[int], list[int]]:
    """Bodies and joints of the loop that a joint closes: `ends` has the two bodies of every joint."""
    first, second = (_way_down(inboard, ends, body) for body in ends[joint])
    shared = {body for body, _ in first} & {body for body, _ in second}
    bodies, joints = list[int](), [joint]
    for way, order in ((first, -1), (second, 1)):
        part = [step for step in way if step[0] not in shared]
        bodies = bodies + [body for body, _ in part] if order == 1 else [body for body, _ in part][::-1]
        joints += [by for _, by in part if by >= 0]
    meet = next(body for body, _ in first if body in shared)
    return [meet, *bodies], joints


def _way_down(inboard: Sequence[int], ends: Sequence[tuple[int, int]], body: int) -> list[tuple[int, int]]:
    """Bodies from one down to its root, or to the ground beyond it, each with its inboard joint."""
    way = []
    while body:
        joint = inboard[body - 1]
        way.append((body, joint))
        body = 0 if joint < 0 else sum(ends[joint]) - body
    return [*way, (0, -1)]


def freedoms(joint: Any) -> tuple[int, int]:
    """Numbers of coordinates with which the joint is the inboard joint of its first body, and of its second."""
    if joint.row.inboard == "turns":
        return int(joint.bodies[0].turns), int(joint.bodies[1].turns)
    return (0, 0) if joint.row.inboard == "fixed" else (1, 1)


def coordinate_names(tables: Any, core: Any) -> list[tuple[Variable, Variable]]:
    """Names and units of coordinates and velocities."""
    found = []
    for coordinate in core.motions:
        body = tables.parts[coordinate.body - 1]
        if coordinate.kind == "displacement":
            joint = tables.joints[tables.inboard[coordinate.body - 1]]
            found.append((Variable(f"{joint.name}.displacement", "m"), Variable(f"{joint.name}.speed", "m/s")))
        elif coordinate.kind == "angle":
            found.append((Variable(f"{body.name}.angle", "rad"), Variable(f"{body.name}.angular_velocity", "rad/s")))
        else:
            place = f"{body.name}.{coordinate.kind}"
            found.append((Variable(place, "m"), Variable(f"{place}_dot", "m/s")))
    return found
