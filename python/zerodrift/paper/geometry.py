"""Figures 1-3 of the paper, computed: constraint manifold, tangent space and corrections of a pendulum in the coordinates x, y.

Its mass matrix is a multiple of the identity, so that what is orthogonal in the mass metric is orthogonal on paper.

>>> from zerodrift.paper import geometry
>>> len(geometry.figure_1().axes)
2
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from .. import plot, systems
from ..runs.open.diagnosis import unwarned
from ..runs.samples.solution import Solution
from ..runs.simulate import simulate
from ..runs.states.instant import Instant
from ..runs.states.operations import project

PENDULUM = systems.pendulum(length=1.0, mass=1.0, gravity=9.81, angle=1.5, rate=0.0)
SPAN, STEP = 0.5, 0.1           # s: steps of Euler's method that are visibly too long
EXACT, NUMERICAL, CORRECTED = plot.COLOURS[4], plot.COLOURS[1], plot.COLOURS[0]
ARC = np.linspace(-1.9, 0.05, 200)     # rad, the part of the manifold that is drawn


def figure_1() -> Figure:
    """Inaccuracy of the state, (a) in dependent coordinates, which leave the manifold, (b) in an independent coordinate."""
    figure, axes = plot.panels(1, 2, 9, 4.6)
    exact = _run(step=1e-3, integrator="rk4")
    for ax, title in zip(axes[0], ("(a) dependent coordinates", "(b) independent coordinate"), strict=True):
        independent = ax is axes[0, 1]
        run = _of_angle() if independent else _run(step=STEP, integrator="euler", stabilization=None).p
        _manifold(ax, title)
        ax.plot(*exact.p.T, color=EXACT, linewidth=2.5, label="exact motion")
        ax.plot(*run.T, "o-", color=NUMERICAL, markersize=5, linewidth=1, label="numerical solution")
        nearest = run[-1] / np.hypot(*run[-1])
        _between(ax, nearest, exact.p[-1], "error of the motion", (-8, 8))
        if not independent:
            _between(ax, run[-1], nearest, "violation", (58, 0))
    return _explained(figure)


def figure_2(p: Any = (0.5, -1.2), v: Any = (0.75, -0.05)) -> Figure:
    """Correction (a) of a position orthogonal to the manifold, (25a), (b) of a velocity onto the tangent, (25b)."""
    figure, axes = plot.panels(1, 2, 9, 4.6)
    p, v = np.array(p), np.array(v)
    corrected, velocity = project(PENDULUM, p, v)
    before, after = axes[0]
    _manifold(before, "(a) position: Δp is orthogonal to the manifold")
    _arrow(before, p, v, NUMERICAL, "ṽ")
    _arrow(before, p, corrected - p, CORRECTED, "Δp", side=-1)
    _point(before, p, NUMERICAL, "p̃")
    _point(before, corrected, CORRECTED, "p̄")
    _manifold(after, "(b) velocity: Δv is orthogonal to the tangent")
    tangent = np.array([-corrected[1], corrected[0]])
    after.plot(*(corrected + np.outer([-0.5, 0.75], tangent)).T, "--", color="gray", linewidth=1)
    _arrow(after, corrected, v, NUMERICAL, "ṽ")
    _arrow(after, corrected, velocity, CORRECTED, "v̄")
    _arrow(after, corrected + v, velocity - v, CORRECTED, "Δv")
    _point(after, corrected, CORRECTED, "p̄")
    for ax in (before, after):
        ax.set(xlim=(-0.4, 1.3), ylim=(-1.35, 0.1))
    return _explained(figure)


def figure_3(p: Any = (0.5, -1.2), v: Any = (0.75, -0.05), share: float = 0.55) -> Figure:
    """Correction of the energy, (29): the velocity keeps its direction, and the energy determines its length."""
    figure, axes = plot.panels(1, 1, 6, 5)
    ax = axes[0, 0]
    p, v = project(PENDULUM, np.array(p), np.array(v))
    speed = np.hypot(*v) * np.sqrt(share)       # the energy is too large by 1 - share of the kinetic energy
    required = v * speed / np.hypot(*v)
    _manifold(ax, "the energy correction changes the length of v")
    turn = np.linspace(0, 2 * np.pi, 200)
    circle = p + speed * np.column_stack([np.cos(turn), np.sin(turn)])
    ax.plot(*circle.T, ":", color="gray", label="velocities of the required energy")
    tangent = v / np.hypot(*v)
    line = p + np.outer([-0.6, 0.75], tangent)
    ax.plot(*line.T, "--", color="gray", linewidth=1, label="velocities that the constraint allows")
    _arrow(ax, p, v, NUMERICAL, "v̄")
    _arrow(ax, p, required, CORRECTED, "v̿", side=-1)
    _point(ax, p, CORRECTED, "p̄")
    return _explained(figure, 1)


def _run(**settings: Any) -> Solution:
    with unwarned():
        return simulate(PENDULUM, SPAN, **settings)


def _of_angle() -> np.ndarray:
    """Positions (k, 2) of Euler's method in the angle from the lowest position, which is an independent coordinate."""
    def rates(y: np.ndarray) -> np.ndarray:
        return np.array([y[1], -9.81 * np.sin(y[0])])

    x, z = Instant(PENDULUM).p
    states = [np.array([np.arctan2(x, -z), 0.0])]
    for _ in range(round(SPAN / STEP)):
        states.append(states[-1] + STEP * rates(states[-1]))
    angles = np.array(states)[:, 0]
    return np.column_stack([np.sin(angles), -np.cos(angles)])


def _manifold(ax: Axes, title: str) -> None:
    ax.plot(np.cos(ARC), np.sin(ARC), color="gray", linewidth=5, alpha=0.35, solid_capstyle="round",
            label="constraint manifold, Φ = 0")
    ax.set_title(title)
    ax.set_aspect("equal")
    ax.set(xlabel="x [m]", ylabel="y [m]")
    ax.xaxis.set_major_locator(MaxNLocator(5))


def _arrow(ax: Axes, start: np.ndarray, way: np.ndarray, colour: str, name: str, side: int = 1) -> None:
    end = start + way
    ax.annotate("", tuple(end), tuple(start), arrowprops={
        "arrowstyle": "-|>", "color": colour, "linewidth": 2, "shrinkA": 0, "shrinkB": 0})
    ax.plot(*np.array([start, end]).T, alpha=0)     # axes get limits from lines only
    aside = side * 0.09 * np.array([-way[1], way[0]]) / np.hypot(*way)
    x, y = start + 0.6 * way + aside
    ax.text(x, y, name, color=colour, ha="center", va="center", fontsize=13)


def _point(ax: Axes, at: np.ndarray, colour: str, name: str) -> None:
    ax.plot(*at, "o", color=colour, markersize=7, zorder=3)
    ax.annotate(name, tuple(at), (-9, -9), textcoords="offset points", color=colour, ha="right", va="top", fontsize=13)


def _between(ax: Axes, start: np.ndarray, end: np.ndarray, name: str, aside: tuple[float, float]) -> None:
    ax.annotate("", tuple(end), tuple(start), arrowprops={"arrowstyle": "<->", "color": "black", "shrinkA": 3, "shrinkB": 0})
    ax.annotate(name, tuple((start + end) / 2), aside, textcoords="offset points", ha="right", va="center", fontsize=9)


def _explained(figure: Figure, columns: int = 3) -> Figure:
    """Legend below all axes, where it covers nothing."""
    lines, names = figure.axes[0].get_legend_handles_labels()
    figure.legend(lines, names, frameon=False, loc="outside lower center", ncols=columns, fontsize=9)
    return figure
