"""Arguments of `simulate`, checked and translated for the core: methods, corrections, steps, and samples to save."""

from __future__ import annotations

import functools
import inspect
import math
import operator
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, TypeVar

import numpy as np

from ..._private import checks, gateway
from ..._private.types import ArrayLike, Correction, Formulation, Integrator, StabilizationName, VectorUnit
from ...errors import WrongType, WrongValue
from ...systems.base import BaseSystem, core_of
from . import methods
from .methods import ARGUMENTS, TABLES, RowSettings, integrators, name_of, row_of

Function = TypeVar("Function", bound=Callable[..., Any])
CORRECTIONS = TABLES["corrections"]
STABILIZATIONS = tuple(name for name, argument in ARGUMENTS.items() if argument == "stabilization")
Stabilization = RowSettings | None
# Default methods.
CHOOSING = "dop853"     # integrator if neither integrator nor step is given
FORMULATION, INTEGRATOR, STABILIZATION = map(gateway.default, ("formulations", "integrators", "corrections"))


def _are_settings(value: Any, *corrections: str) -> bool:
    """Return whether a value holds the settings of one of these corrections."""
    return isinstance(value, RowSettings) and value.table == "corrections" and value.card.name in corrections


def stabilization(value: Any) -> Stabilization:
    """Check the argument `stabilization` of `simulate`: None, a name, or settings."""
    if value is None or _are_settings(value, *STABILIZATIONS):
        return value
    if isinstance(value, str):
        return CORRECTIONS[checks.choice("stabilization", value, STABILIZATIONS)].settings()
    raise WrongType(f"stabilization must be None, {', '.join(map(repr, STABILIZATIONS))}, zd.Projection(...) "
                    f"or zd.Baumgarte(...), not {value!r}")


def energy(value: Any) -> RowSettings | None:
    """Check the argument `energy` of `simulate`."""
    if value is None or value is False:
        return None
    if value is True:
        return methods.EnergyCorrection()
    if _are_settings(value, "energy"):
        return value
    raise WrongType(f"energy must be None, True or zd.EnergyCorrection(...), not {value!r}")


def correction(value: Any) -> tuple[RowSettings, ...]:
    """Check the argument `correction` of `simulate`: None, a name, settings, or a sequence of these."""
    if value is None:
        return ()
    several = value if isinstance(value, Sequence) and not isinstance(value, str) else (value,)
    return tuple(map(_one_correction, several))


def _one_correction(value: Any) -> RowSettings:
    if isinstance(value, RowSettings) and value.table == "corrections":
        return value
    if isinstance(value, str):
        return CORRECTIONS[checks.choice("correction", value, CORRECTIONS)].settings()
    raise WrongType(f"correction must be names or settings of zd.corrections(), not {value!r}")


def corrections_of(settings: dict[str, Any]) -> list[RowSettings]:
    """List of all corrections that the settings of a run switch on."""
    return [each for each in (settings["stabilization"], settings["energy"], *settings.get("correction", ())) if each]


ON_SINGULAR = ("stop", "continue")


def on_singular_row(value: Any) -> int:
    """Number that the core uses for a value of the argument `on_singular`."""
    return ON_SINGULAR.index(checks.choice("on_singular", value, ON_SINGULAR))


# ---- all arguments of `simulate` ----

MAX_STEPS = 1_000_000     # default limit of adaptive steps
TOLERANCES = {"rtol": 1e-6, "atol": 1e-9, "first_step": None, "max_step": None, "max_move": None}     # defaults of adaptive steps
FINEST_RTOL = 100 * np.finfo(float).eps     # smallest rtol: below it, error estimates are rounding
RESOLVED = 16 * float(np.finfo(float).eps)      # shortest step, relative to the time


@dataclass
class Arguments:
    """Arguments of `simulate` on samples, steps and methods, as given; all but `t_eval` are the key of a cache."""

    t_eval: ArrayLike | None = None
    step: float | None = None
    save_every: int = 1
    rtol: float | None = None
    atol: float | None = None
    first_step: float | None = None
    max_step: float | None = None
    max_move: float | None = None
    max_steps: int | None = MAX_STEPS
    formulation: Formulation | RowSettings | None = None
    integrator: Integrator | RowSettings | None = None
    stabilization: StabilizationName | RowSettings | None = STABILIZATION
    energy: bool | RowSettings | None = None
    correction: Correction | RowSettings | Sequence[Correction | RowSettings] | None = None
    on_singular: Literal["stop", "continue"] = "stop"
    closed_form: Literal[False] | None = None
    vector: VectorUnit | None = None


DEFAULTS = vars(Arguments())


def with_names(of: Callable[..., Any]) -> Callable[[Function], Function]:
    """Decorator that gives a function with `**settings` a signature with their names, as in `of`, for interactive editors."""
    def changed(function: Function) -> Function:
        signature = inspect.signature(function)
        own = dict(list(signature.parameters.items())[:-1])
        others = [each.replace(kind=each.KEYWORD_ONLY, annotation=each.empty)
                  for each in inspect.signature(of).parameters.values()
                  if each.name not in own and each.default is not each.empty]
        vars(function)["__signature__"] = signature.replace(parameters=[*own.values(), *others])
        return function

    return changed


@with_names(Arguments)
def known(function: str, step: Any, t_eval: Any, /, **settings: Any) -> Arguments:
    """Arguments of a run from the settings of a call, by name."""
    names = list(DEFAULTS)[2:]
    for name in settings:
        if name not in names:
            raise WrongType(f"{function} has no setting {name!r}; {checks.closest(name, names)}", "wrong-name")
    return Arguments(t_eval, step, **settings)


class CheckedSettings(NamedTuple):
    """Arguments of a run, checked."""

    settings: dict[str, Any]    # by name, as in `Solution.settings`
    core_settings: Any          # the same as a `zd_settings`
    rows: int | None            # number of samples, including the start; None with adaptive steps, as it is not known in advance

    @property
    def steps(self) -> int | None:
        """Number of fixed steps; None with adaptive steps."""
        of = self.core_settings
        return gateway.count_steps(of.t0, of.t1, of.step) if self.settings["step"] else None


class _Known(NamedTuple):
    """Settings that do not depend on the time span; cached."""

    settings: dict[str, Any]
    core_settings: Any
    corrections: Sequence[RowSettings]
    requires: int               # bit mask of the terms that the corrections require


def plan(system: BaseSystem, span: tuple[float, float], given: Arguments) -> CheckedSettings:
    """Check the arguments of `simulate` and translate them for the core."""
    others = vars(given) | {"t_eval": None}
    if isinstance(given.correction, list):
        others["correction"] = tuple(given.correction)
    key = system._formulation if given.formulation is None else given.formulation, vector_unit(given.vector), *others.values()
    try:
        found = _plan(*key)
    except TypeError:       # raised for unhashable arguments, too, most of which are wrong: check them without the cache
        found = _plan.__wrapped__(*key)
    if found.requires & ~core_of(system).provides:
        _refuse_corrections(system, found.corrections)
    settings = found.settings.copy()
    course: dict[str, Any] = {"t0": span[0], "t1": span[1]}
    _check_resolved(settings, span)
    if given.t_eval is None:
        rows = saved_rows(span, settings)
    else:
        course["t_eval"] = settings["t_eval"] = times = times_to_save(given.t_eval, settings["save_every"], span)
        rows = len(times) + 1       # one more, as an event may end the run between two of them
    return CheckedSettings(settings, gateway.settings(course, found.core_settings), rows)


# Cached, as the checks take as long as a short run. `typed` keeps 1 and True apart.
@functools.lru_cache(typed=True)
def _plan(formulation: Any, vector: str, *others: Any) -> _Known:
    given = Arguments(*others)
    on_singular_row(given.on_singular)
    if given.closed_form is not None and given.closed_form is not False:
        raise WrongValue(f"closed_form must be None, which uses closed-form functions, or False, not {given.closed_form!r}")
    integrator: Any = given.integrator
    if integrator is None:
        integrator = CHOOSING if given.step is None else INTEGRATOR
    chosen, corrections, requires = _methods(formulation, integrator, given)
    settings = {**_steps(integrator, given), **chosen, "save_every": checks.count("save_every", given.save_every),
                "on_singular": given.on_singular, "closed_form": given.closed_form, "vector": vector}
    return _Known(settings, core_settings((0.0, 0.0), settings), corrections, requires)


VECTOR_UNITS = ("baseline", "avx2", "avx512")       # index: number in the core


def vector_unit(given: str | None) -> str:
    """Vector unit from the argument `vector`, else from ZERODRIFT_VECTOR, else the widest of the processor."""
    if given is not None:
        name, said = "vector", given
    else:
        name, said = "ZERODRIFT_VECTOR", os.environ.get("ZERODRIFT_VECTOR") or VECTOR_UNITS[gateway.PROCESSOR_UNIT]
    checks.choice(name, said, VECTOR_UNITS)
    if VECTOR_UNITS.index(said) > gateway.PROCESSOR_UNIT:
        has = " or ".join(map(repr, VECTOR_UNITS[:gateway.PROCESSOR_UNIT + 1]))
        raise WrongValue(f"{name} must be {has}, which this processor has, not {said!r}")
    return said


def times_to_save(t_eval: Any, save_every: int, span: tuple[float, float]) -> np.ndarray:
    if save_every != 1:
        raise WrongValue("save_every must be 1 where t_eval is given: one counts steps, the other lists times",
                         "conflicting-arguments")
    times = checks.increasing("t_eval", t_eval, *span)
    times.flags.writeable = False
    return times


def _check_resolved(settings: dict[str, Any], span: tuple[float, float]) -> None:
    """Check that the steps are long enough to change the time in double precision."""
    latest = max(abs(span[0]), abs(span[1]))
    smallest, step = RESOLVED * latest, settings["step"]
    if step is None:
        for name in ("first_step", "max_step"):
            if settings[name] is not None:
                checks.number(name, settings[name], least=smallest, code="step-size")
    elif step < smallest:
        raise WrongValue(f"step must be at least {smallest:.3g} for times up to {latest:g}, not {step:g}", "step-size")


def _steps(integrator: Any, given: Arguments) -> dict[str, Any]:
    """Settings of fixed steps (`step` given) or of adaptive steps, checked."""
    name_of("integrators", integrator)
    tolerances = {name: getattr(given, name) for name in TOLERANCES}
    max_steps = None if given.max_steps is None else checks.count("max_steps", given.max_steps)
    if given.step is None:
        return {"step": None, **_tolerances(integrator, tolerances), "max_steps": max_steps}
    for name, value in tolerances.items():
        if value is not None:
            raise WrongValue(f"{name} is for adaptive steps: step must be left out with it", "conflicting-arguments")
    return {"step": checks.number("step", given.step, above=0, code="step-size")}


def _tolerances(integrator: Any, given: dict[str, Any]) -> dict[str, Any]:
    able = [name for name, card in integrators().items() if card.error_order]
    name = name_of("integrators", integrator)
    if name not in able:
        asked = "".join(f", and {word} is for adaptive steps" for word, value in given.items() if value is not None)
        raise WrongValue(f"step must be given: {name!r} takes fixed steps{asked}; give step=, or "
                         f"{' or '.join(f'integrator={each!r}' for each in able)}, which can take adaptive steps", "step-size")
    given = {name: None if name.startswith("max_") and value == math.inf else value for name, value in given.items()}
    values = TOLERANCES | {name: value for name, value in given.items() if value is not None}
    least = {"rtol": FINEST_RTOL, "atol": 0.0}
    found: dict[str, Any] = {name: None if value is None else checks.number(
        name, value, least=least.get(name), code="tolerance" if name in least else "step-size") for name, value in values.items()}
    if found["max_move"] is not None:
        checks.number("max_move", found["max_move"], above=0, code="step-size")
    if found["rtol"] > 1:
        raise WrongValue(f"rtol must be at most 1, not {found['rtol']:g}: it is a part of the state", "tolerance")
    if found["atol"] == 0:
        raise WrongValue("atol must be greater than 0: parts of the state pass through zero", "tolerance")
    return found


def _methods(formulation: Any, integrator: Any, given: Arguments) -> tuple[dict[str, Any], list[RowSettings], int]:
    """Settings of methods, checked; all corrections among them; and the bit mask of the terms that these require."""
    name_of("formulations", formulation)
    found = {"formulation": formulation, "integrator": integrator, "stabilization": stabilization(given.stabilization),
             "energy": energy(given.energy)}
    if more := correction(given.correction):
        found["correction"] = more
    corrections = corrections_of(found)
    names = [each.card.name for each in corrections]
    for name in names:
        if names.count(name) > 1:
            others = f"{ARGUMENTS[name]} and " if name in ARGUMENTS else ""
            raise WrongValue(f"each correction must be given once, but {name} is given more often, by {others}correction",
                             "duplicate-name")
    return found, corrections, functools.reduce(operator.or_, map(gateway.required, names), 0)


def _refuse_corrections(system: BaseSystem, corrections: Sequence[RowSettings]) -> None:
    for name in (each.card.name for each in corrections):
        for term, row in gateway.TERMS.items():
            if row.bit & gateway.required(name) & ~core_of(system).provides:
                raise WrongValue(f"{name} correction needs {term} ({row.text}), and {system.name} declares none", "not-available")


def saved_rows(span: tuple[float, float], settings: dict[str, Any]) -> int | None:
    """Number of samples of a run, including the start; None with adaptive steps, as it is not known in advance."""
    if settings["step"] is None:
        return None
    steps = gateway.count_steps(*span, settings["step"])
    return steps // settings["save_every"] + 1 + (steps % settings["save_every"] != 0)


# Settings that the core has under the same name with the same value.
_PASSED_ON = ("step", "rtol", "atol", "first_step", "max_step", "max_move", "max_steps", "save_every", "t_eval")


def core_settings(span: tuple[float, float], settings: dict[str, Any]) -> Any:
    """Settings of the core from those of a solution."""
    like = _core_methods(settings["formulation"], settings["integrator"], settings.get("on_singular", "stop"),
                         settings.get("closed_form") is None, VECTOR_UNITS.index(settings.get("vector") or "baseline"),
                         *corrections_of(settings))
    changed = {name: settings[name] for name in _PASSED_ON if settings.get(name) is not None}
    steps = gateway.ADAPTIVE_STEPS if settings.get("step") is None else gateway.FIXED_STEPS
    return gateway.settings({"t0": span[0], "t1": span[1], "steps": steps, **changed}, like)


@functools.lru_cache(typed=True)
def _core_methods(formulation: Any, integrator: Any, on_singular: str, closed_form: bool, vector: int,
                  *corrections: RowSettings) -> Any:
    """Settings of the core that select the methods; cached."""
    return gateway.settings({
        "formulation": row_of("formulations", formulation), "integrator": row_of("integrators", integrator),
        "on_singular": on_singular_row(on_singular), "closed_form": closed_form, "vector": vector,
        **given(formulation, integrator, *corrections)})


def disagreement(settings: dict[str, Any]) -> str:
    """Reason why the methods in these settings cannot be combined; empty if they can."""
    return gateway.disagreement(core_settings((0.0, 0.0), settings))


def given(*chosen: Any) -> dict[str, Any]:
    """Parameters of the methods among `chosen` that are settings instead of names, by the field of `zd_settings`."""
    rows = [each for each in chosen if isinstance(each, RowSettings)]
    fields = {f"of_{each.table.removesuffix('s')}": each._values() for each in rows if each.table != "corrections"}
    return fields | {"correction": {each.card.name: each._values() for each in rows if each.table == "corrections"}}
