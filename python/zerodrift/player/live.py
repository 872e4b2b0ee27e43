"""`zd.view(m, live=True)`: a page in which a mechanism is simulated while it is shown."""

from __future__ import annotations

import base64
import functools
import gzip
import html
import json
import re
import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

from .. import units
from .._private import checks
from .._private.gateway.mechanisms.blocks import BlockCore
from ..errors import WrongValue, ZerodriftError
from ..export import parameters as _parameters
from ..export import wasm
from ..export.block import choose, table_words, written
from ..mechanisms.assembly.drive_starts import driven_coordinate
from ..mechanisms.elements.forces import Actuator, Motor
from ..mechanisms.pictures.arrows import chosen as acting
from ..mechanisms.pictures.arrows import is_rolling
from ..mechanisms.system import MechanismSystem
from ..runs.samples.columns import columns
from ..runs.samples.solution import Solution
from ..runs.shapes_of_samples import names_of_points
from ..runs.simulate import simulate
from ..runs.states.instant import start_of
from ..systems.measure_values import find
from .body_points import BodyPoints, body_points, moved
from .page import Page, document, text
from .scene import ARROW, Wanted, scene

HEIGHT = 520            # of the page in a notebook, in points of the screen
AUTOMATIC = {".length": 4, ".stiffness": 1, ".mass": 1, "gravity.": 1}     # sliders, where none are named
TRIALS = 3              # parameters of a kind that are tried for each slider: some change too much for a block
AROUND = 0.25           # part of a value, to both sides
STEP = 1e-3             # s
MOTION = 1000           # steps from which extent and rails are known
SAMPLES = 60            # of this motion
UNMOVED = (".mass", ".stiffness", ".damping")       # parameters that move no point of the drawing in its body
DIGITS, EXACT = 9, 14   # decimal places of coordinates in m, in pages and in polynomials
TURNING = ", with Shift they turn the view"
# Units of parameters by their endings.
Limits = dict[str, tuple[float, float]]
BODY = """<canvas id="picture" role="img" tabindex="0"
aria-label="{name}, simulated; n chooses a part, arrow keys pull it{turning}"></canvas><div id="bar">
<button id="play">Pause</button><button id="restart">Restart</button><span id="state"></span></div>
<canvas id="trust" role="img" aria-label="Position violation and energy error over time"></canvas><div id="graphs"></div>
<div id="told" role="alert"></div><div id="sliders"></div>"""


class LiveView(Page):
    """A page with the core inside: it shows itself in notebooks, `save` writes it to a file, `show` opens it in the browser.

    Attributes
    ----------
    page : str
        The HTML page, with everything that it needs.
    """

    name = "live.html"

    def __init__(self, scene: Mapping[str, Any]) -> None:
        self._scene = scene

    @functools.cached_property
    def page(self) -> str:
        return self._page({"core": _encoded(gzip.compress(wasm.core(), 9))})

    def linked(self, *scripts: str) -> str:
        """Page that loads core and player from these addresses of scripts, for sites with several pages.

        The first script sets ``globalThis.zerodriftCore`` to the core in base 64, the second is `player`.
        """
        return self._page({}, "".join(f'<script src="{html.escape(each, quote=True)}"></script>' for each in scripts))

    def _page(self, more: Mapping[str, Any], scripts: str = "") -> str:
        name = html.escape(self._scene["name"], quote=True)
        data = json.dumps({**self._scene, **more}, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
        return document(self._scene["name"], "live.css",
                        f'{BODY.format(name=name, turning=TURNING if self._scene["dimension"] == 3 else "")}'
                        f'<script type="application/json" id="live">{data}</script>{scripts or f"<script>{player()}</script>"}')

    def _repr_html_(self) -> str:
        page = self.page.replace("&", "&amp;").replace("'", "&#39;")
        name = html.escape(self._scene["name"], quote=True)
        return (f'<iframe title="{name}, simulated" sandbox="allow-scripts" srcdoc=\'{page}\' '
                f'style="width:100%;max-width:960px;height:{HEIGHT}px;border:0"></iframe>')

    def __repr__(self) -> str:
        sliders = checks.counted(len(self._scene["sliders"]), "slider")
        return f"<live view of {self._scene['name']}: {sliders}, {len(self.page) / 1000:.0f} kB>"


def player() -> str:
    """Script of all live pages."""
    functions = re.sub(r"^export ", "", wasm.text("core.js"), flags=re.MULTILINE)
    return f'(async () => {{\n{functions}{text("graph.js")}\n{text("picture.js")}\n{text("live.js")}\n}})();\n'


def live_view(mechanism: Any, sliders: Mapping[str, tuple[float, float]] | None = None, *, step: float = STEP,
              speed: float | None = None, wanted: Wanted | None = None, **options: Any) -> LiveView:
    """Page of a mechanism, with sliders of these parameters and inputs, by name with smallest and largest value, the contents of
    a film, and the methods that `zerodrift.block` takes.
    """
    wanted = wanted or Wanted()
    system, *_ = start_of(mechanism, None, None, 0.0)
    if not isinstance(system, MechanismSystem):
        raise WrongValue("a live view must be of a mechanism: the page simulates its block, and equations have none",
                         "not-available")
    speed = 1.0 if speed is None else checks.number("speed", speed, above=0)
    sol = _motion(system, step, options)
    points = body_points(system, list(sol.p))
    inputs, limits = _given(system, sliders) if sliders is not None else (_inputs(system), {})
    arrows = [each.name for each in (acting(system._drawing, wanted.forces) if wanted.forces else ())
              if not is_rolling(each) and np.ndim(sol[f"{each.name}.force"]) == 2]
    graphs = [variable for variable, _ in columns(sol, wanted.graphs)] if len(wanted.graphs) else []
    paths = [name if name.endswith(".position") else f"{name}.position" for name in names_of_points(wanted.path)]
    read = [*paths, *(f"{name}.force" for name in arrows), *(variable.name for variable in graphs)]
    chosen = choose(system, None, None, 0.0, step, read, list(inputs), **options)
    driven = map(driven_coordinate, system._drawing.of((Motor, Actuator)))
    chosen = chosen._replace(has_grip=True, watched=(*chosen.watched, *driven))
    words = table_words(chosen), _parameters.computed_once(functools.partial(_coordinates, system, points))
    limits = _parameters.ranges(limits, system.parameters) if sliders is not None else _automatic(system, words)
    data = written(chosen._replace(limits=limits), words[0])
    values = {**system.parameters, **BlockCore(data).inputs}
    shown = [{"name": name, "kind": kind, "least": least, "most": most, "value": values[name],
              **units.shown(system._parameter_units().get(name, ""))._asdict()}
             for kind, those in (("parameter", limits), ("input", inputs)) for name, (least, most) in those.items()]
    film = scene([sol], [system.name], Wanted(samples=SAMPLES))
    kept = {name: film[name] for name in ("name", "upside", "dimension", "low", "high", "follow", "pin")}
    size = float(np.linalg.norm(np.subtract(film["high"], film["low"])) or 1.0)
    kept |= {"arrow": ARROW * size, "names": wanted.names, "paths": paths, "arrows": arrows,
             "force": units.shown("N")._asdict(),
             "graphs": [_read(system, variable.name) for variable in graphs]}
    mass = sum(body.mass for body in system._started_tables.written().bodies)
    gravity = float(np.linalg.norm([value for name, value in system.parameters.items() if name.startswith("gravity.")]))
    return LiveView({
        **kept, **_drawn(points), "changes": _changes(words[1], limits), "block": _encoded(data), "t": 0.0, "step": step,
        "speed": speed, "sliders": shown, "mass": mass, "weight": mass * gravity})


def _read(system: MechanismSystem, name: str) -> dict[str, Any]:
    """A graph: its name, unit and factor, the measure that it shows, and the component."""
    known = system._watching.known
    found: Any = find(name, known)
    return {"name": name, **units.shown(system._unit_of_measure(name))._asdict(), "measure": list(known)[found.number],
            "part": found.component or 0}


def _motion(system: MechanismSystem, step: float, options: Mapping[str, Any]) -> Solution:
    """A motion from the start: as far as it gets."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return simulate(system, MOTION * step, step=step, save_every=MOTION // SAMPLES, **options)
        except ZerodriftError as error:
            if getattr(error, "solution", None) is None:
                raise
            return error.solution


# ---- points ----


def _drawn(points: BodyPoints) -> dict[str, Any]:
    """Shapes, points on the ground, and points (body, 1 if it is a direction, coordinates in the body)."""
    numbers, fixed, carried = list[int](), list[Any](), list[Any]()
    for body, is_direction, own in zip(points.bodies, points.directions, points.local, strict=True):
        if body == 0:
            fixed.append(own.tolist())
            numbers.append(-len(fixed))
        else:
            numbers.append(len(carried))
            carried.append([int(body), int(is_direction), *np.round(own, DIGITS).tolist()])
    ends = np.cumsum([len(shape.points) for shape in points.shapes])
    shapes = [[shape.kind, shape.name, numbers[end - len(shape.points):end], round(float(shape.number), DIGITS)]
              for shape, end in zip(points.shapes, ends, strict=True)]
    return {"shapes": shapes, "fixed": fixed, "points": carried}


def _coordinates(system: MechanismSystem, points: BodyPoints, changed: Mapping[str, float]) -> np.ndarray:
    """Coordinates in their bodies of the points that bodies carry, with changed parameters, in one row."""
    other = system._with(dict(changed)) if changed else system
    return np.round(moved(other, points)[points.bodies > 0], EXACT).ravel()


def _changes(words: _parameters.Words, limits: Limits) -> dict[str, Any]:
    """Coordinates of points in their bodies as polynomials of the parameters that move them, as in a block.

    Raises
    ------
    ValueError
        If they are not polynomials.
    """
    moving = {name: each for name, each in limits.items() if not name.endswith(UNMOVED) and not name.startswith("gravity.")}
    found, products = _parameters.effects(words, moving)
    return {"effects": found, "products": products, "names": list(moving)}


# ---- sliders ----


def _given(system: MechanismSystem, sliders: Mapping[str, tuple[float, float]]) -> tuple[Limits, Limits]:
    """Inputs and parameters among the sliders."""
    motors = _motors(system)
    inputs = {name: (float(limits[0]), float(limits[1])) for name, limits in sliders.items() if name in motors}
    return inputs, {name: limits for name, limits in sliders.items() if name not in motors}


def _motors(system: MechanismSystem) -> dict[str, float]:
    return {f"{motor.name}.{motor.drives}": motor.law.constant for motor in system._drawing.of((Motor, Actuator))
            if motor.law.constant is not None and motor.drives in ("speed", "torque", "force")}


def _inputs(system: MechanismSystem) -> Limits:
    return {name: _around(value) if value else (-1.0, 1.0) for name, value in _motors(system).items()}


def _automatic(system: MechanismSystem, words: tuple[_parameters.Words, _parameters.Words]) -> Limits:
    """Some strokes, lengths, springs, masses and gravity whose changes together a block and the drawing can follow."""
    limits: Limits = {}
    driven = (each for each in system._drawing.of((Motor, Actuator)) if each.drives in ("length", "angle", "displacement"))
    strokes = dict.fromkeys([f"{each.name}.{each.drives}" for each in driven], 1)
    for kind, most in (strokes | AUTOMATIC).items():
        names = [name for name, value in system.parameters.items() if value and (name.endswith(kind) or name.startswith(kind))]
        left = most
        for name in names[:TRIALS * most]:
            more = {**limits, name: _around(system.parameters[name])}
            if left and _go_together(words, more):
                limits, left = more, left - 1
    return limits


def _go_together(words: tuple[_parameters.Words, _parameters.Words], limits: Limits) -> bool:
    """All numbers of the block and of the drawing are polynomials of these parameters."""
    try:
        _changes(words[1], limits)
        _parameters.effects(words[0], limits)
    except ValueError:
        return False
    return True


def _around(value: float) -> tuple[float, float]:
    low, high = sorted(((1 - AROUND) * value, (1 + AROUND) * value))
    return low, high


def _encoded(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")
