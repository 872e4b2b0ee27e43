"""The result of a run."""

from __future__ import annotations

import bisect
import itertools
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _check, _gateway
from ..systems.base import BaseSystem, direct_core_of
from ..systems.measure_values import AXES
from .columns import to_csv, to_excel
from .saving import write
from .settings import core_settings
from .stats import Stats
from .summary import summary

if TYPE_CHECKING:
    from pathlib import Path

A_SOLUTION = "a Solution, as zd.simulate returns it"      # what arguments have to be


@dataclass(frozen=True, eq=False, repr=False)
class Solution:
    """A motion, how well it satisfies its constraints and its energy balance, and what it cost.

    Time comes first in every array; arrays are read-only. ``sol["name"]`` is the column of the coordinate or velocity of that
    name, or of the multiplier of the constraint of that name.

    Attributes
    ----------
    t : ndarray (k,)
        Times in s.
    p, v : ndarray (k, nq), (k, nv)
        Coordinates and velocities, in the units of `system`.
    multipliers : ndarray (k, m)
        Constraint reactions with the sign of (7), ``M vdot + d = f - C.T @ multipliers``.
    position_violation : ndarray (k, mh)
        Phi of (3).
    velocity_violation : ndarray (k, m)
        Psi of (5).
    kinetic_energy : ndarray (k,)
        In J.
    potential_energy, energy_input, energy_violation : ndarray (k,) or None
        V, the integral of the energy input rate, and Psi_E of (28), in J; None where the system declares no potential.
    iterations : ndarray (k,)
        The most position iterations that a step took, among the steps from the row before to this one.
    energy_skipped : ndarray (k,)
        How many energy corrections were left out from the row before to this one, as no bounded factor (29) would have removed
        the error.
    position_size : ndarray (mh,)
        The size of each row of Phi, in which `Projection` measures it.
    stats : dict
        Counts (steps, evaluations, factorizations, ...), `seconds`, the time spent in the core, and `omega_h`, the largest
        product of the motion's angular frequency and a step of fixed size: an explicit method needs it small. That and
        `largest_kinetic`, in J, are looked at every few steps; `energy_corrected`, in J, is the largest error of the energy
        balance that a single correction has taken out. `part_error` is what steps of fixed size, about a thousand in succession,
        miss of the motion of one coordinate (or, where `kinematics` is given, velocity or rotation), estimated, in rad or parts
        of the mechanism's length; `part` is the one where it is most. `unresolved` says how many looks found more of it than 0.03
        and a thousandth of the way, `unresolved_time`, in s, when it was first. Of the constraints, `rank` are independent,
        `redundant` lists rows that follow from the others, and in `rank_drops` steps the rank was less for a while. Where a
        declared structure has more than 40 rows, `smallest_pivot` is the least that was left of a row, in squares of the mass
        metric, once others were eliminated, `smallest_pivot_time`, in s, when, and `smallest_pivot_row` of which row: near a
        bifurcation it is small, and accelerations lose digits. `matrix_path_reason` says why no step used the closed form of
        the system, where systems of its kind have one. Of a run that was killed there are none.
    status : int
        0 done, positive: ended early, negative: failed. What there is is valid in every case.
    success : bool
        Whether the end was reached, or a terminal event.
    message : str
        What happened, in a sentence.
    settings : dict
        As `simulate` takes them: ``simulate(system, t_span, **settings)`` repeats the run; events, being functions, are not kept.
        `vector` is the unit that the direct functions of the run were written for, None where it had none.
    system : system
        What moved.
    t_span : tuple of float
        (t0, t1) as asked for.
    t_events : tuple of ndarray, or None
        For each event, the times at which it happened; None where no events were asked for.
    p_events, v_events : tuple of ndarray (k, nq), (k, nv), or None
        Coordinates and velocities at those times.
    outputs : dict of str to ndarray (k,) or (k, size)
        The measures that the run recorded, by name.
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
    t_events: tuple[np.ndarray, ...] | None = None
    p_events: tuple[np.ndarray, ...] | None = None
    v_events: tuple[np.ndarray, ...] | None = None
    outputs: dict[str, np.ndarray] = field(default_factory=dict)

    def __post_init__(self) -> None:
        vars(self)["stats"] = Stats(self.stats)
        for value in list(vars(self).values()):
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
        for array in itertools.chain(self.t_events or (), self.p_events or (), self.v_events or (), self.outputs.values()):
            array.setflags(write=False)

    @classmethod
    def _of_run(cls, others: Callable[[], dict[str, Any]], **values: Any) -> Solution:
        """With some fields, and a function that makes the others, which is asked when one of these is first wanted.

        To make all of them, and to set them one by one as a frozen class does, takes longer than a short run.
        """
        made = object.__new__(cls)
        vars(made).update(values, _others=others)
        return made

    def __getattr__(self, name: str) -> Any:
        values = vars(self)
        if (others := values.get("_others")) and name in FIELDS:    # other threads may do the same: they find equal ones
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

    def __getitem__(self, name: Any) -> np.ndarray:
        """A coordinate, a velocity, the multiplier of a constraint, or a measure of a mechanism, by its name, at every row.

        Parameters
        ----------
        name : str or measure, or (that, body)
            A measure of a mechanism, such as ``crank.angle`` or ``"C.force"``; or one of the names in
            ``system.coordinates``, ``system.velocities`` and ``system.constraints``. With a body or its name behind it,
            ``sol["C.force", "crank"]``, a vector is turned into that body's axes; scalars of the plane are the same in all.

        Returns
        -------
        ndarray (k,), or (k, 2) of a measure that is a vector
            In the unit of that coordinate or velocity; of a constraint, what `multipliers` has in its column.

        Raises
        ------
        KeyError
            If nothing has that name, or more than one thing has.

        Examples
        --------
        >>> import zerodrift as zd
        >>> sol = zd.simulate(zd.systems.pendulum(), 1.0, step=0.01)
        >>> bool((sol["y"] == sol.p[:, 1]).all() and (sol["rod"] == sol.multipliers[:, 0]).all())
        True
        """
        if isinstance(name, tuple) and len(name) == 2:
            return self._in_axes_of(*name)
        measured = self._recorded(getattr(name, "name", name))
        if measured is None:
            measured = self.system._measured(name, self)
        if measured is not None:
            return measured
        groups = [array for array, _ in self._named()]
        columns = [groups[group][:, column] for group, column in self.system._columns_of.get(name, ())]
        if len(columns) == 1:
            self._check_sign(name)
            return columns[0]
        if columns:
            raise KeyError(f"{name!r} is the name of {len(columns)} things in {self.system.name}: "
                           "take the column of p, v or multipliers")
        if why := self.system._why_unknown(getattr(name, "name", name)):
            raise KeyError(why)
        known = self._ipython_key_completions_()
        raise KeyError(f"nothing in {self.system.name} is called {getattr(name, 'name', name)!r}; {_check.closest(name, known)}")

    def _check_sign(self, name: str) -> None:
        """Refuses the multiplier of a drive or a coupling by the name of that element: its effort has the opposite sign."""
        for effort in ("force", "torque"):
            measure = f"{name}.{effort}"
            if self.system._is_scalar_measure(measure):
                raise KeyError(f"{name!r} names an element, whose {effort} is sol[{measure!r}], and a constraint, whose "
                               "multiplier is in sol.multipliers and has the opposite sign, by (7)")

    def _in_axes_of(self, name: Any, body: Any) -> np.ndarray:
        """A vector in the axes of a body."""
        name, body = (getattr(each, "name", each) for each in (name, body))
        base, _, axis = name.rpartition(".") if isinstance(name, str) else ("", "", "")
        if axis in AXES:
            return self._in_axes_of(base, body)[:, AXES[axis]]
        values = self[name]
        if values.ndim == 1 or body == "ground":
            return values
        if values.shape[1:] == (3,):
            return np.einsum("kji,kj->ki", self[f"{body}.rotation"], values)
        angle = self[f"{body}.angle"]
        c, s = np.cos(angle), np.sin(angle)
        return np.column_stack([c * values[:, 0] + s * values[:, 1], c * values[:, 1] - s * values[:, 0]])

    def _recorded(self, name: Any) -> np.ndarray | None:
        """A measure of the record, or a component of one; None: that is not there."""
        if not self.outputs or not isinstance(name, str):
            return None
        if name in self.outputs:
            return self.outputs[name].reshape(-1, 3, 3) if name.endswith(".rotation") else self.outputs[name]
        base, _, axis = name.rpartition(".")
        vector, component = self.outputs.get(base), AXES.get(axis, -1)
        return vector[:, component] if vector is not None and vector.ndim == 2 and 0 <= component < vector.shape[1] else None

    def unique(self, name: str) -> Any:
        """Whether a measure of a mechanism does not depend on which of all admissible multipliers are taken.

        Where constraints are redundant, reactions are not determined by the motion of rigid bodies, and those that are told have
        the least effect. Forces of this kind differ from one choice of coordinates to another; those that are unique do not.

        Parameters
        ----------
        name : str or measure
            Such as ``"A.force"``.

        Returns
        -------
        bool, or ndarray of bool
            One for each component: True where it is the same at every row.

        Raises
        ------
        KeyError
            If nothing is measured by that name.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("pendulum", gravity=(0, -9.81))
        >>> link = m.link("link", (0, 0), (1, 0), mass=1.0)
        >>> pin = m.revolute("pin", m.ground, link.start)
        >>> zd.simulate(m, 0.1, step=0.01).unique(pin.force)
        array([ True,  True])
        """
        return self.system._unique(name, self)

    def _named(self) -> tuple[tuple[np.ndarray, tuple[_gateway.Variable, ...]], ...]:
        """Arrays whose columns have names, with these."""
        system = self.system
        return (self.p, system.coordinates), (self.v, system.velocities), (self.multipliers, system.constraints)

    def _ipython_key_completions_(self) -> list[str]:
        return [*self.system._names_of_measures(),
                *(variable.name for _, variables in self._named() for variable in variables)]

    def __call__(self, t: Any) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and velocities at any time between the first and the last row.

        They are what `t_eval` gives, with the same bits where a step depends on nothing but where it begins. Between chosen
        steps of a method that has a polynomial, of order 4 in `dormand_prince`, 7 in `dop853` (what its conditions miss of that,
        8e-8, is below rounding in steps so short that it would show) and 3 in `radau`, the step from the row before to the row
        after is made again and interpolated: values between steps have one order less than a step (of `radau`, two), which adds
        no more to the error of the run than its steps do. Where steps are of fixed size, one shorter step is made from the row
        before, with the order of the method. All values are corrected as the rows are.

        By a part of the run's error they may differ from `t_eval` where a step has a memory: `radau` begins to solve its
        equations where the step before leads, the integral term of `Baumgarte` begins at zero at the row, and `mixed` and
        `independent` go on with the independent velocities of the run, where others may be chosen at the row: on a closed chain
        that was a hundredth of the error of p or v, or less.

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
            Outside the rows; or if not every step was saved.

        Examples
        --------
        >>> import zerodrift as zd
        >>> sol = zd.simulate(zd.systems.oscillator(), 1.0, step=0.1)
        >>> p, v = sol([0.25, 0.5])
        >>> p.shape
        (2, 1)
        """
        if self.settings["save_every"] != 1 or "t_eval" in self.settings:
            raise ValueError("values between rows need every step saved: save_every=1, and no t_eval")
        if not len(self.t):
            raise ValueError("this solution has no rows, and so no values")
        times = _check.times("t", t, self.t[0], self.t[-1])
        each, places = np.unique(times, return_inverse=True)
        p, v = self._states_at(each)
        places = places.reshape(times.shape)
        return p[places], v[places]

    def _states_at(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """At times (k,) that increase."""
        rows = _rows_before(self.t, times)
        p, v = self.p[rows], self.v[rows]
        between = times > self.t[rows]
        if between.any():
            options = core_settings(self.t_span, self.settings)
            core = direct_core_of(self.system, self.settings.get("vector") or "baseline", options)
            rows_of = (self.t, self.p, self.v, self.energy_input, self.status == _gateway.EVENT)
            p[between], v[between] = _gateway.states_between(core, options, *rows_of, times[between])
        return p, v

    @property
    def _last_time(self) -> float:
        return float(self.t[-1]) if len(self.t) else self.t_span[0]

    @property
    def measures(self) -> tuple[str, ...]:
        """Names of all measures that `sol[name]` reads, such as "pin.force"; none of a system that is not a mechanism."""
        return tuple(self.system._names_of_measures())

    def to_csv(self, path: str | Path, names: Any = None) -> Path:
        """Write columns to a CSV file: the time, and what is named, a component each, with names and units in the first line.

        Parameters
        ----------
        path : str or Path
        names : str, measure, or sequence of these, optional
            Coordinates, velocities, constraints and measures, as in ``sol[name]``. Left out: all coordinates, velocities and
            multipliers.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        KeyError
            If nothing has a name.

        Examples
        --------
        >>> import tempfile, zerodrift as zd
        >>> sol = zd.simulate(zd.models.slider_crank(), 0.1, step=0.01)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = sol.to_csv(folder + "/crank.csv", ["crank.angle", "slide.force"])
        ...     path.read_text().splitlines()[0]
        't [s],crank.angle [rad],slide.force.x [N],slide.force.y [N]'
        """
        return to_csv(self, path, names)

    def to_excel(self, path: str | Path, names: Any = None) -> Path:
        """Write the same to an Excel file; pandas and openpyxl have to be installed: ``pip install 'zerodrift[excel]'``.

        Parameters
        ----------
        path : str or Path
        names : str, measure, or sequence of these, optional
            As in `to_csv`.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        ImportError
            If one of these packages is missing.
        KeyError
            If nothing has a name.
        """
        return to_excel(self, path, names)

    def save(self, path: str | Path) -> Path:
        """Write everything to an NPZ file, without pickle; `zerodrift.load` reads it into memory.

        What the run recorded is kept, and a mechanism with it unless it has callables; so measures are read from it as from this.

        Parameters
        ----------
        path : str or Path
            The suffix ``.npz`` is added where it is missing.

        Returns
        -------
        Path
            Where it was written.
        """
        from pathlib import Path  # slow to import

        path = Path(path)
        path = path if path.suffix == ".npz" else path.with_name(path.name + ".npz")
        write(path, {name: getattr(self, name) for name in FIELDS})
        return path


def _rows_before(t: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Rows at or before times; of t in a file only the entries that bisection compares are read."""
    if t.flags.c_contiguous:
        return np.searchsorted(t, times, side="right") - 1
    return np.array([bisect.bisect_right(t, time) - 1 for time in times], dtype=np.intp)


FIELDS = tuple(each.name for each in fields(Solution))
