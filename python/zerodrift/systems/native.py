"""Systems with compiled equations of the user: in C, by Numba, or in any language with C calling conventions.

`BIT` and `SLOT` name the terms in such a function, and `INTERFACE_VERSION` is the version to compile it with.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._private import checks, gateway
from .._private.gateway import TERMS, Variable
from .._private.gateway.inputs import Bound, Place
from ..errors import WrongType, WrongValue, ZerodriftError, sentence
from .base import BaseSystem
from .builtin import SystemOfKind
from .defaults import WithInputs
from .structure import Structure, checked
from .variables import quaternion_places, with_units

__all__ = ["BIT", "INTERFACE_VERSION", "SLOT", "get_include", "native", "numba_signature"]

_made: Any = namedtuple
BIT = _made("Bits", TERMS)(*(term.bit for term in TERMS.values()))
BIT.__class__.__doc__ = "Bits of ``want`` that request a term: ``want & BIT.M``."
SLOT = _made("Slots", TERMS)(*range(len(TERMS)))
SLOT.__class__.__doc__ = "Indices of the pointers to the terms: ``out[SLOT.M]``."
INTERFACE_VERSION = gateway.VERSION
KIND = "zd_kind_"       # what the name of a `zd_kind` begins with in a library


def __dir__() -> list[str]:
    return __all__      # and not what is imported


def get_include() -> str:
    """The folder for the compiler's ``-I``, so that ``#include <zerodrift/system.h>`` finds the interface.

    Beside it is ``zerodrift/sines.h``: the sines and cosines that built-in and symbolic systems use, with the same bits on every
    machine.

    Examples
    --------
    >>> import os, zerodrift as zd
    >>> {"sines.h", "system.h"} <= set(os.listdir(os.path.join(zd.get_include(), "zerodrift")))
    True
    """
    here = Path(__file__).resolve()
    in_source_tree = here.parents[3] / "csrc" / "include"
    return str(in_source_tree if in_source_tree.is_dir() else here.parents[1] / "include")


def numba_signature() -> Any:
    """Signature for `numba.cfunc` of a function for `zerodrift.native`."""
    return gateway.numba_signature()


def native(
    function: object, coordinates: int | Sequence[str] | None = None, *, terms: Iterable[str] | None = None,
    symbol: str | None = None, version: int | None = None, velocities: int | Sequence[str] | None = None,
    constraints: int | Sequence[str] = 0, nonholonomic: int | Sequence[str] = 0, parameters: Mapping[str, float] | None = None,
    quaternions: Sequence[int | str] = (), structure: Structure | None = None, units: Sequence[str] | None = None,
    p0: ArrayLike | None = None, v0: ArrayLike | None = None, scratch: int = 0, name: str | None = None,
) -> BaseSystem:
    """A system whose terms a compiled function evaluates, at the speed of the built-in ones.

    The function is a ``zd_evaluate`` of the header ``zerodrift/system.h`` in `get_include()`, which describes its arguments and
    the terms that it writes::

        int f(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)

    It must be pure, as several threads may call it at once. A shared library must state the version of the interface that it was
    compiled with, in a line ``const int zd_interface_version = ZD_INTERFACE_VERSION;``.

    Parameters
    ----------
    function : str, Path, int, function pointer of ctypes or cffi, numba.cfunc, scipy.LowLevelCallable
        The function, whose signature is checked; or the path of a shared library that contains it; or its address.
    coordinates : int or sequence of str, optional
        Number of coordinates, or their names. Left out: `function` is a library that describes the system itself, in a
        ``const zd_kind zd_kind_SYMBOL``; then only `symbol` and `parameters` are given.
    terms : sequence of str
        Terms that the function writes, by their names in `zerodrift.System.evaluate`: always M, and Phi, C and xi as the
        constraints need them. Terms that are not named are absent.
    symbol : str, optional
        Name of the function in the library.
    version : int, optional
        The ``ZD_INTERFACE_VERSION`` that the function was compiled with. Required with an address; a library declares it.
    velocities, constraints, nonholonomic : int or sequence of str
        Numbers of these, or their names. Left out: as many velocities as coordinates, and no constraints. Numbers of velocities
        and coordinates differ only with a kinematic matrix A.
    parameters : mapping of str to float
        Numbers that the function receives as ``data``, an array of doubles in this order; or the parameters of a ``zd_kind``.
    quaternions : sequence of int or str
        As in `zerodrift.System`: entries of p at which unit quaternions begin. They need a kinematic matrix A.
    structure : Structure
        Bodies of the system, and those that each group of constraints joins. The function then writes A, M and C packed, as
        `zerodrift.Structure` describes; its `offsets` are the beginnings of blocks and groups.
    units : sequence of str
        As in `zerodrift.System`: unit of each coordinate, and with a kinematic matrix of each velocity, too.
    p0, v0 : array_like (nq,), (nv,)
        Start. If it is given, the function is called there once, to check that it writes all of its terms and nothing else.
    scratch : int
        Number of doubles at ``out->scratch``, which the function may use; they are kept while t and p are unchanged.
    name : str
        For tables and plots.

    Returns
    -------
    system
        It is accepted wherever a `zerodrift.System` is. It can be pickled if another process can find the function: in the same
        library at the same path, or by its name in a module.

    Raises
    ------
    TypeError, ValueError, FileNotFoundError
        If the function is of another type or version, cannot be found, or writes other terms than those named.

    Notes
    -----
    A mass on a spring, with numba::

        import numba
        from zerodrift.systems.native import BIT, SLOT

        @numba.cfunc(zd.numba_signature())
        def spring(data, want, t, p, v, out):
            if want & BIT.M: out[SLOT.M][0] = data[0]
            if want & BIT.f: out[SLOT.f][0] = -data[1] * p[0]
            if want & BIT.V: out[SLOT.V][0] = data[1] * p[0] ** 2 / 2
            return 0

        system = zd.native(spring, ["x"], terms=["M", "f", "V"], parameters={"mass": 1.0, "stiffness": 4.0}, p0=[1.0])

    Matrices are row-major: ``M[i, j]`` is ``out[SLOT.M][i * nv + j]``; ``numba.carray(out[SLOT.M], (nv, nv))`` makes an array of
    it. Exceptions of a cfunc are lost: return a nonzero number instead.
    """
    if coordinates is None:
        given = {"version": version, "terms": terms, "velocities": velocities, "constraints": constraints or None, "p0": p0,
                 "nonholonomic": nonholonomic or None, "quaternions": quaternions or None, "structure": structure,
                 "units": units, "v0": v0, "scratch": scratch or None, "name": name}
        return _described_by_library(function, symbol, parameters, [key for key, value in given.items() if value is not None])
    if terms is None:
        raise WrongType("terms must be given with coordinates: names of the terms that the function writes", "compiled-function")
    return Native(gateway.find(function, symbol, version), coordinates=coordinates, terms=terms, velocities=velocities,
                  constraints=(constraints, nonholonomic), parameters=parameters, quaternions=quaternions, structure=structure,
                  units=units, start=(p0, v0), scratch=scratch, name=name)


class Native(BaseSystem):
    """A system whose terms a compiled function evaluates."""

    _has_own_energy = True

    def __init__(self, found: gateway.Function, *, coordinates: Any, terms: Any, velocities: Any, constraints: tuple[Any, Any],
                 parameters: Any, quaternions: Any, structure: Any, units: Any, start: tuple[Any, Any], scratch: int,
                 name: str | None) -> None:
        self._found, (p0, v0) = found, start
        names = checks.names("coordinates", coordinates, "p")
        holonomic = checks.names("constraints", constraints[0], "constraint", least=0)
        rows = holonomic + checks.names("nonholonomic", constraints[1], "rolling", least=0)
        terms = _checked_terms(terms, len(holonomic), len(rows))
        rates = _velocity_names(velocities, names, "A" in terms)
        self.parameters = {key: checks.number(key, value) for key, value in checks.parameters(parameters).items()}
        sizes = (len(names), len(rates), len(holonomic), len(rows) - len(holonomic))
        data = np.array([*self.parameters.values()], dtype=float)
        places = quaternion_places(quaternions, names, "A" in terms)
        self.coordinates, self.velocities = with_units(names, rates, units, "A" not in terms, places)
        self.constraints = tuple(Variable(row, "") for row in rows)
        packing = checked(structure, sizes, "A" in terms)
        if packing and "D" in terms:
            raise WrongValue("terms cannot have D where the structure is declared", "compiled-function")
        self._core = gateway.NativeCore(sizes, terms, found.address, data, (*self.coordinates, *self.velocities),
                                         keep=found.keep, scratch=checks.count("scratch", scratch, least=0), quaternions=places,
                                         packing=packing)
        self._core.given_jacobian = True
        self.name = name or "native system"
        self.p0 = None if p0 is None else checks.frozen(checks.vector("p0", p0, self.nq))
        self.v0 = None if v0 is None else checks.frozen(checks.vector("v0", v0, self.nv))
        self._given = {"coordinates": names, "velocities": rates, "constraints": (holonomic, rows[len(holonomic):]),
                       "terms": terms, "quaternions": places, "structure": structure, "units": units,
                       "start": (self.p0, self.v0), "scratch": scratch, "name": name}
        _check_at_start(self)

    def _with(self, changed: dict[str, Any]) -> Native:
        return Native(self._found, **self._given, parameters=self.parameters | changed)

    def _with_inputs(self, names: Sequence[str]) -> WithInputs:
        for name in names:
            if name not in self.parameters:
                known = checks.closest(name, self.parameters) if self.parameters else "it has none"
                raise WrongValue(f"inputs must be parameters of {self.name}, not {name!r}; {known}", "wrong-name")
        return WithInputs(self, [self.parameters[name] for name in names], [""] * len(names), self._bound)

    def _bound(self, core: gateway.NativeCore, names: Sequence[str]) -> Bound:
        """System of one run, with data of its own."""
        mine, pointer, memory = core.with_copied_data()
        order = list(self.parameters)
        return Bound(mine, [Place(name, False, pointer + order.index(name)) for name in names], (), memory)

    def _names_of_inputs(self) -> list[str]:
        return list(self.parameters)

    def __repr__(self) -> str:
        return f"<zd.native {self.name}: {self._sizes_in_words()}>"

    def __reduce__(self) -> tuple[Any, ...]:
        if self._found.origin is None:
            raise WrongType(f"{self.name} cannot be pickled: {self._found.why_no_origin}", "not-portable")
        return _restored, (self._found.origin, self._given | {"parameters": self.parameters})


def _restored(where: Any, given: dict[str, Any]) -> Native:
    return Native(gateway.find(where, None, None), **given)


class NativeKind(SystemOfKind):
    """A system that a shared library describes."""

    def __init__(self, found: gateway.Function, kind: gateway.Kind, parameters: dict[str, Any]) -> None:
        super().__init__(kind, parameters)
        self._found = found
        self._core.keep, self._core.given_jacobian = found.keep, True
        _check_at_start(self)

    def __repr__(self) -> str:
        return f"<zd.native {self.name} of {self._found.origin.path}: {self._given}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored_from_library, (self._found.origin, self._given)

    def _with(self, changed: dict[str, Any]) -> NativeKind:
        return NativeKind(self._found, self._kind, self._given | changed)


def _described_by_library(library: Any, symbol: Any, parameters: Any, others: list[str]) -> NativeKind:
    if not isinstance(library, str | Path):
        raise WrongType(f"coordinates must be given: only a shared library can describe a system itself, not {library!r}",
                        "compiled-function")
    if others:
        raise WrongType(f"{others[0]} must be left out without coordinates: {KIND}{symbol} declares it",
                        "compiled-function")
    found = gateway.in_library(library, KIND + symbol if isinstance(symbol, str) and symbol else symbol)
    return _from_library(found, checks.parameters(parameters))


def _from_library(found: gateway.Function, parameters: dict[str, Any]) -> NativeKind:
    where = f"{found.origin.symbol} of {found.origin.path}"
    try:
        kind = gateway.kind_at(found.address)
        checks.parameters({parameter.name: None for parameter in kind.parameters})
        _checked_terms(gateway.terms_of(kind.c.system), kind.c.system.mh, kind.c.system.mh + kind.c.system.mn)
    except ValueError as error:
        raise WrongValue(f"{where}: {sentence(error)}", "compiled-function") from None
    return NativeKind(found, kind, parameters)


def _restored_from_library(found: Any, parameters: dict[str, Any]) -> NativeKind:
    return _from_library(gateway.find(found, None, None), parameters)


# ---- checks ----


def _checked_terms(given: Any, mh: int, m: int) -> list[str]:
    """Terms that a function writes, checked against the numbers of constraints."""
    needed = ["M", *["Phi"] * (mh > 0), *["C", "xi"] * (m > 0)]
    terms = [checks.choice("terms", term, TERMS) for term in ([given] if isinstance(given, str) else given)]
    missing = [term for term in needed if term not in terms]
    if missing:
        raise WrongValue(f"terms must have {', '.join(missing)}, with {mh} holonomic of {m} constraints, not only "
                         f"{', '.join(terms) or 'none'}", "compiled-function")
    superfluous = [term for term in terms if (term == "Phi" and not mh) or (term in ("C", "Phi_t", "xi", "D", "gamma") and not m)]
    if superfluous:
        raise WrongValue(f"terms cannot have {superfluous[0]}, with {mh} holonomic of {m} constraints", "compiled-function")
    if ("D" in terms) != ("gamma" in terms):
        raise WrongValue("terms must have both D and gamma, or neither", "compiled-function")
    return terms


def _velocity_names(velocities: Any, coordinates: list[str], kinematics: bool) -> list[str]:
    if velocities is None:
        return [f"v{i}" for i in range(len(coordinates))] if kinematics else [f"{name}_dot" for name in coordinates]
    rates = checks.names("velocities", velocities, "v")
    if len(rates) != len(coordinates) and not kinematics:
        raise WrongValue(f"velocities must be as many as coordinates, {len(coordinates)}, unless terms have A, not {len(rates)}",
                         "compiled-function")
    return rates


def _check_at_start(system: BaseSystem) -> None:
    """Refuse a function that does not write its declared terms, if there is a state to test it at."""
    if system.p0 is None:
        return
    wrong = gateway.probe(system._core, *system._state_or_start(None, None))
    if wrong:
        said = f"the function of {system.name} must match its declaration: {wrong}"
        raise ZerodriftError(said) if wrong.startswith("it reports") else WrongValue(said, "compiled-function")
