"""Random motions that are known to thirty digits: closed forms, and Taylor series of minimal equations by `taylor`.

What `zd.reference` certifies is compared with them, by test_certificates.py for a few and by stress/certificates.py for as many
as it is told to. A family draws its numbers, and says the system, its start, how long, and what is exact at a time.
"""

from functools import cache
from time import perf_counter
from typing import NamedTuple

import numpy as np
import sympy as sp

import taylor
import zerodrift as zd
from taylor import mp


class Motion(NamedTuple):
    """`exact(times)` gives (p, v) in mpf for each of the times."""

    system: object
    end: float
    exact: object
    options: dict = {}


def by_series(right_side, x0, state, **options):
    """`exact` from a first-order equation, and how p and v follow from its t and x."""
    def exact(times):
        found = taylor.solution(right_side, x0, 0, times, **options)
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
    x, v, t, w, T, s = symbols("x v t w T s")
    blow = sp.exp(-((t - T) / s) ** 2) / (s * sp.sqrt(sp.pi))
    return zd.symbolic([x], speeds=[v], kinetic=v**2 / 2, potential=w**2 * x**2 / 2, force=[blow], time=t,
                       parameters={w: 1.0, T: 1.0, s: 1.0}, p0=[0.0], v0=[1.0], progress=False)


def pulse(rng):
    """A blow of one newton second, and a `max_step` as long as it."""
    given = {"w": rng.choice([0.0, rng.uniform(0.5, 3)]), "T": rng.uniform(0.5, 1.5), "s": 10 ** rng.uniform(-3, -1)}
    w, T, s = big(*given.values())
    v0 = rng.uniform(-1, 1)

    def right_side(t, x):
        late = (t - T) / s
        return [x[1], taylor.exp(-1 * (late * late)) * (1 / (s * mp.sqrt(mp.pi))) - x[0] * (w * w)]

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


# ---- holonomic constraints ----


def pendulum(rng):
    """In Cartesian coordinates; some nearly turn over."""
    L, g, angle, rate = rng.uniform(0.5, 2), rng.uniform(5, 10), rng.uniform(-3.1, 3.1), rng.normal()
    system = zd.systems.pendulum(length=L, gravity=g, angle=angle, rate=rate)
    (x, y), (u, v) = big(*system.p0), big(*system.v0)
    length, fall = big(L, g)

    def right_side(t, state):
        return [state[1], taylor.sin_cos(state[0])[0] * (-fall / length)]

    def state(t, s):
        sine, cosine = mp.sin(s[0]), mp.cos(s[0])
        return [length * sine, -length * cosine], [length * cosine * s[1], length * sine * s[1]]

    return Motion(system, 10 ** rng.uniform(0, 1.5), by_series(right_side, [mp.atan2(x, -y), (x * v - y * u) / length**2], state))


@cache
def moved_pendulum_system():
    x, y, u, v, L, g, A, W, t = symbols("x y u v L g A W t")
    return zd.symbolic([x, y], speeds=[u, v], kinetic=(u**2 + v**2) / 2, potential=g * y, time=t,
                       constraints=[((x - A * sp.sin(W * t))**2 + y**2 - L**2) / 2], parameters=dict.fromkeys((L, g, A, W), 1.0),
                       p0=[0.0, -1.0], progress=False)


def moved_pendulum(rng):
    """Its pivot goes to and fro: the constraint depends on time, and the motion may be chaotic."""
    L, g, A, W = rng.uniform(0.5, 2), rng.uniform(5, 10), rng.uniform(0.1, 0.6), rng.uniform(1, 5)
    angle, rate = rng.uniform(-2, 2), rng.normal()
    p0 = [L * np.sin(angle), -L * np.cos(angle)]
    v0 = [L * np.cos(angle) * rate + A * W, L * np.sin(angle) * rate]
    length, fall, a, w = big(L, g, A, W)
    x, y, u, v = big(*p0, *v0)

    def right_side(t, s):
        sine, cosine = taylor.sin_cos(s[0])
        return [s[1], taylor.sin_cos(t * w)[0] * cosine * (a * w * w / length) - sine * (fall / length)]

    def state(t, s):
        sine, cosine = mp.sin(s[0]), mp.cos(s[0])
        return ([a * mp.sin(w * t) + length * sine, -length * cosine],
                [a * w * mp.cos(w * t) + length * cosine * s[1], length * sine * s[1]])

    system = moved_pendulum_system().with_parameters(L=L, g=g, A=A, W=W).starting(p0, v0)
    start = [mp.atan2(x, -y), (x * v - y * (u - a * w)) / length**2]
    return Motion(system, rng.uniform(2, 15), by_series(right_side, start, state))


@cache
def double_pendulum_system(cartesian):
    m, n, k, d, g = symbols("m n k l g")
    values = dict.fromkeys((m, n, k, d, g), 1.0)
    if cartesian:
        p, v = symbols("x1 y1 x2 y2"), symbols("u1 v1 u2 v2")
        return zd.symbolic(p, speeds=v, kinetic=(m * (v[0]**2 + v[1]**2) + n * (v[2]**2 + v[3]**2)) / 2,
                           potential=g * (m * p[1] + n * p[3]), parameters=values, p0=[0.0, -1, 0, -2], progress=False,
                           constraints=[(p[0]**2 + p[1]**2 - k**2) / 2, ((p[2] - p[0])**2 + (p[3] - p[1])**2 - d**2) / 2])
    a, b, u, v = symbols("a b u v")
    kinetic = (m + n) * k**2 * u**2 / 2 + n * d**2 * v**2 / 2 + n * k * d * u * v * sp.cos(a - b)
    return zd.symbolic([a, b], speeds=[u, v], kinetic=kinetic, parameters=values, p0=[0.0, 0.0], progress=False,
                       potential=-(m + n) * g * k * sp.cos(a) - n * g * d * sp.cos(b))


def double_pendulum(rng, cartesian=False):
    """In angles: chaotic."""
    given = dict(zip("mnklg", rng.uniform([0.5, 0.5, 0.5, 0.5, 5], [2, 2, 1.5, 1.5, 10]), strict=True))
    m, n, k, d, g = big(*given.values())
    a0, b0 = rng.uniform(-2.5, 2.5, 2)
    u0, v0 = rng.normal(size=2)
    K, L = given["k"], given["l"]

    def right_side(t, x):
        a, b, u, v = x
        sine, cosine = taylor.sin_cos(a - b)
        first = sine * (v * v) * (-n * k * d) - taylor.sin_cos(a)[0] * ((m + n) * g * k)
        second = sine * (u * u) * (n * k * d) - taylor.sin_cos(b)[0] * (n * g * d)
        M11, M22, M12 = (m + n) * k * k, n * d * d, cosine * (n * k * d)
        whole = -1 * (M12 * M12) + M11 * M22
        return [u, v, (first * M22 - M12 * second) / whole, (second * M11 - M12 * first) / whole]

    system = double_pendulum_system(cartesian).with_parameters(**{name: float(x) for name, x in given.items()})
    if not cartesian:
        return Motion(system.starting([a0, b0], [u0, v0]), rng.uniform(1, 6), by_series(right_side, big(a0, b0, u0, v0), halves))
    x1, y1, du, dv = K * np.sin(a0), -K * np.cos(a0), K * np.cos(a0) * u0, K * np.sin(a0) * u0
    p0 = [x1, y1, x1 + L * np.sin(b0), y1 - L * np.cos(b0)]
    v0 = [du, dv, du + L * np.cos(b0) * v0, dv + L * np.sin(b0) * v0]
    X1, Y1, X2, Y2 = big(*p0)
    U1, V1, U2, V2 = big(*v0)
    X2, Y2, U2, V2 = X2 - X1, Y2 - Y1, U2 - U1, V2 - V1

    def state(t, s):
        a, b, u, v = s
        x, y = k * mp.sin(a), -k * mp.cos(a)
        dx, dy = -y * u, x * u
        return ([x, y, x + d * mp.sin(b), y - d * mp.cos(b)], [dx, dy, dx + d * mp.cos(b) * v, dy + d * mp.sin(b) * v])

    start = [mp.atan2(X1, -Y1), mp.atan2(X2, -Y2), (X1 * V1 - Y1 * U1) / k**2, (X2 * V2 - Y2 * U2) / d**2]
    return Motion(system.starting(p0, v0), rng.uniform(1, 4), by_series(right_side, start, state))


def double_pendulum_in_cartesian(rng):
    return double_pendulum(rng, cartesian=True)


@cache
def ellipse_system():
    x, y, u, v, a, b, g = symbols("x y u v a b g")
    return zd.symbolic([x, y], speeds=[u, v], kinetic=(u**2 + v**2) / 2, potential=g * y, p0=[1.0, 0.0], progress=False,
                       constraints=[(x**2 / a**2 + y**2 / b**2 - 1) / 2], parameters={a: 1.0, b: 1.0, g: 1.0})


def ellipse(rng):
    """A point on an ellipse, under its weight."""
    a, b, g, q, w = rng.uniform(0.5, 2), rng.uniform(0.5, 2), rng.uniform(1, 10), rng.uniform(-3, 3), 2 * rng.normal()
    p0, v0 = [a * np.cos(q), b * np.sin(q)], [-a * np.sin(q) * w, b * np.cos(q) * w]
    A, B, G = big(a, b, g)
    x, y, u, v = big(*p0, *v0)
    start = [mp.atan2(y / B, x / A), (x / A * v / B - y / B * u / A)]

    def right_side(t, s):
        q, w = s
        sine, cosine = taylor.sin_cos(q)
        inertia = sine * sine * (A * A) + cosine * cosine * (B * B)
        return [w, (sine * cosine * w * w * (B * B - A * A) - cosine * (G * B)) / inertia]

    def state(t, s):
        sine, cosine = mp.sin(s[0]), mp.cos(s[0])
        return [A * cosine, B * sine], [-A * sine * s[1], B * cosine * s[1]]

    return Motion(ellipse_system().with_parameters(a=a, b=b, g=g).starting(p0, v0), rng.uniform(1, 15),
                  by_series(right_side, start, state))


@cache
def wire_system():
    x, y, u, v, a, g = symbols("x y u v a g")
    return zd.symbolic([x, y], speeds=[u, v], kinetic=(u**2 + v**2) / 2, potential=g * y, p0=[0.0, 0.0], progress=False,
                       constraints=[y - a * x**2 / 2], parameters={a: 1.0, g: 1.0})


def wire(rng):
    """A bead on a parabola."""
    a, g, x, u = rng.uniform(0.3, 3), rng.uniform(1, 10), rng.uniform(-1.5, 1.5), rng.normal()
    A, G = big(a, g)

    def right_side(t, s):
        x, u = s
        return [u, -1 * (x * (u * u * (A * A) + G * A)) / (x * x * (A * A) + 1)]

    return Motion(wire_system().with_parameters(a=a, g=g).starting([x, a * x**2 / 2], [u, a * x * u]), rng.uniform(1, 20),
                  by_series(right_side, big(x, u), lambda t, s: ([s[0], A * s[0]**2 / 2], [s[1], A * s[0] * s[1]])))


@cache
def hung_plate_system():
    x, y, q, u, v, w, L, b, g = symbols("x y q u v w L b g")
    ends = [(x + side * b * sp.cos(q) - side * b, y + side * b * sp.sin(q)) for side in (1, -1)]
    return zd.symbolic([x, y, q], speeds=[u, v, w], kinetic=(u**2 + v**2 + b**2 * w**2) / 2, potential=g * y,
                       constraints=[(c**2 + d**2 - L**2) / 2 for c, d in ends], parameters=dict.fromkeys((L, b, g), 1.0),
                       p0=[0.0, -1, 0], progress=False)


def hung_plate(rng):
    """A parallelogram: a plate that hangs on two equal rods goes along as a pendulum does, and does not turn."""
    L, b, g, q, w = rng.uniform(0.5, 2), rng.uniform(0.3, 1), rng.uniform(5, 10), rng.uniform(-0.9, 0.9), rng.uniform(-0.5, 0.5)
    p0, v0 = [L * np.sin(q), -L * np.cos(q), 0.0], [L * np.cos(q) * w, L * np.sin(q) * w, 0.0]
    length, fall = big(L, g)
    x, y, u, v = big(*p0[:2], *v0[:2])

    def right_side(t, s):
        return [s[1], taylor.sin_cos(s[0])[0] * (-fall / length)]

    def state(t, s):
        sine, cosine = mp.sin(s[0]), mp.cos(s[0])
        return [length * sine, -length * cosine, mp.mpf(0)], [length * cosine * s[1], length * sine * s[1], mp.mpf(0)]

    return Motion(hung_plate_system().with_parameters(L=L, b=b, g=g).starting(p0, v0), rng.uniform(1, 10),
                  by_series(right_side, [mp.atan2(x, -y), (x * v - y * u) / length**2], state))


@cache
def crank_system():
    q, s, x, w, u, v, r, rod, W, a, t = symbols("q s x w u v r l W a t")
    return zd.symbolic([q, s, x], speeds=[w, u, v], kinetic=(w**2 + u**2 + v**2) / 2, potential=sp.Integer(0), time=t,
                       constraints=[r * sp.sin(q) - rod * sp.sin(s), r * sp.cos(q) + rod * sp.cos(s) - x, q - a - W * t],
                       parameters=dict.fromkeys((r, rod, W, a), 1.0), p0=[0.0, 0.0, 2.0], progress=False)


def crank(rng):
    """A slider-crank whose crank turns at a constant rate."""
    r, W, a = rng.uniform(0.2, 1), rng.uniform(-5, 5), rng.uniform(-3, 3)
    rod = r * rng.uniform(1.3, 4)
    R, L, rate, begin = big(r, rod, W, a)

    def at(t):
        q = begin + rate * t
        s = mp.asin(R * mp.sin(q) / L)
        u = R * mp.cos(q) * rate / (L * mp.cos(s))
        return [q, s, R * mp.cos(q) + L * mp.cos(s)], [rate, u, -R * mp.sin(q) * rate - L * mp.sin(s) * u]

    p0, v0 = ([float(value) for value in values] for values in at(mp.mpf(0)))
    return Motion(crank_system().with_parameters(r=r, l=rod, W=W, a=a).starting(p0, v0), rng.uniform(1, 20),
                  lambda times: [at(mp.mpf(float(t))) for t in times])


# ---- nonholonomic constraints ----


def skating(acceleration, turning):
    """x, y, heading, its rate and the speed along the edge, of which the rates of the last two are given."""
    def right_side(t, s):
        sine, cosine = taylor.sin_cos(s[2])
        return [s[4] * cosine, s[4] * sine, s[3], turning(s), acceleration(s, cosine)]

    def state(t, s):
        return s[:3], [s[4] * mp.cos(s[2]), s[4] * mp.sin(s[2]), s[3]]

    return right_side, state


def sleigh(rng):
    m, inertia, a = rng.uniform(0.5, 2, 3)
    heading, speed, turn = rng.uniform(-3, 3), rng.normal(), 2 * rng.normal()
    system = zd.systems.chaplygin_sleigh(mass=m, inertia=inertia, offset=a, heading=heading, speed=speed, turn_rate=turn)
    M, J, A = big(m, inertia, a)
    right_side, state = skating(lambda s, cosine: s[3] * s[3] * A, lambda s: s[4] * s[3] * (-M * A / (J + M * A * A)))
    return Motion(system, rng.uniform(1, 15), by_series(right_side, [*big(*system.p0), *big(turn, speed)], state))


def knife_edge(rng):
    g, incline, heading, speed, turn = rng.uniform([1, 0.1, -3, -1, -3], [10, 1.4, 3, 1, 3])
    system = zd.systems.knife_edge(gravity=g, incline=incline, heading=heading, speed=speed, turn_rate=turn)
    pull = mp.mpf(g) * mp.sin(mp.mpf(incline))
    right_side, state = skating(lambda s, cosine: cosine * pull, lambda s: 0 * s[3])
    return Motion(system, rng.uniform(1, 15), by_series(right_side, [*big(*system.p0), *big(turn, speed)], state))


def vertical_disc(rng):
    """On a circle."""
    R, heading, turn, roll = rng.uniform([0.2, -3, 0.2, -5], [2, 3, 3, 5])
    system = zd.systems.vertical_disc(radius=R, heading=heading, turn_rate=turn, roll_rate=roll)
    radius, head, w, u = big(R, heading, turn, roll)
    along = dict(zip((variable.name for variable in system.coordinates), range(4), strict=True))

    def at(t):
        q = head + w * t
        p = {"x": radius * u / w * (mp.sin(q) - mp.sin(head)), "y": -radius * u / w * (mp.cos(q) - mp.cos(head)), "phi": q,
             "theta": u * t}
        v = {"x": radius * u * mp.cos(q), "y": radius * u * mp.sin(q), "phi": w, "theta": u}
        return [p[name] for name in along], [v[name] for name in along]

    return Motion(system, 10 ** rng.uniform(0, 2), lambda times: [at(mp.mpf(float(t))) for t in times])


FAMILIES = {family.__name__: family for family in (
    linear, linear_long, linear_stiff, oscillator, henon, henon_in_python, duffing, kepler, stiff_spring, pulse, body, pendulum,
    moved_pendulum, double_pendulum, double_pendulum_in_cartesian, ellipse, wire, hung_plate, crank, sleigh, knife_edge,
    vertical_disc)}
ROWS = 12       # of each motion that are compared


class Outcome(NamedTuple):
    """Certified and true errors of p and v, what was said, and the seconds of the reference and of the exact motion."""

    certified: tuple[float, float]
    true: tuple[float, float]
    caveats: tuple[str, ...]
    seconds: tuple[float, float]


def draw(name, seed):
    """A motion of a family, and the times asked for: None is every step."""
    rng = np.random.default_rng([seed, *name.encode()])
    motion = FAMILIES[name](rng)
    times = np.sort(rng.uniform(0, motion.end, ROWS)) if rng.random() < 0.5 else None
    return motion, times


def compare(name, seed, **options):
    """What is certified of a random motion, and what is true."""
    motion, times = draw(name, seed)
    begin = perf_counter()
    ref = zd.reference(motion.system, motion.end, t_eval=times, **(motion.options | options))
    done = perf_counter()
    rows = np.unique(np.linspace(0, len(ref.solution.t) - 1, ROWS).round().astype(int))
    exact = motion.exact(ref.solution.t[rows])
    true = tuple(max(float(abs(mp.mpf(float(a)) - b)) for row, each in zip(rows, exact, strict=True)
                     for a, b in zip(found[row], each[i], strict=True))
                 for i, found in enumerate((ref.solution.p, ref.solution.v)))
    return Outcome((ref.error, ref.velocity_error), true, ref.caveats, (done - begin, perf_counter() - done))
