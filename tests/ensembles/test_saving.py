"""Ensembles that are saved and loaded, and what becomes of them in xarray and pandas."""

import numpy as np
import pytest

import zerodrift as zd
from small_studies import lowest, pendulum
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
    with pytest.raises(TypeError, match="reduce must return what a file keeps"):
        saving.value_as_json(value)
