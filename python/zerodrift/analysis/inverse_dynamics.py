"""`inverse_dynamics`: the efforts that a motion needs, and its reactions."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any, NoReturn

import numpy as np

from .._private import checks
from .._private.gateway import needed_efforts
from .._private.types import ArrayLike, Measures, SystemLike, Values
from ..errors import AccuracyWarning, InconsistentStart, SingularSystem, WrongType, WrongValue
from ..systems.base import BaseSystem, Makes, core_of, system_of
from . import read_forces
from .effort_result import Efforts
from .kinematic_result import Kinematics
from .names import dominant
from .phase_of_motion import of_motion, warn_of_forces
from .quantities import components, conjugate, names_of, rates_of, values_of
from .state import State, scales, small_core, state
from .tangent import NO_MASS, Tangent

VIOLATION = 1e-6        # relative to the size: larger violations of the constraints by the given motion are an error
UNDRIVEN = 1e-9         # relative to the forces: a smaller residual is rounding


def inverse_dynamics(system: SystemLike, motion: Kinematics | ArrayLike, p: ArrayLike | None = None, v: ArrayLike | None = None,
                     vdot: ArrayLike | None = None, *, efforts: Measures | None = None,
                     weights: Values | None = None) -> Efforts:
    """Efforts, reactions and power of a given motion.

    The equations of motion (2) are projected onto the velocities that the constraints allow and solved for the efforts; the
    remainder gives the multipliers. With fewer efforts than freedoms the residual is the smallest in the mass metric; with
    more, the sum of the squares of ``effort / weight`` is.

    Contacts, stops and dry friction are in the phase of the motion: closed contacts and sticking friction are constraints,
    sliding friction is a force. ``inv.system.phase`` has the phase by name.

    Parameters
    ----------
    system : system or Mechanism
    motion : Kinematics, or float or array_like (k,)
        A prescribed motion, or the times t of p, v and vdot.
    p, v, vdot : array_like (nq,) or (k, nq), (nv,) or (k, nv), (nv,) or (k, nv), optional
        With times: the motion in the system's coordinates.
    efforts : sequence of str or measure, optional
        Efforts that drive the motion, conjugate to the rates of measures, coordinates or velocities; ``"joint.torque"`` and
        ``"joint.force"`` act along the joint's coordinate. Left out: those along the prescribed quantities of `motion`. Drives
        of the system that prescribe a motion have their efforts among the reactions, ``inv["motor.torque"]``.
    weights : dict of effort to float, optional
        Magnitudes of efforts that count equally if there are more efforts than freedoms; by default 1.

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
        For a wrong argument, such as kinematics of positions alone, which have no rates, or a motion whose phase changes.

    Warns
    -----
    AccuracyWarning
        If the efforts cannot drive the motion, as at a dead point; the direction is named. If contacts would pull, or friction
        that sticks would exceed its bound.

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
        samples: tuple[np.ndarray, ...] = motion.t, motion.p, motion.v, motion.vdot
        if (np.isfinite(motion.p[:, :1]) & ~np.isfinite(motion.v[:, :1])).any():
            raise WrongValue("motion must have rates, and these positions have none: give t or speed to zd.kinematics",
                             "missing-argument")
    else:
        samples = _samples(system, motion, p, v, vdot)
    if names is None:
        raise WrongValue("efforts must be given with a motion in coordinates: where it is driven", "conflicting-arguments")
    system = of_motion(system, samples)
    found = _solved(system, samples, names, _weights(weights, names))
    if hasattr(system, "phases_of"):
        warn_of_forces(system, found.t, found.multipliers)
    return found


def _in_coordinates_of(motion: Kinematics, given: Any) -> BaseSystem:
    """The given system in the coordinates of a motion: its masses and forces may differ from those that were tracked.

    Raises
    ------
    ValueError
        If it has others.
    """
    system = given.system(getattr(motion.system, "layout", None)) if isinstance(given, Makes) else given
    if [each.name for each in system.coordinates] != [each.name for each in motion.system.coordinates]:
        raise WrongValue(f"motion must be one of {system.name} in its coordinates, not of {motion.system.name} in others",
                         "wrong-element")
    return system


def _samples(system: BaseSystem, t: Any, p: Any, v: Any, vdot: Any) -> tuple[np.ndarray, ...]:
    """T (k,), p (k, nq), v (k, nv), vdot (k, nv)."""
    t = np.atleast_1d(checks.real("motion must hold times,", t).astype(float))
    found = []
    for name, given, size in (("p", p, system.nq), ("v", v, system.nv), ("vdot", vdot, system.nv)):
        if given is None:
            raise WrongType(f"{name} must be given with times", "missing-argument")
        array = np.atleast_2d(checks.real(f"{name} must hold", given).astype(float))
        if array.shape != (len(t), size):
            raise WrongValue(f"{name} must have shape ({len(t)}, {size}), not {array.shape}", "shape")
        if not np.isfinite(array).all():
            raise WrongValue(f"{name} must be finite, not {array[~np.isfinite(array)][0]}", "not-finite")
        found.append(array)
    return t, *found


def _weights(given: Any, names: list[str]) -> dict[str, float]:
    weights = {} if given is None else values_of(given, "weights")
    for name, value in weights.items():
        checks.choice("weights", name, names)
        checks.number(f"weights[{name!r}]", value, above=0)
    return weights


def _solved(system: BaseSystem, samples: tuple[np.ndarray, ...], names: list[str], weights: Mapping[str, float]) -> Efforts:
    """Efforts and multipliers at all samples."""
    core, along, k = small_core(system), tuple(conjugate(system, name) for name in names), len(samples[0])
    are_known = all(np.isfinite(each).all() for each in samples[1:])
    known = slice(None) if are_known else np.isfinite(np.hstack(samples[1:])).all(axis=1)
    t, p, v, vdot = at = [each[known] for each in samples]
    sizes = [system._watching.size(name) for name in along]
    weight = np.repeat([weights.get(name, 1.0) for name in names], np.array(sizes, dtype=int))
    G = rates_of(system, along, "efforts", t, p, v, ["row"])["row"] if names else np.empty(0)
    G = G.reshape(len(t), len(weight), system.nv)
    scale = scales(system, p[0] if len(p) else np.zeros(system.nq))

    def needed(which: slice, force: np.ndarray | None) -> list[np.ndarray]:
        found = needed_efforts(core, [each[which] for each in at], G[which], weight, scale.length, scale.v, force)
        if isinstance(found, int):
            at_fault = [each[which][found] for each in at]
            _refuse(state(system, *at_fault[:3]), at_fault[3])
        return found

    def with_reactions(i: int) -> np.ndarray:
        """The generalized forces (nv,) with those of user functions that read the reactions of this motion."""
        def respond(force: np.ndarray) -> read_forces.Motion:
            u, lam, *_ = needed(slice(i, i + 1), force[None])
            return vdot[i], lam[0], u[0]

        return read_forces.solved(state(system, t[i], p[i], v[i]), along, respond)[1]

    force = np.array([with_reactions(i) for i in range(len(t))]) if core.functions else None
    found = u, _, residual, wanted, *_ = needed(slice(None), force)
    undriven: dict[str, float] = {}
    for i in np.flatnonzero(residual > UNDRIVEN * wanted):
        here = state(system, t[i], p[i], v[i])
        here = here if force is None else here._replace(force=force[i])
        undriven |= _missing(here, vdot[i], G[i].T @ u[i])
    if undriven:
        subject = f"the efforts {', '.join(names)} cannot drive" if names else "nothing drives"
        warnings.warn(f"{subject} this motion of {system.name}: a force of up to "
                      f"{max(undriven.values()):.3g} N/sqrt(kg) in the mass metric is missing at {', '.join(undriven)}",
                      AccuracyWarning, stacklevel=3)
    if not are_known:
        known_alone, found = found, [np.full((k, *each.shape[1:]), np.nan) for each in found]
        for each, values in zip(found, known_alone, strict=True):
            each[known] = values
    u, lam, residual, _, power, rank = found
    efforts = _by_name(names, [u[:, end - size:end] for size, end in zip(sizes, np.cumsum(sizes), strict=True)])
    return Efforts(system, samples, lam, efforts, (along, u), residual=residual, power=power,
                   rank=(rank if are_known else np.nan_to_num(rank)).astype(int))


def _refuse(at: State, vdot: np.ndarray) -> NoReturn:
    """Refuses a motion that violates the constraints, or an allowed one that has no mass."""
    scale = scales(at.system, at.p)
    speed = scale.length * (1.0 + np.abs(at.v / scale.v).max(initial=0.0))
    size = scale.length * (1.0 + np.abs(vdot / scale.v).max(initial=0.0)) + speed**2 / scale.length
    for what, left, by in (("(3), positions", at.Phi, scale.length), ("(5), velocities", at.C @ at.v + at.Phi_t, speed),
                           ("(6), accelerations", at.C @ vdot - at.xi, size)):
        worst = np.abs(left).max(initial=0.0)
        if worst > VIOLATION * by:
            name = at.system.constraints[np.abs(left).argmax()].name
            raise InconsistentStart(f"the motion must satisfy the constraints {what}, of {at.system.name}: at t = {at.t:g} it "
                                    f"violates {name!r} by {worst:.3g}")
    raise SingularSystem(NO_MASS)


def _missing(at: State, vdot: np.ndarray, effort: np.ndarray) -> dict[str, float]:
    """The residual by the name of the coordinate that it moves most; empty if it is the rounding error of terms of the forces."""
    V = Tangent(at).velocities
    left = V.T @ (at.M @ vdot - at.force - effort)
    size = np.linalg.norm(np.abs(V.T) @ (np.abs(at.M) @ np.abs(vdot) + np.maximum(at.magnitudes, np.abs(at.force))))
    residual = float(np.linalg.norm(left))
    return {dominant(at, at.A @ (V @ left)): residual} if residual > UNDRIVEN * (size or 1.0) else {}


def _by_name(names: list[str], found: list[np.ndarray]) -> dict[str, np.ndarray]:
    """Efforts by name, (k,) or (k, size), from (k, size) each."""
    by_name = {}
    for name, values in zip(names, found, strict=True):
        size = values.shape[1]
        by_name[name] = values[:, 0] if size == 1 else values
        if 1 < size <= 3:
            by_name |= {part: values[:, i] for i, part in enumerate(components(name, size))}
    return by_name
