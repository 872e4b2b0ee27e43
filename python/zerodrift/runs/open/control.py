"""Controllers: functions that are called at exact multiples of a period and set inputs."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, overload

from ..._private import checks
from ...errors import WrongType, WrongValue

WHOLE = 1e-9        # relative deviation of a period from a whole number of steps
TIME_ROUNDING = 2.0**-50    # relative, of times that are counted in steps


class Every:
    """A function that is called at multiples of a period; `zerodrift.every` makes it.

    Attributes
    ----------
    period : float
        s
    call : callable
        ``call(run)``.
    """

    def __init__(self, period: Any, call: Callable[[Any], Any]) -> None:
        self.period = checks.number("period", period, above=0)
        if not callable(call):
            raise WrongType(f"call must be a function of the run, not {checks.shown(call)}")
        self.call = call

    def act(self, run: Any) -> None:
        """Call it; what it raises gets a note on when."""
        try:
            self.call(run)
        except BaseException as error:
            checks.tell(error, f"in control {self!r}, called at t = {run.t:g}")
            raise

    def __repr__(self) -> str:
        return f"<every {self.period:g} s: {getattr(self.call, '__name__', repr(self.call))}>"


@overload
def every(period: float) -> Callable[[Callable[[Any], object]], Every]: ...


@overload
def every(period: float, call: Callable[[Any], object]) -> Every: ...


def every(period: float, call: Callable[[Any], object] | None = None) -> Any:
    """A controller: a function that a run calls at its start and at exact multiples of a period, and that sets inputs.

    Parameters
    ----------
    period : float
        In s, counted from the start of the run. With fixed steps it must be a whole number of steps. Adaptive steps end at these
        instants, and so do fixed ones after a shortened step, to the time of `Run.advance_to` or to a terminal event.
    call : callable
        ``call(run)`` receives the `Run` at its present state; values that it assigns to ``run[name]`` or ``run.inputs`` hold
        until they are assigned again. Its return value is ignored. It must not step, advance, reset, restore or close this run,
        but may do so with a `copy` of it. Left out: `every` is a decorator.

    Returns
    -------
    Every
        For the argument `control` of `simulate` and of `Run`.

    Raises
    ------
    ValueError, TypeError
        If the period is not a positive number, or `call` not callable.

    Examples
    --------
    A motor that holds an arm against gravity, by a proportional and derivative law that is sampled at 100 Hz:

    >>> import zerodrift as zd
    >>> m = zd.Mechanism("arm", gravity=(0, -9.81))
    >>> arm = m.link("arm", (0, 0), (1, 0), mass=1.0)
    >>> pin = m.revolute("pin", m.ground, arm.start)
    >>> drive = m.motor("drive", pin, torque=0.0)
    >>> @zd.every(0.01)
    ... def hold(run: zd.Run) -> None:
    ...     run["drive.torque"] = 4.905 - 50.0 * run["pin.angle"] - 10.0 * run["pin.speed"]
    >>> sol = zd.simulate(m, 2.0, step=0.002, inputs=["drive.torque"], control=hold)
    >>> bool(abs(sol["pin.angle"][-1]) < 1e-3)
    True
    """
    if call is None:
        return lambda function: Every(period, function)
    return Every(period, call)


def controls(given: Any) -> tuple[Every, ...]:
    """Check the argument `control`: None, a controller, or several."""
    several = () if given is None else tuple(given) if isinstance(given, Sequence) else (given,)
    for each in several:
        if not isinstance(each, Every):
            raise WrongType(f"control must be zd.every(period, call=f), or a list of these, not {checks.shown(each)}")
    return several


class Sampling:
    """The instants at which the controllers of a run are due.

    Parameters
    ----------
    of : tuple of Every
    t0 : float
        s: start of the run.
    step : float or None
        Size of fixed steps; None: adaptive steps.
    """

    def __init__(self, of: tuple[Every, ...], t0: float, step: float | None) -> None:
        self._of, self._t0, self._step = of, t0, step
        self._periods = [(1, each.period) if step is None else (_steps_of(each.period, step), step) for each in of]
        self.begin()

    def begin(self) -> None:
        """Let every controller be called at the present state, if it is due there."""
        self._called: list[int | None] = [None] * len(self._of)

    def call(self, run: Any) -> None:
        """Call the controllers that are due at the present state and have not been called at this instant."""
        for i, each in enumerate(self._of):
            number = self._number_at(i, run)
            if number is not None and self._called[i] != number:
                self._called[i] = number
                called(each.act, run)

    def _is_on_grid(self, run: Any) -> bool:
        """True if all steps so far were fixed ones of full size, so that instants are counted in steps."""
        if self._step is None:
            return False
        return abs(self._t0 + run.steps * self._step - run.t) <= TIME_ROUNDING * max(abs(self._t0), abs(run.t))

    def _number_at(self, i: int, run: Any) -> int | None:
        """Number of the instant at which the run is; None: it is between two."""
        if self._is_on_grid(run):
            number, beyond = divmod(run.steps, self._periods[i][0])
            return None if beyond else number
        number = self._nearest(i, run.t)
        return number if abs(self._instant(i, number) - run.t) <= self._rounding(i, run.t) else None

    def _nearest(self, i: int, t: float) -> int:
        return round((t - self._t0) / self._period(i))

    def _period(self, i: int) -> float:
        return math.prod(self._periods[i])

    def _instant(self, i: int, number: int) -> float:
        steps, size = self._periods[i]
        return self._t0 + number * steps * size

    def _rounding(self, i: int, t: float) -> float:
        """Distance in s within which a time is at an instant, as the core does not shorten a step by less."""
        return WHOLE * self._period(i) + TIME_ROUNDING * max(abs(self._t0), abs(t))

    def next(self, run: Any) -> tuple[int | None, float]:
        """The next instant: number of steps to it where instants are counted in steps; else its time."""
        if self._is_on_grid(run):
            return min(steps - run.steps % steps for steps, _ in self._periods), math.inf
        return None, min(self._after(i, run.t) for i in range(len(self._of)))

    def _after(self, i: int, t: float) -> float:
        number = self._nearest(i, t)
        while self._instant(i, number) <= t + self._rounding(i, t):
            number += 1
        return self._instant(i, number)


def called(call: Callable[[Any], object], run: Any) -> None:
    """Call what acts on a run, which it must not step meanwhile. `Keyboard` recognizes it by the code of this function."""
    run._is_controlled = True
    try:
        call(run)
    finally:
        run._is_controlled = False


def _steps_of(period: float, step: float) -> int:
    """Number of steps in a period."""
    steps = max(1, round(period / step))
    if abs(period / step - steps) > WHOLE * steps:
        raise WrongValue(f"step must divide the period {period:g} s of control, and {step:g} s does not: the nearest that does "
                         f"is {period / steps:.17g} s", "step-size")
    return steps
