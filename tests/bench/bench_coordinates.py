"""What a step costs in joint and in absolute coordinates, counted and measured: ``python tests/bench/bench_coordinates.py``.

The weights of `zerodrift/mechanisms/cost.py` are fitted to what is measured here, so that the least sum of squares of relative
errors is left; it prints them as they are now and as they would be. Time is that of a corrected step of rk4 in schur, least of
interleaved rounds.
"""

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import numpy as np
from scipy.optimize import nnls

import zerodrift as zd
from large_mechanisms import binary_tree, chain, chain_of_balls, four_bars, spatial_chain, spatial_linkages, spatial_star, star
from measuring import RESULTS, least
from zerodrift.mechanisms import cost

ROUNDS, SECONDS, STEP, FEW = 7, 0.02, 1e-5, 4
CASES = [(make, n) for make, sizes in ((chain, (1, 3, 6, 10, 16, 24, 32, 48, 80)), (four_bars, (1, 2, 3, 4, 6, 10, 16)),
                                       (star, (4, 8, 16, 32, 64, 128)), (binary_tree, (3, 4, 5, 6)),
                                       (spatial_chain, (1, 2, 4, 8, 16, 32)), (chain_of_balls, (1, 2, 4, 8, 16)),
                                       (spatial_star, (4, 8, 16, 32)), (spatial_linkages, (1, 2, 4, 8))) for n in sizes]


def seconds_of(system, steps):
    """A callable that gives the processor's seconds of a step, without what a call takes besides; p, v are found once."""
    p, v = system.p0, system.v0

    def seconds_of_run(steps):
        start = time.process_time()
        zd.simulate(system, steps * STEP, p, v, step=STEP, save_every=steps)
        return time.process_time() - start

    return lambda: (seconds_of_run(steps + FEW) - seconds_of_run(FEW)) / steps


def measured(mechanism):
    """Seconds of a step in joint and in absolute coordinates."""
    systems = [mechanism.system(layout) for layout in ("joint", "absolute")]
    steps = [max(8, int(SECONDS / least(3, seconds_of(system, 20))[0])) for system in systems]
    return least(ROUNDS, *(seconds_of(system, count) for system, count in zip(systems, steps, strict=True)))


def fitted(columns, times):
    """Weights that are not negative, in seconds."""
    return nnls(np.array(columns) / np.array(times)[:, None], np.ones(len(times)))[0]


def main():
    rows, parts = [], {dimension: {"joint": [], "absolute": [], "times": []} for dimension in (2, 3)}
    for make, n in CASES:
        mechanism = make(n)
        tables, times = mechanism.system("joint")._tables, measured(mechanism)
        counted = cost.cost(tables, exact=True)
        of = parts[mechanism.dimension]
        of["joint"].append(cost.parts_of_joint(tables))
        of["absolute"].append(cost.parts_of_absolute(tables))
        of["times"].append(times)
        taken, faster = counted.taken, "joint" if times[0] < times[1] else "absolute"
        lost = max(times[taken == "absolute"] / min(times), 1.0)
        rows.append((make.__name__, n, len(mechanism.bodies), *(f"{1e6 * time:.3g}" for time in times),
                     *(f"{1e6 * cost.seconds(each):.3g}" for each in counted), faster, taken, f"{lost:.2f}"))
        print(*rows[-1], sep="\t", flush=True)
    for dimension, of in parts.items():
        times = np.array(of["times"])
        joint, absolute = fitted(of["joint"], times[:, 0]), fitted(of["absolute"], times[:, 1])
        print(f"dimension {dimension}, an operation: {joint[0]:.3g} s; weights in operations:", joint / joint[0],
              absolute / joint[0])
    header = ("mechanism", "n", "bodies", "joint us", "absolute us", "joint counted us", "absolute counted us", "faster", "taken",
              "time lost")
    (RESULTS / "coordinates.csv").write_text("\n".join(",".join(map(str, row)) for row in (header, *rows)) + "\n")


if __name__ == "__main__":
    main()
