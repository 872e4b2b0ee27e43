"""Pictures of systems that are given by points and the lines between them: bars and pins in the plane, lines in space."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from ..runs.shapes_of_samples import JOINTS, at_rest
from .style import COLOURS

NARROWEST = 0.25    # of the longest axis in space: shortest one
ZOOM = 0.86         # of a picture in space


def draw_in_space(ax: Axes, drawings: np.ndarray, *, moving: bool) -> Axes:
    """Draw the first position, the others faintly, and points at rest as squares."""
    for points in drawings[:0:-1]:
        ax.plot(*points.T, _line_format(points), color=COLOURS[0], alpha=0.25, linewidth=1.2, markersize=2.5)
    _line(ax, drawings[0])
    if moving:
        ax.plot(*drawings[0][at_rest(drawings)].T, "s", color="black", markersize=7, zorder=3)
    return with_equal_scales(ax)


def moved_in_space(ax: Axes, drawings: np.ndarray) -> Callable[[int], Any]:
    """Draw the mechanism as a line; return it and a function that moves it to another position."""
    line = _line(ax, drawings[0])
    low, high = np.nanmin(drawings, axis=(0, 1)), np.nanmax(drawings, axis=(0, 1))
    margin = 0.08 * (high - low).max()
    for axis, a, b in zip("xyz", low, high, strict=True):
        getattr(ax, f"set_{axis}lim")(a - margin, b + margin)
    with_equal_scales(ax)

    def show(frame: int) -> list[Any]:
        line.set_data_3d(*drawings[frame].T)
        return [line]

    return show


def with_equal_scales(ax: Axes) -> Axes:
    """Set equal scales. In space they depend on the present limits, so everything must have been drawn before.

    A curve in a plane of two axes would have no room for the third: its ticks would stand in one place.
    """
    if ax.name == "3d":
        limits = {axis: sorted(getattr(ax, f"get_{axis}lim")()) for axis in "xyz"}
        narrowest = NARROWEST * max(high - low for low, high in limits.values())
        for axis, (low, high) in limits.items():
            if high - low < narrowest:
                getattr(ax, f"set_{axis}lim")((low + high - narrowest) / 2, (low + high + narrowest) / 2)
                getattr(ax, f"{axis}axis").set_major_locator(MaxNLocator(2))
    ax.set_aspect("equal", adjustable="box")
    if ax.name == "3d":     # with room for the names of the axes
        ax.set_box_aspect(ax._box_aspect, zoom=ZOOM)        # type: ignore[attr-defined,call-arg]
    return ax


def _line(ax: Axes, points: np.ndarray) -> Any:
    """The mechanism as one line."""
    (line,) = ax.plot(*points.T, _line_format(points), color=COLOURS[0], linewidth=2.5, markersize=6, solid_capstyle="round")
    return line


def _line_format(points: np.ndarray) -> str:
    return "o-" if len(points) <= JOINTS else "-"
