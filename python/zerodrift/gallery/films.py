"""Small films of exhibits: animated PNG files, which browsers play and which have no loss; others show the first picture."""

from __future__ import annotations

import io

import numpy as np
from matplotlib.animation import FuncAnimation
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from .._private import checks
from ..plot import animate
from ..runs.samples.solution import Solution
from ..runs.shapes_of_samples import moments_of
from .exhibits import Exhibit

COLOURS = 24            # of a film's palette
DPI = 72
SAMPLES = 4             # frames from which the palette is taken


def film(exhibit: Exhibit, *, frames: int = 16, width: int = 240, height: int = 180, solution: Solution | None = None) -> bytes:
    r"""An exhibit as an animated PNG file.

    Parameters
    ----------
    exhibit : Exhibit
    frames : int
        Number of pictures.
    width, height : int
        In pixels.
    solution : Solution, optional
        Its motion, where that is known already.

    Returns
    -------
    bytes

    Examples
    --------
    >>> from zerodrift import gallery
    >>> gallery.film(gallery.exhibit("watt"), frames=2)[:4]
    b'\x89PNG'
    """
    checks.instance("exhibit", exhibit, Exhibit, "an Exhibit, as exhibit(name) returns it")
    frames = checks.count("frames", frames, least=2)
    width, height = checks.count("width", width, least=40), checks.count("height", height, least=40)
    solution = exhibit.run() if solution is None else solution
    figure = Figure(figsize=(width / DPI, height / DPI), dpi=DPI, layout="constrained")
    canvas = FigureCanvasAgg(figure)
    span = float(solution.t[-1] - solution.t[0])
    ax = figure.add_subplot(projection="3d" if moments_of(solution, solution.p[:1])[0][0].points.shape[1] == 3 else None)
    moving = animate(solution, fps=frames / span * exhibit.speed, speed=exhibit.speed, ax=ax, path=exhibit.path)
    ax.set_axis_off()           # at this size the mechanism needs the room
    pictures = [_picture(canvas, moving, i) for i in range(frames)]
    return _together(pictures, milliseconds=1000 * span / exhibit.speed / frames)


def _picture(canvas: FigureCanvasAgg, moving: FuncAnimation, frame: int) -> Image.Image:
    # A writer of matplotlib calls this for each frame, and would draw it at full colour.
    moving._func(frame)         # type: ignore[attr-defined]
    canvas.draw()
    canvas.figure.set_layout_engine("none")     # the first picture's is kept: axes stay in place, and it takes most of the time
    return Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")


def _together(pictures: list[Image.Image], milliseconds: float) -> bytes:
    """One file with one palette."""
    width, height = pictures[0].size
    sample = Image.new("RGB", (width, SAMPLES * height))
    for i in range(SAMPLES):
        sample.paste(pictures[i * (len(pictures) - 1) // (SAMPLES - 1)], (0, i * height))
    palette = sample.quantize(COLOURS)
    colours = np.array(palette.getpalette()).reshape(-1, 3)
    colours[colours.min(axis=1) > 245] = 255        # paper stays white, and is not the mean of all that is nearly white
    reduced = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    for picture in reduced:
        picture.putpalette(colours.ravel().tolist())
    file = io.BytesIO()
    reduced[0].save(file, format="PNG", save_all=True, append_images=reduced[1:], duration=milliseconds, loop=0, optimize=True)
    return file.getvalue()
