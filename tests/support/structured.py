"""Systems that declare their structure, each with its dense twin: the same equations, and nothing declared."""

import os
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

import zerodrift as zd
from native_systems import compile_library
from support import ROOT

BODIES = ROOT / "tests" / "native" / "bodies.c"
GROUND = -1


@cache
def bodies_library():
    """The library of native/bodies.c; its folder is that of the tests' cache, which they remove."""
    return compile_library(BODIES, Path(mkdtemp(dir=os.environ.get("ZERODRIFT_CACHE"))) / "bodies.so")


# ---- rods in the plane, compiled ----


class Rods:
    """Rods of length 1 and the pins between them, drawn with the angles given; a pin is (a, b, where on a, where on b)."""

    def __init__(self, centres, angles, pins, masses=None):
        self.pins, self.masses = pins, [1.0] * len(angles) if masses is None else masses
        self.p0 = np.ravel([(*centre, angle) for centre, angle in zip(centres, angles, strict=True)])

    def system(self, packed=True, speed=0.0, gravity=9.81, **options):
        """The structured system, or its twin; the first pin may move along the ground."""
        n = len(self.masses)
        numbers = [n, len(self.pins), gravity, speed]
        numbers += [x for m in self.masses for x in (m, m / 12)] + [x for a, b, *at in self.pins for x in (a, b, *np.ravel(at))]
        groups = [(2, [b] if a == GROUND else [a, b]) for a, b, *_ in self.pins]
        structure = zd.Structure(blocks=[3] * n, groups=groups, mass="constant diagonal") if packed else None
        return zd.native(
            bodies_library(), 3 * n, symbol="packed" if packed else "dense", structure=structure,
            constraints=2 * len(self.pins), scratch=3 * n + 4 * len(self.pins),
            terms=["M", "f", "Phi", "C", "xi", "V", *["Phi_t"] * (speed != 0)], units=["m", "m", "rad"] * n,
            parameters={f"q{i}": float(x) for i, x in enumerate(numbers)}, **({"p0": self.p0} | options))


def chain(n, closed=False, masses=None, bend=0.7):
    """Rods that hang one on the other; the last one's end on the ground, too, if it is closed."""
    angles = np.linspace(-bend, bend, n)
    steps = np.column_stack([np.cos(angles), np.sin(angles)])
    ends = np.cumsum(steps, axis=0)
    pins = [(i - 1, i, (0.5, 0.0) if i else (0.0, 0.0), (-0.5, 0.0)) for i in range(n)]
    if closed:
        pins.append((GROUND, n - 1, ends[-1], (0.5, 0.0)))
    return Rods(ends - steps / 2, angles, pins, masses)


def four_bars(n, angle=1.0, doubled=False, middle=0):
    """A row of n parallelograms, 2 n + 1 rods and 3 n + 1 pins.

    `doubled`: the first pin is there twice; `middle`: one in so many has a second bar, between the middles of its rods.
    """
    tip, up = np.array([np.cos(angle), np.sin(angle)]), angle
    centres, angles, pins = [], [], []
    for i in range(n + 1):
        centres, angles = [*centres, np.add(tip / 2, (i, 0))], [*angles, up]
        if i:
            pins.append((2 * i - 1, 2 * i, (0.5, 0.0), (0.5, 0.0)))
        pins.append((GROUND, 2 * i, (float(i), 0.0), (-0.5, 0.0)))
        if i < n:
            centres, angles = [*centres, np.add(tip, (i + 0.5, 0))], [*angles, 0.0]
            pins.append((2 * i, 2 * i + 1, (0.5, 0.0), (-0.5, 0.0)))
    for i in range(0, n if middle else 0, max(middle, 1)):
        centres, angles = [*centres, np.add(tip / 2, (i + 0.5, 0))], [*angles, 0.0]
        bar = len(angles) - 1
        pins += [(2 * i, bar, (0.0, 0.0), (-0.5, 0.0)), (2 * i + 2, bar, (0.0, 0.0), (0.5, 0.0))]
    return Rods(centres, angles, [*pins[:1] * doubled, *pins])


# ---- anything, in Python ----


class Bodies:
    """Random bodies of random sizes, and random constraints between them; M, C and, if wanted, A depend on p within blocks."""

    def __init__(self, seed, kinematics=False, nonholonomic=True):
        rng = self.rng = np.random.default_rng(seed)
        self.velocities = rng.integers(1, 5, size=rng.integers(2, 5))
        self.at = np.cumsum([0, *self.velocities])
        self.n = n = int(self.at[-1])
        words = list(rng.choice(["", "diagonal"], size=len(self.velocities)))
        self.p, self.v = rng.normal(size=n), rng.normal(size=n)
        self.M = np.zeros((n, n))
        for b, word in enumerate(words):
            here, size = slice(*self.at[b : b + 2]), self.velocities[b]
            root = np.diag(rng.uniform(0.5, 2.0, size)) if word else rng.normal(size=(size, size)) + 2 * np.eye(size)
            self.M[here, here] = root @ root.T
        groups, rows = [], 0
        most = max(1, n - 2)
        while rows < most:
            blocks = sorted(rng.choice(len(words), size=rng.integers(1, min(3, len(words)) + 1), replace=False).tolist())
            count = int(min(rng.integers(1, 3), most - rows))
            groups, rows = [*groups, (count, blocks)], rows + count
        self.m, cut = rows, len(groups) // 2 if nonholonomic else len(groups)
        self.mh = sum(count for count, _ in groups[:cut])
        mask, row = np.zeros((rows, n)), 0
        for count, blocks in groups:
            for b in blocks:
                mask[row : row + count, self.at[b] : self.at[b + 1]] = 1
            row += count
        self.rows = mask * rng.normal(size=(rows, n))
        self.curved = 0.2 * mask * rng.normal(size=(rows, n))
        self.force, self.bias = rng.normal(size=n), rng.normal(size=n)
        self.blocks = np.repeat(np.arange(len(words)), self.velocities)
        self.kinematics = kinematics
        self.structure = zd.Structure([int(size) for size in self.velocities], groups, words)

    def mass(self, p):
        """M, each block scaled by what depends on its own first coordinate."""
        return self.M * (1 + 0.2 * np.sin(p[self.at[self.blocks]]))[:, None]

    def A(self, p):
        """Scales each rate by what depends on its coordinate."""
        return np.eye(self.n) * (1 + 0.2 * np.sin(p))

    def Phi(self, p):
        x = p - self.p
        return self.rows[: self.mh] @ x + self.curved[: self.mh] @ (x * x)

    def slopes(self, p):
        return self.rows[self.mh :] + self.curved[self.mh :] * p

    def system(self, packed=True, **options):
        """The structured system, or its twin."""
        terms = {"mass": self.mass, "force": self.force, "bias": self.bias, "potential": lambda p: p @ p, "p0": self.p,
                 "v0": self.v}
        if self.mh:
            terms["constraints"] = self.Phi
        if self.m > self.mh:
            terms["nonholonomic"] = self.slopes
        if self.kinematics:
            terms["kinematics"] = self.A
        return zd.System(self.n, structure=self.structure if packed else None, **(terms | options))
