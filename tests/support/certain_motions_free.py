"""Random motions without constraints that are known to thirty digits, and what all such motions consist of."""

from functools import cache
from typing import NamedTuple

import numpy as np
import sympy as sp

import taylor
import zerodrift as zd
from taylor import mp


class Motion(NamedTuple):
    """`exact(times)` gives (p, v) in mpf for each of the times.

    With constraints, `minimal(p, v)` gives the independent numbers of a start, and `exact(times, start)` begins there.
    """

    system: object
    end: float
    exact: object
    options: dict = {}
    minimal: object = None


def by_series(right_side, x0, state, **options):
    """`exact` from a first-order equation, and how p and v follow from its t and x."""
    def exact(times, start=x0):
        found = taylor.solution(right_side, start, 0, times, **options)
        return [state(mp.mpf(float(t)), x) for t, x in zip(times, found, strict=True)]
    return exact


def halves(t, x):
    """Coordinates and velocities where x is both."""
    return x[:len(x) // 2], x[len(x) // 2:]


def big(*values):
    return [mp.mpf(float(value)) for value in values]


def symbols(names):
    return sp.symbols(names)


# ---- without constraints ----


@cache
def linear_system(n):
    p, v, t = sp.symbols(f"p:{n}"), sp.symbols(f"v:{n}"), sp.Symbol("t")
    names = {name: sp.Matrix(n, n, lambda i, j, name=name: sp.Symbol(f"{name}{min(i, j)}_{max(i, j)}")) for name in "MKD"}
    s, c, r, w = sp.symbols(f"s:{n}"), sp.symbols(f"c:{n}"), sp.symbols(f"r:{n}"), sp.Symbol("w")
    force = [s[i] * sp.sin(w * t) + c[i] + r[i] * t - sum(names["K"][i, j] * p[j] + names["D"][i, j] * v[j] for j in range(n))
             for i in range(n)]
    free = sorted({x for m in names.values() for x in m} | {*s, *c, *r, w}, key=str)
    return zd.symbolic(p, kinetic=None, potential=None, mass=names["M"], bias=[0] * n, force=force, speeds=v, time=t,
                       parameters=dict.fromkeys(free, 1.0), p0=[0.0] * n, v0=[0.0] * n, name=f"linear{n}", progress=False)


def positive(rng, n, sizes):
    """A symmetric matrix of given eigenvalues, as it is in doubles."""
    Q = np.linalg.qr(rng.normal(size=(n, n)))[0]
    made = Q * sizes @ Q.T
    return (made + made.T) / 2


def linear(rng, damping=1.0, spread=1.0, turns=20.0, driven=True):
    """M x'' + D x' + K x = s sin(w t) + c + r t."""
    n = int(rng.integers(1, 4))
    rates = 10 ** rng.uniform(0, spread, n)
    M = positive(rng, n, rng.uniform(0.5, 2, n))
    K, D = positive(rng, n, rates**2), positive(rng, n, damping * rng.uniform(0, 1, n) * rates)
    s, c, r = rng.normal(size=(3, n)) * driven
    w = rng.uniform(0.3, 5)
    values = {f"{name}{i}_{j}": matrix[i, j] for name, matrix in (("M", M), ("K", K), ("D", D)) for i in range(n)
              for j in range(i, n)}
    values |= {f"{name}{i}": x[i] for name, x in (("s", s), ("c", c), ("r", r)) for i in range(n)} | {"w": w}
    p0, v0 = rng.normal(size=(2, n))
    inverse = mp.inverse(mp.matrix(M.tolist()))
    A, B = -inverse * mp.matrix(K.tolist()), -inverse * mp.matrix(D.tolist())
    S, constant, R = (inverse * mp.matrix(x.tolist()) for x in (s, c, r))

    def right_side(t, x):
        sine, _ = taylor.sin_cos(t * mp.mpf(w))
        rest = [sine * S[i] + constant[i] + t * R[i] for i in range(n)]
        return x[n:] + [sum((x[j] * A[i, j] + x[n + j] * B[i, j] for j in range(n)), rest[i]) for i in range(n)]

    system = linear_system(n).with_parameters(**{name: float(x) for name, x in values.items()}).starting(p0, v0)
    end = rng.uniform(1, turns) / max(rates) * 2 * np.pi
    return Motion(system, end, by_series(right_side, big(*p0, *v0), halves))


def linear_long(rng):
    return linear(rng, damping=1e-4, spread=0.3, turns=200.0)


def linear_stiff(rng):
    """Widely apart, and strongly damped."""
    return linear(rng, damping=2.0, spread=3.0, turns=100.0)


def oscillator(rng):
    """Up to three thousand radians."""
    m, k, x0, v0 = rng.uniform(0.1, 3, 4)
    end = 10 ** rng.uniform(0, 3.5) / np.sqrt(k / m)
    M, K, X, V = big(m, k, x0, v0)
    w = mp.sqrt(K / M)

    def at(t):
        c, s = mp.cos(w * t), mp.sin(w * t)
        return [X * c + V / w * s], [V * c - X * w * s]

    system = zd.systems.oscillator(mass=m, stiffness=k, x0=x0, v0=v0)
    return Motion(system, end, lambda times: [at(mp.mpf(float(t))) for t in times])


@cache
def henon_system():
    x, y, u, v, k = symbols("x y u v k")
    return zd.symbolic([x, y], speeds=[u, v], kinetic=(u**2 + v**2) / 2, parameters={k: 1.0},
                       potential=(x**2 + y**2) / 2 + k * (x**2 * y - y**3 / 3), p0=[0.0, 0.0], v0=[0.0, 0.0], progress=False)


def henon(rng):
    """Henon and Heiles, from regular to chaotic."""
    y, v, k = rng.uniform(-0.2, 0.3), rng.uniform(-0.1, 0.1), 1 + rng.uniform(-0.05, 0.05)
    energy = rng.uniform(0.08, 0.16)
    u = np.sqrt(2 * energy - v**2 - y**2 + 2 * k * y**3 / 3)
    K = mp.mpf(k)

    def right_side(t, x):
        x, y, u, v = x
        return [u, v, -1 * x - 2 * (x * y) * K, (y * y - x * x) * K - y]

    system = henon_system().with_parameters(k=k).starting([0.0, y], [u, v])
    return Motion(system, rng.uniform(20, 150), by_series(right_side, big(0, y, u, v), halves))


def henon_in_python(rng):
    """The same, short, as callables."""
    y, v, u = rng.uniform(-0.2, 0.3), rng.uniform(-0.1, 0.1), rng.uniform(0.2, 0.4)
    system = zd.System(2, mass=np.eye(2), p0=[0.0, y], v0=[u, v],
                       force=lambda p: np.array([-p[0] - 2 * p[0] * p[1], -p[1] - p[0]**2 + p[1]**2]))

    def right_side(t, x):
        x, y, u, v = x
        return [u, v, -1 * x - 2 * (x * y), y * y - x * x - y]

    return Motion(system, rng.uniform(2, 10), by_series(right_side, big(0, y, u, v), halves))


@cache
def duffing_system():
    x, v, d, a, b, g, w, t = symbols("x v d a b g w t")
    return zd.symbolic([x], speeds=[v], kinetic=v**2 / 2, potential=a * x**2 / 2 + b * x**4 / 4, time=t,
                       force=[g * sp.cos(w * t) - d * v], parameters=dict.fromkeys((d, a, b, g, w), 1.0), p0=[1.0], v0=[0.0],
                       progress=False)


def duffing(rng):
    """Driven, in two wells: chaotic for many of these."""
    given = {"d": rng.uniform(0.05, 0.3), "a": -1.0, "b": 1.0, "g": rng.uniform(0.2, 0.5), "w": rng.uniform(0.8, 1.4)}
    d, a, b, g, w = big(*given.values())
    x0, v0 = rng.uniform(-1, 1, 2)

    def right_side(t, x):
        x, v = x
        _, cosine = taylor.sin_cos(t * w)
        return [v, cosine * g - v * d - x * a - x * x * x * b]

    system = duffing_system().with_parameters(**given).starting([x0], [v0])
    return Motion(system, rng.uniform(10, 60), by_series(right_side, big(x0, v0), halves))


@cache
def kepler_system():
    x, y, u, v, k = symbols("x y u v k")
    return zd.symbolic([x, y], speeds=[u, v], kinetic=(u**2 + v**2) / 2, potential=-k / sp.sqrt(x**2 + y**2),
                       parameters={k: 1.0}, p0=[1.0, 0.0], v0=[0.0, 1.0], progress=False)


def kepler(rng):
    """From the pericentre: up to an eccentricity of 0.9, and up to ten revolutions."""
    k, near, e = rng.uniform(0.5, 2), rng.uniform(0.5, 2), rng.uniform(0, 0.9)
    speed = np.sqrt(k * (1 + e) / near)
    K, R, V = big(k, near, speed)
    a = 1 / (2 / R - V * V / K)
    E = 1 - R / a
    n, ratio = mp.sqrt(K / a**3), mp.sqrt(1 - E * E)

    def at(t):
        turns = mp.floor(n * t / (2 * mp.pi))
        mean = n * t - 2 * mp.pi * turns
        bracket = mp.mpf(-1), 2 * mp.pi + 1
        u = mp.findroot(lambda u: u - E * mp.sin(u) - mean, bracket, solver="anderson", tol=1e-80, maxsteps=500)
        rate = n / (1 - E * mp.cos(u))
        return ([a * (mp.cos(u) - E), a * ratio * mp.sin(u)], [-a * mp.sin(u) * rate, a * ratio * mp.cos(u) * rate])

    end = float(2 * mp.pi / n) * rng.uniform(0.5, 10)
    return Motion(kepler_system().with_parameters(k=k).starting([near, 0.0], [0.0, speed]), end,
                  lambda times: [at(mp.mpf(float(t))) for t in times])


@cache
def spring_system():
    r, q, u, w, k, g = symbols("r q u w k g")
    return zd.symbolic([r, q], speeds=[u, w], kinetic=(u**2 + r**2 * w**2) / 2, parameters={k: 1.0, g: 1.0},
                       potential=k * (r - 1)**2 / 2 - g * r * sp.cos(q), p0=[1.0, 0.0], v0=[0.0, 0.0], progress=False)


def stiff_spring(rng):
    """A pendulum on a hard spring: fast and slow at once, and not linear."""
    k, g, q, w = 10 ** rng.uniform(2, 5), rng.uniform(5, 10), rng.uniform(-1.5, 1.5), rng.uniform(-1, 1)
    K, G = big(k, g)

    def right_side(t, x):
        r, q, u, w = x
        sine, cosine = taylor.sin_cos(q)
        return [u, w, r * w * w + cosine * G - (r - 1) * K, (-1 * (sine * G) - 2 * (u * w)) / r]

    system = spring_system().with_parameters(k=k, g=g).starting([1.0, q], [0.0, w])
    return Motion(system, rng.uniform(20, 150) / np.sqrt(k), by_series(right_side, big(1, q, 0, w), halves))


@cache
def pulse_system():
    x, v, t, w, T, s, a = symbols("x v t w T s a")
    blow = a / s * sp.exp(-((t - T) / s) ** 2)
    return zd.symbolic([x], speeds=[v], kinetic=v**2 / 2, potential=w**2 * x**2 / 2, force=[blow], time=t,
                       parameters={w: 1.0, T: 1.0, s: 1.0, a: 1.0}, p0=[0.0], v0=[1.0], progress=False)


def pulse(rng):
    """A blow of one newton second, and a `max_step` as long as it."""
    given = {"w": rng.choice([0.0, rng.uniform(0.5, 3)]), "T": rng.uniform(0.5, 1.5), "s": 10 ** rng.uniform(-3, -1),
             "a": np.pi**-0.5}
    w, T, s, a = big(*given.values())
    v0 = rng.uniform(-1, 1)

    def right_side(t, x):
        late = (t - T) / s
        return [x[1], taylor.exp(-1 * (late * late)) * (a / s) - x[0] * (w * w)]

    system = pulse_system().with_parameters(**given).starting([0.0], [v0])
    return Motion(system, 2.0, by_series(right_side, big(0, v0), halves, longest=given["s"]),
                  {"max_step": given["s"]})


# ---- attitude ----


@cache
def body_system():
    e = sp.symbols("e0:4")
    w = sp.symbols("w1:4")
    J = sp.symbols("J1:4")
    moment = sp.Symbol("moment")
    a, b, c, d = e
    rate = [(-b * w[0] - c * w[1] - d * w[2]) / 2, (a * w[0] - d * w[1] + c * w[2]) / 2,
            (d * w[0] + a * w[1] - b * w[2]) / 2, (-c * w[0] + b * w[1] + a * w[2]) / 2]
    gyroscopic = sp.Matrix(w).cross(sp.Matrix([J[i] * w[i] for i in range(3)]))
    up = 2 * (b * d - a * c), 2 * (c * d + a * b)       # of the vertical, along the body's first two axes
    return zd.symbolic(e, kinetic=None, potential=None, mass=sp.diag(*J), bias=list(gyroscopic),
                       force=[moment * up[1], -moment * up[0], 0], speeds=w, kinematics=rate,
                       parameters=dict.fromkeys((*J, moment), 1.0), p0=[1.0, 0, 0, 0], v0=[0.0, 0, 1.0], progress=False)


def body(rng):
    """Free, or a heavy top: four coordinates, three velocities."""
    J = rng.uniform(0.5, 2, 3)
    moment = rng.choice([0.0, rng.uniform(0.2, 2)])
    e0, w0 = rng.normal(size=4), rng.normal(size=3) * 2
    e0 /= np.linalg.norm(e0)
    G, own = mp.mpf(float(moment)), big(*J)

    def right_side(t, x):
        a, b, c, d, p, q, r = x
        up = 2 * (b * d - a * c), 2 * (c * d + a * b)
        return [(-1 * (b * p) - c * q - d * r) / mp.mpf(2), (a * p - d * q + c * r) / mp.mpf(2),
                (d * p + a * q - b * r) / mp.mpf(2), (b * q - c * p + a * r) / mp.mpf(2),
                ((q * r) * (own[1] - own[2]) + up[1] * G) / own[0], ((r * p) * (own[2] - own[0]) - up[0] * G) / own[1],
                (p * q) * ((own[0] - own[1]) / own[2])]

    given = {f"J{i + 1}": J[i] for i in range(3)} | {"moment": float(moment)}
    return Motion(body_system().with_parameters(**given).starting(e0, w0), rng.uniform(2, 20),
                  by_series(right_side, big(*e0, *w0), lambda t, x: (x[:4], x[4:])))
