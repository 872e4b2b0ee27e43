"""Cost of the core and of `simulate` on the paper's four-bar: ratios and differences within one run.

Run it with ``python tests/bench/bench_four_bar.py``; it needs a C compiler, and writes ``results/four_bar.csv``.
"""

import ctypes
import functools
import os
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np

import zerodrift as zd
from measuring import least, record, timed

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT / "python"))
FLOOR_FLAGS = ["-O3", "-std=c11", "-ffp-contract=off"]
FLOORS = {"with_sines_of_libm": FLOOR_FLAGS, "with_polynomials": [*FLOOR_FLAGS, "-DPOLYNOMIAL_SINES"],
          "of_this_machine": ["-O3", "-std=c11", "-ffp-contract=fast", "-march=native", "-DPOLYNOMIAL_SINES"]}


def dop853_table():
    """The coefficients of DOP853 as a C header, from SciPy's."""
    from scipy.integrate._ivp import dop853_coefficients as table

    stages = table.N_STAGES
    arrays = {"A": table.A[:stages, :stages], "B": table.B[:stages], "E5": table.E5[:stages], "E3": table.E3[:stages]}
    return "".join(f"static const double DOP853_{name}[] = {{{', '.join(map(repr, array.ravel().tolist()))}}};\n"
                   for name, array in arrays.items())


def compiled_floor(folder, name, *flags):
    """An object or library of the floor, called `floor_NAME`; as a yardstick, each has always the same flags."""
    (folder / "dop853_table.h").write_text(dop853_table())
    target = folder / f"{name}{'.so' if '-shared' in flags else '.o'}"
    renamed = [f"-D{function}=floor_{name}{function.removeprefix('four_bar_floor')}"
               for function in ("four_bar_floor", "four_bar_floor_dop853")]
    subprocess.run([os.environ.get("CC", "cc"), *FLOORS[name], *flags, *renamed, "-I", folder, "-o", target,
                    HERE / "four_bar_floor.c", *(["-lm"] if "-shared" in flags else [])], check=True)
    return target


def compiled(folder):
    """Floors and core in one program: the core with the product's flags."""
    from build_core import FLAGS

    objects, program = [compiled_floor(folder, name, "-c") for name in FLOORS], folder / "compare"
    subprocess.run([os.environ.get("CC", "cc"), *FLAGS, "-fPIC", "-I", ROOT / "csrc", "-o", program, HERE / "compare.c", *objects,
                    *sorted((ROOT / "csrc").rglob("*.c")), "-lm"], check=True)
    return program


def steps():
    """Nanoseconds per step of floors and formulations, and that all of them go to the same place."""
    with tempfile.TemporaryDirectory() as folder:
        output = subprocess.run([compiled(Path(folder))], check=True, capture_output=True, text=True).stdout
    lines = [line.split() for line in output.splitlines()]
    angles = {name: float(angle) for name, _, angle in lines}
    apart = {name: abs(angle - angles["schur"]) for name, angle in angles.items()}
    assert max(apart[name] for name in ("libm", "polynomials", "machine")) < 1e-8, apart    # the same equations
    assert max(apart.values()) < 1e-2, apart        # other states are integrated, by a method that errs as much at this step
    return {name: float(ns) for name, ns, _ in lines}


def floor_runs(name, folder, span, p, v):
    """A function of rtol: a floor's run by DOP853 as a function that gives the times and alpha_1 at its steps."""
    library = ctypes.CDLL(compiled_floor(Path(folder), name, "-shared", "-fPIC"))
    run, pointer = getattr(library, f"floor_{name}_dop853"), np.ctypeslib.ndpointer(float, flags="C")
    run.argtypes = [pointer, pointer, ctypes.c_double, ctypes.c_double, ctypes.c_double, ctypes.c_int, pointer, pointer]
    t, alpha = np.empty(100_000), np.empty(100_000)

    def of(rtol):
        def call():
            steps = run(p, v, span, rtol, 1e-12, len(t), t, alpha)
            return t[:steps], alpha[:steps]
        return call
    return of


def cheapest(errors, contestants, exact, rounds=10):
    """Seconds and rtol, by contestant and error, of the fastest run whose alpha_1 errs by no more at its steps."""
    found = {(name, error): (np.inf, np.nan) for name in contestants for error in errors}
    for rtol in 10.0 ** np.arange(-5, -13.1, -0.2):
        calls = {name: of(rtol) for name, of in contestants.items()}
        best = dict(zip(calls, least(rounds, *map(timed, calls.values())), strict=True))
        for name, call in calls.items():
            t, alpha = call()
            wrong = np.abs(alpha - exact(t)[0][:, 0]).max()
            for error in errors:
                if wrong <= error:
                    found[name, error] = min(found[name, error], (best[name], rtol))
    return found


def costs_of_errors(errors, span=8.0):
    """Times at given errors: of calls of `simulate`, without energy correction and with every step saved, and of the floors."""
    bar = zd.systems.four_bar()
    exact = zd.reference(bar, span, error=None).solution

    def simulated(integrator, rtol):
        def call():
            sol = zd.simulate(bar, span, integrator=integrator, rtol=rtol, atol=rtol)
            return sol.t, sol.p[:, 0]
        return call

    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", zd.AccuracyWarning)     # of the coarsest: their errors are measured here
        ours = {integrator: functools.partial(simulated, integrator) for integrator in ("dormand_prince", "dop853")}
        floors = {name: floor_runs(name, folder, span, bar.p0.copy(), bar.v0.copy()) for name in FLOORS}
        return cheapest(errors, ours | floors, exact)


def measured():
    """Rows (what, value, unit, limit)."""
    ns = steps()
    for name, sines in (("libm", "sines of the C library"), ("polynomials", "polynomials"),
                        ("machine", "polynomials, all that this machine has")):
        yield f"floor, a step: {sines}", ns[name], "ns", None
    for name in zd.formulations():
        yield f"{name}, a step", ns[name], "ns", None
    default = "schur"
    yield f"{default} to floor with polynomials", ns[default] / ns["polynomials"], "", None
    yield f"{default} with every row saved to floor with polynomials", ns[f"{default}+rows"] / ns["polynomials"], "", None
    limits = {"nullspace": 2, "mixed": 2, "independent": 3}
    for name in zd.formulations():
        if name != default:
            yield f"{name} to {default}", ns[name] / ns[default], "", limits.get(name)
    errors = (1e-3, 1e-6, 1e-9)
    costs = costs_of_errors(errors)
    for error in errors:
        (seconds, rtol), how = min((costs[name, error], name) for name in ("dormand_prince", "dop853"))
        yield f"error of {error:g} over 8 s ({how}, rtol = {rtol:.2g})", 1e6 * seconds, "us", None
        for name in FLOORS:
            floor, rtol = costs[name, error]
            yield f"floor {name.replace('_', ' ')}, dop853, rtol = {rtol:.2g}", 1e6 * floor, "us", None
            yield f"error of {error:g}, simulate to that floor", seconds / floor, "", None


if __name__ == "__main__":
    record("four_bar", measured(), ("what", "value", "unit", "at most"), digits=4)
