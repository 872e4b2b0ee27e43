"""Motion of a mechanism with one degree of freedom as a curve: held measures replace its drives."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from .._private import checks
from .._private.gateway.mechanisms.geometry import Component, Geometry
from ..errors import SingularSystem, WrongValue
from ..mechanisms.assembly.assembly import Assembly
from ..mechanisms.assembly.start import Starting, size_of
from ..mechanisms.building.start_verbs import targets
from ..mechanisms.elements.forces import Actuator, Motor
from ..mechanisms.elements.measures import name_of
from ..mechanisms.equations.measure_names import checked_reading
from ..mechanisms.equations.measure_tables import measuring
from ..mechanisms.equations.tables import Tables
from ..mechanisms.system import MechanismSystem
from .curve import ZERO_SLOPE, Curve, Knot

DEPENDENT = 1e-9        # of the largest singular value: what counts as dependent
SMALLEST = 1e-3         # of the largest row: what counts as the size of a smaller one
MOTORS = (Motor, Actuator)


class Motion:
    """Curve of a mechanism's positions, and its starting point.

    Parameters
    ----------
    system : MechanismSystem
    measure : str
        A scalar measure of positions.
    hold : dict of str to float
        Measures that keep a value.
    """

    def __init__(self, system: MechanismSystem, measure: str, hold: Any) -> None:
        self.system, self.measure = system, measure
        self._drawing, self._numbers = system._drawing, system._numbers
        self._check_scalar("measure", measure)
        held = self._held(hold)
        self._starting = Starting(self._drawing, self._numbers)
        poses = self._poses(held)
        self.tables = Tables(self._drawing, self._numbers, in_tree=True, starts=self._starting.drives)
        self.core = measuring(self.tables, [*held, measure])
        self.start = self.core.state(poses)[0]
        self.curve = self._curve(held)
        self.knot = self._first_knot()

    @property
    def is_angle(self) -> bool:
        """True if the measure is an angle, which may make full turns."""
        return self.unit == "rad"

    @property
    def unit(self) -> str:
        """The unit of the measure."""
        return next(row.unit for row in self.core.measures if self.measure in (row.name, f"{row.name}.x", f"{row.name}.y"))

    def turns(self) -> np.ndarray:
        """Mask of the coordinates that are angles."""
        return np.array([coordinate.kind == "angle" for coordinate in self.core.motions], dtype=bool)

    def coordinates(self, x: np.ndarray, slopes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Points of the curve (k, n) and their derivatives by the measure in the coordinates of the system, (k, nq) each."""
        core, found = self.system._interpreted, []
        if self.system.layout == "joint":
            return x * self.curve.scale, slopes * self.curve.scale
        is_finite = np.isfinite(slopes).all(axis=1)
        for place, slope in zip(x * self.curve.scale, np.where(is_finite[:, None], slopes, 0.0) * self.curve.scale, strict=True):
            found.append(core.state(*self.core.poses(place, slope)))
        p, rates = (np.array(each).reshape(len(x), core.nq) for each in zip(*found, strict=True))
        return p, np.where(is_finite[:, None], rates, np.inf)

    # ---- what is held ----

    def _check_scalar(self, what: str, name: str) -> None:
        read = checked_reading(what, name, None, self._drawing.elements)
        if read.is_rate:
            raise WrongValue(f"{what} must be a measure of positions, and {name!r} is one of velocities", "wrong-measure")
        if len(read.quantities) != 1:
            raise WrongValue(f"{what} must be a scalar, and {name!r} has components: {name}.x and {name}.y", "wrong-measure")

    def _held(self, hold: Any) -> dict[str, float | None]:
        """Held measures and their values by name; None: the value at the start."""
        if isinstance(hold, Mapping):
            held: dict[str, Any] = targets(hold, "hold")
        else:
            each = (hold,) if isinstance(hold, str) or not isinstance(hold, Iterable) else hold
            held = {name_of(one, "hold"): None for one in each}
        for name, value in held.items():
            self._check_scalar("hold", name)
            if value is not None and np.ndim(value):
                raise WrongValue(f"hold[{name!r}] must be a number, not {checks.shown(value)}")
        return held

    def _poses(self, held: dict[str, float | None]) -> np.ndarray:
        """Initial poses, moved so that held measures have their values; drives are left out."""
        _, assembly, p = self._starting.closed(0.0)
        given = {name: value for name, value in held.items() if value is not None}
        if given:
            tables = Tables(self._drawing, self._numbers, in_tree=False, starts=self._starting.drives)
            core = measuring(tables, list(given))
            driven = _driven(self._drawing, tables, core)
            names = [tables.joints[row.number].name if row.owner == "joint" else tables.relation_names[row.number]
                     for row in core.rows]
            p = Assembly(core, names, driven, assembly.length, 0.0).led_to(p, self._starting.targets(given, core))
        return assembly.core.poses(p)[0]

    # ---- the curve ----

    def _curve(self, held: dict[str, float | None]) -> Curve:
        core = self.core
        driven = set(_driven(self._drawing, self.tables, core))
        kept = [row for row in range(core.mh) if row not in driven]
        scale = np.where(self.turns(), 1.0, size_of(self._drawing, self._numbers))
        components = [_component(core, name) for name in (*held, self.measure)]
        values, rows = Geometry(core, kept, components)(self.start)
        target = np.append(np.zeros(len(kept)), [value if given is None else given for value, given
                                                 in zip(values[len(kept):-1], held.values(), strict=True)])
        size = np.linalg.norm(rows * scale, axis=1)
        size = np.maximum(size, SMALLEST * size.max(initial=0.0))
        independent = self._independent((rows * scale / np.where(size > 0, size, 1.0)[:, None])[:-1], len(kept), list(held))
        chosen = Geometry(core, [kept[i] for i in independent if i < len(kept)],
                          [components[i - len(kept)] for i in independent if i >= len(kept)] + components[-1:])
        return Curve(chosen, target[independent], scale, size[[*independent, -1]])

    def _independent(self, rows: np.ndarray, count: int, held: list[str]) -> list[int]:
        """Indices of independent constraints; an error if these do not leave one degree of freedom."""
        basis, found = np.zeros((0, rows.shape[1])), list[int]()
        for i, row in enumerate(rows):
            left = row - basis.T @ (basis @ row)
            left -= basis.T @ (basis @ left)
            if (size := np.linalg.norm(left)) > DEPENDENT:
                basis, found = np.vstack([basis, left / size]), [*found, i]
        freedom = rows.shape[1] - len(found)
        if freedom != 1:
            raise SingularSystem(self._not_one(freedom, held))
        return found

    def _not_one(self, freedom: int, held: list[str]) -> str:
        without = " without its motors" if self._drawing.of(MOTORS) else ""
        also = f", and {', '.join(map(repr, held))} held" if held else ""
        if freedom < 1:
            return f"{self._drawing.name} has no freedom{without}{also}: nothing moves that could be traced"
        more = freedom - 1
        named = [f"{motor.joint.name}.{motor.joint.coordinate}" for motor in self._drawing.of(Motor)]
        named += [variable.name for variable in self.system.coordinates if "." in variable.name]
        open_to = [name for name in dict.fromkeys(named) if name not in (*held, self.measure)]
        return (f"{self._drawing.name} has {freedom} freedoms{without}{also} in this position, and positions by {self.measure!r} "
                f"are determined where there is one: hold {more} measure{'s' * (more > 1)} more, such as "
                f"hold={open_to[:more]} where they are, or {{{open_to[0]!r}: value}}")

    def _first_knot(self) -> Knot:
        """First knot: the start, with the tangent along which the measure grows."""
        x = self.start / self.curve.scale
        _, rows, _, row = self.curve.evaluate(x)
        tangent = np.linalg.svd(rows)[2][-1] if len(rows) else np.ones(1)
        knot = self.curve.knot(x, tangent)
        if knot is None:
            raise SingularSystem(f"{self._drawing.name} is in a position in which its constraints do not determine how it moves: "
                                 "start it a little aside")
        if np.linalg.norm(row) < ZERO_SLOPE or abs(knot.slope) < 1e-9 * np.linalg.norm(row):
            return knot._replace(slope=0.0)
        return knot if knot.slope > 0 else knot.reversed()


def _driven(drawing: Any, tables: Tables, core: Any) -> list[int]:
    """The holonomic rows of motors and actuators."""
    drives = {motor.name for motor in drawing.of(MOTORS)}
    return [i for i, row in enumerate(core.rows[: core.mh])
            if row.owner == "relation" and tables.relation_names[row.number] in drives]


def _component(core: Any, name: str) -> Component:
    """Index of a scalar measure and its component."""
    index = {row.name: i for i, row in enumerate(core.measures)}
    base, _, axis = name.rpartition(".")
    return Component(index[name], 0) if name in index else Component(index[base], "xy".index(axis))
