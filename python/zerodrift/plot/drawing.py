"""Drawings of a mechanism, still and moving; `zerodrift.plot` hands them on."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes

from .. import _check
from ..runs.solution import A_SOLUTION, Solution
from ..studies.compare import nearest
from ..systems.base import BaseSystem, system_of
from ..systems.shapes import Shape
from .mechanism import Picture
from .style import COLOURS, given_axes

COLOUR = COLOURS[0]
FAINT_POSITIONS = 9      # positions in the drawing of a motion
JOINTS = 12     # the most points that are drawn as joints; more points are taken for a curve


def mechanism(system_or_solution: BaseSystem | Solution, p: Any = None, ax: Axes | None = None) -> Axes:
    """Draw a system in one position, or a solution's start with faint positions of its motion.

    Mechanisms of bodies and joints show bars and plates with their pins, supports of the ground, sliders on their rails, springs,
    wheels, and pitch circles of gears. Of other systems lines are links and dots are joints (curves of many points have none);
    points that stay in place during the motion are squares.

    Parameters
    ----------
    system_or_solution : system or Solution
        What to draw.
    p : array_like (nq,), optional
        The position; left out: the system's start, or the positions of the solution.
    ax : Axes, optional
        Left out: a new figure, with 3D axes where the drawing is spatial.

    Returns
    -------
    Axes

    Raises
    ------
    ValueError
        If the system has no drawing, or a spatial one does not fit into flat axes.

    Examples
    --------
    >>> import zerodrift as zd
    >>> bar = zd.systems.four_bar()
    >>> ax = zd.plot.mechanism(bar)
    >>> ax = zd.plot.mechanism(zd.simulate(bar, 2.0, step=0.01))
    """
    system_or_solution = system_of(system_or_solution, p)
    if not isinstance(system_or_solution, Solution) and not callable(getattr(system_or_solution, "points", None)):
        raise TypeError(f"system_or_solution must be a system or a Solution, not {_check.shown(system_or_solution)}")
    moving = isinstance(system_or_solution, Solution) and p is None
    system = system_or_solution.system if isinstance(system_or_solution, Solution) else system_or_solution
    if moving:
        rows = np.unique(np.linspace(0, len(system_or_solution.t) - 1, FAINT_POSITIONS).round().astype(int))
        positions = system_or_solution.p[rows]
    else:
        positions = [system.p0 if p is None else p]
    if (moments := _moments(system, positions)) is not None:
        picture = Picture(_drawing_axes(ax, 2), moments)
        picture.faintly(range(1, len(moments)))
        picture.show(0)
        return picture.ax
    drawings = _drawings(system, positions)
    ax = _drawing_axes(ax, drawings.shape[2])
    for points in drawings[:0:-1]:
        ax.plot(*points.T, _line_format(points), color=COLOUR, alpha=0.25, linewidth=1.2, markersize=2.5)
    _links(ax, drawings[0])
    if moving:
        ax.plot(*_fixed_points(drawings).T, "s", color="black", markersize=7, zorder=3)
    return _with_equal_scales(ax)


def animate(sol: Solution, fps: float = 25.0, ax: Axes | None = None, *, speed: float = 1.0) -> FuncAnimation:
    """Animate the motion in real time.

    In a notebook: ``HTML(zd.plot.animate(sol).to_jshtml())`` with ``from IPython.display import HTML``.

    Parameters
    ----------
    sol : Solution
        Each frame shows its row nearest in time.
    fps : float
        Frames per second.
    ax : Axes, optional
        Left out: a new figure.
    speed : float
        Seconds of motion per second of film.

    Returns
    -------
    matplotlib.animation.FuncAnimation
        Keep it in a variable as long as it shall run.

    Raises
    ------
    ValueError
        If the system has no drawing.

    Examples
    --------
    >>> import zerodrift as zd
    >>> film = zd.plot.animate(zd.simulate(zd.systems.four_bar(), 1.0, step=0.01), fps=4)
    >>> page = film.to_jshtml()
    """
    _check.instance("sol", sol, Solution, A_SOLUTION)
    fps, speed = _check.number("fps", fps, above=0), _check.number("speed", speed, above=0)
    frames = int((sol.t[-1] - sol.t[0]) * fps / speed) + 1
    times = sol.t[0] + np.arange(frames) * speed / fps
    rows = nearest(sol.t, times)
    if (moments := _moments(sol.system, sol.p[rows])) is not None:
        return _film(Picture(_drawing_axes(ax, 2), moments), times, fps)
    drawings = _drawings(sol.system, sol.p[rows])
    ax = _drawing_axes(ax, drawings.shape[2])
    line = _links(ax, drawings[0])
    _set_limits(ax, drawings)
    _with_equal_scales(ax)
    title = ax.set_title("", fontsize="medium")

    def show(frame: int) -> tuple[Any, ...]:
        points = drawings[frame]
        (line.set_data if points.shape[1] == 2 else line.set_data_3d)(*points.T)
        title.set_text(f"t = {times[frame]:.2f} s")
        return line, title

    return FuncAnimation(ax.figure, show, frames=frames, interval=1000 / fps, blit=False)


def _film(picture: Picture, times: np.ndarray, fps: float) -> FuncAnimation:
    """A mechanism of shapes as it moves."""
    title = picture.ax.set_title("", fontsize="medium")

    def show(frame: int) -> list[Any]:
        title.set_text(f"t = {times[frame]:.2f} s")
        return [*picture.show(frame), title]

    return FuncAnimation(picture.ax.figure, show, frames=len(times), interval=1000 / fps, blit=False)


def _moments(system: BaseSystem, positions: Any) -> list[list[Shape]] | None:
    """The shapes of each position; None where there are none, but points and lines."""
    if not isinstance(system, BaseSystem):
        return None
    return system._sketches([_check.vector("p", p, system.nq) for p in positions])


def _drawings(system: BaseSystem, positions: Any) -> np.ndarray:
    """The points of each position, (positions, points, dimension)."""
    drawings = [system.points(p) for p in positions]
    if not drawings or drawings[0] is None:
        raise ValueError(f"{system.name} has no drawing: it gives no points")
    return np.array(drawings)


def _links(ax: Axes, points: np.ndarray) -> Any:
    """The mechanism as one line."""
    (line,) = ax.plot(*points.T, _line_format(points), color=COLOUR, linewidth=2.5, markersize=6, solid_capstyle="round")
    return line


def _line_format(points: np.ndarray) -> str:
    return "o-" if len(points) <= JOINTS else "-"


def _fixed_points(drawings: np.ndarray) -> np.ndarray:
    """The points (n, dimension) that are in the same place in all drawings."""
    size = (np.nanmax(drawings, axis=(0, 1)) - np.nanmin(drawings, axis=(0, 1))).max()
    return drawings[0][np.ptp(drawings, axis=0).max(axis=1) <= 1e-6 * size]


def _drawing_axes(ax: Axes | None, dimension: int) -> Axes:
    ax = None if ax is None else given_axes(ax)
    if ax is None:
        ax = plt.figure(layout="constrained").add_subplot(projection="3d" if dimension == 3 else None)
    elif dimension == 3 and ax.name != "3d":
        raise ValueError("ax must be 3D axes for this system: fig.add_subplot(projection='3d')")
    for axis in "xyz"[:dimension]:
        getattr(ax, f"set_{axis}label")(f"{axis} [m]")
    return ax


def _with_equal_scales(ax: Axes) -> Axes:
    """Equal scales; spatial axes take them from the limits of the moment, so that all must have been drawn."""
    ax.set_aspect("equal", adjustable="box")
    return ax


def _set_limits(ax: Axes, drawings: np.ndarray) -> None:
    """Axes that hold all drawings, with a margin."""
    low, high = np.nanmin(drawings, axis=(0, 1)), np.nanmax(drawings, axis=(0, 1))
    margin = 0.08 * (high - low).max()
    for axis, a, b in zip("xyz", low, high, strict=False):
        getattr(ax, f"set_{axis}lim")(a - margin, b + margin)
