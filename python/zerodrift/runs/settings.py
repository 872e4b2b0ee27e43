"""What a run may be told: formulation, integrator, stabilization, energy correction, steps, and what is saved."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from .. import _check, _gateway
from ..systems.base import BaseSystem, core_of


def _set(settings: Any, **numbers: float) -> None:
    """Replace attributes of frozen settings by Python's own numbers, so that equal settings are saved alike."""
    for name, value in numbers.items():
        object.__setattr__(settings, name, value)


@dataclass(frozen=True, slots=True)
class Projection:
    """Correct positions and velocities after the step, (25)-(27).

    Parameters
    ----------
    tol : float
        Positions are iterated until every ``|Phi|`` is at most this, in units of its size `Solution.position_size`: the largest
        ``|C_ki|`` times one radian of an angle or the mechanism's own length, at the start. The tolerance so means the same
        in any unit: angles are off by about that many rad, and lengths by that part of the mechanism's length.
    max_iterations : int
        The largest number of iterations. A correction that needs more is tried again with shortened iterations, then with the
        step in up to eight parts (or shorter, where steps are chosen); `Solution.stats` counts all of them. Where none of this
        helps, the run fails.
    every : int
        Steps between corrections; the last step is always corrected.
    metric : {"mass", "identity"}
        What the correction is orthogonal in: the mass matrix, or (for comparison) the identity of the paper's reference [20].
    positions, velocities : bool
        Which of the two are corrected.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.systems.four_bar(), 8.0, step=0.01, stabilization=zd.Projection(tol=1e-10))
    >>> bool(abs(sol.position_violation).max() <= 1e-10)
    True
    """

    METRICS: ClassVar = ("mass", "identity")

    tol: float = 1e-12
    max_iterations: int = 10
    every: int = 1
    metric: str = "mass"
    positions: bool = True
    velocities: bool = True

    def __post_init__(self) -> None:
        _set(self, tol=_check.number("tol", self.tol, above=0), every=_check.count("every", self.every),
              max_iterations=_check.count("max_iterations", self.max_iterations))
        _check.choice("metric", self.metric, self.METRICS)
        for name in ("positions", "velocities"):
            if not isinstance(getattr(self, name), bool):
                raise TypeError(f"{name} must be True or False, not {getattr(self, name)!r}")

    def _core(self) -> dict[str, Any]:
        return {"projection": {
            "every": self.every, "tolerance": self.tol, "max_iterations": self.max_iterations,
            "metric": self.METRICS.index(self.metric), "positions": self.positions, "velocities": self.velocities}}


@dataclass(frozen=True, slots=True)
class Baumgarte:
    """Feed violations back into the acceleration constraints, (23).

    Parameters
    ----------
    alpha, beta : float
        Gains of the velocity and the position violation, in 1/s and 1/s^2. ``beta = alpha**2 / 4`` damps critically.
    integral : float
        Gain of the time integral of the position violation in 1/s^3, after the paper's reference [16]; it must be less
        than ``alpha * beta``, or the feedback itself is unstable.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.systems.four_bar(), 8.0, step=0.01, stabilization=zd.Baumgarte(alpha=10, beta=25))
    """

    alpha: float = 10.0
    beta: float = 25.0
    integral: float = 0.0

    def __post_init__(self) -> None:
        _set(self, **{name: _check.number(name, getattr(self, name), least=0) for name in ("alpha", "beta", "integral")})
        if self.integral and not self.integral < self.alpha * self.beta:
            raise ValueError(f"integral must be less than alpha * beta = {self.alpha * self.beta:g}, not {self.integral:g}")

    def _core(self) -> dict[str, Any]:
        return {"baumgarte": {"on": 1, "alpha": self.alpha, "beta": self.beta, "integral": self.integral}}


@dataclass(frozen=True, slots=True)
class EnergyCorrection:
    """Scale the velocities after the step so that the energy balance (28) holds, (29).

    Parameters
    ----------
    every : int
        Steps between corrections; the last step is always corrected.
    """

    every: int = 1

    def __post_init__(self) -> None:
        _set(self, every=_check.count("every", self.every))

    def _core(self) -> dict[str, Any]:
        return {"energy": {"every": self.every}}


STABILIZATIONS = {"projection": Projection, "baumgarte": Baumgarte}
Stabilization = Projection | Baumgarte | None
# What is taken where nothing else is asked for.
FORMULATION, INTEGRATOR, STABILIZATION = map(_gateway.default, ("formulations", "integrators", "corrections"))


def stabilization(value: Any) -> Stabilization:
    """The argument `stabilization` of `simulate`: None, a word, or settings."""
    if value is None or isinstance(value, tuple(STABILIZATIONS.values())):
        return value
    if isinstance(value, str):
        return STABILIZATIONS[_check.choice("stabilization", value, STABILIZATIONS)]()
    raise TypeError(f"stabilization must be None, {', '.join(map(repr, STABILIZATIONS))}, zd.Projection(...) "
                    f"or zd.Baumgarte(...), not {value!r}")


def energy(value: Any) -> EnergyCorrection | None:
    """The argument `energy` of `simulate`."""
    if value is None or value is False:
        return None
    if value is True:
        return EnergyCorrection()
    if isinstance(value, EnergyCorrection):
        return value
    raise TypeError(f"energy must be None, True or zd.EnergyCorrection(...), not {value!r}")


class CardTable(dict):
    """The cards of a table of the core by name, printed as a table."""

    def __repr__(self) -> str:
        width = max(map(len, self), default=0)
        return "\n".join(f"{card.name:{width}}  {card.equations:24}  {card.summary}" for card in self.values())


def _table(name: str) -> CardTable:
    return CardTable({card.name: card for card in _gateway.cards(name)})


_FORMULATIONS, _INTEGRATORS, _CORRECTIONS = _table("formulations"), _table("integrators"), _table("corrections")


def formulations(system: BaseSystem | None = None) -> dict[str, _gateway.Card]:
    """The formulations there are, by name, or those that can take a system.

    Examples
    --------
    >>> import zerodrift as zd
    >>> zd.formulations()["schur"].equations
    '(13), (27)'
    >>> "independent" in zd.formulations(zd.systems.four_bar())
    True
    """
    if system is None:
        return CardTable(_FORMULATIONS)
    core = core_of(system)
    return CardTable({name: card for row, (name, card) in enumerate(_FORMULATIONS.items()) if core.suits_formulation(row)})


def integrators(system: BaseSystem | None = None) -> dict[str, _gateway.Card]:
    """The integrators there are, by name, or those that can take a system.

    `order` is the order of the method, `stability` the largest omega h at which a motion that is somewhat damped does not
    grow, 0 where there is none.

    Examples
    --------
    >>> import zerodrift as zd
    >>> zd.integrators()["rk4"].order
    4
    >>> "rattle" in zd.integrators(zd.systems.rolling_disc())
    False
    """
    if system is None:
        return CardTable(_INTEGRATORS)
    core = core_of(system)
    return CardTable({name: card for row, (name, card) in enumerate(_INTEGRATORS.items()) if core.suits(row)})


def corrections() -> dict[str, _gateway.Card]:
    """The corrections there are, by name, in the order in which they are applied."""
    return CardTable(_CORRECTIONS)


def formulation_row(name: Any) -> int:
    """The row of a formulation in the core's table."""
    return list(_FORMULATIONS).index(_check.choice("formulation", name, _FORMULATIONS))


def integrator_row(name: Any) -> int:
    """The row of an integrator in the core's table."""
    return list(_INTEGRATORS).index(_check.choice("integrator", name, _INTEGRATORS))


ON_SINGULAR = ("stop", "continue")


def on_singular_row(value: Any) -> int:
    """The number by which the core knows a value of the argument `on_singular`."""
    return ON_SINGULAR.index(_check.choice("on_singular", value, ON_SINGULAR))


# ---- all arguments of `simulate` ----

MAX_STEPS = 1_000_000     # where steps are chosen
TOLERANCES = {"rtol": 1e-6, "atol": 1e-9, "first_step": None, "max_step": None}     # where steps are chosen
FINEST_RTOL = 100 * np.finfo(float).eps     # below, error estimates are round-off


def checked(system: BaseSystem, span: tuple[float, float], *, on_singular: Any, formulation: Any, integrator: Any,
            stabilization: Any, energy: Any, save_every: Any, t_eval: Any, step: Any, max_steps: Any,
            **tolerances: Any) -> dict[str, Any]:
    """The arguments of `simulate`, checked, as `Solution.settings` keeps them."""
    on_singular_row(on_singular)
    return {**_steps(span, step, integrator, max_steps, tolerances),
            **_methods(system, formulation, integrator, stabilization, energy), **_saved(span, save_every, t_eval),
            "on_singular": on_singular}


def _steps(span: tuple[float, float], step: Any, integrator: Any, max_steps: Any, tolerances: dict[str, Any]) -> dict[str, Any]:
    """How steps are made: of a fixed size, or chosen by their error."""
    integrator_row(integrator)
    max_steps = None if max_steps is None else _check.count("max_steps", max_steps)
    latest = max(map(abs, span))
    smallest = 16 * np.finfo(float).eps * latest
    if step is None:
        return {"step": None, **_tolerances(integrator, tolerances, smallest), "max_steps": max_steps}
    for name, value in tolerances.items():
        if value is not None:
            raise ValueError(f"{name} is for steps that are chosen by their error: with it, leave out step")
    step = _check.number("step", step, above=0)
    if step < smallest:
        raise ValueError(f"step must be at least {smallest:.3g} for times up to {latest:g}, not {step:g}")
    return {"step": step}


def _tolerances(integrator: str, given: dict[str, Any], smallest: float) -> dict[str, Any]:
    able = [name for name, card in integrators().items() if card.error_order]
    if integrator not in able:
        raise ValueError(f"step is needed: {integrator!r} takes steps of fixed size; "
                         f"{', '.join(map(repr, able))} can choose theirs")
    values = TOLERANCES | {name: value for name, value in given.items() if value is not None}
    least = {"rtol": FINEST_RTOL, "atol": 0.0, "first_step": smallest, "max_step": smallest}
    found = {name: None if value is None else _check.number(name, value, least=least[name]) for name, value in values.items()}
    if found["atol"] == 0:
        raise ValueError("atol must be greater than 0: parts of the state pass through zero")
    return found


def _methods(system: BaseSystem, formulation: Any, integrator: Any, given_stabilization: Any,
             given_energy: Any) -> dict[str, Any]:
    """Equations, integrator and corrections."""
    formulation_row(formulation)
    correction = energy(given_energy)
    if correction and not system.has_energy:
        raise ValueError(f"energy correction needs a potential energy, and {system.name} declares none")
    return {"formulation": formulation, "integrator": integrator, "stabilization": stabilization(given_stabilization),
            "energy": correction}


def _saved(span: tuple[float, float], save_every: Any, t_eval: Any) -> dict[str, Any]:
    """Which rows are saved."""
    save_every = _check.count("save_every", save_every)
    if t_eval is None:
        return {"save_every": save_every}
    if save_every != 1:
        raise ValueError("save_every counts steps, and t_eval names times: give one of them")
    times = _check.increasing("t_eval", t_eval, *span)
    times.flags.writeable = False
    return {"save_every": 1, "t_eval": times}


def saved_rows(span: tuple[float, float], chosen: dict[str, Any]) -> int | None:
    """The number of rows that a run saves, its start included; None where it is not known, as steps are chosen."""
    if "t_eval" in chosen:
        return len(chosen["t_eval"]) + 1    # an event may end the run between two of them
    if chosen["step"] is None:
        return None
    steps = _gateway.count_steps(*span, chosen["step"])
    return steps // chosen["save_every"] + 1 + (steps % chosen["save_every"] != 0)


# Settings that the core takes under the same name and without any change.
_PASSED_ON = ("step", "rtol", "atol", "first_step", "max_step", "max_steps", "save_every", "t_eval")


def core_settings(span: tuple[float, float], chosen: dict[str, Any]) -> Any:
    """The core's settings from a solution's."""
    options = {"formulation": formulation_row(chosen["formulation"]),
               "integrator": integrator_row(chosen["integrator"]), "t0": span[0], "t1": span[1],
               "on_singular": on_singular_row(chosen.get("on_singular", "stop"))}
    options |= {name: chosen[name] for name in _PASSED_ON if chosen.get(name) is not None}
    for correction in (chosen["stabilization"], chosen["energy"]):
        options |= correction._core() if correction else {}
    return _gateway.settings(options)
