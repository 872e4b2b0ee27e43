"""Errors and warnings of the package.

Each has a short stable code, which ends its message, ``[zd:branch-jump]``; ``python -m zerodrift explain branch-jump`` prints
its causes and cures. Errors of arguments are also Python's ValueError, TypeError, KeyError, AttributeError or IndexError, and
have the code of the rule that is broken, "shape" or "not-finite"; those of files, packages and memory are Python's OSError,
ImportError and MemoryError.
"""

from __future__ import annotations

from typing import Any


class _Coded(BaseException):
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
    "ZD_CHATTERS": "event-chatter",
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


# Codes of the rules that arguments must keep, each the second argument of an error below; without one, it has that of its class.
OF_ARGUMENTS = {
    "wrong-name": "Nothing has this name; the message has the closest ones.",
    "not-finite": "A number is NaN or infinite, or an entry of an array is masked.",
    "out-of-range": "A number is not between the limits in the message.",
    "unknown-choice": "A word is not among the choices in the message.",
    "duplicate-name": "A name is given twice, is taken, or belongs to several things.",
    "shape": "An array or a list has another shape or number of entries than it must have.",
    "not-increasing": "Times or values are not in increasing order.",
    "step-size": "The step is missing, or it is too short or does not divide a period.",
    "tolerance": "A tolerance is zero, negative, not finite or below round-off, or `rtol` is above 1.",
    "missing-argument": "An argument is missing that another one, or this system, requires.",
    "conflicting-arguments": "Arguments exclude each other; the message states which must be left out.",
    "wrong-dimension": "An argument or element of space is given to a mechanism in the plane, or vice versa.",
    "geometry": "No body, joint or mechanism has these lengths, directions or rotations.",
    "inertia": "No body has this tensor of inertia.",
    "prescribed-twice": "One motion is prescribed twice, by two motors or by a motor and the start.",
    "wrong-measure": "A measure is of another kind than required: of velocities, with components, or of a dependent coordinate.",
    "not-unique": "A force reads a reaction that is not unique, as constraints are redundant.",
    "wrong-element": "An element is of another kind than required, or of another mechanism.",
    "user-function": "A function does not take the arguments, or is not as smooth or linear, as required.",
    "expression": "An expression or equation of SymPy is not of the form that is required.",
    "not-available": "A system or solution does not have the requested quantity.",
    "unreadable-file": "A file is damaged, incomplete, or not of this package or version.",
    "not-portable": "A function cannot be written to a file or a block, or sent to another process.",
    "other-study": "The folder of `store` belongs to another study or to another kind of processor.",
    "compiled-function": "A compiled function or library does not have the interface that is required.",
    "declared-structure": "The declared structure of a system disagrees with the system.",
}


class WrongArgument(_Coded, Exception):
    """Base of errors of arguments, whose message states the rule and the value."""

    def __init__(self, message: str, code: str = "") -> None:
        super().__init__(message)
        if code:
            self.code = code


class WrongValue(WrongArgument, ValueError):
    """An argument has a value that the function does not take; the message states the rule, the value and a hint."""

    code = "wrong-value"


class WrongType(WrongArgument, TypeError):
    """An argument is of a type that the function does not take; the message states what it must be."""

    code = "wrong-type"


class WrongName(WrongArgument, KeyError):
    """Nothing has this name; the message has the closest ones."""

    code = "wrong-name"


class WrongAttribute(WrongArgument, AttributeError):
    """An element does not have this quantity, or it must not be changed."""

    code = "wrong-attribute"


class WrongIndex(WrongArgument, IndexError):
    """Nothing has this number; the message states how many there are."""

    code = "wrong-index"


class MissingFile(_Coded, FileNotFoundError):
    """A file or folder does not exist."""

    code = "missing-file"


class ExistingFile(_Coded, FileExistsError):
    """A file or folder exists that would be overwritten, and is not one that this function has written."""

    code = "existing-file"


class FileInUse(_Coded, PermissionError):
    """A file of samples cannot be replaced on Windows while a solution reads it."""

    code = "file-in-use"


class NoSpace(_Coded, OSError):
    """The samples of a run, or the outputs of an ensemble, exceed the free space of the disk; the message states both sizes."""

    code = "no-space"


class NeedsCompiler(_Coded, NotImplementedError):
    """Missing C compiler, for a function of C that the core does not have."""

    code = "needs-compiler"


def described(error: BaseException, code: bool = True) -> str:
    """Name of an exception and its message, with its code or, for messages that contain it, without; of an error of an argument,
    the name of the exception of Python that it is.
    """
    kinds = type(error).__mro__
    name = next(each for each in kinds if each.__module__ == "builtins" or not isinstance(error, WrongArgument)).__name__
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


class NoUniqueMotion(SingularSystem):
    """Reactions have no unique solution: forces depend too strongly on those that they read, as friction can (Painleve)."""

    code = "no-unique-motion"


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
    """Another run writes to the file of `save_to`, another ensemble to the folder of `store`, or a controller moves its run."""

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


class DrawingWarning(_Coded, UserWarning):
    """The start moves what is drawn: a joint open by more than a hundredth of the drawing's size, or a drive that cannot stay."""

    code = "drawing"


class LockedWarning(_Coded, UserWarning):
    """The mechanism cannot move, and constraints are redundant, for example because of skew hinge axes."""

    code = "locked"


class StateWarning(_Coded, UserWarning):
    """A saved state of a run lacks the states of controllers, since these have no methods ``state()`` and ``restore(state)``."""

    code = "controller-state"


class CostWarning(_Coded, UserWarning):
    """A run would take much time or memory, and could take less; or functions that Python calls have taken 3 s."""

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
    """There is no C compiler: a system whose equations would be compiled is interpreted, several times slower."""

    code = "no-compiler"


class CacheWarning(_Coded, UserWarning):
    """The compile cache cannot be written, or other users can write it: each process compiles its systems again."""

    code = "cache"


class EquilibriumFailed(ZerodriftError):
    """No equilibrium or steady motion was found; the message has the best position and the direction of the remaining force."""

    code = "equilibrium-failed"
