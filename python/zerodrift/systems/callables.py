"""`System`: a mechanism of one's own, written in NumPy."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .._private import checks, gateway
from .._private.gateway import Variable
from .._private.gateway.inputs import Bound, Place
from .._private.types import ArrayLike, TermLike, UserFunction
from ..errors import WrongType, WrongValue
from .base import BaseSystem
from .defaults import WithInputs
from .measure_values import component_names
from .one_sided import OneSided, switched, together
from .one_sided import checked as checked_one_sided
from .structure import Structure, checked
from .user_callables import Function
from .variables import quaternion_places, with_units
from .writers import PackedWriter, Writer


class System(BaseSystem):
    """A multibody system from functions of NumPy arrays.

    Each callable names the arguments it wants, out of ``t`` (float), ``p`` (nq,), ``v`` (nv,) and the keys of
    `parameters`. Arrays are read-only, and may be stored, as they do not change later. An omitted term is absent: no force, no
    constraint. A constant may replace a callable.

    Parameters
    ----------
    coordinates : int or sequence of str
        Number of coordinates, or their names.
    units : sequence of str
        Unit of each coordinate; with `kinematics`, of each velocity, too. Units other than those of pure numbers (``""``,
        ``"rad"``) count as lengths, so that tolerances mean the same in any unit: see `Projection`. Default: all are pure
        numbers.
    mass : callable or array_like -> (nv, nv)
        M of (2): symmetric and positive definite; for formulations other than "schur" it may be singular if the constraints
        hold the massless directions. Its size is the number of velocities.
    force, bias : callable or array_like -> (nv,)
        f and d of (2).
    constraints : callable -> (mh,)
        Phi of (3). It may depend on t.
    jacobian : callable -> (mh, nq)
        dPhi/dp. Left out: derived exactly from `constraints`. If it is given, runs compare it regularly with differences of
        `constraints`.
    nonholonomic : callable -> (mn, nv)
        The rows C_NH of (4).
    xi : callable -> (mh + mn,)
        Right side of (6), ``C vdot = xi``. Left out: derived exactly from `constraints` and `nonholonomic`.
    kinematics : callable -> (nq, nv)
        A of (1), ``pdot = A v``. Left out: the identity.
    quaternions : sequence of int or str
        First coordinates of the unit quaternions in p (scalar first), by index or name. Quaternions are kept at length 1 after
        each step, and each is one coordinate more than there are velocities. They need `kinematics` that keep their length, and
        no constraint on this length.
    potential : callable -> float
        V in J. Without it there are no energies.
    power : callable -> float
        Energy input rate of (28) in W: power of the forces that V does not describe, plus dV/dt at fixed p.
    structure : Structure
        Block structure of A, M and C by bodies. Callables return dense matrices as without it; the core stores and multiplies
        only the entries of the structure, and an entry outside it is an error.
    parameters : dict
        Further arguments of the callables by name, except ``t``, ``p`` and ``v``: numbers, arrays, which are copied, or other
        objects except strings.
    p0, v0 : array_like (nq,), (nv,)
        The start, unless `simulate` is given another; `v0` left out: at rest.
    name : str
        For tables and plots.
    one_sided : dict of str to OneSided
        Gaps that must not be negative, by name, with restitution and friction.

    Notes
    -----
    Derivatives are computed by forward-mode automatic differentiation, exact up to rounding. For that, the callables are called
    with arrays of dtype object. They must be written with operators and NumPy's elementwise functions, and build their results
    with ``np.array``, ``np.stack`` and the like.

    Raises
    ------
    ValueError, TypeError
        If a callable has an unknown argument, or its result has the wrong shape or is not of real numbers. Exceptions of a
        callable get a note with its name and t.

    Examples
    --------
    A pendulum of length L in Cartesian coordinates:

    >>> import numpy as np, zerodrift as zd
    >>> pendulum = zd.System(
    ...     ["x", "y"],
    ...     mass=lambda m: m * np.eye(2),
    ...     force=lambda m, g: np.array([0.0, -m * g]),
    ...     constraints=lambda p, L: np.array([p @ p - L**2]) / 2,
    ...     potential=lambda p, m, g: m * g * p[1],
    ...     parameters={"m": 1.0, "g": 9.81, "L": 1.0},
    ...     p0=[1.0, 0.0],
    ... )
    >>> sol = zd.simulate(pendulum, 1.0, step=0.01)
    >>> sol.p[-1].round(5)
    array([-0.98629, -0.16501])
    """

    _has_own_energy = True

    def __init__(
        self, coordinates: int | Sequence[str], *, mass: TermLike, force: TermLike | None = None, bias: TermLike | None = None,
        constraints: UserFunction | None = None, jacobian: UserFunction | None = None, nonholonomic: UserFunction | None = None,
        xi: UserFunction | None = None, kinematics: UserFunction | None = None, quaternions: Sequence[int | str] = (),
        potential: UserFunction | None = None, power: UserFunction | None = None, structure: Structure | None = None,
        units: Sequence[str] | None = None, parameters: dict[str, Any] | None = None, p0: ArrayLike | None = None,
        v0: ArrayLike | None = None, name: str | None = None, one_sided: Mapping[str, OneSided] | None = None,
    ) -> None:
        parameters = {key: _parameter(key, value) for key, value in checks.parameters(parameters).items()}
        self._given = {key: _as_now(value) for key, value in locals().items() if key not in ("self", "__class__")}
        self.name, self.parameters = name or "system", parameters
        names = checks.names("coordinates", coordinates, "p")
        self.p0 = None if p0 is None else checks.frozen(checks.vector("p0", p0, len(names)))
        terms, one_sided = self._given, checked_one_sided(one_sided)
        if one_sided:
            terms = self._with_gaps(one_sided)
        functions = {key: Function(key, terms[key], self.parameters) for key in SHAPES if terms[key] is not None}
        if "jacobian" in functions and "constraints" not in functions:
            raise WrongValue("jacobian must be given with constraints", "missing-argument")
        places = quaternion_places(quaternions, names, kinematics is not None)
        sizes = _sizes(functions, _anywhere(len(names), places) if self.p0 is None else self.p0)
        packing = checked(structure, sizes, kinematics is not None)
        writer: Writer | PackedWriter = Writer(functions, *sizes)
        if packing:
            writer = PackedWriter(writer, packing)
        rates = [f"{n}_dot" for n in names] if kinematics is None else [f"v{i}" for i in range(sizes[1])]
        self.coordinates, self.velocities = with_units(names, rates, units, kinematics is None, places)
        timeless = not any("t" in function.state_arguments for function in functions.values())
        self._core = gateway.PythonCore(sizes, writer.provides, writer, (*self.coordinates, *self.velocities),
                                         timeless=timeless, quaternions=places, packing=packing)
        self._core.given_jacobian = "jacobian" in functions
        self.constraints = tuple(Variable(f"constraint{i}", "") for i in range(self.m))
        self.v0 = None if v0 is None else checks.frozen(checks.vector("v0", v0, self.nv))
        groups = switched(one_sided, [each.name for each in (*self.coordinates, *self.velocities)], self.mh, self.mn)
        self._groups = gateway.switch(self._core, groups)
        if groups:
            rows = {group.first: f"{group.name}.slip" if group.normal else group.name for group in groups}
            self.constraints = tuple(Variable(rows.get(i, f"constraint{i}"), "") for i in range(self.m))

    def _with_gaps(self, one_sided: dict[str, OneSided]) -> dict[str, Any]:
        """Terms with the rows of gaps and slip velocities after those of the constraints."""
        if wrong := [name for name in ("jacobian", "xi") if self._given[name] is not None]:
            raise WrongValue(f"{wrong[0]} must be left out where there is one_sided, whose derivatives are computed",
                             "conflicting-arguments")
        gaps, slips = {name: each.gap for name, each in one_sided.items()}, {
            name: each.slip for name, each in one_sided.items() if each.slip is not None}
        return {**self._given, **{what: together(what, self._given[what], rows, self.parameters)
                                  for what, rows in (("constraints", gaps), ("nonholonomic", slips))}}

    def _with(self, changed: dict[str, Any]) -> System:
        return type(self)(**(self._given | {"parameters": self.parameters | changed}))

    def _with_inputs(self, names: Sequence[str]) -> WithInputs:
        known = _numbers(self.parameters)
        for name in names:
            if name not in known:
                raise WrongValue(f"inputs must name numbers among the parameters of {self.name}, not {name!r}; "
                                 f"{checks.closest(name, known) if known else 'it has none'}", "wrong-name")
        return WithInputs(self, [known[name] for name in names], [""] * len(names), self._bound)

    def _bound(self, core: gateway.CoreSystem, names: Sequence[str]) -> Bound:
        """The system of one run, whose callables read memory that the core writes inputs to."""
        owners = {name.partition("[")[0] for name in names}
        memory = {owner: np.array(self.parameters[owner], dtype=float) for owner in sorted(owners)}
        views = {owner: array.view(Live) for owner, array in memory.items()}
        mine = self._with(views)._core.for_run()
        index = {name: i for each in self._arrays_of_inputs().values() for i, name in enumerate(each.ravel().tolist())}
        places = [Place(name, False, gateway.doubles(memory[owner], memory[owner].size) + index.get(name, 0))
                  for name in names for owner in [name.partition("[")[0]]]
        return Bound(mine, places, (), memory)

    def _names_of_inputs(self) -> list[str]:
        return [*_numbers(self.parameters), *self._arrays_of_inputs()]

    def _arrays_of_inputs(self) -> dict[str, np.ndarray]:
        return {name: _entries(name, value) for name, value in self.parameters.items() if _is_array(value)}

    def __repr__(self) -> str:
        return f"<zd.System {self.name}: {self._sizes_in_words()}>"

    def _definition(self) -> dict[str, Any]:
        return {name: given for name, given in self._given.items() if name not in ("parameters", "p0", "v0")}

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuild, (type(self), self._given)


class Live(np.ndarray):
    """View of numbers that the core changes between steps: inputs."""


def _numbers(parameters: dict[str, Any]) -> dict[str, float]:
    """Numbers among parameters by name, and entries of arrays as "u[0]" and "K[0, 1]"."""
    found: dict[str, float] = {}
    for name, value in parameters.items():
        if isinstance(value, int | float | np.number) and not isinstance(value, bool):
            found[name] = float(value)
        elif _is_array(value):
            found |= dict(zip(_entries(name, value).ravel().tolist(), value.astype(float).ravel().tolist(), strict=True))
    return found


def _is_array(value: Any) -> bool:
    return isinstance(value, np.ndarray) and value.ndim > 0 and value.dtype.kind in "fiu"


def _entries(name: str, array: np.ndarray) -> np.ndarray:
    """Names of the entries of an array, in its shape."""
    return np.array(component_names(name, array.shape, has_axes=False), dtype=object).reshape(array.shape)


def _rebuild(kind: type[System], given: dict[str, Any]) -> System:
    return kind(**given)


def _as_now(value: Any) -> Any:
    """Copy of a given array or list, which the caller may change later; other objects as they are."""
    return copy.deepcopy(value) if isinstance(value, np.ndarray | list) else value


def _parameter(name: str, value: Any) -> Any:
    """Parameter value for callables: a read-only copy of an array; other objects, except strings, as they are."""
    if isinstance(value, str | bytes) or (isinstance(value, np.ndarray) and value.dtype.kind not in "biufcO"):
        raise WrongType(f"parameter {name!r} must be a number, an array of numbers or an object except a string, not {value!r}")
    if checks.is_masked(value):
        raise WrongValue(f"parameter {name!r} must have no masked entries, not {value!r}", "not-finite")
    if isinstance(value, Live):
        value.flags.writeable = False
        return value
    return checks.frozen(value) if isinstance(value, np.ndarray) and value.dtype != object else value


# The shape of what each callable returns. The first callable in which a size appears determines that size.
SHAPES = {"mass": ("nv", "nv"), "force": ("nv",), "bias": ("nv",), "constraints": ("mh",), "jacobian": ("mh", "nq"),
          "nonholonomic": ("mn", "nv"), "xi": ("m",), "kinematics": ("nq", "nv"), "potential": (), "power": ()}
SIZES = {"nv": "velocities", "mh": "holonomic constraints", "mn": "nonholonomic constraints"}     # those read from a result


def _anywhere(nq: int, quaternions: tuple[int, ...]) -> np.ndarray:
    """Default coordinates if there is no start: zero, with unit quaternions."""
    p = np.zeros(nq)
    p[list(quaternions)] = 1.0
    return checks.frozen(p)


def _sizes(functions: dict[str, Function], p: np.ndarray) -> tuple[int, int, int, int]:
    """Sizes (nq, nv, mh, mn), from the shapes that the callables return at p."""
    nq = len(p)

    def shape(name: str, dimensions: int) -> tuple[int, ...]:
        if name not in functions:
            return (0,) * dimensions
        with np.errstate(all="ignore"):
            found = functions[name].value(0.0, p, checks.frozen(np.zeros(nv))).shape
        if len(found) != dimensions:
            sizes = SHAPES[name]
            raise WrongValue(f"{name} must return shape ({', '.join(sizes)}{',' * (len(sizes) == 1)}), not {found}: "
                             f"{sizes[0]} is the number of {SIZES[sizes[0]]}", "shape")
        return found

    nv = nq     # for a mass that asks for v
    nv = shape("mass", 2)[0]
    if "kinematics" not in functions and nv != nq:
        raise WrongValue(f"mass is for {nv} velocities and there are {nq} coordinates: then kinematics is needed",
                         "missing-argument")
    mh, mn = shape("constraints", 1)[0], shape("nonholonomic", 2)[0]
    if "power" in functions and "potential" not in functions:
        raise WrongValue("power must be given together with potential, which the energy balance needs", "missing-argument")
    _check_shapes(functions, {"nq": nq, "nv": nv, "mh": mh, "mn": mn, "m": mh + mn}, p)
    return nq, nv, mh, mn


def _check_shapes(functions: dict[str, Function], sizes: dict[str, int], p: np.ndarray) -> None:
    for name, function in functions.items():
        expected = tuple(sizes[size] for size in SHAPES[name])
        with np.errstate(all="ignore"):
            found = function.value(0.0, p, checks.frozen(np.zeros(sizes["nv"]))).shape
        if found != expected:
            raise WrongValue(f"{name} must return shape {expected}, not {found}", "shape")
