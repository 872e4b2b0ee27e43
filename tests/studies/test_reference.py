"""`zd.reference`: what it certifies is true, and it certifies nothing that it cannot know."""

import contextlib
import math
import pickle

import numpy as np
import pytest
import sympy as sp

import certain_motions_free
import energy_models
import taylor
import zerodrift as zd
from covering import spread
from reference_files import definition, number, table
from support import SYSTEMS, refused
from symbolic_counterparts import chaplygin_sleigh, rolling_disc
from taylor import mp
from zerodrift.studies import compare

ERRORS = (1e-6, 1e-9, 1e-11, None)
PRINTED = 2e-16         # relative: the numbers of the files as doubles
BAR = SYSTEMS["four_bar"]


# ---- exact motions: system, times (None: every step), coordinates compared, p at the times ----


def oscillator():
    system = zd.systems.oscillator(mass=1.0, stiffness=4.0, x0=0.1)
    return system, 5.0, None, [0], lambda t: 0.1 * np.cos(2 * t)[:, None]


def knife_edge():
    g, rate, slope = 9.81, np.pi / 3, np.pi / 4
    A = g * np.sin(slope) / (2 * rate**2)

    def exact(t):
        return np.stack([A * np.sin(rate * t)**2, A * (rate * t - np.sin(2 * rate * t) / 2), rate * t], axis=1)

    return zd.systems.knife_edge(), 6.0, None, [0, 1, 2], exact


def pendulum():
    given = definition("A01_pendulum")["reference_x0_plus1"]
    times = ("1", "5", "9.99", "10")
    return (zd.systems.pendulum(angle=np.pi / 2), 10.0, [float(t) for t in times], [0, 1],
            lambda t: np.array([number(given[moment]) for moment in times]))


def from_table(name, system, columns, coordinates):
    given = table(name)
    values = np.stack([given[column] for column in columns], axis=1)
    return system, given["t"][-1], given["t"], coordinates, lambda t: values


EXACT = {
    "oscillator": oscillator, "knife_edge": knife_edge, "pendulum": pendulum,
    "sleigh": lambda: from_table("chaplygin_sleigh", chaplygin_sleigh(), ("x_blade", "y_blade", "phi"), [0, 1, 2]),
    "disc": lambda: from_table("rolling_disc", rolling_disc(), "xyz", [0, 1, 2]),
    "slider_crank": lambda: from_table("sundials_slider_crank", energy_models.slider_crank(), "qxp", [0, 1, 2]),
}


@pytest.mark.parametrize("error", ERRORS)
@pytest.mark.parametrize("name", EXACT)
def test_the_certified_error_is_never_too_small(name, error):
    system, end, times, columns, exact = EXACT[name]()
    ref = zd.reference(system, end, error=error, t_eval=times, precision="double")     # as what is known of them
    expected = exact(ref.solution.t)
    actual = np.abs(ref.solution.p[:, columns] - expected).max()
    assert actual <= ref.error + PRINTED * np.abs(expected).max()
    assert error is None or ref.error <= error


def test_velocities_are_certified_too():
    given = table("sundials_slider_crank")
    ref = zd.reference(energy_models.slider_crank(), 10.0, error=1e-9, t_eval=given["t"])
    expected = np.stack([given[name] for name in ("q_d", "x_d", "p_d")], axis=1)
    assert np.abs(ref.solution.v - expected).max() <= ref.velocity_error < 1e-8


@pytest.mark.parametrize("error", [1e-6, 1e-8])
def test_every_system_has_a_reference_that_a_better_one_confirms(system, error):
    """The better one's own error included."""
    times = np.linspace(0, 1, 9)
    ref, best = (zd.reference(system, 1.0, error=wanted, t_eval=times) for wanted in (error, None))
    assert np.abs(ref.solution.p - best.solution.p).max() <= ref.error + best.error
    assert ref.error <= error


def test_the_evidence_is_from_other_steps_methods_formulations_and_roundings():
    ref = zd.reference(BAR, 1.0, error=1e-8)
    halved, rounded, method, finer = ref.differences
    assert ref.solution.stats["steps"] == 2 * halved.steps == rounded.steps
    assert (3 * halved.steps, 3 * method.steps, 3 * finer.steps) == tuple(k * ref.solution.stats["steps"] / 2 for k in (3, 4, 10))
    assert method.integrator == "extrapolation"
    assert {d.integrator for d in ref.differences} == {"dop853", "extrapolation"}
    assert [d.formulation for d in ref.differences] == ["augmented", "augmented", "independent", "independent"]
    assert [d.rounded for d in ref.differences] == [False, True, True, True]
    assert ref.error >= 1.5 * np.hypot.reduce([d.p for d in ref.differences]) > 0
    assert ref.caveats == ()
    assert "four_bar" in repr(ref)
    assert "extrapolation" in repr(ref)


def test_without_constraints_no_formulation_is_taken_for_another():
    """All of them do the same arithmetic there; the runs differ all the same."""
    ref = zd.reference(zd.systems.oscillator(), 1.0, precision="double")
    assert {d.formulation for d in ref.differences} == {"augmented"}
    assert min(d.p for d in ref.differences) > 0


def test_other_formulations_and_corrections_may_be_chosen():
    options = {"formulations": ("nullspace", "schur"), "stabilization": zd.Projection(tol=1e-13)}
    ref = zd.reference(BAR, 1.0, error=1e-8, **options)
    assert ref.solution.settings["formulation"] == "nullspace"
    assert ref.solution.settings["stabilization"] == zd.Projection(tol=1e-13)


# ---- what used to be certified with too little ----


def test_rounding_that_every_step_shares_is_seen():
    """Minutes of the oscillator: k / m is rounded once and for all, and the phase is off in proportion to time."""
    mass, stiffness = 0.1, 0.3
    ref = zd.reference(zd.systems.oscillator(mass=mass, stiffness=stiffness, x0=1.0), 500.0, precision="double")
    rows = np.linspace(0, len(ref.solution.t) - 1, 100).astype(int)
    rate = mp.sqrt(mp.mpf(stiffness) / mp.mpf(mass))
    exact = [mp.cos(rate * mp.mpf(float(t))) for t in ref.solution.t[rows]]
    true = max(float(abs(mp.mpf(float(x)) - e)) for x, e in zip(ref.solution.p[rows, 0], exact, strict=True))
    assert 1e-14 < true <= ref.error <= 100 * true


def test_a_chaotic_motion_says_that_it_is():
    """Henon and Heiles over 200 s, against its Taylor series."""
    start = [0.0, -0.040137511547818916, 0.520452873225992, 0.022581898380487825]

    def right_side(t, s):
        x, y, u, v = s
        return [u, v, -1 * x - 2 * (x * y), y * y - x * x - y]

    system = certain_motions_free.henon_system().starting(start[:2], start[2:])
    ref = zd.reference(system, 200.0, t_eval=[200.0], precision="double")
    exact = taylor.solution(right_side, start, 0, [200.0])[0]
    true = max(float(abs(mp.mpf(float(a)) - b)) for a, b in zip(ref.solution.p[-1], exact[:2], strict=True))
    assert 1e-9 < true <= ref.error <= 100 * true
    assert "multiplies roundings" in ref.caveats[0]
    assert ref.caveats[0] in repr(ref)


def test_a_short_blow_is_seen_with_a_max_step_and_not_excluded_without():
    """One newton second within a millisecond or two, on a free mass."""
    system = certain_motions_free.pulse_system().with_parameters(w=0.0, T=0.33, s=1e-3, a=np.pi**-0.5)
    ref = zd.reference(system, 1.0, max_step=1e-3, t_eval=[0.2, 0.5, 1.0])
    off = np.abs(ref.solution.p[:, 0] - [0.2, 0.5 + 0.17, 1 + 0.67]).max()
    assert off <= ref.error_in_double + 2.0**-52        # a is rounded
    assert ref.error < 1e-10
    assert ref.caveats == ()
    assert min(d.steps for d in ref.differences) >= 1000
    missed = zd.reference(system, 1.0, t_eval=[0.2, 0.5, 1.0])
    assert "no max_step was said" in missed.caveats[0]
    steps = [d.steps for d in missed.differences]
    assert max(steps) >= 3 * min(steps)


def test_the_first_step_may_be_said():
    """`first_step` is that of the run that determines the number of steps; one that is too long is rejected."""
    refs = [zd.reference(BAR, 1.0, error=1e-8, first_step=h) for h in (1e-6, 0.01)]
    assert refs[0].solution.stats["steps"] >= refs[1].solution.stats["steps"]
    assert max(ref.error for ref in refs) <= 1e-8


def test_a_force_with_corners_is_named(monkeypatch):
    """Dry friction: the motion is known piece by piece, x'' = -x - 0.1 sign(x')."""
    x, v = sp.symbols("x v")
    system = zd.symbolic([x], speeds=[v], kinetic=v**2 / 2, potential=x**2 / 2, force=[-sp.sign(v) / 10], p0=[1.0], v0=[0.0])
    for error in (1e-2, 1e-3, None):
        ref = zd.reference(system, 4.0, error=error, t_eval=[1.0, 3.0, 4.0])
        exact = np.where(ref.solution.t < np.pi, 0.1 + 0.9 * np.cos(ref.solution.t), -0.1 + 0.7 * np.cos(ref.solution.t))
        assert np.abs(ref.solution.p[:, 0] - exact).max() <= ref.error <= (error or 1e-2)
        assert any("jump or have corners" in caveat for caveat in ref.caveats)
    monkeypatch.setattr("zerodrift.studies.reference_search.REFINEMENTS", 9)
    with pytest.raises(zd.UnreachableTolerance, match=r"corners.* what can be certified is"):
        zd.reference(system, 4.0, error=1e-6, t_eval=[1.0, 3.0, 4.0])


@pytest.mark.usefixtures("few_places")
def test_a_formulation_that_cannot_follow_is_left_for_another(monkeypatch):
    """A default formulation that fails is replaced: `schur` cannot take a coordinate without mass."""
    system = zd.System(["x", "y"], mass=np.diag([1.0, 0.0]), force=lambda p: np.array([-p[0], 0.0]), p0=[1.0, 1.0],
                       constraints=lambda p: np.array([p[1] - p[0]**2]))
    names = ("augmented", "nullspace", "schur")
    monkeypatch.setattr("zerodrift.runs.arguments.methods.formulations", lambda system=None: dict.fromkeys(names))
    ref = zd.reference(system, 0.2)
    assert [d.formulation for d in ref.differences] == ["augmented", "augmented", "nullspace", "nullspace", "nullspace"]
    assert np.abs(ref.solution.p[:, 0] - np.cos(ref.solution.t)).max() <= ref.error < 1e-12
    with refused("mass-not-definite"):
        zd.reference(system, 0.2, formulations=("augmented", "schur"))


# ---- joint and absolute coordinates ----


def test_a_mechanism_is_compared_in_its_other_coordinates():
    ref = zd.reference(zd.models.four_bar(), 0.3)
    assert [d.formulation for d in ref.differences][-1] == "augmented, absolute"
    assert 1.5 * np.hypot.reduce([d.p for d in ref.differences]) <= ref.error < 1e-10


def test_a_motion_that_is_another_in_other_coordinates_is_not_certified(monkeypatch):
    """As where a rank is decided wrongly in one of them."""
    system = zd.models.four_bar().system("joint")
    other = system.with_parameters({"rocker.mass": 1.01 * system.parameters["rocker.mass"]})._in_other_coordinates()
    monkeypatch.setattr(type(system), "_in_other_coordinates", lambda self: other)
    with contextlib.suppress(zd.UnreachableTolerance):
        assert zd.reference(system, 0.3).error > 1e-4


# ---- what acts in a narrow place ----


def glider(width, force, place):
    """A body at 1 m/s that is pushed where it passes a place; its last speed follows from its energy."""
    x, u = sp.symbols("x u")
    push = force * sp.exp(-((x - place) / width)**2)
    system = zd.symbolic([x], speeds=[u], kinetic=u**2 / 2, force=[push], p0=[0.0], v0=[1.0])
    return system, np.sqrt(1 + 2 * force * width * np.sqrt(np.pi))


@pytest.mark.parametrize(("width", "place"), spread([(0.05, 3.3), (2e-3, 0.31), (0.01, 1.7)], 2))  # 2e-3 takes ten times more
def test_a_narrow_place_is_found(width, place):
    system, last = glider(width, 0.2 / width, place)
    ref = zd.reference(system, 4.0)
    assert abs(ref.solution.v[-1, 0] - last) <= ref.velocity_error < 1e-6
    assert any("max_move" in caveat for caveat in ref.caveats)


def test_a_place_narrower_than_all_points_of_evaluation_is_a_caveat():
    system, last = glider(1e-8, 2e7, np.pi)
    missed = zd.reference(system, 4.0)
    assert abs(missed.solution.v[-1, 0] - last) > missed.velocity_error
    caveat, = missed.caveats
    assert "max_move" in caveat
    assert "narrower than" in caveat


def test_nothing_hides_in_polynomials_and_sines():
    x, u = sp.symbols("x u")
    system = zd.symbolic([x], speeds=[u], kinetic=u**2 / 2, force=[-sp.sin(x) + x**3 / 7], p0=[0.3])
    assert zd.reference(system, 1.0).caveats == ()


# ---- what it is used for ----


def test_a_reference_has_values_at_any_time():
    ref, sol = zd.reference(BAR, 1.0, error=1e-9), zd.simulate(BAR, 1.0, step=0.03)
    exact = zd.reference(BAR, 1.0, error=1e-9, t_eval=sol.t)
    apart = compare.difference(sol, ref, ["alpha1", "alpha2_dot"]) - compare.difference(sol, exact, ["alpha1", "alpha2_dot"])
    assert np.abs(apart[:, 0]).max() <= ref.error + exact.error
    assert np.abs(apart[:, 1]).max() <= ref.velocity_error + exact.velocity_error


def test_a_reference_at_given_times_has_no_others():
    ref = zd.reference(BAR, 1.0, error=1e-9, t_eval=[0.5, 1.0])
    with refused("not-available"):
        compare.difference(zd.simulate(BAR, 1.0, step=0.1), ref)


def test_a_reference_can_be_sent_to_another_process():
    ref = zd.reference(BAR, 0.5, error=1e-8)
    assert pickle.loads(pickle.dumps(ref)).error == ref.error


# ---- what it refuses ----


def test_an_error_below_the_spacing_of_doubles_is_refused():
    with pytest.raises(zd.UnreachableTolerance, match="spacing of doubles at the size of this motion"):
        zd.reference(BAR, 1.0, error=1e-16, precision="double")


def test_an_error_below_round_off_is_refused_with_what_can_be_had():
    """The four-bar passes near its singular position and multiplies what rounding leaves."""
    with pytest.raises(zd.UnreachableTolerance, match=r"stops falling at round-off.* what can be certified is ") as caught:
        zd.reference(BAR, 8.0, error=1e-13, precision="double")
    possible = float(str(caught.value).split()[-2])        # before the code
    assert zd.reference(BAR, 8.0, error=2 * possible, precision="double").error <= 2 * possible


def test_an_error_that_a_jump_excludes_is_refused_with_this_cause(monkeypatch):
    """In 576 steps rounding decides on which side of the jump the force is evaluated, but it does not multiply roundings."""
    monkeypatch.setattr("zerodrift.studies.reference_search.REFINEMENTS", 6)
    t, x, v = sp.symbols("t x v")
    system = zd.symbolic([x], speeds=[v], kinetic=v**2 / 2, force=[sp.Heaviside(t - sp.Rational(7, 10))], p0=[0], v0=[0])
    with pytest.raises(zd.UnreachableTolerance, match=r"fall slowly, as where a term jumps|the terms jump or have corners"):
        zd.reference(system, 2.0, error=1e-5)


def test_a_motion_that_forgets_its_start_is_refused(monkeypatch):
    """Lorenz' equations: after 60 s two runs that round differently have nothing in common."""
    def force(v):
        x, y, z = v
        return np.array([10 * (y - x), x * (28 - z) - y, x * y - 8 / 3 * z])

    lorenz = zd.System(3, mass=np.eye(3), force=force, p0=np.zeros(3), v0=np.array([1.0, 1.0, 20.0]))
    assert zd.reference(lorenz, 2.0, error=1e-9).error <= 1e-9
    monkeypatch.setattr("zerodrift.studies.reference_search.REFINEMENTS", 3)
    with pytest.raises(zd.UnreachableTolerance, match="use a shorter t_span"):
        zd.reference(lorenz, 60.0, error=1e-6)


def test_a_start_off_the_constraints_is_refused():
    with pytest.raises(zd.InconsistentStart):
        zd.reference(BAR, 1.0, BAR.p0 + 1e-3)


def test_a_motion_that_ends_is_refused():
    """X'' = 2 x^3 from x = x' = 1 is 1 / (1 - t)."""
    system = zd.System(1, mass=[[1.0]], force=lambda p: 2 * p**3, p0=[1.0], v0=[1.0])
    with pytest.raises(zd.ZerodriftError), np.errstate(all="ignore"):
        zd.reference(system, 2.0)


@pytest.mark.parametrize(("options", "code", "message"), [
    ({"error": 0.0}, "out-of-range", "error.*than 0"),
    ({"error": math.nan}, "not-finite", "error"),
    ({"formulations": ("schur", "newton")}, "unknown-choice", "formulation"),
    ({"formulations": ("schur", "schur")}, "wrong-value", "two different formulations"),
    ({"formulations": "schur"}, "wrong-value", "two different formulations"),
    ({"max_step": 0.0}, "step-size", "max_step"),
    ({"first_step": -1.0}, "step-size", "first_step"),
])
def test_bad_arguments(options, code, message):
    with refused(code, message):
        zd.reference(BAR, 1.0, **options)
