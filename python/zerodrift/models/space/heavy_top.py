"""The heavy top: a body on a ball, in gravity."""

from __future__ import annotations

from ...mechanisms.mechanism import Mechanism
from .._arguments import checked


@checked
def heavy_top(*, mass: float = 15.0, distance: float = 1.0, axial_inertia: float = 0.46875, transverse_inertia: float = 0.234375,
              spin: float = 150.0, precession: float = -4.61538, gravity: float = 9.81) -> Mechanism:
    """A symmetrical top whose tip does not move, started with its axis level.

    The body is ``top``, whose y axis is its axis of symmetry and whose origin is its tip; the joint is ``tip``.

    Parameters
    ----------
    mass : float
        In kg.
    distance : float
        From the tip to the centre of mass, in m.
    axial_inertia, transverse_inertia : float
        About the centre of mass, along its axis and across, in kg m^2.
    spin, precession : float
        Angular velocity at the start about its axis, and about the vertical, in rad/s.
    gravity : float
        Downwards, along -z, in m/s^2.

    Returns
    -------
    Mechanism

    References
    ----------
    M. Geradin, A. Cardona, Flexible Multibody Dynamics: A Finite Element Approach, Wiley 2001, chapter 5; O. Bruels,
    A. Cardona, M. Arnold, Lie group generalized-alpha time integration of constrained flexible multibody systems, Mechanism and
    Machine Theory 48 (2012).

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.heavy_top(), 0.5, step=1e-3)
    >>> bool(abs(np.linalg.norm(sol["top.center.position"], axis=1) - 1.0).max() < 1e-12)
    True
    """
    m = Mechanism("heavy_top", dimension=3, gravity=(0, 0, -gravity))
    top = m.body("top", mass, (transverse_inertia, axial_inertia, transverse_inertia), com=(0, distance, 0))
    m.spherical("tip", m.ground, top, at=(0, 0, 0))
    m.start({"top.angular_velocity": (0, spin, precession)})
    return m
