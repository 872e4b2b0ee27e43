"""`zd.reference` in double-double arithmetic: against closed forms, and series in integers of separately written formulations."""

import functools

import mpmath
import numpy as np
import pytest

import taylor
import zerodrift as zd
from support import SYSTEMS, refused
from taylor import mp, sin_cos

BAR = SYSTEMS["four_bar"]
DIGITS = 45     # of mpmath, where closed forms are evaluated


def number(high, low):
    return mp.mpf(float(high)) + mp.mpf(float(low))


def largest_error(ref, columns, exact):
    """Largest error of some coordinates, of the sums of both parts, against lists of numbers by sample."""
    return max(abs(number(ref.p[i, j], ref.p_low[i, j]) - exact[i][k]) for i in range(len(exact)) for k, j in enumerate(columns))


# ---- closed forms ----


def test_the_oscillator_by_its_cosine():
    mass, stiffness, x0 = 0.1, 0.3, 1.0
    ref = zd.reference(zd.systems.oscillator(mass=mass, stiffness=stiffness, x0=x0), 100.0, t_eval=np.linspace(0, 100, 11))
    rate = mp.sqrt(mp.mpf(stiffness) / mp.mpf(mass))
    true = largest_error(ref, [0], [[mp.cos(rate * mp.mpf(float(t)))] for t in ref.solution.t])
    assert true <= ref.error <= 1e-26


def test_the_pendulum_by_elliptic_functions():
    """From rest at an angle of 1.2: sin(angle / 2) = k sn(K + t (g / L)^(1/2), k)."""
    ref = zd.reference(zd.systems.pendulum(length=1.0, gravity=9.81, angle=1.2), 10.0, t_eval=[0.0, 0.3, 4.0, 9.99, 10.0])
    mpmath.mp.dps = DIGITS
    start = mpmath.mpf(1.2)
    m = mpmath.sin(start / 2)**2
    worst = 0
    for i, t in enumerate(ref.solution.t):
        sn = mpmath.ellipfun("sn", mpmath.ellipk(m) + mpmath.mpf(float(t)) * mpmath.sqrt(mpmath.mpf(9.81)), m=m)
        angle = 2 * mpmath.asin(mpmath.sqrt(m) * sn)
        for j, exact in enumerate((mpmath.sin(angle), -mpmath.cos(angle))):
            worst = max(worst, abs(mpmath.mpf(float(ref.p[i, j])) + mpmath.mpf(float(ref.p_low[i, j])) - exact))
    mpmath.mp.dps = 15
    assert worst <= ref.error <= 1e-25


def test_the_knife_edge_by_its_cycloid():
    ref = zd.reference(zd.systems.knife_edge(), 6.0, t_eval=np.linspace(0, 6, 7))
    g, slope, rate = mp.mpf(9.81), mp.mpf(np.pi / 4), mp.mpf(SYSTEMS["knife_edge"].parameters["turn_rate"])
    A, exact = g * mp.sin(slope) / (2 * rate**2), []
    for t in ref.solution.t:
        turn = rate * mp.mpf(float(t))
        exact.append([A * mp.sin(turn)**2, A * (turn - mp.sin(2 * turn) / 2), turn])
    assert largest_error(ref, [0, 1, 2], exact) <= ref.error <= 1e-25


# ---- the four-bar, in its crank's angle alone ----


def loop_closed(angle, lengths):
    """Angles of coupler and follower, by Newton's method in mpmath."""
    l0, l1, l2, l3 = lengths
    b, c = mp.mpf(BAR.p0[1]), mp.mpf(BAR.p0[2])
    for _ in range(8):
        x = l1 * mp.cos(angle) + l2 * mp.cos(b) + l3 * mp.cos(c) - l0
        y = l1 * mp.sin(angle) + l2 * mp.sin(b) + l3 * mp.sin(c)
        determinant = l2 * l3 * mp.sin(c - b)
        b, c = b - (x * mp.cos(c) + y * mp.sin(c)) / determinant * l3, c + (x * mp.cos(b) + y * mp.sin(b)) / determinant * l2
    return b, c


def rates_of_bar(lengths, masses, gravity):
    """Right side in (a, b, c, rate of a): both other angles follow the crank, and their equations are projected onto it."""
    _, l1, l2, l3 = lengths
    m1, m2, m3 = masses
    own = [(m1 / 3 + m2 + m3) * l1**2, (m2 / 3 + m3) * l2**2, m3 * l3**2 / 3]
    k12, k13, k23 = (m2 / 2 + m3) * l1 * l2, m3 * l1 * l3 / 2, m3 * l2 * l3 / 2
    weights = [(m1 / 2 + m2 + m3) * gravity * l1, (m2 / 2 + m3) * gravity * l2, m3 * gravity * l3 / 2]

    def right_side(t, state):
        a, b, c, u = state
        (s1, c1), (s2, c2), (s3, c3) = map(sin_cos, (a, b, c))
        s32, s13, s21 = s3 * c2 - c3 * s2, s1 * c3 - c1 * s3, s2 * c1 - c2 * s1
        c32, c13, c21 = c3 * c2 + s3 * s2, c1 * c3 + s1 * s3, c2 * c1 + s2 * s1
        follow_b, follow_c = s13 / s32 * (l1 / l2), s21 / s32 * (l1 / l3)
        w, z = follow_b * u, follow_c * u
        more_b = (c13 * (u - z) * s32 - s13 * c32 * (z - w)) / (s32 * s32) * (l1 / l2)
        more_c = (c21 * (w - u) * s32 - s21 * c32 * (z - w)) / (s32 * s32) * (l1 / l3)
        acceleration_b, acceleration_c = more_b * u, more_c * u
        r1 = c21 * k12 * acceleration_b + c13 * k13 * acceleration_c - s21 * k12 * (w * w) + s13 * k13 * (z * z) + c1 * weights[0]
        r2 = acceleration_b * own[1] + c32 * k23 * acceleration_c + s21 * k12 * (u * u) - s32 * k23 * (z * z) + c2 * weights[1]
        r3 = c32 * k23 * acceleration_b + acceleration_c * own[2] - s13 * k13 * (u * u) + s32 * k23 * (w * w) + c3 * weights[2]
        coupled = c21 * k12 * follow_b + c13 * k13 * follow_c + c32 * k23 * follow_b * follow_c
        mass = follow_b * follow_b * own[1] + follow_c * follow_c * own[2] + 2 * coupled + own[0]
        return [u, w, z, -1 * (r1 + follow_b * r2 + follow_c * r3) / mass]

    return right_side


@functools.cache
def exact_bar(times):
    lengths, masses = (list(map(mp.mpf, BAR.parameters[key])) for key in ("lengths", "masses"))
    angle = mp.mpf(BAR.parameters["crank_angle"])
    start = [angle, *loop_closed(angle, lengths), mp.mpf(BAR.parameters["crank_rate"])]
    return taylor.solution(rates_of_bar(lengths, masses, mp.mpf(9.81)), start, 0, times)


def test_the_four_bar_in_its_cranks_angle():
    """Over 8 s, in which the motion multiplies what is rounded by a hundred thousand."""
    times = (0.0, 1.0, 4.0, 8.0)
    ref = zd.reference(BAR, 8.0, error=1e-18, t_eval=times)
    exact = exact_bar(times)
    assert largest_error(ref, [0, 1, 2], exact) <= ref.error <= 1e-18
    rate = max(abs(number(v, low) - each[3]) for v, low, each in zip(ref.v[:, 0], ref.v_low[:, 0], exact, strict=True))
    assert rate <= ref.velocity_error
    assert largest_error(ref, [0, 1, 2], exact[:1]) <= 1e-30      # the start, assembled


def test_the_first_sample_may_be_later_than_the_start():
    """And the first time other than zero."""
    whole = zd.reference(BAR, (0.5, 1.5), t_eval=[0.5, 1.0, 1.5])
    later = zd.reference(BAR, (0.5, 1.5), t_eval=[1.0, 1.5])
    assert whole.precision == later.precision == "double-double"
    apart = (whole.p[1:] - later.p) + (whole.p_low[1:] - later.p_low)
    assert np.abs(apart).max() <= whole.error + later.error
    only = zd.reference(BAR, 0.5, t_eval=[0.5])
    assert (only.precision, len(only.p)) == ("double-double", 1)


def test_the_start_has_what_is_given():
    ref = zd.reference(BAR, 0.1, t_eval=[0.0, 0.1])
    assert (ref.p[0, 0], ref.p_low[0, 0]) == (BAR.parameters["crank_angle"], 0.0)
    assert (ref.v[0, 0], ref.v_low[0, 0]) == (BAR.parameters["crank_rate"], 0.0)
    assert np.abs(ref.p[0] - BAR.p0).max() <= 4e-16


def test_a_start_at_an_angle_is_that_of_the_parameters():
    """Sine and cosine are those of mpmath, and the constraint holds as it is."""
    ref = zd.reference(zd.systems.knife_edge(heading=0.7, speed=1.3), 0.2, t_eval=[0.0, 0.2])
    exact = [mp.mpf(1.3) * of(mp.mpf(0.7)) for of in (mp.cos, mp.sin)]
    assert max(abs(number(high, low) - x) for high, low, x in zip(ref.v[0], ref.v_low[0], exact, strict=False)) <= 1e-30


# ---- the choice of a precision ----


def test_double_precision_where_that_is_enough_or_wanted():
    assert zd.reference(BAR, 0.5, error=1e-6).precision == "double"
    ref = zd.reference(BAR, 0.5, precision="double")
    assert ref.precision == "double"
    assert not ref.p_low.any()
    assert not ref.v_low.any()
    assert zd.reference(BAR, 0.5, error=1e-6, precision="double-double").precision == "double-double"
    with refused("unknown-choice", "precision"):
        zd.reference(BAR, 0.5, precision="quadruple")
    with pytest.raises(zd.UnreachableTolerance, match="spacing of doubles"):
        zd.reference(BAR, 0.5, error=1e-20, precision="double")


def test_a_system_without_expressions_has_double_precision_alone():
    spring = zd.System(1, mass=[[1.0]], force=lambda t, p, v: -p, p0=[1.0])
    assert zd.reference(spring, 0.5, error=1e-8).precision == "double"
    with refused("not-available", "precision.*'double'"):
        zd.reference(spring, 0.5, precision="double-double")


def test_a_motion_that_cannot_be_computed_is_refused_where_it_was_requested(monkeypatch):
    from zerodrift.studies import precise_motion

    monkeypatch.setattr(precise_motion, "MAX_STEPS", 1)
    with pytest.raises(zd.UnreachableTolerance, match="no reference in double-double arithmetic: step size underflow"):
        zd.reference(BAR, 0.5, t_eval=[0.5], precision="double-double")
    assert zd.reference(BAR, 0.5, t_eval=[0.5]).precision == "double"


def test_the_certificate_tells_its_evidence():
    ref = zd.reference(BAR, 0.5, t_eval=[0.0, 0.5])
    truncated, rounded, *in_double = ref.differences
    assert truncated.formulation == rounded.formulation == "double-double"
    assert (truncated.rounded, rounded.rounded) == (False, True)
    assert {each.integrator for each in in_double} >= {"dop853", "extrapolation"}
    assert ref.error >= 5 * np.hypot(truncated.p, rounded.p)
    assert "double-double arithmetic" in repr(ref)


def test_events_that_never_come_are_empty():
    spring = zd.systems.oscillator(mass=1.0, stiffness=4.0, x0=0.1)
    found = zd.reference(spring, 2.0, precision="double-double").events(zd.Event("x", value=0.5))
    assert [len(each) for each in (found.t, found.low)] == [0, 0]
    assert [each.shape for each in (found.p, found.p_low, found.v, found.v_low)] == [(0, 1)] * 4
