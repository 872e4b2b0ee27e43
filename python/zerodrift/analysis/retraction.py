"""Positions on the manifold: a guess projected onto the holonomic constraints and onto prescribed values of quantities."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from .._private import checks, gateway
from ..errors import CorrectionFailed
from ..systems.base import BaseSystem
from .quantities import find, values_of
from .state import State, scales, small_core, state


def moved(at: State, delta: np.ndarray) -> np.ndarray:
    """The position after a displacement in quasi-coordinates, a guess for `onto`."""
    return at.p + at.A @ delta


def onto(system: BaseSystem, t: float, p: np.ndarray, held: Mapping[str, np.ndarray] | None = None) -> np.ndarray:
    """The position that Newton's method finds from a guess, with minimum-norm steps in characteristic scales.

    Parameters
    ----------
    system : BaseSystem
    t : float
    p : ndarray (nq,)
    held : dict of str to ndarray, optional
        Values of quantities of positions, such as measures.

    Raises
    ------
    CorrectionFailed
        If it does not converge.
    """
    held = held or {}
    found, step = prescribing(system, p, held).find(p, np.hstack([*(np.ravel(each) for each in held.values()), t]))
    if step is not None:
        also = f" and {', '.join(held)}" if held else ""
        raise CorrectionFailed(f"no position satisfies the constraints{also} near the guess: the last step was {step:.3g} of the "
                               "size")
    return found


def prescribing(system: BaseSystem, p: np.ndarray, names: Iterable[str]) -> gateway.Prescribing:
    """Quantities of positions that are prescribed, with scales near a position."""
    scale, components, indices, which = scales(system, p), 0, [], []
    for name in names:
        if (place := system._watching.find(name)) is None:
            which.append(-1 - [each.name for each in system.coordinates].index(name))
            continue
        size = system._watching.core.measure_size(place.number)
        indices.append(place.number)
        which += [components + i for i in range(size) if place.component in (i, None)]
        components += size
    return gateway.Prescribing(small_core(system), system._measuring, indices, which, (scale.p, scale.v))


def near_to(system: BaseSystem, near: Any, t: float) -> np.ndarray:
    """The position that an argument `near` means: coordinates, or values to which the start is led; None: the start.

    Raises
    ------
    CorrectionFailed
        If there is no way to it.
    """
    if near is not None and not isinstance(near, Mapping):
        return onto(system, t, checks.vector("near", near, system.nq))
    p = np.array(system._state_or_start(None, None, "near", "v", t)[0])
    if near is None:
        return p
    values, at = values_of(near, "near"), state(system, t, p, np.zeros(system.nv))
    wanted = [checks.vector(f"near[{name!r}]", np.atleast_1d(value), len(find(at, name, "near").value))
              for name, value in values.items()]
    tracked = prescribing(system, p, values).track(p, np.hstack([*wanted, t])[None])
    if tracked.reached is not None:
        raise CorrectionFailed(f"near must be values that {system.name} can move to from its start, and the way to "
                               f"{', '.join(values)} ends at {tracked.reached[:-1]}")
    return tracked.p[0]
