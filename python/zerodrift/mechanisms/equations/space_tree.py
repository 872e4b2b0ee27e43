"""Joint coordinates in space: possible inboard joints of bodies, and their coordinates."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ..._private.gateway import Variable
from ..._private.rotations import AXES
from ..elements.bodies import Body
from ..elements.space_joints import SpaceJoint, speeds
from .tree import Edge, ends

QUATERNION = ("e0", "e1", "e2", "e3")
SIZES = {"slides": 1, "turns": 1, "advances": 1, "swings": 3}      # numbers of velocities


def edges(joints: Sequence[SpaceJoint], number: dict[str, int], *, with_cut: bool = False) -> list[Edge]:
    """Joints that may be in the tree, optionally with those that the user has cut."""
    return [Edge(i, *ends(joint, number), freedoms(joint)) for i, joint in enumerate(joints)
            if joint.row.freedoms is not None and (with_cut or not joint.cut)]


def freedoms(joint: SpaceJoint) -> tuple[int, int]:
    """Numbers of velocities with which the joint is the inboard joint of its first body, and of its second."""
    first, second = (sum(SIZES[each.kind] for each in joint.row.freedoms or () if body.turns or each.kind != "swings")
                     for body in joint.bodies)
    return first, second


def positions(body: Body, inboard: SpaceJoint | None) -> Iterator[Variable]:
    """Entries of p of a body: position and quaternion if it is free, otherwise the coordinates of its inboard joint."""
    if inboard is None:
        yield from (Variable(f"{body.name}.{axis}", "m") for axis in AXES)
        yield from (Variable(f"{body.name}.{each}", "") for each in (QUATERNION if body.turns else ()))
        return
    for each in inboard.row.freedoms or ():
        if each.kind != "swings":
            yield Variable(f"{inboard.name}.{each.name}", "m" if each.kind == "slides" else "rad")
        elif body.turns:
            yield from (Variable(f"{inboard.name}.{word}", "") for word in QUATERNION)


def rates(body: Body, inboard: SpaceJoint | None) -> Iterator[Variable]:
    """Entries of v of a body; with a quaternion the angular velocity about the body's own axes."""
    if inboard is None:
        yield from (Variable(f"{body.name}.{axis}_dot", "m/s") for axis in AXES)
        yield from (Variable(f"{body.name}.{axis}_spin", "rad/s") for axis in (AXES if body.turns else ()))
        return
    speed_of = {coordinate: speed for speed, coordinate in speeds(inboard.row).items()}
    for each in inboard.row.freedoms or ():
        if each.kind != "swings":
            speed = speed_of.get(str(each.name), f"{each.name}_dot")
            yield Variable(f"{inboard.name}.{speed}", "m/s" if each.kind == "slides" else "rad/s")
        elif body.turns:
            yield from (Variable(f"{inboard.name}.{axis}_spin", "rad/s") for axis in AXES)
