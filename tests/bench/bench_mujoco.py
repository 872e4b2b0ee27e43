"""Steps a second of 1024 cart-poles that receive new forces in each step, beside MuJoCo's `rollout` with its RK4 and its Euler.

Run it with ``python tests/bench/bench_mujoco.py`` where mujoco is installed, too; it writes ``results/mujoco.csv``. Both programs
take the same starts and forces, RK4 at 0.02 s; rounds alternate, and the minimum of each is quoted, in processor
time. `rollout` is called once for each step, as a loop with a controller has to, and once for sixty steps, whose forces are then
known beforehand. The semi-implicit Euler method has its step reduced until its error at the end, which is proportional to it, is
that of RK4; the reference is `zerodrift` at a step of 0.5 ms.
"""

import mujoco
import numpy as np
from mujoco import rollout

import zerodrift as zd
from bench_open_runs import CALLS, FORCES, RUNS, cart_pole, processor_seconds
from measuring import record

ROUNDS, STEP = 8, 0.02
STARTS = np.random.default_rng(2).uniform(-0.1, 0.1, (RUNS, 2))
TEXT = """
<mujoco>
  <option timestep="{step}" integrator="{integrator}" gravity="0 0 -9.81"><flag contact="disable" constraint="disable"/></option>
  <worldbody>
    <body name="cart">
      <joint name="slide" type="slide" axis="1 0 0"/>
      <inertial pos="0.1 0 0" mass="1" diaginertia="0.01 0.01 0.01"/>
      <body name="pole">
        <joint name="hinge" type="hinge" axis="0 -1 0"/>
        <inertial pos="0.5 0 0" mass="0.1" diaginertia="{inertia} {inertia} {inertia}"/>
      </body>
    </body>
  </worldbody>
  <actuator><motor joint="slide"/></actuator>
</mujoco>
"""


class Peer:
    """MuJoCo's cart-poles: a model, one `MjData`, and the states (runs, 1 + nq + nv) of all."""

    def __init__(self, integrator, step):
        text = TEXT.format(integrator=integrator, step=step, inertia=0.1 / 12)
        self.model = mujoco.MjModel.from_xml_string(text)
        self.data = [mujoco.MjData(self.model)]
        self.begin()

    def begin(self):
        """Set the states to the starts."""
        self.state = np.zeros((RUNS, 5))
        self.state[:, 1:3] = STARTS

    def step(self, forces, steps=1):
        """Advance with forces (runs,), each of which holds for some steps, or (runs, steps)."""
        control = np.ascontiguousarray(np.broadcast_to(forces[:, None] if forces.ndim == 1 else forces, (RUNS, steps)))[..., None]
        states, _ = rollout.rollout(self.model, self.data, self.state, control, nstep=steps)
        self.state = np.ascontiguousarray(states[:, -1])

    @property
    def p(self):
        """Coordinates (runs, 2)."""
        return self.state[:, 1:3]


def ours(step):
    """Open runs at the starts."""
    return zd.ManyRuns(cart_pole().system(compiled=True), STARTS, runs=RUNS, step=step, inputs=["drive.force"])


def end_of_ours(step):
    """Coordinates after all forces, each of which holds for 0.02 s."""
    runs = ours(step)
    for forces in FORCES:
        runs["drive.force"] = forces
        runs.step(round(STEP / step))
    return runs.p


def error_of_euler(step, reference):
    """Largest error of MuJoCo's Euler after all forces."""
    peer = Peer("Euler", step)
    for forces in FORCES:
        peer.step(forces, round(STEP / step))
    return np.abs(peer.p - reference).max()


def rounds(calls):
    """Minimum processor time of each call over alternating rounds, s."""
    return np.min([[processor_seconds(call) for call in calls] for _ in range(ROUNDS)], axis=0)


def rows():
    """Rows: rates, their ratios, and errors."""
    runs, rk4, euler = ours(STEP), Peer("RK4", STEP), Peer("Euler", STEP)
    turned = np.ascontiguousarray(FORCES.T)

    def of_ours():
        for forces in FORCES:
            runs["drive.force"] = forces
            runs.step()

    def of(peer):
        for forces in FORCES:
            peer.step(forces)

    taken = rounds([of_ours, lambda: of(rk4), lambda: rk4.step(turned, CALLS), lambda: euler.step(turned, CALLS)])
    rates = 1e-6 * RUNS * CALLS / taken
    for peer in (rk4, euler):
        peer.begin()
        peer.step(turned, CALLS)
    reference, end = end_of_ours(5e-4), end_of_ours(STEP)
    names = ("zerodrift, RK4, forces in each step", "MuJoCo, RK4, forces in each step", "MuJoCo, RK4, forces known beforehand",
             "MuJoCo, Euler at the same step, forces known beforehand")
    for name, rate in zip(names, rates, strict=True):
        yield f"{name}: steps a second of one processor", rate, "1e6/s", None
    yield "ratio to MuJoCo's RK4, forces in each step (at least 3)", rates[0] / rates[1], "", None
    yield "ratio to MuJoCo's RK4, its forces known beforehand (at least 3)", rates[0] / rates[2], "", None
    error, largest = np.abs(end - reference).max(), error_of_euler(5e-4, reference)
    yield "difference of both RK4 after 1.2 s", np.abs(end - rk4.p).max(), "m, rad", None
    yield "error of RK4 at 0.02 s after 1.2 s", error, "m, rad", None
    yield "error of MuJoCo's Euler at 0.5 ms after 1.2 s", largest, "m, rad", None
    size = 5e-4 * error / largest
    yield "step of Euler of the same error", size, "s", None
    yield "ratio to MuJoCo's Euler at the step of the same error (at least 3)", rates[0] / rates[3] * STEP / size, "", None


if __name__ == "__main__":
    record("mujoco", list(rows()), ("what", "value", "unit", "at most"))
