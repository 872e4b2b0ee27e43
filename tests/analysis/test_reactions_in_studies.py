"""Studies of mechanisms with user functions that read reactions, against a pendulum whose equation is solved by hand."""

import numpy as np
import pytest

import zerodrift as zd

MASS, C, G = 1.3, 0.5, 9.81
INERTIA = MASS / 3
A0, W0 = 0.7, 1.3


def arm(bias=0.0, layout="joint"):
    """A rod on a pin, with a torque that is smooth in the pin's force."""
    m = zd.Mechanism("arm", gravity=(0, -G))
    link = m.link("link", (0, 0), (1, 0), mass=MASS)
    pin = m.revolute("pin", m.ground, link.start)
    m.motor("drive", pin, torque=lambda x, y, w: bias + torque(x, y, w), of={"x": "pin.force.x", "y": "pin.force.y",
                                                                             "w": "pin.speed"})
    return m.system(layout)


def torque(x, y, w):
    return -0.03 * x - 0.05 * w * np.sqrt(1 + x * x + y * y)


def force(a, w, wdot):
    s, c = np.sin(a), np.cos(a)
    return -MASS * C * (w * w * c + wdot * s), MASS * (G + C * (wdot * c - w * w * s))


def acceleration(a, w, added=0.0):
    """Angular acceleration, by bisection."""
    def left(wdot):
        return INERTIA * wdot + MASS * G * C * np.cos(a) - added - torque(*force(a, w, wdot), w)

    low, high = -1e3, 1e3
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if left(middle) < 0 else (low, middle)
    return low


def slope(function, h=1e-3):
    """Derivative at 0, of sixth order."""
    return sum(c * (function(k * h) - function(-k * h)) for k, c in ((1, 3 / 4), (2, -3 / 20), (3, 1 / 60))) / h


def test_linearization_contains_what_is_read():
    system = arm()
    lin = zd.linearize(system, at=(0.0, [A0], [W0]), inputs=["pin.torque"], outputs=["pin.force.x", "drive.torque"])
    of = [slope(lambda h: acceleration(A0 + h, W0)), slope(lambda h: acceleration(A0, W0 + h)),
          slope(lambda h: acceleration(A0, W0, h))]
    assert np.allclose(lin.A, [[0, 1], of[:2]], rtol=1e-8, atol=1e-12)
    unit = np.sqrt(INERTIA)         # of the coordinates of the tangent space
    assert np.allclose(lin.B, [[0], [of[2] * unit]], rtol=1e-8, atol=1e-12)

    def outputs(a, w, added=0.0):
        read = force(a, w, acceleration(a, w, added))
        return read[0], torque(*read, w)

    for i in range(2):
        rows = [slope(lambda h, i=i: outputs(A0 + h, W0)[i]), slope(lambda h, i=i: outputs(A0, W0 + h)[i])]
        assert lin.C[i] * unit == pytest.approx(rows, rel=1e-8)
        assert lin.D[i, 0] == pytest.approx(slope(lambda h, i=i: outputs(A0, W0, h)[i]), rel=1e-8)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_efforts_of_a_motion_contain_the_friction_that_its_reactions_cause(layout):
    system, wdot = arm(layout=layout), 2.5
    x, y = C * np.cos(A0), C * np.sin(A0)
    p, v, vdot = ([A0], [W0], [wdot]) if layout == "joint" else (
        [x, y, A0], [-y * W0, x * W0, W0], [-y * wdot - x * W0**2, x * wdot - y * W0**2, wdot])
    expected = INERTIA * wdot + MASS * G * C * np.cos(A0) - torque(*force(A0, W0, wdot), W0)
    found = zd.inverse_dynamics(system, 0.0, p, v, vdot, efforts=["pin.angle"])
    assert found["pin.angle"] == pytest.approx([expected], rel=1e-10)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_an_equilibrium_and_its_eigenvalues(layout):
    system = arm(bias=0.9, layout=layout)
    eq = zd.equilibrium(system)
    assert -MASS * G * C * np.cos(eq["pin.angle"]) + 0.9 == pytest.approx(0, abs=1e-10)
    a = eq["pin.angle"]
    coefficients = [1, -slope(lambda h: acceleration(a, h, 0.9)), -slope(lambda h: acceleration(a + h, 0, 0.9))]
    assert np.sort_complex(zd.linearize(system, at=eq).eigenvalues) == pytest.approx(np.sort_complex(np.roots(coefficients)),
                                                                                   rel=1e-8)


def test_acceleration_check_and_reference():
    system = arm()
    vdot, _ = zd.acceleration(system, [A0], [W0])
    assert vdot == pytest.approx([acceleration(A0, W0)], rel=1e-12)
    assert zd.check(system, [A0], [W0])


def test_ensembles_have_the_bits_of_single_runs():
    system, starts = arm(), [[0.0], [0.4], [1.0]]
    found = zd.ensemble(system, 0.2, p0=starts, v0=[[0.0]] * 3, step=0.01)
    for i, start in enumerate(starts):
        assert np.array_equal(found[i].p, zd.simulate(system, 0.2, p0=start, v0=[0.0], step=0.01).p)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_linearization_in_space(layout):
    """Orientations of absolute coordinates are quaternions; the plane has none."""
    def hanging(dimension):
        m = zd.Mechanism("arm", dimension=dimension, gravity=(0, -G, 0)[:dimension])
        link = m.link("link", (0, 0, 0)[:dimension], (0, -1, 0)[:dimension], mass=MASS)
        pin = m.revolute("pin", m.ground, link.start, **({"axis": (0, 0, 1)} if dimension == 3 else {}))
        m.motor("drive", pin, torque=lambda y, w: -0.05 * w * y, of={"y": "pin.force.y", "w": "pin.speed"})
        return m

    plane, space = (zd.linearize(m).eigenvalues for m in (hanging(2), hanging(3).system(layout)))
    assert np.allclose(np.sort_complex(space), np.sort_complex(plane), rtol=1e-3)      # a link in space has a thickness


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_run_reads_reactions_that_no_law_reads(layout):
    """The reaction on a shaft contains the torque of its motor, whose law reads another reaction."""
    m = zd.Mechanism("two arms", gravity=(0, -G))
    first, second = m.link("first", (0, 0), (1, 0), mass=2.0), m.link("second", (1, 0), (1.5, 0), mass=1.0)
    root = m.revolute("root", m.ground, first.start)
    m.revolute("elbow", first.end, second.start)
    m.motor("drive", root, torque=lambda f: -0.1 * f, of={"f": "elbow.force.y"})
    system = m.system(layout)
    names = ["root.force.x", "root.force.y", "elbow.force.y", "drive.torque"]
    run, runs = zd.Run(system, step=1e-3), zd.ManyRuns(system, runs=3, step=1e-3)
    run.step(3)
    runs.step(3)
    sol = zd.simulate(system, 3e-3, step=1e-3, outputs=names)
    assert np.allclose([run[name] for name in names], [sol[name][-1] for name in names], rtol=1e-12)
    assert np.allclose(runs["root.force.y"], run["root.force.y"], rtol=1e-12)
    assert np.allclose(sol["drive.torque"], -0.1 * sol["elbow.force.y"], rtol=1e-12)
