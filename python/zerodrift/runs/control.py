"""Controllers: functions that are called at exact multiples of a period and set inputs."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from .. import _check
from ..errors import WrongType, WrongValue

WHOLE = 1e-9        # relative deviation of a period from a whole number of steps


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
        self.period = _check.number("period", period, above=0)
        if not callable(call):
            raise WrongType(f"call must be a function of the run, not {_check.shown(call)}")
        self.call = call

    def __repr__(self) -> str:
        return f"<every {self.period:g} s: {getattr(self.call, '__name__', repr(self.call))}>"


def every(period: float, call: Callable[[Any], Any] | None = None) -> Any:
    """A controller: a function that a run calls at its start and at exact multiples of a period, and that sets inputs.

    Parameters
    ----------
    period : float
        In s, counted from the start of the run. With fixed steps it must be a whole number of steps; adaptive steps end at these
        instants.
    call : callable
        ``call(run)`` receives the `Run` at its present state; what it assigns to ``run[name]`` or ``run.inputs`` holds until it
        is assigned again. Its return value is ignored. It must not step, advance, reset, restore or close this run; a
        `copy` of it is free. Left out: `every` is a decorator.

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
    ... def hold(run):
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
            raise WrongType(f"control must be zd.every(period, call=f), or a list of these, not {_check.shown(each)}")
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
        self._of, self._t0 = of, t0
        self._steps = None if step is None else [_steps_of(each.period, step) for each in of]
        self.begin()

    def begin(self) -> None:
        """Let every controller be called at the present state, if it is due there."""
        self._called: list[float | None] = [None] * len(self._of)

    def call(self, run: Any) -> None:
        """Call the controllers that are due at the present state and have not been called there."""
        now = self._now(run)
        for i, each in enumerate(self._of):
            if self._called[i] != now and self._is_due(i, now):
                self._called[i] = now
                called(each, run)

    def _now(self, run: Any) -> float:
        return run.t if self._steps is None else run.steps

    def _is_due(self, i: int, now: float) -> bool:
        if self._steps is not None:
            return now % self._steps[i] == 0
        return self._instant(i, self._number(i, now)) == now

    def _number(self, i: int, t: float) -> int:
        return round((t - self._t0) / self._of[i].period)

    def _instant(self, i: int, number: int) -> float:
        return self._t0 + number * self._of[i].period

    def next(self, run: Any) -> tuple[int | None, float]:
        """Number of steps to the next instant, with fixed steps; and its time, with adaptive ones."""
        if self._steps is not None:
            return min(each - run.steps % each for each in self._steps), math.inf
        return None, min(map(self._after, range(len(self._of)), [run.t] * len(self._of)))

    def _after(self, i: int, t: float) -> float:
        number = self._number(i, t) - 1
        while self._instant(i, number) <= t:
            number += 1
        return self._instant(i, number)


def called(each: Every, run: Any) -> None:
    """Call a controller; what it raises gets a note on when. `Keyboard` recognizes it by the code of this function."""
    run._is_controlled = True
    try:
        each.call(run)
    except BaseException as error:
        _check.tell(error, f"in control {each!r}, called at t = {run.t:g}")
        raise
    finally:
        run._is_controlled = False


def _steps_of(period: float, step: float) -> int:
    """Number of steps in a period."""
    steps = max(1, round(period / step))
    if abs(period / step - steps) > WHOLE * steps:
        raise WrongValue(f"step must divide the period {period:g} s of control, and {step:g} s does not: the nearest that does "
                         f"is {period / steps:.17g} s", "step-size")
    return steps
