"""Unit quaternions are kept at length one, and what is at length one is left as it is."""

import numpy as np
import pytest

import zerodrift as zd
from rotating_bodies import about_a_point, held_at_a_point
from spinning_body import body
from support import FORMULATIONS, INTEGRATORS, assert_same_bits

KEPT = 8 * 2.0**-52     # of the squared length: what the core leaves, and as much again for NumPy's own sum
TOP = (15.0, (0.5, 0.5, 0.25), (0.0, 0.0, 0.5), (0.3, 0.0, 30.0))       # mass, inertia, arm, angular velocity
STEP = 2.0**-7          # s: times of steps have no rounding, so that a second run has the same
EXPLICIT = ["rk4", "dop853", "extrapolation"]


def off(p):
    """By how much squared lengths of the last four coordinates differ from one, the most."""
    return np.abs((np.asarray(p)[..., -4:] ** 2).sum(axis=-1) - 1).max()


def tops():
    return {"held": held_at_a_point(*TOP), "free": about_a_point(*TOP)}


@pytest.mark.pairs(which=["held", "free"], integrator=sorted(zd.integrators(held_at_a_point(*TOP)).keys() & {*INTEGRATORS}))
def test_every_row_is_of_length_one(which, formulation, integrator):
    """Euler's method lengthens by a thousandth in each of these steps, and the last rows are as good as the first."""
    system = tops()[which]
    sol = zd.simulate(system, 3.0 if which == "free" else 0.5, step=2e-3, formulation=formulation, integrator=integrator)
    assert off(sol.p) <= KEPT
    assert off(sol(sol.t[:-1] + 1e-3)[0][::20]) <= KEPT


@pytest.mark.parametrize("options", [
    {"stabilization": None}, {"stabilization": zd.Projection(every=5)}, {"stabilization": "baumgarte"}, {"energy": True},
    {"step": None, "rtol": 1e-6, "atol": 1e-8, "integrator": "dormand_prince"}, {"t_eval": np.linspace(0, 0.5, 77)},
    {"stabilization": zd.Projection(metric="identity")},
    {"step": None, "t_eval": np.linspace(0, 0.5, 77), "integrator": "dop853"}],
    ids=lambda options: "-".join(options))
def test_whatever_else_a_run_does(formulation, options):
    sol = zd.simulate(held_at_a_point(*TOP), 0.5, **({"step": 1e-3, "formulation": formulation} | options))
    assert off(sol.p) <= KEPT


def test_events_see_it(formulation):
    seen = []

    def half_turn(t, p, v):
        seen.append(np.array(p))
        return p[3]

    sol = zd.simulate(held_at_a_point(*TOP), 0.5, step=5e-3, formulation=formulation, events=half_turn)
    assert len(seen) > 100
    assert len(sol.p_events[0])
    assert off(seen) <= KEPT
    assert off(sol.p_events[0]) <= KEPT


@pytest.mark.parametrize("method", EXPLICIT)
@pytest.mark.parametrize("which", ["held", "free"])
def test_a_run_from_a_saved_state_has_the_same_bits(which, formulation, method):
    """Methods with a memory beyond the state are left out: matrices of implicit methods, independent velocities."""
    if which == "held" and formulation in ("mixed", "independent"):
        pytest.skip("which velocities are independent depends on where the run has been")
    options = {"step": STEP, "formulation": formulation, "integrator": method}
    whole = zd.simulate(tops()[which], 1.0, **options)
    k = 40
    rest = zd.simulate(tops()[which], (whole.t[k], 1.0), whole.p[k], whole.v[k], **options)
    for name in ("t", "p", "v"):
        assert getattr(whole, name)[k:].tobytes() == getattr(rest, name).tobytes(), name
    # A start is on the matrix path, and has the multipliers of that, which differ by a rounding from those in closed form.
    assert whole.multipliers[k + 1:].tobytes() == rest.multipliers[1:].tobytes()


def test_what_was_normalised_is_not_changed_again():
    random, system = np.random.default_rng(0), about_a_point(*TOP)
    for q in random.normal(size=(2000, 4)) * random.choice([1e-3, 1.0, 1e3], (2000, 1)):
        once, _ = zd.project(system, q, np.zeros(3))
        again, _ = zd.project(system, once, np.zeros(3))
        assert off(once) <= KEPT
        assert once.tobytes() == again.tobytes()
        np.testing.assert_allclose(once, q / np.linalg.norm(q), rtol=8 * 2.0**-52)


def test_round_off_is_left_as_it_is():
    """One unit in the last place of one entry."""
    system, q = about_a_point(*TOP), np.array([np.nextafter(0.5, 1), 0.5, -0.5, 0.5])
    assert zd.project(system, q, np.zeros(3))[0].tobytes() == q.tobytes()


def test_a_position_correction_ends_at_length_one(formulation):
    """From far enough that its iterations lengthen the quaternion, as each goes along a tangent; Phi is zero where it ends."""
    system = held_at_a_point(*TOP)
    p = system.p0 + np.array([0.05, -0.1, 0.02, 0.0, 0.3, -0.2, 0.1])
    p, _ = zd.project(system, p, system.v0, formulation="augmented" if formulation == "independent" else formulation)
    assert off(p) <= KEPT
    assert np.abs(system.evaluate(p).Phi).max() < 1e-12


def test_a_held_entry_keeps_its_value():
    system = held_at_a_point(*TOP)
    p, _ = zd.assemble(system, np.r_[system.p0[:3], 0.9, 0.3, 0.2, 0.1], hold=["e1"])
    assert off(p) <= 1e-12
    assert abs(p[4] - 0.3) <= 1e-12


# ---- starts ----


@pytest.mark.parametrize("length", [1 + 1e-7, 1 - 9e-7, 1.0])
def test_a_start_that_is_nearly_of_length_one_is_put_there(length):
    q = np.array([0.5, -0.1, 0.7, 0.5])
    q /= np.linalg.norm(q)
    sol, exact = (zd.simulate(about_a_point(*TOP), 0.1, p0=p, step=STEP) for p in (length * q, q))
    assert off(sol.p) <= KEPT
    np.testing.assert_allclose(sol.p[0], q, rtol=1e-15)
    np.testing.assert_allclose(sol.p, exact.p, rtol=0, atol=1e-13)
    assert_same_bits(zd.simulate(about_a_point(*TOP), 0.1, p0=sol.p[0], step=STEP), sol)


@pytest.mark.parametrize("length", [0.0, 0.5, 1 - 2e-6, 1 + 2e-6, 1e200])
def test_a_start_of_another_length_is_refused(length):
    system, q = held_at_a_point(*TOP), np.array([length, 0, 0, 0])
    calls = [lambda p: zd.simulate(system, 0.1, p, step=STEP), lambda p: zd.acceleration(system, p, system.v0)]
    for call in calls:
        with pytest.raises(zd.InconsistentStart, match=r"p\[3\] to p\[6\] must be .* length 1 .*divide it by its length"):
            call(np.r_[system.p0[:3], q])


def test_a_quaternion_of_zero_length_is_not_an_attitude():
    with pytest.raises(zd.InconsistentStart, match=r"p\[0\] to p\[3\] must be a quaternion of positive length, not 0"):
        zd.project(about_a_point(*TOP), np.zeros(4), np.zeros(3))


def test_kinematics_that_change_the_length_are_refused():
    """The matrix of a rotation from the other side, scalar last: it serves, in its own order, and not in this."""
    def scalar_last(p):
        x, y, z, w = p
        return 0.5 * np.array([[w, -z, y], [z, w, -x], [-y, x, w], [-x, -y, z]])

    wrong = body(kinematics=scalar_last, quaternions=[0], p0=[0.5, 0.5, 0.5, 0.5])
    with pytest.raises(zd.InconsistentSystem, match=r"unit quaternion p\[0\] to p\[3\], and velocity 2 changes it"):
        zd.simulate(wrong, 0.1, step=0.01)
    report = zd.check(wrong)
    assert any("length of quaternions" in problem for problem in report.problems)
    right = zd.check(body(quaternions=[0]))
    assert right
    assert "length of quaternions" in right.checks


def test_without_saying_so_nothing_is_normalised():
    sol = zd.simulate(body(), 5.0, step=0.05, integrator="rk4")
    assert 1e-8 < off(sol.p) < 1e-2
    assert list(zd.formulations(body())) == [name for name in FORMULATIONS if name != "independent"]
