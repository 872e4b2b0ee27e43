"""A quarter of a car on a shaker: its body on a suspension, and the wheel on its tyre."""

from __future__ import annotations

import numpy as np

from .._private import checks
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked
from ._swing import swing


@checked
def quarter_car(*, body_mass: float = 2500.0, wheel_mass: float = 320.0, stiffness: float = 80e3, damping: float = 350.0,
                tyre_stiffness: float = 500e3, tyre_damping: float = 15020.0, amplitude: float = 0.05, rate: float = 2 * np.pi,
                gravity: float = 9.81) -> Mechanism:
    """Quarter car: wheel and body on springs and dampers, excited by a base that moves vertically by amplitude sin(rate t).

    It starts in static equilibrium, from which displacements are measured. The bodies are the base, called a
    ``road``, ``wheel`` and ``body``, each on its own guide, ``body guide``, ...; the springs are ``tyre`` and ``suspension``,
    and the motor is ``drive``. The tyre cannot lift off.

    Parameters
    ----------
    body_mass, wheel_mass : float
        In kg.
    stiffness, damping : float
        Stiffness and damping of the suspension, in N/m and N s/m.
    tyre_stiffness, tyre_damping : float
        In N/m and N s/m.
    amplitude, rate : float
        Amplitude in m and angular frequency in rad/s of the base.
    gravity : float
        Downwards, in m/s^2.

    Returns
    -------
    Mechanism

    References
    ----------
    W. C. Messner, D. M. Tilbury, Control Tutorials for MATLAB and Simulink, Suspension: a quarter of a bus, with these numbers.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.quarter_car(), 3.0, step=0.002)
    >>> bool(abs(sol["body guide.displacement"]).max() > 0.05)      # the excitation is near a resonance
    True
    """
    masses = [checks.number(name, value, above=0) for name, value in (("body_mass", body_mass), ("wheel_mass", wheel_mass))]
    k, k_tyre = checks.number("stiffness", stiffness, above=0), checks.number("tyre_stiffness", tyre_stiffness, above=0)
    g = checks.number("gravity", gravity)
    m = Mechanism("quarter_car", gravity=(0.0, -g))
    road = m.body("road", 1.0, at=(0, 0))
    wheel, body = m.body("wheel", masses[1], at=(0, 0.5)), m.body("body", masses[0], at=(0, 1.2))
    for each in (road, wheel, body):
        m.prismatic(f"{each.name} guide", m.ground, each, axis=(0, 1))
    m.spring("tyre", road.point((0, 0)), wheel.point((0, 0)), stiffness=k_tyre, length=0.5 + sum(masses) * g / k_tyre,
             damping=tyre_damping)
    m.spring("suspension", wheel.point((0, 0)), body.point((0, 0)), stiffness=k, length=0.7 + masses[0] * g / k, damping=damping)
    m.motor("drive", "road guide", displacement=swing(amplitude, rate))
    return m
