"""Events: against closed forms and SciPy, on the constraints, and with the same bits however the run is cut."""

import functools
import itertools

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipk

import tolerances as tol
import zerodrift as zd
from four_bar_in_python import four_bar as bar_in_python
from support import SYSTEMS, assert_close
from zerodrift.runs import simulate as simulation
from zerodrift.runs.open.diagnosis import unwarned

OSCILLATOR = zd.systems.oscillator(x0=0.1, v0=0.05)
DENSE = {"step": 1 / 100, "integrator": "dop853"}      # in a hundredth of a second it leaves nothing but round-off


def event(function, direction=0, terminal=False):
    """A function of its own each time, as attributes stay with it."""
    def call(t, p, v):
        return function(t, p, v)

    call.direction, call.terminal = direction, terminal
    return call


def position(t, p, v):
    return p[0]


def rate_of_first(t, p, v):
    return v[0]


def rate_of_coupler(t, p, v):
    return v[1]


def by_scipy(events, **options):
    """The oscillator, by SciPy at its finest."""
    wrapped = [event(lambda t, y, _, f=f: f(t, y[:1], y[1:]), f.direction, f.terminal) for f in events]
    plain = [lambda t, y, f=f: f(t, y, None) for f in wrapped]
    for mine, its in zip(wrapped, plain, strict=True):
        its.direction, its.terminal = mine.direction, mine.terminal
    return solve_ivp(lambda t, y: [y[1], -10 * y[0]], (0, 7), [0.1, 0.05], "DOP853", rtol=1e-13, atol=1e-15, max_step=0.01,
                     events=plain, **options)


@pytest.mark.parametrize("direction", [-1, 0, 1])
@pytest.mark.parametrize("terminal", [False, True, 1, 2, 3, np.int64(2), 0])
@pytest.mark.parametrize("steps", [DENSE, {"integrator": "dop853", "rtol": 1e-13, "atol": 1e-15}], ids=["fixed", "chosen"])
def test_against_scipy(direction, terminal, steps):
    events = [event(position, direction, terminal), event(rate_of_first, -direction), event(lambda t, p, v: t - 1.23)]
    expected, sol = by_scipy(events), zd.simulate(OSCILLATOR, 7.0, events=events, **steps)
    for i in range(3):
        assert_close(sol.t_events[i], expected.t_events[i], tol.STEPPED, scale=1)
        states = np.array(expected.y_events[i]).reshape(-1, 2)
        assert_close(np.hstack([sol.p_events[i], sol.v_events[i]]), states, tol.STEPPED, scale=1)
    assert (sol.status > 0) == (expected.status > 0) == bool(terminal)
    assert sol.success
    assert_close(sol.t[-1], expected.t[-1], tol.STEPPED)


def test_the_pendulum_in_closed_form():
    """It passes its lowest point every half period, 2 K(sin^2(amplitude / 2)) sqrt(L / g), to what the fourth order leaves."""
    amplitude, L, g = 2.0, 1.3, 9.81
    pendulum = zd.systems.pendulum(length=L, gravity=g, angle=amplitude)
    sol = zd.simulate(pendulum, 12.0, step=0.005, integrator="dop853", events=position)
    period = 4 * np.sqrt(L / g) * ellipk(np.sin(amplitude / 2) ** 2)
    expected = period * (1 / 4 + np.arange(len(sol.t_events[0])) / 2)
    assert len(expected) == int(12 / period * 2 + 0.5)
    assert_close(sol.t_events[0], expected, 1e-10)      # the projection's tolerance, 1e-12, in each of 2400 steps


POLYNOMIAL = {"dormand_prince": 4, "dop853": 7}      # and its order
TURN = 2.0      # of the four-bar's crank, passed after 0.27 s


@pytest.mark.parametrize("method", POLYNOMIAL)
@pytest.mark.parametrize("tolerance", [1e-6, 1e-9])
def test_the_pendulum_in_closed_form_by_adaptive_steps(method, tolerance):
    """Lowest points and turning points in turn, a quarter of a period apart: to some tens of the tolerance, as steps end."""
    amplitude, L, g = 2.0, 1.3, 9.81
    pendulum = zd.systems.pendulum(length=L, gravity=g, angle=amplitude)
    sol = zd.simulate(pendulum, 12.0, integrator=method, rtol=tolerance, atol=tolerance,
                      events=[position, event(lambda t, p, v: p[0] * v[1] - p[1] * v[0])])
    quarter = np.sqrt(L / g) * ellipk(np.sin(amplitude / 2) ** 2)
    for times, first in zip(sol.t_events, (1, 2), strict=True):
        expected = quarter * (first + 2 * np.arange(len(times)))
        assert 0 <= 12 - expected[-1] < 2 * quarter
        assert_close(times, expected, 50 * tolerance, scale=1)


@pytest.mark.parametrize("options", [{}, {"closed_form": False}, {"energy": True}, {"stabilization": zd.Projection(every=3)},
                                     {"stabilization": None}], ids=["closed_form", "general", "energy", "every 3", "none"])
@pytest.mark.parametrize("method", POLYNOMIAL)
@pytest.mark.parametrize("terminal", [False, 5])
def test_an_event_is_a_row(bar, method, options, terminal):
    """With the bits of `t_eval` and of sol(t) at its time, several in a step; what has ended the run is its last row."""
    events = [event(lambda t, p, v: np.sin(9 * p[0])), event(rate_of_coupler), event(rate_of_coupler, terminal=terminal)]
    options = options | {"events": events, "integrator": method, "rtol": 1e-5, "atol": 1e-6}
    with unwarned():
        sol = zd.simulate(bar, 4.0, **options)
        assert len(sol.t_events[0]) > len(sol.t) / 3
        for t, p, v in zip(sol.t_events, sol.p_events, sol.v_events, strict=True):
            rows = zd.simulate(bar, 4.0, t_eval=t, **options)
            assert rows.t[:len(t)].tolist() == t.tolist()
            for states in (sol(t), (rows.p[:len(t)], rows.v[:len(t)])):
                assert np.array_equal(states[0], p)
                assert np.array_equal(states[1], v)
    # The event that ends the run is the other one, too; at a step's end, which the rounding of t may put on either side of it.
    assert len(sol.t_events[2]) - len(sol.t_events[1]) in (0, 1)
    assert not terminal or (len(sol.t_events[2]) == 5 and sol.t[-1] == sol.t_events[2][-1])


@pytest.mark.parametrize("method", POLYNOMIAL)
def test_a_run_ends_with_a_step_and_not_with_a_value_between(bar, method):
    """The step is made once more by itself: to the same bits, where the polynomial of the longer step has others."""
    at, options = event(lambda t, p, v: p[0] - TURN), {"integrator": method, "closed_form": False, "rtol": 1e-4, "atol": 1e-4}
    noted = zd.simulate(bar, 1.0, events=at, **options)
    at.terminal = True
    ended = zd.simulate(bar, 1.0, events=at, **options)
    h = ended.t[-1] - ended.t[-2]
    again = zd.simulate(bar, (ended.t[-2], ended.t[-1]), ended.p[-2], ended.v[-2], integrator=method, closed_form=False, step=h)
    assert again.p[-1].tobytes() == ended.p[-1].tobytes()
    assert again.v[-1].tobytes() == ended.v[-1].tobytes()
    assert abs(ended.p[-1, 0] - TURN) <= 4 * tol.EPS * np.abs(ended.v[-1]).max()
    assert 1e-12 < abs(noted.t_events[0][0] - ended.t[-1]) < 1e-4


@pytest.mark.parametrize("terminal", [False, True])
@pytest.mark.parametrize(("method", "steps"), [("dormand_prince", (20, 160)), ("dop853", (8, 32))])
@pytest.mark.filterwarnings("ignore::zerodrift.AccuracyWarning")
def test_the_order_of_instants(bar, method, steps, terminal):
    """The error of the polynomial within a step is one power of h above its order."""
    def errors(where):
        found = [zd.simulate(bar, 1.0, integrator=method, rtol=0.9, atol=1e3, first_step=1 / n, max_step=1 / n,
                             events=event(lambda t, p, v: p[0] - where, terminal=terminal)).t_events[0][0] for n in steps]
        return np.abs(np.array(found) - zd.simulate(bar, 0.5, step=1 / 2000, integrator="dop853",
                                                    events=event(lambda t, p, v: p[0] - where)).t_events[0][0])

    coarse, fine = np.mean([errors(where) for where in np.linspace(TURN - 0.3, TURN + 0.3, 9)], axis=0)
    assert np.log2(coarse / fine) / np.log2(steps[1] / steps[0]) > POLYNOMIAL[method] + 1 - tol.HIGH_ORDER


@pytest.mark.parametrize("steps", [{"step": 0.05}, {"integrator": "dop853", "rtol": 1e-6}], ids=["fixed", "chosen"])
def test_the_instant_is_resolved_to_rounding(system, steps):
    """Wherever in a step: here the event is time itself."""
    times = np.random.default_rng(7).uniform(0.1, 0.9, 20)
    sol = zd.simulate(system, 1.0, events=[event(lambda t, p, v, at=at: t - at) for at in times], **steps)
    found = np.concatenate(sol.t_events)
    assert found.shape == times.shape
    assert (found - times >= 0).all()
    assert (found - times <= 4 * tol.EPS).all()


CHOSEN = [name for name, card in zd.integrators().items() if card.error_order and card.order > 2 and name != "taylor"]


@pytest.mark.parametrize("steps", [{"step": 0.03}, {"rtol": 1e-3, "atol": 1e-6}], ids=["fixed", "chosen"])
@pytest.mark.parametrize("method", ["rk4", *CHOSEN])
def test_a_fall_in_closed_form(method, steps):
    """Its height 1 - 5 t^2 is solved without error: others are passed when that says so, to some units of rounding."""
    if "rtol" in steps and method not in CHOSEN:
        pytest.skip("it cannot choose its steps")
    ball = zd.System(["y"], mass=np.eye(1), force=np.array([-10.0]), potential=lambda p: 10 * p[0], p0=[1.0])
    heights = np.linspace(0.9, -3.0, 14)
    exact = np.sqrt((1 - heights) / 5)
    sol = zd.simulate(ball, 1.0, integrator=method, events=[zd.Event("y", value=y) for y in heights], **steps)
    of_polynomial = 4 if "rtol" in steps and method in POLYNOMIAL else 1      # whose weights are larger than those of a step
    assert np.abs(np.concatenate(sol.t_events) - exact).max() <= of_polynomial * 16 * tol.EPS
    ended = zd.simulate(ball, 1.0, integrator=method, events=zd.Event("y", value=heights[3], terminal=True), **steps)
    assert abs(ended.t[-1] - exact[3]) <= 8 * tol.EPS
    assert abs(ended.p[-1, 0] - heights[3]) <= 4 * tol.EPS * (1 + abs(ended.v[-1, 0]))       # t is found to four units


def test_constraints_hold_at_events(system, formulation, integrator):
    """And the event does, as well as t resolves it; the motion itself is that without events."""
    middle = zd.simulate(system, 0.5, step=1 / 60, formulation=formulation, integrator=integrator)(0.26)[0][0]
    sol = zd.simulate(system, 0.5, step=1 / 60, formulation=formulation, integrator=integrator,
                      events=event(lambda t, p, v: p[0] - middle + 1e-3 * (t - 0.26)))
    assert len(sol.t_events[0]) >= 1
    for t, p, v in zip(sol.t_events[0], sol.p_events[0], sol.v_events[0], strict=True):
        e, scale = system.evaluate(p, v, t), 1 + np.abs(v).max()
        assert abs(p[0] - middle + 1e-3 * (t - 0.26)) <= 1e-12 * (scale + abs(middle))   # where positions are corrected to
        assert e.Phi is None or np.abs(e.Phi).max() <= 1e-12
        if system.m:
            assert np.abs(e.C @ v + (0 if e.Phi_t is None else e.Phi_t)).max() <= 1e-12 * scale
    plain = zd.simulate(system, 0.5, step=1 / 60, formulation=formulation, integrator=integrator)
    assert_close(sol.p, plain.p, tol.STEPPED)


@pytest.mark.parametrize("steps", [{"step": 0.01}, {"rtol": 1e-8, "atol": 1e-10, "integrator": "dormand_prince"}], ids=str)
@pytest.mark.parametrize("saved", [{}, {"save_every": 7}, {"t_eval": np.linspace(0, 1.5, 11)}], ids=["all", "some", "times"])
def test_every_step_is_watched(bar, steps, saved):
    """Whatever of them is saved; a terminal event's instant is the last row."""
    if "save_every" in saved and "rtol" in steps:
        steps = steps | {"max_step": 0.1}
    events = [event(lambda t, p, v: np.sin(p[0]), 1, 2), event(rate_of_first), event(lambda t, p, v: p[2])]
    full, sol = (zd.simulate(bar, 8.0, events=events, **steps, **options) for options in ({}, saved))
    for name in ("t_events", "p_events", "v_events"):
        for a, b in zip(getattr(full, name), getattr(sol, name), strict=True):
            assert_close(b, a, tol.STEPPED)
    assert len(sol.t_events[0]) == 2
    assert sol.t[-1] == sol.t_events[0][-1]
    assert sol.p[-1].tobytes() == sol.p_events[0][-1].tobytes()
    assert (np.diff(sol.t) > 0).all()
    assert np.isfinite(sol.energy_violation).all()
    if "t_eval" in saved:
        assert sol.t[:-1].tolist() == [t for t in saved["t_eval"] if t < sol.t[-1]]
    if "save_every" in saved:
        assert sol.t[:-1].tolist() == full.t[:-1:7].tolist()


def test_times_to_save_do_not_end_the_watch(bar):
    """Events are found to the end of the span, as in SciPy; a time that is both a sample and an event is saved once."""
    at = event(lambda t, p, v: t - 0.5, terminal=True)
    sol = zd.simulate(bar, 1.0, step=0.01, t_eval=[0.1, 0.2], events=at)
    assert sol.t_events[0].tolist() == [0.5]
    assert sol.t.tolist() == [0.1, 0.2, 0.5]
    assert zd.simulate(bar, 1.0, step=0.01, t_eval=[0.1, 0.5, 0.6], events=at).t.tolist() == [0.1, 0.5]


@pytest.mark.each_value
def test_slicing_changes_no_bit(bar, formulation, integrator, monkeypatch):
    runs = []
    for seconds in (1e9, 0.0, -1.0):
        monkeypatch.setattr(simulation, "SLICE", seconds)
        runs.append(zd.simulate(bar, 4.0, step=0.01, formulation=formulation, integrator=integrator,
                                events=[event(rate_of_first), event(lambda t, p, v: np.sin(p[0]), 1, 2)]))
    for other in runs[1:]:
        for a, b in zip(runs[0].p_events + runs[0].t_events, other.p_events + other.t_events, strict=True):
            assert a.tobytes() == b.tobytes()
        assert runs[0].p.tobytes() == other.p.tobytes()
        assert runs[0].stats | {"seconds": 0} == other.stats | {"seconds": 0}


def test_watching_leaves_the_motion_alone(bar):
    plain, watched = (zd.simulate(bar, 2.0, step=0.01, events=e) for e in (None, event(lambda t, p, v: v[1])))
    assert len(watched.t_events[0]) > 0
    assert plain.p.tobytes() == watched.p.tobytes()
    assert plain.t_events is plain.p_events is plain.v_events is None


def test_systems_in_python(bar):
    events = [event(rate_of_first), event(lambda t, p, v: np.sin(p[0]), 1, 2)]
    one, other = (zd.simulate(system, 8.0, step=0.01, events=events) for system in (bar, bar_in_python()))
    assert one.status == other.status > 0
    for a, b in zip(one.t_events + one.v_events, other.t_events + other.v_events, strict=True):
        assert_close(b, a, 1e-9)        # round-off, grown in two seconds


# ---- several in one step, and at its ends ----


def test_after_a_terminal_event_nothing_is_reported(bar):
    """All three in the same step; the order they are given in does not matter."""
    for order in ([0, 1, 2], [2, 1, 0], [1, 0, 2]):
        events = [event(lambda t, p, v: t - 0.101), event(lambda t, p, v: t - 0.105, 0, True), event(lambda t, p, v: t - 0.107)]
        sol = zd.simulate(bar, 1.0, step=0.05, events=[events[i] for i in order])
        counts = dict(zip(order, map(len, sol.t_events), strict=True))
        assert counts == {0: 1, 1: 1, 2: 0}
        assert sol.message == f"at t = 0.105 (step 3 of 20): ended by event {order.index(1)}"


def test_the_earlier_of_two_terminal_events_ends_the_run(bar):
    late, early = (event(lambda t, p, v, at=at: t - at, 0, True) for at in (0.107, 0.104))
    sol = zd.simulate(bar, 1.0, step=0.05, events=[late, early])
    assert [len(t) for t in sol.t_events] == [0, 1]
    assert "ended by event 1" in sol.message


def test_what_is_zero_at_the_start_is_not_an_event():
    oscillator = zd.systems.oscillator(x0=0.0, v0=1.0)
    sol = zd.simulate(oscillator, 1.0, events=event(position, 0, True), **DENSE)
    assert_close(sol.t_events[0], [np.pi / np.sqrt(10)], tol.STEPPED)


def test_a_zero_at_the_end_of_a_step_happens_once():
    falling = zd.System(1, mass=np.eye(1), p0=[1.0], v0=[-1.0])      # reaches 0 at t = 1 without rounding
    for direction, count in ((0, 1), (-1, 1), (1, 0)):
        sol = zd.simulate(falling, 2.0, step=0.25, integrator="euler", events=event(position, direction))
        assert sol.t_events[0].tolist() == [1.0] * count


def test_a_run_that_starts_where_an_event_ended_one_goes_on(bar):
    """The event has happened there, and does not happen again."""
    at = event(lambda t, p, v: np.sin(p[0]), 1, True)
    first = zd.simulate(bar, 8.0, step=0.01, events=at)
    second = zd.simulate(bar, (first.t[-1], 8.0), first.p[-1], first.v[-1], step=0.01, events=at)
    assert second.t[-1] > first.t[-1] + 0.1


def test_a_ball_that_bounces():
    """Terminal events and new starts: flights of a ball last 2 v / g, and each bounce takes a tenth of v."""
    ball = zd.System(["y"], mass=np.eye(1), force=np.array([-9.81]), potential=lambda p: 9.81 * p[0], p0=[1.0])
    ground, t, p, v, bounces = event(position, -1, True), 0.0, None, None, []
    while len(bounces) < 5:
        sol = zd.simulate(ball, (t, t + 5.0), p, v, step=0.05, events=ground)
        t, p, v = sol.t[-1], sol.p[-1], -0.9 * sol.v[-1]
        bounces.append(t)
    first = np.sqrt(2 / 9.81)
    assert_close(bounces, first + np.cumsum([0, *(2 * first * 0.9**k for k in range(1, 5))]), tol.STEPPED)


def test_a_jump_costs_no_more_than_bisection(bar):
    """A function without a slope: the step is halved down to four units of rounding, then both sides are visited."""
    sol = zd.simulate(bar, 0.05, step=0.05, events=event(lambda t, p, v: 1.0 if t > 0.0123456 else -1.0))
    assert_close(sol.t_events[0], [0.0123456], 8 * tol.EPS)
    assert sol.stats["output_steps"] <= 50 + 3
    smooth = zd.simulate(bar, 0.05, step=0.05, events=event(lambda t, p, v: p[0] - bar.p0[0] - 0.01))
    assert len(smooth.t_events[0]) == 1
    assert smooth.stats["output_steps"] <= 20


CORRECTIONS = [None, "projection", zd.Projection(every=2), zd.Projection(every=3, metric="identity"), zd.Projection(tol=1e-4),
               zd.Projection(every=4, positions=False), zd.Projection(every=4, velocities=False),
               zd.Baumgarte(10.0, 25.0, 20.0)]
STEPS = [{"step": 0.03}, {"rtol": 1e-4, "atol": 1e-6}]


@pytest.mark.each_value
@pytest.mark.pairs(system={kind: SYSTEMS[kind] for kind in ("four_bar", "skate", "arm") if kind in SYSTEMS})
def test_events_are_zero_whatever_is_corrected(system, formulation, integrator):
    """Corrections at every k-th step, within a wide tolerance, of velocities alone: none makes the function leap."""
    happened = 0
    for steps, stabilization, energy in itertools.product(STEPS, CORRECTIONS, [None, zd.EnergyCorrection(every=3)]):
        if "rtol" in steps and not zd.integrators()[integrator].error_order:
            continue
        function = functools.partial(wave, np.arange(1, system.nq + 1))
        with unwarned():
            sol = zd.simulate(system, 0.7, events=event(function, terminal=4), formulation=formulation, integrator=integrator,
                              stabilization=stabilization, energy=energy, on_failure="return", **steps)
        for t, p, v in zip(sol.t_events[0], sol.p_events[0], sol.v_events[0], strict=True):
            happened += 1
            assert abs(function(t, p, v)) <= tol.SAME * (1 + np.abs(v).max())     # it changes so fast, and t is rounded
            if system.mh and isinstance(stabilization, zd.Projection) and stabilization.positions:
                assert np.abs(system.evaluate(p, v, t).Phi / sol.position_size).max() <= 2 * stabilization.tol
    assert happened > 10


def wave(weights, t, p, v):
    """A function of all there is, with zeros now and then."""
    return np.sin(weights @ p + 2 * t + 0.3 * v[0])


@pytest.mark.parametrize("every", [2, 3, 5])
def test_corrections_now_and_then_invent_no_events(bar, every):
    """The function leaps neither where a correction is made nor where none is: the events are those of the motion."""
    events = [event(lambda t, p, v: v[1]), event(lambda t, p, v: np.sin(p[0] - 0.3))]
    true = zd.simulate(bar, 8.0, step=0.002, integrator="dop853", events=events)
    often, seldom = (zd.simulate(bar, 8.0, step=0.01, events=events, stabilization=zd.Projection(every=k)) for k in (1, every))
    for expected, corrected, found in zip(true.t_events, often.t_events, seldom.t_events, strict=True):
        assert len(found) == len(expected) > 5
        assert np.abs(found - expected).max() < 3 * np.abs(corrected - expected).max()


@pytest.mark.parametrize("stabilization", ["projection", zd.Projection(every=2)], ids=["each", "second"])
def test_a_function_that_leaps_is_reported_behind_its_leap(bar, stabilization):
    def side(t, p, v):
        return 0.7 if p[0] > 1.6 else -0.2

    sol = zd.simulate(bar, 1.0, step=0.01, events=side, stabilization=stabilization)
    (t,), (p,), (v,) = sol.t_events[0], sol.p_events[0], sol.v_events[0]
    assert side(t, p, v) == 0.7
    assert abs(p[0] - 1.6) <= 64 * tol.EPS
