"""Masses, stiffnesses and gravity that depend on time: refused, with forces that do the same, which are tried here."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import zerodrift as zd
from support import assert_close, refused


def hung(**given):
    m = zd.Mechanism("hung")
    m.spring("k", m.ground.point((0, 0)), m.particle("mass", 2.0, at=(0, -1)), **given)
    return m


@pytest.mark.parametrize("given", [lambda t: 5 + t, sp.Symbol("t"), zd.table([0.0, 1.0, 2.0, 3.0], [1.0, 2.0, 2.0, 1.0])],
                         ids=["function", "expression", "table"])
def test_they_are_refused_with_what_to_take(given):
    m = zd.Mechanism("none")
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, link.start)
    for call, hint in ((lambda: hung(stiffness=given), "force= of a spring"),
                       (lambda: m.torsion_spring("k", pin, stiffness=given), "torque="),
                       (lambda: hung(stiffness=5.0, damping=given), "lambda speed"),
                       (lambda: m.bushing("b", m.ground, link, at=(0, 0), stiffness=(1.0, given)), "stiffness of 'b'"),
                       (lambda: zd.Mechanism("g", gravity=(0, given)), r"force\(\)"),
                       (lambda: m.particle("p", given, at=(0, 0)), "acceleration"),
                       (lambda: m.body("p", given, 1.0), "acceleration")):
        with refused("wrong-type", f"must be a number, not a function: .*{hint}" if "'" not in hint else hint):
            call()


def test_a_stiffness_that_changes():
    """The spring of a swing, k(t) = 50 + 20 sin 3 t: its work is what the balance of energy counts."""
    m = hung(force=lambda t, length: (50 + 20 * np.sin(3 * t)) * (length - 0.8))
    m.force("weight", m["mass"], along=(0, -1), value=lambda t: 2.0 * (9.81 + np.cos(t)))
    sol = zd.simulate(m, 2.0, rtol=1e-11, atol=1e-12, t_eval=np.linspace(0, 2, 21))
    known = solve_ivp(lambda t, y: [y[1], (50 + 20 * np.sin(3 * t)) * (-y[0] - 0.8) / 2 - 9.81 - np.cos(t)], (0, 2), [-1.0, 0.0],
                      rtol=1e-12, atol=1e-13, t_eval=sol.t)
    assert_close(sol["mass.position.y"], known.y[0], 1e-9, scale=1.0)
    assert np.abs(sol.energy_violation).max() < 1e-9


def test_a_rocket_that_burns():
    """Its speed is that of Tsiolkovsky, u ln(m0 / m) - g t, with thrust u dm/dt."""
    m = zd.Mechanism("rocket", gravity=(0, -9.81))
    rocket = m.particle("rocket", 2.0, at=(0, 0))
    m.force("less", rocket, along=(0, 1), value=lambda t, a: 0.5 * t * a, of={"a": rocket.acceleration.y})
    m.force("weight", rocket, along=(0, 1), value=lambda t: 0.5 * t * 9.81)
    m.force("thrust", rocket, along=(0, 1), value=0.5 * 60.0)
    sol = zd.simulate(m, 3.0, rtol=1e-10, atol=1e-10)
    assert_close(sol["rocket.velocity.y"], 60.0 * np.log(2.0 / (2.0 - 0.5 * sol.t)) - 9.81 * sol.t, 1e-8, scale=1.0)
