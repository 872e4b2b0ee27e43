"""Errors of compiled functions name the cause: when the system is made, and where a term is not finite later."""

import ctypes

import cffi
import numpy as np
import pytest
import scipy

import zerodrift as zd
from native_systems import GIVEN, PENDULUM, TERMS, address, compile_text, motion, needs_compiler, of_ctypes, pendulum
from support import refused
from zerodrift.systems.native import SLOT

pytestmark = needs_compiler


# ---- when a system is made ----


def another_version(library):
    text = PENDULUM.read_text().replace("= ZD_INTERFACE_VERSION", "= ZD_INTERFACE_VERSION + 1")
    return pendulum(compile_text(text, library.parent / "newer.so"))


def no_version(library):
    text = PENDULUM.read_text().replace("const int zd_interface_version = ZD_INTERFACE_VERSION;", "")
    return pendulum(compile_text(text, library.parent / "versionless.so"))


def no_library(library):
    (library.parent / "text.so").write_text("not a library")
    return pendulum(library.parent / "text.so")


def untyped(library):
    return zd.native(ctypes.CDLL(str(library)).pendulum, ["x", "y"], **GIVEN)


def other_ctypes(library):
    return zd.native(ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(abs), ["x", "y"], **GIVEN)


def other_cffi(library):
    ffi = cffi.FFI()
    return zd.native(ffi.cast("double (*)(double)", 1), ["x", "y"], **GIVEN)


def with_user_data(library):
    data = ctypes.cast(ctypes.create_string_buffer(8), ctypes.c_void_p)
    return zd.native(scipy.LowLevelCallable(of_ctypes(library), data), ["x", "y"], **GIVEN)


WRONG = [
    (another_version, ValueError, r"zd_interface_version of .*newer\.so is 13, and this core has version 12 of the "),
    (no_version, ValueError, r"versionless\.so must declare its version of the interface by the line"),
    (no_library, ValueError, r"text\.so must be a shared library that can be loaded here: "),
    (lambda lib: pendulum(lib.parent / "none.so"), FileNotFoundError, r"the shared library must exist: .*none\.so"),
    (lambda lib: pendulum(lib, "pendulums"), ValueError, r"pendulum\.so has no symbol 'pendulums'"),
    (lambda lib: pendulum(lib, None), TypeError, "symbol must be the name of a function in .*, not None"),
    (lambda lib: pendulum(lib, version=1), TypeError, "version must be left out: a library declares zd_"),
    (untyped, TypeError, "argtypes and restype of .* must be set, as of a int"),
    (other_ctypes, TypeError, r"the ctypes function is double \(double\), and must be int \(const void \*data, int want"),
    (other_cffi, TypeError, r"the cffi function is double \(double\), and must be int"),
    (with_user_data, ValueError, "the LowLevelCallable must have no user_data"),
    (lambda lib: zd.native(address(lib), 2, **GIVEN), TypeError, "version must be given with an address: .* has 12"),
    (lambda lib: zd.native(address(lib), 2, version=13, **GIVEN), ValueError, "version is 13, and this core has version 12"),
    (lambda lib: zd.native(0, 2, version=12, **GIVEN), ValueError, "function must be the address of a function, not 0"),
    (lambda lib: zd.native(abs, 2, **GIVEN), TypeError, "function must be the path of a shared library, an address"),
    (lambda lib: zd.native(address(lib), 2, version=12, symbol="f", **GIVEN), TypeError, "symbol names a function of a"),
    (lambda lib: pendulum(lib, terms=None), TypeError, "terms must be given with coordinates"),
    (lambda lib: pendulum(lib, terms=["M", "F"]), ValueError, "terms must be one of 'A', 'M', .*, not 'F'"),
    (lambda lib: pendulum(lib, terms=["M", "f", "C"]), ValueError, "terms must have Phi, xi, with 1 holonomic of 1"),
    (lambda lib: pendulum(lib, constraints=0), ValueError, "terms cannot have Phi, with 0 holonomic of 0 constraints"),
    (lambda lib: pendulum(lib, terms=[*TERMS, "D"]), ValueError, "terms must have both D and gamma, or neither"),
    (lambda lib: pendulum(lib, velocities=3), ValueError, "velocities must be as many as coordinates, 2, unless"),
    (lambda lib: pendulum(lib, p0=[1.0]), ValueError, r"p0 must have shape \(2,\), not \(1,\)"),
    (lambda lib: pendulum(lib, parameters={"mass": "1"}), TypeError, "mass must be a real number, not '1'"),
    # tried at the start
    (lambda lib: pendulum(lib, terms=[*TERMS, "d"]), ValueError,
     r"it leaves d\[0\] unwritten, and d of shape \(2,\) is among its terms"),
    (lambda lib: zd.native(lib, 3, symbol="pendulum", **(GIVEN | {"p0": [1.0, 0.0, 0.0]})), ValueError,
     r"it leaves M\[1, 1\] unwritten, and M of shape \(3, 3\) is among its terms"),
    (lambda lib: pendulum(lib, constraints=2), ValueError, r"it leaves Phi\[1\] unwritten"),
    (lambda lib: pendulum(lib, terms=["M", "Phi", "C", "xi"], symbol="deaf"), ValueError,
     "it writes power, which is not among its terms"),
    (lambda lib: pendulum(lib, symbol="beyond_its_force"), ValueError,
     r"it writes beyond f, which is of shape \(2,\)"),
    (lambda lib: pendulum(lib, "spoilt", parameters=GIVEN["parameters"] | {"from": 0.0, "term": 12.0}),
     zd.ZerodriftError, "it reports a failure at the start"),
    # libraries that describe themselves
    (lambda lib: zd.native(lib, symbol="four_bar"), ValueError, r"pendulum\.so has no symbol 'zd_kind_four_bar'"),
    (lambda lib: zd.native(lib, symbol="without_a_start"), ValueError,
     r"zd_kind_without_a_start of .*pendulum\.so: its start is missing"),
    (lambda lib: zd.native(lib, symbol="pendulum", terms=["M"]), TypeError,
     "terms must be left out without coordinates: zd_kind_pendulum declares it"),
    (lambda lib: zd.native(address(lib)), TypeError, "coordinates must be given: only a shared library can describe"),
]


@pytest.mark.parametrize(("make", "error", "message"), WRONG, ids=range(len(WRONG)))
def test_what_is_wrong(make, error, message, library):
    with pytest.raises(error, match=message):
        make(library)


# ---- terms that are not finite, later ----


SPOILT = ["A", "M", "d", "f", "Phi", "C", "Phi_t", "xi", "V", "power"]      # what `spoilt` of native/pendulum.c writes


def spoilt(library, term, moment=1.0):
    extra = [name for name in ("A", "d", "Phi_t", "power") if name == term]
    return pendulum(library, "spoilt", terms=[*TERMS, *extra],
                    parameters=GIVEN["parameters"] | {"from": moment, "term": SLOT._asdict().get(term, 12)})


@pytest.mark.parametrize("term", SPOILT)
def test_a_term_that_is_not_finite_is_named(term, library, formulation):
    message = rf"^at t = 1(\.\d+)? \(step 10\d of 200\): the system's {term} must be finite \[zd:"
    with pytest.raises(zd.ZerodriftError, match=message) as caught:
        motion(spoilt(library, term), formulation=formulation)
    sol = caught.value.solution
    assert 0.98 < sol.t[-1] <= 1.0
    for values in (sol.p, sol.v, sol.energy_violation):
        assert np.isfinite(values).all()
    unspoilt = motion(spoilt(library, term, 9.0), formulation=formulation)
    assert np.array_equal(sol.p, unspoilt.p[:len(sol.t)])


@pytest.mark.parametrize("term", ["M", "f", "C", "Phi_t", "xi", "A"])
def test_where_steps_are_adaptive_too(term, library, integrator):
    if not zd.integrators()[integrator].error_order:
        return
    with refused("term-not-finite", rf"^at t = 1(\.\d+)? .* {term} "):
        zd.simulate(spoilt(library, term), 2.0, rtol=1e-8, integrator=integrator)


@pytest.mark.parametrize("term", ["M", "C", "Phi"])
def test_a_term_that_is_not_finite_at_the_start(term, library):
    system = spoilt(library, term, 0.0)
    with refused("term-not-finite", f" {term} "):
        zd.simulate(system, 1.0, step=0.1)


@pytest.mark.parametrize("term", ["M", "C", "f", "xi"])
def test_outside_a_run(term, library):
    with refused("term-not-finite", f" {term} "):
        zd.acceleration(spoilt(library, term), [1.0, 0.0], [0.0, 0.0], t=1.0)


def test_a_failure_that_the_function_reports(library):
    """Whatever number it returns: a positive one does not mean that the run is merely paused."""
    with refused("evaluation-failed", r"^at t = .* \(step 10\d of 200\)") as caught:
        motion(spoilt(library, "failure"))
    assert 0.98 < caught.value.solution.t[-1] <= 1.0
