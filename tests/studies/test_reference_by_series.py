"""`zd.reference` by Taylor's method: what it certifies of systems of expressions, and by what it is checked."""

import mpmath
import numpy as np
import pytest
import sympy

import tolerances as tol
import zerodrift as zd
from native_systems import needs_compiler
from support import assert_close
from zerodrift.studies.reference_runs import Perturbed

pytestmark = needs_compiler
x, y, a, t = sympy.symbols("x y a t", real=True)
rates = sympy.symbols("xdot ydot")
TIMES = np.linspace(0, 2, 9)


@pytest.fixture(scope="module")
def pendulum():
    """A particle on a circle, from rest at 90 degrees."""
    return zd.symbolic([x, y], speeds=rates, kinetic=(rates[0]**2 + rates[1]**2) / 2, potential=9.81 * y,
                       constraints=[x**2 + y**2 - 1], p0=[1.0, 0.0], v0=[0.0, 0.0])


@pytest.fixture(scope="module")
def cart():
    """A sleigh with kinematics, a nonholonomic row, a constraint that moves, and a parameter."""
    s, side, turn, k = sympy.symbols("s side turn k")
    mass = sympy.Matrix([[1, 0, sympy.cos(a) / 10], [0, 1, 0.2], [sympy.cos(a) / 10, 0.2, 0.5]])
    return zd.symbolic([x, y, a], speeds=[s, side, turn], potential=None, mass=mass, parameters={k: 0.3}, time=t,
                       force=[side * turn + sympy.cos(t), -s * turn - k * x, -0.1 * turn],
                       kinematics=[s * sympy.cos(a) - side * sympy.sin(a), s * sympy.sin(a) + side * sympy.cos(a), turn],
                       constraints=[a - 0.3 - sympy.sin(2 * t)], nonholonomic=[side + 0.1 * turn],
                       p0=[0.0, 0, 0.3], v0=[1.0, -0.2, 2.0])


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("name", ["pendulum", "cart"])
def test_the_series_of_a_system_that_is_off_follow_from_its_terms(request, name, seed):
    """By its accelerations as the core has them, a little later. It is off by percents, so that every factor counts."""
    system, order, start, h = request.getfixturevalue(name), 12, 0.4, 1e-2
    off = Perturbed(system, seed, 0.01)
    p, v = np.array(system.p0), np.array(system.v0) + 0.1
    P, V, _ = off._with_series(off._core).series(order, start, p, v)
    powers, k = h ** np.arange(order + 1), np.arange(1, order + 1)
    later = start + h, powers @ P, powers @ V
    vdot, _ = zd.acceleration(off, later[1], later[2], later[0])
    assert_close(powers[:-1] @ (k[:, None] * V[1:]), vdot, tol.STEPPED)
    plain, _ = zd.acceleration(system, later[1], later[2], later[0])
    assert np.abs(vdot - plain).max() > 1e-3
    terms = off.evaluate(later[1], later[2], later[0])
    assert_close(powers[:-1] @ (k[:, None] * P[1:]), later[2] if terms.A is None else terms.A @ later[2], tol.STEPPED)


def test_a_certificate_near_rounding_is_true(pendulum):
    """sin(angle / 2) = k sn(K - omega t, k), with k^2 = 1/2."""
    ref = zd.reference(pendulum, 2.0, t_eval=TIMES, precision="double")
    with mpmath.workdps(30):
        K, omega = mpmath.ellipk(0.5), mpmath.sqrt(mpmath.mpf(9.81))
        half = [mpmath.sqrt(0.5) * mpmath.ellipfun("sn", K - omega * mpmath.mpf(at), m=0.5) for at in TIMES]
        exact = np.array([[2 * s * mpmath.sqrt(1 - s * s), 2 * s * s - 1] for s in half], dtype=float)
    assert np.abs(ref.solution.p - exact).max() <= ref.error < 1e-13
    assert ref.caveats == ()


def test_its_evidence_is_from_another_method_and_formulation(pendulum):
    ref = zd.reference(pendulum, 2.0, precision="double")
    halved, rounded, method, finer = ref.differences
    assert ref.solution.settings["integrator"] == "taylor"
    assert [d.integrator for d in ref.differences] == ["taylor", "taylor", "dop853", "taylor"]
    assert ref.solution.stats["steps"] == 2 * halved.steps == rounded.steps
    assert finer.steps == 5 * rounded.steps / 3
    assert [d.formulation for d in ref.differences][::2] == ["augmented", "independent"]
    assert finer.formulation in zd.formulations(pendulum)
    assert finer.formulation not in ("augmented", "independent")
    assert [d.rounded for d in ref.differences] == [False, True, True, True]
    assert ref.error >= 1.5 * np.linalg.norm([d.p for d in ref.differences]) > 0
    assert method.p > 0


def test_it_is_called_only_where_others_are_not_enough(pendulum):
    assert zd.reference(pendulum, 2.0, error=1e-9).solution.settings["integrator"] == "dop853"


def test_where_it_takes_no_part(pendulum):
    ref = zd.reference(pendulum, 0.5, precision="double", stabilization="baumgarte")
    assert {d.integrator for d in ref.differences} == {"dop853", "extrapolation"}


def test_in_independent_velocities(pendulum):
    ref = zd.reference(pendulum, 2.0, precision="double", formulations=("independent", "schur"))
    assert ref.solution.settings["integrator"] == "taylor"
    assert ref.solution.settings["formulation"] == "independent"
    assert ref.error < 1e-13


def test_where_terms_depend_on_time_the_check_tells_what_may_be_missed(cart):
    """By how densely its runs have evaluated them."""
    ref = zd.reference(cart, 4.0, precision="double")
    assert ref.solution.settings["integrator"] == "taylor"
    assert ref.error < 1e-12
    assert f"some {4 * 0.21 / ref.differences[2].steps:.2g} s" in ref.caveats[0]
