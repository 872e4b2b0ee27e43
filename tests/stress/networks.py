"""Random networks of bodies through all formulations, seeds as told: ``python tests/stress/networks.py [first] end``.

Of every five, one is as it is drawn, one has many rows, one has redundant rows besides, one bodies without mass, one both.
All have nonholonomic rows now and then. The table is written to networks.md.
"""

import sys
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

import zerodrift as zd
from random_networks import MAX_ROUNDINGS, check_accelerations, check_motion
from support import FORMULATIONS

KINDS = {"as drawn, up to 13 bodies": {}, "24 bodies": {"bodies": 24},
         "20 bodies, redundant rows": {"bodies": 20, "redundant": 4},
         "20 bodies, singular M": {"bodies": 20, "massless": 3}, "20 bodies, both": {"bodies": 20, "redundant": 3, "massless": 3}}
INVERTING = {"schur"}       # refuses a singular M
UNTOLD = "too ill-conditioned to tell"
EVERY_MOTION = 40           # of networks that are also moved


class Comparison:
    """Results by kind and formulation, the largest differences, and the cases that did not agree."""

    def __init__(self, formulations):
        self.formulations, self.began = formulations, time.perf_counter()
        self.counts, self.largest, self.failures = Counter(), {}, []

    def compare(self, seed):
        kind, options = list(KINDS.items())[seed % len(KINDS)]
        asked = [each for each in self.formulations if not (options.get("massless") and each in INVERTING)]
        try:
            off = check_accelerations(seed, asked, **options)
        except zd.ZerodriftError as error:
            self.failures.append((seed, kind, f"{type(error).__name__}: {error}"))
            return
        self.counts[kind, UNTOLD] += off is None
        for each, much in (off or {}).items():
            self.counts[kind, each] += much < MAX_ROUNDINGS
            self.largest[each] = max(self.largest.get(each, 0), much)
            if not much < MAX_ROUNDINGS:
                self.failures.append((seed, kind, f"{each}: off by {much:.3g} roundings times the condition"))
        if seed % EVERY_MOTION == 0:
            self.move(seed)

    def move(self, seed):
        """Two steps beside those of the twin that declares nothing."""
        for each in self.formulations:
            try:
                self.counts["motion", each] += check_motion(seed, each)
            except (AssertionError, zd.ZerodriftError) as error:
                self.failures.append((seed, "motion", f"{each}: {error}"))

    def table(self, first, end):
        columns = [*self.formulations, UNTOLD]
        lines = [f"# {end - first} random networks of bodies against dense equations", "",
                 f"Seeds {first} to {end - 1}, written by `tests/stress/networks.py`, zerodrift {zd.__version__}, "
                 f"{time.perf_counter() - self.began:.0f} s. Accelerations and multipliers, these of least effect",
                 f"where rows are redundant, agree where they differ by less than {MAX_ROUNDINGS:g} roundings times the "
                 "condition, two steps where they differ by 1e-9.", "",
                 f"| | {' | '.join(columns)} |", "|---|" + "---|" * len(columns)]
        lines += [f"| {kind} | {' | '.join(str(self.counts[kind, each]) for each in columns)} |" for kind in [*KINDS, "motion"]]
        largest = " | ".join(f"{self.largest.get(each, 0):.2g}" for each in self.formulations)
        lines += [f"| largest difference, in these roundings | {largest} | |", "", f"{len(self.failures)} did not agree.", ""]
        return "\n".join([*lines, *(f"* seed {seed}, {kind}: {what}" for seed, kind, what in self.failures)]).rstrip() + "\n"


def main(first, end):
    """Writes the table, again and again as it grows; returns how many did not agree."""
    comparison = Comparison(list(FORMULATIONS))
    for seed in range(first, end):
        comparison.compare(seed)
        if (seed + 1) % 100 == 0 or seed + 1 == end:
            Path(__file__).with_suffix(".md").write_text(comparison.table(first, seed + 1))
    print(comparison.table(first, end))
    return len(comparison.failures)


if __name__ == "__main__":
    sys.exit(main(*([0, 1000] if len(sys.argv) < 2 else [0, *map(int, sys.argv[1:])][-2:])) > 0)
