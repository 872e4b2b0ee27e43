"""Machines with contacts against closed forms, and against a program that shares nothing with the package."""

import math

import numpy as np
import pytest
import sympy as sp
from scipy.optimize import brentq

import zerodrift as zd
from event_driven import Contact, Machine

G = 9.81
FINE = {"rtol": 1e-10, "atol": 1e-13}
T, Q, V = sp.Symbol("t"), sp.symbols("q1:4"), sp.Matrix(sp.symbols("v1:4"))


def rate(place, count):
    """Rate of a place (n,) of the first coordinates and time."""
    return place.jacobian(Q[:count]) * V[:count, :] + place.diff(T)


def kinetic(mass, place, count):
    speed = rate(place, count)
    return mass * speed.dot(speed) / 2


def direction(angle):
    return sp.Matrix([sp.cos(angle), sp.sin(angle)])


def test_a_rimless_wheel_repeats_its_step_on_a_slope():
    """All that gravity does in a step is lost where the next spoke is set down: the fixed point of the closed form."""
    mass, inertia, length, slope, half = 2.0, 0.3, 0.8, 0.12, math.pi / 8
    m = zd.Mechanism("wheel", gravity=(G * math.sin(slope), -G * math.cos(slope)))
    hub = m.body("hub", mass, inertia, at=(0, length))
    floor = m.ground.line((0, 0), (1, 0))
    for i in range(8):
        angle = 2 * half * i - math.pi / 2
        m.contact(f"spoke{i}", hub.point((length * math.cos(angle), length * math.sin(angle))), floor, friction=2.0)
    about_foot = inertia + mass * length**2
    kept = (inertia + mass * length**2 * math.cos(2 * half)) / about_foot
    before = math.sqrt(4 * mass * G * length * math.sin(half) * math.sin(slope) / about_foot / (1 - kept**2))
    work = mass * G * length * (math.sin(slope) * math.sin(half) - math.cos(slope) * (1 - math.cos(half)))
    upright = math.sqrt((kept * before)**2 + 2 * work / about_foot)
    m.start({hub.angular_velocity: -upright, hub.velocity: (upright * length, 0)})
    sol = zd.simulate(m, 3.0, **FINE)
    times = np.unique(sol.impacts["t"])
    assert len(times) > 5
    for t in times:
        first, *_, last = np.flatnonzero(sol.t == t)
        assert sol["hub.angular_velocity"][[first, last]] == pytest.approx([-before, -kept * before], rel=1e-8)
    assert np.diff(times) == pytest.approx(np.full(len(times) - 1, times[1] - times[0]), rel=1e-7)


def test_a_follower_lifts_off_an_eccentric_where_its_weight_is_too_small():
    throw, radius, speed, e = 0.01, 0.04, 40.0, 0.5
    m = zd.Mechanism("cam", gravity=(0, -G))
    cam, follower = m.body("cam", 1.0, 1e-3), m.body("follower", 0.2, 1e-4, at=(0, radius))
    m.motor("drive", m.revolute("shaft", m.ground, cam.point((0, 0))), speed=speed)
    m.prismatic("guide", m.ground, follower, axis=(0, 1))
    m.contact("face", cam.point((throw, 0)), follower.line((0, radius), (-1, radius)), radius=radius, restitution=e)
    m.start({follower.velocity.y: throw * speed})
    sol = zd.simulate(m, 0.5, **FINE)
    leaves = math.asin(G / (throw * speed**2)) / speed

    def lands(t0, y0, v0):
        """Time at which the follower meets the cam, and its speeds before."""
        def gap(t):
            return y0 + v0 * (t - t0) - G / 2 * (t - t0)**2 - throw * math.sin(speed * t)
        after = next(t for t in t0 + np.arange(1, 4000) * 1e-4 if gap(t) < 0)
        t = brentq(gap, after - 1e-4, after, xtol=1e-15)
        return t, v0 - G * (t - t0), throw * speed * math.cos(speed * t)
    t, own, cams = lands(leaves, throw * math.sin(speed * leaves), throw * speed * math.cos(speed * leaves))
    expected = [t]
    for _ in range(2):
        t, own, cams = lands(t, throw * math.sin(speed * t), cams - e * (own - cams))
        expected.append(t)
    assert sol.phases[1].t0 == pytest.approx(leaves, abs=1e-10)
    assert sol.impacts["t"][:3] == pytest.approx(expected, abs=1e-9)


def test_a_woodpecker_pecks_its_way_down():
    """Glocker's and Pfeiffer's toy, whose geometry they linearize: a sleeve that jams on its pole, and a bird on a spring."""
    pole, inner, half, arm, far, up, beak = 0.0025, 0.0031, 0.0058, 0.010, 0.015, 0.02, 0.0201
    m = zd.Mechanism("woodpecker", gravity=(0, -G))
    sleeve = m.body("sleeve", 0.0003, 5e-9, at=(0, 0))
    bird = m.body("bird", 0.0045, 7e-7, at=(arm + far, 0))
    m.slot("guide", m.ground, sleeve.point((0, 0)), axis=(0, 1))
    hinge = m.revolute("hinge", sleeve.point((arm, 0)), bird.point((-far, 0)))
    m.torsion_spring("spring", hinge, stiffness=0.0056)
    wood = m.ground.line((pole, 1), (pole, 0))          # free to the right
    m.contact("peck", bird.point((-beak, up)), wood, restitution=0.5, friction=0.3)
    for name, y in (("lower", -half), ("upper", half)):
        m.contact(name, sleeve.point((inner, y)), wood, friction=0.3)
    m.start({sleeve.position.y: 0.0, sleeve.angle: -0.09, sleeve.angular_velocity: 0.0, sleeve.velocity.y: -0.3411,
             bird.angle: -0.2788, bird.angular_velocity: -7.4583})
    sol = zd.simulate(m, 0.3, rtol=1e-10, atol=1e-14)
    y, tilt, nod = Q

    def turned(angle, x, y):
        return sp.Matrix([x * sp.cos(angle) - y * sp.sin(angle), x * sp.sin(angle) + y * sp.cos(angle)])
    middle = sp.Matrix([0, y])
    centre = middle + turned(tilt, arm, 0) + turned(nod, far, 0)
    places = [centre + turned(nod, -beak, up), *(middle + turned(tilt, inner, y) for y in (-half, half))]
    contacts = [Contact(place[0] - pole, rate(place, 3)[1], e, (0.3, 0.3)) for place, e in zip(places, (0.5, 0, 0), strict=True)]
    energy = kinetic(0.0003, middle, 3) + kinetic(0.0045, centre, 3) + 5e-9 * V[1]**2 / 2 + 7e-7 * V[2]**2 / 2
    toy = Machine(Q, V, T, energy, G * (0.0003 * y + 0.0045 * centre[1]) + 0.0056 * (nod - tilt)**2 / 2, contacts)
    _, q, _, impacts, history = toy.run([0, -0.09, -0.2788], [-0.3411, 0, -7.4583], 0.3, rest=1e-8)
    found = np.unique(sol.impacts["t"])
    assert len(found) > 4
    assert found == pytest.approx([each.t for each in impacts], abs=1e-7)
    words = {"open": "open", "stick": "sticking", "+": "sliding", "-": "sliding"}
    assert [list(each.state.values()) for each in sol.phases] == [[words[mode] for mode in modes] for _, modes in history]
    end = [float(sol[name][-1]) for name in ("sleeve.position.y", "sleeve.angle", "bird.angle")]
    assert end == pytest.approx(list(q), abs=1e-7)


def test_a_slider_crank_with_clearance_in_its_pin():
    """A pin of 9.5 mm in a bore with 0.5 mm of play, e 0.4, mu 0.01; the crank turns at a constant speed."""
    crank, rod, speed, start, pin, play, e, mu = 0.05, 0.12, 60.0, 0.6, 0.0095, 0.0005, 0.4, 0.01
    joint = crank * np.array([math.cos(start), math.sin(start)])
    tilt = -math.asin(joint[1] / rod)
    place = joint[0] + rod * math.cos(tilt)
    turning = -crank * speed * math.cos(start) / (rod * math.cos(tilt))         # as without play
    moving = -crank * speed * math.sin(start) - rod * turning * math.sin(tilt)
    bore = place - 2e-4         # the pin starts off its middle
    m = zd.Mechanism("engine", gravity=(0, -G))
    arm = m.link("crank", (0, 0), tuple(joint), mass=0.3)
    link = m.link("rod", tuple(joint), (place, 0), mass=0.21, inertia=2.5e-4)
    slider = m.body("slider", 0.14, 0.0, at=(bore, 0))
    shaft = m.revolute("shaft", m.ground, arm.start)
    m.revolute("joint", arm.end, link.start)
    m.prismatic("guide", m.ground, slider, axis=(1, 0))
    m.motor("drive", shaft, speed=speed)
    m.contact("pin", link.end, slider.circle((bore, 0), pin + play, outside=False), radius=pin, restitution=e, friction=mu)
    m.start({"rod.angular_velocity": turning, "slider.velocity.x": moving})
    sol = zd.simulate(m, 0.03, rtol=1e-11, atol=1e-14)
    angle, x = Q[:2]
    middle, end = (crank * direction(start + speed * T) + share * rod * direction(angle) for share in (0.5, 1))
    apart = end - sp.Matrix([x, 0])
    length = sp.sqrt(apart.dot(apart))
    slip = sp.Matrix([-apart[1], apart[0]]).dot(rate(apart, 2)) / length + pin * V[0]
    energy = kinetic(0.21, middle, 2) + 2.5e-4 * V[0]**2 / 2 + 0.14 * V[1]**2 / 2
    other = Machine(Q[:2], V[:2, :], T, energy, 0.21 * G * middle[1], [Contact(play - length, slip, e, (mu, mu))])
    _, q, _, impacts, _ = other.run([tilt, bore], [turning, moving], 0.03)
    assert len(impacts) > 10
    assert sol.impacts["t"][:10] == pytest.approx([each.t for each in impacts[:10]], abs=1e-9)
    found = [float(sol[name][-1]) for name in ("rod.angle", "slider.position.x")]
    assert found == pytest.approx(list(q), abs=1e-6)        # after bounces that the rest speed ends


def test_a_ratchet_turns_one_way():
    """A rack with teeth is pushed on under a pawl, falls back onto the face of a tooth, and is held there."""
    pitch, height, push, weight = 0.02, 0.008, 0.8, 0.05 * G
    m = zd.Mechanism("ratchet", gravity=(0, -G))
    rack, pawl = m.body("rack", 1.0, 1.0), m.body("pawl", 0.05, 1e-4, at=(0.5 * pitch, 0.5 * height))
    slide = m.prismatic("slide", m.ground, rack, axis=(1, 0))
    m.prismatic("guide", m.ground, pawl, axis=(0, 1))
    tip = pawl.point((0, 0))
    for i in range(3):      # ramps and faces cross where they meet below, as points pass beside ends
        top = ((i + 1) * pitch, height)
        m.contact(f"ramp{i}", tip, rack.segment(((i - 0.2) * pitch, -0.2 * height), top))
        m.contact(f"face{i}", tip, rack.segment(top, (top[0], -0.2 * height)))
    m.motor("push", slide, force=lambda t: -push if t < 0.2 else push)
    sol = zd.simulate(m, 1.5, **FINE)
    assert sol["slide.displacement"].min() < -0.6 * pitch
    assert sol["slide.displacement"][-1] == pytest.approx(-0.5 * pitch, abs=1e-12)
    slope = height / pitch
    assert sol["face0.force"][-1] == pytest.approx([push + weight * slope, 0], abs=1e-9)
    assert sol["ramp1.force"][-1] == pytest.approx([-weight * slope, weight], abs=1e-9)
