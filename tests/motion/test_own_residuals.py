"""Derivatives of residuals that a system provides: for Radau's method and the analyses, and differences where it refuses."""

import ctypes

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from native_systems import PENDULUM, compile_text, needs_compiler
from support import assert_close
from zerodrift._private.gateway.compiled.functions import load_library

pytestmark = needs_compiler

# Of M vdot - f + C^T lambda, C vdot - xi and C v with C = p / L, xi = -v v / L, by hand
SOURCE = f"""
#include "{PENDULUM}"

int calls, refuses;

static int residuals(const void *data, const double *inputs, double t, const double *p, const double *v, const double *vdot,
                     const double *lambda, int directions, const zd_direction *along, const zd_derivatives *of, double *scratch)
{{
    const double L = ((const double *)data)[2];
    (void)inputs, (void)t;
    calls++;
    scratch[0] = directions;
    for (int k = 0; k < directions; k++) {{
        double s = 0, Psi = 0;
        for (int i = 0; i < 2; i++) {{
            const double dp = along[k].p ? along[k].p[i] : 0, dv = along[k].v ? along[k].v[i] : 0;
            if (of[k].dynamics) of[k].dynamics[i] = lambda[0] * dp / L;
            if (of[k].rates) of[k].rates[i] = dv;
            s += (dp * vdot[i] + 2 * v[i] * dv) / L;
            Psi += (dp * v[i] + p[i] * dv) / L;
        }}
        if (of[k].accelerations) of[k].accelerations[0] = s;
        if (of[k].velocities) of[k].velocities[0] = Psi;
        if (of[k].power) of[k].power[0] = 0;
    }}
    return refuses;
}}

static const zd_residuals own = {{1, residuals}};
const zd_kind zd_kind_swing = {{
    .card = {{"swing", "Point mass on a rod.", "", 0, 0}},
    .system = {{
        .nq = 2, .nv = 2, .mh = 1,
        .provides = ZD_M | ZD_FORCE | ZD_PHI | ZD_C | ZD_XI | ZD_POTENTIAL,
        .evaluate = pendulum, .residuals = &own,
    }},
    .parameters = 3, .constants = 3,
    .parameter = parameter, .coordinate = coordinate, .velocity = velocity, .constraint = constraint,
    .prepare = prepare, .start = start,
}};
"""


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return compile_text(SOURCE, tmp_path_factory.mktemp("own") / "swing.so")


@pytest.fixture
def numbers(library):
    """Its counter of calls, and whether they are refused."""
    of = load_library(library)      # as the system, of which a copy is loaded
    calls, refuses = (ctypes.c_int.in_dll(of, name) for name in ("calls", "refuses"))
    calls.value = refuses.value = 0
    yield calls, refuses
    refuses.value = 0


def test_radau_takes_them(library, numbers, formulation):
    """The run is that of the built-in pendulum, by differences; refused ones count as evaluations besides the differences."""
    calls, refuses = numbers
    options = {"rtol": 1e-8, "atol": 1e-8, "integrator": "radau", "formulation": formulation}
    other = zd.simulate(zd.systems.pendulum(), 2.0, [1.0, 0.0], [0.0, 0.0], **options)
    evaluations = []
    for refuses.value in (0, 1):
        calls.value = 0
        found = zd.simulate(zd.native(library, symbol="swing"), 2.0, [1.0, 0.0], [0.0, 0.0], **options)
        assert calls.value > 0
        assert np.abs(found.p[-1] - other.p[-1]).max() < 1e-7
        evaluations.append(found.stats["evaluations"])
    assert evaluations[0] < evaluations[1]


def test_the_analyses_take_them(library, numbers):
    """The frequency of small oscillations, sqrt(g / L) of a pendulum that hangs at rest."""
    calls, refuses = numbers
    for refuses.value, tolerance in ((0, tol.EXACT), (1, tol.DIFFERENCE)):
        calls.value = 0
        hanging = zd.linearize(zd.native(library, symbol="swing"), (0.0, np.array([0.0, -1.0]), np.zeros(2)))
        assert calls.value > 0
        assert_close(hanging.frequencies, np.full(2, np.sqrt(9.81) / (2 * np.pi)), tolerance)
