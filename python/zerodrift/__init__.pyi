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

# Written by tests/support/stubs.py.
from . import inertia as inertia
from . import models as models
from . import plot as plot
from . import systems as systems
from ._private.types import Baumgarte as Baumgarte
from ._private.types import EnergyCorrection as EnergyCorrection
from ._private.types import Projection as Projection
from .analysis.equilibria import equilibria as equilibria
from .analysis.equilibrium import equilibrium as equilibrium
from .analysis.inverse_dynamics import inverse_dynamics as inverse_dynamics
from .analysis.kinematics import kinematics as kinematics
from .analysis.linearize import linearize as linearize
from .analysis.matrices import bias as bias
from .analysis.matrices import jacobian as jacobian
from .analysis.matrices import mass_matrix as mass_matrix
from .ensembles.ensemble import ensemble as ensemble
from .ensembles.runs import grid as grid
from .errors import AccuracyWarning as AccuracyWarning
from .errors import Bifurcation as Bifurcation
from .errors import BranchJump as BranchJump
from .errors import CacheWarning as CacheWarning
from .errors import CompilationFailed as CompilationFailed
from .errors import CorrectionFailed as CorrectionFailed
from .errors import CorrectionWarning as CorrectionWarning
from .errors import CostWarning as CostWarning
from .errors import Diverged as Diverged
from .errors import DrawingWarning as DrawingWarning
from .errors import EquilibriumFailed as EquilibriumFailed
from .errors import InconsistentStart as InconsistentStart
from .errors import InconsistentSystem as InconsistentSystem
from .errors import InputRefused as InputRefused
from .errors import Interrupted as Interrupted
from .errors import InUse as InUse
from .errors import LockedWarning as LockedWarning
from .errors import NoCompilerWarning as NoCompilerWarning
from .errors import NoUniqueMotion as NoUniqueMotion
from .errors import SingularSystem as SingularSystem
from .errors import StabilityWarning as StabilityWarning
from .errors import StaleCore as StaleCore
from .errors import StateWarning as StateWarning
from .errors import StepFailed as StepFailed
from .errors import UnreachableTolerance as UnreachableTolerance
from .errors import UnsuitedFormulation as UnsuitedFormulation
from .errors import UnsuitedIntegrator as UnsuitedIntegrator
from .errors import WorkerLost as WorkerLost
from .errors import WrongState as WrongState
from .errors import ZerodriftError as ZerodriftError
from .export.block import block as block
from .export.c_source import c_source as c_source
from .export.fmu import fmu as fmu
from .files import load as load
from .laws.table import table as table
from .mechanisms.linkage import linkage as linkage
from .mechanisms.mechanism import Mechanism as Mechanism
from .player.explore import explore as explore
from .player.view import view as view
from .runs.arguments.events import Event as Event
from .runs.arguments.methods import corrections as corrections
from .runs.arguments.methods import formulations as formulations
from .runs.arguments.methods import integrators as integrators
from .runs.open.control import every as every
from .runs.open.many_runs import ManyRuns as ManyRuns
from .runs.open.run import Run as Run
from .runs.samples.record_size import record_size as record_size
from .runs.samples.solution import Solution as Solution
from .runs.simulate import simulate as simulate
from .runs.states.instant import Instant as Instant
from .runs.states.operations import acceleration as acceleration
from .runs.states.operations import assemble as assemble
from .runs.states.operations import project as project
from .studies import compare as compare
from .studies.check import check as check
from .studies.flywheel import flywheel as flywheel
from .studies.reference import reference as reference
from .studies.stability_map import stability_map as stability_map
from .studies.tune import tune as tune
from .studies.work_precision import work_precision as work_precision
from .symbolics.define import symbolic as symbolic
from .symbolics.mechanics import from_mechanics as from_mechanics
from .systems.callables import System as System
from .systems.native import get_include as get_include
from .systems.native import native as native
from .systems.native import numba_signature as numba_signature
from .systems.one_sided import OneSided as OneSided
from .systems.structure import Structure as Structure
from .tracing.trace import reach as reach
from .tracing.trace import trace as trace
from .tracing.transmission import transmission_angle as transmission_angle
from .units import display_units as display_units

__version__: str
