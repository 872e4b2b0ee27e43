"""A slider-crank with spring, damper and a pull."""

import numpy as np
import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

from zerodrift.symbolics.define import symbolic


def slider_crank(*, crank=0.5, rod=1.0, crank_inertia=1.0, slider_mass=1.0,
                 rod_inertia=2.0, stiffness=1.0, damping=1.0, rest_length=1.0,
                 pull=1.0, angle=np.pi / 2):
    """The damped slider-crank of SUNDIALS' example idaSlCrank, from its energies.

    A spring and a damper join the midpoints of crank and rod. The rod's mass is centred at the slider; the rod runs on beyond it
    by as much again, and there a constant force pulls along x.

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

    Examples
    --------
    >>> import zerodrift as zd
    >>> import energy_models
    >>> sol = zd.simulate(energy_models.slider_crank(), 10.0, step=0.01)
    >>> bool(sol.energy_input[-1] < 0)      # the damper
    True
    """
    q, x, phi = angles = dynamicsymbols("q x phi")
    t = dynamicsymbols._t
    names = {"crank": crank, "rod": rod, "crank_inertia": crank_inertia, "slider_mass": slider_mass, "rod_inertia": rod_inertia,
             "stiffness": stiffness, "damping": damping, "rest_length": rest_length, "pull": pull}
    A, B, J1, m, J2, k, c, l0, F = sp.symbols(list(names))

    pin = sp.Matrix([A * sp.cos(q), A * sp.sin(q)])
    slider = pin + sp.Matrix([B * sp.cos(phi), B * sp.sin(phi)])
    apart = sp.Matrix([x - (A * sp.cos(q) + B * sp.cos(phi)) / 2, -(A * sp.sin(q) + B * sp.sin(phi)) / 2])
    length = sp.sqrt(apart.dot(apart))

    start = np.arcsin(-crank / rod * np.sin(angle))
    return symbolic(
        angles,
        kinetic=(J1 * q.diff(t)**2 + m * x.diff(t)**2 + J2 * phi.diff(t)**2) / 2,
        potential=k * (length - l0)**2 / 2 - F * (x + B * sp.cos(phi)),
        force=[-c * length.diff(t) * length.diff(each) for each in angles],
        constraints={"closed_x": x - slider[0], "closed_y": -slider[1]},
        parameters=names,
        points=[(0, 0), tuple(pin), (x, 0), (2 * x - pin[0], -pin[1])],
        units=["rad", "m", "rad"],
        p0=[angle, crank * np.cos(angle) + rod * np.cos(start), start],
        name="slider_crank",
    )
