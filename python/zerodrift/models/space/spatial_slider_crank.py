"""A slider-crank whose crank turns in a plane perpendicular to the slider's line."""

from __future__ import annotations

import numpy as np

from ..._private import checks
from ...errors import WrongValue
from ...mechanisms.mechanism import Mechanism
from .._arguments import checked


@checked
def spatial_slider_crank(*, crank: float = 0.08, rod: float = 0.3, offset: float = 0.1, height: float = 0.12,
                         crank_mass: float = 0.12, rod_mass: float = 0.5, slider_mass: float = 2.0, speed: float = 6.0,
                         gravity: float = 9.81) -> Mechanism:
    """A crank that turns about the x axis, a rod, and a slider along x that it pulls and pushes.

    The crank starts upright. A ball joins the rod to the crank, ``ball``, a cross to the slider, ``cross``; the crank's hinge is
    ``hinge``, the slider's rail ``rail``. The bodies are ``crank``, ``rod`` and ``slider``.

    Parameters
    ----------
    crank, rod : float
        Their lengths in m.
    offset, height : float
        Distances of the crank's hinge from the slider's line, along y and z, in m.
    crank_mass, rod_mass, slider_mass : float
        In kg.
    speed : float
        Angular velocity of the crank at the start, in rad/s.
    gravity : float
        Downwards, along -z, in m/s^2.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If the rod is too short for a turn of the crank.

    Notes
    -----
    The crank's end at ``(0, y, z)`` has the slider at ``x = sqrt(rod^2 - y^2 - z^2)``.

    References
    ----------
    E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, Allyn and Bacon 1989, section 12.6, also in the
    IFToMM library of computational benchmark problems. The inertias of the rod and crank are those given there, and change with
    masses and squares of lengths.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.spatial_slider_crank(), 1.0, step=1e-3)
    >>> x = np.sqrt(0.3**2 - (sol["crank.end.position"]**2).sum(axis=1))
    >>> bool(abs(sol["slider.position.x"] - x).max() < 1e-9)
    True
    """
    crank, rod = checks.number("crank", crank, above=0), checks.number("rod", rod, above=0)
    reach = np.hypot(offset, height) + crank
    if not 0 < reach < rod:
        raise WrongValue(f"rod must be longer than {reach:g} m, which the crank reaches from the slider's line, not {rod:g}",
                         "geometry")
    m = Mechanism("spatial_slider_crank", dimension=3, gravity=(0, 0, -gravity))
    pin, wrist = np.array([0.0, offset, height + crank]), np.array([np.sqrt(rod**2 - offset**2 - (height + crank)**2), 0.0, 0.0])
    turned, swung = crank_mass * crank**2 / (0.12 * 0.08**2), rod_mass * rod**2 / (0.5 * 0.3**2)
    first = m.link("crank", (0, offset, height), pin, crank_mass, inertia=np.array([1e-5, 1e-4, 1e-4]) * turned)
    second = m.link("rod", pin, wrist, rod_mass, inertia=np.array([4e-4, 4e-3, 4e-3]) * swung)
    slider = m.body("slider", slider_mass, [1e-4] * 3, at=wrist)
    m.revolute("hinge", m.ground, first.start, axis=(1, 0, 0))
    m.spherical("ball", first.end, second.start)
    arm = np.cross(wrist - pin, (1, 0, 0))
    m.universal("cross", second.end, slider.point((0, 0, 0)), axes=(np.cross(arm, wrist - pin), arm))
    m.prismatic("rail", m.ground, slider, axis=(1, 0, 0))
    m.start({"hinge.speed": speed})
    return m
