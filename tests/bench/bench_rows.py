"""Cost of samples and events between adaptive steps, on the paper's four-bar over 8 s.

Run it with ``python tests/bench/bench_rows.py``; it writes ``results/rows.csv``. Runs with few and with many samples are made in
turn, and the minimum time of the core counts for each: the increase due to 161 samples over a run that saves its start and end
alone, and the time per sample from 16,001 samples against 161, both at a tolerance of 1e-9. For some hundred events: the increase
per event, all evaluations of its function included, in processor time of the call, as functions of Python wait for other threads.
On the closed-form path and on the matrix path, which some systems and formulations need.
"""

import functools
import itertools
import math
import time

import numpy as np
import sympy as sp

import zerodrift as zd
from measuring import least, record

RTOL, SPAN = 1e-9, 8.0
FEW, SOME, MANY = 2, 161, 16_001
ROUNDS = {FEW: 30, SOME: 300, MANY: 30}
METHODS = ("dop853", "dormand_prince")
PATHS = {"closed-form path": None, "matrix path": False}


def seconds(system, rows, tolerance=RTOL, **options):
    """Function that returns the core's time of one run with `rows` samples, s."""
    times = np.linspace(0, SPAN, rows)
    return lambda: zd.simulate(system, SPAN, t_eval=times, rtol=tolerance, atol=tolerance, **options).stats["seconds"]


def pendulum():
    """A mechanism, and the height of its end, which passes some hundred others."""
    m = zd.Mechanism("pendulum", gravity=(0, -9.81))
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    m.revolute("pin", m.ground, link.start)
    return m, [zd.Event(link.end.position.y, value=value) for value in np.linspace(-0.95, -0.05, 12)]


BAR = zd.systems.four_bar()
WATCHED = {
    "an expression": (BAR, zd.Event(sp.sin(9 * sp.Symbol("alpha1")))),
    "a function of Python": (BAR, lambda t, p, v: math.sin(9 * p[0])),
    "a measure": pendulum(),
}


def processor_seconds(system, tolerance, **options):
    """Function that returns the processor time of a call that saves the start and the end, s."""
    def call():
        start = time.thread_time()
        zd.simulate(system, SPAN, t_eval=[0, SPAN], rtol=tolerance, atol=tolerance, **options)
        return time.thread_time() - start
    return call


def of_events():
    """About a hundred in each run; rows as those of `measured`."""
    for integrator, tolerance, (path, closed_form) in itertools.product(METHODS, (1e-6, 1e-9), PATHS.items()):
        for what, (system, events) in WATCHED.items():
            run = functools.partial(processor_seconds, system, tolerance, integrator=integrator, closed_form=closed_form)
            without, with_them = least(ROUNDS[FEW], run(), run(events=events))
            found = zd.simulate(system, SPAN, rtol=tolerance, atol=tolerance, integrator=integrator, events=events).t_events
            count = sum(map(len, found))
            name = f"{integrator}, {tolerance:.0e}, {path}"
            yield f"{name}: an event of {count}, {what}", 1e6 * (with_them - without) / count, "us", None


def measured():
    """Rows (what, value, unit, limit)."""
    for integrator in METHODS:
        for path, closed_form in PATHS.items():
            run = functools.partial(seconds, BAR, integrator=integrator, closed_form=closed_form)
            few, some = least(ROUNDS[SOME], run(FEW), run(SOME))
            fewer, many = least(ROUNDS[MANY], run(SOME), run(MANY))
            name = f"{integrator}, {path}"
            yield f"{name}: increase of a run's time by {SOME} samples", 100 * (some / few - 1), "%", 20
            yield f"{name}: a sample, of {MANY}", 1e6 * (many - fewer) / (MANY - SOME), "us", 0.3


if __name__ == "__main__":
    record("rows", itertools.chain(measured(), of_events()), ("what", "value", "unit", "at most"))
