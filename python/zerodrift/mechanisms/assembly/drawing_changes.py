"""Differences between a drawing and the start that is assembled from it, in words."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ..elements.bodies import Body, Link, Particle
from ..elements.drawing import Drawing
from ..elements.joints import Joint
from ..elements.numbers import AS_GIVEN, Numbers
from ..equations.measure_names import constraint_names
from .assembly import Assembly
from .sketches import is_sketch, loop_of

NAMED = 1e-3            # of the drawing's extent, or rad: smaller differences come from rounded numbers
OPEN = 1e-2             # of the same: gaps of joints beyond the precision of a drawing
MAX_NAMED = 8          # bodies or joints in a line, at most
MAX_WARNED = 3         # bodies in a warning, at most


class DrawingChanges:
    """Changes of a drawing by the assembly of its start.

    Parameters
    ----------
    tables : Tables
    assembly : Assembly
    p : ndarray (nq,)
        Positions that it found.
    """

    def __init__(self, tables: Any, assembly: Assembly, p: np.ndarray) -> None:
        self._tables, self._assembly, self._p = tables, assembly, p
        self._extent = extent_of(tables.drawing, tables.numbers)
        self._drawn, _ = assembly.core.state(tables.drawn())
        rest = np.zeros(assembly.core.nv)
        found = assembly.core.evaluate_states(("Phi",), np.array([assembly.t]), self._drawn, rest)
        self._Phi = found["Phi"][0] if found else np.zeros(0)

    @property
    def may_be_open(self) -> bool:
        """False if no joint is open by more than a hundredth; found without names."""
        return bool(np.abs(self._Phi).max(initial=0.0) > OPEN / 2 * min(self._extent, 1.0))

    def sentences(self) -> list[str]:
        """Sentences on joints that are drawn open and bodies that start elsewhere than drawn, by more than a thousandth."""
        lines = (("drawn open, and closed at the start (m, or rad)", self._open_joints()),
                 ("moved from the drawing", self._moved()))
        return [f"{what}: {listed(changes)}" for what, changes in lines if changes]

    def warning(self, also_held: Iterable[str] = ()) -> str | None:
        """Sentence on the joint that is drawn open most, by more than a hundredth, and is not part of a sketch; None without it.

        `also_held` are names of coordinates that are held besides those of the drawing.
        """
        for joint, gap in sorted(self._gaps().items(), key=lambda each: -self._size(each[1])):
            if self._size(gap) <= OPEN:
                return None
            if not is_sketch(self._tables, loop_of(self._tables, joint), also_held):
                return (f"joint {self._tables.joints[joint].name!r} of {self._tables.drawing.name!r} is drawn open by "
                        f"{self._in_words(gap)}, and to close it the start moves {', '.join(self._moved()[:MAX_WARNED])}: "
                        f"{self._remedy(self._tables.joints[joint])}, or if it is a sketch, give a length= or hold a coordinate "
                        "of its loop by start()")
        return None

    def _remedy(self, joint: Joint) -> str:
        """Advice to draw a joint closed, or to place its bodies that are drawn at the origin, with points in their own frames."""
        points = (each for each in (joint.first, joint.second) if each.body is not self._tables.drawing.ground)
        unplaced = [repr(each.body.name) for each in points if _is_unplaced(each.body) and np.any(each.local_with(AS_GIVEN))]
        if not unplaced:
            return "draw it closed"
        named = " and ".join(unplaced)
        return f"give {named} a place by at=, as points such as body.point((x, y)) are in the frame of their body"

    # ---- joints ----

    def _gaps(self) -> dict[int, dict[str, float]]:
        """Gap of each joint by unit, m and rad."""
        gaps: dict[int, dict[str, float]] = {}
        core = self._assembly.core
        for row, variable, value in zip(core.rows, constraint_names(self._tables, core), self._Phi, strict=False):
            if row.owner == "joint":
                gap = gaps.setdefault(row.number, {"m": 0.0, "rad": 0.0})
                gap[variable.unit] = float(np.hypot(gap[variable.unit], value))
        return gaps

    def _size(self, gap: dict[str, float]) -> float:
        return max(gap["m"] / self._extent, gap["rad"])

    def _open_joints(self) -> list[str]:
        open_by = {self._tables.joints[joint].name: float(np.hypot(gap["m"], gap["rad"])) for joint, gap in self._gaps().items()}
        return [f"{name!r} by {by:.3g}" for name, by in _largest(open_by) if by > NAMED * self._extent]

    def _in_words(self, amounts: dict[str, float]) -> str:
        """Amounts by unit that are more than rounded numbers."""
        unit = {"m": self._extent, "rad": 1.0}
        return " and ".join(f"{amount:.3g} {name}" for name, amount in amounts.items() if amount > NAMED * unit[name])

    # ---- bodies ----

    def _moved(self) -> list[str]:
        """Bodies that start elsewhere than drawn, the most moved first."""
        apart = self._assembly.core.apart(self._p, self._drawn)
        places, angles = (self._by_body(apart, is_angle) for is_angle in (False, True))
        changes = {name: {"m": places.get(name, 0.0), "rad": angles.get(name, 0.0)} for name in {**angles, **places}}
        size = {name: self._size(change) for name, change in changes.items()}
        return [f"{name!r} by {self._in_words(changes[name])}" for name, by in _largest(size) if by > NAMED]

    def _by_body(self, apart: np.ndarray, is_angle: bool) -> dict[str, float]:
        """Norm of the difference of each body's angle or position."""
        found: dict[str, float] = {}
        for each, value in zip(self._assembly.core.motions, apart, strict=True):
            if (each.kind == "angle") == is_angle:
                name = self._tables.parts[each.body - 1].name
                found[name] = float(np.hypot(found.get(name, 0.0), value))
        return found


def extent_of(drawing: Drawing, numbers: Numbers) -> float:
    """Extent of a drawing: the diagonal of the box around its bodies, links and joints, in m; 1 without extent."""
    ends = [point for link in drawing.of(Link) for point in (link.start, link.end)]
    places = [point.drawn_with(numbers) for point in (*drawing.joined_points(), *ends)]
    places += [body.pose.origin for body in drawing.parts()]
    return float(np.linalg.norm(np.ptp(places, axis=0))) or 1.0


def _is_unplaced(body: Body) -> bool:
    """True for a body whose frame is that of the drawing, as without at=."""
    return not isinstance(body, Link | Particle) and not np.any(body.pose.origin)


def _largest(amounts: dict[str, float]) -> list[tuple[str, float]]:
    return sorted(amounts.items(), key=lambda each: -each[1])


def listed(changes: list[str]) -> str:
    """The first ones, and the number of others."""
    others = [f"{len(changes) - MAX_NAMED} others"] if len(changes) > MAX_NAMED else []
    return ", ".join([*changes[:MAX_NAMED], *others])
