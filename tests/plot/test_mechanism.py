"""Pictures of mechanisms: every part is there, where the measures say that it is, in every frame."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import zerodrift as zd
from zerodrift.plot.glyphs import GLYPHS
from zerodrift.plot.mechanism import Picture
from zerodrift.systems.shapes import Shape


def sorts():
    """All that has a glyph."""
    m = zd.Mechanism("sorts", gravity=(0, -9.81))
    arm = m.link("arm", (0, 0), (1, 0.3), mass=1.0)
    plate = m.body("plate", 1.0, 0.1, at=(3, 0))
    box, piston = m.body("box", 1.0, 0.1, at=(1.2, 0.4)), m.body("piston", 1.0, 0.1, at=(2, 1), angle=0.5)
    bob, bead = m.particle("bob", 1.0, at=(0.6, -0.6)), m.particle("bead", 0.1, at=(0.8, 0.24))
    sleigh = m.body("sleigh", 1, 0.1, at=(-1, 1))
    wheel = m.body("wheel", 1.0, 0.1, at=(-2, 0.5))
    rotors = [m.body(f"rotor{i}", 1.0, 0.1, at=(i, 2)) for i in range(2)]
    hinge = m.revolute("hinge", m.ground, arm.start)
    m.revolute("corner", m.ground, plate.point((0, 0)))
    m.bushing("mount", arm, box, at=(1, 0.3), stiffness=100, torsion=10)
    m.rod("rod", arm.point((0.5, 0)), bob)
    m.slot("groove", arm, bead, axis=(1, 0.3))
    m.prismatic("rail", m.ground, piston, axis=(1, 1))
    m.knife_edge("blade", sleigh, along=(1, 1))
    m.rolling("road", m.ground, wheel, radius=0.5)
    m.gear("mesh", *(m.revolute(f"pin{i}", m.ground, rotor.point((0, 0))) for i, rotor in enumerate(rotors)), ratio=-3.0)
    m.spring("coil", m.ground.point((2, -1)), plate.point((0.4, 0.2)), stiffness=20.0)
    m.spring("band", piston.point((0, 0.1)), plate.point((0.4, -0.2)), stiffness=20.0)
    m.torsion_spring("clock", hinge, stiffness=1.0)
    m.actuator("jack", m.ground.point((2, 3)), piston.point((0, 0)), force=1.0)
    m.particle("nut", 0.1, at=arm.end)
    m.start({"pin0.speed": 2.0, "wheel.angular_velocity": -1.0})
    return m


@pytest.fixture(scope="module")
def sol():
    return zd.simulate(sorts(), 0.3, step=0.01)


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def shapes(sol, row, kind, name=None):
    return [shape for shape in sol.system._shapes(sol.p[row]) if shape.kind == kind and name in (None, shape.name)]


def test_every_kind_of_shape_is_made_and_has_a_glyph(sol):
    assert {shape.kind for shape in sol.system._shapes(sol.p[0])} | {"ground"} == set(GLYPHS)


@pytest.mark.parametrize("row", [0, 17])
def test_shapes_are_where_the_measures_are(sol, row):
    def at(kind, name):
        (shape,) = shapes(sol, row, kind, name)
        return shape.points

    for end in ("arm.start", "arm.end"):
        assert np.hypot(*(at("link", "arm") - sol[f"{end}.position"][row]).T).min() < 1e-12
    for kind, name, measure in (("particle", "bob", "bob.position"), ("particle", "nut", "arm.end.position"),
                                ("wheel", "road", "wheel.position"), ("slider", "rail", "piston.position"),
                                ("slider", "groove", "bead.position"), ("rail", "rail", None)):
        place = at(kind, name)[1 if kind == "rail" else 0]
        np.testing.assert_allclose(place, sol[measure or "piston.position"][row], atol=1e-9, err_msg=name)
    ends = at("spring", "coil")
    assert np.hypot(*(ends[1] - ends[0])) == pytest.approx(sol["coil.length"][row])
    (wheel,) = shapes(sol, row, "wheel")
    assert wheel.number == 0.5
    np.testing.assert_allclose(np.arctan2(*wheel.points[1][::-1]), sol["wheel.angle"][row], atol=1e-9)


def test_gears_touch_and_their_radii_are_as_their_ratio(sol):
    first, second = shapes(sol, 0, "gear")
    assert first.number == pytest.approx(3 * second.number)
    assert first.number + second.number == pytest.approx(1.0)


def test_inner_gears_touch_from_inside():
    m = zd.Mechanism("inner")
    pins = [m.revolute(f"pin{i}", m.ground, m.body(f"b{i}", 1.0, 0.1, at=(0.3 * i, 0)).point((0, 0))) for i in range(2)]
    m.gear("mesh", *pins, ratio=3.0)
    system = m.system()
    first, second = (shape.number for shape in system._shapes(system.p0) if shape.kind == "gear")
    assert first - second == pytest.approx(0.3)
    assert first == pytest.approx(3 * second)


def test_the_ground_holds_each_of_its_pins_once(sol):
    places = [tuple(shape.points[0].round(9)) for shape in shapes(sol, 0, "ground")]
    assert sorted(places) == [(0.0, 0.0), (0.0, 2.0), (1.0, 2.0), (2.0, -1.0), (2.0, 3.0), (3.0, 0.0)]


@pytest.mark.parametrize("what", ["mechanism", "system", "solution", "position"])
def test_pictures_are_drawn(sol, what):
    given = {"mechanism": (sorts(),), "system": (sol.system,), "solution": (sol,), "position": (sol, sol.p[-1])}[what]
    ax = zd.plot.mechanism(*given)
    ax.figure.canvas.draw()
    assert ax.get_aspect() == 1.0
    assert len(ax.patches) > 15
    assert ax.get_xlabel() == "x [m]"


def test_a_picture_holds_all_its_moments(sol):
    film = zd.plot.animate(sol, fps=4)
    film.to_jshtml()
    ax = film._fig.axes[0]
    (low, high), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    for row in range(len(sol.t)):
        places = np.vstack([shape.points for shape in sol.system._shapes(sol.p[row]) if shape.kind in ("link", "spring", "pin")])
        assert ((places > [low, bottom]) & (places < [high, top])).all()


def test_a_frame_takes_away_the_one_before(sol):
    ax = plt.subplots()[1]
    picture = Picture(ax, [sol.system._shapes(p) for p in sol.p[::10]])
    counts = []
    for moment in range(3):
        picture.show(moment)
        counts.append((len(ax.lines), len(ax.patches)))
    assert counts[0] == counts[1] == counts[2]


def test_pins_are_smaller_than_their_bars():
    m = zd.Mechanism("chain")
    last = m.ground.point((0, 0))
    for i in range(20):
        link = m.link(f"link{i}", (0.1 * i, 0), (0.1 * i + 0.1, 0), mass=0.1)
        m.revolute(f"pin{i}", last, link.start)
        last = link.end
    ax = zd.plot.mechanism(m)
    radii = [patch.radius for patch in ax.patches if hasattr(patch, "radius")]
    assert len(radii) >= 20
    assert max(radii) < 0.025


def test_points_in_line_are_a_bar_and_others_a_plate():
    bar, plate = (Shape("link", np.array(points)) for points in ([(0, 0), (1, 1), (3, 3)], [(0, 0), (1, 1), (3, 2)]))
    assert [len(GLYPHS["link"](plt.subplots()[1], shape, 0.1)) for shape in (bar, plate)] == [1, 2]


def test_nothing_to_draw_is_drawn_too():
    assert Picture(plt.subplots()[1], [[]]).size > 0
    (shape,) = [Shape("particle", np.zeros((1, 2)))]
    assert Picture(plt.subplots()[1], [[shape]]).show(0)
