"""`from_mechanics`: system from the definitions of a method of `sympy.physics.mechanics`, before its elimination."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..errors import WrongType, WrongValue
from .define import symbolic
from .system import SymbolicSystem

import sympy  # isort: skip  (after `define`, which says what to install)
from sympy.physics.mechanics import KanesMethod, LagrangesMethod, ReferenceFrame, dynamicsymbols

from .._private.types import ArrayLike, Expression

try:
    from sympy.physics.mechanics import System
except ImportError:     # before SymPy 1.13
    System = ()

SAMPLES = 4         # random states at which rows are compared
DEPENDENT = 1e-9    # of a row: what others leave of it where they span it, after rounding


def from_mechanics(
    method: object, *, potential: Expression | None = None, parameters: Mapping[Any, float] | None = None,
    points: Sequence[Sequence[Expression]] = (), quaternions: Sequence[int | str | Expression] = (),
    units: Sequence[str] | None = None, p0: ArrayLike | None = None, v0: ArrayLike | None = None, name: str = "symbolic",
    progress: bool = True,
) -> SymbolicSystem:
    """The system that SymPy's mechanics describes, with all of its coordinates and constraints.

    Parameters
    ----------
    method : LagrangesMethod, KanesMethod or System
        From `sympy.physics.mechanics`. Of a KanesMethod and of a System, as the joints framework builds it, coordinates and
        speeds that depend on others are taken like the rest, and their constraints go to the core. A KanesMethod must have its
        bodies (``bodies=``) and loads (``forcelist=``).
    potential : Expr, optional
        V in J, of forces that are among the loads already: then there are energies. Left out: of a LagrangesMethod, what its
        Lagrangian has without velocities; else there are none.
    parameters, points, quaternions, units, p0, v0, name, progress
        As for `symbolic`.

    Returns
    -------
    SymbolicSystem

    Raises
    ------
    TypeError, ValueError
        If the argument is of another kind, or lacks a term that is needed.

    Examples
    --------
    >>> import sympy as sp, zerodrift as zd
    >>> from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols
    >>> x, y = dynamicsymbols("x y")
    >>> g, t = sp.Symbol("g"), dynamicsymbols._t
    >>> L = (x.diff(t)**2 + y.diff(t)**2) / 2 - g * y
    >>> method = LagrangesMethod(L, [x, y], hol_coneqs=[(x**2 + y**2 - 1) / 2])
    >>> pendulum = zd.from_mechanics(method, parameters={g: 9.81}, p0=[1.0, 0.0])
    >>> zd.simulate(pendulum, 1.0, step=0.01).p[-1].round(5)
    array([-0.98629, -0.16501])
    """
    if isinstance(method, LagrangesMethod):
        described = _of_lagrange(method, potential)
    elif isinstance(method, KanesMethod):
        described = _of_kane(method, potential)
    elif System and isinstance(method, System):
        described = _of_system(method, potential)
    else:
        raise WrongType(f"method must be a LagrangesMethod, a KanesMethod or a System of sympy.physics.mechanics, not {method!r}")
    return symbolic(**described, parameters=parameters, points=points, quaternions=quaternions, units=units, p0=p0, v0=v0,
                    name=name, progress=progress)


# ---- Lagrange ----


def _of_lagrange(method: LagrangesMethod, potential: Any) -> dict[str, Any]:
    q, rates = list(method.q), list(method._qdots)
    lagrangian = method._L[0] if isinstance(method._L, sympy.MatrixBase) else method._L
    at_rest = -lagrangian.xreplace(dict.fromkeys(rates, sympy.S.Zero))
    V = at_rest if potential is None else potential
    holonomic = list(method._hol_coneqs)
    nonholonomic = list(method.coneqs)[len(holonomic):]     # before these stand the rates of the holonomic ones
    return {"coordinates": q, "kinetic": lagrangian + V, "potential": V, "force": _generalized_forces(method, rates),
            "constraints": holonomic, "nonholonomic": nonholonomic}


def _generalized_forces(method: LagrangesMethod, rates: list[Any]) -> list[Any] | None:
    if not method.forcelist:
        return None
    if method.inertial is None:
        raise WrongValue("the LagrangesMethod has a forcelist, but no frame that its velocities refer to", "missing-argument")
    force = [sympy.S.Zero] * len(rates)
    for place, load in method.forcelist:
        frame = method.inertial
        velocity = place.ang_vel_in(frame) if isinstance(place, ReferenceFrame) else place.vel(frame)
        for i, rate in enumerate(rates):
            force[i] += velocity.diff(rate, frame, var_in_dcm=False).dot(load)
    return force


# ---- Kane ----


def _of_kane(method: KanesMethod, potential: Any) -> dict[str, Any]:
    if method.bodylist is None:
        raise WrongValue("the KanesMethod has no bodies yet: give it bodies=, or call kanes_equations", "missing-argument")
    if len(method._uaux):
        raise WrongValue(f"auxiliary speeds such as {method._uaux[0]} are not for integration: leave u_auxiliary out",
                         "expression")
    velocity = list(method._k_nh * method.u + method._f_nh) if len(method._k_nh) else []
    pdot = [method._qdot_u_map[rate] for rate in method.q.diff(dynamicsymbols._t)]
    nonholonomic = _not_from_positions(list(method._f_h), velocity, method.q, method.u, pdot)
    return _unconstrained(method._inertial, method.q, method.u, pdot, method.bodylist, method.forcelist, potential) | {
        "constraints": list(method._f_h), "nonholonomic": nonholonomic}


def _of_system(method: Any, potential: Any) -> dict[str, Any]:
    if len(method.u_aux):
        raise WrongValue(f"auxiliary speeds such as {method.u_aux[0]} are not for integration: leave them out", "expression")
    loads = [*method.loads, *(load for actuator in method.actuators for load in actuator.to_loads())]
    free = KanesMethod(method.frame, list(method.q), list(method.u), kd_eqs=list(method.kdes))
    pdot = [free._qdot_u_map[rate] for rate in free.q.diff(dynamicsymbols._t)]
    return _unconstrained(method.frame, free.q, free.u, pdot, method.bodies, loads, potential) | {
        "constraints": list(method.holonomic_constraints), "nonholonomic": list(method.nonholonomic_constraints)}


def _unconstrained(frame: Any, q: Any, u: Any, pdot: list[Any], bodies: Any, loads: Any, potential: Any) -> dict[str, Any]:
    """The equations of motion of the bodies with all coordinates and speeds independent."""
    rates = list(q.diff(dynamicsymbols._t))
    free = KanesMethod(frame, list(q), list(u), kd_eqs=[rate - value for rate, value in zip(rates, pdot, strict=True)])
    force, _ = free.kanes_equations(list(bodies), list(loads) if loads else None)
    M, bias = free.mass_matrix, force - free.forcing
    if potential is not None:       # the loads contain the potential's forces already
        gradient = sympy.Matrix([potential]).jacobian(q) * sympy.Matrix(pdot).jacobian(u)
        force = force + gradient.T
    kinematics = None if pdot == list(u) else dict(zip(rates, pdot, strict=True))
    mass = sympy.Matrix(len(u), len(u), lambda i, j: M[min(i, j), max(i, j)])   # SymPy writes the triangles differently
    return {"coordinates": list(q), "speeds": list(u), "kinematics": kinematics, "mass": mass, "bias": list(bias),
            "force": list(force), "potential": potential}


def _not_from_positions(holonomic: list[Any], velocity: list[Any], q: Any, u: Any, pdot: list[Any]) -> list[Any]:
    """Nonholonomic constraints: velocity constraints that are not derivatives of the holonomic ones, found at random states."""
    if not holonomic or not velocity:
        return velocity
    by_position = sympy.Matrix(holonomic).jacobian(q) * sympy.Matrix(pdot).jacobian(u)
    rows = by_position.col_join(sympy.Matrix(velocity).jacobian(u))
    unknown = sorted(rows.atoms(sympy.Symbol, *(type(x) for x in [*q, *u])), key=str)
    random, independent = np.random.default_rng(0), set()
    for _ in range(SAMPLES):
        values = dict(zip(unknown, random.uniform(0.5, 1.5, len(unknown)), strict=True))
        numbers = np.array(rows.xreplace({x: sympy.Float(value) for x, value in values.items()}), dtype=float)
        basis = list(numbers[: len(holonomic)])
        for i, row in enumerate(numbers[len(holonomic):]):
            fit = np.linalg.lstsq(np.array(basis).T, row, rcond=None)[0]
            if np.abs(row - np.array(basis).T @ fit).max() > DEPENDENT * np.abs(row).max():
                independent.add(i)
                basis.append(row)
    return [velocity[i] for i in sorted(independent)]
