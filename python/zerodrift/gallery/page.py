"""The gallery as files: a film of every model, and a page that shows them."""

from __future__ import annotations

import html
from pathlib import Path

from .._private.writing import write_atomically
from .exhibits import Exhibit, exhibits
from .films import film

FRAMES, WIDTH, HEIGHT = 40, 400, 300

PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>zerodrift: models in motion</title>
<style>
body {{ font: 16px/1.45 system-ui, sans-serif; color: #222; max-width: 1320px; margin: 2em auto; padding: 0 1em; }}
main {{ display: grid; grid-template-columns: repeat(auto-fill, minmax(360px, 1fr)); gap: 2em; }}
h1 {{ font-weight: 600; }} h2 {{ font-size: 1.1em; margin: 0 0 .3em; }}
img {{ width: 100%; height: auto; border: 1px solid #ddd; background: #fff; }}
pre {{ font-size: 12px; line-height: 1.35; background: #f6f6f6; padding: .8em; overflow-x: auto; margin: .5em 0; }}
summary {{ cursor: pointer; color: #555; font-size: .9em; }}
</style>
</head>
<body>
<h1>Models in motion</h1>
<p>{count} models of <code>zerodrift.models</code>, each simulated by the lines below its picture.
<code>import zerodrift as zd</code> comes first.</p>
<main>
{figures}
</main>
</body>
</html>
"""

FIGURE = """<section id="{name}">
<h2>{title}</h2>
<img src="{name}.png" alt="{see}" width="{width}" height="{height}">
<p>{see}</p>
<pre>{lines}</pre>
<details><summary>the model</summary><pre>{source}</pre></details>
</section>"""


def write(folder: str | Path, *, frames: int | None = None, names: list[str] | None = None) -> Path:
    """Write the films, ``<model>.png``, and the page ``index.html`` that shows them.

    Parameters
    ----------
    folder : str or Path
        It is made where it is missing.
    frames : int, optional
        Pictures of each film; left out: forty.
    names : list of str, optional
        Names of models; left out: all.

    Returns
    -------
    Path
        Path of the page.

    Raises
    ------
    OSError
        If the folder cannot be written to.

    Examples
    --------
    >>> import tempfile
    >>> from zerodrift import gallery
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     gallery.write(folder, frames=2, names=["watt"]).name
    'index.html'
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    shown = [each for each in exhibits() if names is None or each.name in names]
    for each in shown:
        _write(folder / f"{each.name}.png", film(each, frames=frames or FRAMES, width=WIDTH, height=HEIGHT))
    page = folder / "index.html"
    _write(page, PAGE.format(count=len(shown), figures="\n".join(map(_figure, shown))).encode())
    return page


def _write(path: Path, content: bytes) -> None:
    write_atomically(path, lambda file: file.write(content))


def _figure(exhibit: Exhibit) -> str:
    said = {"title": exhibit.title, "see": exhibit.see, "lines": "\n".join(exhibit.lines), "source": exhibit.source}
    return FIGURE.format(name=exhibit.name, width=WIDTH, height=HEIGHT, **{key: html.escape(text) for key, text in said.items()})
