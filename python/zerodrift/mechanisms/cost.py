"""What a step costs in joint and in absolute coordinates: `Mechanism.system` takes the cheaper by this count.

An operation is a multiplication, with its addition, in the factors of a dense matrix; what else a step does is counted in as
many of them as take its time. A step is a corrected one of "rk4" in "schur", which has five factorizations. With bodies B, joint
coordinates n, and m rows that close loops:

    joint       5 (n^3/6 + n^2 m + n m^2/2 + m^3/6 + 2 (n^2 + n m + m^2)) + b B + d D + r R
    absolute    a + l m + s 5 S

D is the sum of the bodies' depths in the tree, and R that of the depths of both bodies of each row that closes a loop, as these
are passed inward joint by joint. S are the multiplications in C M^-1 C^T, in its factors and in a solve, counted by the core in
the order in which a run eliminates; all else that a step does for each body and joint grows with them. Weights are those that
tests/bench/bench_coordinates.py measured on chains, rows of four-bars, stars and trees of 1 to 129 bodies; but a is larger, as
mechanisms of unequal bodies that share loops take more in absolute coordinates, Andrews' three times what is counted. In space
b, d and r are measured in the same way, on chains of hinges and of balls, stars, trees and rows of linkages of 1 to 33 bodies;
a, l and s are set by hand, so that of the worked models that were timed the count takes the faster. Loops there often have rows
that follow from others, or unequal joints whose blocks have no kernel. Neither is in S, and l stands for it, in space alone.

What costs less is taken, but for loops in space that are closed by a joint of one freedom or none: as loops are cut where there
are most freedoms, all their joints are such, and with fewer than seven of them they move only because rows follow from others.
Where such a loop lies flat its rank falls: joint coordinates have stopped there with runs that absolute ones went through,
Bennett's linkage among them, so absolute ones are taken up to some times the cost.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .tables import Tables

FACTORIZATIONS = 5
JOINT = {2: (1.0, 700.0, 40.0, 650.0), 3: (1.0, 3000.0, 100.0, 500.0)}      # 1, b, d, r; in the plane, and in space
ABSOLUTE = {2: (16000.0, 0.0, 2.5), 3: (2500.0, 3000.0, 1.3)}               # a, l, s
NANOSECONDS = 0.38      # of an operation, there
PASSES_FLAT_POSES = 3.0 # absolute coordinates may cost so many times as much where flat poses have stopped joint ones
DEARER = 3.0            # so many times the operations are worth a sentence, and
WORTH_A_WARNING = 10.0, 10.0, 0.01      # a warning, if it is so many times, and so many seconds of a run, or of a step


class Cost(NamedTuple):
    """Operations of a step in both coordinates."""

    joint: float
    absolute: float         # infinite where they cannot be taken: a body has no mass, or a row touches none
    allowed: float = 1.0    # how many times the cost of joint coordinates absolute ones may have and still be taken

    @property
    def taken(self) -> str:
        """The layout to take: absolute coordinates where they cost less than `allowed` times as much as joint ones."""
        return "absolute" if self.absolute < self.allowed * self.joint else "joint"

    @property
    def ratio(self) -> float:
        """How many times as much joint coordinates cost."""
        return self.joint / self.absolute

    @property
    def in_words(self) -> str:
        """Both, those that are taken first."""
        counts = {"joint": self.joint, "absolute": self.absolute}
        other = "joint" if self.taken == "absolute" else "absolute"
        more = "" if counts[other] == np.inf else f", in {other} ones {counts[other]:.3g}"
        return f"{counts[self.taken]:.3g} operations a step{more}"


def cost(tables: Tables, exact: bool = False) -> Cost:
    """Of a mechanism whose tables have a tree; `exact`: S is counted, too, where joint coordinates cost less whatever it is."""
    dimension = tables.drawing.dimension
    joint, least = float(np.dot(JOINT[dimension], parts_of_joint(tables))), ABSOLUTE[dimension][0]
    if not _has_mass(tables):
        return Cost(joint, np.inf)
    if joint <= least and not exact:
        return Cost(joint, least)
    parts = parts_of_absolute(tables)
    absolute = float(np.dot(ABSOLUTE[dimension], parts)) if parts[-1] else np.inf
    return Cost(joint, absolute, PASSES_FLAT_POSES if dimension == 3 and _has_stiff_loops(tables) else 1.0)


def _has_stiff_loops(tables: Tables) -> bool:
    """Whether a loop has joints of one freedom or none alone."""
    return any(rows >= 5 for rows, _ in _loops(tables))


def parts_of_absolute(tables: Tables) -> tuple[float, ...]:
    """One, m, and 5 S."""
    rows = sum(rows for rows, _ in _loops(tables)) + len(tables.relations)
    return 1.0, float(rows), FACTORIZATIONS * tables.absolute().core().structure_count()


def parts_of_joint(tables: Tables) -> tuple[float, ...]:
    """Five times the dense matrices, B, D and R."""
    depth, loops = _depths(tables), _loops(tables)
    n, m = tables.joint_coordinates(), sum(rows for rows, _ in loops) + len(tables.relations)
    dense = n**3 / 6 + n**2 * m + n * m**2 / 2 + m**3 / 6 + 2 * (n**2 + n * m + m**2)
    passed = sum(rows * (depth[first] + depth[second]) for rows, (first, second) in loops)
    return FACTORIZATIONS * dense, float(len(tables.parts)), float(sum(depth)), float(passed)


def _loops(tables: Tables) -> list[tuple[int, tuple[int, int]]]:
    """Of each joint that closes a loop its rows, how many they are, and its bodies."""
    carriers = {joint for joint in tables.carrier if joint >= 0}
    return [(len(joint.row.rows), ends)
            for i, (joint, ends) in enumerate(zip(tables.joints, _ends(tables), strict=True)) if i not in carriers]


def _ends(tables: Tables) -> list[tuple[int, int]]:
    """The bodies of each joint, by number."""
    return [tuple(tables.number[body.name] for body in joint.bodies) for joint in tables.joints]


def _depths(tables: Tables) -> list[int]:
    """How many bodies there are from each down to the ground or a free root, itself included; of the ground none."""
    ends, depth = _ends(tables), [0] + [-1] * len(tables.parts)
    for body in range(1, len(depth)):
        way = []
        while depth[body] < 0:
            way.append(body)
            carrier = tables.carrier[body - 1]
            body = 0 if carrier < 0 else sum(ends[carrier]) - body
        for further, each in enumerate(reversed(way), depth[body] + 1):
            depth[each] = further
    return depth


def _has_mass(tables: Tables) -> bool:
    """Whether every body has, which absolute coordinates need."""
    return all(tables.inertias.is_massive(body) for body in tables.parts)


def seconds(operations: float) -> float:
    """About how long they take."""
    return 1e-9 * NANOSECONDS * operations


def of_a_step(found: Cost) -> str:
    """What a step in joint coordinates costs, where absolute ones cost much less; else nothing."""
    if found.ratio < DEARER:
        return ""
    return f"a step takes about {in_words(seconds(found.joint))}, {found.ratio:.3g} times as long as in absolute coordinates"


def of_a_run(found: Cost, steps: int | None) -> str | None:
    """A warning of what so many steps in joint coordinates cost; None: it is not worth one. Steps may be unknown."""
    times, run, step = WORTH_A_WARNING
    each = seconds(found.joint)
    if found.ratio < times or (each < step if steps is None else steps * each < run):
        return None
    whole = "" if steps is None else f", and {steps} steps about {in_words(steps * each)}"
    return f"{of_a_step(found)}{whole}: system('absolute') has these"


def in_words(time: float) -> str:
    """Seconds, as people read them."""
    for unit, size in (("h", 3600.0), ("min", 60.0), ("s", 1.0), ("ms", 1e-3)):
        if time >= size:
            return f"{time / size:.3g} {unit}"
    return f"{1e6 * time:.3g} us"
