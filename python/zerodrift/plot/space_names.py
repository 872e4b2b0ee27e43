"""Names in axes that show space, moved up or down where they would cover each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.text import Text
from matplotlib.transforms import ScaledTranslation
from mpl_toolkits.mplot3d import proj3d

LINE = 1.35         # height of a line of text, in units of its font
LETTER = 0.62       # width of a letter, in the same units
LINES = 12          # by so many lines a name is moved at most


def keep_apart(ax: Axes, texts: Sequence[Text]) -> None:
    """Shift texts by whole lines of the picture as it is seen from where the axes look; they keep that when the view turns."""
    placed: list[tuple[float, float, float, float]] = []
    pixels = ax.figure.dpi / 72
    projection = ax.get_proj()
    for text in sorted((each for each in texts if each.get_visible()), key=lambda each: -_seen(ax, each, projection)[1]):
        x, y = _seen(ax, text, projection)
        height = LINE * text.get_fontsize() * pixels
        width = LETTER * text.get_fontsize() * pixels * len(text.get_text())
        free = (k for k in _shifts() if not any(_overlap((x, y + k * height, width, height), other) for other in placed))
        shift = next(free, 0)
        placed.append((x, y + shift * height, width, height))
        text.set_transform(ax.transData + ScaledTranslation(0, shift * height / ax.figure.dpi, ax.figure.dpi_scale_trans))


def _seen(ax: Axes, text: Text, projection: np.ndarray) -> np.ndarray:
    """Lower left corner (2,) of a text, in pixels."""
    x, y, _ = proj3d.proj_transform(*text.get_position_3d(), projection)
    return ax.transData.transform((x, y))


def _shifts() -> list[int]:
    """0, -1, 1, -2, 2 and so on."""
    return [0, *(sign * k for k in range(1, LINES) for sign in (-1, 1))]


def _overlap(one: tuple[float, float, float, float], other: tuple[float, float, float, float]) -> bool:
    return all(one[i] < other[i] + other[i + 2] and other[i] < one[i] + one[i + 2] for i in (0, 1))
