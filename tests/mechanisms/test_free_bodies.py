"""Reported loads of machines against free bodies: forces and moments on each body are those of its acceleration.

Joints act at the second body's point, which is found here from poses; teeth act at pitch points that are found here from radii.
"""

import numpy as np
import pytest

import zerodrift as zd
from zerodrift.mechanisms.elements.bodies import Body
from zerodrift.mechanisms.elements.forces import Force, Spring
from zerodrift.mechanisms.elements.table_forces import TableForce

PRESSURE = np.radians(20.0)


def embedded(vector):
    """Vectors (k, 2) or (k, 3) as (k, 3)."""
    return np.pad(vector, ((0, 0), (0, 3 - vector.shape[1])))


class FreeBodies:
    """Sums (k, 3) of forces, and of moments about the origin, by body."""

    def __init__(self, m, sol):
        self.m, self.sol, self.size = m, sol, len(sol.t)
        self.bodies = [body for body in m.bodies if not getattr(body, "attachment", None)]
        self.force = {body.name: np.zeros((self.size, 3)) for body in m.bodies} | {"ground": np.zeros((self.size, 3))}
        self.moment = {name: np.zeros((self.size, 3)) for name in self.force}
        self.scale = 0.0

    def rotation(self, body):
        if body.name == "ground" or not body.turns:
            return np.broadcast_to(np.eye(3), (self.size, 3, 3))
        if self.m.dimension == 3:
            return self.sol[f"{body.name}.rotation"]
        c, s = np.cos(self.sol[f"{body.name}.angle"]), np.sin(self.sol[f"{body.name}.angle"])
        zero, one = np.zeros_like(c), np.ones_like(c)
        return np.moveaxis(np.array([[c, -s, zero], [s, c, zero], [zero, zero, one]]), 2, 0)

    def at(self, body, local):
        origin = np.zeros((self.size, 3)) if body.name == "ground" else embedded(self.sol[f"{body.name}.position"])
        return origin + self.rotation(body) @ np.append(local, 0.0)[:3]

    def act(self, body, force, at, moment=0.0):
        force = embedded(np.broadcast_to(force, (self.size, np.shape(force)[-1])))
        self.force[body.name] += force
        self.moment[body.name] += np.cross(at, force) + moment
        self.scale = max(self.scale, np.abs(force).max())

    def joints(self):
        for joint in self.m.joints:
            force, first, second = self.sol[joint.force], *joint.bodies
            at = self.at(second, joint.second.local)
            torque = self.sol[f"{joint.name}.torque"] if f"{joint.name}.torque" in self.m.measures else np.zeros(self.size)
            moment = torque if torque.ndim == 2 else np.outer(torque, [0, 0, 1])
            self.act(second, force, at, moment)
            self.act(first, -force, at, -moment)

    def springs(self):
        for spring in [each for each in self.m._elements.values() if isinstance(each, Spring)]:
            first, second = (self.at(point.body, point.local) for point in (spring.first, spring.second))
            pull = self.sol[spring.force][:, None] * (second - first) / np.linalg.norm(second - first, axis=1)[:, None]
            self.act(spring.first.body, pull, first)
            self.act(spring.second.body, -pull, second)

    def loads(self):
        for force in [each for each in self.m._elements.values() if isinstance(each, Force)]:
            at = self.at(force.point.body, force.point.local)
            vector = self.sol[f"{force.name}.force"][:, None] * (self.rotation(force.frame) @ np.append(force.along, 0.0)[:3])
            self.act(force.point.body, vector, at)
            self.act(self.m.ground, -vector, at)

    def missing(self):
        """Largest errors of Newton's and Euler's equations, relative to the largest force, and that of the ground's load."""
        worst = 0.0
        for body in self.bodies:
            attached = [each for each in self.m.bodies if getattr(each, "attachment", None)]
            parts = [body, *(each for each in attached if each.attachment.body is body)]
            need, moment = np.zeros((self.size, 3)), np.zeros((self.size, 3))
            for part in parts:
                base = f"{part.name}.center" if part.turns else part.name
                r, a = embedded(self.sol[f"{base}.position"]), embedded(self.sol[f"{base}.acceleration"])
                a = a - np.append(self.m.gravity, 0.0)[:3]
                need += part.mass * a
                moment += part.mass * np.cross(r, a)
                if part.turns and self.m.dimension == 2:
                    moment += np.outer(part.inertia * self.sol[f"{part.name}.angular_acceleration"], [0, 0, 1])
                elif part.turns:
                    R, w = self.rotation(part), self.sol[f"{part.name}.angular_velocity"]
                    J = R @ np.asarray(part.inertia) @ R.transpose(0, 2, 1)
                    h = np.einsum("kij,kj->ki", J, w)
                    moment += np.einsum("kij,kj->ki", J, self.sol[f"{part.name}.angular_acceleration"]) + np.cross(w, h)
            worst = max(worst, np.abs(self.force[body.name] - need).max(), np.abs(self.moment[body.name] - moment).max())
        ground = embedded(self.sol["ground.force"])
        return worst / self.scale, np.abs(ground - self.force["ground"]).max() / self.scale


def teeth(of, mesh, sun, planet, radii, carrier):
    """Add the tooth force of an external mesh, or of a ring (a negative radius), from radii and directions of this test."""
    torque, pressure = of.sol[f"{mesh}.torque"], np.tan(PRESSURE)
    one, other = (embedded(of.sol[f"{each}.position"]) if each != "ground" else np.zeros((of.size, 3)) for each in (sun, planet))
    n = (other - one) / np.linalg.norm(other - one, axis=1)[:, None]
    t = np.cross([0, 0, 1.0], n)
    at = one + abs(radii[0]) * n
    arm = -radii[1] if radii[0] > 0 else radii[1]       # from the planet's centre to the pitch point, along n
    tangential = torque / arm
    force = tangential[:, None] * t + np.abs(tangential)[:, None] * pressure * n * (1 if radii[0] > 0 else -1)
    of.act(of.m[planet], force, at)
    of.act(of.m[sun] if sun != "ground" else of.m.ground, -force, at)


def v_twin():
    m = zd.Mechanism("V-twin", gravity=(0, -9.81))
    crank = m.body("crank", 6.0, 0.03, com=(-0.01, 0))
    m.revolute("main", m.ground, crank, at=(0, 0))
    for side, angle in (("left", np.radians(135)), ("right", np.radians(45))):
        axis = np.array([np.cos(angle), np.sin(angle)])
        reach = 0.04 * axis[0] + np.sqrt(0.15**2 - (0.04 * axis[1])**2)
        rod = m.link(f"{side} rod", (0.04, 0), reach * axis, mass=0.5)
        piston = m.particle(f"{side} piston", 0.4, at=reach * axis)
        m.revolute(f"{side} pin", crank.point((0.04, 0)), rod.start)
        m.revolute(f"{side} wrist", rod.end, piston)
        m.slot(f"{side} bore", m.ground, piston, axis=axis)
    m.motor("drive", "main", speed=628.0)
    return m


def crane():
    m = zd.Mechanism("crane", gravity=(0, -9.81))
    trolley, jib = m.body("trolley", 50.0, 2.0, at=(1, 4)), m.link("jib", (0, 3), (3, 4.5), mass=80.0)
    m.revolute("mast", m.ground, jib.start)
    m.spring("tie", m.ground.point((0, 5)), jib.point((2.5, 0)), stiffness=5e4, length=1.0)
    m.prismatic("track", jib, trolley, axis=(3, 1.5), at=(1, 3.5))
    m.motor("winch", "track", displacement=lambda t: 0.2 * np.sin(2 * t))
    load = m.link("load", (1, 4), (1.2, 2), mass=30.0)
    m.revolute("hook", trolley.point((0, 0)), load.start)
    return m


def bracket():
    m = zd.Mechanism("arm in space", dimension=3, gravity=(0, 0, -9.81))
    inertia = ((0.3, 0.02, 0), (0.02, 0.4, 0.01), (0, 0.01, 0.2))
    turret = m.body("turret", 8.0, inertia, at=(0, 0, 0.3), com=(0.05, 0.02, 0.1))
    arm = m.link("arm", (0, 0, 0.5), (0.6, 0, 0.8), mass=3.0)
    m.revolute("yaw", m.ground, turret, at=(0, 0, 0), axis=(0, 0, 1))
    m.revolute("pitch", turret, arm.start, axis=(0, 1, 0))
    m.spring("balance", turret.point(at=(0.2, 0, 0.2)), arm.point((0.3, 0, 0)), stiffness=800.0, length=0.2)
    m.motor("drive", "yaw", speed=4.0)
    return m


def cut(model):
    m = model
    m.force("cut", m.bodies[-1], along=(1, *[0.3] * (m.dimension - 1)), value=lambda t: 30 * np.cos(5 * t))
    return m


def geneva():
    """Four slots, while the pin is in one of them: the crank's arm and the slot are square where it comes and goes."""
    m = zd.Mechanism("Geneva", gravity=(0, -9.81))
    crank = m.body("crank", 2.0, 0.01, com=(0.01, 0))
    wheel = m.body("wheel", 3.0, 0.02, at=(0.1 * np.sqrt(2), 0), angle=np.pi)
    pin = 0.1 * np.array([np.cos(0.6), np.sin(0.6)])
    m.revolute("main", m.ground, crank, at=(0, 0))
    m.revolute("axle", m.ground, wheel, at=(0.1 * np.sqrt(2), 0))
    m.slot("slot", wheel.point(at=(0.1 * np.sqrt(2), 0)), crank.point(at=pin), axis=pin - [0.1 * np.sqrt(2), 0])
    m.force("work", wheel.point((0, 0.08)), along=(1, 0), frame=wheel, value=lambda t: 30 * np.cos(5 * t))
    m.motor("drive", "main", speed=-12.0)
    return m


MACHINES = {
    "V-twin": v_twin, "shaper": lambda: cut(zd.models.quick_return()), "press": lambda: cut(zd.models.toggle_press()),
    "scissor lift": lambda: cut(zd.models.scissor_lift()), "crane": crane, "four-bar": lambda: cut(zd.models.four_bar()),
    "slider-crank": zd.models.slider_crank, "arm in space": bracket, "Stewart platform": zd.models.stewart_platform,
    "heavy top": zd.models.heavy_top, "wishbone": zd.models.double_wishbone, "Geneva": geneva}


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
@pytest.mark.parametrize("name", MACHINES)
def test_loads_are_those_of_free_bodies(name, coordinates):
    m = MACHINES[name]()
    known = (Body, Spring, Force)
    assert not [each for each in m._elements.values() if isinstance(each, TableForce) and not isinstance(each, known)]
    of = FreeBodies(m, zd.simulate(m.system(coordinates), 0.02, step=1e-3))
    of.joints()
    of.springs()
    of.loads()
    newton, ground = of.missing()
    assert newton < 1e-9
    assert ground < 1e-9


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_loads_of_a_differential_are_those_of_free_bodies(coordinates):
    """Carrier about x, two side gears of radius 0.05 m in it, and a pinion of 0.03 m about an axis across, all bevel gears."""
    m, pitch, small, large = zd.Mechanism("differential", dimension=3, gravity=(0, 0, -9.81)), np.radians(20.0), 0.03, 0.05
    carrier = m.body("carrier", 5.0, (0.08, 0.05, 0.06))
    m.revolute("main", m.ground, carrier, at=(0.1, 0, 0), axis=(1, 0, 0))
    pinion = m.body("pinion", 0.4, (2e-4, 3e-4, 2e-4), at=(0, large, 0))
    m.revolute("pinion axle", carrier, pinion, at=(0, large, 0), axis=(0, 1, 0))
    for side, sign in (("left", -1), ("right", 1)):
        wheel = m.body(side, 1.0 + 0.5 * sign, (2e-3, 1.5e-3, 1.5e-3), at=(sign * small, 0, 0))
        m.revolute(f"{side} axle", carrier, wheel, at=(sign * small, 0, 0), axis=(1, 0, 0))
        m.gear(f"{side} mesh", f"{side} axle", "pinion axle", ratio=-sign * large / small, pressure_angle=pitch, radius=small)
        m.force(f"{side} wheel", wheel.point((0, 0.04, 0)), along=(0, 0, 1), frame=wheel, value=20.0 + 5 * sign)
    m.motor("drive", "main", speed=lambda t: 15.0 + np.sin(9 * t))
    of = FreeBodies(m, zd.simulate(m.system(coordinates), 0.05, step=1e-3))
    of.joints()
    of.loads()
    x, y, z = (of.rotation(carrier)[:, :, k] for k in range(3))
    for side, sign in (("left", -1), ("right", 1)):
        at = sign * small * x + large * y       # where the pitch cones touch; both axes go through the origin
        tangential = of.sol[f"{side} mesh.torque"] / (-sign * small)        # moment about y of a force along z at x = r is -r
        away = (sign * -large * x + small * y) / np.hypot(small, large)
        force = tangential[:, None] * z + np.abs(tangential)[:, None] * np.tan(pitch) * away
        of.act(pinion, force, at)
        of.act(m[side], -force, at)
    newton, ground = of.missing()
    assert newton < 1e-9
    assert ground < 1e-9
    assert np.ptp(of.sol["pinion.angular_velocity"] @ np.ones(3)) > 1


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_loads_of_a_planetary_gear_are_those_of_free_bodies(coordinates):
    """Sun and fixed ring with three planets: both kinds of meshes, moving pitch points, and reactions that are not unique."""
    m = zd.Mechanism("planetary", gravity=(0, -9.81))
    carrier, sun = m.body("carrier", 1.0, 0.01), m.body("sun", 1.5, 0.01)
    m.revolute("main", m.ground, carrier, at=(0, 0))
    m.revolute("sun axle", carrier, sun, at=(0, 0))
    sun_radius, planet_radius = 0.04 / 3, 0.02 / 3
    for i, angle in enumerate(2 * np.pi * np.arange(3) / 3):
        at = 0.02 * np.array([np.cos(angle), np.sin(angle)])
        m.revolute(f"pin{i}", carrier, m.body(f"planet{i}", 0.1 + 0.05 * i, 1e-5, at=at), at=at)
        m.gear(f"sun mesh {i}", "sun axle", f"pin{i}", ratio=-2.0, pressure_angle=PRESSURE)
        m.gear(f"ring mesh {i}", "main", f"pin{i}", ratio=-4.0, pressure_angle=PRESSURE)
    m.motor("drive", "main", speed=lambda t: 25.0 + 40 * np.sin(9 * t))
    of = FreeBodies(m, zd.simulate(m.system(coordinates), 0.05, step=1e-3))
    of.joints()
    for i in range(3):
        teeth(of, f"sun mesh {i}", "sun", f"planet{i}", (sun_radius, planet_radius), "carrier")
        teeth(of, f"ring mesh {i}", "ground", f"planet{i}", (-(0.02 + planet_radius), planet_radius), "carrier")
    newton, ground = of.missing()
    assert newton < 1e-9
    assert ground < 1e-9
