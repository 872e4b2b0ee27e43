"""Laws of t that jump or bend: adaptive steps end there, so that none passes over a pulse."""

import itertools
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import zerodrift as zd
from support import assert_close

PULSE = (7.0, 7.01)


def pendulum(law, gravity=0.0, **options):
    m = zd.Mechanism("pendulum", gravity=(0.0, -gravity), **options)
    arm = m.link("arm", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, arm.start)
    m.motor("drive", pin, torque=law)
    return m


def pulse(t):
    return 5.0 if PULSE[0] <= t < PULSE[1] else 0.0


def as_formula(t):
    return np.where((t > 7.0) & (t <= 7.01), 5.0, 0.0)


def wave(t):
    return 1.0 if t % 0.5 < 0.1 else -0.25


def from_a_parameter(t, width):
    return 2.0 if abs(t - 3.0) < width / 2 else 0.0


RAMP = zd.table([0, 1, 5], [0, 3, 3], kind="linear", beyond="hold")
LAWS = {
    "pulse": (pulse, (7.0, 7.01)),
    "where": (as_formula, (7.0, 7.01)),
    "remainder": (wave, [0.1 + 0.5 * k for k in range(20)] + [0.5 * k for k in range(1, 20)]),
    "sine": (lambda t: 1.0 if np.sin(2 * t + 0.3) > 0.5 else 0.0,
             [(turn * math.pi / 6 - 0.3) / 2 + math.pi * k for turn in (1, 5) for k in range(3)]),
    "floor": (lambda t: math.floor(t / 3), (3.0, 6.0, 9.0)),
    "parameter": (from_a_parameter, (2.995, 3.005)),
    "lines": (zd.table([0, 3, 3.001, 3.002, 10], [0, 0, 100, 0, 0], kind="linear"), (3.0, 3.001, 3.002)),
    "steps": (zd.table([0, 4, 4.5, 10], [0, 3, 0, 0], kind="steps"), (4.0, 4.5)),
    "peak": (zd.table([0, 1, 2, 2.1, 2.2, 3, 10], [0, 0, 0, 5, 0, 0, 0]), (2.0, 2.1, 2.2)),
    "repeated": (zd.table([0, 1, 1.1, 2], [0, 2, 0, 0], kind="linear", beyond="period"),
                 [k + each for k in range(0, 10, 2) for each in (0, 1, 1.1)][1:]),
    "within": (lambda t: 2 * RAMP(2 * t - 3), (1.5, 2.0)),
    "square": (lambda t: 1.0 if (t - 5)**2 < 1e-6 else 0.0, (4.999, 5.001)),
    "bell": (lambda t: 1.0 if math.exp(-((t - 5) * 100)**2) > 0.5 else 0.0,
             [5 + side * math.sqrt(math.log(2)) / 100 for side in (-1, 1)]),
    "chirp": (lambda t: 1.0 if np.sin(t * t) > 0 else 0.0, [math.sqrt(k * math.pi) for k in range(1, 32)]),
    "half sine": (lambda t: 100 * math.sin(math.pi * (t - 5) / 0.01) if 5 <= t <= 5.01 else 0.0, (5.0, 5.01)),
    "smooth": (lambda t: np.exp(-t) * np.sin(t), ()),
    "fine": (zd.table(np.linspace(0, 10, 201), np.sin(np.linspace(0, 10, 201))), ()),
}


@pytest.mark.parametrize("name", LAWS)
def test_steps_end_at_breaks(name):
    law, times = LAWS[name]
    options = {"parameters": {"width": 0.01}} if name == "parameter" else {}
    sol = zd.simulate(pendulum(law, gravity=9.81, **options), 10.0, rtol=1e-7, atol=1e-7)
    for time in times:
        assert np.abs(sol.t - time).min() < 1e-12
    assert name not in ("smooth", "fine") or len(sol.t) < 100


def law_of(name, t):
    return LAWS[name][0](t, *([0.01] if name == "parameter" else []))


def reference(name, until):
    """Angle and speed by SciPy, from break to break."""
    breaks = sorted({0.0, *LAWS[name][1], until})
    y, inertia = np.zeros(2), 1 / 3
    for start, end in itertools.pairwise(breaks):
        inside = start + (end - start) * np.array([1e-9, 1 - 1e-9])     # so that rounding leads to no other side
        y = solve_ivp(lambda t, y: [y[1], (law_of(name, np.clip(t, *inside)) - 9.81 / 2 * np.cos(y[0])) / inertia],    # noqa: B023
                      (start, end), y, method="DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
    return y


@pytest.mark.parametrize("name", ["pulse", "remainder", "sine", "parameter", "lines", "steps", "within", "bell", "half sine"])
@pytest.mark.parametrize("method", ["dop853", "dormand_prince", "radau"])
def test_motions_are_those_of_scipy_from_break_to_break(name, method):
    options = {"parameters": {"width": 0.01}} if name == "parameter" else {}
    sol = zd.simulate(pendulum(LAWS[name][0], gravity=9.81, **options), 10.0, integrator=method, rtol=1e-10, atol=1e-10)
    angle, speed = reference(name, 10.0)
    # 10 s of a pendulum enlarge the error of a step about a hundred times; Radau's steps are many
    allowed = 1e-7 if method == "radau" else 1e-8
    assert_close([sol["pin.angle"][-1] - sol["pin.angle"][0], sol["pin.speed"][-1]], [angle, speed], allowed, scale=1.0)


def speed_of_pulse(t):
    return 15.0 * np.clip(np.asarray(t) - PULSE[0], 0, PULSE[1] - PULSE[0])


WAYS = {
    "steps": {}, "many samples": {"t_eval": np.linspace(0, 10, 1001)}, "at breaks": {"t_eval": [7.0, 7.005, 7.01]},
    "event": {"events": lambda t, p, v: t - 8.5}, "matrices": {"closed_form": False}, "mixed": {"formulation": "mixed"},
    "independent": {"formulation": "independent"}}


@pytest.mark.parametrize("method", ["dop853", "dormand_prince", "radau"])
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_a_pulse_at_rest_is_not_passed_over(method, way, coordinates):
    sol = zd.simulate(pendulum(pulse).system(coordinates), 10.0, integrator=method, rtol=1e-6, atol=1e-6, **WAYS[way])
    # a joint coordinate is a parabola, which each method integrates exactly; Cartesian coordinates of a rotation are not
    allowed = 1e-5 if coordinates == "absolute" else 1e-12
    assert_close(sol["pin.speed"], speed_of_pulse(sol.t), allowed, scale=1.0)
    assert np.abs(sol.energy_violation).max() < 1e-6
    if way == "steps":
        t = np.linspace(0, 10, 1777)
        assert_close(sol(t)[1][:, -1], speed_of_pulse(t), allowed, scale=1.0)


SPEEDS = {"step": (lambda t: 1.0 if t < 1 else 3.0, 4.0), "saw": (lambda t: t % 0.5, 0.5),
          "pulse": (lambda t: 1.0 if 1 < t < 1.01 else 0.0, 0.01)}


@pytest.mark.parametrize("name", SPEEDS)
@pytest.mark.parametrize("method", ["dop853", "radau"])
def test_a_prescribed_speed_jumps_with_its_law(name, method):
    law, angle = SPEEDS[name]
    m = zd.Mechanism("arm")
    arm = m.link("arm", (0, 0), (1, 0), mass=1.0)
    m.motor("drive", m.revolute("pin", m.ground, arm.start), speed=law)
    for coordinates in ("joint", "absolute"):
        sol = zd.simulate(m.system(coordinates), 2.0, integrator=method, rtol=1e-8, atol=1e-8)
        assert_close(sol["pin.angle"][-1], angle, 1e-7, scale=1.0)


@pytest.mark.parametrize("name", ["kink", "ramp", "triangle"])
@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_a_prescribed_angle_bends_with_its_law(name, coordinates):
    """The impulse on the second link of a double pendulum, by fixed steps that end at the bends, which are many."""
    law = {"kink": lambda t: max(0.0, t - 1), "ramp": lambda t: float(np.clip(t - 0.5, 0, 1)),
           "triangle": lambda t: abs(t % 1 - 0.5)}[name]
    m = zd.Mechanism("double pendulum", gravity=(0, -9.81))
    first = m.link("first", (0, 0), (1, 0), mass=1.0)
    second = m.link("second", first.end, (2, 0), mass=1.0)
    m.motor("drive", m.revolute("pin", m.ground, first.start), angle=law)
    m.revolute("elbow", first.end, second.start)
    system = m.system(coordinates)
    found = [zd.simulate(system, 2.0, **options)["second.angle"][-1] for options in (
        {"rtol": 1e-10, "atol": 1e-10}, {"integrator": "radau", "rtol": 1e-8, "atol": 1e-8}, {"step": 1e-4})]
    # a fixed step has the impulse at its end: an error of first order in the step at each bend
    assert_close(found[1], found[0], 1e-6, scale=1.0)
    assert_close(found[2], found[0], 2e-3, scale=1.0)


def test_shifted_and_narrow_pulses_of_a_period():
    for width in (1e-2, 1e-4):
        for law in (lambda t: (1 / width if (t - 0.3) % 1 < width else 0.0),               # noqa: B023
                    lambda t: (1 / width if np.cos(2 * np.pi * (t - 0.3)) > np.cos(np.pi * width) else 0.0)):     # noqa: B023
            m = zd.Mechanism("body")
            body = m.particle("body", 1.0, at=(0, 0))
            m.force("push", body, along=(1, 0), value=law)
            run = zd.Run(m, rtol=1e-4, atol=1e-4)
            run.advance_to(10.0)
            for speed in (run["body.velocity.x"], zd.simulate(m, 10.0, rtol=1e-4, atol=1e-4)["body.velocity.x"][-1]):
                assert_close(speed, 10.0, 1e-6, scale=1.0)


def test_a_pulse_that_ends_with_the_run():
    sol = zd.simulate(pendulum(pulse), 7.01)
    assert sol.t[-1] == 7.01
    assert len(sol.t) < 12
    assert_close(sol["pin.speed"][-1], 0.15, 1e-12, scale=1.0)


def test_open_runs_and_restored_states_meet_breaks():
    m, times = pendulum(pulse), (3.0, 7.0, 7.002, 7.01, 9.0)
    run = zd.Run(m)
    for t in times:
        run.advance_to(t)
        assert_close(run["pin.speed"], speed_of_pulse(t), 1e-12, scale=1.0)
        again = zd.Run(m)
        again.restore(run.save())
        again.advance_to(9.5)
        assert_close(again["pin.speed"], 0.15, 1e-12, scale=1.0)
    run.restore(zd.Run(m).save())
    run.advance_to(7.005)
    assert_close(run["pin.speed"], 0.075, 1e-12, scale=1.0)


def test_ensembles_meet_breaks():
    speeds = np.linspace(0, 1, 9)
    many = zd.ensemble(pendulum(pulse), 10.0, v0=speeds[:, None], rtol=1e-8, atol=1e-8, outputs="pin.speed")
    assert_close([each[-1] for each in many["pin.speed"]], speeds + 0.15, 1e-10)


def test_fixed_steps_do_not_move():
    sol = zd.simulate(pendulum(pulse), 1.0, step=0.3)
    assert_close(sol.t, [0, 0.3, 0.6, 0.9, 1.0], 1e-15)


def test_the_energy_balance_of_radaus_method_holds_where_an_input_jumps():
    """The iteration had ended by the contraction of the step before, with the Jacobian of the earlier torque."""
    toggle = zd.every(0.5, lambda run: run.__setitem__("drive.torque", 1.0 if round(run.t / 0.5) % 2 else -0.25))
    sol = zd.simulate(pendulum(1.0), 10.0, integrator="radau", rtol=1e-6, atol=1e-6, inputs=["drive.torque"], control=toggle)
    assert np.abs(sol.energy_violation).max() < 1e-9 * sol.kinetic_energy.max()
