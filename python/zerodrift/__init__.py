"""Mechanisms and other constrained multibody systems, simulated without constraint drift.

>>> import zerodrift as zd
>>> sol = zd.simulate(zd.models.slider_crank(), 1.0, step=1e-3)
>>> forces = sol["pin.force"]
>>> ax = zd.plot.mechanism(sol, t=0.5)

Call first, by task (``m`` is a mechanism or other system, ``sol`` a solution)::

    build a mechanism           m = zd.Mechanism("name"); m.link, m.body, m.revolute, m.spring, m.motor, ...
    take a known mechanism      zd.models.slider_crank(), ...; dir(zd.models) lists them
    write your own equations    zd.System (NumPy), zd.symbolic (SymPy), zd.native (C or numba)
    simulate                    sol = zd.simulate(m, 10.0)
    read forces and motions     sol["pin.force"]; m.measures lists names; zd.Instant reads one state
    plot                        zd.plot.mechanism(sol), zd.plot.measures(sol, ["pin.force"]); zd.display_units(force="kN")
    find the maximum loads      sol.loads("crank.angle"), sol["ground.force"], zd.plot.polar(sol, "pin.force")
    play a film                 zd.view(sol); with sliders: zd.explore
    stop at an event            zd.simulate(m, 10.0, events=zd.Event(...))
    control a run, step by step zd.Run, zd.every; many together: zd.ManyRuns
    find a state                zd.assemble (closed joints), zd.equilibrium (at rest), zd.equilibria
    linearize                   zd.linearize(m): modes, frequencies, matrices A, B, C, D
    prescribe a motion          zd.kinematics(m, ...); without time: zd.trace, zd.reach
    find forces of a motion     zd.inverse_dynamics
    size a flywheel             zd.flywheel(m, "crank.angle", speed=31.4)
    vary parameters             zd.ensemble(m, 10.0, parameters=...); zd.grid for all combinations
    choose settings             zd.tune, zd.work_precision; certified error: zd.reference
    check equations             zd.check(m)
    save and load               sol.save, m.save, zd.load; sol.to_csv for other programs
    use outside Python          zd.fmu(m, ...), zd.c_source(m, ...)
    understand an error         python -m zerodrift explain CODE

Modules to use: `models`, `systems`, `plot`, `inertia`, `compare`, `errors`. Other modules are the implementation.
"""

import importlib
from typing import Any

from . import systems
from .errors import (
    AccuracyWarning,
    Bifurcation,
    BranchJump,
    CacheWarning,
    CompilationFailed,
    CorrectionFailed,
    CorrectionWarning,
    CostWarning,
    Diverged,
    DrawingWarning,
    EquilibriumFailed,
    InconsistentStart,
    InconsistentSystem,
    InputRefused,
    Interrupted,
    InUse,
    LockedWarning,
    NoCompilerWarning,
    NoUniqueMotion,
    SingularSystem,
    StabilityWarning,
    StaleCore,
    StateWarning,
    StepFailed,
    UnreachableTolerance,
    UnsuitedFormulation,
    UnsuitedIntegrator,
    WorkerLost,
    WrongState,
    ZerodriftError,
)
from .runs.arguments.events import Event
from .runs.arguments.methods import corrections, formulations, integrators
from .runs.open.control import every
from .runs.samples.solution import Solution
from .runs.simulate import simulate
from .runs.states.instant import Instant
from .runs.states.operations import acceleration, assemble, project
from .systems.structure import Structure

__version__ = "0.1.0"
__all__ = [
    "AccuracyWarning", "Baumgarte", "Bifurcation", "BranchJump", "CacheWarning", "CompilationFailed", "CorrectionFailed",
    "CorrectionWarning", "CostWarning", "Diverged", "DrawingWarning", "EnergyCorrection", "EquilibriumFailed", "Event",
    "InUse", "InconsistentStart", "InconsistentSystem", "InputRefused", "Instant", "Interrupted", "LockedWarning", "ManyRuns",
    "Mechanism", "NoCompilerWarning", "NoUniqueMotion", "OneSided", "Projection", "Run", "SingularSystem", "Solution",
    "StabilityWarning", "StaleCore", "StateWarning", "StepFailed", "Structure", "System", "UnreachableTolerance",
    "UnsuitedFormulation", "UnsuitedIntegrator", "WorkerLost", "WrongState", "ZerodriftError", "acceleration", "assemble",
    "bias", "block", "c_source", "check", "compare", "corrections", "display_units", "ensemble", "equilibria", "equilibrium",
    "every", "explore", "flywheel", "fmu", "formulations", "from_mechanics", "get_include", "grid", "inertia", "integrators",
    "inverse_dynamics", "jacobian", "kinematics", "linearize", "linkage", "load", "mass_matrix", "models", "native",
    "numba_signature", "plot", "project", "reach", "record_size", "reference", "simulate", "stability_map", "symbolic",
    "systems", "table", "trace", "transmission_angle", "tune", "view", "work_precision",
]
_LATER = {      # imported, or made, at first use
    "Baumgarte": "runs.arguments.methods", "EnergyCorrection": "runs.arguments.methods", "ManyRuns": "runs.open.many_runs",
    "Mechanism": "mechanisms.mechanism", "Projection": "runs.arguments.methods", "Run": "runs.open.run",
    "System": "systems.callables", "bias": "analysis.matrices", "block": "export.block", "c_source": "export.c_source",
    "check": "studies.check", "display_units": "units", "ensemble": "ensembles.ensemble", "fmu": "export.fmu",
    "equilibria": "analysis.equilibria", "equilibrium": "analysis.equilibrium", "explore": "player.explore",
    "flywheel": "studies.flywheel", "from_mechanics": "symbolics.mechanics", "get_include": "systems.native",
    "OneSided": "systems.one_sided",
    "grid": "ensembles.runs", "inverse_dynamics": "analysis.inverse_dynamics", "jacobian": "analysis.matrices",
    "kinematics": "analysis.kinematics", "linearize": "analysis.linearize", "linkage": "mechanisms.linkage", "load": "files",
    "mass_matrix": "analysis.matrices", "native": "systems.native", "numba_signature": "systems.native",
    "reach": "tracing.trace", "record_size": "runs.samples.record_size", "reference": "studies.reference",
    "stability_map": "studies.stability_map", "symbolic": "symbolics.define", "table": "laws.table", "trace": "tracing.trace",
    "transmission_angle": "tracing.transmission", "tune": "studies.tune", "view": "player.view",
    "work_precision": "studies.work_precision",
}


def _shown(solution: Solution) -> str:
    """The film of a solution above its text, in notebooks; the player is imported then."""
    return importlib.import_module(".player.view", __name__).of_solution(solution, repr(solution))


Solution._repr_html_ = _shown


def __getattr__(name: str) -> Any:
    if name in ("inertia", "models", "plot"):       # SymPy and matplotlib are imported when they are used
        return importlib.import_module(f".{name}", __name__)
    if name == "compare":
        return importlib.import_module(".studies.compare", __name__)
    if name in _LATER:
        return getattr(importlib.import_module(f".{_LATER[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
