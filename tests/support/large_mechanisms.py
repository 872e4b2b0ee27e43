"""Mechanisms of many bodies, from bodies and joints: chains, rows of linkages, stars, trees that branch; some in space."""

import numpy as np

import zerodrift as zd


def chain(n, spacing=1.0):
    """Links in a row that hang on the ground."""
    m = zd.Mechanism(f"chain of {n}", gravity=(0, -9.81))
    last = m.ground.point((0, 0))
    for i in range(n):
        link = m.link(f"link{i}", (spacing * i, 0), (spacing * (i + 1), 0), mass=1.0)
        m.revolute(f"pin{i}", last, link.start)
        last = link.end
    return m


def chain_of_hooks(links, length=1.5):
    """A chain of uniform links between two hooks one metre apart, drawn as a V."""
    m = zd.Mechanism("chain", gravity=(0, -9.81))
    depth = np.sqrt((length / 2)**2 - 0.25)
    at = [(i / links, -depth * (1 - abs(2 * i / links - 1))) for i in range(links + 1)]
    parts = [m.link(f"l{i}", at[i], at[i + 1], mass=1.0 / links) for i in range(links)]
    m.revolute("first", m.ground, parts[0].start)
    for i in range(links - 1):
        m.revolute(f"p{i}", parts[i].end, parts[i + 1].start)
    m.revolute("last", parts[-1].end, m.ground.point((1.0, 0)))
    return m


def four_bars(n):
    """A row of n parallelograms, 2 n + 1 rods of a metre, that swings from upright with 1 m/s at its upper end."""
    m = zd.Mechanism(f"{n} four-bars", gravity=(0, -9.81))
    cranks = [m.link(f"rod{i}", (i, 0), (i, 1), mass=1.0) for i in range(n + 1)]
    for i, crank in enumerate(cranks):
        m.revolute(f"A{i}", m.ground, crank.start)
    for i in range(n):
        coupler = m.link(f"bar{i}", (i, 1), (i + 1, 1), mass=1.0)
        m.revolute(f"B{i}", cranks[i].end, coupler.start)
        m.revolute(f"C{i}", coupler.end, cranks[i + 1].end)
    m.start({"rod0.angular_velocity": -1.0})
    return m


def star(n):
    """A wheel with n pendulums at its rim."""
    m = zd.Mechanism(f"star of {n}", gravity=(0, -9.81))
    hub = m.body("hub", 1.0, 1.0, at=(0, 0))
    m.revolute("axle", m.ground, hub.point((0, 0)))
    for i in range(n):
        along = np.array([np.cos(2 * np.pi * i / n), np.sin(2 * np.pi * i / n)])
        link = m.link(f"link{i}", along, 2 * along, mass=1.0)
        m.revolute(f"pin{i}", hub.point(along), link.start)
    return m


def binary_tree(levels):
    """Links of which two hang on each, but on those of the last level."""
    m = zd.Mechanism(f"tree of {levels} levels", gravity=(0, -9.81))
    ends, count = [(m.ground.point((0, 0)), np.zeros(2))], 0
    for level in range(levels):
        below = []
        for end, place in ends:
            for side in (-1, 1) if level else (0,):
                tip = place + np.array([side * 0.5**level, -1])
                link = m.link(f"link{count}", place, tip, mass=1.0)
                m.revolute(f"pin{count}", end, link.start)
                below.append((link.end, tip))
                count += 1
        ends = below
    return m


def spatial_chain(n, kind="revolute"):
    """Links in a row in space, whose hinges, or balls, hang on the ground."""
    m = zd.Mechanism(f"{kind} chain of {n}", dimension=3, gravity=(0, 0, -9.81))
    last = m.ground.point((0, 0, 0))
    for i in range(n):
        link = m.link(f"link{i}", (i, 0, 0), (i + 1, 0, 0), mass=1.0)
        if kind == "revolute":
            m.revolute(f"pin{i}", last, link.start, axis=((0, 1, 0), (0.3, 1, 0.2))[i % 2])
        else:
            m.spherical(f"pin{i}", last, link.start)
        last = link.end
    return m


def chain_of_balls(n):
    """Links in a row in space that hang on the ground by balls."""
    return spatial_chain(n, "spherical")


def spatial_star(n):
    """A hub on a ball, with n pendulums at its rim."""
    m = zd.Mechanism(f"star in space of {n}", dimension=3, gravity=(0, 0, -9.81))
    hub = m.body("hub", 1.0, (1, 1, 1))
    m.spherical("ball", m.ground, hub, at=(0, 0, 0))
    for i in range(n):
        angle = 2 * np.pi * i / n
        along, across = np.array([np.cos(angle), np.sin(angle), 0]), (-np.sin(angle), np.cos(angle), 0.1)
        m.revolute(f"pin{i}", hub, m.link(f"link{i}", along, 2 * along, mass=1.0).start, axis=across)
    return m


def spatial_linkages(n):
    """A row of n four-bars in space, each on the rocker of the one before: two hinges, a ball, and a cross."""
    m = zd.Mechanism(f"{n} linkages", dimension=3, gravity=(0, 0, -9.81))
    base = m.ground
    for i in range(n):
        one, other = np.array([0, 3 * i, 0.5]), np.array([2, 3 * i + 0.5, 1.2])
        crank = m.link(f"crank{i}", (0, 3 * i, 0), one, mass=1.0)
        rocker = m.link(f"rocker{i}", (2, 3 * i + 0.3, 0), other, mass=1.0)
        rod = m.link(f"rod{i}", one, other, mass=1.0)
        m.revolute(f"A{i}", base, crank.start, axis=(0, 1, 0))
        m.revolute(f"D{i}", base, rocker.start, axis=(0.2, 1, 0))
        m.spherical(f"B{i}", crank.end, rod.start)
        m.universal(f"C{i}", rod.end, rocker.end, axes=((0, 0, 1), (0, 1, 0)))
        base = rocker
    return m
