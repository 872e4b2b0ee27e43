"""Random starts: one joint coordinate is held, and what may move with it follows from the graph of the mechanism alone.

Two joints move together only if some closed loop contains both. Then no single body separates them (Menger's theorem), which is
tested here by leaving out one body after the other.
"""

import numpy as np

import zerodrift as zd
from mechanisms.plain_space import Plain
from mechanisms.random_mechanisms import Maker

APART = 1e-9            # rad, m, or their rates: how far what stays may be from where it was
QUANTITIES = {"revolute": "angle", "prismatic": "displacement"}


class Undriven(Maker):
    """A random mechanism in the plane that nothing but its start moves."""

    def _drive(self):
        pass

    def _blade(self):
        pass


def mechanism(seed, in_space):
    """A mechanism, and its joints by the names of the bodies that they connect."""
    if in_space:
        rng = np.random.default_rng(seed)
        m = Plain(rng, int(rng.integers(3, 7)), int(rng.integers(0, 2)), None, "joint").m
    else:
        m = Undriven(seed).m
    return m, [(joint, tuple(body.name for body in joint.bodies)) for joint in m.joints]


def move_together(edges, one, other):
    """True if a closed loop contains both of two edges, (body, body) each, given by their numbers."""
    if one == other:
        return True
    bodies = {body for edge in edges for body in edge}
    return all(_connected(edges, one, other, without) for without in [*bodies, None])


def _connected(edges, one, other, without):
    """True if a path leads from one edge to another that avoids a body and does not contain these edges."""
    found, left = {body for body in edges[one] if body != without}, True
    while left:
        left = [edge for i, edge in enumerate(edges) if i not in (one, other) and without not in edge
                and len(found & set(edge)) == 1]
        found |= {body for edge in left for body in edge}
    return bool(found & set(edges[other]))


def outcome(seed, in_space, layout):
    """Result of a start as a word, and the largest motion of a body that need not move; a speed or a position is prescribed."""
    random = np.random.default_rng(seed)
    m, joints = mechanism(seed, in_space)
    able = [i for i, (joint, _) in enumerate(joints) if joint.kind in QUANTITIES]
    if not able:
        return "no joint that turns or slides", 0.0
    number = int(random.choice(able))
    joint = joints[number][0]
    quantity = "speed" if seed % 2 else QUANTITIES[joint.kind]
    edges = [bodies for _, bodies in joints]
    staying = [joints[i][0] for i in able if not move_together(edges, number, i)]
    before = _values(m, staying, layout)
    m.start({f"{joint.name}.{quantity}": float(random.uniform(0.5, 1.5)) if quantity == "speed" else 0.1})
    try:
        after = _values(m, staying, layout)
    except zd.InconsistentStart:
        return "the joints block it", 0.0
    moved = max((float(abs(after[name] - before[name])) for name in before), default=0.0)
    if not staying:
        return "every coordinate is in a loop with it", 0.0
    return ("the others stay" if moved < APART else "others move"), moved


def _values(m, joints, layout):
    """Coordinates and rates at t = 0."""
    sol = zd.simulate(m.system(layout), 1e-6, step=1e-6)
    names = [f"{joint.name}.{quantity}" for joint in joints for quantity in (QUANTITIES[joint.kind], "speed")]
    return {name: sol[name][0] for name in names}
