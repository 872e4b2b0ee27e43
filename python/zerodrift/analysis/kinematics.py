"""`kinematics`: positions, velocities and accelerations of a system whose motion is prescribed."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

from .._private import checks
from .._private.gateway import Tracked
from .._private.types import ArrayLike, Motions, SystemLike, Values
from ..errors import AccuracyWarning, InconsistentStart, LockedWarning, SingularSystem, WrongValue
from ..systems.base import BaseSystem, core_of, system_of
from .kinematic_result import Kinematics
from .names import dominant
from .phase import in_phase
from .phase_of_motion import at_start, warn_of_gaps
from .prescribed import Prescribed, prescribed
from .quantities import is_velocity, rates_of, values_of
from .retraction import near_to, prescribing
from .state import State, scales, state
from .tangent import null_space

INACCURATE = 1e-4           # of the largest second rate: differences of an array over time that are worth a warning


def kinematics(system: SystemLike, motion: Motions | None = None, t: ArrayLike | None = None, *, speed: float | None = None,
               near: ArrayLike | Values | None = None) -> Kinematics:
    """Motion by prescribed quantities, or by the drives alone, without forces and masses; inverse kinematics of a robot.

    Positions are tracked sample by sample on one assembly branch. Velocities and accelerations follow from (5) and (6) with the
    constraints of the prescribed quantities. Drives of the system run at the times of the samples. Contacts and stops that touch
    at the start stay closed, and friction does not matter.

    Parameters
    ----------
    system : system or Mechanism
    motion : dict of measure to values, optional
        Quantities of positions that are prescribed: arrays (k,) or (k, size) over the samples, callables of t in NumPy's
        functions, or SymPy expressions in t. Together with the constraints, drives included, they must determine all positions;
        left out: drives of angles, displacements, lengths or constant speeds must.
    t : array_like (k,), optional
        Times of the samples in s, increasing. Arrays become quintic splines; `Kinematics.errors` estimates the errors of their
        second derivatives.
    speed : float, optional
        In place of t: the constant rate of the one scalar that is prescribed. Without both, only positions are determined, at
        t = 0, and rates are NaN.
    near : array_like (nq,) or dict of measure to value, optional
        Position at which the tracking begins; left out: the start.

    Returns
    -------
    Kinematics
        ``kin["coupler.acceleration"]`` is any measure that needs no forces, at all samples. Samples beyond a dead point are NaN.

    Raises
    ------
    SingularSystem
        If positions are not determined.
    InconsistentStart
        If prescribed quantities contradict each other or the constraints.
    ValueError, TypeError
        For a wrong argument.

    Warns
    -----
    LockedWarning
        If samples lie beyond a dead point; the message has the limit. Later ones that are within reach again are found.
    AccuracyWarning
        If an array over time is too coarse for its derivatives. If the motion passes a contact that is open at its start.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> kin = zd.kinematics(zd.models.four_bar(), {"crank.angle": np.linspace(np.pi / 2, 5.0, 50)}, speed=10.0)
    >>> kin["rocker.angle"].shape, bool(abs(kin["crank.angular_velocity"] - 10.0).max() < 1e-9)
    ((50,), True)
    >>> m = zd.Mechanism("crank")
    >>> crank = m.link("crank", (0, 0), (2, 0), mass=1.0)
    >>> drive = m.motor("drive", m.revolute("pin", m.ground, crank.start), angle=lambda t: 3 * t)
    >>> kin = zd.kinematics(m, t=np.linspace(0, 1, 101))
    >>> bool(abs(kin["crank.end.acceleration.x"] + 18 * np.cos(3 * kin.t)).max() < 1e-12)
    True
    """
    system = system_of(system)
    core_of(system)
    given = {} if motion is None else values_of(motion, "motion")
    times = None if t is None else checks.increasing("t", t, -np.inf, np.inf)
    if speed is not None:
        speed = _speed(speed, given, times)
    wanted = {name: prescribed(f"motion[{name!r}]", value, times, speed) for name, value in given.items()}
    times = _times(wanted, times, speed)
    if system._groups:
        p = near_to(in_phase(system, [0] * len(system._groups)), near, times[0])
        system, near = at_start(system, times[0], p), p
    p = near_to(system, near, times[0])
    rows = _rows_of(system, times[0], p, wanted)
    value, *rates = (np.hstack([times[:, None], *(getattr(each, order) for each in wanted.values())])
                     for order in ("value", "rate", "second"))
    rates = [] if t is None and speed is None else [np.ascontiguousarray(each[:, 1:]) for each in rates]
    tracked = prescribing(system, p, wanted).track(p, np.roll(value, -1, axis=1), *rates)
    if not tracked.is_determined:
        _check_freedom(state(system, times[0], p, np.zeros(system.nv)), rows, tuple(wanted))
    _report(system, tracked, times, wanted)
    _warn_of_errors(wanted)
    if hasattr(system, "phases_of"):
        warn_of_gaps(system, times, tracked.p)
    return Kinematics(system, times, *tracked[:3], {name: each.error for name, each in wanted.items()}, tuple(wanted))


def _speed(speed: Any, given: Mapping[str, Any], times: Any) -> float:
    speed = checks.number("speed", speed)
    if times is not None or len(given) != 1:
        raise WrongValue("speed must be given without t, and for a single prescribed quantity", "conflicting-arguments")
    if speed == 0:
        raise WrongValue("speed must not be zero: the samples then have no times", "out-of-range")
    return speed


def _times(wanted: Mapping[str, Prescribed], times: np.ndarray | None, speed: float | None) -> np.ndarray:
    """The times of the samples."""
    if not wanted and times is None:
        raise WrongValue("motion must prescribe at least one quantity, or t be given where drives determine all positions",
                         "missing-argument")
    counts = {len(each.value) for each in wanted.values()}
    if len(counts) > 1:
        raise WrongValue(f"motion must have as many samples of each quantity, not {sorted(counts)}", "shape")
    if times is not None:
        return times
    value = next(iter(wanted.values())).value
    if speed is None:
        return np.zeros(len(value))
    times = (value[:, 0] - value[0, 0]) / speed
    if value.shape[1] != 1 or (np.diff(times) <= 0).any():
        raise WrongValue("speed must be that of a scalar whose samples go its way: increasing for a positive speed",
                         "not-increasing")
    return times


def _rows_of(system: BaseSystem, t: float, p: np.ndarray, wanted: Mapping[str, Prescribed]) -> np.ndarray:
    """Rows of the quantities at a position; those of velocities and of other sizes are refused."""
    rows = rates_of(system, tuple(wanted), "motion", np.array([t]), p[None], parts=("row",))["row"][0]
    for name, each in wanted.items():
        if is_velocity(system, name):
            raise WrongValue(f"motion must prescribe quantities of positions, and {name!r} is one of velocities", "wrong-measure")
        if each.value.shape[1] != (size := system._watching.size(name)):
            raise WrongValue(f"motion[{name!r}] must have {size} components, not {each.value.shape[1]}", "shape")
    return rows


def _check_freedom(at: State, rows: np.ndarray, wanted: tuple[str, ...]) -> None:
    """Refuses quantities or drives that do not determine the positions; the coordinate that stays free is named."""
    free = null_space(np.vstack([at.holonomic, rows]), scales(at.system, at.p).v)
    if free.shape[1]:
        named = ", ".join(sorted({dominant(at, at.A @ column) for column in free.T}))
        what, more = ("prescribed quantities", "") if wanted else ("drives", " by motion=, or drives of angles or lengths")
        raise SingularSystem(f"the {what} must determine all positions of {at.system.name}, and leave {free.shape[1]} free: "
                             f"{named}; prescribe more{more}, or begin beside a singular position with near=")


def _report(system: BaseSystem, tracked: Tracked, times: np.ndarray, wanted: Mapping[str, Prescribed]) -> None:
    """Warns of samples beyond a dead point.

    Raises
    ------
    InconsistentStart
        If quantities or their rates contradict each other or the constraints.
    """
    if (i := tracked.contradicting) >= 0:
        if np.isnan(tracked.p[i, 0]):
            raise InconsistentStart(f"the prescribed quantities must agree with each other and with the constraints of "
                                    f"{system.name}: at t = {times[i]:g} {', '.join(wanted)} differ by "
                                    f"{tracked.contradiction:.3g} of their changes from what the others determine")
        raise InconsistentStart(f"the prescribed motion must agree with the constraints of {system.name}: at t = {times[i]:g} "
                                f"rates differ by {tracked.contradiction:.3g} of their size")
    if tracked.reached is not None:
        ends = np.cumsum([each.value.shape[1] for each in wanted.values()], dtype=int)
        limit = ", ".join(f"{name} = {np.array2string(value, precision=9)[1:-1]}" for name, value in
                          zip([*wanted] or ["t"], np.split(tracked.reached, ends), strict=not wanted))
        beyond = np.isnan(tracked.p[:, 0]).sum()
        warnings.warn(f"the motion of {system.name} comes to a dead point, {limit}: {beyond} samples beyond it are NaN",
                      LockedWarning, stacklevel=3)


def _warn_of_errors(wanted: Mapping[str, Prescribed]) -> None:
    for name, each in wanted.items():
        if each.error and each.error > INACCURATE * np.abs(each.second).max(initial=0.0) + each.rounding:
            warnings.warn(f"the samples of {name} must be closer for accurate accelerations: these differ by up to "
                          f"{each.error:.3g} between a quintic spline and polynomials; a callable or an expression is exact",
                          AccuracyWarning, stacklevel=3)
