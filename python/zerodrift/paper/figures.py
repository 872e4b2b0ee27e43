"""Figures 4-9 of the paper, and the cost of its methods; each function returns a matplotlib figure of its own."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from .. import plot
from ..runs.open.diagnosis import unwarned
from ..runs.samples.solution import Solution
from ..runs.simulate import simulate
from . import FOUR_BAR, STEP, reference
from .claims import Runs, energy_errors, largest, link_1_error

STYLES = ("-", "--", "-.", "-")
COST_STEPS = (0.1, 0.05, 0.025, 0.0125, 0.00625, 0.003125)   # s
REPETITIONS = 15        # of each timed run; the fastest counts


def figure_4(fine: Solution) -> Figure:
    """The mechanism at the start, and later positions."""
    figure, axes = plot.panels(1, 2, 9, 3.6)
    plot.mechanism(fine, t=fine.t[0], ax=axes[0, 0])
    _name_links(axes[0, 0], fine.system)
    plot.mechanism(fine, ax=axes[0, 1])
    for ax in axes.flat:
        ax.grid(False)
        ax.set(xlim=axes[0, 1].get_xlim(), ylim=axes[0, 1].get_ylim())      # one scale
    axes[0, 0].set_title("start")
    axes[0, 1].set_title("positions during the motion")
    return figure


def _name_links(ax: Any, system: Any) -> None:
    points = system.points(system.p0)
    for number, (start, end) in enumerate(pairwise(points), start=1):
        along = (end - start) / np.hypot(*(end - start))
        ax.annotate(f"$l_{number},\\ \\alpha_{number}$", (start + end) / 2 + 0.12 * np.array([-along[1], along[0]]),
                    ha="center", va="center")
    ax.plot(*points[[0, -1]].T, "--", color="black", linewidth=1, zorder=1)
    ax.annotate("$l_0$", points[[0, -1]].mean(axis=0) - np.array([0, 0.07]), ha="center", va="center")


def figure_5(fine: Solution) -> Figure:
    """Position and velocity of link 1."""
    figure, axes = plot.panels(2, 1, 7, 5, sharex=True)
    plot.motion(fine, "alpha1", ax=axes[0, 0])
    plot.motion(fine, "alpha1_dot", ax=axes[1, 0])
    axes[0, 0].set(xlabel="", ylabel="position α₁ [rad]")
    axes[1, 0].set_ylabel("velocity dα₁/dt [rad/s]")
    figure.align_ylabels()
    return figure


def figure_6(runs: Runs) -> Figure:
    """Constraint violations in the four cases."""
    figure, axes = plot.panels(2, 2, 9, 6, sharex=True, sharey=True)
    for ax, (case, sol) in zip(axes.flat, runs.items(), strict=True):
        plot.violation(sol, ax=ax, linewidth=1.2)
        ax.set_title(case)
        ax.label_outer()
        if not sol.success:
            ax.axvline(sol.t[-1], color="grey", linewidth=0.8, linestyle=":")
            ax.annotate("ends here", (sol.t[-1], 1e-8), xytext=(-4, 0), textcoords="offset points", ha="right",
                        color="grey")
    axes[0, 0].set_ylim(1e-18, 1e3)
    _one_legend(figure, *axes.flat)
    return figure


def figure_7(runs: Runs) -> Figure:
    """Energy violation and error of link 1 in the four cases."""
    figure, ((upper,), (lower,)) = plot.panels(2, 1, 9.5, 6.6, sharex=True)
    for style, (case, sol) in zip(STYLES, runs.items(), strict=True):
        plot.energy_violation(sol, ax=upper, log=True, label=case, linestyle=style)
        plot.error(sol, reference.four_bar, "alpha1", ax=lower, log=True, label=case, linestyle=style)
    upper.set(xlabel="", ylim=(1e-15, 1e5))
    lower.set(ylabel="|error of α₁| [rad]", ylim=(1e-4, 1e3))
    _one_legend(figure, upper, lower)
    return figure


def figure_8(runs: Runs) -> Figure:
    """Energy violation and error of the oscillator; last the remark on equal steps."""
    figure, ((energy,), (printed,), (equal,)) = plot.panels(3, 1, 8, 8, sharex=True)
    a, b, c, same_step = runs
    for style, case in zip(STYLES, (a, b, c), strict=False):
        plot.energy_violation(runs[case], ax=energy, log=True, label=_with_step(case, runs[case]), linestyle=style)
        plot.error(runs[case], reference.oscillator, ax=printed, label=case, linestyle=style)
    for style, case in (("-", a), ("-.", same_step)):
        plot.error(runs[case], reference.oscillator, ax=equal, label=_with_step(case, runs[case]), linestyle=style,
                   color=plot.COLOURS[0 if case == a else 2])
    _one_legend(figure, energy, printed)
    equal.legend(frameon=False, loc="upper left", ncols=2)
    printed.set_title("steps as printed")
    equal.set_title("equal steps")
    for ax in (energy, printed):
        ax.set_xlabel("")
    figure.align_ylabels()
    return figure


def figure_9(runs: Runs) -> Figure:
    """Errors in kinetic, potential and total energy of the oscillator."""
    figure, axes = plot.panels(1, 3, 11, 3.8, sharex=True, sharey=True)
    for ax, (case, sol) in zip(axes.flat, list(runs.items())[:3], strict=True):
        dT, dV = energy_errors(sol, reference.oscillator_energies)
        for style, label, values in zip(STYLES, ("ΔT", "ΔV", "ΔE = ΔT + ΔV"), (dT, dV, dT + dV), strict=False):
            ax.plot(sol.t, 1e3 * values, style, label=label)
        ax.set(title=_with_step(case, sol), xlabel="t [s]", ylabel="error of energy [mJ]")
        ax.label_outer()
    axes[0, 0].legend(frameon=False, loc="upper left")
    return figure


def costs() -> dict[str, np.ndarray]:
    """Run time in ms and largest error of link 1 in rad (NaN: the end was not reached), (n, 2), at `COST_STEPS`."""
    runs = [{(case, step): _run_with_step(settings, step) for case, settings in FOUR_BAR.cases.items()
             for step in COST_STEPS} for _ in range(REPETITIONS)]
    return {case: np.array([_cost([repetition[case, step] for repetition in runs]) for step in COST_STEPS])
            for case in FOUR_BAR.cases}


def _run_with_step(settings: dict[str, Any], step: float) -> Solution:
    every = max(1, round(reference.SPACING / step))     # only where the exact motion is stored
    settings = settings | {"step": step, "save_every": every, "on_failure": "return"}
    with unwarned():
        return simulate(FOUR_BAR.system, FOUR_BAR.end, closed_form=False, **settings)


def _cost(repetitions: list[Solution]) -> tuple[float, float]:
    sol = repetitions[0]
    milliseconds = 1e3 * min(repetition.stats["seconds"] for repetition in repetitions)
    return milliseconds, largest(link_1_error(sol)) if sol.success else np.nan


def figure_of_costs(runs: Runs, measured: dict[str, np.ndarray]) -> Figure:
    """The paper's result in two panels: violations in the four cases, and the cost of accuracy."""
    figure, ((left, right),) = plot.panels(1, 2, 10, 4.2)
    for marker, (case, sol) in zip("os^D", runs.items(), strict=True):
        plot.violation(sol, ax=left, velocities=False, label=case, linewidth=1.2)
        milliseconds, error = measured[case].T
        right.loglog(milliseconds, error, marker=marker, markersize=5, label=case)
    left.set(title=f"Constraint violation, step {STEP:g} s", ylim=(1e-17, 1e1))
    right.set(title=f"Accuracy and its price, steps {COST_STEPS[0]:g} ... {COST_STEPS[-1]:g} s",
              xlabel="time to compute 8 s of motion [ms]", ylabel="largest |error of α₁| [rad]")
    ticks = [tick for tick in (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50) if right.get_xlim()[0] < tick < right.get_xlim()[1]]
    right.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    right.set_xticks([], minor=True)
    _one_legend(figure, right, left)
    return figure


def _with_step(case: str, sol: Solution) -> str:
    return f"{case}, {sol.settings['step']:g} s"


def _one_legend(figure: Figure, *axes: Any) -> None:
    """One legend above the axes, of the lines of the first, instead of one in each."""
    if any(line.get_marker() == "v" for ax in axes for line in ax.lines):
        axes[0].plot([], [], "v", color="grey", markersize=5, markeredgewidth=0, label="exactly 0")
    handles, labels = axes[0].get_legend_handles_labels()
    for ax in axes:
        if ax.get_legend():
            ax.get_legend().remove()
            ax.autoscale_view()     # without the room for it
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels), frameon=False)
