"""`Solution`: the result of a run."""

from __future__ import annotations

import bisect
import itertools
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ..._private import checks
from ..._private.types import ArrayLike
from ...errors import WrongValue
from ...systems.base import BaseSystem
from ..states.instant import Instant
from .between_samples import states_between
from .columns import to_csv, to_excel, to_frame
from .loads import Loaded
from .named import Named, Stats
from .phases import Phase, impacts_of, phases_of, state_from_samples
from .saving import write
from .summary import summary

if TYPE_CHECKING:
    from pathlib import Path

A_SOLUTION = "a Solution, as zd.simulate returns it"      # for error messages


@dataclass(frozen=True, eq=False, repr=False)
class Solution(Named, Loaded):
    """Result of a run: the motion at sampled times, constraint violation, energies, and statistics.

    The first axis of every array is time (k samples); arrays are read-only. ``sol["name"]`` is the column of the coordinate,
    velocity, constraint (its multiplier) or measure of that name. ``sol(t)`` interpolates.

    Attributes
    ----------
    t : ndarray (k,)
        Times in s.
    p, v : ndarray (k, nq), (k, nv)
        Coordinates and velocities, in the units of `system`.
    multipliers : ndarray (k, m)
        Constraint reactions with the sign of (7), ``M vdot + d = f - C.T @ multipliers``.
    position_violation : ndarray (k, mh)
        Position constraint residual Phi of (3), in the units of the constraints.
    velocity_violation : ndarray (k, m)
        Velocity constraint residual Psi of (5).
    kinetic_energy : ndarray (k,)
        T in J.
    potential_energy, energy_input, energy_violation : ndarray (k,) or None
        V, the integral of the energy input rate, and the residual Psi_E of the energy balance (28), in J; None if the system
        declares no potential.
    iterations : ndarray (k,)
        Largest number of iterations of a position projection since the previous sample.
    energy_skipped : ndarray (k,)
        Number of energy corrections skipped since the previous sample because no bounded factor (29) would have removed the
        error.
    position_size : ndarray (mh,)
        Characteristic size of each component of Phi, by which `Projection` scales its tolerance.
    stats : dict
        Statistics of the run; empty for a killed run.

        * `steps`, `evaluations`, `factorizations`, ...: counts; `seconds`: time spent in the core.
        * `omega_h`: largest product of the motion's angular frequency and a fixed step, small if an explicit method is accurate.
        * `largest_kinetic`: in J; it and `omega_h` are evaluated every few steps.
        * `energy_corrected`: largest error of the energy balance that a single correction removed, in J.
        * `omitted_bounce_time`, `omitted_bounce_energy`: duration in s and kinetic energy in J of bounces omitted as contacts
          that separate slower than the rest speed stay closed, summed over contacts. The energy balance includes the energy;
          `impacts` do not. The duration is infinite for a coefficient of restitution of 1.
        * `part_error`: estimated error that about a thousand successive fixed steps make in the motion of one coordinate (with
          `kinematics`, one velocity or rotation), in rad or relative to the mechanism's length; `part`: the coordinate with the
          largest one, or the velocity whose rate jumps where the step size has collapsed. `unresolved`: number of checks at
          which it exceeded 0.03 and a thousandth of the distance moved; `unresolved_time`: time of the first, in s.
        * `rank`: number of independent constraints; `redundant`: indices of linearly dependent ones; `rank_drops`: number of
          steps in which the rank was temporarily lower.
        * `smallest_pivot`: for a declared structure with more than 40 constraints, smallest relative pivot (square of the
          residual norm in the mass metric) of a constraint after elimination of others; `smallest_pivot_time`: its time in s;
          `smallest_pivot_row`: the constraint. Near a bifurcation it is small, and accelerations lose digits.
        * `matrix_path_reason`: reason why no step was evaluated in closed form; None if some were, or if systems of this kind
          have no closed form. `interpreted`: time that compiling the equations would save; None if they are compiled, or
          cannot be. `calls`: time in s in each user function that was called because it could not be recorded.
    status : int
        0: done; positive: ended early; negative: failed. All samples are valid in each case.
    success : bool
        True if the end or a terminal event was reached.
    message : str
        "done", or the reason for the end of the run.
    settings : dict
        Arguments of `simulate`: ``simulate(system, t_span, **settings)`` repeats the run. Events are not included, as they are
        functions. `vector` is the vector unit of the closed-form functions, None if the run used none.
    system : system
        The simulated system.
    t_span : tuple of float
        Requested (t0, t1) in s.
    jumps : ndarray (k,)
        Actions at events, and jumps of speeds that are prescribed or inputs, in order of time: structured, with the fields `t` in
        s, `name` of the event or motor, or "break" of a law, and `energy`, the change of the energy in J, which the balance
        includes.
    transitions : ndarray (k,)
        Start and changes of phase of a system with contacts, from which `phases` and `impacts` are made: structured, with the
        fields `t` in s and, by group of constraints, `state`, `impulse` in N s and `loss` in J. Empty for other systems.
    t_events : tuple of ndarray, or None
        Times of each event in s; None without `events`.
    p_events, v_events : tuple of ndarray (k, nq), (k, nv), or None
        Coordinates and velocities at those times.
    outputs : dict of str to ndarray (k,) or (k, size)
        Recorded measures by name.
    """

    t: np.ndarray
    p: np.ndarray
    v: np.ndarray
    multipliers: np.ndarray
    position_violation: np.ndarray
    velocity_violation: np.ndarray
    kinetic_energy: np.ndarray
    potential_energy: np.ndarray | None
    energy_input: np.ndarray | None
    energy_violation: np.ndarray | None
    iterations: np.ndarray
    energy_skipped: np.ndarray
    position_size: np.ndarray
    stats: dict[str, Any]
    status: int
    success: bool
    message: str
    settings: dict[str, Any]
    system: BaseSystem
    t_span: tuple[float, float]
    jumps: np.ndarray
    transitions: np.ndarray
    t_events: tuple[np.ndarray, ...] | Any = None
    p_events: tuple[np.ndarray, ...] | Any = None
    v_events: tuple[np.ndarray, ...] | Any = None
    outputs: dict[str, np.ndarray] = field(default_factory=dict)

    _repr_html_: ClassVar[Callable[[Solution], str]]      # set by the package, as runs know nothing of films

    def __post_init__(self) -> None:
        vars(self)["stats"] = Stats(self.stats)
        for value in list(vars(self).values()):
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
        for array in itertools.chain(self.t_events or (), self.p_events or (), self.v_events or (), self.outputs.values()):
            array.setflags(write=False)

    @property
    def phases(self) -> list[Phase]:
        """Phases of the run, in order: each has `t0`, `t1` in s and the `state` of each contact, stop and joint by name.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("ball", gravity=(0, -9.81))
        >>> ball = m.particle("ball", 1.0, at=(0, 1))
        >>> floor = m.contact("floor", ball, m.ground.line((0, 0), (1, 0)))
        >>> [str(phase) for phase in zd.simulate(m, 1.0).phases]
        ['0 to 0.451524 s: floor open', '0.451524 to 1 s: floor closed']
        """
        return phases_of(self.transitions, self.system._groups, float(self.t[-1]) if len(self.t) else self.t_span[0])

    @property
    def impacts(self) -> np.ndarray:
        """Impacts in order of time, (k,): structured, with `t` in s, `name`, `impulse` in N s (N m s) and `energy_lost` in J."""
        return impacts_of(self.transitions, self.system._groups)

    @classmethod
    def _of_run(cls, others: Callable[[], dict[str, Any]], **values: Any) -> Solution:
        """Solution with some fields given and a function that makes the others at first use.

        Making all fields and assigning them individually, as a frozen dataclass does, takes longer than a short run.
        """
        made = object.__new__(cls)
        vars(made).update(values, _others=others)
        return made

    if not TYPE_CHECKING:       # which has the fields already

        def __getattr__(self, name: str) -> Any:
            values = vars(self)
            if (others := values.get("_others")) and name in FIELDS:    # other threads may do the same and get equal values
                values.update(others())
                self.__post_init__()
                values["_others"] = None
            if name in FIELDS and name in values:
                return values[name]
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self)

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *FIELDS})

    def __reduce__(self) -> tuple[Any, ...]:
        # Copies and pickles are made by __init__, so that their arrays are read-only, too.
        return Solution, tuple(getattr(self, name) for name in FIELDS)

    def __repr__(self) -> str:
        return summary(self)

    def __call__(self, t: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and velocities at any times between the first and the last sample.

        With adaptive steps, the step around each time is repeated and its dense output evaluated, if the method has one: of
        order 4 in `dormand_prince`, 7 in `dop853` and 3 in `radau`, one less than the step itself (two in `radau`). Otherwise
        one shorter step is made from the previous sample, with the order of the method. All values satisfy the constraints.

        Values are bitwise those of `t_eval` if a step depends on its initial state alone. Otherwise they differ by a small part
        of the error of the run: `radau` starts its iteration from the previous step, the integral term of `Baumgarte`
        restarts from zero, and `mixed` and `independent` may select other independent velocities.

        Parameters
        ----------
        t : float or array_like
            Times in s.

        Returns
        -------
        p, v : ndarray (..., nq), (..., nv)

        Raises
        ------
        ValueError
            For times outside the samples, if not every step was saved, or if speeds are inputs.

        Examples
        --------
        >>> import zerodrift as zd
        >>> sol = zd.simulate(zd.systems.oscillator(), 1.0, step=0.1)
        >>> p, v = sol([0.25, 0.5])
        >>> p.shape
        (2, 1)
        """
        if self.settings["save_every"] != 1 or "t_eval" in self.settings:
            raise WrongValue("values between samples need every step saved: save_every must be 1, and t_eval left out",
                             "not-available")
        if not len(self.t):
            raise WrongValue("a solution must have samples to be evaluated between them, and this one has none", "not-available")
        times = checks.times("t", t, self.t[0], self.t[-1])
        each, places = np.unique(times, return_inverse=True)
        p, v = self._states_at(each)
        places = places.reshape(times.shape)
        return p[places], v[places]

    def at(self, t: float) -> Instant:
        """The state at a time between the first and the last sample, from which any measure is read by its name.

        It can be the start of `simulate` and the state of `linearize`.

        Parameters
        ----------
        t : float
            Time in s.

        Returns
        -------
        Instant

        Raises
        ------
        ValueError
            If t is not between them.

        Examples
        --------
        >>> import zerodrift as zd
        >>> sol = zd.simulate(zd.systems.oscillator(), 1.0, step=0.1)
        >>> bool(abs(sol.at(0.25)["x"] - sol(0.25)[0][0]) < 1e-15)
        True
        """
        t = checks.number("t", t)
        (p, v), now = self(t), Instant.__new__(Instant)     # may be beyond the end of a table by the tolerances
        vars(now).update(system=self.system, t=t, p=p, v=v, _inputs=self.settings.get("inputs") or ())
        return now

    def _states_at(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and velocities at increasing times (k,)."""
        # Bisection reads few entries of a column that is mapped from a file.
        rows = (np.searchsorted(self.t, times, side="right") if self.t.flags.c_contiguous else
                np.array([bisect.bisect_right(self.t, time) for time in times], dtype=np.intp)) - 1
        p, v = self.p[rows], self.v[rows]
        between = times > self.t[rows]
        if between.any():
            p[between], v[between] = states_between(self, rows[between], times[between])
        return p, v

    @property
    def _state_of_groups(self) -> Any:
        """State (k, groups) of each group of constraints from each sample on."""
        return state_from_samples(self.t, self.transitions)

    @property
    def _last_time(self) -> float:
        return float(self.t[-1]) if len(self.t) else self.t_span[0]

    to_csv, to_excel, to_frame = to_csv, to_excel, to_frame

    def save(self, path: str | Path) -> Path:
        """Write everything to an NPZ file, without pickle; `zerodrift.load` reads it into memory.

        It contains all that the run recorded, and a mechanism unless that has callables; measures are then read from it as from
        this.

        Parameters
        ----------
        path : str or Path
            The suffix ``.npz`` is added where it is missing.

        Returns
        -------
        Path
            Path of the written file.
        """
        from pathlib import Path  # slow to import

        path = Path(path)
        path = path if path.suffix == ".npz" else path.with_name(path.name + ".npz")
        write(path, {name: getattr(self, name) for name in FIELDS})
        return path


FIELDS = tuple(each.name for each in fields(Solution))
