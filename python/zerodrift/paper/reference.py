"""Exact motions of the two examples, which share no code with the core.

The four-bar has one degree of freedom. With alpha_2 and alpha_3 eliminated in closed form its equation of motion is

    I(alpha_1) alpha_1'' + I'(alpha_1) alpha_1'^2 / 2 + V'(alpha_1) = 0,        T = I(alpha_1) alpha_1'^2 / 2,

where links 1 and 3 turn about fixed joints and link 2 moves freely. (The core uses the open chain of Figure 4b.)
SciPy's DOP853 integrates it. As this package does not require SciPy, the result is stored in ``four_bar.csv``, which
``python -m zerodrift.paper.reference`` writes anew. Its error is some 2e-10 rad in alpha_1, found with an extrapolation
method in extended precision; the tests compare it with the same method in double precision.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from math import acos, atan2, cos, hypot, sin, sqrt
from pathlib import Path

import numpy as np

from .._private.writing import write_atomically
from ..errors import WrongValue
from . import FOUR_BAR, OSCILLATOR

SPACING = 0.025         # s between the stored states
TOLERANCE = 3e-14       # the least that DOP853 accepts is 2.2e-14
FILE = Path(__file__).with_name("four_bar.csv")


class CrankEquation:
    """The four-bar as a system of one degree of freedom, alpha_1.

    Parameters
    ----------
    lengths : (4,) in m
        Ground, links 1, 2, 3.
    masses : (3,) in kg
        Masses of the slender rods.
    gravity : float in m/s^2
    side : {1, -1}
        Open or crossed.
    """

    def __init__(self, lengths: Sequence[float], masses: Sequence[float], gravity: float, side: int = 1) -> None:
        self.l0, self.l1, self.l2, self.l3 = lengths
        self.m1, self.m2, self.m3 = masses
        self.gravity, self.side = gravity, side

    def close(self, a: float) -> tuple[float, float]:
        """Angles of links 2 and 3, from the triangle they form with the diagonal between joint 2 and (l0, 0)."""
        x, y = self.l0 - self.l1 * cos(a), -self.l1 * sin(a)
        diagonal = hypot(x, y)
        b = atan2(y, x) + self.side * acos((self.l2**2 + diagonal**2 - self.l3**2) / (2 * self.l2 * diagonal))
        return b, atan2(y - self.l2 * sin(b), x - self.l2 * cos(b))

    def ratios(self, a: float, b: float, c: float) -> tuple[float, float, float, float]:
        """First and second derivatives of alpha_2, alpha_3 by alpha_1, from the loop closure differentiated twice."""
        l1, l2, l3, sine = self.l1, self.l2, self.l3, sin(c - b)
        b1, c1 = l1 * sin(a - c) / (l2 * sine), l1 * sin(b - a) / (l3 * sine)
        b2 = (l1 * cos(a - c) + l2 * b1**2 * cos(b - c) + l3 * c1**2) / (l2 * sine)
        c2 = -(l1 * cos(a - b) + l2 * b1**2 + l3 * c1**2 * cos(c - b)) / (l3 * sine)
        return b1, c1, b2, c2

    def inertia(self, a: float) -> tuple[float, float]:
        """I in kg m^2, and half its derivative."""
        b, c = self.close(a)
        b1, c1, b2, c2 = self.ratios(a, b, c)
        J1, J2, J3 = self.m1 * self.l1**2 / 3, self.m2 * self.l2**2 / 3, self.m3 * self.l3**2 / 3
        k = self.m2 * self.l1 * self.l2
        inertia = J1 + self.m2 * self.l1**2 + J2 * b1**2 + k * b1 * cos(b - a) + J3 * c1**2
        half = J2 * b1 * b2 + k * (b2 * cos(b - a) - b1 * (b1 - 1) * sin(b - a)) / 2 + J3 * c1 * c2
        return inertia, half

    def potential(self, a: float) -> tuple[float, float]:
        """V in J, and its derivative."""
        b, c = self.close(a)
        b1, c1, _, _ = self.ratios(a, b, c)
        w1 = self.gravity * (self.m1 / 2 + self.m2) * self.l1
        w2, w3 = self.gravity * self.m2 * self.l2 / 2, self.gravity * self.m3 * self.l3 / 2
        return w1 * sin(a) + w2 * sin(b) - w3 * sin(c), w1 * cos(a) + w2 * b1 * cos(b) - w3 * c1 * cos(c)

    def rates(self, t: float, y: np.ndarray) -> tuple[float, float]:
        """The equation of motion in first order, for y = (alpha_1, alpha_1')."""
        inertia, half = self.inertia(y[0])
        return y[1], -(half * y[1] ** 2 + self.potential(y[0])[1]) / inertia

    def integrate(self, times: np.ndarray, start: Sequence[float]) -> np.ndarray:
        """States (k, 2) at the times, by SciPy's DOP853."""
        from scipy.integrate import solve_ivp

        span = float(times[0]), float(times[-1])
        result = solve_ivp(self.rates, span, start, method="DOP853", t_eval=times, rtol=TOLERANCE, atol=TOLERANCE / 10)
        return result.y.T


def equation() -> CrankEquation:
    """The equation of motion of the paper's example 1."""
    given = FOUR_BAR.system.parameters
    return CrankEquation(given["lengths"], given["masses"], given["gravity"])


def four_bar_times() -> np.ndarray:
    """The times of the stored states, in s."""
    return np.arange(round(FOUR_BAR.end / SPACING) + 1) * SPACING


def four_bar_states() -> np.ndarray:
    """The states (k, 2), integrated again."""
    given = FOUR_BAR.system.parameters
    return equation().integrate(four_bar_times(), [given["crank_angle"], given["crank_rate"]])


@cache
def stored() -> np.ndarray:
    """The stored states (k, 2): alpha_1 and its rate, in rad and rad/s."""
    states = np.loadtxt(FILE, delimiter=",", comments="#")[:, 1:]
    states.flags.writeable = False
    return states


def four_bar(t: float) -> np.ndarray:
    """The exact p (3,) of example 1 at a stored time, a multiple of 0.025 s.

    Examples
    --------
    >>> from zerodrift.paper import reference
    >>> reference.four_bar(0.0).round(5)
    array([ 1.5708 ,  0.30288, -1.49486])
    """
    a = stored()[_row(t), 0]
    return np.array([a, *equation().close(a)])


def four_bar_energies(t: float) -> tuple[float, float]:
    """The exact T and V in J of example 1 at a stored time."""
    a, rate = stored()[_row(t)]
    return equation().inertia(a)[0] * rate**2 / 2, equation().potential(a)[0]


def _row(t: float) -> int:
    row = round(t / SPACING)
    if not 0 <= row < len(stored()) or abs(row * SPACING - t) > 1e-9:
        raise WrongValue(f"t must be a multiple of {SPACING:g} s between 0 and {FOUR_BAR.end:g} s, not {t:g}", "out-of-range")
    return row


def oscillator(t: float) -> np.ndarray:
    """The exact p (1,) of example 2: x = x0 cos(omega t) + v0 / omega sin(omega t)."""
    given = OSCILLATOR.system.parameters
    omega = sqrt(given["stiffness"] / given["mass"])
    return np.array([given["x0"] * cos(omega * t) + given["v0"] / omega * sin(omega * t)])


def oscillator_energies(t: float) -> tuple[float, float]:
    """The exact T and V in J of example 2."""
    given = OSCILLATOR.system.parameters
    m, k = given["mass"], given["stiffness"]
    V = k * oscillator(t)[0] ** 2 / 2
    return (m * given["v0"] ** 2 + k * given["x0"] ** 2) / 2 - V, V


def write(path: Path = FILE) -> None:
    """Integrate again and write the file."""
    rows = (f"{t:.3f},{a:.17g},{rate:.17g}\n" for t, (a, rate) in zip(four_bar_times(), four_bar_states(), strict=True))
    head = "# Example 1 by SciPy's DOP853 on the equation in alpha_1; written by python -m zerodrift.paper.reference\n"
    content = (head + "# t [s], alpha_1 [rad], its rate [rad/s]\n" + "".join(rows)).encode("ascii")
    write_atomically(path, lambda file: file.write(content))


if __name__ == "__main__":
    write()
