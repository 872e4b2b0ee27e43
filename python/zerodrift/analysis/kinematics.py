"""`kinematics`: positions, velocities and accelerations of a system whose motion is prescribed."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

from .. import _check
from ..errors import AccuracyWarning, InconsistentStart, LockedWarning, WrongValue
from ..systems.base import BaseSystem, core_of, system_of
from .kinematic_result import Kinematics
from .prescribed import Prescribed, prescribed
from .quantities import find, rates_of, values_of
from .retraction import near_to
from .state import scales, state, states
from .tangent import DEPENDENT, row_lengths
from .tracker import DeadPoint, Target, Tracker

CONTRADICTION = 1e-9        # of the size of the rates: prescribed ones that contradict each other
INACCURATE = 1e-4           # of the largest second rate: differences of an array over time that are worth a warning


def kinematics(system: Any, motion: Mapping[Any, Any], t: Any = None, *, speed: float | None = None,
               near: Any = None) -> Kinematics:
    """Motion of a system by prescribed quantities, without forces and masses; inverse kinematics for the end of a robot.

    Positions are tracked sample by sample on one assembly branch. Velocities and accelerations follow from (5) and (6) with the
    rows of the prescribed quantities. Drives of the system run at the times of the samples.

    Parameters
    ----------
    system : system or Mechanism
    motion : dict of measure to values
        Quantities of positions that are prescribed: arrays (k,) or (k, size) over the samples, callables of t in NumPy's
        functions, or SymPy expressions in t. Together with the constraints they must determine all positions.
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
        If positions stay free.
    InconsistentStart
        If what is prescribed contradicts itself or the constraints.
    ValueError, TypeError
        For a wrong argument.

    Warns
    -----
    LockedWarning
        If samples lie beyond a dead point; the message has the limit. Later ones that are within reach again are found.
    AccuracyWarning
        If an array over time is too coarse for its derivatives.

    Examples
    --------
    >>> import numpy as np
    >>> import zerodrift as zd
    >>> kin = zd.kinematics(zd.models.four_bar(), {"crank.angle": np.linspace(np.pi / 2, 5.0, 50)}, speed=10.0)
    >>> kin["rocker.angle"].shape, bool(abs(kin["crank.angular_velocity"] - 10.0).max() < 1e-9)
    ((50,), True)
    """
    system = system_of(system)
    core_of(system)
    given, times = values_of(motion, "motion"), None if t is None else _check.increasing("t", t, -np.inf, np.inf)
    if speed is not None:
        speed = _speed(speed, given, times)
    wanted = {name: prescribed(f"motion[{name!r}]", value, times, speed) for name, value in given.items()}
    times = _times(wanted, times, speed)
    p = near_to(system, near, times[0])
    _check_quantities(system, times[0], p, wanted)
    tracker = Tracker(system, list(wanted))
    positions = _tracked(tracker, p, times, wanted)
    rates = _rates(system, times, positions, wanted, has_rates=t is not None or speed is not None)
    _warn_of_errors(wanted)
    return Kinematics(system, times, positions, *rates, {name: each.error for name, each in wanted.items()}, tuple(wanted))


def _speed(speed: Any, given: Mapping[str, Any], times: Any) -> float:
    speed = _check.number("speed", speed)
    if times is not None or len(given) != 1:
        raise WrongValue("speed must be given without t, and for a single prescribed quantity", "conflicting-arguments")
    if speed == 0:
        raise WrongValue("speed must not be zero: the samples then have no times", "out-of-range")
    return speed


def _times(wanted: Mapping[str, Prescribed], times: np.ndarray | None, speed: float | None) -> np.ndarray:
    """The times of the samples."""
    if not wanted:
        raise WrongValue("motion must prescribe at least one quantity", "missing-argument")
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


def _check_quantities(system: BaseSystem, t: float, p: np.ndarray, wanted: Mapping[str, Prescribed]) -> None:
    at = state(system, t, p, np.zeros(system.nv))
    for name, each in wanted.items():
        found = find(at, name, "motion")
        if found.is_velocity:
            raise WrongValue(f"motion must prescribe quantities of positions, and {name!r} is one of velocities", "wrong-measure")
        if each.value.shape[1] != len(found.value):
            raise WrongValue(f"motion[{name!r}] must have {len(found.value)} components, not {each.value.shape[1]}", "shape")


def _tracked(tracker: Tracker, p: np.ndarray, times: np.ndarray, wanted: Mapping[str, Prescribed]) -> np.ndarray:
    """Positions (k, nq) at the samples, NaN beyond a dead point; from the last position before it to samples within reach."""
    tracker.check_determined(times[0], p)
    found, here = np.full((len(times), tracker.system.nq), np.nan), tracker.target(times[0], p)
    first: DeadPoint | None = None
    for i, t in enumerate(times):
        there = Target(float(t), {name: each.value[i] for name, each in wanted.items()})
        try:
            p = tracker.follow(p, here, there)
        except DeadPoint as dead:
            if first is None:
                _check_agreement(tracker, dead, there)
                first = dead
            continue
        found[i], here = p, there
    if first is not None:
        limit = ", ".join(f"{name} = {np.array2string(value, precision=9)[1:-1]}" for name, value in first.reached.values.items())
        warnings.warn(f"the motion of {tracker.system.name} comes to a dead point, {limit}: {np.isnan(found).any(axis=1).sum()} "
                      "samples beyond it are NaN", LockedWarning, stacklevel=3)
    return found


def _check_agreement(tracker: Tracker, dead: DeadPoint, there: Target) -> None:
    """Refuses quantities that determine the positions more than once, and contradict each other.

    Raises
    ------
    InconsistentStart
    """
    if (off := tracker.contradiction(dead.p, dead.reached, there)) > 0:
        raise InconsistentStart(f"the prescribed quantities must agree with each other and with the constraints of "
                                f"{tracker.system.name}: at t = {there.t:g} {', '.join(tracker.names)} differ by {off:.3g} of "
                                "their changes from what the others determine")


def _rates(system: BaseSystem, times: np.ndarray, positions: np.ndarray, wanted: Mapping[str, Prescribed], *,
           has_rates: bool) -> tuple[np.ndarray, np.ndarray]:
    """Velocities and accelerations (k, nv) each."""
    v, vdot = (np.full((len(times), system.nv), np.nan) for _ in range(2))
    known, names = np.flatnonzero(np.isfinite(positions).all(axis=1) & has_rates), tuple(wanted)
    t, p = times[known], positions[known]
    rate, second = (np.hstack([getattr(each, order)[known] for each in wanted.values()]) for order in ("rate", "second"))
    v[known] = 0.0
    found = rates_of(system, names, "motion", t, p)
    for i, at, row, its_rate in zip(known, states(system, t, p, v[known]), found["row"], rate, strict=True):
        v[i] = _solved(system, at.p, np.vstack([at.C, row]), np.concatenate([-at.Phi_t, its_rate]), at.t)
    found = rates_of(system, names, "motion", t, p, v[known])
    for i, at, row, its_second in zip(known, states(system, t, p, v[known]), found["row"], second - found["bias"], strict=True):
        vdot[i] = _solved(system, at.p, np.vstack([at.C, row]), np.concatenate([at.xi, its_second]), at.t)
    return v, vdot


def _solved(system: BaseSystem, p: np.ndarray, rows: np.ndarray, right: np.ndarray, t: float) -> np.ndarray:
    """The one x with rows x = right.

    Raises
    ------
    InconsistentStart
        If there is none.
    """
    scale = scales(system, p).v
    length = row_lengths(rows * scale)
    rows, right = rows * scale / length[:, None], right / length
    x = np.linalg.lstsq(rows, right, rcond=DEPENDENT)[0]
    off = float(np.abs(rows @ x - right).max(initial=0.0))
    if off > CONTRADICTION * (float(np.abs(x).max(initial=0.0)) + float(np.abs(right).max(initial=0.0))) + 1e-12:
        raise InconsistentStart(f"the prescribed motion must agree with the constraints of {system.name}: at t = {t:g} rates "
                                f"differ by {off:.3g}")
    return scale * x


def _warn_of_errors(wanted: Mapping[str, Prescribed]) -> None:
    for name, each in wanted.items():
        if each.error > INACCURATE * np.abs(each.second).max(initial=0.0) + each.rounding:
            warnings.warn(f"the samples of {name} must be closer for accurate accelerations: these differ by up to "
                          f"{each.error:.3g} between a quintic spline and polynomials; a callable or an expression is exact",
                          AccuracyWarning, stacklevel=3)
