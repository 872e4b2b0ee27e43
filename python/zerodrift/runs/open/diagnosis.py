"""Warnings of completed runs: skipped corrections, instability, inaccuracy; each message suggests a remedy."""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ..._private import gateway
from ...errors import AccuracyWarning, CorrectionWarning, LockedWarning, StabilityWarning
from ...systems.base import core_of
from ..arguments.methods import Projection, integrators, name_of
from ..samples.solution import Solution
from ..states import branches

# Both energy limits are relative to the largest kinetic energy. Among the runs that were measured, none whose error of the energy
# balance (28) stayed below the first limit made a wrong number of turns in twenty. Corrections take out more than that without
# harm, as long as no single one of them has to take out more than the second limit.
SMALLEST_PIVOT, LARGEST_ENERGY_ERROR, LARGEST_ENERGY_CORRECTION, ENERGY_ROUNDING = gateway.WARNING_LIMITS
POSITION_ROUNDING = 1e-14   # relative to the size of a system: rounding of positions that are corrected in each step
TOO_COARSE = "some steps are too long to resolve the motion; use shorter ones, a method of higher order, or rtol instead of step"
TOO_LOOSE = ("the tolerances are too loose to resolve the motion in some steps; use a smaller rtol and atol, or max_step if "
             "something acts for a short time")
OTHER_ENERGY = "; or potential and power are not those of the forces: zd.check(system) compares them"
CATEGORIES = (AccuracyWarning, CorrectionWarning, LockedWarning, StabilityWarning)


def is_beyond_doubt(results: gateway.Results) -> bool:
    """True if no warning is due. A quick check of a few numbers, as `doubts` takes as long as a short run."""
    counted, kinetic = results.statistics, results.largest_kinetic
    return (not (counted.energy_skipped or counted.too_long or counted.stiff or counted.unresolved)
            and not 0 < counted.smallest_pivot < SMALLEST_PIVOT and not results.redundant
            and results.energy_error < LARGEST_ENERGY_ERROR * kinetic
            and counted.energy_corrected <= LARGEST_ENERGY_CORRECTION * kinetic)


def are_beyond_doubt(counted: np.ndarray, kinetic: np.ndarray, energy_error: np.ndarray) -> np.ndarray:
    """The same check for many runs (k,): statistics of the core, largest kinetic energy and energy error of each, in J."""
    any_count = counted["energy_skipped"] | counted["too_long"] | counted["stiff"] | counted["unresolved"]
    return ((any_count == 0) & ~((counted["smallest_pivot"] > 0) & (counted["smallest_pivot"] < SMALLEST_PIVOT))
            & ((energy_error < LARGEST_ENERGY_ERROR * kinetic) | (energy_error == 0))
            & (counted["energy_corrected"] <= LARGEST_ENERGY_CORRECTION * kinetic))


def warn(solution: Solution, stacklevel: int) -> None:
    """Issue all warnings of a solution; `stacklevel` as in `warnings.warn`, counted from the caller."""
    for category, sentence in doubts(solution):
        warnings.warn(sentence, category, stacklevel=stacklevel + 1)


@contextlib.contextmanager
def unwarned() -> Iterator[None]:
    """Context without these warnings, for callers that evaluate or show the same facts themselves."""
    with warnings.catch_warnings():
        for category in CATEGORIES:
            warnings.simplefilter("ignore", category)
        yield


def doubts(solution: Solution) -> Iterator[tuple[type[Warning], str]]:
    """Warnings due for a solution: category and message of each."""
    yield from _skipped_corrections(solution)
    yield from _small_pivot(solution)
    yield from _locked(solution)
    if solution.success:
        yield from ((StabilityWarning, sentence) for sentence in instability(solution.stats, solution.settings["integrator"]))
        yield from _inaccuracy(solution)


def _skipped_corrections(solution: Solution) -> Iterator[tuple[type[Warning], str]]:
    stats = solution.stats
    if skipped := stats["energy_skipped"]:
        due = skipped + stats["energy_corrections"]     # more than the steps, where some are made in parts
        yield CorrectionWarning, (f"{skipped} of {due} energy corrections were left out: near a turning point the kinetic energy "
                                  "is too small for them; sol.energy_skipped says where")


def _small_pivot(solution: Solution) -> Iterator[tuple[type[Warning], str]]:
    stats = solution.stats
    if 0 < stats["smallest_pivot"] < SMALLEST_PIVOT:
        yield AccuracyWarning, (
            f"at t = {stats['smallest_pivot_time']:.6g}, {stats['smallest_pivot']:.1g} was left of constraint "
            f"{solution.system.constraints[stats['smallest_pivot_row']].name!r} once others are eliminated: the motion comes "
            "near a bifurcation or follows it through, which is not looked for among so many constraints, and accelerations lose "
            "digits there; joint coordinates lose fewer")


def _locked(solution: Solution) -> Iterator[tuple[type[Warning], str]]:
    system, stats = solution.system, solution.stats
    if stats["redundant"] and stats["rank"] == system.nv and (message := system._why_locked()):
        yield LockedWarning, message


def instability(stats: Mapping[str, Any], integrator: Any) -> Iterator[str]:
    """Messages of `StabilityWarning` for a run that reached its end, from the statistics of the core."""
    integrator, steps = name_of("integrators", integrator), stats["steps"]
    if too_long := stats["too_long"]:
        stable = integrators()[integrator].stability
        limit = f"is stable for ({stable:g})" if stable else "resolves: what moves so fast is stable, but wrong"
        yield (f"{too_long} of {steps} steps, with an omega h of up to {stats['omega_h']:.3g}, were longer "
               f"than {integrator!r} {limit}; take shorter ones{', or an implicit method' if stable else ''}")
    if stats["stiff"]:
        yield (f"the problem is stiff for {integrator!r}: stability, not the tolerance, limited many "
               f"of its {steps} steps; an implicit method, as 'radau', takes longer ones")


def _other_branch(solution: Solution) -> Iterator[tuple[type[Warning], str]]:
    """The step that led to another assembly branch. The check may take as long as a run; a jump changes the energy."""
    if (at := branches.changed_at(solution)) is not None:
        yield AccuracyWarning, (f"in the step from t = {at:.6g} a correction led to another assembly branch, which no motion "
                                f"reaches from there: {_advice(solution)}")


def _advice(solution: Solution) -> str:
    """Advice on inaccurate steps, fixed or adaptive."""
    return TOO_LOOSE if solution.settings["step"] is None else TOO_COARSE


def _inaccuracy(solution: Solution) -> Iterator[tuple[type[Warning], str]]:
    advice = _advice(solution)
    of_energy = advice + OTHER_ENERGY if solution.system._has_own_energy else advice
    found = [f"{sentence}: {of_energy}" for sentence in _numerical_energy(solution)]
    if _is_prescribed(solution):
        yield from _other_branch(solution) if found else ()
        return
    if not found and not solution.stats["too_long"] and solution.stats["unresolved"]:
        found = [f"{_unresolved_part(solution)}: {advice}"]     # otherwise the same has been said of the whole mechanism
    for sentence in found:
        yield AccuracyWarning, sentence
    if found or solution.stats["too_long"] or solution.stats["energy_skipped"]:
        yield from _other_branch(solution)


def _is_prescribed(solution: Solution) -> bool:
    """True if constraints leave no freedom and positions are projected onto them: steps affect the work of drives alone."""
    stabilization = solution.settings["stabilization"]
    return solution.stats["rank"] == solution.system.nv and isinstance(stabilization, Projection) and stabilization.positions


def _rounding_at_rest(solution: Solution) -> float:
    """Rounding of the potential energy in J: of the work that the forces at the start do over the size of the system."""
    core, (t, p, v) = core_of(solution.system), (each[:1] for each in (solution.t, solution.p, solution.v))
    # Where constraints switch, forces may read reactions, which a single state does not have.
    force = solution.multipliers[:1] if core.c.groups else core.evaluate_states(("f",), t, p, v).get("f", np.zeros(1))
    return POSITION_ROUNDING * max(core.c.length, _largest(p.ravel())) * _largest(force.ravel())


def _rests(solution: Solution) -> bool:
    """True if no coordinate leaves its start by more than the tolerance of adaptive steps, or than rounding."""
    moved, size = np.abs(solution.p - solution.p[0]), max(core_of(solution.system).c.length, _largest(solution.p[0]))
    settings = solution.settings
    tolerance = 0.0 if settings["step"] is not None else settings["atol"] + settings["rtol"] * size
    is_seen = solution.stats["largest_kinetic"] <= 10 * _largest(solution.kinetic_energy)
    return is_seen and float(moved.max()) <= tolerance + 100 * POSITION_ROUNDING * size


def _numerical_energy(solution: Solution) -> Iterator[str]:
    """Messages on energy errors of integration and corrections that exceed both rounding and the allowed limits."""
    violation, potential = solution.energy_violation, solution.potential_energy
    if violation is None or potential is None or not len(violation):
        return
    error, correction, kinetic = _largest(violation), solution.stats["energy_corrected"], solution.stats["largest_kinetic"]
    if error < LARGEST_ENERGY_ERROR * kinetic and correction <= LARGEST_ENERGY_CORRECTION * kinetic:
        return      # all the more where the rows have seen more kinetic energy
    # All samples may be at turning points; the statistics include the steps between them.
    kinetic = max(_largest(solution.kinetic_energy), kinetic)
    rounding = ENERGY_ROUNDING * (kinetic + _largest(potential)) + _rounding_at_rest(solution)
    if not kinetic:
        if error > rounding:
            yield f"the energy balance is off by {error:.2g} J, and nothing was seen to move"
        return
    if _rests(solution):
        return
    if not error < max(LARGEST_ENERGY_ERROR * kinetic, rounding):       # true also where a number is infinite or not a number
        yield f"the energy balance is off by {error / kinetic:.2g} of the largest kinetic energy"
    if correction > max(LARGEST_ENERGY_CORRECTION * kinetic, rounding):
        yield f"energy corrections were up to {correction / kinetic:.2g} of the largest kinetic energy"


def _largest(x: np.ndarray) -> float:
    """The largest |x|. It is what takes most of a warning's time, and so is written as NumPy does it fastest."""
    return float(max(np.maximum.reduce(x), -np.minimum.reduce(x)))


def _unresolved_part(solution: Solution) -> str:
    """Which part of the motion the steps do not resolve."""
    stats, system = solution.stats, solution.system
    has_rates = core_of(system).provides & gateway.TERMS["A"].bit     # then the core compares velocities, not coordinates
    parts = [*(system.velocities if has_rates else system.coordinates), *(system.coordinates[q] for q in system.quaternions)]
    part = parts[stats["part"]]
    unit = "of the mechanism's length" if gateway.is_length(part) else "rad"
    return (f"the steps do not resolve the motion of {part.name!r}: its accumulated error reaches {stats['part_error']:.2g} "
            f"{unit}; first detected at t = {stats['unresolved_time']:.6g}")
