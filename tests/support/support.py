"""Shared helpers of the tests: built-in systems and own ones in C, consistent states, the paper's equations, and comparisons."""

import contextlib
import functools
import os
import sys
from dataclasses import dataclass

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from native_systems import ROOT, own_systems  # noqa: F401  (ROOT: of tests)
from zerodrift._private import gateway
from zerodrift.explanations import codes
from zerodrift.runs.arguments.methods import evaluating_integrators

FORMULATIONS = list(zd.formulations())
INTEGRATORS = list(evaluating_integrators(zd.systems.four_bar()))   # and not those that need series, which few systems have


def environment_of_tests(**variables):
    """Environment of a process that can import what this one can, the package from the same place."""
    return os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))} | variables


def _instances():
    """Every built-in system as it comes, and with every word its choices allow."""
    for name, kind in gateway.kinds().items():
        yield name, getattr(zd.systems, name)()
        for parameter in (p for p in kind.parameters if p.rule == "choice"):
            for word in parameter.words[1:]:
                yield f"{name}-{word}", getattr(zd.systems, name)(**{parameter.name: word})


BUILT_IN, OWN = dict(_instances()), own_systems()
SYSTEMS = BUILT_IN | {name: system for name, system in OWN.items() if not system.quaternions}     # which steps normalize


@contextlib.contextmanager
def refused(code, match=None):
    """Like `pytest.raises`, for an error or warning of a code; `match` are numbers and names in its message, if any."""
    with pytest.raises(codes()[code][0], match=match) as caught:
        yield caught
    assert caught.value.code == code


@dataclass
class Numbers:
    """The terms at one (t, p, v), with zeros and the identity where the system has none."""

    A: np.ndarray
    M: np.ndarray
    force: np.ndarray   # f - d
    Phi: np.ndarray
    C: np.ndarray
    Phi_t: np.ndarray
    xi: np.ndarray
    V: float
    power: float


def numbers(system, t, p, v):
    """`system.evaluate`, filled up."""
    e = system.evaluate(p, v, t)

    def or_zeros(array, *shape):
        return np.zeros(shape) if array is None else array

    return Numbers(
        A=np.eye(system.nq) if e.A is None else e.A, M=e.M, force=or_zeros(e.f, system.nv) - or_zeros(e.d, system.nv),
        Phi=or_zeros(e.Phi, system.mh), C=or_zeros(e.C, system.m, system.nv), Phi_t=or_zeros(e.Phi_t, system.m),
        xi=or_zeros(e.xi, system.m), V=float(or_zeros(e.V)), power=float(or_zeros(e.power)))


def with_energy(system):
    if not system.has_energy:
        pytest.skip("declares no potential")
    return system


# ---- states ----


def flowed(system, t, p, w, steps=8):
    """P after moving with the velocity w for a second: a displacement that respects (1), quaternions included."""
    h, p = 1.0 / steps, np.array(p)
    if system.evaluate(p, w, t).A is None:
        return p + w

    def rate(p):
        return system.evaluate(p, w, t).A @ w

    for _ in range(steps):
        k1 = rate(p)
        k2 = rate(p + h / 2 * k1)
        k3 = rate(p + h / 2 * k2)
        p = p + h / 6 * (k1 + 2 * k2 + 2 * k3 + rate(p + h * k3))
    return p


def consistent_states(system, count=4, seed=2002):
    """Random (t, p, v) that satisfy the constraints."""
    rng, states = np.random.default_rng(seed), []
    for _ in range(20 * count):
        t = rng.uniform(0, 1)
        guess = flowed(system, t, system.p0, 0.4 * rng.normal(size=system.nv))
        try:
            p, v = zd.assemble(system, guess, system.v0 + rng.normal(size=system.nv), t=t)
        except zd.ZerodriftError:       # too far from any assembly
            continue
        states.append((t, p, v))
        if len(states) == count:
            return states
    raise AssertionError(f"no consistent states of {system.name} were found")


def violated_states(system, count=4, seed=2002):
    """Random (t, p, v) that do not, by about 1e-3."""
    rng = np.random.default_rng(seed)
    return [(t, flowed(system, t, p, 1e-3 * rng.normal(size=system.nv)), v + 1e-3 * rng.normal(size=system.nv))
            for t, p, v in consistent_states(system, count, seed)]


# ---- the paper's equations ----


def saddle_matrix(M, C):
    """The leading matrix of (8)."""
    m = len(C)
    return np.block([[M, C.T], [C, np.zeros((m, m))]])


def condition(M, C):
    """Condition of (8) with C scaled to the size of M, as the units of C are arbitrary."""
    scale = np.abs(M).max() / np.abs(C).max() if C.size else 1.0
    return np.linalg.cond(saddle_matrix(M, scale * C))


def solved(M, C, force, rhs):
    """Solve (8): x with M x + C^T lambda = force, C x = rhs; and lambda, with the sign of (7)."""
    both = np.linalg.solve(saddle_matrix(M, C), np.concatenate([force, rhs]))
    return both[:len(M)], both[len(M):]


def rate(system, t, y, alpha=0.0, beta=0.0):
    """(1) and (8) for y = (p, v), with (23) where gains are given."""
    p, v = np.split(y, [system.nq])
    e = numbers(system, t, p, v)
    xi = e.xi - alpha * (e.C @ v + e.Phi_t)
    xi[:system.mh] -= beta * e.Phi
    return np.concatenate([e.A @ v, solved(e.M, e.C, e.force, xi)[0]])


def along_manifold(C, nv):
    """D: the motions along the manifold, C D = 0."""
    return np.linalg.svd(C)[2][len(C):].T if len(C) else np.eye(nv)


def drawn_in(basis, rng):
    """Coordinates z (k,) of a random vector basis @ z, basis (n, k).

    It is drawn in all n coordinates and projected, since LAPACK decides signs and rotation of such a basis by the processor.
    """
    return np.linalg.lstsq(basis, rng.standard_normal(len(basis)), rcond=None)[0]


def allowed_velocity(V, M, rng):
    """Random velocities (nv,) in the space of V (nv, k), with a kinetic energy of about k / 2."""
    return V @ drawn_in(np.linalg.cholesky(M).T @ V, rng)


def difference(function, x, h=1e-3):
    """The derivative of a function of one number, by five points."""
    return (8 * (function(x + h) - function(x - h)) - (function(x + 2 * h) - function(x - 2 * h))) / (12 * h)


def along(function, *directed):
    """The derivative of function(x, ...) along directions: pairs (x, direction)."""
    return difference(lambda s: function(*(x + s * direction for x, direction in directed)), 0.0)


# ---- comparisons ----


def assert_close(actual, desired, tolerance, scale=0.0, what=""):
    """|actual - desired| <= tolerance * the largest of scale, |actual| and |desired|."""
    actual, desired = np.asarray(actual), np.asarray(desired)
    assert actual.shape == desired.shape
    size = max(scale, np.abs(desired).max(initial=0), np.abs(actual).max(initial=0))
    error = np.abs(actual - desired).max(initial=0)
    assert error <= tolerance * size, f"{what} off by {error:.3g}, of {size:.3g} (allowed: {tolerance:.1g})"


ROWS = ("t", "p", "v", "multipliers", "position_violation", "velocity_violation", "kinetic_energy", "potential_energy",
        "energy_input", "energy_violation", "iterations")


def assert_same_bits(one, other, rows=slice(None)):
    """Every array of two solutions, the first at `rows`."""
    for name in ROWS:
        a, b = getattr(one, name), getattr(other, name)
        assert (a is None) == (b is None), name
        assert a is None or name == "iterations" or a[rows].tobytes() == b.tobytes(), name


# ---- runs ----


def handed(**changed):
    """The core's own settings, right except what is changed; `correction` has the parameters of some by their names."""
    given = {"projection": {}} | changed.pop("correction", {})
    corrections = {name: [values.get(parameter.name, parameter.initial[0]) for parameter in zd.corrections()[name].parameters]
                   for name, values in given.items()}
    options = {"t1": 1.0, "step": 0.1, "rtol": 1e-6, "atol": 1e-9, "save_every": 1, "correction": corrections}
    return gateway.settings(options | changed)


def motion(system, t_end, steps, **options):
    """A run of a given number of steps."""
    return zd.simulate(system, t_end, step=t_end / steps, **options)


def observed_order(system, t_end=0.5, coarsest=10, refinements=8, **options):
    """From runs with ever half the step: the last that is not round-off. None where there is none."""
    order, states, before = None, None, None
    for k in range(refinements):
        run = motion(system, t_end, coarsest * 2**k, save_every=2**k, **options)
        now = np.hstack([run.p, run.v])
        if states is not None:
            difference = np.abs(now - states).max()
            if difference < tol.MEASURABLE * (1 + np.abs(now).max()):
                break
            order = None if before is None else np.log2(before / difference)
            before = difference
        states = now
    return order


def called(function):
    """The same user function, which cannot be recorded, so that Python is called."""
    @functools.wraps(function)
    def caller(*x, **named):
        with contextlib.nullcontext():
            return function(*x, **named)
    return caller


def relay(torque=2.0):
    """An arm in gravity, and two events at which its motor is switched."""
    m = zd.Mechanism("arm", gravity=(0, -9.81))
    link = m.link("arm", (0, 0), (1, 0), mass=3.0)
    m.motor("drive", m.revolute("pin", m.ground, link.start), torque=torque)
    m.start({"pin.angle": 0.0})
    return m, [zd.Event("pin.angle", value=-2.0, direction=-1, then={"drive.torque": 20.0}),
               zd.Event("pin.angle", value=-1.0, direction=1, then={"drive.torque": -1.0})]
