"""`zerodrift.symbolic` finds bodies and groups of constraints from the zeros of the matrices."""

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

import zerodrift as zd
from support import assert_close, numbers
from zerodrift.symbolics import define
from zerodrift.symbolics.graph.pattern import Pattern

N = 5       # rods


def rods(n=N, coupled=False):
    """Rods that hang one on the other, each x, y, angle; `coupled`: by a term of the kinetic energy, too."""
    names = [dynamicsymbols(f"x{i} y{i} a{i}") for i in range(n)]
    m, g = sp.symbols("m g")
    q = [each for body in names for each in body]
    t = dynamicsymbols._t
    kinetic = sum(m * (x.diff(t) ** 2 + y.diff(t) ** 2) / 2 + m * a.diff(t) ** 2 / 24 for x, y, a in names)
    if coupled:
        kinetic += m * names[0][2].diff(t) * names[-1][2].diff(t) / 50
    ends, constraints = (0, 0), []
    for x, y, a in names:
        half = sp.cos(a) / 2, sp.sin(a) / 2
        constraints += [x - half[0] - ends[0], y - half[1] - ends[1]]
        ends = x + half[0], y + half[1]
    p0 = np.ravel([(i + 0.5, 0.0, 0.0) for i in range(n)])
    return zd.symbolic(q, kinetic=kinetic, potential=sum(m * g * y for _, y, _ in names), constraints=constraints,
                       parameters={m: 1.0, g: 9.81}, p0=p0, name=f"rods{coupled}")


@pytest.fixture
def dense(monkeypatch):
    """No structure is looked for, nor known from before."""
    monkeypatch.setattr(Pattern, "structure", lambda self: None)
    monkeypatch.setattr(define, "_derived", {})
    monkeypatch.setattr(define.cache, "read", lambda *arguments: None)
    monkeypatch.setattr(define.cache, "write", lambda *arguments: None)


def test_bodies_and_joints_are_found():
    system = rods()
    assert system.structure == zd.Structure([3] * N, [(2, [0]), *((2, [i, i + 1]) for i in range(N - 1))], "diagonal")
    assert repr(system).startswith(f"<zd.symbolic rodsFalse: 15 coordinates, 15 velocities, 10 holonomic and 0 nonholonomic "
                                   f"constraints, {N} blocks and {N} groups of constraints")
    assert system.with_parameters(m=2.0).structure == system.structure
    assert f"memset(C, 0, {10 * 15}" not in system.c_source


def test_what_couples_all_bodies_leaves_nothing_to_find():
    assert rods(coupled=True).structure is None
    assert rods(3).structure is None        # small


@pytest.mark.parametrize("closed_form", [None, False])
def test_the_motion_is_that_of_the_dense_system(request, closed_form):
    system = rods()
    request.getfixturevalue("dense")
    twin = rods()
    assert (system.structure is None, twin.structure is None) == (False, True)
    rng = np.random.default_rng(2)
    p, v = rng.normal(size=15), rng.normal(size=15)
    one, other = numbers(system, 0.0, p, v), numbers(twin, 0.0, p, v)
    for name in ("M", "C", "Phi", "xi", "force"):
        assert (getattr(one, name) == getattr(other, name)).all(), name
    for formulation in zd.formulations():
        runs = [zd.simulate(each, 0.2, step=0.01, formulation=formulation, closed_form=closed_form) for each in (system, twin)]
        assert_close(runs[0].p, runs[1].p, 1e-10)
        assert_close(runs[0].multipliers, runs[1].multipliers, 1e-9)


def test_without_a_compiler_it_is_packed_as_well(monkeypatch):
    system = rods()
    monkeypatch.setattr("zerodrift.symbolics.compile.shared_library.library", lambda *arguments, **options: None)
    with pytest.warns(zd.NoCompilerWarning):
        slow = rods()
    assert slow.structure == system.structure
    assert_close(zd.simulate(slow, 0.05, step=0.01).p, zd.simulate(system, 0.05, step=0.01).p, 1e-12)


# ---- patterns by themselves ----


def pattern(sizes, **rows):
    """From rows of 0 and 1."""
    return Pattern({name: [entry for row in matrix for entry in row] for name, matrix in rows.items()}, sizes, lambda x: x == 0)


def blocks(*sizes):
    return np.array(np.kron(np.eye(sizes[0]), np.ones(sizes[1:])), dtype=int).tolist()


def test_a_kinematic_matrix_gives_each_block_its_coordinates():
    """Two bodies with quaternions, held by one row each."""
    C = [[1] * 6 + [0] * 6, [0] * 6 + [1] * 6]
    found = pattern((14, 12, 2, 0), A=blocks(2, 7, 6), M=blocks(2, 6, 6), C=C).structure()
    assert zd.Structure(**found) == zd.Structure([(7, 6), (7, 6)], [(1, [0]), (1, [1])])


def test_coordinates_that_are_not_in_order_have_no_structure():
    A = np.eye(12, dtype=int)[::-1].tolist()
    assert pattern((12, 12, 0, 0), A=A, M=blocks(12, 1, 1)).structure() is None


def test_rows_of_different_kinds_and_rows_of_nothing_are_groups_of_their_own():
    C = [[1, 1, 1] + [0] * 9, [0] * 12, [1, 1, 1] + [0] * 9, [1, 1, 1] + [0] * 9]
    found = zd.Structure(**pattern((12, 12, 3, 1), M=blocks(4, 3, 3), C=C).structure())
    assert found.groups == ((3, (0,)), (1, (0,)))


def test_full_matrices_have_no_structure_that_pays():
    C = np.ones((8, 12), dtype=int).tolist()
    assert pattern((12, 12, 8, 0), M=blocks(4, 3, 3), C=C).structure() is None
