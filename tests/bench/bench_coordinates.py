"""Cost of a step in joint and in absolute coordinates, predicted and measured: ``python tests/bench/bench_coordinates.py``.

Mechanisms: chains, rows, stars and trees of several sizes, all of `zd.models`, and random ones, some of which are not in the fit.
The weights of the cost model, fitted to these measurements, are printed with the relative errors of the fit. Times are processor
times of a step of rk4 in schur, the minimum of interleaved rounds; the step size is the longest up to 5 ms that is not subdivided
and needs at most one iteration of the positions. Mechanisms with more than 20 ms a step in either layout are left out, such as a
chain of a thousand links in joint coordinates.
"""

import sys
import time
import warnings
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

import numpy as np
from scipy.optimize import nnls

import zerodrift as zd
from large_mechanisms import binary_tree, chain, chain_of_balls, four_bars, spatial_chain, spatial_linkages, spatial_star, star
from measuring import RESULTS, least
from random_assemblies import Assembly
from zerodrift.mechanisms.reports import cost

ROUNDS, SECONDS, FEW, MAX_STEPS = 9, 1.5e-3, 4, 100
STEPS = [k * 10.0**-e for e in (3, 4, 5) for k in (5, 2, 1)]
SIZES = {
    chain: (1, 2, 3, 4, 6, 8, 10, 12, 16, 20, 24, 32, 48, 80), four_bars: (1, 2, 3, 4, 6, 10, 16), star: (4, 8, 16, 32, 64, 128),
    binary_tree: (3, 4, 5, 6), spatial_chain: (1, 2, 3, 4, 6, 8, 16, 32), chain_of_balls: (1, 2, 3, 4, 6, 8, 16),
    spatial_star: (4, 8, 16, 32), spatial_linkages: (1, 2, 4, 8)}
RANDOM = {2: (range(120), range(200, 250)), 3: (range(80), range(200, 230))}     # seeds in the fit, and others
TOO_MUCH, TOO_LONG = 1.3, 0.02      # times as long; s
HEADER = ("mechanism", "dimension", "bodies", "joint us", "absolute us", "joint counted us", "absolute counted us", "taken",
          "time lost")


def cases():
    """Names, functions that make mechanisms, and whether these are in the fit."""
    for make, sizes in SIZES.items():
        yield from ((f"{make.__name__} {n}", partial(make, n), True) for n in sizes)
    yield from ((name, getattr(zd.models, name), True) for name in zd.models.__all__)
    for dimension, (in_fit, others) in RANDOM.items():
        for seed in (*in_fit, *others):
            yield f"random {dimension}D {seed}", partial(assembled, seed, dimension), seed in in_fit


def assembled(seed, dimension):
    return Assembly(seed, dimension).m


def run(system, start, step, steps):
    """The processor's seconds of a run, and its statistics; None where it fails."""
    begin = time.thread_time()
    sol = zd.simulate(system, steps * step, *start, step=step, save_every=steps, on_failure="return")
    seconds = time.thread_time() - begin
    return (seconds, sol.stats) if sol.success else None


def longest_step(systems, starts):
    """The longest that both make whole; None where there is none."""
    def is_complete(found):
        stats = found[1] if found else {}
        return found and not stats["subdivided"] and not stats["damped"] and stats["position_iterations"] <= 1.1 * stats["steps"]

    return next((step for step in STEPS
                 if all(is_complete(run(*each, step, MAX_STEPS + FEW)) for each in zip(systems, starts, strict=True))), None)


def measured(mechanism):
    """Seconds of a step in joint and in absolute coordinates; None where none is whole."""
    systems = [mechanism.system(layout) for layout in ("joint", "absolute")]
    starts = [(system.p0, system.v0) for system in systems]
    step = longest_step(systems, starts)
    if step is None:
        return None
    counts, measures = [], []
    for system, start in zip(systems, starts, strict=True):
        def seconds(steps, system=system, start=start):
            return lambda: run(system, start, step, steps)[0]

        often, few = least(3, seconds(40), seconds(FEW))
        counts.append(int(np.clip(SECONDS * 36 / max(often - few, 1e-5), 12, MAX_STEPS)))
        measures += [seconds(counts[-1] + FEW), seconds(FEW)]
    found = least(ROUNDS, *measures)
    return [(found[2 * i] - found[2 * i + 1]) / count for i, count in enumerate(counts)]


def fitted(parts, times):
    """Weights in operations, none negative; what is far off counts less, as a run that was disturbed is."""
    shares = np.array(parts) / np.array(times)[:, None] * 1e-9 * cost.NANOSECONDS
    trust = np.ones(len(times))
    for _ in range(8):
        weights = nnls(shares * trust[:, None], trust)[0]
        trust = 1 / np.sqrt(1 + ((shares @ weights - 1) / 0.25) ** 2)
    return weights, shares @ weights


def row_of(name, mechanism, times):
    """Entry of the table for one mechanism, in the columns of HEADER."""
    counted = cost.cost(mechanism.system("joint")._tables, exact=True)
    lost = times[counted.taken == "absolute"] / min(times)
    return (name, mechanism.dimension, len(mechanism.bodies), *(f"{1e6 * time:.3g}" for time in times),
            *(f"{1e6 * cost.seconds(each):.3g}" for each in counted[:2]), counted.taken, f"{lost:.2f}")


def tell(rows, fits):
    """The weights as they would be, and the mechanisms that lose by the count."""
    for (dimension, which), (parts, times) in fits.items():
        weights, share = fitted(parts, times)
        print(f"dimension {dimension}, {which}:", np.round(weights, 1), "counted over measured, 5, 50, 95 %:",
              np.round(np.percentile(share, (5, 50, 95)), 2))
    for what, wanted in (("in the fit", True), ("others", False)):
        lost = np.array([float(row[-1]) for row, is_fitted in rows if is_fitted is wanted])
        print(f"{what}: {len(lost)}, {(lost > TOO_MUCH).sum()} lose by more than {TOO_MUCH:g}; on average {lost.mean():.3f}")


def write(rows):
    lines = [",".join(map(str, row)) for row in (HEADER, *(row for row, _ in rows))]
    (RESULTS / "coordinates.csv").write_text("\n".join(lines) + "\n")


def main():
    rows, fits = [], {(dimension, which): ([], []) for dimension in (2, 3) for which in ("joint", "absolute")}
    for name, make, is_fitted in cases():
        mechanism = make()
        tables = mechanism.system("joint")._tables
        longest = max(map(cost.seconds, cost.cost(tables, exact=True)[:2]))
        times = measured(mechanism) if longest < TOO_LONG else None
        if times is None:
            continue
        rows.append((row_of(name, mechanism, times), is_fitted))
        print(*rows[-1][0], sep="\t", flush=True)
        parts, share = cost.parts_of_absolute(tables)
        for which, part, seconds in (("joint", cost.parts_of_joint(tables), times[0]), ("absolute", parts, times[1] / share)):
            if is_fitted:
                fits[mechanism.dimension, which][0].append(part)
                fits[mechanism.dimension, which][1].append(seconds)
    tell(rows, fits)
    write(rows)


if __name__ == "__main__":
    with warnings.catch_warnings(category=zd.AccuracyWarning, action="ignore"):
        main()
