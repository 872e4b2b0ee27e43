"""Random events with known instants: of thrown particles, oscillators and pendulums, from closed forms of their motion."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp
from scipy.optimize import brentq
from scipy.special import ellipj, ellipk

import zerodrift as zd

GRAVITY = 9.81
SAMPLES = 10001     # of the closed form, between which its zeros are bracketed
STEPS = {
    "dormand_prince": {"integrator": "dormand_prince", "rtol": 1e-9, "atol": 1e-11},
    "dop853": {"integrator": "dop853", "rtol": 1e-9, "atol": 1e-11},
    "long": {"integrator": "dop853", "rtol": 1e-5, "atol": 1e-6},
    "radau": {"integrator": "radau", "rtol": 1e-7, "atol": 1e-9},
    "taylor": {"integrator": "taylor", "rtol": 1e-9, "atol": 1e-11},
    "rk4": {"integrator": "rk4"},
    "fixed": {"integrator": "dop853"},
}
ERROR = {"dormand_prince": 1e-7, "dop853": 1e-7, "long": 1e-3, "radau": 1e-5, "taylor": 1e-7, "rk4": 1e-4, "fixed": 1e-5}
PER_PERIOD = {"rk4": 150, "fixed": 25}      # fixed steps
SHALLOWEST = {"long": 2e-2, "radau": 1e-3}      # distance of the value from an extremum, relative to the range; else 1e-4


@dataclass
class Scene:
    """A motion with the closed form of what its event reads; `value(t)` takes an array of times (k,)."""

    name: str
    system: Any
    period: float
    event: Any      # a function of the value that the event reaches
    value: Any


def thrown(rng, dimension):
    m = zd.Mechanism("thrown", dimension=dimension, gravity=(0, -GRAVITY, 0)[:dimension])
    m.particle("ball", float(rng.uniform(0.5, 2)), at=(0, 0, 0)[:dimension])
    speed = float(rng.uniform(3, 12))
    m.start({"ball.velocity": (1.0, speed, 0.5)[:dimension]})
    return Scene(f"thrown in {dimension}D", m, 2 * speed / GRAVITY, lambda level: zd.Event("ball.position.y", value=level),
                 lambda t: speed * t - GRAVITY / 2 * t**2)


def oscillating(rng, what):
    mass, stiffness, x0, v0 = (float(each) for each in rng.uniform(0.5, 2, 4))
    omega = np.sqrt(stiffness / mass)
    phase = np.arctan2(-v0 / omega, x0)
    A = np.hypot(x0, v0 / omega)
    system = zd.systems.oscillator(mass=mass, stiffness=stiffness, x0=x0, v0=v0)
    x, v = (lambda t: A * np.cos(omega * t + phase)), (lambda t: -A * omega * np.sin(omega * t + phase))
    forms = {
        "coordinate": (lambda level: zd.Event("x", value=level), x),
        "velocity": (lambda level: zd.Event("x_dot", value=level), v),
        "expression": (lambda level: zd.Event(sp.Symbol("x") * sp.Symbol("x_dot"), value=level), lambda t: x(t) * v(t)),
        "function": (lambda level: lambda t, p, v: p[0] ** 3 - level, lambda t: x(t) ** 3),
        "time": (lambda level: lambda t, p, v: p[0] * np.cos(3 * t) - level, lambda t: x(t) * np.cos(3 * t)),
    }
    return Scene(f"oscillator, {what}", system, 2 * np.pi / omega, *forms[what])


def pendulum(rng, dimension, what):
    """A rod on a pin: sin(angle / 2) = k sn(w t, k), with reactions from its centre's acceleration."""
    length, mass, amplitude = float(rng.uniform(0.5, 2)), float(rng.uniform(0.5, 2)), float(rng.uniform(0.5, 2.5))
    thickness = 0.05 * length if dimension == 3 else 0.0
    w, k = np.sqrt(GRAVITY * length / 2 / (length**2 / 3 + thickness**2 / 16)), np.sin(amplitude / 2)
    m = zd.Mechanism("pendulum", dimension=dimension, gravity=(0, -GRAVITY, 0)[:dimension])
    link = m.link("link", (0, 0, 0)[:dimension], (0, -length, 0)[:dimension], mass=mass, thickness=thickness or None)
    m.revolute("pin", m.ground, link.start, **({"axis": (0, 0, 1)} if dimension == 3 else {}))
    m.start({"pin.speed": float(2 * w * k)})

    def angle(t):
        return 2 * np.arcsin(k * ellipj(w * t, k**2)[0])

    def speed(t):
        return 2 * k * w * ellipj(w * t, k**2)[1]

    def along(t):
        """Force of the pin along y."""
        a, rate = angle(t), speed(t)
        return mass * (GRAVITY + length / 2 * (np.cos(a) * rate**2 - w**2 * np.sin(a) ** 2))

    forms = {
        "angle": (lambda level: zd.Event("pin.angle", value=level), angle),
        "speed": (lambda level: zd.Event("pin.speed", value=level), speed),
        "measure": (lambda level: zd.Event("link.end.position.y", value=level), lambda t: -length * np.cos(angle(t))),
        "reaction": (lambda level: zd.Event("pin.force.y", value=level), along),
        "bound": (lambda level: zd.Event(lambda a: np.sin(2 * a) - level, of={"a": "pin.angle"}), lambda t: np.sin(2 * angle(t))),
    }
    system = m.system("absolute" if rng.random() < 0.5 else "joint")
    return Scene(f"pendulum in {dimension}D, {what}", system, 4 * ellipk(k**2) / w, *forms[what])


def swinging(rng, what):
    """A particle on a rod, released at rest."""
    length, amplitude = float(rng.uniform(0.5, 2)), float(rng.uniform(0.5, 2.5))
    w, k = np.sqrt(GRAVITY / length), np.sin(amplitude / 2)
    system = zd.systems.pendulum(length=length, gravity=GRAVITY, angle=amplitude)

    def angle(t):
        return 2 * np.arcsin(k * ellipj(w * t + ellipk(k**2), k**2)[0])

    forms = {"x": (lambda level: zd.Event("x", value=level), lambda t: length * np.sin(angle(t))),
             "y": (lambda level: lambda t, p, v: p[1] - level, lambda t: -length * np.cos(angle(t))),
             "area": (lambda level: zd.Event(sp.Symbol("x") * sp.Symbol("y"), value=level),
                      lambda t: -length**2 * np.sin(2 * angle(t)) / 2)}
    return Scene(f"particle on a rod, {what}", system, 4 * ellipk(k**2) / w, *forms[what])


SERIES = [*((oscillating, what) for what in ("coordinate", "velocity", "expression", "function", "time")),
          *((swinging, what) for what in ("x", "y", "area"))]      # scenes whose systems have Taylor series
SCENES = [(thrown, 2), (thrown, 3), *SERIES,
          *((pendulum, dimension, what) for dimension in (2, 3) for what in ("angle", "speed", "measure", "reaction", "bound"))]


def draw_level(rng, value, shallowest):
    """A value near one of the extremes of a motion (k,), at a random depth."""
    depth = shallowest ** float(rng.uniform(0, 1)) * 0.5
    low, high = value.min(), value.max()
    return float(high - depth * (high - low) if rng.random() < 0.5 else low + depth * (high - low))


def zeros_of(function, t):
    """Zeros with their directions; t (k,) brackets each."""
    g = function(t)
    before = np.flatnonzero(g[:-1] * g[1:] < 0)
    return [(brentq(function, t[i], t[i + 1], xtol=1e-15), int(np.sign(g[i + 1] - g[i]))) for i in before]


@dataclass
class Case:
    """A run and the instants (k,) at which its event has to occur, each with a bound of its error."""

    name: str
    system: Any
    end: float
    options: dict
    event: Any
    expected: np.ndarray
    bounds: np.ndarray


def draw(seed, steps):
    """A random case, whose event has a direction in two of three and ends the run in one of three."""
    rng = np.random.default_rng(seed)
    scenes = SERIES if steps == "taylor" else SCENES
    kind, *which = scenes[int(rng.integers(len(scenes)))]
    scene = kind(rng, *which)
    end = scene.period * float(rng.uniform(0.9, 1.0) if kind is thrown else rng.uniform(1.5, 3.0))
    t = np.linspace(0, end, SAMPLES)
    level = draw_level(rng, scene.value(t), SHALLOWEST.get(steps, 1e-4))
    event, direction = scene.event(level), int(rng.integers(-1, 2))
    event = event if isinstance(event, zd.Event) else zd.Event(event)
    found = [at for at, sign in zeros_of(lambda t: scene.value(t) - level, t) if direction in (0, sign)]
    terminal = int(rng.integers(1, len(found) + 1)) if found and rng.random() < 1 / 3 else 0
    expected = np.array(found[:terminal or None])
    slope = np.abs(scene.value(expected + 1e-6) - scene.value(expected - 1e-6)) / 2e-6
    size = np.abs(scene.value(t)).max() + abs(level)
    options = STEPS[steps] | ({"step": scene.period / PER_PERIOD[steps]} if steps in PER_PERIOD else {})
    event = zd.Event(event.what, value=event.value, direction=direction, terminal=terminal, of=event.of)
    return Case(f"{seed}: {scene.name}, {steps}", scene.system, end, options, event, expected, ERROR[steps] * size / slope)


def check(times, case):
    """The fault of the instants found, in a few words; empty: none."""
    if len(times) != len(case.expected):
        return f"{len(times)} events for {len(case.expected)}"
    off = np.abs(times - case.expected)
    worst = np.argmax(off / case.bounds) if len(off) else 0
    return f"off by {off[worst]:.1e} s, allowed {case.bounds[worst]:.1e} s" if (off > case.bounds).any() else ""


def times_of(case, way):
    """Instants found by a single run, an open run advanced in parts, or the last of three equal runs of an ensemble."""
    if way == "ensemble":
        times = {} if "step" in case.options else {"t_eval": np.linspace(0, case.end, 7)}     # else runs are made individually
        ens = zd.ensemble(case.system, case.end, v0=np.tile(case.system.v0, (3, 1)), events=case.event, threads=1,
                          **times, **case.options)
        assert not ens.failed.any(), ens.messages
        return ens.t_events[2][0]
    if way == "single":
        return zd.simulate(case.system, case.end, events=case.event, **case.options).t_events[0]
    run = zd.Run(case.system, events=case.event, record=True, **case.options)
    for part in (0.3, 0.7, 1.0):
        if run.event is None:
            run.advance_to(part * case.end)
    return run.solution().t_events[0]
