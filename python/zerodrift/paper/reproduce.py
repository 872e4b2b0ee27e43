"""Figures 4-9 and the table of claims, in a folder."""

from __future__ import annotations

import functools
import operator
from pathlib import Path

from matplotlib.figure import Figure

from .._private.writing import write_atomically
from ..runs.simulate import simulate
from . import FOUR_BAR, FOUR_BAR_REFERENCE, OSCILLATOR, claims, figures, run

FORMATS = ("png", "svg")
DPI = 150


def compute() -> tuple[dict[str, Figure], list[claims.Claim]]:
    """All figures by the name of their file, and all claims."""
    fine = simulate(FOUR_BAR.system, FOUR_BAR.end, closed_form=False, **FOUR_BAR_REFERENCE)
    bar, oscillator = run(FOUR_BAR), run(OSCILLATOR)
    pictures = {
        "figure_4": figures.figure_4(fine),
        "figure_5": figures.figure_5(fine),
        "figure_6": figures.figure_6(bar),
        "figure_7": figures.figure_7(bar),
        "figure_8": figures.figure_8(oscillator),
        "figure_9": figures.figure_9(oscillator),
        "four_bar": figures.figure_of_costs(bar, figures.costs()),
    }
    measured = [*claims.figure_5(fine), *claims.figure_6(bar), *claims.figure_7(bar), *claims.figure_8(oscillator),
                *claims.figure_9(oscillator)]
    return pictures, measured


def reproduce(folder: Path) -> str:
    """Write the figures (PNG and SVG) and the claims (text and CSV) into a folder.

    Parameters
    ----------
    folder : Path
        Made if it does not exist.

    Returns
    -------
    str
        The table of claims.

    Raises
    ------
    OSError
        If the folder cannot be made or written to.
    """
    folder.mkdir(parents=True, exist_ok=True)
    pictures, measured = compute()
    for name, figure in pictures.items():
        for suffix in FORMATS:
            write_atomically(folder / f"{name}.{suffix}", functools.partial(figure.savefig, format=suffix, dpi=DPI))
            figure.set_layout_engine("none")    # the first file laid it out, which takes longer than all else here
    table = claims.as_text(measured)
    for name, content in ("claims.txt", table), ("claims.csv", claims.as_csv(measured)):
        write_atomically(folder / name, operator.methodcaller("write", content.encode()))
    return table
