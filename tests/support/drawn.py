"""A mechanism of all that is drawn, and what a picture holds, read back from its artists: for several tests."""

import numpy as np

import zerodrift as zd


def sorts():
    """All that has a glyph."""
    m = zd.Mechanism("sorts", gravity=(0, -9.81))
    arm = m.link("arm", (0, 0), (1, 0.3), mass=1.0)
    plate = m.body("plate", 1.0, 0.1, at=(3, 0))
    box, piston = m.body("box", 1.0, 0.1, at=(1.2, 0.4)), m.body("piston", 1.0, 0.1, at=(2, 1), angle=0.5)
    bob, bead = m.particle("bob", 1.0, at=(0.6, -0.6)), m.particle("bead", 0.1, at=(0.8, 0.24))
    sleigh, fin = m.body("sleigh", 1, 0.1, at=(-1, 1)), m.body("fin", 0.2, 0.01, at=(3.3, 0.4))
    wheel, ram = m.body("wheel", 1.0, 0.1, at=(-2, 0.5)), m.body("ram", 0.3, 0.01, at=(2.3, 1.3))
    rotors = [m.body(f"rotor{i}", 1.0, 0.1, at=(i, 2)) for i in range(2)]
    arm.point((0.3, 0.1), name="tracer")
    hinge = m.revolute("hinge", m.ground, arm.start)
    corner = m.revolute("corner", m.ground, plate.point((0, 0)))
    m.weld("seam", plate, fin, at=(3.2, 0.3))
    m.bushing("mount", arm, box, at=(1, 0.3), stiffness=100, torsion=10)
    m.rod("rod", arm.point((0.5, 0)), bob)
    m.slot("groove", arm, bead, axis=(1, 0.3))
    rail = m.prismatic("rail", m.ground, piston, axis=(1, 1))
    m.prismatic("telescope", piston, ram, axis=(1, 1))
    m.knife_edge("blade", sleigh, along=(1, 1))
    m.rolling("road", m.ground, wheel, radius=0.5)
    pins = [m.revolute(f"pin{i}", m.ground, rotor.point((0, 0))) for i, rotor in enumerate(rotors)]
    m.gear("mesh", *pins, ratio=-3.0)
    m.spring("coil", m.ground.point((2, -1)), plate.point((0.4, 0.2)), stiffness=20.0)
    m.spring("band", piston.point((0, 0.1)), plate.point((0.4, -0.2)), stiffness=20.0, damping=1.0)
    m.torsion_spring("clock", hinge, stiffness=1.0)
    m.actuator("jack", m.ground.point((2, 3)), piston.point((0, 0)), force=1.0)
    m.motor("turn", corner, torque=-0.1)
    m.motor("push", rail, force=1.0)
    m.force("wind", sleigh, along=(0, 1), value=-1.0)
    m.torque("twist", sleigh, value=1.0)
    m.coupler("cage", {pins[0].angle: 1.0, pins[1].angle: 1.0, _third(m).angle: 1.0})
    m.particle("nut", 0.1, at=arm.end)
    m.start({"pin0.speed": 2.0, "wheel.angular_velocity": -1.0})
    return m


def _third(m):
    return m.revolute("pin2", m.ground, m.body("rotor2", 1.0, 0.1, at=(4, 2)).point((0, 0)))


def collection(ax, kind):
    """The collection of the axes that draws all parts of a kind."""
    (found,) = [each for each in ax.collections if each.get_label() == f"_{kind}"]
    return found


def outlines(ax, kind):
    return [path.vertices for path in collection(ax, kind).get_paths()]


def centres(ax, kind):
    """The middles of what is drawn of a kind, (n, 2)."""
    return np.array([(points.min(axis=0) + points.max(axis=0)) / 2 for points in outlines(ax, kind)])


def is_among(place, places, within=1e-9):
    return np.hypot(*(np.asarray(places) - place).T).min() < within
