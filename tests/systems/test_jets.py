"""Derivatives of constraints written in Python: where there are none, that is said."""

import numpy as np
import pytest

import zerodrift as zd
from bead import bead
from support import FORMULATIONS, assert_close, refused


@pytest.mark.parametrize("value", [[None], ["1"], [1j], np.ma.array([1.0], mask=True)], ids=repr)
def test_what_constraints_return_with_derivatives_is_judged(value):
    def constraints(p):
        return value if p.dtype == object else np.array([p @ p - 1.0])

    with pytest.raises((TypeError, ValueError), match="constraints must return real numbers"):
        bead(constraints=constraints).evaluate()


def test_complex_numbers_within_derivatives_are_refused():
    with refused("wrong-type", "constraints"):
        bead(constraints=lambda p: np.array([p[0] * (1j if p.dtype == object else 1.0)])).evaluate()


def test_a_power_that_has_its_second_derivative_at_zero_only_as_a_whole():
    """|x|^3 + |y|^3 = 1 from (1, 0), written (x^2)^1.5: the same as with its Jacobian and xi in closed form."""
    def rows(p):
        return 3 * np.array([abs(p) * p])

    written = bead(constraints=lambda p: np.array([(p[0] ** 2) ** 1.5 + (p[1] ** 2) ** 1.5 - 1]), v0=[0.0, 1.0])
    closed = bead(constraints=lambda p: np.array([np.sum(abs(p) ** 3) - 1]), jacobian=rows,
                  xi=lambda p, v: -np.array([6 * abs(p) @ v**2]), v0=[0.0, 1.0])
    assert written.evaluate().xi == pytest.approx(closed.evaluate().xi, rel=1e-14)      # powers of numbers and of arrays
    for formulation in FORMULATIONS:
        a, b = (zd.simulate(system, 0.5, step=0.01, formulation=formulation) for system in (written, closed))
        assert_close(a.p, b.p, 1e-9)


@pytest.mark.parametrize("row", [
    lambda x, y: np.sqrt(y**2), lambda x, y: np.hypot(y, 0 * x), lambda x, y: y**0.5, lambda x, y: (y - 1e-3) ** 1.5,
    lambda x, y: 1 / y, lambda x, y: np.log(y), lambda x, y: np.arcsin(x + y), lambda x, y: y**-1.0, lambda x, y: np.cbrt(y),
    lambda x, y: (-2.0) ** (x / 3 + y), lambda x, y: np.exp(1000 * (x + y))])
def test_a_derivative_that_does_not_exist_names_the_constraints(row):
    """If NumPy's value is not finite either, the error names the value, not the derivative."""
    with np.errstate(all="ignore"), refused("not-finite"):
        bead(constraints=lambda p: np.array([row(p[0], p[1])])).evaluate()


def test_a_branch_that_is_not_taken_may_have_no_derivative():
    """``np.where`` computes both, 1/y at y = 0 too."""
    system = bead(constraints=lambda p: np.where(p[1:] > 0.5, 1 / p[1:], p[:1] - 1))
    with np.errstate(all="ignore"):
        assert system.evaluate().C.tolist() == [[1.0, 0.0]]
