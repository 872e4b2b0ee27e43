"""A row of four-bars that move alike, and pass through bifurcations."""

from __future__ import annotations

import itertools

from .._private import checks
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked


@checked
def four_bars(loops: int = 2, *, length: float = 1.0, mass: float = 1.0, gravity: float = 9.81, speed: float = 1.0) -> Mechanism:
    """N parallelograms in a row, upright, whose upper joints start along x; all uprights turn alike.

    Problem A02 of the IFToMM library of multibody benchmarks. The uprights are ``crank0`` to ``crankN``, the bars between them
    ``bar0`` to ``barN-1``. If the crank turns in one direction, the row passes its flat poses, in which it has N + 1 freedoms
    instead of one.

    Parameters
    ----------
    loops : int
        N, at least 1.
    length, mass : float
        Length and mass of every slender rod, in m and kg.
    gravity : float
        Downwards, in m/s^2.
    speed : float
        Speed of the upper joints at the start, in m/s.

    Returns
    -------
    Mechanism

    References
    ----------
    IFToMM Technical Committee for Multibody Dynamics, Library of Computational Benchmark Problems, A02, N-four-bar mechanism.

    Examples
    --------
    >>> import zerodrift as zd
    >>> row = zd.models.four_bars(loops=4)
    >>> len(row.bodies), len(row.joints)
    (9, 13)
    >>> sol = zd.simulate(row, 1.0, step=0.005, on_singular="continue")
    >>> bool(abs(sol["crank0.angle"] - sol["crank4.angle"]).max() < 1e-10)
    True
    """
    n = checks.count("loops", loops, least=1)
    L = checks.number("length", length, above=0)
    m = Mechanism("four_bars", gravity=(0.0, -checks.number("gravity", gravity)))
    cranks = [m.link(f"crank{i}", (i * L, 0), (i * L, L), mass) for i in range(n + 1)]
    for i, crank in enumerate(cranks):
        m.revolute(f"ground{i}", m.ground, crank.start)
    for i, (left, right) in enumerate(itertools.pairwise(cranks)):
        bar = m.link(f"bar{i}", left.drawn_end, right.drawn_end, mass)
        m.revolute(f"left{i}", left.end, bar.start)
        m.revolute(f"right{i}", bar.end, right.end)
    m.start({"crank0.angular_velocity": -checks.number("speed", speed) / L})
    return m
