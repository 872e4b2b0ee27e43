"""Systems that are not what they say: a mass matrix that loses its symmetry, a Jacobian that is not that of the constraints."""

import re

import numpy as np
import pytest

import zerodrift as zd
from covering import draws
from every_model import MODELS
from native_systems import compile_text, needs_compiler
from support import BUILT_IN, motion, refused

WAYS = {"fixed": {"step": 0.01}, "chosen": {"rtol": 1e-8, "atol": 1e-8, "integrator": "dop853"}}
WRONG_ROW = r"row 0 of the Jacobian, for velocity 1, must be the derivative of the constraint"


@pytest.fixture(params=WAYS)
def way(request):
    return WAYS[request.param]


def pendulum(jacobian=None, constraints=lambda p: np.array([(p @ p - 1) / 2]), **options):
    return zd.System(["x", "y"], **({"mass": np.eye(2), "force": [0.0, -9.81], "constraints": constraints, "jacobian": jacobian,
                                     "p0": [1.0, 0.0]} | options))


# ---- M ----


def test_symmetry_that_is_lost_later_stops_the_run(formulation, way):
    """Formulations used to disagree in silence."""
    system = pendulum(mass=lambda t: np.array([[1.0, 0.3 * (t > 0.5)], [0.0, 1.0]]))
    with refused("mass-not-symmetric", r"M\[1, 0\] = 0, .* = 0\.3 \[zd:") as caught:
        zd.simulate(system, 3.0, formulation=formulation, **way)
    found = re.match(r"at t = ([0-9.]+) \(step", caught.value.solution.message)
    assert 0.5 < float(found[1]) < 1.5


@pytest.mark.parametrize("scale", [1.0, 1e-6, 1e6])
def test_rounding_is_not_an_asymmetry_and_a_low_inertia_component_may_have_none(scale):
    """1e-10 of an entry is rounding, a thousandth is not, however light the part is that the entry belongs to."""
    def mass(t, relative):
        light = 1e-6 * scale
        return np.array([[scale, 0, 0], [0, light, 0.5 * light * (1 + relative * (t > 0.1))], [0, 0.5 * light, light]])

    for relative, fails in ((1e-10, False), (1e-3, True)):
        system = zd.System(3, mass=mass, p0=np.zeros(3), v0=np.ones(3), parameters={"relative": relative})
        sol = zd.simulate(system, 0.5, step=0.01, on_failure="return")
        assert ("not symmetric: M[2, 1]" in sol.message) == fails


# ---- the Jacobian ----

WRONG_LATER = {
    "sign": lambda p: np.array([[p[0], -p[1]]]), "percent": lambda p: np.array([[p[0], 1.01 * p[1]]]),
    "from a time on": lambda t, p: np.array([[p[0], p[1] + (t > 0.5)]]),
}


@pytest.mark.parametrize("wrong", WRONG_LATER)
def test_a_wrong_jacobian_stops_the_run(wrong, formulation, way):
    """The first two are right at the start, where y = 0, and wrong later."""
    with refused("wrong-jacobian", WRONG_ROW) as caught:
        zd.simulate(pendulum(WRONG_LATER[wrong]), 3.0, formulation=formulation, **way)
    assert isinstance(caught.value, ValueError)


def test_at_the_start_it_is_refused():
    with refused("wrong-jacobian", r"row 0 .* velocity 0, .*: it is 2, and differences .* give 1 \[zd:"):
        zd.simulate(pendulum(lambda p: 2 * p[None, :]), 1.0, step=0.01)


def by_differences(p, e=1e-6):
    return np.array([[(((p + e * d) @ (p + e * d)) - p @ p) / (2 * e) for d in np.eye(2)]])


ROUGH = {
    "differences": (by_differences, lambda p: np.array([(p @ p - 1) / 2])),
    "kinks": (lambda p: p[None, :] * (1 + 1e-4 * np.sign(np.sin(1e4 * p[0]))), lambda p: np.array([(p @ p - 1) / 2])),
    "coarsely rounded": (lambda p: p[None, :], lambda p: np.array([np.round((p @ p - 1) / 2, 7)])),
    "single precision": (lambda p: p[None, :], lambda p: np.array([np.float64(np.float32(p @ p)) - 1]) / 2),
}


@pytest.mark.parametrize("rough", ROUGH)
def test_rough_functions_do_not_contradict(rough, way):
    jacobian, constraints = ROUGH[rough]
    projection = zd.Projection(tol=1e-6)
    options = {"xi": lambda v: np.array([-v @ v]), "stabilization": projection}
    system = pendulum(jacobian, constraints, xi=options.pop("xi"))
    sol = zd.simulate(system, 2.0, on_failure="return", **options, **way)
    assert "Jacobian" not in sol.message
    if "step" in way:
        assert sol.success


def quadratic(rng, factor=1.0):
    """A random system with quadratic constraints and their Jacobian, one entry of it multiplied by a factor; that entry."""
    n = int(rng.integers(2, 7))
    m = int(rng.integers(1, n))
    linear, quad = rng.normal(size=(m, n)), 0.2 * rng.normal(size=(m, n, n))
    quad = quad + quad.transpose(0, 2, 1)
    p0, k, i = rng.normal(size=n), int(rng.integers(m)), int(rng.integers(n))
    at_start = linear @ p0 + quad @ p0 @ p0 / 2
    root = rng.normal(size=(n, n))

    def jacobian(p):
        C = linear + quad @ p
        C[k, i] *= factor
        return C

    return zd.System(n, mass=root @ root.T + np.eye(n), force=lambda p: -p, p0=p0, jacobian=jacobian,
                     constraints=lambda p: linear @ p + quad @ p @ p / 2 - at_start), (k, i)


@pytest.mark.parametrize("seed", range(draws(12, 40)))
def test_random_jacobians(seed):
    """Right ones are let alone; one entry that is off by a third is found and named."""
    system, _ = quadratic(np.random.default_rng(seed))
    assert "Jacobian" not in zd.simulate(system, 1.0, step=0.01, on_failure="return").message
    system, (row, column) = quadratic(np.random.default_rng(seed), 4 / 3)
    with refused("wrong-jacobian", f"row {row} of the Jacobian, for velocity {column}, "):
        zd.simulate(system, 1.0, step=0.01)


@pytest.mark.parametrize("name", [*BUILT_IN, *MODELS])
def test_what_is_derived_would_pass(name):
    """Built-in and symbolic systems are not looked at; looked at they show no contradiction."""
    system, h = (BUILT_IN[name], 1e-3) if name in BUILT_IN else (MODELS[name](), 2e-5)
    assert not system._core.given_jacobian
    system._core.given_jacobian = True
    try:
        sol = motion(system, 300 * h, 300)
    finally:
        system._core.given_jacobian = False
    assert sol.success


def test_it_costs_hardly_anything():
    """Two evaluations of Phi in 64 steps, and a few as the run begins."""
    count = 0

    def constraints(p):
        nonlocal count
        count += 1
        return np.array([(p @ p - 1) / 2])

    options = {"xi": lambda v: np.array([-v @ v])}
    found = []
    for jacobian in (lambda p: p[None, :], lambda p: p[None, :]):
        system = pendulum(jacobian, constraints, **options)
        system._core.given_jacobian = not found
        count = 0
        zd.simulate(system, 10.0, step=0.01)
        found.append(count)
    assert 0 < found[0] - found[1] <= 2 * (1000 // 64 + 12)


DRIVEN = """
#include <math.h>
#include <zerodrift/system.h>
const int zd_interface_version = ZD_INTERFACE_VERSION;

int driven(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const double *q = data;
    (void)v;
    if (want & ZD_M) out->M[0] = out->M[3] = 1, out->M[1] = out->M[2] = 0;
    if (want & ZD_FORCE) out->f[0] = 0, out->f[1] = -p[1];
    if (want & ZD_PHI) out->Phi[0] = p[0] - 0.3 * sin(t) + q[0] * sin(p[1]);
    if (want & ZD_C) out->C[0] = 1, out->C[1] = q[1] * cos(p[1]);
    if (want & ZD_PHI_T) out->Phi_t[0] = -q[2] * cos(t);
    if (want & ZD_XI) out->xi[0] = -0.3 * sin(t) + q[0] * sin(p[1]) * v[1] * v[1];
    return ZD_DONE;
}
"""


@needs_compiler
@pytest.mark.parametrize(("wrong", "says"), [
    ({}, None), ({"slope": 0.2}, WRONG_ROW), ({"slope": 0.0}, WRONG_ROW),
    ({"speed": 0.31}, r"row 0 of Phi_t must be the derivative of the constraint: it is -0\.3"),
])
def test_of_native_systems_the_derivative_by_time_is_looked_at_too(tmp_path, wrong, says, way):
    library = compile_text(DRIVEN, tmp_path / "driven.so")
    parameters = {"bend": 0.1, "slope": 0.1, "speed": 0.3} | wrong
    terms = ["M", "f", "Phi", "C", "xi", "Phi_t"]
    system = zd.native(library, ["x", "y"], symbol="driven", terms=terms, constraints=1, parameters=parameters, p0=[0.0, 0.0],
                       v0=[parameters["speed"], 0.0])
    if says is None:
        assert zd.simulate(system, 3.0, **way).success
    else:
        with refused("wrong-jacobian", says):
            zd.simulate(system, 3.0, **way)
