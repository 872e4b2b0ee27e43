"""Pictures of mechanisms: names, forces to a scale, paths of points, other positions; in films, too."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import zerodrift as zd
from drawn import centres, is_among, outlines, sorts
from support import refused
from zerodrift.plot import annotations


@pytest.fixture(scope="module")
def loaded():
    """All that forces can be asked of, in a four-bar."""
    m = zd.Mechanism("loaded", gravity=(0, -9.81))
    crank = m.link("crank", (0, 0), (0, 0.3), mass=1.5)
    coupler = m.link("coupler", (0, 0.3), (0.95, 0.6), mass=5.0, length=1.0)
    rocker = m.link("rocker", (0.95, 0.6), (1, 0), mass=3.0, length=0.6)
    m.revolute("A", m.ground, crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.start)
    m.revolute("D", rocker.end, m.ground.point((1, 0)))
    coupler.point((0.5, 0.35), name="P")
    wheel = m.body("wheel", 1.0, 0.02, at=(1.5, 0.2))
    m.rolling("road", m.ground, wheel, radius=0.2)
    m.spring("coil", coupler.center, wheel.point((0, 0)), stiffness=60.0, damping=2.0)
    m.actuator("jack", m.ground.point((0.4, -0.3)), coupler.start, force=7.0)
    m.bushing("rubber", rocker, wheel, at=(1.2, 0.3), stiffness=30.0)
    m.force("wind", coupler, along=(0.6, 0.8), value=-4.0)
    return zd.simulate(m, 0.4, step=0.005)


def shown_forces(ax):
    """The tails and vectors in N of the arrows, from what is drawn alone: by the arrow that says the scale."""
    (words,) = [text for text in ax.texts if text.get_label() == "_scale"]
    (key,) = outlines(ax, "scale")
    value, unit = words.get_text().split()
    per_metre = float(value) * {"mN": 1e-3, "N": 1.0, "kN": 1e3}[unit] / np.ptp(key[:, 0])
    names = [text.get_text() for text in ax.texts if text.get_label() == "_force" and text.get_visible()]
    ends = [((points[0] + points[-2]) / 2, points[3]) for points in outlines(ax, "forces")]
    return {name: (tail, (tip - tail) * per_metre) for name, (tail, tip) in zip(names, ends, strict=True)}


@pytest.mark.parametrize("row", [20, 80])
def test_arrows_are_forces_to_the_scale_that_is_said(loaded, row):
    found = shown_forces(zd.plot.mechanism(loaded, t=loaded.t[row], forces=True))
    sizes = {name: np.hypot(*loaded[f"{name}.force"][row]) for name in ("A", "B", "C", "D", "road", "rubber")} | {"wind": 4.0}
    assert set(found) == {name for name, size in sizes.items() if size > 0.02 * max(sizes.values())}
    for name in set(found) - {"wind"}:
        np.testing.assert_allclose(found[name][1], loaded[f"{name}.force"][row], rtol=1e-9)
    for name in "ABCD":
        np.testing.assert_allclose(found[name][0], loaded[f"{name}.position"][row], atol=1e-12)
    np.testing.assert_allclose(found["wind"][1], (-2.4, -3.2), rtol=1e-9)
    np.testing.assert_allclose(found["wind"][0], loaded["coupler.center.position"][row], atol=1e-12)
    np.testing.assert_allclose(found["road"][0], loaded["wheel.position"][row] - [0, 0.2], atol=1e-9)


def test_springs_pull_and_cylinders_push_along_themselves(loaded):
    found = shown_forces(zd.plot.mechanism(loaded, t=loaded.t[40], forces=["coil", "jack"]))
    middle, wheel, foot, head = (loaded[f"{name}.position"][40] if name else np.array([0.4, -0.3])
                                 for name in ("coupler.center", "wheel", "", "coupler.start"))
    pull, push = (middle - wheel) / np.hypot(*(middle - wheel)), (head - foot) / np.hypot(*(head - foot))
    np.testing.assert_allclose(found["coil"][1], loaded["coil.force"][40] * pull, rtol=1e-6)
    np.testing.assert_allclose(found["jack"][1], 7.0 * push, rtol=1e-6)


def test_a_scale_can_be_given_and_is_said_by_a_round_number(loaded):
    for scale in (100.0, 1e5):
        ax = zd.plot.mechanism(loaded, forces="C", force_scale=scale, t=0.0)
        (key,) = outlines(ax, "scale")
        (words,) = [text.get_text() for text in ax.texts if text.get_label() == "_scale"]
        value, unit = words.split()
        assert np.ptp(key[:, 0]) * scale == pytest.approx(float(value) * (1e3 if unit == "kN" else 1.0))
        assert value[0] in "125"


@pytest.mark.parametrize("dimension", [2, 3])
def test_forces_of_zero_have_no_scale(dimension):
    m = zd.Mechanism("bar", dimension=dimension)
    m.revolute("pin", m.ground, m.link("bar", (0, 0, 0)[:dimension], (1, 0, 0)[:dimension], mass=1.0).start,
               **({} if dimension == 2 else {"axis": (0, 0, 1)}))
    ax = zd.plot.mechanism(zd.simulate(m, 0.1, step=0.05), forces=["pin"])
    assert [each for each in [*ax.texts, *ax.collections] if each.get_label() == "_scale"] == []


def test_a_load_that_is_to_scale_is_a_number(loaded):
    assert len(outlines(zd.plot.mechanism(loaded, t=0.0), "load")) == 1
    assert not [each for each in zd.plot.mechanism(loaded, t=0.0, forces="wind").collections if each.get_label() == "_load"]


@pytest.mark.parametrize("path", ["P", "P.position", "coupler.end", ["P", "C"]])
def test_paths_are_those_of_the_points(loaded, path):
    lines = [line for line in zd.plot.mechanism(loaded, path=path).lines if line.get_label() == "_path"]
    names = {"P": ["P"], "P.position": ["P"], "coupler.end": ["C"]}.get(path, path) if isinstance(path, str) else path
    for line, name in zip(lines, names, strict=True):
        np.testing.assert_allclose(line.get_xydata(), loaded[f"{name}.position"], atol=1e-9)
    alone = zd.plot.path(loaded, path)
    assert len(alone.lines) == len(lines)
    assert alone.get_aspect() == 1.0


def test_names_are_written_once_each():
    ax = zd.plot.mechanism(sorts(), names=True)
    written = [text.get_text() for text in ax.texts if text.get_label() == "_name"]
    assert len(written) == len(set(written))
    assert {"arm", "hinge", "bob", "tracer", "coil", "band", "rod", "jack", "turn", "push", "rail", "seam"} <= set(written)


@pytest.mark.parametrize(("ghosts", "count"), [(None, 8), (0, 0), (3, 3), ([0.1, 0.2], 2), (np.array([0.0]), 1)])
def test_other_positions_are_faint(loaded, ghosts, count):
    ax = zd.plot.mechanism(loaded, ghosts=ghosts)
    faint = [each for each in ax.collections if each.get_label() == "_ghosts"]
    assert sum(len(each.get_segments()) for each in faint) == 5 * count       # four bodies and the wheel's rim
    if isinstance(ghosts, list):
        start = loaded["crank.end.position"][20]
        assert is_among(start, np.vstack(faint[0].get_segments()))


def test_a_time_is_that_of_the_nearest_row(loaded):
    ax = zd.plot.mechanism(loaded, t=0.2012)
    assert is_among(loaded["C.position"][40], centres(ax, "pin"))
    assert not [each for each in ax.collections if each.get_label() == "_ghosts"]


def test_films_show_forces_names_and_paths_of_their_last_frame(loaded, tmp_path):
    film = zd.plot.animate(loaded, fps=5, names=True, path="P", forces=["A", "C"])
    film.save(tmp_path / "film.gif", writer="pillow", dpi=30)
    assert (tmp_path / "film.gif").read_bytes()[:4] == b"GIF8"
    ax = film._fig.axes[0]
    found = shown_forces(ax)
    for name in "AC":
        np.testing.assert_allclose(found[name][1], loaded[f"{name}.force"][-1], rtol=1e-9)
    (crank,) = [text for text in ax.texts if text.get_text() == "crank"]
    middle = (loaded["crank.start.position"][-1] + loaded["crank.end.position"][-1]) / 2
    assert np.hypot(*(crank.get_position() - middle)) < 0.2


@pytest.mark.parametrize(("given", "code", "says"), [
    ({"forces": "E"}, "unknown-choice", "'A', 'B', 'C', 'D'.*'E'"),
    ({"path": "Q"}, "wrong-name", "Q.position"),
    ({"path": 3}, "wrong-type", "'F' or rod.end, not 3"),
    ({"ghosts": -1}, "out-of-range", "ghosts.*between 0"),
    ({"ghosts": [9.0]}, "out-of-range", "ghosts.*between 0.*and 0.4"),
    ({"t": np.nan}, "not-finite", "^t must"),
    ({"t": 0.1, "p": "end"}, "conflicting-arguments", "^t must"),
    ({"forces": True, "p": "end"}, "conflicting-arguments", "forces"),
    ({"force_scale": 0.0, "forces": True}, "out-of-range", "force_scale.*than 0")])
def test_what_cannot_be_drawn_is_said(loaded, given, code, says):
    given = given | ({"p": loaded.p[-1]} if "p" in given else {})
    with refused(code, says):
        zd.plot.mechanism(loaded, **given)


@pytest.mark.parametrize("given", [{"path": "F"}, {"forces": True}, {"t": 0.1}, {"ghosts": 3}])
def test_what_needs_a_motion_says_so(given):
    with refused("conflicting-arguments", f"{next(iter(given))} must be left out for a system in one position: it needs"):
        zd.plot.mechanism(sorts(), **given)


@pytest.mark.parametrize("given", [{"names": True}, {"forces": True}])
def test_what_needs_bodies_and_joints_says_so(given):
    with refused("not-available", f"{next(iter(given))} must be left out for .*, which is drawn from its points"):
        zd.plot.animate(zd.simulate(zd.systems.pendulum(), 0.1, step=0.01), **given)


@pytest.mark.parametrize(("value", "rounded"), [(0.73, 0.5), (1.0, 1.0), (4.9, 2.0), (999.0, 500.0), (0.0, 1.0)])
def test_round_numbers(value, rounded):
    assert annotations.round_number(value) == pytest.approx(rounded)


def test_a_load_of_zero_is_not_drawn_and_symbols_beside_arrows_are_hollow():
    m = zd.Mechanism("cantilever", gravity=(0, -9.81))
    beam = m.link("beam", (0, 0), (1, 0), mass=100.0)
    m.revolute("A", m.ground, beam.start)
    m.force("nothing", beam.end, along=(0, 1), value=0.0)
    m.torque("no moment", beam, value=0.0)
    m.force("wind", beam.end, along=(1, 1), value=5.0)
    sol = zd.simulate(m, 0.1, step=0.01)
    to_scale, alone = zd.plot.mechanism(sol, t=0.0, forces=["A"], names=True), zd.plot.mechanism(sol, t=0.0)
    assert len(outlines(alone, "load")) == 1
    assert len(outlines(to_scale, "load_symbol")) == 1
    for ax in (to_scale, alone):
        assert not [each for each in ax.collections if each.get_label() == "_moment"]
    assert not [each for each in to_scale.collections if each.get_label() == "_load"]
    assert "nothing" not in {text.get_text() for text in to_scale.texts}


def test_paths_in_space_are_those_of_the_points():
    m = zd.Mechanism("pendulum", dimension=3, gravity=(0, 0, -9.81))
    m.rod("wire", m.ground.point((0, 0, 0)), m.particle("bob", 1.0, at=(1, 0, -1)))
    sol = zd.simulate(m, 1.0, step=0.01)
    ax = zd.plot.path(sol, "bob")
    np.testing.assert_array_equal(np.array(ax.lines[0].get_data_3d()).T, sol["bob.position"])
    with refused("wrong-dimension", "3D"):
        zd.plot.path(sol, "bob", ax=plt.figure().add_subplot())
