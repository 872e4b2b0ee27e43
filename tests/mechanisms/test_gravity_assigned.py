"""Gravity assigned to a mechanism: the next system has it, earlier systems and solutions keep theirs."""

import numpy as np
import pytest

import zerodrift as zd
from support import refused


def pendulum():
    m = zd.Mechanism("pendulum", gravity=(0, -9.81))
    m.revolute("pin", m.ground, m.link("link", (0, 0), (1, 0), mass=1.0).start)
    return m


def acceleration(system):
    return system.evaluate().f[0] / system.evaluate().M[0, 0]


@pytest.mark.parametrize("in_place", [True, False])
def test_an_assignment_acts_from_the_next_system_on(in_place):
    m = pendulum()
    earlier = m.system()
    sol = zd.simulate(m, 0.1, step=0.01)
    if in_place:
        m.gravity[:] = (0, -1)
    else:
        m.gravity = (0, -1)
    assert earlier.parameters["gravity.y"] == sol.system.parameters["gravity.y"] == -9.81
    assert earlier.with_parameters({"link.mass": 2.0}).parameters["gravity.y"] == -9.81
    assert m.system().parameters["gravity.y"] == -1.0
    # A rod about its end: angular acceleration 3 g / (2 l), with l = 1 m; rounding alone.
    np.testing.assert_allclose(acceleration(earlier), -1.5 * 9.81, rtol=1e-14)
    np.testing.assert_allclose(acceleration(m.system()), -1.5, rtol=1e-14)


def test_the_array_that_was_given_is_copied():
    given = np.array([0.0, -9.81])
    m = zd.Mechanism("pendulum", gravity=given)
    given[1] = -1.0
    assert m.gravity[1] == -9.81


def test_gravity_of_another_size_is_refused():
    m = pendulum()
    m.gravity = (0, 0, -9.81)
    with refused("shape"):
        m.system()
