"""Saved runs continue with the same bits, here and in another process; wrong states are refused with a reason."""

import functools
import os
import subprocess
import sys

import numpy as np
import pytest

import zerodrift as zd
from few_bodies import two_links
from support import refused


def same(one, other):
    return one.t == other.t and np.array_equal(one.p, other.p) and np.array_equal(one.v, other.v)


@pytest.mark.parametrize("settings", [
    {"step": 0.01}, {"step": 0.01, "energy": True}, {"step": 0.01, "formulation": "mixed"}, {"step": 0.01, "integrator": "radau"},
    {"step": 0.01, "formulation": "independent", "integrator": "dop853"}, {"rtol": 1e-8}, {"rtol": 1e-7, "integrator": "radau"},
    {"step": 0.01, "stabilization": "baumgarte"}], ids=str)
def test_a_restored_run_continues_with_the_same_bits(settings):
    run = zd.Run(zd.systems.four_bar(), **settings)
    run.step(37)
    state = run.save()
    run.step(60)
    other = zd.Run(zd.systems.four_bar(), **settings)
    other.step(3)
    other.restore(state)
    assert other.steps == 37
    other.step(60)
    assert same(run, other)
    assert run.save() == other.save()


@pytest.mark.parametrize("compiled", [False, True])
def test_inputs_are_part_of_a_state(compiled):
    run = zd.Run(two_links().system(compiled=compiled), step=0.01, inputs=["drive.torque"])
    run["drive.torque"] = 3.0
    run.step(20)
    state, twin = run.save(), run.copy()
    for each in (run, twin):
        each["drive.torque"] = -2.0
        each.step(20)
    assert same(run, twin)
    array = run.inputs
    run.restore(state)
    assert run["drive.torque"] == 3.0
    assert run.inputs is array
    run.inputs[:] = -2.0
    run.step(20)
    assert same(run, twin)


def test_the_ramp_of_a_speed_is_part_of_a_state():
    m = zd.Mechanism("wheel")
    body = m.body("body", 1.0, 0.1)
    m.motor("drive", m.revolute("hinge", m.ground, body, at=(0, 0)), speed=0.0)
    run = zd.Run(m, step=0.01, inputs=["drive.speed"])
    run["drive.speed"] = 2.0
    run.step()
    twin = run.copy()
    for each in (run, twin):
        each.step(5)
    assert same(run, twin)
    assert twin["hinge.angle"] == pytest.approx(0.01 + 5 * 0.02, rel=1e-9)


class Integral:
    """A controller with a state."""

    def __init__(self):
        self.sum = 0.0

    def __call__(self, run):
        self.sum -= run["pin.angle"]
        run["drive.torque"] = self.sum

    def state(self):
        return self.sum

    def restore(self, state):
        self.sum = state


def test_states_of_controllers_are_saved():
    def made():
        return zd.Run(two_links(), step=0.01, inputs=["drive.torque"], control=zd.every(0.02, call=Integral()))

    run, other = made(), made()
    run.step(31)
    other.restore(run.save())
    for each in (run, other):
        each.step(30)
    assert same(run, other)


def test_controllers_without_a_state_are_named():
    def damp(run):
        run["drive.torque"] = -run["pin.speed"]

    run = zd.Run(two_links(), step=0.01, inputs=["drive.torque"],
                 control=[zd.every(0.02, call=Integral()), zd.every(0.03, call=damp)])
    with pytest.warns(zd.StateWarning, match=r"nothing of the control <every 0\.03 s: damp>: .* \[zd:controller-state\]") as told:
        run.save()
    assert [each.filename for each in told] == [__file__]


def test_a_copy_shares_its_controllers_and_names_none(recwarn):
    run = zd.Run(two_links(), step=0.01, inputs=["drive.torque"], control=zd.every(0.02, call=lambda run: None))
    run.copy().step()
    assert not recwarn.list


def test_reset_goes_back_to_the_start():
    run = zd.Run(two_links(), step=0.01, inputs=["drive.torque"], record=True)
    run["drive.torque"] = 3.0
    run.step(20)
    p = run.p
    run.reset()
    assert (run.t, run.steps, run["drive.torque"]) == (0.0, 0, 0.0)
    run["drive.torque"] = 3.0
    run.step(20)
    assert np.array_equal(run.p, p)
    assert len(run.solution().t) == 21
    with pytest.raises(zd.InconsistentStart):
        zd.Run(zd.systems.four_bar(), step=0.01).reset([1.0, 2.0, 3.0])


PROCESS = """
import sys
import zerodrift as zd
run = zd.Run(zd.systems.four_bar(), step=0.01, energy=True)
run.restore(open(sys.argv[1], "rb").read())
run.step(1000)
sys.stdout.write(run.p.tobytes().hex() + run.v.tobytes().hex())
m = zd.Mechanism("lever", gravity=(0, -9.81))
link = m.link("link", (0, 0), (1, 0), mass=1.0)
pin = m.revolute("pin", m.ground, link.start)
def spring(q):
    return -3.0 * q
m.torque("drive", link, value=spring, of={"q": pin.angle})
zd.Run(m, step=0.01).restore(open(sys.argv[2], "rb").read())
"""


def test_a_state_is_restored_in_another_process(tmp_path):
    run = zd.Run(zd.systems.four_bar(), step=0.01, energy=True)
    run.step(100)
    (tmp_path / "state").write_bytes(run.save())

    def pull(q):
        return -3.0 * q

    (tmp_path / "other").write_bytes(zd.Run(lever(pull), step=0.01).save())
    run.step(1000)
    said = subprocess.run([sys.executable, "-c", PROCESS, str(tmp_path / "state"), str(tmp_path / "other")], check=True,
                          capture_output=True, text=True, env=dict(os.environ)).stdout
    assert said == run.p.tobytes().hex() + run.v.tobytes().hex()


def test_wrong_states_are_refused_and_the_run_stays():
    bar = zd.systems.four_bar()
    run = zd.Run(bar, step=0.01)
    run.step(10)
    state, p = run.save(), run.p
    changed = bytearray(state)
    changed[len(state) // 2] ^= 1
    for wrong, reason in ((state[:-8], "whole and unchanged"), (state[:20], "the bytes that save"), (bytes(changed), "unchanged"),
                          (b"", "the bytes that save"), (b"zdrun000" + state[8:], "this version"), ("text", "not str")):
        with pytest.raises(zd.WrongState, match=reason):
            run.restore(wrong)
    for other, reason in ((zd.Run(bar, step=0.02), "same settings"), (zd.Run(zd.systems.pendulum(), step=0.01), "same system"),
                          (zd.Run(bar.with_parameters(gravity=1.0), step=0.01), "same parameters"),
                          (zd.Run(two_links(), step=0.01, inputs=["drive.torque"]), "same inputs")):
        with pytest.raises(zd.WrongState, match=reason):
            other.restore(state)
        other.step()
    assert np.array_equal(run.p, p)


def test_every_bit_of_a_state_is_checked():
    run = zd.Run(zd.systems.pendulum(), step=0.01)
    state = run.save()
    for bit in range(8 * len(state)):
        changed = bytearray(state)
        changed[bit // 8] ^= 1 << bit % 8
        with pytest.raises(zd.WrongState):
            run.restore(bytes(changed))


def lever(law, height=0.0):
    """A lever with a torque that is a law of its angle."""
    m = zd.Mechanism("lever", gravity=(0, -9.81))
    link = m.link("link", (0, height), (1, height), mass=1.0)
    pin = m.revolute("pin", m.ground, link.start)
    m.torque("drive", link, value=law, of={"q": pin.angle})
    return m.system()


def mass(spring):
    return zd.System(["x"], p0=[1.0], mass=[[1.0]], force=lambda p: -spring * p)


def symbolic_mass(power):
    sp = pytest.importorskip("sympy")
    x, v = sp.symbols("x v")
    return zd.symbolic([x], speeds=[v], kinetic=v**2 / 2, potential=x**power / power, p0=[1.0], name="mass")


def table(last):
    return zd.table([-9, 0, 9], [1, 2, last], argument="q")


@pytest.mark.parametrize(("made", "other"), [
    (lambda: lever(lambda q: 2 * q), lambda: lever(lambda q: 3 * q)), (lambda: lever(table(3)), lambda: lever(table(4))),
    (lambda: lever(lambda q: 2 * q), lambda: lever(lambda q: 2 * q, 2.0)), (lambda: lever(table(3)), lambda: lever(lambda q: q)),
    (lambda: mass(1.0), lambda: mass(9.0)), (lambda: symbolic_mass(2), lambda: symbolic_mass(4))],
    ids=["functions", "tables", "geometry", "a table and a function", "forces", "potentials"])
def test_states_of_systems_with_other_geometry_and_functions_are_refused(made, other):
    """Their names and parameters are the same."""
    run, alike = zd.Run(made(), step=0.01), zd.Run(made(), step=0.01)
    run.step(10)
    alike.restore(run.save())
    for each in (run, alike):
        each.step()
    assert same(run, alike)
    with refused("wrong-state", "same system"):
        zd.Run(other(), step=0.01).restore(run.save())


class Counting:
    """A function with a state of its own."""

    def __init__(self):
        self.calls = 0

    def __call__(self, q):
        self.calls += 1
        return -q


def test_what_functions_keep_between_calls_does_not_make_another_system():
    angles = []
    for law in (Counting(), lambda q: angles.append(q) or -q):
        run = zd.Run(lever(law), step=0.01)
        run.step(10)
        alike = zd.Run(lever(Counting() if isinstance(law, Counting) else law), step=0.01)
        alike.restore(run.save())
        assert same(run, alike)
    assert angles


def test_what_does_not_pickle_is_left_out():
    def made(stiffness):
        return zd.Run(lever(functools.partial(lambda numbers, q, k=stiffness: -k * q, (number for number in ()))), step=0.01)

    state = made(1.0).save()
    made(1.0).restore(state)
    with refused("wrong-state", "same system"):
        made(2.0).restore(state)


def test_a_state_of_one_of_many_runs_is_that_of_a_run_with_its_parameters():
    bar = zd.models.four_bar().system()
    name = next(each for each in bar.parameters if each.endswith(".mass"))
    many = zd.ManyRuns(bar, runs=2, parameters={name: [1.0, 2.0]}, step=0.01)
    many.step(5)
    run = zd.Run(bar.with_parameters({name: 2.0}), step=0.01)
    run.restore(many.save()[1])
    assert np.array_equal(run.p, many.p[1])
    with refused("wrong-state", "same parameters"):
        run.restore(many.save()[0])


def test_many_runs_are_restored_by_a_mask():
    many = zd.ManyRuns(two_links(), runs=3, step=0.01, inputs=["drive.torque"])
    many["drive.torque"] = [1.0, 2.0, 3.0]
    many.step(10)
    states = many.save()
    many.step(10)
    p = many.p
    many.restore(states[:2], where=np.array([True, True, False]))
    assert many.t.tolist() == pytest.approx([0.1, 0.1, 0.2])
    assert many["drive.torque"].tolist() == [1.0, 2.0, 3.0]
    many.step(10)
    assert np.array_equal(many.p[:2], p[:2])
    many.restore(states[0])
    assert np.ptp(many.p, axis=0).max() == 0.0
    with refused("shape", "states.*be 3"):
        many.restore(states[:2])
