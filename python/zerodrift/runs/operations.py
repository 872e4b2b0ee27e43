"""The steps of a run by themselves: assemble, project, accelerate. For those who bring their own integrator."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from .. import _check, _gateway
from .._gateway import Variable
from ..systems.base import BaseSystem, Makes, core_of, system_of
from . import settings

TOL, ITERATIONS = 1e-12, 100      # of `assemble`, where nothing else is asked for
NUDGE = 1e-3                      # in rad or parts of a mechanism's size


def assemble(system: BaseSystem, p: Any = None, v: Any = None, hold: Any = (), *, wish: Mapping[Any, Any] | None = None,
             nudge: bool | float = False, t: float = 0.0, tol: float = TOL,
             max_iterations: int = ITERATIONS) -> tuple[np.ndarray, np.ndarray]:
    """Find a consistent state near a guess, or that of a mechanism near its drawing.

    Positions are iterated onto the constraints, then velocities corrected; each moves as little as possible in the mass
    metric, (25), and what is held does not move at all.

    Parameters
    ----------
    system : system
        One of `zerodrift.systems`, or a `zerodrift.System`.
    p : array_like (nq,), or dict of measure to value
        Guess of the coordinates. Of a mechanism: what is held, positions and velocities, besides what its `start` holds; all
        else is as `Mechanism.start` says: joint coordinates that nothing forces stay as drawn and at rest.
    v : array_like (nv,), optional
        Guess of the velocities; left out: zero.
    hold : sequence of str or Variable, or one of them
        Coordinates and velocities that keep the values of the guess: their names, or entries of `system.coordinates` and
        `system.velocities`.
    wish : dict of measure to value
        Of a mechanism: what is met as nearly as possible after that.
    nudge : bool or float
        Of a mechanism: how far aside of the assembled position it starts, held ones included, in rad or parts of its size,
        whichever coordinate moves most; True is a thousandth. It moves along the velocities that are held or driven, if there
        are any, and else along a random free direction. For drawings that are singular, as a stretched linkage is, or a
        universal joint at a right angle.
    t : float
        Time in s, for constraints that depend on it.
    tol : float
        Of ``|Phi|`` in units of its size, as in `Projection`.
    max_iterations : int
        The largest number of iterations.

    Returns
    -------
    p, v : ndarray (nq,), (nv,)

    Raises
    ------
    CorrectionFailed
        If no consistent position was found: links cannot close, what is held contradicts them, or the guess is too far away.
    SingularSystem
        If what is held leaves no way to satisfy the constraints.
    InconsistentStart
        If what a mechanism is to hold cannot be met; the error names it, and by how much it is missed.

    Examples
    --------
    >>> import zerodrift as zd
    >>> bar = zd.systems.four_bar()
    >>> p, v = zd.assemble(bar, [1.2, 0.3, -1.5], [2.0, 0.0, 0.0], hold=("alpha1", "alpha1_dot"))
    >>> float(p[0]), float(v[0])
    (1.2, 2.0)
    """
    if isinstance(p, Mapping) or isinstance(system, Makes) or (p is None and hasattr(system, "_assembled")):
        return _assembled(system_of(system), p, v, hold, wish, _far(nudge), _check.number("t", t))
    core_of(system)
    if wish is not None or nudge:
        raise TypeError(f"wish and nudge are for mechanisms, and {system.name} is none")
    if p is None:
        raise TypeError(f"p is needed, a guess of the coordinates of {system.name}")
    holds = _holds(system, hold)
    v = np.zeros(system.nv) if v is None else v
    return _corrected(system, p, v, t, settings.Projection(tol=tol, max_iterations=max_iterations), "augmented", holds)


def assembly(system: BaseSystem, hold: Any = ()) -> _gateway.Assembly:
    """How the core does what `assemble` does, holding these coordinates and velocities."""
    projection = settings.Projection(tol=TOL, max_iterations=ITERATIONS)
    return _gateway.Assembly(_options("augmented", projection), *_holds(system, hold))


def _far(nudge: bool | float) -> float:
    """How far aside."""
    if isinstance(nudge, bool | np.bool_):
        return NUDGE if nudge else 0.0
    return _check.number("nudge", nudge, above=0)


def _assembled(system: Any, held: Any, v: Any, hold: Any, wish: Any, nudge: float, t: float) -> tuple[np.ndarray, np.ndarray]:
    """The state of a mechanism near its drawing."""
    core_of(system)
    if v is not None or hold != () or not (held is None or isinstance(held, Mapping)):
        raise TypeError("p of a mechanism must be a dict of values by measure, positions and velocities, without v and hold")
    if not hasattr(system, "_assembled"):
        raise TypeError("p must hold real numbers, not object: a dict of values by measure is for mechanisms, "
                        f"and {system.name} is none")
    return system._assembled(held, wish, nudge, t)


def _holds(system: BaseSystem, hold: Any) -> list[list[int]]:
    """Which coordinates and which velocities are held."""
    held, core = _held(system, hold), core_of(system)
    following = [variable.name for variable in system.coordinates[core.nq - core.c.followers:] if variable.name in held]
    if following:
        raise ValueError(f"hold names {following[0]!r}, which follows other coordinates: of a mechanism m, "
                         f"zd.assemble(m, {{{following[0]!r}: ...}}) holds it")
    return [[int(variable.name in held) for variable in group] for group in (system.coordinates, system.velocities)]


def _held(system: BaseSystem, hold: Any) -> set[str]:
    """The argument `hold`: names of coordinates and velocities."""
    if not isinstance(hold, Iterable):
        raise TypeError(f"hold must be names of coordinates and velocities, not {hold!r}")
    known = {variable.name: variable for variable in (*system.coordinates, *system.velocities)}
    each = (hold,) if isinstance(hold, str | Variable) else tuple(hold)
    return {_name_of(one, known) for one in each}


def _name_of(held: Any, known: Mapping[str, Variable]) -> str:
    """The name of what is held, whether it is a name or a variable of the system."""
    name = held.name if isinstance(held, Variable) and known.get(held.name) == held else held
    return name if isinstance(name, str) and name in known else _check.choice("hold", name, list(known))


def project(system: BaseSystem, p: Any, v: Any, t: float = 0.0, *, projection: settings.Projection | None = None,
            formulation: str = settings.FORMULATION) -> tuple[np.ndarray, np.ndarray]:
    """Correct positions and velocities onto the constraints, (25)-(27), as after a step of `simulate`.

    Parameters
    ----------
    system : system
        One of `zerodrift.systems`, or a `zerodrift.System`.
    p, v : array_like (nq,), (nv,)
        The state to be corrected; it is not changed.
    t : float
        Time in s.
    projection : Projection
        Tolerance, metric, and so on.
    formulation : str
        Whose leading matrix is used.

    Returns
    -------
    p, v : ndarray (nq,), (nv,)

    Raises
    ------
    CorrectionFailed, SingularSystem

    Examples
    --------
    >>> import zerodrift as zd
    >>> bar = zd.systems.four_bar()
    >>> p, v = zd.project(bar, bar.p0 + 1e-3, bar.v0)
    >>> bool(abs(bar.evaluate(p, v).Phi).max() < 1e-12)
    True
    """
    projection = settings.Projection() if projection is None else projection
    if not isinstance(projection, settings.Projection):
        raise TypeError(f"projection must be zd.Projection(...), not {projection!r}")
    return _corrected(system, p, v, t, projection, formulation, (None, None))


def _options(formulation: str, projection: settings.Projection) -> Any:
    return _gateway.settings({"formulation": settings.formulation_row(formulation), **settings.given(formulation, projection)})


def _corrected(system, p, v, t, projection, formulation, holds) -> tuple[np.ndarray, np.ndarray]:
    core = core_of(system)
    p, v = _check.vector("p", p, core.nq), _check.vector("v", v, core.nv)
    _gateway.project(core, _options(formulation, projection), _check.number("t", t), p, v, *holds)
    return p, v


def acceleration(system: BaseSystem, p: Any, v: Any, t: float = 0.0, formulation: str = settings.FORMULATION,
                 on_singular: str = "stop") -> tuple[np.ndarray, np.ndarray]:
    """Accelerations and multipliers at (t, p, v).

    Parameters
    ----------
    system : system
        One of `zerodrift.systems`, or a `zerodrift.System`.
    p, v : array_like (nq,), (nv,)
        The state. It need not satisfy the constraints.
    t : float
        Time in s.
    formulation : str
        One of `formulations()`.
    on_singular : {"stop", "continue"}
        What to do at a bifurcation, a position in which constraints that are independent elsewhere become dependent. "stop"
        raises `Bifurcation`. "continue" returns the acceleration of the motion that goes through the bifurcation with this
        velocity; at rest, the smallest acceleration along any branch.

    Returns
    -------
    vdot, multipliers : ndarray (nv,), (m,)
        With the sign of (7): ``M vdot + d = f - C.T @ multipliers``, and ``C vdot = xi``. Where constraints are redundant,
        the smallest multipliers: ``sum(multipliers**2 * s**2)`` is least, with ``s**2 = diag(C inv(M) C.T)``. At a bifurcation
        some are unbounded; their part of the reactions is left out.

    Examples
    --------
    >>> import zerodrift as zd
    >>> vdot, multipliers = zd.acceleration(zd.systems.oscillator(), [0.1], [0.0])
    >>> vdot
    array([-1.])
    """
    core = core_of(system)
    return _gateway.acceleration(core, settings.formulation_row(formulation), settings.on_singular_row(on_singular),
                                 _check.number("t", t), _check.vector("p", p, core.nq), _check.vector("v", v, core.nv))
