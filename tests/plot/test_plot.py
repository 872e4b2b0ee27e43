"""Every drawing function on every built-in system, and what each must say when it cannot draw."""

import dataclasses

import matplotlib
import numpy as np
import pytest

import zerodrift as zd
from zerodrift import plot
from zerodrift.studies import compare

matplotlib.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.path import Path

from support import refused


@pytest.fixture(scope="module", params=zd.systems.__all__)
def sol(request):
    return zd.simulate(getattr(zd.systems, request.param)(), 1.0, step=0.01)


@pytest.fixture(scope="module")
def bar():
    return zd.simulate(zd.systems.four_bar(), 1.0, step=0.05)


@pytest.fixture(scope="module")
def oscillator():
    return zd.simulate(zd.systems.oscillator(), 1.0, step=0.05)


def altered(sol, **values):
    return dataclasses.replace(sol, **values)


def curves(ax):
    """The labelled lines by label."""
    return {line.get_label(): line for line in ax.lines if not line.get_label().startswith("_")}


def drawn(ax):
    """Draw the figure, so that errors and warnings of drawing are raised; return its axes."""
    ax.figure.canvas.draw()
    return ax


# ---- what every function does with any solution ----


def test_every_function_draws_into_the_axes_it_is_given(sol):
    drawings = [plot.motion, plot.energy, plot.energy_violation, lambda s, ax: plot.error(s, s, ax=ax), plot.mechanism]
    drawings += [plot.violation] if sol.system.constraints else []
    for draw in drawings:
        spatial = draw is plot.mechanism and sol.system.points(sol.system.p0).shape[1] == 3
        ax = plt.figure().add_subplot(projection="3d" if spatial else None)
        figures = plt.get_fignums()
        assert drawn(draw(sol, ax=ax)) is ax
        assert ax.lines or ax.collections
        assert plt.get_fignums() == figures


def test_every_function_makes_axes_of_its_own(sol):
    axes = [plot.motion(sol), plot.energy(sol), plot.energy_violation(sol, log=True), plot.error(sol, sol, log=True),
            plot.mechanism(sol), plot.mechanism(sol.system)]
    assert len(set(axes)) == len(plt.get_fignums()) == len(axes)


def test_nothing_global_is_touched_and_nothing_is_shown(sol, monkeypatch):
    monkeypatch.setattr(plt, "show", lambda *_: pytest.fail("show was called"))
    before = dict(matplotlib.rcParams)
    plot.motion(sol), plot.energy(sol), plot.mechanism(sol)
    assert dict(matplotlib.rcParams) == before


# ---- motion ----


def test_motion_takes_names_and_units_from_the_system(bar):
    ax = plot.motion(bar, ["alpha2", "alpha1_dot"])
    assert list(curves(ax)) == ["alpha2 [rad]", "alpha1_dot [rad/s]"]
    assert ax.get_ylabel() == "rad, rad/s"
    np.testing.assert_array_equal(ax.lines[1].get_ydata(), bar.v[:, 0])
    assert plot.motion(bar, "alpha1").get_ylabel() == "alpha1 [rad]"


def test_motion_says_which_names_there_are(bar):
    with refused("unknown-choice", "names.*'alpha1'.*'alpha3_dot', not 'beta'"):
        plot.motion(bar, "beta")


# ---- violation ----


def test_violation_draws_the_largest_component_on_a_logarithmic_scale(bar):
    ax = drawn(plot.violation(bar))
    assert ax.get_yscale() == "log"
    phi = np.abs(bar.position_violation).max(axis=1)
    shown = curves(ax)["position violation |Φ| [m]"].get_ydata()
    np.testing.assert_array_equal(shown[phi > 0], phi[phi > 0])
    assert "velocity violation |Ψ| [m/s]" in curves(ax)


def test_exact_zeros_are_triangles_on_the_lower_edge(bar):
    phi = np.zeros_like(bar.position_violation)
    phi[3:5] = 1e-9
    phi[7] = 1e-8
    ax = drawn(plot.violation(altered(bar, position_violation=phi), velocities=False))
    triangles = [line for line in ax.lines if line.get_marker() == "v"]
    dots = [line for line in ax.lines if line.get_marker() == "."]
    assert len(triangles[0].get_xdata()) == len(bar.t) - 3
    np.testing.assert_array_equal(dots[0].get_xdata(), bar.t[[7]])
    low = ax.transAxes.transform((0, 0))[1]
    assert triangles[0].get_transform().transform((0.0, 0.0))[1] == low


def test_a_violation_that_is_zero_throughout_can_be_drawn(bar):
    ax = drawn(plot.violation(altered(bar, position_violation=0 * bar.position_violation,
                                      velocity_violation=0 * bar.velocity_violation)))
    assert ax.get_ylim() == (1e-17, 1)


def test_violation_of_nonholonomic_constraints_only(bar):
    rolling = altered(bar, position_violation=np.empty((len(bar.t), 0)))
    assert list(curves(drawn(plot.violation(rolling)))) == ["velocity violation |Ψ| [m]"]
    assert plot.violation(rolling).get_ylabel() == "velocity violation |Ψ| [m]"


def test_a_run_that_blew_up_can_be_drawn():
    sol = zd.simulate(zd.systems.four_bar(), 8.0, step=0.05, stabilization=None, on_failure="return")
    assert not sol.success
    for ax in plot.violation(sol), plot.energy_violation(sol, log=True), plot.mechanism(sol), plot.energy(sol):
        drawn(ax)


def test_violation_needs_constraints(oscillator):
    with refused("not-available"):
        plot.violation(oscillator)


# ---- energy ----


def test_energy_draws_the_input_only_where_there_is_one(oscillator):
    assert list(curves(plot.energy(oscillator))) == ["T", "V", "E = T + V"]
    driven = altered(oscillator, energy_input=np.linspace(0, 1, len(oscillator.t)))
    assert list(curves(plot.energy(driven))) == ["T", "V", "E = T + V", "energy input"]


@pytest.mark.parametrize("draw", [plot.energy, plot.energy_violation])
def test_energy_needs_a_potential(oscillator, draw):
    with refused("not-available", "oscillator"):
        draw(altered(oscillator, potential_energy=None, energy_input=None, energy_violation=None))


# ---- error ----


def test_error_against_a_finer_solution(bar):
    fine = zd.simulate(bar.system, 1.0, step=0.005)
    ax = drawn(plot.error(bar, fine, "alpha1"))
    np.testing.assert_array_equal(ax.lines[0].get_ydata(), bar.p[:, 0] - fine.p[::10, 0])
    assert ax.get_ylabel() == "error of alpha1 [rad]"


def test_error_against_a_function(oscillator):
    ax = drawn(plot.error(oscillator, lambda t: 0.1 * np.cos(np.sqrt(10) * t), log=True))
    assert ax.get_ylabel() == "|error| of x [m]"


@pytest.mark.parametrize(("reference", "names", "code", "message"), [
    (lambda t: [1.0, 2.0], None, "shape", "3.*2"),
    (lambda t: [1.0, 2.0, 3.0], "alpha1_dot", "wrong-measure", "'alpha1'"),
    (3.0, None, "wrong-type", "must be a Reference, a Solution or a callable"),
])
def test_error_says_what_is_wrong_with_the_reference(bar, reference, names, code, message):
    with refused(code, message):
        plot.error(bar, reference, names)


@pytest.mark.parametrize(("end", "step"), [(1.0, 0.03), (0.5, 0.05)])
def test_error_needs_the_times(bar, end, step):
    with refused("not-available"):
        plot.error(bar, zd.simulate(bar.system, end, step=step))


def test_nearest_row():
    times = np.array([0.0, 1.0, 2.0])
    assert list(compare.nearest(times, np.array([-1.0, 0.4, 0.6, 1.2, 9.0]))) == [0, 0, 1, 1, 2]
    assert list(compare.nearest(times[:1], np.array([5.0]))) == [0]


# ---- drawings ----


class Spatial:
    """A triangle in space with a gap, as a system would give it."""

    name, nq, p0 = "spatial", 1, np.zeros(1)

    def points(self, p):
        return np.array([[0, 0, 0], [1, p[0], 0], [np.nan] * 3, [0, 1, 1.0], [0, 0, 1]])


def test_mechanism_in_space_gets_axes_in_space():
    ax = drawn(plot.mechanism(Spatial(), [0.5]))
    assert ax.name == "3d"
    with refused("wrong-dimension", "3D"):
        plot.mechanism(Spatial(), ax=plt.subplots()[1])


@pytest.mark.parametrize("animated", [False, True])
def test_a_drawing_in_space_has_equal_scales(animated):
    """A disc that rolls far is still round."""
    sol, ax = zd.simulate(zd.models.rolling_disc(), 2.0, step=0.01), plt.figure().add_subplot(projection="3d")
    if animated:
        plot.animate(sol, fps=1, ax=ax).to_jshtml()
    else:
        plot.mechanism(sol, ax=ax)
    spans = [np.ptp(limits) for limits in (ax.get_xlim(), ax.get_ylim(), ax.get_zlim())]
    scales = ax._box_aspect / spans       # matplotlib has no public way to ask
    assert np.ptp(scales) < 1e-12 * scales.max()


def test_a_plane_curve_in_space_has_room_for_its_ticks():
    """The rod of the spatial slider-crank turns in the plane x = 0, except for rounding."""
    sol = zd.simulate(zd.models.spatial_slider_crank(), 1.0)
    ax = plot.path(sol, "crank.end", ax=plt.figure().add_subplot(projection="3d"))
    spans = [np.ptp(limits) for limits in (ax.get_xlim(), ax.get_ylim(), ax.get_zlim())]
    assert np.ptp(sol["crank.end.position.x"]) < 1e-12 < 0.2 * max(spans) < min(spans)


def shapes(ax, kind):
    (found,) = [each for each in ax.collections if each.get_label() == f"_{kind}"]
    return [path.vertices for path in found.get_paths()]


def test_points_of_the_plane_are_joined_by_bars_and_what_rests_is_on_the_ground(bar):
    ax = drawn(plot.mechanism(bar))
    for points, corner in zip(shapes(ax, "link"), bar.system.points(bar.p[0])[:-1], strict=True):
        assert Path(points).contains_point(corner)
    supports = shapes(ax, "ground")[::3]      # between them, the line under each and its hatching
    np.testing.assert_allclose([points[:, 0].min() / 2 + points[:, 0].max() / 2 for points in supports], [0, 1], atol=0.01)
    assert len(shapes(ax, "pin")) == 4
    assert ax.get_aspect() == 1
    assert "_ground" in [each.get_label() for each in plot.mechanism(bar, bar.p[4]).collections]
    assert "_ground" not in [each.get_label() for each in plot.mechanism(bar.system).collections]    # it has no ground


class Curve(Spatial):
    """A wave of many points, a gap, and a bar, in the plane."""

    def points(self, p):
        x = np.linspace(0, 1, 30)
        return np.vstack([np.column_stack([x, np.sin(9 * x)]), [np.nan, np.nan], [[0, 0], [1, p[0]]], [np.nan, np.nan], [[2, 0]]])


def test_curves_of_many_points_stay_curves_and_points_alone_are_masses():
    ax = drawn(plot.mechanism(Curve(), [0.5]))
    (wave,), (rod,), (mass,) = (shapes(ax, kind) for kind in ("curve", "link", "particle"))
    np.testing.assert_allclose(wave, Curve().points([0.5])[:30])
    assert rod.max() > 1.0
    np.testing.assert_allclose(mass[:-1].mean(axis=0), [2, 0], atol=1e-12)


def test_mechanism_needs_a_drawing(bar):
    class Bare(Spatial):
        def points(self, p):
            return None

    with refused("not-available"):
        plot.mechanism(Bare())


def test_animation_is_in_real_time(bar):
    film = plot.animate(bar, fps=5)
    page = film.to_jshtml()
    assert page.count("frames[") >= 6
    assert film._interval == 200
    slow = plot.animate(bar, fps=5, speed=0.5)
    assert len(list(slow.new_frame_seq())) == 11
    slow._draw_frame(10)
    assert slow._fig.axes[0].get_title() == "t = 1.00 s"
    slow._draw_was_started = True     # matplotlib warns of animations that were never shown


@pytest.mark.parametrize("name", ["fps", "speed"])
def test_animation_refuses_times_that_make_no_sense(bar, name):
    with refused("out-of-range", f"{name} must be greater than 0"):
        plot.animate(bar, **{name: 0.0})


def test_an_integrator_has_its_colour_whatever_stands_beside_it():
    options = {"formulations": ["schur"], "rounds": 1}
    some, alone = (plot.work_precision(zd.work_precision(zd.systems.oscillator(), 1.0, integrators=names, **options))
                   for names in (["euler", "dop853"], ["dop853"]))
    colours = [{line.get_label(): line.get_color() for line in ax.get_legend().legend_handles} for ax in (some, alone)]
    assert colours[0]["dop853"] == colours[1]["dop853"] != colours[0]["euler"]
    assert alone.lines[0].get_color() == colours[1]["dop853"]
    assert "euler" not in colours[1]


# ---- wrong arguments ----


BAR = zd.systems.four_bar()
SOL = zd.simulate(BAR, 0.1, step=0.01)
WRONG = [None, "sol", 1.5, BAR]


@pytest.mark.parametrize("wrong", WRONG, ids=["None", "str", "float", "system"])
@pytest.mark.parametrize("name", ["motion", "violation", "energy", "energy_violation", "animate", "work_precision",
                                  "stability_map"])
def test_plots_of_what_is_none(name, wrong):
    with refused("wrong-type", r"^(sol|result) must be (a Solution|what zd)"):
        getattr(zd.plot, name)(wrong)


@pytest.mark.parametrize("wrong", [None, "sol", 1.5])
def test_drawings_and_errors_of_what_is_none(wrong):
    with refused("wrong-type", "system_or_solution"):
        zd.plot.mechanism(wrong)
    with refused("wrong-type", "^sol must"):
        zd.plot.error(wrong, SOL)
    with refused("wrong-type", "reference"):
        zd.plot.error(SOL, wrong)


@pytest.mark.parametrize("wrong", [SOL, "ax", 3, BAR], ids=["Solution", "str", "int", "system"])
def test_axes_that_are_none(wrong):
    for draw in (zd.plot.motion, zd.plot.violation, zd.plot.energy, zd.plot.energy_violation, zd.plot.mechanism):
        with refused("wrong-type", "^ax must") as caught:
            draw(SOL, ax=wrong)
        assert "\n" not in str(caught.value)
        assert len(str(caught.value)) < 200
    with refused("wrong-type", "names"):
        zd.plot.motion(SOL, SOL)


THREE = ["alpha1", "alpha2", "alpha3"]
SIX = [*THREE, "alpha1_dot", "alpha2_dot", "alpha3_dot"]
DRAWN = {"motion": plot.motion, "violation": plot.violation, "energy": plot.energy,
         "measures": lambda sol: plot.measures(sol, THREE), "six measures": lambda sol: plot.measures(sol, SIX)}


@pytest.mark.parametrize("draw", DRAWN.values(), ids=DRAWN)
def test_legends_cover_no_curve(bar, draw):
    """On the canvas: no point of a curve lies in the box of the legend."""
    ax = draw(bar)
    ax.figure.canvas.draw()
    box = ax.get_legend().get_window_extent()
    for line in ax.lines:
        points = line.get_transform().transform(line.get_xydata())
        points = points[np.isfinite(points).all(axis=1)]
        assert not box.count_contains(points)


def test_room_for_a_legend_does_not_grow_with_each_curve(bar):
    ax = plot.violation(bar, positions=False, label="one")
    once = ax.get_ylim()
    plot.violation(bar, positions=False, label="one", ax=ax)
    plot.violation(bar, positions=False, label="one", ax=ax)
    assert ax.get_ylim()[1] < 10 * once[1]


def test_energies_of_several_runs_have_one_axis():
    """Logarithmic where they differ by more than a factor of 100."""
    bar = zd.models.four_bar()
    runs = [zd.simulate(bar, 0.5, step=0.01, integrator=each) for each in ("heun", "rk4")]
    alike, apart = (zd.plot.energy_violation(each) for each in ([runs[0], runs[0]], runs))
    assert (alike.get_yscale(), apart.get_yscale()) == ("linear", "log")
    assert [line.get_label() for line in alike.lines] == ["heun", "heun"]
    assert {"heun", "rk4"} <= {line.get_label() for line in apart.lines}
    assert np.asarray(apart.lines[0].get_ydata())[1:] == pytest.approx(np.abs(runs[0].energy_violation)[1:])
    plt.close("all")


def test_a_mode_has_its_position_at_rest_and_both_extremes():
    bar = zd.models.four_bar()
    ax = zd.plot.mode(zd.linearize(bar, zd.equilibrium(bar)))
    rest, one, other = (np.asarray(line.get_data()) for line in ax.lines[-3:])
    assert [line.get_label() for line in ax.lines[-3:]] == ["at rest", "one extreme", "other extreme"]
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["at rest", "one extreme", "other extreme"]
    far = np.nanmax(np.abs(one - rest))
    assert far > 0.01
    assert np.nanmax(np.abs(one + other - 2 * rest)) < far
    plt.close("all")
