"""Films: contents of the page, its size, what is refused. `test_in_a_browser.py` looks at them."""

import base64
import html
import itertools
import json
import re
import sys

import numpy as np
import pytest

import zerodrift as zd
from support import refused
from zerodrift.player.rigid import carried


@pytest.fixture(scope="module")
def crank():
    return zd.simulate(zd.models.slider_crank(), 4.0, step=0.005)


def scene_of(film):
    return json.loads(re.search(r'id="scene">(.*?)</script>', film.page, re.DOTALL)[1])


def places(scene, layer, number):
    """A point of the table at all samples."""
    points = scene["layers"][layer]
    if number < 0:
        return np.tile(points["fixed"][-1 - number], (scene["samples"], 1))
    if number >= points["moving"]:
        base, own = points["carried"][number - points["moving"]]
        a, b, *c = (places(scene, layer, each) for each in base)
        side = [np.cross(b - a, c[0] - a) / np.linalg.norm(b - a, axis=1)[:, None]] if c else []
        axes = [b - a, c[0] - a, *side] if c else [b - a, (b - a)[:, ::-1] * (-1, 1)]
        return a + sum(x * axis for x, axis in zip(own, axes, strict=True))
    table = np.frombuffer(base64.b64decode(points["points"]), dtype="<u2").reshape(scene["samples"], points["moving"], -1)
    low, high = np.array(scene["box"]) if number < points["moving"] - points["vectors"] else np.array([-1.0, 1.0])
    return low + table[:, number] / 65535 * (high - low)


def test_points_of_the_film_are_those_of_the_motion(crank):
    """The wrist is the one end of the rod that slides; a coordinate of 16 bits errs by half a level of the box."""
    scene = scene_of(zd.view(crank))
    t = np.linspace(*scene["span"], scene["samples"])
    ends = next(numbers for kind, name, numbers, _ in scene["layers"][0]["shapes"] if (kind, name) == ("link", "rod"))
    known = np.column_stack([np.interp(t, crank.t, column) for column in crank["rod.position"].T])
    allowed = np.ptp(scene["box"], axis=0).max() / 65535 + 1e-4      # and straight lines between samples of 5 ms
    assert min(np.abs(places(scene, 0, number) - known).max() for number in ends) < allowed


def test_a_small_film_is_small(crank):
    assert len(zd.view(crank).page) < 50_000
    assert "http" not in zd.view(crank).page.replace("http-equiv", "")


@pytest.mark.parametrize("name", ["cam_follower", "whipple_bicycle", "rattleback", "gyroscope", "planetary_gear"])
def test_bodies_carry_their_points(name):
    """Points of the film are those of the drawing: to half a level of 16 bits of each of three points that span the axes."""
    from zerodrift.runs.shapes_of_samples import moments_of
    sol = zd.simulate(getattr(zd.models, name)(), 0.2, step=0.005)
    scene = scene_of(zd.view(sol))
    t = np.linspace(*scene["span"], scene["samples"])
    shapes = moments_of(sol, [sol(time)[0] for time in t])
    layer = scene["layers"][0]
    assert name == "planetary_gear" or len(layer["carried"]) > 5
    allowed = 4 * np.ptp(scene["box"], axis=0).max() / 65535
    for k, (_, _, numbers, _) in enumerate(layer["shapes"]):
        for n, number in enumerate(numbers):
            known = np.array([moment[k].points[n] for moment in shapes])
            assert np.abs(places(scene, 0, number) - known).max() < allowed


def test_points_in_line_are_not_carried():
    line = np.array([[[0.1 * k * (1 + t), 0, 0] for k in range(9)] for t in range(4)], dtype=float)
    assert carried(line, [range(9)], 1.0) == {}
    assert carried(line[:, :, :2], [range(9)], 1.0).keys() == set(range(1, 8))      # in the plane two points are enough


def test_clicks_know_all_forces(crank):
    loads = {each["name"]: each for each in scene_of(zd.view(crank))["layers"][0]["loads"] if each["unit"] == "N"}
    assert set(loads) == {"main", "pin", "slide", "spring", "pull"}
    scene = scene_of(zd.view(crank))
    t = np.linspace(*scene["span"], scene["samples"])
    for name, known in (("pin", np.linalg.norm(crank["pin.force"], axis=1)), ("spring", crank["spring.force"])):
        levels = np.frombuffer(base64.b64decode(loads[name]["values"]), dtype="<u2")
        values = loads[name]["least"] + loads[name]["size"] / 65535 * levels
        assert np.abs(values - np.interp(t, crank.t, known)).max() < np.ptp(known) / 65535


def test_what_goes_far_is_followed():
    runs = {name: zd.simulate(getattr(zd.models, name)(), 2.0, step=0.02) for name in ("bicycle", "watt")}
    assert {name: scene_of(zd.view(sol))["follow"] > 0 for name, sol in runs.items()} == {"bicycle": True, "watt": False}


@pytest.mark.parametrize("forces", [False, True])
def test_small_mechanisms_are_drawn_as_accurately_as_large_ones(forces):
    """Also beside arrows, whose vectors are far larger than a crank of 0.3 mm."""
    m = zd.Mechanism("small")
    crank = m.link("crank", (0, 0), (0, 3e-4), mass=1e-9)
    m.motor("drive", m.revolute("main", m.ground, crank.start), speed=6.0)
    scene = scene_of(zd.view(zd.simulate(m, 2.0, step=2e-3), forces=forces))
    ends = next(numbers for kind, _, numbers, _ in scene["layers"][0]["shapes"] if kind == "link")
    lengths = np.linalg.norm(np.subtract(*(places(scene, 0, number) for number in ends)), axis=1)
    assert bool(scene["layers"][0]["arrows"]) is forces
    assert lengths == pytest.approx(np.full(len(lengths), 3e-4), rel=1e-4)


@pytest.mark.parametrize(("span", "width"), [(30.0, 1.6 * 0.4), (0.5, 0.0)])
def test_a_wheel_that_goes_far_is_followed(span, width):
    """The ground that it rolls on is drawn as long as the motion; of half a metre all is seen at once."""
    m = zd.Mechanism("wheel", gravity=(0, -9.81))
    disc = m.body("disc", 1.0, 0.02, at=(0, 0.2))
    m.rolling("contact", m.ground, disc, radius=0.2)
    m.start({"disc.velocity.x": 1.0})
    assert scene_of(zd.view(zd.simulate(m, span, step=0.05)))["follow"] == pytest.approx(width)


@pytest.mark.parametrize("bars", [1, 2])
def test_what_hangs_on_the_ground_is_not_followed(bars):
    """Its parts are as large as their distance from the ground."""
    m = zd.Mechanism("pendulum", gravity=(0, -9.81))
    end = m.ground.point((0, 0))
    for k, (near, far) in enumerate([(0, 1), (1, 1.05)][:bars]):
        bar = m.link(f"bar {k}", (near, 0), (far, 0), mass=1.0)
        m.revolute(f"hinge {k}", end, bar.start)
        end = bar.end
    assert scene_of(zd.view(zd.simulate(m, 1.0, step=0.01)))["follow"] == 0


def test_arrows_have_the_size_of_the_force(crank):
    scene = scene_of(zd.view(crank, forces=["pin"]))
    arrow, = scene["layers"][0]["arrows"]
    force = places(scene, 0, arrow["to"]) * arrow["scale"]
    t = np.linspace(*scene["span"], scene["samples"])
    known = np.column_stack([np.interp(t, crank.t, column) for column in crank["pin.force"].T])
    assert np.abs(np.abs(force) - np.abs(known)).max() < 1e-3 * np.abs(known).max()


def test_the_arrow_on_a_hanging_body_points_up():
    """The force of the hook on the bar, its second body, carries the weight."""
    m = zd.Mechanism("hanging", gravity=(0, -9.81))
    bar = m.link("bar", (0, 0), (0, -1), mass=2.0)
    m.revolute("hook", m.ground, bar.start)
    scene = scene_of(zd.view(zd.simulate(m, 1.0, step=0.1), forces=["hook"]))
    arrow, = scene["layers"][0]["arrows"]
    assert np.allclose(places(scene, 0, arrow["to"]) * arrow["scale"], [0, 2 * 9.81], atol=1e-2)


def test_graphs_and_trust_lines(crank):
    scene = scene_of(zd.view(crank, graphs=["crank.angle", "slide.force"]))
    assert [(line["name"], line["unit"]) for line in scene["graphs"]] == [
        ("crank.angle", "rad"), ("slide.force.x", "N"), ("slide.force.y", "N")]
    assert [line["name"] for line in scene["trust"]] == ["position violation", "energy error"]
    assert scene["trust"][0]["most"] == np.abs(crank.position_violation).max()


def test_the_graph_of_a_shorter_run_ends_with_it(crank):
    scene = scene_of(zd.view(crank, zd.simulate(zd.models.slider_crank(), 1.0, step=0.005), graphs=["crank.angle"]))
    for line, end in zip(scene["graphs"] + scene["trust"][::2], (4.0, 1.0, 4.0, 1.0), strict=True):
        values = np.frombuffer(base64.b64decode(line["values"]), dtype="<f4")
        assert np.array_equal(np.isfinite(values), np.linspace(*scene["span"], len(values)) <= end)


def test_arrows_of_rounding_are_left_out():
    """No force acts on the shaft of a wheel that a motor turns about its mass centre."""
    m = zd.Mechanism("wheel")
    wheel = m.body("wheel", 1.3, 0.1, at=(0.3, 0.7))
    shaft = m.revolute("shaft", m.ground, wheel, at=(0.3, 0.7))
    m.motor("drive", shaft, torque=1.0)
    sol = zd.simulate(m, 0.1, step=0.005)
    assert np.abs(sol["shaft.force"]).max() < 1e-12 < np.abs(sol["shaft.torque"]).max()
    assert scene_of(zd.view(sol, forces=True))["layers"][0]["arrows"] == []


def test_motions_over_each_other():
    bar = zd.systems.four_bar()
    runs = [zd.simulate(bar, 2.0, step=0.01, stabilization=stabilization) for stabilization in (None, "projection")]
    scene = scene_of(zd.view(*runs, labels=["free", "corrected"]))
    assert [layer["label"] for layer in scene["layers"]] == ["free", "corrected"]


@pytest.mark.parametrize(("span", "speed"), [(0.5, 0.1), (3.0, 1.0), (8.0, 1.0), (200.0, 10.0)])
def test_the_speed_of_short_and_long_motions(span, speed):
    assert scene_of(zd.view(zd.simulate(zd.systems.pendulum(), span, step=0.05)))["speed"] == pytest.approx(speed)


def rotor(turns):
    """Film of a rotor that makes so many turns in 3 s, by its motor."""
    m = zd.Mechanism("rotor")
    bar = m.link("bar", (0, 0), (0.04, 0), mass=0.5)
    m.motor("drive", m.revolute("axle", m.ground, bar.start), speed=2 * np.pi * turns / 3)
    return scene_of(zd.view(zd.simulate(m, 3.0, step=1e-3)))


@pytest.mark.parametrize(("turns", "samples", "nearest"), [(5, 60, False), (20, 171, False), (90, 768, False), (179, 900, True)])
def test_samples_of_fast_parts(turns, samples, nearest):
    """An interval between samples may turn the bar by 0.81 rad, until cubics deviate by 1 % of its length. Of 179 turns,
    several between two of the first samples each, no length between samples may seem right, and the bar must not stand still.
    """
    scene = rotor(turns)
    assert scene["nearest"] is nearest
    assert samples / 1.1 <= scene["samples"] <= 1.1 * samples


def test_a_film_of_a_long_chain_is_thinned():
    sol = zd.simulate(zd.models.closed_pendulum(300), 1.0, step=2e-3, save_every=5)
    film = zd.view(sol, speed=0.05)
    assert len(film.page) < 500_000
    assert film._scene["thinned"]
    assert not zd.view(zd.simulate(zd.models.closed_pendulum(5), 1.0, step=2e-3))._scene["thinned"]


def test_gravity_points_down():
    """Also where z does, as in Whipple's bicycle."""
    runs = {name: zd.simulate(getattr(zd.models, name)(), 0.02, step=0.01) for name in ("whipple_bicycle", "gyroscope", "watt")}
    assert {name: scene_of(zd.view(sol))["upside"] for name, sol in runs.items()} == {
        "whipple_bicycle": True, "gyroscope": False, "watt": False}


def test_a_file_needs_no_other(crank, tmp_path):
    path = zd.view(crank).save(tmp_path / "film")
    assert path.name == "film.html"
    with refused("wrong-value", r"must end in \.html.* not in \.mp4"):
        zd.view(crank).save(tmp_path / "film.mp4")
    assert path.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_a_solution_shows_its_film_above_its_text(crank):
    shown = crank._repr_html_()
    assert "sandbox=\"allow-scripts allow-downloads\"" in shown
    assert 'alt="slider_crank at the start of the motion"' in shown
    assert html.escape(repr(crank)) in shown
    assert len(shown) < 125_000         # the film, and a still picture behind it


@pytest.mark.parametrize("model", ["closed_pendulum", "chain"])
def test_work_grows_with_the_number_of_bodies(model):
    """Calls of functions, those of C included, in the plane and in space: four times as many for four times the bodies."""
    def calls(bodies):
        sol, count = zd.simulate(getattr(zd.models, model)(bodies), 2e-3, step=1e-3), itertools.count()
        sys.setprofile(lambda _, event, __: next(count) if "call" in event else None)
        try:
            zd.view(sol)
        finally:
            sys.setprofile(None)
        return next(count)
    calls(5)        # imports
    assert calls(80) < 5 * calls(20)


def test_a_long_chain_shows_its_text_alone():
    sol = zd.simulate(zd.models.chain(400), 1e-3, step=1e-3)
    assert "<iframe" not in sol._repr_html_()


def test_what_cannot_be_drawn_shows_its_text():
    system = zd.System(["x"], mass=np.eye(1), force=lambda p: -p, p0=[1.0])
    sol = zd.simulate(system, 1.0, step=0.1)
    assert sol._repr_html_() == f"<pre>{html.escape(repr(sol))}</pre>"
    with refused("not-available"):
        zd.view(sol)


def test_what_is_refused(crank):
    with refused("missing-argument"):
        zd.view()
    with refused("wrong-type", "each of solutions"):
        zd.view(zd.models.watt())
    with refused("wrong-dimension", "all of the plane or all of space"):
        zd.view(crank, zd.simulate(zd.models.gyroscope(), 0.02, step=0.01))
    with refused("shape", "labels.*name 1"):
        zd.view(crank, labels=["a", "b"])
    with refused("wrong-name", "slider_crank"):
        zd.view(crank, graphs=["crank.angel"])
