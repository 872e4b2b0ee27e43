"""Random systems of many bodies that declare their structure: point/test_weighted.py compares a few of them with dense matrices,
stress/networks.py as many as it is told to.
"""

import numpy as np

import tolerances as tol
import zerodrift as zd
from structured import Bodies
from support import assert_close, condition, solved

STEPS = {"step": 1e-3}
LARGEST_CONDITION = 1e9     # beyond, too few digits are left to compare


class Network(Bodies):
    """Bodies that hang on each other as a tree, with loops, and on one that has many joints; blocks and groups of random sizes.

    Phi is quadratic, with rows of random numbers; the last groups are nonholonomic. M is full in some blocks, diagonal in others.
    """

    def __init__(self, seed, bodies=None):
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
        self.structure = zd.Structure([int(size) for size in self.velocities], groups, words)

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


def check_acceleration(seed, formulation):
    """Whether accelerations and multipliers of a network are those of dense equations; False: too ill-conditioned to tell."""
    network = Network(seed)
    system = network.system()
    e = system.evaluate(network.p, network.v)
    force = e.f - e.d
    bound = condition(e.M, e.C)
    if bound > LARGEST_CONDITION:
        return False
    vdot, multipliers = solved(e.M, e.C, force, e.xi)
    got, reactions = zd.acceleration(system, network.p, network.v, formulation=formulation)
    bound *= 1e3 * tol.EPS
    assert_close(got, vdot, bound, scale=1.0, what=f"vdot, seed {seed}")
    assert_close(reactions, multipliers, bound, scale=1.0, what=f"multipliers, seed {seed}")
    return True


def check_motion(seed, formulation):
    """Whether a network moves as its twin that declares nothing; False: too ill-conditioned to tell, or the twin cannot go on either.

    What is compared are steps of order four, so that it does not matter that independent variables are chosen differently.
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
        assert_close(getattr(one, name), getattr(other, name), 1e-9 + bound * tol.EPS * 1e3, scale=1.0, what=f"{name}, seed {seed}")
    return True
