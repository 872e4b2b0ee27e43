"""A slider-crank with spring, damper and a pull."""

from __future__ import annotations

import numpy as np

from .._private import checks
from ..errors import WrongValue
from ..mechanisms.mechanism import Mechanism
from ._arguments import checked


@checked
def slider_crank(*, crank: float = 0.5, rod: float = 1.0, crank_inertia: float = 1.0, slider_mass: float = 1.0,
                 rod_inertia: float = 2.0, stiffness: float = 1.0, damping: float = 1.0, rest_length: float = 1.0,
                 pull: float = 1.0, angle: float = np.pi / 2) -> Mechanism:
    """The damped slider-crank of SUNDIALS' example idaSlCrank, from bodies and joints.

    A spring and a damper join the midpoints of crank and rod. The rod's
    mass is centred at the slider; the rod runs on beyond it by as much again, and there a constant force pulls along x. The
    bodies are ``crank`` and ``rod``, the slider is a point, ``slider``, in the slot ``slide``.

    Parameters
    ----------
    crank, rod : float
        Lengths in m; the rod is the longer one.
    crank_inertia, slider_mass, rod_inertia : float
        In kg m^2, kg, kg m^2.
    stiffness, damping, rest_length : float
        Stiffness and damping of spring and damper, and the spring's rest length, in N/m, N s/m, m.
    pull : float
        In N.
    angle : float
        Angle of the crank at the start, in rad; it starts from rest.

    Returns
    -------
    Mechanism

    Raises
    ------
    ValueError
        If the rod is not longer than the crank.

    References
    ----------
    SUNDIALS, example idaSlCrank of the integrator IDA, Lawrence Livermore National Laboratory.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.slider_crank(), 10.0, step=0.01)
    >>> bool(abs(sol["slider.position.y"]).max() < 1e-12)
    True
    """
    a, b = checks.number("crank", crank, above=0), checks.number("rod", rod, above=0)
    if not b > a:
        raise WrongValue(f"rod must be longer than the crank of {a:g} m, not {b:g}", "geometry")
    rest_length = checks.number("rest_length", rest_length, least=0)
    m = Mechanism("slider_crank")
    crank_body = m.body("crank", 0.0, crank_inertia, angle=angle)
    pin = crank_body.point((a, 0))
    rod_body = m.body("rod", slider_mass, rod_inertia, at=pin, angle=np.arcsin(-a / b * np.sin(angle)), com=(b, 0))
    slider = m.point("slider", rod_body, (b, 0))
    m.revolute("main", m.ground, crank_body.point((0, 0)))
    m.revolute("pin", pin, rod_body.point((0, 0)))
    m.slot("slide", m.ground, slider, axis=(1, 0))
    m.spring("spring", crank_body.point((a / 2, 0)), rod_body.point((b / 2, 0)), stiffness=stiffness, length=rest_length,
             damping=damping)
    m.force("pull", rod_body.point((2 * b, 0)), along=(1, 0), value=pull)
    return m
