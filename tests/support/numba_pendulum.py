"""The pendulum of native/pendulum.c as a user of numba would write it, and malformed functions."""

import numba

import zerodrift as zd
from zerodrift.systems.native import BIT, SLOT


def pendulum(data, want, t, p, v, out):
    m, g, L, x, y = data[0], data[1], data[2], p[0], p[1]
    if want & BIT.M:
        M = numba.carray(out[SLOT.M], (2, 2))
        M[0, 0] = M[1, 1] = m
        M[0, 1] = M[1, 0] = 0.0
    if want & BIT.f:
        out[SLOT.f][0] = 0.0
        out[SLOT.f][1] = -m * g
    if want & BIT.Phi:
        out[SLOT.Phi][0] = (x * x + y * y - L * L) / (2 * L)
    if want & BIT.C:
        out[SLOT.C][0] = x / L
        out[SLOT.C][1] = y / L
    if want & BIT.xi:
        out[SLOT.xi][0] = -(v[0] * v[0] + v[1] * v[1]) / L
    if want & BIT.V:
        out[SLOT.V][0] = m * g * y
    return 0


compiled = numba.cfunc(zd.numba_signature())(pendulum)


@numba.cfunc(zd.numba_signature())
def decorated(data, want, t, p, v, out):
    return 1


@numba.cfunc("float64(float64)")
def other(x):
    return x


def local():
    return numba.cfunc(zd.numba_signature())(lambda data, want, t, p, v, out: 0)
