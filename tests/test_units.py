"""Units of display: one mechanism for files, tables, pictures, films and sliders."""

import csv
import json
import re

import matplotlib.pyplot as plt
import numpy as np
import pytest

import zerodrift as zd
from every_model import IN_SPACE, MECHANISMS
from support import refused
from zerodrift import units

CHOSEN = {"length": "mm", "angle": "deg", "velocity": "km/h", "angular_velocity": "rpm", "force": "kN", "torque": "kN m",
          "energy": "kJ", "power": "kW", "mass": "g", "time": "ms"}
# Independent of the package's table: what one SI unit is in that of display.
FACTORS = {"length": 1e3, "angle": 180 / np.pi, "velocity": 3.6, "angular_velocity": 30 / np.pi, "force": 1e-3, "torque": 1e-3,
           "energy": 1e-3, "power": 1e-3, "mass": 1e3, "time": 1e3}
BY_NAME = (("angular_velocity", "angular_velocity"), ("velocity", "velocity"), ("torque", "torque"), ("force", "force"),
           ("tension", "force"), ("power", "power"), ("position", "length"), ("length", "length"), ("displacement", "length"),
           ("angle", "angle"))


@pytest.fixture(autouse=True)
def _closed():
    yield
    plt.close("all")


def crank():
    return zd.simulate(zd.models.slider_crank(), 0.2, step=0.01)


@pytest.mark.parametrize("name", sorted({**MECHANISMS, **IN_SPACE}))
def test_each_measure_knows_its_quantity(name):
    """The last word of a measure says which quantity it is; all others have units of none."""
    system = getattr(zd.models, name)().system()
    for measure in system.measures:
        unit, word = system._unit_of_measure(measure), measure.rpartition(".")[2]
        quantity = next((quantity for end, quantity in BY_NAME if word == end), None)
        if quantity:
            assert units.OF_UNIT[unit] == quantity, measure
        else:
            assert unit in units.OF_UNIT or unit in ("", "m/s^2", "rad/s^2", "kg m/s", "kg m^2/s"), (measure, unit)


def test_factors_of_all_units():
    """Each quantity by one unit from another source, and units of a quantity between each other."""
    for quantity, unit in CHOSEN.items():
        with zd.display_units({quantity: unit}):
            assert units.shown(units.QUANTITIES[quantity]) == (unit, pytest.approx(FACTORS[quantity], rel=1e-14))
            assert units.shown("kg m^2") == ("kg m^2", 1.0)
    table = units.UNITS
    assert table["length"]["ft"] == pytest.approx(12 * table["length"]["in"])
    assert table["velocity"]["mph"] == pytest.approx(5280 * table["length"]["ft"] / table["time"]["h"])
    assert table["torque"]["lbf ft"] == pytest.approx(table["force"]["lbf"] * table["length"]["ft"])
    assert table["torque"]["lbf in"] == pytest.approx(table["force"]["lbf"] * table["length"]["in"])
    assert table["force"]["lbf"] == pytest.approx(table["mass"]["lb"] * 9.80665)
    assert table["power"]["hp"] == pytest.approx(550 * table["torque"]["lbf ft"])
    assert all(known[units.QUANTITIES[quantity]] == 1 for quantity, known in table.items())


def test_files_and_tables(tmp_path):
    sol, names = crank(), ["crank.angle", "crank.angular_velocity", "main.force", "slide.speed", "crank.position"]
    path = sol.to_csv(tmp_path / "a.csv", names, display=CHOSEN)
    heading, *rows = csv.reader(path.read_text().splitlines())
    assert heading == ["t [ms]", "crank.angle [deg]", "crank.angular_velocity [rpm]", "main.force.x [kN]", "main.force.y [kN]",
                       "slide.speed [km/h]", "crank.position.x [mm]", "crank.position.y [mm]"]
    values = np.array(rows, dtype=float)
    assert values[:, 0] == pytest.approx(1e3 * sol.t)
    assert values[:, 1] == pytest.approx(np.degrees(sol["crank.angle"]))
    assert values[:, 3] == pytest.approx(1e-3 * sol["main.force.x"])
    frame = sol.to_frame(names, display=CHOSEN)
    assert [frame.index.name, *frame] == heading
    assert frame.to_numpy() == pytest.approx(values[:, 1:])
    with zd.display_units(CHOSEN):
        assert sol.to_csv(tmp_path / "b.csv", names).read_bytes() == path.read_bytes()
    assert sol.to_csv(tmp_path / "c.csv", names).read_text().startswith("t [s],crank.angle [rad]")


def test_excel(tmp_path):
    openpyxl, sol = pytest.importorskip("openpyxl"), crank()
    sheet = openpyxl.load_workbook(sol.to_excel(tmp_path / "a.xlsx", "crank.angle", display={"angle": "deg"})).active
    assert sheet["B1"].value == "crank.angle [deg]"
    assert sheet["B2"].value == pytest.approx(np.degrees(sol["crank.angle"][0]))


def labels(ax):
    return {ax.get_xlabel(), ax.get_ylabel(), *(line.get_label() for line in ax.lines)}


def test_curves_of_a_solution():
    sol = crank()
    for draw, expected in ((lambda display: zd.plot.measures(sol, ["main.force.x"], display=display), "main.force.x [kN]"),
                           (lambda display: zd.plot.motion(sol, display=display), "deg"),
                           (lambda display: zd.plot.energy(sol, display=display), "energy [kJ]"),
                           (lambda display: zd.plot.energy_violation(sol, display=display), "energy violation [kJ]"),
                           (lambda display: zd.plot.error(sol, sol, display=display), None),
                           (lambda display: zd.plot.violation(sol, display=display), None)):
        ax, plain = draw(CHOSEN), draw(None)
        assert "t [ms]" in labels(ax)
        assert "t [s]" in labels(plain)
        assert ax.lines[0].get_xdata() == pytest.approx(1e3 * np.asarray(plain.lines[0].get_xdata()))
        if expected:
            assert expected in labels(ax)
            ratio = np.asarray(ax.lines[0].get_ydata())[-1] / np.asarray(plain.lines[0].get_ydata())[-1]
            assert ratio == pytest.approx(180 / np.pi if expected == "deg" else 1e-3)


def test_a_vector_in_the_axes_of_a_body_has_its_name():
    ax = zd.plot.measures(crank(), [("main.force", "crank")], display={"force": "kN"})
    assert [line.get_label() for line in ax.lines] == ["main.force.x in crank", "main.force.y in crank"]
    assert ax.get_ylabel() == "kN"


def test_polar():
    sol = crank()
    ax = zd.plot.polar(sol, ("main.force", "crank"), display={"force": "kN"})
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("main.force.x in crank [kN]", "main.force.y in crank [kN]")
    assert np.hypot(*ax.lines[0].get_data()) == pytest.approx(1e-3 * np.linalg.norm(sol["main.force"], axis=1))
    with refused("wrong-measure", "crank.angle"):
        zd.plot.polar(sol, "crank.angle")
    space = zd.simulate(zd.models.heavy_top(), 0.1, step=0.01)
    name = next(each for each in space.measures if each.endswith(".force"))
    ax = zd.plot.polar(space, name, plane="zx")
    assert ax.lines[0].get_xdata() == pytest.approx(space[name][:, 2])
    assert ax.lines[0].get_ydata() == pytest.approx(space[name][:, 0])


def test_pictures_of_many_runs():
    ens = zd.ensemble(zd.models.slider_crank(), 0.1, parameters={"rod.mass": [1.0, 2.0, 3.0]}, step=0.01,
                      outputs=["main.force.x", "crank.angle"])
    ax = zd.plot.against(ens, "rod.mass", "main.force.x", at=0.05, display=CHOSEN)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("rod.mass [g]", "main.force.x [kN] at t = 50 ms")
    assert np.asarray(ax.collections[0].get_offsets())[:, 0] == pytest.approx([1e3, 2e3, 3e3])
    ax = zd.plot.bands(ens, "crank.angle", display=CHOSEN)
    assert labels(ax) >= {"t [ms]", "crank.angle [deg]"}
    assert ax.lines[0].get_ydata() == pytest.approx(np.degrees(ens["crank.angle"][1]))


def test_pictures_of_studies():
    spring = zd.systems.oscillator()
    found = zd.work_precision(spring, 0.2, integrators=["rk4"], steps=[0.02, 0.01], rounds=1)
    ax, plain = zd.plot.work_precision(found, display={"time": "us"}), zd.plot.work_precision(found)
    assert (ax.get_xlabel(), plain.get_xlabel()) == ("time [us]", "time [ms]")
    assert ax.lines[0].get_xdata() == pytest.approx(1e3 * np.asarray(plain.lines[0].get_xdata()))
    mapped = zd.stability_map(lambda mass: zd.systems.oscillator(mass=mass), 0.2, steps=[0.02, 0.04], values=[1.0, 2.0],
                              parameter="mass [kg]", ways={"projection": {}})
    ax = zd.plot.stability_map(mapped, display=CHOSEN)[0]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("step [ms]", "mass [g]")
    assert ax.get_xlim() == pytest.approx([20 / 2**0.5, 40 * 2**0.5])
    assert ax.get_ylim() == pytest.approx([1e3 / 2**0.5, 2e3 * 2**0.5])
    lins = [zd.linearize(spring, (0.0, [0.0], [0.0]))]
    ax = zd.plot.root_locus(lins, [5.0], label="speed [m/s]", display=CHOSEN)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("real part [1/ms]", "imaginary part [rpm]")
    drawn = ax.collections[0]
    assert sorted(drawn.get_offsets()[:, 1]) == pytest.approx(sorted(30 / np.pi * lins[0].eigenvalues.imag))
    assert list(drawn.get_array()) == pytest.approx([18.0, 18.0])
    assert drawn.colorbar.ax.get_ylabel() == "speed [km/h]"


def test_traces():
    traced = zd.trace(zd.models.four_bar(), "crank.angle", np.linspace(1.5, 1.7, 5), forces=True)
    ax = zd.plot.trace(traced, ["effort"], display=CHOSEN)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("crank.angle [deg]", "effort [kN m]")
    assert ax.lines[0].get_ydata() == pytest.approx(1e-3 * traced["effort"])


def test_films_explorations_and_live_pages():
    sol = crank()
    film = zd.view(sol, graphs=["crank.angle"], forces=True, display=CHOSEN)
    scene = json.loads(re.search(r'id="scene">(.*?)</script>', film.page, re.S)[1])
    line, arrow = scene["graphs"][0], scene["layers"][0]["arrows"][0]
    assert (line["name"], line["unit"]) == ("crank.angle", "deg")
    assert line["most"] == pytest.approx(np.degrees(sol["crank.angle"].max()), rel=1e-6)
    assert (arrow["unit"], arrow["factor"]) == ("kN", 1e-3)
    assert {load["unit"] for load in scene["layers"][0]["loads"]} <= {"kN", "kN m"}
    found = zd.explore(zd.models.slider_crank(), {"rod.mass": (0.5, 2.0)}, 0.1, step=0.01, graphs=["crank.angle"], display=CHOSEN)
    assert '"unit":"deg"' in found.film.page
    assert '"unit":"deg"' in found.set({"rod.mass": 1.5}).film.page
    ipywidgets = pytest.importorskip("ipywidgets")
    slider = next(each for each in found.widget().children if isinstance(each, ipywidgets.FloatSlider))
    assert (slider.description, slider.value, slider.max) == ("rod.mass [g]", pytest.approx(1500), pytest.approx(2000))
    slider.value = 750.0
    assert found.values["rod.mass"] == pytest.approx(0.75)


def test_loads():
    sol = crank()
    table = sol.loads("crank.angle", display=CHOSEN)
    main = table["main"]["force"]
    size = np.linalg.norm(sol["main.force"], axis=1)
    assert (main.magnitude, main.t, main.is_unique) == (size.max(), sol.t[size.argmax()], True)
    assert main.angle == sol["crank.angle"][size.argmax()]
    assert re.search(rf"main +force +{1e-3 * main.magnitude:.6g} +kN", str(table))
    frame = table.to_frame()
    assert list(frame) == ["joint", "quantity", "maximum", "unit", "t [ms]", "crank.angle [deg]", "unique"]
    assert frame["maximum"][0] == pytest.approx(1e-3 * main.magnitude)
    redundant = zd.simulate(zd.models.planetary_gear(), 0.01, step=1e-3).loads()
    assert "not unique" in str(redundant) or all(row.is_unique for row in redundant.rows)
    with refused("wrong-type", "mechanism"):
        zd.simulate(zd.systems.oscillator(), 0.1, step=0.01).loads()


def test_wrong_units():
    with refused("unknown-choice", "quantity"):
        zd.display_units(pressure="bar")
    with refused("unknown-choice", "kN"):
        crank().to_frame(display={"force": "kilo"})
    with refused("wrong-type", "dict"):
        crank().loads(display="kN")
