"""What can go wrong, by name."""

from __future__ import annotations

from typing import Any


class ZerodriftError(Exception):
    """Base of all errors of this package.

    Attributes
    ----------
    solution : Solution or None
        What was computed before the failure, if it happened during a run.
    """

    solution: Any = None


class InconsistentStart(ZerodriftError, ValueError):
    """The initial state violates the constraints; `zerodrift.assemble` finds one that does not."""


class UnreachableTolerance(ZerodriftError, ValueError):
    """The tolerance is below what double precision can reach for this system."""


class UnsuitedFormulation(ZerodriftError, ValueError):
    """The formulation cannot take this system."""


class UnsuitedIntegrator(ZerodriftError, ValueError):
    """The integrator cannot take this system."""


class InconsistentSystem(ZerodriftError, ValueError):
    """What a system says of itself does not fit together: the Jacobian it brings is not that of its constraints,
    or its kinematic matrix changes the length of a unit quaternion.
    """


class SingularSystem(ZerodriftError, ArithmeticError):
    """The mass matrix is not positive definite where it has to be, or the constraints are dependent or contradict each other."""


class Bifurcation(SingularSystem):
    """Constraints that are independent elsewhere are not here, or within this step, and do not determine the motion."""


class Diverged(ZerodriftError, ArithmeticError):
    """The state left the range of doubles."""


class CorrectionFailed(ZerodriftError):
    """A correction did not reach its tolerance."""


class BranchJump(CorrectionFailed):
    """A step ended where its velocities do not lead, as on another assembly branch: it was far too long."""


class StepFailed(ZerodriftError):
    """The equations of an implicit step were not solved, or chosen steps became too short or too many."""


class WorkerLost(ZerodriftError):
    """An executor did not return some runs of an ensemble; `solution` is the Ensemble of what it did return."""


class InUse(ZerodriftError, ValueError):
    """Another run writes to the file of `save_to`, or another ensemble to the folder of `store`."""


class StaleCore(ZerodriftError, ImportError):
    """The compiled core does not belong to the C sources beside it."""


class CorrectionWarning(UserWarning):
    """Some corrections were left out because they had no bounded solution; `Solution.energy_skipped` says where."""


class AccuracyWarning(UserWarning):
    """The energy balance, or one part of the motion, shows that steps were too long: what was computed satisfies the constraints,
    but is not the motion.
    """


class StabilityWarning(UserWarning):
    """Steps were longer than the integrator is stable for, or stability rather than accuracy held them down."""


class LockedWarning(UserWarning):
    """Nothing is free to move, and rows follow from others, as where axes of hinges are askew: the run stays where it is."""


class CostWarning(UserWarning):
    """A run takes much time or memory, and it could take less: said before it starts."""


class Interrupted(KeyboardInterrupt):
    """A run was interrupted from the keyboard; `solution` has what was computed before: a Solution, or a WorkPrecision."""

    def __init__(self, message: str, solution: Any) -> None:
        super().__init__(message)
        self.solution = solution


class CompilationFailed(ZerodriftError):
    """The C compiler cannot be run, refused the source of a symbolic system, or wrote no library that can be loaded."""


class NoCompilerWarning(UserWarning):
    """There is no C compiler: a symbolic system is evaluated in Python, some hundred times slower."""


class CacheWarning(UserWarning):
    """The folder for compiled systems cannot be written, or others can write it, too; they are compiled once in every process."""


class EquilibriumFailed(ZerodriftError):
    """No equilibrium or steady motion was found; the message has the best position and the direction of the remaining force."""
