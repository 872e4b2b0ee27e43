"""Random mechanisms in space against plain NumPy: accelerations, of all formulations in turn. Writes spatial_mechanisms.md.

    PYTHONPATH=python:tests python tests/stress/spatial_mechanisms.py [how many]

A run that stops with an error is not wrong in silence, and is counted by its error.
"""

import sys
import time
from collections import Counter
from pathlib import Path

import zerodrift as zd
from mechanisms.plain_space import compare

TABLE = Path(__file__).with_suffix(".md")
FORMULATIONS = ("nullspace", "schur", "augmented", "mixed", "independent")
NEAR = 1e-5     # of the largest acceleration


def outcome(seed):
    """How one mechanism ends: a word, and how far it is off or a sentence."""
    formulation = FORMULATIONS[seed % len(FORMULATIONS)]
    try:
        off = compare(seed, formulation)
    except zd.ZerodriftError as error:
        return f"{formulation}: {type(error).__name__}", str(error)[:110]
    if off is None:
        return "not compared: nothing is free, or rows nearly depend on each other", ""
    return f"{formulation}: {'agrees' if off < NEAR else 'differs'}", off


def main():
    """Runs them and writes the table."""
    many, begin = int(sys.argv[1]) if len(sys.argv) > 1 else 1000, time.time()
    found = [outcome(seed) for seed in range(many)]
    counts = Counter(word for word, _ in found)
    lines = [f"# {many} random mechanisms in space against plain NumPy", "",
             f"Written by `tests/stress/spatial_mechanisms.py`, zerodrift {zd.__version__}, {time.time() - begin:.0f} s.", "",
             "| how it ended | how many |", "|---|---|", *(f"| {word} | {count} |" for word, count in sorted(counts.items())), "",
             f"Largest difference where they agree: {max(off for word, off in found if word.endswith('agrees')):.2g} of the "
             "largest acceleration, which is that of the model's differences.", "", "| seed | what |", "|---|---|"]
    lines += [f"| {seed} | {word}, {off} |" for seed, (word, off) in enumerate(found)
              if not word.endswith("agrees") and off != ""]
    TABLE.write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
