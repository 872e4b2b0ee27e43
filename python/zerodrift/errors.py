"""Errors and warnings of the package.

Each has a short stable code, which ends its message, ``[zd:branch-jump]``; ``python -m zerodrift explain branch-jump`` prints
its causes and cures. Errors of arguments are also Python's ValueError, TypeError or KeyError; of missing packages
and of too little memory, its ImportError and MemoryError.
"""

from __future__ import annotations

from typing import Any


class _Coded:
    """Base of errors and warnings whose message ends with their code, beside a class of Python."""

    code: str

    def __str__(self) -> str:
        return f"{BaseException.__str__(self)} [zd:{self.code}]"


def sentence(error: BaseException) -> str:
    """The message of an error without its code, for messages that contain it."""
    return BaseException.__str__(error) if isinstance(error, _Coded) else str(error)


def of_code(code: str, error: Any) -> Any:
    """The error with the code of one of its parts."""
    error.code = code
    return error


def advised(error: Exception, advice: str) -> Exception:
    """The same error, of the same code, with advice at the end of its message."""
    found = type(error)(f"{sentence(error)}; {advice}")
    return of_code(error.code, found) if isinstance(error, _Coded) else found


# Codes of the core's statuses of which several raise the same exception, by their symbol; the others have the exception's code.
OF_STATUS = {
    "ZD_NOT_DEFINITE": "mass-not-definite",
    "ZD_NOT_SYMMETRIC": "mass-not-symmetric",
    "ZD_DEPENDENT_ROWS": "dependent-constraints",
    "ZD_CONTRADICTION": "contradicting-constraints",
    "ZD_SINGULAR": "singular-matrix",
    "ZD_NO_STEP": "implicit-step",
    "ZD_NO_EMBEDDING": "dependent-coordinates",
    "ZD_TINY_STEP": "step-underflow",
    "ZD_TOO_MANY_STEPS": "too-many-steps",
    "ZD_COLLAPSED": "step-collapse",
    "ZD_BIFURCATION_PASSED": "bifurcation-passed",
    "ZD_NOT_JACOBIAN": "wrong-jacobian",
    "ZD_NOT_KEPT": "quaternion-length",
    "ZD_BAD_TERM": "term-not-finite",
    "ZD_CALLBACK": "evaluation-failed",
}


class ZerodriftError(_Coded, Exception):
    """Base of all errors of this package.

    Attributes
    ----------
    code : str
        Short stable name of the error, such as "branch-jump"; the message ends with it.
    solution : Solution or None
        Partial solution up to the failure, if it happened during a run.
    """

    code = "zerodrift-error"
    solution: Any = None


class _Argument(_Coded):
    """Base of errors of arguments, whose message states the rule and the value."""

class WrongValue(_Argument, ValueError):
    """An argument has a value that the function does not take; the message states the rule, the value and a hint."""

    code = "wrong-value"


class WrongType(_Argument, TypeError):
    """An argument is of a type that the function does not take; the message states what it must be."""

    code = "wrong-type"


class WrongName(_Argument, KeyError):
    """Nothing has this name; the message has the closest ones."""

    code = "wrong-name"


def described(error: BaseException, code: bool = True) -> str:
    """Name of an exception and its message, with its code or, for messages that contain it, without; of an error of an argument,
    the name of the exception of Python that it is.
    """
    name = type(error).__bases__[-1].__name__ if isinstance(error, _Argument) else type(error).__name__
    return f"{name}: {error if code else sentence(error)}"


class MissingPackage(_Coded, ImportError):
    """An optional package is not installed; the message has the command that installs it."""

    code = "missing-package"


class NoMemory(_Coded, MemoryError):
    """The samples of a run, or what an ensemble keeps, exceed the free memory; the message states both sizes."""

    code = "no-memory"


class InconsistentStart(ZerodriftError, ValueError):
    """The initial state violates the constraints; `zerodrift.assemble` finds a consistent one."""

    code = "inconsistent-start"


class UnreachableTolerance(ZerodriftError, ValueError):
    """The tolerance is below what double precision can reach for this system."""

    code = "unreachable-tolerance"


class UnsuitedFormulation(ZerodriftError, ValueError):
    """The formulation does not suit this system."""

    code = "unsuited-formulation"


class UnsuitedIntegrator(ZerodriftError, ValueError):
    """The integrator does not suit this system."""

    code = "unsuited-integrator"


class InconsistentSystem(ZerodriftError, ValueError):
    """The terms of a system contradict each other: its Jacobian is not the derivative of its constraints, or its kinematic
    matrix changes the length of a unit quaternion.
    """

    code = "inconsistent-system"


class SingularSystem(ZerodriftError, ArithmeticError):
    """The mass matrix is not positive definite where required, or constraints are dependent or contradict each other."""

    code = "singular-system"


class Bifurcation(SingularSystem):
    """Constraints that are independent elsewhere become dependent at or within this step and do not determine the motion."""

    code = "bifurcation"


class Diverged(ZerodriftError, ArithmeticError):
    """The state left the range of doubles."""

    code = "diverged"


class CorrectionFailed(ZerodriftError):
    """A correction did not reach its tolerance."""

    code = "correction-failed"


class BranchJump(CorrectionFailed):
    """A step ended on (or near) another assembly branch: displacement and velocities disagree, as it was far too long."""

    code = "branch-jump"


class StepFailed(ZerodriftError):
    """The equations of an implicit step were not solved, or adaptive steps became too short or too many."""

    code = "step-failed"


class WrongState(ZerodriftError, ValueError):
    """A saved state of a run is damaged, or of another system, other settings, or another version."""

    code = "wrong-state"


class InputRefused(ZerodriftError, ValueError):
    """An input of a run is not a finite number, or beyond its limits; the run has made no step with it."""

    code = "input-refused"


class WorkerLost(ZerodriftError):
    """An executor did not return all runs of an ensemble; `solution` is the Ensemble of those that it did return."""

    code = "worker-lost"


class InUse(ZerodriftError, ValueError):
    """Another run writes to the file of `save_to`, or another ensemble to the folder of `store`."""

    code = "in-use"


class NoLocksWarning(_Coded, RuntimeWarning):
    """The file system has no locks: two processes that write to the same file or folder there are not noticed."""

    code = "no-locks"


class StaleCore(ZerodriftError, ImportError):
    """The compiled core is older than the C sources beside it."""

    code = "stale-core"


class CorrectionWarning(_Coded, UserWarning):
    """Corrections were skipped, as they had no bounded solution; `Solution.energy_skipped` counts them over time."""

    code = "correction-skipped"


class AccuracyWarning(_Coded, UserWarning):
    """Steps were too long, as the energy balance or the motion of one component shows: the result satisfies the constraints,
    but is not the motion.
    """

    code = "accuracy"


class StabilityWarning(_Coded, UserWarning):
    """Fixed steps exceeded the stability limit of the integrator, or stability rather than accuracy limited adaptive steps."""

    code = "stability"


class LockedWarning(_Coded, UserWarning):
    """The mechanism cannot move, and constraints are redundant, for example because of skew hinge axes."""

    code = "locked"


class StateWarning(_Coded, UserWarning):
    """A saved state of a run lacks the states of controllers, since these have no methods ``state()`` and ``restore(state)``."""

    code = "controller-state"


class CostWarning(_Coded, UserWarning):
    """A run would take much time or memory, and could take less; issued before it starts."""

    code = "cost"


class Interrupted(_Coded, KeyboardInterrupt):
    """A computation was interrupted from the keyboard; `solution` has its partial result, such as a Solution or Ensemble."""

    code = "interrupted"

    def __init__(self, message: str, solution: Any) -> None:
        super().__init__(message)
        self.solution = solution


class CompilationFailed(ZerodriftError):
    """The C compiler cannot be run, rejected the source of a symbolic system, or wrote no library that can be loaded."""

    code = "compilation-failed"


class NoCompilerWarning(_Coded, UserWarning):
    """There is no C compiler: a symbolic system is evaluated in Python, about a hundred times slower."""

    code = "no-compiler"


class CacheWarning(_Coded, UserWarning):
    """The compile cache cannot be written, or other users can write it: each process compiles its systems again."""

    code = "cache"


class EquilibriumFailed(ZerodriftError):
    """No equilibrium or steady motion was found; the message has the best position and the direction of the remaining force."""

    code = "equilibrium-failed"
