"""Random systems of many bodies with a declared structure: point/test_weighted.py compares a few of them with dense matrices,
stress/networks.py any number.
"""

import numpy as np

import tolerances as tol
import zerodrift as zd
from structured import Bodies
from support import assert_close, condition, solved

STEPS = {"step": 1e-3}
MAX_ROUNDINGS = 1e3
LARGEST_CONDITION = 1e9     # beyond, too few digits are left to compare


class Network(Bodies):
    """Bodies that hang on each other as a tree, with loops, and on one that has many joints; blocks and groups of random sizes.

    Phi is quadratic, with rows of random numbers; the last groups are nonholonomic. M is full in some blocks, diagonal in others.
    `redundant`: so many groups are redundant, one from one each. `massless`: so many bodies have no mass in one of their
    velocities, where constraints hold them.
    """

    def __init__(self, seed, bodies=None, redundant=0, massless=0):
        rng = self.rng = np.random.default_rng(seed)
        count = int(rng.integers(2, 14)) if bodies is None else bodies
        are_alike = rng.random() < 0.3
        self.velocities = np.full(count, rng.choice([3, 6])) if are_alike else rng.choice([3, 3, 3, 6, 6, 4, 7], size=count)
        self.at = np.cumsum([0, *self.velocities])
        self.n = n = int(self.at[-1])
        self.p, self.v = rng.normal(size=n), rng.normal(size=n)
        words = list(rng.choice(["", "diagonal", "constant diagonal"], size=count))
        self.M, self.varies = np.zeros((n, n)), np.zeros(n)
        for b, word in enumerate(words):
            here, size = slice(*self.at[b : b + 2]), self.velocities[b]
            root = np.diag(rng.uniform(0.5, 2.0, size)) if word else rng.normal(size=(size, size)) + 2 * np.eye(size)
            self.M[here, here] = root @ root.T * 10.0 ** rng.uniform(-1, 1)
            self.varies[here] = "constant" not in word
        more = np.random.default_rng([seed, redundant, massless])
        for b in more.choice(count, size=min(massless, count), replace=False):
            i = self.at[b] + more.integers(self.velocities[b])
            self.M[i], self.M[:, i] = 0, 0
        groups = self._joints(count)
        self.m, cut = sum(rows for rows, _ in groups), len(groups) - int(rng.integers(0, 3))
        self.mh = sum(rows for rows, _ in groups[:cut])
        mask, row = np.zeros((self.m, n)), 0
        for rows, blocks in groups:
            for b in blocks:
                mask[row : row + rows, self.at[b] : self.at[b + 1]] = 1
            row += rows
        self.rows, self.curved = (size * mask * rng.normal(size=(self.m, n)) for size in (1.0, 0.1))
        self.force, self.bias = rng.normal(size=n), rng.normal(size=n)
        self.blocks, self.kinematics, self.groups = np.repeat(np.arange(count), self.velocities), False, groups
        self.following = np.zeros(self.m, dtype=bool)      # redundant rows
        for _ in range(redundant):
            self._repeat(more)
        self.structure = zd.Structure([int(size) for size in self.velocities], self.groups, words)

    def _repeat(self, rng):
        """Insert a redundant group beside a holonomic one: at most as many rows, each a linear combination of that group's."""
        ends = np.cumsum([rows for rows, _ in self.groups])
        g = int(rng.integers(np.searchsorted(ends, self.mh) + 1))
        rows, blocks = self.groups[g]
        count, own = int(rng.integers(1, rows + 1)), slice(ends[g] - rows, ends[g])
        shares = rng.normal(size=(count, rows))
        self.groups = [*self.groups[: g + 1], (count, blocks), *self.groups[g + 1 :]]
        self.rows, self.curved = (np.insert(x, [ends[g]] * count, shares @ x[own], axis=0) for x in (self.rows, self.curved))
        self.following = np.insert(self.following, [ends[g]] * count, True)
        self.m, self.mh = self.m + count, self.mh + count

    def _joints(self, count):
        """Each body on an earlier one, on the ground or on a hub, with fewer rows than it has velocities; then loops."""
        rng, groups, hub = self.rng, [], int(self.rng.integers(count)) if self.rng.random() < 0.4 else None
        left = np.array(self.velocities)
        for b in range(count):
            other = hub if hub is not None and rng.random() < 0.8 else int(rng.integers(-1, b)) if b else -1
            rows = int(min(rng.integers(1, 4), left[b] - 1)) if rng.random() < 0.6 else int(left[b] - 1)
            groups.append((max(rows, 1), sorted({b} | ({other} if other is not None and other >= 0 else set()))))
            left[b] -= max(rows, 1)
        for _ in range(int(rng.integers(0, count))):
            ends = sorted(rng.choice(count, size=int(rng.integers(1, min(3, count) + 1)), replace=False).tolist())
            if left[ends].sum() > 1 and left[ends[0]] > 0:
                groups.append((1, ends))
                left[ends[0]] -= 1
        return groups

    def mass(self, p):
        """M, each block that is not constant scaled by what depends on its own first coordinate."""
        return self.M * (1 + 0.2 * self.varies * np.sin(p[self.at[self.blocks]]))[:, None]


def expected(network, e):
    """Accelerations and multipliers of dense equations, the latter of least effect; and their condition."""
    force, independent = e.f - e.d, ~network.following
    C = e.C[independent]
    vdot, multipliers = solved(e.M, C, force, e.xi[independent])
    bound = condition(e.M, C)
    if independent.all():
        return vdot, multipliers, bound
    masses = np.linalg.eigvalsh(e.M)
    is_definite = masses[0] > 1e-12 * masses[-1]
    effect = np.sqrt(np.einsum("ki,ki->k", e.C, np.linalg.solve(e.M, e.C.T).T if is_definite else e.C))
    bound = max(bound, effect.max() / effect.min())     # these are weights of the multipliers
    return vdot, np.linalg.lstsq((e.C / effect[:, None]).T, C.T @ multipliers, rcond=1e-9)[0] / effect, bound


def check_accelerations(seed, formulations, **kind):
    """Errors of accelerations and multipliers of a network by each formulation against dense equations, in units of rounding
    times their condition; None if the network is too ill-conditioned for a comparison.
    """
    network = Network(seed, **kind)
    system = network.system()
    e = system.evaluate(network.p, network.v)
    vdot, multipliers, bound = expected(network, e)
    if bound > LARGEST_CONDITION:
        return None
    off = {}
    for formulation in formulations:
        got, reactions = zd.acceleration(system, network.p, network.v, formulation=formulation)
        pairs = (got, vdot), (reactions, multipliers)
        off[formulation] = max(np.abs(x - y).max() / max(1.0, np.abs(y).max()) for x, y in pairs) / (bound * tol.EPS)
    return off


def check_acceleration(seed, formulation, **kind):
    """Check that a formulation agrees with dense equations; False if too ill-conditioned for a comparison."""
    off = check_accelerations(seed, [formulation], **kind)
    if off:
        assert off[formulation] < MAX_ROUNDINGS, f"seed {seed} is off by {off[formulation]:.3g} roundings times the condition"
    return off is not None


def check_motion(seed, formulation):
    """Check that a network moves as its twin without a structure; False if too ill-conditioned, or if the twin's run fails.

    The steps are of order four, so that a different choice of independent variables makes no visible difference.
    """
    network = Network(seed)
    if network.m == network.n:
        return False
    e = network.system().evaluate(network.p, network.v)
    bound = condition(e.M, e.C)
    if bound > LARGEST_CONDITION:
        return False
    start = zd.assemble(network.system(), network.p, network.v)
    try:
        other = zd.simulate(network.system(packed=False), 2e-3, *start, formulation=formulation, **STEPS)
    except zd.ZerodriftError:
        return False
    one = zd.simulate(network.system(), 2e-3, *start, formulation=formulation, **STEPS)
    for name in ("p", "v"):
        allowed = 1e-9 + bound * tol.EPS * 1e3
        assert_close(getattr(one, name), getattr(other, name), allowed, scale=1.0, what=f"{name}, seed {seed}")
    return True
