"""Benchmark problems for all programs: four planar mechanisms, as bodies and joints in one reference configuration.

Every body's frame has its origin at the centre of mass and is parallel to the global axes at the start, so that a point has the
same coordinates in every program. All start at rest. Compared are the bodies' centres of mass and angles.
"""

from typing import NamedTuple

import numpy as np

GROUND = None


class Body(NamedTuple):
    """A rigid body."""

    name: str
    mass: float             # kg
    inertia: float          # about the centre of mass, kg m^2
    center: np.ndarray      # (2,) m, at the start


class Revolute(NamedTuple):
    """A hinge of two bodies, or of the ground and a body."""

    first: str | None
    second: str
    at: np.ndarray          # (2,) m


class Prismatic(NamedTuple):
    """A slider on the ground's x axis, which keeps its angle."""

    second: str


class Spring(NamedTuple):
    """A spring with a damper between two points."""

    first: str | None
    tail: np.ndarray        # (2,) m, on the first at the start
    second: str
    tip: np.ndarray         # (2,) m, on the second at the start
    stiffness: float        # N/m
    length: float           # m, at which it is slack
    damping: float          # N s/m


class Drawing(NamedTuple):
    """A mechanism."""

    name: str
    bodies: list[Body]
    joints: list[Revolute | Prismatic]
    springs: list[Spring]
    torques: dict[str, float]       # constant, in N m, by body
    gravity: float                  # m/s^2, against y
    t_end: float                    # s
    count: int                      # of outputs after the start

    @property
    def outputs(self):
        """Times at which all are compared, (count + 1,)."""
        return self.t_end / self.count * np.arange(self.count + 1)

    @property
    def centers(self):
        """(k, 2) m, at the start."""
        return np.array([body.center for body in self.bodies])


def all_of_them():
    """The four."""
    return [four_bar(), slider_crank(), swing(8), andrews()]


def rod(name, start, end, mass):
    """A uniform rod."""
    start, end = np.array(start, dtype=float), np.array(end, dtype=float)
    return Body(name, mass, mass * np.sum((end - start) ** 2) / 12, (start + end) / 2)


def four_bar():
    """The links of the paper's example 1, its crank upright, from rest: gravity turns it."""
    a, d = np.array([0.0, 0.3]), np.array([1.0, 0.0])
    b = _meeting(a, 1.0, d, 0.6)
    bodies = [rod("crank", (0, 0), a, 1.5), rod("coupler", a, b, 5.0), rod("rocker", b, d, 3.0)]
    joints = [Revolute(GROUND, "crank", np.zeros(2)), Revolute("crank", "coupler", a), Revolute("coupler", "rocker", b),
              Revolute(GROUND, "rocker", d)]
    return Drawing("four-bar", bodies, joints, [], {}, 9.81, 4.0, 80)


def slider_crank():
    """A crank with a constant moment, a piston on a damped spring, which does not let it come around."""
    crank = 0.1 * np.array([np.cos(2.0), np.sin(2.0)])
    wrist = np.array([crank[0] + np.sqrt(0.3**2 - crank[1] ** 2), 0.0])
    bodies = [rod("crank", (0, 0), crank, 0.5), rod("rod", crank, wrist, 0.3), Body("piston", 0.4, 1e-4, wrist)]
    joints = [Revolute(GROUND, "crank", np.zeros(2)), Revolute("crank", "rod", crank), Revolute("rod", "piston", wrist),
              Prismatic("piston")]
    spring = Spring(GROUND, np.array([0.6, 0.0]), "piston", wrist, 2000.0, 0.3, 2.0)
    return Drawing("slider-crank", bodies, joints, [spring], {"crank": 2.0}, 9.81, 1.0, 100)


def swing(n):
    """A row of n four-bars that hang down: n + 1 equal hangers, n couplers, let go at sixty degrees."""
    reach = 0.5 * np.array([np.sin(np.pi / 3), -np.cos(np.pi / 3)])
    tops = [np.array([0.4 * i, 0.0]) for i in range(n + 1)]
    bodies = [rod(f"hanger{i}", top, top + reach, 1.0) for i, top in enumerate(tops)]
    bodies += [rod(f"coupler{i}", tops[i] + reach, tops[i + 1] + reach, 2.0) for i in range(n)]
    joints = [Revolute(GROUND, f"hanger{i}", top) for i, top in enumerate(tops)]
    for i in range(n):
        joints += [Revolute(f"hanger{i}", f"coupler{i}", tops[i] + reach),
                   Revolute(f"coupler{i}", f"hanger{i + 1}", tops[i + 1] + reach)]
    return Drawing(f"swing of {n} four-bars", bodies, joints, [], {}, 9.81, 4.0, 80)


def chain(n):
    """A chain of n equal links, let go straight at sixty degrees."""
    link = 0.1 * np.array([np.sin(np.pi / 3), -np.cos(np.pi / 3)])
    bodies = [rod(f"link{i}", i * link, (i + 1) * link, 0.1) for i in range(n)]
    joints = [Revolute(f"link{i - 1}" if i else GROUND, f"link{i}", i * link) for i in range(n)]
    return Drawing(f"chain of {n}", bodies, joints, [], {}, 9.81, 1.0, 20)


def andrews():
    """Andrews' squeezing mechanism. Source: W. Schiehlen (ed.), Multibody Systems Handbook, Springer 1990."""
    beta, theta, gamma, phi, delta, omega, epsilon = (
        -0.0617138900142764496, 0.0, 0.455279819163070380, 0.222668390165885885, 0.487364979543842551, -0.222668390165885885,
        1.23054744454982119)
    o, a, b, c = np.zeros(2), np.array([-0.06934, -0.00227]), np.array([-0.03635, 0.03273]), np.array([0.014, 0.072])
    crank = _turned(beta, 0.007)
    end = crank - _turned(beta + theta, 0.028)
    lower, upper = a + _turned(delta, 0.04), a + _turned(epsilon, 0, -0.04)
    bodies = [
        Body("crank", 0.04325, 2.194e-6, _turned(beta, 0.00092)),
        Body("coupler", 0.00365, 4.410e-7, crank - _turned(beta + theta, 0.0115)),
        Body("lever", 0.02373, 5.255e-6, b + _turned(gamma, 0.01874, 0.01043)),
        Body("lower link", 0.00706, 5.667e-7, lower + _turned(phi + delta, 0, 0.01421 - 0.02)),
        Body("lower rocker", 0.07050, 1.169e-5, a + _turned(delta, 0.02308, 0.00916)),
        Body("upper link", 0.00706, 5.667e-7, upper + _turned(omega + epsilon, 0.02 - 0.01421)),
        Body("upper rocker", 0.05498, 1.912e-5, a + _turned(epsilon, 0.01228, 0.00449)),
    ]
    joints = [Revolute(GROUND, "crank", o), Revolute("crank", "coupler", crank), Revolute(GROUND, "lever", b),
              Revolute("coupler", "lever", end), Revolute(GROUND, "lower rocker", a),
              Revolute("lower rocker", "lower link", lower), Revolute("coupler", "lower link", end),
              Revolute(GROUND, "upper rocker", a),
              Revolute("upper rocker", "upper link", upper), Revolute("coupler", "upper link", end)]
    spring = Spring(GROUND, c, "lever", b + _turned(gamma, 0.02, -0.018), 4530.0, 0.07785, 0.0)
    return Drawing("Andrews", bodies, joints, [spring], {"crank": 0.033}, 0.0, 0.03, 60)


def _turned(angle, x, y=0.0):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([x * c - y * s, x * s + y * c])


def _meeting(a, r, b, s):
    """Intersection of the circles of radius r about a and s about b, to the left of the direction from a to b."""
    along = b - a
    d = np.hypot(*along)
    x = (d**2 + r**2 - s**2) / (2 * d)
    return a + (x * along + np.sqrt(r**2 - x**2) * np.array([-along[1], along[0]])) / d


def tree(drawing):
    """Children of each body, breadth first: (name, joint, where its frame is); and the other joints, with the second's frame."""
    at, children, waiting = {None: np.zeros(2)}, {}, list(drawing.joints)
    centers = {body.name: body.center for body in drawing.bodies}
    level = [None]
    while level:
        below = []
        for joint in list(waiting):
            first = getattr(joint, "first", None)
            for parent, child in ((first, joint.second), (joint.second, first)):
                if parent in level and child not in at:
                    at[child] = joint.at if isinstance(joint, Revolute) else centers[child]
                    children.setdefault(parent, []).append((child, joint, at[child]))
                    below.append(child)
                    waiting.remove(joint)
                    break
        level = below
    return children, [(joint, at[joint.second]) for joint in waiting]
