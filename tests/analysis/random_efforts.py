"""Random mechanisms, plane and space: efforts of a random motion, and the accelerations under them from plain linear algebra."""

import numpy as np

import zerodrift as zd
from mechanisms.random_starts import mechanism

RANK = 1e-9     # of the largest singular value


def largest_error(seed, in_space, layout):
    """The largest difference of accelerations under computed efforts from those prescribed, relative to these; None: locked."""
    random = np.random.default_rng(seed)
    system = mechanism(seed, in_space)[0].system(layout)
    p, v = system.start_at(0.0)
    free = null_space(system, p)
    if not free.shape[1]:
        return None
    p, v = zd.project(system, p, v + free @ random.standard_normal(free.shape[1]), projection=zd.Projection(tol=1e-13))
    terms, free = system.evaluate(p, v), null_space(system, p)
    C, xi = constraints(system, terms)
    vdot = np.linalg.lstsq(C, xi, rcond=RANK)[0] + free @ random.standard_normal(free.shape[1])
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
