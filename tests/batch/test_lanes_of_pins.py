"""Many bodies joined by pins, side by side in vector lanes: runs that are those of `simulate` up to rounding."""

import numpy as np
import pytest

import zerodrift as zd
from lanes import ALONE, LANES, UNITS, made, plan_of, rows_of
from large_mechanisms import four_bars
from zerodrift import _gateway

pytestmark = pytest.mark.skipif(not _gateway.has_lanes("baseline"), reason="the compiler has no vectors")
LOOPS = 7           # of so many and more, nothing dense is made
STEP = 0.005
TIMES = np.linspace(0.013, 0.2, 5)
COURSES = {"rk4": {"step": STEP, "save_every": 8}, "within": {"step": 0.007, "t_eval": TIMES},
           "dop853": {"integrator": "dop853", "rtol": 1e-9, "t_eval": TIMES},
           "uncorrected": {"step": STEP, "stabilization": None}}


def hung(light=1.0):
    """A row of links with a small weight on each pin, of which some are much lighter, and a particle that hangs at its end."""
    m = zd.Mechanism("links and weights", gravity=(0.5, -9.81))
    last = m.ground.point((0.3, -0.2))
    for i in range(22):
        tip = last.drawn + np.array([0.6, 0.8 * (-1) ** i])
        link = m.link(f"link{i}", last.drawn, tip, mass=light if i % 5 == 2 else 1.0)
        m.revolute(f"pin{i}", last, link.start)
        last = link.end
    m.revolute("end", last, m.particle("bob", 0.7, at=last.drawn))
    m.start({"link0.angular_velocity": 1.0})
    return m


def swinging(mechanism, shares):
    """Its system, and starts whose speeds differ."""
    system = mechanism.system("absolute")
    return system, np.tile(system.p0, (len(shares), 1)), np.multiply.outer(shares, system.v0)


def together(mechanism, span, shares, names=None, **options):
    system, p0, v0 = swinging(mechanism, shares)
    names = names or [variable.name for variable in system.coordinates if variable.unit == "m"][::7]
    return system, p0, v0, plan_of(system, span, p0=p0, v0=v0, names=names, **options)


MECHANISMS = {"four-bars": lambda: four_bars(LOOPS), "weights": hung, "light links": lambda: hung(1e-4)}


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("course", COURSES)
@pytest.mark.parametrize("mechanism", MECHANISMS)
def test_runs_are_those_of_simulate_but_for_rounding(mechanism, course, unit):
    options = COURSES[course] | {"vector": unit}
    shares = np.linspace(0.5, 1.5, 9)
    first = MECHANISMS[mechanism]()
    rows = [variable.name for variable in first.system("absolute").constraints][:4]
    system, p0, v0, plan = together(first, 0.2, shares, ["rod3.x" if mechanism == "four-bars" else "link6.x", *rows], **options)
    part = made(plan)
    assert (part.paths == LANES).all()
    for run in (0, 8):
        sol = zd.simulate(system, 0.2, p0[run], v0[run], **options)
        assert np.array_equal(list(part.times())[run], sol.t)
        for name in plan.names:     # as of other lanes; a link of 1e-4 kg is shaken by rounding of what pulls at both of its ends
            allowed = (1e-10 if mechanism != "light links" else 1e-7) * max(1.0, np.abs(sol[name]).max())
            assert np.abs(rows_of(part, name)[run] - sol[name]).max() < allowed, name


@pytest.mark.parametrize("mechanism", ["four-bars", "weights"])
def test_a_step_is_that_of_simulate_within_eight_roundings(mechanism):
    names = ["rod3.x", "rod3.y"] if mechanism == "four-bars" else ["link6.x", "bob.y"]
    system, p0, v0, plan = together(MECHANISMS[mechanism](), STEP, np.linspace(0.5, 1.5, 9), names, step=STEP)
    part = made(plan)
    for run in range(9):
        sol = zd.simulate(system, STEP, p0[run], v0[run], step=STEP)
        for name in names:
            size = max(1.0, np.abs(sol[name]).max())
            assert np.abs(rows_of(part, name)[run] - sol[name]).max() <= 8 * 2**-53 * size


@pytest.mark.parametrize("course", ["rk4", "dop853"])
def test_bits_do_not_depend_on_neighbours(course):
    """Among them one that violates its constraints, and one whose steps are too long."""
    system, p0, v0 = swinging(four_bars(LOOPS), np.array([1.0, 0.5, 2.0, 300.0, 1.5, 0.0, 0.7, 0.9, 1.1, 1.2, 1.3]))
    p0[2, 0] += 0.1
    options = COURSES[course] | ({} if course == "rk4" else {"max_steps": 60})
    plan, turned = (plan_of(system, 0.2, p0=p, v0=v, names=["rod3.x"], **options)
                    for p, v in ((p0, v0), (p0[::-1], v0[::-1])))
    whole, back = made(plan), made(turned)
    assert whole.failed[2]
    assert whole.messages[2].startswith("InconsistentStart: ")
    assert (whole.paths == LANES).sum() == 9
    for run in range(len(p0)):
        alone = made(plan, run, run + 1)
        assert np.array_equal(rows_of(whole, "rod3.x")[run], alone.arrays["rod3.x"])
        assert np.array_equal(rows_of(back, "rod3.x")[::-1][run], alone.arrays["rod3.x"])
        assert (whole.failed[run], whole.paths[run], whole.messages[run]) == (alone.failed[0], alone.paths[0], alone.messages[0])


@pytest.mark.filterwarnings("ignore::zerodrift.AccuracyWarning")
def test_a_run_whose_pivots_are_lost_is_made_by_itself():
    """Upright to flat, where the row of parallelograms could part, and one step ends right there."""
    system, p0, v0 = swinging(four_bars(LOOPS), np.array([1.0, 0.2, 1.3]))
    event = zd.Event("rod0.angle", terminal=True)
    flat = zd.simulate(system, 3.0, p0[0], v0[0], integrator="dop853", rtol=1e-12, events=event).t[-1]
    step = flat / 250
    plan = plan_of(system, 260 * step, p0=p0, v0=v0, names=["rod3.x"], step=step, save_every=65)
    part = made(plan)
    assert part.paths.tolist() == [ALONE, LANES, LANES]
    for run, allowed in enumerate((0.0, 1e-10, 1e-6)):      # the last has come near it, too, and its pivots are small
        sol = zd.simulate(system, 260 * step, p0[run], v0[run], step=step, save_every=65)
        assert np.abs(rows_of(part, "rod3.x")[run] - sol["rod3.x"]).max() <= allowed


def test_a_start_of_dependent_rows_is_made_by_itself():
    system, p0, v0 = swinging(four_bars(LOOPS), np.array([1.0, 1.0]))
    flat = zd.assemble(system, {"rod0.angle": 1e-6, "rod0.angular_velocity": -1.0})
    p0[1], v0[1] = flat
    part = made(plan_of(system, 2 * STEP, p0=p0, v0=v0, names=["rod3.x"], step=STEP))
    assert part.paths.tolist() == [LANES, ALONE]


@pytest.mark.parametrize("how", ["spring", "few", "massless", "identity", "gear"])
def test_what_lanes_do_not_know_is_made_by_itself(how):
    m, options = four_bars(2 if how == "few" else LOOPS), {}
    if how == "spring":
        m.spring("spring", m.ground.point((0, 2)), m["rod0"].end, stiffness=10.0, length=1.0)
    if how == "gear":
        m.revolute("F", m.ground.point((9, 0)), m.body("wheel", 1.0, 1.0, at=(9, 0)).point((0, 0)))
        m.gear("gear", "A0", "F", ratio=2.0)
    if how == "identity":
        options = {"stabilization": zd.Projection(metric="identity")}
    if how == "massless":
        options = {"formulation": "augmented"}
        m.link("pointer", (0, 1), (0, 2), mass=1.0, inertia=0.0)
        m.revolute("D", m["rod0"].end, m["pointer"].start)
        m.revolute("E", m.particle("tip", 1.0, at=(0, 2)), m["pointer"].end)
    system, p0, v0, plan = together(m, 0.05, np.array([1.0, 1.1]), ["rod0.x"], step=STEP, **options)
    part = made(plan)
    assert (part.paths == ALONE).all()
    sol = zd.simulate(system, 0.05, p0[1], v0[1], step=STEP, **options)
    assert np.array_equal(rows_of(part, "rod0.x")[1], sol["rod0.x"])


def test_a_run_is_made_again_with_its_bits():
    system, p0, v0 = swinging(four_bars(LOOPS), np.linspace(0.5, 1.5, 5))
    ens = zd.ensemble(system, 0.1, p0=p0, v0=v0, step=STEP, outputs=["rod0.x"])
    again = ens[3]
    assert "vector lanes" in repr(ens)
    assert np.array_equal(again["rod0.x"], ens["rod0.x"][3])
    assert np.abs(again.multipliers - zd.simulate(system, 0.1, p0[3], v0[3], step=STEP).multipliers).max() < 1e-9
