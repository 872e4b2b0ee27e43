"""`linearize`: the linear motion near a state, on the tangent space of the constraints."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from .._private import checks
from .._private.types import ArrayLike, Measures, Reading, SystemLike, Values
from ..errors import AccuracyWarning, InconsistentStart, WrongType, WrongValue
from ..systems.base import BaseSystem, core_of, system_of
from . import differences
from .equilibrium import equilibrium
from .equilibrium_result import Equilibrium
from .flow import Flow
from .linearization_result import Linearization
from .phase import at_state
from .quantities import components, conjugate, find, names_of
from .state import State, scales, sizes_of, state

VIOLATION = 1e-6        # of characteristic scales: a state that violates its constraints by more is refused


def linearize(system: SystemLike, at: Reading | tuple[float, ArrayLike, ArrayLike] | None = None, *, v: Values | None = None,
              inputs: Measures = (), outputs: Measures = ()) -> Linearization:
    """Linear equations of motion z' = A z + B u, y = C z + D u near a state, (p, v) = (p0, v0) + basis z.

    z are coordinates on the tangent space of all constraints, so that none has to be chosen as dependent. In a steady motion the
    basis moves along: displacements of bodies turn with the precession of the mechanism, and not with a wheel that spins. At an
    instant of another motion the basis stands still, and z' = rate + A z + B u; `Linearization.in_coordinates` gives the
    Jacobian of the equations of motion in chosen quantities. Derivatives are those of the system's own Jacobian where it has
    one, and otherwise differences of eighth order, with relative errors of some 1e-12.

    Parameters
    ----------
    system : system or Mechanism
    at : Equilibrium, Instant, or (t, p, v), optional
        The state. In an equilibrium drives are at rest, and efforts that hold it are constant. Left out: the start, or the
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
        If the state is not an equilibrium or a steady motion: A is then that of an instant, and `Linearization.rate` is z' there.

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
    if system._groups:
        at, system = _in_its_phase(system, at, v)
        v = None
    if at is None and v is not None:
        at, v = equilibrium(system, v=v), None
    here, rest = _state(system, at, v), _rest(at)
    flow = Flow(here, rest, at.effort if isinstance(at, Equilibrium) else None)
    if not flow.is_steady:
        left = float(np.abs(flow.left).max())
        warnings.warn(f"{system.name} is not in an equilibrium or a steady motion here: the residual acceleration is {left:.3g} "
                      "(m/s^2 or rad/s^2), and A is that of an instant; zd.equilibrium finds an equilibrium", AccuracyWarning,
                      stacklevel=2)
    return _with_ports(flow, names_of(inputs, "inputs"), names_of(outputs, "outputs"))


def _in_its_phase(system: BaseSystem, at: Any, v: Any) -> tuple[Any, BaseSystem]:
    """The state of a system with contacts, and the system in the phase that a run begins with there."""
    t, p, v = _numbers(system, at, v)
    return (t, p, v), at_state(system, t, p, v)


def _numbers(system: BaseSystem, at: Any, v: Any) -> tuple[float, np.ndarray, np.ndarray]:
    """The state that is given."""
    if v is not None:
        raise WrongValue("v must be left out where the state is given", "conflicting-arguments")
    if at is None:
        return 0.0, *system._state_or_start(None, None, "p", "v", 0.0)
    if hasattr(at, "p") and hasattr(at, "v"):
        t, p, v = getattr(at, "t", 0.0), at.p, at.v
    else:
        try:
            t, p, v = at
        except (TypeError, ValueError):
            raise WrongType(f"at must be an equilibrium, an instant such as sol.at(t), or (t, p, v), "
                            f"not {checks.shown(at)}") from None
    return checks.number("t", t), checks.vector("p", p, system.nq), checks.vector("v", v, system.nv)


def _state(system: BaseSystem, at: Any, v: Any) -> State:
    """The terms at the state that is given."""
    here = state(system, *_numbers(system, at, v))
    if not hasattr(at, "p"):
        core_of(system).check_domain(here.t, here.p, here.v)
    scale = scales(system, here.p)
    speed = scale.length * (1.0 + np.abs(here.v / scale.v).max(initial=0.0))
    if _rest(at) is not None:
        return here
    off = max(np.abs(here.Phi).max(initial=0.0) / scale.length, np.abs(here.C @ here.v + here.Phi_t).max(initial=0.0) / speed)
    if off > VIOLATION:
        raise InconsistentStart(f"the state must satisfy the constraints of {system.name}, and violates them by {off:.3g} of its "
                                "size; zd.project corrects it")
    return here


def _rest(at: Any) -> np.ndarray | None:
    """Multipliers of an equilibrium at rest; None for other states."""
    return at.multipliers if isinstance(at, Equilibrium) and not at.v.any() else None


def _with_ports(flow: Flow, inputs: list[str], outputs: list[str]) -> Linearization:
    """The linearization with its inputs and outputs."""
    at, k = flow.at, flow.A.shape[0]
    along = [conjugate(at.system, name) for name in inputs]
    sizes = [len(find(at, name, "inputs").value) for name in along]
    j = sum(sizes)
    B, dvdot_u, dlam_u = flow.response(along, j)
    _, _, dvdot, dlam = flow.columns
    dp, dv = np.split(np.pad(flow.tangent.basis, ((0, 0), (0, j))), [at.system.nq])
    changes = dp, dv, np.hstack([dvdot, dvdot_u]), np.hstack([dlam, dlam_u]), np.eye(j, k + j, k)
    found = [_derivatives(flow, name, along, changes) for name in outputs]
    C, D = np.split(np.vstack([np.zeros((0, k + j)), *found]), [k], axis=1)
    named = [each for name, size in zip(inputs, sizes, strict=True) for each in components(name, size)]
    labels = [each for name, rows in zip(outputs, found, strict=True) for each in components(name, len(rows))]
    return Linearization(flow, B, C, D, tuple(named), tuple(labels))


def _derivatives(flow: Flow, name: str, inputs: list[str], changes: tuple[np.ndarray, ...]) -> np.ndarray:
    """Derivatives (size, j) of a quantity along changes of p, v, vdot, multipliers and inputs, (..., j)."""
    at, scale = flow.at, scales(flow.at.system, flow.at.p)
    start = at.p, at.v, flow.vdot, flow.lam, np.zeros(len(changes[4]))

    def values(which: np.ndarray, h: np.ndarray) -> np.ndarray:
        moved = [[each + by * change[:, i] for each, change in zip(start, changes, strict=True)]
                 for i, by in zip(which, h, strict=True)]
        return np.array([np.atleast_1d(flow.held(inputs, u).instant(at, *moving)[name]) for *moving, u in moved])

    units = np.maximum(scale.v, np.abs(flow.vdot))[:, None], max(np.abs(flow.lam).max(initial=0.0), 1.0), 1.0
    sizes = [np.abs(change / unit).max(axis=0, initial=0.0) for change, unit in zip(changes[2:], units, strict=True)]
    return differences.each(values, np.max([sizes_of(at, changes[0].T, changes[1].T), *sizes], axis=0),
                            values(np.zeros(1, dtype=int), np.zeros(1)).shape[1]).T
