"""Random motions that are known to thirty digits: closed forms, and Taylor series of minimal equations by `taylor`.

The certificates of `zd.reference` are compared with them, by studies/test_reference_of_known_motions.py for a few, and by
stress/certificates.py for any number. A family draws its numbers and returns the system, its start, the duration, and the exact
state as a function of time.
"""

from time import perf_counter
from typing import NamedTuple

import numpy as np

import certain_motions_free as free
import certain_motions_held as held
import zerodrift as zd
from taylor import mp

FAMILIES = {family.__name__: family for family in (
    free.linear, free.linear_long, free.linear_stiff, free.oscillator, free.henon, free.henon_in_python, free.duffing,
    free.kepler, free.stiff_spring, free.pulse, free.body, held.pendulum, held.moved_pendulum, held.double_pendulum,
    held.double_pendulum_in_cartesian, held.ellipse, held.wire, held.hung_plate, held.crank, held.sleigh, held.knife_edge,
    held.vertical_disc)}
ROWS = 12       # of each motion that are compared


class Outcome(NamedTuple):
    """Certified and true errors of p and v, what was said, and the seconds of the reference and of the exact motion."""

    certified: tuple[float, float]
    true: tuple[float, float]
    caveats: tuple[str, ...]
    seconds: tuple[float, float]


def draw(name, seed):
    """A motion of a family, and the times asked for: None is every step."""
    rng = np.random.default_rng([seed, *name.encode()])
    motion = FAMILIES[name](rng)
    times = np.sort(rng.uniform(0, motion.end, ROWS)) if rng.random() < 0.5 else None
    return motion, times


def compare(name, seed, **options):
    """Certified and true errors of a random motion, in double precision: starts on constraints are known as doubles alone."""
    motion, times = draw(name, seed)
    begin = perf_counter()
    ref = zd.reference(motion.system, motion.end, t_eval=times, **({"precision": "double"} | motion.options | options))
    done = perf_counter()
    rows = np.unique(np.linspace(0, len(ref.solution.t) - 1, ROWS).round().astype(int))
    exact = motion.exact(ref.solution.t[rows])
    true = tuple(max(float(abs(mp.mpf(float(a)) + mp.mpf(float(low)) - b)) for row, each in zip(rows, exact, strict=True)
                     for a, low, b in zip(high[row], lows[row], each[i], strict=True))
                 for i, (high, lows) in enumerate(((ref.p, ref.p_low), (ref.v, ref.v_low))))
    return Outcome((ref.error, ref.velocity_error), true, ref.caveats, (done - begin, perf_counter() - done))
