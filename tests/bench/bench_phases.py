"""Cost of a change of phase, in steps of the same scene; and a joint that sticks for 1e6 steps.

    python tests/bench/bench_phases.py

writes ``results/phases.csv`` and ``results/stuck.csv``. Each scene is run with two sizes of steps, from whose times the cost
of a step follows. A change is all that remains, shared among the changes: the search for the instant, the problem of contacts,
the first step of the phase that follows.
"""

import csv
import pathlib
import sys
import time
import warnings

import numpy as np

import zerodrift as zd

G = 9.81
REPEATS = 5
DURATION = 40.0     # s
STUCK_STEPS = 10**6
RESULTS = pathlib.Path(__file__).parent / "results"


def ball():
    """A ball that bounces without loss."""
    m = zd.Mechanism("ball", gravity=(0, -G))
    body = m.particle("ball", 1.0, at=(0, 0.05))
    m.contact("floor", body, m.ground.line((0, 0), (1, 0)), restitution=1.0)
    return m


def box():
    """A box with four corners and friction, thrown between floor and ceiling."""
    m = zd.Mechanism("box", gravity=(0, 0))
    body = m.body("box", 1.0, 0.03, at=(0, 0.5), angle=0.3)
    for where, line in (("floor", ((0, 0), (1, 0))), ("ceiling", ((1, 1), (0, 1)))):
        for name, corner in {"a": (-0.2, -0.2), "b": (0.2, -0.2), "c": (0.2, 0.2), "d": (-0.2, 0.2)}.items():
            m.contact(f"{name} {where}", body.point(corner), m.ground.line(*line), restitution=1.0, friction=0.0)
    m.start({body.velocity: (0.0, 3.0)})
    return m


def slider():
    """A slider with dry friction on a spring, driven by a force to and fro."""
    m = zd.Mechanism("slider", gravity=(0, -G))
    block = m.body("block", 2.0, 0.1)
    slide = m.prismatic("slide", m.ground, block, at=(0, 0), axis=(1, 0), friction_force=(2.0, 1.5))
    m.motor("push", slide, force=lambda t: 6 * np.sin(30 * t))
    return m


def crank():
    """A slider-crank with friction by loads in two joints, driven by a torque to and fro."""
    m = zd.Mechanism("crank", gravity=(0, -G))
    arm, rod = m.link("arm", (0, 0), (0.2, 0.1), mass=1.0), m.link("rod", (0.2, 0.1), (0.8, 0), mass=1.0)
    block = m.body("block", 1.0, 0.01, at=(0.8, 0))
    pin = m.revolute("A", m.ground, arm.start, friction=0.1, radius=0.02)
    m.revolute("B", arm.end, rod.start)
    m.revolute("C", rod.end, block)
    m.prismatic("S", m.ground, block, axis=(1, 0), friction=0.2)
    m.motor("drive", pin, torque=lambda t: 8 * np.sin(30 * t))
    return m


def seconds(system, duration, settings):
    """Least processor time of a run, its steps and its changes of phase."""
    least, steps, changes = np.inf, 0, 0
    for _ in range(REPEATS):
        run = zd.Run(system, **settings)
        begin = time.process_time()
        run.advance_to(duration)
        least = min(least, time.process_time() - begin)
        steps, changes = run._core.steps, run._core._changes.count - 1
    return least, steps, changes


def row(scene, settings):
    """Cost of a change of phase of a scene in its steps: the same motion is made with four times as many steps."""
    system, finer = scene().system(), {**settings, "step" if "step" in settings else "max_step": 2.5e-3}
    few, more = seconds(system, DURATION, settings), seconds(system, DURATION, finer)
    step = (more[0] - few[0]) / (more[1] - few[1])
    change = (few[0] - few[1] * step) / few[2]
    how = "fixed" if "step" in settings else "adaptive"
    return scene.__doc__.rstrip("."), how, *few[1:], f"{1e6 * step:.2g}", f"{change / step:.2g}"


def stuck():
    """The friction of a joint that sticks for so many steps: largest speed, and largest share of its bound."""
    m = zd.Mechanism("stuck", gravity=(0, -G))
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    m.revolute("pin", m.ground, link.start, friction_torque=6.0)
    run = zd.Run(m.system("joint"), step=1e-3)
    speed = share = 0.0
    for _ in range(100):
        run.step(STUCK_STEPS // 100)
        speed, share = max(speed, abs(run["pin.speed"])), max(share, abs(run["pin.torque"]) / 6.0)
    return run._core.steps, f"{speed:g}", f"{run['pin.angle']:g}", f"{share:.4f}"


def write(name, header, rows):
    """Write a table."""
    with (RESULTS / f"{name}.csv").open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([header, *rows])


def main():
    """Write the tables."""
    warnings.simplefilter("ignore")
    settings = {"step": 0.01}, {"rtol": 1e-8, "atol": 1e-10, "max_step": 0.01}
    write("phases", ("scene", "steps", "number", "changes", "us a step", "steps a change"),
          [row(scene, each) for scene in (ball, box, slider, crank) for each in settings])
    write("stuck", ("steps", "largest speed", "angle", "largest share of the bound"), [stuck()])


if __name__ == "__main__":
    sys.exit(main())
