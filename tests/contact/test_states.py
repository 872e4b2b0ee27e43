"""Copies and saved states of runs with contacts; bits of random scenes are compared in runs/test_saved_states.py."""

import numpy as np
import pytest

import zerodrift as zd

G = 9.81


def hoist():
    """A slider with dry friction, driven by a force, that hits its stop, is caught by a latch and let go again."""
    m = zd.Mechanism("hoist", gravity=(0, -G))
    block = m.body("block", 2.0, 0.1)
    slide = m.prismatic("slide", m.ground, block, at=(0, 0), axis=(1, 0), friction=(0.3, 0.2), guide=0.4)
    m.stop("buffer", slide.displacement, lower=-0.2, upper=0.3, restitution=0.5)
    m.weld("lock", m.ground, block, at=(0, 0), active=False)
    m.latch("pawl", "lock", when="slide.displacement - 0.1")
    m.motor("push", slide, force=0.0)
    grain = m.particle("grain", 0.1, at=(0, 0.6))
    m.contact("deck", grain, block.line((-1, 0.1), (1, 0.1)), restitution=0.4, friction=0.3)
    return m


FORCES = [15.0, -20.0, 30.0, 0.0, -12.0, 18.0]


def drive(run, forces, into):
    for force in forces:
        run["push.force"] = force
        run.advance_to(run.t + 0.25)
        if run.t < 1.0:
            run.release("lock")
        into.append((run.t, run.p.tobytes(), run.v.tobytes(), run["lock.force"].tobytes()))


@pytest.mark.parametrize("settings", [{"step": 1e-3}, {"rtol": 1e-8, "atol": 1e-10}], ids=str)
def test_a_copy_goes_on_through_latches_inputs_and_events(settings):
    expected, found = [], []
    run = zd.Run(hoist(), inputs=["push.force"], events=zd.Event("grain.velocity.y"), record=True, **settings)
    drive(run, FORCES[:2], [])
    state, twin = run.save(), run.copy()
    before = len(run.solution().phases)
    drive(run, FORCES[2:], expected)
    drive(twin, FORCES[2:], found)
    assert found == expected
    whole = run.solution()
    run.restore(state)
    found.clear()
    drive(run, FORCES[2:], found)
    assert found == expected
    phases = run.solution().phases      # the record began anew with the state
    assert [str(phase) for phase in phases[1:]] == [str(phase) for phase in whole.phases[before:]]
    assert phases[0].t0 == 0.5
    assert phases[0].state == whole.phases[before - 1].state
    assert (run.solution().impacts == whole.impacts[whole.impacts["t"] > 0.5]).all()


def test_many_runs_are_restored_in_their_phases():
    runs = zd.ManyRuns(hoist(), runs=2, step=1e-3, inputs=["push.force"])
    runs["push.force"] = [15.0, -15.0]
    runs.step(400)
    states = runs.save()
    runs.step(300)
    p = runs.p
    runs.restore(states)
    runs.step(300)
    assert np.array_equal(runs.p, p)
