"""Joints of every kind of the core's table, by the verbs that their rows make; a kind that is added to the table is here."""

import numpy as np

import zerodrift as zd
from zerodrift.mechanisms.building.table_force_verbs import force_verb, sides, words
from zerodrift.mechanisms.building.table_joint_verbs import plane_words, verb
from zerodrift.mechanisms.elements.joints import JOINTS, made
from zerodrift.mechanisms.elements.table_forces import ELEMENTS, made_force

AXIS, NORMAL, LENGTH = (0.8, 0.6), (-0.6, 0.8), 0.4


def two_bodies(kind, m=None, at=(0.3, 0.2)):
    """A mechanism, a point of a body and one of another, which lie a length apart where the kind takes one."""
    m = zd.Mechanism(kind, gravity=(0.1, -9.81)) if m is None else m
    at, number = np.array(at), len(m.bodies)
    bodies = [m.body(f"B{number + i}", 1.0 + i, 0.1, at=at + i, angle=0.3 + i, com=(0.05, 0.02 * i)) for i in range(2)]
    row, first = JOINTS[kind], m.ground if JOINTS[kind].at_contact else bodies[0]
    second = bodies[1].point(at=at + (LENGTH * np.array(NORMAL) if row.takes_length else 0.0))
    return m, first.point(at=at if row.takes_length else second.drawn), second


def added(m, first, second, joint, name="J", damping=0.0):
    """A joint of a class that is made from a row."""
    given = {"axis": AXIS, "along": AXIS, "length": LENGTH, "damping": damping}
    points = (second,) if joint.is_of_one_body else (first, second)
    return verb(joint)(m, name, *points, **{word: given[word] for word in plane_words(joint) if word in given})


def by_row():
    """Each kind once, with damping where it has a coordinate; and each kind of element."""
    m = zd.Mechanism("by row", gravity=(0.1, -9.81))
    for i, kind in enumerate(JOINTS):
        _, first, second = two_bodies(kind, m, at=(3.0 * i, 0.1 * i))
        added(m, first, second, made(kind), name=f"J {kind}", damping=0.2)
    for i, kind in enumerate(ELEMENTS):
        _, first, second = two_bodies("rod", m, at=(3.0 * i, 5.0))
        force = made_force(kind)
        given = {**({"axis": AXIS} if force.entries[2].axes else {}), "stiffness": 20.0 + i, "damping": 0.3, "value": 1.7}
        on = ("J revolute",) if sides(force) == ("joint",) else (first, second)
        force_verb(force)(m, f"F {kind}", *on, **{word: given[word] for word in words(force.entries[2]) if word in given})
    return m
