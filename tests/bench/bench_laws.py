"""Time of a step with user functions in all their forms, compared with that of an expression.

Run it with ``python tests/bench/bench_laws.py``. It writes ``results/laws.csv``. A slider-crank has a force on its slider by a law of
the crank's speed. Steps are of RK4, of fixed size, with the projection; forms are timed in turn, in one process, the minimum of their
rounds, in processor time, which other processes disturb little.
"""

import time
from functools import partial

import numpy as np
import sympy as sp

import zerodrift as zd
from measuring import least, record, timed

ROUNDS, STEPS, STEP = 30, 4000, 1e-6
W = np.linspace(-6, 6, 25)
SPEED = sp.Symbol("w")
OF = {"w": "main.speed"}


def cubic(w):
    return 3 - w / 2 - w**3 / 10


def forms():
    """Laws of the speed w of the crank by name."""
    yield "expression", cubic(SPEED)
    yield "function", cubic
    yield "function with a branch", lambda w: cubic(w) if w > 0 else 3 - 0.4 * w
    for beyond in ("error", "hold", "line"):
        yield f"table, beyond={beyond!r}", zd.table(W, cubic(W), argument="w", beyond=beyond)
    yield "table, linear", zd.table(W, cubic(W), argument="w", kind="linear", beyond="hold")


def system(law, compiled):
    m = zd.models.slider_crank()
    m.force("load", "slider", along=(1, 0), value=law, of=OF)
    return m.system(compiled=compiled)


def measured():
    """Rows (what, value, unit, limit)."""
    for compiled, how, limit in ((None, "by tables", 5.0), (True, "compiled", 1.0)):
        systems = {name: system(law, compiled) for name, law in forms()}
        calls = [partial(zd.simulate, each, STEPS * STEP, step=STEP, integrator="rk4", save_every=STEPS) for each in systems.values()]
        seconds = least(ROUNDS, *(timed(call, time.process_time) for call in calls))
        for i, (name, each) in enumerate(zip(systems, seconds, strict=True)):
            yield f"a step, {how}: {name}", 1e6 * each / STEPS, "us", None if i else limit
            yield f"a step, {how}: {name}", each / seconds[0], "expression", 1.3


if __name__ == "__main__":
    record("laws", measured(), ("what", "value", "unit", "at most"))
