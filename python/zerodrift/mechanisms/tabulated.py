"""The tables of a drawing, in the plane or in space."""

from __future__ import annotations

from collections.abc import Mapping

from .drawing import Drawing
from .numbers import Numbers
from .space_tables import SpaceTables
from .tables import Tables


def tables_of(drawing: Drawing, numbers: Numbers, *, in_tree: bool, starts: Mapping[str, float] | None = None) -> Tables:
    """The tables."""
    return (SpaceTables if drawing.dimension == 3 else Tables)(drawing, numbers, in_tree=in_tree, starts=starts)
