"""Analyses in joint coordinates where the tree satisfies all constraints identically, so that their gradients are rounding."""

import numpy as np
import pytest

import zerodrift as zd
from zerodrift.analysis.state import state


def bell_crank(braces):
    """Two bars that are welded together, a pendulum; a rod braces them as often as asked for."""
    m = zd.Mechanism("bell crank", gravity=(0, -9.81))
    arm, leg = m.link("arm", (0, 0), (1, 0.3), mass=1.0), m.link("leg", (1, 0.3), (1.5, 1), mass=1.0)
    m.revolute("hinge", m.ground, arm.start)
    m.weld("corner", arm.end, leg.start)
    for i in range(braces):
        m.rod(f"gusset{i}", arm.point(at=(0.3 + 0.1 * i, 0.1)), leg.point(at=(1.3, 0.8)))
    return m


def in_space(braces):
    """A bar and a plate that are welded together, on a hinge along y; rods between them."""
    m = zd.Mechanism("bracket", dimension=3, gravity=(0, 0, -9.81))
    bar = m.link("bar", (0, 0, 0), (1, 0, 0.2), mass=1.0, inertia=(0.01, 0.1, 0.1))
    plate = m.body("plate", 2.0, (0.1, 0.2, 0.1), at=(1.4, 0.3, 0.5))
    m.revolute("hinge", m.ground, bar.start, axis=(0, 1, 0))
    m.weld("corner", bar, plate, at=(1, 0, 0.2))
    for i in range(braces):
        m.rod(f"brace{i}", bar.point(at=(0.2 + 0.2 * i, 0.0, 0.1)), plate.point(at=(1.3, 0.2, 0.4)))
    return m


MADE = {"plane": bell_crank, "space": in_space}


@pytest.mark.parametrize("room", MADE)
@pytest.mark.parametrize("braces", [1, 2])
def test_what_is_braced_rests_and_swings_as_without_the_brace(room, braces):
    free, braced = (MADE[room](n).system("joint") for n in (0, braces))
    hanging, held = zd.equilibrium(free), zd.equilibrium(braced)
    assert np.abs(held.p - braced.p0).max() > 0.1       # not the start
    assert held.p == pytest.approx(hanging.p, abs=1e-9)
    expected = np.sort_complex(zd.linearize(free, hanging).eigenvalues)
    assert np.abs(expected.imag).max() > 1.0
    assert np.sort_complex(zd.linearize(braced, held).eigenvalues) == pytest.approx(expected, abs=1e-8)


@pytest.mark.parametrize("room", MADE)
def test_the_same_in_absolute_coordinates(room):
    found = [zd.linearize(system, zd.equilibrium(system)).eigenvalues for system in (MADE[room](1).system(kind) for kind in (
        "joint", "absolute"))]
    assert np.sort_complex(found[0]) == pytest.approx(np.sort_complex(found[1]), abs=1e-8)


@pytest.mark.parametrize("room", MADE)
def test_derivatives_of_accelerations_agree(room):
    assert not zd.check(MADE[room](1).system("joint")).problems


@pytest.mark.parametrize("room", MADE)
def test_torque_of_a_motion(room):
    """The torque at the hinge that holds the start is that without the brace."""
    free, braced = (MADE[room](n).system("joint") for n in (0, 1))
    torques = [zd.inverse_dynamics(each, 0.0, each.p0, each.v0, [0.0], efforts=["hinge.angle"])["hinge.angle"]
               for each in (free, braced)]
    assert abs(torques[0][0]) > 1.0
    assert torques[1] == pytest.approx(torques[0], rel=1e-10)


def test_rows_that_are_rounding_are_zero():
    """And those of a drive are not, whose terms do not cancel."""
    m = bell_crank(1)
    assert not state(m.system("joint"), 0.0, np.array([0.7]), np.zeros(1)).C.any()
    m.motor("drive", "hinge", speed=1.0)
    C = state(m.system("joint"), 0.0, np.array([0.7]), np.zeros(1)).C
    assert sorted(np.abs(C).ravel()) == [0.0, 1.0]
