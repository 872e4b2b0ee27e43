"""A thousand random mechanisms against plain NumPy: motion and reactions. Writes planar_mechanisms.md beside this.

    PYTHONPATH=python:tests:tests/support python tests/stress/planar_mechanisms.py [how many, or seed,seed,... to be shown alone]

Each is simulated in joint or in absolute coordinates for 0.2 s, by steps of fixed size. What fails is counted by how it fails: a
run that stops with an error is not wrong in silence. Where fixed steps differ, the run is repeated with steps that are chosen for
the tolerances that the independent model has: where that agrees, the fixed steps were too long, and the table has both
differences and what the first run warned of. What differs then, too, is wrong.
"""

import sys
import time
import warnings
from collections import Counter
from pathlib import Path

import zerodrift as zd
from mechanisms.test_against_plain_mechanics import CHOSEN, FIXED, MOTION, REACTION, compare

TABLE = Path(__file__).with_suffix(".md")


def compared(seed, layout, steps):
    """Compare one mechanism: (agrees, difference of motion, difference of reactions, run warned)."""
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        motion, reaction = compare(seed, layout, steps=steps)
    was_warned = any(issubclass(each.category, zd.AccuracyWarning) for each in warned)
    return motion < MOTION and reaction < REACTION, motion, reaction, was_warned


def outcome(seed):
    """Result of one mechanism: a word, and its largest differences or a sentence."""
    layout = ("joint", "absolute")[seed % 2]
    try:
        agrees, motion, reaction, warned = compared(seed, layout, FIXED)
        if agrees:
            return f"{layout}: agrees", (seed, motion, reaction)
        told = f"fixed steps: motion {motion:.2g}, reactions {reaction:.2g}, {'warned' if warned else 'not warned'}"
        agrees, motion, reaction, _ = compared(seed, layout, CHOSEN)
    except zd.ZerodriftError as error:
        return f"{layout}: {type(error).__name__}", (seed, str(error).split(";")[0][:110])
    told += f"; adaptive steps: motion {motion:.2g}, reactions {reaction:.2g}"
    return f"{layout}: {'agrees with adaptive steps' if agrees else 'differs'}", (seed, told)


def main():
    """Runs them and writes the table; seeds that are named are shown only."""
    asked, begin = sys.argv[1] if len(sys.argv) > 1 else "1000", time.time()
    if "," in asked:
        for seed in filter(None, asked.split(",")):
            print(*outcome(int(seed)))
        return
    many = int(asked)
    found = [outcome(seed) for seed in range(many)]
    counts = Counter(word for word, _ in found)
    agreeing = [row for word, row in found if word.endswith("agrees")]
    lines = [f"# {many} random mechanisms against plain NumPy", "",
             f"Written by `tests/stress/planar_mechanisms.py`, zerodrift {zd.__version__}, {time.time() - begin:.0f} s.", "",
             "| how it ended | how many |", "|---|---|", *(f"| {word} | {count} |" for word, count in sorted(counts.items())), "",
             f"Largest difference where they agree: in motion {max(row[1] for row in agreeing):.2g} of the velocities' size, in "
             f"reactions {max(row[2] for row in agreeing):.2g} of the largest.", "", "| seed | what |", "|---|---|"]
    lines += [f"| {row[0]} | {row[1]} |" for word, row in found if not word.endswith("agrees")]
    TABLE.write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
