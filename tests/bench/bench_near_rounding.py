"""Time of the paper's four-bar to small errors, by zerodrift and heyoka.py: of the run, and of the whole call of `simulate`.

Run it with ``python tests/bench/bench_near_rounding.py``; it writes ``results/near_rounding.csv``. Timed are a run that was
created before, from its start to the end, as heyoka.py's integrator is compiled and set to the start before; and `simulate`,
which creates the run, too. heyoka.py corrects nothing; zerodrift projects after each step. The error of a setting is the largest
of any angle at outputs 0.05 s apart, from a run of its own. Processor time, the lower quartile of forty interleaved rounds; one
thread, and the same vector unit.
"""

import dataclasses
import functools
import itertools
import sys
import time
from pathlib import Path

import numpy as np

import zerodrift as zd
from measuring import RESULTS

sys.path.insert(0, str(Path(__file__).resolve().parent / "peers"))
import problems
import with_heyoka

SPANS = {0.5: (1e-9, 1e-12), 8.0: (1e-9, 2e-11)}    # errors to which methods are compared, by the end time in s
TOLERANCES = 10.0 ** -np.arange(8, 15, 0.5)
FINEST_TOLERANCE = 2.3e-14     # of zerodrift's tolerances
ROUNDS = 40
BAR = zd.systems.four_bar()
CREATIONS = 10      # of heyoka.py's integrator
COLUMNS = ("span", "error", "method", "tolerance", "its error", "microseconds", "of heyoka's best")


def timed(call, *given):
    """Processor time of a call, s."""
    start = time.process_time()
    call(*given)
    return time.process_time() - start


def of_heyoka(chain, equations, tolerance):
    """Angles at the outputs, and a measurement."""
    p, _ = with_heyoka.solve(chain, (equations, tolerance))
    integrator, start = with_heyoka._integrator(chain, equations, tolerance)

    def again():
        integrator.time = 0.0
        integrator.state[:] = start
        return timed(integrator.propagate_until, chain.t_end)

    return p, again


def of_run(chain, settings, tolerance):
    """The same of a run that is there."""
    settings = {**settings, "rtol": tolerance, "atol": tolerance}
    p = zd.simulate(BAR, chain.t_end, chain.p0, chain.v0, t_eval=chain.outputs, **settings).p
    run = zd.Run(BAR, chain.p0, chain.v0, **settings)

    def again():
        run.reset()
        seconds = timed(run.advance_to, chain.t_end)
        assert np.abs(run.p - p[-1]).max() < 1e-5
        return seconds

    return p, again


def of_call(chain, settings, tolerance):
    """The same of the whole call."""
    settings = {**settings, "rtol": tolerance, "atol": tolerance}
    p = zd.simulate(BAR, chain.t_end, chain.p0, chain.v0, t_eval=chain.outputs, **settings).p
    return p, lambda: timed(lambda: zd.simulate(BAR, chain.t_end, chain.p0, chain.v0, save_every=10**6, **settings))


def methods():
    """Name of each method, and a function of the chain and the tolerance that measures it."""
    for equations in ("velocities eliminated", "multipliers eliminated"):
        yield f"heyoka.py, {equations}", lambda chain, tolerance, e=equations: of_heyoka(chain, e, tolerance)
    for integrator, formulation in itertools.product(("dop853", "taylor"), ("augmented", "schur")):
        settings = {"integrator": integrator, "formulation": formulation}
        for what, of in (("run", of_run), ("simulate", of_call)):
            yield (f"zerodrift, {what}: {formulation}, {integrator}",
                   lambda chain, tolerance, of=of, s=settings: of(chain, s, tolerance))


def measured(t_end):
    """Method, tolerance, error and time of every setting."""
    chain = dataclasses.replace(problems.four_bar(), t_end=t_end)
    ref = zd.reference(BAR, t_end, chain.p0, chain.v0, error=1e-15, t_eval=chain.outputs)
    cases = []
    for (name, method), tolerance in itertools.product(methods(), TOLERANCES):
        if tolerance < FINEST_TOLERANCE and not name.startswith("heyoka"):
            continue
        p, again = method(chain, tolerance)
        cases.append((name, tolerance, np.abs(p - ref.p).max(), again))
    rounds = [[again() for *_, again in cases] for _ in range(ROUNDS)]
    return [(*case[:3], np.quantile(times, 0.25)) for case, times in zip(cases, zip(*rounds, strict=True), strict=True)]


def creation():
    """Milliseconds of the creation of heyoka.py's integrator: for the first time, and with its code in the process's cache."""
    system, start = with_heyoka._reduced(problems.four_bar())
    return [1e3 * timed(functools.partial(with_heyoka.hy.taylor_adaptive, system, list(map(float, start)), tol=1e-10))
            for _ in range(CREATIONS)]


def rows():
    """The quickest setting of each method that reaches an error."""
    for t_end, errors in SPANS.items():
        found = measured(t_end)
        for error in errors:
            best = {}
            for name, tolerance, own, seconds in found:
                if own <= error and seconds < best.get(name, (np.inf,))[0]:
                    best[name] = seconds, tolerance, own
            heyoka = min((of[0] for name, of in best.items() if name.startswith("heyoka")), default=np.nan)
            for name, (seconds, tolerance, own) in best.items():
                yield (f"{t_end:g} s", f"{error:.0e}", name, f"{tolerance:.0e}", f"{own:.1e}", f"{1e6 * seconds:.1f}",
                       f"{seconds / heyoka:.2f}")


if __name__ == "__main__":
    first, *again = creation()
    print(f"heyoka.py's integrator is created in {first:.0f} ms, again in {min(again):.0f} ms")
    lines = [",".join(COLUMNS)]
    for row in rows():
        print(*row, sep="  ", flush=True)
        lines.append(",".join(f'"{each}"' if "," in each else each for each in row))
    (RESULTS / "near_rounding.csv").write_text("\n".join(lines) + "\n")
