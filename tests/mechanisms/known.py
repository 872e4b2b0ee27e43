"""Mechanisms that are known from elsewhere, from bodies and joints."""

import numpy as np

import zerodrift as zd

andrews, four_bar, four_bars = zd.models.andrews, zd.models.four_bar, zd.models.four_bars


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
