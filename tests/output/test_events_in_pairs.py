"""Events whose function passes zero and returns within a step: all are found, none twice, and a touch is none."""

import numpy as np
import pytest

import zerodrift as zd
from lanes import LANES
from timed_events import GRAVITY, STEPS, check, draw, times_of
from zerodrift.runs.open.diagnosis import unwarned

OSCILLATOR = zd.systems.oscillator(x0=0.1, v0=0.05)
QUARTERS = {"rtol": 0.9, "atol": 1e3, "first_step": 0.25, "max_step": 0.25}     # steps of this size whatever their error
METHODS = {"dormand_prince": QUARTERS, "dop853": QUARTERS, "radau": QUARTERS, "taylor": QUARTERS,
           "rk4": {"step": 0.25}, "heun": {"step": 0.25}}


@pytest.mark.parametrize("way", ["single", "open", "ensemble"])
@pytest.mark.parametrize("steps", STEPS)
def test_known_instants(steps, way):
    """A fixed sample of the draws of `stress/events.py`."""
    for seed in range(1000, 1003):
        case = draw(seed, steps)
        if way != "ensemble" or hasattr(case.system, "v0"):
            assert not check(times_of(case, way), case), case.name


@pytest.mark.parametrize("method", METHODS)
def test_zeros_a_tenth_of_a_step_apart(method):
    """Functions that polynomials of the step's order do not follow: dense oscillations, and a dip out of a constant."""
    apart = 0.102 * 0.25

    def dip(t, centre):
        return 1 - 2 * np.exp(-np.log(2) * ((t - centre) / (apart / 2)) ** 2)

    centres = np.random.default_rng(3).uniform(0.05, 0.95, 8)
    events = [lambda t, p, v: np.sin(np.pi * (t - 0.001) / apart), *(lambda t, p, v, at=at: dip(t, at) for at in centres)]
    with unwarned():
        sol = zd.simulate(OSCILLATOR, 1.0, integrator=method, events=events, **METHODS[method])
    expected = 0.001 + apart * np.arange(40)
    assert len(sol.t) == 5
    assert np.abs(sol.t_events[0] - expected[expected < 1]).max() < 1e-12
    for at, times in zip(centres, sol.t_events[1:], strict=True):
        assert np.abs(times - [at - apart / 2, at + apart / 2]).max() < 1e-12


@pytest.mark.parametrize("method", METHODS)
def test_close_pairs_of_smooth_functions(method):
    """A thousandth of a step apart, rising first or falling first; and each of both by its direction, where it ends a run."""
    for sign in (1, -1):
        event = zd.Event(lambda t, p, v, sign=sign: sign * ((t - 0.33) ** 2 - 1.25e-4**2))
        with unwarned():
            found = zd.simulate(OSCILLATOR, 1.0, integrator=method, events=event, **METHODS[method]).t_events[0]
            for direction, terminal, expected in ((sign, 1, [0.330125]), (0, 2, [0.329875, 0.330125]), (-sign, 1, [0.329875])):
                ending = zd.Event(event.what, direction=direction, terminal=terminal)
                sol = zd.simulate(OSCILLATOR, 1.0, integrator=method, events=ending, **METHODS[method])
                assert np.abs(sol.t_events[0] - expected).max() < 1e-10
                assert sol.t[-1] == sol.t_events[0][-1]
        assert np.abs(found - [0.329875, 0.330125]).max() < 1e-10


@pytest.mark.parametrize("method", METHODS)
def test_a_touch_is_not_an_event(method):
    """The height of a thrown particle at its apex, off by rounding; and functions whose double zero is exact."""
    rng = np.random.default_rng(11)
    for speed in rng.uniform(0.6, 0.9, 6) * GRAVITY:
        apex = speed**2 / (2 * GRAVITY)
        ball = zd.System(["y"], mass=np.eye(1), force=np.array([-GRAVITY]), p0=[0.0], v0=[speed])
        with unwarned():
            if method != "taylor":
                sol = zd.simulate(ball, 1.0, integrator=method, events=zd.Event("y", value=apex), **METHODS[method])
                assert len(sol.t_events[0]) == 0
    touching = [lambda t, p, v: (t - 0.4) ** 2, lambda t, p, v: -((t - 0.6) ** 4)]
    with unwarned():
        sol = zd.simulate(OSCILLATOR, 1.0, integrator=method, events=touching, **METHODS[method])
    assert not any(map(len, sol.t_events))


@pytest.mark.parametrize("steps", [{"integrator": "dop853", "rtol": 1e-6, "atol": 1e-8}, {"step": 0.1, "integrator": "dop853"},
                                   {"integrator": "dormand_prince", "rtol": 1e-5, "atol": 1e-7}], ids=str)
@pytest.mark.parametrize("terminal", [0, 1, 2, 3])
def test_pairs_in_lanes(steps, terminal):
    """Near the turning points of oscillators of different amplitude, which single runs find at the same times."""
    system = zd.systems.oscillator(x0=0.0, v0=1.0)
    starts = np.linspace(1.001, 1.3, 9)[:, None]
    events = [zd.Event("x", value=1 / np.sqrt(10), terminal=terminal), zd.Event("x_dot", value=-0.9)]
    steps = steps | ({} if "step" in steps else {"t_eval": np.linspace(0, 4, 9)})
    ens = zd.ensemble(system, 4.0, v0=starts, events=events, threads=1, **steps)
    assert (ens._part.paths == LANES).all()
    w = np.sqrt(10.0)
    for run, (v0,) in enumerate(starts):
        first = np.arcsin(1 / v0) / w
        turns = 2 * np.pi / w * np.arange(4)
        expected = np.sort(np.concatenate([turns + first, turns + np.pi / w - first]))
        expected = expected[expected < 4][:terminal or None]
        assert np.abs(ens.t_events[run][0] - expected).max() < 1e-3
        sol = zd.simulate(system, 4.0, v0=[v0], events=events, **steps)
        for mine, its in zip(ens.t_events[run], sol.t_events, strict=True):
            assert np.abs(mine - its).max(initial=0) < 1e-9
        assert len(ens.t_events[run][1]) == len(sol.t_events[1])


def test_an_open_run_goes_on_between_both():
    """A terminal event of the first of a pair ends a step; the other is found in the next."""
    with zd.Run(OSCILLATOR, rtol=1e-6, atol=1e-8, record=True,
                events=zd.Event(lambda t, p, v: (t - 0.33) ** 2 - 0.01**2, terminal=True)) as run:
        times = []
        for _ in range(3):
            run.advance_to(1.0)
            times.append(run.t)
    assert np.abs(np.array(times) - [0.32, 0.34, 1.0]).max() < 1e-12


@pytest.mark.parametrize("height", [0.54776, 0.54779])
def test_corrections_larger_than_what_is_sought(height):
    """Along the nearly straight line of Hoecken's linkage, which coarse steps leave by more than its waves before corrections."""
    m = zd.models.hoecken()
    fine = zd.simulate(m, 2.0, step=1e-3, outputs=["P.position.y"])
    g = fine["P.position.y"] - height
    times = fine.t[:-1][g[:-1] * g[1:] < 0]
    coarse = {"integrator": "dormand_prince", "rtol": 1e-2, "atol": 1e-2}
    sol = zd.simulate(m.system("absolute"), 2.0, events=zd.Event("P.position.y", value=height), **coarse)
    assert sol.stats["steps"] < 20
    assert len(sol.t_events[0]) == len(times)
    assert np.abs(sol.t_events[0] - times).max() < 2e-3     # the grid's step, and the slope of a line that is nearly straight
