"""Names in pictures of mechanisms, moved up or down where they would cover each other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.text import Text
from matplotlib.transforms import ScaledTranslation
from mpl_toolkits.mplot3d import Axes3D, proj3d

LINE = 1.35         # height of a line of text, in units of its font
LETTER = 0.62       # width of a letter, in the same units
LINES = 12          # by so many lines a name is moved at most
ABOVE = 1e4         # z-order of names in space: above surfaces, which matplotlib numbers by their depth


def keep_apart(ax: Axes, texts: Sequence[Text]) -> None:
    """Shift overlapping texts by whole lines of the picture as seen; in space the shift stays when the view turns."""
    placed: list[tuple[float, float, float, float]] = []
    projection = ax.get_proj() if isinstance(ax, Axes3D) else None
    if projection is None:
        ax.apply_aspect()
    boxes = [(text, _box(ax, text, projection)) for text in texts if text.get_visible()]
    for text, (x, y, width, height) in sorted(boxes, key=lambda each: -each[1][1]):
        step = height / len(text.get_text().split("\n"))
        free = (k for k in _shifts() if not any(_overlap((x, y + k * step, width, height), other) for other in placed))
        shift = next(free, 0)
        placed.append((x, y + shift * step, width, height))
        text.set_transform(ax.transData + ScaledTranslation(0, shift * step / ax.figure.dpi, ax.figure.dpi_scale_trans))


def _box(ax: Axes, text: Any, projection: np.ndarray | None) -> tuple[float, float, float, float]:
    """Lower left corner, width and height of a text before it is shifted, in pixels."""
    place = text.get_position() if projection is None else proj3d.proj_transform(*text.get_position_3d(), projection)[:2]
    x, y = ax.transData.transform(place)
    letter = text.get_fontsize() * ax.figure.dpi / 72
    lines = text.get_text().split("\n")
    width, height = LETTER * letter * max(map(len, lines)), LINE * letter * len(lines)
    left = {"left": 0.0, "center": 0.5, "right": 1.0}[text.get_horizontalalignment()]
    below = {"top": 1.0, "center": 0.5}.get(text.get_verticalalignment(), 0.0)
    return x - left * width, y - below * height, width, height


def _shifts() -> list[int]:
    """0, -1, 1, -2, 2 and so on."""
    return [0, *(sign * k for k in range(1, LINES) for sign in (-1, 1))]


def _overlap(one: tuple[float, float, float, float], other: tuple[float, float, float, float]) -> bool:
    return all(one[i] < other[i] + other[i + 2] and other[i] < one[i] + one[i + 2] for i in (0, 1))
