"""A quarter of a car on double wishbones, with a sinusoidal excitation of the tyre."""

from __future__ import annotations

import numpy as np

from ...mechanisms.mechanism import Mechanism
from .._arguments import checked
from .._swing import swing, symbol

POINTS = {"car": (0, 0, 0.5), "lower front": (0.15, 0.3, 0.2), "lower rear": (-0.15, 0.3, 0.2), "lower ball": (0, 0.68, 0.18),
          "upper front": (0.12, 0.38, 0.45), "upper rear": (-0.12, 0.38, 0.44), "upper ball": (-0.02, 0.64, 0.46),
          "tie inner": (-0.12, 0.32, 0.24), "tie outer": (-0.13, 0.67, 0.23), "strut top": (0, 0.42, 0.62),
          "strut foot": (0, 0.52, 0.19), "wheel": (0, 0.75, 0.3)}


@checked
def double_wishbone(*, body_mass: float = 350.0, lower_mass: float = 3.0, upper_mass: float = 2.0, upright_mass: float = 8.0,
                    wheel_mass: float = 15.0, stiffness: float = 4e4, preload: float = 6000.0, damping: float = 3000.0,
                    tyre_stiffness: float = 2e5, amplitude: float = 0.02, rate: float = 12.0, gravity: float = 9.81) -> Mechanism:
    """Double wishbone suspension: a quarter car that heaves, two arms, an upright, a tie rod, a strut, and a wheel.

    x is forward, y to the side, z up. The bodies are ``car``, ``lower arm``, ``upper arm``, ``upright`` and ``wheel``; the
    joints are ``heave``, ``lower bushings``, ``upper bushings``, ``lower ball``, ``upper ball``, ``tie rod`` and ``axle``; the
    forces ``strut`` and ``tyre``. The car's steering does not move. Bump steer and camber are in ``"upright.rotation"``.

    Parameters
    ----------
    body_mass, lower_mass, upper_mass, upright_mass, wheel_mass : float
        In kg: a quarter of the car, the arms, the upright and the wheel.
    stiffness, preload, damping : float
        Stiffness of the strut, in N/m, its force as drawn, in N, and its damping, in N s/m.
    tyre_stiffness : float
        In N/m. It carries the weight of all as drawn, and pulls where the wheel would lift off.
    amplitude, rate : float
        Amplitude in m and angular frequency in rad/s of the ground under the wheel.
    gravity : float
        Downwards, along -z, in m/s^2.

    Returns
    -------
    Mechanism

    References
    ----------
    W. F. Milliken, D. L. Milliken, Race Car Vehicle Dynamics, SAE 1995, chapter 17; M. Blundell, D. Harty, The Multibody Systems
    Approach to Vehicle Dynamics, Elsevier 2004, chapter 4. Places and numbers are round ones.

    Examples
    --------
    >>> import zerodrift as zd
    >>> corner = zd.models.double_wishbone()
    >>> sol = zd.simulate(corner, 1.0, step=1e-3)
    >>> bool(abs(sol.position_violation).max() < 1e-11)
    True
    """
    P = {name: np.array(place, dtype=float) for name, place in POINTS.items()}
    m = Mechanism("double_wishbone", dimension=3, gravity=(0, 0, -gravity))
    car = m.body("car", body_mass, (60.0, 150.0, 180.0), at=P["car"])
    lower = m.body("lower arm", lower_mass, (0.05, 0.03, 0.07), at=(P["lower front"] + P["lower rear"] + P["lower ball"]) / 3)
    upper = m.body("upper arm", upper_mass, (0.03, 0.02, 0.04), at=(P["upper front"] + P["upper rear"] + P["upper ball"]) / 3)
    hub = m.body("upright", upright_mass, (0.2, 0.2, 0.1), at=(P["lower ball"] + P["upper ball"] + P["tie outer"]) / 3)
    wheel = m.body("wheel", wheel_mass, (0.5, 0.9, 0.5), at=P["wheel"])
    m.prismatic("heave", m.ground, car, axis=(0, 0, 1))
    m.revolute("lower bushings", car, lower, at=P["lower front"], axis=P["lower rear"] - P["lower front"])
    m.revolute("upper bushings", car, upper, at=P["upper front"], axis=P["upper rear"] - P["upper front"])
    m.spherical("lower ball", lower, hub, at=P["lower ball"])
    m.spherical("upper ball", upper, hub, at=P["upper ball"])
    m.rod("tie rod", car.point(at=P["tie inner"]), hub.point(at=P["tie outer"]))
    m.revolute("axle", hub, wheel.point((0, 0, 0)), axis=(0, 1, 0))
    slack = float(np.linalg.norm(P["strut top"] - P["strut foot"])) + (preload / stiffness if stiffness else 0.0)
    m.spring("strut", car.point(at=P["strut top"]), lower.point(at=P["strut foot"]), stiffness=stiffness, length=slack,
             damping=damping)
    weight = gravity * (body_mass + lower_mass + upper_mass + upright_mass + wheel_mass)
    pressed = swing(amplitude, rate) + P["wheel"][2] - symbol("z")
    m.force("tyre", wheel, along=(0, 0, 1), value=weight + tyre_stiffness * pressed, of={"z": "wheel.position.z"})
    return m
