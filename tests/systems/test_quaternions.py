"""More coordinates than velocities: a spinning body whose attitude is a quaternion, said to be one or not."""

import pickle

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from covering import draws
from native_systems import compile_text, needs_compiler
from rotating_bodies import SPIN, TURN, gyroscopic, turning
from spinning_body import INERTIA, attitude, body, half_turns, precession
from spinning_body import SPIN as START
from support import FORMULATIONS, assert_close, refused

SUITED = [name for name in FORMULATIONS if name != "independent"]
BODIES = {"said to be one": body(quaternions=[0]), "not said": body()}
PAIRS = [(which, name) for which in BODIES for name in zd.formulations(BODIES[which])]


@pytest.mark.parametrize(("which", "name"), PAIRS)
def test_a_free_body_precesses(which, name):
    sol = zd.simulate(BODIES[which], draws(1.0, 5.0), step=0.01, formulation=name, integrator="dop853", energy=True)
    assert_close(sol.v, precession(sol.t), 1e-12)
    assert_close(sol.p, attitude(sol.t), 1e-12)
    assert np.abs(np.linalg.norm(sol.p, axis=1) - 1).max() < 1e-12
    assert np.abs(sol.energy_violation).max() < 1e-14


@pytest.mark.parametrize(("which", "name"), PAIRS)
def test_a_body_held_to_turn_about_one_axis(which, name):
    """Its own z axis stays upright: two holonomic constraints on four coordinates, and a rotation at a constant rate."""
    def upright(p):
        w, x, y, z = p
        return np.array([2 * (x * z + w * y), 2 * (y * z - w * x)])

    system = body(constraints=upright, v0=[0.0, 0.0, 2.0], quaternions=BODIES[which].quaternions)
    assert zd.check(system, system.p0, system.v0, samples=0)
    sol = zd.simulate(system, draws(0.5, 2.0), step=0.01, formulation=name)
    assert_close(sol.p, np.stack([np.cos(sol.t), 0 * sol.t, 0 * sol.t, np.sin(sol.t)], axis=1), 1e-9)
    assert np.abs(sol.position_violation).max() <= 1e-12


# ---- tools that choose formulations themselves ----


def test_the_core_says_which_formulations_suit():
    assert list(zd.formulations(body())) == SUITED
    assert list(zd.formulations(body(quaternions=[0]))) == FORMULATIONS


@pytest.mark.usefixtures("few_places")
@pytest.mark.parametrize("which", BODIES)
def test_a_reference_of_a_body(which):
    ref = zd.reference(BODIES[which], 0.5)
    assert np.abs(ref.solution.v - precession(ref.solution.t)).max() <= ref.velocity_error < 1e-12
    assert np.abs(ref.solution.p - attitude(ref.solution.t)).max() <= ref.error < 1e-12


@pytest.mark.usefixtures("few_places")
@pytest.mark.parametrize("which", BODIES)
def test_work_precision_takes_what_suits(which):
    found = zd.work_precision(BODIES[which], 0.2, integrators=["rk4"], steps=[0.1], rounds=1)
    assert [row.setting.formulation for row in found.rows] == list(zd.formulations(BODIES[which]))
    assert all(row.success and row.error < 1e-4 for row in found.rows)


@pytest.mark.usefixtures("few_places")
@pytest.mark.parametrize("chosen", [None, ["schur"], ["independent"]])
def test_tuning_a_body(chosen):
    system = BODIES["said to be one"]
    tuning = zd.tune(system, 0.2, error=1e-6, formulations=chosen, integrators=["rk4"], rounds=1)
    sol = zd.simulate(system, 0.2, **tuning.settings)
    assert np.abs(sol.v[-1] - precession(sol.t)[-1]).max() < 1e-5


@pytest.mark.usefixtures("few_places")
def test_the_stability_of_a_body():
    found = zd.stability_map(BODIES["said to be one"], 0.2, steps=[0.05], values=[1.0],
                             ways={name: {"formulation": name} for name in FORMULATIONS})
    assert all(found.survived(way).all() and found.error(way).max() < 1e-4 for way in found.rows)


@pytest.mark.usefixtures("few_places")
def test_a_singular_mass_matrix_suits_those_that_do_not_invert_it():
    """The second coordinate has no mass, and the first decides where it is: x = cos t."""
    def force(p):
        return np.array([-p[0], 0.0])

    system = zd.System(["x", "y"], mass=np.diag([1.0, 0.0]), force=force, constraints=lambda p: np.array([p[1] - p[0]**2]),
                       p0=[1.0, 1.0])
    found = zd.work_precision(system, 0.05, integrators=["rk4"], steps=[0.01], rounds=1)
    assert [row.setting.formulation for row in found.rows] == [name for name in FORMULATIONS if name != "schur"]
    assert all(row.error < 1e-4 for row in found.rows)
    with refused("mass-not-definite"):
        zd.work_precision(system, 0.05, formulations=["schur"], integrators=["rk4"], steps=[0.01], rounds=1)


def test_independent_coordinates_say_what_they_need():
    with pytest.raises(zd.UnsuitedFormulation, match="must have as many coordinates as velocities, not 4 and 3"):
        zd.simulate(body(), 1.0, step=0.1, formulation="independent")


def test_independent_coordinates_need_a_velocity_for_each_of_the_rest():
    """A rotor in the body, whose angle is not a coordinate: as many coordinates as velocities, and one of them is surplus."""
    system = zd.System(["e0", "e1", "e2", "e3"], mass=np.eye(4), quaternions=[0],
                       kinematics=lambda p: np.hstack([half_turns(p), np.zeros((4, 1))]), p0=[1.0, 0, 0, 0], v0=[1.0, 2, 3, 4])
    assert list(zd.formulations(system)) == SUITED
    with pytest.raises(zd.UnsuitedFormulation, match="besides one for each of 1 unit quaternions, not 4 and 4"):
        zd.simulate(system, 1.0, step=0.1, formulation="independent")
    assert_close(zd.simulate(system, 1.0, step=0.1).v[-1], system.v0, 1e-14)


# ---- how it is said ----


def symbolic(**changes):
    given = {"speeds": SPIN, "kinematics": turning(TURN, SPIN), "mass": sp.diag(*map(float, INERTIA)),
             "bias": gyroscopic(INERTIA), "quaternions": [TURN[0]],
             "p0": [1, 0, 0, 0], "v0": START, "name": "spinning body", "progress": False}
    return zd.symbolic(TURN, **(given | changes))


SOURCE = """
#include <zerodrift/system.h>
const int zd_interface_version = ZD_INTERFACE_VERSION;
static void write_A(const double *e, double *A)
{
    const double half[12] = {-e[1], -e[2], -e[3], e[0], -e[3], e[2], e[3], e[0], -e[1], -e[2], e[1], e[0]};
    for (int i = 0; i < 12; i++) A[i] = half[i] / 2;
}
int body(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const double *J = data;
    (void)t;
    if (want & ZD_A) write_A(p, out->A);
    for (int i = 0; (want & ZD_M) && i < 9; i++) out->M[i] = i % 4 ? 0 : J[i / 4];
    for (int i = 0; (want & ZD_BIAS) && i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out->d[i] = (J[k] - J[j]) * v[j] * v[k];
    }
    return ZD_DONE;
}
static const double initial[] = {1.0, 1.0, 0.4};
static const int first[] = {0};
static const zd_parameter parameter[] = {{"inertia", "kg m^2", "about its axes", 3, ZD_POSITIVE, initial}};
static const zd_variable coordinate[] = {{"e0", ""}, {"e1", ""}, {"e2", ""}, {"e3", ""}};
static const zd_variable velocity[] = {{"w1", "rad/s"}, {"w2", "rad/s"}, {"w3", "rad/s"}};
static const char *prepare(const double *parameters, double *constants)
{
    for (int i = 0; i < 3; i++) constants[i] = parameters[i];
    return 0;
}
static void start(const double *parameters, double *p, double *v)
{
    (void)parameters;
    for (int i = 0; i < 4; i++) p[i] = i == 0;
    v[0] = 0.3, v[1] = 0, v[2] = 2;
}
const zd_kind zd_kind_body = {
    .card = {"body", "A body.", "(1), (2)", 0},
    .system = {.nq = 4, .nv = 3, .provides = ZD_A | ZD_M | ZD_BIAS, .evaluate = body, .quaternions = 1, .quaternion = first},
    .parameters = 1, .constants = 3, .parameter = parameter, .coordinate = coordinate, .velocity = velocity, .prepare = prepare,
    .start = start,
};
"""


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return compile_text(SOURCE, tmp_path_factory.mktemp("body") / "body.so")


def native(library, **changes):
    given = {"symbol": "body", "terms": ["A", "M", "d"], "velocities": ["w1", "w2", "w3"], "quaternions": ["e0"],
             "parameters": {"A": 1.0, "B": 1.0, "C": 0.4}, "p0": [1.0, 0, 0, 0], "v0": START}
    return zd.native(library, ["e0", "e1", "e2", "e3"], **(given | changes))


@needs_compiler
def test_systems_of_every_origin_say_it(library):
    systems = [body(quaternions=["e0"]), symbolic(), symbolic(quaternions=[0]), symbolic(quaternions=["e0"]), native(library),
               zd.native(library, symbol="body", parameters={})]
    systems += [pickle.loads(pickle.dumps(system)) for system in systems[1:]]
    systems += [systems[0].with_parameters(), symbolic().starting(v0=START), native(library).with_parameters(A=1.0)]
    for system in systems:
        assert system.quaternions == (0,)
        sol = zd.simulate(system, 1.0, step=0.01, formulation="independent", integrator="dop853")
        assert_close(sol.p, attitude(sol.t), 1e-12)
        assert_close(sol.v, precession(sol.t), 1e-12)


def test_a_system_without_compiler_says_it(monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.warns(zd.NoCompilerWarning):
        system = symbolic(name="another")
    assert system.quaternions == (0,)


@pytest.mark.parametrize(("quaternions", "code", "match"), [
    ([1], "wrong-value", "quaternions must begin with four of the 4 coordinates each, not shared; not \\[1\\]"),
    ([0, 0], "wrong-value", "quaternions must begin with four"),
    (["q"], "unknown-choice", "quaternions.*'e0', 'e1', 'e2', 'e3', not 'q'"),
    ([-1], "out-of-range", "quaternions.*between 0"),
    ([0.0], "wrong-type", "quaternions.*not 0.0"),
    (0, "wrong-type", "quaternions.*not 0"),
], ids=str)
def test_what_is_none_is_refused(quaternions, code, match):
    with refused(code, match):
        body(quaternions=quaternions)


def test_a_quaternion_has_no_unit():
    with refused("wrong-value", "units of a quaternion must be those of pure numbers, and e3 has 'm'"):
        body(quaternions=[0], units=["", "", "", "m", "rad/s", "rad/s", "rad/s"])


def test_rates_of_a_quaternion_are_not_velocities():
    with refused("missing-argument"):
        zd.System(4, mass=np.eye(4), quaternions=[0])


def test_without_a_start_callables_are_tried_without_rotation():
    seen = []

    def kinematics(p):
        seen.append(np.array(p, dtype=float))
        return half_turns(p)

    body(quaternions=[0], kinematics=kinematics, p0=None)
    assert (np.array(seen) == [1, 0, 0, 0]).all()
