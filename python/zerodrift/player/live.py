"""`zd.view(m, live=True)`: a page in which a mechanism of the plane is simulated while it is shown."""

from __future__ import annotations

import base64
import functools
import gzip
import html
import json
import re
import tempfile
import webbrowser
from collections.abc import Mapping, Sequence
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from .. import _check
from .._gateway.mechanisms.blocks import BlockCore
from .._writing import write_whole
from ..errors import WrongValue
from ..export import wasm
from ..export.block import block
from ..mechanisms.elements.bodies import Body, Link, Point
from ..mechanisms.elements.forces import Motor, Spring
from ..mechanisms.elements.joints import Joint
from ..runs.start import start_of

HEIGHT = 520            # of the page in a notebook, in points of the screen
MARGIN = 0.35           # around the drawing, part of its size
AUTOMATIC = 4           # sliders for lengths, where none are named
AROUND = 0.25           # part of a value, to both sides
STEP = 1e-3             # s
BODY = """<canvas id="picture" role="img" tabindex="0"
aria-label="{name}, simulated; n chooses a point, arrow keys pull it"></canvas><div id="bar"><button id="play">Pause</button>
<span id="state"></span></div><canvas id="trust" role="img" aria-label="Position violation and energy error over time"></canvas>
<div id="told" role="alert"></div><div id="sliders"></div>"""


class LiveView:
    """A page with the core inside: it shows itself in notebooks, `save` writes it to a file, `show` opens it in the browser.

    Attributes
    ----------
    page : str
        The HTML page, with everything that it needs.
    """

    def __init__(self, scene: Mapping[str, Any]) -> None:
        self._scene = scene

    @functools.cached_property
    def page(self) -> str:
        return self._page({"core": _encoded(gzip.compress(wasm.core(), 9))})

    def linked(self, core: str) -> str:
        """The page without the core, which it takes from a script of this address: ``globalThis.zerodriftCore``, in base 64."""
        return self._page({}, f'<script src="{html.escape(core, quote=True)}"></script>')

    def _page(self, more: Mapping[str, Any], before: str = "") -> str:
        name = html.escape(self._scene["name"], quote=True)
        data = json.dumps({**self._scene, **more}, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
        script = re.sub(r"^export ", "", wasm.text("core.js"), flags=re.MULTILINE) + _text("live.js")
        return (f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>{name}</title>'
                f'<meta name="viewport" content="width=device-width"><style>{_text("live.css")}</style></head>'
                f'<body>{BODY.format(name=name)}{before}'
                f'<script type="application/json" id="live">{data}</script><script type="module">{script}</script></body></html>')

    def save(self, path: str | Path) -> Path:
        """Write the page to an HTML file, which needs no other file and no network; the suffix ``.html`` is added."""
        path = Path(path)
        path = path if path.suffix == ".html" else path.with_name(path.name + ".html")
        write_whole(path, lambda file: file.write(self.page.encode()))
        return path

    def show(self) -> None:
        """Open the page in the browser, from a temporary file."""
        folder = Path(tempfile.mkdtemp(prefix="zerodrift-"))
        webbrowser.open(self.save(folder / "live.html").as_uri())

    def _repr_html_(self) -> str:
        page = self.page.replace("&", "&amp;").replace("'", "&#39;")
        name = html.escape(self._scene["name"], quote=True)
        return (f'<iframe title="{name}, simulated" sandbox="allow-scripts" srcdoc=\'{page}\' '
                f'style="width:100%;max-width:960px;height:{HEIGHT}px;border:0"></iframe>')

    def __repr__(self) -> str:
        return f"<live view of {self._scene['name']}: {len(self._scene['sliders'])} sliders, {len(self.page) / 1000:.0f} kB>"


def live_view(mechanism: Any, sliders: Mapping[str, tuple[float, float]] | None = None, *, step: float = STEP,
              speed: float | None = None, **options: Any) -> LiveView:
    """Page of a mechanism, with sliders of these parameters and inputs, by name with smallest and largest value, and the methods
    that `zerodrift.block` takes.
    """
    system, *_ = start_of(mechanism, None, None, 0.0)
    if getattr(getattr(system, "_drawing", None), "dimension", 0) != 2:
        raise WrongValue("a live view must be of a mechanism in the plane")
    inputs, limits = _sorted(system, sliders)
    points = _Points(system)
    bodies = [{"name": body.name, "points": found} for body in system._drawing.of(Body) if (found := points.of_body(body))]
    springs = [[points.of(spring.first), points.of(spring.second)] for spring in system._drawing.of(Spring)]
    springs = [ends for ends in springs if None not in ends]
    names = sorted({point for body in bodies for point in body["points"] if isinstance(point, str)} |
                   {point for ends in springs for point in ends if isinstance(point, str)} |
                   {pin["at"] for pin in points.pins if isinstance(pin["at"], str)})
    data = block(system, step=step, outputs=names, inputs=list(inputs), parameters=limits, **options)
    values = {**system.parameters, **BlockCore(data).inputs}
    shown = [{"name": name, "kind": kind, "least": least, "most": most, "value": values[name]}
             for kind, those in (("parameter", limits), ("input", inputs)) for name, (least, most) in those.items()]
    ends = [*springs, *([pin["at"]] for pin in points.pins)]
    return LiveView({
        "name": system.name, "block": _encoded(data), "t": 0.0, "step": step,
        "speed": 1.0 if speed is None else _check.number("speed", speed, above=0), "bodies": bodies, "springs": springs,
        "pins": points.pins, "sliders": shown, "extent": _extent(system, names, ends)})


def _sorted(system: Any, sliders: Mapping[str, tuple[float, float]] | None) -> tuple[dict[str, Any], dict[str, Any]]:
    """Inputs and parameters among the sliders."""
    motors = {f"{motor.name}.{motor.drives}": motor.law.constant for motor in system._drawing.of(Motor)
              if motor.law.constant is not None and motor.drives in ("speed", "torque", "force")}
    if sliders is None:
        lengths = [name for name in system.parameters if name.endswith(".length")][:AUTOMATIC]
        sliders = {name: _around(system.parameters[name]) for name in lengths} | {
            name: _around(value or 1.0) if value else (-1.0, 1.0) for name, value in motors.items()}
    inputs = {name: (float(limits[0]), float(limits[1])) for name, limits in sliders.items() if name in motors}
    return inputs, {name: limits for name, limits in sliders.items() if name not in motors}


def _around(value: float) -> tuple[float, float]:
    low, high = sorted(((1 - AROUND) * value, (1 + AROUND) * value))
    return low, high


class _Points:
    """Points of a mechanism as the page reads them: a name of a measure, or a place on the ground."""

    def __init__(self, system: Any) -> None:
        self._drawing, self._known = system._drawing, system._watching.number
        self._on: dict[str, list[Any]] = {}
        self.pins: list[dict[str, Any]] = []
        for joint in self._drawing.of(Joint):
            self._add(joint)
        for point in self._drawing.of(Point):
            if (at := self.of(point)) is not None:
                self._on.setdefault(point.body.name, []).append(at)

    def _add(self, joint: Joint) -> None:
        at = f"{joint.name}.position" if f"{joint.name}.position" in self._known else self.of(joint.second)
        if at is None:
            return
        bodies = [body.name for body in joint.bodies]
        self.pins.append({"at": at, "ground": "ground" in bodies})
        for name in bodies:
            self._on.setdefault(name, []).append(at)

    def of(self, point: Point) -> Any:
        """Name of the measure of a point, its place on the ground, or None if it is not measured."""
        if point.body is self._drawing.ground:
            return [float(each) for each in point.drawn]
        name = point.name if point.name else point.body.name if not np.any(point.local) else ""
        return f"{name}.position" if f"{name}.position" in self._known else None

    def _at_ends(self, body: Link) -> list[Any]:
        """Joints and points at the ends of a link."""
        ends, found = [body.start.local, body.end.local], []
        for joint in self._drawing.of(Joint):
            found += [f"{joint.name}.position" for side in (joint.first, joint.second) if side.body is body
                      and any(np.allclose(side.local, end) for end in ends)]
        return found

    def of_body(self, body: Body) -> list[Any]:
        """Points between which a body is drawn: ends of a link, and its joints."""
        if body is self._drawing.ground:
            return []
        ends = [f"{body.name}.start.position", f"{body.name}.end.position"] if isinstance(body, Link) else []
        found = [name for name in ends if name in self._known]
        if len(found) == 2:
            others = [each for each in self._on.get(body.name, []) if each not in self._at_ends(body)]
            return [*found, *others]
        points, own = self._on.get(body.name, []), f"{body.name}.position"
        return points if len(points) > 1 or own not in self._known else [*points, own]


def _extent(system: Any, names: Sequence[str], more: Sequence[Sequence[Any]]) -> list[float]:
    """Rectangle around the start: left, low, right, high, with a margin of the size of the mechanism."""
    places = [np.asarray(point, dtype=float) for group in more for point in group if not isinstance(point, str)]
    core = system._watching.core
    for name in names:
        places.append(core.measure(system._watching.number[name], np.zeros(1), system.p0[None], system.v0[None])[0])
    low, high = np.min(places, axis=0), np.max(places, axis=0)
    size = max(float((high - low).max()), 1e-3)
    return [*(low - MARGIN * size).tolist(), *(high + MARGIN * size).tolist()]


def _encoded(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")


@functools.cache
def _text(name: str) -> str:
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")
