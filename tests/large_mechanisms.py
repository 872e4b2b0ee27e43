"""Mechanisms of many bodies, from bodies and joints: chains, rows of four-bars, stars, and trees that branch in two."""

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
