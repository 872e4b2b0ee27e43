"""All planar models of `zd.models`: what they consist of, what a run takes, and how far it is from what is known of them.

Run it with ``python tests/bench/bench_models.py``; it needs SymPy and SciPy, and a C compiler. Freedom, rows and rank are as
`print` of the mechanism counts them, with absolute coordinates; loops are those that joint coordinates close. A run is in joint
coordinates, interpreted and compiled; its time is that in the core, with laws that are expressions of SymPy, the least of
rounds. The error is the largest deviation from `tests/support/known_motions.py` at any sample. It writes
``results/models.csv``.
"""

import csv
import re
import sys
from pathlib import Path

import zerodrift as zd
from measuring import RESULTS

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
import known_motions
from reference_files import table

ROUNDS = 5
CIRCLES, EQUATIONS, REFERENCE = "intersected circles", "equations of motion by hand", "reference file"
HIGH = {"integrator": "dop853"}
RUNS = {        # until when (s), settings, and what it is compared with
    "andrews": (table("A03_andrews")["t"][-1], {"step": 2e-5, "t_eval": table("A03_andrews")["t"], **HIGH}, REFERENCE),
    "bicycle": (10.0, {"step": 0.02, **HIGH}, EQUATIONS),
    "cam_follower": (1.0, {"step": 0.005}, "polynomial of the profile"),
    "chebyshev_lambda": (1.0, {"step": 0.005}, "Thales' theorem"),
    "closed_pendulum": (2.0, {"step": 0.0025, **HIGH}, EQUATIONS),
    "four_bar": (4.0, {"step": 0.005, **HIGH}, EQUATIONS),
    "four_bars": (10.0, {"step": 0.0025, "on_singular": "continue", "t_eval": [0.0, 1.0, 4.0, 10.0]}, REFERENCE),
    "hoecken": (1.0, {"step": 0.005}, "Thales' theorem"),
    "jansen": (1.0, {"step": 0.005}, CIRCLES),
    "klann": (1.0, {"step": 0.005}, CIRCLES),
    "pantograph": (1.0, {"step": 0.005}, "scaling"),
    "peaucellier": (1.0, {"step": 0.005}, "inversion in a circle"),
    "planetary_gear": (1.0, {"step": 0.01}, "Willis's equation"),
    "quarter_car": (3.0, {"step": 0.005, **HIGH}, "eigenvalues and transfer function"),
    "quick_return": (0.42, {"step": 0.001}, "closed form"),
    "scissor_lift": (2.0, {"step": 0.005}, "stages times arm times sine"),
    "slider_crank": (table("sundials_slider_crank")["t"][-1],
                     {"step": 0.02, "t_eval": table("sundials_slider_crank")["t"], **HIGH}, REFERENCE),
    "snakeboard": (10.0, {"step": 0.05, **HIGH}, EQUATIONS),
    "stephenson": (1.0, {"step": 0.005}, CIRCLES),
    "toggle_press": (1.0, {"step": 0.002}, "law of cosines"),
    "watt": (1.0, {"step": 0.005}, CIRCLES),
}
COLUMNS = ("model", "freedom", "rows", "rank", "loops", "until [s]", "steps", "integrator", "interpreted [ms]", "compiled [ms]",
           "compared with", "error [m, rad]")


def counted(m):
    """Freedom, rows, rank and loops, as `print` says them."""
    said = str(m)

    def number(pattern):
        found = re.search(pattern, said)
        return int(found[1]) if found else 0

    rows = number(r"absolute \d+, (\d+) constraint")
    rank = rows - number(r"(\d+) of \d+ constraints are redundant")
    return number(r"freedom (-?\d+)"), rows, rank, number(r"closing (\d+) loop")


def measured(name):
    """The row of a model."""
    until, settings, against = RUNS[name]
    m = getattr(zd.models, name)()
    seconds, errors = [], []
    for system in (m.system(), m.system(compiled=True)):
        sols = [zd.simulate(system, until, **settings) for _ in range(ROUNDS)]
        seconds.append(min(sol.stats["seconds"] for sol in sols))
        errors.append(getattr(known_motions, name)(sols[0]))
    return (name, *counted(m), f"{until:g}", sols[0].stats["steps"], settings.get("integrator", "rk4"),
            *(f"{1e3 * each:.3g}" for each in seconds), against, f"{max(errors):.1e}")


def main():
    """Measure all, print and write the table."""
    missing = (set(zd.models.__all__) - set(zd.models.space.__all__)) ^ set(RUNS)
    assert not missing, f"these are in one table only: {missing}"
    rows = []
    for name in RUNS:
        rows.append(measured(name))
        print("  ".join(f"{cell!s:>10}" for cell in rows[-1]), flush=True)
    with (RESULTS / "models.csv").open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(rows)


if __name__ == "__main__":
    main()
