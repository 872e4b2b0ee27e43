"""Pages of the site that are made from tables of the package: methods, joints and forces, errors, gallery, reference."""

from __future__ import annotations

import html
import inspect
import json
import warnings
from collections.abc import Iterable
from pathlib import Path

import boards
import live
import matplotlib
import numpy as np
from fontTools import subset
from fontTools.ttLib import TTFont

import zerodrift as zd
from zerodrift import errors, gallery
from zerodrift._private.gateway.base import statuses
from zerodrift.explanations import codes, explanations
from zerodrift.mechanisms.elements.joints import JOINTS
from zerodrift.mechanisms.elements.space_joints import JOINTS as SPACE_JOINTS
from zerodrift.mechanisms.elements.table_forces import ELEMENTS, SPACE_ELEMENTS
from zerodrift.paper import geometry
from zerodrift.player.view import player

WARNINGS = tuple(each for each in vars(errors).values() if inspect.isclass(each) and issubclass(each, Warning))
ERRORS = tuple(each for each in vars(errors).values() if inspect.isclass(each) and issubclass(each, zd.ZerodriftError))


def write(folder: Path) -> None:
    """Write all of them; a file that would not change is left as it is."""
    folder.mkdir(exist_ok=True)
    pages = {"formulations": methods("Formulations", zd.formulations()), "integrators": methods("Integrators", zd.integrators()),
             "corrections": methods("Corrections", zd.corrections()), "elements": elements(), "errors": messages(),
             "reference": reference(), **dict(films(folder))}
    (folder / "models").mkdir(exist_ok=True)
    figures(folder)
    live.write(folder / "extra")
    font(folder / "fonts")
    for name, lines in {"cards.html": cards(), "boards.html": live.boards(), **{f"{page}.md": text for page, text in pages.items()}}.items():
        path, text = folder / name, "\n".join(lines) + "\n"
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


CARDS = (("start/a_mechanism_in_ten_minutes", "slider_crank", "Ten minutes", "a mechanism of your own, a reaction, a film"),
         ("generated/gallery", "jansen", "Gallery", "known mechanisms in motion, with their code"),
         ("start/mechanisms_in_space", "stewart_platform", "In space", "axes, wheels, frames; graphs and forces"))


def cards() -> Iterable[str]:
    """Links of the first page, whose films play."""
    yield '<div class="films">'
    yield from (card(page, f"films/{film}", title, text, text) for page, film, title, text in CARDS)
    yield from ("</div>", PLAYING)


def card(page: str, film: str, title: str, text: str, see: str) -> str:
    """A film that plays when it is pointed at, on a telephone when it is seen; it is a link."""
    return (f'<a href="{page}.html"><iframe src="{film}.html#t=0" title="Film: {html.escape(see)}" loading="lazy" tabindex="-1"></iframe>'
            f'<b>{title}</b><small>{html.escape(text)}</small></a>')


LETTERS = (range(0x20, 0x7F), range(0x391, 0x3D7), (0x2D9, 0x307, 0x2032), range(0x2190, 0x22FF), range(0x1D400, 0x1D7FF))      # code points


def font(folder: Path) -> None:
    """Write a font for equations, of those that matplotlib has: systems without one have no italic letters or dots that are seen."""
    path = folder / "mathematics.woff"
    if path.exists():
        return
    folder.mkdir(exist_ok=True)
    whole = TTFont(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "STIXGeneral.ttf")
    part = subset.Subsetter(subset.Options(drop_tables=["FFTM"]))
    part.populate(unicodes=[code for codes in LETTERS for code in codes])
    part.subset(whole)
    whole.flavor = "woff"
    whole.save(path)


def figures(folder: Path) -> None:
    """Figures 1 to 3 of the paper, drawn anew."""
    for number in (1, 2, 3):
        path = folder / f"figure_{number}.png"
        if not path.exists():
            getattr(geometry, f"figure_{number}")().savefig(path, dpi=100)


def methods(title: str, rows: dict[str, object]) -> Iterable[str]:
    """The rows of a table of methods, with their parameters."""
    yield from (f"# {title}", "", f"Summary, equations, source and parameters of {', '.join(f'`{name}`' for name in rows)}.", "")
    for name, row in rows.items():
        yield from (f"## {name}", "", row.summary, "", " ".join(row.description.split()), "")
        if row.equations:
            yield from (f"Equations: {row.equations}", "")
        if row.reference:
            yield from (f"Source: {row.reference}", "")
        if row.parameters:
            yield from ("| parameter | initially | meaning |", "|---|---|---|")
            yield from (f"| `{each.name}` | {', '.join(f'{value:g}' for value in each.initial)} | {cell(each.text)} |"
                       for each in row.parameters)
            yield ""


def cell(text: str) -> str:
    """Text of a table's cell, whose bars end no column."""
    return text.replace("|", "\\|")


COUPLINGS = ("motor", "actuator", "gear", "rack_pinion", "coupler", "cam", "constraint", "nonholonomic")


def elements() -> Iterable[str]:
    """Joints, force elements and couplings, with the verbs that make them."""
    yield from ("# Joints and forces", "", "Verbs of {py:class}`zerodrift.Mechanism`; `help(m.revolute)` has their arguments.", "")
    for title, table in (("Joints in the plane", JOINTS), ("Joints in space", SPACE_JOINTS), ("Force elements in the plane", ELEMENTS),
                         ("Force elements in space", SPACE_ELEMENTS)):
        yield from (f"## {title}", "", "| verb | effect |", "|---|---|")
        yield from (f"| `{name}` | {(row.row if hasattr(row, 'row') else row).card.summary} |" for name, row in table.items())
        yield ""
    yield from ("## Drives, couplings and constraints of your own", "", "| verb | effect |", "|---|---|")
    for name in COUPLINGS:
        words = " ".join(inspect.cleandoc(getattr(zd.Mechanism, name).__doc__ or "").split("\n\n")[0].split())
        yield f"| `{name}` | {words} |"
    yield ""


def messages() -> Iterable[str]:
    """Errors and warnings by code: meaning, the core's sentences, causes, cures, and lines that provoke it."""
    yield from ("# When it stops", "", "A message ends with a code, such as `[zd:branch-jump]`, which `error.code` holds. "
                "`python -m zerodrift explain branch-jump` prints the section below it.", "",
                "Errors of the package are {py:class}`zerodrift.ZerodriftError`; most carry the solution up to the place where it "
                "stopped, as `error.solution`. Errors of arguments are `ValueError`, `TypeError` and `KeyError`, too; their message states "
                "the rule, the value and a hint, and their code is that of the rule, such as `shape`, or one of the first three.", "")
    known, explained = codes(), explanations()
    yield from ("| code | meaning |", "|---|---|")
    yield from (f"| [`{code}`](#{code}) | {first_clause(meaning)} |" for code, (_, meaning) in known.items())
    for code, (each, meaning) in known.items():
        found = explained[code]
        name = each.__name__ if hasattr(zd, each.__name__) else f"errors.{each.__name__}"
        yield from ("", f"({code})=", f"## {code}", "", f"`zerodrift.{name}`. {meaning}", "")
        if said := [row.sentence for row in statuses() if row.code == code]:
            yield from ("As printed:", "", *(f"* {sentence}" for sentence in said), "")
        for title, sentences in (("Causes", found.causes), ("Cures", found.cures)):
            yield from (f"**{title}**", "", *(f"* {sentence}" for sentence in sentences), "")
        if found.snippet:
            yield from ("These lines provoke it:", "", "```python", "import zerodrift as zd", "", found.snippet, "```", "")


def first_clause(meaning: str) -> str:
    return meaning.split("; ")[0].rstrip(".")


KINDS = {
    "Linkages": ("four_bar", "hoecken", "chebyshev_lambda", "watt", "peaucellier", "pantograph", "stephenson", "jansen", "klann", "bennett"),
    "Machines": ("slider_crank", "spatial_slider_crank", "quick_return", "toggle_press", "scissor_lift", "cam_follower", "planetary_gear",
                 "hookes_joint", "double_cardan", "flyball_governor", "andrews", "geneva", "anchor_escapement", "trebuchet"),
    "Vehicles": ("quarter_car", "suspension", "double_wishbone", "bicycle", "whipple_bicycle", "snakeboard", "compass_gait"),
    "Robots": ("delta_robot", "stewart_platform"),
    "Tops and rolling": ("heavy_top", "gyroscope", "rolling_disc", "coin", "rattleback"),
    "Many bodies": ("closed_pendulum", "four_bars", "chain"),
}
PLAYING = """<script>
(() => {
const still = matchMedia("(prefers-reduced-motion: reduce)").matches, play = (card, on) => card.querySelector("iframe").contentWindow.postMessage({zerodrift: "play", on}, "*");
const seen = matchMedia("(hover: none)").matches && !still ? new IntersectionObserver(all => all.forEach(each => play(each.target, each.isIntersecting)), {threshold: 0.95}) : null;
document.querySelectorAll(".films a").forEach(card => {
  seen?.observe(card);
  for (const [event, on] of [["pointerenter", true], ["focus", true], ["pointerleave", false], ["blur", false]]) card.addEventListener(event, () => play(card, on));
});
})();
</script>"""


def films(folder: Path) -> Iterable[tuple[str, Iterable[str]]]:
    """The gallery, and a page for each model; films are files of their own, which are made anew when the package has changed."""
    (folder / "extra" / "films").mkdir(parents=True, exist_ok=True)
    (folder / "extra" / "films" / "player.js").write_text(player(), encoding="utf-8")
    live.write_leg(folder / "extra" / "live")
    kept = folder / "graphs.json"
    known = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {}
    shown = {each.name: each for each in gallery.exhibits()}
    for exhibit in shown.values():
        path = folder / "extra" / "films" / f"{exhibit.name}.html"
        if not live.is_current(path) or exhibit.name not in known:
            sol = exhibit.run()
            known[exhibit.name] = plotted(sol)
            live.write_live(exhibit, known[exhibit.name], folder / "extra" / "live" / path.name)
            film = zd.view(sol, path=list(exhibit.path), speed=exhibit.speed, graphs=known[exhibit.name])
            path.write_text(film.linked("player.js"), encoding="utf-8")
            kept.write_text(json.dumps(known), encoding="utf-8")
        yield f"models/{exhibit.name}", model(exhibit, known)
    yield "gallery", [
        "# Gallery", "", f"{len(shown)} mechanisms; films play when pointed at, on a telephone when they are seen.", "",
        *(line for kind, names in KINDS.items() for line in (f"## {kind}", "", "```{raw} html", '<div class="films">',
            *(card(f"models/{name}", f"../films/{name}", shown[name].title, shown[name].see, shown[name].see) for name in names), "</div>", "```", "")),
        "```{raw} html", PLAYING, "```", "", "```{toctree}", ":hidden:", "", *(f"models/{name}" for name in shown), "```"]


def plotted(sol: zd.Solution) -> list[str]:
    """The measure that a page plots: what drives the mechanism, the force of a joint, or a coordinate, the first that changes."""
    names = [name for name in sol.measures if not name.startswith("ground.")]
    driving = [name for name in names if name.endswith(".torque") and sol[name].ndim == 1 and abs(sol[name]).max() > 1e-9]
    forces = [name for name in names if name.endswith(".force")]
    found = [*reversed(driving), *forces, sol.system.coordinates[0].name]
    return [next((name for name in found if np.ptp(sol[name], axis=0).max() > max(1e-9, 1e-3 * abs(sol[name]).max())), found[0])]


TURNING = " The view is turned by dragging beside it, or by Shift with the arrow keys."
LIVE = """## Simulated on this page

Sliders change lengths, springs, masses, gravity and motors. A point that is dragged takes the mechanism along, as by a spring, in space parallel to
the screen; `n` chooses a part for the arrow keys.{turning} A length with which it cannot close is refused, and so is pulling what a motor holds.
Below it are the position violation and the energy error of the run; the core simulates in the browser.

```{{raw}} html
<iframe src="../../live/{name}.html" title="{title}, simulated" loading="lazy"
style="width:100%;height:560px;border:0"></iframe>
{board}```
"""
BOARD = '<p><a href="../{address}">Open in the drawing board</a>, to change it: with uniform links, as drawn.</p>\n'


def model(exhibit: gallery.Exhibit, graphs: dict[str, str]) -> Iterable[str]:
    """The page of a model: film with a plot, lines, simulation, the mechanism in words, sources of its numbers, code."""
    made, name, graph = getattr(zd.models, exhibit.name), exhibit.name, graphs[exhibit.name][0]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        words = str(exhibit.made())
    text = inspect.cleandoc(made.__doc__ or "")
    path = f", path={list(exhibit.path)}" if exhibit.path else ""
    on_board = boards.boarded(exhibit.made())
    board = BOARD.format(address=boards.address(on_board)) if on_board else ""
    shown = f"zd.view(sol, speed={exhibit.speed:g}{path}, graphs=[{graph!r}])".replace("'", '"')
    yield from (f"# {exhibit.title}", "", exhibit.see, "", f"Beside it: `{graph}`.", "", "```{raw} html", f'<iframe src="../../films/{name}.html" '
                f'title="Film: {html.escape(exhibit.see)}" allowfullscreen style="width:100%;height:460px;border:0"></iframe>', "```", "",
                "```python", "import zerodrift as zd", "", *exhibit.lines[:-1], shown, "```", "",
                LIVE.format(name=name, title=exhibit.title, board=board, turning=TURNING if exhibit.made().dimension == 3 else ""), "## The mechanism", "",
                text.split("\n\n")[0], "", "```text", words, "```", "")
    if "References\n----------" in text:
        source = text.split("References\n----------\n")[1].split("\nExamples\n")[0].strip()
        yield from ("## Source of its numbers", "", source, "")
    yield from ("## Its code", "", "```python", exhibit.source, "```", "")


TASKS = {
    "Build": "Mechanism linkage load System symbolic native from_mechanics table Structure",
    "Simulate": "simulate Run ManyRuns Event every Solution Instant view explore",
    "Find states and forces": "assemble equilibrium equilibria kinematics trace reach inverse_dynamics flywheel linearize transmission_angle",
    "Vary and choose": "ensemble grid tune work_precision reference stability_map check",
    "Methods": "formulations integrators corrections Projection Baumgarte EnergyCorrection",
    "Use elsewhere": "fmu c_source block record_size get_include numba_signature",
    "Terms of the equations": "mass_matrix bias jacobian acceleration project",
}


def reference() -> Iterable[str]:
    """Public names, each with a page of its own."""
    plots = [f"plot.{name}" for name in zd.plot.__all__ if inspect.isroutine(getattr(zd.plot, name))]
    yield from ("# Reference", "", "By task; `help(zd)` has the function to begin with for each.", "")
    public = [each.__name__ for each in (*ERRORS, *WARNINGS) if hasattr(zd, each.__name__)]
    known = {*public, *(name for names in TASKS.values() for name in names.split())}
    others = [name for name in zd.__all__ if name not in known and (inspect.isroutine(getattr(zd, name)) or inspect.isclass(getattr(zd, name)))]
    tasks = [(title, names.split()) for title, names in TASKS.items()]
    for title, names in (*tasks, ("Others", others), ("Plots", plots), ("Errors and warnings", public)):
        if not names:
            continue
        yield from (f"## {title}", "", "```{eval-rst}", ".. autosummary::", "   :toctree: api", "   :nosignatures:", "")
        yield from (f"   ~zerodrift.{name}" for name in names)
        yield from ("```", "")
    yield from ("## Modules", "", "```{eval-rst}")
    for module in (zd.systems, zd.compare, zd.inertia):
        yield from (f".. module:: {module.__name__}", "", f"**{module.__name__}**", "", inspect.cleandoc(module.__doc__ or ""), "")
    yield from (".. currentmodule:: zerodrift.studies.compare", "", ".. autofunction:: difference", "", ".. autofunction:: signals", "```", "")
