"""Mechanisms in the plane in plain NumPy, in absolute coordinates: a model that shares no code with the package.

Every number that constraints and forces are made of is carried with its row, its rate and what its second derivative has besides
row vdot. The unknowns of a body are x, y of its mass centre and its angle; the ground has none.
"""

import numpy as np

QUARTER = np.array([[0.0, -1.0], [1.0, 0.0]])


class Number:
    """A scalar or a vector: value, row (..., n), rate, and quad, its second derivative where vdot = 0."""

    def __init__(self, value, row, rate, quad):
        self.value, self.row, self.rate, self.quad = value, row, rate, quad

    def __add__(self, other):
        return Number(self.value + other.value, self.row + other.row, self.rate + other.rate, self.quad + other.quad)

    def __mul__(self, factor):
        return Number(self.value * factor, self.row * factor, self.rate * factor, self.quad * factor)

    def __sub__(self, other):
        return self + other * -1.0

    def __matmul__(self, other):
        """The dot product of two vectors."""
        return Number(self.value @ other.value, self.value @ other.row + other.value @ self.row,
                      self.value @ other.rate + other.value @ self.rate,
                      self.value @ other.quad + other.value @ self.quad + 2 * self.rate @ other.rate)

    def root(self):
        """The square root of a scalar."""
        root = np.sqrt(self.value)
        rate = self.rate / (2 * root)
        return Number(root, self.row / (2 * root), rate, (self.quad - 2 * rate**2) / (2 * root))


class Bodies:
    """Poses and velocities of all bodies at one state q, v (n,)."""

    def __init__(self, q, v):
        self.q, self.v, self.n = q, v, len(q)

    def angle(self, body):
        row = np.zeros(self.n)
        if body < 0:
            return Number(0.0, row, 0.0, 0.0)
        row[3 * body + 2] = 1.0
        return Number(self.q[3 * body + 2], row, self.v[3 * body + 2], 0.0)

    def direction(self, body, local):
        """A direction (2,) that turns with a body."""
        if body < 0:
            return Number(np.array(local, dtype=float), np.zeros((2, self.n)), np.zeros(2), np.zeros(2))
        angle, turning = self.q[3 * body + 2], self.v[3 * body + 2]
        value = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]) @ local
        row = np.zeros((2, self.n))
        row[:, 3 * body + 2] = QUARTER @ value
        return Number(value, row, turning * QUARTER @ value, -turning**2 * value)

    def point(self, body, local):
        """A point at (2,) from a body's mass centre, in the body's axes."""
        point = self.direction(body, local)
        if body >= 0:
            centre = np.zeros((2, self.n))
            centre[0, 3 * body] = centre[1, 3 * body + 1] = 1.0
            point = point + Number(self.q[3 * body : 3 * body + 2], centre, self.v[3 * body : 3 * body + 2], np.zeros(2))
        return point


def rows_of(joint, bodies):
    """The rows of a joint, each a Number that is zero; and those that are nonholonomic, whose rate is zero."""
    first, second = bodies.point(joint["first"], joint["point1"]), bodies.point(joint["second"], joint["point2"])
    apart, turn = second - first, bodies.angle(joint["second"]) - bodies.angle(joint["first"])
    turn = turn + constant(bodies, -joint.get("angle", 0.0))
    components = [apart @ bodies.direction(-1, axis) for axis in ((1.0, 0.0), (0.0, 1.0))]
    kind = joint["kind"]
    if kind == "revolute":
        return components
    if kind == "weld":
        return [*components, turn]
    if kind == "rod":
        return [(apart @ apart).root() + constant(bodies, -joint["length"])]
    across = apart @ bodies.direction(joint["first"], QUARTER @ joint["axis"]) if "axis" in joint else None
    if kind == "slot":
        return [across]
    if kind == "prismatic":
        return [across, turn]
    assert kind == "rolling"        # on the ground, along x, which rolls forward as it turns clockwise
    rolled = components[0] + constant(bodies, -joint["along"]) + turn * joint["radius"]
    return [components[1] + constant(bodies, -joint["radius"]), rolled]


def constant(bodies, value):
    return Number(value, np.zeros(bodies.n), 0.0, 0.0)


def coordinate(joint, bodies):
    """The angle or displacement that drives and springs act along."""
    if joint["kind"] == "revolute":
        turn = bodies.angle(joint["second"]) - bodies.angle(joint["first"])
        return turn + constant(bodies, -joint["angle"])
    apart = bodies.point(joint["second"], joint["point2"]) - bodies.point(joint["first"], joint["point1"])
    return apart @ bodies.direction(joint["first"], joint["axis"]) + constant(bodies, -joint["along"])


class Model:
    """A mechanism that is described by plain dicts: `mass` (n,), joints, drives, knife edges, springs, forces, gravity."""

    def __init__(self, description):
        self.d = description
        self.M = np.repeat(description["mass"], 1)

    def constraints(self, t, q, v):
        """Rows (m, n), right sides of C vdot = xi, and which joint each row belongs to (None: none)."""
        bodies, rows, right, owners = Bodies(q, v), [], [], []
        for i, joint in enumerate(self.d["joints"]):
            for row in rows_of(joint, bodies):
                rows.append(row.row), right.append(-row.quad), owners.append(i)
        for drive in self.d["drives"]:
            row = coordinate(self.d["joints"][drive["joint"]], bodies)
            rows.append(row.row), right.append(drive["second_derivative"](t) - row.quad), owners.append(drive["joint"])
        for blade in self.d["blades"]:
            across = bodies.direction(blade["body"], QUARTER @ blade["axis"])
            point = bodies.point(blade["body"], blade["point"])
            rows.append(across.value @ point.row), owners.append(None)
            right.append(-(across.rate @ point.rate + across.value @ point.quad))
        return np.array(rows).reshape(-1, len(q)), np.array(right), owners

    def forces(self, t, q, v):
        """Applied forces (n,), and of them what acts through each joint (joints, n)."""
        bodies = Bodies(q, v)
        f = np.zeros(len(q))
        for i in range(len(q) // 3):
            f[3 * i : 3 * i + 2] += self.M[3 * i] * self.d["gravity"]
        through = np.zeros((len(self.d["joints"]), len(q)))
        for spring in self.d["springs"]:
            apart = bodies.point(spring["second"], spring["point2"]) - bodies.point(spring["first"], spring["point1"])
            length = (apart @ apart).root()
            f -= length.row * (spring["stiffness"] * (length.value - spring["length"]) + spring["damping"] * length.rate)
        for force in self.d["forces"]:
            point = bodies.point(force["body"], force["point"])
            f += force["value"] * bodies.direction(force["frame"], force["axis"]).value @ point.row
        for effort in self.d["efforts"]:       # torsion springs, dampers and motors of effort at joints
            x = coordinate(self.d["joints"][effort["joint"]], bodies)
            value = effort["constant"] - effort["stiffness"] * x.value - effort["damping"] * x.rate
            f += value * x.row
            through[effort["joint"]] += value * x.row
        return f, through

    def solve(self, t, q, v):
        """Accelerations (n,), multipliers of least norm (m,), rows (m, n), and their owners."""
        C, right, owners = self.constraints(t, q, v)
        f, _ = self.forces(t, q, v)
        m = len(C)
        matrix = np.block([[np.diag(self.M), C.T], [C, np.zeros((m, m))]])
        x = np.linalg.lstsq(matrix, np.concatenate([f, right]), rcond=1e-11)[0]
        return x[: len(q)], x[len(q):], C, owners

    def reaction(self, joint, q, C, owners, multipliers, through):
        """Force (2,) and torque that a joint exerts on its second body, at the second's point (rolling: at the contact)."""
        description, bodies = self.d["joints"][joint], Bodies(q, 0 * q)
        mine = np.array([owner == joint for owner in owners])
        generalized = through[joint] - C[mine].T @ multipliers[mine]
        body = description["second"]
        point = bodies.point(body, description["point2"]).value
        if description["kind"] == "rolling":
            point = point - np.array([0.0, description["radius"]])
        force = generalized[3 * body : 3 * body + 2]
        arm = point - q[3 * body : 3 * body + 2]
        return force, generalized[3 * body + 2] - (arm[0] * force[1] - arm[1] * force[0])
