"""`zd.view`: the film of a motion in one HTML file."""

from __future__ import annotations

import base64
import functools
import html
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from .._private import checks
from .._private.types import Display, MeasureLike, Measures, Mechanism, Point
from ..errors import WrongType, WrongValue, ZerodriftError
from ..runs.samples.solution import A_SOLUTION, Solution
from ..systems.base import Makes
from ..units import displayed
from .page import Page, document, text
from .scene import Wanted, scene

HEIGHT = 460            # of a film in a notebook, in points of the screen
GRAPH = 110             # more for each graph
LARGEST = 100_000       # characters of the page that a solution shows of itself
MAX_COORDINATES = 300  # of systems whose solutions show a film of themselves
PICTURES = (".mp4", ".gif", ".webm", ".mov", ".avi", ".png")   # suffixes of films that `zerodrift.plot.animate` writes
SHORTER = (900, 300, 100, 40)       # samples of it: the first whose page is not larger


class View(Page):
    """A film: it shows itself in notebooks, `save` writes it to a file, `show` opens it in the browser.

    Attributes
    ----------
    page : str
        The complete HTML page.
    """

    name = "film.html"

    def __init__(self, solutions: Sequence[Solution], labels: Sequence[str], wanted: Wanted) -> None:
        self._solutions, self._wanted = solutions, wanted
        self._scene = scene(solutions, labels, wanted)
        self.samples: int = self._scene["samples"]
        self.height = HEIGHT + GRAPH * len({line["unit"] for line in self._scene["graphs"]})

    @functools.cached_property
    def page(self) -> str:
        return self._page(f"<script>{player()}</script>")

    def linked(self, script: str) -> str:
        """Page that loads the player from this address of a script, for sites with several films; `player` has the script."""
        return self._page(f'<script src="{html.escape(script, quote=True)}"></script>')

    def _page(self, script: str) -> str:
        data = json.dumps(self._scene, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
        return document(self._scene["name"], "player.css", f'<script type="application/json" id="scene">{data}</script>{script}')

    def save(self, path: str | Path) -> Path:
        """Write the film to an HTML file, which needs no other file and no network.

        Parameters
        ----------
        path : str or Path
            The suffix ``.html`` is added where it is missing.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        ValueError
            If the suffix is that of another kind of film or picture.
        """
        path = Path(path)
        if path.suffix.lower() in PICTURES:
            raise WrongValue(f"path must end in .html, as a film is a page, not in {path.suffix}: zd.plot.animate(sol).save(...) "
                             "writes such a film")
        return super().save(path)

    def _repr_html_(self) -> str:
        """A frame in front of a still picture, which untrusted notebooks keep."""
        name = html.escape(self._scene["name"], quote=True)
        return self.frame(f'<img alt="{name} at the start of the motion" src="data:image/png;base64,{self._still()}" '
                          'style="position:absolute;max-width:100%;max-height:100%">')

    def frame(self, behind: str = "") -> str:
        """The film as a frame that may run scripts, offer its picture and table as files, and fill the screen, and nothing else.

        Parameters
        ----------
        behind : str
            HTML that is shown where frames are not.

        Returns
        -------
        str
            HTML.
        """
        name = html.escape(self._scene["name"], quote=True)
        return (f'<div style="position:relative;height:{self.height}px;max-width:960px">{behind}'
                f'<iframe title="Film of {name}" sandbox="allow-scripts allow-downloads" allowfullscreen '
                f'srcdoc=\'{_quoted(self.page)}\' '
                'style="position:absolute;width:100%;height:100%;border:0;background:Canvas"></iframe></div>')

    def _still(self) -> str:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        from ..plot.drawing import mechanism

        figure = Figure(figsize=(6.4, 4.4), layout="constrained")
        FigureCanvasAgg(figure)
        mechanism(self._solutions[0], t=float(self._solutions[0].t[0]),
                  ax=figure.add_subplot(projection="3d" if self._scene["dimension"] == 3 else None))
        file = io.BytesIO()
        figure.savefig(file, format="png", dpi=60)
        return base64.b64encode(file.getvalue()).decode("ascii")

    def __repr__(self) -> str:
        return f"<film of {self._scene['name']}: {self._scene['samples']} samples, {len(self.page) / 1000:.0f} kB>"


def player() -> str:
    """Script of all films."""
    return text("graph.js") + text("picture.js") + text("player.js")


def of_solution(solution: Solution, text: str) -> str:
    """The film of a solution above its text, for notebooks; the text alone where the system cannot be drawn."""
    words = f"<pre>{html.escape(text)}</pre>"
    if solution.system.nq > MAX_COORDINATES:
        return f"{words}<small>zd.view(sol) shows the film of so many bodies; it takes a while to make.</small>"
    for samples in SHORTER:
        try:
            film = View([solution], [solution.system.name], Wanted(samples=samples))
        except (ValueError, ZerodriftError):
            return words
        if len(_quoted(film.page)) <= LARGEST:
            thinned = samples < SHORTER[0] and film.samples == samples
            note = f"<small>The film shows {film.samples} samples; zd.view(sol) shows more.</small>" if thinned else ""
            return f"{film._repr_html_()}{note}{words}"
    return words


@displayed
def view(*solutions: Solution | Mechanism, forces: bool | Sequence[Any] = False,
         path: str | Point | Sequence[str | Point] = (), graphs: MeasureLike | Measures = (), names: bool = False,
         speed: float | None = None, labels: Sequence[str] | None = None, live: bool = False,
         sliders: Mapping[str, tuple[float, float]] | None = None, display: Display | None = None) -> Any:
    """Film of one motion, or of several over each other, for notebooks and browsers.

    Play, pause and step with the space bar and the arrow keys; the slider is the time. Below it are the position violation and
    the energy error of the run. A click on a part shows its name and, for up to 200 joints and force elements, force and
    torque; ``n`` chooses the next part. In space, drag or Shift with the arrow keys turns; the wheel with Ctrl, ``+`` and
    ``-`` zoom. The view follows a mechanism that travels far, over a grid at rest.

    Parameters
    ----------
    *solutions : Solution
        At least one. Several are drawn over each other, in colours of their own: a drifting and a corrected run, for example.
    forces : bool, or sequence of str or element
        Reactions and forces to draw as arrows, in one scale, which the film shows; True: all of them.
    path : point or name, or a list of these
        Points whose paths are drawn.
    graphs : str, measure, or sequence of these
        Measures, coordinates and velocities whose graphs are drawn beside the film, with a cursor at its time.
    names : bool
        Names of parts.
    speed : float, optional
        Seconds of the motion in a second of the film. Left out: 1 for motions of 3 to 15 s; faster for longer and slower for
        shorter ones.
    labels : sequence of str, optional
        Names of the solutions.
    live : bool
        True: the argument is a mechanism instead of solutions, which the page itself simulates, by the core in WebAssembly;
        graphs are then of measures, forces not of rolling joints, and labels are left out. Points are dragged by a spring from
        the pointer, in space parallel to the screen, and sliders change parameters and motors; values with which loops cannot
        close are refused with a message. The core is compiled once, by the package ziglang (the extra ``web``).
    sliders : dict of (float, float), optional
        With ``live=True``: parameters and motors of the mechanism, with smallest and largest values, such as
        ``{"rod.length": (0.8, 1.2), "drive.speed": (0, 10)}``. By default some lengths, a spring, a mass,
        gravity, and all motors.
    display : dict of str to str, optional
        Units by quantity, as in `zerodrift.display_units`; left out: those of the session.

    Returns
    -------
    View or LiveView
        It shows itself at the end of a notebook's cell; `View.save` writes one HTML file, and `View.show` opens the browser.

    Raises
    ------
    ValueError
        If a system has no drawing, or systems of the plane and of space are given together.
    TypeError
        If anything other than a solution is given, or arguments exclude each other.

    Examples
    --------
    >>> import tempfile, zerodrift as zd
    >>> sol = zd.simulate(zd.models.slider_crank(), 2.0, step=0.005)
    >>> film = zd.view(sol, forces=["pin"], graphs=["crank.angle"])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     film.save(folder + "/crank.html").stat().st_size < 100_000
    True
    """
    if live:
        from .live import live_view

        if len(solutions) != 1:
            raise WrongType(f"a live view must be of one mechanism, not of {len(solutions)} arguments", "conflicting-arguments")
        _refuse_given({"labels": labels}, "must be left out with live=True")
        return live_view(solutions[0], sliders, speed=speed, wanted=Wanted(forces, path, graphs, names))
    _refuse_given({"sliders": sliders}, "must be left out without live=True; zd.explore has sliders of finished runs")
    if not solutions:
        raise WrongType("view must have at least one solution, as zd.simulate returns", "missing-argument")
    for sol in solutions:
        checks.instance("each of solutions", sol, Solution, A_SOLUTION if not isinstance(sol, Makes) else
                        f"{A_SOLUTION}, or with live=True a mechanism")
    if labels is None:
        labels = [sol.system.name if len(solutions) == 1 else f"{sol.system.name} {i}"     # type: ignore[union-attr]
                  for i, sol in enumerate(solutions, 1)]
    if len(labels) != len(solutions):
        raise WrongValue(f"labels must name {len(solutions)} solutions, not {len(labels)}", "shape")
    return View(solutions, list(labels), Wanted(forces, path, graphs, names, speed))     # type: ignore[arg-type]


def _refuse_given(arguments: Mapping[str, Any], rule: str) -> None:
    """Refuse arguments that are not left out."""
    for name, value in arguments.items():
        if value is not None and value is not False and not (isinstance(value, list | tuple) and not value):
            raise WrongType(f"{name} {rule}", "conflicting-arguments")


def _quoted(page: str) -> str:
    """A page as an attribute between single quotation marks."""
    return page.replace("&", "&amp;").replace("'", "&#39;")
