"""Andrews' squeezing mechanism: seven bodies and three loops, over three hundredths of a second."""

from __future__ import annotations

from types import SimpleNamespace

from .._private import checks
from ..mechanisms.mechanism import Mechanism

# In m, kg, kg m^2, N/m and N m, named as in the literature.
PARAMETERS = {
    "m1": 0.04325, "m2": 0.00365, "m3": 0.02373, "m4": 0.00706, "m5": 0.07050, "m6": 0.00706, "m7": 0.05498,
    "I1": 2.194e-6, "I2": 4.410e-7, "I3": 5.255e-6, "I4": 5.667e-7, "I5": 1.169e-5, "I6": 5.667e-7, "I7": 1.912e-5,
    "xa": -0.06934, "ya": -0.00227, "xb": -0.03635, "yb": 0.03273, "xc": 0.014, "yc": 0.072,
    "d": 0.028, "da": 0.0115, "e": 0.02, "ea": 0.01421, "rr": 0.007, "ra": 0.00092, "ss": 0.035, "sa": 0.01874, "sb": 0.01043,
    "sc": 0.018, "sd": 0.02, "ta": 0.02308, "tb": 0.00916, "u": 0.04, "ua": 0.01228, "ub": 0.00449, "zf": 0.02, "zt": 0.04,
    "fa": 0.01421, "c0": 4530.0, "l0": 0.07785, "mom": 0.033,
}
START = {
    "beta": -0.0617138900142764496358948458001, "theta": 0.0, "gamma": 0.455279819163070380255912382449,
    "phi": 0.222668390165885884674473185609, "delta": 0.487364979543842550225598953530,
    "omega": -0.222668390165885884674473185609, "epsilon": 1.23054744454982119249735015568,
}


def andrews(**parameters: float) -> Mechanism:
    """Andrews' squeezing mechanism, the seven-body test problem of the DAE literature, from bodies and joints.

    A crank that a constant moment drives, a coupler, and three chains that support the coupler's end: a lever on a spring, and
    two pairs of a rocker and a link. It starts from rest and is known to 0.03 s. The bodies are ``K1`` (crank), ``K2``
    (coupler), ``K3`` (lever), ``K4`` and ``K5``, ``K6`` and ``K7``, as in the literature, whose angles are theirs: beta, beta +
    theta, gamma, phi + delta, delta, omega + epsilon, epsilon. The motor is ``drive``.

    Parameters
    ----------
    **parameters : float
        Other values, by the symbols of the literature, such as ``mom=0.05`` for the moment in N m; SI units.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If the literature has no such symbol.

    References
    ----------
    W. Schiehlen (ed.), Multibody Systems Handbook, Springer 1990; E. Hairer and G. Wanner, Solving Ordinary Differential
    Equations II, section VII.7.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.andrews(), 0.03, step=1e-5)
    >>> print(sol["K1.angle"][-1].round(6))
    15.810771
    """
    given = {checks.choice("parameter", name, PARAMETERS): checks.number(f"parameter {name!r}", value)
             for name, value in parameters.items()}
    k, q = SimpleNamespace(**(PARAMETERS | given)), SimpleNamespace(**START)
    m = Mechanism("andrews")
    A, B, C = (k.xa, k.ya), (k.xb, k.yb), (k.xc, k.yc)
    K1 = m.body("K1", k.m1, k.I1, angle=q.beta, com=(k.ra, 0))
    E = K1.point((k.rr, 0))
    K2 = m.body("K2", k.m2, k.I2, at=E, angle=q.beta + q.theta, com=(-k.da, 0))
    F = K2.point((-k.d, 0))
    K3 = m.body("K3", k.m3, k.I3, at=B, angle=q.gamma, com=(k.sa, k.sb))
    K5 = m.body("K5", k.m5, k.I5, at=A, angle=q.delta, com=(k.ta, k.tb))
    G = K5.point((k.zt, 0))
    K4 = m.body("K4", k.m4, k.I4, at=G, angle=q.phi + q.delta, com=(0, k.ea - k.e))
    K7 = m.body("K7", k.m7, k.I7, at=A, angle=q.epsilon, com=(k.ua, k.ub))
    H = K7.point((0, -k.u))
    K6 = m.body("K6", k.m6, k.I6, at=H, angle=q.omega + q.epsilon, com=(k.zf - k.fa, 0))
    m.revolute("O", m.ground, K1, at=(0, 0))
    pins = ("E", E, K2), ("B", m.ground, K3), ("A5", m.ground, K5), ("A7", m.ground, K7), ("G", G, K4), ("H", H, K6)
    for name, first, second in pins:
        m.revolute(name, first, second.point((0, 0)))
    for body, end in ((K3, (0, -k.ss)), (K4, (0, -k.e)), (K6, (k.zf, 0))):
        m.revolute(f"F{body.name}", F, body.point(end))
    m.spring("spring", m.ground.point(C), K3.point((k.sd, -k.sc)), stiffness=k.c0, length=k.l0)
    m.motor("drive", "O", torque=k.mom)
    return m
