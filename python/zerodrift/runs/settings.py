"""What a run may be told: formulation, integrator, stabilization, energy correction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from .. import _check, _gateway
from ..systems.base import BaseSystem, core_of


def _keep(settings: Any, **checked: float) -> None:
    """Keep numbers of Python's own kinds, whatever kinds were given: equal settings then are saved alike."""
    for name, value in checked.items():
        object.__setattr__(settings, name, value)


@dataclass(frozen=True, slots=True)
class Projection:
    """Correct positions and velocities after the step, (25)-(27).

    Parameters
    ----------
    tol : float
        Positions are iterated until every ``|Phi|`` is at most this, in units of its size `Solution.position_size`: the largest
        ``|C_ki|`` times one radian of an angle or the mechanism's own length, at the start. So it means the same in any
        unit; it is as if coordinates were off by so many rad or parts of that length.
    max_iterations : int
        At most so many. A correction that needs more is tried again with shortened iterations, then with the step in up to
        eight parts (or shorter, where steps are chosen), all counted in `Solution.stats`; if none helps, it is an error.
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
        _keep(self, tol=_check.number("tol", self.tol, above=0), every=_check.count("every", self.every),
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
        _keep(self, **{name: _check.number(name, getattr(self, name), least=0) for name in ("alpha", "beta", "integral")})
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
        _keep(self, every=_check.count("every", self.every))

    def _core(self) -> dict[str, Any]:
        return {"energy": {"every": self.every}}


STABILIZATIONS = {"projection": Projection, "baumgarte": Baumgarte}
Stabilization = Projection | Baumgarte | None


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


class _Names(dict):
    """Cards by name, printed as a table."""

    def __repr__(self) -> str:
        width = max(map(len, self), default=0)
        return "\n".join(f"{card.name:{width}}  {card.equations:24}  {card.summary}" for card in self.values())


def _names(table: str) -> _Names:
    return _Names({card.name: card for card in _gateway.cards(table)})


_FORMULATIONS, _INTEGRATORS, _CORRECTIONS = _names("formulations"), _names("integrators"), _names("corrections")


def formulations() -> dict[str, _gateway.Card]:
    """The formulations there are, by name.

    Examples
    --------
    >>> import zerodrift as zd
    >>> zd.formulations()["schur"].equations
    '(13), (27)'
    """
    return _Names(_FORMULATIONS)


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
        return _Names(_INTEGRATORS)
    core = core_of(system)
    return _Names({name: card for row, (name, card) in enumerate(_INTEGRATORS.items()) if core.suits(row)})


def corrections() -> dict[str, _gateway.Card]:
    """The corrections there are, by name, in the order in which they are applied."""
    return _Names(_CORRECTIONS)


def formulation_row(name: Any) -> int:
    """The row of a formulation in the core's table."""
    return list(_FORMULATIONS).index(_check.choice("formulation", name, _FORMULATIONS))


def integrator_row(name: Any) -> int:
    """The row of an integrator in the core's table."""
    return list(_INTEGRATORS).index(_check.choice("integrator", name, _INTEGRATORS))


ON_SINGULAR = ("stop", "continue")


def on_singular_row(value: Any) -> int:
    """What the core calls the argument `on_singular`."""
    return ON_SINGULAR.index(_check.choice("on_singular", value, ON_SINGULAR))


# Settings that the core takes as they are.
_PLAIN = ("step", "rtol", "atol", "first_step", "max_step", "save_every", "t_eval")


def core_settings(span: tuple[float, float], chosen: dict[str, Any]) -> Any:
    """The core's settings from a solution's."""
    options = {"formulation": formulation_row(chosen["formulation"]),
               "integrator": integrator_row(chosen["integrator"]), "t0": span[0], "t1": span[1],
               "on_singular": on_singular_row(chosen.get("on_singular", "stop"))}
    options |= {name: chosen[name] for name in _PLAIN if chosen.get(name) is not None}
    for correction in (chosen["stabilization"], chosen["energy"]):
        options |= correction._core() if correction else {}
    return _gateway.settings(options)
