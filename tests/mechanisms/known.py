"""Mechanisms that are known from elsewhere, from bodies and joints."""

import importlib
from types import SimpleNamespace

import numpy as np

import zerodrift as zd

literature = importlib.import_module("zerodrift.models.andrews")


def four_bar():
    """The paper's, from a sketch whose links do not close."""
    bar = zd.Mechanism("four-bar", gravity=(0, -9.81))
    crank = bar.link("crank", (0, 0), (0, 0.3), mass=1.5)
    coupler = bar.link("coupler", (0, 0.3), (0.95, 0.6), mass=5.0, length=1.0)
    rocker = bar.link("rocker", (0.95, 0.6), (1, 0), mass=3.0, length=0.6)
    bar.revolute("A", bar.ground, crank.start)
    bar.revolute("B", crank.end, coupler.start)
    bar.revolute("C", coupler.end, rocker.start)
    bar.revolute("D", rocker.end, bar.ground.point((1, 0)))
    bar.start({crank.angle: np.pi / 2, crank.angular_velocity: 1.0})
    return bar


def slider_crank():
    """Driven at a constant speed, with a spring and a gas force on the piston."""
    m = zd.Mechanism("slider-crank")
    crank = m.link("crank", (0, 0), (0.1, 0), mass=0.5)
    rod = m.link("rod", (0.1, 0), (0.4, 0), mass=0.3)
    piston = m.particle("piston", 0.4, at=(0.4, 0))
    main = m.revolute("main", m.ground, crank.start)
    m.revolute("pin", crank.end, rod.start)
    m.revolute("wrist", rod.end, piston)
    slide = m.slot("slide", m.ground, piston, axis=(1, 0))
    m.spring("spring", m.ground.point((0.7, 0)), piston, stiffness=2e3, length=0.25, damping=5.0)
    m.force("gas", piston, along=(1, 0), value=lambda s, t: -50.0 * np.exp(-20 * s), of={"s": slide.displacement})
    m.motor("drive", main, speed=30.0)
    return m


def andrews():
    """Andrews' squeezing mechanism with the literature's numbers."""
    k, q = SimpleNamespace(**literature.PARAMETERS), SimpleNamespace(**literature.START)
    m = zd.Mechanism("andrews")
    A, B, C = (k.xa, k.ya), (k.xb, k.yb), (k.xc, k.yc)
    K1 = m.body("K1", k.m1, k.I1, angle=q.beta, com=(k.ra, 0))
    E = K1.point((k.rr, 0))
    K2 = m.body("K2", k.m2, k.I2, at=E, angle=q.beta + q.theta, com=(-k.da, 0))
    F = K2.point((-k.d, 0))
    K3 = m.body("K3", k.m3, k.I3, at=B, angle=q.gamma, com=(k.sa, k.sb))
    K5 = m.body("K5", k.m5, k.I5, at=A, angle=q.delta, com=(k.ta, k.tb))
    G = K5.point((k.zt, 0))
    K4 = m.body("K4", k.m4, k.I4, at=G, angle=q.phi + q.delta, com=(0, k.ea - k.e))
    K7 = m.body("K7", k.m7, k.I7, at=A, angle=q.epsilon, com=(k.ua, k.ub))
    H = K7.point((0, -k.u))
    K6 = m.body("K6", k.m6, k.I6, at=H, angle=q.omega + q.epsilon, com=(k.zf - k.fa, 0))
    O = m.revolute("O", m.ground, K1, at=(0, 0))        # noqa: E741 - the literature's name
    pins = ("E", E, K2), ("B", m.ground, K3), ("A5", m.ground, K5), ("A7", m.ground, K7), ("G", G, K4), ("H", H, K6)
    for name, first, second in pins:
        m.revolute(name, first, second.point((0, 0)))
    for body in (K3, K4, K6):
        m.revolute(f"F{body.name}", F, body)
    m.spring("spring", m.ground.point(C), K3.point((k.sd, -k.sc)), stiffness=k.c0, length=k.l0)
    m.motor("drive", O, torque=k.mom)
    return m


JANSEN = {"Z": (0, 0), "Y": (-38, -7.8), "X": (15, 0), "V": (-19, 33), "U": (-15, -40), "W": (-72, 10), "T": (-60, -30),
          "F": (-20, -85)}


def add_links(m, places, lengths, fixed, mass):
    """Links between places in cm, of lengths in cm, named by their ends; where they meet, all are hinged to the first."""
    places = {name: 0.01 * np.array(place) for name, place in places.items()}
    links = {(a, b): m.link(a + b, places[a], places[b], mass=mass, length=0.01 * length) for (a, b), length in lengths.items()}
    for point, place in places.items():
        joined = [link.start if ends[0] == point else link.end for ends, link in links.items() if point in ends]
        first = m.ground.point(place) if point in fixed else joined.pop(0)
        for second in joined:
            m.revolute(f"{point} {second.body.name}", first, second)


def jansen():
    """Jansen's leg from a sketch in whole numbers; triangles are two links and a rod."""
    m = zd.Mechanism("Jansen's leg", gravity=(0, -9.81))
    lengths = {"ZX": 15, "XV": 50, "XU": 61.9, "YV": 41.5, "VW": 55.8, "YW": 40.1, "YU": 39.3, "WT": 39.4, "TU": 36.7, "TF": 65.7,
               "UF": 49}
    add_links(m, JANSEN, lengths, fixed="ZY", mass=1.0)
    m.motor("drive", m["Z ZX"], speed=-6.0)
    m.start({"ZX.angle": 0.0})
    return m


def peaucellier():
    """Peaucellier's cell from a sketch: P moves along a straight line."""
    m = zd.Mechanism("Peaucellier's cell")
    places = {"O": (0, 0), "A": (10, 0), "Q": (18, 5), "S": (20, 16), "R": (24, -5), "P": (25, 8)}
    lengths = {"OS": 25, "OR": 25, "AQ": 10, "QS": 12, "QR": 12, "PS": 12, "PR": 12}
    add_links(m, places, lengths, fixed="OA", mass=0.2)
    m.start({"AQ.angular_velocity": 2.0})
    return m


def four_bars(n):
    """N parallelograms in a row that move as one, of links of 1 m and 1 kg: every crank turns as the first does."""
    m = zd.Mechanism(f"{n} four-bars", gravity=(0, -9.81))
    cranks = [m.link(f"crank{i}", (i, 0), (i, 1), mass=1.0) for i in range(n + 1)]
    for i, crank in enumerate(cranks):
        m.revolute(f"ground{i}", m.ground, crank.start)
    for i in range(n):
        bar = m.link(f"bar{i}", (i, 1), (i + 1, 1), mass=1.0)
        m.revolute(f"left{i}", cranks[i].end, bar.start)
        m.revolute(f"right{i}", bar.end, cranks[i + 1].end)
    m.start({"crank0.angular_velocity": -1.0})
    return m
