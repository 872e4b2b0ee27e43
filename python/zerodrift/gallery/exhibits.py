"""Exhibits of the gallery: duration, traced points and caption of each model.

Models that are not in the table use the first sentence of their docstring and one turn of their motor.
"""

from __future__ import annotations

import ast
import inspect
import sys
from typing import Any, NamedTuple

import numpy as np

from .. import models
from .._private import checks
from ..mechanisms.elements.forces import Motor
from ..mechanisms.mechanism import Mechanism
from ..runs.samples.solution import Solution
from ..runs.simulate import simulate


class Exhibit(NamedTuple):
    """A model in motion.

    Attributes
    ----------
    name : str
        Name of the model in `zerodrift.models`.
    see : str
        Caption.
    span, step : float
        In s.
    path : tuple of str
        The points whose paths are drawn.
    speed : float
        Seconds of motion per second of film.
    options : dict
        Further arguments of `zerodrift.simulate`.
    arguments : tuple
        Arguments of the model.
    """

    name: str
    see: str
    span: float
    step: float
    path: tuple[str, ...] = ()
    speed: float = 1.0
    options: tuple[tuple[str, Any], ...] = ()
    arguments: tuple[Any, ...] = ()

    @property
    def title(self) -> str:
        """Its name in words."""
        return self.name.replace("_", " ").capitalize()

    @property
    def lines(self) -> list[str]:
        """The lines that show it."""
        options = "".join(f", {name}={_word(value)}" for name, value in self.options)
        path = f", path={_word(self.path[0] if len(self.path) == 1 else list(self.path))}" if self.path else ""
        speed = f", speed={self.speed:g}" if self.speed != 1 else ""
        return [f"m = zd.models.{self.name}({', '.join(map(_word, self.arguments))})",
                f"sol = zd.simulate(m, {self.span:g}, step={self.step:g}{options})",
                f"zd.plot.animate(sol{speed}{path})"]

    @property
    def source(self) -> str:
        """The model's own lines: its file without docstrings and imports."""
        text = inspect.getsource(sys.modules[getattr(models, self.name).__module__])
        dropped: set[int] = set()
        for node in ast.walk(tree := ast.parse(text)):
            if isinstance(node, ast.Module | ast.FunctionDef | ast.ClassDef) and ast.get_docstring(node, clean=False) is not None:
                dropped |= _lines_of(node.body[0])
        for node in tree.body:
            if isinstance(node, ast.Import | ast.ImportFrom):
                dropped |= _lines_of(node)
        kept = "\n".join(line for i, line in enumerate(text.splitlines(), 1) if i not in dropped)
        while "\n\n\n\n" in kept:
            kept = kept.replace("\n\n\n\n", "\n\n\n")
        return kept.strip()

    def made(self) -> Any:
        """The mechanism."""
        return getattr(models, self.name)(*self.arguments)

    def run(self) -> Solution:
        """Its motion."""
        return simulate(self.made(), self.span, step=self.step, **dict(self.options))


def _word(value: Any) -> str:
    return repr(value).replace("'", '"')


def _lines_of(node: ast.stmt) -> set[int]:
    return set(range(node.lineno, (node.end_lineno or node.lineno) + 1))


TABLE = [
    Exhibit("anchor_escapement",
            "Each swing lets half a tooth pass, which pushes the pendulum; then the pendulum turns the wheel back a little.",
            5.0, 0.005, speed=0.6),
    Exhibit("andrews",
            "A constant moment spins the crank up to two and a half turns in 0.03 s, and three chains of links follow its"
            " coupler.",
            0.03, 2e-05, speed=0.012),
    Exhibit("bicycle",
            "The steering swings, and the frame follows: the rear wheel cuts the corners of the front wheel's slalom.",
            3.0, 0.01, ("frame", "fork")),
    Exhibit("cam_follower",
            "The follower rises and falls without a jolt and rests in between, as acceleration and jerk begin and end at "
            "zero.",
            1.0, 0.005, speed=0.4),
    Exhibit("chebyshev_lambda",
            "For half of the crank's turn P goes along a line that is nearly straight; then it comes back in an arc.",
            1.0, 0.005, ("P",), speed=0.4),
    Exhibit("closed_pendulum",
            "The chain falls from its arch, folds and whips: nothing repeats, and it stays closed to rounding.",
            4.0, 0.002),
    Exhibit("compass_gait",
            "Gravity alone drives the walk: what a step gains on the slope is lost where the next foot is set down.",
            5.0, 0.005),
    Exhibit("four_bar",
            "The paper's mechanism falls from its start: the crank turns fully, and the rocker swings.",
            4.0, 0.005, ("C",)),
    Exhibit("four_bars",
            "All uprights stay parallel, also where the row lies flat, and the motion could branch.",
            4.0, 0.005, options=(("on_singular", "continue"),)),
    Exhibit("geneva",
            "Each turn of the crank moves the wheel on by a quarter, and holds it meanwhile.",
            4.0, 0.005),
    Exhibit("hoecken",
            "P draws a line that is straight to 0.023 % while the crank turns through 140 degrees.",
            1.0, 0.0025, ("P",), speed=0.4),
    Exhibit("jansen",
            "The toe is flat on the ground for half of the turn, and is lifted back in the other half.",
            1.0, 0.005, ("F",), speed=0.4),
    Exhibit("klann",
            "The foot steps as a spider's does: it is set down, drawn back, and lifted high over obstacles.",
            1.0, 0.005, ("F",), speed=0.4),
    Exhibit("pantograph",
            "The pen P draws twice as large what the tracer Q is led along: O, Q and P are always in line.",
            1.0, 0.005, ("Q", "P"), speed=0.4),
    Exhibit("peaucellier",
            "Q goes on a circle, and P on a line that is exactly straight: to 1e-12 m here.",
            1.0, 0.002, ("Q", "P"), speed=0.4),
    Exhibit("planetary_gear",
            "Carrier and sun are driven, and the ring runs ahead of both, as Willis's equation has it.",
            0.6, 0.002, speed=0.2),
    Exhibit("quarter_car",
            "The wheel follows a road whose waves are near the resonance of the body, which sways late and far.",
            3.0, 0.002),
    Exhibit("quick_return",
            "The ram goes slowly one way and returns in less than two fifths of the turn.",
            0.42, 0.001, speed=0.17),
    Exhibit("scissor_lift",
            "The platform stays level, and its height follows from the width of the foot, whatever the load.",
            2.0, 0.01, speed=0.8),
    Exhibit("slider_crank",
            "It swings on the spring between its links, and the damper beside that takes the energy out.",
            10.0, 0.01, speed=3.0),
    Exhibit("snakeboard",
            "Nothing pushes from behind: swinging the rotor and turning the axles in step drives the board forward.",
            20.0, 0.02, ("board",), speed=6.0),
    Exhibit("stephenson",
            "With each turn of the crank the output swings to and fro, unevenly, as the coupler's curve has it.",
            1.0, 0.005, ("E",), speed=0.4),
    Exhibit("suspension",
            "The wheel leaves the plate where it falls away, and the arm hits its stops.",
            1.7136, 0.002, speed=0.7),
    Exhibit("toggle_press",
            "The knee is nearly straight where the ram is lowest: there a small torque holds a large force.",
            1.0, 0.002, speed=0.4),
    Exhibit("trebuchet",
            "The projectile slides in its trough, is lifted off and thrown; then the arm hits the beam.",
            5.0, 0.005, ("projectile",)),
    Exhibit("watt",
            "P goes along a lemniscate whose middle is straight to the eye: it guided the pistons of steam engines.",
            1.0, 0.005, ("P",), speed=0.4),
    Exhibit("bennett", "Four hinges with skew axes turn fully, where a count of constraints leaves no freedom.", 3.0, 0.005),
    Exhibit("chain", "The chain swings down from one end, and a wave runs along it.", 2.0, 0.002, speed=0.5, arguments=(20,)),
    Exhibit("coin", "The coin whirs around on its edge, its centre at rest.", 0.3, 2e-4, speed=0.1),
    Exhibit("delta_robot", "Three arms swing one after the other, and the platform moves without turning.", 2.0, 0.005),
    Exhibit("double_cardan", "The shaft between the two joints turns unevenly, and the output evenly again.", 1.0, 0.002,
            speed=0.4),
    Exhibit("double_wishbone", "The wheel moves up and down nearly upright, held by two arms and a tie rod.", 1.0, 0.001,
            speed=0.4),
    Exhibit("flyball_governor", "The balls keep their height at the speed for which they are in equilibrium.", 2.0, 0.002,
            speed=0.5),
    Exhibit("gyroscope", "The weight on the axle does not fall: the gimbals precess.", 2.0, 0.002, speed=0.5),
    Exhibit("heavy_top", "The top precesses about the vertical, and its axle nods.", 2.0, 0.001, ("top.center",), speed=0.5),
    Exhibit("hookes_joint", "The output runs ahead of the even input twice in each turn, and behind it twice.", 1.0, 0.002,
            speed=0.4),
    Exhibit("rattleback", "The stone rattles, stops, and turns back, as it has a way to turn that it prefers.", 6.0, 0.001,
            speed=2.0),
    Exhibit("rolling_disc", "The disc rolls on a circle with constant lean.", 2.0, 0.002, speed=0.5),
    Exhibit("spatial_slider_crank", "A crank turns about the line along which it pushes and pulls the slider.", 1.0, 0.001,
            speed=0.4),
    Exhibit("stewart_platform", "Six cylinders change their lengths, and the platform moves in all six freedoms.", 2.0, 0.005),
    Exhibit("whipple_bicycle", "Pushed over, the riderless bicycle steers into its fall and rides upright again.", 1.2, 0.01,
            speed=0.4),
]


def exhibits() -> list[Exhibit]:
    """Every model of `zerodrift.models`, in its order.

    Examples
    --------
    >>> from zerodrift import gallery
    >>> len(gallery.exhibits())
    41
    """
    return [exhibit(name) for name in _models()]


def _models() -> list[str]:
    """Names of all functions of `zerodrift.models`."""
    return [name for name in models.__all__ if callable(getattr(models, name))]


def exhibit(name: str) -> Exhibit:
    """Exhibit of one model.

    Parameters
    ----------
    name : str
        Name of a model in `zerodrift.models`.

    Returns
    -------
    Exhibit

    Raises
    ------
    ValueError
        If there is no such model.

    Examples
    --------
    >>> from zerodrift import gallery
    >>> gallery.exhibit("watt").path
    ('P',)
    """
    checks.choice("name", name, _models())
    listed = next((each for each in TABLE if each.name == name), None)
    return listed or by_itself(name, getattr(models, name))


def by_itself(name: str, model: Any) -> Exhibit:
    """An exhibit of a model that is not in the table: a turn of its first motor, or two seconds."""
    made = model()
    speeds = [abs(motor.law.constant) for motor in (made.motors if isinstance(made, Mechanism) else ())
              if isinstance(motor, Motor) and motor.drives == "speed" and motor.law.constant]
    span = float(2 * np.pi / speeds[0]) if speeds else 2.0
    return Exhibit(name, " ".join((inspect.getdoc(model) or name).split("\n\n")[0].split()), float(f"{span:.3g}"),
                   float(f"{span / 400:.2g}"), speed=float(f"{span / 2.5:.2g}"))
