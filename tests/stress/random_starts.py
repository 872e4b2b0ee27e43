"""Random starts, plane and space: coordinates that no loop connects with the held one stay. Writes random_starts.md.

OPENBLAS_NUM_THREADS=1 PYTHONPATH=python:tests:tests/support python tests/stress/random_starts.py [how many [commit]]
"""

import sys
import time
import warnings
from collections import Counter
from pathlib import Path

import zerodrift as zd
from mechanisms.random_starts import outcome

TABLE = Path(__file__).with_suffix(".md")


def main():
    """Runs them and writes the table."""
    warnings.simplefilter("ignore")
    many = int(sys.argv[1]) if len(sys.argv) > 1 else 500
    counts, largest = Counter(), 0.0
    for seed in range(many):
        in_space, layout = seed % 2 == 1, ("joint", "absolute")[seed // 2 % 2]
        word, moved = outcome(seed // 4, in_space, layout)
        counts[f"{'space' if in_space else 'plane'}, {layout} coordinates: {word}"] += 1
        largest = max(largest, moved)
    commit = f", commit {sys.argv[2]}" if len(sys.argv) > 2 else ""
    lines = [f"# {many} random starts", "", f"Written by `tests/stress/random_starts.py`, zerodrift {zd.__version__}{commit}, "
             f"{time.strftime('%d %B %Y')}.", "",
             "| start of one joint's coordinate or speed | how many |", "|---|---|",
             *(f"| {word} | {count} |" for word, count in sorted(counts.items())), "",
             f"Largest change of a coordinate or rate that no loop connects with the held one: {largest:.2g}."]
    TABLE.write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
