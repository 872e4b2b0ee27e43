"""Random systems with redundant constraints by construction: constraints/test_rank.py compares a few hundred of them,
stress/random_systems.py any number.
"""

import numpy as np

import tolerances as tol
import zerodrift as zd
from support import FORMULATIONS, assert_close, condition

INTEGRATED_VELOCITIES = ("augmented", "nullspace", "schur")     # v is their state: they need no branch
LARGEST_CONDITION = 1e7     # beyond, too few digits are left to compare


class Ranked:
    """A random system of n velocities: Phi and C_NH of full rank times a matrix of more rows than columns.

    In p, all of it is quadratic or linear, so that there are closed forms. `curved` rows are dependent at the start and nowhere
    else; with `massless`, M has so much less than full rank, and is definite where C leaves the velocities free.
    """

    def __init__(self, seed):
        rng = np.random.default_rng(seed)
        n = self.n = int(rng.integers(1, 10))
        rank = int(rng.integers(1, n + 1))
        mh = int(rng.integers(0, rank + 1))
        self.mixing_h, self.mixing_n = (self._mixing(rng, rows) for rows in (mh, rank - mh))
        self.mh, self.mn, self.rank = len(self.mixing_h), len(self.mixing_n), rank
        self.linear, self.quadratic = rng.normal(size=(mh, n)), 0.1 * rng.normal(size=(mh, n, n))
        self.quadratic += self.quadratic.transpose(0, 2, 1)
        self.rows, self.slopes = rng.normal(size=(rank - mh, n)), 0.1 * rng.normal(size=(rank - mh, n, n))
        self.p, self.v, self.f = rng.normal(size=(3, n))
        self.curvature = np.zeros((self.mh, n, n))
        scale = 10.0 ** rng.uniform(-2, 2, n)
        root = rng.normal(size=(n, n))
        self.M = (root @ root.T + np.eye(n)) * np.sqrt(np.outer(scale, scale))
        self.rng = rng

    @staticmethod
    def _mixing(rng, rows):
        """All of these rows, and up to three that follow from them, in any order and in units of their own."""
        more = int(rng.integers(0, 4)) if rows else 0
        mixing = np.vstack([np.eye(rows), rng.normal(size=(more, rows)) * (rng.random((more, rows)) < 0.7)])
        return rng.permutation(mixing) * 10.0 ** rng.uniform(-2, 2, (rows + more, 1))

    def curved(self):
        """The same, with every holonomic row that is redundant bent; at rest, where all of them agree."""
        self.curvature = self.rng.normal(size=self.curvature.shape)
        self.curvature += self.curvature.transpose(0, 2, 1)
        self.v = np.zeros(self.n)
        return self

    def massless(self):
        """The same, with no more coordinates without mass than constraints can hold."""
        some = self.rng.permutation(self.n)[: self.rng.integers(1, self.rank + 1)]
        self.M[some] = self.M[:, some] = 0.0
        return self

    def Phi(self, p):
        from_start = p - self.p
        base = self.linear @ from_start + (p @ self.quadratic @ p - self.p @ self.quadratic @ self.p) / 2
        return self.mixing_h @ base + (self.curvature @ from_start) @ from_start / 2

    def C(self, p):
        return np.vstack([self.mixing_h @ (self.linear + self.quadratic @ p) + self.curvature @ (p - self.p),
                          self.mixing_n @ (self.rows + self.slopes @ p)])

    def xi(self, v):
        """(6): minus the rate of C along the motion, times v."""
        return -np.concatenate([self.mixing_h @ ((self.quadratic @ v) @ v) + (self.curvature @ v) @ v,
                                self.mixing_n @ ((self.slopes @ v) @ v)])

    def system(self):
        terms = {"mass": self.M, "force": self.f, "potential": 0.0, "p0": self.p, "v0": self.v}
        if self.mh:
            terms["constraints"] = self.Phi
        if self.mn:
            terms["nonholonomic"] = lambda p: self.mixing_n @ (self.rows + self.slopes @ p)
        return zd.System(self.n, **terms)

    def condition(self):
        """Condition of (8) with an orthonormal basis of the rows of C, or of C with rows of unit length, squared, if larger."""
        C = self.C(self.p)
        C = C / np.maximum(np.linalg.norm(C, axis=1), 1e-300)[:, None]
        values, basis = np.linalg.svd(C)[1:]
        return max(condition(self.M, basis[: self.rank]), (values[0] / values[self.rank - 1]) ** 2)

    def solved(self):
        """NumPy's vdot of (8), and its multipliers: those of least norm, where row k is measured by sqrt(C_k inv(M) C_k^T)."""
        C, xi = self.C(self.p), self.xi(self.v)
        basis = np.linalg.svd(C / np.maximum(np.linalg.norm(C, axis=1), 1e-300)[:, None])[2]
        rows, free = basis[: self.rank], basis[self.rank:]
        particular = np.linalg.lstsq(C @ rows.T, xi, rcond=None)[0] @ rows
        vdot = particular + free.T @ np.linalg.solve(free @ self.M @ free.T, free @ (self.f - self.M @ particular))
        reaction = self.f - self.M @ vdot
        singular = not self.M.diagonal().all()
        size = np.linalg.norm(C, axis=1) if singular else np.sqrt(np.einsum("ki,ki->k", C, np.linalg.solve(self.M, C.T).T))
        size = np.where(size > 0, size, 1.0)
        return vdot, size, np.linalg.lstsq((C / size[:, None]).T, reaction, rcond=1e-9)[0] / size


def compare(random, formulations, **options):
    """Accelerations and multipliers of these formulations with NumPy's; whether there was something to compare."""
    bound = random.condition()
    if bound > LARGEST_CONDITION:
        return False
    system, (vdot, size, multipliers) = random.system(), random.solved()
    for name in formulations:
        got, reactions = zd.acceleration(system, random.p, random.v, formulation=name, **options)
        assert_close(got, vdot, 1e4 * tol.EPS * bound, scale=1.0, what=f"vdot of {name}")
        assert_close(size * reactions, size * multipliers, 1e4 * tol.EPS * bound, scale=1.0, what=f"lambda of {name}")
    return True


def raises(error, call):
    """True if the call raises this error."""
    try:
        call()
    except error:
        return True
    return False


def check_redundant(seed):
    """Every formulation finds the same motion and the smallest multipliers, whatever the rank."""
    return compare(Ranked(seed), FORMULATIONS)


def check_massless(seed):
    """So do all that do not invert M where it is singular, and the one that does says so."""
    random = Ranked(seed).massless()
    if not compare(random, [name for name in FORMULATIONS if name != "schur"]):
        return False
    assert raises(zd.SingularSystem, lambda: zd.acceleration(random.system(), random.p, random.v, formulation="schur"))
    return True


def on_branch(random, vdot):
    """Relative residual of the second-order conditions along p + vdot t^2 / 2, and the acceleration on that branch.

    The combinations in which rows of C vanish are, applied to Phi, of second order, and their gradients along the branch are
    constraints again.
    """
    C = random.C(random.p)[: random.mh]
    left, values, _ = np.linalg.svd(C)
    combinations = left[:, np.sum(values > 1e-9 * values.max(initial=0.0)):].T
    second = np.einsum("ck,kij->cij", combinations, np.tensordot(random.mixing_h, random.quadratic, 1) + random.curvature)
    rows = np.vstack([random.C(random.p), second @ vdot])
    rank = np.linalg.matrix_rank(rows / np.maximum(np.linalg.norm(rows, axis=1), 1e-300)[:, None], tol=1e-7)
    free = np.linalg.svd(rows)[2][rank:].T
    along = free @ np.linalg.solve(free.T @ random.M @ free, free.T @ random.f)
    size = np.linalg.norm(second, axis=(1, 2)) * (vdot @ vdot)
    return np.abs(vdot @ second @ vdot).max() / size.max(), along


def check_bifurcation(seed):
    """Every formulation raises `Bifurcation` where the rank drops at this point only. From rest, all find the branch of minimum
    acceleration; without a branch, those that can continue take the minimum acceleration.
    """
    random = Ranked(seed).curved()
    bound = random.condition()
    if random.mh == random.mixing_h.shape[1] or random.n == random.rank or bound > LARGEST_CONDITION:
        return False        # no such row, or no motion that it could hinder
    system, (least, _, _) = random.system(), random.solved()
    first, _ = zd.acceleration(system, random.p, random.v, formulation="schur", on_singular="continue")
    left, along = on_branch(random, first)
    for name in FORMULATIONS:
        assert raises(zd.Bifurcation, lambda name=name: zd.acceleration(system, random.p, random.v, formulation=name))
        if left > 1e-8 and name not in INTEGRATED_VELOCITIES:
            assert raises(zd.Bifurcation, lambda name=name: zd.acceleration(system, random.p, random.v, formulation=name,
                                                                              on_singular="continue"))
            continue
        got, _ = zd.acceleration(system, random.p, random.v, formulation=name, on_singular="continue")
        expected, tolerance = (least, 1e4 * tol.EPS * bound) if left > 1e-8 else (along, 1e-8 + 1e-9 * bound)
        assert_close(got, expected, tolerance, scale=1.0, what=f"vdot of {name}")
    return True


class Branched(Ranked):
    """The same, with two surfaces crossing at the start, alpha(p) beta(p) = 0, and a motion along the one where alpha is zero.

    What is true of the motion is true of the system that has alpha(p) = 0 for the product.
    """

    def __init__(self, seed):
        super().__init__(seed)
        self.alpha, self.beta = self.rng.normal(size=(2, self.n))
        self.bend = 0.1 * self.rng.normal(size=(self.n, self.n))
        self.bend += self.bend.T
        self.mixing = self._mixing(self.rng, len(self.linear) + 1)
        rows = np.vstack([self.linear + self.quadratic @ self.p, self.rows + self.slopes @ self.p, self.alpha])
        self.v -= np.linalg.pinv(rows) @ (rows @ self.v)
        self.along = rows
        self.base_xi = -np.concatenate([(self.quadratic @ self.v) @ self.v, (self.slopes @ self.v) @ self.v,
                                        [self.v @ self.bend @ self.v]])

    def system(self):
        def constraints(p):
            from_start = p - self.p
            base = self.linear @ from_start + (p @ self.quadratic @ p - self.p @ self.quadratic @ self.p) / 2
            alpha, beta = self.alpha @ from_start + from_start @ self.bend @ from_start / 2, self.beta @ from_start
            return self.mixing @ np.append(base, alpha * beta)

        terms = {"constraints": constraints}
        if self.mn:
            terms["nonholonomic"] = lambda p: self.mixing_n @ (self.rows + self.slopes @ p)
        return zd.System(self.n, mass=self.M, force=self.f, potential=0.0, p0=self.p, v0=self.v, **terms)


def check_branch(seed):
    """At a bifurcation every formulation finds the acceleration of the motion that goes through it."""
    random = Branched(seed)
    if random.rank == random.n or np.linalg.norm(random.v) < 0.1 or abs(random.beta @ random.v) < 0.1 * np.linalg.norm(random.v):
        return False
    rows = random.along / np.linalg.norm(random.along, axis=1)[:, None]
    bound = max(condition(random.M, rows), (np.linalg.cond(random.mixing) * np.linalg.cond(rows)) ** 2)
    if bound > LARGEST_CONDITION:
        return False
    C, n = random.along, random.n
    matrix = np.block([[random.M, C.T], [C, np.zeros((len(C), len(C)))]])
    expected = np.linalg.solve(matrix, np.concatenate([random.f, random.base_xi]))[:n]
    system = random.system()
    for name in FORMULATIONS:
        got, _ = zd.acceleration(system, random.p, random.v, formulation=name, on_singular="continue")
        assert_close(got, expected, 1e-8 + 1e-9 * bound, scale=1.0, what=f"vdot of {name}")       # rates are differences
        assert raises(zd.Bifurcation, lambda name=name: zd.acceleration(system, random.p, random.v, formulation=name))
    return True


CHECKS = {"redundant": check_redundant, "massless": check_massless, "bifurcation": check_bifurcation,
          "branch": check_branch}
