"""Time of a step with user functions in all their forms, compared with that of an expression.

Run it with ``python tests/bench/bench_laws.py``. It writes ``results/laws.csv``. A force of a slider-crank is a law of the
crank's speed, or of time. Steps are of RK4, of fixed size, with the projection; forms are timed in turn, in one process, the
minimum of their rounds, in processor time, which other processes disturb little.
"""

import time
from functools import partial

import numpy as np
import sympy as sp

import zerodrift as zd
from measuring import least, record, timed

ROUNDS, STEPS, STEP = 60, 4000, 1e-6
X = np.linspace(-6, 6, 25)


def cubic(x):
    return 3 - x / 2 - x**3 / 10


def forms(name):
    """Laws of one argument by name."""
    table = partial(zd.table, X, cubic(X), argument=name)
    yield "expression", cubic(sp.Symbol(name))
    yield "function", eval(f"lambda {name}: cubic({name})", {"cubic": cubic})
    yield "function with a branch", eval(f"lambda {name}: cubic({name}) if {name} > 0 else 3 - 0.4 * {name}", {"cubic": cubic})
    yield "table", table()
    yield "table that holds", table(beyond="hold")
    yield "table of lines", table(kind="linear", beyond="line")


def system(law, compiled, of):
    m = zd.models.slider_crank()
    m.force("load", "slider", along=(1, 0), value=law, of=of)
    return m.system(compiled=compiled)


def measured():
    """Rows (what, value, unit, limit)."""
    for compiled, how, limit in ((None, "by tables", 5.0), (True, "compiled", 1.0)):
        for name, of in (("speed", {"speed": "main.speed"}), ("t", None)):
            systems = {form: system(law, compiled, of) for form, law in forms(name)}
            run = partial(zd.simulate, t_span=STEPS * STEP, step=STEP, integrator="rk4", save_every=STEPS)
            seconds = least(ROUNDS, *(timed(partial(run, each), time.process_time) for each in systems.values()))
            yield f"expression of {name}, {how}", 1e6 * seconds[0] / STEPS, "us", limit
            for form, each in list(zip(systems, seconds, strict=True))[1:]:
                yield f"{form} of {name}, {how}", each / seconds[0], "expression", 1.3


if __name__ == "__main__":
    record("laws", measured(), ("a step with", "value", "unit", "at most"))
