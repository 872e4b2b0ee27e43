"""Mechanisms with a part that is light, at random steps, with every integrator: what is wrong, and what of it is said.

Run it with ``python tests/stress/light_parts.py 3000``; it prints the table, and writes it to
``tests/bench/results/light_parts.md``.

A run is wrong if any coordinate is ever off by more than 0.05 rad, or parts of the mechanism's length, from the motion by
"dop853" to 1e-12; it is lost if by more than 0.5. Where that motion differs from the one to 1e-10 by more than 0.01, the truth is
not known.
It is chaotic here if a change of the velocities by 1e-7 of them grows by more than 300.
"""

import sys
import warnings
from collections import Counter
from pathlib import Path

import numpy as np
import sympy as sp

import zerodrift as zd

RESULTS = Path(__file__).resolve().parents[1] / "bench" / "results" / "light_parts.md"
WRONG, LOST, UNKNOWN, CHAOTIC, CHANGE = 0.05, 0.5, 0.01, 300, 1e-7
GRAVITY = 9.81
COLUMNS = ("right", "right, warned of otherwise", "right, warned of by the part", "wrong", "wrong, warned of otherwise",
           "wrong, warned of by the part", "wrong, silent", "wrong, silent, not chaotic", "lost, warned of by the part",
           "lost, silent", "lost, silent, not chaotic", "stopped", "truth not known")


# ---- mechanisms ----


def rods(ends, closed=None, name="rods"):
    """Rods in a plane by their angles, each from the place on a rod that `ends` says, (rod, share of it); None: the ground."""
    n = len(ends)
    angles, rates, lengths, masses = (sp.symbols(f"{letter}0:{n}") for letter in "awLm")
    directions = [sp.Matrix([sp.cos(a), sp.sin(a)]) for a in angles]
    starts, kinetic, potential = [], 0, 0
    for rod, end in enumerate(ends):
        start = sp.zeros(2, 1) if end is None else starts[end[0]] + end[1] * lengths[end[0]] * directions[end[0]]
        starts.append(start)
        centre = start + lengths[rod] / 2 * directions[rod]
        velocity = centre.jacobian(angles) * sp.Matrix(rates)
        kinetic += masses[rod] * (velocity.dot(velocity) / 2 + lengths[rod] ** 2 * rates[rod] ** 2 / 24)
        potential += masses[rod] * GRAVITY * centre[1]
    loop = [] if closed is None else list(starts[closed] + lengths[closed] * directions[closed] - sp.Matrix([1, 0]))
    return zd.symbolic(angles, speeds=rates, kinetic=kinetic, potential=potential, constraints=loop, p0=[0.0] * n,
                       parameters=dict.fromkeys([*lengths, *masses], 1.0), name=name)


def points():
    """Two points on two strings, in metres."""
    q, v = sp.symbols("x0 y0 x1 y1"), sp.symbols("u0 w0 u1 w1")
    (m0, m1), (L0, L1) = sp.symbols("m0:2"), sp.symbols("L0:2")
    return zd.symbolic(
        q, speeds=v, kinetic=(m0 * (v[0]**2 + v[1]**2) + m1 * (v[2]**2 + v[3]**2)) / 2,
        potential=GRAVITY * (m0 * q[1] + m1 * q[3]),
        constraints=[(q[0]**2 + q[1]**2 - L0**2) / 2, ((q[2] - q[0])**2 + (q[3] - q[1])**2 - L1**2) / 2], units=["m"] * 4,
        parameters=dict.fromkeys([m0, m1, L0, L1], 1.0), p0=[1.0, 0.0, 2.0, 0.0], name="points")


KINDS = {
    "two rods": rods([None, (0, 1)]), "three rods": rods([None, (0, 1), (1, 1)]), "points": points(),
    "rod on a four-bar": rods([None, (0, 1), (1, 1), (1, sp.Rational(1, 2))], closed=2),
}


def chain(rng, kind, light):
    """Rods, one of them or all behind one of them light, from anywhere."""
    n = KINDS[kind].nq
    masses = np.full(n, 10 ** rng.uniform(-0.5, 1.5))
    masses[rng.integers(1, n)] *= light
    values = {f"m{i}": masses[i] for i in range(n)} | {f"L{i}": rng.uniform(0.4, 1.6) for i in range(n)}
    return KINDS[kind].with_parameters(**values), rng.uniform(-np.pi, np.pi, n), rng.normal(size=n) * 10 ** rng.uniform(-0.5, 1)


def strings(rng, kind, light):
    """The points, the outer one light."""
    (L0, L1), angles = rng.uniform(0.4, 1.6, 2), rng.uniform(-np.pi, np.pi, 2)
    rates = rng.normal(size=2) * 10 ** rng.uniform(-0.5, 0.8)
    along, across = np.array([np.cos(angles), np.sin(angles)]).T, np.array([-np.sin(angles), np.cos(angles)]).T
    first, second = L0 * along[0], L0 * rates[0] * across[0]
    p, v = np.r_[first, first + L1 * along[1]], np.r_[second, second + L1 * rates[1] * across[1]]
    return KINDS[kind].with_parameters(m1=light, L0=L0, L1=L1), p, v


def hung(rng, kind, light):
    """A light rod on the coupler of a four-bar."""
    values = {"L0": 0.3, "L1": 1.0, "L2": 0.6, "L3": rng.uniform(0.2, 1), "m0": 2.0, "m1": 3.0, "m2": 2.0, "m3": 3 * light}
    system, (crank, rod), rates = KINDS[kind].with_parameters(**values), rng.uniform(-np.pi, np.pi, 2), 5 * rng.normal(size=2)
    return system, *zd.assemble(system, [crank, 0.8, -1.8, rod], [rates[0], 0, 0, rates[1]])


def four_bar(rng, kind, light):
    """The four-bar with a light link."""
    masses = np.ones(3)
    masses[rng.integers(3)] = light
    system = zd.systems.four_bar(lengths=(1, 0.3, 1, 0.6), masses=masses, crank_angle=rng.uniform(-3, 3),
                                 crank_rate=rng.normal() * 10 ** rng.uniform(0, 1))
    return system, system.p0, system.v0


MAKERS = {"two rods": chain, "three rods": chain, "points": strings, "rod on a four-bar": hung, "four-bar": four_bar}


# ---- runs ----


def listened(system, *arguments, **options):
    """A run, and what was said of it."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        sol = zd.simulate(system, *arguments, on_failure="return", **options)
    return sol, [str(warning.message) for warning in said]


def compared(seed):
    """Result of a random run, as words to count; nothing if it failed, or if the exact motion is not known."""
    rng = np.random.default_rng(seed)
    kind = str(rng.choice(list(MAKERS)))
    integrator, h, energy = str(rng.choice(list(zd.integrators()))), 10 ** rng.uniform(-3.2, -1), bool(rng.integers(2)) or None
    try:
        system, p0, v0 = MAKERS[kind](rng, kind, 10 ** rng.uniform(-8, 0))
        sol, said = listened(system, h * int(min(4 / h, 600)), p0, v0, step=h, integrator=integrator, energy=energy)
        if not sol.success:
            return integrator, ["stopped"]
        exact, check, changed = (zd.simulate(system, sol.t[-1], p0, v, t_eval=sol.t, rtol=tol, atol=tol, integrator="dop853").p
                                 for tol, v in ((1e-12, v0), (1e-10, v0), (1e-12, (1 + CHANGE) * v0)))
    except zd.ZerodriftError:
        return integrator, ["stopped"]
    if np.abs(exact - check).max() > UNKNOWN:
        return integrator, ["truth not known"]
    length = np.abs(p0).max() if kind == "points" else 1.0
    return integrator, judged(np.abs(sol.p - exact).max() / length, np.abs(changed - exact).max() / length / CHANGE, said)


def judged(off, growth, said):
    """The columns that a run counts in."""
    by_part = any(sentence.startswith("the steps do not resolve") for sentence in said)
    how = "warned of by the part" if by_part else "warned of otherwise" if said else "silent"
    right = "right" if off <= WRONG else "wrong"
    names = [right, f"{right}, {how}"]
    if off > LOST:
        names.append(f"lost, {how}")
    return [*names, *(f"{name}, not chaotic" for name in names[1:] if growth <= CHAOTIC)]


def main(count):
    """Measure, print and write."""
    counts = {name: Counter() for name in [*zd.integrators(), "all"]}
    for seed in range(count):
        integrator, names = compared(seed)
        counts[integrator].update(names)
        counts["all"].update(names)
    lines = ["| integrator | " + " | ".join(COLUMNS) + " |", "|" + " --- |" * (len(COLUMNS) + 1)]
    lines += [f"| {name} | " + " | ".join(str(found[column]) for column in COLUMNS) + " |" for name, found in counts.items()]
    text = f"## {count} random runs of mechanisms with a low-inertia component\n\n" + "\n".join(lines) + "\n"
    print(text)
    RESULTS.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 3000)
