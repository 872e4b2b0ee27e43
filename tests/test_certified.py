"""`zd.reference`: what it certifies is true, and it certifies nothing that it cannot know."""

import math
import pickle

import numpy as np
import pytest

import zerodrift as zd
from support import SYSTEMS
from test_references import definition, number, table
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
    "sleigh": lambda: from_table("chaplygin_sleigh", zd.systems.chaplygin_sleigh(), ("x_blade", "y_blade", "phi"), [0, 1, 2]),
    "disc": lambda: from_table("rolling_disc", zd.systems.rolling_disc(), "xyz", [0, 1, 2]),
    "slider_crank": lambda: from_table("sundials_slider_crank", zd.systems.slider_crank(), "qxp", [0, 1, 2]),
}


@pytest.mark.parametrize("error", ERRORS)
@pytest.mark.parametrize("name", EXACT)
def test_the_certified_error_is_never_too_small(name, error):
    system, end, times, columns, exact = EXACT[name]()
    ref = zd.reference(system, end, error=error, t_eval=times)
    expected = exact(ref.solution.t)
    actual = np.abs(ref.solution.p[:, columns] - expected).max()
    assert actual <= ref.error + PRINTED * np.abs(expected).max()
    assert error is None or ref.error <= error


def test_velocities_are_certified_too():
    given = table("sundials_slider_crank")
    ref = zd.reference(zd.systems.slider_crank(), 10.0, error=1e-9, t_eval=given["t"])
    expected = np.stack([given[name] for name in ("q_d", "x_d", "p_d")], axis=1)
    assert np.abs(ref.solution.v - expected).max() <= ref.velocity_error < 1e-8


@pytest.mark.parametrize("error", [1e-6, 1e-8])
def test_every_system_has_a_reference_that_a_better_one_confirms(system, error):
    """The better one's own error included."""
    times = np.linspace(0, 1, 9)
    ref, best = (zd.reference(system, 1.0, error=wanted, t_eval=times) for wanted in (error, None))
    assert np.abs(ref.solution.p - best.solution.p).max() <= ref.error + best.error
    assert ref.error <= error


def test_the_evidence_is_from_another_step_and_another_formulation():
    ref = zd.reference(BAR, 1.0, error=1e-8)
    step, formulation = ref.differences
    assert (step.formulation, formulation.formulation) == ("augmented", "independent")
    assert ref.error >= 10 * max(step.p, formulation.p)
    assert ref.solution.stats["steps"] == step.steps
    assert "four_bar" in repr(ref)


def test_other_formulations_and_corrections_may_be_chosen():
    options = {"formulations": ("nullspace", "schur"), "stabilization": zd.Projection(tol=1e-13)}
    ref = zd.reference(BAR, 1.0, error=1e-8, **options)
    assert ref.solution.settings["formulation"] == "nullspace"
    assert ref.solution.settings["stabilization"] == zd.Projection(tol=1e-13)


# ---- what it is used for ----


def test_a_reference_has_values_at_any_time():
    ref, sol = zd.reference(BAR, 1.0, error=1e-9), zd.simulate(BAR, 1.0, step=0.03)
    exact = zd.reference(BAR, 1.0, error=1e-9, t_eval=sol.t)
    apart = compare.difference(sol, ref, ["alpha1", "alpha2_dot"]) - compare.difference(sol, exact, ["alpha1", "alpha2_dot"])
    assert np.abs(apart[:, 0]).max() <= ref.error + exact.error
    assert np.abs(apart[:, 1]).max() <= ref.velocity_error + exact.velocity_error


def test_a_reference_at_given_times_has_no_others():
    ref = zd.reference(BAR, 1.0, error=1e-9, t_eval=[0.5, 1.0])
    with pytest.raises(ValueError, match="no row at t = 0"):
        compare.difference(zd.simulate(BAR, 1.0, step=0.1), ref)


def test_a_reference_can_be_sent_to_another_process():
    ref = zd.reference(BAR, 0.5, error=1e-8)
    assert pickle.loads(pickle.dumps(ref)).error == ref.error


# ---- what it refuses ----


def test_an_error_below_the_spacing_of_doubles_is_refused():
    with pytest.raises(zd.UnreachableTolerance, match="spacing of doubles at the size of this motion"):
        zd.reference(BAR, 1.0, error=1e-16)


def test_an_error_below_round_off_is_refused_with_what_can_be_had():
    """The four-bar passes near its singular position and multiplies what rounding leaves."""
    with pytest.raises(zd.UnreachableTolerance, match=r"stops falling at round-off.* what can be certified is (.*)") as caught:
        zd.reference(BAR, 8.0, error=1e-13)
    possible = float(str(caught.value).split()[-1])
    assert zd.reference(BAR, 8.0, error=2 * possible).error <= 2 * possible


def test_a_motion_that_forgets_its_start_is_refused(monkeypatch):
    """Lorenz' equations: after 60 s two runs that round differently have nothing in common."""
    def force(v):
        x, y, z = v
        return np.array([10 * (y - x), x * (28 - z) - y, x * y - 8 / 3 * z])

    lorenz = zd.System(3, mass=np.eye(3), force=force, p0=np.zeros(3), v0=np.array([1.0, 1.0, 20.0]))
    assert zd.reference(lorenz, 2.0, error=1e-9).error <= 1e-9
    monkeypatch.setattr("zerodrift.studies.reference.REFINEMENTS", 3)
    with pytest.raises(zd.UnreachableTolerance, match="Ask for a shorter t_span"):
        zd.reference(lorenz, 60.0, error=1e-6)


def test_a_start_off_the_constraints_is_refused():
    with pytest.raises(zd.InconsistentStart):
        zd.reference(BAR, 1.0, BAR.p0 + 1e-3)


def test_a_motion_that_ends_is_refused():
    """X'' = 2 x^3 from x = x' = 1 is 1 / (1 - t)."""
    system = zd.System(1, mass=[[1.0]], force=lambda p: 2 * p**3, p0=[1.0], v0=[1.0])
    with pytest.raises(zd.ZerodriftError), np.errstate(all="ignore"):
        zd.reference(system, 2.0)


@pytest.mark.parametrize(("options", "message"), [
    ({"error": 0.0}, "error must be greater than 0"),
    ({"error": math.nan}, "error must be finite"),
    ({"formulations": ("schur", "newton")}, "formulation must be one of"),
    ({"formulations": ("schur", "schur")}, "two different formulations"),
    ({"formulations": "schur"}, "two different formulations"),
])
def test_bad_arguments(options, message):
    with pytest.raises(ValueError, match=message):
        zd.reference(BAR, 1.0, **options)
