"""Values between samples, measures and events beyond double precision, against closed forms and relations that hold exactly."""

import pickle

import mpmath
import numpy as np
import pytest
import sympy

import zerodrift as zd
from support import refused
from zerodrift.systems.exact_numbers import low_parts_of_frames

DIGITS = 45     # of mpmath, where closed forms are evaluated
MASS, STIFFNESS, X0 = 0.1, 0.3, 0.7


def number(high, low):
    return mpmath.mpf(float(high)) + mpmath.mpf(float(low))


def numbers(high, low):
    return [number(*each) for each in zip(high, low, strict=True)]


@pytest.fixture(autouse=True)
def many_digits():
    with mpmath.workdps(DIGITS):
        yield


@pytest.fixture(scope="module")
def oscillating():
    return zd.reference(zd.systems.oscillator(mass=MASS, stiffness=STIFFNESS, x0=X0), 10.0, t_eval=[0.0, 10.0],
                        precision="double-double")


@pytest.fixture(scope="module")
def swinging():
    """From rest at an angle of 1.2: sin(angle / 2) = k sn(K + t (g / L)^(1/2), k)."""
    return zd.reference(zd.systems.pendulum(length=1.0, gravity=9.81, angle=1.2), 3.0, t_eval=[0.0, 3.0],
                        precision="double-double")


def rate():
    return mpmath.sqrt(mpmath.mpf(STIFFNESS) / mpmath.mpf(MASS))


def modulus():
    return mpmath.sin(mpmath.mpf(1.2) / 2)**2


def test_values_between_samples(oscillating):
    times = [7.3, 0.4, 2.5]
    found = oscillating.at(times)
    exact = [mpmath.mpf(X0) * mpmath.cos(rate() * mpmath.mpf(t)) for t in times]
    worst = max(abs(a - b) for a, b in zip(numbers(found.p[:, 0], found.p_low[:, 0]), exact, strict=True))
    assert worst <= found.error <= 1e-27
    speeds = [-mpmath.mpf(X0) * rate() * mpmath.sin(rate() * mpmath.mpf(t)) for t in times]
    worst = max(abs(a - b) for a, b in zip(numbers(found.v[:, 0], found.v_low[:, 0]), speeds, strict=True))
    assert worst <= found.velocity_error <= 1e-27


def test_samples_are_those_of_the_reference(oscillating):
    found = oscillating.at(oscillating.solution.t)
    assert np.array_equal(found.p, oscillating.p)
    assert np.array_equal(found.p_low, oscillating.p_low)
    assert (found.error, found.velocity_error) == (oscillating.error, oscillating.velocity_error)


def test_zeros_of_the_oscillator(oscillating):
    """At odd quarters of its period."""
    found = oscillating.events("x")
    exact = [(2 * k + 1) * mpmath.pi / (2 * rate()) for k in range(len(found.t))]
    assert len(found.t) == int(10.0 * rate() / mpmath.pi + 0.5)
    worst = max(abs(a - b) for a, b in zip(numbers(found.t, found.low), exact, strict=True))
    assert worst <= found.error <= 1e-27
    assert np.abs(found.p).max() <= 1e-15
    assert np.abs(np.abs(found.v) - X0 * float(rate())).max() <= 1e-15


def test_levels_and_directions_of_events(oscillating):
    """Half of x0 is reached from above first at a sixth of the period."""
    found = oscillating.events(zd.Event("x", value=X0 / 2, direction=-1))
    exact = [(mpmath.acos(mpmath.mpf(X0 / 2) / mpmath.mpf(X0)) + 2 * mpmath.pi * k) / rate() for k in range(len(found.t))]
    worst = max(abs(a - b) for a, b in zip(numbers(found.t, found.low), exact, strict=True))
    assert len(found.t) == 3
    assert worst <= found.error <= 1e-27


def test_the_pendulum_passes_its_lowest_point_at_quarter_periods(swinging):
    found = swinging.events("x")
    quarter = mpmath.ellipk(modulus()) / mpmath.sqrt(mpmath.mpf(9.81))
    exact = [(2 * k + 1) * quarter for k in range(len(found.t))]
    assert len(found.t) == 3
    assert max(abs(a - b) for a, b in zip(numbers(found.t, found.low), exact, strict=True)) <= found.error <= 1e-27


def test_an_expression_of_the_pendulum(swinging):
    """Its angle, by elliptic functions."""
    x, y = sympy.symbols("x y")
    value, low, error = swinging.measure(sympy.atan2(x, -y), [0.3, 1.7])
    for t, found in zip((0.3, 1.7), numbers(value, low), strict=True):
        sn = mpmath.ellipfun("sn", mpmath.ellipk(modulus()) + mpmath.mpf(t) * mpmath.sqrt(mpmath.mpf(9.81)), m=modulus())
        assert abs(found - 2 * mpmath.asin(mpmath.sqrt(modulus()) * sn)) <= error <= 1e-26


def test_an_event_that_is_an_expression(swinging):
    """The angle of half its amplitude, in double precision the same."""
    x, y = sympy.symbols("x y")
    event = zd.Event(sympy.atan2(x, -y), value=0.6)
    found = swinging.events(event)
    angle = 2 * mpmath.asin(mpmath.sin(mpmath.mpf(0.6) / 2))
    at = mpmath.asin(mpmath.sin(mpmath.mpf(0.6) / 2) / mpmath.sqrt(modulus()))
    first = (mpmath.ellipk(modulus()) - mpmath.ellipf(at, modulus())) / mpmath.sqrt(mpmath.mpf(9.81))
    assert angle > 0
    assert abs(number(found.t[0], found.low[0]) - first) <= found.error <= 1e-26


# ---- mechanisms ----


@pytest.fixture(scope="module")
def cranking():
    """A compiled slider-crank in joint coordinates, whose crank angle and sliding point are related in closed form."""
    return zd.reference(zd.models.slider_crank().system(compiled=True), 0.2, t_eval=[0.0, 0.07, 0.2], precision="double-double")


def scalars(system):
    """Names of scalar measures of positions and velocities."""
    core = system._measuring
    return [measure.name for i, measure in enumerate(core.measures)
            if core.measure_size(i) == 1 and core.measure_depends(i) in ("positions", "velocities")]


def test_measures_agree_with_those_in_double_precision(cranking):
    names = [*scalars(cranking.solution.system), "slider.position.x", "slider.velocity.x"]
    assert len(names) > 6
    for name in names:
        value, low, error = cranking.measure(name)
        expected = cranking.solution[name]
        assert value == pytest.approx(expected, rel=1e-13, abs=1e-13), name
        assert np.abs(low).max() <= np.spacing(np.abs(value).max()), name
        assert error <= 1e-22, name


def test_measures_of_a_rod_satisfy_its_length(cranking):
    """Pin and slider are as far apart as at the start, far beyond double precision."""
    x, y, u, w = sympy.symbols("x y u w")
    ends = dict(zip("xyuw", (f"{point}.position.{axis}" for point in ("pin", "slider") for axis in "xy"), strict=True))
    value, low, error = cranking.measure(sympy.sqrt((x - u)**2 + (y - w)**2), of=ends)
    lengths = numbers(value, low)
    assert max(abs(each - lengths[0]) for each in lengths) <= 2 * error <= 1e-25


def test_the_spatial_slider_crank_whose_joints_are_not_along_axes():
    """Its slider is where the length of the rod has it; frames of its joints are rotations to 32 digits."""
    ref = zd.reference(zd.models.spatial_slider_crank().system(compiled=True), 0.1, t_eval=[0.0, 0.06, 0.1],
                       precision="double-double")
    assert ref.error <= 1e-28
    a, b, c, u, v, w = sympy.symbols("a b c u v w")
    ends = dict(zip("abcuvw", (f"{end}.position.{axis}" for end in ("crank.end", "rod.end") for axis in "xyz"), strict=True))
    value, low, error = ref.measure(sympy.sqrt((u - a)**2 + (v - b)**2 + (w - c)**2), of=ends)
    lengths = numbers(value, low)
    assert max(abs(each - lengths[0]) for each in lengths) <= 2 * error <= 1e-27
    assert np.abs(ref.measure("slider.position.x").value - ref.solution["slider.position.x"]).max() <= 1e-15


def test_frames_become_rotations():
    """Equal entries stay equal, zeros and ones stay as they are, and frames that are not rotations have no low parts."""
    values = np.array([0.6, 0.8])
    turned = [[[(0, 1), (1, 1), (-1, 0)], [(1, -1), (0, 1), (-1, 0)], [(-1, 0), (-1, 0), (-1, 1)]]]
    low = low_parts_of_frames(turned, values)
    assert abs(number(0.6, low[0])**2 + number(0.8, low[1])**2 - 1) <= mpmath.mpf(10)**-32
    assert 0 < np.abs(low).max() < 1e-16
    assert not low_parts_of_frames(turned, np.array([0.6, 0.7])).any()
    assert not low_parts_of_frames([], values).any()


# ---- refusals ----


def test_forces_are_in_double_precision(cranking):
    name = next(name for name in cranking.solution.measures if name.endswith(".force"))
    with pytest.raises(ValueError, match=r"must be a (scalar )?measure of positions or velocities"):
        cranking.measure(f"{name}.x")


def test_what_has_no_more_digits_is_refused(oscillating):
    double = zd.reference(zd.systems.oscillator(), 0.5, error=1e-8)
    for ref in (double, pickle.loads(pickle.dumps(oscillating))):
        with pytest.raises(ValueError, match="need a reference of double-double arithmetic"):
            ref.at(0.2)
    with pytest.raises(TypeError, match="must be a measure, the name of one"):
        oscillating.measure(3)
    with pytest.raises(TypeError, match="must be a measure, the name of one"):
        oscillating.events(lambda t, p, v: p[0])
    with pytest.raises(ValueError, match="t"):
        oscillating.at(11.0)
    for values in (oscillating.at, lambda t: oscillating.measure("x", t)):
        with refused("shape", "^t must hold at least one time"):
            values([])


def test_an_event_without_a_rate_is_refused(oscillating):
    """The third power of x crosses zero without one."""
    with pytest.raises(zd.UnreachableTolerance, match="at a rate that is not zero"):
        oscillating.events(sympy.Symbol("x")**3)
