"""Errors and warnings of the package."""

from __future__ import annotations

from typing import Any


class ZerodriftError(Exception):
    """Base of all errors of this package.

    Attributes
    ----------
    solution : Solution or None
        Partial solution up to the failure, if it happened during a run.
    """

    solution: Any = None


class InconsistentStart(ZerodriftError, ValueError):
    """The initial state violates the constraints; `zerodrift.assemble` finds a consistent one."""


class UnreachableTolerance(ZerodriftError, ValueError):
    """The tolerance is below what double precision can reach for this system."""


class UnsuitedFormulation(ZerodriftError, ValueError):
    """The formulation does not suit this system."""


class UnsuitedIntegrator(ZerodriftError, ValueError):
    """The integrator does not suit this system."""


class InconsistentSystem(ZerodriftError, ValueError):
    """The terms of a system contradict each other: its Jacobian is not the derivative of its constraints, or its kinematic
    matrix changes the length of a unit quaternion.
    """


class SingularSystem(ZerodriftError, ArithmeticError):
    """The mass matrix is not positive definite where required, or constraints are dependent or contradict each other."""


class Bifurcation(SingularSystem):
    """Constraints that are independent elsewhere become dependent at or within this step and do not determine the motion."""


class Diverged(ZerodriftError, ArithmeticError):
    """The state left the range of doubles."""


class CorrectionFailed(ZerodriftError):
    """A correction did not reach its tolerance."""


class BranchJump(CorrectionFailed):
    """A step ended on (or near) another assembly branch: displacement and velocities disagree, as it was far too long."""


class StepFailed(ZerodriftError):
    """The equations of an implicit step were not solved, or adaptive steps became too short or too many."""


class WorkerLost(ZerodriftError):
    """An executor did not return all runs of an ensemble; `solution` is the Ensemble of those that it did return."""


class InUse(ZerodriftError, ValueError):
    """Another run writes to the file of `save_to`, or another ensemble to the folder of `store`."""


class StaleCore(ZerodriftError, ImportError):
    """The compiled core is older than the C sources beside it."""


class CorrectionWarning(UserWarning):
    """Corrections were skipped, as they had no bounded solution; `Solution.energy_skipped` counts them over time."""


class AccuracyWarning(UserWarning):
    """Steps were too long, as the energy balance or the motion of one component shows: the result satisfies the constraints,
    but is not the motion.
    """


class StabilityWarning(UserWarning):
    """Fixed steps exceeded the stability limit of the integrator, or stability rather than accuracy limited adaptive steps."""


class LockedWarning(UserWarning):
    """The mechanism cannot move, and constraints are redundant, for example because of skew hinge axes."""


class CostWarning(UserWarning):
    """A run would take much time or memory, and could take less; issued before it starts."""


class Interrupted(KeyboardInterrupt):
    """A computation was interrupted from the keyboard; `solution` has its partial result, such as a Solution or Ensemble."""

    def __init__(self, message: str, solution: Any) -> None:
        super().__init__(message)
        self.solution = solution


class CompilationFailed(ZerodriftError):
    """The C compiler cannot be run, rejected the source of a symbolic system, or wrote no library that can be loaded."""


class NoCompilerWarning(UserWarning):
    """There is no C compiler: a symbolic system is evaluated in Python, about a hundred times slower."""


class CacheWarning(UserWarning):
    """The compile cache cannot be written, or other users can write it: each process compiles its systems again."""


class EquilibriumFailed(ZerodriftError):
    """No equilibrium or steady motion was found; the message has the best position and the direction of the remaining force."""
