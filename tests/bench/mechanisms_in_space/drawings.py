"""Benchmark problems for all programs: two mechanisms in space, as bodies, joints and springs in one reference configuration.

Every body's frame has its origin at the centre of mass and is parallel to the global axes at the start. All start at rest.
Compared are the positions of the mass centres, in m, and the nine direction cosines of each body's axes.
"""

from typing import NamedTuple

import numpy as np

GROUND = None


class Body(NamedTuple):
    """A rigid body."""

    name: str
    mass: float             # kg
    inertia: np.ndarray     # (3, 3) about the centre of mass, kg m^2
    center: np.ndarray      # (3,) m, at the start


class Joint(NamedTuple):
    """Joint between two bodies, or ground and a body. Joints that close loops come last, when both bodies are in the tree."""

    kind: str               # revolute, prismatic, universal, spherical
    first: str | None
    second: str
    at: np.ndarray          # (3,) m
    axes: tuple             # of directions (3,) in the drawing: one, of a universal two
    closes: bool = False


class Rod(NamedTuple):
    """A massless rod between two points."""

    first: str | None
    tail: np.ndarray
    second: str
    tip: np.ndarray


class Spring(NamedTuple):
    """A spring with a damper between two points."""

    first: str | None
    tail: np.ndarray        # (3,) m, on the first at the start
    second: str
    tip: np.ndarray
    stiffness: float        # N/m
    length: float           # m, at which it is slack
    damping: float          # N s/m


class Drawing(NamedTuple):
    """A mechanism."""

    name: str
    bodies: list[Body]
    joints: list[Joint]
    rods: list[Rod]
    springs: list[Spring]
    gravity: float          # m/s^2, against z
    t_end: float            # s
    count: int              # of outputs after the start

    @property
    def outputs(self):
        """The times at which bodies are compared, (count + 1,)."""
        return np.linspace(0, self.t_end, self.count + 1)

    def center(self, name):
        """Mass centre of a body, or the origin for the ground (None), (3,) m."""
        return np.zeros(3) if name is None else next(body.center for body in self.bodies if body.name == name)


def bar(mass, start, end):
    """The inertia (3, 3) of a slender bar whose thickness is a twentieth of its length."""
    along, length = (end - start) / np.linalg.norm(end - start), np.linalg.norm(end - start)
    own, across = mass * (length / 20)**2 / 8, mass * (length**2 / 12 + (length / 20)**2 / 16)
    return across * np.eye(3) + (own - across) * np.outer(along, along)


def stewart_platform():
    """A platform on six legs of two bodies each, with a spring and damper in each; one spring is longer."""
    angles = np.repeat(np.arange(3) * 2 * np.pi / 3, 2) + np.tile([-0.2, 0.2], 3)
    feet = np.stack([np.cos(angles), np.sin(angles), np.zeros(6)], axis=1)
    heads = np.stack([0.6 * np.cos(angles + np.pi / 3), 0.6 * np.sin(angles + np.pi / 3), np.full(6, 0.8)], axis=1)
    heads = np.roll(heads, 1, axis=0)
    bodies, joints, springs, closing = [], [], [], []
    for k, (foot, head) in enumerate(zip(feet, heads, strict=True)):
        low, high, middle, leg = f"cylinder{k}", f"piston{k}", (foot + head) / 2, head - foot
        bodies += [Body(low, 2.0, bar(2.0, foot, middle), (foot + middle) / 2),
                   Body(high, 1.0, bar(1.0, middle, head), (middle + head) / 2)]
        across = np.cross((0, 0, 1), leg)
        joints += [Joint("universal", GROUND, low, foot, (np.cross(across, leg), across)),
                   Joint("prismatic", low, high, middle, (leg,))]
        closing.append(Joint("spherical", high, "top", head, (), closes=k > 0))
        springs.append(Spring(GROUND, foot, high, head, 3000.0, float(np.linalg.norm(leg)) + (0.08 if k == 0 else 0.02), 30.0))
    bodies.append(Body("top", 20.0, np.diag([1.8, 1.8, 3.6]), np.array([0, 0, 0.8])))
    return Drawing("Stewart platform", bodies, [*joints, *closing], [], springs, 9.81, 1.0, 50)


def double_wishbone():
    """A corner of a car that falls into its springs: two arms, an upright, a tie rod, and a tyre that is a spring, too."""
    from zerodrift.models.space.double_wishbone import POINTS

    P = {name: np.array(place, dtype=float) for name, place in POINTS.items()}
    lower, upper = ((P[f"{arm} front"] + P[f"{arm} rear"] + P[f"{arm} ball"]) / 3 for arm in ("lower", "upper"))
    hub = (P["lower ball"] + P["upper ball"] + P["tie outer"]) / 3
    bodies = [Body("car", 350.0, np.diag([60.0, 150.0, 180.0]), P["car"]), Body("lower", 3.0, np.diag([0.05, 0.03, 0.07]), lower),
              Body("upper", 2.0, np.diag([0.03, 0.02, 0.04]), upper), Body("upright", 8.0, np.diag([0.2, 0.2, 0.1]), hub),
              Body("wheel", 15.0, np.diag([0.5, 0.9, 0.5]), P["wheel"])]
    joints = [Joint("prismatic", GROUND, "car", P["car"], (np.array([0, 0, 1.0]),)),
              Joint("revolute", "car", "lower", P["lower front"], (P["lower rear"] - P["lower front"],)),
              Joint("revolute", "car", "upper", P["upper front"], (P["upper rear"] - P["upper front"],)),
              Joint("spherical", "lower", "upright", P["lower ball"], ()),
              Joint("revolute", "upright", "wheel", P["wheel"], (np.array([0, 1.0, 0]),)),
              Joint("spherical", "upper", "upright", P["upper ball"], (), closes=True)]
    strut, road = float(np.linalg.norm(P["strut top"] - P["strut foot"])), P["wheel"] - (0, 0, 0.3)
    springs = [Spring("car", P["strut top"], "lower", P["strut foot"], 4e4, strut + 0.12, 3000.0),
               Spring(GROUND, road, "wheel", P["wheel"], 2e5, 0.31, 100.0)]
    rods = [Rod("car", P["tie inner"], "upright", P["tie outer"])]
    return Drawing("double wishbone", bodies, joints, rods, springs, 9.81, 1.0, 50)


def all_of_them():
    """In the order of the tables."""
    return [stewart_platform(), double_wishbone()]
