"""Wheels that roll in and around rings, by Lagrange's equations in SciPy."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import zerodrift as zd
from support import refused

MASS, INERTIA, HEAVY, G, END = 1.5, 0.02, 0.3, 9.81, 1.2
START = 0.6         # rad: of the line of centres from its lowest place, or from its highest


def scene(dimension, layout, radius, ring, is_outside, is_free):
    """A wheel drawn beside the lowest place in the ring, or the highest one on it; the ring is fixed, or hinged at its centre."""
    m = zd.Mechanism("ring", dimension=dimension, gravity=(0, -G, 0)[:dimension])
    axis = {} if dimension == 2 else {"axis": (0, 0, 1)}
    length, sign = (ring + radius, 1.0) if is_outside else (abs(ring - radius), -1.0)
    centre = np.array([0.2, 0.1, 0.0])
    at = centre + length * np.array([np.sin(START), sign * np.cos(START), 0])
    wheel = m.body("wheel", MASS, INERTIA if dimension == 2 else (INERTIA,) * 3, at=at[:dimension])
    base = m.ground
    if is_free:
        base = m.body("base", 2.0, HEAVY if dimension == 2 else (HEAVY,) * 3, at=centre[:dimension])
        m.revolute("bearing", m.ground, base, at=centre[:dimension], **axis)
    axle = {} if dimension == 2 else {"axle": (0, 0, 1)}
    m.rolling("roll", base, wheel, radius=radius, ring=ring, at=centre[:dimension], **axle)
    return m.system(layout)


def lagrange(radius, ring, is_outside, is_free):
    """Angles of the line of centres, since the start, and of the ring at the end, counter-clockwise, (phi, alpha).

    The wheel turns by theta' = (ring alpha' - (ring - radius) phi') / radius in a ring, and by the opposite sign of the ring's
    and the sum of the radii around it.
    """
    length = ring + radius if is_outside else abs(ring - radius)
    by = np.array([ring + radius, -ring]) / radius if is_outside else np.array([-(ring - radius), ring]) / radius
    M = INERTIA * np.outer(by, by) + np.diag([MASS * length**2, HEAVY])

    def rates(t, y):
        weight = MASS * G * length * (np.sin(START - y[0]) if is_outside else -np.sin(START + y[0]))
        Q = np.array([-weight if is_outside else weight, 0.0])
        return [*y[2:], *(np.linalg.solve(M, Q) if is_free else [Q[0] / M[0, 0], 0])]

    return solve_ivp(rates, (0, END), [0, 0, 0, 0], method="DOP853", rtol=1e-12, atol=1e-13).y[:2, -1]


@pytest.mark.parametrize("is_free", [False, True])
@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(("radius", "ring", "is_outside"), [(0.3, 1.0, False), (0.3, 1.0, True), (0.7, 0.2, False)])
def test_a_wheel_on_a_ring_moves_as_lagrange_says(dimension, layout, radius, ring, is_outside, is_free):
    system = scene(dimension, layout, radius, ring, is_outside, is_free)
    sol = zd.simulate(system, END, rtol=1e-11, atol=1e-12)
    phi, alpha = lagrange(radius, ring, is_outside, is_free)
    length, sign = (ring + radius, 1.0) if is_outside else (abs(ring - radius), -1.0)
    drawn = np.array([np.sin(START), sign * np.cos(START)])
    turn = np.array([[np.cos(phi), -np.sin(phi)], [np.sin(phi), np.cos(phi)]])
    assert sol["wheel.position"][-1][:2] == pytest.approx([0.2, 0.1] + length * turn @ drawn, abs=1e-7)
    if is_free:
        assert sol["bearing.angle"][-1] == pytest.approx(alpha, abs=1e-7)


def test_its_force_is_that_of_the_contact():
    """A wheel at rest at the lowest place of a ring carries its weight, positive on the wheel, and nothing slips it."""
    m = zd.Mechanism("rest", gravity=(0, -G))
    roll = m.rolling("roll", m.ground, m.body("wheel", MASS, INERTIA, at=(0, -0.7)), radius=0.3, ring=1.0)
    sol = zd.simulate(m, 0.01)
    assert sol[roll.force][0] == pytest.approx([0, MASS * G], abs=1e-9)


def test_what_does_not_touch_is_refused():
    m = zd.Mechanism("apart")
    wheel = m.body("wheel", 1.0, 0.1, at=(0.5, 0))
    with refused("geometry", "0.7 or 1.3 m"):
        m.rolling("roll", m.ground, wheel, radius=0.3, ring=1.0)
    with refused("conflicting-arguments", "ring"):
        m.rolling("roll", m.ground, wheel, radius=0.3, ring=1.0, normal=(0, 1))
    assert [body.name for body in m.bodies] == ["wheel"]
