"""As few angles as possible go to the sines, and what follows from these is as good as what mpmath has from the same numbers."""

import functools

import numpy as np
import pytest

import zerodrift as zd
from native_systems import needs_compiler
from vector_units import DirectSet, closed_form_sets
from zerodrift.symbolics.graph import angles
from zerodrift.symbolics.graph.lowering import Lowering

mpmath = pytest.importorskip("mpmath")
sp = pytest.importorskip("sympy")
SIZES = {"small": 1e-9, "of one": 1.0, "large": 1e6}


def program(*forms):
    """Sines of sums of whole multiples of leaves, as operations, and where the sines stand; leaves below 0 are parameters."""
    do = Lowering(None)
    numbers = []
    for form in forms:
        parts = [do.emit("*", do.emit("number", float(count)), do.emit("leaf", "p" if i >= 0 else "parameter", abs(i)))
                 for i, count in form.items()]
        angle = parts[0]
        for part in parts[1:]:
            angle = do.emit("+", angle, part)
        numbers.append(do.emit("call", sp.sin, angle))
    operations = [[code, *(["sin", *arguments[1:]] if code == "call" else arguments)] for code, arguments, _ in do.operations]
    return operations, numbers


@pytest.mark.parametrize(("forms", "computed"), [
    ([{0: 1}, {1: 1}, {0: 1, 1: -1}, {1: 1, 0: 1}], 2), ([{0: 1, 1: -1}, {0: 1, 2: -1}, {1: 1, 2: -1}], 2),
    ([{0: 1}, {0: 2}, {0: 3}, {0: 5}, {0: -1}], 1), ([{0: 1}, {0: 1, 1: 1}, {0: 1, 1: 1, 2: 1}], 3),
    ([{0: 1, -1: 2}, {-1: 2}, {0: 1}], 2), ([{0: 1}, {0: 0.5}], 2), ([{i: 1 for i in range(9)}, {0: 1}, {1: 1}], 3),
    ([{0: 1, 1: 1, 2: 1}, {0: 1, 1: 1}, {2: 1}], 2)], ids=str)
def test_as_few_are_computed_as_there_may_be(forms, computed):
    """And each of the others is the sum of two that are known by then."""
    operations, numbers = program(*forms)
    found = angles.sums(operations, numbers)
    wanted = {operations[number][2]: form for number, form in zip(numbers, forms, strict=True)}
    assert len(wanted) - len(found) == computed
    known = set(wanted) - set(found)
    for angle, way in found.items():
        parts = [(sign, part) for sign, part in ((way.sign_a, way.a), (way.sign_b, way.b)) if part is not None]
        assert known.issuperset(part for _, part in parts)
        for leaf in range(-1, 9):
            assert wanted[angle].get(leaf, 0) == sum(sign * wanted[part].get(leaf, 0) for sign, part in parts)
        known.add(angle)


def turned():
    """Four velocities that are driven by sines of two angles, of sums and of differences of these."""
    a, b, va, vb = sp.symbols("a b va vb")
    return zd.symbolic([a, b], speeds=[va, vb], kinetic=(va**2 + vb**2) / 2, parameters={},
                       force=[sp.sin(a - b) + sp.sin(a) * sp.cos(2 * a - b), sp.sin(2 * a - 2 * b) + sp.sin(b) * sp.cos(a)],
                       p0=[0.0, 0.0], v0=[0.0, 0.0])


@functools.cache
def plain_functions():
    closed_form, sizes, data, _ = closed_form_sets(turned())
    return DirectSet(closed_form[0, 1], sizes, data[None, :])


@needs_compiler
@pytest.mark.parametrize("size", SIZES)
def test_near_cancellation_nothing_is_lost_that_the_angles_have(size):
    """An error of 2^-53 of each angle's own sine is what these angles as numbers have by themselves."""
    assert "ZD_SINES(2, " in turned()._closed_form.source
    closed_form, rng = plain_functions(), np.random.default_rng(1)
    with mpmath.workdps(60):
        for apart in 10.0 ** -np.arange(0, 16):
            a = SIZES[size] * rng.uniform(0.5, 1.5)
            b = a * (1 - apart * rng.uniform(0, 1))
            A, B = mpmath.mpf(a), mpmath.mpf(b)
            exact = [mpmath.sin(A - B) + mpmath.sin(A) * mpmath.cos(2 * A - B),
                     mpmath.sin(2 * A - 2 * B) + mpmath.sin(B) * mpmath.cos(A)]
            found = closed_form.accelerate(0, np.zeros(1), np.array([[a, b]]), np.zeros((1, 2)))["vdot"][0]
            for value, right in zip(found, exact, strict=True):
                assert abs(float(value - right)) <= 16 * 2.0**-53 * max(abs(np.sin(a)), abs(np.sin(b)))
