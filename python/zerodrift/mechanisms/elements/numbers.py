"""Parameters of a mechanism by path, ``"crank.mass"``: as given, or as changed by `with_parameters`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from ..._private import checks

NOT_NEGATIVE = {"mass", "inertia", "stiffness", "damping", "torsion", "torsion_damping"}
PRODUCTS = (".xy", ".xz", ".yz")        # of inertia: of either sign
LINEAR = {"speed": "m/s", "damping": "N s/m", "stiffness": "N/m", "value": "N"}
ANGULAR = {"speed": "rad/s", "damping": "N m s/rad", "stiffness": "N m/rad", "value": "N m"}
UNITS = {"mass": "kg", "inertia": "kg m^2", "torque": "N m", "force": "N", "angle": "rad",
         **dict.fromkeys("xyz", "m/s^2"),      # of gravity
         **dict.fromkeys(("length", "radius", "thickness", "pitch", "displacement", "com", "local", "semiaxes"), "m")}


class Numbers:
    """Values of parameters: the changed one at a path, otherwise the given one."""

    def __init__(self, changed: Mapping[str, Any] | None = None) -> None:
        self.changed = dict(changed or {})

    def __call__(self, element: Any, quantity: str, given: Any) -> float:
        return self.changed.get(f"{element.name}.{quantity}", given)

    def vector(self, name: str | None, quantity: str, given: np.ndarray) -> np.ndarray:
        """Vector (2,) or (3,), whose components have paths of their own, ``"gas.along.x"``."""
        if not self.changed:
            return given
        return np.array([self.changed.get(f"{name}.{quantity}.{axis}", value) for axis, value in zip("xyz", given, strict=False)])


AS_GIVEN = Numbers()


def checked(path: str, value: Any) -> float:
    """New value of a parameter, with the checks of the method that adds its element."""
    name = f"parameter {path!r}"
    quantity = path.split(".")[1] if "." in path else ""
    if quantity in NOT_NEGATIVE and not path.endswith(PRODUCTS):
        return checks.number(name, value, least=0)
    if quantity in ("length", "radius"):
        return checks.number(name, value, above=0)
    return checks.number(name, value)


def is_right(path: str, value: float) -> bool:
    """True if a parameter can have this value."""
    try:
        checked(path, value)
    except ValueError:
        return False
    return True


def parameter_units(names: Iterable[str], elements: Mapping[str, Any]) -> dict[str, str]:
    """Units of parameters by their paths, as far as their last words tell them."""
    found = {}
    for name in names:
        owner, _, path = name.partition(".")
        element = elements.get(owner)
        along = str(getattr(element, "coordinate", None) or "")
        is_angle = along.startswith("angle") or getattr(element, "kind", "").startswith("tor")
        unit = (ANGULAR if is_angle else LINEAR).get(path) or UNITS.get(path.partition(".")[0])
        if unit and (element is not None or owner == "gravity"):
            found[name] = unit
    return found
