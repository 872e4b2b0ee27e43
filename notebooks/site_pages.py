"""Pages of the site that are made from tables of the package: methods, joints and forces, errors, models, reference."""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Iterable
from pathlib import Path

import zerodrift as zd
from zerodrift import errors
from zerodrift._gateway.base import statuses
from zerodrift.explanations import classes, explanations
from zerodrift.mechanisms.elements.joints import JOINTS
from zerodrift.mechanisms.elements.table_forces import ELEMENTS

WARNINGS = tuple(each for each in vars(errors).values() if inspect.isclass(each) and issubclass(each, Warning))
ERRORS = tuple(each for each in vars(errors).values() if inspect.isclass(each) and issubclass(each, zd.ZerodriftError))


def write(folder: Path) -> None:
    """Write all of them; a file that would not change is left as it is."""
    folder.mkdir(exist_ok=True)
    pages = {"formulations": methods("Formulations", zd.formulations()), "integrators": methods("Integrators", zd.integrators()),
             "corrections": methods("Corrections", zd.corrections()), "elements": elements(), "errors": messages(),
             "models": models(), "reference": reference()}
    for name, lines in {"front.html": front(), **{f"{page}.md": text for page, text in pages.items()}}.items():
        path, text = folder / name, "\n".join(lines) + "\n"
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def front() -> Iterable[str]:
    """The film of the first page: what the code above it computes."""
    sol = zd.simulate(zd.models.jansen(), 6.0, step=0.01)
    yield zd.view(sol, path="F", forces=["Y bed", "W"], graphs=["F.position.y"])._repr_html_()


def methods(title: str, rows: dict[str, object]) -> Iterable[str]:
    """The rows of a table of methods, with their parameters."""
    yield from (f"# {title}", "")
    for name, row in rows.items():
        yield from (f"## {name}", "", row.summary, "", " ".join(row.description.split()), "")
        if row.equations:
            yield from (f"Equations: {row.equations}", "")
        if row.reference:
            yield from (f"Source: {row.reference}", "")
        if row.parameters:
            yield from ("| parameter | initially | meaning |", "|---|---|---|")
            yield from (f"| `{each.name}` | {', '.join(f'{value:g}' for value in each.initial)} | {each.text} |" for each in row.parameters)
            yield ""


def elements() -> Iterable[str]:
    """Joints and force elements, with the verbs that make them."""
    yield from ("# Joints and forces", "", "Verbs of {py:class}`zerodrift.Mechanism`; `help(m.revolute)` has their arguments.", "")
    for title, table in (("Joints in the plane", JOINTS), ("Force elements", ELEMENTS)):
        yield from (f"## {title}", "", "| verb | effect |", "|---|---|")
        yield from (f"| `{name}` | {(row.row if hasattr(row, 'row') else row).card.summary} |" for name, row in table.items())
        yield ""


def messages() -> Iterable[str]:
    """Errors and warnings by code: meaning, the core's sentences, causes, cures, and lines that provoke it."""
    yield from ("# When it stops", "", "A message ends with a code, such as `[zd:branch-jump]`, which `error.code` holds. "
                "`python -m zerodrift explain branch-jump` prints the section below it.", "",
                "Errors of the package are {py:class}`zerodrift.ZerodriftError`; most carry the solution up to the place where it "
                "stopped, as `error.solution`. Wrong arguments are `ValueError` and `TypeError`, whose message states the rule, the value "
                "and a hint.", "")
    codes, explained = classes(), explanations()
    yield from ("| code | class | meaning |", "|---|---|---|")
    yield from (f"| [`{code}`](#{code}) | `{each.__name__}` | {first_sentence(each)} |" for code, each in codes.items())
    for code, each in codes.items():
        found = explained[code]
        yield from ("", f"({code})=", f"## {code}", "", f"`zerodrift.{each.__name__}`. " + inspect.cleandoc(each.__doc__ or "").split("\n\n")[0], "")
        if said := [row.sentence for row in statuses() if row.error == each.__name__]:
            yield from ("As printed:", "", *(f"* {sentence}" for sentence in said), "")
        for title, sentences in (("Causes", found.causes), ("Cures", found.cures)):
            yield from (f"**{title}**", "", *(f"* {sentence}" for sentence in sentences), "")
        if found.snippet:
            yield from ("These lines provoke it:", "", "```python", "import zerodrift as zd", "", found.snippet, "```", "")


def first_sentence(cls: type) -> str:
    return " ".join(inspect.cleandoc(cls.__doc__ or "").split("\n\n")[0].split()).split("; ")[0].rstrip(".")


def models() -> Iterable[str]:
    """All models with the first lines of their documentation, and their mechanism in words."""
    yield from ("# Models", "", "Each is a function of `zerodrift.models`, whose arguments are lengths, masses and springs.", "")
    for name in sorted(each for each in dir(zd.models) if not each.startswith("_") and callable(getattr(zd.models, each))):
        model = getattr(zd.models, name)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            made = model()
        first = inspect.cleandoc(model.__doc__ or "").split("\n\n")[0]
        yield from (f"## {name}", "", first, "", "```text", str(made), "```", "")


def reference() -> Iterable[str]:
    """Public names, each with a page of its own."""
    functions = [name for name in zd.__all__ if inspect.isroutine(getattr(zd, name))]
    classes = [name for name in zd.__all__ if inspect.isclass(getattr(zd, name)) and getattr(zd, name) not in (*ERRORS, *WARNINGS)]
    plots = [f"plot.{name}" for name in zd.plot.__all__ if inspect.isroutine(getattr(zd.plot, name))]
    yield from ("# Reference", "")
    public = [each.__name__ for each in (*ERRORS, *WARNINGS) if hasattr(zd, each.__name__)]
    for title, names in (("Functions", functions), ("Classes", classes), ("Plots", plots), ("Errors and warnings", public)):
        yield from (f"## {title}", "", "```{eval-rst}", ".. autosummary::", "   :toctree: api", "")
        yield from (f"   zerodrift.{name}" for name in names)
        yield from ("```", "")
    yield from ("## Modules", "", "```{eval-rst}")
    for module in (zd.systems, zd.compare, zd.inertia):
        yield from (f".. module:: {module.__name__}", "", f"**{module.__name__}**", "", inspect.cleandoc(module.__doc__ or ""), "")
    yield from (".. currentmodule:: zerodrift.compare", "", ".. autofunction:: difference", "", ".. autofunction:: signals", "```", "")
