"""Statistics of a run by name, as `Solution.stats` holds them."""

from __future__ import annotations

from typing import Any

from ...errors import WrongName


class Stats(dict):
    """Dictionary of statistics whose error for a missing key lists the keys."""

    def __missing__(self, name: str) -> Any:
        raise WrongName(f"nothing in stats is called {name!r}; there are {', '.join(self)}", "wrong-name")
