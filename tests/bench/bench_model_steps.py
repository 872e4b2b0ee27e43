"""Steps of all models, by matrices, as they come, and compiled, fixed and adaptive, beside a step of MuJoCo at its own settings.

Run it with ``python tests/bench/bench_model_steps.py`` where mujoco is installed, too; it needs a C compiler and writes
``results/model_steps.csv``. Fixed steps are 300 of "rk4" at 0.1 ms, adaptive ones those of "dop853" over 0.2 s, both with
projection, in the coordinates that `Mechanism.system` takes; compiled ones are in joint coordinates. A step of MuJoCo is one of
its Euler method at 2 ms, with soft constraints, its solver as it comes, and no contacts (`models_in_mujoco.py`): it evaluates
forces once and has no error bound. "Import to solution" is a new process that imports, builds the model and makes the fixed
steps.
"""

import contextlib
import csv
import subprocess
import sys
import time
import warnings

import zerodrift as zd
from measuring import RESULTS

with contextlib.suppress(ImportError):
    import mujoco

    import models_in_mujoco

ROUNDS, STEPS, STEP, SPAN, PEER_STEPS = 5, 300, 1e-4, 0.2, 300
COLUMNS = ("model", "import to solution [s]", "fixed, matrices [us]", "as it comes [us]", "compiled [us]",
           "adaptive, matrices [us]", "as it comes [us]", "compiled [us]", "MuJoCo [us]", "MuJoCo / as it comes",
           "MuJoCo / compiled")
SCRIPT = f"import zerodrift as zd; zd.simulate(zd.models.{{}}(), {STEPS * STEP}, step={STEP})"
LARGE_MODEL = "chain"     # 1000 links: no code is written for it; `bench_bodies.py` has it beside others


def fixed(system):
    """Microseconds of a fixed step."""
    return 1e6 * zd.simulate(system, STEPS * STEP, step=STEP, save_every=STEPS).stats["seconds"] / STEPS


def adaptive(system):
    """Microseconds of an adaptive step."""
    stats = zd.simulate(system, SPAN, save_every=10**6).stats
    return 1e6 * stats["seconds"] / stats["steps"]


def from_import(name):
    """Seconds of a new process."""
    start = time.perf_counter()
    subprocess.run([sys.executable, "-W", "ignore", "-c", SCRIPT.format(name)], check=True)
    return time.perf_counter() - start


def peer(m):
    """A callable that gives the microseconds of a step of MuJoCo; NaN where it lacks an element of the mechanism."""
    text = models_in_mujoco.described(m) if m and "mujoco" in globals() else None
    if text is None:
        return lambda: float("nan")
    mujoco.set_mju_user_warning(lambda message: None)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)

    def microseconds():
        mujoco.mj_resetData(model, data)
        start = time.perf_counter()
        mujoco.mj_step(model, data, nstep=PEER_STEPS)
        return 1e6 * (time.perf_counter() - start) / PEER_STEPS

    return microseconds


def measured(name):
    """The row of a model: least times of alternating rounds."""
    m = getattr(zd.models, name)()
    matrices, usual, of_peer = m.system(compiled=False), m.system(), peer(None if name == LARGE_MODEL else m)
    calls = [lambda: from_import(name), lambda: fixed(matrices), lambda: fixed(usual), lambda: adaptive(matrices),
             lambda: adaptive(usual), of_peer]
    if name != LARGE_MODEL:
        compiled = m.system(compiled=True)
        calls += [lambda: fixed(compiled), lambda: adaptive(compiled)]
    least = [min(times) for times in zip(*([call() for call in calls] for _ in range(ROUNDS)), strict=True)]
    total, by_matrices, step, adaptive_by_matrices, adaptive_step, other, *code = least
    code = code or [float("nan")] * 2
    return (total, by_matrices, step, code[0], adaptive_by_matrices, adaptive_step, code[1], other, other / step,
            other / code[0])


def main():
    """Measure all, print and write the table."""
    warnings.simplefilter("ignore")
    names = sorted({*zd.models.__all__, *zd.models.space.__all__} - {"space"})
    with (RESULTS / "model_steps.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        for name in sys.argv[1:] or names:
            row = [name, *(f"{value:.3g}" for value in measured(name))]
            print(*row, sep="  ", flush=True)
            table.writerow(row)


if __name__ == "__main__":
    main()
