"""Drawings and animations of mechanisms, for `zerodrift.plot`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from .._private import checks
from .._private.types import ArrayLike, Points, SystemLike
from ..errors import WrongType, WrongValue
from ..runs.dense_samples import dense
from ..runs.samples.solution import A_SOLUTION, Solution
from ..runs.shapes_of_samples import GHOSTS, is_nothing, is_upside_down, moments_or_points, paths_of, spread
from ..studies.compare import nearest
from ..systems.base import BaseSystem, system_of
from ..systems.shapes import Shape
from .annotations import Arrow, draw_path
from .mechanism import NOTHING, Extras, Picture, points_of
from .points import draw_in_space, moved_in_space, with_equal_scales
from .space_picture import SpacePicture
from .style import given_axes

NARROW = 130.0  # points: axes that are narrower show no coordinates
QUIET = "#6E6E6E"


def mechanism(system_or_solution: SystemLike | Solution, p: ArrayLike | None = None, ax: Axes | None = None, *,
              t: float | None = None, ghosts: ArrayLike | None = None, names: bool = False, path: Points = (),
              forces: bool | Sequence[str] = False, force_scale: float | None = None) -> Axes:
    """Draw a system in one position, or a solution at one time with faint other positions.

    Mechanisms are drawn with the symbols of textbooks: bars and plates with pins, hatched ground, sliders on rails, blocks in
    grooves, springs, dashpots, wheels, pitch circles of gears, profiles of cams, motors and loads as arrows. In space, bodies
    are bars, plates, discs, or boxes of the same inertia, and joint axes are short lines; the mouse turns the view, in
    notebooks with ``%matplotlib widget``. Other systems are drawn from their points: in the plane, lines between points are
    links, and points that do not move are on the ground; in space they are lines.

    Parameters
    ----------
    system_or_solution : system, Mechanism or Solution
        Mechanism to draw.
    p : array_like (nq,), optional
        Coordinates of the position to draw; by default the start of the system, or positions of the solution.
    ax : Axes, optional
        Axes to draw into; by default those of a new figure, 3D for a system in space.
    t : float, optional
        Time in s at which a solution is drawn (nearest sample); by default the first.
    ghosts : int or array_like of float, optional
        Number of other positions to draw faintly, evenly over the run, or their times in s. By default eight, or none if `p`
        or `t` is given.
    names : bool
        True: label bodies, joints, points, springs and drives of a mechanism with their names.
    path : str, point or measure, or a sequence of them
        Points of a mechanism whose paths over the solution are drawn, such as ``"F"`` or ``rod.end``.
    forces : bool or sequence of str
        Forces of a mechanism at that time to draw as arrows: True for all joints, bushings and loads, or names of force
        elements and joints. The force of a joint is that of the first body on the second. An arrow in the corner shows the
        scale, in space a line of text.
    force_scale : float, optional
        Newtons per metre of arrow; by default the longest arrow is about a fifth of the picture.

    Returns
    -------
    Axes

    Raises
    ------
    ValueError
        If the system cannot be drawn or lacks a requested item, or if the axes are not 3D for a system in space.

    Examples
    --------
    >>> import zerodrift as zd
    >>> leg = zd.models.jansen()
    >>> ax = zd.plot.mechanism(leg, names=True)
    >>> sol = zd.simulate(leg, 1.0, step=0.005)
    >>> ax = zd.plot.mechanism(sol, path="F")                           # with eight other positions
    >>> ax = zd.plot.mechanism(sol, t=0.3, forces=["Z", "V"], ghosts=[0.1, 0.2])
    """
    given = system_of(system_or_solution, p)
    if not isinstance(given, Solution) and not callable(getattr(given, "points", None)):
        raise WrongType(f"system_or_solution must be a system or a Solution, not {checks.shown(given)}")
    sol = dense(given) if isinstance(given, Solution) else None
    _check_asked(sol, p, t=t, ghosts=ghosts, forces=forces, path=path)
    force_scale = None if force_scale is None else checks.number("force_scale", force_scale, above=0)
    system = given if sol is None else sol.system
    rows = _rows(sol, p, t, ghosts)
    positions = ([] if p is None and sol is not None else [system.p0 if p is None else p])
    positions += [] if sol is None else [sol.p[row] for row in rows]
    times = None if sol is None or p is not None else sol.t[rows]
    moments = moments_or_points(system, positions, sol, times, names=names, path=path, forces=forces)
    extras = NOTHING if isinstance(moments, np.ndarray) else Extras(
        names, paths_of(sol, path), _arrows(sol, forces, rows[:1]), force_scale)
    return _drawn(system, moments, ax, extras, moving=sol is not None and p is None)


def still_picture(system: BaseSystem, positions: Any, ax: Axes | None) -> Axes:
    """Axes with a system drawn in the first of some positions (k, nq), and faintly in the others."""
    return _drawn(system, moments_or_points(system, positions, None), ax)


def _drawn(system: BaseSystem, moments: list[list[Shape]] | np.ndarray, ax: Axes | None,
           extras: Extras = NOTHING, *, moving: bool = False) -> Axes:
    """Axes with the first position drawn in full colours and the others faintly, or with points in space (k, n, 3)."""
    if isinstance(moments, np.ndarray):
        return draw_in_space(drawing_axes(ax, 3), moments, moving=moving)
    picture: Picture | SpacePicture
    if _is_in_space(moments):
        picture = SpacePicture(drawing_axes(ax, 3), moments, extras, upside_down=is_upside_down(system))
    else:
        picture = Picture(drawing_axes(ax, 2), moments, extras)
    picture.faintly(range(1, len(moments)))
    picture.show(0)
    return picture.ax


def path(sol: Solution, points: Points, ax: Axes | None = None, **style: Any) -> Axes:
    """Draw the paths of points of a mechanism in the plane or in space, to equal scales.

    `mechanism(sol, path=...)` draws the mechanism, too.

    Parameters
    ----------
    sol : Solution
        Solution of a mechanism.
    points : str, point or measure, or a sequence of them
        Such as ``"F"``, ``"rod.end"``, ``rod.end`` or ``"F.position"``.
    ax : Axes, optional
        Left out: a new figure, with 3D axes for a mechanism in space.
    **style
        For ``ax.plot``.

    Returns
    -------
    Axes

    Raises
    ------
    KeyError
        If there is no such point.
    ValueError
        For a measure that is not a position, and for plane axes with a mechanism in space.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.models.jansen(), 1.0, step=0.005)
    >>> ax = zd.plot.path(sol, "F")
    """
    sol = dense(checks.instance("sol", sol, Solution, A_SOLUTION))
    found = paths_of(sol, points)
    ax = drawing_axes(ax, 3 if any(places.shape[1] == 3 for places in found) else 2)
    for places in found:
        draw_path(ax, places, 1.0, **style)
    return with_equal_scales(ax)


def animate(sol: Solution, fps: float = 25.0, ax: Axes | None = None, *, speed: float = 1.0, names: bool = False,
            path: Points = (), forces: bool | Sequence[str] = False, force_scale: float | None = None) -> FuncAnimation:
    """Animate a motion in real time, drawn as by `mechanism`.

    In a notebook: ``HTML(zd.plot.animate(sol).to_jshtml())`` with ``from IPython.display import HTML``. To a file:
    ``zd.plot.animate(sol).save("motion.gif")``, or ``"motion.mp4"`` with ffmpeg.

    Parameters
    ----------
    sol : Solution
        Motion; each frame shows the sample nearest in time.
    fps : float
        Frames per second.
    ax : Axes, optional
        Axes to draw into; by default those of a new figure.
    speed : float
        Seconds of motion per second of film.
    names, path, forces, force_scale
        As in `mechanism`; forces are those at each frame, to a common scale.

    Returns
    -------
    matplotlib.animation.FuncAnimation
        It runs as long as it is referenced, for example by a variable.

    Raises
    ------
    ValueError
        If the system cannot be drawn or lacks a requested item.

    Examples
    --------
    >>> import zerodrift as zd
    >>> film = zd.plot.animate(zd.simulate(zd.models.jansen(), 1.0, step=0.01), fps=4, path="F")
    >>> page = film.to_jshtml()
    """
    sol = dense(checks.instance("sol", sol, Solution, A_SOLUTION))
    fps, speed = checks.number("fps", fps, above=0), checks.number("speed", speed, above=0)
    force_scale = None if force_scale is None else checks.number("force_scale", force_scale, above=0)
    frames = int((sol.t[-1] - sol.t[0]) * fps / speed) + 1
    times = sol.t[0] + np.arange(frames) * speed / fps
    rows = nearest(sol.t, times)
    moments = moments_or_points(sol.system, sol.p[rows], sol, sol.t[rows], names=names, path=path, forces=forces)
    ax = drawing_axes(ax, 3 if isinstance(moments, np.ndarray) or _is_in_space(moments) else 2)
    if isinstance(moments, np.ndarray):
        return _film(ax, moved_in_space(ax, moments), times, fps)
    if _is_in_space(moments):
        extras = Extras(names, paths_of(sol, path), _arrows(sol, forces, rows), force_scale)
        return _film(ax, SpacePicture(ax, moments, extras, upside_down=is_upside_down(sol.system)).show, times, fps)
    extras = Extras(names, paths_of(sol, path), _arrows(sol, forces, rows), force_scale)
    return _film(ax, Picture(ax, moments, extras).show, times, fps)


# ---- arguments ----


def _check_asked(sol: Solution | None, p: Any, **asked: Any) -> None:
    """Check that arguments that require a solution, or a sample of it, are not given without it."""
    wanted = [name for name, value in asked.items() if value is not None and value is not False and not is_nothing(value)]
    for name in wanted:
        if sol is None:
            raise WrongValue(f"{name} must be left out for a system in one position: it needs a solution, as zd.simulate returns",
                             "conflicting-arguments")
        if p is not None and name in ("t", "forces"):
            raise WrongValue(f"{name} must be left out where p is given: it needs a sample of the solution, see t",
                             "conflicting-arguments")


def _rows(sol: Solution | None, p: Any, t: float | None, ghosts: Any) -> np.ndarray:
    """Indices of the samples to draw: first the one in full colours (unless p is given), then the faint ones."""
    if sol is None:
        return np.zeros(0, dtype=int)
    first = nearest(sol.t, np.array([sol.t[0] if t is None else checks.number("t", t)]))
    if ghosts is None:
        ghosts = GHOSTS if p is None and t is None else 0
    if isinstance(ghosts, int | np.integer):
        others = np.setdiff1d(spread(sol, checks.count("ghosts", ghosts, least=0)), first)[:ghosts]
    else:
        others = nearest(sol.t, checks.times("ghosts", ghosts, sol.t[0], sol.t[-1]))
    return np.concatenate([first if p is None else first[:0], others])


def _is_in_space(moments: list[list[Shape]]) -> bool:
    """True if the shapes are three-dimensional."""
    return any(shape.points.shape[1] == 3 for shape in moments[0])


def _arrows(sol: Solution | None, forces: Any, rows: np.ndarray) -> list[Arrow]:
    if forces is False or sol is None:
        return []
    return [Arrow(*each) for each in sol.system._forces(forces, sol, rows)]


def _film(ax: Axes, draw: Callable[[int], list[Any]], times: np.ndarray, fps: float) -> FuncAnimation:
    """Animation from a function that draws a frame, with the time as its title."""
    title = ax.set_title("", fontsize="medium")

    def show(frame: int) -> list[Any]:
        title.set_text(f"t = {times[frame]:.2f} s")
        return [*draw(frame), title]

    frames = len(times)
    return FuncAnimation(ax.figure, show, frames=frames, interval=1000 / fps, blit=False)      # type: ignore[arg-type]


def drawing_axes(ax: Axes | None, dimension: int) -> Axes:
    ax = None if ax is None else given_axes(ax)
    if ax is None:
        ax = plt.figure(layout="constrained").add_subplot(projection="3d" if dimension == 3 else None)
    elif dimension == 3 and ax.name != "3d":
        raise WrongValue("ax must be 3D axes for this system: fig.add_subplot(projection='3d')", "wrong-dimension")
    for axis in "xyz"[:dimension]:
        getattr(ax, f"set_{axis}label")(f"{axis} [m]")
    if dimension == 2:
        _quieten(ax)
    return ax


def _quieten(ax: Axes) -> None:
    """Style the axes in grey behind the drawing; hide them if they are too small."""
    if points_of(ax)[0] < NARROW:
        ax.set_axis_off()
        return
    ax.spines[["top", "right"]].set_visible(False)
    ax.spines[["left", "bottom"]].set_color(QUIET)
    ax.tick_params(color=QUIET, labelcolor=QUIET, labelsize="small")
    for axis in (ax.xaxis, ax.yaxis):
        axis.label.set(color=QUIET, size="small")
        axis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
    ax.set_axisbelow(True)
