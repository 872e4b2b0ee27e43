"""The chart of phases, stops and forces of contacts in pictures, against phases, limits and positions of the solution."""

import numpy as np
import pytest
from matplotlib.colors import to_hex

import zerodrift as zd
from few_bodies import falling_box
from support import refused
from zerodrift.player.live import live_view
from zerodrift.plot.phases import COLOURS
from zerodrift.runs.shapes_of_samples import moments_of


def stopped():
    """A slider, a hinged bar, and a ball on a rope, each at one of its stops in the end; and a ball that rolls on the ground."""
    m = zd.Mechanism("stopped", gravity=(0, -9.81))
    bar = m.link("bar", (0, 0), (1, 0), mass=1.0)
    pin, block = m.revolute("pin", m.ground, bar.start), m.body("block", 1.0, 0.1, at=(1.5, 0.5), angle=0.2)
    slide = m.prismatic("slide", m.ground, block, axis=(3, 4))
    rope = m.spring("rope", m.ground.point((2.5, 0.5)), m.particle("weight", 1.0, at=(2.5, 0.2)), stiffness=0.0, length=1.0)
    m.stop("rest", pin.angle, lower=-1.0, upper=0.5)
    m.stop("buffer", slide.displacement, lower=-0.3, upper=0.3)
    m.stop("taut", rope.length, upper=0.8)
    ball = m.body("ball", 1.0, 0.004, at=(0.5, -1.5))
    m.contact("road", ball, m.ground.line((0, -1.6), (1, -1.6)), radius=0.1, friction=0.3)
    m.start({ball.velocity.x: 0.3})
    return zd.simulate(m, 2.0, rtol=1e-9)


def test_bars_are_the_times_of_the_phases_and_triangles_the_impacts():
    sol = zd.simulate(falling_box(), 3.0)
    ax = zd.plot.phases(sol, display={"time": "ms"})
    ax.figure.canvas.draw()
    assert [label.get_text() for label in ax.get_yticklabels()] == [*"abcd"]
    drawn = {}
    for bar in ax.collections:
        for path in bar.get_paths():
            (low, y0), (high, y1) = path.vertices.min(axis=0), path.vertices.max(axis=0)
            key = "abcd"[round((y0 + y1) / 2)], to_hex(bar.get_facecolor()[0]).upper()
            drawn[key] = drawn.get(key, 0.0) + high - low
    times = {}
    for phase in sol.phases:
        for name, state in phase.state.items():
            if state in COLOURS:
                key = name, COLOURS[state]
                times[key] = times.get(key, 0.0) + 1e3 * (phase.t1 - phase.t0)
    assert drawn == pytest.approx(times)
    assert len(times) == 3
    marks = next(line for line in ax.lines if line.get_marker() == "v")
    assert set(marks.get_xdata()) == {1e3 * t for t in sol.impacts["t"]}
    assert {text.get_text() for text in ax.get_legend().get_texts()} == {"open", "sliding", "sticking", "impact"}


def test_a_system_without_contacts_has_no_chart():
    with refused("not-available", "^sol must.*pendulum"):
        zd.plot.phases(zd.simulate(zd.systems.pendulum(), 0.1, step=0.01))
    assert zd.simulate(zd.systems.pendulum(), 0.1, step=0.01).phases == []


def test_stops_are_drawn_where_what_they_stop_comes_to_rest():
    sol = stopped()
    shapes = {}
    for shape in sol.system._sketches([sol.p[-1]])[0]:
        if shape.kind == "stop":
            shapes.setdefault(shape.name, []).append(shape.points)
    assert {name: len(each) for name, each in shapes.items()} == {"rest": 2, "buffer": 2, "taut": 1}
    end = {name: sol[f"{name}.position"][-1] for name in ("bar", "block", "weight")}
    start, along = shapes["rest"][0]
    assert np.cross([*start, 0], [*end["bar"], 0]) == pytest.approx(np.zeros(3), abs=1e-9)      # on the line of the bar
    assert along == pytest.approx([np.sin(-1.0), -np.cos(1.0)], abs=1e-9)
    assert shapes["rest"][1][0] @ [np.cos(0.5), np.sin(0.5)] == pytest.approx(np.hypot(*start))
    assert shapes["buffer"][0] == pytest.approx(np.array([end["block"], [-0.6, -0.8]]), abs=1e-9)
    assert shapes["buffer"][1] == pytest.approx(np.array([end["block"] + 0.6 * np.array([0.6, 0.8]), [0.6, 0.8]]), abs=1e-9)
    assert shapes["taut"][0] == pytest.approx(np.array([end["weight"], [0, -1]]), abs=1e-9)


def test_the_force_of_a_contact_acts_at_the_ground():
    sol = stopped()
    ((name, places, forces),) = sol.system._forces(["road"], sol, [len(sol.t) - 1])
    assert name == "road"
    assert places[0] == pytest.approx(sol["ball.position"][-1] - [0, 0.1], abs=1e-12)
    assert forces[0] == pytest.approx([0, 9.81], abs=1e-9)


def test_a_rod_is_drawn_while_it_is_joined():
    sol = zd.simulate(zd.models.trebuchet(), 1.5, step=0.01)
    ((start, end),) = (shape.points for shape in moments_of(sol, sol.p[:1], sol.t[:1])[0] if shape.kind == "rod")
    assert np.hypot(*(end - start)) == pytest.approx(2.8)
    ((start, end),) = (shape.points for shape in moments_of(sol, sol.p[-1:], sol.t[-1:])[0] if shape.kind == "rod")
    assert (start == end).all()
    (held,) = (number for kind, _, _, number in live_view(zd.models.trebuchet())._scene["shapes"] if kind == "rod")
    assert held == pytest.approx(2.8)       # at other lengths the page draws none


def test_stops_of_coordinates_are_walls():
    m = zd.Mechanism("ball")
    ball, arm = m.particle("ball", 1.0, at=(0.2, 0.3)), m.link("arm", (1, 0), (2, 0), mass=1.0)
    m.revolute("pin", m.ground, arm.start)
    m.stop("x", ball.position.x, lower=-1, upper=0.8)
    m.stop("y", arm.end.position.y, lower=-0.7)
    sol = zd.simulate(m, 0.1)
    found = [(shape.name, *shape.points.ravel()) for shape in moments_of(sol, sol.p[:1], sol.t[:1])[0] if shape.kind == "wall"]
    assert found == [("x", -1, 0.3, 1, 0), ("x", 0.8, 0.3, -1, 0), ("y", 2, -0.7, 0, 1)]


def test_grooves_that_a_pin_enters_and_leaves_are_as_long_as_it_goes_in_them():
    sol = zd.simulate(zd.models.geneva(), 4.0, step=0.005)
    shapes = moments_of(sol, sol.p[:1], sol.t[:1])[0]
    center = sol["wheel.position"][0]
    for i in range(4):
        (groove,) = (shape.points[:2] for shape in shapes if shape.kind == "groove" and shape.name == f"slot {i + 1}")
        assert sorted(np.hypot(*(groove - center).T)) == pytest.approx([0.05 * (np.sqrt(2) - 1), 0.05], abs=2e-3)
    assert not [shape for shape in shapes if shape.kind == "block"]
