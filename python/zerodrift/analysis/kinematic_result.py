"""The result of `kinematics`: a prescribed motion, whose measures are read by name."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import WrongName
from ..systems.base import BaseSystem


class Kinematics:
    """A prescribed motion; ``kin["coupler.acceleration"]`` is a measure at all samples, (k,) or (k, size).

    Reactions, and what reads them, are those of `inverse_dynamics`; forces whose laws read none are here, too.

    Attributes
    ----------
    system : system
    t : ndarray (k,)
        In s.
    p, v, vdot : ndarray (k, nq), (k, nv), (k, nv)
        NaN beyond a dead point.
    prescribed : tuple of str
    errors : dict of str to float
        Estimated error of the second rate of each prescribed quantity; zero where it is differentiated exactly.
    """

    def __init__(self, system: BaseSystem, t: np.ndarray, p: np.ndarray, v: np.ndarray, vdot: np.ndarray,
                 errors: dict[str, float], prescribed: tuple[str, ...]) -> None:
        self.system, self.t, self.p, self.v, self.vdot = system, t, p, v, vdot
        self.errors, self.prescribed = errors, prescribed

    @property
    def success(self) -> bool:
        """No sample lies beyond a dead point."""
        return bool(np.isfinite(self.p).all())

    def __len__(self) -> int:
        return len(self.t)

    def __getitem__(self, given: Any) -> np.ndarray:
        name = getattr(given, "name", given)
        watching = self.system._watching
        place = watching.find(name)
        if place is not None and watching.core.needs_reactions(place.number):
            raise WrongName(f"{name!r} needs reactions, which kinematics does not know: zd.inverse_dynamics(system, kin) does",
                            "not-available")
        return read(self.system, name, self.t, (self.p, self.v, self.vdot, np.zeros((len(self.t), self.system.m))))

    def __repr__(self) -> str:
        reached = int(np.isfinite(self.p).all(axis=1).sum())
        by = ", ".join(self.prescribed) or "its drives"
        beyond = "" if self.success else f"; {len(self) - reached} beyond a dead point"
        return f"<motion of {self.system.name} by {by}: {len(self)} samples, t = {self.t[0]:g} ... {self.t[-1]:g} s{beyond}>"


def read(system: BaseSystem, name: Any, t: np.ndarray, states: tuple[np.ndarray, ...],
         acting: Any = ((), None)) -> np.ndarray:
    """A quantity at samples: t (k,), p, v, vdot, multipliers; NaN where these are. acting: efforts (k, j) along quantities."""
    place, watching = system._watching.view(name), system._watching
    if place is not None:
        depends = watching.core.measure_depends(place.number)
        used = {"positions": states[:1], "velocities": states[:2]}.get(depends, states)
        good = np.logical_and.reduce([np.isfinite(each).all(axis=1) for each in used])
        rows = [np.ascontiguousarray(np.where(good[:, None], np.nan_to_num(each), 0.0)[good]) for each in states]
        values = np.full((len(t), watching.core.measure_size(place.number)), np.nan)
        if good.any():
            efforts = watching.acting(acting[0], acting[1][good]) if len(acting[0]) else None
            values[good] = watching.core.measure(place.number, np.ascontiguousarray(t[good]), *rows, acting=efforts)
        return place.pick(values)
    group, column = system._column(name)
    return (states[0], states[1], states[3])[group][:, column].copy()
