"""Types of arguments, for type checkers and editors; written by tests/support/stubs.py."""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike as _PathLike
from typing import Any, Literal, Protocol, TypedDict

import numpy as np
from numpy.typing import ArrayLike as ArrayLike

from ..mechanisms.elements.bodies import Body as Body
from ..mechanisms.elements.bodies import Point as Point
from ..mechanisms.elements.measures import Measure as Measure
from ..mechanisms.mechanism import Mechanism as Mechanism
from ..runs.arguments.events import Event
from ..runs.arguments.methods import RowSettings
from ..runs.open.control import Every
from ..runs.states.instant import Reading as Reading
from ..systems.base import BaseSystem

class Expression(Protocol):
    """An expression of SymPy."""

    @property
    def free_symbols(self) -> Any: ...

SystemLike = Mechanism | BaseSystem
StateLike = ArrayLike | Reading
MeasureLike = Measure | str
Measures = Sequence[MeasureLike]
Display = Mapping[str, str]
EventLike = Event | Measure | str | Expression | Callable[[float, np.ndarray, np.ndarray], float]
Events = EventLike | Sequence[EventLike]
Names = MeasureLike | Measures
Points = Point | MeasureLike | Sequence[Point | MeasureLike]
Inputs = MeasureLike | Sequence[MeasureLike] | Mapping[str, tuple[float, float] | None]
LawLike = float | Expression | Callable[..., Any]
Laws = LawLike | Sequence[LawLike] | np.ndarray
UserFunction = Callable[..., Any]
TermLike = ArrayLike | UserFunction
Equations = Sequence[Expression] | Mapping[str, Expression]
Bindings = Mapping[str, MeasureLike]
Values = Mapping[str, ArrayLike] | Mapping[Measure, ArrayLike] | Mapping[MeasureLike, ArrayLike]
Motions = Mapping[str, ArrayLike | LawLike] | Mapping[Measure, ArrayLike | LawLike] | Mapping[MeasureLike, ArrayLike | LawLike]
PathLike = str | _PathLike[str]

Formulation = Literal['augmented', 'nullspace', 'schur', 'mixed', 'independent']
Integrator = Literal['euler', 'midpoint', 'heun', 'rk4', 'dormand_prince', 'dop853', 'extrapolation', 'trapezoidal', 'radau',
                     'rattle', 'taylor']
Correction = Literal['baumgarte', 'projection', 'energy']
StabilizationName = Literal['projection', 'baumgarte']
VectorUnit = Literal['baseline', 'avx2', 'avx512']

class Settings(TypedDict, total=False):
    """Settings of steps and methods, as of `simulate`."""

    save_every: int
    rtol: float | None
    atol: float | None
    first_step: float | None
    max_step: float | None
    max_move: float | None
    max_steps: int | None
    formulation: Formulation | RowSettings | None
    integrator: Integrator | RowSettings | None
    stabilization: StabilizationName | RowSettings | None
    energy: bool | RowSettings | None
    correction: Correction | RowSettings | Sequence[Correction | RowSettings] | None
    on_singular: Literal['stop', 'continue']
    closed_form: Literal[False] | None
    vector: VectorUnit | None

class SimulateSettings(Settings, total=False):
    """Settings of `simulate`."""

    inputs: Inputs | None
    hold: bool
    ramp: float | None
    control: Every | Sequence[Every] | None
    save_to: PathLike | None
    progress: bool | Callable[[float], object]
    on_failure: Literal['raise', 'return']

class ExploreOptions(SimulateSettings, total=False):
    """Arguments of `simulate` and of `view`."""

    step: float | None
    t_eval: ArrayLike | None
    events: Events | None
    outputs: Measures | None
    forces: bool | Sequence[Any]
    path: str | Point | Sequence[str | Point]
    graphs: MeasureLike | Measures
    names: bool
    speed: float | None

class EnsembleOptions(Settings, total=False):
    """Arguments of `simulate` for the runs of an ensemble."""

    step: float | None
    t_eval: ArrayLike | None
    events: Events | None

class Projection(RowSettings):
    """Positions and velocities are projected onto the constraints after the step, orthogonally in the mass metric.

    Positions are iterated onto the constraints (3) to the tolerance, then velocities onto (5) in one
    solve, with the leading matrix that the formulation has factored already. In the mass metric the
    correction is orthogonal to the manifold of the constraints and does not change the motion along it,
    so that the order of the integrator is unchanged.

    Parameters
    ----------
    tol : float, positive
        Positions are iterated until every ``|Phi|`` is at most this, in units of its size
        `Solution.position_size`: the largest ``|C_ki|`` times one radian of an angle or the mechanism's
        own length, at the start. The tolerance so means the same in any unit: angles are off by about
        that many rad, and lengths by that part of the mechanism's length.
    max_iterations : int
        The largest number of iterations. A correction that needs more is tried again with shortened
        iterations, then with the step in up to eight parts (or shorter, with adaptive steps);
        `Solution.stats` counts all of them. Where none of this helps, the run fails.
    every : int
        Steps between corrections; the last step is always corrected.
    metric : {'mass', 'identity'}
        Metric in which the correction is orthogonal: the mass matrix, or (for comparison) the identity
        of the paper's reference [20].
    positions : bool
        True: positions are corrected.
    velocities : bool
        True: velocities are corrected.

    Notes
    -----
    Source: (25), (26), (27); W. Blajer, Elimination of constraint violation and accuracy aspects in
    numerical simulation of multibody systems, Multibody System Dynamics 7 (2002) 265-284, section 3.1.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.systems.four_bar(), 8.0, step=0.01, stabilization=zd.Projection())
    """

    tol: float
    max_iterations: int
    every: int
    metric: Literal['mass', 'identity']
    positions: bool
    velocities: bool
    def __init__(self, tol: float = 1e-12, max_iterations: int = 10, every: int = 1, metric: Literal['mass', 'identity'] = 'mass',
                 positions: bool = True, velocities: bool = True) -> None: ...

class Baumgarte(RowSettings):
    """Violations are fed back into the acceleration constraints, with gains alpha, beta and integral.

    The right side of (6) gets -alpha Psi - beta Phi, so that violations decay as a damped oscillation
    instead of growing. They stay bounded but do not vanish: their size depends on the gains, the step
    and the motion. Gains that are large for the step make an explicit method unstable.

    Parameters
    ----------
    alpha : float in 1/s, not negative
        Gain of the velocity violation.
    beta : float in 1/s^2, not negative
        Gain of the position violation. ``beta = alpha**2 / 4`` damps critically.
    integral : float in 1/s^3, not negative
        Gain of the time integral of the position violation, after the paper's reference [16]; it must
        be less than ``alpha * beta``, or the feedback itself is unstable.

    Notes
    -----
    Source: (23); J. Baumgarte, Stabilization of constraints and integrals of motion in dynamical
    systems, Computer Methods in Applied Mechanics and Engineering 1 (1972) 1-16.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.systems.four_bar(), 8.0, step=0.01, stabilization=zd.Baumgarte())
    """

    alpha: float
    beta: float
    integral: float
    def __init__(self, alpha: float = 10.0, beta: float = 25.0, integral: float = 0.0) -> None: ...

class EnergyCorrection(RowSettings):
    """Velocities are scaled so that the energy balance holds.

    After the correction of the constraints, the part of the velocities that moving constraints do not
    prescribe is scaled by one factor, such that kinetic and potential energy equal the initial energy
    and the work done since. Near a turning point the kinetic energy is too small for this; such a step
    is not corrected, and counted. A closed energy balance does not imply that the phase of the motion
    is right.

    Parameters
    ----------
    every : int
        Steps between corrections; the last step is always corrected.

    Notes
    -----
    Source: (28), (29); W. Blajer, Elimination of constraint violation and accuracy aspects in numerical
    simulation of multibody systems, Multibody System Dynamics 7 (2002) 265-284, section 3.2.

    Examples
    --------
    >>> import zerodrift as zd
    >>> sol = zd.simulate(zd.systems.four_bar(), 8.0, step=0.01, energy=zd.EnergyCorrection())
    """

    every: int
    def __init__(self, every: int = 1) -> None: ...
