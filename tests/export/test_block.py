"""`zd.block`: what the core makes of a block is what it makes of Python's tables, to the bit."""

import math
import struct
from types import SimpleNamespace

import numpy as np
import pytest
import sympy as sp
from scipy.special import ellipk

import zerodrift as zd
from every_model import IN_SPACE, MECHANISMS
from mechanisms.every_element import coupled_bodies
from support import called, refused
from zerodrift._private import gateway
from zerodrift._private.gateway.mechanisms.blocks import SECTIONS, VERSION, BlockCore

STEPS, STEP = 40, 1e-3
t = sp.Symbol("t")
LARGE_MODELS = {"chain"}  # thousands of bodies


def run(core, duration, **inputs):
    """Samples of a run of a block, whose inputs are set before its first step."""
    options = core.settings
    options.t1 = options.t0 + duration
    given = SimpleNamespace(c=options.inputs) if options.inputs else None
    record, made = gateway.Record(core, 4000), gateway.Run(core, options, *core.start, inputs=given)
    for name, value in inputs.items():
        core.set_input(f"drive.{name}", value)
    for status in iter(lambda: made.advance(record, 1e3), 0):
        assert status == 1      # it pauses where a contact opens or closes
    return record.take()


def assert_bits(system, duration=STEPS * STEP, **settings):
    core = BlockCore(zd.block(system, step=STEP, outputs=[], **settings))
    samples, sol = run(core, duration), zd.simulate(system, duration, step=STEP, vector="baseline", closed_form=False, **settings)
    for name in ("t", "p", "v", "multipliers", "position_violation", "velocity_violation", "potential_energy"):
        np.testing.assert_array_equal(samples[name.removesuffix("_energy")], getattr(sol, name), err_msg=name)
    return core


@pytest.mark.parametrize("name", sorted({*MECHANISMS, *IN_SPACE} - LARGE_MODELS))
def test_runs_of_blocks_have_the_bits_of_simulate(name):
    system = getattr(zd.models, name)().system()
    core = assert_bits(system)
    assert core.constraint_names == [variable.name for variable in system.constraints]
    assert (core.nq, core.nv, core.mh, core.mn) == (system.nq, system.nv, system.mh, system.mn)


@pytest.mark.parametrize(("when", "until", "speed"), [("axle.angle - 0.02", "2 * axle.angle - 0.1", 1.0),
                                                      ("-0.02 - axle.angle", None, -1.0)])
def test_latches_of_text_are_carried(when, until, speed):
    """Linear functions of one measure, rising or falling."""
    m = zd.Mechanism("wheel")
    wheel = m.body("wheel", 1.0, 0.1)
    m.revolute("axle", m.ground, wheel, at=(0, 0))
    m.latch("catch", m.weld("pawl", m.ground, wheel, at=(0, 0), active=False), when=when, until=until)
    m.start({"axle.speed": speed})
    system = m.system()
    assert_bits(system)
    assert zd.simulate(system, STEPS * STEP, step=STEP).impacts["t"] == pytest.approx([0.02], rel=1e-12)


@pytest.mark.parametrize("name", ["four_bar", "andrews", "double_wishbone", "coin"])
def test_also_in_absolute_coordinates(name):
    system = getattr(zd.models, name)().system("absolute")
    core = assert_bits(system)
    assert core.constraint_names == [variable.name for variable in system.constraints]


@pytest.mark.parametrize("settings", [
    {"formulation": "augmented", "stabilization": zd.Baumgarte(alpha=3.0, beta=4.0)}, {"integrator": "heun", "energy": True},
    {"formulation": "nullspace", "stabilization": None, "integrator": "rattle"}])
def test_methods_and_their_parameters_are_kept(settings):
    assert_bits(zd.models.four_bar().system(), **settings)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_elements_between_bodies_in_space_have_their_bits(layout):
    assert_bits(coupled_bodies().system(layout))


def linkage(**drive):
    m = zd.Mechanism("drive")
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, link.start)
    m.motor("drive", pin, **drive)
    return m


TIMES = np.linspace(0, 1, 11)
LAWS = {
    "table of angles": {"angle": zd.table(TIMES, 0.2 * TIMES**3)}, "table of speeds": {"speed": zd.table(TIMES, TIMES**2)},
    "table of torques": {"torque": zd.table(TIMES, np.sin(TIMES))},
    "period": {"angle": zd.table(TIMES / 40, np.sin(2 * np.pi * TIMES), beyond="period")},
    "line": {"speed": zd.table(TIMES / 40, TIMES**2, kind="linear", beyond="line")},
    "hold": {"torque": zd.table(TIMES / 40, TIMES**2, kind="steps", beyond="hold")},
    "grid": {"torque": zd.table((TIMES, TIMES / 40), np.outer(TIMES, TIMES) + 1, argument=("q", "t"), beyond="line"),
             "of": {"q": "pin.angle"}},
    "angle": {"angle": sp.sin(3 * t) * sp.exp(-t / 2) + 0.3 * t},
    "speed": {"speed": sp.tanh(4 * t)}, "speed of a measure": {"speed": sp.cos(sp.Symbol("pin.angle"))},
    "cases": {"torque": sp.Piecewise((2.5, t < 0.02), (sp.log(1 + t), True))},
    "functions": {"torque": sp.sqrt(1 + t) * sp.atan2(t, 2) - sp.Abs(t - 0.02) + sp.erf(t) * sp.floor(100 * t) / sp.cosh(t)},
    "powers": {"torque": (1 + t)**sp.Rational(5, 3) + sp.Max(t, 0.01) * sp.sign(t - 0.02)}}


@pytest.mark.parametrize("name", LAWS)
def test_user_functions_have_the_bits_of_compiled_ones(name):
    assert_bits(linkage(**LAWS[name]).system())


def test_a_parameter_of_the_mechanism_is_a_number_of_its_programs():
    m = zd.Mechanism("swing", parameters={"amplitude": 2.0})
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    m.motor("drive", m.revolute("pin", m.ground, link.start), torque=sp.Symbol("amplitude") * sp.sin(t))
    assert_bits(m.system())


def test_callables_and_unknown_functions_are_refused_by_name():
    with refused("not-portable", "'drive'"):
        zd.block(linkage(torque=called(lambda t: t)))
    with refused("wrong-name"):
        zd.block(linkage(torque=1.0).system("absolute"), outputs=["pin.y"])
    with refused("wrong-name", "inputs"):
        zd.block(linkage(torque=t), inputs=["drive.torque"])
    with refused("wrong-type", "a mechanism or its system"):
        zd.block(zd.systems.four_bar())


def test_a_table_left_ends_the_run_with_a_sentence():
    core = BlockCore(zd.block(linkage(torque=zd.table([0, 0.01], [1, 2])), step=STEP, outputs=[]))
    options = core.settings
    options.t1 = 0.1
    made, record = gateway.Run(core, options, *core.start), gateway.Record(core, 200)
    assert made.advance(record, 1e3) == gateway.CALLBACK
    assert "a table, for example, within its ends" in made.message


def test_inputs_are_set_by_name():
    core = BlockCore(zd.block(linkage(torque=0.0), step=STEP, outputs=[], inputs=["drive.torque"]))
    assert core.inputs == {"drive.torque": 0.0}
    opened = zd.Run(linkage(torque=0.0), step=STEP, inputs=["drive.torque"], vector="baseline")
    opened["drive.torque"] = 3.5
    opened.step(STEPS)
    np.testing.assert_array_equal(run(core, STEPS * STEP, torque=3.5)["p"][-1], opened.p)
    with refused("not-finite"):
        core.set_input("drive.torque", math.nan)


def test_speeds_follow_their_inputs_as_in_open_runs():
    core = BlockCore(zd.block(linkage(speed=1.0), step=STEP, outputs=[], inputs=["drive.speed"]))
    opened = zd.Run(linkage(speed=1.0), step=STEP, inputs=["drive.speed"], vector="baseline")
    opened["drive.speed"] = 2.0
    opened.step(STEPS)
    p = run(core, STEPS * STEP, speed=2.0)["p"][-1]
    np.testing.assert_array_equal(p, opened.p)
    assert p[0] == pytest.approx(2.0 * STEPS * STEP - 0.5 * STEP, rel=1e-9)      # the speed rises within the first step


def test_recorded_outputs_are_those_of_simulate():
    names = ["crank.angle", "coupler.position", "C.force"]
    system = zd.models.four_bar().system()
    core = BlockCore(zd.block(system, step=STEP, outputs=names))
    measures = [core.c.measures.measure[core.settings.outputs.measure[i]] for i in range(len(names))]
    assert [each.size for each in measures] == [1, 2, 2]
    sol = zd.simulate(system, 10 * STEP, step=STEP, vector="baseline", closed_form=False, outputs=names)
    options = core.settings
    options.t1 = 10 * STEP
    record = gateway.Record(core, 20, type("Width", (), {"width": 5}))
    assert gateway.Run(core, options, *core.start).advance(record, 1e3) == 0
    np.testing.assert_array_equal(record.take()["outputs"], np.column_stack([sol[name] for name in names]))


# ---- a block that no code of the package has written ----

def pendulum_by_hand(mass, length, inertia, start):
    """Block of a physical pendulum, as the description in block.h has it: one body that turns about the origin."""
    body, joint = [mass, inertia, 0, 0], [0, 0, 1, 0, 0, -length, 0, 1, 0, 0, 0, 0, 0]
    sections = {"gravity": [0, -9.81, 1], "bodies": body, "joints": joint, "start": [start - math.pi / 2, 0], "names": [0, 0]}
    counts = {"gravity": 3, "bodies": 1, "joints": 1, "start": 2, "names": 2, "texts": 1}
    numbers = [number for name in SECTIONS for number in sections.get(name, ())]
    words = 4 + len(SECTIONS) + len(numbers) + 1
    return (b"zdblock\0" + struct.pack(f"<{3 + len(SECTIONS)}d", VERSION, words, 2, *(counts.get(name, 0) for name in SECTIONS))
            + struct.pack(f"<{len(numbers)}d", *numbers) + b"bob" + bytes(5))


def test_a_block_by_hand_swings_with_the_period_of_the_elliptic_integral():
    mass, length, inertia, start = 2.0, 0.7, 0.1, 1.2
    core = BlockCore(pendulum_by_hand(mass, length, inertia, start))
    reduced = (inertia + mass * length**2) / (mass * length)
    period = 4 * math.sqrt(reduced / 9.81) * ellipk(math.sin(start / 2)**2)
    samples = run(core, period)
    assert samples["p"][-1, 0] == pytest.approx(start - math.pi / 2, abs=1e-7)      # rk4 at its default step of 0.01 s
    assert samples["v"][-1, 0] == pytest.approx(0, abs=1e-6)
