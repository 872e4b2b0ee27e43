"""The result of `inverse_dynamics`: efforts by name, reactions, power and residual."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..systems.base import BaseSystem
from .kinematic_result import read

ALIASES = {"angle": "torque", "displacement": "force", "length": "force", "position": "force"}
UNITS = {"torque": "N m", "force": "N"}


class Efforts:
    """Efforts of a motion; ``inv["crank.angle"]`` is that at a prescribed quantity, ``inv["A.force"]`` any measure, (k,) or (k,
    size).

    Efforts are external loads: reactions of joints include them, except for the effort along a joint's own coordinate.

    Attributes
    ----------
    system : system
    t : ndarray (k,)
        In s.
    p, v, vdot, multipliers : ndarray (k, ...)
    efforts : dict of str to ndarray
        In N or N m, those of vectors also by component.
    power : ndarray (k,)
        Power of all efforts together, in W.
    residual : ndarray (k,)
        Norm of the force that the efforts do not give, in the mass metric, in N/sqrt(kg).
    rank : ndarray (k,)
        Independent efforts on the tangent space.
    """

    def __init__(self, system: BaseSystem, samples: tuple[np.ndarray, ...], multipliers: np.ndarray,
                 efforts: dict[str, np.ndarray], acting: tuple[tuple[str, ...], np.ndarray], *,
                 residual: np.ndarray, power: np.ndarray, rank: np.ndarray) -> None:
        self.system, self.multipliers, self.efforts = system, multipliers, efforts
        self._acting = acting
        self.t, self.p, self.v, self.vdot = samples
        self.residual, self.power, self.rank = residual, power, rank

    def __getitem__(self, given: Any) -> np.ndarray:
        name = getattr(given, "name", given)
        if name in self.efforts:
            return self.efforts[name]
        if self.system._watching.find(name) is None:
            for known, values in self.efforts.items():
                base, _, quantity = known.rpartition(".")
                if quantity in ALIASES and name == f"{base}.{ALIASES[quantity]}":
                    return values
        return read(self.system, name, self.t, (self.p, self.v, self.vdot, self.multipliers), self._acting)

    def __repr__(self) -> str:
        lines = [f"<efforts of a motion of {self.system.name}: {len(self.t)} samples, t = {self.t[0]:g} ... {self.t[-1]:g} s>"]
        for name, values in self.efforts.items():
            if values.ndim == 1:
                lines.append(f"  {name:<24} {_range(values)}{_unit(name)}")
        lines.append(f"  power                    {_range(self.power)} W")
        if (worst := np.nanmax(self.residual, initial=0.0)) > 0:
            lines.append(f"  residual                 {worst:.3g} N/sqrt(kg)")
        return "\n".join(lines)


def _range(values: np.ndarray) -> str:
    """Smallest and largest value, samples beyond a dead point left out."""
    known = values[np.isfinite(values)]
    return f"{known.min():.6g} ... {known.max():.6g}" if known.size else "nan"


def _unit(name: str) -> str:
    """Unit of an effort, after a space, by the name of its measure; none for a coordinate of a system without such names."""
    quantity = next((word for word in reversed(name.split(".")[1:]) if word not in ("x", "y", "z")), "")
    unit = UNITS.get(ALIASES.get(quantity, quantity))
    return f" {unit}" if unit else ""
