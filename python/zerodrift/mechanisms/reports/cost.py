"""Computing cost of a step in joint and in absolute coordinates, by which `Mechanism.system` chooses them.

The unit is one multiplication, with its addition, in the factorization of a dense matrix; all other work is expressed in it. The
step is a corrected one of "rk4" in "schur". These quantities are counted, as a run will compute them:

    joint       dense factors and solves for n velocities and m constraints that close loops; the bodies, once more those whose
                terms need more than sines and cosines; the sum of the bodies' depths in the tree; the sum, over constraints that
                close loops, of the depths of both bodies, as forces pass inward joint by joint; the constraints; the forces
    absolute    multiplications in C M^-1 C^T, in its factors and in a solve, counted by the core in the elimination order of the
                run, separately for blocks that have a kernel of their size; the constraints, at one rate with the system's own
                products and at another where C is stored; the forces. Constraints cost more where bodies contribute unequally to
                them, as solutions are then compared, and where few constraints are checked for bifurcations, the more so the
                smaller the smallest pivot is. Where it vanishes, constraints are redundant, and all is several times slower.

Redundancy and unequal contributions are evaluated in the drawn pose. The weights are fitted to measured times by
tests/bench/bench_coordinates.py, separately in the plane and in space.

The cheaper coordinates are chosen, with one exception: loops in space closed by a joint of at most one degree of freedom. As a
loop is cut at its joint of most degrees of freedom, all its joints are such, and with fewer than seven of them it moves only
because constraints are redundant. Where such a loop lies flat its rank drops: runs in joint coordinates have stopped there that
absolute ones completed, Bennett's linkage among them. So absolute coordinates are chosen there up to a multiple of the cost.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..equations.tables import Tables
from ..equations.tree import ends

# Weights of parts_of_joint() and parts_of_absolute(), in the plane and in space
JOINT = {2: (710.0, 5.0, 3.7, 360.0, 240.0, 44.0, 400.0, 0.0, 960.0),
         3: (2400.0, 2.4, 62.0, 1200.0, 0.0, 215.0, 330.0, 1900.0, 2500.0)}
ABSOLUTE = {2: (3300.0, 4.7, 29.0, 180.0, 460.0, 250.0, 67.0, 120.0, 840.0),
            3: (3500.0, 4.9, 10.8, 270.0, 730.0, 560.0, 340.0, 55.0, 2150.0)}
NANOSECONDS = 0.39      # duration of an operation in that measurement
SAVED = 0.5             # of that by compiled equations: small mechanisms take two thirds of the count, code a fifth of these
INSTRUCTION, OF_CODE = 1.2, 0.3     # nanoseconds of an instruction of a program, and the part of it that code takes
MAX_HINGED = 200       # bodies, at most, for which the core has terms from sines and cosines alone, if all have hinges
GOOD, MAX_LOST = 2.0**-3, 20.0     # smallest pivot without extra cost; lost binary digits counted below it
REDUNDANT = 1e-12       # smallest pivot of redundant constraints, and their factor of the cost, for few and for many constraints
TIMES_OF_FEW, TIMES_OF_MANY = 4.0, 15.0
PASSES_FLAT_POSES = 8.0 # ratio of costs up to which absolute coordinates are chosen where flat poses may stop joint ones
CLEARLY = 0.85          # the same elsewhere in space, where the count is less certain
ALIKE = 0.33            # the same if all bodies are free, so that both have the same coordinates
DEARER = 3.0            # ratio of operations from which a report mentions them, and
WORTH_A_WARNING = 10.0, 10.0, 0.01      # from which a warning is given; seconds of a run or of a step for it


class Cost(NamedTuple):
    """Operations of a step in joint and in absolute coordinates."""

    joint: float
    absolute: float         # infinite if they cannot be used: a body has no mass, or a constraint has no body
    allowed: float = 1.0    # ratio of costs up to which absolute coordinates are chosen

    @property
    def taken(self) -> str:
        """Cheaper layout: absolute coordinates if they cost less than `allowed` times as much as joint ones."""
        return "absolute" if self.absolute < self.allowed * self.joint else "joint"

    @property
    def ratio(self) -> float:
        """Cost in joint coordinates over that in absolute ones."""
        return self.joint / self.absolute

    @property
    def in_words(self) -> str:
        """Costs in words, those of the chosen coordinates first."""
        counts = {"joint": self.joint, "absolute": self.absolute}
        other = "joint" if self.taken == "absolute" else "absolute"
        more = "" if counts[other] == np.inf else f", in {other} ones {counts[other]:.3g}"
        return f"{counts[self.taken]:.3g} operations a step{more}"


def cost(tables: Tables, exact: bool = False) -> Cost:
    """Cost of a mechanism whose tables have a tree; `exact` counts absolute coordinates even if joint ones are cheaper."""
    dimension = tables.drawing.dimension
    joint, least = float(np.dot(JOINT[dimension], parts_of_joint(tables))), ABSOLUTE[dimension][0]
    if not _has_mass(tables):
        return Cost(joint, np.inf)
    if not tables.joint_coordinates():
        return Cost(np.inf, least)     # welded to the ground: absolute coordinates have the reactions
    if joint <= least and not exact:
        return Cost(joint, least)
    parts, times = parts_of_absolute(tables)
    absolute = times * float(np.dot(ABSOLUTE[dimension], parts)) if parts[1] else np.inf
    return Cost(joint, absolute, _allowed(tables))


def _allowed(tables: Tables) -> float:
    """Largest ratio of costs, absolute to joint, at which absolute coordinates are chosen."""
    if max(tables.inboard) < 0:
        return ALIKE
    return 1.0 if tables.drawing.dimension == 2 else PASSES_FLAT_POSES if _has_stiff_loops(tables) else CLEARLY


def _has_stiff_loops(tables: Tables) -> bool:
    """True if a loop consists of joints of at most one degree of freedom."""
    return any(rows >= 5 for rows, _ in _loops(tables))


def parts_of_absolute(tables: Tables) -> tuple[tuple[float, ...], float]:
    """Counts for absolute coordinates, in the order of `ABSOLUTE`, and the factor by which redundancy multiplies their cost.

    The counts are: 1; multiplications in blocks with a kernel, and in other blocks; constraints by the system's products, by a
    stored C, those of unequal bodies, those of few constraints, and these times the digits that their smallest pivot loses;
    forces.
    """
    free = tables.absolute()
    core = free.core()
    work = core.structure_work(core.state(free.drawn())[0])
    known, other = (work.products[i] + work.factors[i] + work.solves[i] for i in (0, 1))
    few = 0.0 if work.is_of_many else float(work.rows)
    is_redundant = work.share < REDUNDANT
    lost = 0.0 if is_redundant else min(math.log2(GOOD / min(work.share, GOOD)), MAX_LOST)
    times = 1.0 if not is_redundant else TIMES_OF_MANY if work.is_of_many else TIMES_OF_FEW
    by_products = work.rows * bool(work.has_products)
    return (1.0, known, other, by_products, work.rows - by_products, work.rows * (not work.is_alike), few, few * lost,
            float(len(tables.forces))), times


def parts_of_joint(tables: Tables) -> tuple[float, ...]:
    """Counts for joint coordinates, in the order of `JOINT`."""
    depth, loops, bodies = _depths(tables), _loops(tables), len(tables.parts)
    n, m = tables.joint_coordinates(), sum(rows for rows, _ in loops) + len(tables.relations)
    passed = sum(rows * (depth[first] + depth[second]) for rows, (first, second) in loops)
    unhinged = bodies * (not _is_hinged(tables))
    return (1.0, n**3 / 6 + n**2 * m / 2 + n * m**2, float(n**2 + n * m + m**2), float(bodies), float(unhinged),
            float(sum(depth)), float(passed), float(m), float(len(tables.forces)))


def _is_hinged(tables: Tables) -> bool:
    """True if every body of a planar mechanism has a hinge or weld as its inboard joint."""
    if tables.drawing.dimension == 3 or len(tables.parts) > MAX_HINGED:
        return False
    return all(inboard >= 0 and tables.joints[inboard].row.inboard in ("turns", "fixed") for inboard in tables.inboard)


def _loops(tables: Tables) -> list[tuple[int, tuple[int, int]]]:
    """Number of constraints and the two bodies of each joint that closes a loop."""
    inboard_joints = {joint for joint in tables.inboard if joint >= 0}
    return [(len(joint.row.rows), ends)
            for i, (joint, ends) in enumerate(zip(tables.joints, _ends(tables), strict=True)) if i not in inboard_joints]


def _ends(tables: Tables) -> list[tuple[int, int]]:
    """Bodies of each joint, by number."""
    return [ends(joint, tables.number) for joint in tables.joints]


def _depths(tables: Tables) -> list[int]:
    """Depth of each body in the tree: bodies on the path to the ground or a free root, itself included; 0 for the ground."""
    ends, depth = _ends(tables), [0] + [-1] * len(tables.parts)
    for body in range(1, len(depth)):
        way = []
        while depth[body] < 0:
            way.append(body)
            inboard = tables.inboard[body - 1]
            body = 0 if inboard < 0 else sum(ends[inboard]) - body
        for further, each in enumerate(reversed(way), depth[body] + 1):
            depth[each] = further
    return depth


def _has_mass(tables: Tables) -> bool:
    """True if every body has mass, as absolute coordinates require."""
    return all(tables.inertias.is_massive(body) for body in tables.parts)


def seconds(operations: float) -> float:
    """Approximate duration of a number of operations, in s."""
    return 1e-9 * NANOSECONDS * operations


def saved(operations: float, steps: float) -> float:
    """Approximate time in s that compiled equations save in so many corrected steps of "rk4", each of so many operations."""
    return SAVED * seconds(operations) * steps


def saved_from_programs(instructions: float, steps: float) -> float:
    """The same, in s, where a step runs so many instructions of programs."""
    return (1 - OF_CODE) * INSTRUCTION * 1e-9 * instructions * steps


def of_a_step(found: Cost) -> str:
    """Sentence on the cost of a step, where absolute coordinates are much cheaper; otherwise ""."""
    if found.ratio < DEARER:
        return ""
    return f"a step takes about {in_words(seconds(found.joint))}, {found.ratio:.3g} times as long as in absolute coordinates"


def of_a_run(found: Cost, steps: int | None) -> str | None:
    """Warning on the cost of a run in joint coordinates, or None if absolute ones gain little; `steps` may be unknown."""
    times, run, step = WORTH_A_WARNING
    each = seconds(found.joint)
    if found.ratio < times or (each < step if steps is None else steps * each < run):
        return None
    whole = "" if steps is None else f", and {steps} steps about {in_words(steps * each)}"
    return f"{of_a_step(found)}{whole}: system('absolute') has these"


def in_words(time: float) -> str:
    """Duration with a unit suited to its size."""
    for unit, size in (("h", 3600.0), ("min", 60.0), ("s", 1.0), ("ms", 1e-3)):
        if time >= size:
            return f"{time / size:.3g} {unit}"
    return f"{1e6 * time:.3g} us"
