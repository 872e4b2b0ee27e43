"""Certified errors of references in double-double arithmetic, and their differences from motions that share no code with them.

Run it with ``python tests/bench/bench_beyond_double.py``; it writes ``results/beyond_double.csv``. Compared are sums of both
parts of the coordinates with closed forms, or with series in integers of 150 bits of equations without constraints, from the
first sample on; where there is no such motion, with publications, whose digits limit the comparison. Seconds are processor time
of the certificate, once its system is compiled.
"""

import csv
import math
import sys
import time
from pathlib import Path

import mpmath
import numpy as np

import zerodrift as zd
from measuring import RESULTS

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS), str(TESTS / "support")]

import energy_models  # noqa: E402
import symbolic_counterparts  # noqa: E402
import taylor  # noqa: E402
from reference_files import definition, number, table  # noqa: E402
from taylor import mp  # noqa: E402

GRAVITY = mp.mpf(9.81)


def exactly(ref, row, column):
    """A coordinate at a sample, of both parts."""
    return mp.mpf(float(ref.p[row, column])) + mp.mpf(float(ref.p_low[row, column]))


def rate(ref, row, column):
    """A velocity, likewise."""
    return mp.mpf(float(ref.v[row, column])) + mp.mpf(float(ref.v_low[row, column]))


def apart(ref, exact):
    """Largest difference from columns of numbers by sample."""
    return max(abs(exactly(ref, i, j) - value) for i, row in enumerate(exact) for j, value in enumerate(row) if value is not None)


def oscillator():
    """A cosine."""
    mass, stiffness = 0.1, 0.3
    system, end = zd.systems.oscillator(mass=mass, stiffness=stiffness, x0=1.0), 100.0
    frequency = mp.sqrt(mp.mpf(stiffness) / mp.mpf(mass))
    return system, end, None, lambda ref: apart(ref, [[mp.cos(frequency * mp.mpf(float(t)))] for t in ref.solution.t])


def pendulum():
    """A01 of the library of benchmark problems of the IFToMM: let go level."""
    system, end = zd.systems.pendulum(length=1.0, gravity=9.81, angle=-math.pi / 2), 10.0

    def compared(ref):
        with mpmath.workdps(45):
            start = mpmath.mpf(-math.pi / 2)
            m = mpmath.sin(start / 2)**2
            K, frequency, rows = mpmath.ellipk(m), mpmath.sqrt(mpmath.mpf(9.81)), []
            for t in ref.solution.t:
                half = -mpmath.sqrt(m) * mpmath.ellipfun("sn", K + mpmath.mpf(float(t)) * frequency, m=m)
                rows.append([mp.mpf(str(x)) for x in (2 * half * mpmath.sqrt(1 - half**2), 2 * half**2 - 1)])
        return apart(ref, rows)

    return system, end, None, compared


def four_bars():
    """A02 with two loops, to 1e-3 rad of its first flat pose: all cranks are at one angle, which is that of a pendulum."""
    system = zd.models.four_bars(2).system("joint", compiled=True)
    inertia = mp.mpf(1 / 12) + mp.mpf(1) / 4        # of a crank about its pin: the inertia of a rod is a double
    falling = GRAVITY * (mp.mpf(3) / 2 + 2) / (3 * inertia + 2)
    flat = zd.simulate(system, 1.0, step=1e-3, events=zd.Event("crank0.angle", value=1e-3, terminal=True), on_failure="return")
    end = float(flat.t_events[0][0])

    def compared(ref):
        motion = taylor.solution(lambda t, x: [x[1], -1 * (taylor.sin_cos(x[0])[1] * falling)],
                                 [exactly(ref, 0, 0), rate(ref, 0, 0)], 0, ref.solution.t)
        return apart(ref, [[x[0]] * 3 for x in motion])

    return system, end, None, compared


def heavy_top():
    """Euler's equations about the tip, in unit quaternions."""
    system = zd.models.heavy_top().system("joint", compiled=True)
    across, along, moment = mp.mpf(0.234375) + 15, mp.mpf(0.46875), 15 * GRAVITY

    def right_side(t, x):
        a, b, c, d, p, q, r = x
        up = 2 * (b * d - a * c), a * a - b * b - c * c + d * d      # vertical, along the first and the third axis of the body
        half = mp.mpf(1) / 2
        return [(-1 * (b * p) - c * q - d * r) * half, (a * p - d * q + c * r) * half, (d * p + a * q - b * r) * half,
                (-1 * (c * p) + b * q + a * r) * half, ((q * r) * (along - across) - up[1] * moment) * (1 / across),
                0 * q, ((p * q) * (across - along) + up[0] * moment) * (1 / across)]

    def compared(ref):
        start = [exactly(ref, 0, j) for j in range(4)] + [rate(ref, 0, j) for j in range(3)]
        return apart(ref, [x[:4] for x in taylor.solution(right_side, start, 0, ref.solution.t)])

    return system, 1.0, None, compared


def rolling_disc():
    """A table of fifteen digits."""
    given = table("rolling_disc")
    system = symbolic_counterparts.rolling_disc()
    columns = {variable.name: j for j, variable in enumerate(system.coordinates) if variable.name in given}

    def compared(ref):
        rows = np.searchsorted(given["t"], ref.solution.t - 1e-9)
        assert np.abs(given["t"][rows] - ref.solution.t).max() < 1e-12
        return float(max(np.abs(ref.p[:, j] - given[name][rows]).max() for name, j in columns.items()))

    return system, float(given["t"][-1]), None, compared


def andrews():
    """The end of the test set for initial values, of fourteen digits."""
    end = number([definition("A03_andrews")["reference_t0_03"][f"q{i}"] for i in range(1, 8)])
    return energy_models.andrews(), 0.03, 1e-18, lambda ref: float(np.abs(ref.p[-1] - end).max())


MOTIONS = {"oscillator": (oscillator, "cosine"), "pendulum (A01)": (pendulum, "elliptic functions"),
           "two four-bars up to a flat pose (A02)": (four_bars, "series of one pendulum"),
           "heavy top": (heavy_top, "series of Euler's equations"), "rolling disc": (rolling_disc, "table of 15 digits"),
           "Andrews' mechanism": (andrews, "publication with 14 digits")}


def main(names):
    """Measure, print and write."""
    rows = []
    for name in names or MOTIONS:
        motion, what = MOTIONS[name]
        system, end, error, compared = motion()
        options = {"error": error, "t_eval": np.linspace(0, end, 6), "precision": "double-double"}
        ref = zd.reference(system, end, **options)
        begin = time.process_time()
        zd.reference(system, end, **options)
        seconds = time.process_time() - begin
        rows.append((name, f"{end:.3g}", f"{ref.error:.1e}", ref.precision, what, f"{float(compared(ref)):.1e}",
                     f"{seconds:.1f}"))
        print(*rows[-1], sep="  ", flush=True)
    with (RESULTS / "beyond_double.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerows([("motion", "s", "certified error of p", "arithmetic", "compared with", "difference", "seconds"), *rows])


if __name__ == "__main__":
    main(sys.argv[1:])
