"""Components of rotations in laws, constraints, events and measures: against Euler's equations by hand, and NumPy."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import zerodrift as zd
from support import assert_close, refused

J = np.array([1.0, 2.0, 2.5])


def top(**law):
    """A free body that turns, under a torque about the drawing's x axis."""
    m = zd.Mechanism("top", dimension=3)
    b = m.body("b", 1.0, J)
    m.start({"b.angular_velocity": (0.3, 1.0, -0.5)})
    if law:
        m.torque("T", b, axis=(1, 0, 0), **law)
    return m


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("law", [lambda c, s: -4 * c * s, -4 * sp.Symbol("c") * sp.Symbol("s")])
def test_a_torque_that_depends_on_the_orientation(layout, law):
    m = top()
    m.torque("T", m["b"], axis=(1, 0, 0), value=law, of={"c": "b.rotation.zy", "s": m["b"].rotation.xx})
    sol = zd.simulate(m.system(layout), 3.0, rtol=1e-11, atol=1e-12, t_eval=np.linspace(0, 3, 31))

    def rates(t, y):
        R, w = y[:9].reshape(3, 3), y[9:]       # w about the body's axes
        torque = R.T @ [-4 * R[2, 1] * R[0, 0], 0, 0]
        cross = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        return [*(R @ cross).ravel(), *((torque - np.cross(w, J * w)) / J)]

    known = solve_ivp(rates, (0, 3), [*np.eye(3).ravel(), 0.3, 1.0, -0.5], rtol=1e-12, atol=1e-13, t_eval=sol.t, method="DOP853")
    assert_close(sol["b.rotation"].reshape(-1, 9), known.y[:9].T, 1e-8, scale=1.0)
    assert_close(sol["b.rotation.zy"], known.y[7], 1e-8, scale=1.0)
    assert np.abs(sol.energy_violation).max() < 1e-8


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_constraint_keeps_an_axis_horizontal(layout):
    """The body's y axis stays in the plane of x and y; derivatives are those of differences."""
    m = top()
    m.constraint("level", lambda c: c, of={"c": "b.rotation.zy"})
    m.torque("push", m["b"], axis=(0, 0, 1), value=1.0)
    m.start({"b.angular_velocity": (0.0, 1.0, -0.5)})
    system = m.system(layout)
    sol = zd.simulate(system, 2.0, step=0.01)
    assert np.abs(sol["b.rotation.zy"]).max() < 1e-9
    assert np.abs(sol["b.rotation.zx"]).max() > 0.5
    assert np.abs(sol["level.torque"]).max() > 0
    p, v = sol.p[70], sol.v[70]
    terms, h = system.evaluate(p, v), 1e-6
    forth, back = (system.evaluate(p + s * h * terms.A @ v, v) for s in (1, -1))
    i = [each.name for each in system.constraints].index("level")
    assert_close((forth.Phi[i] - back.Phi[i]) / (2 * h), (terms.C @ v)[i], 1e-8, scale=1.0)
    assert_close(((forth.C - back.C) @ v / (2 * h))[i], -terms.xi[i], 1e-7, scale=1.0)


def test_events_outputs_and_measures_read_components():
    m = top()
    m.measure("tilt", lambda c: np.arccos(c), of={"c": "b.rotation.zz"}, unit="rad")
    event = zd.Event("b.rotation.zz", value=0.2, terminal=True)
    sol = zd.simulate(m, 20.0, rtol=1e-10, atol=1e-10, events=event, outputs=["b.rotation", "b.rotation.xy"])
    assert sol.t[-1] < 20.0
    assert_close(sol["b.rotation"][-1, 2, 2], 0.2, 1e-9, scale=1.0)
    for i, row in enumerate("xyz"):
        for j, column in enumerate("xyz"):
            assert np.array_equal(sol[f"b.rotation.{row}{column}"], sol["b.rotation"][:, i, j])
    assert_close(np.cos(sol["tilt"]), sol["b.rotation"][:, 2, 2], 1e-12, scale=1.0)
    assert sol.at(sol.t[3])["b.rotation.yx"] == sol["b.rotation.yx"][3]


@pytest.mark.parametrize("name", ["b.rotation", "b.rotation.x", "b.rotation.wx", "b.rotation.zy.x", "b.quaternion"])
def test_other_names_are_refused(name):
    with refused("wrong-measure", name):
        top(value=lambda c: c, of={"c": name})


def test_files_have_them(tmp_path):
    m = top(value=lambda c: -c, of={"c": "b.rotation.zy"})
    again, sol = (zd.simulate(each, 1.0, step=0.01) for each in (zd.load(m.save(tmp_path / "m")), m))
    assert_close(again.p, sol.p, 1e-13, scale=1.0)


def test_starts_hold_components():
    m = top()
    m.start({"b.rotation.zy": 0.5})
    assert_close(zd.simulate(m, 0.1, step=0.01)["b.rotation.zy"][0], 0.5, 1e-9, scale=1.0)
