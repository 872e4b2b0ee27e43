"""Functions that ensembles are made with in tests, in a module that other processes find."""

import os
import threading
import time

import zerodrift as zd


def pendulum(length=1.0, gravity=9.81):
    """A link on a hinge, level at the start."""
    m = zd.Mechanism("pendulum", gravity=(0, -gravity))
    link = m.link("link", (0, 0), (length, 0), mass=1.0)
    m.revolute("pin", m.ground, link.start)
    return m


def lowest(sol):
    """The least angle."""
    return float(sol["link.angle"].min())


def waits(sol):
    """The same, in its time."""
    time.sleep(0.01)
    return lowest(sol)


def slow(sol):
    """The same, and a line in a file for each call: which run it was, as no two have one end."""
    with open(os.environ["ZERODRIFT_COUNTED"], "a") as file:
        file.write(f"{sol.p[-1, 0]!r}\n")
    return waits(sol)


def dies(sol):
    """The same; the process dies at the eighth run, as if it was killed, except those that survive."""
    if sol.p[-1, 0] < -3.11 and "ZERODRIFT_SURVIVES" not in os.environ:
        os._exit(9)
    return lowest(sol)


def locks(sol):
    """Something that does not travel."""
    return threading.Lock()
