"""Time of kinematics and of inverse dynamics, in corrected steps of the same system.

Run it with ``python tests/bench/bench_given_motions.py``. It writes ``results/given_motions.csv``. Steps are of RK4, of fixed
size, with the projection, by tables that are interpreted, at the start of the motion; samples lie along it. The three are timed
in turn, in one process, the minimum of their rounds, in processor time, which other processes disturb little.
"""

import time
from functools import partial
from unittest import mock

import numpy as np

import zerodrift as zd
from measuring import least, record, timed

ROUNDS, SAMPLES, STEPS = 20, 2000, 4000
STEP = 1e-6
T = np.linspace(0, 1, SAMPLES)


def chain(links):
    """A planar chain of links, each on a hinge."""
    m = zd.Mechanism("chain", gravity=(0, -9.81))
    last = m.ground.point((0, 0))
    for i in range(links):
        link = m.link(f"link {i}", (i, 0), (i + 1, 0), mass=1.0)
        m.revolute(f"pin {i}", last, link.start)
        last = link.end
    return m


def undriven(model):
    """A model without its motors."""
    with mock.patch.object(zd.Mechanism, "motor"):
        return model()


def swings(names, amplitude):
    """Motions from zero, each with a phase of its own."""
    return {name: (lambda t, i=i: amplitude * (np.sin(3 * t + i) - np.sin(i))) for i, name in enumerate(names)}


def motions():
    """Each mechanism with its prescribed motion."""
    turn = {"crank.angle": lambda t: np.pi / 2 + 2 * np.sin(2 * t)}
    yield "four-bar, crank", zd.models.four_bar(), turn
    yield "slider-crank, crank", zd.models.slider_crank(), turn
    yield "Andrews' mechanism, crank", zd.models.andrews(), {"K1.angle": lambda t: -0.0617138900142764496 + 0.5 * np.sin(3 * t)}
    for links in (2, 3, 7):
        yield f"chain of {links} links, all angles", chain(links), {
            f"pin {i}.angle": (lambda t, i=i: 0.3 * np.sin(3 * t + i)) for i in range(links)}
    yield "Watt's linkage, left angle", undriven(zd.models.watt), swings(["left.angle"], 0.1)
    yield "gyroscope, 3 angles", zd.models.gyroscope(), swings(["pivot.angle", "trunnion.angle", "axle.angle"], 0.1)
    yield "Bennett's linkage, an angle", undriven(zd.models.bennett), swings(["B.angle"], 0.1)
    yield "delta robot, 3 shoulders", undriven(zd.models.delta_robot), swings([f"shoulder {i}.angle" for i in range(3)], 0.3)
    yield "Stewart platform, 6 strokes", undriven(zd.models.stewart_platform), swings(
        [f"stroke {i}.displacement" for i in range(6)], 0.05)


def measured():
    """Rows (what, value, unit, limit); limits hold in the coordinates that are the default of these mechanisms."""
    for name, mechanism, motion in motions():
        for coordinates in ("joint", "absolute"):
            system, of = mechanism.system(coordinates), f"{name}, {coordinates} coordinates"
            kin, is_default = zd.kinematics(system, motion, T), coordinates == "joint"
            calls = (partial(zd.simulate, system, STEPS * STEP, step=STEP, integrator="rk4", save_every=STEPS),
                     partial(zd.kinematics, system, motion, T), partial(zd.inverse_dynamics, system, kin))
            seconds = least(ROUNDS, *(timed(call, time.process_time) for call in calls))
            step, kinematics, inverse = (each / number for each, number in zip(seconds, (STEPS, SAMPLES, SAMPLES), strict=True))
            yield f"a step: {of}", 1e6 * step, "us", None
            yield f"a sample of kinematics: {of}", kinematics / step, "steps", 1.5 if is_default else None
            yield f"a sample of inverse dynamics: {of}", inverse / step, "steps", 1.0 if is_default else None


if __name__ == "__main__":
    record("given_motions", measured(), ("what", "value", "unit", "at most"))
