"""Mechanisms whose numbers vary: the core makes each, assembles it and reads its measures, as `simulate` would have it."""

import numpy as np
import pytest

import zerodrift as zd
from lanes import made, plan_of
from zerodrift.ensembles import run_range

FACTORS = np.array([1.0, 1.001, 0.996, 1.02])
SPAN, STEP = 0.05, 0.005


@pytest.fixture
def in_python(monkeypatch):
    """Which runs were made by Python, one by one."""
    runs, one = [], run_range._one

    def noted(plan, run, is_cancelled):
        runs.append(run)
        return one(plan, run, is_cancelled)
    monkeypatch.setattr(run_range, "_one", noted)
    return runs


def machine(*, cut=0.0):
    """A four-bar that is drawn a little open, with a slider, a spring, a gear, a bushing and weights."""
    m = zd.Mechanism("machine", gravity=(0.3, -9.81))
    crank = m.link("crank", (0, 0), (0.1, 0.3), mass=1.0)
    coupler = m.link("coupler", (0.1, 0.3), (1.0, 0.8 + cut), mass=2.0)
    rocker = m.link("rocker", (1.2, 0), (1.0, 0.8), mass=1.5)
    tip = m.point("tip", coupler, (0.5, 0.2))
    m.revolute("A", m.ground, crank.start, damping=0.1)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.point((1.2, 0)), rocker.start)
    block = m.body("block", 0.5, 0.1, at=(1.5, 0.8))
    m.prismatic("guide", m.ground.point((1.4, 0.8)), block.point((0, 0)), axis=(1, 0.2))
    m.rod("rod", rocker.end, block.point((0, 0)))
    m.spring("spring", m.ground.point((0.5, 1.5)), tip, stiffness=40.0, damping=0.5)
    m.particle("weight", 0.2, at=tip)
    wheel = m.body("wheel", 0.4, 0.01, at=(-1, 0))
    m.revolute("E", m.ground.point((-1, 0)), wheel.point((0, 0)))
    m.gear("gear", "A", "E", ratio=2.0)
    m.torque("torque", wheel, value=0.3)
    m.start({"crank.angular_velocity": 2.0})
    return m


PATHS = ["gravity.y", "crank.mass", "crank.length", "coupler.length", "rocker.inertia", "tip.local.x", "rod.length", "A.damping",
         "spring.stiffness", "spring.length", "weight.mass", "gear.ratio", "torque.value", "block.com.y"]
OUTPUTS = ["crank.angle", "tip.position", "tip.velocity.x", "guide.displacement", "B.force", "C.transmission_angle",
           "spring.length"]


def compare(system, parameters, outputs, ens, runs, allowed=1e-11):
    """An ensemble with what `simulate` makes of systems with these parameters."""
    for run in runs:
        sol = zd.simulate(system.with_parameters({name: float(each[run]) for name, each in parameters.items()}), SPAN, step=STEP)
        for name in outputs:
            assert np.abs(ens[name][run] - sol[name]).max() <= allowed * max(1.0, np.abs(sol[name]).max()), name
        again = ens[run]
        assert all(np.array_equal(again[name], ens[name][run]) for name in outputs)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("path", PATHS)
def test_runs_are_those_of_simulate_up_to_rounding(path, layout, in_python):
    system = machine().system(layout)
    parameters = {path: system.parameters[path] * FACTORS + (0.01 * FACTORS if system.parameters[path] == 0 else 0)}
    outputs = [*OUTPUTS, system.coordinates[-1].name, system.velocities[0].name, system.constraints[0].name]
    ens = zd.ensemble(system, SPAN, parameters=parameters, outputs=outputs, step=STEP)
    assert not in_python
    assert not ens.failed.any()
    compare(system, parameters, outputs, ens, (1, 3))


HELD = [{"crank.angle": 1.4, "A.speed": 1.0}, {"guide.displacement": 0.05}, {"tip.position.x": 0.5, "wheel.velocity": (0, 0)}, {}]


@pytest.mark.parametrize("held", HELD)
@pytest.mark.parametrize("cut", [0.0, 0.02])
def test_starts_are_those_of_the_mechanism(held, cut, in_python):
    """Held or as drawn, and drawn open."""
    m = machine(cut=cut)
    m.start({"crank.angular_velocity": None})
    m.start(held)
    path = "rod.length"
    system = m.system()
    parameters = {path: system.parameters[path] * FACTORS}
    outputs = ["tip.position", "tip.velocity", system.coordinates[0].name]
    ens = zd.ensemble(system, SPAN, parameters=parameters, outputs=outputs, step=STEP)
    assert not in_python
    compare(system, parameters, outputs, ens, range(4), allowed=1e-9)   # how near to the drawing is found to some digits alone


def test_bits_do_not_depend_on_neighbours_nor_on_the_range(in_python):
    """Among them numbers that are refused, one that cannot be closed, and one without a damper."""
    system = machine().system()
    factors = np.array([1.0, 1.01, -1.0, 0.99, 30.0, 1.02, np.nan])
    plan = plan_of(system, SPAN, {"coupler.length": system.parameters["coupler.length"] * factors,
                                  "A.damping": np.array([0.1, 0.0, 0.1, 0.2, 0.1, 0.0, 0.1])}, names=OUTPUTS, step=STEP)
    whole = made(plan)
    assert sorted(set(in_python)) == [1, 2, 4, 5, 6]      # without a damper there is an element less
    assert whole.failed.tolist() == [False, False, True, False, True, False, True]
    assert "must be greater than 0" in whole.messages[2]
    assert "cannot close" in whole.messages[4]
    first = 0
    for run, rows in enumerate(whole.rows):
        alone = made(plan, run, run + 1)
        assert (alone.messages, alone.failed[0]) == ([whole.messages[run]], whole.failed[run])
        for name in OUTPUTS if rows else ():
            assert np.array_equal(alone.arrays[name], whole.arrays[name][first:first + rows])
        first += rows


def test_redundant_joints_are_assembled_by_the_core(in_python):
    m = machine()
    other = m.link("double", (0.1, 0.3), (1.0, 0.8), mass=0.1)
    m.revolute("F", m["crank"].end, other.start)
    m.revolute("G", m["rocker"].end, other.end)
    m.weld("H", m["coupler"].start, other.start)
    system = m.system()
    parameters = {"crank.mass": system.parameters["crank.mass"] * FACTORS}
    ens = zd.ensemble(system, SPAN, parameters=parameters, outputs=["tip.position"], step=STEP, threads=1)
    assert not in_python
    assert not ens.failed.any()
    compare(system, parameters, ["tip.position"], ens, range(4), allowed=1e-9)


@pytest.mark.parametrize("what", ["law", "wish", "late", "massless", "event"])
def test_what_needs_python_is_made_there(what, in_python):
    m, path, options = machine(), "crank.mass", {}
    if what == "law":
        m.force("push", "tip", along=(1, 0), value=lambda t: np.sin(t))
    if what == "wish":
        m.start({"crank.angular_velocity": None}, wish={"rocker.angular_velocity": 1.0})
    if what == "late":
        driven(m)
    if what == "massless":
        m.link("pointer", (0.1, 0.3), (0.1, 0.5), mass=0.0)
        m.weld("F", m["crank"].end, m["pointer"].start)
    system = m.system("absolute" if what == "massless" else "joint")
    parameters = {path: system.parameters[path] * FACTORS}
    if what == "event":
        options = {"events": zd.Event("crank.angle")}
    if what == "massless":      # which the leading matrix of other formulations does not stand
        options = {"formulation": "augmented"}
    span = (0.1, 0.1 + SPAN) if what == "late" else SPAN
    ens = zd.ensemble(system, span, parameters=parameters, outputs=["tip.position"], step=STEP, threads=1, **options)
    assert in_python == [0, 1, 2, 3]
    assert not ens.failed.any()


def driven(m):
    m.start({"crank.angular_velocity": None})
    m.motor("motor", "A", speed=2.0)


@pytest.mark.parametrize("path", ["motor.speed", "coupler.length", "crank.mass"])
@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("held", [{}, {"crank.angle": 1.4}])
def test_drives_of_constant_speed_begin_where_the_start_has_them(held, layout, path, in_python):
    """Which is another place for each, and another by some digits than Python finds: runs made again have the core's."""
    m = machine()
    driven(m)
    m.start(held)
    system = m.system(layout)
    parameters = {path: system.parameters[path] * FACTORS}
    outputs = ["tip.position", "crank.angle", "A.force", "motor.torque"]
    ens = zd.ensemble(system, SPAN, parameters=parameters, outputs=outputs, step=STEP)
    assert not in_python
    assert not ens.failed.any()
    assert "4 by the core alone" in repr(ens)
    compare(system, parameters, outputs, ens, (1, 3), allowed=1e-7)
    angles = ens["crank.angle"]
    speed = parameters["motor.speed"][:, None] if path == "motor.speed" else 2.0
    assert np.abs(angles - angles[:, :1] - speed * ens.t).max() < 1e-12


def test_what_has_no_mass_of_its_own_is_made_by_the_core(in_python):
    m = machine()
    m.link("pointer", (0.1, 0.3), (0.1, 0.5), mass=0.0)
    m.weld("F", m["crank"].end, m["pointer"].start)
    system = m.system("joint")
    parameters = {"crank.mass": system.parameters["crank.mass"] * FACTORS}
    ens = zd.ensemble(system, SPAN, parameters=parameters, outputs=["tip.position"], step=STEP)
    assert not in_python
    compare(system, parameters, ["tip.position"], ens, (1, 3))


def test_what_moves_without_mass_is_left_to_python(in_python):
    m = machine()
    m.link("pointer", (0.1, 0.3), (0.1, 0.5), mass=0.0)
    m.revolute("F", m["crank"].end, m["pointer"].start)
    system = m.system("joint")
    ens = zd.ensemble(system, SPAN, parameters={"crank.mass": FACTORS}, outputs=["tip.position"], step=STEP, threads=1)
    assert in_python == [0, 1, 2, 3]
    assert ens.failed.all()
    assert "SingularSystem" in ens.messages[0]
    assert "4 by Python" in repr(ens)


def test_starts_that_are_given_stay(in_python):
    system = machine().system("joint")
    states = {"p0": np.tile(system.p0, (4, 1)), "v0": FACTORS[:, None] * system.v0}
    parameters = {"crank.mass": FACTORS}
    ens = zd.ensemble(system, SPAN, parameters=parameters, outputs=["tip.position"], step=STEP, **states)
    assert not in_python
    sol = zd.simulate(system.with_parameters({"crank.mass": 1.02}), SPAN, states["p0"][3], states["v0"][3], step=STEP)
    assert np.abs(ens["tip.position"][3] - sol["tip.position"]).max() < 1e-12


def test_measures_are_recorded_by_the_core_where_starts_vary(in_python):
    system = machine().system("joint")
    states = {"p0": np.tile(system.p0, (4, 1)), "v0": FACTORS[:, None] * system.v0}
    ens = zd.ensemble(system, SPAN, outputs=["tip.position", "B.force"], step=STEP, **states)
    assert not in_python
    sol = zd.simulate(system, SPAN, states["p0"][3], states["v0"][3], step=STEP)
    assert np.array_equal(ens["tip.position"][3], sol["tip.position"])
    assert np.abs(ens["B.force"][3] - sol["B.force"]).max() < 1e-10


def test_masses_that_cross_are_made_by_the_core(in_python):
    """The heaviest of bodies that are not joined to the ground is the root of the tree, so that the trees of the runs differ."""
    m = zd.Mechanism("two", gravity=(0, -9.81))
    a, b = m.link("a", (0, 0), (1, 0), mass=1.0), m.link("b", (1, 0), (2, 1), mass=1.0)
    m.revolute("pin", a.end, b.start)
    m.start({"a.angular_velocity": 1.0})
    system = m.system("joint")
    parameters = {"a.mass": np.array([0.5, 2.0, 0.7, 3.0])}
    ens = zd.ensemble(system, SPAN, parameters=parameters, outputs=["b.end.position"], step=STEP)
    for run in range(4):
        sol = zd.simulate(system.with_parameters({"a.mass": parameters["a.mass"][run]}), SPAN, step=STEP)
        assert np.abs(ens["b.end.position"][run] - sol["b.end.position"]).max() < 1e-12
