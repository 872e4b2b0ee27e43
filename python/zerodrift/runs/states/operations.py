"""Operations of a step, individually: assemble, project, accelerate; for programs with their own integrator."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

import numpy as np

from ..._private import checks, gateway
from ..._private.gateway import Variable
from ..._private.types import ArrayLike, Formulation, Measures, Projection, SystemLike, Values
from ...errors import WrongType, WrongValue
from ...systems.base import BaseSystem, Makes, core_of, system_of
from ..arguments import methods, settings

TOL, ITERATIONS = 1e-12, 100      # defaults of `assemble`
NUDGE = 1e-3                      # default displacement, in rad or relative to the size of the mechanism
IMPACT = 1e-7       # change of velocities at a state, relative to these, that is rounding


def assemble(system: SystemLike, p: ArrayLike | Values | None = None, v: ArrayLike | None = None, hold: Measures = (), *,
             wish: Values | None = None, nudge: bool | float = False, t: float = 0.0, tol: float = TOL,
             max_iterations: int = ITERATIONS) -> tuple[np.ndarray, np.ndarray]:
    """Find a consistent state near a guess, or the state of a mechanism near its reference configuration.

    Positions are projected onto the constraints by iteration (25a), then velocities (25b), with the smallest change in the
    mass metric. Held coordinates and velocities do not change.

    Parameters
    ----------
    system : system
        One of `zerodrift.systems`, or a `zerodrift.System`.
    p : array_like (nq,), or dict of measure to value
        Guess of the coordinates. For a mechanism: measures and the values that they must have, in addition to those given to
        `Mechanism.start`; joint coordinates that remain free keep their drawn values and are at rest.
    v : array_like (nv,), optional
        Guess of the velocities; left out: zero.
    hold : sequence of str or Variable, or one of them
        Coordinates and velocities that keep the values of the guess: their names, or entries of `system.coordinates` and
        `system.velocities`.
    wish : dict of measure to value
        For a mechanism: measures and values that are met as nearly as possible, after those in `p`.
    nudge : bool or float
        For a mechanism: distance of the start from the assembled position, held values included, for drawings that are
        singular, such as a stretched linkage or a universal joint at a right angle. It is the largest change of any coordinate,
        in rad or relative to the size of the mechanism; True is 0.001. The direction is that of the velocities that are held
        or driven, else a random free one.
    t : float
        Time in s, for constraints that depend on it.
    tol : float
        Tolerance of ``|Phi|`` relative to its size, as in `Projection`. A result in whose own scale a run may not start, as from
        a guess that is far away, is the guess of the next iteration.
    max_iterations : int
        The largest number of iterations, from each guess.

    Returns
    -------
    p, v : ndarray (nq,), (nv,)

    Raises
    ------
    CorrectionFailed
        If no consistent position was found: links cannot close, held values contradict them, or the guess is too far away.
    SingularSystem
        If the constraints cannot be satisfied by changing coordinates that are not held.
    InconsistentStart
        If a mechanism cannot have the required values; the error names the measure and the difference.

    Examples
    --------
    >>> import zerodrift as zd
    >>> bar = zd.systems.four_bar()
    >>> p, v = zd.assemble(bar, [1.2, 0.3, -1.5], [2.0, 0.0, 0.0], hold=("alpha1", "alpha1_dot"))
    >>> float(p[0]), float(v[0])
    (1.2, 2.0)
    """
    if isinstance(p, Mapping) or isinstance(system, Makes) or (p is None and hasattr(system, "_assembled")):
        return _assembled(system_of(system), p, v, hold, wish, _far(nudge), checks.number("t", t))
    core_of(system)
    if wish is not None or nudge:
        raise WrongType(f"wish and nudge must be left out, as {system.name} is not a mechanism", "conflicting-arguments")
    if p is None:
        raise WrongType(f"p must be given, a guess of the coordinates of {system.name}", "missing-argument")
    holds = _holds(system, hold)
    v = np.zeros(system.nv) if v is None else v
    return _corrected(system, p, v, t, methods.Projection(tol=tol, max_iterations=max_iterations), "augmented", holds)


def assembly(system: BaseSystem, hold: Any = ()) -> gateway.Assembly:
    """Settings with which the core makes a state consistent as `assemble` does, holding these coordinates and velocities."""
    projection = methods.Projection(tol=TOL, max_iterations=ITERATIONS)
    return gateway.Assembly(_options("augmented", projection), *_holds(system, hold))


def _far(nudge: bool | float) -> float:
    """Value of the argument `nudge` as a number; 0.0 for False."""
    if isinstance(nudge, bool | np.bool_):
        return NUDGE if nudge else 0.0
    return checks.number("nudge", nudge, above=0)


def _assembled(system: Any, held: Any, v: Any, hold: Any, wish: Any, nudge: float, t: float) -> tuple[np.ndarray, np.ndarray]:
    """Assembled state of a mechanism near its reference configuration."""
    core_of(system)
    if v is not None or hold != () or not (held is None or isinstance(held, Mapping)):
        raise WrongType("p of a mechanism must be a dict of values by measure, positions and velocities, without v and hold")
    if not hasattr(system, "_assembled"):
        raise WrongType("p must hold real numbers, not object: a dict of values by measure is for mechanisms, "
                        f"and {system.name} is not one")
    return system._assembled(held, wish, nudge, t)


def _holds(system: BaseSystem, hold: Any) -> list[list[int]]:
    """Flags (0 or 1) of the held coordinates and of the held velocities."""
    held, core = _held(system, hold), core_of(system)
    following = [variable.name for variable in system.coordinates[core.nq - core.c.followers:] if variable.name in held]
    if following:
        raise WrongValue(f"hold names {following[0]!r}, which follows other coordinates: of a mechanism m, "
                         f"zd.assemble(m, {{{following[0]!r}: ...}}) holds it", "wrong-measure")
    return [[int(variable.name in held) for variable in group] for group in (system.coordinates, system.velocities)]


def _held(system: BaseSystem, hold: Any) -> set[str]:
    """Names of coordinates and velocities in the argument `hold`, checked."""
    if not isinstance(hold, Iterable):
        raise WrongType(f"hold must be names of coordinates and velocities, not {hold!r}")
    known = {variable.name: variable for variable in (*system.coordinates, *system.velocities)}
    each = (hold,) if isinstance(hold, str | Variable) else tuple(hold)
    return {_name_of(one, known) for one in each}


def _name_of(held: Any, known: Mapping[str, Variable]) -> str:
    """Name of a held coordinate or velocity, given by name or as a variable of the system."""
    name = held.name if isinstance(held, Variable) and known.get(held.name) == held else held
    return name if isinstance(name, str) and name in known else checks.choice("hold", name, list(known))


def project(system: SystemLike, p: ArrayLike, v: ArrayLike, t: float = 0.0, *, projection: Projection | None = None,
            formulation: Formulation | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Project positions and velocities onto the constraints, (25)-(27), as after a step of `simulate`.

    Parameters
    ----------
    system : system or Mechanism
    p, v : array_like (nq,), (nv,)
        State to correct; these arrays are not modified.
    t : float
        Time in s.
    projection : Projection
        Settings of the projection: tolerance, metric, and so on.
    formulation : str, optional
        Name of the formulation whose leading matrix is used; left out: as in `simulate`.

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
    projection = methods.Projection() if projection is None else projection
    if not isinstance(projection, methods.Projection):
        raise WrongType(f"projection must be zd.Projection(...), not {projection!r}")
    return _corrected(system, p, v, t, projection, formulation, (None, None))


def _options(formulation: str, projection: methods.Projection) -> Any:
    row = methods.row_of("formulations", formulation)
    return gateway.settings({"formulation": row, **settings.given(formulation, projection)})


def _corrected(system: Any, p: Any, v: Any, t: Any, projection: methods.Projection, formulation: str | None,
               holds: Sequence[Any]) -> tuple[np.ndarray, np.ndarray]:
    of = system_of(system)
    core = core_of(of)
    p, v = checks.vector("p", p, core.nq), checks.vector("v", v, core.nv)
    gateway.project(core, _options(formulation or of._formulation, projection), checks.number("t", t), p, v, *holds)
    return p, v


def acceleration(system: SystemLike, p: ArrayLike, v: ArrayLike, t: float = 0.0, formulation: Formulation | None = None,
                 on_singular: Literal["stop", "continue"] = "stop") -> tuple[np.ndarray, np.ndarray]:
    """Accelerations and multipliers at (t, p, v).

    Parameters
    ----------
    system : system or Mechanism
    p, v : array_like (nq,), (nv,)
        The state. It need not satisfy the constraints, except in systems with contacts: these are in the phase with which a run
        from the state would begin.
    t : float
        Time in s.
    formulation : str, optional
        One of `formulations()`; left out: as in `simulate`.
    on_singular : {"stop", "continue"}
        Behaviour at a bifurcation, a position in which constraints that are independent elsewhere become dependent. "stop"
        raises `Bifurcation`. "continue" returns the acceleration of the motion that passes the bifurcation with this
        velocity; at rest, the smallest acceleration along any branch.

    Returns
    -------
    vdot, multipliers : ndarray (nv,), (m,)
        With the sign of (7): ``M vdot + d = f - C.T @ multipliers``, and ``C vdot = xi``. Where constraints are redundant,
        the multipliers that minimize ``sum(multipliers**2 * s**2)`` with ``s**2 = diag(C inv(M) C.T)``. At a bifurcation
        some are unbounded; their contribution to the reactions is left out.

    Examples
    --------
    >>> import zerodrift as zd
    >>> vdot, multipliers = zd.acceleration(zd.systems.oscillator(), [0.1], [0.0])
    >>> vdot
    array([-1.])
    """
    of = system_of(system)
    core = core_of(of)
    row = methods.row_of("formulations", formulation or of._formulation)
    at = checks.number("t", t), checks.vector("p", p, core.nq), checks.vector("v", v, core.nv)
    if of._groups:
        return phase_at(of, *at, row)[2:]
    return gateway.acceleration(core, row, settings.on_singular_row(on_singular), *at)


def phase_at(of: BaseSystem, t: float, p: np.ndarray, v: np.ndarray, row: int) -> Any:
    """The phase with which a run from a state begins: states of its groups, v, vdot and multipliers.

    Raises
    ------
    ValueError
        If contacts collide there.
    """
    found = gateway.phase_at(core_of(of), row, t, p, v)
    if np.abs(found.v - v).max(initial=0.0) > IMPACT * (1.0 + np.abs(v).max(initial=0.0)):
        raise WrongValue(f"a state of {of.name} must be before or after an impact, and contacts collide in it", "not-available")
    return found
