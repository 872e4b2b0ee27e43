"""Certified errors of `zd.reference` against true ones, for random motions known to thirty digits.

Run it with ``python tests/stress/certificates.py 3000``; it takes some ten minutes and writes ``certificates.csv`` into
``tests/bench/results/``. It exits with the number of certificates that are too small.
"""

import csv
import sys
from itertools import islice
from pathlib import Path

import numpy as np

import zerodrift as zd

TESTS = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TESTS))

from certain_motions import FAMILIES, compare  # noqa: E402


def drawn():
    """Families in turn, each time with another seed."""
    seed = 0
    while True:
        yield from ((name, seed) for name in FAMILIES)
        seed += 1


def row(family, outcomes, refused):
    """Entry of the table for one family, or for all."""
    certified, true = (np.array([getattr(each, which) for each in outcomes]).reshape(-1, 2) for which in ("certified", "true"))
    seconds = np.array([outcome.seconds for outcome in outcomes]).reshape(-1, 2).sum(axis=0)
    loose = certified / np.maximum(true, np.finfo(float).tiny)
    return {"family": family, "motions": len(outcomes), "refused": refused, "too small": int((true > certified).sum()),
            **{f"largest true / certified, {name}": f"{(true / certified)[:, i].max():.2g}" for i, name in enumerate("pv")},
            **{f"median certified / true, {name}": f"{np.median(loose[:, i]):.3g}" for i, name in enumerate("pv")},
            "median certified, p": f"{np.median(certified[:, 0]):.2g}", "largest certified, p": f"{certified[:, 0].max():.2g}",
            "with caveats": sum(bool(outcome.caveats) for outcome in outcomes),
            "s certified": f"{seconds[0]:.0f}", "s exact": f"{seconds[1]:.0f}"}


def main(count):
    """So many motions; the number of certificates that are too small."""
    found, refused = {name: [] for name in FAMILIES}, dict.fromkeys(FAMILIES, 0)
    for name, seed in islice(drawn(), count):
        try:
            outcome = compare(name, seed)
        except zd.UnreachableTolerance as error:
            refused[name] += 1
            print(f"{name}, seed {seed}: {error}", flush=True)
            continue
        found[name].append(outcome)
        if seed % 10 == 0:
            print(name, seed, [f"{a / b:.2g}" for a, b in zip(outcome.true, outcome.certified, strict=True)], flush=True)
        if any(true > certified for true, certified in zip(outcome.true, outcome.certified, strict=True)):
            print(f"{name}, seed {seed}: certified {outcome.certified}, true {outcome.true}, {outcome.caveats}", flush=True)
    rows = [row(name, outcomes, refused[name]) for name, outcomes in found.items() if outcomes]
    rows.append(row("all", [outcome for outcomes in found.values() for outcome in outcomes], sum(refused.values())))
    for each in rows:
        print(each)
    with open(TESTS / "bench" / "results" / "certificates.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    return rows[-1]["too small"]


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 1000) > 0)
