"""Random mechanisms that move: a tree of bodies, and pairs of bodies that close a loop and take no freedom away.

Each body hangs on the one before it, on any or on the ground, so that chains, trees and what is between are drawn.
What differs from one to the next is the size, how unequal masses are, which joints there are, and whether springs are.
"""

import numpy as np

import zerodrift as zd

MOST = 60       # bodies, some
OTHERS = {2: ["prismatic"], 3: ["prismatic", "cylindrical", "universal", "spherical"]}     # joints that are not hinges


class Assembly:
    """Draws a mechanism of `dimension` 2 or 3 from a seed."""

    def __init__(self, seed, dimension):
        self.rng = rng = np.random.default_rng([dimension, seed])
        self.dimension = dimension
        self.m = zd.Mechanism(f"assembly {seed}", dimension=dimension, gravity=(0, -9.81) if dimension == 2 else (0, 0, -9.81))
        self.bodies, self.places = [self.m.ground], [np.zeros(dimension)]
        self.joints = self.springs = 0
        self.unequal = rng.choice([0.0, 0.5, 2.0])          # natural logarithms of masses differ by so much
        self.along = rng.choice([0.2, 0.7, 0.95])           # how often a body hangs on the one before it
        self.to_ground = rng.choice([0.0, 0.1, 0.4])        # how often it hangs on, or a loop goes to, the ground
        self.other_joints = rng.choice([0.0, 0.0, 0.25])    # how often a joint is not a hinge
        closing = rng.choice([0.0, 0.2, 0.7])
        count = int(MOST ** rng.uniform(0, 1) if dimension == 2 else (MOST / 2) ** rng.uniform(0, 1)) + 1
        while len(self.bodies) <= count:
            if len(self.bodies) > 2 and rng.random() < closing:
                self._close()
            else:
                self._hang()
        for _ in range(int(rng.choice([0, 0, 1, count]))):
            self._spring()

    def _place_near(self, place):
        along = self.rng.normal(size=self.dimension)
        return place + self.rng.uniform(0.5, 1.0) * along / np.linalg.norm(along)

    def _direction(self):
        along = self.rng.normal(size=self.dimension)
        return along / np.linalg.norm(along)

    def _inner(self):
        """A body to hang on."""
        if len(self.bodies) == 1 or self.rng.random() < self.to_ground:
            return 0
        return len(self.bodies) - 1 if self.rng.random() < self.along else int(self.rng.integers(len(self.bodies)))

    def _body(self, place):
        """One with its mass centre there, whose radius of gyration is a third of a metre."""
        mass = float(np.exp(self.unequal * self.rng.normal()))
        inertia = mass / 9 if self.dimension == 2 else tuple(mass / 9 * self.rng.uniform(0.8, 1.2, 3))
        self.bodies.append(self.m.body(f"b{len(self.bodies)}", mass, inertia, at=place))
        self.places.append(place)
        return len(self.bodies) - 1

    def _join(self, kind, first, second, at):
        name, sides, self.joints = f"j{self.joints}", (self.bodies[first], self.bodies[second]), self.joints + 1
        if kind == "spherical" or (kind == "revolute" and self.dimension == 2):
            getattr(self.m, kind)(name, *sides, at=at)
        elif kind == "universal":
            axis = self._direction()
            other = np.cross(axis, self._direction())
            self.m.universal(name, *sides, axes=(axis, other / np.linalg.norm(other)), at=at)
        else:
            getattr(self.m, kind)(name, *sides, axis=self._direction(), at=at)

    def _kind(self):
        if self.rng.random() >= self.other_joints:
            return "revolute"
        return str(self.rng.choice(OTHERS[self.dimension]))

    def _hang(self):
        inner = self._inner()
        at = self._place_near(self.places[inner])
        self._join(self._kind(), inner, self._body(self._place_near(at)), at)

    def _close(self):
        """Two bodies between two others, whose joints take as many freedoms as these bodies have: in the plane three; in space a
        hinge, a cross and a ball.
        """
        one, other = len(self.bodies) - 1, self._inner()
        if one == other:
            other = 0
        kinds = ("revolute", self._kind(), "revolute") if self.dimension == 2 else ("revolute", "universal", "spherical")
        at = self._place_near(self.places[one])
        first = self._body(self._place_near(at))
        self._join(kinds[0], one, first, at)
        between = self._place_near(self.places[first])
        second = self._body(self._place_near(between))
        self._join(kinds[1], first, second, between)
        self._join(kinds[2], second, other, self._place_near(self.places[second]))

    def _spring(self):
        one, other = self.rng.choice(len(self.bodies), 2, replace=False)
        points = (self.bodies[each].point(at=self._place_near(self.places[each])) for each in (one, other))
        self.m.spring(f"s{self.springs}", *points, stiffness=20.0, damping=0.1)
        self.springs += 1
