"""Pages that are written to files and opened in the browser: films and live views."""

from __future__ import annotations

import functools
import html
import re
import tempfile
import webbrowser
from importlib import resources
from pathlib import Path

from .._private.writing import with_suffix, write_atomically


class Page:
    """An HTML page in one file; subclasses make `page`."""

    name: str       # of its temporary file

    @property
    def page(self) -> str:
        """The HTML page."""
        raise NotImplementedError

    def save(self, path: str | Path) -> Path:
        """Write the page to an HTML file, which needs no other file and no network; the suffix ``.html`` is added."""
        path = with_suffix(path, ".html")
        write_atomically(path, lambda file: file.write(self.page.encode()))
        return path

    def show(self) -> None:
        """Open the page in the browser, from a temporary file."""
        folder = Path(tempfile.mkdtemp(prefix="zerodrift-"))
        webbrowser.open(self.save(folder / self.name).as_uri())


POLICY = ("default-src 'none'; script-src 'self' 'unsafe-inline' 'wasm-unsafe-eval'; style-src 'unsafe-inline'; "
          "img-src data: blob:")


def document(name: str, style: str, body: str) -> str:
    """A page with its name, style and body, which loads nothing but scripts beside it."""
    styles = re.sub(r" *([{};,]) *", r"\1", text("colours.css") + text(style)).replace(": ", ":").replace(";}", "}")
    return (f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>{html.escape(name)}</title>'
            f'<meta http-equiv="Content-Security-Policy" content="{POLICY}"><meta name="viewport" content="width=device-width">'
            f'<style>{styles}</style></head><body>{body}</body></html>')


@functools.cache
def text(name: str) -> str:
    """A file of the player, without indentation and comments."""
    source = resources.files(__package__).joinpath(name).read_text(encoding="utf-8")
    return re.sub(r"^\s+|\s*/\*[\s\S]*?\*/|(^|[ ]{2,})// .*$", "", source, flags=re.MULTILINE)
