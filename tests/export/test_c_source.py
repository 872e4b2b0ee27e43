"""`zd.c_source`: sources without warnings whose numbers are those of `simulate` to the bit, and no allocation in steps."""

import shutil
import subprocess
import sys

import numpy as np
import pytest

import zerodrift as zd
from core_objects import AT_FIXED_PLACES, CC, STRICT, needs_compiler, objects_of, shared_folder
from few_bodies import touching_bodies, touching_in_space
from support import called, refused, relay
from written_laws import machine_of_laws

ALLOCATED = """
#include <stdio.h>
#include <stdlib.h>
static long count;
void *__real_aligned_alloc(size_t alignment, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size) { count++; return __real_aligned_alloc(alignment, size); }
static void report(void) { fprintf(stderr, "%ld allocations\\n", count); }
__attribute__((constructor)) static void begin(void) { atexit(report); }
"""


@pytest.fixture
def built(tmp_path_factory):
    """Program of all sources below a folder, by a function; warnings are errors."""
    def build(folder, *options):
        objects = objects_of(sorted(folder.rglob("*.c")), folder, shared_folder(tmp_path_factory))
        subprocess.run([CC, *AT_FIXED_PLACES, "-o", folder / "main", *objects.values(), *options, "-lm"], check=True)
        return folder / "main"
    return build


def printed(program, duration):
    """Numbers that the program prints, one row for each sample, and what it writes besides."""
    result = subprocess.run([program, str(duration)], capture_output=True, text=True, check=True)
    return np.array([[float(word) for word in line.split()] for line in result.stdout.splitlines()]), result.stderr


@needs_compiler
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="wraps the allocation by the linker of GNU")
def test_a_crank_has_the_bits_of_simulate_and_allocates_before_its_steps(tmp_path, built):
    names = ["crank.angle", "pin.force"]
    folder = zd.c_source(zd.models.slider_crank(), tmp_path / "crank", step=1e-3, outputs=names, energy=True)
    (folder / "allocated.c").write_text(ALLOCATED)
    program = built(folder, "-Wl,--wrap=aligned_alloc")
    sol = zd.simulate(zd.models.slider_crank(), 1.0, step=1e-3, outputs=names, energy=True, vector="baseline", closed_form=False)
    rows, told = printed(program, 1.0)
    np.testing.assert_array_equal(rows, np.column_stack([sol.t, *(sol[name] for name in names)]))
    assert told == printed(program, 0.01)[1] != "0 allocations\n"


@needs_compiler
def test_events_act_with_the_bits_of_simulate(tmp_path, built):
    m, events = relay()
    folder = zd.c_source(m, tmp_path / "relay", step=1e-2, outputs=["pin.angle"], events=events)
    sol = zd.simulate(m, 5.0, step=1e-2, events=events, vector="baseline", closed_form=False)
    rows, _ = printed(built(folder), 5.0)
    assert len(sol.jumps) == 4
    np.testing.assert_array_equal(rows, np.column_stack([sol.t, sol["pin.angle"]]))


@needs_compiler
@pytest.mark.parametrize(("scene", "end"), [(touching_bodies, 3.0), (touching_in_space, 0.6)])
def test_contacts_have_the_bits_of_simulate(scene, end, tmp_path, built):
    m, names = scene()
    folder = zd.c_source(m, tmp_path / "bodies", step=1e-2, outputs=names)
    sol = zd.simulate(m, end, step=1e-2, outputs=names, vector="baseline", closed_form=False)
    rows, _ = printed(built(folder), end)
    assert len(sol.phases) > 20
    np.testing.assert_array_equal(rows, np.column_stack([sol.t, *(sol[name] for name in names)]))


@needs_compiler
def test_recorded_functions_have_the_bits_of_simulate(tmp_path, built):
    m, names = machine_of_laws()
    folder = zd.c_source(m, tmp_path / "laws", step=1e-2, outputs=names)
    sol = zd.simulate(m, 0.3, step=1e-2, outputs=names, vector="baseline", closed_form=False)
    rows, _ = printed(built(folder), 0.3)
    np.testing.assert_array_equal(rows, np.column_stack([sol.t, *(sol[name] for name in names)]))


@needs_compiler
def test_measures_of_ones_own_are_outputs(tmp_path, built):
    m = zd.models.slider_crank()
    m.measure("idle", lambda t: t)
    m.measure("load", lambda x, y, t: np.hypot(x, y) + t, of={"x": "pin.force.x", "y": "pin.force.y"})
    folder = zd.c_source(m, tmp_path / "crank", step=1e-3, outputs=["load", "crank.angle"])
    sol = zd.simulate(m, 0.1, step=1e-3, outputs=["load"], vector="baseline", closed_form=False)
    rows, _ = printed(built(folder), 0.1)
    np.testing.assert_array_equal(rows, np.column_stack([sol.t, sol["load"], sol["crank.angle"]]))


@needs_compiler
def test_a_disc_in_space_has_the_bits_of_simulate(tmp_path, built):
    folder = zd.c_source(zd.models.rolling_disc(), tmp_path / "disc", step=1e-3, outputs=["disc.position"], integrator="heun")
    sol = zd.simulate(zd.models.rolling_disc(), 0.5, step=1e-3, outputs=["disc.position"], integrator="heun", vector="baseline",
                      closed_form=False)
    rows, _ = printed(built(folder), 0.5)
    np.testing.assert_array_equal(rows, np.column_stack([sol.t, sol["disc.position"]]))


@needs_compiler
@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_least_reactions_of_redundant_constraints_have_the_bits_of_simulate(layout, tmp_path, built):
    m, names = zd.Mechanism("door", dimension=3, gravity=(1, 2, -9.81)), ["upper.force", "lower.torque"]
    leaf = m.body("leaf", 2.0, (0.1, 0.1, 0.1), at=(0.5, 0, 0))
    for name, z in (("upper", 1.0), ("lower", -1.0)):
        m.revolute(name, m.ground, leaf, at=(0, 0, z), axis=(0, 0, 1))
    folder = zd.c_source(m.system(layout), tmp_path / "door", step=1e-3, outputs=names)
    sol = zd.simulate(m.system(layout), 0.01, step=1e-3, outputs=names, vector="baseline", closed_form=False)
    rows, _ = printed(built(folder), 0.01)
    np.testing.assert_array_equal(rows, np.column_stack([sol.t, *(sol[name] for name in names)]))
    np.testing.assert_allclose(sol["upper.force"][:, 2], 9.81, rtol=0, atol=1e-9)


def test_clang_compiles_it_without_warnings(tmp_path):
    """The first of the compilers `clang` and `zig cc` that is there."""
    clang = shutil.which("clang")
    if not clang:
        pytest.importorskip("ziglang")
    compiler = (clang,) if clang else (sys.executable, "-m", "ziglang", "cc")
    folder = zd.c_source(zd.models.four_bar(), tmp_path / "bar", step=1e-2)
    for source in ("main.c", "block/create.c", "block/laws.c", "simulate.c", "registry.c"):
        subprocess.run([*compiler, "-std=c11", "-ffp-contract=off", *STRICT, "-c", "-I", folder, "-o", tmp_path / "one.o",
                        folder / source], check=True)


def test_the_folder_has_what_the_mechanism_needs_and_no_more(tmp_path):
    folder = zd.c_source(zd.models.four_bar(), tmp_path / "bar", step=1e-2, integrator="rk4")
    files = {path.relative_to(folder).as_posix() for path in folder.rglob("*.c")}
    assert {"main.c", "block/plane.c", "integrators/rk4.c", "formulations/schur.c", "corrections/projection.c"} <= files
    others = {"block/space.c", "integrators/radau/radau.c", "formulations/mixed.c", "batch/lanes.c", "systems/four_bar.c"}
    assert not files & others
    with refused("existing-file"):
        zd.c_source(zd.models.four_bar(), folder, step=1e-2)


def test_a_mechanism_that_is_refused_leaves_no_folder(tmp_path):
    m = zd.models.four_bar()
    m.torque("drive", m.bodies[0], value=called(lambda t: 1.0 + t))
    with refused("not-portable", "drive"):
        zd.c_source(m, tmp_path / "bar", step=1e-2)
    assert not list(tmp_path.iterdir())


def test_names_of_the_mechanism_cannot_end_a_comment(tmp_path):
    m = zd.Mechanism("a */ int x; /*")
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    m.revolute("pin", m.ground, link.start)
    first, *_ = (zd.c_source(m, tmp_path / "named", step=1e-2) / "data.h").read_text().splitlines()
    assert first.count("*/") == 1
    assert first.endswith("*/")
