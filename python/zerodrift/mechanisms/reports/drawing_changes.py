"""Differences between a drawing and the start that is assembled from it, in words."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..assembly.assembly import Assembly

NAMED = 1e-3            # of the mechanism's length, or rad: smaller differences come from rounded numbers
MOST_NAMED = 8          # bodies or joints in a line, at most


def differences(tables: Any, assembly: Assembly, p: np.ndarray) -> list[str]:
    """Sentences on joints that are drawn open and bodies that start elsewhere than drawn, by more than a thousandth."""
    drawn, _ = assembly.core.state(tables.drawn())
    lines = (("drawn open, and closed at the start (m, or rad)", _open_joints(assembly, drawn)),
             ("moved from the drawing", _moved(tables, assembly, p, drawn)))
    return [f"{what}: {_listed(changes)}" for what, changes in lines if changes]


def _open_joints(assembly: Assembly, drawn: np.ndarray) -> list[str]:
    if not assembly.core.mh:
        return []
    Phi = assembly.core.evaluate_stored(assembly.t, drawn, np.zeros(assembly.core.nv))["Phi"]
    open_by: dict[str, float] = {}
    for row, name, value in zip(assembly.core.rows, assembly.rows, Phi, strict=False):
        if row.owner == "joint":
            open_by[name] = float(np.hypot(open_by.get(name, 0.0), value))
    return [f"{name!r} by {by:.3g}" for name, by in _largest(open_by) if by > NAMED * assembly.length]


def _moved(tables: Any, assembly: Assembly, p: np.ndarray, drawn: np.ndarray) -> list[str]:
    places, angles = (_by_body(tables, assembly, assembly.core.apart(p, drawn), is_angle) for is_angle in (False, True))
    least = {name: max(by / assembly.length, angles.get(name, 0.0)) for name, by in places.items()}
    changes = []
    for name, by in _largest({**angles, **least}):
        if by > NAMED:
            amounts = [f"{amount:.3g} {unit}" for amount, unit, size in (
                (places.get(name, 0.0), "m", assembly.length), (angles.get(name, 0.0), "rad", 1.0)) if amount > NAMED * size]
            changes.append(f"{name!r} by {' and '.join(amounts)}")
    return changes


def _by_body(tables: Any, assembly: Assembly, apart: np.ndarray, is_angle: bool) -> dict[str, float]:
    """Norm of the difference of each body's angle or position."""
    found: dict[str, float] = {}
    for each, value in zip(assembly.core.motions, apart, strict=True):
        if (each.kind == "angle") == is_angle:
            name = tables.parts[each.body - 1].name
            found[name] = float(np.hypot(found.get(name, 0.0), value))
    return found


def _largest(amounts: dict[str, float]) -> list[tuple[str, float]]:
    return sorted(amounts.items(), key=lambda each: -each[1])


def _listed(changes: list[str]) -> str:
    others = [f"{len(changes) - MOST_NAMED} others"] if len(changes) > MOST_NAMED else []
    return ", ".join([*changes[:MOST_NAMED], *others])
