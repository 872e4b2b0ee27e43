"""Progress of a run, shown by a bar or passed to a callable."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..errors import MissingPackage, WrongType


def progress_of(progress: Any) -> tuple[Callable[[float], None], Callable[[], None]]:
    """Two functions for the argument `progress` of `simulate`: show the completed fraction (0 ... 1), and close the display."""
    if progress is False or progress is None:
        return (lambda part: None), (lambda: None)
    if callable(progress):
        return progress, (lambda: None)
    if progress is not True:
        raise WrongType(f"progress must be True, False or a callable, not {progress!r}")
    try:
        from tqdm.auto import tqdm
    except ImportError:
        raise MissingPackage("progress=True shows a bar with tqdm, which is not installed: pip install tqdm") from None
    bar = tqdm(total=1.0, bar_format="{percentage:3.0f}%|{bar}| {elapsed}<{remaining}")

    def show(part: float) -> None:
        bar.n = part
        bar.refresh()

    return show, bar.close
