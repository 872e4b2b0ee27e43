"""Stiff mechanisms, as equations in SymPy that every program is given: kinetic and potential energy, damping, and constraints.

The equations are M vdot = f - C^T lambda with C vdot = b. Where a force is stiff, so are these.
"""

import itertools
import sys
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
import sympy as sp

G = 9.81


@dataclass(frozen=True, eq=False)
class Problem:
    """A mechanism in n coordinates p, whose rates are v."""

    name: str
    t_end: float
    p: tuple
    v: tuple
    kinetic: sp.Expr
    potential: sp.Expr
    constraints: list
    p0: list
    power: sp.Expr = sp.S.Zero      # half of what dampers lose, as Rayleigh has it
    drive: list = field(default_factory=list)       # generalised forces that are constant
    outputs: int = 21

    @property
    def n(self):
        """The number of coordinates."""
        return len(self.p)

    @cached_property
    def times(self):
        """At which all are compared, (k,)."""
        return np.linspace(0, self.t_end, self.outputs)

    @cached_property
    def terms(self):
        """M, f, C and b, in the symbols p and v."""
        momenta = [sp.diff(self.kinetic, rate) for rate in self.v]
        M = [[sp.diff(momentum, rate) for rate in self.v] for momentum in momenta]
        drive = self.drive or self.n * [0]
        force = [sp.diff(self.kinetic - self.potential, q) - self.rate_of(momentum) - sp.diff(self.power, rate) + given
                 for q, rate, momentum, given in zip(self.p, self.v, momenta, drive, strict=True)]
        C = [[sp.diff(row, q) for q in self.p] for row in self.constraints]
        b = [-self.rate_of(self.rate_of(row)) for row in self.constraints]
        return M, force, C, b

    def rate_of(self, expression):
        """Its derivative by time with v held."""
        return sum(sp.diff(expression, q) * rate for q, rate in zip(self.p, self.v, strict=True))

    def rayleigh(self):
        """The forces of dampers and drives."""
        drive = self.drive or self.n * [0]
        return [given - sp.diff(self.power, rate) for rate, given in zip(self.v, drive, strict=True)]


def symbols(n):
    """Coordinates and their rates."""
    return sp.symbols(f"p:{n}"), sp.symbols(f"v:{n}")


def _speed(point, p, v):
    return [sum(sp.diff(x, q) * rate for q, rate in zip(p, v, strict=True)) for x in point]


def _bar(mass, inertia, centre, angle, p, v):
    """Kinetic energy of a body."""
    vx, vy = _speed(centre, p, v)
    turning, = _speed([angle], p, v)
    return (mass * (vx**2 + vy**2) + inertia * turning**2) / 2


def governor():
    """A flyball governor: a spindle turns two balls on rods, which hold a sleeve against a hard spring with a damper.

    Its spring has 8e7 N/m and its damper 4e6 N s/m, a hundred times those of the literature on stiff mechanisms, with which
    explicit methods are as fast; the spindle is driven by a moment and starts with the balls swung out. Rates from 20 to 2e5 1/s.
    """
    p, v = symbols(3)
    (_turn, swing, sleeve), (spin, swinging, sliding) = p, v
    rod, ball, collar, spindle, stiffness, damping = 0.3, 5.0, 10.0, 1.0, 8e7, 4e6
    drawn = 2 * rod * np.cos(0.6)
    kinetic = (spindle * spin**2 + collar * sliding**2) / 2 + ball * rod**2 * (swinging**2 + (sp.sin(swing) * spin) ** 2)
    potential = -2 * ball * G * rod * sp.cos(swing) - collar * G * sleeve + stiffness * (sleeve - drawn) ** 2 / 2
    return Problem("governor", 5.0, p, v, kinetic, potential, [sleeve - 2 * rod * sp.cos(swing)],
                   [0.0, 0.7, 2 * rod * np.cos(0.7)], damping * sliding**2 / 2, [2.0, 0, 0])


def bushings():
    """A slider-crank whose crank pin is a bushing of 1e8 N/m and 1e4 N s/m: rates up to 1.6e5 1/s."""
    p, v = symbols(5)
    crank, x, y, angle, slide = p
    r, length, stiffness, damping = 0.1, 0.3, 1e8, 1e4
    end = [r * sp.cos(crank), r * sp.sin(crank)]
    gap = [end[0] - x + length / 2 * sp.cos(angle), end[1] - y + length / 2 * sp.sin(angle)]
    kinetic = (_bar(0.5, 0.5 * r**2 / 12, [end[0] / 2, end[1] / 2], crank, p, v)
               + _bar(0.3, 0.3 * length**2 / 12, [x, y], angle, p, v) + 0.4 * v[4] ** 2 / 2)
    potential = G * (0.5 * end[1] / 2 + 0.3 * y) + stiffness * (gap[0] ** 2 + gap[1] ** 2) / 2
    lost = damping * sum(speed**2 for speed in _speed(gap, p, v)) / 2
    rows = [x + length / 2 * sp.cos(angle) - slide, y + length / 2 * sp.sin(angle)]
    return Problem("bushings", 1.0, p, v, kinetic, potential, rows, [0.0, 0.25, 0.0, 0.0, 0.4], lost)


def flexible():
    """A slider-crank whose rod is four segments, held straight by springs of 1e5 N m/rad and dampers of 10 N m s/rad.

    Rates up to 1.3e6 1/s.
    """
    p, v = symbols(6)
    crank, *angles, slide = p
    r, length, stiffness, damping = 0.15, 0.3 / 4, 1e5, 10.0
    x, y = r * sp.cos(crank), r * sp.sin(crank)
    kinetic = _bar(0.36, 0.36 * r**2 / 12, [x / 2, y / 2], crank, p, v) + 0.75 * v[5] ** 2 / 2
    potential = 0.36 * G * y / 2
    for angle in angles:
        dx, dy = length * sp.cos(angle), length * sp.sin(angle)
        kinetic += _bar(0.0375, 0.0375 * length**2 / 12, [x + dx / 2, y + dy / 2], angle, p, v)
        potential += 0.0375 * G * (y + dy / 2)
        x, y = x + dx, y + dy
    bends = [second - first for first, second in itertools.pairwise(angles)]
    potential += stiffness * sum(bend**2 for bend in bends) / 2
    lost = damping * sum(_speed([bend], p, v)[0] ** 2 for bend in bends) / 2
    return Problem("flexible rod", 0.5, p, v, kinetic, potential, [x - slide, y], [0.0, 0.0, 0.0, 0.0, 0.0, 0.45], lost,
                   [0.5, 0, 0, 0, 0, 0])


def andrews():
    """Andrews' squeezing mechanism, whose spring is not stiff: what an implicit method costs where none is needed."""
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "peers"))
    from andrews import Squeezer, drawn

    p, v = symbols(7)
    bodies, loops, potential = drawn(*p)
    kinetic = sum(_bar(*body, p, v) for body in bodies)
    return Problem("Andrews", 0.03, p, v, kinetic, potential, loops, list(Squeezer().p0), drive=[0.033, 0, 0, 0, 0, 0, 0])


ALL = {"governor": governor, "bushings": bushings, "flexible rod": flexible, "Andrews": andrews}
