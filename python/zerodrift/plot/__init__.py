"""Pictures of any solution and any system that can be drawn.

Each function draws into `ax`, or into a new figure, and returns the axes. Nothing is shown until the caller says so,
and no global setting of matplotlib is touched.
"""

from .curves import energy, energy_violation, error, measures, motion, violation
from .drawing import animate, mechanism, path
from .linear import mode, root_locus
from .many_runs import against, bands, heat_map
from .phases import phases
from .polar import polar
from .studies import stability_map, work_precision
from .style import COLOURS, panels
from .traces import positions, trace

__all__ = ["COLOURS", "against", "animate", "bands", "energy", "energy_violation", "error", "heat_map", "measures", "mechanism",
           "mode", "motion", "panels", "path", "phases", "polar", "positions", "root_locus", "stability_map", "trace",
           "violation", "work_precision"]


def __dir__() -> list[str]:
    return __all__      # and not what is imported
