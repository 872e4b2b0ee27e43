"""Equations of free bodies against their terms written out: chains of each kind of joint, rows of several marker quantities."""

import numpy as np
import pytest

import zerodrift as zd
from large_mechanisms import four_bars
from mechanism_tables import KINDS, Body, Joint, Quantity, Relation, Tabled, Tables
from support import assert_close

NEAR = 1e-11        # rounding, times the condition of some five bodies
BODIES = 5


def drawn(rng, joints, **more):
    """Bodies anywhere, and a state."""
    table = [Body(rng.uniform(1, 3), rng.uniform(0.5, 1)) for _ in range(BODIES)]
    system = Tabled(Tables(table, joints, gravity=(0.4, -9.8), **more))
    return system, rng.normal(size=system.nq), rng.normal(size=system.nv)


def chain(kind, rng):
    """Each body with the one before; what is of one body alone, with itself."""
    joints = []
    for b in range(1, BODIES + 1):
        first, angle = b if all(row.nonholonomic for row in kind.rows) else b - 1, rng.uniform(0, 6)
        axis = (np.cos(angle), np.sin(angle))
        joints.append(Joint(kind.number, first, b, *rng.normal(size=(2, 2)).tolist(), axis, 0.3, 0.2, 0.1, 0.7))
    return joints


def assert_solved(system, p, v):
    """(13) by blocks, or by products without C, gives what (8) does with the terms written out."""
    terms = system.evaluate(p, v)
    C, n = terms.C, system.nv
    matrix = np.block([[terms.M, C.T], [C, np.zeros((len(C), len(C)))]])
    expected = np.linalg.solve(matrix, np.concatenate([terms.f, terms.xi]))
    vdot, multipliers = zd.acceleration(system, p, v, formulation="schur")
    assert_close(vdot, expected[:n], NEAR)
    assert_close(multipliers, expected[n:], NEAR)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("name", KINDS)
def test_chains_of_each_kind(name, seed):
    rng = np.random.default_rng(seed)
    assert_solved(*drawn(rng, chain(KINDS[name], rng)))


def test_pins_beside_others():
    """Hinges, a weld, a slider and a rod, which have blocks of two, three, two and one rows, and a particle."""
    rng = np.random.default_rng(3)
    made = [chain(KINDS[name], rng)[b] for b, name in enumerate(("revolute", "weld", "prismatic", "rod"))]
    pin = Joint(KINDS["revolute"].number, 2, 5, (0.3, 0.1))
    table = [*(Body(rng.uniform(1, 3), rng.uniform(0.5, 1)) for _ in range(4)), Body(1.5, 0.0, True)]
    system = Tabled(Tables(table, [*made, pin], gravity=(0.4, -9.8)))
    assert_solved(system, rng.normal(size=system.nq), rng.normal(size=system.nv))


def test_rows_of_several_quantities():
    """Gears, a rack, a pulley, and a row of velocities: between up to four bodies, or two marker quantities of the same two."""
    rng = np.random.default_rng(4)
    point = rng.normal(size=(4, 2)).tolist()
    quantities = [Quantity("angle", 1, 2), Quantity("angle", 3, 4), Quantity("along", 2, 3, point[0], point[1], (0.6, 0.8)),
              Quantity("distance", 1, 4, point[2], point[3]), Quantity("distance", 0, 5, point[1], point[0]),
              Quantity("skid", 4, 5, axis=(0.8, 0.6)), Quantity("across", 3, 2, point[1], point[2], (0.6, -0.8)),
              Quantity("y", 0, 1, point[0], point[3])]
    relations = [Relation([0, 1], [1.0, -2.5]), Relation([0, 2], [0.3, 1.0], 0.2, 0.1), Relation([3, 4], [1.0, 2.0]),
                 Relation([5, 1], [1.0, 0.4], 0.2, 0.3, nonholonomic=True), Relation([6, 2], [2.0, 1.0]), Relation([7], [3.0])]
    assert_solved(*drawn(rng, (), quantities=quantities, relations=relations))


def test_what_is_written_out_goes_without():
    """Compiled terms leave nothing for them: the motion is that of the tables."""
    m = four_bars(2)
    one, other = (zd.simulate(m.system("absolute", compiled=it), 0.1, step=0.01, closed_form=False) for it in (False, True))
    assert_close(other.p, one.p, 1e-12)
