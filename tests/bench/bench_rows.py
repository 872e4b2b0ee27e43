"""What a row costs that is asked for between chosen steps, on the paper's four-bar over 8 s at a tolerance of 1e-9.

Run it with ``python tests/bench/bench_rows.py``; it writes ``results/rows.csv``. Runs with few rows and with many are made in
turn, and of each the least time of the core counts: for 161 rows, what they add to the run that saves its start and end alone;
for a row, by how much 16,001 rows take longer than 161. On the direct road and on the general one, which some systems and
formulations have to take.
"""

import functools

import numpy as np

import zerodrift as zd
from measuring import least, record

RTOL, SPAN = 1e-9, 8.0
FEW, SOME, MANY = 2, 161, 16_001
ROUNDS = {SOME: 300, MANY: 30}
ROADS = {"direct": None, "general": False}


def seconds(system, rows, **options):
    """Of the core, in one run with so many rows."""
    times = np.linspace(0, SPAN, rows)
    return lambda: zd.simulate(system, SPAN, t_eval=times, rtol=RTOL, atol=RTOL, **options).stats["seconds"]


def measured():
    """Rows (what, value, unit, limit)."""
    for integrator in ("dop853", "dormand_prince"):
        for road, direct in ROADS.items():
            run = functools.partial(seconds, zd.systems.four_bar(), integrator=integrator, direct=direct)
            few, some = least(ROUNDS[SOME], run(FEW), run(SOME))
            fewer, many = least(ROUNDS[MANY], run(SOME), run(MANY))
            name = f"{integrator}, {road} road"
            yield f"{name}: what {SOME} rows add to a run", 100 * (some / few - 1), "%", 20
            yield f"{name}: a row, of {MANY}", 1e6 * (many - fewer) / (MANY - SOME), "us", 0.3


if __name__ == "__main__":
    record("rows", measured(), ("what", "value", "unit", "at most"))
