"""Laws that jump where a comparison of the motion changes: adaptive steps end there. Kinks are left to the error control."""

import inspect
import itertools

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import zerodrift as zd
from support import assert_close, refused
from zerodrift.laws.recording import record
from zerodrift.laws.switches import held

END, START = 6.0, (0.5, 0.0)
METHODS = ("dormand_prince", "dop853", "radau")
# Law, borders g(t, x, v), and the acceleration from x, v, t and the sides g > 0, written anew.
JUMPS = {
    "relay": (lambda x: np.where(x > 0, -1.0, 1.0), [lambda t, x, v: x], lambda t, x, v, a: -1.0 if a else 1.0),
    "zones": (lambda x: np.select([x < -0.2, x < 0.2], [3.0, 0.5], -4.0), [lambda t, x, v: x + 0.2, lambda t, x, v: x - 0.2],
              lambda t, x, v, a, b: -4.0 if b else 0.5 if a else 3.0),
    "stairs": (lambda x: np.select([x < -0.3, x < 0.0, x < 0.2], [4.0, 2.0, -1.0], -3.0),      # which are met again in a step
               [lambda t, x, v: x + 0.3, lambda t, x, v: x, lambda t, x, v: x - 0.2],
               lambda t, x, v, a, b, c: -3.0 if c else -1.0 if b else 2.0 if a else 4.0),
    "band": (lambda x: 20.0 if 0.1 < x < 0.12 else -3 * x, [lambda t, x, v: x - 0.1, lambda t, x, v: 0.12 - x],
             lambda t, x, v, a, b: 20.0 if a and b else -3 * x),
    "product": (lambda x, v: -5 * x + np.where(x * v > 0.1, -1.0, 0.2), [lambda t, x, v: x * v - 0.1],
                lambda t, x, v, a: -5 * x + (-1.0 if a else 0.2)),
    "moving": (lambda t, x: -3.0 if x > 0.3 * np.sin(3 * t) else 3.0, [lambda t, x, v: x - 0.3 * np.sin(3 * t)],
               lambda t, x, v, a: -3.0 if a else 3.0),
    "both": (lambda x, v: -8 * x - 2 * v if x > 0 and v > 0 else -x, [lambda t, x, v: x, lambda t, x, v: v],
             lambda t, x, v, a, b: -8 * x - 2 * v if a and b else -x),
    "step": (lambda x: -x - 2 * np.heaviside(x - 0.2, 0.5), [lambda t, x, v: x - 0.2], lambda t, x, v, a: -x - 2.0 * a),
    "square": (lambda x: -8 * x + np.where(x**2 < 0.05, 2.0, 0.0), [lambda t, x, v: x**2 - 0.05],
               lambda t, x, v, a: -8 * x + (0.0 if a else 2.0)),
    "sign": (lambda x: -3 * x - 0.7 * np.sign(x), [lambda t, x, v: x], lambda t, x, v, a: -3 * x + (-0.7 if a else 0.7)),
    "exponential": (lambda x: -2 - np.exp(x) if x > 0 else 4.0, [lambda t, x, v: x],
                    lambda t, x, v, a: -2 - np.exp(x) if a else 4.0),
}
# Law that bends, and its borders
X, LOW = [lambda t, x, v: x], [lambda t, x, v: x - 0.2, lambda t, x, v: x + 0.2]
KINKS = {
    "contact": (lambda x: -3 * x - max(0.0, 200 * (x - 0.4)), [lambda t, x, v: x - 0.4]),
    "modulus": (lambda x: -abs(x) - x, X),
    "clip": (lambda x: np.clip(-5 * x, -1, 1), LOW),
    "maximum": (lambda x, v: -4 * x - np.maximum(v, 0.0), [lambda t, x, v: v]),
    "parabola": (lambda x: -x - (x**2 if x > 0 else 0.0), X),
    "hardening": (lambda x: -2 * x if abs(x) < 0.2 else -10 * x + 1.6 * np.sign(x), LOW),
    "drag": (lambda x, v: -4 * x - v * abs(v), [lambda t, x, v: v]),
    "interpolated": (lambda x: np.interp(x, [-1, -0.2, 0.2, 1], [4, 1, -1, -4]), LOW),
    "two": (lambda x, v: -min(2.5 * x, 0.5) - max(v, 0.1), [lambda t, x, v: x - 0.2, lambda t, x, v: v - 0.1]),
    "stiff": (lambda x: -1000 * x if x > 0 else -10 * x, X),
}


def particle(law):
    m = zd.Mechanism("particle")
    body = m.particle("body", 1.0, at=(START[0], 0))
    m.force("force", body, along=(1, 0), value=law, of={"x": body.position.x, "v": body.velocity.x})
    return m


def reference(borders, acceleration):
    """State at the end, and the number of changes, by SciPy from one to the next."""
    t, y, changes = 0.0, np.array(START), 0
    sides = [g(1e-9, START[0], -1e-9) > 0 for g in borders]     # all of these begin to the left
    while t < END:
        events = [lambda t, y, g=g: g(t, *y) for g in borders]
        for event, side in zip(events, sides, strict=True):
            event.terminal, event.direction = True, -1 if side else 1
        found = solve_ivp(lambda t, y: (y[1], acceleration(t, *y, *sides)), (t, END), y, "DOP853", rtol=1e-13, atol=1e-14,
                          events=events, max_step=0.05)
        t, y = found.t[-1], found.y[:, -1]
        for i, times in enumerate(found.t_events):
            sides[i] ^= bool(len(times))
            changes += bool(len(times))
    return y, changes


@pytest.fixture(scope="module", params=JUMPS)
def jump(request):
    law, *others = JUMPS[request.param]
    return law, *reference(*others)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rtol", [1e-6, 1e-9, 1e-12])
def test_steps_end_where_a_law_jumps(jump, method, rtol):
    """Errors are those of smooth motion; by the error control alone they are some hundred times as large."""
    law, true, changes = jump
    sol = zd.simulate(particle(law), END, integrator=method, rtol=rtol, atol=1e-3 * rtol)
    assert_close([sol["body.position.x"][-1], sol["body.velocity.x"][-1]], true, 20 * rtol + 2e-12, scale=1.0)
    assert sol.stats["rejected"] <= 4 * changes + 12      # without switches: 20 a change and more


@pytest.mark.parametrize("name", KINKS)
def test_kinks_are_left_to_the_error_control(name):
    """Errors decrease with the tolerance, but more slowly than those of smooth motion: an error estimate sees a kink weakly."""
    law, borders = KINKS[name]
    system, names = particle(law).system(), inspect.signature(law).parameters
    assert not system._core._law.jump
    true, _ = reference(borders, lambda t, x, v, *sides: law(*(x, v)[:len(names)]))
    for method, rtol in itertools.product(METHODS, (1e-6, 1e-9, 1e-12)):
        sol = zd.simulate(system, END, integrator=method, rtol=rtol, atol=1e-3 * rtol)
        assert_close([sol.p[-1, 0], sol.v[-1, 0]], true, 100 * rtol**0.8, scale=1.0)


def test_both_results_of_a_comparison_are_compared_at_its_border():
    def differences(law, names, **parameters):
        formula, *_ = record(law, names, parameters)
        return len(held(formula, frozenset(names) - {"t", *parameters}, tuple(parameters.items())).differences)

    assert differences(lambda x: np.where(x > 0, 1 + x, x**2), ["x"]) == 1
    assert differences(lambda x: np.where(x > 0, x, x**2), ["x"]) == 0
    assert differences(np.sign, ["x"]) == 1     # of two comparisons of the same
    assert differences(lambda x, v: np.where((x > 0) & (v > 1), 5.0, 0.0), ["x", "v"]) == 2
    assert differences(lambda x, v: np.where((x > 0) & (v > 1), v - 1, 0.0), ["x", "v"]) == 1
    assert differences(lambda t: np.where(t > 0, 5.0, 0.0), ["t"]) == 0      # known beforehand: a break
    assert differences(lambda t, x: np.where(x > t, 5.0, 0.0), ["t", "x"]) == 1
    assert differences(lambda x, limit: np.where(x > limit, 5.0, 0.0), ["x", "limit"], limit=0.3) == 1
    assert differences(lambda x, limit: np.where(limit > 0, 5.0, x), ["x", "limit"], limit=0.3) == 0


# ---- mechanisms, and other runs ----

def crank():
    """Slider-crank with four jumps: of an angle, a speed, and of the same place for two forces."""
    m = zd.Mechanism("crank", gravity=(0, -9.81))
    crank = m.link("crank", (0, 0), (0.1, 0.05), mass=1.0)
    rod = m.link("rod", crank.end, (0.5, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, crank.start)
    m.revolute("joint", crank.end, rod.start)
    m.slot("slot", m.ground, rod.end, axis=(1, 0))
    m.motor("drive", pin, torque=lambda angle, w: (12.0 if np.sin(angle) > 0.2 else 5.0) - 0.2 * w - (1.0 if w > 16 else 0.0),
            of={"w": pin.speed, "angle": pin.angle})
    for name, push in (("push", (-20.0, 0.0)), ("pull", (-5.0, 3.0))):
        m.force(name, rod.end, along=(1, 0), value=lambda x, push=push: push[0] if x > 0.42 else push[1],
                of={"x": rod.end.position.x})
    return m


def test_a_mechanism_in_both_coordinates_by_all_methods():
    m, found = crank(), []
    for coordinates in ("joint", "absolute"):
        for method, rtol in zip(METHODS, (1e-10, 1e-10, 1e-8), strict=True):
            sol = zd.simulate(m.system(coordinates), 2.0, integrator=method, rtol=rtol, atol=1e-2 * rtol)
            found.append([sol["pin.angle"][-1], sol["pin.speed"][-1]])
            assert np.abs(sol.energy_violation).max() < 1e-6
    assert_close(found, np.mean(found, axis=0) + np.zeros((6, 2)), 1e-8, scale=10.0)


@pytest.mark.parametrize("method", METHODS)
def test_values_between_steps_are_on_the_side_of_their_step(method):
    m = particle(JUMPS["relay"][0])
    sol, times = zd.simulate(m, END, integrator=method, rtol=1e-9, atol=1e-12), np.linspace(0, END, 601)
    p, _ = sol(times)
    phase = times % 4
    x = np.select([phase < 1, phase < 3], [0.5 - phase**2 / 2, (phase - 2)**2 / 2 - 0.5], 0.5 - (phase - 4)**2 / 2)
    assert_close(p[:, 0], x, 1e-9)
    assert_close(zd.simulate(m, END, integrator=method, rtol=1e-9, atol=1e-12, t_eval=times).p[:, 0], x, 1e-9)


def test_open_runs_copies_ensembles_and_compiled_mechanisms_have_them():
    m = particle(JUMPS["relay"][0])
    settings = {"rtol": 1e-9, "atol": 1e-12, "integrator": "dop853"}
    sol = zd.simulate(m, END, **settings)
    run = zd.Run(m, **settings)
    for _ in range(sol.t.size - 1):
        copy = run.copy()       # also where a step ended at a jump
        copy.advance_to(END)
        assert_close(copy.p, sol.p[-1], 1e-9)
        run.step() if run.t < 5 else None
    x = zd.ensemble(m.system(), END, p0=[START, (0.3, 0)], outputs=["body.position.x"], **settings)["body.position.x"]
    other = zd.simulate(m.system(), END, p0=(0.3, 0), **settings)
    assert_close([each[-1] for each in x], [sol.p[-1, 0], other.p[-1, 0]], 1e-9, scale=1.0)
    assert_close(zd.simulate(m.system(compiled=True), END, **settings).p[-1], sol.p[-1], 1e-9, scale=1.0)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rtol", [1e-6, 1e-9])
def test_a_region_that_is_entered_and_left_in_a_step_is_not_passed_over(method, rtol):
    """The position, x = 1/2 - v t + t^2 / 2 goes below 0 by d, where the acceleration is 3."""
    for depth in np.geomspace(1e-8, 0.1, 15):
        fast, slow = np.sqrt(1 + 2 * depth), np.sqrt(2 * depth)
        rest = 4 - (fast - slow) - 2 * slow / 3
        x = zd.simulate(particle(lambda x: 1.0 if x > 0 else 3.0).system(), 4.0, v0=[-fast, 0], rtol=rtol, atol=1e-3 * rtol,
                        integrator=method).p[-1, 0]
        assert_close(x, slow * rest + rest**2 / 2, 20 * rtol)


@pytest.mark.parametrize("method", METHODS)
def test_a_run_goes_on_from_an_event_within_a_step_that_ended_at_a_jump(method):
    m = particle(JUMPS["relay"][0])
    for value in np.linspace(-0.9, 0.9, 7):
        run = zd.Run(m, rtol=1e-9, atol=1e-12, integrator=method,
                     events=zd.Event("body.velocity.x", value=value, terminal=True))
        while run.t < 6.0:
            run.advance_to(6.0)
        assert_close(run.p[0], -0.5, 1e-8)


def test_copies_and_saved_states_continue_with_the_same_bits():
    law, settings = (lambda x: (-1.0 if x > 0 else 1.0) - 0.5 * x**3), {"rtol": 1e-8, "atol": 1e-10, "integrator": "radau"}
    run = zd.Run(particle(law), **settings)
    states, copies = [], []
    for _ in range(120):
        copies.append((run.copy(), zd.Run(particle(law), **settings)))
        copies[-1][1].restore(run.save())
        run.step()
        states.append((run.t, *run.p, *run.v))
    for step, others in enumerate(copies[:-2]):
        for other in others:
            other.step(3)
            assert (other.t, *other.p, *other.v) == states[step + 2]


def test_another_state_forgets_the_side():
    run = zd.Run(particle(JUMPS["relay"][0]), rtol=1e-9, integrator="dop853")
    while run.p[0] > 1e-9:
        run.step()
    run.set_state(p=[0.5, 0.0], v=[0.0, 0.0])
    begin = run.t
    run.advance_to(begin + 0.5)
    assert_close(run.p[0], 0.5 - 0.125, 1e-8)


def test_beyond_the_domain_of_a_side_the_error_control_decides():
    """A root has no value across the border: the step is made again with the comparison free."""
    law = particle(lambda x: -2 - np.sqrt(x) if x > 0 else 4.0)
    ends = [zd.simulate(law, END, rtol=rtol, atol=1e-3 * rtol, integrator="dop853").p[-1, 0] for rtol in (1e-9, 1e-12)]
    assert_close(*ends, 1e-6)


@pytest.mark.parametrize("method", METHODS)
def test_changes_ever_nearer_to_each_other_end_the_run(method):
    """Swings that lose a part of their energy at each change of direction come to rest after infinitely many of them."""
    law = particle(lambda x, v: (-6.0 if v > 0 else -2.0) if x > 0 else (5.0 if v < 0 else 3.0))
    with refused("step-collapse"):
        zd.simulate(law, 20.0, rtol=1e-9, integrator=method)
