"""Mechanisms of few bodies that several tests and measurements share."""

import zerodrift as zd


def two_links(torque=0.0, speed=None):
    """Two hanging links, whose upper one has a motor with this torque or this speed."""
    m = zd.Mechanism("two links", gravity=(0, -9.81))
    upper, lower = m.link("upper", (0, 0), (0, -1), mass=1.0), m.link("lower", (0, -1), (0, -2), mass=1.0)
    pin = m.revolute("pin", m.ground, upper.start)
    m.revolute("elbow", upper.end, lower.start)
    m.motor("drive", pin, **({"torque": torque} if speed is None else {"speed": speed}))
    return m


def driven_four_bar(**drive):
    """A four-bar with a motor at its crank, whose joint has a damper."""
    m = zd.Mechanism("four-bar", gravity=(0, -9.81))
    crank = m.link("crank", (0, 0), (0, 1), mass=1.0)
    coupler = m.link("coupler", (0, 1), (2, 2), mass=2.0)
    rocker = m.link("rocker", (3, 0), (2, 2), mass=2.0)
    pin = m.revolute("A", m.ground, crank.start, damping=0.5)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground, rocker.start)
    m.motor("drive", pin, **drive)
    return m


def cart_pole():
    """A cart on a rail with a pole on it, whose cart a force drives."""
    m = zd.Mechanism("cart-pole", gravity=(0, -9.81))
    cart = m.link("cart", (0, 0), (0.2, 0), mass=1.0)
    slide = m.prismatic("slide", m.ground, cart.start, axis=(1, 0))
    pole = m.link("pole", (0, 0), (0, 1), mass=0.1)
    m.revolute("hinge", cart.start, pole.start)
    m.motor("drive", slide, force=0.0)
    return m


def crank_and_piston(at=(0.4, 0), **bushing):
    """A slider-crank with its piston drawn at a point; the crank pin gives where its stiffness is given."""
    m = zd.Mechanism("slider-crank", gravity=(0, -9.81))
    crank, rod = m.link("crank", (0, 0), (0.1, 0), mass=0.5), m.link("rod", (0.1, 0), (0.4, 0), mass=0.3)
    piston = m.particle("piston", 0.4, at=at)
    m.revolute("main", m.ground, crank.start)
    (m.bushing if bushing else m.revolute)("pin", crank.end, rod.start, **bushing)
    m.revolute("wrist", rod.end, piston)
    m.slot("cylinder", m.ground, piston, axis=(1, 0))
    return m


def kicked(force, at, gravity=0.0, form=lambda law: law):
    """A mass at rest on a spring, omega = 31.6 / s, critically damped by a third; a force of a fiftieth of a second moves it.

    `form` makes what the force is given from its function of t.
    """
    m = zd.Mechanism("kicked", gravity=(0, -gravity))
    mass = m.particle("mass", 1.0, at=(0, 0))
    m.slot("guide", m.ground, mass, axis=(0, 1))
    m.spring("spring", m.ground.point((0, -1)), mass, stiffness=1e3, length=1 + gravity / 1e3, damping=20.0)
    m.force("kick", mass, along=(0, 1), value=form(lambda t: force if at < t < at + 0.02 else 0.0))
    return m


def touching_bodies():
    """The falling box, a disc that rolls off a table onto a hill, gears with backlash and a limit of speed, and a buffer.

    Returned with names of measures of each.
    """
    m = falling_box()
    disc = m.body("disc", 1.0, 0.005, at=(5.0, 1.1))
    m.contact("table", disc, m.ground.segment((4.5, 1.0), (5.3, 1.0)), radius=0.1, friction=0.4)
    m.contact("hill", disc, m.ground.circle((5.6, -0.2), 0.5), radius=0.1, restitution=0.4, friction=0.2)
    wheels = [m.body(f"wheel{i}", 1.0, 0.1, at=(8.0 + i, 0)) for i in range(2)]
    axles = [m.revolute(f"axle{i}", m.ground, wheel.point((0, 0))) for i, wheel in enumerate(wheels)]
    m.gear("mesh", *axles, ratio=-1.0, backlash=0.05, restitution=0.3)
    m.stop("governor", axles[1].speed, lower=-0.5)
    slide = m.prismatic("slide", m.ground, m.body("block", 1.0, 0.1, at=(12, 0)), at=(12, 0), axis=(1, 0))
    m.stop("buffer", slide.displacement, lower=-0.1, upper=0.1, stiffness=1e3, damping=0.2, exponent=2.0)
    m.start({disc.velocity: (0.8, 0.0), disc.angular_velocity: -8.0, axles[0].speed: 2.0, slide.speed: 1.0})
    return m, ["box.position", "b.force", "disc.position", "hill.force", "wheel1.angle", "mesh.torque", "block.position",
               "buffer.force"]


def touching_in_space():
    """A ball that bounces, a stool that slides and spins, and a ball in a bowl, with names of measures."""
    m = zd.Mechanism("in space", gravity=(0, 0, -9.81), dimension=3)
    floor = m.ground.plane((0, 0, 0), (0, 0, 1))
    ball = m.body("ball", 1.0, (0.004, 0.004, 0.004), at=(0, 0, 0.3))
    other = m.body("other", 1.0, (0.004, 0.004, 0.004), at=(4.3, 0, 0.2))
    m.contact("floor", ball, floor, radius=0.1, restitution=0.6, friction=0.3)
    m.contact("bowl", other, m.ground.sphere((4, 0, 1), 1.0, outside=False), radius=0.1, restitution=0.4, friction=0.2)
    stool = m.body("stool", 2.0, (0.02, 0.02, 0.03), at=(2, 0, 0.2))
    for k, foot in enumerate(((0.15, 0.0, -0.2), (-0.08, 0.13, -0.2), (-0.08, -0.13, -0.2))):
        m.contact(f"foot{k}", stool.point(foot), floor, friction=(0.35, 0.3))
    m.start({ball.velocity: (1.0, 0.5, 0), ball.angular_velocity: (10.0, 0, 0), other.velocity: (0, 1.0, 0),
             stool.velocity: (0.7, 0, 0), stool.angular_velocity: (0, 0, 3.0)})
    return m, ["ball.position", "floor.force", "other.position", "bowl.force", "stool.position", "foot1.force"]


def falling_box():
    """A square box that falls on the ground, bounces, tips over, slides and sticks."""
    m = zd.Mechanism("box", gravity=(0, -9.81))
    box = m.body("box", 1.0, 0.03, at=(0, 1), angle=0.3)
    floor = m.ground.line((0, 0), (1, 0))
    for name, corner in {"a": (-0.2, -0.2), "b": (0.2, -0.2), "c": (0.2, 0.2), "d": (-0.2, 0.2)}.items():
        m.contact(name, box.point(corner), floor, restitution=0.3, friction=(0.5, 0.4))
    m.start({box.velocity: (2.0, 0.0)})
    return m
