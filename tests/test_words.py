"""What people see: names that are completed, systems that are printed, and refusals in words that name the argument."""

import importlib
import os
import re
import subprocess
import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

import zerodrift as zd
from support import SYSTEMS
from zerodrift.__main__ import main

mpl.use("Agg")
BAR = zd.systems.four_bar()
SOL = zd.simulate(BAR, 0.1, step=0.01)
PACKAGE = Path(zd.__file__).parent


def public_modules():
    """Those that `zerodrift` names, and those from which its documentation imports."""
    named = {f"zerodrift.{name}" for name in zd.__all__ if type(getattr(zd, name)) is type(zd)}
    written = "".join(path.read_text() for path in [*PACKAGE.rglob("*.py"), PACKAGE.parents[1] / "README.md"] if path.is_file())
    imported = re.findall(r"(?:>>> |^|    )(?:from|import) (zerodrift(?:\.[a-z]\w*)*)", written, flags=re.MULTILINE)
    packages = {f"zerodrift.{path.parent.name}" for path in PACKAGE.glob("[a-z]*/__init__.py") if "__all__" in path.read_text()}
    return sorted({"zerodrift", *named, *imported, *packages})


@pytest.mark.parametrize("name", public_modules())
def test_completion_shows_only_what_is_public(name):
    module = importlib.import_module(name)
    assert set(dir(module)) == set(module.__all__)
    assert all(hasattr(module, public) for public in module.__all__)


@pytest.mark.parametrize("kind", SYSTEMS)
def test_a_printed_system_says_what_it_is(kind):
    system = SYSTEMS[kind]
    text = str(system)
    assert text.startswith(f"{system.name}\n")
    for variable in (*system.coordinates, *system.velocities, *system.constraints):
        assert (f"{variable.name} [{variable.unit}]" if variable.unit else variable.name) in text
    for name in system.parameters:
        assert f"{name} = " in text
    assert f"freedom       {system.nv - system.m}\n" in text      # of the built-in ones, no row follows from others
    assert repr(system) != text


def test_printed_systems_of_all_kinds():
    twice = zd.System(["x", "y"], mass=np.eye(2), units=["m", "m"], p0=[1.0, 0.0], parameters={"L": 1.0},
                      constraints=lambda p, L: np.array([p @ p - L, 2 * (p @ p - L)]))
    assert "x [m], y [m]" in str(twice)
    assert "freedom       1, as 1 rows follow from others at the start" in str(twice)
    assert "L = 1.0" in str(twice)
    nowhere = zd.System(["x", "y"], mass=np.eye(2), constraints=lambda p: np.array([p @ p - 1.0]))
    assert "freedom       at least 1" in str(nowhere)
    assert "gravity = 9.81 m/s^2" in str(BAR)
    assert "coordinates" in str(zd.models.slider_crank())


WRONG = [None, "sol", 1.5, BAR]


@pytest.mark.parametrize("wrong", WRONG, ids=["None", "str", "float", "system"])
@pytest.mark.parametrize("name", ["motion", "violation", "energy", "energy_violation", "animate", "work_precision",
                                  "stability_map"])
def test_plots_of_what_is_none(name, wrong):
    with pytest.raises(TypeError, match=r"^(sol|result) must be (a Solution|what zd)"):
        getattr(zd.plot, name)(wrong)


@pytest.mark.parametrize("wrong", [None, "sol", 1.5])
def test_drawings_and_errors_of_what_is_none(wrong):
    with pytest.raises(TypeError, match="system_or_solution must be a system or a Solution, not"):
        zd.plot.mechanism(wrong)
    with pytest.raises(TypeError, match="sol must be a Solution"):
        zd.plot.error(wrong, SOL)
    with pytest.raises(TypeError, match="reference must be a Reference, a Solution or a callable"):
        zd.plot.error(SOL, wrong)


@pytest.mark.parametrize("wrong", [SOL, "ax", 3, BAR], ids=["Solution", "str", "int", "system"])
def test_axes_that_are_none(wrong):
    for draw in (zd.plot.motion, zd.plot.violation, zd.plot.energy, zd.plot.energy_violation, zd.plot.mechanism):
        with pytest.raises(TypeError, match="ax must be matplotlib's Axes, or left out for a new figure, not") as refused:
            draw(SOL, ax=wrong)
        assert "\n" not in str(refused.value)
        assert len(str(refused.value)) < 200
    with pytest.raises(TypeError, match="names must be names of coordinates"):
        zd.plot.motion(SOL, SOL)


def test_values_at_no_times():
    p, v = SOL([])
    assert p.shape == v.shape == (0, 3)
    assert SOL(np.zeros((2, 0)))[0].shape == (2, 0, 3)


LATE = np.append(np.linspace(0, 0.1, 200), 0.2)


@pytest.mark.parametrize(("times", "error", "message"), [
    (LATE, ValueError, r"be between 0 and 0.1, not 0.2\d* \(entry 200\)"), ([0.1j], TypeError, "hold real numbers"),
    (np.ma.masked_array([0.0, 0.1], [False, True]), ValueError, "hold real numbers, none of them masked"),
    ([0.0, np.nan], ValueError, r"be finite, not nan \(entry 1\)"), (["a"], TypeError, "hold real numbers"),
    ([[0.0], [0.0, 0.1]], ValueError, "not be a ragged sequence")])
def test_times_that_are_none(times, error, message):
    for call in (lambda: SOL(times), lambda: zd.simulate(BAR, 0.1, step=0.01, t_eval=times)):
        with pytest.raises(error, match=message) as refused:
            call()
        assert len(str(refused.value)) < 140


def test_times_that_do_not_increase():
    with pytest.raises(ValueError, match=r"t_eval must increase, but 0.05\d* \(entry 2\) comes after 0.06"):
        zd.simulate(BAR, 0.1, step=0.01, t_eval=[0.0, 0.06, 0.05])
    with pytest.raises(ValueError, match="needs at least one time"):
        zd.simulate(BAR, 0.1, step=0.01, t_eval=np.zeros(0))


def test_masked_and_complex_starts():
    masked = np.ma.masked_array(BAR.p0, [False, True, False])
    with pytest.raises(ValueError, match="p0 must hold real numbers, none of them masked"):
        zd.simulate(BAR, 0.1, masked, step=0.01)
    with pytest.raises(TypeError, match="v0 must hold real numbers, not complex128"):
        zd.simulate(BAR, 0.1, v0=BAR.v0 + 0j, step=0.01)
    assert zd.simulate(BAR, 0.1, np.ma.masked_array(BAR.p0), step=0.01).p.tobytes() == SOL.p.tobytes()


@pytest.mark.parametrize("folder", ["", "  ", "a\0b"], ids=["empty", "blank", "null"])
def test_folders_that_are_none(folder, capsys):
    with pytest.raises(SystemExit) as end:
        main(["reproduce", "--out", folder])
    assert end.value.code == 2
    assert "--out" in capsys.readouterr().err


def test_a_backend_that_is_none(tmp_path):
    done = subprocess.run([sys.executable, "-m", "zerodrift", "reproduce", "--out", str(tmp_path)], capture_output=True,
                          text=True, env=os.environ | {"MPLBACKEND": "nonsense"})
    assert done.returncode == 1
    assert "MPLBACKEND" in done.stderr
    assert "Traceback" not in done.stderr


def test_variables_are_held_as_their_names_are():
    guess, rates = [1.2, 0.3, -1.5], [2.0, 0.0, 0.0]
    named = zd.assemble(BAR, guess, rates, hold=("alpha1", "alpha1_dot"))
    given = zd.assemble(BAR, guess, rates, hold=(BAR.coordinates[0], BAR.velocities[0]))
    assert all((a == b).all() for a, b in zip(named, given, strict=True))
    assert zd.assemble(BAR, guess, hold=BAR.coordinates[0])[0][0] == 1.2
    with pytest.raises(ValueError, match="hold must be one of"):
        zd.assemble(BAR, guess, hold=zd.systems.oscillator().coordinates[0])
