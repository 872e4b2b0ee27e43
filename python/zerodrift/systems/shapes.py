"""Shapes of a drawing in the plane, independent of the plotting library."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

# Number of trailing points that are directions, of the kinds that have them.
DIRECTED = {"drive": 2, **dict.fromkeys(("rail", "road", "stop", "wall", "groove", "guide", "slider", "block", "disc", "wheel",
                                         "gear", "ring", "rack", "blade", "weld", "load", "load_symbol"), 1)}


class Shape(NamedTuple):
    """A part of a drawing.

    Attributes
    ----------
    kind : str
        A key of `zerodrift.plot.glyphs.GLYPHS`, where it says what `points` are.
    points : ndarray (n, 2)
        Places in m; of some kinds the last is a direction.
    name : str
        Name of the element it belongs to.
    number : float
        A radius in m, or an angle in rad, of kinds that have one.
    """

    kind: str
    points: np.ndarray
    name: str = ""
    number: float = 0.0
