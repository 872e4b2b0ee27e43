"""`simulate`: from a system to its motion."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

from . import _check, _gateway, settings
from ._system import BaseSystem, core_of
from .errors import CorrectionWarning, Interrupted
from .solution import Solution

SLICE = 0.03    # seconds the core runs between looks at the keyboard and the progress bar


def simulate(
    system: BaseSystem,
    t_span: float | tuple[float, float],
    p0: Any = None,
    v0: Any = None,
    *,
    step: float | None = None,
    formulation: str = "schur",
    integrator: str = "rk4",
    stabilization: str | settings.Stabilization = "projection",
    energy: bool | settings.EnergyCorrection | None = None,
    save_every: int = 1,
    progress: bool | Callable[[float], None] = False,
    on_failure: str = "raise",
) -> Solution:
    """Simulate the motion of a constrained multibody system.

    Parameters
    ----------
    system : system
        One of `zerodrift.systems`, or a `zerodrift.System`.
    t_span : float or (float, float)
        End time, or start and end, in s.
    p0, v0 : array_like (nq,), (nv,), optional
        Start; left out: the system's own. It must satisfy the constraints, see `assemble`.
    step : float
        Step in s. If the span is no whole number of steps, a shorter one is added at the end.
    formulation : str
        One of `formulations()`: which equations of motion are solved.
    integrator : str
        One of `integrators()`.
    stabilization : None, "projection", "baumgarte", Projection or Baumgarte
        How constraint violations are kept down.
    energy : None, True or EnergyCorrection
        Whether energy errors are taken out of the velocities, (29).
    save_every : int
        Steps between saved rows; start and end are always saved.
    progress : bool or callable
        True: a progress bar (needs tqdm). A callable is handed the part done, 0 ... 1, some thirty times a second.
    on_failure : {"raise", "return"}
        Whether a run that fails or is interrupted raises an error that carries the partial solution as `.solution`,
        or returns that solution, whose `success` is then False.

    Returns
    -------
    Solution

    Raises
    ------
    ZerodriftError
        Or one of its subclasses, where the start is inconsistent, a correction or an implicit step fails, the motion diverges.
    Interrupted
        On Ctrl-C.
    ValueError, TypeError
        For a wrong argument.

    Examples
    --------
    >>> import zerodrift as zd
    >>> bar = zd.systems.four_bar()
    >>> sol = zd.simulate(bar, 8.0, step=0.05, formulation="augmented", stabilization=zd.Projection(), energy=True)
    >>> sol.p.shape
    (161, 3)
    >>> bool(abs(sol.position_violation).max() < 1e-12)
    True
    """
    core, span = core_of(system), _check.span(t_span)
    chosen = _chosen(system, span, step, formulation, integrator, stabilization, energy, save_every)
    _check.choice("on_failure", on_failure, ("raise", "return"))
    p0, v0 = system._start(p0, v0)
    run = _gateway.Run(core, _core_settings(span, chosen), p0, v0)
    record = _gateway.Record(core, _rows(span, chosen))
    return _finish(system, span, chosen, run, record, on_failure, *_drive(run, record, progress))


def _chosen(system, span, step, formulation, integrator, stabilization, energy, save_every) -> dict[str, Any]:
    """The settings, checked: what `Solution.settings` will say."""
    if step is None:
        raise ValueError(f"step is needed: {integrator!r} takes steps of fixed size")
    step = _check.number("step", step, above=0)
    smallest = 16 * np.finfo(float).eps * max(map(abs, span))
    if step < smallest:
        raise ValueError(f"step must be at least {smallest:.3g} for times up to {max(map(abs, span)):g}, not {step:g}")
    settings.formulation_row(formulation)
    settings.integrator_row(integrator)
    energy = settings.energy(energy)
    if energy and not system.has_energy:
        raise ValueError(f"energy correction needs a potential energy, and {system.name} declares none")
    return {"step": step, "formulation": formulation, "integrator": integrator,
            "stabilization": settings.stabilization(stabilization), "energy": energy,
            "save_every": _check.count("save_every", save_every)}


def _core_settings(span: tuple[float, float], chosen: dict[str, Any]) -> Any:
    options = {"formulation": settings.formulation_row(chosen["formulation"]),
               "integrator": settings.integrator_row(chosen["integrator"]),
               "t0": span[0], "t1": span[1], "step": chosen["step"], "save_every": chosen["save_every"]}
    for correction in (chosen["stabilization"], chosen["energy"]):
        options |= correction._core() if correction else {}
    return _gateway.settings(options)


def _drive(run: _gateway.Run, record: _gateway.Record, progress: Any) -> tuple[int, float]:
    """Run slice by slice to the end; the status and the seconds it took."""
    show, close = _progress(progress)
    start, status = time.perf_counter(), _gateway.PAUSED
    try:
        while status == _gateway.PAUSED:
            status = run.advance(record, SLICE)
            show(run.progress)
    except KeyboardInterrupt:
        status = _gateway.INTERRUPTED
    finally:
        close()
    if status == _gateway.CALLBACK and isinstance(run.error(status), KeyboardInterrupt):
        status = _gateway.INTERRUPTED
    return status, time.perf_counter() - start


def _message(run: _gateway.Run, status: int) -> str:
    match status:
        case _gateway.DONE:
            return "done"
        case _gateway.INTERRUPTED:
            return "interrupted from the keyboard"
        case _gateway.CALLBACK:
            return f"{run.message}: {run.error(status)!r}"
        case _:
            return run.message


def _finish(system, span, chosen, run, record, on_failure, status, seconds) -> Solution:
    """The solution, or the error that carries it."""
    arrays = record.arrays()
    solution = Solution(
        t=arrays["t"], p=arrays["p"], v=arrays["v"], multipliers=arrays["multipliers"],
        position_violation=arrays["position_violation"], velocity_violation=arrays["velocity_violation"],
        kinetic_energy=arrays["kinetic"], potential_energy=arrays.get("potential"), energy_input=arrays.get("input"),
        energy_violation=arrays.get("energy_violation"), iterations=arrays["iterations"],
        stats=run.statistics | {"seconds": seconds}, status=status, success=status == _gateway.DONE,
        message=_message(run, status), settings=chosen, system=system, t_span=span)
    if on_failure == "raise" and not solution.success:
        _raise(run, status, solution)
    if skipped := solution.stats["energy_skipped"]:
        warnings.warn(f"{skipped} of {solution.stats['steps']} energy corrections were left out: near a turning point the "
                      "kinetic energy is too small for them", CorrectionWarning, stacklevel=3)
    return solution


def _raise(run: _gateway.Run, status: int, solution: Solution) -> None:
    if status == _gateway.INTERRUPTED:
        raise Interrupted(solution.message, solution) from None
    error = run.error(status)
    error.solution = solution
    if status == _gateway.CALLBACK:
        error.add_note(run.message)
    raise error


def _rows(span: tuple[float, float], chosen: dict[str, Any]) -> int:
    """Rows of the record, counted as the core counts steps, with the start."""
    steps = _gateway.count_steps(*span, chosen["step"])
    return steps // chosen["save_every"] + 1 + (steps % chosen["save_every"] != 0)


def _progress(progress: Any) -> tuple[Callable[[float], None], Callable[[], None]]:
    """How to show progress, and how to end that."""
    if progress is False or progress is None:
        return (lambda part: None), (lambda: None)
    if callable(progress):
        return progress, (lambda: None)
    if progress is not True:
        raise TypeError(f"progress must be True, False or a callable, not {progress!r}")
    try:
        from tqdm.auto import tqdm
    except ImportError:
        raise ImportError("progress=True shows a bar with tqdm, which is not installed: pip install tqdm") from None
    bar = tqdm(total=1.0, bar_format="{percentage:3.0f}%|{bar}| {elapsed}<{remaining}")

    def show(part: float) -> None:
        bar.n = part
        bar.refresh()

    return show, bar.close
