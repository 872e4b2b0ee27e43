"""Random mechanisms in the plane, each as the package has it and as plain dicts for `plain_mechanics`."""

import numpy as np

import zerodrift as zd
from mechanisms.plain_mechanics import Model


class Maker:
    """Draws a mechanism at random: everything is consistent as drawn, so that each joint may be added anywhere.

    `law(a, w)` is what a drive is given for a sin(w t); left out, a callable.
    """

    def __init__(self, seed, law=lambda a, w: lambda t: a * np.sin(w * t)):
        self.random, self.law = np.random.default_rng(seed), law
        self.m = zd.Mechanism(f"random {seed}", gravity=(0.3, -9.81))
        self.bodies, self.poses = [], []        # of the package; of mass centres, (x, y, angle)
        self.d = {"mass": np.zeros(0), "gravity": np.array([0.3, -9.81]), "joints": [], "drives": [], "blades": [], "springs": [],
                  "forces": [], "efforts": []}
        self.joints, self.free = [], []         # of the package; those of the tree without a drive
        self.drawn = []                         # kind, bodies, place and axis of each joint
        self._grow()

    def _grow(self):
        for _ in range(self.random.integers(2, 7)):
            self._body()
        for _ in range(self.random.integers(0, 6)):
            self._loop()
        if self.random.random() < 0.5:
            self._redundant()
        for add in (self._drive, self._spring, self._force, self._effort, self._blade):
            if self.random.random() < 0.5:
                add()

    # ---- places ----

    def _place(self):
        return self.random.uniform(-1, 1, 2)

    def _local(self, body, drawn):
        """From the mass centre of a body, in its axes; on the ground as drawn."""
        if body < 0:
            return drawn
        x, y, angle = self.poses[body]
        c, s = np.cos(angle), np.sin(angle)
        return np.array([[c, s], [-s, c]]) @ (drawn - [x, y])

    def _turned_back(self, body, axis):
        angle = 0.0 if body < 0 else self.poses[body][2]
        c, s = np.cos(angle), np.sin(angle)
        return np.array([[c, s], [-s, c]]) @ axis

    def _of(self, body):
        return self.m.ground if body < 0 else self.bodies[body]

    def _pair(self):
        """Two different bodies, the ground being -1; the second is none."""
        second = self.random.integers(len(self.bodies))
        return int(self.random.choice([body for body in range(-1, len(self.bodies)) if body != second])), int(second)

    # ---- parts ----

    def _body(self):
        number = self._apart()
        first = int(self.random.integers(-1, number)) if self.random.random() < 0.95 else None
        if first is not None:
            kind = self.random.choice(["revolute", "prismatic", "weld"], p=[0.7, 0.22, 0.08])
            self._joint(kind, first, number, self._place())
            if kind != "weld":
                self.free.append(len(self.joints) - 1)

    def _apart(self):
        """A body that no joint holds yet; its number."""
        at, angle, com = self._place(), self.random.uniform(-3, 3), self.random.uniform(-0.3, 0.3, 2)
        mass, inertia = self.random.uniform(0.5, 2.0), self.random.uniform(0.02, 0.2)
        self.bodies.append(self.m.body(f"B{len(self.bodies)}", mass, inertia, at=at, angle=angle, com=com))
        c, s = np.cos(angle), np.sin(angle)
        self.poses.append((*(at + np.array([[c, -s], [s, c]]) @ com), angle))
        self.d["mass"] = np.append(self.d["mass"], [mass, mass, inertia])
        return len(self.bodies) - 1

    def _joint(self, kind, first, second, at, axis=None):
        name = f"J{len(self.joints)}"
        if axis is None:
            axis = np.array([np.cos(turn := self.random.uniform(0, 6)), np.sin(turn)])
        described = {"kind": kind, "first": first, "second": second,
                     "point1": self._local(first, at), "point2": self._local(second, at),
                     "angle": self.poses[second][2] - (0.0 if first < 0 else self.poses[first][2]), "along": 0.0}
        sides = self._of(first), self._of(second)
        if kind in ("prismatic", "slot"):
            described["axis"] = self._turned_back(first, axis)
        if kind == "revolute":
            joint = self.m.revolute(name, *sides, at=at)
        elif kind == "weld":
            joint = self.m.weld(name, *sides, at=at)
        elif kind == "prismatic":
            joint = self.m.prismatic(name, *sides, axis=axis, at=at)
        elif kind == "slot":
            joint = self.m.slot(name, sides[0], sides[1].point(at=at), axis=axis)
        else:
            other = at + 0.5 * axis
            described |= {"point1": self._local(first, other), "length": 0.5}
            joint = self.m.rod(name, sides[0].point(at=other), sides[1].point(at=at))
        self.joints.append(joint)
        self.d["joints"].append(described)
        self.drawn.append((kind, first, second, at, axis))

    def _freedom(self, **more):
        """Velocities that are left free, with more drives or blades than there are."""
        q = np.concatenate(self.poses)
        C, _, _ = Model(self.d | {key: [*self.d[key], value] for key, value in more.items()}).constraints(0.0, q, 0 * q)
        singular = np.linalg.svd(C, compute_uv=False) if len(C) else np.zeros(0)
        return len(q) - int((singular > 1e-2).sum())

    def _loop(self):
        """One more joint, where freedoms are left for it."""
        if self._freedom() > 3:
            self._joint(self.random.choice(["revolute", "rod", "slot", "prismatic"]), *self._pair(), self._place())

    def _redundant(self):
        """The same joint twice: its rows follow from the others everywhere."""
        again = int(self.random.integers(len(self.joints))) if self.joints else None
        if again is None or self.d["joints"][again]["kind"] != "revolute":
            return
        old, joint = self.d["joints"][again], self.joints[again]
        self.joints.append(self.m.revolute(f"J{len(self.joints)}", joint.first, joint.second))
        self.d["joints"].append(dict(old))
        self.drawn.append(self.drawn[again])

    def _drive(self):
        joint = int(self.random.choice(self.free or [0]))
        if not self.free or self._freedom(drives={"joint": joint, "second_derivative": np.sin}) == self._freedom():
            return      # there is no joint, or it cannot move
        self.free.remove(joint)
        a, w = self.random.uniform(0.1, 0.4), self.random.uniform(2, 5)
        quantity = "angle" if self.d["joints"][joint]["kind"] == "revolute" else "displacement"
        self.m.motor("drive", self.joints[joint], **{quantity: self.law(a, w)})
        self.d["drives"].append({"joint": joint, "second_derivative": lambda t: -a * w**2 * np.sin(w * t)})

    def _spring(self):
        (first, second), at, other = self._pair(), self._place(), self._place()
        stiffness, length, damping = self.random.uniform(5, 50), self.random.uniform(0.1, 1), self.random.uniform(0, 2)
        points = self._of(first).point(at=other), self._of(second).point(at=at)
        self.m.spring("spring", *points, stiffness=stiffness, length=length, damping=damping)
        self.d["springs"].append({
            "first": first, "second": second, "point1": self._local(first, other), "point2": self._local(second, at),
            "stiffness": stiffness, "length": length, "damping": damping})

    def _force(self):
        (frame, body), at, value = self._pair(), self._place(), self.random.uniform(-5, 5)
        axis = np.array([0.6, 0.8])
        self.m.force("force", self._of(body).point(at=at), along=axis, value=value, frame=self._of(frame))
        self.d["forces"].append({"body": body, "frame": frame, "point": self._local(body, at), "value": value,
                                 "axis": self._turned_back(frame, axis)})

    def _effort(self):
        if not self.free:
            return
        joint = int(self.random.choice(self.free))
        value = self.random.uniform(-2, 2)
        turns = self.d["joints"][joint]["kind"] == "revolute"
        self.m.motor("effort", self.joints[joint], **{"torque" if turns else "force": value})
        self.d["efforts"].append({"joint": joint, "constant": value, "stiffness": 0.0, "damping": 0.0})
        if turns:
            self.m.torsion_spring("torsion spring", self.joints[joint], stiffness=4.0, angle=0.3, damping=0.2)
            self.d["efforts"].append({"joint": joint, "constant": 4.0 * 0.3, "stiffness": 4.0, "damping": 0.2})

    def _blade(self):
        body, at, axis = int(self.random.integers(len(self.bodies))), self._place(), np.array([0.8, -0.6])
        blade = {"body": body, "point": self._local(body, at), "axis": self._turned_back(body, axis)}
        if self._freedom(blades=blade) == self._freedom():
            return
        self.m.knife_edge("blade", self.bodies[body].point(at=at), along=axis)
        self.d["blades"].append(blade)

    def start(self):
        """Wishes velocities, so that it moves."""
        self.m.start(wish={f"B{i}.angular_velocity": self.random.uniform(-2, 2) for i in range(len(self.bodies))})
