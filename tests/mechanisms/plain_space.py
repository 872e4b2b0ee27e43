"""Random mechanisms in space, and their accelerations by an independent model: bodies, and what each joint holds, in NumPy.

Constraints are written from what a joint is for, of the poses alone, with more rows than needed where that is plainer, and are
differentiated by differences; accelerations follow by least squares, which takes redundant rows. What rolls or glides on the
ground has rows of velocities besides. Motions are those of a plain RK4, and reactions have to balance each body.
"""

import numpy as np
from scipy.spatial.transform import Rotation

import zerodrift as zd
from support import drawn_in

H = 1e-4        # of central differences, whose error is some H^2 and round-off over H
KINDS = ("revolute", "prismatic", "cylindrical", "universal", "spherical", "planar", "rod", "slot", "weld", "screw")
PITCH = 0.5
ON_GROUND = {"ball": (0.3, 0.3, 0.3), "disc": (0.0, 0.4, 0.4), "egg": (0.3, 0.5, 0.4)}    # semiaxes of what rolls, in m


class Plain:
    """A mechanism with what is needed to write its equations again."""

    def __init__(self, rng, bodies, loops, on_ground=None, coordinates=None):
        self.m = zd.Mechanism("random", dimension=3, gravity=rng.normal(size=3))
        self.bodies, self.held, self.on_ground, self.joints, self.drawn = [self.m.ground], [], [], {}, {}
        self.pose = {"ground": (np.zeros(3), Rotation.identity())}
        self.mass = {}
        for b in range(bodies):
            self._add_body(rng, f"b{b}")
            self._join(rng, f"j{b}", str(rng.choice(KINDS)), self.bodies[rng.integers(b + 1)], self.bodies[-1])
        for k in range(loops):
            one, other = rng.choice(bodies + 1, 2, replace=False)
            kind = str(rng.choice(["spherical", "rod", "slot", "universal"]))
            self._join(rng, f"loop{k}", kind, self.bodies[one], self.bodies[other])
        if on_ground:
            self._put_on_ground(rng, on_ground)
        self._add_idle(rng)
        self._add_forces(rng)
        self.system = self.m.system(coordinates)

    def _add_body(self, rng, name):
        at, R, com = rng.normal(size=3), Rotation.random(random_state=rng), 0.3 * rng.normal(size=3)
        J = Rotation.random(random_state=rng).as_matrix()
        J = J @ np.diag(rng.uniform(1, 1.5, 3)) @ J.T
        mass = rng.uniform(1, 3)
        self.bodies.append(self.m.body(name, mass, J, at=at, rotation=R.as_matrix(), com=com))
        self.pose[name], self.mass[name] = (at + R.apply(com), R), (mass, J, com)

    def _local(self, body, place):
        at, R = self.pose[body.name]
        return R.inv().apply(place - at)

    def _turned_back(self, body, direction):
        return self.pose[body.name][1].inv().apply(direction)

    def _join(self, rng, name, kind, first, second):
        place, axis = rng.normal(size=3), rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        normal = np.cross(axis, rng.normal(size=3))
        normal /= np.linalg.norm(normal)
        self._put(name, kind, first, second, place, axis, normal, place + rng.uniform(0.5, 1) * normal)

    def _add_idle(self, rng):
        """No redundant joints but those that come about by chance."""

    def _put(self, name, kind, first, second, place, axis, normal, other):
        given = {"planar": {"normal": axis}, "universal": {"axes": (axis, normal)}, "screw": {"axis": axis, "pitch": PITCH},
                 **{each: {"axis": axis} for each in ("revolute", "prismatic", "cylindrical")}}.get(kind, {})
        if kind == "rod":
            self.m.rod(name, first.point(at=place), second.point(at=other))
        elif kind == "slot":
            self.m.slot(name, first, second.point(at=place), axis=axis)
        else:
            getattr(self.m, kind)(name, first, second, at=place, **given)
        ends = (self._local(first, place), self._local(second, other if kind == "rod" else place))
        axes = [(self._turned_back(first, d), self._turned_back(second, d)) for d in (axis, normal)]
        self.held.append((kind, first.name, second.name, *ends, axes))
        self.joints[name] = first.name, second.name, other if kind == "rod" else place
        self.drawn[name] = kind, first, second, place, axis, normal, other

    def _put_on_ground(self, rng, kind):
        """The last body rolls on a plane of the ground, or a point of it glides along a blade."""
        body, centre = self.bodies[-1], rng.normal(size=3)
        up, along, _ = Rotation.random(random_state=rng).as_matrix()
        if kind == "blade":
            self.m.knife_edge("blade", body.point(at=centre), along=along, normal=up)
            self.joints["blade"] = "ground", body.name, centre
            across = self._turned_back(body, np.cross(up, along))
            self.on_ground.append((kind, body.name, self._local(body, centre), across))
            return
        tilt = Rotation.from_rotvec(rng.uniform(0.2, 1) * along) if kind == "disc" else Rotation.identity()
        axle = tilt.apply(np.cross(up, along))
        shape = np.diag(ON_GROUND[kind]) if kind != "disc" else 0.4 * (np.eye(3) - np.outer(axle, axle))
        R = self.bodies[-1].pose.rotation if kind == "egg" else np.eye(3)
        S = R @ shape @ shape.T @ R.T
        given = {"ball": {"radius": 0.3}, "disc": {"radius": 0.4, "axle": axle}, "egg": {"semiaxes": ON_GROUND["egg"]}}[kind]
        foot = centre - np.sqrt(up @ S @ up) * up
        self.m.rolling("floor", self.m.ground, body.point(at=centre), at=foot, normal=up, **given)
        self.joints["floor"] = "ground", body.name, centre - S @ up / np.sqrt(up @ S @ up)
        turned = self.pose[body.name][1].as_matrix()
        self.on_ground.append((kind, body.name, self._local(body, centre), (up, turned.T @ S @ turned)))

    def _add_forces(self, rng):
        one, other = rng.choice(len(self.bodies), 2, replace=False)
        ends = [body.point(at=rng.normal(size=3)) for body in (self.bodies[one], self.bodies[other])]
        self.m.spring("spring", *ends, stiffness=20.0, length=0.7, damping=2.0)
        self.spring = [(body.name, self._local(body, end.drawn)) for body, end in
                       zip((self.bodies[one], self.bodies[other]), ends, strict=True)]
        pushed, along = self.bodies[-1], rng.normal(size=3)
        self.m.force("push", pushed, along=along, value=3.0, frame=pushed)
        self.m.torque("kick", pushed, axis=along, value=2.0)
        self.push = (self._turned_back(pushed, along / np.linalg.norm(along)), along / np.linalg.norm(along))

    # ---- the model: velocities are those of mass centres, and angular velocities, both in the drawing's axes ----

    def names(self):
        return [body.name for body in self.bodies[1:]]

    def moved(self, poses, step):
        """Poses after a step (6 n,) along velocities that stay."""
        parts = dict(zip(self.names(), np.reshape(step, (-1, 6)), strict=True))
        return {"ground": poses["ground"], **{name: (poses[name][0] + d[:3], Rotation.from_rotvec(d[3:]) * poses[name][1])
                                              for name, d in parts.items()}}

    def constraints(self, poses):
        return np.concatenate([np.atleast_1d(_held(poses[first], poses[second], kind, *given))
                               for kind, first, second, *given in self.held])

    def jacobian(self, poses):
        steps = np.eye(6 * len(self.names())) * H
        rows = np.stack([(self.constraints(self.moved(poses, d)) - self.constraints(self.moved(poses, -d))) / (2 * H)
                         for d in steps], axis=1)
        return np.vstack([rows, *(self._rows_on_ground(poses, *each) for each in self.on_ground)])

    def _rows_on_ground(self, poses, kind, name, local, given):
        """Rows of velocities: no point of a body has any where it touches, or none across a blade."""
        R = poses[name][1]
        arm = R.apply(local)
        if kind == "blade":
            held = [R.apply(given)]
        else:
            up, S = given[0], R.as_matrix() @ given[1] @ R.as_matrix().T
            arm = arm - S @ up / np.sqrt(up @ S @ up)
            held = np.eye(3)        # the contact is where a body is farthest down: that its height stays is the part along `up`
        rows = np.zeros((len(held), 6 * len(self.names())))
        at = 6 * self.names().index(name)
        rows[:, at:at + 6] = [np.r_[d, np.cross(arm, d)] for d in held]
        return rows

    def loads(self, poses, v):
        """Generalized forces (6 n,), gyroscopic ones included."""
        spins = {"ground": np.zeros(6), **dict(zip(self.names(), v.reshape(-1, 6), strict=True))}
        total = {name: np.zeros(6) for name in spins}
        for name, (mass, J, _) in self.mass.items():
            turned = poses[name][1].as_matrix() @ J @ poses[name][1].as_matrix().T
            total[name] += np.r_[mass * self.m.gravity, -np.cross(spins[name][3:], turned @ spins[name][3:])]
        arms = [poses[name][1].apply(local) for name, local in self.spring]
        places = [poses[name][0] + arm for (name, _), arm in zip(self.spring, arms, strict=True)]
        speeds = [spins[name][:3] + np.cross(spins[name][3:], arm) for (name, _), arm in zip(self.spring, arms, strict=True)]
        apart = places[1] - places[0]
        line = apart / np.linalg.norm(apart)
        pull = (20.0 * (np.linalg.norm(apart) - 0.7) + 2.0 * line @ (speeds[1] - speeds[0])) * line
        for (name, _), arm, force in zip(self.spring, arms, (pull, -pull), strict=True):
            total[name] += np.r_[force, np.cross(arm, force)]
        last = self.names()[-1]
        total[last] += np.r_[3.0 * poses[last][1].apply(self.push[0]), 2.0 * self.push[1]]
        return np.concatenate([total[name] for name in self.names()])

    def accelerations(self, poses, v):
        """(6 n,) in the drawing's axes; where rows are redundant, they are as determined as ever."""
        C = self.jacobian(poses)
        change = (self.jacobian(self.moved(poses, H * v)) - self.jacobian(self.moved(poses, -H * v))) / (2 * H) @ v
        blocks = []
        for name in self.names():
            R = poses[name][1].as_matrix()
            blocks += [self.mass[name][0] * np.eye(3), R @ self.mass[name][1] @ R.T]
        W = np.zeros((len(v), len(v)))
        for k, block in enumerate(blocks):
            W[3 * k:3 * k + 3, 3 * k:3 * k + 3] = np.linalg.inv(block)
        free = W @ self.loads(poses, v)
        pushed = np.linalg.lstsq(C @ W @ C.T, C @ free + change, rcond=1e-7)[0]
        return free - W @ C.T @ pushed


def _held(first, second, kind, local1, local2, axes):
    """Constraint residuals of a joint, from the poses of its bodies."""
    (at1, R1), (at2, R2) = first, second
    apart = at2 + R2.apply(local2) - at1 - R1.apply(local1)
    (a1, a2), (n1, n2) = [(R1.apply(one), R2.apply(other)) for one, other in axes]
    t1, t2 = np.cross(a1, n1), np.cross(a2, n2)
    same = np.r_[np.cross(a1, a2), np.cross(n1, n2), np.cross(t1, t2)]
    across = np.cross(a1, apart)
    angle = np.arctan2(n2 @ t1, n2 @ n1)
    return {"revolute": np.r_[apart, np.cross(a1, a2)], "prismatic": np.r_[across, same], "weld": np.r_[apart, same],
            "cylindrical": np.r_[across, np.cross(a1, a2)], "universal": np.r_[apart, a1 @ n2], "spherical": apart,
            "planar": np.r_[a1 @ apart, np.cross(a1, a2)], "slot": across,
            "screw": np.r_[across, np.cross(a1, a2), a1 @ apart - PITCH / (2 * np.pi) * angle],
            "rod": np.linalg.norm(apart)}[kind]      # less its length, which its derivatives do not see


class Compared:
    """One random mechanism, and how far the core is off in accelerations, the balance of reactions, and the end of a motion."""

    def __init__(self, seed, on_ground=None, loops=2, coordinates=None):
        rng = np.random.default_rng(seed)
        self.plain = Plain(rng, int(rng.integers(1, 5)), int(rng.integers(0, loops + 1)), on_ground, coordinates)
        _, s, vt = np.linalg.svd(self.plain.jacobian(self.plain.pose))
        rank = int((s > 1e-6 * s[0]).sum())
        # nearly dependent rows would need more digits than differences have
        self.can_be = self.plain.system.nv > 0 and s[:rank].min() >= 1e-2 * s[0]
        free = vt[rank:].T
        self.v = free @ drawn_in(free, rng)

    def _run(self, formulation, span, step):
        system, own = self.plain.system, self.v.reshape(-1, 6).copy()
        poses = system._core.poses(system.p0)[0]
        own[:, 3:] = [Rotation.from_quat(pose[3:], scalar_first=True).inv().apply(w)
                      for pose, w in zip(poses, own[:, 3:], strict=True)]
        start = system._core.state(poses, own)[1]
        p, v = zd.assemble(system, system.p0, start)        # the model's rows are as exact as differences are
        return zd.simulate(system, span, p, v, step=step, formulation=formulation)

    def accelerations(self, formulation):
        """Error of the accelerations, and residual of mass times acceleration less all forces; each relative to its maximum."""
        expected, sol = self.plain.accelerations(self.plain.pose, self.v), self._run(formulation, 1e-6, 1e-6)
        found = np.concatenate([[*sol[f"{name}.center.acceleration"][0], *sol[f"{name}.angular_acceleration"][0]]
                                for name in self.plain.names()])
        size = max(np.abs(expected).max(), 1.0)
        return np.abs(found - expected).max() / size, np.abs(self._unbalanced(sol, found)).max() / size

    def _unbalanced(self, sol, found):
        """Residual of Newton-Euler: mass times acceleration less all forces, reactions included, (6 n,)."""
        plain = self.plain
        left = dict(zip(plain.names(), plain.loads(plain.pose, self.v).reshape(-1, 6).copy(), strict=True))
        for joint, (first, second, place) in plain.joints.items():
            force = sol[f"{joint}.force"][0]
            torque = sol[f"{joint}.torque"][0] if f"{joint}.torque" in plain.system.measures else np.zeros(3)
            for body, sign in ((first, -1), (second, 1)):
                if body != "ground":
                    left[body] += sign * np.r_[force, torque + np.cross(place - plain.pose[body][0], force)]
        for name, change in zip(plain.names(), found.reshape(-1, 6), strict=True):
            R, (mass, J, _) = plain.pose[name][1].as_matrix(), plain.mass[name]
            left[name] -= np.r_[mass * change[:3], R @ J @ R.T @ change[3:]]
        return np.concatenate(list(left.values()))

    def motion(self, formulation, span=0.01, steps=2):
        """Largest error of the positions at the end, m."""
        sol, poses, v = self._run(formulation, span, span / steps), self.plain.pose, self.v
        for _ in range(steps):
            poses, v = self._step(poses, v, span / steps)
        return max(np.abs(sol[f"{name}.center.position"][-1] - poses[name][0]).max() for name in self.plain.names())

    def _step(self, poses, v, h):
        """One step of RK4: turns add up by increments, whose own change with the attitude is taken to third order."""
        k = []
        for part in (0, 0.5, 0.5, 1):
            moved, u = (poses, v) if not k else (self.plain.moved(poses, part * h * k[-1][0]), v + part * h * k[-1][1])
            rate = u.reshape(-1, 6).copy()
            if k:
                turned = (part * h * k[-1][0]).reshape(-1, 6)[:, 3:]
                twist = np.cross(turned, rate[:, 3:])
                rate[:, 3:] += -twist / 2 + np.cross(turned, twist) / 12
            k.append((rate.ravel(), self.plain.accelerations(moved, u)))
        step, change = ((k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]) * h / 6 for i in (0, 1))
        return self.plain.moved(poses, step), v + change
