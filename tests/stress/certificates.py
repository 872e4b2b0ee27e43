"""Certified errors of `zd.reference` against true ones, in both precisions, for random motions known to thirty digits.

Run it with ``python tests/stress/certificates.py 1000``, motions in each precision; a second number is of minutes after
which it ends, a third the first seed. It writes ``certificates.csv`` into ``tests/bench/results/``, and exits with 1 if a
certificate is too small.
"""

import collections
import csv
import sys
import time
from itertools import islice
from pathlib import Path

import numpy as np

import zerodrift as zd

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS), str(TESTS / "support")]

from certain_motions import FAMILIES, compare  # noqa: E402

PRECISIONS = ("double", "double-double")


def drawn(seed):
    """Families in turn, each time with another seed, in both precisions."""
    while True:
        yield from ((precision, name, seed) for name in FAMILIES for precision in PRECISIONS
                    if (precision, name) != ("double-double", "henon_in_python"))
        seed += 1


def row(precision, family, outcomes, refused):
    """Entry of the table for one family, or for all."""
    certified, true = (np.array([getattr(each, which) for each in outcomes]).reshape(-1, 2) for which in ("certified", "true"))
    seconds = np.array([outcome.seconds for outcome in outcomes]).reshape(-1, 2).sum(axis=0)
    loose = certified / np.maximum(true, np.finfo(float).tiny)
    return {"precision": precision, "family": family, "motions": len(outcomes), "refused": refused,
            "too small": int((true > certified).any(axis=1).sum()),
            **{f"{which} certified / true, {name}": f"{of(loose[:, i]):.3g}" for which, of in
               (("smallest", np.min), ("median", np.median), ("largest", np.max)) for i, name in enumerate("pv")},
            "median certified, p": f"{np.median(certified[:, 0]):.2g}", "largest certified, p": f"{certified[:, 0].max():.2g}",
            "with caveats": sum(bool(outcome.caveats) for outcome in outcomes),
            "s certified": f"{seconds[0]:.0f}", "s exact": f"{seconds[1]:.0f}"}


def tried(precision, name, seed):
    """Outcome of one motion; None if no certificate is given. It is printed in any case."""
    try:
        outcome = compare(name, seed, precision)
    except zd.UnreachableTolerance as error:
        print(f"{name}, seed {seed}, {precision}: {error}", flush=True)
        return None
    factors = [a / max(b, np.finfo(float).tiny) for a, b in zip(outcome.certified, outcome.true, strict=True)]
    print(f"{name}, seed {seed}, {precision}: certified {outcome.certified[0]:.2g}, {outcome.certified[1]:.2g}, over true "
          f"{factors[0]:.3g}, {factors[1]:.3g}, {outcome.precision}", "TOO SMALL" if min(factors) < 1 else "", flush=True)
    return outcome


def main(count, minutes, first):
    """So many motions in each precision; the number of certificates that are too small."""
    end = time.monotonic() + 60 * minutes
    found, refused = {}, collections.Counter()
    for precision, name, seed in islice(drawn(first), 2 * count):
        if time.monotonic() > end:
            break
        outcome = tried(precision, name, seed)
        refused[precision, name] += outcome is None
        if outcome is not None:
            found.setdefault((precision, name), []).append(outcome)
    rows = [row(*key, outcomes, refused[key]) for key, outcomes in sorted(found.items(), key=lambda each: each[0][0])]
    for precision in PRECISIONS:
        rows.append(row(precision, "all", [each for key, outcomes in found.items() if key[0] == precision for each in outcomes],
                        sum(number for key, number in refused.items() if key[0] == precision)))
    for each in rows:
        print(each)
    with open(TESTS / "bench" / "results" / "certificates.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    return sum(each["too small"] for each in rows)


if __name__ == "__main__":
    given = [float(each) for each in sys.argv[1:]] + [1000, np.inf, 0][len(sys.argv) - 1:]
    sys.exit(main(int(given[0]), given[1], int(given[2])) > 0)
