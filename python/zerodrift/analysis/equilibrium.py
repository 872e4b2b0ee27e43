"""`equilibrium`: a position in which a system rests, or a steady motion."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np

from .._private import checks
from .._private.types import ArrayLike, Measures, SystemLike, Values
from ..errors import EquilibriumFailed, WrongValue, ZerodriftError
from ..runs.arguments.methods import Projection
from ..runs.states.operations import project
from ..systems.base import BaseSystem, system_of
from .equilibrium_result import Equilibrium, at_rest, in_motion, of_many
from .large import MANY, blocks_that_meet, found
from .phase import resting
from .quantities import components, find, names_of, rows_of, values_of
from .relaxation import settled
from .rest import Balance, Search
from .retraction import near_to
from .state import State, scales, state
from .steady import Steady

FAR = 20.0      # characteristic scales: a coordinate that has moved so far does not stop


def equilibrium(system: SystemLike, *, near: ArrayLike | Values | None = None, hold: Measures = (),
                v: Values | None = None, stability: Literal["stable", "any"] = "stable", t: float = 0.0) -> Equilibrium:
    """Find a position in which a system rests under its forces, or a steady motion with given speeds.

    Newton's method solves the balance of forces on the tangent space of the constraints, with projection onto these as
    retraction, in a trust region of 0.3 rad or characteristic lengths. Holonomic, nonholonomic and redundant constraints are
    treated alike, and no coordinate is chosen as independent. The search goes downhill, so that the forces do work in each step;
    where it does not converge, the motion is integrated, stopped at each maximum of its kinetic energy, and Newton's method
    finishes. The stiffness is from differences of the residuals of fourth or higher order, accurate to 1e-12. Mechanisms in the
    plane with more than 200 velocities, of joints and springs, are solved by sparse factors where SciPy is installed: downhill,
    by at most 600 steps, without an integrated motion after these, and not with hold=, which requires dense matrices.

    Parameters
    ----------
    system : system or Mechanism
    near : array_like (nq,), or dict of measure to value, optional
        Position from which the search starts; or values of measures of positions, to which the system is moved from its start.
        Left out: the start.
    hold : sequence of measures, optional
        Measures of positions that keep the values that they have there; `Equilibrium.effort` has the efforts that hold them.
        Reactions contain these efforts, also where user functions read them; an effort along a joint's own coordinate is
        separate from that joint's reaction. In a steady motion they are constant, at values that it needs, such as the
        steering angle of a bicycle in a turn.
    v : dict of measure to value, optional
        Prescribed speeds of a steady motion, with drives running, which is found instead of a position of rest. All bodies keep
        their rates in a frame that turns about the direction of gravity, without gravity about any axis, or shifts along a line,
        and the equations of motion hold at 16 instants of one turn of each rate, or of one characteristic length. One near the
        start is found, stable or not.
    stability : {"stable", "any"}
        "stable" leaves an unstable equilibrium downhill; "any" finds one nearby by Newton's method, stable or not.
    t : float
        Time in s of the drives, which are at rest there.

    Returns
    -------
    Equilibrium
        Prints its position, stability, lowest frequency and reactions.

    Raises
    ------
    EquilibriumFailed
        If none was found; the message names the direction in which a force remains, or the force that changes along the motion.
    ValueError, TypeError
        For a wrong argument.

    Examples
    --------
    >>> import zerodrift as zd
    >>> m = zd.Mechanism("pendulum", gravity=(0, -9.81))
    >>> link = m.link("link", (0, 0), (1, 0), mass=2.0)
    >>> pin = m.revolute("pin", m.ground, link.start)
    >>> eq = zd.equilibrium(m)
    >>> round(eq["link.angle"], 9), round(eq["pin.force.y"], 9), eq.stable
    (-1.570796327, 19.62, True)
    """
    system, t = system_of(system), checks.number("t", t)
    checks.choice("stability", stability, ("stable", "any"))
    if system._groups:
        return _with_contacts(system, t, near, hold, v, is_downhill=stability == "stable")
    if hold == () and v is None and (meet := blocks_that_meet(system)) is not None:
        return of_many(*found(system, t, _first(system, near), meet))
    p = near_to(system, near, t)
    if v is not None:
        return _steady(system, t, p, values_of(v, "v"), names_of(hold, "hold"))
    at = state(system, t, p, np.zeros(system.nv))
    held = {name: _held(at, name) for name in names_of(hold, "hold")}
    balance, iterations, how = _found(system, t, p, held, is_downhill=stability == "stable")
    return at_rest(balance, iterations, how)


def _with_contacts(system: BaseSystem, t: float, near: Any, hold: Any, v: Any, *, is_downhill: bool) -> Equilibrium:
    """The equilibrium of a system with contacts, in its phase."""
    if hold != () or v is not None:
        raise WrongValue(f"hold and v must be left out for {system.name}, which has contacts, stops or joints that switch",
                         "not-available")
    balance, iterations, found = resting(system, t, near, is_downhill=is_downhill)
    result, here = at_rest(balance, iterations, "Newton's method, contact by contact"), vars(balance.at.system)
    result.phase, result.system, result.multipliers = here["phase"], system, found.multipliers
    return result


def _held(at: State, name: str) -> np.ndarray:
    """The values (size,) at which a quantity is held."""
    found = find(at, name, "hold")
    if found.is_velocity:
        raise WrongValue(f"hold must name quantities of positions, and {name!r} is one of velocities", "wrong-measure")
    return found.value


def _first(system: BaseSystem, near: Any) -> np.ndarray:
    """The position (nq,) from which the search begins, of a system of many bodies."""
    if isinstance(near, Mapping):
        raise WrongValue(f"near must hold coordinates, not values of quantities, where there are more than {MANY} velocities")
    return np.array(system._state_or_start(None, None, "near", "v", 0.0)[0]) if near is None else (
        checks.vector("near", near, system.nq))


def balanced(system: BaseSystem, t: float, p: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The stable equilibrium found from a position, and the velocities nearest to v that its constraints allow."""
    balance, _, _ = _found(system, t, p, {}, is_downhill=True)
    return project(system, balance.at.p, v, t, projection=Projection(tol=1e-11))


def _steady(system: BaseSystem, t: float, p: np.ndarray, speeds: Mapping[str, float], hold: list[str]) -> Equilibrium:
    """The steady motion with given speeds."""
    at = state(system, t, p, np.zeros(system.nv))
    held = [part for name in hold for part in components(name, len(rows_of(at, [name])))]
    search = Steady(system, t, {name: _speed(at, name, value) for name, value in speeds.items()}, held)
    flow, efforts = search.run(p, np.array(system._state_or_start(None, None, "near", "v", t)[1]))
    return in_motion(flow, dict(zip(held, map(float, efforts), strict=True)), search.iterations)


def _speed(at: State, name: str, value: Any) -> np.ndarray:
    """Checked values (size,) of a rate; a number stands for all of its components."""
    size = len(find(at, name, "v").value)
    if np.ndim(value) == 0:
        return np.full(size, checks.number(f"v[{name!r}]", value))
    return checks.vector(f"v[{name!r}]", value, size)


def _unmoved(system: BaseSystem, p: np.ndarray) -> np.ndarray:
    return p


WAYS = {"Newton's method, downhill": _unmoved, "integration with stops, then Newton's method": settled}      # after the first


def _found(system: BaseSystem, t: float, p: np.ndarray, held: Mapping[str, np.ndarray], *,
           is_downhill: bool) -> tuple[Balance, int, str]:
    """The balance, the number of iterations and the way in which it was found."""
    search = Search(system, t, held, is_downhill=is_downhill)
    balance, is_found = search.run(p)
    if is_found:
        return balance, search.iterations, "Newton's method in a trust region"
    other = Search(system, t, held, is_downhill=True)
    for how, begin in WAYS.items():
        if (is_downhill and begin is _unmoved) or (held and begin is settled):
            continue
        try:
            found, is_found = other.run(begin(system, p))
        except ZerodriftError:
            continue
        if is_found:
            return found, search.iterations + other.iterations, how
        balance = min(balance, found, key=lambda each: each.residual)
    raise EquilibriumFailed(_nothing(balance, p))


def _nothing(balance: Balance, start: np.ndarray) -> str:
    """The message of a search that found nothing."""
    at, where = balance.at, np.array2string(balance.at.p, precision=4, threshold=12, max_line_width=1000)
    moved = np.abs(at.p - start) / scales(at.system, start).p
    runs = f"{at.system.coordinates[int(moved.argmax())].name!r} moves on without end" if moved.max() > FAR else (
        f"it accelerates {balance.largest_force()!r}")
    return (f"{at.system.name} must have a position in which its forces balance, and none was found: a force of "
            f"{balance.residual:.3g} N/sqrt(kg) in the mass metric remains; {runs}, at p = {where}; hold that motion with "
            "hold=, or start the search elsewhere with near=")
