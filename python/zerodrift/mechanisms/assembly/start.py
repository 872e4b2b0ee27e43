"""Start of a mechanism: positions and velocities assembled from the drawing, held and wished values, and drives."""

from __future__ import annotations

import copy
import functools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..._private.gateway.mechanisms.blocks import BlockCore, of_joints
from ..._private.gateway.mechanisms.core import MechanismCore
from ..._private.gateway.mechanisms.space import SpaceCore
from ..._private.rotations import COMPONENTS, quaternion_of
from ...errors import CorrectionFailed, InconsistentStart, SingularSystem, sentence
from ..elements import columns
from ..elements.drawing import Drawing
from ..elements.forces import Motor
from ..elements.joints import Coupling
from ..elements.numbers import Numbers
from ..equations.measure_names import checked_reading, is_rate
from ..equations.measure_tables import read
from ..equations.space_tables import SpaceTables, tables_of
from ..equations.tables import Tables
from ..equations.tree import ends, loop
from .assembly import Assembly, Rates, Target, is_of_many
from .drawing_changes import DrawingChanges
from .drive_starts import Conditions, DriveStarts, drawn_targets, drive_starts, driven_coordinate, speed_drives
from .free_coordinates import Unforced, bodies_of, names_of, swings, unforced
from .nudge import aside, way_out
from .reference_motion import motion_of_drives
from .space_advice import of_angles
from .start_checks import check_directions

MASSLESS = 1e-13        # of the largest mass: bound below which a motion has none


class Starting:
    """Start of a mechanism, in poses of mass centres; `tables` are those of the drawing, if they exist already."""

    def __init__(self, drawing: Drawing, numbers: Numbers, tables: Tables | None = None) -> None:
        self.drawing, self.numbers, self._known = drawing, numbers, tables
        self.has_speeds = bool(drives_of(drawing))
        self.changes: DrawingChanges | None = None      # of the last assembly, if a joint was open
        self._stays: Unforced | None = None
        self._drive_starts: dict[float, DriveStarts] = {}       # by time
        self._assemblies: dict[Any, tuple[Tables, Assembly]] = {}
        self._check_held()

    def with_values(self, held: Mapping[str, Any]) -> Starting:
        """The same start with other values of what it holds; tables and assemblies are kept, if these do not depend on them."""
        drawing = self.drawing._replace(held=dict(held))
        if self.has_speeds or held.keys() != self.drawing.held.keys():
            return Starting(drawing, self.numbers, self._known)
        other = copy.copy(self)
        other.drawing = drawing
        for name in ("is_relative", "has_mass"):
            vars(other).pop(name, None)
        return other

    def _check_held(self) -> None:
        for what, given in (("start", self.drawing.held), ("wish", self.drawing.wished)):
            for name, value in given.items():
                checked_reading(what, name, value, self.drawing.elements)

    @functools.cached_property
    def is_relative(self) -> bool:
        """True if start velocities at t = 0 depend on the motions of driven bodies."""
        return self.velocities(*self.closed(0.0)[1:]).is_relative

    @property
    def drives_by_name(self) -> list[str]:
        """Coordinates driven at constant speed."""
        return [driven_coordinate(motor) for motor in drives_of(self.drawing)]

    def drive_starts(self, t: float) -> DriveStarts:
        """Coordinates driven by speeds that keep their drawn values; those of drives of constant speed do at t = 0."""
        t = 0.0 if self.has_speeds else t
        if t not in self._drive_starts:
            tables = self._tables({})
            assembly = self._assembly(tables, t, without_speeds=True)
            conditions = self._conditions(tables, assembly)
            self._drive_starts[t] = drive_starts(speed_drives(self.drawing), assembly, conditions)
        return self._drive_starts[t]

    def moved_drives(self, t: float) -> str | None:
        """Sentence on drives of speeds whose coordinates cannot keep their drawn values; None without such drives."""
        drives = self.drive_starts(t).unmet
        if not drives:
            return None
        names = " and ".join(repr(motor.name) for motor in drives)
        places = " and ".join(f"{driven_coordinate(motor)} = 0" for motor in drives)
        return (f"drive {names} of {self.drawing.name!r} must start as drawn, at {places}, where the joints cannot close, and "
                "the start moves it: draw it where they can, or hold a coordinate of its loop by start()")

    @functools.cached_property
    def drives(self) -> dict[str, float]:
        """Values at t = 0 of the coordinates that motors of constant speed drive."""
        if not self.has_speeds:
            return {}
        tables, names = self._tables({}), self.drives_by_name
        assembly = self._assembly(tables, 0.0, without_speeds=True)
        p = self._positions(tables, assembly, self.drive_starts(0.0).drawn)
        index = {row.name: i for i, row in enumerate(assembly.core.measures)}
        zero = np.zeros(assembly.core.nv)
        return {name: float(assembly.core.measure_at(index[name], 0.0, p, zero)["value"][0]) for name in names}

    @functools.cached_property
    def has_mass(self) -> bool:
        """True if every motion has inertia at t = 0, in the drawn pose."""
        try:
            self.assembled(0.0)
        except (CorrectionFailed, InconsistentStart, SingularSystem):
            return False
        return True

    def assembled(self, t: float) -> tuple[Assembly, np.ndarray]:
        """Assembly at a time, and the positions that it found.

        Drives of constant speed count from t = 0, and so does then what is held: from there they lead to their places at t.
        """
        tables, assembly, p = self.closed(t)
        self._check_mass(tables, assembly, p)
        return assembly, p

    def closed(self, t: float) -> tuple[Tables, Assembly, np.ndarray]:
        """Tables, assembly and positions at a time, also if something moves without mass."""
        if t not in self._assemblies:
            tables = self._tables(self.drives)
            self._assemblies[t] = tables, self._assembly(tables, t)
        (tables, assembly), drawn = self._assemblies[t], self.drive_starts(t).drawn
        if t and self.has_speeds:
            by_functions = drawn_targets([name for name in drawn if name not in self.drives], assembly.core)
            staying = self._staying(assembly.core, "positions")
            return tables, assembly, assembly.led_to(self.closed(0.0)[2], by_functions, staying)
        return tables, assembly, self._positions(tables, assembly, drawn)

    def at(self, t: float, *, nudge: float = 0.0) -> tuple[np.ndarray, ...]:
        """Poses (bodies, 3) of the mass centres at a time, and their rates; nudged as far as asked for.

        In space poses are (bodies, 7), and the angles of joints come third.
        """
        tables, assembly, p = self.closed(t)
        self._check_mass(tables, assembly, p)
        if nudge:
            p = aside(assembly, p, nudge, self.targets(self.drawing.held, assembly.core, rates=True))
        poses = assembly.core.poses(p, self.velocities(assembly, p).v)
        check_directions(tables, poses[0], assembly.length)
        return (*poses, core.angles(p)) if isinstance(core := assembly.core, SpaceCore) else poses

    def velocities(self, assembly: Assembly, p: np.ndarray) -> Rates:
        """Velocities at p: with the held and wished values, the nearest in kinetic energy to those that drives alone give.

        As velocities of least energy are linear in values, these are the former ones and the difference of two of least energy.
        """
        alone, given = self._velocities_of_drives(assembly, p), self._rates_of_start(assembly.core)
        if not any(given):
            return alone
        staying = self._staying(assembly.core, "rates")
        if not alone.v.any():
            return Rates(assembly.velocities(p, *given, staying))
        held, wished, staying = (assembly.with_rates_of(p, alone.v, each) for each in (*given, staying))
        v = assembly.velocities(p, *given, staying)
        kept = staying if assembly.meets(p, v, staying) else ()
        found = assembly.changed(v, alone.v - assembly.velocities(p, held, wished, kept))
        return Rates(found, alone.is_relative or found is not v)

    def _velocities_of_drives(self, assembly: Assembly, p: np.ndarray) -> Rates:
        """Velocities at p without values of the start: of least kinetic energy relative to the motion of what drives carry."""
        staying = self._staying(assembly.core, "rates_of_drives")
        v = assembly.velocities(p, (), (), staying)
        if is_of_many(assembly.core) or not v.any():
            return Rates(v)
        free = assembly.undetermined(p, v, (), staying)
        return Rates(assembly.nearest(p, v, free, motion_of_drives(assembly, p, v)), True) if free.shape[1] else Rates(v)

    def undetermined(self, assembly: Assembly, p: np.ndarray) -> np.ndarray:
        """Basis (nv, k) of velocities that neither constraints nor values of the start determine."""
        held, wished = self._rates_of_start(assembly.core)
        return assembly.undetermined(p, np.zeros(assembly.core.nv), [*held, *wished])

    def _rates_of_start(self, core: MechanismCore) -> tuple[list[Target], list[Target]]:
        """Held and wished rates."""
        held, wished = (self.targets(given, core, rates=True) for given in (self.drawing.held, self.drawing.wished))
        return held, wished

    def way_out(self) -> str:
        """Advice for a singular start: a nudge, if that leads to a regular pose that the drives allow."""
        assembly, p = self.assembled(0.0)
        held = self.targets(self.drawing.held, assembly.core, rates=True)
        return way_out(assembly, p, held)

    def _tables(self, starts: Mapping[str, float]) -> Tables:
        if self._known is None or starts:
            return tables_of(self.drawing, self.numbers, in_tree=False, starts=starts)
        return self._known.absolute()

    def _assembly(self, tables: Tables, t: float, *, without_speeds: bool = False) -> Assembly:
        """Assembly at a time, optionally without drives of constant speed; it measures what drives of speeds move."""
        staying = [each for coordinates in self._unforced(tables) for each in coordinates]
        speeds = map(driven_coordinate, speed_drives(self.drawing))
        measured = [*self.drawing.held, *self.drawing.wished, *speeds, *names_of(staying)]
        quantities, observed = read(tables, measured)
        more, of_swings = swings(tables, dict.fromkeys(staying), len(quantities))
        core = tables.core([*quantities, *more], [*observed, *of_swings]) if measured else tables.core()
        names = [tables.joints[row.number].name if row.owner == "joint" else tables.relation_names[row.number]
                 for row in core.rows]
        motors = {motor.name for motor in drives_of(self.drawing)} if without_speeds else set()
        left_out = [i for i, row in enumerate(core.rows) if row.owner == "relation" and names[i] in motors]
        linear = {each.name for each in self.drawing.of(Coupling) if each.law is None}
        couplings = {i for i, row in enumerate(core.rows) if row.owner == "relation" and names[i] in linear}
        return Assembly(core, names, left_out, size_of(self.drawing, self.numbers), t, couplings)

    def _conditions(self, tables: Tables, assembly: Assembly) -> Conditions:
        p, _ = assembly.core.state(self._drawn(tables))
        held, wished = (self.targets(given, assembly.core, rates=False) for given in (self.drawing.held, self.drawing.wished))
        return Conditions(p, held, wished, self._staying(assembly.core, "positions"))

    def _positions(self, tables: Tables, assembly: Assembly, drawn: Sequence[str]) -> np.ndarray:
        """Positions from the drawing, in which the driven coordinates `drawn` keep their values."""
        conditions = self._conditions(tables, assembly)
        try:
            found = assembly.positions(*conditions, drawn_targets(drawn, assembly.core))
            changes = DrawingChanges(tables, assembly, found)
            self.changes = changes if changes.may_be_open else None
            return found
        except CorrectionFailed:
            raise CorrectionFailed(self._not_closed(assembly, conditions.p)) from None
        except InconsistentStart as error:
            raise InconsistentStart(f"{sentence(error)}{self._loop_in_words(tables, assembly, conditions.p)}") from None

    def _unforced(self, tables: Tables) -> Unforced:
        if self._stays is None:
            self._stays = unforced(self.drawing, tables)
        return self._stays

    def _staying(self, core: MechanismCore, of: str) -> list[Target]:
        """Targets that keep free coordinates as drawn, or their rates at zero; positions get their values later."""
        index = {row.name: i for i, row in enumerate(core.measures)}
        targets = []
        for each in getattr(self._stays, of, ()):
            measure = index[each.position if of == "positions" else each.rate]
            components = range(core.measures[measure].size) if each.axis is None else ["xyz".index(each.axis)]
            targets += [Target(each.position, measure, i, 0.0) for i in components]
        return targets

    def _drawn(self, tables: Tables) -> np.ndarray:
        """Poses of mass centres as drawn, with held rotations applied, as small steps cannot turn a body by half a turn."""
        poses = tables.drawn()
        for name, value in self.drawing.held.items():
            body, _, quantity = name.partition(".")
            if quantity == "rotation":
                poses[tables.number[body] - 1, 3:] = quaternion_of(value @ tables.inertias.of[body].axes)
        return poses

    def targets(self, given: Mapping[str, Any], core: MechanismCore, *, rates: bool = False) -> list[Target]:
        """Components of the held or wished positions or velocities."""
        if not given:
            return []
        index = {row.name: i for i, row in enumerate(core.measures)}
        targets = []
        for name, value in given.items():
            if is_rate(name, self.drawing.elements) != rates:
                continue
            base, _, axis = name.rpartition(".")
            if name in index:
                targets += [Target(_component(name, i, np.shape(value)), index[name], i, float(each))
                            for i, each in enumerate(np.ravel(value))]
            else:
                component = COMPONENTS[core.measures[index[base]].size].index(axis)
                targets.append(Target(name, index[base], component, float(value)))
        return targets

    # ---- diagnosis ----

    def _not_closed(self, assembly: Assembly, p: np.ndarray) -> str:
        """Loop that does not close, and its gap: in joint coordinates only joints that close loops are open. In space, and with
        many bodies, the joints that stay open in absolute coordinates.
        """
        tables, many = self._tables({}), is_of_many(assembly.core)
        if many:
            p = assembly.least_open(p)
        elif self.drawing.dimension == 2:
            tables = Tables(self.drawing, self.numbers, in_tree=True)
            p = tables.core().state(assembly.core.poses(p)[0])[0]
        block = of_joints(tables.written(), [each.name for each in (*tables.parts, *tables.joints)])
        return BlockCore(block).gaps_in_words(p, are_smallest=many)

    def _loop_in_words(self, tables: Tables, assembly: Assembly, p: np.ndarray) -> str:
        """Loop of something held or driven; in space, shafts that keep the angles of a universal joint."""
        if isinstance(tables, SpaceTables):
            return of_angles(tables, assembly.core, p, [*self.drawing.held])
        tables = Tables(self.drawing, self.numbers, in_tree=True)
        owners = [self.drawing.elements[name.partition(".")[0]] for name in self.drawing.held]
        owners += [motor.joint for motor in self.drawing.of(Motor)]
        meant = {body.name for owner in owners for body in bodies_of(owner)}
        pairs = [ends(joint, tables.number) for joint in tables.joints]
        cuts = set(range(len(pairs))) - set(tables.inboard)
        for joint in sorted(cut for cut in cuts if not tables.joints[cut].is_of_one_body):
            description, bodies = _around(tables, *loop(tables.inboard, pairs, joint))
            if meant & bodies - {"ground"}:
                return f"; in {description}"
        return ""

    def _check_mass(self, tables: Tables, assembly: Assembly, p: np.ndarray) -> None:
        """Check that every motion has inertia, or is held."""
        if all(tables.inertias.is_massive(body) for body in tables.parts):
            return
        M, free = assembly.free_motions(p)
        if not free.shape[1]:
            return
        weights, motions = np.linalg.eigh(free.T @ M @ free)
        if weights[0] > MASSLESS * max(np.abs(M).max(), 1e-300):
            return
        motion = np.abs(free @ motions[:, 0])
        moved = {assembly.core.motions[i].body for i in np.flatnonzero(motion > 1e-6 * motion.max())}
        names = ", ".join(repr(tables.parts[body - 1].name) for body in sorted(moved))
        raise SingularSystem(f"{names} can move without moving any mass: give it mass and inertia, or hold it by a joint")


def _around(tables: Tables, bodies: Sequence[int], joints: Sequence[int]) -> tuple[str, set[str]]:
    """Name of a loop, and the names of its bodies."""
    parts = ["ground", *(body.name for body in tables.parts)]
    around, through = [parts[body] for body in bodies], [tables.joints[i].name for i in sorted(joints)]
    return f"the loop of {', '.join(around)}, through {', '.join(through)}", set(around)


def _component(name: str, i: int, shape: tuple[int, ...]) -> str:
    """Name of one component of a held number, vector or matrix."""
    return name if not shape else f"{name}.{'xyz'[i]}" if len(shape) == 1 else f"{name}[{i // 3}, {i % 3}]"


def size_of(drawing: Drawing, numbers: Numbers) -> float:
    """Size of a drawing: the longest side of the box around its points, in m; 1 without extent."""
    places = [point.drawn_with(numbers) for point in drawing.joined_points()] + [body.pose.origin for body in drawing.parts()]
    size = columns.longest_side(places) if places else 0.0
    return size or 1.0


def drives_of(drawing: Drawing) -> list[Motor]:
    """Motors of constant speed."""
    return [motor for motor in speed_drives(drawing) if motor.law.constant is not None]
