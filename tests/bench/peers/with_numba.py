"""numba: a right-hand side compiled at run time, with velocities eliminated by hand, under two integrators.

SciPy's DOP853 calls it from Python; a DOP853 written for it is compiled together with it. Velocities that are eliminated
are, of a chain, those of the two rods that are least parallel at the start. Nothing is corrected. Outputs are values of
SciPy's dense output, or ends of steps.
"""

import functools
import math
import time

import numpy as np
from equations import eliminated
from numba import njit
from scipy.integrate import solve_ivp
from scipy.integrate._ivp import dop853_coefficients as table

TOLERANCES = 10.0 ** -np.arange(2, 13.5, 0.5)
A, B, E3, E5 = table.A[:12, :12].copy(), table.B.copy(), table.E3[:12].copy(), table.E5[:12].copy()


def sweeps(chain):
    """The settings of each method."""
    return {f"numba, {integrator}": [(integrator, tolerance) for tolerance in TOLERANCES]
            for integrator in ("SciPy DOP853", "DOP853 by hand")}


def solve(chain, setting):
    """Angles (k, n) at the outputs, and seconds."""
    integrator, tolerance = setting
    right_hand_side, integrate = compiled(chain)
    n, y0, outputs = chain.n, np.concatenate([chain.p0, chain.v0]), chain.outputs
    start = time.process_time()
    if integrator == "DOP853 by hand":
        p = integrate(y0, outputs, tolerance)
    else:
        p = solve_ivp(right_hand_side, (0, chain.t_end), y0, "DOP853", t_eval=outputs, rtol=tolerance, atol=tolerance).y[:n].T
    return p, time.process_time() - start


@functools.cache
def compiled(chain):
    """The right-hand side (t, y) and the integrator (y0, outputs, tolerance), compiled and called once."""
    differentiate = rates_of(chain)
    size = 2 * chain.n

    @njit
    def right_hand_side(t, y):
        rate = np.empty(size)
        differentiate(y, rate)
        return rate

    integrate = _dop853(differentiate, chain.n)
    y0 = np.concatenate([chain.p0, chain.v0])
    right_hand_side(0.0, y0)
    integrate(y0, chain.outputs[:2], 1e-3)
    return right_hand_side, integrate


def rates_of(chain):
    """The compiled function (y, rate) with y = [p, v], its operations written out one by one."""
    n, lines = chain.n, []
    p, v = ([Recorded(f"y[{first + i}]", lines) for i in range(n)] for first in (0, n))
    vdot = eliminated(chain, {name: functools.partial(_call, name) for name in ("sin", "cos", "sqrt")}).vdot(p, v)
    lines += [f"rate[{i}] = {value.name}" for i, value in enumerate([*v, *vdot])]
    return _compiled_source("differentiate(y, rate)", lines)


class Recorded:
    """A number that is not known yet: what is done with it becomes lines of a program, none of them twice."""

    def __init__(self, name, lines):
        self.name, self.lines = name, lines

    def record(self, text):
        """The result of an operation."""
        known = {line.split(" = ")[1]: line.split(" = ")[0] for line in self.lines}
        name = known.get(text, f"x{len(self.lines)}")
        if text not in known:
            self.lines.append(f"{name} = {text}")
        return Recorded(name, self.lines)

    def __neg__(self):
        return self.record(f"-{self.name}")

    def __add__(self, other):
        return self.record(f"{self.name} + {_name(other)}")

    def __sub__(self, other):
        return self.record(f"{self.name} - {_name(other)}")

    def __mul__(self, other):
        return self.record(f"{self.name} * {_name(other)}")

    def __pow__(self, exponent):
        return self.record(f"{self.name} * {self.name}" if exponent == 2 else f"{self.name} ** {exponent!r}")

    def __truediv__(self, other):
        return self.record(f"{self.name} / {_name(other)}")

    def __radd__(self, other):
        return self.record(f"{other!r} + {self.name}")

    def __rsub__(self, other):
        return self.record(f"{other!r} - {self.name}")

    def __rmul__(self, other):
        return self.record(f"{other!r} * {self.name}")

    def __rtruediv__(self, other):
        return self.record(f"{other!r} / {self.name}")


def _name(value):
    return value.name if isinstance(value, Recorded) else repr(value)


def _call(function, value):
    return value.record(f"{function}({value.name})")


def _compiled_source(head, lines, **names):
    found = {"sin": math.sin, "cos": math.cos, "sqrt": math.sqrt, **names}
    exec("\n    ".join([f"def {head}:", *lines]), found)
    return njit(found[head.partition("(")[0]])


def _weighed(weights):
    """The sum of stages at one place, written out."""
    return " + ".join(f"{weight!r} * k[{j}, m]" for j, weight in enumerate(weights.tolist()) if weight != 0)


def _dop853(differentiate, n):
    lines = []
    for i in range(1, 12):
        lines += [f"for m in range({2 * n}):", f"    stage[m] = y[m] + h * ({_weighed(A[i, :i])})",
                  f"differentiate(stage, k[{i}])"]
    lines += ["squares5, squares3 = 0.0, 0.0", f"for m in range({2 * n}):", f"    end[m] = y[m] + h * ({_weighed(B)})",
              "    scale = tolerance + tolerance * max(abs(y[m]), abs(end[m]))",
              f"    fifth, third = {_weighed(E5)}, {_weighed(E3)}",
              "    squares5 += (fifth / scale) ** 2", "    squares3 += (third / scale) ** 2",
              f"return h * squares5 / sqrt((squares5 + 0.01 * squares3) * {2 * n}) if squares5 > 0 else 0.0"]
    step = _compiled_source("step(y, h, tolerance, k, stage, end)", lines, differentiate=differentiate)

    @njit
    def integrate(y0, outputs, tolerance):
        p, y, k, stage, end = np.empty((len(outputs), n)), y0.copy(), np.empty((12, 2 * n)), np.empty(2 * n), np.empty(2 * n)
        p[0] = y[:n]
        t, h = outputs[0], 1e-3
        differentiate(y, k[0])
        for row in range(1, len(outputs)):
            while t < outputs[row]:
                lands = t + h >= outputs[row]
                taken = outputs[row] - t if lands else h
                norm = step(y, taken, tolerance, k, stage, end)
                factor = min(10.0, max(0.2, 0.9 * norm ** -0.125)) if norm > 0 else 10.0
                if not norm <= 1:
                    h = taken * (factor if norm > 1 else 0.2)
                    if h < 1e-12:
                        raise RuntimeError("steps vanish")
                    continue
                if not lands or factor < 1:
                    h = taken * factor
                t = outputs[row] if lands else t + taken
                y[:] = end
                differentiate(y, k[0])
            p[row] = y[:n]
        return p

    return integrate
