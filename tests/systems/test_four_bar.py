"""The four-bar against derivations of its own: three free bodies with pin joints, and the motion by SciPy.

Body i has its centre (x_i, y_i) and its angle a_i; joints hold their ends together. Nothing here is shared with (8) of the
paper's example in three angles: neither the mass matrix nor the bias, which in these coordinates is zero.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import tolerances as tol
import zerodrift as zd
from support import SYSTEMS, assert_close, consistent_states

BARS = {name: system for name, system in SYSTEMS.items() if system.name == "four_bar"}
BARS["unequal"] = zd.systems.four_bar(lengths=(1.1, 0.4, 0.9, 0.7), masses=(2, 3, 5), inertias=(0.5, 0.25, 0.125), gravity=3)


class Bodies:
    """Three free bodies, nine coordinates, eight joint equations: the last two close the loop."""

    def __init__(self, bar):
        given = bar.parameters
        self.l0, *self.l = given["lengths"]
        self.m, self.g = np.array(given["masses"]), given["gravity"]
        J = given["inertias"] or self.m * np.array(self.l)**2 / 12
        self.M = np.diag(np.ravel([[m, m, J] for m, J in zip(self.m, J, strict=True)]))

    def centres(self, a):
        half = np.array(self.l)[:, None] / 2 * np.column_stack([np.cos(a), np.sin(a)])
        return np.cumsum(2 * half, axis=0) - half

    def velocities(self, a, w):
        """Rates of (x, y, a) of each body: each link turns on the tip of the one before it."""
        half = (np.array(self.l) / 2 * w)[:, None] * np.column_stack([-np.sin(a), np.cos(a)])
        return np.column_stack([np.cumsum(2 * half, axis=0) - half, w])

    def joints(self, a, w):
        """The matrix of the joints, rows (start of link i at the tip of link i - 1) and closure, and its right side."""
        C, rhs = np.zeros((8, 9)), np.zeros(8)

        def end(row, body, side, sign):
            s, c, half = np.sin(a[body]), np.cos(a[body]), side * self.l[body] / 2
            C[row:row + 2, 3 * body:3 * body + 3] += sign * np.array([[1, 0, -half * s], [0, 1, half * c]])
            rhs[row:row + 2] += sign * w[body]**2 * half * np.array([c, s])

        for body in range(3):
            end(2 * body, body, -1, 1)
            if body:
                end(2 * body, body - 1, 1, -1)
        end(6, 2, 1, 1)
        return C, rhs

    def acceleration(self, a, w):
        """Angular accelerations of the links and the reaction that holds the tip of the last."""
        C, rhs = self.joints(a, w)
        weight = np.ravel([[0, -m * self.g, 0] for m in self.m])
        K = np.block([[self.M, C.T], [C, np.zeros((8, 8))]])
        both = np.linalg.solve(K, np.concatenate([weight, rhs]))
        return both[2:9:3], both[-2:]


@pytest.mark.parametrize("bar", BARS.values(), ids=BARS)
def test_accelerations_and_reaction_are_those_of_three_free_bodies(bar):
    for t, p, v in consistent_states(bar):
        vdot, multipliers = zd.acceleration(bar, p, v, t)
        expected, reaction = Bodies(bar).acceleration(p, v)
        assert_close(vdot, expected, tol.STEPPED, scale=1)
        assert_close(multipliers, reaction, tol.STEPPED, scale=1)


@pytest.mark.parametrize("bar", BARS.values(), ids=BARS)
def test_energies_are_those_of_three_free_bodies(bar):
    bodies = Bodies(bar)
    for _, p, v in consistent_states(bar):
        e, rates = bar.evaluate(p, v), np.ravel(bodies.velocities(p, v))
        assert_close(v @ e.M @ v / 2, rates @ bodies.M @ rates / 2, tol.SAME)
        assert_close(e.V, bodies.g * bodies.m @ bodies.centres(p)[:, 1], tol.SAME, scale=1)


@pytest.mark.parametrize("bar", BARS.values(), ids=BARS)
def test_motion_is_that_of_three_free_bodies(bar):
    """By SciPy, which shares no code with ours; so the crossed assembly is checked, too."""
    bodies = Bodies(bar)
    reference = solve_ivp(lambda t, y: np.concatenate([y[3:], bodies.acceleration(y[:3], y[3:])[0]]), (0, 1),
                          np.concatenate([bar.p0, bar.v0]), method="DOP853", rtol=1e-12, atol=1e-12)
    sol = zd.simulate(bar, 1.0, step=1e-3)
    assert_close(np.concatenate([sol.p[-1], sol.v[-1]]), reference.y[:, -1], tol.REFERENCE)


def test_the_paper_s_start(bar):
    """ERRATA of the paper: the open assembly, to the five digits given."""
    assert_close(bar.p0, [np.pi / 2, 0.30288, -1.49486], 0.5e-5, scale=1)
    assert bar.v0[0] == 1


@pytest.mark.parametrize("bar", BARS.values(), ids=BARS)
def test_the_drawing_ends_where_the_ground_does(bar):
    points = bar.points(bar.p0)
    assert_close(points[0], [0, 0], 0)
    assert_close(points[-1], [bar.parameters["lengths"][0], 0], tol.SAME, scale=1)
    assert_close(np.linalg.norm(np.diff(points, axis=0), axis=1), bar.parameters["lengths"][1:], tol.SAME)


def test_assemblies_differ():
    opened, crossed = SYSTEMS["four_bar"], SYSTEMS["four_bar-crossed"]
    assert opened.p0[0] == crossed.p0[0]
    sides = [np.sign(np.sin(system.p0[2] - system.p0[1])) for system in (opened, crossed)]
    assert sides[0] == -sides[1]
