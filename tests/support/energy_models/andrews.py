"""Andrews' squeezing mechanism: seven bodies, three loops, driven hard for three hundredths of a second."""

from types import SimpleNamespace

import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

from zerodrift.models.andrews import PARAMETERS, START
from zerodrift.symbolics.define import symbolic


def andrews(**parameters):
    """Andrews' squeezing mechanism, the seven-body test problem of the DAE literature.

    A crank, which a constant moment drives, a coupler, and three chains that carry the coupler's end: a lever on a spring, and
    two pairs of a rocker and a link. It starts from rest and is known to 0.03 s.

    Parameters
    ----------
    **parameters : float
        Values of the literature's symbols that are to differ, such as ``mom=0.05`` for the moment in N m; SI units.

    Notes
    -----
    Source: W. Schiehlen (ed.), Multibody Systems Handbook, Springer 1990; E. Hairer and G. Wanner, Solving Ordinary
    Differential Equations II, section VII.7. The rows of Phi are in their order. The energy that the moment puts in is
    integrated along, so that `Solution.energy_violation` is that of the whole balance.

    Examples
    --------
    >>> import zerodrift as zd
    >>> import energy_models
    >>> sol = zd.simulate(energy_models.andrews(), 0.03, step=1e-5)
    >>> sol.p[-1, :2].round(6)
    array([ 15.810771, -15.756371])
    """
    k = SimpleNamespace(**{name: sp.Symbol(name) for name in PARAMETERS})
    angles = dynamicsymbols(" ".join(START))
    beta, theta, gamma, phi, delta, omega, epsilon = angles
    t = dynamicsymbols._t

    def turned(angle, x, y=sp.S.Zero):
        return sp.Matrix([x * sp.cos(angle) - y * sp.sin(angle), x * sp.sin(angle) + y * sp.cos(angle)])

    A, B, C = sp.Matrix([k.xa, k.ya]), sp.Matrix([k.xb, k.yb]), sp.Matrix([k.xc, k.yc])
    crank = turned(beta, k.rr)
    coupler = crank - turned(beta + theta, k.d)             # its end, where all chains meet
    lever = B + turned(gamma, 0, -k.ss)
    hook = B + turned(gamma, k.sd, -k.sc)                   # of the spring, whose other end is C
    lower, upper = A + turned(delta, k.zt), A + turned(epsilon, 0, -k.u)       # ends of the rockers
    lower_link = lower + turned(phi + delta, 0, -k.e)
    upper_link = upper + turned(omega + epsilon, k.zf)

    bodies = [      # mass, moment of inertia, centre of mass, angle
        (k.m1, k.I1, turned(beta, k.ra), beta),
        (k.m2, k.I2, crank - turned(beta + theta, k.da), beta + theta),
        (k.m3, k.I3, B + turned(gamma, k.sa, k.sb), gamma),
        (k.m4, k.I4, lower + turned(phi + delta, 0, k.ea - k.e), phi + delta),
        (k.m5, k.I5, A + turned(delta, k.ta, k.tb), delta),
        (k.m6, k.I6, upper + turned(omega + epsilon, k.zf - k.fa), omega + epsilon),
        (k.m7, k.I7, A + turned(epsilon, k.ua, k.ub), epsilon),
    ]
    spring = sp.sqrt((hook - C).dot(hook - C))
    system = symbolic(
        angles,
        kinetic=sum(m * centre.diff(t).dot(centre.diff(t)) / 2 + J * angle.diff(t)**2 / 2 for m, J, centre, angle in bodies),
        potential=k.c0 * (spring - k.l0)**2 / 2,
        force={beta: k.mom},
        constraints=[*(coupler - lever), *(coupler - lower_link), *(coupler - upper_link)],
        parameters=PARAMETERS,
        points=[tuple(point) for point in (sp.zeros(2, 1), crank, coupler, lower, A, upper, coupler, B, hook, C)],
        p0=list(START.values()),
        name="andrews",
    )
    return system.with_parameters(**parameters)
