"""A compiled function moves as the built-in system does, to the last bit, wherever it comes from."""

import ctypes
import inspect
import pickle
import textwrap

import cffi
import numpy as np
import pytest
import scipy

import zerodrift as zd
from native_systems import GIVEN, address, built_in, compile_four_bar, motion, needs_compiler, of_ctypes
from support import assert_close, assert_same_bits, refused
from zerodrift.systems.native import INTERFACE_VERSION

pytestmark = needs_compiler


def of_cffi(library):
    ffi = cffi.FFI()
    ffi.cdef("typedef struct zd_terms zd_terms; int pendulum(const void *, int, double, const double *, const double *, "
             "const zd_terms *);")
    of_cffi.library = ffi.dlopen(str(library))
    return ffi.addressof(of_cffi.library, "pendulum")


SOURCES = {
    "ctypes": lambda library: (of_ctypes(library), {}),
    "cffi": lambda library: (of_cffi(library), {}),
    "scipy of ctypes": lambda library: (scipy.LowLevelCallable(of_ctypes(library)), {}),
    "address": lambda library: (address(library), {"version": INTERFACE_VERSION}),
    "library": lambda library: (library, {"symbol": "pendulum"}),
    "library as str": lambda library: (str(library), {"symbol": "pendulum"}),
}


@pytest.mark.parametrize("source", SOURCES)
def test_a_function_from_anywhere_moves_as_the_built_in_does(source, library, formulation):
    function, options = SOURCES[source](library)
    system = zd.native(function, ["x", "y"], **GIVEN, **options)
    for more in ({}, {"energy": True, "integrator": "dop853"}):
        assert_same_bits(motion(system, formulation=formulation, **more), motion(built_in(), formulation=formulation, **more))


def test_a_capsule_is_known_by_its_signature(library):
    """A capsule as Cython exports it, here made by hand."""
    new = ctypes.pythonapi.PyCapsule_New
    new.restype, new.argtypes = ctypes.py_object, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
    name = b"int (void *, int, double, double *, double *, void *)"
    capsule = new(address(library), name, None)
    system = zd.native(scipy.LowLevelCallable(capsule), ["x", "y"], **GIVEN)
    assert_same_bits(motion(system), motion(built_in()))
    other = b"double (double, void *)"
    with refused("compiled-function", r"the LowLevelCallable is double \(double, void \*\), and must be int \(const void"):
        zd.native(scipy.LowLevelCallable(new(address(library), other, None)), ["x", "y"], **GIVEN)


@pytest.mark.parametrize("source", ["ctypes", "cffi", "scipy of ctypes", "address"])
def test_pointers_are_not_pickled(source, library):
    function, options = SOURCES[source](library)
    system = zd.native(function, ["x", "y"], **GIVEN, **options)
    with refused("not-portable"):
        pickle.dumps(system)


# ---- libraries that describe themselves ----


@pytest.fixture(scope="module")
def bar_library(tmp_path_factory):
    return compile_four_bar(tmp_path_factory.mktemp("native") / "four_bar.so")


def test_a_library_that_describes_its_system(bar_library, bar, formulation):
    mine = zd.native(bar_library, symbol="four_bar")
    assert (mine.coordinates, mine.velocities, mine.constraints) == (bar.coordinates, bar.velocities, bar.constraints)
    assert np.array_equal(mine.points(mine.p0), bar.points(bar.p0))
    assert mine._core.timeless      # ZD_TIMELESS is among what it provides
    options = {"step": 0.02, "formulation": formulation, "energy": True}
    assert_same_bits(zd.simulate(mine, 2.0, **options), zd.simulate(bar, 2.0, **options))


def test_parameters_of_a_kind(library):
    system = zd.native(library, symbol="pendulum", parameters={"length": 2.0})
    assert np.array_equal(system.p0, [2.0, 0.0])
    assert system.parameters == {"mass": 1.0, "gravity": 9.81, "length": 2.0}
    assert system.constraints == built_in().constraints
    assert "length" in repr(system)


@pytest.mark.parametrize(("parameters", "code", "message"), [
    ({"lenght": 1.0}, "wrong-name", "'lenght'"),
    ({"length": -1.0}, "out-of-range", "length.*not -1.0"),
    ({"gravity": 1e3}, "wrong-value", "pendulum: gravity must be at most 100"),
])
def test_wrong_parameters_of_a_kind(parameters, code, message, library):
    with refused(code, message):
        zd.native(library, symbol="pendulum", parameters=parameters)


def test_a_saved_motion_is_not_taken_for_that_of_a_built_in_system(library, tmp_path):
    sol = motion(zd.native(library, symbol="pendulum"))
    again = zd.load(sol.save(tmp_path / "motion"))
    assert np.array_equal(again.p, sol.p)
    with refused("wrong-type", "description of pendulum"):
        zd.simulate(again.system, 1.0, step=0.1)


# ---- numba ----


@pytest.fixture(scope="module")
def module():
    pytest.importorskip("numba")
    import numba_pendulum

    return numba_pendulum


def test_numba(module, formulation):
    system = zd.native(module.compiled, ["x", "y"], **GIVEN)
    ours, theirs = motion(system, formulation=formulation), motion(built_in(), formulation=formulation)
    assert_close(ours.p, theirs.p, 1e-12)       # numba may contract a product and a sum
    assert zd.check(system)


def test_pickling_what_numba_compiled(module):
    """By compiling the function again, or by importing what was compiled when its module was."""
    system = zd.native(module.compiled, ["x", "y"], **GIVEN)
    assert_same_bits(motion(pickle.loads(pickle.dumps(system))), motion(system))
    imported = zd.native(module.decorated, ["x", "y"], **(GIVEN | {"p0": None}))
    with refused("evaluation-failed"):
        motion(pickle.loads(pickle.dumps(imported)))
    hidden = zd.native(module.local(), ["x", "y"], **(GIVEN | {"p0": None}))
    with pytest.raises(TypeError, match="cannot be pickled: numba would have to find its Python function at the top of"):
        pickle.dumps(hidden)


def test_a_cfunc_of_another_signature(module):
    with pytest.raises(TypeError, match=r"the numba\.cfunc is double \(double\), and must be int .*numba_signature\(\)"):
        zd.native(module.other, ["x", "y"], **GIVEN)


def test_the_example_of_the_docstring():
    pytest.importorskip("numba")
    code = inspect.getdoc(zd.native).partition("with numba::\n")[2].partition("\nMatrices are")[0]
    scope = {"zd": zd}
    # numba wants the source of what it compiles only to cache it
    exec(compile(textwrap.dedent(code), "example", "exec"), scope)
    sol = zd.simulate(scope["system"], 1.0, step=0.001)
    assert_close(sol.p[-1], np.cos([2.0]), 1e-10)
