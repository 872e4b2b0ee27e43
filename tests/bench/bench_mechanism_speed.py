"""Cost of a mechanism made of bodies and joints relative to the built-in system, and time to describe one of 100 links.

Run it with ``python tests/bench/bench_mechanism_speed.py``; it needs SymPy and a C compiler. Ratios are of the minimum times of
interleaved runs of the paper's four-bar, 2000 steps each with projection. It writes ``results/mechanism_speed.csv``.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

import zerodrift as zd
from large_mechanisms import chain
from measuring import least, record, timed
from mechanisms.known import four_bar

ROUNDS = 150
STEPS = 2000
LINKS = 100


def running(system, **settings):
    """A callable that gives the seconds of a run, those in the core alone."""
    def seconds():
        return zd.simulate(system, 0.005 * STEPS, step=0.005, save_every=STEPS, **settings).stats["seconds"]
    return seconds


def measured():
    """Rows (what, value, unit, limit)."""
    built_in, tables, written = zd.systems.four_bar(), four_bar().system(), four_bar().system(compiled=True)
    general = {"closed_form": False}
    times = least(ROUNDS, running(built_in, **general), running(built_in), running(tables, **general),
                  running(written, **general), running(written))
    yield "four-bar, tables interpreted, to the matrix path of the one built in", times[2] / times[0], "", 2
    yield "four-bar, compiled=True, to the closed-form functions of the one built in", times[4] / times[1], "", 1.1
    yield "four-bar, compiled=True with closed_form=False, to the matrix path of that", times[3] / times[0], "", None
    m = chain(LINKS, 0.01)
    links, system, started = least(ROUNDS, timed(lambda: chain(LINKS, 0.01)), timed(m.system), timed(lambda: m.system().p0))
    yield f"{LINKS} links and joints in Python", 1e3 * links, "ms", 5
    yield f"m.system() of {LINKS} links", 1e3 * system, "ms", 2
    yield f"m.system() of {LINKS} links and its start", 1e3 * started, "ms", None


if __name__ == "__main__":
    record("mechanism_speed", measured(), columns=("what", "value", "unit", "at most"))
