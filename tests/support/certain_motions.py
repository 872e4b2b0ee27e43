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
    held.double_pendulum_in_cartesian, held.ellipse, held.wire, held.hung_plate, held.crank, held.sleigh, held.knife_edge)}
ROWS = 12       # output times; of a motion with every step, three times as many rows are compared


class Outcome(NamedTuple):
    """Certified and true errors of p and v, caveats, the seconds of the reference and of the exact motion, and the arithmetic."""

    certified: tuple[float, float]
    true: tuple[float, float]
    caveats: tuple[str, ...]
    seconds: tuple[float, float]
    precision: str


def draw(name, seed):
    """A motion of a family, and the times asked for: None is every step."""
    rng = np.random.default_rng([seed, *name.encode()])
    motion = FAMILIES[name](rng)
    times = np.sort(rng.uniform(0, motion.end, ROWS)) if rng.random() < 0.5 else None
    return motion, times


def rows_of(count):
    """Rows that are compared: all of a few, otherwise evenly spaced ones, and more of them at the beginning, after which a stiff
    motion has died away.
    """
    if count <= ROWS + 1:
        return np.arange(count)
    evenly = np.linspace(0, count - 1, 2 * ROWS).round().astype(int)
    return np.unique(np.r_[evenly, np.geomspace(1, count - 1, ROWS).astype(int)])


def compare(name, seed, precision="double", **options):
    """Certified and true errors of a random motion.

    Beyond double precision, what follows from the constraints at the start has been computed with 32 digits, and the exact motion
    begins at the first sample; in double precision, at the doubles that were given.
    """
    motion, times = draw(name, seed)
    is_finer = precision == "double-double"
    if is_finer and times is not None:
        times = np.union1d([0.0], times)
    begin = perf_counter()
    ref = zd.reference(motion.system, motion.end, t_eval=times, precision=precision, **(motion.options | options))
    done = perf_counter()
    rows = rows_of(len(ref.solution.t))
    found = [[[mp.mpf(float(a)) + mp.mpf(float(b)) for a, b in zip(high[row], low[row], strict=True)] for row in rows]
             for high, low in ((ref.p, ref.p_low), (ref.v, ref.v_low))]
    start = [motion.minimal(found[0][0], found[1][0])] if is_finer and motion.minimal else []
    exact = motion.exact(ref.solution.t[rows], *start)
    true = tuple(max(float(abs(a - b)) for row, each in zip(found[i], exact, strict=True)
                     for a, b in zip(row, each[i], strict=True)) for i in (0, 1))
    return Outcome((ref.error, ref.velocity_error), true, ref.caveats, (done - begin, perf_counter() - done), ref.precision)
