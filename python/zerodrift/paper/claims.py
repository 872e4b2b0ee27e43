"""Claims of the paper about Figures 5-9, and measured values. Nothing here is tuned: a claim may hold or not."""

from __future__ import annotations

import csv
import io
import textwrap
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..runs.arguments.methods import Projection
from ..runs.open.diagnosis import unwarned
from ..runs.samples.solution import Solution
from ..runs.simulate import simulate
from ..studies.compare import difference
from . import FOUR_BAR, reference

Runs = dict[str, Solution]


@dataclass(frozen=True)
class Claim:
    """A statement of the paper and its verification.

    Attributes
    ----------
    figure : int
        The figure it is about.
    claim, expected : str
        The claim of the paper, in other words, and the number or criterion taken for it.
    measured : str
        The measured result.
    holds : bool
        True: the measurement agrees with the claim.
    remark : str
        The reason, or the condition.
    """

    figure: int
    claim: str
    expected: str
    measured: str
    holds: bool
    remark: str = ""

    @property
    def verdict(self) -> str:
        """Verdict as text."""
        return "holds" if self.holds else "does not come out as stated"


def figure_5(fine: Solution) -> list[Claim]:
    """Claims about the paper's own reference solution, `paper.FOUR_BAR_REFERENCE`."""
    Phi, Psi = largest(fine.position_violation), largest(fine.velocity_violation)
    energy = largest(fine.energy_violation)
    every = round(reference.SPACING / fine.settings["step"])
    states = np.column_stack([fine.p[::every, 0], fine.v[::every, 0]])
    angle, rate = np.abs(states - reference.stored()).max(axis=0)
    return [
        Claim(5, "the reference solution (RK4, 0.0005 s, no control) hardly violates constraints and energy balance",
              "negligible: below 1e-6", f"|Phi| {Phi:.1e} m, |Psi| {Psi:.1e} m/s, |Psi_E| {energy:.1e} J",
              max(Phi, Psi, energy) < 1e-6),
        Claim(5, "that solution is numerically exact", "below 1e-5 rad and rad/s of link 1",
              f"error {angle:.1e} rad, {rate:.1e} rad/s against DOP853 on the equation in alpha_1",
              max(angle, rate) < 1e-5),
    ]


def figure_6(runs: Runs) -> list[Claim]:
    """Claims about the constraint violations in the cases of `paper.FOUR_BAR`."""
    a, b, c, d = runs.values()
    half = np.searchsorted(b.t, FOUR_BAR.end / 2)
    early, late = largest(b.position_violation[:half]), largest(b.position_violation[half:])
    start = a.t <= 1
    return [
        Claim(6, "(a) without control the constraints are soon badly violated", "|Phi| above 0.1 m before the end",
              f"|Phi| {largest(a.position_violation[start]):.1e} m in the first second, "
              f"{largest(a.position_violation):.2g} m at most; {ending(a)}", largest(a.position_violation) > 0.1),
        Claim(6, "(b) Baumgarte's method keeps the violations bounded", "no larger in the second half of the time",
              f"|Phi| {early:.1e} m in the first half, {late:.1e} m in the second; "
              f"|Psi| {largest(b.velocity_violation):.1e} m/s", b.success and late <= early),
        _no_violation(),
        _iterations(c, d),
        _one_velocity_correction([c, d]),
    ]


def _projected(tol: float) -> list[Solution]:
    """Cases (c) and (d) with another tolerance."""
    cases = [settings for settings in FOUR_BAR.cases.values() if isinstance(settings["stabilization"], Projection)]
    with unwarned():
        return [simulate(FOUR_BAR.system, FOUR_BAR.end, on_failure="return", closed_form=False,
                         **settings | {"stabilization": replace(settings["stabilization"], tol=tol)}) for settings in cases]


def _no_violation() -> Claim:
    runs = _projected(1e-15)
    Phi = max(largest(sol.position_violation) for sol in runs)
    Psi = max(largest(sol.velocity_violation) for sol in runs)
    return Claim(6, "(c), (d) projection leaves no violation", "below 1e-15",
                 f"|Phi| {Phi:.2e} m, |Psi| {Psi:.2e} m/s iterated to 1e-15 m, in at most {_most(runs)} iterations",
                 all(sol.success for sol in runs) and max(Phi, Psi) < 1e-15)


def _one_velocity_correction(runs: Sequence[Solution]) -> Claim:
    Psi = max(largest(sol.velocity_violation) for sol in runs)
    corrections, steps = (sum(sol.stats[name] for sol in runs) for name in ("velocity_corrections", "steps"))
    return Claim(6, "(c), (d) one velocity correction a step is enough", "|Psi| below 1e-14 m/s",
                 f"|Psi| {Psi:.1e} m/s with {corrections} corrections in {steps} steps",
                 corrections <= steps and Psi < 1e-14)


def _iterations(c: Solution, d: Solution) -> Claim:
    third = [int((sol.iterations > 2).sum()) for sol in (c, d)]
    return Claim(6, "(c), (d) at most two position corrections a step", "2",
                 f"{_most([c, d])} for 1e-14 m ({third[0]} and {third[1]} of {c.stats['steps']} steps take a third); "
                 f"{_most(_projected(1e-10))} for 1e-10 m", _most([c, d]) <= 2,
                 "two bring |Phi| to 1e-10 m; round-off takes a third in about one step of eight")


def figure_7(runs: Runs) -> list[Claim]:
    """Claims about energy and accuracy in the cases of `paper.FOUR_BAR`."""
    a, b, c, d = runs.values()
    errors = [link_1_error(sol) for sol in (a, b, c, d)]
    worst = [largest(error) for error in errors]
    return [
        Claim(7, "only (d), with both corrections, gives an accurate motion", "error of link 1 below 0.1 rad in (d)",
              ", ".join(f"{_angle(error)} in ({letter})" for error, letter in zip(worst, "abcd", strict=True)),
              worst[3] < 0.1 < min(worst[:3]),
              "the crank passes the top with only 0.26 J to spare: where more is lost, it loses whole turns"),
        Claim(7, "(d) the energy balance holds after every correction", "round-off",
              f"|Psi_E| {largest(d.energy_violation):.1e} J, of 33 J; in (c) {largest(c.energy_violation):.2g} J",
              largest(d.energy_violation) < 1e-12),
        _recovery(d, errors[3]),
        _delay(errors[2:]),
        *_signs_of_energy_errors(c, errors[2]),
    ]


def _recovery(d: Solution, error: np.ndarray) -> Claim:
    """Claim: the motion ends near the top, where the error is small again."""
    peaks = [largest(error[(d.t > start) & (d.t <= start + 2)]) for start in (0, 2, 4, 6)]
    return Claim(7, "(d) the error spoils and recovers in turn, and accuracy is kept", "at the end below half of its worst",
                 f"{abs(error[-1]):.1e} rad at the end; at worst {', '.join(f'{peak:.1e}' for peak in peaks)} rad in the four "
                 "quarters of the time", abs(error[-1]) < max(peaks) / 2, "its peaks still grow, but slowly")


def _delay(errors: Sequence[np.ndarray]) -> Claim:
    """Claim on the delay, while the crank makes the same turns as the reference."""
    behind = [float(np.mean(error[1:][np.abs(error[1:]) < 1] < 0)) for error in errors]
    return Claim(7, "the numerical motion lags behind the exact one", "always",
                 f"behind at {behind[0]:.0%} of the instants in (c), {behind[1]:.0%} in (d)", min(behind) == 1,
                 "as long as the error is below 1 rad; in this example it is ahead most of the time")


def _signs_of_energy_errors(c: Solution, error: np.ndarray) -> list[Claim]:
    """Claims about the errors of T and V in case (c), as long as the crank makes the same turns as the reference."""
    dT, dV = energy_errors(c, reference.four_bar_energies)
    same, rising = (np.abs(error) < 1) & (c.t > 0), np.array([np.cos(reference.four_bar(t)[0]) > 0 for t in c.t])
    up, down = same & rising, same & ~rising
    both, opposite = np.mean((dT < 0) & (dV < 0), where=up), np.mean((dT < 0) & (dV > 0), where=down)
    why = "(c), as long as its error is below 1 rad; it gains energy in the first second, and so runs ahead"
    return [Claim(7, "while link 1 rises, T and V are both too small", "always", f"at {both:.0%} of the instants",
                  both == 1, why),
            Claim(7, "while it falls, T is too small and V too large", "always", f"at {opposite:.0%} of the instants",
                  opposite == 1, why)]


def figure_8(runs: Runs) -> list[Claim]:
    """Claims about energy and accuracy in the cases of `paper.OSCILLATOR`."""
    a, b, c, _ = runs.values()
    error = [largest(difference(sol, reference.oscillator)) for sol in runs.values()]
    energy = [largest(sol.energy_violation) for sol in (a, b, c)]
    return [
        Claim(8, "energy correction (b) and trapezoidal rule (c) conserve energy", "round-off",
              f"|Psi_E| {energy[1]:.1e} and {energy[2]:.1e} J, of 0.05 J; in (a) {energy[0]:.1e} J",
              max(energy[1:]) < 1e-14),
        Claim(8, "(b) energy correction hardly improves accuracy", "by less than a factor of 2",
              f"error {error[0]:.2e} m in (a), {error[1]:.2e} m in (b): a factor of {error[0] / error[1]:.1f}",
              error[0] / error[1] < 2),
        Claim(8, "(c) Newmark's method is 100 times less accurate than (a)", "100",
              f"{error[2] / error[0]:.1f} with the printed steps, 0.025 and 0.1 s; "
              f"{error[3] / error[0]:.0f} with 0.1 s for both", 50 < error[2] / error[0] < 200,
              "the factor of 100 is that of equal steps"),
    ]


def figure_9(runs: Runs) -> list[Claim]:
    """Claims about the errors of kinetic and potential energy in the cases of `paper.OSCILLATOR`."""
    (Ta, Va), (Tb, Vb), (Tc, Vc), _ = (energy_errors(sol, reference.oscillator_energies) for sol in runs.values())
    opposite = np.mean(Ta[1:] * Va[1:] < 0)
    ratio = largest(Ta + Va) / max(largest(Ta), largest(Va))
    return [
        Claim(9, "(a) dT and dV have opposite signs", "always", f"at {opposite:.0%} of the instants", opposite == 1,
              "RK4 loses energy at this step, which both share"),
        Claim(9, "(a) dE = dT + dV is small beside dT and dV", "below a tenth",
              f"|dE| {largest(Ta + Va):.1e} J is {ratio:.2f} of the larger of the two", ratio < 0.1,
              "smaller, but of the same order of magnitude"),
        Claim(9, "(b) energy correction makes dE vanish", "round-off", f"|dE| {largest(Tb + Vb):.1e} J",
              largest(Tb + Vb) < 1e-14),
        Claim(9, "(b) and leaves dT and dV almost as they were", "within a tenth",
              f"|dT| {largest(Ta):.1e} -> {largest(Tb):.1e} J, |dV| {largest(Va):.1e} -> {largest(Vb):.1e} J",
              0.9 < largest(Tb) / largest(Ta) < 1.1 and 0.9 < largest(Vb) / largest(Va) < 1.1,
              "they become smaller by two fifths: the amplitude error is gone, the phase error stays"),
        Claim(9, "(c) Newmark's dE vanishes too", "round-off", f"|dE| {largest(Tc + Vc):.1e} J",
              largest(Tc + Vc) < 1e-14),
        Claim(9, "(c) with much larger dT and dV than in (a)", "more than twice as large",
              f"|dT| {largest(Tc):.1e} J, {largest(Tc) / largest(Ta):.1f} times that of (a)",
              largest(Tc) > 2 * largest(Ta)),
    ]


# ---- what is measured ----


def largest(values: np.ndarray | None) -> float:
    """Largest magnitude; NaN without values."""
    return np.nan if values is None else float(np.abs(values).max(initial=0.0))


def link_1_error(sol: Solution) -> np.ndarray:
    """Error of alpha_1 (k,) in rad against the exact motion."""
    return difference(sol, reference.four_bar, "alpha1")[:, 0]


def energy_errors(sol: Solution, exact: Callable[[float], tuple[float, float]]) -> tuple[np.ndarray, np.ndarray]:
    """Errors of T and V, (k,) each, in J."""
    T, V = np.array([exact(float(t)) for t in sol.t]).T
    return sol.kinetic_energy - T, sol.potential_energy - V


def ending(sol: Solution) -> str:
    """End of a run, in words."""
    return "it reaches the end" if sol.success else sol.message.split(";")[0]


def _most(runs: Sequence[Solution]) -> int:
    return max(sol.stats["max_position_iterations"] for sol in runs)


def _angle(error: float) -> str:
    return f"{error:.2g} rad" if error < 1e3 else "beyond all bounds"


# ---- the table ----


COLUMNS = ("figure", "claim", "expected", "measured", "verdict", "remark")


def as_csv(claims: Sequence[Claim]) -> str:
    """One row for each claim."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerows([COLUMNS, *(_row(claim) for claim in claims)])
    return text.getvalue()


def as_text(claims: Sequence[Claim], width: int = 110) -> str:
    """One paragraph for each claim, and the count."""
    held = sum(claim.holds for claim in claims)
    paragraphs = [_paragraph(claim, width) for claim in claims]
    return "\n\n".join([*paragraphs, f"{held} of {len(claims)} claims come out as stated."]) + "\n"


def _row(claim: Claim) -> list[Any]:
    return [getattr(claim, column) for column in COLUMNS]


def _paragraph(claim: Claim, width: int) -> str:
    mark = "holds" if claim.holds else "NOT AS STATED"
    lines = textwrap.wrap(f"Figure {claim.figure}: {claim.claim}  [{mark}]", width, subsequent_indent="          ")
    details = {"expected": claim.expected, "measured": claim.measured, "remark": claim.remark}
    for name, value in details.items():
        if value:
            lines += textwrap.wrap(value, width, initial_indent=f"  {name:9} ", subsequent_indent=" " * 12)
    return "\n".join(lines)
