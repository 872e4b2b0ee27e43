"""Systems of compiled functions do what all systems do: in threads, in other processes, pickled, compiled anew."""

import concurrent.futures
import multiprocessing
import pickle
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import zerodrift as zd
from native_systems import (
    COMPILER,
    GIVEN,
    PENDULUM,
    built_in,
    compile_library,
    compile_text,
    motion,
    needs_compiler,
    pendulum,
    run_elsewhere,
)
from support import assert_close, assert_same_bits, refused
from zerodrift._private.gateway import TERMS
from zerodrift.systems.native import BIT, SLOT

pytestmark = needs_compiler


@pytest.mark.parametrize("describes", [False, True])
def test_check(library, describes):
    assert zd.check(zd.native(library, symbol="pendulum") if describes else pendulum(library))


def test_check_finds_a_wrong_derivative(tmp_path):
    text = PENDULUM.read_text().replace("out->C[1] = y / L", "out->C[1] = -y / L")
    wrong = pendulum(compile_text(text, tmp_path / "wrong.so"))
    assert any("jacobian" in problem for problem in zd.check(wrong, [0.6, -0.8], [0.8, 0.6]).problems)


def test_several_threads_at_once(library):
    system = pendulum(library)
    expected = motion(system)
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        for sol in pool.map(lambda _: motion(system), range(16)):
            assert_same_bits(sol, expected)


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


# ---- the file of a library ----


def test_pickling_wants_the_same_library(library, tmp_path):
    copy = Path(shutil.copy(library, tmp_path / "pendulum.so"))
    pickled = [pickle.dumps(system) for system in (pendulum(copy), zd.native(copy, symbol="pendulum"))]
    other = tmp_path / "other.so"       # as compilers do: to write into a library that is loaded would change the code in use
    other.write_bytes(copy.read_bytes() + b"\0")
    other.replace(copy)
    for data in pickled:
        with refused("compiled-function", r"pendulum\.so is not what it was when this system was made"):
            pickle.loads(data)
    copy.unlink()
    for data in pickled:
        with refused("missing-file", r"the shared library must exist: .*pendulum\.so"):
            pickle.loads(data)


def test_a_library_compiled_anew_is_loaded_anew(tmp_path):
    """Though the system's loader would give back what it had at this path."""
    source = PENDULUM.read_text()
    library, before = tmp_path / "pendulum.so", compile_library(PENDULUM, tmp_path / "pendulum.so")
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
    assert_same_bits(motion(system), before)
    with refused("compiled-function", r"pendulum\.so must be a shared library"):
        pendulum(copy)


# ---- names, parameters and places ----


def test_parameters_are_handed_over_in_order(library):
    heavy = pendulum(library).with_parameters(mass=3.0)
    assert heavy.evaluate().M[0, 0] == 3.0
    assert_close(motion(heavy).multipliers, 3 * motion(built_in()).multipliers, 1e-12)
    with refused("unknown-choice", "parameter.*'mass', 'gravity', 'length', not 'width'"):
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


def test_bits_and_slots_are_those_of_the_header(tmp_path):
    """Which the compiler knows."""
    lines = "".join(f'printf("%d %d ", {term.symbol}, (int)(offsetof(zd_terms, {name}) / sizeof(double *)));\n'
                    for name, term in TERMS.items())
    (tmp_path / "main.c").write_text("#include <stddef.h>\n#include <stdio.h>\n#include <zerodrift/system.h>\n"
                                     f"int main(void) {{ {lines} return 0; }}")
    subprocess.run([COMPILER, "-I", zd.get_include(), "-o", tmp_path / "main", tmp_path / "main.c"], check=True)
    numbers = [int(word) for word in subprocess.run([tmp_path / "main"], check=True, capture_output=True).stdout.split()]
    assert numbers[::2] == list(BIT)
    assert numbers[1::2] == list(SLOT)
