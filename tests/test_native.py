"""Compiled functions as systems: the same bits as built-in ones, wherever they come from; and what is wrong, by name."""

import concurrent.futures
import ctypes
import multiprocessing
import os
import pickle
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

import cffi
import numpy as np
import pytest
import scipy

import zerodrift as zd
from support import assert_close
from zerodrift.compiled import BIT, INTERFACE_VERSION, SLOT

HERE = Path(__file__).resolve().parent
COMPILER = shutil.which(os.environ.get("CC", "cc"))
pytestmark = pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")

TERMS = ["M", "f", "Phi", "C", "xi", "V"]
GIVEN = {"terms": TERMS, "constraints": ["rod"], "parameters": {"mass": 1.0, "gravity": 9.81, "length": 1.0}, "p0": [1.0, 0.0]}
POINTER = ctypes.POINTER(ctypes.c_double)
PROTOTYPE = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_int, ctypes.c_double, POINTER, POINTER, ctypes.c_void_p)


def compile_library(source, library, *options):
    subprocess.run([COMPILER, "-shared", "-fPIC", "-O2", "-std=c11", "-ffp-contract=off", "-Wall", "-Wextra", "-Wpedantic",
                    "-Werror", *options, "-I", zd.get_include(), "-o", library, source, "-lm"], check=True)
    return library


def compile_text(text, library, *options):
    source = library.with_suffix(".c")
    source.write_text(text)
    return compile_library(source, library, *options)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("native")


@pytest.fixture(scope="module")
def library(folder):
    return compile_library(HERE / "native" / "pendulum.c", folder / "pendulum.so")


def pendulum(library, symbol="pendulum", **changes):
    return zd.native(library, ["x", "y"], symbol=symbol, **(GIVEN | changes))


def built_in():
    return zd.systems.pendulum(angle=np.pi / 2)


def motion(system, **options):
    """Of a pendulum, from exactly the same place."""
    return zd.simulate(system, 2.0, [1.0, 0.0], [0.0, 0.0], step=0.01, **options)


def same_bits(sol, other):
    for name in ("t", "p", "v", "multipliers", "position_violation", "kinetic_energy", "energy_violation"):
        assert np.array_equal(getattr(sol, name), getattr(other, name)), name


# ---- wherever it comes from ----


def of_ctypes(library):
    function = ctypes.CDLL(str(library)).pendulum
    function.restype, function.argtypes = ctypes.c_int, PROTOTYPE._argtypes_
    return function


def of_cffi(library):
    ffi = cffi.FFI()
    ffi.cdef("typedef struct zd_terms zd_terms; int pendulum(const void *, int, double, const double *, const double *, "
             "const zd_terms *);")
    of_cffi.library = ffi.dlopen(str(library))
    return ffi.addressof(of_cffi.library, "pendulum")


def address(library):
    return ctypes.cast(ctypes.CDLL(str(library)).pendulum, ctypes.c_void_p).value


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
        same_bits(motion(system, formulation=formulation, **more), motion(built_in(), formulation=formulation, **more))


def test_a_capsule_is_known_by_its_signature(library):
    """What Cython exports; here made by hand."""
    new = ctypes.pythonapi.PyCapsule_New
    new.restype, new.argtypes = ctypes.py_object, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
    name = b"int (void *, int, double, double *, double *, void *)"
    capsule = new(address(library), name, None)
    system = zd.native(scipy.LowLevelCallable(capsule), ["x", "y"], **GIVEN)
    same_bits(motion(system), motion(built_in()))
    other = b"double (double, void *)"
    with pytest.raises(TypeError, match=r"the LowLevelCallable is double \(double, void \*\), and must be int \(const void"):
        zd.native(scipy.LowLevelCallable(new(address(library), other, None)), ["x", "y"], **GIVEN)


def bar_source():
    """The built-in four-bar as the library of a user."""
    source = HERE.parent / "csrc" / "systems" / "four_bar.c"
    return f'#define zd_four_bar zd_kind_four_bar\n#include "{source}"\nconst int zd_interface_version = ZD_INTERFACE_VERSION;\n'


@pytest.fixture(scope="module")
def bar_library(folder):
    return compile_text(bar_source(), folder / "four_bar.so", "-O3", "-Wno-pedantic")


def test_a_library_that_describes_its_system(bar_library, bar, formulation):
    mine = zd.native(bar_library, symbol="four_bar")
    assert (mine.coordinates, mine.velocities, mine.constraints) == (bar.coordinates, bar.velocities, bar.constraints)
    assert np.array_equal(mine.points(mine.p0), bar.points(bar.p0))
    options = {"step": 0.02, "formulation": formulation, "energy": True}
    same_bits(zd.simulate(mine, 2.0, **options), zd.simulate(bar, 2.0, **options))


def test_parameters_of_a_kind(library):
    system = zd.native(library, symbol="pendulum", parameters={"length": 2.0})
    assert np.array_equal(system.p0, [2.0, 0.0])
    assert system.parameters == {"mass": 1.0, "gravity": 9.81, "length": 2.0}
    assert system.constraints == built_in().constraints
    assert "length" in repr(system)


@pytest.mark.parametrize(("parameters", "error", "message"), [
    ({"lenght": 1.0}, TypeError, "pendulum has no parameter 'lenght'; it has mass, gravity, length"),
    ({"length": -1.0}, ValueError, "length must be positive, not -1.0"),
    ({"gravity": 1e3}, ValueError, "pendulum: there is no such gravity"),
])
def test_wrong_parameters_of_a_kind(parameters, error, message, library):
    with pytest.raises(error, match=message):
        zd.native(library, symbol="pendulum", parameters=parameters)


def test_a_saved_motion_is_not_taken_for_that_of_a_built_in_system(library, tmp_path):
    sol = motion(zd.native(library, symbol="pendulum"))
    again = zd.load(sol.save(tmp_path / "motion"))
    assert np.array_equal(again.p, sol.p)
    with pytest.raises(TypeError, match="description of pendulum"):
        zd.simulate(again.system, 1.0, step=0.1)


# ---- numba ----

NUMBA = '''
import numba
import zerodrift as zd
from zerodrift.compiled import BIT, SLOT


def pendulum(data, want, t, p, v, out):
    m, g, L, x, y = data[0], data[1], data[2], p[0], p[1]
    if want & BIT.M:
        M = numba.carray(out[SLOT.M], (2, 2))
        M[0, 0] = M[1, 1] = m
        M[0, 1] = M[1, 0] = 0.0
    if want & BIT.f:
        out[SLOT.f][0] = 0.0
        out[SLOT.f][1] = -m * g
    if want & BIT.Phi:
        out[SLOT.Phi][0] = (x * x + y * y - L * L) / (2 * L)
    if want & BIT.C:
        out[SLOT.C][0] = x / L
        out[SLOT.C][1] = y / L
    if want & BIT.xi:
        out[SLOT.xi][0] = -(v[0] * v[0] + v[1] * v[1]) / L
    if want & BIT.V:
        out[SLOT.V][0] = m * g * y
    return 0


compiled = numba.cfunc(zd.numba_signature())(pendulum)


@numba.cfunc(zd.numba_signature())
def decorated(data, want, t, p, v, out):
    return 1


@numba.cfunc("float64(float64)")
def other(x):
    return x


def local():
    return numba.cfunc(zd.numba_signature())(lambda data, want, t, p, v, out: 0)
'''


@pytest.fixture(scope="module")
def module(folder):
    pytest.importorskip("numba")
    (folder / "numba_pendulum.py").write_text(NUMBA)
    sys.path.insert(0, str(folder))
    yield __import__("numba_pendulum")
    sys.path.remove(str(folder))


def test_numba(module, formulation):
    system = zd.native(module.compiled, ["x", "y"], **GIVEN)
    ours, theirs = motion(system, formulation=formulation), motion(built_in(), formulation=formulation)
    assert_close(ours.p, theirs.p, 1e-12)       # numba may contract a product and a sum
    assert zd.check(system)


def test_pickling_what_numba_compiled(module):
    """By compiling the function again, or by importing what was compiled when its module was."""
    system = zd.native(module.compiled, ["x", "y"], **GIVEN)
    same_bits(motion(pickle.loads(pickle.dumps(system))), motion(system))
    imported = zd.native(module.decorated, ["x", "y"], **(GIVEN | {"p0": None}))
    with pytest.raises(zd.ZerodriftError, match="the native function reported a failure"):
        motion(pickle.loads(pickle.dumps(imported)))
    hidden = zd.native(module.local(), ["x", "y"], **(GIVEN | {"p0": None}))
    with pytest.raises(TypeError, match="cannot be pickled: numba would have to find its Python function at the top of"):
        pickle.dumps(hidden)


def test_a_cfunc_of_another_signature(module):
    with pytest.raises(TypeError, match=r"the numba\.cfunc is double \(double\), and must be int .*numba_signature\(\)"):
        zd.native(module.other, ["x", "y"], **GIVEN)


def test_the_example_of_the_docstring():
    pytest.importorskip("numba")
    code = zd.native.__doc__.partition("that a spring pulls::\n")[2].partition("    Matrices are")[0]
    scope = {"zd": zd}
    # numba wants the source of what it compiles only to cache it
    exec(compile(textwrap.dedent(code), "example", "exec"), scope)
    sol = zd.simulate(scope["system"], 1.0, step=0.001)
    assert_close(sol.p[-1], np.cos([2.0]), 1e-10)


# ---- ordinary systems ----


@pytest.mark.parametrize("describes", [False, True])
def test_check(library, describes):
    assert zd.check(zd.native(library, symbol="pendulum") if describes else pendulum(library))


def test_check_finds_a_wrong_derivative(folder):
    text = (HERE / "native" / "pendulum.c").read_text().replace("out->C[1] = y / L", "out->C[1] = -y / L")
    wrong = pendulum(compile_text(text, folder / "wrong.so"))
    assert any("jacobian" in problem for problem in zd.check(wrong, [0.6, -0.8], [0.8, 0.6]).problems)


def test_several_threads_at_once(library):
    system = pendulum(library)
    expected = motion(system)
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        for sol in pool.map(lambda _: motion(system), range(16)):
            same_bits(sol, expected)


def run_elsewhere(system):
    return motion(system).p


@pytest.mark.parametrize("describes", [False, True])
def test_another_process(library, describes):
    system = zd.native(library, symbol="pendulum", parameters={"mass": 2.0}) if describes else pendulum(library)
    with concurrent.futures.ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        assert np.array_equal(pool.submit(run_elsewhere, system).result(), motion(system).p)


def test_units_say_what_is_a_length(library):
    long = {"p0": [0.0, -1e3], "parameters": GIVEN["parameters"] | {"length": 1e3}}
    system = zd.native(library, ["x", "y"], symbol="pendulum", units=["m", "m"], **(GIVEN | long))
    assert [variable.unit for variable in pickle.loads(pickle.dumps(system)).velocities] == ["m/s", "m/s"]
    plain = zd.native(library, ["x", "y"], symbol="pendulum", **(GIVEN | long))
    sizes = [zd.simulate(each, 0.1, step=0.1).position_size for each in (plain, system)]
    np.testing.assert_allclose(sizes[1], 1e3 * sizes[0])        # the size of Phi where the length is one unit, or a thousand


def test_pickling_wants_the_same_library(library, tmp_path):
    copy = Path(shutil.copy(library, tmp_path / "pendulum.so"))
    pickled = [pickle.dumps(system) for system in (pendulum(copy), zd.native(copy, symbol="pendulum"))]
    other = tmp_path / "other.so"       # as compilers do: to write into a library that is loaded would change the code in use
    other.write_bytes(copy.read_bytes() + b"\0")
    other.replace(copy)
    for data in pickled:
        with pytest.raises(ValueError, match=r"pendulum\.so is not what it was when this system was made"):
            pickle.loads(data)
    copy.unlink()
    for data in pickled:
        with pytest.raises(FileNotFoundError, match=r"there is no shared library .*pendulum\.so"):
            pickle.loads(data)


@pytest.mark.parametrize("source", ["ctypes", "cffi", "scipy of ctypes", "address"])
def test_pointers_are_not_pickled(source, library):
    function, options = SOURCES[source](library)
    system = zd.native(function, ["x", "y"], **GIVEN, **options)
    with pytest.raises(TypeError, match="native system cannot be pickled: a function pointer means nothing in another process"):
        pickle.dumps(system)


def test_a_library_compiled_anew_is_loaded_anew(folder, tmp_path):
    """Though the system's loader would give back what it had at this path."""
    source = (HERE / "native" / "pendulum.c").read_text()
    library, before = tmp_path / "pendulum.so", compile_library(HERE / "native" / "pendulum.c", tmp_path / "pendulum.so")
    heavy = pendulum(before).evaluate().M
    (tmp_path / "changed.c").write_text(source.replace("out->M[3] = m", "out->M[3] = 2 * m"))
    first = pendulum(library)
    compile_library(tmp_path / "changed.c", library)
    assert np.array_equal(pendulum(library).evaluate().M, 2 * heavy)
    assert np.array_equal(first.evaluate().M, heavy)


def test_a_library_may_be_overwritten_while_it_is_used(library, tmp_path):
    """Not even its pages in memory are those of the file."""
    copy = Path(shutil.copy(library, tmp_path / "pendulum.so"))
    system = zd.native(copy, symbol="pendulum")
    before = motion(system)
    copy.write_bytes(b"something else")
    same_bits(motion(system), before)
    with pytest.raises(ValueError, match=r"pendulum\.so is no shared library"):
        pendulum(copy)


def test_parameters_are_handed_over_in_order(library):
    heavy = pendulum(library).with_parameters(mass=3.0)
    assert heavy.evaluate().M[0, 0] == 3.0
    assert_close(motion(heavy).multipliers, 3 * motion(built_in()).multipliers, 1e-12)
    with pytest.raises(ValueError, match="parameter must be one of 'mass', 'gravity', 'length', not 'width'"):
        heavy.with_parameters(width=1.0)


def test_work_precision(library):
    table = zd.work_precision(pendulum(library), 1.0, formulations=["schur"], integrators=["rk4"], steps=[0.04, 0.02],
                              tolerances=[], rounds=1)
    coarse, fine = (row.error for row in table.rows)
    assert fine < coarse / 12


def test_names(library):
    system = pendulum(library, name="mine")
    assert [variable.name for variable in (*system.coordinates, *system.velocities, *system.constraints)] == [
        "x", "y", "x_dot", "y_dot", "rod"]
    assert repr(system) == "<zd.native mine: 2 coordinates, 2 velocities, 1 holonomic and 0 nonholonomic constraints>"
    p, _ = zd.assemble(system, [0.5, -0.5], hold="x")
    assert_close(p, np.array([0.5, -np.sqrt(0.75)]), 1e-12)


def test_bits_and_slots_are_those_of_the_header(folder):
    """Which the compiler knows."""
    names = ["A", "M", "BIAS", "FORCE", "PHI", "C", "PHI_T", "XI", "POTENTIAL", "POWER", "COMPLEMENT", "GAMMA"]
    lines = "".join(f'printf("%d %d ", ZD_{bit}, (int)(offsetof(zd_terms, {slot}) / sizeof(double *)));\n'
                    for bit, slot in zip(names, SLOT._fields, strict=True))
    (folder / "main.c").write_text("#include <stddef.h>\n#include <stdio.h>\n#include <zerodrift/system.h>\n"
                                   f"int main(void) {{ {lines} return 0; }}")
    subprocess.run([COMPILER, "-I", zd.get_include(), "-o", folder / "main", folder / "main.c"], check=True)
    numbers = [int(word) for word in subprocess.run([folder / "main"], check=True, capture_output=True).stdout.split()]
    assert numbers[::2] == list(BIT)
    assert numbers[1::2] == list(SLOT)


# ---- what is wrong, by name ----


def another_version(library):
    text = (HERE / "native" / "pendulum.c").read_text().replace("= ZD_INTERFACE_VERSION", "= ZD_INTERFACE_VERSION + 1")
    return pendulum(compile_text(text, library.parent / "newer.so"))


def no_version(library):
    text = (HERE / "native" / "pendulum.c").read_text().replace("const int zd_interface_version = ZD_INTERFACE_VERSION;", "")
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
    (another_version, ValueError, r"zd_interface_version of .*newer\.so is 3, and this core has version 2 of the "),
    (no_version, ValueError, r"versionless\.so does not say its version of the interface: it needs the line"),
    (no_library, ValueError, r"text\.so is no shared library that can be loaded here: "),
    (lambda lib: pendulum(lib.parent / "none.so"), FileNotFoundError, r"there is no shared library .*none\.so"),
    (lambda lib: pendulum(lib, "pendulums"), ValueError, r"pendulum\.so has no symbol 'pendulums'"),
    (lambda lib: pendulum(lib, None), TypeError, "symbol is needed, the name of what is meant in .*, not None"),
    (lambda lib: pendulum(lib, version=1), TypeError, "version is for functions in memory: a library says its own"),
    (untyped, TypeError, "set argtypes and restype of .*, as of a int"),
    (other_ctypes, TypeError, r"the ctypes function is double \(double\), and must be int \(const void \*data, int want"),
    (other_cffi, TypeError, r"the cffi function is double \(double\), and must be int"),
    (with_user_data, ValueError, "the LowLevelCallable has user_data"),
    (lambda lib: zd.native(address(lib), 2, **GIVEN), TypeError, "version is needed with an address: .* has 2"),
    (lambda lib: zd.native(address(lib), 2, version=7, **GIVEN), ValueError, "version is 7, and this core has version 2"),
    (lambda lib: zd.native(0, 2, version=2, **GIVEN), ValueError, "function must be the address of a function, not 0"),
    (lambda lib: zd.native(abs, 2, **GIVEN), TypeError, "function must be the path of a shared library, an address"),
    (lambda lib: zd.native(address(lib), 2, version=2, symbol="f", **GIVEN), TypeError, "symbol names a function of a"),
    (lambda lib: pendulum(lib, terms=None), TypeError, "terms is needed with coordinates"),
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
     "terms is for a function, with its coordinates: zd_kind_pendulum says it itself"),
    (lambda lib: zd.native(address(lib)), TypeError, "coordinates are needed: only a shared library can describe"),
]


@pytest.mark.parametrize(("make", "error", "message"), WRONG, ids=range(len(WRONG)))
def test_what_is_wrong(make, error, message, library):
    with pytest.raises(error, match=message):
        make(library)


# ---- terms that are not finite, later ----

SPOILT = {"A": "A", "M": "M", "d": "bias d", "f": "force f", "Phi": "Phi", "C": "C", "Phi_t": "Phi_t", "xi": "xi",
          "V": "potential V", "power": "power"}


def spoilt(library, term, moment=1.0):
    extra = [name for name in ("A", "d", "Phi_t", "power") if name == term]
    return pendulum(library, "spoilt", terms=[*TERMS, *extra],
                    parameters=GIVEN["parameters"] | {"from": moment, "term": SLOT._asdict().get(term, 12)})


@pytest.mark.parametrize("term", SPOILT)
def test_a_term_that_is_not_finite_is_named(term, library, formulation):
    message = rf"^at t = 1(\.\d+)? \(step 10\d of 200\): the system's {SPOILT[term]} is not finite$"
    with pytest.raises(zd.ZerodriftError, match=message) as caught:
        motion(spoilt(library, term), formulation=formulation)
    sol = caught.value.solution
    assert 0.98 < sol.t[-1] <= 1.0
    for values in (sol.p, sol.v, sol.energy_violation):
        assert np.isfinite(values).all()
    unspoilt = motion(spoilt(library, term, 9.0), formulation=formulation)
    assert np.array_equal(sol.p, unspoilt.p[:len(sol.t)])


@pytest.mark.parametrize("term", ["M", "f", "C", "Phi_t", "xi", "A"])
def test_where_steps_are_chosen_too(term, library, integrator):
    if not zd.integrators()[integrator].error_order:
        return
    with pytest.raises(zd.ZerodriftError, match=rf"^at t = 1(\.\d+)? .*the system's {SPOILT[term]} is not finite$"):
        zd.simulate(spoilt(library, term), 2.0, rtol=1e-8, integrator=integrator)


@pytest.mark.parametrize("term", ["M", "C", "Phi"])
def test_a_term_that_is_not_finite_at_the_start(term, library):
    system = spoilt(library, term, 0.0)
    with pytest.raises(zd.ZerodriftError, match=f"the system's {term} is not finite"):
        zd.simulate(system, 1.0, step=0.1)


@pytest.mark.parametrize("term", ["M", "C", "f", "xi"])
def test_outside_a_run(term, library):
    with pytest.raises(zd.ZerodriftError, match=f"the system's .*{term} is not finite"):
        zd.acceleration(spoilt(library, term), [1.0, 0.0], [0.0, 0.0], t=1.0)


def test_a_failure_that_the_function_reports(library):
    """Whatever number it returns: a positive one does not mean that the run is merely paused."""
    with pytest.raises(zd.ZerodriftError, match=r"^at t = .* \(step 10\d of 200\): the native function reported") as caught:
        motion(spoilt(library, "failure"))
    assert 0.98 < caught.value.solution.t[-1] <= 1.0


