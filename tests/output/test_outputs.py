"""Measures recorded during a run equal those evaluated afterwards, for any choice of samples; none are recorded by default."""

import copy
import pickle

import numpy as np
import pytest

import zerodrift as zd
from large_mechanisms import four_bars
from mechanisms.every_element import machinery
from mechanisms.plain_space import Plain
from native_systems import PENDULUM, compile_text, needs_compiler
from support import handed, refused
from zerodrift._private import gateway
from zerodrift._private.core import ffi, lib

OUTPUTS = ["C.force", "crank.angle", "coupler.end.velocity.y", "drive.power", "A.torque"]


def four_bar(speed=lambda t: 3.0 + np.sin(t)):
    bar = zd.Mechanism("four-bar", gravity=(0, -9.81))
    crank = bar.link("crank", (0, 0), (0, 0.3), mass=1.5)
    coupler = bar.link("coupler", (0, 0.3), (0.95, 0.6), mass=5.0, length=1.0)
    rocker = bar.link("rocker", (0.95, 0.6), (1, 0), mass=3.0, length=0.6)
    pin = bar.revolute("A", bar.ground, crank.start, damping=0.1)
    bar.revolute("B", crank.end, coupler.start)
    bar.revolute("C", coupler.end, rocker.start)
    bar.revolute("D", rocker.end, bar.ground.point((1, 0)))
    bar.motor("drive", pin, speed=speed)
    return bar


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_what_is_recorded_is_what_is_read_afterwards(layout, formulation):
    """Both are of the same state. They are solved for twice, and differ by rounding."""
    system, options = four_bar().system(layout), {"step": 0.01, "formulation": formulation}
    plain, sol = zd.simulate(system, 0.3, **options), zd.simulate(system, 0.3, **options, outputs=OUTPUTS)
    assert np.array_equal(plain.p, sol.p)
    assert not plain.outputs
    assert set(sol.outputs) == {"C.force", "crank.angle", "coupler.end.velocity", "drive.power", "A.torque"}
    for name in OUTPUTS:
        np.testing.assert_allclose(sol[name], plain[name], rtol=1e-10, atol=1e-10 * np.abs(plain[name]).max())


OF_MOTION = {"position", "rotation", "angle", "displacement", "velocity", "angular_velocity", "speed"}


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("make", [machinery, lambda: Plain(np.random.default_rng(11), 4, 1).m], ids=["plane", "space"])
def test_measures_of_one_state_do_not_hang_on_those_before(make, layout):
    """Bodies are placed once for all measures of a row, and twice where one is read by itself; in any order, to the last bit."""
    system, rng = make().system(layout), np.random.default_rng(3)
    names = [name for name in system.measures if name.rpartition(".")[2] in OF_MOTION]
    plain = zd.simulate(system, 0.02, step=0.01)
    assert max(np.abs(plain[name]).max() for name in names if "velocity" in name) > 0.01
    for _ in range(3):
        sol = zd.simulate(system, 0.02, step=0.01, outputs=list(rng.permutation(list(system.measures))))
        for name in names:
            assert sol[name].tobytes() == plain[name].tobytes(), name


MANY = ["C3.force", "rod5.angle", "bar2.end.velocity", "B0.force.x"]


@pytest.mark.parametrize("rows", [{"save_every": 7}, {"t_eval": [0.0, 0.013, 0.15, 0.25]}], ids=["some", "times"])
def test_those_of_a_structured_system_are_those_of_its_tree(formulation, rows, tmp_path):
    """Joint coordinates are dense, and pass reactions on from body to body instead of reading multipliers; steps agree to 1e-8.

    In memory and in a file, which is opened without reading it.
    """
    m = four_bars(6)
    options = {"step": 1e-3, "formulation": formulation, "outputs": MANY, **rows}
    system = m.system("absolute")
    assert system._core.packing is not None
    sol, tree = zd.simulate(system, 0.25, **options), zd.simulate(m.system("joint"), 0.25, **options)
    zd.simulate(system, 0.25, save_to=tmp_path / "rows", **options)
    filed = zd.load(tmp_path / "rows.npy")
    for name in MANY:
        whole = sol.outputs[name] if name in sol.outputs else sol[name]
        np.testing.assert_allclose(whole, tree[name], rtol=0, atol=1e-8 * max(1.0, np.abs(tree[name]).max()))
        assert filed[name].tobytes() == sol[name].tobytes()
    assert set(sol.outputs) == {*MANY[:3], "B0.force"}
    memory = filed.p
    while not isinstance(memory, np.memmap):
        memory = memory.base


@pytest.mark.parametrize("rows", [{"save_every": 7}, {"t_eval": [0.0, 0.013, 0.2, 0.25]}, {}], ids=["some", "times", "all"])
def test_they_have_the_rows_that_are_saved(rows):
    bar = four_bar()
    sol = zd.simulate(bar, 0.3, step=0.01, outputs=[bar["C"].force, "crank.angle"], **rows)
    np.testing.assert_allclose(sol["crank.angle"] - sol["crank.angle"][0], 3 * sol.t + 1 - np.cos(sol.t), atol=1e-8)
    assert sol["C.force"].shape == (len(sol.t), 2)
    assert np.array_equal(sol["C.force.y"], sol["C.force"][:, 1])
    assert not sol["C.force"].flags.writeable
    again = zd.simulate(bar, 0.3, **sol.settings)
    assert np.array_equal(again["C.force"], sol["C.force"])


def test_the_record_is_what_is_read(monkeypatch):
    sol = zd.simulate(four_bar(), 0.1, step=0.01, outputs=["C.force"])
    monkeypatch.setattr(sol.system._watching, "values", None)
    assert sol["C.force.x"].shape == (11,)
    with pytest.raises(TypeError):
        sol["B.force"]      # which is evaluated


def test_a_record_grows_with_its_outputs():
    """Steps that are chosen: blocks of rows are joined."""
    bar = four_bar(speed=3.0)
    sol = zd.simulate(bar, 1.5, integrator="dop853", max_step=1e-3, outputs=["crank.angle"])
    assert len(sol.t) > 1024
    plain = zd.simulate(bar, sol.t_span, **sol.settings | {"outputs": []})
    assert np.array_equal(sol["crank.angle"], plain["crank.angle"])


def test_they_outlive_files_pickles_and_copies(tmp_path):
    sol = zd.simulate(four_bar(speed=3.0), 0.1, step=0.01, outputs=["C.force", "crank.angle"])
    for again in (zd.load(sol.save(tmp_path / "motion")), pickle.loads(pickle.dumps(sol)), copy.deepcopy(sol)):
        assert np.array_equal(again["C.force.x"], sol["C.force"][:, 0])
        assert np.array_equal(again["crank.angle"], sol["crank.angle"])
        assert again.settings == sol.settings
        assert not again["C.force"].flags.writeable


def test_columns_that_every_run_has_may_be_asked_for(bar):
    """They are recorded as ever."""
    names = [bar.coordinates[0].name, bar.velocities[1].name, bar.constraints[0].name]
    sol = zd.simulate(bar, 0.1, step=0.05, outputs=names)
    assert not sol.outputs
    assert np.array_equal(sol[names[1]], sol.v[:, 1])


@pytest.mark.parametrize(("outputs", "code", "sentence"), [
    (["C.forces"], "wrong-name", r"outputs\[0\].*'C.forces'"),
    (["C.force", "crank.angle.x"], "wrong-name", r"outputs\[1\].*crank.angle.x"),
    (["C.force.z"], "wrong-name", r"outputs\[0\].*'C.force.z'"),
    ([3], "wrong-type", r"outputs\[0\].*not 3"),
    ({"C.force"}, "wrong-type", "outputs"),
])
def test_what_is_not_there_is_named(outputs, code, sentence):
    with refused(code, sentence):
        zd.simulate(four_bar(), 0.1, step=0.05, outputs=outputs)


def test_what_is_not_asked_for_takes_no_memory():
    core = four_bar().system()._core
    assert gateway.Record(core, 10).c.outputs == ffi.NULL
    assert "outputs" not in gateway.Record(core, 10).take()


# ---- what the core refuses ----


def created(core, **changed):
    content = {"count": 1, "measure": ffi.new("int[]", [0]), "of": ffi.NULL} | changed
    outputs = ffi.new("zd_outputs *", content)
    options = handed()
    options.outputs = outputs
    system = four_bar(speed=3.0).system() if core is None else core
    gateway.Run(system._core, options, system.p0, system.v0)


@pytest.mark.parametrize(("changed", "sentence"), [
    ({"count": 0}, "outputs must be 1 to 8192 measures"), ({"measure": ffi.NULL}, "outputs must be 1 to 8192 measures"),
    ({"measure": ffi.new("int[]", [-1])}, "every output must be the index of a measure"),
    ({"measure": ffi.new("int[]", [9999])}, "every output must be the index of a measure"),
    ({"of": zd.systems.pendulum()._core.c}, "measures of a system with the same numbers of coordinates"),
], ids=["none", "nowhere", "negative", "beyond", "another"])
def test_outputs_that_the_core_refuses(changed, sentence):
    with pytest.raises(zd.ZerodriftError, match=sentence):
        created(None, **changed)


def test_a_system_without_measures_has_no_outputs(bar):
    with pytest.raises(zd.ZerodriftError, match="outputs must be 1 to 8192 measures"):
        created(bar)


# ---- systems that are not mechanisms ----

MEASURED = """
/* data: mass, gravity, length and, where it fails, a time */
static int measure(const void *data, const double *inputs, int which, double t, const double *p, const double *v,
                   const double *vdot, const double *lambda, const zd_measured *out, double *scratch)
{
    const double *q = data;
    (void)inputs, (void)v, (void)scratch;
    if (which == 0 && out->value) for (int i = 0; i < 3; i++) out->value[i] = i < 2 ? p[i] : t;
    if (which == 1 && out->value) out->value[0] = lambda[0];
    if (which == 2 && out->value) out->value[0] = vdot[1] + q[1];
    return which == 3 && t > 0.5 ? ZD_CALLBACK : 0;
}
static const zd_measure measured[] = {{"bob.place", "m", 3, ZD_OF_POSITIONS}, {"rod.tension", "N", 1, ZD_OF_ACCELERATIONS},
                                      {"bob.load", "m/s^2", 1, ZD_OF_ACCELERATIONS}, {"bob.trouble", "", 1, ZD_OF_POSITIONS}};
static const zd_measures measures = {4, measured, 2, measure};
"""


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    """The pendulum, as a library that brings measures of its own."""
    text = PENDULUM.read_text().replace("const zd_kind zd_kind_pendulum", MEASURED + "const zd_kind zd_kind_pendulum", 1)
    text = text.replace(".evaluate = pendulum,\n", ".evaluate = pendulum, .measures = &measures,\n", 1)
    return zd.native(compile_text(text, tmp_path_factory.mktemp("measured") / "measured.so"), symbol="pendulum")


@needs_compiler
def test_every_system_that_has_measures_records_them(measured):
    """In the rod of a pendulum let go at the horizontal the force is 3 m g cos(angle from the vertical) = -3 m g y."""
    options = {"step": 0.01, "t_eval": np.linspace(0, 1, 12)}
    sol = zd.simulate(measured, 1.0, **options, outputs=["bob.place", "rod.tension", "bob.load"])
    np.testing.assert_allclose(sol["bob.place"], np.column_stack([sol.p, sol.t]), rtol=0)
    np.testing.assert_allclose(sol["bob.place.z"], sol.t, rtol=0)
    np.testing.assert_allclose(sol["rod.tension"], -3 * 9.81 * sol.p[:, 1], atol=1e-6)      # the integration error
    np.testing.assert_allclose(sol["bob.load"], -sol["rod.tension"] * sol.p[:, 1], atol=1e-9)
    plain = zd.simulate(measured, 1.0, **options)
    for name in ("bob.place", "rod.tension", "bob.load"):
        np.testing.assert_allclose(plain[name], sol[name], rtol=1e-12, atol=1e-12)
    assert plain._ipython_key_completions_()[:2] == ["bob.place", "rod.tension"]


@needs_compiler
def test_a_measure_that_fails_ends_the_run(measured):
    with pytest.raises(zd.ZerodriftError) as caught:
        zd.simulate(measured, 1.0, step=0.01, outputs=["bob.trouble"])
    assert caught.value.solution.t[-1] == pytest.approx(0.5)
    assert caught.value.solution.status == lib.ZD_CALLBACK
