"""Errors on velocities that contradict each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...errors import InconsistentStart

MAX_LISTED = 8           # largest number of names in a sentence
ANGLES = "angle", "angle1", "angle2"


def contradiction(left: np.ndarray, size: np.ndarray, names: Sequence[str], rows: Sequence[str]) -> Exception:
    """The error that names whose velocities contradict each other, or the joints that do not leave one its velocity.

    What is left over weighs rows so that the weighted sum of them vanishes and that of their right sides does not: rows with
    a weight are those that contradict each other. `names` are what rows ask a velocity for, and `rows` what they belong to.
    """
    least = 1e-3 * np.abs(left).max()
    worst = [int(i) for i in np.argsort(-np.abs(left)) if abs(left[i]) > least]
    moved = list(dict.fromkeys(names[i] for i in worst if names[i]))
    if len(moved) > 1:
        velocities, off = _listed(moved, " and "), np.abs(left * size).max()
        held = next((f": all but one must be left out, or approached only, as by wish={{{name!r}: ...}}" for name in moved
                     if "." in name), "")
        return InconsistentStart(f"start: the velocities of {velocities} contradict each other, by {off:.3g}{held}")
    row = max((i for i, name in enumerate(names) if name), key=lambda i: abs(left[i]))
    off = left @ left / abs(left[row]) * size[row] if row in worst else 0.0      # of this row, where all others are met
    residual = f"; it is off by {off:.3g}" if off else ""
    joints = _listed(sorted({rows[i] for i in worst if not names[i]}), ", ")
    blocking = f"the joints {joints} do" if joints else "the mechanism does"
    return InconsistentStart(f"start: {names[row]!r} asks for a velocity that {blocking} not allow in this pose{residual}. "
                             "At a dead centre, start a little aside, or drive another joint")


def unit_of(name: str) -> str:
    """Unit of a held measure; "" for drives and couplings, whose names have no quantity, and for cosines."""
    quantity = name.split(".")[1:]
    if not quantity or quantity[-1].endswith("]"):
        return ""
    return "rad" if quantity[-1] in ANGLES else "m"


def _listed(names: Sequence[str], between: str) -> str:
    """List of names, shortened after the first few."""
    others = [f"{len(names) - MAX_LISTED} others"] if len(names) > MAX_LISTED else []
    return between.join([*map(repr, names[:MAX_LISTED]), *others])
