"""Programs too large for one function: the same bits as in one, in functions of bounded length."""

import re
import sys

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

import energy_models
import zerodrift as zd
from support import assert_same_bits
from symbolic_counterparts import four_bar, rolling_disc
from zerodrift.symbolics.emit import splitting
from zerodrift.symbolics.emit.loops import element, number, plain, rolled

T = dynamicsymbols._t


def coupled(n):
    """Coupled oscillators with functions of parameters and of time, choices, and a constraint on velocities."""
    q, a = dynamicsymbols(f"q1:{n + 1}"), sp.Symbol("a")
    rates, start = [each.diff(T) for each in q], np.linspace(0.2, 1.1, n)
    return {"coordinates": q, "kinetic": sum(sp.cos(x - y) * u * w + u**2 * (2 + sp.sin(a * x)) for x, y, u, w in zip(
                q, q[1:], rates, rates[1:], strict=False)) / 2 + rates[-1] ** 2,
            "potential": sum(sp.sin(a) * sp.sqrt(1 + (x - sp.sin(T)) ** 2) for x in q) + sp.Max(q[0], 0.1) ** 2,
            "force": [sp.Piecewise((x**2, x > a), (x, True)) for x in q],
            "constraints": [sum(sp.cos(x) for x in q) - np.cos(start).sum()],
            "nonholonomic": [rates[0] - sp.exp(q[1]) * rates[2]], "parameters": {a: 0.3}, "p0": start}


def written_twice(make, monkeypatch):
    """The system in functions as long as they come, and in short ones."""
    one = make()
    monkeypatch.setattr(splitting, "MAX_STATEMENTS", 0)
    monkeypatch.setattr(splitting, "PIECE", 5)
    monkeypatch.setattr(splitting, "FEWEST_STATEMENTS", 2)
    monkeypatch.setattr(sys.modules["zerodrift.symbolics.define"], "fingerprint", lambda expressions: None)
    return one, make()


@pytest.mark.parametrize("make", [four_bar, rolling_disc, lambda: zd.symbolic(**coupled(5))], ids=["bar", "disc", "coupled"])
def test_terms_and_motion_have_the_same_bits(make, monkeypatch):
    one, other = written_twice(make, monkeypatch)
    assert {"PIECE", "for"} <= set(other.c_source.split())
    assert "PIECE" not in one.c_source
    for seed in range(3):
        chance = np.random.default_rng(seed)
        state = chance.uniform(0.2, 1.2, one.nq), chance.uniform(-1, 1, one.nv), 0.3
        a, b = (system.evaluate(*state) for system in (one, other))
        for name in ("A", "M", "d", "f", "Phi", "C", "Phi_t", "xi", "V"):
            value, again = getattr(a, name), getattr(b, name)
            assert (value is None) == (again is None), name
            assert value is None or np.asarray(value).tobytes() == np.asarray(again).tobytes(), name
    assert_same_bits(*(zd.simulate(system, 0.1, step=0.01, closed_form=False) for system in (one, other)))


def test_no_function_of_a_long_chain_is_long():
    """Code that differs between links only in its data is emitted once, so that only the tables of the source grow."""
    system = energy_models.closed_pendulum(24)
    counts = [text.count(";\n") for text in re.split(r"^}$", system.c_source, flags=re.MULTILINE)]
    assert max(counts) <= splitting.MAX_STATEMENTS
    assert zd.check(system)


def test_statements_alike_are_loops_and_wait_for_what_they_use():
    """Six sums of neighbours and their halves, of which two lines are needed later."""
    x, y = (lambda i: element("x", i)), (lambda i: element("y", i))
    sums = [f"{x(10 + i)} = {y(i)} + {y(i + 1)};" for i in range(6)]
    halves = [f"{x(20 + 2 * i % 7)} = {number('0.5')} * {x(10 + i)};" for i in range(6)]
    last = f"{x(30)} = {x(20)} * {number('2.0')};"
    with_loops = rolled([*sums, *halves, last, "done();", last], 2)
    assert with_loops[0] == "for (int i = 0; i < 6; i++)\n    x[10 + i] = y[i] + y[1 + i];"
    assert "{20}, {22}, {24}, {26}, {21}, {23}," in with_loops[1]
    assert with_loops[1].endswith("        x[at[i][0]] = 0.5 * x[10 + i];\n}")
    assert with_loops[2:] == ["x[30] = x[20] * 2.0;", "done();", "x[30] = x[20] * 2.0;"]
    assert rolled(sums, 7) == [plain(line) for line in sums]


def test_numbers_that_differ_are_a_table_and_large_indices_are_not_cut_short():
    squares = [f"{element('x', 70000 + i * i)} = {number(repr(i / 2))} * {element('y', 3)};" for i in range(3)]
    text, = rolled(squares, 2)
    assert "static const unsigned at[3][1] = {\n        {70000}, {70001}, {70004},\n    };" in text
    assert "static const double number[3][1] = {\n        {0.0}, {0.5}, {1.0},\n    };" in text
    assert "x[at[i][0]] = number[i][0] * y[3];" in text
