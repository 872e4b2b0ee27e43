"""Random mechanisms, plane and space: efforts of a random motion, and the accelerations under them from plain linear algebra."""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import qr

import zerodrift as zd
from mechanisms.random_starts import mechanism
from support import drawn_in

RANK = 1e-9     # of the largest singular value


def largest_error(seed, in_space, layout):
    """The largest difference of accelerations under computed efforts from those prescribed, relative to these; None: locked."""
    random = np.random.default_rng(seed)
    system = mechanism(seed, in_space)[0].system(layout)
    p, v = system.start_at(0.0)
    free = null_space(system, p)
    if not free.shape[1]:
        return None
    p, v = zd.project(system, p, v + free @ drawn_in(free, random), projection=zd.Projection(tol=1e-13))
    terms, free = system.evaluate(p, v), null_space(system, p)
    C, xi = constraints(system, terms)
    vdot = np.linalg.lstsq(C, xi, rcond=RANK)[0] + free @ drawn_in(free, random)
    names = [each.name for each in system.velocities]
    inv = zd.inverse_dynamics(system, 0.0, p, v, vdot, efforts=names)
    assert inv.residual[0] < 1e-9 * (1 + np.abs(terms.f).max())
    found = accelerations(system, terms, np.array([inv[name][0] for name in names]))
    return float(np.abs(found - vdot).max() / np.abs(vdot).max())


def constraints(system, terms):
    """C (m, nv) and xi (m,)."""
    return (np.zeros((0, system.nv)), np.zeros(0)) if terms.C is None else (terms.C, terms.xi)


def null_space(system, p):
    """Orthonormal velocities (nv, k) that the constraints allow."""
    C, _ = constraints(system, system.evaluate(p, np.zeros(system.nv)))
    _, values, vectors = np.linalg.svd(C)
    return vectors[(values > RANK * values.max(initial=0.0)).sum():].T


def accelerations(system, terms, force):
    """Vdot (nv,) under an additional generalized force: on the null space of C, and across it by (6)."""
    (C, xi), zero = constraints(system, terms), np.zeros(system.nv)
    _, values, vectors = np.linalg.svd(C)
    V = vectors[(values > RANK * values.max(initial=0.0)).sum():].T
    f = (zero if terms.f is None else terms.f) - (zero if terms.d is None else terms.d) + force
    across = np.linalg.lstsq(C, xi, rcond=RANK)[0]
    return across + V @ np.linalg.solve(V.T @ terms.M @ V, V.T @ (f - terms.M @ across))


class Driven:
    """A random mechanism whose efforts are computed in each stage of each step so that independent velocities follow u(t).

    u(t) = u0 + rate sin(t) of the velocities that a pivoted factorization of the null space of C chooses.
    """

    def __init__(self, seed, in_space, layout):
        random = np.random.default_rng(seed)
        self.base = base = mechanism(seed, in_space)[0].system(layout)
        self.p, _ = base.start_at(0.0)
        free = null_space(base, self.p)
        self.freedoms = free.shape[1]
        self.chosen = qr(free.T, pivoting=True)[2][:self.freedoms]
        self.names = [each.name for each in base.velocities]
        self.u0, self.rate = (0.5 * random.standard_normal(self.freedoms) for _ in range(2))

    def velocities(self, t, p):
        """V (nv,) at a position: those chosen are u(t), the others follow from C v = 0."""
        return self._determined(p, np.zeros(self.base.m), self.u0 + self.rate * np.sin(t))

    def _determined(self, p, across, along):
        C, _ = constraints(self.base, self.base.evaluate(p, np.zeros(self.base.nv)))
        return np.linalg.lstsq(np.vstack([C, np.eye(self.base.nv)[self.chosen]]), np.concatenate([across, along]), rcond=RANK)[0]

    def force(self, t, p, v):
        """F (nv,) with the efforts of `zd.inverse_dynamics` at this state, projected, as stages are not on the constraints."""
        p, v = zd.project(self.base, p, v, t)
        terms = self.base.evaluate(p, v, t)
        vdot = self._determined(p, constraints(self.base, terms)[1], self.rate * np.cos(t))
        inv = zd.inverse_dynamics(self.base, t, p, v, vdot, efforts=self.names)
        given = 0.0 if terms.f is None else terms.f
        return given + np.array([inv[name][0] for name in self.names])

    def system(self):
        """The mechanism under these efforts, as a system of plain functions."""
        base, none = self.base, np.zeros(self.base.nv)

        def term(name):
            return None if getattr(base.evaluate(self.p, none), name) is None else (
                lambda t, p, v: getattr(base.evaluate(p, v, t), name))

        def jacobian(p):
            terms = base.evaluate(p, none)
            return terms.C if terms.A is None else terms.C @ np.linalg.pinv(terms.A)

        moving = {"constraints": lambda p: base.evaluate(p, none).Phi, "jacobian": jacobian, "xi": term("xi")} if base.mh else {}
        kinematics = {} if term("A") is None else {"kinematics": lambda p: base.evaluate(p, none).A}
        return zd.System([each.name for each in base.coordinates], mass=lambda p: base.evaluate(p, none).M, force=self.force,
                         bias=term("d"), quaternions=list(base.quaternions), p0=self.p, v0=self.velocities(0.0, self.p), **moving,
                         **kinematics)

    def positions(self, seconds):
        """P (nq,) after that time, from the velocities alone."""
        def pdot(t, p):
            v = self.velocities(t, p)
            A = self.base.evaluate(p, v).A
            return v if A is None else A @ v

        return solve_ivp(pdot, (0.0, seconds), self.p, method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
