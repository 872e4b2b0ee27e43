"""`linearize`: the linear motion near a state, on the tangent space of the constraints."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from .. import _check
from ..errors import AccuracyWarning, InconsistentStart, WrongType, WrongValue
from ..runs.instant import names_of_quantities
from ..systems.base import BaseSystem, core_of, system_of
from . import differences
from .derivatives import Direction
from .equilibrium import equilibrium
from .equilibrium_result import Equilibrium
from .flow import Flow, Rest
from .linearization_result import Linearization
from .quantities import components, effort, names_of
from .state import State, scales, state

VIOLATION = 1e-6        # of characteristic scales: a state that violates its constraints by more is refused


def linearize(system: Any, at: Any = None, *, v: Any = None, inputs: Any = (), outputs: Any = ()) -> Linearization:
    """The linear motion z' = A z + B u, y = C z + D u near a state, (p, v) = (p0, v0) + basis z.

    z are coordinates on the tangent space of all constraints, so that none has to be chosen as dependent. In a steady motion the
    basis moves along: displacements of bodies turn with the precession of the mechanism, and not with a wheel that spins.
    At an instant of another motion the basis stands still, and z' = rate + A z + B u; `Linearization.in_coordinates` gives the
    Jacobian of the equations of motion in quantities of one's own. Derivatives are those of the system's own Jacobian where it
    has one, and otherwise differences of eighth order, with relative errors of some 1e-12.

    Parameters
    ----------
    system : system or Mechanism
    at : Equilibrium, Instant, or (t, p, v), optional
        The state. In an equilibrium drives stand still, and efforts that hold it stay as they are. Left out: the start, or the
        steady motion with the speeds `v`.
    v : dict of measure to value, optional
        Speeds of a steady motion, as in `equilibrium`.
    inputs : sequence of str or measure
        Efforts, conjugate to the rates of measures, coordinates or velocities; ``"joint.torque"`` and ``"motor.torque"`` act
        along the joint's coordinate.
    outputs : sequence of str or measure
        Any measures, reactions included.

    Returns
    -------
    Linearization
        Prints a table of frequencies, damping ratios and dominant coordinates.

    Raises
    ------
    InconsistentStart
        If the state violates the constraints.
    ValueError, TypeError
        For a wrong argument.

    Warns
    -----
    AccuracyWarning
        If the state is not an equilibrium or a steady motion: A then is that of an instant, and `Linearization.rate` is z' there.

    Examples
    --------
    >>> import zerodrift as zd
    >>> m = zd.Mechanism("pendulum", gravity=(0, -9.81))
    >>> link = m.link("link", (0, 0), (1, 0), mass=2.0)
    >>> pin = m.revolute("pin", m.ground, link.start)
    >>> lin = zd.linearize(m, zd.equilibrium(m), inputs=["pin.torque"], outputs=["link.angle"])
    >>> round(float(abs(lin.eigenvalues[0])) ** 2, 9)
    14.715
    """
    system = system_of(system)
    core_of(system)
    if at is None and v is not None:
        at, v = equilibrium(system, v=v), None
    here, rest = _state(system, at, v), _rest(at)
    flow = Flow(here, rest, at.effort if isinstance(at, Equilibrium) else None)
    if not flow.is_steady:
        left = float(np.abs(flow.left).max())
        warnings.warn(f"{system.name} is not in an equilibrium or a steady motion here: accelerations of {left:.3g} m/s^2 or "
                      "rad/s^2 remain or arise, and A is that of an instant; zd.equilibrium finds one", AccuracyWarning,
                      stacklevel=2)
    return _with_ports(flow, names_of(inputs, "inputs"), names_of(outputs, "outputs"))


def _state(system: BaseSystem, at: Any, v: Any) -> State:
    """The terms at the state that is given."""
    if v is not None:
        raise WrongValue("v must be left out where the state is given", "conflicting-arguments")
    if at is None:
        t, p, v = 0.0, *system._state_or_start(None, None, "p", "v", 0.0)
    elif hasattr(at, "p") and hasattr(at, "v"):
        t, p, v = getattr(at, "t", 0.0), at.p, at.v
    else:
        try:
            t, p, v = at
        except (TypeError, ValueError):
            raise WrongType(f"at must be an equilibrium, an instant such as sol.at(t), or (t, p, v), "
                            f"not {_check.shown(at)}") from None
    here = state(system, _check.number("t", t), _check.vector("p", p, system.nq), _check.vector("v", v, system.nv))
    scale = scales(system, here.p)
    speed = scale.length * (1.0 + np.abs(here.v / scale.v).max(initial=0.0))
    if _rest(at) is not None:
        return here
    off = max(np.abs(here.Phi).max(initial=0.0) / scale.length, np.abs(here.C @ here.v + here.Phi_t).max(initial=0.0) / speed)
    if off > VIOLATION:
        raise InconsistentStart(f"the state must satisfy the constraints of {system.name}, and violates them by {off:.3g} of its "
                                "size; zd.project corrects it")
    return here


def _rest(at: Any) -> Rest | None:
    """Multipliers and efforts of an equilibrium at rest; None for other states."""
    return Rest(at.multipliers, at.effort) if isinstance(at, Equilibrium) and not at.v.any() else None


def _with_ports(flow: Flow, inputs: list[str], outputs: list[str]) -> Linearization:
    """The linearization with its inputs and outputs."""
    at, nv = flow.at, flow.at.system.nv
    rows = [effort(at, name, "inputs") for name in inputs]
    force = np.vstack(rows).T if rows else np.zeros((nv, 0))
    B, dvdot_u, dlam_u = flow.response(force)
    _, _, dvdot, dlam = flow.columns
    lines, direct, labels = [], [], []
    for name in outputs:
        output = _Output(flow, name)
        lines.append(np.array([output.along(dp, dv, a, b) for dp, dv, a, b in zip(
            flow.tangent.basis[:at.system.nq].T, flow.tangent.basis[at.system.nq:].T, dvdot.T, dlam.T, strict=True)]).T)
        direct.append(np.array([output.along(None, None, a, b) for a, b in zip(dvdot_u.T, dlam_u.T, strict=True)]).T)
        lines[-1] = lines[-1].reshape(output.size, -1)
        direct[-1] = direct[-1].reshape(output.size, -1)
        labels += components(name, output.size)
    k = flow.A.shape[0]
    C = np.vstack(lines) if lines else np.zeros((0, k))
    D = np.vstack(direct) if direct else np.zeros((0, force.shape[1]))
    named = [each for name, row in zip(inputs, rows, strict=True) for each in components(name, len(row))]
    return Linearization(flow, B, C, D, tuple(named), tuple(labels))


class _Output:
    """Derivatives of a quantity along directions of the state, of accelerations and of multipliers."""

    def __init__(self, flow: Flow, name: str) -> None:
        self.flow, self.name = flow, name
        self._place = flow.at.system._watching.find(name)
        self.size = len(self._value(flow.at.p, flow.at.v, flow.vdot, flow.lam))

    def along(self, dp: Any, dv: Any, dvdot: np.ndarray, dlam: np.ndarray) -> np.ndarray:
        """The derivative (size,) along one direction."""
        flow, at = self.flow, self.flow.at
        dp = np.zeros(at.system.nq) if dp is None else dp
        dv = np.zeros(at.system.nv) if dv is None else dv
        scale = scales(at.system, at.p)
        size = Direction(dp=dp, dv=dv).size(scale, at)
        size = max(size, float(np.abs(dvdot / np.maximum(scale.v, np.abs(flow.vdot))).max(initial=0.0)),
                   float(np.abs(dlam).max(initial=0.0) / max(np.abs(flow.lam).max(initial=0.0), 1.0)))

        def value(h: float) -> np.ndarray:
            return self._value(at.p + h * dp, at.v + h * dv, flow.vdot + h * dvdot, flow.lam + h * dlam)

        return differences.along(value, size)

    def _value(self, p: np.ndarray, v: np.ndarray, vdot: np.ndarray, lam: np.ndarray) -> np.ndarray:
        system, t = self.flow.at.system, self.flow.at.t
        if self._place is not None:
            states = [np.ascontiguousarray(each)[None] for each in (p, v, vdot, lam)]
            values = system._watching.core.measure(self._place.number, np.array([float(t)]), *states)
            return np.atleast_1d(self._place.pick(values)[0])
        for variables, values in ((system.coordinates, p), (system.velocities, v), (system.constraints, lam)):
            for variable, value in zip(variables, values, strict=True):
                if variable.name == self.name:
                    return np.array([value])
        raise WrongValue(f"outputs names {self.name!r}, and nothing in {system.name} is called that; "
                         f"{_check.closest(self.name, names_of_quantities(system))}", "wrong-name")


