"""The closed n-link pendulum: a chain of slender links between two pins."""

import numpy as np
import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

from zerodrift.runs.arguments.methods import Projection
from zerodrift.runs.states.operations import project
from zerodrift.symbolics.define import symbolic

LEAN = np.radians(75.0)     # initial inclination of the first link in rad


def closed_pendulum(links=4, *, length=1.0, mass=1.0, gravity=9.81,
                    span=None):
    """A chain of equal slender links, pinned at both ends on one level; it is let go from an arch above the pins.

    Coordinates are the angles of the links from the x axis, so that the loop leaves two constraints; y points up.

    Parameters
    ----------
    links : int
        Number of links, at least 3: with the ground between the pins, 3 make a four-bar.
    length, mass : float
        Length and mass of each link, in m and kg.
    gravity : float
        In m/s^2, downwards.
    span : float, optional
        Distance of the pins in m, less than all links together; left out: about half of that, and as far as can be from where all
        links can line up with the pins.

    Notes
    -----
    Where all links lie on the line through the pins, the constraints are dependent, and close to it, motions are as wild as the
    steps are long. That can happen where ``span`` is a sum of the lengths with some signs turned, as with ``links=4, span=2``.

    Examples
    --------
    >>> import energy_models
    >>> energy_models.closed_pendulum(links=6)
    <zd.symbolic closed_pendulum: 6 coordinates, 6 velocities, 2 holonomic and 0 nonholonomic constraints>
    """
    n = links
    # A sum of n terms of plus or minus one is odd where n is. As `half` is not, the links cannot all line up with the pins.
    half = n // 2 + (n // 2 - n + 1) % 2
    span = half * length if span is None else span

    angles = dynamicsymbols(f"theta1:{n + 1}")
    L, m, g, d = sp.symbols("length mass gravity span", positive=True)
    t = dynamicsymbols._t

    # Matrices and sums that are added to term by term would take SymPy the square of the number of links.
    across, up = ([L * turn(angle) for angle in angles] for turn in (sp.cos, sp.sin))
    moved = [[x.diff(t) for x in along] for along in (across, up)]
    squares = [speed**2 for along in moved for speed in _middles(along)]
    turning = m * L**2 / 12 * sp.Add(*(angle.diff(t)**2 for angle in angles)) / 2
    joints = [(sp.Add(*across[:i]), sp.Add(*up[:i])) for i in range(n + 1)]

    system = symbolic(
        angles,
        kinetic=m * sp.Add(*squares) / 2 + turning,
        potential=m * g * sp.Add(*_middles(up)),
        constraints={"closed_x": joints[-1][0] - d, "closed_y": joints[-1][1]},
        parameters={L: length, m: mass, g: gravity, d: span},
        points=joints,
        name="closed_pendulum",
    )
    # The arch ends a quarter of the chain away from the pin. In the mass metric the last links, which move most easily, would go
    # all that way and wind up; in that of the angles all of them turn a little.
    arch, evenly = np.linspace(LEAN, -0.75 * LEAN, n), Projection(metric="identity", max_iterations=100)
    return system.starting(*project(system, arch, np.zeros(n), projection=evenly))


def _middles(along):
    """Halfway along each link, of what the links are long in one direction; and of their speeds likewise."""
    return [sp.Add(*along[:i], each / 2) for i, each in enumerate(along)]
