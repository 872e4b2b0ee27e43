"""Laws as print has them, and the time that calls of Python take."""

import random
import warnings

import numpy as np

import zerodrift as zd
from zerodrift.runs import simulate

NOISE = random.Random(1)


def machine(law):
    m = zd.Mechanism("machine")
    arm = m.link("arm", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, arm.start)
    m.motor("drive", pin, torque=law)
    return m


def noisy(speed):
    return NOISE.random() - 0.1 * speed


def test_print_says_how_laws_are_evaluated():
    assert "laws: torque of motor 'drive' (graph)" in str(machine(lambda t, speed: np.sin(t) - speed))
    assert "(graph, not portable to the bit: Pow, tanh)" in str(machine(lambda speed: -np.tanh(speed) + abs(speed) ** 1.3))
    assert "(graph)" in str(machine(lambda speed: -speed * abs(speed) ** 1.5 if speed > 0 else np.cos(speed) % 1))
    assert "laws: torque of motor 'drive' (table)" in str(machine(zd.table([0, 1], [0, 1])))
    assert "laws: torque of motor 'drive' (call: uses " in str(machine(noisy))
    assert "laws" not in str(machine(1.0))


def test_a_run_says_once_that_calls_are_slow(monkeypatch):
    monkeypatch.setattr(simulate, "LONG_CALLS", -1.0)
    monkeypatch.setattr(simulate, "SLICE", 1e-4)     # several parts of the run
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        sol = zd.simulate(machine(noisy), 1.0, step=1e-3)
    slow = [each for each in caught if each.category is zd.CostWarning]
    assert len(slow) == 1
    assert "torque of motor 'drive'" in str(slow[0].message)
    assert slow[0].filename == __file__
    assert list(sol.stats["calls"]) == ["torque of motor 'drive'"]
    assert "of the time: torque of motor 'drive'" in repr(sol)


def test_runs_without_calls_say_nothing():
    sol = zd.simulate(machine(lambda speed: -speed), 0.1, step=0.01)
    assert sol.stats["calls"] == {}
    assert "in Python" not in repr(sol)
