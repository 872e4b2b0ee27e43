"""Studies of mechanisms with user functions that read reactions, against a pendulum whose equation is solved by hand."""

import numpy as np
import pytest

import zerodrift as zd
from zerodrift.analysis import read_forces
from zerodrift.analysis.flow import Flow
from zerodrift.analysis.retraction import near_to
from zerodrift.analysis.state import state
from zerodrift.analysis.steady import with_speeds

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
def test_laws_that_are_zero_beside_them(layout):
    """A motor at rest, and a drag without a load, by inverse dynamics and held at rest."""
    m = zd.Mechanism("arm", gravity=(0, -G))
    link = m.link("link", (0, 0), (1, 0), mass=MASS)
    pin = m.revolute("pin", m.ground, link.start)
    m.force("drag", link.end, along=(0, 1), value=lambda r: -0.1 * r, of={"r": "pin.force.y"})
    m.force("side", link.end, along=(1, 0), value=lambda r: -0.1 * r, of={"r": "pin.force.x"})
    m.motor("drive", pin, torque=lambda t: 3 * t)
    system = m.system(layout)
    kin = zd.kinematics(system, {"pin.angle": lambda t: 0.0 * t}, [0.0, 1.0])
    found, load = zd.inverse_dynamics(system, kin), MASS * G / 0.9       # what pin and drag bear: 0.9 of the pin's force
    assert found["pin.force.y"] == pytest.approx([load, load], rel=1e-12)
    assert found["pin.angle"] == pytest.approx([MASS * G * C + 0.1 * load, MASS * G * C + 0.1 * load - 3], rel=1e-12)
    assert zd.equilibrium(system, hold=["pin.angle"])["pin.torque"] == pytest.approx(MASS * G * C + 0.1 * load, rel=1e-9)


def test_forces_that_do_not_agree_with_the_reactions_are_refused(monkeypatch):
    """Without an iteration the reactions are those of the free motion, not of the prescribed one."""
    monkeypatch.setattr(read_forces, "ITERATIONS", 0)
    with pytest.raises(zd.errors.NoUniqueMotion, match="must agree with the reactions"):
        zd.inverse_dynamics(arm(layout="joint"), 0.0, [A0], [W0], [2.5], efforts=["pin.angle"])


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


M1, M2 = 2.0, 1.0


def two_links(dimension, layout):
    """A hanging link at the end of another; a torque between them reads the force at the first pin, smooth and not linear."""
    m = zd.Mechanism("two links", dimension=dimension, gravity=(0, -G, 0)[:dimension])
    about = {"axis": (0, 0, 1)} if dimension == 3 else {}
    first, second = (m.link(name, a[:dimension], b[:dimension], mass=mass) for name, a, b, mass in (
        ("first", (0, 0, 0), (1, 0, 0), M1), ("second", (1, 0, 0), (1, -1, 0), M2)))
    m.revolute("pin", m.ground, first.start, **about)
    elbow = m.revolute("elbow", first.end, second.start, **about)
    m.motor("drive", elbow, torque=lambda y, w: of_force(y) - 0.1 * w * y, of={"y": "pin.force.y", "w": "elbow.speed"})
    return m.system(layout)


def of_force(y):
    return 0.02 * y + 0.001 * y * y


BOTH = [(dimension, layout) for dimension in (2, 3) for layout in ("joint", "absolute")]


@pytest.mark.parametrize(("dimension", "layout"), BOTH)
def test_a_held_coordinate_changes_what_a_law_reads(dimension, layout):
    """Vertical forces and moments of both links by hand, for an effort at a pin and one at a point."""
    system, a = two_links(dimension, layout), 0.4
    eq = zd.equilibrium(system, near={"pin.angle": a}, hold=["pin.angle"])
    torque, R = of_force((M1 + M2) * G), (M1 + M2) * G
    assert eq["pin.force"][1] == pytest.approx(R, rel=1e-10)
    assert eq.effort["pin.angle"] == pytest.approx((M1 / 2 + M2) * G * np.cos(a) + torque, rel=1e-10)
    turned = eq["pin.angle"] + eq["elbow.angle"]        # of the second link, from the vertical
    assert np.sin(turned) == pytest.approx(torque / (M2 * G / 2), rel=1e-10)
    if dimension == 2:      # a link in space has a thickness
        inertia = M2 / 3 - (0.02 + 0.002 * R) * M2 / 2 * np.sin(turned)
        expected = np.sort_complex(np.roots([inertia, 0.1 * R, M2 * G / 2 * np.cos(turned)]))
        assert np.sort_complex(eq.eigenvalues) == pytest.approx(expected, rel=1e-8)

    eq = zd.equilibrium(system, near={"pin.angle": a}, hold=["first.end.position.y"])
    R = M1 * G / 2
    for _ in range(60):
        R = M1 * G / 2 - of_force(R) / np.cos(a)
    assert eq["pin.force"][1] == pytest.approx(R, rel=1e-10)
    assert eq["drive.torque"] == pytest.approx(of_force(R), rel=1e-9)
    assert eq.effort["first.end.position.y"] == pytest.approx((M1 + M2) * G - R, rel=1e-10)


@pytest.mark.parametrize("dimension", [2, 3])
def test_efforts_at_points_are_in_the_reactions_of_the_tree(dimension):
    """Absolute coordinates have these reactions from multipliers."""
    found, end = [], "second.end.position.y"
    for layout in ("joint", "absolute"):
        eq = zd.equilibrium(two_links(dimension, layout), near={"pin.angle": 0.4, "elbow.angle": 1.0}, hold=["pin.angle", end])
        lin = zd.linearize(eq.system, at=eq, inputs=[end, "pin.torque"], outputs=["pin.force.y", "drive.torque"])
        inv = zd.inverse_dynamics(eq.system, 0.0, eq.p, eq.v, eq.vdot, efforts=["pin.angle", end])
        found.append(np.hstack([eq["pin.force"], eq["elbow.force"], lin.D.ravel(), np.sort(lin.eigenvalues.real),
                                inv["pin.angle"], inv[end], *inv["pin.force"]]))
    assert found[0] == pytest.approx(found[1], rel=1e-7, abs=1e-9)
    assert inv["pin.force.y"][0] == pytest.approx((M1 + M2) * G - inv[end][0], rel=1e-10)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_held_steady_motion_with_a_law_that_reads_a_reaction(layout):
    """A rod on a turning shaft: gravity, the centrifugal moment and a torque by the weight on the hinge."""
    m, a, w = zd.Mechanism("turntable", dimension=3, gravity=(0, 0, -G)), 0.5, 3.0
    post, arm = m.body("post", 1.0, (0.1, 0.1, 0.1)), m.body("arm", MASS, (0.01, 0.2, 0.2), at=(C, 0, 0))
    m.revolute("shaft", m.ground, post, at=(0, 0, 0), axis=(0, 0, 1))
    hinge = m.revolute("hinge", post, arm, at=(0, 0, 0), axis=(0, -1, 0))
    m.motor("drive", hinge, torque=lambda z: 0.05 * z + 0.001 * z * z, of={"z": "hinge.force.z"})
    weight = MASS * G
    effort = weight * C * np.cos(a) + w * w * (MASS * C * C + 0.19) * np.sin(a) * np.cos(a) - 0.05 * weight - 0.001 * weight**2
    system = m.system(layout)
    at = state(system, 0.0, near_to(system, {"hinge.angle": a}, 0.0), np.zeros(system.nv))
    at = with_speeds(at, {"shaft.speed": w, "hinge.speed": 0.0})
    flow = Flow(at, efforts={"hinge.angle": effort})
    assert flow.instant["hinge.acceleration"] == pytest.approx(0, abs=1e-9)
    assert flow.instant["drive.torque"] == pytest.approx(0.05 * weight + 0.001 * weight**2, rel=1e-9)
