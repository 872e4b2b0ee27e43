"""Mechanisms in which every joint, element and law of the core's tables and of the verbs stands once: nothing user-written."""

import numpy as np
import sympy as sp

import zerodrift as zd


def machinery():
    """Joints that carry and joints that close loops, drives of all kinds, couplings, a cam by a table."""
    t, a = sp.symbols("t a")
    m = zd.Mechanism("machinery", gravity=(0.3, -9.81), parameters={"a": 0.4})
    crank = m.link("crank", (0, 0), (0.1, 0.05), mass=0.5)
    rod = m.body("rod", 0.3, 0.01, at=(0.1, 0.05), com=(0.2, 0.03))
    piston = m.particle("piston", 0.4, at=(0.4, 0))
    main = m.revolute("main", m.ground, crank.start, damping=0.02)
    m.revolute("pin", crank.end, rod.point((0, 0)))
    m.rod("wrist", rod.point((0.25, 0.02)), piston, length=0.12)
    slide = m.slot("slide", crank, piston, axis=(1, 0.5))
    m.particle("bob", 0.2, at=crank.end)
    m.motor("drive", main, angle=a * sp.sin(3 * t))
    plate = m.body("plate", 1.2, 0.2, at=(1, 1), angle=0.3, com=(0.05, -0.1))
    cart = m.body("cart", 0.8, 0.05, at=(1.2, 0.9), angle=-0.4)
    track = m.prismatic("track", plate, cart, axis=(1, 0.3), at=(1.1, 1.0), damping=0.3)
    m.weld("shelf", cart, m.body("shelf body", 0.3, 0.02, at=(1.4, 1.1)), at=(1.3, 1.0))
    m.motor("thrust", track, force=-2.0)
    hinge = m.revolute("hinge", m.ground, plate, at=(0.8, 1.0))
    m.torsion_spring("coil", hinge, stiffness=4.0, angle=0.3, damping=0.2)
    wheels = [m.body(f"wheel{i}", 1.0, 0.1 + 0.05 * i, at=(3.0 + i, 0)) for i in range(3)]
    pins = [m.revolute(f"pin{i}", m.ground, wheel.point((0.0, 0.0))) for i, wheel in enumerate(wheels)]
    m.gear("gear", pins[0], pins[1], ratio=-2.0)
    m.coupler("cage", {pins[0].angle: 1.0, pins[1].angle: 1.0, pins[2].angle: -2.5})
    rack = m.prismatic("rack", m.ground, m.body("bar", 0.7, 0.01, at=(3, 1)), axis=(0.6, 0.8), at=(3, 1))
    m.rack_pinion("pinion", hinge, rack, ratio=0.2)
    follower = m.prismatic("follower", m.ground, m.body("tappet", 0.2, 0.01, at=(4, 1)), axis=(0, 1), at=(4, 1))
    m.cam("cam", pins[2], follower, profile=(np.linspace(0, 2 * np.pi, 9)[:-1], [0, 0.01, 0.02, 0.03, 0.03, 0.02, 0.01, 0]))
    m.motor("twist", pins[0], torque=sp.cos(t) - sp.Symbol("s") ** 2, of={"s": slide.displacement})
    return m


def hinged():
    """Hinges alone, which the core has a road of its own for: branches, a weld, particles, mass beside the lines, two loops."""
    m = zd.Mechanism("hinged", gravity=(0.3, -9.81))
    bodies = [m.body(f"B{i}", 1.0 + 0.3 * i, 0.05 + 0.01 * i, at=(0.5 * i, 0.2 * i), angle=0.4 * i - 1, com=(0.1, 0.07 * i - 0.1))
              for i in range(5)]
    for i, (first, second) in enumerate(((m.ground, bodies[0]), (bodies[0], bodies[1]), (bodies[0], bodies[2]))):
        m.revolute(f"J{i}", first, second, at=(0.5 * i, 0.2 * i + 0.1))
    m.weld("plate", bodies[2], bodies[3], at=(1.2, 0.6))
    m.revolute("J3", bodies[3], bodies[4], at=(1.6, 0.9))
    bob = m.particle("bob", 0.4, at=(2.1, 1.0))
    m.revolute("string", bodies[4].point(at=(2.1, 1.0)), bob)
    m.revolute("cut", m.ground.point((2.0, 0.3)), bodies[4].point(at=(2.0, 0.3)), cut=True)
    m.revolute("other cut", bodies[1].point((0.3, 0.2)), bodies[4].point(at=bodies[1].point((0.3, 0.2))), cut=True)
    return m


def vehicles():
    """Free bodies: rolling, a blade, forces and torques that turn with bodies, rows of the user's own, drives by speed."""
    t, x, y, w = sp.symbols("t x y w")
    m = zd.Mechanism("vehicles", gravity=(0, -9.81))
    wheel = m.body("wheel", 1.0, 0.1, at=(0, 0.3), com=(0.02, 0.01))
    m.rolling("rolling", m.ground, wheel.point((0, 0)), radius=0.3)
    sleigh = m.body("sleigh", 2.0, 0.3, at=(2, 1), angle=0.5, com=(0.1, 0.0))
    m.knife_edge("blade", sleigh.point((0, 0.1)), along=(0.8, 0.6))
    m.force("thrust", sleigh.point((0.2, 0)), along=(0.6, 0.8), value=1.5, frame=sleigh)
    m.force("drag", sleigh, along=(1, 0), value=-w * sp.Abs(w) + t, of={"w": "sleigh.angular_velocity"})
    m.torque("moment", wheel, value=0.7, against=sleigh)
    m.bushing("mount", wheel, sleigh, at=(1, 0.7), stiffness=(30, 20), damping=(1, 0.5), torsion=2.0, torsion_damping=0.1)
    m.spring("spring", m.ground.point((1, 2)), sleigh.point((0.1, 0.2)), stiffness=20, length=0.7, damping=0.8)
    m.spring("strut", m.ground.point((2, 3)), sleigh.point((0.1, 0)), force=8 * (x - 1)**3 + y, damping=0.3,
             of={"x": "strut.length", "y": "strut.speed"})
    ball = m.particle("ball", 0.5, at=(-1, 1))
    m.constraint("bowl", y - x**2 / 2 - sp.sin(t) / 9, of={"x": ball.position.x, "y": ball.position.y})
    disc = m.body("disc", 1.0, 0.2, at=(-2, 0))
    axle = m.revolute("axle", m.ground, disc.point((0.0, 0.0)))
    m.motor("governor", axle, speed=2 + sp.cos(t) * x, of={"x": ball.position.x})
    fan = m.revolute("fan axle", m.ground, m.body("fan", 1.5, 0.3, at=(-3, 0)).point((0, 0)))
    m.motor("fan motor", fan, speed=1.5)
    lift = m.prismatic("lift", m.ground, m.body("cabin", 3.0, 1.0, at=(-4, 0)), axis=(0, 1), at=(-4, 0))
    m.motor("hoist", lift, displacement=0.1 * t**2)
    kart = m.body("kart", 1.0, 0.1, at=(-5, 0))
    m.nonholonomic("steer", w - sp.sin(x) * y, of={"w": kart.angular_velocity, "x": kart.angle, "y": kart.velocity.x})
    return m


def coupled_bodies():
    """Bodies in space: damped, driven and skew swivels, forces against bodies and points, a rotor, a coupled bushing, a ring."""
    t = sp.Symbol("t")
    m = zd.Mechanism("coupled bodies", dimension=3, gravity=(0.3, 0.2, -9.81))
    bodies = [m.body(f"B{i}", 1.0 + 0.2 * i, (0.3, 0.4 + 0.05 * i, 0.5), at=(0.5 * i, 0.1, 0.2 * i), com=(0.05, 0.02, 0.1 * i))
              for i in range(5)]
    m.spherical("socket", m.ground, bodies[0], at=(0, 0, 0.1), damping=0.2)
    right = m.universal("right", bodies[0], bodies[1], at=(0.3, 0, 0.1), axes=((1, 0, 0), (0, 1, 1)), damping=0.1)
    m.motor("drive", right.angle1, torque=sp.sin(3 * t))
    skew = m.universal("skew", bodies[1], bodies[2], at=(0.8, 0, 0.3), axes=((1, 0, 0), (0.3, 1, 0)))
    m.torsion_spring("coil", skew.angle2, stiffness=3.0, angle=0.2, damping=0.1)
    hinge = m.revolute("hinge", bodies[2], bodies[3], at=(1.2, 0, 0.5), axis=(0, 1, 1))
    m.motor("geared", hinge, torque=0.4, rotor=1e-3, ratio=12.0)
    K = np.diag([200.0, 300, 250, 20, 30, 25]) + 5 * (np.eye(6, k=1) + np.eye(6, k=-1))
    m.bushing("rubber", m.ground, bodies[4], at=(2.0, 0.1, 0.8), stiffness=K, damping=(1.0, 2.0, 3.0), torsion_damping=0.3)
    near, far = bodies[0], bodies[4].center
    for name, against, frame in (("drawn", near, None), ("own", near, near), ("pair", far, bodies[1])):
        m.force(name, bodies[2].point((0.1, 0.2, 0.1)), along=(1, 2, -1), value=1.5 + t, against=against, frame=frame)
    wheel = m.body("wheel", 0.5, (0.01, 0.01, 0.02), at=(5, 0.7, 0))
    m.rolling("ring", m.ground, wheel, radius=0.3, ring=1.0, at=(5, 0, 0), axle=(0, 0, 1))
    return m
