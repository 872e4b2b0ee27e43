"""Forces against a body and against a point: two free bodies by Newton's and Euler's equations in SciPy."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import zerodrift as zd
from support import refused

MASS, INERTIA, END = np.array([2.0, 1.0]), np.array([[0.5, 0.7, 0.6], [0.2, 0.3, 0.25]]), 0.7
AT, SPEED, TURN = np.array([[0.1, 0.2, 0.0], [1.1, -0.2, 0.0]]), np.array([[0.2, 0.1, 0.0], [-0.1, 0.3, 0.0]]), (0.4, -0.8)
P, Q, ALONG = np.array([-0.2, 0.3, 0.0]), np.array([0.1, 0.25, 0.0]), np.array([0.6, 0.8, 0.0])
OUT = np.array([0.0, 0.0, 1.0])      # of the plane, in which mechanisms in space leave it
WAYS = [("body", None), ("body", "a"), ("point", None), ("point", "a"), ("point", "b"), ("point", "c")]


def law(t, x):
    return 3 * np.cos(2 * t) - 4 * x


def mechanism(dimension, against, frame):
    """Bodies a and b, and a third that only carries axes."""
    m, lift = zd.Mechanism("two", dimension=dimension), (0.3 * OUT if dimension == 3 else 0 * OUT)[:dimension]
    bodies = [m.body(name, MASS[i], INERTIA[i] if dimension == 3 else INERTIA[i, 2], at=AT[i, :dimension]) for i, name in
              enumerate("ab")]
    m.body("c", 1.0, (1.0, 1.0, 1.0) if dimension == 3 else 1.0, at=(3, 3, 0)[:dimension])
    m.force("f", bodies[1].point(Q[:dimension] + lift), along=ALONG[:dimension] + lift, value=law, of={"x": "b.position.x"},
            frame=frame, against=bodies[0] if against == "body" else bodies[0].point(P[:dimension] - lift))
    turns = {"ab"[i]: TURN[i] for i in range(2)} | {"c": 1.5}
    m.start({f"{name}.angular_velocity{'.z' * (dimension == 3)}": turn for name, turn in turns.items()})
    m.start({f"{'ab'[i]}.velocity": SPEED[i, :dimension] for i in range(2)})
    return m


def plain(dimension, against, frame):
    """Positions and velocities of a and b at the end."""
    lift = 0.3 * OUT if dimension == 3 else 0 * OUT
    along = (ALONG + lift) / np.linalg.norm(ALONG + lift)

    def rates(t, y):
        r, u, v, w = (y[at:at + 6].reshape(2, 3) for at in (0, 6, 12, 18))
        R = [Rotation.from_rotvec(each) for each in u]
        axes = {None: Rotation.identity(), "a": R[0], "b": R[1], "c": Rotation.from_rotvec([0, 0, 1.5 * t])}[frame]
        F = law(t, r[1, 0]) * axes.apply(along)
        place = r[1] + R[1].apply(Q + lift)
        other = place if against == "body" else r[0] + R[0].apply(P - lift)
        moment = np.stack([R[0].inv().apply(np.cross(other - r[0], -F)), R[1].inv().apply(np.cross(place - r[1], F))])
        turning = (moment - np.cross(w, INERTIA * w)) / INERTIA
        udot = []
        for each, spin in zip(u, w, strict=True):     # of the rotation vector, by the spin in body axes
            angle = np.linalg.norm(each)
            c = 1 / 12 if angle < 1e-4 else (1 - angle / 2 / np.tan(angle / 2)) / angle**2
            udot.append(spin + np.cross(each, spin) / 2 + c * np.cross(each, np.cross(each, spin)))
        return np.concatenate([np.ravel(each) for each in (v, udot, [-F, F] / MASS[:, None], turning)])

    spin = np.outer(TURN, OUT)
    y = np.concatenate([np.ravel(each) for each in (AT, 0 * AT, SPEED, spin)])
    end = solve_ivp(rates, (0, END), y, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    return end[:6].reshape(2, 3)[:, :dimension], end[12:18].reshape(2, 3)[:, :dimension]


@pytest.mark.parametrize("closed_form", [None, False])
@pytest.mark.parametrize(("against", "frame"), WAYS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_two_bodies_move_as_newton_and_euler_say(dimension, against, frame, closed_form):
    m = mechanism(dimension, against, frame)
    sol = zd.simulate(m, END, rtol=1e-12, atol=1e-13, closed_form=closed_form)
    at, speed = plain(dimension, against, frame)
    for i, name in enumerate("ab"):
        assert sol[f"{name}.position"][-1] == pytest.approx(at[i], abs=1e-10)
        assert sol[f"{name}.velocity"][-1] == pytest.approx(speed[i], abs=1e-10)
    assert sol["f.force"] == pytest.approx(law(sol.t, sol["b.position.x"]), rel=1e-12)


@pytest.mark.parametrize(("against", "frame"), WAYS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_they_are_saved_and_read_again(dimension, against, frame, tmp_path):
    m = mechanism(dimension, against, frame)
    one, other = (each.system("absolute")._measuring.tables for each in (m, zd.load(m.save(tmp_path / "m"))))
    assert one.quantities == other.quantities


def test_a_restoring_law_in_the_axes_of_the_drawing_and_in_those_of_a_body():
    """Springs along the axes of a heavy body that turns, and along the drawing's: a Cartesian spring pulls back."""
    for frame in (None, "base"):
        m = zd.Mechanism("tied")
        base, load = m.body("base", 1e9, 1e9), m.body("load", 1.0, 0.1, at=(0.2, 0.0))
        m.force("tie", load, along=(1, 0), value=lambda a, b: -50.0 * (b - a), against=base, frame=frame,
                of={"a": base.position.x, "b": load.position.x})
        sol = zd.simulate(m, 0.1, rtol=1e-10)
        assert sol["load.position.x"][-1] == pytest.approx(0.2 * np.cos(np.sqrt(50) * 0.1), abs=1e-8)


def test_the_moment_of_a_pair_is_named():
    m = mechanism(2, "point", None)
    apart = AT[1] + Q - AT[0] - P
    assert f"force f is a pair at two points, with a free moment: value times {abs(np.cross(apart, ALONG)[2]):.3g} m" in str(m)
    assert "free moment" not in str(mechanism(2, "body", None))


def test_against_the_ground_is_against_nothing():
    for against in (None, "ground"):
        m = zd.Mechanism("alone")
        m.force("f", m.body("a", 1.0, 0.1), along=(1, 0), value=1.0, against=against)
        assert m["f"].against is None


def test_a_spring_to_a_whole_body_is_at_its_centre_of_mass():
    m = zd.Mechanism("hung")
    body = m.body("body", 1.0, 0.1, at=(0.5, 0), com=(0.1, 0.2))
    spring = m.spring("spring", m.ground.point((0, 0)), body, stiffness=2.0)
    assert spring.second.drawn == pytest.approx([0.6, 0.2])


def test_what_is_wrong_is_refused():
    m = mechanism(2, "body", None)
    with refused("wrong-element", "'b' and against it"):
        m.force("g", m["b"], along=(1, 0), value=1.0, against="b")
    with refused("conflicting-arguments", "must be 'a'"):
        m.force("g", m["b"], along=(1, 0), value=1.0, against="a", frame="c")
