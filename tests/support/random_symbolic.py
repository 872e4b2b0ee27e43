"""Random symbolic systems: driven, nonholonomic, with a kinematic matrix."""

import numpy as np
import sympy as sp

import zerodrift as zd


def random_system(seed, apart=None):
    """Random system of up to six velocities: M full or nearly diagonal, both kinds of constraints, some driven, some with A.

    With `apart`, the last holonomic constraint is twice the first plus `apart` times the displacement of the last coordinate.
    """
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 7))
    mh = int(rng.integers(0, n))
    mn = int(rng.integers(0, n - mh))
    q, u, t = sp.symbols(f"q:{n}"), sp.symbols(f"u:{n}"), sp.Symbol("t")
    a = sp.Symbol("a")
    numbers_ = rng.uniform(0.5, 2, (3, n))
    kinetic = sum(m * w**2 / 2 for m, w in zip(numbers_[0], u, strict=True))
    kinetic += sum(a * sp.cos(q[i] - q[i - 1]) * u[i] * u[i - 1] / 8 for i in range(1, n) if rng.random() < 0.7)
    p0 = rng.uniform(-1, 1, n)
    rows = []
    for k in range(mh):
        terms = [(i, *rng.uniform(0.3, 2, 2)) for i in rng.permutation(n)[: int(rng.integers(1, 4))]]
        row = sum(size * sp.sin(q[i] + shift) for i, size, shift in terms) + q[k]
        driven = sp.sin(t + 1) if seed % 3 == 0 else 0
        rows.append(row + driven - row.subs(dict(zip(q, p0, strict=True))) - (np.sin(1) if seed % 3 == 0 else 0))
    if apart is not None:
        rows.append(2 * rows[0] + sp.Symbol("apart") * (q[-1] - p0[-1]))
    rolling = [sum(sp.cos(q[i] * rng.uniform(0.5, 2)) * u[i] * rng.uniform(0.5, 2) for i in rng.permutation(n)[:3])
               for _ in range(mn)]
    if seed % 3 == 0:
        rolling = [row + sp.cos(t) for row in rolling]
    options = {}
    if seed % 4 == 1:
        A = np.eye(n) + 0.2 * rng.uniform(-1, 1, (n, n))
        options["kinematics"] = sp.Matrix(A) * sp.diag(*[1 + sp.sin(x) / 4 for x in q])
        options["mass"], kinetic = sp.hessian(kinetic, u), None
    else:
        options["kinetic"] = kinetic
    potential = sum(m * sp.sin(x) for m, x in zip(numbers_[1], q, strict=True))
    damping = [-d * w for d, w in zip(numbers_[2], u, strict=True)]
    parameters = {a: 1.0} | ({} if apart is None else {"apart": apart})
    return zd.symbolic(q, speeds=u, constraints=rows, nonholonomic=rolling, potential=potential, force=damping,
                       parameters=parameters, time=t, p0=p0, v0=np.zeros(n), **options)
