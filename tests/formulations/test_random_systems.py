"""Random systems of random size: every formulation, every correction, against each other and against NumPy.

Phi is quadratic in p and the rows C_NH are linear in it, so that all the equations have a closed form that is written here.
"""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import tolerances as tol
import zerodrift as zd
from support import FORMULATIONS, assert_close, condition, solved

ALWAYS = settings(max_examples=60, deadline=None, derandomize=True)     # derandomized: CI finds what everybody finds
LARGEST_CONDITION = 1e9     # beyond, round-off times condition leaves too few digits to compare


class Draw:
    """A random system with n velocities, mh holonomic and mn nonholonomic constraints, and its terms in closed form."""

    def __init__(self, seed, n, mh, mn, decades):
        rng = np.random.default_rng(seed)
        scale = 10.0 ** rng.uniform(-decades / 2, decades / 2, n)
        root = rng.normal(size=(n, n))
        self.M = (root @ root.T + np.eye(n)) * np.sqrt(np.outer(scale, scale))
        self.linear, self.quadratic = rng.normal(size=(mh, n)), 0.1 * rng.normal(size=(mh, n, n))
        self.quadratic += self.quadratic.transpose(0, 2, 1)
        self.rows, self.slopes = rng.normal(size=(mn, n)), 0.1 * rng.normal(size=(mn, n, n))
        self.f, self.d, self.p, self.v = rng.normal(size=(4, n))
        self.offset = self.linear @ self.p + self.p @ self.quadratic @ self.p / 2
        self.mh, self.mn, self.n = mh, mn, n

    def Phi(self, p):
        return self.linear @ p + (self.quadratic @ p) @ p / 2 - self.offset

    def C(self, p):
        return np.vstack([self.linear + self.quadratic @ p, self.rows + self.slopes @ p])

    def xi(self, v):
        """(6): minus the rate of C along the motion, times v."""
        return -np.concatenate([(self.quadratic @ v) @ v, (self.slopes @ v) @ v])

    def system(self):
        terms = {"mass": self.M, "force": self.f, "bias": self.d, "potential": 0.0, "p0": self.p, "v0": self.v}
        if self.mh:
            terms["constraints"] = self.Phi
        if self.mn:
            terms["nonholonomic"] = lambda p: self.rows + self.slopes @ p
        return zd.System(self.n, **terms)


@st.composite
def draws(draw, decades=6):
    n = draw(st.integers(1, 9))
    m = draw(st.integers(0, n))
    mh = draw(st.integers(0, m))
    return Draw(draw(st.integers(0, 2**32 - 1)), n, mh, m - mh, draw(st.floats(0, decades)))


def well_conditioned(random):
    """Its condition, or None where there is nothing to compare."""
    found = condition(random.M, random.C(random.p))
    return found if found < LARGEST_CONDITION else None


@ALWAYS
@given(draws())
def test_accelerations_and_multipliers_of_all_formulations(random):
    bound, system = well_conditioned(random), random.system()
    if bound is None:
        return
    vdot, multipliers = solved(random.M, random.C(random.p), random.f - random.d, random.xi(random.v))
    weight = np.sqrt(np.diag(random.M))
    free = np.abs((random.f - random.d) / weight).max()     # what the constraints take most of away
    for formulation in FORMULATIONS:
        got, reactions = zd.acceleration(system, random.p, random.v, formulation=formulation)
        assert_close(weight * got, weight * vdot, 256 * tol.EPS * bound, scale=free, what=f"vdot of {formulation}")
        assert_close(reactions, multipliers, 256 * tol.EPS * bound, scale=free, what=f"lambda of {formulation}")


@ALWAYS
@given(draws())
def test_response_to_forces_is_the_same_by_the_complement_and_by_the_multipliers(random):
    """(12): D (D^T M D)^-1 D^T = M^-1 - M^-1 C^T (C M^-1 C^T)^-1 C M^-1, which is how vdot answers to f where xi = 0."""
    bound = well_conditioned(random)
    if bound is None or bound > 1e5:    # NumPy's side of (12) has the square of it
        return
    C, rest = random.C(random.p), np.zeros(random.n)
    inverse = np.linalg.inv(random.M)
    whole = inverse - inverse @ C.T @ np.linalg.solve(C @ inverse @ C.T, C @ inverse) if C.size else inverse
    random.d = np.zeros(random.n)
    for formulation in ("mixed", "nullspace", "schur"):
        columns = []
        for unit in np.eye(random.n):
            random.f = unit
            columns.append(zd.acceleration(random.system(), random.p, rest, formulation=formulation)[0])
        weight = np.sqrt(np.outer(random.M.diagonal(), random.M.diagonal()))
        assert_close(weight * np.array(columns).T, weight * whole, 1e4 * tol.EPS * bound, scale=1.0)


@ALWAYS
@given(draws(decades=2), st.floats(1e-6, 1e-3))
def test_corrections_of_all_formulations(random, size):
    bound, system = well_conditioned(random), random.system()
    if bound is None or bound > 1e6 or system.m == 0:
        return
    rng = np.random.default_rng(7)
    p, v = random.p + size * rng.normal(size=random.n), random.v
    results = {}
    for formulation in FORMULATIONS:
        try:
            results[formulation] = zd.project(system, p, v, formulation=formulation, projection=zd.Projection(max_iterations=50))
        except zd.CorrectionFailed:     # from where it was put, it does not get back: then in no formulation
            results[formulation] = None
    if any(result is None for result in results.values()):
        assert all(result is None for result in results.values())
        return
    first_p, first_v = results["schur"]
    if np.abs(first_p - p).max() > 0.1:     # the iteration wandered, and what it multiplied on its way is unknown
        return
    for formulation, (now_p, now_v) in results.items():
        assert_close(now_p, first_p, 1e4 * tol.EPS * bound, scale=1.0, what=f"p of {formulation}")
        assert_close(now_v, first_v, 1e4 * tol.EPS * bound, scale=1.0, what=f"v of {formulation}")
        again_p, _ = zd.project(system, now_p, now_v, formulation=formulation)
        assert (again_p == now_p).all()                     # it is where it should be
    C = random.C(first_p)
    assert np.abs(C @ first_v).max() <= 1e3 * tol.EPS * bound * max(1.0, np.abs(first_v).max())
    expected = v - np.linalg.solve(random.M, C.T @ np.linalg.solve(C @ np.linalg.solve(random.M, C.T), C @ v))     # (27b)
    assert_close(first_v, expected, 1e4 * tol.EPS * bound, scale=1.0)


@settings(max_examples=15, deadline=None, derandomize=True)
@given(draws(decades=1))
def test_motions_of_all_formulations_converge_to_each_other(random):
    system = random.system()
    if well_conditioned(random) is None or condition(random.M, random.C(random.p)) > 1e3 or system.m in (0, random.n):
        return
    p, v = zd.project(system, random.p, random.v)
    ends = []
    for formulation in FORMULATIONS:
        sol = zd.simulate(system, 0.1, p, v, step=0.005, formulation=formulation)
        assert np.abs(sol.position_violation / sol.position_size).max(initial=0.0) <= 1e-12
        assert np.abs(sol.velocity_violation).max() <= 1e-11 * max(1.0, np.abs(sol.v).max())
        ends.append(np.concatenate([sol.p[-1], sol.v[-1]]))
    for end in ends:
        assert_close(end, ends[0], 1e-4)


def test_mixed_velocities_satisfy_their_constraints_without_correction():
    """C D = 0: v = D u cannot violate (5), whatever p does."""
    random = Draw(3, 6, 2, 1, 2)
    system = random.system()
    p, v = zd.project(system, random.p, random.v)
    sol = zd.simulate(system, 0.2, p, v, step=0.01, formulation="mixed", stabilization=None)
    assert np.abs(sol.position_violation).max() > 1e-12
    assert np.abs(sol.velocity_violation).max() < 1e-13 * np.abs(sol.v).max()
