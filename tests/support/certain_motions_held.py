"""Random motions with constraints that are known to thirty digits."""

from functools import cache

import numpy as np
import sympy as sp

import symbolic_counterparts
import taylor
import zerodrift as zd
from certain_motions_free import Motion, big, by_series, halves, symbols
from taylor import mp

# ---- holonomic constraints ----


def turning(p, v, length):
    """Angle from the vertical and its rate, of a point on a circle about the origin."""
    (x, y), (u, v) = p, v
    return [mp.atan2(x, -y), (x * v - y * u) / length**2]


def pendulum(rng):
    """In Cartesian coordinates; some nearly turn over."""
    L, g, angle, rate = rng.uniform(0.5, 2), rng.uniform(5, 10), rng.uniform(-3.1, 3.1), rng.normal()
    system = zd.systems.pendulum(length=L, gravity=g, angle=angle, rate=rate)
    length, fall = big(L, g)

    def minimal(p, v):
        return turning(p, v, length)

    def right_side(t, state):
        return [state[1], taylor.sin_cos(state[0])[0] * (-fall / length)]

    def state(t, s):
        sine, cosine = mp.sin(s[0]), mp.cos(s[0])
        return [length * sine, -length * cosine], [length * cosine * s[1], length * sine * s[1]]

    start = minimal(big(*system.p0), big(*system.v0))
    return Motion(system, 10 ** rng.uniform(0, 1.5), by_series(right_side, start, state), minimal=minimal)


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

    def minimal(p, v):
        return turning(p, [v[0] - a * w, v[1]], length)

    def right_side(t, s):
        sine, cosine = taylor.sin_cos(s[0])
        return [s[1], taylor.sin_cos(t * w)[0] * cosine * (a * w * w / length) - sine * (fall / length)]

    def state(t, s):
        sine, cosine = mp.sin(s[0]), mp.cos(s[0])
        return ([a * mp.sin(w * t) + length * sine, -length * cosine],
                [a * w * mp.cos(w * t) + length * cosine * s[1], length * sine * s[1]])

    system = moved_pendulum_system().with_parameters(L=L, g=g, A=A, W=W).starting(p0, v0)
    return Motion(system, rng.uniform(2, 15), by_series(right_side, minimal(big(*p0), big(*v0)), state), minimal=minimal)


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

    def minimal(p, v):
        first = turning(p[:2], v[:2], k)
        second = turning([p[2] - p[0], p[3] - p[1]], [v[2] - v[0], v[3] - v[1]], d)
        return [first[0], second[0], first[1], second[1]]

    def state(t, s):
        a, b, u, v = s
        x, y = k * mp.sin(a), -k * mp.cos(a)
        dx, dy = -y * u, x * u
        return ([x, y, x + d * mp.sin(b), y - d * mp.cos(b)], [dx, dy, dx + d * mp.cos(b) * v, dy + d * mp.sin(b) * v])

    return Motion(system.starting(p0, v0), rng.uniform(1, 4), by_series(right_side, minimal(big(*p0), big(*v0)), state),
                  minimal=minimal)


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

    def minimal(p, v):
        (x, y), (u, v) = p, v
        return [mp.atan2(y / B, x / A), (x / A * v / B - y / B * u / A)]

    def right_side(t, s):
        q, w = s
        sine, cosine = taylor.sin_cos(q)
        inertia = sine * sine * (A * A) + cosine * cosine * (B * B)
        return [w, (sine * cosine * w * w * (B * B - A * A) - cosine * (G * B)) / inertia]

    def state(t, s):
        sine, cosine = mp.sin(s[0]), mp.cos(s[0])
        return [A * cosine, B * sine], [-A * sine * s[1], B * cosine * s[1]]

    return Motion(ellipse_system().with_parameters(a=a, b=b, g=g).starting(p0, v0), rng.uniform(1, 15),
                  by_series(right_side, minimal(big(*p0), big(*v0)), state), minimal=minimal)


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
                  by_series(right_side, big(x, u), lambda t, s: ([s[0], A * s[0]**2 / 2], [s[1], A * s[0] * s[1]])),
                  minimal=lambda p, v: [p[0], v[0]])


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

    def minimal(p, v):
        return turning(p[:2], v[:2], length)

    def right_side(t, s):
        return [s[1], taylor.sin_cos(s[0])[0] * (-fall / length)]

    def state(t, s):
        sine, cosine = mp.sin(s[0]), mp.cos(s[0])
        return [length * sine, -length * cosine, mp.mpf(0)], [length * cosine * s[1], length * sine * s[1], mp.mpf(0)]

    return Motion(hung_plate_system().with_parameters(L=L, b=b, g=g).starting(p0, v0), rng.uniform(1, 10),
                  by_series(right_side, minimal(big(*p0), big(*v0)), state), minimal=minimal)


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
    heading, speed, turn = 0.0, rng.normal(), 2 * rng.normal()      # at which the start is exact
    system = symbolic_counterparts.chaplygin_sleigh(m, inertia, a, heading, speed, turn)
    M, J, A = big(m, inertia, a)
    right_side, state = skating(lambda s, cosine: s[3] * s[3] * A, lambda s: s[4] * s[3] * (-M * A / (J + M * A * A)))
    return Motion(system, rng.uniform(1, 15), by_series(right_side, [*big(*system.p0), *big(turn, speed)], state))


def knife_edge(rng):
    g, incline, heading, speed, turn = rng.uniform([1, 0.1, -3, -1, -3], [10, 1.4, 3, 1, 3])
    system = zd.systems.knife_edge(gravity=g, incline=incline, heading=heading, speed=speed, turn_rate=turn)
    pull = mp.mpf(g) * mp.sin(mp.mpf(incline))
    right_side, state = skating(lambda s, cosine: cosine * pull, lambda s: 0 * s[3])
    return Motion(system, rng.uniform(1, 15), by_series(right_side, [*big(*system.p0), *big(turn, speed)], state))
