"""Andrews' squeezing mechanism, seven bodies in three loops; equations derived in SymPy for whoever compiles expressions.

Source: W. Schiehlen (ed.), Multibody Systems Handbook, Springer 1990. One velocity is free, that of the crank.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import sympy as sp
from equations import dot, solved

LOOPS = ((1, 2), (3, 4), (5, 6))    # the two angles that each loop determines, once those before it are known


@dataclass(frozen=True, eq=False)
class Squeezer:
    """Coordinates are the angles of the literature: beta, theta, gamma, phi, delta, omega, epsilon."""

    name: str = "Andrews"
    n: int = 7
    t_end: float = 0.03
    spacing: float = 0.0005

    @cached_property
    def outputs(self):
        """Times at which all are compared, (k,)."""
        return self.spacing * np.arange(round(self.t_end / self.spacing) + 1)

    @cached_property
    def p0(self):
        """The start in rad, consistent to all digits."""
        return np.array([-0.0617138900142764496358948458001, 0.0, 0.455279819163070380255912382449,
                         0.222668390165885884674473185609, 0.487364979543842550225598953530,
                         -0.222668390165885884674473185609, 1.23054744454982119249735015568])

    @cached_property
    def v0(self):
        """It starts from rest."""
        return np.zeros(self.n)

    @cached_property
    def terms(self):
        """Symbols p and v, and in them M, f - d, C and b of C vdot = b."""
        p, v = sp.symbols("p:7"), sp.symbols("v:7")
        bodies, loops, potential = drawn(*p)
        kinetic = sum(m * sum(rate**2 for rate in _rate(centre, p, v)) + J * _rate([angle], p, v)[0] ** 2
                      for m, J, centre, angle in bodies) / 2
        momenta = [sp.diff(kinetic, rate) for rate in v]
        M = [[sp.diff(momentum, rate) for rate in v] for momentum in momenta]
        force = [sp.diff(kinetic - potential, angle) - _rate([momentum], p, v)[0]
                 for angle, momentum in zip(p, momenta, strict=True)]
        force[0] += 0.033       # N m, at the crank
        C = [[sp.diff(row, angle) for angle in p] for row in loops]
        return p, v, {"M": M, "force": force, "C": C, "b": [-rate for rate in _rate(_rate(loops, p, v), p, v)]}

    def evaluated(self, names, p, v, functions):
        """Terms at p and v, made of whatever the functions sin, cos and sqrt take."""
        symbols_p, symbols_v, terms = self.terms
        return sp.lambdify([symbols_p, symbols_v], [terms[name] for name in names], modules=[functions], cse=True)(p, v)

    def accelerations(self):
        """The function (p, v) -> vdot of the index-1 equations (8), in NumPy."""
        p, v, terms = self.terms
        evaluate = sp.lambdify([p, v], [terms[name] for name in ("M", "force", "C", "b")], cse=True)

        def vdot(p, v):
            M, force, C, b = evaluate(p, v)
            C = np.array(C)
            return np.linalg.solve(np.block([[np.array(M), C.T], [C, np.zeros((6, 6))]]), np.concatenate([force, b]))[:7]

        return vdot

    def spread(self, p, u, functions):
        """All velocities, of that of the crank: D u of (14)."""
        C, = self.evaluated(["C"], p, self.n * [0], functions)
        return [u * each for each in _following(C, 1.0, 6 * [0])]

    def reduced(self, p, v, functions):
        """The accelerations D udot + gamma of (15), from D^T times (2)."""
        C, M, force, b = self.evaluated(["C", "M", "force", "b"], p, v, functions)
        D, gamma = _following(C, 1.0, 6 * [0]), _following(C, 0, b)
        rest = [force[i] - dot(M[i], gamma) for i in range(self.n)]
        udot = dot(D, rest) / dot(D, [dot(row, D) for row in M])
        return [D[0] * udot, *(D[i] * udot + gamma[i] for i in range(1, self.n))]

    def with_multipliers(self, p, v, functions):
        """The accelerations of (13)."""
        C, M, force, b = self.evaluated(["C", "M", "force", "b"], p, v, functions)
        free, *columns = solved(M, [force, *C])
        multipliers, = solved([[dot(row, column) for column in columns] for row in C],
                              [[dot(row, free) - right for row, right in zip(C, b, strict=True)]])
        return [free[i] - dot([column[i] for column in columns], multipliers) for i in range(self.n)]


def _following(C, crank, b):
    """The solution x of C x = b with x[0] given, loop by loop."""
    x = [crank, *6 * [0]]
    for k, (i, j) in enumerate(LOOPS):
        first, second = C[2 * k], C[2 * k + 1]
        r, s = b[2 * k] - dot(first, x), b[2 * k + 1] - dot(second, x)
        determinant = first[i] * second[j] - first[j] * second[i]
        x[i], x[j] = (r * second[j] - s * first[j]) / determinant, (first[i] * s - second[i] * r) / determinant
    return x


def _rate(what, p, v):
    """Time derivatives of expressions in p at constant v."""
    return [sum(sp.diff(each, angle) * rate for angle, rate in zip(p, v, strict=True)) for each in what]


def _turned(angle, x, y=0):
    return np.array([x * sp.cos(angle) - y * sp.sin(angle), x * sp.sin(angle) + y * sp.cos(angle)])


def drawn(beta, theta, gamma, phi, delta, omega, epsilon):
    """Bodies (mass, moment of inertia, centre of mass, angle), what is zero where loops are closed, and the spring's energy."""
    a, b, c = np.array([-0.06934, -0.00227]), np.array([-0.03635, 0.03273]), np.array([0.014, 0.072])
    crank = _turned(beta, 0.007)
    coupler = crank - _turned(beta + theta, 0.028)
    lower, upper = a + _turned(delta, 0.04), a + _turned(epsilon, 0, -0.04)
    bodies = [
        (0.04325, 2.194e-6, _turned(beta, 0.00092), beta),
        (0.00365, 4.410e-7, crank - _turned(beta + theta, 0.0115), beta + theta),
        (0.02373, 5.255e-6, b + _turned(gamma, 0.01874, 0.01043), gamma),
        (0.00706, 5.667e-7, lower + _turned(phi + delta, 0, 0.01421 - 0.02), phi + delta),
        (0.07050, 1.169e-5, a + _turned(delta, 0.02308, 0.00916), delta),
        (0.00706, 5.667e-7, upper + _turned(omega + epsilon, 0.02 - 0.01421), omega + epsilon),
        (0.05498, 1.912e-5, a + _turned(epsilon, 0.01228, 0.00449), epsilon),
    ]
    ends = [b + _turned(gamma, 0, -0.035), lower + _turned(phi + delta, 0, -0.02), upper + _turned(omega + epsilon, 0.02)]
    spring = b + _turned(gamma, 0.02, -0.018) - c
    loops = [gap for end in ends for gap in coupler - end]
    return bodies, loops, 4530.0 * (sp.sqrt(spring[0] ** 2 + spring[1] ** 2) - 0.07785) ** 2 / 2
