"""`inverse_dynamics`: the efforts that a motion needs, and its reactions."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

from .. import _check
from ..errors import AccuracyWarning, InconsistentStart, WrongType, WrongValue
from ..systems.base import BaseSystem, Makes, core_of, system_of
from . import read_forces
from .effort_result import Efforts
from .kinematic_result import Kinematics
from .names import dominant
from .quantities import components, conjugate, find, names_of, rates_of, values_of
from .state import State, scales, states
from .tangent import DEPENDENT, Tangent, multipliers

VIOLATION = 1e-6        # relative to the size: larger violations of the constraints by the given motion are an error
UNDRIVEN = 1e-9         # relative to the forces: a smaller residual is rounding


def inverse_dynamics(system: Any, motion: Any, p: Any = None, v: Any = None, vdot: Any = None, *, efforts: Any = None,
                     weights: Mapping[Any, float] | None = None) -> Efforts:
    """Efforts, reactions and power of a given motion.

    The equations of motion (2) are projected onto the velocities that the constraints allow and solved for the efforts; what
    remains gives the multipliers. With fewer efforts than freedoms the residual is the smallest in the mass metric; with more,
    the sum of the squares of ``effort / weight`` is.

    Parameters
    ----------
    system : system or Mechanism
    motion : Kinematics, or float or array_like (k,)
        A prescribed motion, or the times t of p, v and vdot.
    p, v, vdot : array_like (nq,) or (k, nq), (nv,) or (k, nv), (nv,) or (k, nv), optional
        With times: the motion in the system's coordinates.
    efforts : sequence of str or measure, optional
        Efforts that drive the motion, conjugate to the rates of measures, coordinates or velocities; ``"joint.torque"`` and
        ``"joint.force"`` act along the joint's coordinate. Left out: what is prescribed in `motion`. Drives of the system that
        prescribe a motion have their efforts among the reactions, ``inv["motor.torque"]``.
    weights : dict of effort to float, optional
        The magnitudes of efforts that count alike where there are more than freedoms; one where left out.

    Returns
    -------
    Efforts
        ``inv["crank.angle"]`` is the effort there, also as ``inv["crank.torque"]`` where nothing else has that name, and
        ``inv["A.force"]`` any measure.

    Raises
    ------
    InconsistentStart
        If the motion violates the constraints (3), (5) or (6).
    ValueError, TypeError
        For a wrong argument, such as kinematics of positions alone, which have no rates.

    Warns
    -----
    AccuracyWarning
        If the efforts cannot drive the motion, as at a dead point; what they cannot is named.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> m = zd.Mechanism("pendulum", gravity=(0, -9.81))
    >>> link = m.link("link", (0, 0), (2, 0), mass=3.0)
    >>> pin = m.revolute("pin", m.ground, link.start)
    >>> inv = zd.inverse_dynamics(m.system("joint"), 0.0, [0.0], [0.0], [1.5], efforts=["pin.angle"])
    >>> inv["pin.angle"].round(9)       # 3 * 2**2 / 3 * 1.5 + 3 * 9.81
    array([35.43])
    """
    given, system = system, system_of(system)
    core_of(system)
    names = None if efforts is None else names_of(efforts, "efforts")
    if isinstance(motion, Kinematics):
        if any(each is not None for each in (p, v, vdot)):
            raise WrongType("p, v and vdot must be left out with what zd.kinematics returned", "conflicting-arguments")
        system, names = _in_coordinates_of(motion, given), list(motion.prescribed) if names is None else names
        samples = motion.t, motion.p, motion.v, motion.vdot
        if (np.isfinite(motion.p).all(axis=1) & ~np.isfinite(motion.v).all(axis=1)).any():
            raise WrongValue("motion must have rates, and these positions have none: give t or speed to zd.kinematics",
                             "missing-argument")
    else:
        samples = _samples(system, motion, p, v, vdot)
    if names is None:
        raise WrongValue("efforts must be given with a motion in coordinates: where it is driven", "conflicting-arguments")
    return _solved(system, samples, names, _weights(weights, names))


def _in_coordinates_of(motion: Kinematics, given: Any) -> BaseSystem:
    """The given system in the coordinates of a motion: its masses and forces may differ from those that were tracked.

    Raises
    ------
    ValueError
        If it has others.
    """
    system = given.system(motion.system.layout) if isinstance(given, Makes) else given
    if [each.name for each in system.coordinates] != [each.name for each in motion.system.coordinates]:
        raise WrongValue(f"motion must be one of {system.name} in its coordinates, not of {motion.system.name} in others",
                         "wrong-element")
    return system


def _samples(system: BaseSystem, t: Any, p: Any, v: Any, vdot: Any) -> tuple[np.ndarray, ...]:
    """T (k,), p (k, nq), v (k, nv), vdot (k, nv)."""
    t = np.atleast_1d(_check.real("motion must hold times,", t).astype(float))
    found = []
    for name, given, size in (("p", p, system.nq), ("v", v, system.nv), ("vdot", vdot, system.nv)):
        if given is None:
            raise WrongType(f"{name} must be given with times", "missing-argument")
        array = np.atleast_2d(_check.real(f"{name} must hold", given).astype(float))
        if array.shape != (len(t), size):
            raise WrongValue(f"{name} must have shape ({len(t)}, {size}), not {array.shape}", "shape")
        if not np.isfinite(array).all():
            raise WrongValue(f"{name} must be finite, not {array[~np.isfinite(array)][0]}", "not-finite")
        found.append(array)
    return t, *found


def _weights(given: Any, names: list[str]) -> dict[str, float]:
    weights = {} if given is None else values_of(given, "weights")
    for name, value in weights.items():
        _check.choice("weights", name, names)
        _check.number(f"weights[{name!r}]", value, above=0)
    return weights


def _solved(system: BaseSystem, samples: tuple[np.ndarray, ...], names: list[str], weights: Mapping[str, float]) -> Efforts:
    """Efforts and multipliers at all samples."""
    t, p, v, vdot = samples
    k, undriven, along = len(t), {}, tuple(conjugate(system, name) for name in names)
    lam, residual, rank, power = np.full((k, system.m), np.nan), np.full(k, np.nan), np.zeros(k, dtype=int), np.full(k, np.nan)
    known = np.flatnonzero(np.isfinite(np.hstack([p, v, vdot])).all(axis=1))
    at_known = states(system, t[known], p[known], v[known])
    sizes = [len(find(at, name, "efforts").row) for at in at_known[:1] for name in along]
    G = rates_of(system, along, "efforts", t[known], p[known], v[known])["row"] if sizes else np.zeros((len(known), 0, system.nv))
    weight = np.repeat([weights.get(name, 1.0) for name in names], sizes or 0)
    u = np.full((k, len(weight)), np.nan)
    for i, at, rows in zip(known, at_known, G, strict=True):
        _check_motion(at, vdot[i])
        V = Tangent(at).velocities
        if core_of(system).functions:
            at = _with_reactions(at, V, vdot[i], along, rows, weight)
        u[i], lam[i], left, rank[i] = _at(at, V, vdot[i], rows, weight)
        residual[i], power[i] = np.linalg.norm(left), u[i] @ (rows @ v[i])
        if _is_missing(residual[i], at, V, vdot[i]):
            undriven[dominant(at, at.A @ (V @ left))] = residual[i]
    if undriven:
        subject = f"the efforts {', '.join(names)} cannot drive" if names else "nothing drives"
        warnings.warn(f"{subject} this motion of {system.name}: a force of up to "
                      f"{max(undriven.values()):.3g} N/sqrt(kg) in the mass metric is missing at {', '.join(undriven)}",
                      AccuracyWarning, stacklevel=3)
    efforts = _by_name(names, np.split(u, np.cumsum(sizes)[:-1], axis=1) if sizes else [np.full((k, 1), np.nan) for _ in names])
    return Efforts(system, samples, lam, efforts, (list(along), u), residual=residual, power=power, rank=rank)


def _at(at: State, V: np.ndarray, vdot: np.ndarray, G: np.ndarray,
        weight: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """Efforts, multipliers, the residual on the tangent space and the rank of the efforts there, at one sample.

    An effort that the constraints take up does not count: its part on the tangent space is rounding of its whole.
    """
    wanted = at.M @ vdot - at.force
    acting = V.T @ G.T * weight
    values = np.linalg.svd(acting, compute_uv=False) if acting.size else np.zeros(0)
    dependent = DEPENDENT * float((weight * _sizes(at, V, G)).max(initial=0.0))
    largest = values.max(initial=0.0)
    u = weight * np.linalg.lstsq(acting, V.T @ wanted, rcond=dependent / largest)[0] if largest > dependent else np.zeros(len(G))
    left = V.T @ (wanted - G.T @ u)
    rank = int((values > dependent).sum())
    return u, multipliers(at, G.T @ u - wanted), left, rank


def _with_reactions(at: State, V: np.ndarray, vdot: np.ndarray, along: tuple[str, ...], G: np.ndarray,
                    weight: np.ndarray) -> State:
    """The state with the forces of user functions that read the reactions of this motion."""
    def respond(force: np.ndarray) -> read_forces.Motion:
        u, lam, *_ = _at(at._replace(force=force), V, vdot, G, weight)
        return vdot, lam, u

    return at._replace(force=read_forces.solved(at, along, respond)[1])


def _sizes(at: State, V: np.ndarray, G: np.ndarray) -> np.ndarray:
    """Characteristic sizes (j,) of what efforts along the rows G (j, nv) do to the motions V (nv, k), wherever they stand.

    A row counts as at least one radian or characteristic length: at a dead point it may be rounding itself.
    """
    scale = scales(at.system, at.p)
    rows = np.maximum(np.abs(G * scale.v).max(axis=1, initial=0.0), min(scale.length, 1.0))
    return rows * float(np.abs(V / scale.v[:, None]).max(initial=0.0))


def _is_missing(residual: float, at: State, V: np.ndarray, vdot: np.ndarray) -> bool:
    """True if the residual exceeds the rounding error of the forces on the tangent space.

    Magnitudes of their terms before these cancel are evaluated only where the forces themselves are too small to explain it.
    """
    inertial, V = np.abs(at.M) @ np.abs(vdot), np.abs(V.T)
    if residual <= UNDRIVEN * np.linalg.norm(V @ (inertial + np.abs(at.force))):
        return False
    size = float(np.linalg.norm(V @ (inertial + np.maximum(at.magnitudes, np.abs(at.force)))))
    return residual > UNDRIVEN * (size or 1.0)


def _check_motion(at: State, vdot: np.ndarray) -> None:
    """Refuses a motion that violates the constraints."""
    scale = scales(at.system, at.p)
    speed = scale.length * (1.0 + float(np.abs(at.v / scale.v).max(initial=0.0)))
    size = scale.length * (1.0 + float(np.abs(vdot / scale.v).max(initial=0.0))) + speed**2 / scale.length
    for what, left, by in (("(3), positions", at.Phi, scale.length), ("(5), velocities", at.C @ at.v + at.Phi_t, speed),
                           ("(6), accelerations", at.C @ vdot - at.xi, size)):
        worst = float(np.abs(left).max(initial=0.0))
        if worst > VIOLATION * by:
            names = [each.name for each in at.system.constraints]
            raise InconsistentStart(f"the motion must satisfy the constraints {what}, of {at.system.name}: at t = {at.t:g} it "
                                    f"violates {names[int(np.abs(left).argmax())]!r} by {worst:.3g}")


def _by_name(names: list[str], found: list[np.ndarray]) -> dict[str, np.ndarray]:
    """Efforts by name, (k,) or (k, size), from (k, size) each."""
    by_name = {}
    for name, values in zip(names, found, strict=True):
        size = values.shape[1]
        by_name[name] = values[:, 0] if size == 1 else values
        if 1 < size <= 3:
            by_name |= {part: values[:, i] for i, part in enumerate(components(name, size))}
    return by_name
