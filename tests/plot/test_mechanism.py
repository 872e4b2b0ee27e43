"""Pictures of mechanisms: every part is there as its kind is drawn, where the measures say that it is, in every frame."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from scipy.spatial import ConvexHull

import zerodrift as zd
from drawn import centres, collection, is_among, outlines, sorts
from few_bodies import falling_box
from zerodrift.mechanisms.elements.joints import JOINTS
from zerodrift.mechanisms.elements.table_forces import ELEMENTS
from zerodrift.plot import annotations, marks
from zerodrift.plot.glyphs import GLYPHS
from zerodrift.plot.mechanism import Picture
from zerodrift.systems.shapes import Shape

sys.path.insert(0, str(Path(__file__).parents[1] / "mechanisms"))
import every_element
import every_joint_by_row

ON_MOVING_BODIES = {"slot": {"groove", "block"}, "prismatic": {"guide", "slider"}}
LOOKS = {"revolute": {"pin"}, "weld": {"weld"}, "rod": {"rod"}, "rolling": {"road", "wheel"}, "knife_edge": {"blade"},
         **{kind: looks | {"pin"} if kind == "slot" else looks for kind, looks in ON_MOVING_BODIES.items()},
         "spring": {"spring", "damper"}, "bushing": {"bushing"}, "force": {"load"}, "torque": {"moment"},
         "torsion_spring": {"spiral"}}


def shapes_at(system, p):
    return system._sketches([p])[0]


def planetary():
    """The ring is the ground, the sun turns against the carrier, as the planet does."""
    m = zd.Mechanism("planetary")
    carrier, sun, planet = m.body("carrier", 1.0, 0.1), m.body("sun", 1.0, 0.1), m.body("planet", 1.0, 0.1, at=(0.45, 0))
    arm = m.revolute("arm", m.ground, carrier.point((0, 0)))
    spin, roll = m.revolute("spin", carrier, sun.point((0, 0))), m.revolute("roll", carrier, planet.point((0, 0)))
    m.gear("outer", arm, roll, ratio=-0.6 / 0.15)
    m.gear("inner", spin, roll, ratio=-0.3 / 0.15)
    m.start({"arm.speed": 1.0})
    return m


def steering():
    m = zd.Mechanism("steering")
    pinion = m.revolute("pinion", m.ground, m.body("wheel", 1.0, 0.1, at=(0, 0.06)).point((0, 0)))
    rack = m.prismatic("rack", m.ground, m.body("bar", 1.0, 0.1), axis=(1, 0))
    m.rack_pinion("teeth", pinion, rack, ratio=0.05)
    m.start({"pinion.speed": 1.0})
    return m


def lift(a):
    return 0.01 * (1 - np.cos(a)) + 0.003 * np.sin(2 * a)


def valve():
    m = zd.Mechanism("valve")
    turn = m.revolute("turn", m.ground, m.body("shaft", 1.0, 0.1, angle=0.3).point((0, 0)))
    stem = m.body("stem", 0.1, 0.01, at=(0.01, 0.06))
    m.cam("cam", turn, m.prismatic("guide", m.ground, stem, axis=(0, 1), at=(0.01, 0.09)), profile=lift)
    m.motor("drive", turn, speed=5.0)
    return m


def knob():
    """A body without inertia on a driven hinge, a block before a stop, and a particle above a step."""
    m = zd.Mechanism("knob")
    m.motor("drive", m.revolute("turn", m.ground, m.body("eye", 0.1), at=(0, 0)), angle=0.0)
    m.contact("step", m.particle("crumb", 1.0, at=(0, 1)), m.ground.segment((-1, 0), (1, 0)))
    m.stop("end", m.prismatic("slide", m.ground, m.body("block", 0.1, 1.0), at=(1, 0), axis=(1, 0)).displacement, upper=1.0)
    return m


@pytest.fixture(scope="module")
def sol():
    return zd.simulate(sorts(), 0.3, step=0.01)


def kinds(system, name):
    return {shape.kind for shape in shapes_at(system, system.p0) if shape.name == name}


# ---- what is drawn ----


def test_every_glyph_is_drawn():
    drawn = [m.system() for m in (sorts(), planetary(), steering(), valve(), knob())]
    made = {shape.kind for system in drawn for shape in shapes_at(system, system.p0)}
    assert made == set(GLYPHS) - {"curve", "load_symbol"}     # of systems that are drawn from points; beside arrows to scale


@pytest.mark.parametrize("what", [every_element.machinery, every_element.hinged, every_element.vehicles,
                                  every_joint_by_row.by_row])
def test_all_joints_and_elements_are_drawn(what):
    ax = zd.plot.mechanism(what())
    ax.figure.canvas.draw()
    assert sum(len(each.get_paths()) for each in ax.collections) > 15


@pytest.mark.parametrize("kind", [*JOINTS, *ELEMENTS])
def test_every_kind_of_the_tables_is_drawn_as_itself(kind):
    """A new kind of element has a drawing with its name."""
    system, prefix = every_joint_by_row.by_row().system("absolute"), "J" if kind in JOINTS else "F"
    drawn = kinds(system, f"{prefix} {kind}")
    assert drawn == LOOKS[kind] if kind in LOOKS else drawn


def test_slides_on_the_ground_have_rails():
    m = sorts()
    assert kinds(m.system(), "rail") == {"rail", "slider"}
    assert kinds(m.system(), "push") == {"drive"}


@pytest.mark.parametrize(("stiffness", "damping", "drawn"), [(1.0, 0.0, {"spring"}), (0.0, 1.0, {"damper"}),
                                                             (1.0, 1.0, {"spring", "damper"})])
def test_springs_and_dampers(stiffness, damping, drawn):
    m = zd.Mechanism("m")
    m.spring("S", m.ground.point((0, 0)), m.particle("bob", 1.0, at=(1, 0)), stiffness=stiffness, damping=damping)
    assert kinds(m.system(), "S") == drawn


# ---- where it is drawn ----


@pytest.mark.parametrize("row", [0, 17])
def test_parts_are_where_the_measures_are(sol, row):
    ax = zd.plot.mechanism(sol, sol.p[row])
    names = ("bob", "bead", "piston", "wheel", "arm.end", "hinge", "tracer", "sleigh")
    at = {name: sol[f"{name}.position"][row] for name in names}
    for kind, name in (("particle", "bob"), ("particle", "arm.end"), ("wheel", "wheel"), ("pin", "hinge"), ("pin", "bead"),
                       ("block", "bead"), ("slider", "piston"), ("mark", "tracer"), ("blade", "sleigh")):
        assert is_among(at[name], centres(ax, kind)), (kind, name)
    eyes = centres(ax, "spring")
    assert is_among([2, -1], eyes)
    assert np.abs(np.hypot(*(eyes - [2, -1]).T) - sol["coil.length"][row]).min() < 1e-9
    (tail_to_tip,) = [points for points in outlines(ax, "load")]
    assert tail_to_tip[:, 1].min() < at["sleigh"][1] - 1e-3     # of the wind, which blows down
    assert is_among(at["sleigh"], [(tail_to_tip[0] + tail_to_tip[-2]) / 2])


@pytest.mark.parametrize("row", [0, 17])
def test_a_bar_holds_its_ends_and_is_as_wide_everywhere(sol, row):
    """The outline is as far from the line between the ends, wherever it is looked at."""
    m = zd.Mechanism("pendulum", gravity=(0, -9.81))
    link = m.link("link", (0, 0), (0.6, 0.2), mass=1.0)
    m.revolute("pin", m.ground, link.start)
    swing = zd.simulate(m, 0.3, step=0.01)
    (outline,) = outlines(zd.plot.mechanism(swing, swing.p[row]), "link")
    start, end = (swing[f"link.{side}.position"][row] for side in ("start", "end"))
    along = (end - start) / np.hypot(*(end - start))
    feet = start + np.clip((outline - start) @ along, 0, np.hypot(*(end - start)))[:, None] * along
    width = np.hypot(*(outline - feet).T)
    assert np.ptp(width) < 1e-9
    assert 0.005 < width[0] < 0.05


def test_points_in_line_are_a_bar_and_others_a_plate():
    for points, is_plate in (([(0, 0), (1, 1), (3, 3)], False), ([(0, 0), (1, 1), (3, 2)], True)):
        (mark,) = GLYPHS["link"].draw(Shape("link", np.array(points, dtype=float)), 0.1)
        assert (mark.face == marks.PLATE) is is_plate


def test_a_hull_is_as_scipy_has_it():
    rng = np.random.default_rng(3)
    for _ in range(20):
        points = rng.normal(size=(12, 2))
        found, expected = marks.hull(points), points[ConvexHull(points).vertices]
        assert {tuple(each) for each in found} == {tuple(each) for each in expected}


def test_gears_touch_and_their_radii_are_as_their_ratio(sol):
    first, second = (shape for shape in shapes_at(sol.system, sol.p[0]) if shape.kind == "gear")
    assert first.number == pytest.approx(3 * second.number)
    assert first.number + second.number == pytest.approx(1.0)
    widths = [np.ptp(points[:, 0]) for points in outlines(zd.plot.mechanism(sol), "gear")]
    assert {round(max(widths), 6)} <= {round(2 * first.number, 6)}


def test_inner_gears_touch_from_inside():
    m = zd.Mechanism("inner")
    pins = [m.revolute(f"pin{i}", m.ground, m.body(f"b{i}", 1.0, 0.1, at=(0.3 * i, 0)).point((0, 0))) for i in range(2)]
    m.gear("mesh", *pins, ratio=3.0)
    system = m.system()
    found = {shape.kind: shape.number for shape in shapes_at(system, system.p0) if shape.kind in ("gear", "ring")}
    assert found["ring"] - found["gear"] == pytest.approx(0.3)
    assert found["ring"] == pytest.approx(3 * found["gear"])


def test_a_planetary_gear_has_its_radii_from_the_carriers_view():
    system = planetary().system()
    found = {(shape.kind, round(shape.number, 9)) for shape in shapes_at(system, system.p0) if shape.kind in ("gear", "ring")}
    assert found == {("ring", 0.6), ("gear", 0.3), ("gear", 0.15)}


@pytest.mark.parametrize("what", [planetary, sorts])
def test_wheels_that_mesh_have_one_velocity_where_they_touch(what):
    """Holes in the wheels move as the wheels do: without slip, arcs along both pitch circles are alike."""
    sol = zd.simulate(what(), 0.1, step=0.01)
    wheels = [[shape for shape in shapes_at(sol.system, p) if shape.kind in ("gear", "ring")] for p in sol.p[[0, -1]]]
    turns = [np.angle(complex(*late.points[1]) / complex(*early.points[1])) for early, late in zip(*wheels, strict=True)]
    carrier = sol["carrier.angle"][-1] - sol["carrier.angle"][0] if what is planetary else 0.0
    if what is planetary:
        (ring, planet, sun) = ((turn - carrier) * wheel.number for turn, wheel in zip(turns, wheels[0], strict=True))
        assert ring == pytest.approx(planet, abs=1e-9)
        assert sun == pytest.approx(-planet, abs=1e-9)
    else:
        assert turns[0] * wheels[0][0].number == pytest.approx(-turns[1] * wheels[0][1].number, abs=1e-9)


def test_a_rack_moves_as_its_pinion_does_where_they_touch():
    sol = zd.simulate(steering(), 0.1, step=0.01)
    (early, late) = ({shape.kind: shape for shape in shapes_at(sol.system, p)} for p in sol.p[[0, -1]])
    rack, wheel = early["rack"], early["gear"]
    foot = wheel.points[0] - wheel.number * rack.points[2]
    assert np.allclose(foot, (0, 0.01))
    turn = sol["pinion.angle"][-1]
    moved = (late["rack"].points[:2].mean(axis=0) - rack.points[:2].mean(axis=0))
    velocity = turn * np.array([-(foot - wheel.points[0])[1], (foot - wheel.points[0])[0]])
    np.testing.assert_allclose(moved, velocity, atol=1e-9)


@pytest.mark.parametrize("row", [0, 33, 100])
def test_a_cam_touches_its_roller_and_never_holds_it(row):
    """The roller's centre is a roller's radius from the nearest place of the profile, at any angle of the cam."""
    sol = zd.simulate(valve(), 1.2, step=0.01)
    picture = Picture(plt.subplots()[1], sol.system._sketches([sol.p[row]]))
    picture.show(0)
    (profile,) = outlines(picture.ax, "cam")
    roller = sol["stem.position"][row]
    assert is_among(roller, centres(picture.ax, "roller"))
    nearest = np.hypot(*(profile - roller).T).min()
    assert nearest == pytest.approx(1.5 * picture.size, rel=0.02)       # of 180 places of the profile


def test_a_cam_that_would_be_too_small_gets_a_stem():
    m = zd.Mechanism("valve")
    turn = m.revolute("turn", m.ground, m.body("shaft", 1.0, 0.1).point((0, 0)))
    guide = m.prismatic("guide", m.ground, m.body("stem", 0.1, 0.01, at=(0, 0)), axis=(0, 1))
    m.cam("cam", turn, guide, profile=lambda a: 0.01 * (1 - np.cos(a)))
    found = {shape.kind: shape for shape in shapes_at(m.system(), m.system().p0)}
    assert np.hypot(*found["cam"].points.T).min() > 0.02
    assert np.ptp(found["link"].points[:, 1]) > 0.02


def test_a_guide_is_clear_of_its_cam():
    """The guide of a follower is drawn away from its roller, and the follower extends to it."""
    m = zd.Mechanism("valve")
    turn = m.revolute("turn", m.ground, m.body("shaft", 1.0, 0.1).point((0, 0)))
    guide = m.prismatic("guide", m.ground, m.body("stem", 0.1, 0.01, at=(0, 0.05)), axis=(0, 1))
    m.cam("cam", turn, guide, profile=lambda a: 0.01 * (1 - np.cos(a)))
    ax = zd.plot.mechanism(m)
    assert centres(ax, "slider")[0, 1] > 0.09
    (stem,) = outlines(ax, "link")
    assert stem[:, 1].min() < 0.05
    assert stem[:, 1].max() > 0.09


def test_a_load_outside_its_body_is_led_to_it():
    m = zd.Mechanism("m")
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    m.revolute("pin", m.ground, link.start)
    m.force("far", link.point((2, 0)), along=(0, 1), value=1.0)
    m.force("near", link.point((0.7, 0)), along=(0, 1), value=1.0)
    (lead,) = outlines(zd.plot.mechanism(m), "coupled")
    np.testing.assert_allclose(lead, [(1, 0), (2, 0)], atol=1e-12)


def test_the_ground_holds_each_of_its_pins_once_and_springs_by_walls(sol):
    def places(kind):
        return sorted(tuple(shape.points[0].round(9)) for shape in shapes_at(sol.system, sol.p[0]) if shape.kind == kind)

    assert places("ground") == [(0.0, 0.0), (0.0, 2.0), (1.0, 2.0), (3.0, 0.0), (4.0, 2.0)]
    assert places("wall") == [(2.0, -1.0), (2.0, 3.0)]


@pytest.mark.parametrize("moving", [False, True])
def test_grooves_are_within_their_bodies(moving):
    m = zd.Mechanism("lever")
    lever, crank = m.link("lever", (0, 0), (0, 1), mass=1.0), m.link("crank", (0.0, 0.4), (0.1, 0.4), mass=1.0)
    m.revolute("O", m.ground, lever.start)
    turn = m.revolute("turn", m.ground, crank.start)
    m.slot("slot", lever, crank.end, axis=(0, 1))
    m.motor("drive", turn, speed=6.3)
    sol = zd.simulate(m, 1.0, step=0.01)
    ax = zd.plot.mechanism(sol if moving else m)
    (groove,), bars, (block,) = outlines(ax, "groove"), outlines(ax, "link"), outlines(ax, "block")
    assert any(marks.Path(bar).contains_points(groove).all() for bar in bars)
    assert marks.Path(groove).contains_points(0.99 * block + 0.01 * block.mean(axis=0)).all()
    if moving:      # the pin is 0.3 to 0.5 m from the lever's end
        start, end = groove[np.argmin(groove @ [0, 1])], groove[np.argmax(groove @ [0, 1])]
        assert np.hypot(*(end - start)) == pytest.approx(0.25, abs=0.05)     # and half a block at each end


def test_rails_are_as_long_as_the_motion_needs():
    m = zd.Mechanism("shaker")
    slide = m.prismatic("slide", m.ground, m.body("box", 1.0, 0.1), axis=(1, 0))
    m.motor("drive", slide, displacement=lambda t: 0.3 * np.sin(t))
    sol = zd.simulate(m, 6.3, step=0.01)
    for p in sol.p[[0, 100, 300]]:
        (shapes,) = sol.system._sketches([p], sol.p[::10])
        (rail,) = (shape for shape in shapes if shape.kind == "rail")
        assert np.sort(rail.points[:2, 0]) == pytest.approx([-0.3, 0.3], abs=0.01)
    surface = outlines(zd.plot.mechanism(sol, t=1.0), "rail")[0]
    assert surface[:, 0].min() < -0.3 < 0.3 < surface[:, 0].max()


# ---- pictures and films ----


@pytest.mark.parametrize("what", ["mechanism", "system", "solution", "position"])
def test_pictures_are_drawn(sol, what):
    given = {"mechanism": (sorts(),), "system": (sol.system,), "solution": (sol,), "position": (sol, sol.p[-1])}[what]
    ax = zd.plot.mechanism(*given)
    ax.figure.canvas.draw()
    assert ax.get_aspect() == 1.0
    assert ax.get_xlabel() == "x [m]"
    assert ("_ghosts" in [each.get_label() for each in ax.collections]) is (what == "solution")


def test_given_axes_are_drawn_into(sol):
    ax = plt.subplots()[1]
    assert zd.plot.mechanism(sol, ax=ax) is ax
    assert plt.get_fignums() == [ax.figure.number]
    film_axes = plt.subplots()[1]
    film = zd.plot.animate(sol, ax=film_axes, fps=4)
    film.to_jshtml()
    assert film._fig is film_axes.figure


def test_what_is_added_to_a_picture_is_seen():
    ax = zd.plot.mechanism(valve())
    ax.plot([0, 1], [0, 2])
    assert ax.get_xlim()[1] >= 1.0
    assert ax.get_ylim()[1] >= 2.0


def test_a_picture_holds_all_its_moments(sol):
    film = zd.plot.animate(sol, fps=4)
    film.to_jshtml()
    ax = film._fig.axes[0]
    (low, high), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    for p in sol.p:
        places = np.vstack([shape.points for shape in shapes_at(sol.system, p) if shape.kind in ("link", "spring", "pin")])
        assert ((places > [low, bottom]) & (places < [high, top])).all()


def test_the_last_frame_is_as_a_fresh_picture_of_that_pose():
    """And its artists are those of the first frame."""
    sol = zd.simulate(planetary(), 0.5, step=0.01)
    ax = plt.subplots()[1]
    picture = Picture(ax, sol.system._sketches(sol.p[::10]))
    artists = picture.show(0)
    for moment in range(1, 6):
        assert all(one is other for one, other in zip(artists, picture.show(moment), strict=True))
    fresh = Picture(plt.subplots()[1], sol.system._sketches(sol.p[::10]))
    fresh.show(5)
    for kind in ("link", "gear", "pin", "ring"):
        assert np.array_equal(np.vstack(outlines(ax, kind)), np.vstack(outlines(fresh.ax, kind)))
        assert np.array_equal(collection(ax, kind).get_facecolor(), collection(fresh.ax, kind).get_facecolor())
    assert is_among(sol["planet.position"][-1], centres(ax, "pin"))


def test_pins_are_smaller_than_their_bars():
    m = zd.Mechanism("chain")
    last = m.ground.point((0, 0))
    for i in range(20):
        link = m.link(f"link{i}", (0.1 * i, 0), (0.1 * i + 0.1, 0), mass=0.1)
        m.revolute(f"pin{i}", last, link.start)
        last = link.end
    pins = outlines(zd.plot.mechanism(m), "pin")
    assert len(pins) == 20
    assert max(np.ptp(points[:, 0]) for points in pins) < 0.05


def test_small_pictures_have_larger_pins_and_thinner_lines():
    pictures = []
    for inches in (1.5, 6.0):
        ax = plt.figure(figsize=(inches, inches)).add_subplot()
        m = valve()
        pictures.append(Picture(ax, [shapes_at(m.system(), m.system().p0)]))
    small, large = pictures
    assert small.size > 1.2 * large.size
    assert small.line < 0.7 * large.line


def test_what_travels_far_is_drawn_by_its_own_size():
    m = zd.Mechanism("cart")
    cart = m.link("cart", (0, 0), (0.5, 0), mass=1.0)
    m.start({"cart.velocity.x": 10.0})
    sol = zd.simulate(m, 1.0, step=0.1)
    (bar,) = outlines(zd.plot.mechanism(sol), "link")
    assert np.ptp(bar[:, 1]) < 0.2 * cart.length


def test_a_line_that_several_points_touch_is_drawn_once_where_it_is():
    """Also under a body that has not yet reached it, as far as its corners are."""
    system = falling_box().system()
    shapes = shapes_at(system, system.p0)
    half = 0.2 * (np.cos(0.3) + np.sin(0.3))
    assert [each.kind for each in shapes] == ["link", "road"]
    np.testing.assert_allclose(shapes[1].points, [(-half, 0), (half, 0), (1, 0)], atol=1e-12)


@pytest.mark.parametrize(("radius", "extent"), [(0.2, None), (0.2, 1.0), (0.2, 0.1)])
def test_a_body_alone_is_the_disc_of_its_inertia(radius, extent):
    """At most as large as the drawing."""
    m = zd.Mechanism("flywheel")
    m.body("fly", *zd.inertia.disc(mass=3.0, radius=radius), at=(1, 1))
    if extent:
        link = m.link("link", (0, 0), (extent, 0), mass=1.0)
        m.revolute("pin", m.ground, link.start), m.spring("s", link.end, m.ground.point((0, 0)), stiffness=1.0)
    shape = next(each for each in shapes_at(m.system(), m.system().p0) if each.name == "fly")
    assert (shape.kind, shape.number) == ("wheel", pytest.approx(min(radius, extent or radius)))
    assert shape.points[0] == pytest.approx([1, 1])


def test_hinges_at_one_place_share_a_label():
    m = zd.Mechanism("fan", gravity=(0, -9.81))
    for i in range(3):
        m.revolute(f"J{i}", m.ground, m.link(f"link{i}", (0, 0), (1, i - 1), mass=1.0).start)
    written = [text.get_text() for text in zd.plot.mechanism(m, names=True).texts]
    assert sorted(written) == ["J0\nJ1\nJ2", "link0", "link1", "link2"]


def test_nothing_to_draw_is_drawn_too():
    assert Picture(plt.subplots()[1], [[]]).size > 0
    assert Picture(plt.subplots()[1], [[Shape("particle", np.zeros((1, 2)))]]).show(0)


# ---- without colour ----


def luminance(colour):
    """Relative luminance by WCAG 2.1, from 0 to 1."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(colour)]
    return float(np.dot([0.2126, 0.7152, 0.0722], linear))


@pytest.mark.parametrize(("one", "other", "contrast"), [
    (marks.EDGE, marks.BODY, 4.5), (marks.EDGE, marks.TINT, 4.5), (marks.DARK, marks.BODY, 4.5), (marks.BODY, marks.WHITE, 1.5),
    (marks.LOAD, marks.WHITE, 4.5), (marks.LOAD, marks.BODY, 2.5), (marks.BODY, marks.TINT, 1.2), (marks.GREY, marks.WHITE, 3.0),
    (annotations.PATH, marks.WHITE, 4.5), (annotations.PATH, marks.BODY, 3.0)])
def test_what_touches_differs_in_luminance(one, other, contrast):
    """By WCAG: 3 for graphics, 4.5 for what is thin; fills that have an outline between them need less."""
    dark, light = sorted(luminance(each) for each in (one, other))
    assert (light + 0.05) / (dark + 0.05) > contrast
