"""Random mechanisms in space against plain NumPy: accelerations, reactions, motions. Writes spatial_mechanisms.md.

    OPENBLAS_NUM_THREADS=1 PYTHONPATH=python:tests:tests/support \
        python tests/stress/spatial_mechanisms.py [how many [how many processes]]

Trees of up to four bodies and joints of all kinds, with up to three loops, in absolute and in joint coordinates; on every
second of them the last body rolls on the ground, as a ball, a disc or an egg, or glides on a blade. Reactions have to balance
each body, whichever of them are determined.
A run that stops with an error is not wrong in silence, and is counted by its error.
"""

import sys
import time
import warnings
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import zerodrift as zd
from mechanisms.plain_space import ON_GROUND, Compared

TABLE = Path(__file__).with_suffix(".md")
FORMULATIONS = ("nullspace", "schur", "augmented", "mixed", "independent")
COORDINATES = ("absolute", "joint")
GROUND = (None, "ball", None, "disc", None, "egg", None, "blade")
NEAR = 1e-5     # of the largest acceleration: of the model's differences
FAR = 1e-6      # m: two steps of two different RK4, and those differences
EVERY = 10      # motions are looked at of one in so many, as the model's take a second


def outcome(seed):
    """Result of one mechanism: a word, and its error or a sentence."""
    formulation, on_ground = FORMULATIONS[seed % len(FORMULATIONS)], GROUND[seed // len(FORMULATIONS) % len(GROUND)]
    coordinates = COORDINATES[seed // (len(FORMULATIONS) * len(GROUND)) % 2]
    kind = f"{coordinates}, {formulation}, {'rolling' if on_ground in ON_GROUND else on_ground or 'holonomic'}"
    warnings.simplefilter("ignore", zd.LockedWarning)       # some of them cannot move
    try:
        case = Compared(seed, on_ground, loops=3, coordinates=coordinates)
        if not case.can_be:
            return "not compared: rows nearly depend on each other, or nothing but welds is left", "", 0.0
        off = max(case.accelerations(formulation))
        moved = case.motion(formulation) if seed % EVERY == seed // EVERY % EVERY else 0.0
    except zd.ZerodriftError as error:
        return f"{kind}: {type(error).__name__}", str(error)[:110], 0.0
    return f"{kind}: {'agrees' if off < NEAR and moved < FAR else 'differs'}", off, moved


def main():
    """Runs them and writes the table."""
    many, processes = (int(sys.argv[i]) if len(sys.argv) > i else default for i, default in ((1, 1000), (2, 1)))
    begin = time.time()
    with ProcessPoolExecutor(processes) as pool:
        found = list(pool.map(outcome, range(many), chunksize=5))
    counts = Counter(word for word, _, _ in found)
    agreeing = [(off, moved) for word, off, moved in found if word.endswith("agrees")]
    lines = [f"# {many} random mechanisms in space against plain NumPy", "",
             f"Written by `tests/stress/spatial_mechanisms.py`, zerodrift {zd.__version__}, {time.time() - begin:.0f} s.", "",
             "| how it ended | how many |", "|---|---|", *(f"| {word} | {count} |" for word, count in sorted(counts.items())), "",
             f"Largest difference where they agree: {max(off for off, _ in agreeing):.2g} of the largest acceleration, of "
             f"accelerations and of what reactions leave unbalanced, and {max(moved for _, moved in agreeing):.2g} m in the "
             f"end of the {sum(moved > 0 for _, moved in agreeing)} motions; both are those of the model's differences.", "",
             "| seed | what |", "|---|---|"]
    lines += [f"| {seed} | {word}, {off}, {moved} |" for seed, (word, off, moved) in enumerate(found)
              if not word.endswith("agrees") and off != ""]
    TABLE.write_text("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
