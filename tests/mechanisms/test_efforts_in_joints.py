"""Forces and torques of joints contain what acts in them along their coordinates, by one rule: I alpha is the torque."""

import numpy as np
import pytest

import zerodrift as zd
from support import assert_close

INERTIA, SPEED = 2.0, 1.5
WITHIN = {"motor": (3.0, lambda m, pin: m.motor("of", pin, torque=3.0)),
          "law": (-4.0 * SPEED, lambda m, pin: m.motor("of", pin, torque=lambda w: -4.0 * w, of={"w": pin.speed})),
          "spring": (0.8, lambda m, pin: m.torsion_spring("of", pin, stiffness=2.0, angle=0.4)),
          "damper": (-0.5 * SPEED, lambda m, pin: m.torsion_spring("of", pin, stiffness=0.0, damping=0.5)),
          "prescribed": (INERTIA * 0.7, lambda m, pin: m.motor("of", pin, angle=lambda t: SPEED * t + 0.35 * t * t))}
SPACES = {"plane": 2, "space": 3}


def wheel(space, **more):
    """A wheel on the ground, at rest as drawn, or turning at SPEED about z."""
    m = zd.Mechanism("wheel", dimension=SPACES[space])
    zero = (0.0,) * m.dimension
    body = m.body("wheel", 1.0, INERTIA if m.dimension == 2 else (INERTIA,) * 3)
    axis = {} if m.dimension == 2 else {"axis": (0, 0, 1)}
    return m, m.revolute("pin", m.ground, body.point(zero), **axis, **more)


def about_z(torque):
    return np.asarray(torque)[..., -1] if np.ndim(torque) > 0 and np.shape(torque)[-1] == 3 else np.asarray(torque)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("kind", [*WITHIN, "damping"])
def test_the_torque_of_a_hinge_has_what_acts_in_it(kind, space, layout):
    m, pin = wheel(space, **({"damping": 0.5} if kind == "damping" else {}))
    torque, add = WITHIN.get(kind, (-0.5 * SPEED, lambda m, pin: None))
    add(m, pin)
    if kind != "prescribed":
        m.start({"pin.speed": SPEED})
    now = zd.Instant(m.system(layout))
    assert_close(about_z(now["pin.torque"]), torque, 1e-12)
    assert_close(now["pin.acceleration"], torque / INERTIA, 1e-12)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("space", SPACES)
def test_so_do_inverse_dynamics_and_equilibria_that_are_held(space, layout):
    m, pin = wheel(space)
    m.torsion_spring("coil", pin, stiffness=2.0, angle=0.35)
    system, t = m.system(layout), np.linspace(0.0, 1.0, 5)
    kin = zd.kinematics(system, {"pin.angle": lambda t: 0.35 * t * t}, t)
    found = zd.inverse_dynamics(system, kin, efforts=["pin.angle"])
    assert_close(found["pin.angle"], INERTIA * 0.7 + 2.0 * (0.35 * t * t - 0.35), 1e-9)
    assert_close(about_z(found["pin.torque"]), np.full(5, INERTIA * 0.7), 1e-9)
    held = zd.equilibrium(m.system(layout), hold=["pin.angle"])
    assert_close(held.effort["pin.angle"], -0.7, 1e-9)
    assert_close(about_z(held["pin.torque"]), 0.0, 1e-9, scale=1.0)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("space", SPACES)
def test_laws_read_it(space, layout):
    """Friction that is a tenth of the torque of another hinge, in which a spring of 0.8 N m acts."""
    m, pin = wheel(space)
    WITHIN["spring"][1](m, pin)
    zero = (0.0,) * m.dimension
    other = m.body("other", 1.0, INERTIA if m.dimension == 2 else (INERTIA,) * 3)
    second = m.revolute("second", m.ground, other.point(zero), **({} if m.dimension == 2 else {"axis": (0, 0, 1)}))
    m.motor("drag", second, torque=lambda T: 0.1 * T, of={"T": pin.torque if m.dimension == 2 else pin.torque.z})
    assert_close(zd.Instant(m.system(layout))["second.acceleration"], 0.08 / INERTIA, 1e-12)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("space", SPACES)
def test_the_moment_on_either_side_of_a_guide(space, layout, turned):
    """A body slides down a tilted guide, its mass centre off it: the guide carries the weight across, at the mass centre."""
    tilt, g, off = 0.6, 9.81, np.array([2.0, 0.0, 0.0])
    axis = np.array([0.0, np.cos(tilt), np.sin(tilt)]) if space == "space" else np.array([np.cos(tilt), np.sin(tilt), 0.0])
    weight = np.array([0.0, 0.0, -g]) if space == "space" else np.array([0.0, -g, 0.0])
    off = off if space == "space" else 2.0 * np.array([1.0, 1.0, 0.0])
    n = SPACES[space]
    m = zd.Mechanism("guide", dimension=n, gravity=tuple(weight[:n]))
    body = m.body("body", 1.0, 0.1 if n == 2 else (0.1, 0.1, 0.1), at=tuple(off[:n]))
    sides = (body, m.ground) if turned else (m.ground, body)
    guide = m.prismatic("guide", *sides, at=(0.0,) * n, axis=tuple(axis[:n]))
    sol = zd.simulate(m.system(layout), 2.0, step=0.01)
    across, slid = weight - weight @ axis * axis, weight @ axis * 2.0 * axis        # a t^2 / 2 at t = 2 s
    on_ground, on_body = np.cross(slid + off, across), np.cross(off, -across)
    expected = {"torque": on_ground, "first_torque": on_body} if turned else {"torque": on_body, "first_torque": on_ground}
    for name, value in expected.items():
        assert_close(sol[f"guide.{name}"][-1], value if n == 3 else value[2], 1e-9, scale=10.0)
    assert f"guide.{guide.first_torque.name.partition('.')[2]}" in m.measures
