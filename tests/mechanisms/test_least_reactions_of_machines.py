"""Least reactions of random machines, against Newton and Euler: of all wrenches in balance with the accelerations, the least."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import zerodrift as zd

GRAVITY = np.array([1.0, -2.0, -9.81])
INERTIA = np.array([0.1, 0.2, 0.25])
KINDS = {2: ["revolute", "prismatic", "weld"], 3: ["revolute", "spherical", "cylindrical", "prismatic", "weld"]}
ONE, Z = np.eye(3), np.array([0.0, 0.0, 1.0])


class Machine:
    """A chain of bodies from the ground, with joints in parallel to those of the chain, and rods; drawn turned by R."""

    def __init__(self, seed, dimension):
        self.random, self.dimension = np.random.default_rng(seed), dimension
        self.in_plane = ONE if dimension == 3 else np.diag([1, 1, 0])
        self.gravity = self.in_plane @ GRAVITY
        n = int(self.random.integers(2, 5))
        self.at = [np.zeros(3), *(self.in_plane @ (self.random.uniform(-1, 1, 3) + np.array([i, 0, 0])) for i in range(n))]
        self.masses = self.random.uniform(0.5, 3, n + 1)
        kinds = self.random.choice(KINDS[dimension], n)
        self.joints = [(str(kind), i, i + 1, self._place(i), self._axis(kind)) for i, kind in enumerate(kinds)]
        for _ in range(int(self.random.integers(1, 4))):
            self._add_in_parallel()
        for _ in range(int(self.random.integers(0, 3))):
            first, second = sorted(self.random.choice(n + 1, 2, replace=False))
            self.joints.append(("rod", first, second, self._place(first), self._place(second)))

    def _place(self, body):
        return self.in_plane @ (self.at[body] + self.random.uniform(-0.5, 0.5, 3))

    def _axis(self, kind):
        axis = self.in_plane @ self.random.standard_normal(3)
        return Z if self.dimension == 2 and kind == "revolute" else axis / np.linalg.norm(axis)

    def _add_in_parallel(self):
        """A joint that is redundant at least in part, as it leaves the same freedoms as one of the chain."""
        kind, first, second, place, axis = self.joints[int(self.random.integers(0, len(self.at) - 1))]
        shift = 0 if kind == "spherical" else self.random.uniform(0.2, 1)
        self.joints.append((kind, first, second, place + self.in_plane @ (shift * axis), axis))

    def mechanism(self, R=ONE, order=0):
        """The mechanism; `order` rotates the list of its joints, from which the tree is chosen."""
        d = self.dimension
        m = zd.Mechanism("machine", dimension=d, gravity=(R @ self.gravity)[:d])
        drawn = {"rotation": R} if d == 3 else {"angle": np.arctan2(R[1, 0], R[0, 0])}
        bodies = [m.ground, *(m.body(f"b{i}", self.masses[i], INERTIA if d == 3 else INERTIA[2], at=(R @ self.at[i])[:d], **drawn)
                              for i in range(1, len(self.at)))]
        for number in np.roll(np.arange(len(self.joints)), order):
            kind, first, second, place, axis = self.joints[number]
            if kind == "rod":
                m.rod(f"j{number}", bodies[first].point(at=(R @ place)[:d]), bodies[second].point(at=(R @ axis)[:d]))
                continue
            more = {} if kind in ("spherical", "weld") or (d == 2 and kind == "revolute") else {"axis": (R @ axis)[:d]}
            getattr(m, kind)(f"j{number}", bodies[first], bodies[second], at=(R @ place)[:d], **more)
        return m

    def read(self, now, name, R=ONE):
        """A force, torque or acceleration in space, in the axes of the machine."""
        value, found = now[name], np.zeros(3)
        part = slice(2, 3) if np.ndim(value) == 0 else slice(0, len(value))
        found[part] = value
        return found @ R

    def wrenches(self, system, R=ONE):
        """Forces and torques (joints, 6) at the start, in the axes of the machine."""
        now, found = zd.Instant(system), np.zeros((len(self.joints), 6))
        for number in range(len(self.joints)):
            for k, name in enumerate((f"j{number}.force", f"j{number}.torque")):
                if name in system.measures:
                    found[number, 3 * k:3 * k + 3] = self.read(now, name, R)
        return found

    def length(self):
        points = np.array([end for joint in self.joints for end in (joint[3:] if joint[0] == "rod" else joint[3:4])])
        return max(np.linalg.norm(a - b) for a in points for b in points) or 1.0

    def passed_on(self, joint):
        """Basis (k, 6) of the wrenches that a joint may put on its second body, with torques over the length."""
        kind, _, _, place, axis = joint
        across, along = np.linalg.svd(axis[None])[2][1:], (axis - place)[None] / (np.linalg.norm(axis - place) or 1.0)
        forces = {"cylindrical": across, "prismatic": across, "rod": along}.get(kind, ONE)
        torques = {"revolute": across, "cylindrical": across, "spherical": ONE[:0], "rod": ONE[:0]}.get(kind, ONE)
        basis = np.block([[forces, 0 * forces], [0 * torques, torques]])
        if self.dimension == 3:
            return basis
        _u, s, V = np.linalg.svd(basis * (1, 1, 0, 0, 0, 1), full_matrices=False)
        return V[s > 0.5]

    def least(self, now):
        """Wrenches (joints, 6) of the least sum of force^2 + (torque / length)^2 that give the accelerations at rest."""
        length, bodies = self.length(), len(self.at) - 1
        bases = [self.passed_on(joint) for joint in self.joints]
        A = np.zeros((bodies, 6, sum(map(len, bases))))
        column = 0
        for (kind, first, second, place, axis), basis in zip(self.joints, bases, strict=True):
            point = axis if kind == "rod" else place
            for body, sign in ((first, -1), (second, 1)):
                if body:
                    force, torque = basis[:, :3], length * basis[:, 3:]
                    moment = torque + np.cross(point - self.at[body], force)
                    A[body - 1, :, column:column + len(basis)] += sign * np.hstack([force, moment]).T
            column += len(basis)
        right = np.zeros((bodies, 6))
        for i in range(bodies):
            right[i, :3] = self.masses[i + 1] * (self.read(now, f"b{i + 1}.center.acceleration") - self.gravity)
            right[i, 3:] = INERTIA * self.read(now, f"b{i + 1}.angular_acceleration")
        x = np.linalg.lstsq(A.reshape(6 * bodies, column), right.ravel(), rcond=1e-9)[0]
        parts = np.split(x, np.cumsum([len(basis) for basis in bases])[:-1])
        return np.array([part @ basis for part, basis in zip(parts, bases, strict=True)]) * np.repeat([1, length], 3)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("seed", range(16))
def test_reactions_of_random_machines_are_the_least_in_balance(seed, dimension):
    machine = Machine(seed, dimension)
    want = machine.least(zd.Instant(machine.mechanism().system("absolute")))
    R = Rotation.random(random_state=seed) if dimension == 3 else Rotation.from_rotvec(0.3 * (seed + 1) * Z)
    for order, coordinates in ((0, "joint"), (1, "absolute"), (2, "joint"), (3, "joint")):
        turned = R.as_matrix() if order else ONE
        m = machine.mechanism(turned, order)
        got = machine.wrenches(m.system(coordinates if m.system("joint").nv else "absolute"), turned)
        np.testing.assert_allclose(got, want, rtol=0, atol=1e-9 * np.abs(want).max(), err_msg=f"{order} {coordinates}")
