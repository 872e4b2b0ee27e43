"""Solutions of ordinary differential equations to some thirty digits, by Taylor series in integers: for comparison.

A number x is the integer x 2^BITS. The right side is written once, with the nodes below; each knows the coefficients of its own
series as soon as it knows those of its arguments (the recurrences of automatic differentiation). It shares nothing with the core.
"""

from fractions import Fraction
from operator import mul

from mpmath import MPContext

BITS = 150
ORDER = 40
SMALL_TERM = 1 << (BITS - 110)  # 2^-110 = 8e-34: of the last terms of a series
mp = MPContext()        # of its own: others may be using mpmath's
mp.prec = BITS


def fixed(x):
    """The integer of a number; doubles are taken as they are."""
    if isinstance(x, mp.mpf):
        return int(mp.floor(mp.ldexp(x, BITS) + mp.mpf("0.5")))
    x = Fraction(x)
    return (x.numerator << BITS) // x.denominator


def number(i):
    return mp.ldexp(mp.mpf(i), -BITS)


class Node:
    """A series; `of(k, c)` is its coefficient k, from those before it and those of what it depends on."""

    def __init__(self, of, first=None):
        self.of, self.first = of, first
        self.restart([])

    def restart(self, c):
        self.c, self.times_index = c, []

    def extend(self, k):
        self.c.append(self.first() if k == 0 and self.first else self.of(k, self.c))

    def __add__(self, other):
        other = as_node(other)
        return made(lambda k, c: self.c[k] + other.c[k])

    def __sub__(self, other):
        return self + -1 * as_node(other)

    def __rsub__(self, other):
        return as_node(other) - self

    def __neg__(self):
        return -1 * self

    def __mul__(self, other):
        if isinstance(other, int):
            return made(lambda k, c: other * self.c[k])
        if not isinstance(other, Node):
            factor = fixed(other)
            return made(lambda k, c: factor * self.c[k] >> BITS)
        return made(lambda k, c: convolved(self.c, other.c, k) >> BITS)

    __radd__, __rmul__ = __add__, __mul__

    def __truediv__(self, other):
        """The quotient c of a = b c."""
        if not isinstance(other, Node):
            return self * (mp.mpf(1) / other)
        return made(lambda k, c: ((self.c[k] << BITS) - sum(map(mul, other.c[1:k + 1], c[::-1]))) // other.c[0])

    def power(self, exponent):
        """a^r: k a_0 c_k = sum_i (r i - (k - i)) a_i c_(k-i)."""
        n, d = Fraction(exponent).numerator, Fraction(exponent).denominator
        root = made(None, lambda: fixed(mp.power(number(self.c[0]), mp.mpf(n) / d)))
        root.of = lambda k, c: (n * weighted(self, c, k) - d * weighted(root, self.c, k)) // (d * k * self.c[0])
        return root


NODES = []      # of the right side being written, in order


def made(of, first=None):
    NODES.append(Node(of, first))
    return NODES[-1]


def as_node(x):
    if isinstance(x, Node):
        return x
    value = fixed(x)
    return made(lambda k, c: 0 if k else value)


def convolved(a, b, k):
    return sum(map(mul, a[:k + 1], b[k::-1]))


def weighted(a, b, k):
    """sum_i i a_i b_(k-i), as far as there are any"""
    done = a.times_index
    done.extend(i * a.c[i] for i in range(len(done), min(len(a.c), k + 1)))
    return sum(map(mul, done[1:k + 1], b[k - 1::-1]))


def exp(a):
    return made(lambda k, c: (weighted(a, c, k) >> BITS) // k, lambda: fixed(mp.exp(number(a.c[0]))))


def sin_cos(a):
    sine = Node(None, lambda: fixed(mp.sin(number(a.c[0]))))
    cosine = Node(None, lambda: fixed(mp.cos(number(a.c[0]))))
    sine.of = lambda k, c: (weighted(a, cosine.c, k) >> BITS) // k
    cosine.of = lambda k, c: -(weighted(a, sine.c, k) >> BITS) // k
    NODES.extend([sine, cosine])
    return sine, cosine


def solution(right_side, x0, t0, times, longest=4.0):
    """Solution of x' = right_side(t, x), a list of nodes, from x0 at t0: x (mpf) at each of the times, which must increase.

    A series cannot contain terms that are zero to all digits at its start: `longest` bounds its reach to where they stay zero.
    """
    NODES.clear()
    t, state = Node(None), [Node(None) for _ in x0]
    rates = [as_node(rate) for rate in right_side(t, state)]
    nodes, now, x, found, h = list(NODES), fixed(t0), [fixed(value) for value in x0], [], fixed(longest / 16)
    targets = [fixed(time) for time in times]
    while len(found) < len(targets):
        if targets[len(found)] == now:
            found.append([number(value) for value in x])
            continue
        _series(nodes, t, state, rates, now, x, h)
        reach = min(_reach(state, h), fixed(longest))
        end = now + reach
        while len(found) < len(targets) and targets[len(found)] <= end:
            found.append([number(_value(node.c, targets[len(found)] - now, h)) for node in state])
        x, now = [_value(node.c, reach, h) for node in state], end
        h = reach
    return found


def _series(nodes, t, state, rates, now, x, h):
    """All coefficients, of powers of (time - now) / h."""
    for node in nodes:
        node.restart([])
    t.restart([now, h] + [0] * ORDER)
    for node, value in zip(state, x, strict=True):
        node.restart([value])
    for k in range(ORDER):
        for node in nodes:
            node.extend(k)
        for node, rate in zip(state, rates, strict=True):
            node.c.append((h * rate.c[k] >> BITS) // (k + 1))


def _reach(state, h):
    """Reach of the series: the time within which its last terms are small."""
    part = min(mp.power(mp.mpf(SMALL_TERM) / max(1, abs(node.c[k])), mp.mpf(1) / k) for node in state for k in (ORDER - 1, ORDER))
    return fixed(min(part, mp.mpf(4)) * number(h))


def _value(c, apart, h):
    part, total = (apart << BITS) // h, 0
    for coefficient in reversed(c):
        total = (total * part >> BITS) + coefficient
    return total
