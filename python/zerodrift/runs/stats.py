"""Statistics of a run by name, as `Solution.stats` holds them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..errors import WrongName

RENAMED = {"general_road": "matrix_path_reason"}        # keys of earlier versions, in files and in programs, to those of today


class Stats(dict):
    """Dictionary of statistics in which the keys of earlier versions go on working."""

    def __init__(self, values: Mapping[str, Any]) -> None:
        super().__init__({RENAMED.get(name, name): value for name, value in values.items()})

    def __missing__(self, name: str) -> Any:
        if name in RENAMED:
            return self[RENAMED[name]]
        raise WrongName(f"nothing in stats is called {name!r}; there are {', '.join(self)}", "wrong-name")

    def __contains__(self, name: object) -> bool:
        return super().__contains__(RENAMED.get(name, name) if isinstance(name, str) else name)

    def get(self, name: str, default: Any = None) -> Any:
        return super().get(RENAMED.get(name, name), default)
