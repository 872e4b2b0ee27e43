"""Loads of a solution: the resultant on the ground, and the maximum reaction of each joint."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ... import units
from ..._private import checks
from ..._private.types import ArrayLike, Display, MeasureLike
from ...errors import WrongName, WrongType
from .columns import imported


class GroundLoad(NamedTuple):
    """Force (k, 2) or (k, 3) in N on the ground, and its moment (k,) or (k, 3) about a point in N m."""

    force: np.ndarray
    torque: np.ndarray


class Load(NamedTuple):
    """The maximum magnitude of a joint's force or moment, in N or N m; `angle` of the crank in rad, NaN without one.

    `is_unique` is False if redundant constraints leave a component undetermined; its minimum norm is taken.
    """

    joint: str
    quantity: str
    magnitude: float
    t: float
    angle: float
    is_unique: bool


class Loads:
    """Table of the maximum reactions, `Solution.loads`; it prints itself in the units of display.

    Attributes
    ----------
    rows : list of Load
        In SI units, the force of each joint and, where it transmits one, its moment.
    crank : str or None
    """

    def __init__(self, rows: list[Load], crank: str | None) -> None:
        self.rows, self.crank, self._display = rows, crank, dict(units.chosen())

    def __getitem__(self, joint: str) -> dict[str, Load]:
        """Loads of a joint by "force" and "moment"."""
        found = {row.quantity: row for row in self.rows if row.joint == getattr(joint, "name", joint)}
        if not found:
            raise WrongName(f"no joint is called {joint!r}; {checks.closest(str(joint), [row.joint for row in self.rows])}",
                            "wrong-name")
        return found

    def to_frame(self) -> Any:
        """The table as a pandas DataFrame in the units of display, which column names have."""
        pandas = imported("pandas", "to_frame", "excel")
        heading, *cells = self._cells()
        return pandas.DataFrame(cells, columns=heading)

    def _cells(self) -> list[list[Any]]:
        with units.display_units(self._display):
            time, angle = units.shown("s"), units.shown("rad")
            crank = [f"{self.crank} [{angle.unit}]"] if self.crank else []
            found: list[list[Any]] = [["joint", "quantity", "maximum", "unit", f"t [{time.unit}]", *crank, "unique"]]
            for row in self.rows:
                of = units.shown("N" if row.quantity == "force" else "N m")
                found.append([row.joint, row.quantity, row.magnitude * of.factor, of.unit, row.t * time.factor,
                              *([row.angle * angle.factor] if self.crank else []), row.is_unique])
        return found

    def __repr__(self) -> str:
        heading, *rows = self._cells()
        table = [[*heading[:-1], ""], *([*(f"{each:.6g}" if isinstance(each, float) else str(each) for each in row[:-1]),
                                         "" if row[-1] else "not unique: minimum norm"] for row in rows)]
        widths = [max(map(len, column)) for column in zip(*table, strict=True)]
        return "\n".join("  ".join(each.ljust(width) for each, width in zip(row, widths, strict=True)).rstrip() for row in table)


class Loaded:
    """Loads, as methods of a solution."""

    def ground_load(self: Any, about: ArrayLike | None = None) -> GroundLoad:
        """Resultant on the ground: of joints, springs, and forces without a body against which they act.

        It is the weight of the mechanism less the rate of its momentum, so that redundant constraints leave it unique.

        Parameters
        ----------
        about : array_like (2,) or (3,), optional
            Point of the drawing in m that the moment is about; left out: the origin.

        Returns
        -------
        GroundLoad
            `force` (k, 2) or (k, 3) in N, ``sol["ground.force"]``; and `torque` (k,) or (k, 3) in N m, about the origin
            ``sol["ground.torque"]``.

        Raises
        ------
        KeyError
            If the system is not a mechanism, or its gravity is a function.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("pendulum", gravity=(0, -9.81))
        >>> link = m.link("link", (0, 0), (1, 0), mass=1.0)
        >>> pin = m.revolute("pin", m.ground, link.start)
        >>> load = zd.simulate(m, 1.0, step=0.01).ground_load(about=(0, 0))
        >>> float(load.force[0, 1].round(6)), float(abs(load.torque).max().round(6))
        (-2.4525, 0.0)
        """
        force, torque = self["ground.force"], self["ground.torque"]
        if about is None:
            return GroundLoad(force, torque)
        size = force.shape[1]
        at = np.append(checks.vector("about", about, size), 0.0)[:3]
        moved = np.cross(at, np.pad(force, ((0, 0), (0, 3 - size))))
        return GroundLoad(force, torque - (moved[:, 2] if size == 2 else moved))

    @units.displayed
    def loads(self: Any, crank: MeasureLike | None = None, *, display: Display | None = None) -> Loads:
        """The maximum force and moment of each joint at the samples, with the time.

        Parameters
        ----------
        crank : measure or str, optional
            An angle that becomes a column of the table, such as ``"main.angle"``.
        display : dict of str to str, optional
            Units by quantity, as in `zerodrift.display_units`; left out: those of the session.

        Returns
        -------
        Loads

        Raises
        ------
        TypeError
            If the system is not a mechanism.

        Examples
        --------
        >>> import zerodrift as zd
        >>> sol = zd.simulate(zd.models.slider_crank(), 1.0, step=0.01)
        >>> print(sol.loads("crank.angle", display={"angle": "deg"}))       # doctest: +ELLIPSIS
        joint  quantity  maximum  unit  t [s]  crank.angle [deg]
        main   force     ...
        """
        names = getattr(self.system._watching.core if self.measures else None, "joint_forces", None)
        if names is None:
            raise WrongType(f"loads must be of a mechanism, and {self.system.name!r} is not one")
        angle = np.full(len(self.t), np.nan) if crank is None else self[crank]
        rows = []
        for name in names:
            joint = name.rpartition(".")[0]
            for quantity, measure in (("force", name), ("moment", f"{joint}.torque")):
                if measure in self.measures:
                    size = np.linalg.norm(self[measure].reshape(len(self.t), -1), axis=1)
                    i = int(np.argmax(size))
                    rows.append(Load(joint, quantity, float(size[i]), float(self.t[i]), float(angle[i]),
                                     bool(np.all(self.unique(measure)))))
        return Loads(rows, None if crank is None else getattr(crank, "name", str(crank)))
