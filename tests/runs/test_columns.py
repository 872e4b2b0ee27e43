"""Columns of a solution: files for other programs, plots of measures, names, and signs that are not mixed up."""

import csv

import numpy as np
import pytest

import zerodrift as zd
from support import refused


@pytest.fixture(scope="module")
def sol():
    return zd.simulate(zd.models.slider_crank(), 0.2, step=0.01)


def test_a_csv_file_has_all_digits(sol, tmp_path):
    path = sol.to_csv(tmp_path / "crank.csv", ["crank.angle", "slide.force"])
    with path.open(newline="") as file:
        heading, *rows = csv.reader(file)
    assert heading == ["t [s]", "crank.angle [rad]", "slide.force.x [N]", "slide.force.y [N]"]
    assert np.array_equal(np.array(rows, dtype=float), np.column_stack([sol.t, sol["crank.angle"], sol["slide.force"]]))


def test_without_names_a_file_has_coordinates_velocities_and_multipliers(sol, tmp_path):
    with sol.to_csv(tmp_path / "all.csv").open(newline="") as file:
        _, *rows = csv.reader(file)
    assert np.array_equal(np.array(rows, dtype=float), np.column_stack([sol.t, sol.p, sol.v, sol.multipliers]))


def test_the_multiplier_of_a_drive_is_not_named_as_its_force(tmp_path):
    m = zd.Mechanism("crank")
    m.motor("drive", m.revolute("pin", m.ground, m.link("link", (0, 0), (1, 0), mass=1.0).start), angle=lambda t: t**2)
    sol = zd.simulate(m, 0.1, step=0.05)
    heading, first = sol.to_csv(tmp_path / "all.csv").read_text().splitlines()[:2]
    assert heading.split(",")[-1] == "multiplier of drive"
    assert float(first.split(",")[-1]) == -sol["drive.torque"][0] != 0.0


def test_an_excel_file(sol, tmp_path):
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("openpyxl")
    found = pandas.read_excel(sol.to_excel(tmp_path / "crank.xlsx", "crank.angle"))
    assert list(found.columns) == ["t [s]", "crank.angle [rad]"]
    assert np.allclose(found["crank.angle [rad]"], sol["crank.angle"], rtol=1e-14, atol=0)      # Excel keeps 16 digits


def test_a_name_that_nothing_has_leaves_an_older_file(sol, tmp_path):
    path = sol.to_csv(tmp_path / "crank.csv", "crank.angle")
    before = path.read_bytes()
    with refused("wrong-name", "slider_crank"):
        sol.to_csv(path, "crank.angel")
    assert path.read_bytes() == before


def test_measures_are_listed(sol):
    m = zd.models.slider_crank()
    assert m.measures == sol.measures
    assert "slide.force" in sol.measures
    assert set(sol.measures) <= set(sol._ipython_key_completions_())
    assert zd.simulate(zd.systems.pendulum(), 0.1, step=0.1).measures == ()


def test_twelve_lines_differ_in_colour_or_dashes():
    m = zd.models.jansen()
    ax = zd.plot.measures(zd.simulate(m, 0.1, step=0.05), [name for name in m.measures if name.endswith(".force")][:6])
    assert len({(line.get_color(), line.get_linestyle()) for line in ax.get_lines()}) == len(ax.get_lines()) == 12


def test_lines_of_measures(sol):
    ax = zd.plot.measures(sol, ["slide.force", "crank.angle"])
    drawn = [line.get_ydata() for line in ax.get_lines()]
    assert np.array_equal(drawn[1], sol["slide.force"][:, 1])
    assert np.array_equal(drawn[2], sol["crank.angle"])


def test_the_multiplier_of_a_drive_is_not_taken_for_its_torque():
    sol = zd.simulate(zd.models.watt(), 0.1, step=0.01)
    with refused("duplicate-name", r"drive\.torque"):
        sol["drive"]
    constraint = [variable.name for variable in sol.system.constraints].index("drive")
    assert np.allclose(sol["drive.torque"], -sol.multipliers[:, constraint])


def test_without_step_and_integrator_steps_are_adaptive():
    sol = zd.simulate(zd.systems.pendulum(), 2.0)
    assert (sol.settings["integrator"], sol.settings["step"]) == ("dop853", None)
    assert (sol.settings["rtol"], sol.settings["atol"]) == (1e-6, 1e-9)
    assert zd.simulate(zd.systems.pendulum(), 2.0, step=0.1).settings["integrator"] == "rk4"
