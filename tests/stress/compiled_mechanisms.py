"""Random mechanisms written out and compiled, against their tables: terms, motion, reactions. Writes compiled_mechanisms.md.

    PYTHONPATH=python:tests:tests/support python tests/stress/compiled_mechanisms.py [first seed] [how many] [seconds at most]

Each is taken in joint and in absolute coordinates: all terms at a random state, then 0.1 s from the start with reactions.
"""

import sys
import time
import warnings
from collections import Counter
from pathlib import Path

import numpy as np
import sympy as sp

import zerodrift as zd
from mechanisms.random_mechanisms import Maker

TABLE = Path(__file__).with_suffix(".md")
ALIKE = {"terms": 1e-12, "motion": 1e-9, "reactions": 1e-9}     # rounding; of runs and reactions times conditions up to 1e3


def terms(interpreted, compiled, random):
    """The largest difference of any term, of its size."""
    t, p, v = random.uniform(), random.normal(size=interpreted.nq), random.normal(size=interpreted.nq)
    one, other = interpreted.evaluate(p, v, t), compiled.evaluate(p, v, t)
    pairs = ((getattr(one, name), getattr(other, name)) for name in one.__slots__)
    return max(np.abs(a - (0 if b is None else b)).max(initial=0.0) / max(1.0, np.abs(a).max(initial=0.0))
               for a, b in pairs if a is not None)


def runs(*systems):
    """The solutions, or for those that stop with an error its name."""
    for system in systems:
        try:
            yield zd.simulate(system, 0.1, step=1e-3, save_every=50, formulation="augmented")
        except zd.ZerodriftError as error:
            yield type(error).__name__


def reactions(one, other):
    """The largest difference of any determined reaction, of its size."""
    worst = 0.0
    for name in one.system.measures:
        if name.endswith((".force", ".torque")):
            a, b = (sol[name].reshape(len(sol.t), -1) for sol in (one, other))
            off = np.abs(a - b)[:, np.atleast_1d(one.unique(name))]
            worst = max(worst, off.max(initial=0.0) / max(1.0, np.abs(a).max()))
    return worst


def differences(seed, layout):
    """Result of a mechanism as a word, and the differences between tables and compiled code."""
    maker = Maker(seed, law=lambda a, w: a * sp.sin(w * sp.Symbol("t")))
    maker.start()
    systems = maker.m.system(layout), maker.m.system(layout, compiled=True)
    if not systems[0].nq:
        return "no coordinates", {}
    found = {"terms": terms(*systems, np.random.default_rng(seed))}
    one, other = runs(*systems)
    if isinstance(one, str) or isinstance(other, str):
        return f"{one} and {other}" if isinstance(one, str) and isinstance(other, str) else "one of them stops", found
    motion = np.abs(one.p - other.p).max() / max(1.0, np.abs(one.v).max())
    return "both run", found | {"motion": motion, "reactions": reactions(one, other)}


def main():
    """Runs them and writes the table."""
    first, many, seconds = (int(each) for each in (sys.argv[1:] + ["0", "100", "3600"][len(sys.argv) - 1:]))
    begin, ended, worst, lines, seed = time.time(), Counter(), Counter(), [], first
    warnings.simplefilter("ignore")
    while seed < first + many and time.time() - begin < seconds:
        for layout in ("joint", "absolute"):
            how, found = differences(seed, layout)
            ended[f"{layout}: {how}"] += 1
            worst |= found
            lines += [f"| {seed} {layout} | {what} {off:.2g} |" for what, off in found.items() if off > ALIKE[what]]
        seed += 1
    head = [f"# {seed - first} random mechanisms, compiled against their tables", "",
            f"Written by `tests/stress/compiled_mechanisms.py`, zerodrift {zd.__version__}, {time.time() - begin:.0f} s.", "",
            "| how they end | how many |", "|---|---|", *(f"| {how} | {count} |" for how, count in sorted(ended.items())), "",
            "Largest differences: " + ", ".join(f"{what} {off:.2g}" for what, off in worst.items()) + ".", "",
            "| seed | more than " + ", ".join(f"{what} {most:.0e}" for what, most in ALIKE.items()) + " |", "|---|---|"]
    TABLE.write_text("\n".join([*head, *lines]) + "\n")
    print("\n".join([*head, *lines]))


if __name__ == "__main__":
    main()
