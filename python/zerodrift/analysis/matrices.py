"""Mass matrix, Jacobian of a measure and bias of a system at a state, in its coordinates or on the tangent space."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._private import checks
from .._private.types import ArrayLike, MeasureLike, SystemLike
from .quantities import find, names_of
from .state import State, arguments, scales, state
from .tangent import Tangent, null_space


def _at(system: Any, p: Any, v: Any, t: float) -> State:
    system, t, p, v = arguments(system, p, v, t)
    return state(system, t, p, v)


def _tangent(at: State) -> np.ndarray:
    """Basis (nv, r) of the velocities that all constraints allow, orthonormal in characteristic scales."""
    return null_space(at.C, scales(at.system, at.p).v)


def mass_matrix(system: SystemLike, p: ArrayLike | None = None, *, t: float = 0.0, tangent: bool = False) -> np.ndarray:
    """Mass matrix M of (2) at a position.

    Parameters
    ----------
    system : system or Mechanism
    p : array_like (nq,), optional
        Position; left out: the start.
    t : float
        Time in s.
    tangent : bool
        True: the matrix is restricted to the r velocities that the constraints allow: ``Z.T @ M @ Z``, with Z (nv, r) a basis
        of these that is orthonormal in characteristic scales, ``zd.jacobian(system, names_of_velocities, p, tangent=True)``.

    Returns
    -------
    ndarray (nv, nv), of the tangent space (r, r)

    Raises
    ------
    ValueError, TypeError
        For a wrong argument.

    Examples
    --------
    >>> import zerodrift as zd
    >>> zd.mass_matrix(zd.systems.oscillator(mass=2.0))
    array([[2.]])
    """
    at = _at(system, p, None, t)
    if not checks.instance("tangent", tangent, bool, "True or False"):
        return at.M.copy()
    Z = _tangent(at)
    return Z.T @ at.M @ Z


def jacobian(system: SystemLike, measure: MeasureLike, p: ArrayLike | None = None, *, t: float = 0.0,
             tangent: bool = False) -> np.ndarray:
    """Derivative of the rate of a measure with respect to the velocities.

    Its transpose turns an effort, conjugate to the rate of the measure, into generalized forces.

    Parameters
    ----------
    system : system or Mechanism
    measure : measure, str, or a sequence of these
        Measures of positions or velocities, and coordinates and velocities of the system by name; several are stacked. For a
        measure of velocities the result is the derivative of the measure itself.
    p : array_like (nq,), optional
        Position; left out: the start.
    t : float
        Time in s.
    tangent : bool
        True: the matrix is restricted to the r velocities that the constraints allow, see `mass_matrix`.

    Returns
    -------
    ndarray (components, nv), of the tangent space (components, r)

    Raises
    ------
    ValueError
        If there is no such measure, or it depends on accelerations or reactions.

    Examples
    --------
    >>> import zerodrift as zd
    >>> m = zd.Mechanism("pendulum")
    >>> link = m.link("link", (0, 0), (2, 0), mass=1.0)
    >>> pin = m.revolute("pin", m.ground, link.start)
    >>> zd.jacobian(m.system("joint"), link.end.position.y)
    array([[2.]])
    """
    at = _at(system, p, None, t)
    rows = np.vstack([find(at, name, "measure").row for name in names_of(measure, "measure")])
    return rows @ _tangent(at) if checks.instance("tangent", tangent, bool, "True or False") else rows


def bias(system: SystemLike, p: ArrayLike | None = None, v: ArrayLike | None = None, *, t: float = 0.0,
         tangent: bool = False) -> np.ndarray:
    """Bias d of (2) at a state: the generalized inertial forces that do not depend on the accelerations.

    Parameters
    ----------
    system : system or Mechanism
    p, v : array_like (nq,), (nv,), optional
        The state; left out: the start. Constraints need not be satisfied.
    t : float
        Time in s.
    tangent : bool
        True: the vector is restricted to the r velocities that the constraints allow, see `mass_matrix`: ``Z.T @ (d + M @ x)``,
        with x the smallest acceleration that satisfies (6). Then ``mass_matrix(..., tangent=True) @ a + bias = Z.T @ f``, with
        the acceleration ``x + Z @ a``.

    Returns
    -------
    ndarray (nv,), of the tangent space (r,)

    Raises
    ------
    ValueError, TypeError
        For a wrong argument.

    Examples
    --------
    >>> import zerodrift as zd
    >>> zd.bias(zd.systems.oscillator())
    array([0.])
    """
    at = _at(system, p, v, t)
    terms = at.system.evaluate(at.p, at.v, at.t)
    d = np.zeros(at.system.nv) if terms.d is None else np.array(terms.d)
    if not checks.instance("tangent", tangent, bool, "True or False"):
        return d
    x = Tangent(at).solve_rows(at.xi) if at.system.m else np.zeros(at.system.nv)
    return _tangent(at).T @ (d + at.M @ x)
