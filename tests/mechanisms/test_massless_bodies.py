"""Bodies without mass or inertia that constraints hold: they move as with a vanishing mass, and are named where they cannot."""

import numpy as np
import pytest

import zerodrift as zd
from support import assert_close, refused


def crank(dimension, *, rod=0.0, hinge=False):
    """Slider-crank with a rod of this mass; in space its end is a ball, or a hinge on a guided body."""
    z, axis = (0.0,) * (dimension - 2), {"axis": (0, 0, 1)} if dimension == 3 else {}
    pin = np.array([0.1 * np.cos(1.0), 0.1 * np.sin(1.0)])
    x, inertia = pin[0] + np.sqrt(0.09 - pin[1]**2), 1.0 / 1200
    m = zd.Mechanism("crank", dimension=dimension, gravity=(0, -9.81, *z))
    arm = m.link("arm", (0, 0, *z), (*pin, *z), mass=1.0, inertia=inertia if dimension == 2 else (inertia,) * 3)
    link = m.link("rod", (*pin, *z), (x, 0, *z), mass=rod)
    m.revolute("A", m.ground, arm.start, **axis)
    m.revolute("B", arm.end, link.start, **axis)
    if hinge:
        piston = m.body("piston", 0.4, 1e-3 if dimension == 2 else (1e-3,) * 3, at=(x, 0, *z))
        m.revolute("C", link.end, piston.point((0, 0, *z)), **axis)
        m.prismatic("S", m.ground, piston, axis=(1, 0, *z))
    else:
        piston = m.particle("piston", 0.4, at=(x, 0, *z))
        (m.revolute if dimension == 2 else m.spherical)("C", link.end, piston)
        m.slot("S", m.ground, piston, axis=(1, 0, *z))
    return m


def cross(mass, inertia):
    """Cardan suspension whose cross has this mass and inertia."""
    m = zd.Mechanism("cardan", dimension=3, gravity=(0, 0, -9.81))
    body, x = m.body("b", 2.0, (0.05, 0.06, 0.02), at=(0.2, 0.1, -0.5)), m.body("x", mass, inertia)
    m.revolute("r1", m.ground, x, at=(0, 0, 0), axis=(1, 0, 0))
    m.revolute("r2", x, body, at=(0, 0, 0), axis=(0, 1, 0))
    return m


def ways(system, measure):
    """End value of a measure, by a run, an open run and a run among many."""
    fixed = {"step": 1e-3}
    yield zd.simulate(system, 0.1, **fixed)[measure][-1]
    run = zd.Run(system, **fixed)
    run.advance_to(0.1)
    yield run[measure]
    yield zd.ensemble(system, 0.1, parameters=[{}, {}], outputs=[measure], **fixed)[measure][1, -1]


@pytest.mark.parametrize("hinge", [False, True])
@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_massless_rod_moves_as_one_of_vanishing_mass(dimension, layout, hinge):
    expected = zd.simulate(crank(2, rod=1e-9), 0.1, step=1e-3)["A.angle"][-1]
    system = crank(dimension, hinge=hinge).system(layout)
    if hinge:       # a guided body that does not turn is a particle
        assert zd.simulate(system, 0.01, step=1e-3).settings["formulation"] == system._formulation
    for found in ways(system, "A.angle"):
        assert_close(found, expected, 1e-7)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize(("mass", "inertia"), [(0.0, (0, 0, 0)), (1.0, (0, 0, 0)), (1.0, (0, 1, 1))])
def test_cross_without_mass_or_inertia(layout, mass, inertia):
    tiny = tuple(each or 1e-10 for each in inertia)
    other = cross(mass or 1e-9, tiny).system(layout)
    system, measure = cross(mass, inertia).system(layout), "b.position"
    expected = zd.simulate(other, 0.1, step=1e-3)[measure][-1]
    for found in ways(system, measure):
        assert_close(found, expected, 1e-6)
    p, v = system.p0, system.v0
    assert_close(zd.acceleration(system, p, v)[0], zd.acceleration(other, other.p0, other.v0)[0], 1e-6, scale=10.0)
    assert_close(zd.project(system, p, v)[0], p, 1e-12)
    if layout == "absolute":
        with refused("mass-not-definite", "'x'"):
            zd.simulate(system, 0.1, step=1e-3, formulation="schur")


def test_mass_alone_decides():
    assert crank(3).system("absolute")._formulation == "augmented"
    assert crank(3).system("absolute").with_parameters({"rod.mass": 1.0})._formulation == "schur"
    assert crank(3, rod=1.0).system("absolute")._formulation == "schur"
    m = zd.Mechanism("pendulum", dimension=3)
    arm = m.body("arm", 0.0, (0, 0, 0))
    m.spherical("pivot", m.ground, arm, at=(0, 0, 0))
    m.weld("fix", arm, m.body("bob", 1.0, (0.1, 0.1, 0.1), at=(0, 0, -1)), at=(0, 0, -1))
    assert m.system("joint")._formulation == "schur"        # the tree's mass matrix is definite
    assert m.system("absolute")._formulation == "augmented"
    with refused("singular-system", "'loose'"):
        m.body("loose", 1.0, (0, 0, 0), at=(1, 0, 0))
        zd.simulate(m, 0.1)
