"""Ensembles that are saved and loaded, and what becomes of them in xarray and pandas."""

import sys

import numpy as np
import pytest

import zerodrift as zd
from small_studies import lowest, pendulum
from support import refused
from zerodrift.ensembles import saving


def test_an_ensemble_of_a_mechanism_is_loaded_with_its_runs(tmp_path):
    times = np.linspace(0, 0.5, 6)
    ens = zd.ensemble(zd.models.four_bar(), 0.5, parameters=zd.grid({"crank.mass": [1.0, 2.0], "rocker.mass": [1.0, 2.0, 3.0]}),
                      start={"crank.angle": 1.0}, step=0.01, t_eval=times, outputs=["crank.angle", "C.force"],
                      formulation="augmented", energy=True)
    again = zd.load(ens.save(tmp_path / "study"))
    assert (again.shape, again.messages, list(again.parameters)) == (ens.shape, ens.messages, list(ens.parameters))
    for name in ("crank.angle", "C.force"):
        assert np.array_equal(again[name], ens[name])
    assert np.array_equal(again.t, times)
    assert np.array_equal(again[4].p, ens[4].p)
    assert "as study.npz has it" in repr(again)
    assert np.array_equal(zd.load(again.save(tmp_path / "again.npz"))["C.force"], ens["C.force"])


def test_what_was_made_by_functions_is_loaded_without_them(tmp_path):
    falls = zd.Event("link.angle", value=-0.5, terminal=True)
    for i, arguments in enumerate(({"system": pendulum, "parameters": {"length": [1.0, 0.0, 2.0]}, "reduce": lowest},
                                   {"system": pendulum().system(), "events": [falls], "start": {"link.angle": [0.0, 0.1]}})):
        ens = zd.ensemble(t_span=1.0, step=0.01, outputs=["link.angle"], **arguments)
        again = zd.load(zd.load(ens.save(tmp_path / f"{i}.npz")).save(tmp_path / f"{i}.npz"))
        for one, other in zip(again["link.angle"], ens["link.angle"], strict=True):
            assert np.array_equal(one, other, equal_nan=True)
        assert again.messages == ens.messages
        assert np.array_equal(again.failed, ens.failed)
        assert str(again.values) == str(ens.values)
        assert str(again.t_events) == str(ens.t_events)
        with pytest.raises(zd.ZerodriftError, match=r"run 0 cannot be made again, as (a function|it had events)"):
            _ = again[0]


@pytest.mark.parametrize("reduce", [None, lambda sol: 1.0])
def test_runs_of_a_loaded_ensemble_have_its_bits(tmp_path, reduce):
    """Runs made in SIMD lanes or individually, loaded from a file or a store."""
    ens = zd.ensemble(zd.systems.four_bar(), 1.0, parameters={"gravity": np.linspace(9, 10, 5)}, step=0.01, outputs=["alpha2"],
                      reduce=reduce, store=tmp_path / "store")
    for again in (zd.load(ens.save(tmp_path / "file")), zd.load(tmp_path / "store"), ens):
        assert np.array_equal(again["alpha2"], ens["alpha2"])
        for i in range(5):
            assert np.array_equal(again[i]["alpha2"], ens["alpha2"][i])


def test_a_system_that_is_not_kept_is_named(tmp_path):
    system = zd.System(1, mass=np.eye(1), p0=[1.0], name="block")
    again = zd.load(zd.ensemble(system, 0.5, v0=[[1.0], [2.0]], step=0.1).save(tmp_path / "study"))
    assert again["p0"][:, -1].tolist() == pytest.approx([1.5, 2.0])
    with pytest.raises(zd.ZerodriftError, match="of block only the description was kept"):
        _ = again[0]


@pytest.mark.parametrize("value", [
    None, True, 3, 2.5, -0.0, float("inf"), "a", [1, [2.0]], (1, (2,)), {"a": [1], "b": {"array": 1}}, np.arange(3),
    np.zeros((0, 2)), np.array([[1.5, 2.5]])])
def test_what_reduce_returns_comes_back_as_it_was(value):
    again = saving.value_from_json(saving.value_as_json(value))
    assert type(again) is type(value)
    assert repr(again) == repr(value)


@pytest.mark.parametrize("value", [1j, object(), {1: 2}, {"a": {3}}, np.array([object()])])
def test_what_a_file_does_not_keep(value):
    with refused("not-portable", "reduce"):
        saving.value_as_json(value)


def studies():
    """One over a grid with times of its own choice, and one whose runs end by an event."""
    grid = zd.grid({"crank.mass": [1.0, 2.0], "rocker.mass": [1.0, 2.0, 3.0]})
    falls = zd.Event("link.angle", value=-0.5, terminal=True)
    return (zd.ensemble(zd.models.four_bar(), 0.5, parameters=grid, step=0.01, t_eval=[0.0, 0.25, 0.5],
                        outputs=["crank.angle", "C.force"]),
            zd.ensemble(pendulum, 1.0, parameters={"length": [1.0, 0.0, 2.0]}, events=[falls], step=0.01, reduce=lowest,
                        outputs=["link.angle"]))


def test_xarray_has_all_of_it():
    pytest.importorskip("xarray")
    gridded, ragged = studies()
    data = gridded.to_xarray()
    assert dict(data.sizes) == {"crank.mass": 2, "rocker.mass": 3, "t": 3, "component": 2}
    chosen = data["C.force"].sel({"crank.mass": 2.0, "rocker.mass": 3.0, "t": 0.25, "component": "y"})
    assert float(chosen) == gridded["C.force.y"][5, 1]
    assert [data[name].attrs["units"] for name in ("C.force", "crank.angle", "t")] == ["N", "rad", "s"]
    data = ragged.to_xarray()
    assert dict(data.sizes) == {"run": 3, "row": len(ragged[2].t)}
    assert np.array_equal(data["link.angle"][2], ragged["link.angle"][2])
    assert np.array_equal(data["t"][0, :len(ragged[0].t)], ragged[0].t)
    assert np.isnan(data["link.angle"][1]).all()
    assert data["failed"].values.tolist() == [False, True, False]
    assert float(data["value"][2]) == ragged.values[2]
    assert data["length"].values.tolist() == [1.0, 0.0, 2.0]
    assert str(data["message"].values[1]).startswith("ValueError")


def test_pandas_has_all_of_it():
    pytest.importorskip("pandas")
    gridded, ragged = studies()
    table = gridded.to_pandas()
    assert list(table) == ["crank.mass", "rocker.mass", "crank.angle", "C.force.x", "C.force.y"]
    assert table["C.force.y"][5, 0.25] == gridded["C.force.y"][5, 1]
    assert ragged.to_pandas().groupby(level="run").size().to_dict() == {0: len(ragged[0].t), 2: len(ragged[2].t)}
    for reduce, column in ((lowest, "value"), (lambda sol: np.ones(2), "value[1]"), (lambda sol: "text", "value")):
        table = zd.ensemble(pendulum, 0.1, parameters={"length": [1.0, 0.0]}, step=0.01, reduce=reduce).to_pandas()
        assert {"length", column, "failed", "message"} <= set(table)
        assert table["failed"].tolist() == [False, True]


@pytest.mark.parametrize("name", ["xarray", "pandas"])
def test_what_is_not_installed_is_named(monkeypatch, name):
    monkeypatch.setitem(sys.modules, name, None)
    ens = zd.ensemble(zd.systems.oscillator(), 0.5, step=0.1)
    with refused("missing-package", rf"to_{name} needs {name}, .* pip install 'zerodrift\[ensembles\]'"):
        getattr(ens, f"to_{name}")()


def test_components_of_vectors():
    gridded, _ = studies()
    assert np.array_equal(gridded["C.force.x"], gridded["C.force"][..., 0])
    for name in ("C.force.z", "crank.angle.x", "B.force.x"):
        with refused("wrong-name"):
            _ = gridded[name]
    ens = zd.ensemble(pendulum, 1.0, parameters={"length": [1.0, 2.0]}, outputs=["link.end.position"],
                      integrator="dop853")
    assert [each.tolist() for each in ens["link.end.position.y"]] == [each[:, 1].tolist() for each in ens["link.end.position"]]
