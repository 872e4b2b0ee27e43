"""The system of a mechanism: a snapshot, in joint or in absolute coordinates."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._private import checks, gateway
from .._private.gateway import CoreSystem, Variable
from .._private.gateway import is_length as is_length_of
from .._private.gateway.base import row_named
from .._private.gateway.compiled.precise import Precise
from .._private.gateway.mechanisms import law_inputs
from .._private.gateway.mechanisms.core import MechanismCore
from ..errors import WrongValue, ZerodriftError, sentence
from ..symbolics.compile.closed_form_library import CLOSED_FORM, ClosedFormFunctions
from ..systems.defaults import WithInputs
from ..systems.parameter_tables import NumberTables, refusals
from ..systems.shapes import Shape
from .assembly.start import Starting
from .assembly.variants import are_plain, varied
from .building.start_verbs import targets
from .elements.contacts import Latch
from .elements.drawing import Drawing
from .elements.forces import driven, inputs_of
from .elements.numbers import Numbers, checked, is_right, parameter_units
from .elements.space_bodies import SpaceInertias
from .equations.generated_code import Written, measure_program
from .equations.measure_names import constraint_names
from .equations.measure_tables import measuring
from .equations.space_tables import SpaceTables, tables_of
from .equations.tables import Tables
from .equations.tree import coordinate_names
from .files.to_json import described
from .pictures.arrows import acting, chosen
from .pictures.plane_outline import outline
from .pictures.plane_pose import Parts, at_moments
from .pictures.plane_shapes import sketches
from .pictures.space_outline import space_outline
from .pictures.space_pose import SpacePosed
from .pictures.space_shapes import space_sketches
from .reports import cost
from .reports.in_words import Reported

LAYOUTS = ("joint", "absolute")


class MechanismSystem(Reported):
    """Equations of a mechanism at the time of its creation; `Mechanism.system` makes it.

    It does not change any more, can be pickled unless a callable cannot, and knows all names of the mechanism.

    Attributes
    ----------
    layout : str
        "joint": coordinates are absolute angles and displacements along the tree of joints, and only joints that close loops are
        constraints. "absolute": position of the mass centre and angle of each body, and all joints are constraints.
    parameters : dict
        Every number by its path, such as ``"crank.mass"``, and the mechanism's own parameters.
    measures : tuple of str
        Names of the measures that ``sol[...]`` accepts.
    compiled : bool
        True: the equations are written out and compiled; False also where no compiler was found.
    """

    def __init__(self, drawing: Drawing, layout: str | None, changed: dict[str, float], compiled: bool | None = None,
                 closed_form: tuple[str, ClosedFormFunctions] | None = None, has_inputs: bool = False) -> None:
        self._drawing, self._changed, self.name = drawing, changed, drawing.name
        self._numbers = Numbers(changed)
        self._tables = tables_of(drawing, self._numbers, in_tree=layout != "absolute")
        self.layout = layout or ("joint" if compiled else cost.cost(self._tables).taken)
        if self.layout == "absolute":
            self._tables = self._tables.absolute()
        self._assembling = self._tables if drawing.free is drawing else tables_of(drawing.free, self._numbers,
                                                                                  in_tree=self.layout != "absolute")
        self._start = Starting(drawing.free, self._numbers, self._assembling)
        self._first_core = self._plain_core(self._tables)
        self._compiled = False if self._tables.groups else compiled
        self._given_closed_form, self._has_inputs = closed_form, has_inputs
        if self._compiled:
            self._check_written()
            self._written       # noqa: B018 - generates the code now

    @property
    def _is_written_out(self) -> bool:
        return bool(self._compiled)

    # These are computed at first use: for a hundred bodies they take longer than everything else.

    @functools.cached_property
    def parameters(self) -> dict[str, float]:
        return self._drawing.numbers(self._numbers) | self._changed

    @functools.cached_property
    def coordinates(self) -> tuple[Variable, ...]:
        if isinstance(self._tables, SpaceTables):
            return self._tables.coordinates()
        return tuple(position for position, _ in coordinate_names(self._tables, self._first_core))

    @functools.cached_property
    def velocities(self) -> tuple[Variable, ...]:
        if isinstance(self._tables, SpaceTables):
            return self._tables.velocities()
        return tuple(rate for _, rate in coordinate_names(self._tables, self._first_core))

    @functools.cached_property
    def constraints(self) -> tuple[Variable, ...]:
        return constraint_names(self._tables, self._first_core)

    @property
    def measures(self) -> tuple[str, ...]:
        return tuple(self._watching.known)

    _latches = property(lambda self: self._drawing.of(Latch))
    _groups = property(lambda self: [(group.name, group.kind) for group in self._tables.groups])

    def _plain_core(self, tables: Tables) -> MechanismCore:
        """Core system without measures, unless user functions read them."""
        return measuring(tables) if self._drawing.reactions() else tables.core()

    def _check_written(self) -> None:
        """Check that code can be generated: user functions must be no callables, and not read reactions."""
        if names := self._drawing.reactions():
            raise WrongValue(f"user functions of {self.name} must read no reactions or accelerations for equations to be written "
                             f"of them, and read {', '.join(names)}", "not-portable")
        self._tables.laws.check_written()

    @functools.cached_property
    def _measuring(self) -> MechanismCore:
        return measuring(self._started_tables)

    @functools.cached_property
    def _started_tables(self) -> Tables:
        """Tables with the initial positions of drives of constant speed."""
        if not self._start.has_speeds:
            return self._tables
        return tables_of(self._drawing, self._numbers, in_tree=self.layout == "joint", starts=self._start.drives)

    @functools.cached_property
    def _interpreted(self) -> MechanismCore:
        return self._plain_core(self._started_tables) if self._start.has_speeds else self._first_core

    @functools.cached_property
    def _core(self) -> MechanismCore:
        return self._written.core if self._is_written_out else self._interpreted

    # ---- generated code ----

    def _in_other_coordinates(self) -> MechanismSystem | None:
        other = MechanismSystem(self._drawing, "absolute" if self.layout == "joint" else "joint", self._changed)
        names = {variable.name for variable in (*self.coordinates, *self.velocities)}
        known = {*other.measures, *(variable.name for variable in (*other.coordinates, *other.velocities))}
        return other if names <= known and other.nv else None

    @property
    def _has_plain_laws(self) -> bool:
        return all(law.is_plain for law in self._drawing.laws)

    @property
    def compiled(self) -> bool:
        return self._is_written_out and self._written.is_compiled

    @functools.cached_property
    def _written(self) -> Written:
        return Written(self._interpreted, self._started_tables.laws, self._tables.parameters, self.name,
                       compiles=self._is_written_out, has_inputs=self._has_inputs)

    @functools.cached_property
    def _closed_form(self) -> tuple[str, ClosedFormFunctions]:
        """Closed-form functions and the name of their code; elimination orders are those of the system that this one was made
        from by changing numbers.
        """
        if self._given_closed_form is not None and self._given_closed_form[0] == self._written.key:
            return self._given_closed_form
        try:
            p0 = self.p0
        except ZerodriftError:      # a run from another start does not need this one
            p0 = None
        is_length = np.array([is_length_of(variable) for variable in (*self.coordinates, *self.velocities)])
        return self._written.key, self._written.closed_form_functions(p0, is_length)

    @functools.cached_property
    def _cores_with_closed_form(self) -> dict[tuple[str, bool], MechanismCore]:
        """Core systems by vector unit, and by whether they embed."""
        return {}

    def _closed_form_core(self, vector: str = "baseline", embeds: bool = False) -> MechanismCore:
        if not self.compiled and not self._takes_programs:
            return self._core
        cores, key = self._cores_with_closed_form, (vector if self.compiled else "", embeds)
        if key not in cores:
            functions = self._closed_form[1].embedding if embeds else self._closed_form[1]
            cores[key] = (self._written.with_closed_form(functions, vector) if self.compiled else
                          self._written.with_programs(functions))
        return cores[key]

    def _core_in_lanes(self, vector: str, embeds: bool = False) -> MechanismCore:
        core = self._closed_form_core(vector, embeds)
        if embeds or not self.compiled or not core.has_closed_form:
            return core
        library = self._closed_form[1].library_in_lanes(vector)
        return core if library is None else core.with_lanes(gateway.address_of(library, CLOSED_FORM), library)

    def _with_jacobian(self, core: CoreSystem, vector: str = "baseline") -> CoreSystem:
        return self._written.with_jacobian(vector) if self.compiled and core is self._core else core

    def _with_series(self, core: CoreSystem, vector: str = "baseline") -> CoreSystem:
        return self._written.with_series(vector) if self.compiled else core

    @property
    def _brings_series(self) -> bool:
        return self.compiled and not self._written.why_no_series

    def _precise_functions(self, vector: str = "baseline") -> Precise | None:
        return self._written.precise(vector) if self.compiled else None

    def _program_of(self, name: str) -> tuple[Any, list[int], np.ndarray] | None:
        return measure_program(self._started_tables, name)

    @functools.cached_property
    def _formulation(self) -> str:      # type: ignore[override]
        """As of any system; "augmented" where the mass matrix, which the default inverts, is singular at the start."""
        if self._tables.groups:
            return MechanismSystem(self._drawing.free, self.layout, self._changed, False)._formulation
        usual = super()._formulation
        if not all(self._tables.inertias.is_massive(body) for body in self._tables.parts):
            try:
                gateway.acceleration(self._core, row_named("formulations", usual), 0, 0.0, *self.start_at(0.0))
            except ZerodriftError as error:
                return "augmented" if error.code == "mass-not-definite" else usual
        return usual

    @property
    def _held_at_start(self) -> tuple[list[int], list[int]]:
        p, v = ([i for i, variable in enumerate(group) if variable.name in self._drawing.held]
                for group in (self.coordinates, self.velocities))
        return p, v

    def _compiled_for(self, steps: int) -> MechanismSystem | None:
        gains = self._compiled is None and self._gains_by_compiling(steps)
        return MechanismSystem(self._drawing, self.layout, self._changed, compiled=True) if gains else None

    def _by_matrices(self) -> MechanismSystem:
        return MechanismSystem(self._drawing, self.layout, self._changed, False) if self._compiled is None else self

    def _why_no_closed_form(self, embeds: bool = False) -> str | None:
        if not self.compiled and not self._takes_programs:
            return "compiled=False" if self._compiled is False else self._why_not_compiled() or None
        return (self._closed_form[1].embedding if embeds else self._closed_form[1]).why_none

    @functools.cached_property
    def p0(self) -> np.ndarray:
        """Initial coordinates of `simulate`, at t = 0."""
        return self.start_at(0.0)[0]

    @functools.cached_property
    def v0(self) -> np.ndarray:
        """Initial velocities of `simulate`, at t = 0."""
        return self.start_at(0.0)[1]

    @functools.lru_cache(maxsize=4)     # noqa: B019 - the cache lives as long as the system
    def start_at(self, t: float) -> tuple[np.ndarray, np.ndarray]:
        """Assembled start (p, v) at a time: held values and drives are satisfied, all else is nearest to the drawing."""
        p, v = self._interpreted.state(*self._start.at(t))
        if self._drawing.is_balanced:
            from ..analysis.equilibrium import balanced  # slow to import and rarely needed

            p, v = balanced(self, t, p, v)
        return checks.frozen(p), checks.frozen(v)

    def _assembled(self, held: Any, wish: Any, nudge: float, t: float) -> tuple[np.ndarray, np.ndarray]:
        """State at a time with held and wished values in addition to the mechanism's own start."""
        drawing = self._drawing.free
        more, wished = (targets(given, what, drawing.dimension) for given, what in ((held, "held"), (wish, "wish")))
        drawing = drawing._replace(held=drawing.held | more, wished=drawing.wished | wished)
        return self._interpreted.state(*Starting(drawing, self._numbers, self._assembling).at(t, nudge=nudge))

    def _assembled_each(self, values: Sequence[Mapping[str, Any]], t: float) -> list[tuple[np.ndarray, np.ndarray]]:
        """States with these held values in addition to those of the start, one after another."""
        held = [self._drawing.held | targets(each, "start", self._drawing.dimension) for each in values]
        starting = Starting(self._drawing._replace(held=held[0]), self._numbers, self._tables)
        return [self._interpreted.state(*starting.with_values(each).at(t)) for each in held]

    def _state_or_start(self, p: Any, v: Any, p_name: str = "p0", v_name: str = "v0",
                        t: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        if not self.nv:     # coordinates of joints between welded bodies have no velocities
            raise ZerodriftError(f"mechanism {self.name!r} has no joint coordinates to move in, as all its bodies are welded to "
                                 "the ground; system('absolute') has coordinates, and gives its reactions")
        state = self.start_at(t) if p is None and v is None else super()._state_or_start(p, v, p_name, v_name)
        self._check_unique(t, *state)
        return state

    def _check_unique(self, t: float, p: np.ndarray, v: np.ndarray) -> None:
        """Check that redundant constraints leave the reactions unique that user functions read."""
        laws = self._drawing.laws if 0 < self.m <= gateway.MAX_LEAST else []
        for law, name in ((each, name) for each in laws for name in each.reactions.values()):
            place = self._watching.find(name)
            if place is not None and not self._watching.is_unique_at(place, t, p, v):
                raise WrongValue(f"{law.what} must read reactions that are unique, and {name!r} is not, as constraints are "
                                 "redundant: free a joint of the loop, such as by spherical() in the place of revolute()",
                                 "not-unique")

    def _number_tables(self, parameters: Mapping[str, np.ndarray], count: int, closed_form: tuple[str, bool] | None = None, *,
                       starts_are_known: bool = True) -> NumberTables | None:
        plain = not self._is_written_out and not self._drawing.is_balanced and not self._tables.groups
        if not parameters or not plain or not are_plain(self._drawing, self._tables, self._start):
            return super()._number_tables(parameters, count, closed_form) if starts_are_known else None
        wrong, own = np.zeros(count, dtype=bool), self.parameters
        for name, each in parameters.items():
            if each.ndim != 1 or name not in own:
                return None
            wrong |= [not is_right(name, value) for value in each.tolist()]
        right = {name: np.where(wrong, own[name], each) for name, each in parameters.items()}       # invalid ones are not built
        family = varied(self._drawing, self._changed, right, self.layout, self._measuring, self._start, wrong=wrong,
                        starts_are_known=starts_are_known)
        if family is None:
            return None
        refused = refusals(self.with_parameters, parameters, wrong) if starts_are_known else {}
        return NumberTables(self._measuring, None, 0, None, None, refused, family)

    def _with_inputs(self, names: Sequence[str]) -> WithInputs:
        found = driven(self._drawing, names, self._changed)
        system = MechanismSystem(found.drawing, self.layout, self._changed, self._compiled, has_inputs=True)
        return WithInputs(system, found.initial, found.units, law_inputs.bound)

    def _names_of_inputs(self) -> list[str]:
        return list(inputs_of(self._drawing))

    def _with(self, changed: dict[str, Any]) -> MechanismSystem:
        numbers = {name: checked(name, value) for name, value in changed.items()}
        return MechanismSystem(self._drawing, self.layout, self._changed | numbers, self._compiled, self._known_closed_form())

    def _without_drives(self) -> MechanismSystem:
        """The same system without motors and actuators that prescribe a motion."""
        return MechanismSystem(self._drawing.without_drives(), self.layout, self._changed, self._compiled)

    def _driven_from(self, places: list[float]) -> MechanismSystem:
        """The same system with these initial positions of its motors of constant speed, as assembled or nearly."""
        other = self._with({})
        other._start.drives = dict(zip(other._start.drives_by_name, places, strict=True))
        return other

    def _parameter_units(self) -> dict[str, str]:
        return parameter_units(self.parameters, self._drawing.elements)

    def _definition(self) -> tuple[Any, ...]:
        drawing = self._drawing
        return self.layout, self.compiled, drawing.gravity, drawing.elements

    def __reduce__(self) -> tuple[Any, ...]:
        if self._takes_programs:
            self._closed_form[1].programs       # noqa: B018 - the other process may lack SymPy
        return MechanismSystem, (self._drawing, self.layout, self._changed, self._compiled, self._known_closed_form())

    def _known_closed_form(self) -> tuple[str, ClosedFormFunctions] | None:
        """Closed-form functions for the same system with other numbers, which so has the same orders; None: it has none."""
        return self._closed_form if self._is_written_out or self._takes_programs else None

    def _described(self) -> dict[str, Any]:
        """As of any system, with the mechanism or the reason why it cannot be saved."""
        try:
            more = {"mechanism": described(self._drawing), "layout": self.layout, "changed": self._changed}
        except ValueError as error:
            more = {"not_saved": sentence(error)}
        return super()._described() | more

    def __repr__(self) -> str:
        how = f", compiled{self._closed_form[1].in_words}" if self.compiled else ""
        dear = cost.of_a_step(self._cost) if self._cost else ""
        return (f"<system of {self.name}{how}: {self.layout} coordinates, {self.nq}, {self.mh} holonomic and {self.mn} "
                f"nonholonomic constraints{f'; {dear}' if dear else ''}>")

    def points(self, p: ArrayLike) -> np.ndarray | Any:
        """Outline at p: points (n, dimension) in m, joined by lines where not NaN."""
        poses, _ = self._core.poses(checks.vector("p", p, self.nq))
        return (space_outline if self._drawing.dimension == 3 else outline)(self._drawing, self._numbers, poses)

    def _sketches(self, positions: Sequence[np.ndarray], motion: Sequence[np.ndarray] = ()) -> list[list[Shape]]:
        if self._drawing.dimension == 3:
            poses = [self._first_core.poses(np.ascontiguousarray(p))[0] for p in positions]
            return space_sketches(self._drawing, self._numbers, poses)
        moments, others = ((self._first_core.poses(np.ascontiguousarray(p))[0] for p in those) for those in (positions, motion))
        return sketches(self._drawing, self._numbers, moments, others)

    def _forces(self, names: Any, solution: Any, rows: np.ndarray) -> list[tuple[str, np.ndarray, np.ndarray]]:
        elements, drawing, numbers = chosen(self._drawing, names), self._drawing, self._numbers
        poses = [self._first_core.poses(np.ascontiguousarray(solution.p[row]))[0] for row in rows]
        if drawing.dimension == 3:
            inertias = SpaceInertias(drawing, numbers)
            moments: Any = [SpacePosed(drawing, numbers, inertias, pose) for pose in poses]
        else:
            moments = at_moments(Parts(drawing, numbers), poses)
        return [(element.name, *acting(element, moments, np.asarray(solution[f"{element.name}.force"])[rows]))
                for element in elements]
