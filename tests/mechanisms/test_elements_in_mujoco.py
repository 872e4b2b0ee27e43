"""Joints with dampers, drives on angles, rotors, forces against bodies, bushings and laws of time: end states of MuJoCo."""

import json
from pathlib import Path

import numpy as np
import pytest

import zerodrift as zd
from support import assert_close

KNOWN = json.loads((Path(__file__).parents[1] / "references" / "mujoco_elements.json").read_text(encoding="utf-8"))
SKEW, ACCURATE = (0.5, 0.8, 0), {"rtol": 1e-12, "atol": 1e-13, "integrator": "dop853"}
FORCE = np.array([200.0, 300.0, 500.0])


def end(m, *names):
    """Measures after 1 s."""
    sol = zd.simulate(m, KNOWN["time"], **ACCURATE)
    return np.concatenate([np.ravel(sol[name][-1]) for name in names])


def ball(damping, gravity=(0, -9.81, 0)):
    m = zd.Mechanism("ball", dimension=3, gravity=gravity)
    body = m.body("b", 2.0, (0.15, 0.3, 0.4), com=(0.5, 0, 0))
    m.spherical("j", m.ground, body, at=(0, 0, 0), damping=damping)
    body.point((1, 0.2, 0.1), name="s")
    m.start({"b.angular_velocity": (3, 1, -2)})
    return end(m, "s.position")


def chain():
    m = zd.Mechanism("chain", dimension=3, gravity=(0, 0, -9.81))
    one = m.body("one", 2.0, (0.15, 0.3, 0.4), com=(0.4, 0, 0.1))
    two = m.body("two", 1.0, (0.2, 0.1, 0.2), at=(0.8, 0.1, 0), com=(0, 0.3, 0))
    two.point((0.2, 0.5, 0.1), name="s")
    m.spherical("A", m.ground, one, at=(0, 0, 0), damping=0.3)
    m.spherical("B", one, two, at=(0.8, 0.1, 0), damping=0.2)
    m.start({"one.angular_velocity": (1, 2, -1), "two.angular_velocity": (1.5, -1, 1)})
    return end(m, "s.position")


def universal(second=(0, 1, 0), damping=0.0, motors=(), **springs):
    """Springs by the names of their angles."""
    m = zd.Mechanism("universal", dimension=3, gravity=(0, 0, -9.81))
    body = m.body("b", 2.0, (0.3, 0.25, 0.1), com=(0.1, 0.2, -0.5))
    body.point((0.1, 0.2, -1), name="s")
    joint = m.universal("u", m.ground, body, at=(0, 0, 0), axes=((1, 0, 0), second), damping=damping)
    for which, given in springs.items():
        m.torsion_spring(f"k {which}", getattr(joint, which), **given)
    for which, torque in zip(("angle1", "angle2"), motors, strict=False):
        m.motor(f"m {which}", getattr(joint, which), torque=torque)
    m.start({"u.angle1_speed": 1.5, "u.angle2_speed": -2.0})
    return end(m, "s.position", "u.angle1", "u.angle2")


def hinge(rotor, ratio, **spring):
    m = zd.Mechanism("hinge", dimension=3, gravity=(0, -9.81, 0))
    body = m.body("b", 2.0, (0.15, 0.3, 0.4), com=(0.5, 0, 0))
    joint = m.revolute("j", m.ground, body, at=(0, 0, 0), axis=(0, 0, 1))
    m.motor("drive", joint, torque=0.0, rotor=rotor, ratio=ratio)
    if spring:
        m.torsion_spring("k", joint, **spring)
    return end(m, "j.angle")


def slide():
    m = zd.Mechanism("slide", dimension=3, gravity=(0, 0, -9.81))
    joint = m.prismatic("j", m.ground, m.body("b", 2.0, (1, 1, 1)), at=(0, 0, 0), axis=(0.6, 0, 0.8))
    m.motor("drive", joint, force=lambda displacement: -30 * displacement, rotor=0.7 / 4, ratio=2.0)
    return end(m, "j.displacement")


def hung(**spring):
    m = zd.Mechanism("hung", dimension=3, gravity=(0, -9.81, 0))
    m.spring("k", m.ground.point((0, 0, 0)), m.particle("p", 2.0, at=(0.3, -1, 0)), **spring)
    return end(m, "p.position")


def two(act, *, third=False):
    """Two free bodies, or three, on which something acts."""
    m = zd.Mechanism("two", dimension=3)
    one, other = m.body("one", 2.0, (0.3, 0.4, 0.5)), m.body("two", 1.0, (0.2, 0.1, 0.2), at=(0.4, 0.1, 0))
    start = {"one.angular_velocity": (2, -1, 0.5), "two.velocity": (0.3, 0.5, -0.2), "two.angular_velocity": (-0.5, 1, 2),
             "one.velocity": (0, 0, 0)}
    if third:
        m.body("three", 1.0, (0.1, 0.2, 0.25), at=(0, 0, 1))
        start |= {"three.angular_velocity": (0.5, 2, -1), "three.velocity": (0, 0, 0)}
    act(m, one, other, other.point((0.3, 0.1, -0.2), name="s"))
    m.start(start)
    return end(m, "one.position", "two.position", "two.rotation")


def bushing(**given):
    return two(lambda m, one, other, s: m.bushing("mount", one, other, at=(0.4, 0.1, 0), **given))


def along_a_third_body(m, one, other, s):
    """Along (0.6, 0, 0.8) of a body on which nothing acts."""
    for axis, direction in zip("xyz", np.eye(3), strict=True):
        m.force(f"f {axis}", s, along=direction, against=one, of={"a": f"three.rotation.{axis}x", "b": f"three.rotation.{axis}z"},
                value=lambda t, a, b: (2 + np.sin(5 * t)) * (0.6 * a + 0.8 * b))


def hooke(k, angle, c):
    return {"stiffness": k, "angle": angle, "damping": c}


SCENES = {
    "ball 0.0": lambda: ball(0.0),
    "ball 0.4": lambda: ball(0.4),
    "gravity of t": lambda: ball(0.4, lambda t: (0.3 * np.sin(4 * t), -9.81 + 3 * np.sin(2 * t), 0)),
    "chain of balls": chain,
    "universal": universal,
    "universal springs": lambda: universal(angle1=hooke(20, 0.2, 0.3), angle2=hooke(12, 0, 0.1)),
    "universal motors": lambda: universal(motors=(lambda t: 1.5 * np.sin(3 * t), -0.8)),
    "universal skew": lambda: universal(SKEW),
    "universal skew springs": lambda: universal(SKEW, angle1=hooke(20, 0, 0.3), angle2=hooke(12, 0, 0.1)),
    "universal damped": lambda: universal(damping=0.5),
    "universal skew damped": lambda: universal(SKEW, damping=0.5),
    "universal law": lambda: universal(angle1={"torque": lambda angle: -20 * angle**3, "damping": 0.3},
                                       angle2={"stiffness": lambda t: 12 + 3 * t, "angle": 0.1}),
    "rotor hinge": lambda: hinge(0.1, 3.0),
    "hinge law": lambda: hinge(0.05, -2.0, stiffness=lambda t: 8 + 4 * t, angle=0.3, damping=0.5),
    "rotor slide": slide,
    "stiffness of t": lambda: hung(stiffness=lambda t: 50 + 20 * np.sin(3 * t), length=0.8),
    "spring law": lambda: hung(force=lambda length: 400 * (length - 0.8) ** 3 + 60 * (length - 0.8), damping=0.7),
    "force against a body": lambda: two(lambda m, one, other, s: m.force(
        "f", s, along=(0.6, 0, 0.8), frame=one, against=one, value=lambda t: 2 + np.sin(5 * t))),
    "force against a point": lambda: two(lambda m, one, other, s: m.force(
        "f", s, along=(0.6, 0, 0.8), against=one.center, value=lambda z: -30 * (z + 0.2), of={"z": "s.position.z"})),
    "force along a third body": lambda: two(along_a_third_body, third=True),
    "bushing law": lambda: bushing(
        force=lambda displacement, velocity: -FORCE * displacement * (1 + displacement @ displacement) - 2 * velocity,
        torque=lambda angle, angular_velocity: -30 * angle**3 - 0.4 * angular_velocity),
    "bushing of time": lambda: bushing(force=lambda t, displacement: -(100 + 50 * np.sin(4 * t)) * displacement,
                                       torque=lambda t, angle: -(20 + 5 * t) * angle),
    "bushing 6 by 6": lambda: bushing(stiffness=np.array(KNOWN["K"]), damping=1.5, torsion_damping=0.2)}


@pytest.mark.parametrize("scene", KNOWN["scenes"])
def test_the_end_is_that_of_mujoco(scene):
    assert_close(SCENES[scene](), KNOWN["scenes"][scene], 1e-9, scale=1.0)
