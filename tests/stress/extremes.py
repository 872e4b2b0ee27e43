"""Tables of extreme cases: scales, energies that cannot be corrected, large steps, bifurcations, stiffness.

Run it with ``python tests/stress/extremes.py``; it prints the tables and writes them to ``tests/bench/results/extremes.md``.
With names of integrators, ``python tests/stress/extremes.py rk4 dop853``, it draws among these and only prints: a new one changes
all that is drawn after it, so that tables before and after it compare only where it is left out.
"""

import itertools
import sys
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

import zerodrift as zd

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parent / "support")]

from turning_cranks import LENGTHS, side  # noqa: E402
from units import MECHANISMS, Units, run  # noqa: E402

RESULTS = HERE.parent / "bench" / "results" / "extremes.md"
TRIALS = 4000
NEARLY = 1000
DECADES = np.logspace(-3, 3, 13)
METHODS = sys.argv[1:] or list(zd.integrators())


def table(title, columns, rows):
    """A table in Markdown."""
    lines = [f"## {title}", "", "| " + " | ".join(columns) + " |", "|" + " --- |" * len(columns)]
    return "\n".join([*lines, *("| " + " | ".join(map(str, row)) + " |" for row in rows)]) + "\n"


def listened(*arguments, **options):
    """A run that may fail, and what was said of it."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        sol = zd.simulate(*arguments, on_failure="return", **options)
    return sol, [warning.category.__name__ for warning in said]


# ---- scaling ----


def difference(one, other):
    """The largest, relative to each quantity's size."""
    keys = ("p", "v", "multipliers", "kinetic_energy")
    return max(np.abs(one[key] - other[key]).max() / np.abs(one[key]).max() for key in keys)


def scaling():
    """Each mechanism, formulation and integrator in other units."""
    units = {"micrometres": Units(length=1e6), "kilometres": Units(length=1e-3), "masses * 1e9": Units(mass=1e9),
             "masses * 1e-9": Units(mass=1e-9), "milliseconds": Units(time=1e3), "lengths * 2^20": Units(length=2.0**20),
             "masses * 2^30": Units(mass=2.0**30), "times * 2^10": Units(time=2.0**10)}
    for (what, u), name in itertools.product(units.items(), MECHANISMS):
        found, same = [], 0
        for formulation, integrator in itertools.product(zd.formulations(), METHODS):
            one, other = (run(name, each, formulation=formulation, integrator=integrator) for each in (Units(), u))
            found.append(difference(one, other))
            same += all(np.array_equal(one[key], other[key]) for key in one)
        yield what, name, len(found), f"{same} to the last bit", f"{max(found):.1g}"


# ---- energy ----


def energy():
    """Pendulums from nearly no kinetic energy to plenty, corrected after every step."""
    rng, h = np.random.default_rng(29), 0.02
    for low, high in ((-20, -12), (-12, -4), (-4, 1)):
        count, largest, finite = Counter(), 0.0, True
        for _ in range(100):
            pendulum = zd.systems.pendulum(angle=rng.uniform(0.01, 3), rate=10 ** rng.uniform(low, high))
            sol, said = listened(pendulum, 100 * h, step=h, integrator="heun", energy=True)
            left, told = sol.stats["energy_skipped"], "CorrectionWarning" in said
            count.update(corrected=sol.stats["energy_corrections"], left=left, said=told, silent=left > 0 and not told)
            finite &= bool(np.isfinite(sol.v).all())
            kept = np.flatnonzero(sol.energy_skipped[1:] == 0) + 1
            scale = sol.kinetic_energy.max() + 2 * 9.81
            largest = max(largest, np.abs(sol.energy_violation[kept]).max(initial=0) / scale)
        yield (f"rate 1e{low} ... 1e{high} rad/s", 100, 10000, count["corrected"], count["left"], count["said"], count["silent"],
               f"{largest:.1g}", finite)


# ---- large steps ----


def large_steps():
    """Four-bars from anywhere, whose two assemblies no motion connects."""
    rng, edges = np.random.default_rng(5), (0.0, 0.1, 0.3, 1.0, 3.0, 10.0, np.inf)
    counts = {edge: Counter() for edge in edges[:-1]}
    for _ in range(TRIALS):
        rate = rng.normal() * 10 ** rng.uniform(0, 1)
        bar = zd.systems.four_bar(lengths=LENGTHS[rng.integers(3)], assembly=["open", "crossed"][rng.integers(2)],
                                  crank_angle=rng.uniform(-3, 3), crank_rate=rate)
        h = 10 ** rng.uniform(-2, 0.3)
        options = {"formulation": rng.choice(list(zd.formulations())), "integrator": rng.choice(METHODS)}
        sol, _ = listened(bar, 30 * h, step=h, **{name: str(value) for name, value in options.items()})
        speed = np.abs(sol.v).max() * h
        count = counts[max(edge for edge in counts if speed >= edge)]
        helped = sol.stats["subdivided"] + sol.stats["damped"] > 0
        count.update(tried=1, jumped=(side(sol) != side(sol)[0]).any(), plain=sol.success and not helped,
                     helped=sol.success and helped, stopped=not sol.success)
    for low, high in itertools.pairwise(edges):
        c = counts[low]
        yield f"{low:g} ... {high:g}", c["tried"], c["plain"], c["helped"], c["stopped"], int(c["jumped"])


# ---- bifurcations ----


def bifurcations():
    """Parallelograms, and what is nearly one, from anywhere over half a turn and more, against adaptive steps."""
    rng = np.random.default_rng(11)
    for low, high in ((-np.inf, -np.inf), (-12, -8), (-8, -6), (-6, -4), (-4, -2), (-2, -1)):
        counts = Counter()
        for _ in range(NEARLY):
            off = 10 ** rng.uniform(low, high) * rng.choice([-1, 1]) if np.isfinite(low) else 0.0
            bar = zd.systems.four_bar(lengths=(1 + off, 0.3, 1, 0.3), gravity=rng.choice([0.0, 9.81]),
                                      crank_angle=rng.uniform(1.2, 1.9), crank_rate=rng.uniform(5, 15))
            chosen = {"integrator": "dop853", "rtol": 1e-11, "atol": 1e-11}
            options = {"formulation": rng.choice(list(zd.formulations())), "integrator": rng.choice(METHODS),
                       "on_singular": rng.choice(["stop", "continue"])}
            options = {name: str(value) for name, value in options.items()} | {"energy": bool(rng.integers(2)) or None}
            true, _ = listened(bar, 0.5, on_singular="stop" if off else "continue", **chosen)
            sol, said = listened(bar, 0.5, step=0.5 / 10 ** rng.uniform(1.4, 3.4), **options)
            right = sol.success and np.abs(sol.p[-1] - true.p[-1]).max() < 0.05
            named = "taken" if off and sol.stats["rank_drops"] and sol.success else "said" if said else ""
            outcome = f"right{named}" if right else "stopped" if not sol.success else named or "wrong"
            counts.update([outcome], unknown=not true.success)
        what = "a parallelogram" if not np.isfinite(low) else f"off by 1e{low} ... 1e{high}"
        yield (what, NEARLY, *(counts[key] for key in ("right", "rightsaid", "said", "stopped", "taken", "wrong", "unknown")))


# ---- stiffness ----


def stiffness():
    """An oscillator for 1000 steps: the amplitude it ends with, of the true one."""
    for integrator in METHODS:
        cells = []
        for omega_h in DECADES:
            oscillator = zd.systems.oscillator(mass=1.0, stiffness=100.0)
            sol, said = listened(oscillator, 100 * omega_h, step=omega_h / 10, integrator=integrator)
            with np.errstate(over="ignore"):
                swing = np.hypot(sol.p[-1, 0], sol.v[-1, 0] / 10) / 0.1
            mark = "x" if not sol.success else "!" if said else ""
            cells.append(f"{swing:.3g}{mark}")
        yield integrator, *cells


def main():
    """Measure, print and write."""
    text = "\n".join([
        table("Units", ("unit", "mechanism", "runs", "unchanged", "largest relative difference"), scaling()),
        table("Energy corrections", ("start", "runs", "steps", "corrected", "left out", "runs with a warning", "silent",
                                     "largest error where corrected", "finite"), energy()),
        table("Large steps: largest rad per step", ("rad", "runs", "done", "done with help", "stopped", "left their branch"),
              large_steps()),
        table("Bifurcations: half a turn of parallelograms, and of what is nearly one",
              ("ground", "runs", "right", "right, with a warning", "wrong, with a warning", "stopped", "taken for a bifurcation",
               "wrong", "truth not known"),
              bifurcations()),
        table("Oscillator: amplitude after 1000 steps, by omega h; ! said, x stopped",
              ("integrator", *(f"{x:.3g}" for x in DECADES)), stiffness()),
    ])
    print(text)
    if not sys.argv[1:]:
        RESULTS.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
