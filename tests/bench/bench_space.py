"""Cost of a step in space against the number of bodies: ``python tests/bench/bench_space.py``.

Chains of N rigid bodies with both ends fixed, of spherical joints or of revolute ones with axes in all directions, coiled up so
that coordinates stay small: RK4 by ``schur`` with the default corrections, in steps of 1 ms. Times are processor times, the
minimum of many short interleaved windows.
"""

import platform
from datetime import date

import numpy as np

import zerodrift as zd
from bench_bodies import Steps
from measuring import record

ROUNDS, WINDOWS, STEP = 4, 20, 1e-3
SIZES = (10, 100, 1000, 10_000)
AT_MOST = {"spherical": 1.0, "revolute": 2.25}      # microseconds for a body and step


def place(k):
    """Position of joint k, m: near a coil."""
    return np.array([3.2 * np.cos(0.25 * k), 3.2 * np.sin(0.25 * k), 1e-3 * k + 0.3 * np.cos(0.9 * k)])


def chain(n, kind):
    """Bodies of 0.5 to 1.5 kg, whose centres and axes are in no special place."""
    m = zd.Mechanism(f"chain of {n}", dimension=3, gravity=(0, 0, -9.81))
    bodies = [m.ground]
    for i in range(n):
        q = np.array([1, *(0.5 * np.sin(i + 2 * c) for c in range(3))])
        at = (place(i) + place(i + 1)) / 2 + 0.1 * np.array([np.sin(1.3 * i), np.cos(2.1 * i), 0])
        inertia = (0.05, 0.08 + 0.02 * np.cos(i), 0.11)
        bodies.append(m.body(f"b{i}", 1 + 0.5 * np.sin(i), inertia, at=at, rotation=q / np.linalg.norm(q)))
    for k, (first, second) in enumerate(zip(bodies, [*bodies[1:], m.ground], strict=True)):
        axis = {"axis": (np.sin(2 * k + 1), np.cos(3 * k), 0.7)} if kind == "revolute" else {}
        getattr(m, kind)(f"j{k}", first, second, at=place(k), **axis)
    return m.system("absolute")


def main():
    """Measures all and writes the table."""
    runs = {}
    for kind in AT_MOST:
        for n in SIZES:
            system = chain(n, kind)
            runs[kind, n] = Steps(system, system.p0, system.v0, max(2, 1000 // n), STEP)
    for _ in range(ROUNDS):
        for (_, n), steps in runs.items():
            steps.measure(WINDOWS if n <= 1000 else 4)
    each = {key: steps.least / key[1] for key, steps in runs.items()}
    rows = [(f"microseconds of a step for each body: {kind}, {n} bodies", each[kind, n], AT_MOST[kind] if n == 100 else None)
            for kind, n in runs]
    most = SIZES[-1]
    rows += [(f"{kind}: for each body, {most} bodies to 100", each[kind, most] / each[kind, 100], None) for kind in AT_MOST]
    machine = f"{date.today()}, {platform.machine()}, python {platform.python_version()}"
    record("space", rows, ("what", f"value ({machine})", "at most"))


if __name__ == "__main__":
    main()
