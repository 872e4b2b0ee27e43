"""Time of `zd.equilibrium` from near an equilibrium and from anywhere, of all models with up to 20 velocities; a long chain.

Run it with ``python tests/bench/bench_equilibrium.py``; it writes ``results/equilibrium.csv``. Processor times of this process,
the least of several calls from each start, the largest over all starts; in joint coordinates, with one thread of BLAS.
"""

import csv
import os
import sys
import time
import warnings
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")      # read when NumPy is imported

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

import zerodrift as zd
from large_mechanisms import chain_of_hooks
from zerodrift.analysis.retraction import moved, onto
from zerodrift.analysis.state import scales, state
from zerodrift.analysis.tangent import Tangent

STARTS, CALLS = 6, 5
NEAR, FAR = 0.1, 1.0        # largest change of a coordinate, in rad or characteristic lengths
AT_MOST = {NEAR: 5.0, FAR: 100.0}       # ms
VELOCITIES, LINKS = 20, 1000


def milliseconds(call, calls=CALLS):
    """The least processor time of a call."""
    times = []
    for _ in range(calls):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return 1e3 * min(times)


def away(system, p, random, largest):
    """A position on the constraints whose displacement from p, in a random free direction, has that largest change."""
    at = state(system, 0.0, p, np.zeros(system.nv))
    W = Tangent(at).displacements
    delta = W @ random.standard_normal(W.shape[1])
    size = np.abs(at.A @ delta / scales(system, p).p).max(initial=0.0)
    for part in (1.0, 0.7, 0.5, 0.3):
        try:
            return onto(system, 0.0, moved(at, delta * largest * part / max(size, 1e-300)))
        except zd.CorrectionFailed:
            continue
    return p


def measured(name):
    """Number of velocities, of freedoms, and the largest times from near and from far; None where there is no equilibrium."""
    system = getattr(zd.models, name)().system("joint")
    if system.nv > VELOCITIES:
        return None
    try:
        eq = zd.equilibrium(system)
    except zd.EquilibriumFailed:
        return None
    random, largest = np.random.default_rng(1), []
    for change in (NEAR, FAR):
        starts = [away(system, eq.p, random, change) for _ in range(STARTS if eq.basis.shape[1] else 1)]
        starts += [np.array(system.start_at(0.0)[0])] if change == FAR else []
        largest.append(max(milliseconds(lambda start=start: zd.equilibrium(system, near=start)) for start in starts))
    return system.nv, eq.basis.shape[1], *largest


def main():
    """Measure, print and write."""
    warnings.simplefilter("ignore")
    names, slow = sys.argv[1:] or list(zd.models.__all__), []
    rows = [["model", "velocities", "freedoms", "within 0.1 rad, ms", "from anywhere, ms"]]
    for name in names:
        if (found := measured(name)) is not None:
            nv, k, near, far = found
            slow += [name] if near > AT_MOST[NEAR] or far > AT_MOST[FAR] else []
            rows.append([name, nv, k, f"{near:.2g}", f"{far:.2g}"])
            print(*rows[-1], "SLOW" if name in slow else "", flush=True)
    if not sys.argv[1:]:
        system = chain_of_hooks(LINKS).system()
        of_chain = milliseconds(lambda: zd.equilibrium(system), calls=2)
        rows.append([f"a chain of {LINKS} links", system.nv, "", "", f"{of_chain:.2g}"])
        with (Path(__file__).parent / "results" / "equilibrium.csv").open("w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
    print("slow:", *slow)


if __name__ == "__main__":
    main()
