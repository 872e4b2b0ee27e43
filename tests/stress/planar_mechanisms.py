"""A thousand random mechanisms against plain NumPy: motion and reactions. Writes planar_mechanisms.md beside this.

    PYTHONPATH=python:tests python tests/stress/planar_mechanisms.py [how many]

Each is simulated in joint or in absolute coordinates for 0.2 s. What fails is counted by how it fails: a run that stops with an error
is not wrong in silence. What is wrong in silence would be a line in the last table.
"""

import sys
import time
import warnings
from collections import Counter
from pathlib import Path

import zerodrift as zd
from mechanisms.test_against_plain_mechanics import MOTION, REACTION, compare

TABLE = Path(__file__).with_suffix(".md")


def outcome(seed):
    """How one mechanism ends: a word, and its largest differences."""
    layout = ("joint", "absolute")[seed % 2]
    try:
        motion, reaction = compare(seed, layout)
    except zd.ZerodriftError as error:
        return f"{layout}: {type(error).__name__}", (seed, str(error).split(";")[0][:110])
    agrees = motion < MOTION and reaction < REACTION
    return f"{layout}: {'agrees' if agrees else 'differs'}", (seed, motion, reaction)


def main():
    """Runs them and writes the table."""
    warnings.simplefilter("ignore")
    many, begin = int(sys.argv[1]) if len(sys.argv) > 1 else 1000, time.time()
    found = [outcome(seed) for seed in range(many)]
    counts = Counter(word for word, _ in found)
    agreeing = [row for word, row in found if word.endswith("agrees")]
    lines = [f"# {many} random mechanisms against plain NumPy", "",
             f"Written by `tests/stress/planar_mechanisms.py`, zerodrift {zd.__version__}, {time.time() - begin:.0f} s.", "",
             "| how it ended | how many |", "|---|---|", *(f"| {word} | {count} |" for word, count in sorted(counts.items())), "",
             f"Largest difference where they agree: in motion {max(row[1] for row in agreeing):.2g} of the velocities' size, in "
             f"reactions {max(row[2] for row in agreeing):.2g} of the largest.", "", "| seed | what |", "|---|---|"]
    lines += [f"| {row[0]} | {row[1]} |" if len(row) == 2 else f"| {row[0]} | motion {row[1]:.2g}, reactions {row[2]:.2g} |"
              for word, row in found if not word.endswith("agrees")]
    TABLE.write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
