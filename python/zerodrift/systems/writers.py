"""Writers of terms of Python systems into the core's arrays: from callables, by differentiation, and packed."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._private import gateway
from .._private.gateway import TERMS
from ..errors import WrongValue, sentence
from . import autodiff
from .user_callables import Function

SAID = {"A": "kinematics", "M": "mass", "C": "the constraint matrix"}

# The callable that gives a term without any derivation.
_CALLABLE_OF = {"A": "kinematics", "M": "mass", "d": "bias", "f": "force", "Phi": "constraints", "V": "potential",
                "power": "power", "xi": "xi"}


class Writer:
    """Writer of the requested terms, (2)-(6), into the core's arrays; terms without a callable are derived."""

    def __init__(self, functions: dict[str, Function], nq: int, nv: int, mh: int, mn: int) -> None:
        self.functions, self.nq, self.nv, self.mh, self.mn = functions, nq, nv, mh, mn
        moving = "constraints" in functions and "t" in functions["constraints"].state_arguments
        self.provides = [name for name, source in _CALLABLE_OF.items() if source in functions]
        self.provides += ["C", "xi"] * bool(mh + mn) + ["Phi_t"] * moving
        self._direct = {name: functions[source] for name, source in _CALLABLE_OF.items() if source in functions}
        if "kinematics" not in functions and "jacobian" in functions:
            self._direct["C_H"] = functions["jacobian"]
        if mn:
            self._direct["C_NH"] = functions["nonholonomic"]
        self._plans: dict[int, tuple[list[tuple[str, Function]], frozenset[str]]] = {}

    def __call__(self, want: int, t: float, arrays: dict[str, np.ndarray]) -> None:
        plan = self._plans.get(want)
        if plan is None:
            plan = self._plans[want] = self._plan(want)
        direct, derived = plan
        p, v = arrays["p"], arrays["v"]
        for name, function in direct:
            function.write(arrays[name], t, p, v)
        if derived:
            self._derive(derived, t, arrays)

    def _plan(self, want: int) -> tuple[list[tuple[str, Function]], frozenset[str]]:
        """The callables to call for these terms, and the terms to derive. C and xi are split into holonomic and other rows."""
        names = {name for name, term in TERMS.items() if want & term.bit}
        grouped = {"C"} if "xi" in self.functions else {"C", "xi"}
        for name in names & grouped:
            names = names | ({f"{name}_H"} if self.mh else set()) | ({f"{name}_NH"} if self.mn else set())
        names -= grouped
        derived = frozenset(names - set(self._direct))
        if derived and "A" in self._direct:
            names.add("A")
        return [(name, function) for name, function in self._direct.items() if name in names], derived

    def not_finite(self, name: str, t: float, value: np.ndarray) -> Exception:
        """Error for a term that is not finite, with the callables that computed it."""
        asked = ("jacobian", "nonholonomic", "kinematics") if name == "C" else (_CALLABLE_OF.get(name),)
        sources = [source for source in asked if source in self.functions]
        if sources not in ([], ["kinematics"]):
            return WrongValue(f"{' or '.join(sources)} is not finite at t = {t:g}: {value}", "not-finite")
        source = " and ".join(["constraints" if self.mh else "nonholonomic", *["kinematics"] * ("kinematics" in self.functions)])
        return WrongValue(f"{name}, derived from {source}, is not finite at t = {t:g}: {value}; supply jacobian and xi "
                          "if these functions cannot be differentiated", "not-finite")

    def _derive(self, derived: frozenset[str], t: float, arrays: dict[str, np.ndarray]) -> None:
        p, v, mh = arrays["p"], arrays["v"], self.mh
        if "C_H" in derived and "jacobian" in self.functions:
            jacobian = np.empty((mh, self.nq))
            self.functions["jacobian"].write(jacobian, t, p, v)
            arrays["C_H"][...] = jacobian @ arrays["A"]                     # (5)
            derived = derived - {"C_H"}
        if derived - {"xi_NH"}:
            self._differentiate(derived, t, arrays)
        if "xi_NH" in derived:
            motion = self._motion_as_jets(t, arrays, gradients=False)
            jets = self.functions["nonholonomic"].evaluate_jets((self.mn, self.nv), *motion, v)
            arrays["xi"][mh:] = -autodiff.part(jets, "first") @ v              # (6): xi = -Cdot v

    def _differentiate(self, derived: frozenset[str], t: float, arrays: dict[str, np.ndarray]) -> None:
        """Derivatives of the holonomic constraints, all that are wanted in one pass."""
        gradients = not derived.isdisjoint({"C_H", "Phi_t"})
        motion = self._motion_as_jets(t, arrays, gradients=gradients)
        jets = self.functions["constraints"].evaluate_jets((self.mh,), *motion, arrays["v"])
        if gradients:
            gradient = autodiff.part(jets, "gradient", self.nq + 1)
            if "C_H" in derived:
                rows = gradient[:, :-1]
                arrays["C_H"][...] = rows @ arrays["A"] if "A" in arrays else rows      # (5)
            if "Phi_t" in derived:
                arrays["Phi_t"][: self.mh] = gradient[:, -1]
                arrays["Phi_t"][self.mh :] = 0.0
        if "xi_H" in derived:
            arrays["xi"][: self.mh] = -autodiff.part(jets, "second")           # (6)

    def _motion_as_jets(self, t: float, arrays: dict[str, np.ndarray], *, gradients: bool) -> tuple[Any, np.ndarray]:
        """(t, p) as jets: along the motion with vdot = 0, there pddot = Adot v, and with gradients in (p, t) if wanted."""
        p, v, A = arrays["p"], arrays["v"], arrays.get("A")
        velocity, curvature = (v, np.zeros(self.nq)) if A is None else (A @ v, self._curvature(t, p, v, A @ v))
        identity = np.eye(self.nq + 1) if gradients else None
        time = autodiff.Jet(t, 0.0 if identity is None else identity[-1], 1.0, 0.0)
        return time, autodiff.seeds(p, velocity, curvature, identity)

    def _curvature(self, t: float, p: np.ndarray, v: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Adot v along the motion."""
        time, position = autodiff.Jet(t, 0.0, 1.0, 0.0), autodiff.seeds(p, velocity)
        jets = self.functions["kinematics"].evaluate_jets((self.nq, self.nv), time, position, v)
        return autodiff.part(jets, "first") @ v


class PackedWriter:
    """Writer that packs the dense matrices of another writer; nonzero entries outside the structure are refused."""

    def __init__(self, writer: Any, packing: gateway.Packing) -> None:
        self._writer, self._packing, self.provides = writer, packing, writer.provides

    def __call__(self, want: int, t: float, arrays: dict[str, np.ndarray]) -> None:
        packed = [name for name in gateway.PACKED if name in arrays]
        dense = arrays | {name: np.zeros(self._packing.shapes[name]) for name in packed}
        if "C" in dense:
            dense["C_H"], dense["C_NH"] = dense["C"][: self._writer.mh], dense["C"][self._writer.mh :]
        self._writer(want, t, dense)
        for name in packed:
            if want & TERMS[name].bit:
                try:
                    arrays[name][...] = self._packing.pack(name, dense[name])
                except ValueError as error:
                    raise WrongValue(f"{SAID[name]}{sentence(error)} (at t = {t:g})", "declared-structure") from None

    def not_finite(self, name: str, t: float, value: np.ndarray) -> Exception:
        """The error for a term that is not finite."""
        return self._writer.not_finite(name, t, self._packing.expand(name, value) if name in gateway.PACKED else value)
