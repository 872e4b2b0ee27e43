"""Pages of the site that simulate: the core in WebAssembly, once for all of them, and the drawing board."""

from __future__ import annotations

import base64
import gzip
import json
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from boards import address

import zerodrift as zd
from zerodrift import gallery
from zerodrift.errors import CompilationFailed
from zerodrift.export import wasm
from zerodrift.mechanisms.files import from_json
from zerodrift.mechanisms.files.to_json import described
from zerodrift.player.live import LiveView, live_view, player
from zerodrift.player.page import text as player_text
from zerodrift.player.scene import Wanted

BOARD = Path(__file__).parent.parent / "board"
SCRIPTS = ("model.js", "scene.js", "block.js", "python.js", "edit.js", "fields.js", "board.js")      # what a script uses stands before it


PACKAGE = [path for path in Path(zd.__file__).parent.rglob("*.*") if path.suffix != ".pyc"]
CHANGED = max(path.stat().st_mtime for path in PACKAGE)     # s


def is_current(path: Path) -> bool:
    """Existence of a file that is made of the package as it is."""
    return path.exists() and path.stat().st_mtime >= CHANGED


def write(folder: Path) -> None:
    """Write the core and the drawing board; a file that would not change is left as it is."""
    for name, text in {"core_bytes.js": core_bytes(), "board.html": board()}.items():
        path = folder / name
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def core_bytes() -> str:
    """Script with the core; without the package ziglang there is none, and the pages say so."""
    try:
        packed = base64.b64encode(gzip.compress(wasm.core(), 9, mtime=0)).decode("ascii")
    except CompilationFailed:
        packed = ""
    return f'globalThis.zerodriftCore = "{packed}";\n'


def board() -> str:
    """The drawing board in one file, except for the core."""
    text = {path.name: path.read_text(encoding="utf-8") for path in BOARD.iterdir()}
    script = plain(wasm.text("core.js")) + player_text("graph.js") + player_text("picture.js") + "".join(plain(text[name]) for name in SCRIPTS)
    examples = [[name, described(each._drawing())] for name, each in drawn().items()]
    script = script.replace("/*examples*/[]", json.dumps(examples, separators=(",", ":")))
    return text["board.html"].replace("/*style*/", player_text("colours.css") + text["board.css"]).replace("/*script*/", script)


def leg() -> zd.Mechanism:
    """Jansen's leg, whose crank a motor turns by a torque, so that it can be held and dragged."""
    data = described(zd.models.jansen()._drawing())
    data["elements"] = [each for each in data["elements"] if each["kind"] != "motor"]
    walking = from_json.mechanism(zd.Mechanism, data, "leg")
    walking.motor("drive", "Z", torque=lambda speed: -2.0 * (speed + 5.0))
    return walking


def write_leg(folder: Path) -> None:
    """Write the live page of the first page, and the player that all of them share."""
    folder.mkdir(exist_ok=True)
    (folder / "player.js").write_text(player(), encoding="utf-8")
    if not is_current(folder / "leg.html"):
        save(live_view(leg(), {}, step=0.005, wanted=Wanted(path="F")), folder / "leg.html")


def write_live(exhibit: gallery.Exhibit, graphs: Sequence[str], path: Path) -> None:
    """Write the page that simulates a model, with graphs of those that are measures."""
    made = exhibit.made()
    shown = [name for name in graphs if name in made.measures]
    wanted = Wanted([name.removesuffix(".force") for name in shown if name.endswith(".force")], exhibit.path, shown)
    save(live_view(made, step=min(exhibit.step, 0.01), speed=exhibit.speed, wanted=wanted, **dict(exhibit.options)), path)


def save(view: LiveView, path: Path) -> None:
    """Write a live page that loads core and player."""
    path.write_text(view.linked("../core_bytes.js", "player.js"), encoding="utf-8")


def plain(script: str) -> str:
    """A module's text as part of one script."""
    return re.sub(r"^import .*?;\n", "", re.sub(r"^export ", "", script, flags=re.MULTILINE), flags=re.MULTILINE)


def drawn() -> dict[str, zd.Mechanism]:
    """Mechanisms that the drawing board offers while it is empty, and its page."""
    bar = zd.Mechanism("four-bar", gravity=(0, -9.81))
    for name, start, end in (("crank", (0, 0), (0, 0.4)), ("coupler", (0, 0.4), (1.2, 0.9)), ("rocker", (1.2, 0.9), (1, 0))):
        bar.link(name, start, end, mass=1.0)
    bar.revolute("A", bar.ground.point((0, 0)), "crank.start")
    bar.revolute("B", "crank.end", "coupler.start")
    bar.revolute("C", "coupler.end", "rocker.start")
    bar.revolute("D", bar.ground.point((1, 0)), "rocker.end")
    bar.motor("drive", "A", speed=3.0)
    bar.point("P", "coupler", (0.6, 0.4))
    slider = zd.Mechanism("slider-crank", gravity=(0, -9.81))
    slider.link("crank", (0, 0), (0.2, 0.3), mass=1.0)
    slider.link("rod", (0.2, 0.3), (1.2, 0), mass=1.0)
    slider.revolute("main", slider.ground.point((0, 0)), "crank.start")
    slider.revolute("pin", "crank.end", "rod.start")
    slider.slot("guide", "ground", "rod.end", axis=(1, 0))
    slider.spring("spring", slider.ground.point((2, 0)), "rod.end", stiffness=40.0, length=0.8, damping=0.5)
    slider.motor("drive", "main", speed=5.0)
    slider.force("load", "rod.end", value=(-20.0, 0.0))
    watt = zd.Mechanism("Watt linkage", gravity=(0, -9.81))
    for name, start, end in (("left", (-1, 0.2), (0, 0.2)), ("middle", (0, 0.2), (0, -0.2)), ("right", (0, -0.2), (1, -0.2))):
        watt.link(name, start, end, mass=1.0)
    watt.revolute("A", watt.ground.point((-1, 0.2)), "left.start")
    watt.revolute("B", "left.end", "middle.start")
    watt.revolute("C", "middle.end", "right.start")
    watt.revolute("D", watt.ground.point((1, -0.2)), "right.end")
    watt.link("crank", (-0.5, -0.4), (-0.4, -0.4), mass=1.0)
    watt.link("rod", (-0.4, -0.4), (-0.5, 0.2), mass=1.0)
    watt.revolute("E", watt.ground.point((-0.5, -0.4)), "crank.start")
    watt.revolute("F", "crank.end", "rod.start")
    watt.revolute("G", watt["left"].point((0.5, 0.0)), "rod.end")
    watt.motor("drive", "E", speed=2.0)
    watt.point("P", "middle", (0.2, 0.0))
    pendulum = zd.Mechanism("double pendulum", gravity=(0, -9.81))
    pendulum.link("upper", (0, 0), (0.8, 0.1), mass=1.0)
    pendulum.link("lower", (0.8, 0.1), (1.4, 0.6), mass=1.0)
    pendulum.revolute("top", pendulum.ground.point((0, 0)), "upper.start")
    pendulum.revolute("elbow", "upper.end", "lower.start")
    return {each.name: each for each in (bar, slider, watt, pendulum)}


def boards() -> Iterable[str]:
    """Links to the drawing board with mechanisms on it."""
    links = [f'<a href="{address(described(each._drawing()))}">{name}</a>' for name, each in drawn().items()]
    yield f"<p>To begin with: {', '.join(links)}.</p>"
