"""Systems written in NumPy: the same motion as their counterparts in C, exact derivatives, and errors that say what is wrong."""

import pickle
import signal

import numpy as np
import pytest

import zerodrift as zd
from four_bar_in_python import ANGLES, DERIVED, force, four_bar, jacobian
from support import FORMULATIONS, SYSTEMS, assert_close, refused
from symbolic_counterparts import chaplygin_sleigh


def raising(error):
    """A force that raises on its two hundredth call."""
    calls = []

    def force_until(p, L, m, g):
        calls.append(1)
        if len(calls) == 200:
            raise error
        return force(p, L, m, g)

    return force_until


# ---- the same motion ----


@pytest.mark.parametrize("changes", [{}, DERIVED, {"xi": None}], ids=["given", "derived", "xi derived"])
def test_same_trajectory_as_in_c(formulation, changes):
    options = {"step": 0.01, "formulation": formulation, "energy": True}
    mine, core = zd.simulate(four_bar(**changes), 0.5, **options), zd.simulate(SYSTEMS["four_bar"], 0.5, **options)
    assert_close(mine.p, core.p, 1e-13)
    assert_close(mine.multipliers, core.multipliers, 1e-11)


def test_terms_derived_are_those_given():
    state = [1.0, 0.4, -1.3], [1.0, -2.0, 0.5]
    derived, given = four_bar(**DERIVED).evaluate(*state), four_bar().evaluate(*state)
    assert_close(derived.C, given.C, 1e-15)
    assert_close(derived.xi, given.xi, 1e-15)


def test_kinematics_enter_the_derived_terms():
    """A pendulum in polar quasi-velocities: p = (x, y), v = (radial, tangential), so that A turns with p."""
    def kinematics(p):
        r = np.sqrt(p @ p)
        return np.array([[p[0], -p[1]], [p[1], p[0]]]) / r

    plain = zd.System(2, mass=np.eye(2), force=[0.0, -9.81], constraints=lambda p: np.array([p @ p - 1.0]) / 2,
                      potential=lambda p: 9.81 * p[1], p0=[1.0, 0.0])
    turning = zd.System(
        2, mass=np.eye(2), kinematics=kinematics, constraints=lambda p: np.array([p @ p - 1.0]) / 2,
        force=lambda p: kinematics(p).T @ np.array([0.0, -9.81]),
        bias=lambda p, v: np.array([-v[1] ** 2, v[0] * v[1]]) / np.sqrt(p @ p),
        potential=lambda p: 9.81 * p[1], p0=[1.0, 0.0])
    assert zd.check(turning)
    for formulation in FORMULATIONS:
        a, b = (zd.simulate(system, 0.1, step=0.001, formulation=formulation, save_every=50) for system in (plain, turning))
        assert_close(a.p, b.p, 1e-8)
        assert_close(a.multipliers, b.multipliers, 1e-6)


def test_time_dependent_constraint_is_derived_and_does_work():
    """A bead on a rod that turns at a prescribed angle: r grows as cosh, the drive does the work."""
    system = zd.System(
        ["x", "y"], mass=np.eye(2), potential=lambda p: 0.0,
        constraints=lambda t, p, w: np.array([p[1] * np.cos(w * t) - p[0] * np.sin(w * t)]),
        parameters={"w": 2.0}, p0=[1.0, 0.0], v0=[0.0, 2.0])
    assert zd.check(system, [1.0, 0.0], [0.0, 2.0])
    for formulation in FORMULATIONS:
        sol = zd.simulate(system, 1.0, step=0.002, formulation=formulation)
        r = np.cosh(2.0 * sol.t)
        assert_close(sol.p, np.stack([r * np.cos(2 * sol.t), r * np.sin(2 * sol.t)], axis=1), 1e-9)
        assert np.abs(sol.energy_violation).max() < 1e-8
        assert sol.energy_input[-1] > 1.0
    kept = zd.simulate(system, 1.0, step=0.05, energy=True)
    assert np.abs(kept.energy_violation).max() < 1e-13
    assert np.abs(kept.velocity_violation).max() < 1e-13


def test_nonholonomic_xi_is_derived():
    sleigh = chaplygin_sleigh()
    mine = zd.System(
        ["x", "y", "phi"], mass=lambda p: sleigh.evaluate(p).M, bias=lambda p, v: sleigh.evaluate(p, v).d,
        nonholonomic=lambda p: np.array([[-np.sin(p[2]), np.cos(p[2]), 0.0]]), potential=0.0, p0=sleigh.p0, v0=sleigh.v0)
    for formulation in FORMULATIONS:
        a, b = (zd.simulate(system, 0.5, step=0.01, formulation=formulation, stabilization=None) for system in (mine, sleigh))
        assert_close(a.p, b.p, 1e-13)


def test_callables_take_parameters_by_name_and_parameters_can_be_changed():
    short = four_bar().with_parameters(g=0.0)
    assert short.evaluate().f == pytest.approx(0.0)
    with refused("unknown-choice", "'l0', 'L', 'm', 'g'"):
        four_bar().with_parameters(gravity=1.0)


class Drawn(zd.System):
    """A system with a drawing."""

    def points(self, p):
        return np.array([[0.0, 0.0], p])


def test_a_system_that_adds_a_drawing_keeps_it():
    mine = Drawn(2, mass=np.eye(2), parameters={"m": 1.0}, p0=[0.0, 1.0])
    for other in (mine.with_parameters(m=2.0), pickle.loads(pickle.dumps(mine))):
        assert type(other) is Drawn
        assert other.points(other.p0).shape == (2, 2)


def test_pickled_systems_are_the_same():
    again = pickle.loads(pickle.dumps(four_bar()))
    assert (again.evaluate().M == four_bar().evaluate().M).all()


def test_saved_solutions_of_custom_systems_keep_the_description(tmp_path):
    sol = zd.simulate(four_bar(), 0.1, step=0.01)
    again = zd.load(sol.save(tmp_path / "motion"))
    assert [c.name for c in again.system.coordinates] == ANGLES
    assert repr(again.system) == "<description of system>"


# ---- what goes wrong ----


def test_an_exception_in_a_callable_surfaces_as_itself_with_the_partial_solution():
    error = ZeroDivisionError("on purpose")
    with pytest.raises(ZeroDivisionError, match="on purpose") as caught:
        zd.simulate(four_bar(force=raising(error)), 8.0, step=0.01)
    assert caught.value is error
    assert 10 < len(error.solution.t) < 100
    assert "t = " in error.__notes__[0]
    partial = zd.simulate(four_bar(force=raising(ZeroDivisionError("again"))), 8.0, step=0.01, on_failure="return")
    assert not partial.success
    assert "again" in partial.message


def test_ctrl_c_inside_a_callable_is_an_interruption():
    def interrupted(p, L, m, g):
        if p[0] < 1.0:
            signal.raise_signal(signal.SIGINT)
        return force(p, L, m, g)

    with pytest.raises(zd.Interrupted) as caught:
        zd.simulate(four_bar(force=interrupted, v0=-SYSTEMS["four_bar"].v0), 8.0, step=0.01)
    assert len(caught.value.solution.t) > 1


@pytest.mark.parametrize(("changes", "code", "message"), [
    ({"mass": lambda p: np.eye(2)}, "missing-argument", "for 2.*are 3"),
    ({"mass": np.ones(3)}, "shape", "^mass must.*3"),
    ({"force": lambda p: np.zeros(2)}, "shape", "force.*3.*2"),
    ({"jacobian": lambda p: np.zeros((3, 2))}, "shape", "jacobian.*2, 3.*3, 2"),
    ({"xi": lambda p: np.zeros(3)}, "shape", "^xi must.*2"),
    ({"constraints": lambda p: 0.0, "jacobian": None, "xi": None}, "shape", "constraints"),
    ({"constraints": None, "xi": None}, "missing-argument", None),
    ({"potential": None, "power": 0.0}, "missing-argument", "power"),
    ({"p0": [0.0, 1.0]}, "shape", "^p0 must.*3"),
    ({"p0": [0.0, np.nan, 1.0]}, "not-finite", "^p0 must"),
])
def test_wrong_shapes_name_the_callable(changes, code, message):
    with refused(code, message):
        four_bar(**changes)


def test_an_unknown_argument_of_a_callable_is_named():
    with refused("user-function", "'q'"):
        four_bar(force=lambda q: q)


@pytest.mark.parametrize("coordinates", [0, [], ["x", "x", "y"], "x x", [1, 2, 3]])
def test_coordinates_are_a_number_or_names(coordinates):
    with pytest.raises((ValueError, TypeError), match="coordinates"):
        zd.System(coordinates, mass=np.eye(3))


@pytest.mark.parametrize(("term", "value"), [("force", lambda t, p: np.full(3, np.nan if t > 0.1 else 0.0)),
                                             ("mass", lambda t: np.full((3, 3), np.inf) if t > 0.1 else np.eye(3))])
def test_a_value_that_is_not_finite_names_callable_and_time(term, value):
    with refused("not-finite", rf"{term} is not finite at t = 0.1") as caught:
        zd.simulate(four_bar(**{term: value}), 1.0, step=0.01)
    assert len(caught.value.solution.t) > 5


def test_a_jacobian_that_is_not_finite_is_named():
    def broken(t, p, L):
        return jacobian(p, L) if t < 0.1 else np.full((2, 3), np.nan)

    with refused("not-finite", r"^jacobian is not finite at t = 0.1"):
        zd.simulate(four_bar(jacobian=broken), 1.0, step=0.01)


def test_a_shape_that_changes_on_the_way_is_caught():
    with refused("shape", "force.*3.*4.*0.1"):
        zd.simulate(four_bar(force=lambda t: np.zeros(3 if t < 0.1 else 4)), 1.0, step=0.01)


@pytest.mark.parametrize(("changes", "code", "names"), [
    ({"mass": lambda p: -np.eye(3)}, "mass-not-definite", None),
    ({"mass": lambda p: np.eye(3) + np.triu(np.ones((3, 3)), 1)}, "mass-not-symmetric", None),
    ({"constraints": lambda p, t, L: np.array([L @ np.sin(p), 2 * L @ np.sin(p) - t**2]), **DERIVED},
     "contradicting-constraints", "row . follows from the others, but row . "),
])
def test_what_cannot_be_simulated_is_said_at_the_start(formulation, changes, code, names):
    with refused(code, names) as caught:
        zd.simulate(four_bar(**changes), 1.0, step=0.01, formulation=formulation)
    assert caught.value.solution is None


def test_energy_correction_without_potential_is_refused():
    with refused("not-available"):
        zd.simulate(four_bar(potential=None), 1.0, step=0.01, energy=True)


def test_a_system_without_start_asks_for_one():
    with refused("missing-argument"):
        zd.simulate(zd.System(1, mass=[[1.0]]), 1.0, step=0.1)


def test_filling_an_array_with_derivatives_explains_itself():
    def filled(p):
        out = np.zeros(1)
        out[0] = p[0] ** 2 + p[1] ** 2 - 1
        return out

    with refused("user-function"):
        zd.System(2, mass=np.eye(2), constraints=filled, p0=[1.0, 0.0]).evaluate()
