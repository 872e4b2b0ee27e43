"""Default methods of systems: those of a system with equations alone, which kinds of systems override."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .._private import gateway
from .._private.gateway import CoreSystem, Variable
from .._private.gateway.compiled.precise import Precise
from ..errors import WrongValue
from .shapes import Shape


class WithInputs(NamedTuple):
    """System with some of its numbers as inputs of a run."""

    system: Any
    initial: list[float]
    units: list[str]
    bound: Any      # function of a core of this system and of the names: the core of one run, with the places of its inputs


class Defaults:
    """Defaults: a system without advice, drawing, inputs, series and other coordinates."""

    name: str
    _groups: Sequence[tuple[str, str]] = ()     # names and kinds of groups of constraints that switch
    _latches: Sequence[Any] = ()                # latches, which join joints and let them go at events

    if TYPE_CHECKING:       # attributes, which mechanisms compute at first use

        @cached_property
        def parameters(self) -> dict[str, Any]: ...
        @cached_property
        def coordinates(self) -> tuple[Variable, ...]: ...
        @cached_property
        def velocities(self) -> tuple[Variable, ...]: ...
        @cached_property
        def constraints(self) -> tuple[Variable, ...]: ...
        @cached_property
        def p0(self) -> np.ndarray | Any: ...
        @cached_property
        def v0(self) -> np.ndarray | Any: ...
        @cached_property
        def _core(self) -> CoreSystem: ...

    def _closed_form_core(self, vector: str = "baseline", embeds: bool = False) -> CoreSystem:
        """The core's system with closed-form functions; those for independent velocities (`embeds`) are separate functions."""
        return self._core

    def _why_interpreted(self, steps: float) -> str | None:
        """Time that compiling would save in so many corrected steps of "rk4", in words; None: nothing is interpreted."""
        return None

    def _why_no_closed_form(self, embeds: bool = False) -> str | None:
        """Known reason why the system has no closed-form functions; empty: it has some; None: systems of its kind have none."""
        core = getattr(self, "_core", None)
        return "" if core is not None and core.has_closed_form else None

    def _by_matrices(self) -> Any:
        """The same system without closed forms as programs, which batches of runs with different numbers do not have."""
        return self

    def _compiled_for(self, steps: int) -> Any:
        """The same system with compiled equations, if a run of so many fixed steps gains by it; None: it does not."""
        return None

    def _parameter_units(self) -> dict[str, str]:
        """Units of the parameters, as far as they are known."""
        return {}

    def points(self, p: ArrayLike) -> np.ndarray | Any:
        """Drawing at p: points (n, 2) or (n, 3) in m, joined by lines except at NaN. None: the system has no drawing."""
        return None

    def _sketches(self, positions: Sequence[np.ndarray], motion: Sequence[np.ndarray] = ()) -> list[list[Shape]] | None:
        """Shapes to draw at each of some positions, which may be of a motion; None: only the points and lines of the drawing are
        known.
        """
        return None

    def _forces(self, names: Any, solution: Any, rows: np.ndarray) -> list[tuple[str, np.ndarray, np.ndarray]]:
        """Forces by name at samples of a solution: points of action (k, 2) in m and vectors (k, 2) in N."""
        return []

    def _definition(self) -> Any:
        """Geometry, user functions and tables, without parameters and start; saved states of runs are compared by it."""
        return None

    def _advice(self, error: Exception) -> str | None:
        """Advice of the system on an error that the core reported at the start; None: no advice."""
        return None

    def _advice_on_failure(self, t: float, p: np.ndarray) -> str | None:
        """Advice on the error of a run that failed near a state; None: no advice."""
        return None

    def _beyond_reach(self, t: float, p: np.ndarray, ahead: float) -> str:
        """Sentence on a drive that the motion from (t, p) cannot follow for `ahead` seconds; "": it follows all drives."""
        return ""

    def _advice_on_collapse(self, t: float, p: np.ndarray, v: np.ndarray, velocity: int) -> str:
        """Name of the velocity whose rate jumps where the step size of a run has collapsed."""
        return f"velocity {velocity} is {self.velocities[velocity].name!r}"

    def _why_locked(self) -> str | None:
        """Possible reason why the system has no degree of freedom; None: it is intended."""
        return None

    def _why_unknown(self, name: Any) -> str | None:
        """Explanation of an unknown name; None: no measure or coordinate has a similar one."""
        return None

    def _with_inputs(self, names: Sequence[str]) -> WithInputs:
        """The system whose numbers of these names are inputs."""
        raise WrongValue("inputs must be forces and speeds of a mechanism, symbols declared by zd.symbolic(inputs=), or "
                         f"parameters of a zd.System or zd.native system, and {self.name} has none", "not-available")

    def _names_of_inputs(self) -> list[str]:
        """Names of numbers that may be inputs."""
        return []

    def _arrays_of_inputs(self) -> dict[str, np.ndarray]:
        """Names of the numbers in each array that may be an input as a whole, in its shape."""
        return {}

    def _core_in_lanes(self, vector: str, embeds: bool = False) -> CoreSystem:
        """The core's system with its closed-form functions, for SIMD lanes, too, where it has them."""
        return self._closed_form_core(vector, embeds)

    def _with_series(self, core: CoreSystem, vector: str = "baseline") -> CoreSystem:
        """The core's system, with the Taylor series of its motion where it has one."""
        return core

    def _precise_functions(self, vector: str = "baseline") -> Precise | None:
        """Functions of the system in double-double arithmetic; None: it has none."""
        return None

    def _program_of(self, name: str) -> tuple[Any, list[int], np.ndarray] | None:
        """Operations of a measure of positions or velocities, as those of a symbolic graph: the lowering, the operations whose
        values its components are, and the parameters (k, 2) that are read, as pairs of doubles; None for other measures.
        """
        return None

    def _exact_start(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Start (nq, 2), (nv, 2) of the system as pairs of doubles, if more than doubles is known of it."""
        return None

    @property
    def _formulation(self) -> str:
        """Formulation of runs that name none."""
        return gateway.default("formulations")

    @property
    def _held_at_start(self) -> tuple[list[int], list[int]]:
        """Coordinates and velocities that are given as doubles at the start, and from which all others follow."""
        return [], []

    def _with_jacobian(self, core: CoreSystem, vector: str = "baseline") -> CoreSystem:
        """The core's system, with the Jacobian of its motion where it has one."""
        return core

    def _with_series_of_perturbed(self, core: gateway.PerturbedCore, vector: str) -> CoreSystem:
        """The core's perturbed system, with the Taylor series of the perturbed motion."""
        return core

    @property
    def _brings_perturbed_series(self) -> bool:
        """True if the perturbed system has its Taylor series, too."""
        return False

    @property
    def _brings_series(self) -> bool:
        """True if the system has a Taylor series."""
        return False

    def _in_other_coordinates(self) -> Any:
        """Equivalent system in other coordinates, with this system's coordinates among its measures, or None."""
        return None

    @property
    def _has_plain_laws(self) -> bool:
        """True if all terms are known to be polynomials, sines and cosines, except smooth elements."""
        return False

    def _what_it_costs(self, steps: int | None) -> str | None:
        """Advice on a cheaper description of the system for a number of steps (None: unknown), or None."""
        return None

    def _drawn_open(self, also_held: Iterable[str] = ()) -> str | None:
        """Sentence on a joint that is drawn open where the start, with values held besides, is not meant to differ; or None."""
        return None
