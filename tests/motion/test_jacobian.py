"""Derivatives of what is integrated in independent velocities against differences of its rates, which share none of it."""

import ctypes
import subprocess

import numpy as np
import pytest
import sympy

import tolerances as tol
import zerodrift as zd
from core_objects import CC, CSRC, needs_compiler
from random_symbolic import random_system
from support import ROOT, along, assert_close, consistent_states
from zerodrift._private.core import ffi
from zerodrift.analysis.derivatives import Derivatives, jacobian
from zerodrift.analysis.state import state as terms_at
from zerodrift.analysis.tangent import Tangent

FORMULATIONS = ("independent", "mixed", "schur")        # in the order of state_jacobian.c
ROOMS = ("motion", "formulations", "point", "constraints", "linalg")
pytestmark = needs_compiler


@pytest.fixture(scope="module")
def core(tmp_path_factory):
    """These rooms of the core, and what opens them."""
    path = tmp_path_factory.mktemp("jacobian") / "core.so"
    sources = [each for room in ROOMS for each in sorted((CSRC / room).rglob("*.c"))]
    subprocess.run([CC, "-O0", "-std=c11", "-ffp-contract=off", "-fPIC", "-shared", "-o", path, *sources, CSRC / "workspace.c",
                    ROOT / "tests" / "motion" / "state_jacobian.c", "-lm"], check=True)
    library = ctypes.CDLL(str(path))
    library.start.restype = ctypes.POINTER(ctypes.c_double)
    return library


def pointer(array):
    """As C is handed it."""
    return array.ctypes.data_as(ctypes.c_void_p)


class Integrated:
    """Variables of a system, its own Jacobian with it or not, that a formulation integrates, from a given state on."""

    def __init__(self, core, system, formulation, t, p, v, *, has_own=True):
        self.core, self.t = core, ctypes.c_double(t)
        self.system = system._with_jacobian(system._core) if has_own else system._core
        address = ctypes.c_void_p(int(ffi.cast("uintptr_t", self.system.c)))
        assert core.begin(address, FORMULATIONS.index(formulation), self.t, pointer(np.array(p)), pointer(np.array(v))) == 0
        self.y = np.array(core.start()[:core.size()])

    def rate(self, y):
        """Its rate, (size,)."""
        ydot = np.zeros(len(y))
        assert self.core.rate(self.t, pointer(np.array(y)), pointer(ydot)) == 0
        return ydot

    def jacobian(self):
        """As the core finds it, (size, size)."""
        J = np.full((len(self.y), len(self.y)), np.nan)
        assert self.core.jacobian(self.t, pointer(self.y), pointer(J)) == 0
        return J

    def by_differences(self):
        return np.transpose([along(self.rate, (self.y, direction)) for direction in np.eye(len(self.y))])

    def assert_is_exact(self):
        """Beside differences."""
        assert_close(self.jacobian(), self.by_differences(), 10 * tol.DIFFERENCE)


both = pytest.mark.parametrize("kind", ["mixed", "independent"])


@both
@pytest.mark.parametrize("seed", range(0, 12, 2))
def test_of_random_systems(core, kind, seed):
    """Rows that move, nonholonomic ones and a kinematic matrix among them, and energy that comes in."""
    system = random_system(seed)
    for t, p, v in consistent_states(system, count=2):
        Integrated(core, system, kind, t, p, v).assert_is_exact()


@both
def test_where_a_row_moves_by_more_the_farther_out(core, kind):
    """A bead on a wire that turns and bends: Phi_t depends on p."""
    t, x, y, vx, vy = sympy.symbols("t x y vx vy")
    system = zd.symbolic([x, y], speeds=[vx, vy], kinetic=(vx**2 + 2 * vy**2) / 2, potential=9.81 * y, time=t,
                         constraints=[y * sympy.cos(t) - x * sympy.sin(t) - t * x**2], p0=[1.0, 0.0], v0=[0.0, 2.0])
    for state in consistent_states(system, count=2):
        Integrated(core, system, kind, *state).assert_is_exact()


@both
@pytest.mark.parametrize("seed", [0, 1, 2, 8])
def test_where_a_constraint_is_redundant(core, kind, seed):
    system = random_system(seed, apart=0.0)
    for t, p, v in consistent_states(system, count=1):
        Integrated(core, system, kind, t, p, v).assert_is_exact()


def pendulums(upper):
    """Two in space, the upper one on a ball or on a pin, whose turns are counted in absolute coordinates."""
    m = zd.Mechanism("pendulums", dimension=3, gravity=(0, 1, -9.81))
    arm, rod = m.body("arm", 1.0, (0.02, 0.03, 0.04), at=(0.3, 0.1, 0)), m.body("rod", 0.5, (0.02, 0.03, 0.01), at=(0.6, 0.3, 0))
    if upper == "pin":
        m.revolute("shoulder", m.ground, arm, at=(0, 0, 0), axis=(0, 1, 0.2))
    else:
        m.spherical("shoulder", m.ground, arm, at=(0, 0, 0))
    m.spherical("elbow", arm, rod, at=(0.5, 0.2, 0))
    return m


@both
@pytest.mark.parametrize(("upper", "coordinates"), [("ball", "absolute"), ("pin", "absolute"), ("pin", "joint")])
def test_with_unit_quaternions(core, kind, upper, coordinates):
    """For which `independent` has increments, from its tangents as from the state itself."""
    system = pendulums(upper).system(coordinates, compiled=True)
    for t, p, v in consistent_states(system, count=2):
        Integrated(core, system, kind, t, p, v).assert_is_exact()


# ---- systems without a Jacobian of their own: derivatives of the residuals, for Radau's method and for the analyses ----


def bushed_crank(*, compiled=False):
    """Two links whose pin gives: stiff, but not beyond differences."""
    m = zd.Mechanism("crank", gravity=(0, -9.81))
    crank, rod = m.link("crank", (0, 0), (0.1, 0), mass=0.5), m.link("rod", (0.1, 0), (0.4, 0.1), mass=0.3)
    m.revolute("main", m.ground, crank.start)
    m.bushing("pin", crank.end, rod.start, stiffness=1e5, damping=1e2)
    m.slot("cylinder", m.ground, rod.end, axis=(1, 0))
    return m.system("absolute", compiled=compiled)


def four_bar(*, compiled=False):
    return zd.models.four_bar().system("absolute", compiled=compiled)


def disc(*, compiled=False):
    """Nonholonomic rows and a kinematic matrix: a body that rolls on a plane."""
    return zd.models.rolling_disc().system("joint", compiled=compiled)


@pytest.mark.parametrize("make", [four_bar, bushed_crank, disc])
def test_radau_and_the_analyses_use_one_derivative(core, make):
    """Derivatives of residuals: by differences of first order for Radau's iteration, 1e-6, of eighth for `check` and `linearize`.
    Beside differences of rates, and beside the compiled Jacobian of the same mechanism.
    """
    system, exact = make(), make(compiled=True)
    for t, p, v in consistent_states(system, count=1):
        for formulation in FORMULATIONS:
            found = Integrated(core, system, formulation, t, p, v, has_own=False)
            assert_close(found.jacobian(), found.by_differences(), 1e-6, what=formulation)
        tangent = Tangent(terms_at(system, t, p, v))
        assert jacobian(tangent.at) is None
        dp, dv = np.split(tangent.basis.T, [system.nq], axis=1)
        along_tangents = Derivatives(tangent, *zd.acceleration(system, p, v, t)).of_accelerations(dp, dv)
        assert_close(along_tangents, jacobian(terms_at(exact, t, p, v)) @ np.hstack([dp, dv]).T, tol.DIFFERENCE)
