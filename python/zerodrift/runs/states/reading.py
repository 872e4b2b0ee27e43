"""Values of a run by name, at its present state: inputs, coordinates, velocities, multipliers and measures."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..._private import gateway
from ...systems.base import BaseSystem


class Reading:
    """Functions that read values by name; each is found once.

    Parameters
    ----------
    system : BaseSystem
    core : OpenRun
        The run.
    ready : Prepared
        Its attribute `measured` is the system whose measures are read.
    """

    def __init__(self, system: BaseSystem, core: gateway.OpenRun, ready: Any) -> None:
        self._system, self._core, self._ready = system, core, ready
        self._known: dict[Any, Callable[[], Any]] = {}
        self._measured: gateway.CoreSystem | None = None

    def __call__(self, name: Any) -> Any:
        """Value of that name: a float, or an array of a vector."""
        read = self._known.get(name)
        if read is None:
            read = self._known[name] = self._found(getattr(name, "name", name))
        return read()

    def _found(self, name: Any) -> Callable[[], Any]:
        system = self._system
        if (place := system._watching.view(name)) is not None:
            self._measured = self._measured or self._ready.measured
            read = self._core.reader(self._measured, place.number, place.component)
            return read if place.form is None else lambda: place.pick(read()[None])[0]
        (group, column), core = system._column(name), self._core
        return (lambda: float(core.accelerations()[1][column])) if group == 2 else core.entry(group, column)
