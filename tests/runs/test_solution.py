"""Solution of a run: frozen, complete, and the same after pickle, copy, save and load."""

import copy
import dataclasses
import json
import pickle
from fractions import Fraction

import numpy as np
import pytest

import zerodrift as zd
from support import ROWS, assert_same_bits, motion, refused
from zerodrift.runs.samples.saving import Described
from zerodrift.systems.builtin import BuiltIn


def saved_and_loaded(sol, tmp_path):
    return zd.load(sol.save(tmp_path / "motion"))


ROUND_TRIPS = {
    "pickle": lambda sol, tmp_path: pickle.loads(pickle.dumps(sol)),
    "copy": lambda sol, tmp_path: copy.deepcopy(sol),
    "save": saved_and_loaded,
}


@pytest.mark.filterwarnings("ignore::zerodrift.CorrectionWarning")
@pytest.mark.parametrize("there_and_back", ROUND_TRIPS.values(), ids=ROUND_TRIPS)
def test_round_trips(system, there_and_back, tmp_path):
    sol = motion(system, 1.0, 20, stabilization=zd.Projection(every=3, tol=1e-11), energy=system.has_energy)
    again = there_and_back(sol, tmp_path)
    assert_same_bits(sol, again)
    assert np.array_equal(sol.iterations, again.iterations)
    for name in ("stats", "status", "success", "message", "settings", "t_span"):
        assert getattr(again, name) == getattr(sol, name), name
    assert repr(again) == repr(sol)
    assert_read_only(again)
    if there_and_back is saved_and_loaded and not isinstance(system, BuiltIn):      # a file describes systems of others
        assert again.system.name == system.name
        return
    assert again.system.parameters == sol.system.parameters
    assert_same_bits(sol, zd.simulate(again.system, again.t_span, **again.settings))


def assert_read_only(sol):
    for name in ROWS:
        array = getattr(sol, name)
        assert array is None or not array.flags.writeable, name


def test_a_solution_is_frozen(bar):
    sol = motion(bar, 1.0, 20)
    assert_read_only(sol)
    with pytest.raises(dataclasses.FrozenInstanceError):
        sol.p = sol.v
    with pytest.raises(ValueError, match="read-only"):
        sol.p[0] = 0


def test_shapes(system, formulation, integrator):
    """Time first; energies only where a potential is declared."""
    sol = motion(system, 0.1, 20, formulation=formulation, integrator=integrator)
    rows = {"t": (), "p": (system.nq,), "v": (system.nv,), "multipliers": (system.m,), "position_violation": (system.mh,),
            "velocity_violation": (system.m,), "kinetic_energy": (), "iterations": ()}
    for name, shape in rows.items():
        assert getattr(sol, name).shape == (21, *shape)
    for name in ("potential_energy", "energy_input", "energy_violation"):
        array = getattr(sol, name)
        assert array.shape == (21,) if system.has_energy else array is None
    assert sol.success
    assert sol.status == 0
    assert sol.message == "done"


@pytest.mark.parametrize("stabilization", [None, "projection", zd.Projection(tol=1e-9), "baumgarte", zd.Baumgarte(5, 6)], ids=str)
@pytest.mark.parametrize("energy", [None, True, zd.EnergyCorrection(every=2)], ids=str)
def test_settings_repeat_the_run(bar, stabilization, energy):
    sol = motion(bar, 1.0, 20, stabilization=stabilization, energy=energy, save_every=3, formulation="augmented")
    again = zd.simulate(bar, sol.t_span, **sol.settings)
    assert_same_bits(sol, again)
    assert again.settings == sol.settings


def test_numbers_of_any_kind_are_saved(bar, tmp_path):
    """NumPy's scalars are accepted as numbers, also in a file."""
    projection = zd.Projection(tol=np.float32(1e-9), every=np.int8(2), max_iterations=np.uint16(7))
    sol = zd.simulate(bar, np.float32(1), step=np.float64(0.0625), save_every=np.int64(2), stabilization=projection,
                      energy=zd.EnergyCorrection(np.int32(2)))
    assert saved_and_loaded(sol, tmp_path).settings == sol.settings
    gains = zd.simulate(bar, 1, step=Fraction(1, 16), stabilization=zd.Baumgarte(np.int64(10), Fraction(50, 2)))
    assert saved_and_loaded(gains, tmp_path).settings == gains.settings


def test_a_system_keeps_what_it_was_given(tmp_path):
    """Also where the caller goes on using the array."""
    lengths = np.array([1, 0.35, 1, 0.6])
    bar = zd.systems.four_bar(lengths=lengths, inertias=[0.1, 0.2, 0.3], assembly="crossed")
    p0, lengths[1] = bar.p0.copy(), 0.1
    for again in (pickle.loads(pickle.dumps(bar)), saved_and_loaded(motion(bar, 0.1, 1), tmp_path).system):
        assert np.array_equal(again.p0, p0)
        assert again.parameters == bar.parameters
    assert "lengths=(1.0, 0.35, 1.0, 0.6)" in repr(bar)


def test_the_suffix_is_added_where_it_is_missing(bar, tmp_path):
    sol = motion(bar, 0.1, 1)
    assert [sol.save(tmp_path / name).name for name in ("a", "b.npz", "c.5")] == ["a.npz", "b.npz", "c.5.npz"]
    assert zd.load(str(tmp_path / "a.npz")).t[-1] == 0.1


def test_functions_of_built_in_systems_are_pickled():
    assert pickle.loads(pickle.dumps(zd.systems.four_bar)) is zd.systems.four_bar


def test_a_solution_file_needs_no_pickle(bar, tmp_path):
    with np.load(motion(bar, 0.1, 1).save(tmp_path / "a"), allow_pickle=False) as file:
        assert json.loads(str(file["zerodrift"]))["message"] == "done"


def test_a_forgotten_system_is_described(bar, tmp_path):
    """A file from another version: enough for tables and plots."""
    path = motion(bar, 0.1, 1).save(tmp_path / "a")
    with np.load(path) as file:
        arrays = dict(file)
    rest = json.loads(str(arrays["zerodrift"]))
    rest["system"]["name"] = "five_bar"
    np.savez(path, **arrays | {"zerodrift": np.array(json.dumps(rest))})
    sol = zd.load(path)
    assert isinstance(sol.system, Described)
    assert repr(sol.system) == "<description of five_bar>"
    assert sol.system.coordinates == bar.coordinates
    assert "five_bar" in repr(sol)


def write_text(path):
    path.write_text("no solution")


def write_other_arrays(path):
    with path.open("wb") as file:
        np.savez(file, a=np.zeros(3))


def write_one_array(path):
    with path.open("wb") as file:
        np.save(file, np.zeros(3))


@pytest.mark.parametrize("write", [write_text, write_other_arrays, write_one_array, lambda path: path.touch()],
                         ids=["text", "npz", "npy", "empty"])
def test_a_file_that_is_not_a_solution(write, tmp_path):
    path = tmp_path / "file.npz"
    write(path)
    with refused("unreadable-file", r"file\.npz"):
        zd.load(path)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(FileNotFoundError):
        zd.load(tmp_path / "nothing.npz")


def test_repr_says_what_matters(bar):
    text = repr(motion(bar, 1.0, 20, energy=True))
    for part in ("four_bar", "21 samples", "t = 0 ... 1 s", "done", "schur", "rk4", "Projection(", "EnergyCorrection(",
                 "max |Phi| =", "max |Psi_E| ="):
        assert part in text
    assert "no stabilization" in repr(motion(bar, 1.0, 20, stabilization=None))


def test_columns_are_found_by_their_names(system, tmp_path):
    """Coordinates, velocities and multipliers, of the run and of what was saved of it."""
    sol = motion(system, 0.1, 10)
    for it in (sol, saved_and_loaded(sol, tmp_path)):
        columns = np.hstack([it.p, it.v, it.multipliers]).T
        names = [variable.name for variable in (*system.coordinates, *system.velocities, *system.constraints)]
        assert it._ipython_key_completions_() == names
        for name, column in zip(names, columns, strict=True):
            assert np.array_equal(it[name], column)


def test_names_that_say_nothing_or_too_much_are_refused():
    system = zd.System(["x", "constraint0"], mass=np.eye(2), constraints=lambda p: p[1:], p0=[1.0, 0.0])
    sol = zd.simulate(system, 0.1, step=0.1)
    assert np.array_equal(sol["x"], sol.p[:, 0])
    with refused("duplicate-name", "'constraint0'.*names 2"):
        sol["constraint0"]
    for nothing in ("z", 0, None):
        with refused("wrong-name", "x_dot, constraint0_dot"):
            sol[nothing]


def test_of_many_names_the_closest_are_reported():
    names = [f"rocker{i}" for i in range(9)]
    sol = zd.simulate(zd.System(names, mass=np.eye(9), p0=np.zeros(9)), 0.1, step=0.1)
    with refused("wrong-name", r"is called 'Roker3'; the closest of 18 names are rocker3, (rocker., ){3}rocker. \[zd:"):
        sol["Roker3"]
    with refused("wrong-name", "and 13"):
        sol["q"]
