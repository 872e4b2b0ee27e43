"""Parameters of a mechanism by path, ``"crank.mass"``: as given, or as changed by `with_parameters`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


class Numbers:
    """Values of parameters: the changed one at a path, otherwise the given one."""

    def __init__(self, changed: Mapping[str, Any] | None = None) -> None:
        self.changed = dict(changed or {})

    def __call__(self, element: Any, quantity: str, given: float) -> float:
        return self.changed.get(f"{element.name}.{quantity}", given)

    def vector(self, name: str | None, quantity: str, given: np.ndarray) -> np.ndarray:
        """Vector (2,) or (3,), whose components have paths of their own, ``"gas.along.x"``."""
        if not self.changed:
            return given
        return np.array([self.changed.get(f"{name}.{quantity}.{axis}", value) for axis, value in zip("xyz", given, strict=False)])


AS_GIVEN = Numbers()
