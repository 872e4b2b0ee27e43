"""One-sided constraints of systems of one's own, against mechanisms and closed forms."""

import pickle

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from native_systems import needs_compiler

G = 9.81
FINE = {"rtol": 1e-10, "atol": 1e-12}


def mechanism():
    m = zd.Mechanism("ball", gravity=(0, -G))
    ball = m.particle("ball", 2.0, at=(0, 1))
    m.contact("floor", ball, m.ground.line((0, 0), (1, 0)), restitution=0.5, friction=(0.4, 0.3))
    m.start({ball.velocity: (2.0, 0.0)})
    return m


def symbolic():
    x, y, vx, vy, g = sp.symbols("x y vx vy g")
    return zd.symbolic([x, y], speeds=[vx, vy], kinetic=vx**2 + vy**2, potential=2 * g * y, parameters={g: G}, p0=[0, 1],
                       v0=[2, 0], one_sided={"floor": zd.OneSided(y, restitution=0.5, slip=vx, friction=(0.4, 0.3))})


def numeric():
    return zd.System(["x", "y"], mass=2 * np.eye(2), force=lambda g: np.array([0, -2 * g]), potential=lambda p, g: 2 * g * p[1],
                     parameters={"g": G}, p0=[0, 1], v0=[2, 0], one_sided={"floor": zd.OneSided(
                         lambda p: p[1], restitution=0.5, slip=lambda: np.array([1.0, 0.0]), friction=(0.4, 0.3))})


@pytest.fixture(params=[pytest.param(symbolic, marks=needs_compiler), numeric], ids=["symbolic", "System"], scope="module")
def ball(request):
    return request.param()


@pytest.mark.parametrize("settings", [FINE, {"step": 0.01}], ids=str)
def test_a_ball_moves_as_that_of_a_mechanism(ball, settings):
    expected, found = zd.simulate(mechanism(), 2.0, **settings), zd.simulate(ball, 2.0, **settings)
    assert found.p[-1] == pytest.approx(expected.p[-1], abs=1e-12)
    assert [str(phase) for phase in found.phases] == [str(phase) for phase in expected.phases]
    assert found.impacts["energy_lost"] == pytest.approx(expected.impacts["energy_lost"])
    assert -found["floor"][-1] == pytest.approx(2 * G)


def test_copies_equilibria_and_ensembles(ball):
    run = zd.Run(ball, step=0.01)
    run.step(80)
    twin = run.copy()
    run.step(60)
    twin.step(60)
    assert (run.p == twin.p).all()
    eq = zd.equilibrium(ball)
    assert eq.phase == zd.linearize(ball, eq).phase == {"floor": "sticking"}
    runs = zd.ensemble(ball, 1.0, parameters={"g": [5.0, G]}, step=0.01)
    assert (runs[1].p == zd.simulate(ball, 1.0, step=0.01).p).all()
    assert runs[0].impacts["t"][0] == pytest.approx(np.sqrt(2 / 5.0))


def pressed(kind):
    """A body on a floor, pressed with 10 N/s and pulled with 3 N/s."""
    if kind is symbolic:
        x, y, vx, vy, t = sp.symbols("x y vx vy t")
        return zd.symbolic([x, y], speeds=[vx, vy], kinetic=vx**2 + vy**2, potential=2 * G * y, p0=[0, 0], v0=[0, 0],
                           force=[3 * t, -10 * t], one_sided={"floor": zd.OneSided(y, slip=vx, friction=(0.4, 0.3))})
    return zd.System(["x", "y"], mass=2 * np.eye(2), force=lambda t: np.array([3 * t, -2 * G - 10 * t]), p0=[0, 0],
                     one_sided={"floor": zd.OneSided(lambda p: p[1], slip=lambda: np.array([1.0, 0.0]), friction=(0.4, 0.3))})


@pytest.mark.parametrize("settings", [FINE, {"step": 0.01}], ids=str)
@pytest.mark.parametrize("kind", [pytest.param(symbolic, marks=needs_compiler), numeric])
def test_events_read_reactions(kind, settings):
    """By name, in expressions and in functions: 2 g + 10 t reaches 25 N, and 3 t reaches 1 N."""
    events = [zd.Event("floor", value=-25.0), zd.Event(sp.Symbol("floor") + 25), zd.Event(lambda n: n + 25, of={"n": "floor"}),
              zd.Event("floor.slip", value=1.0)]
    sol = zd.simulate(pressed(kind), 1.0, events=events, **settings)
    for times, expected in zip(sol.t_events, [*3 * [0.538], 1 / 3], strict=True):
        assert times == pytest.approx([expected], abs=1e-13)


def test_an_event_finds_the_force_that_a_landing_brings(ball):
    """It jumps from 0 to its impulse, and after the last bounce to 2 g."""
    sol = zd.simulate(ball, 2.0, step=0.01, events=[zd.Event("floor", value=-10.0)])
    lands = next(phase.t0 for phase in sol.phases if phase.state["floor"] != "open")
    assert sol.t_events[0] == pytest.approx([lands], abs=1e-12)


@needs_compiler
def test_a_symbolic_system_is_pickled_with_its_groups():
    one = symbolic()
    other = pickle.loads(pickle.dumps(one))
    assert (zd.simulate(other, 1.0, step=0.01).p == zd.simulate(one, 1.0, step=0.01).p).all()
    assert "switching     floor" in str(other)
    assert "freedom       2" in str(other)


def test_gaps_stand_beside_constraints_and_follow_time():
    """A pendulum of length 1 in Cartesian coordinates against a wall that moves away with 0.1 m/s, hit without loss."""
    system = zd.System(
        ["x", "y"], mass=np.eye(2), force=lambda: np.array([0, -G]), constraints=lambda p: np.array([p @ p - 1]) / 2,
        p0=[1, 0], one_sided={"wall": zd.OneSided(lambda t, p: p[0] + 0.1 * t, restitution=1.0)})
    sol = zd.simulate(system, 2.0, **FINE)
    t = sol.impacts["t"][0]
    before, after = sol.v[sol.t == t][[0, -1]]
    p = sol.at(t).p
    assert p[0] == pytest.approx(-0.1 * t, abs=1e-10)
    assert p @ after == pytest.approx(0, abs=1e-9)
    assert after[0] + 0.1 == pytest.approx(-(before[0] + 0.1), rel=1e-9)


def with_speed(one_sided):
    x, vx = sp.symbols("x vx")
    return zd.symbolic([x], speeds=[vx], kinetic=vx**2, p0=[1], one_sided=one_sided(x, vx))


def test_wrong_arguments_are_named():
    for make, said in [(lambda: zd.OneSided(0, restitution=2), "restitution"), (lambda: zd.OneSided(0, friction=0.3), "slip"),
                       (lambda: zd.OneSided(0, slip=0, friction=(0.2, 0.3)), "static"),
                       (lambda: zd.System(1, mass=[[1.0]], one_sided={"a": 1}), "one_sided"),
                       (lambda: zd.System(1, mass=[[1.0]], one_sided={"a": zd.OneSided(1.0)}), "callables"),
                       (lambda: zd.System(1, mass=[[1.0]], jacobian=lambda p: p, constraints=lambda p: p,
                                          one_sided={"a": zd.OneSided(lambda p: p[0])}), "jacobian"),
                       (lambda: zd.System(["x"], mass=[[1.0]], one_sided={"x": zd.OneSided(lambda p: p[0])}), "has 'x'"),
                       (lambda: with_speed(lambda x, _: {"vx": zd.OneSided(x)}), "has 'vx'"),
                       (lambda: with_speed(lambda x, vx: {"a": zd.OneSided(x, slip=vx), "a.slip": zd.OneSided(x)}), "a.slip"),
                       (lambda: with_speed(lambda x, vx: {"a": zd.OneSided(x, slip=vx**2)}), "'a.slip' must be linear")]:
        with pytest.raises((ValueError, TypeError), match=said):
            make()
