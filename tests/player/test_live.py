"""Live views in Chromium: they simulate in real time, sliders and dragged points change them, and nothing fails."""

import numpy as np
import pytest

import zerodrift as zd
from browser import needs_chromium
from support import refused
from zerodrift import gallery
from zerodrift.errors import sentence
from zerodrift.player.live import live_view

pytest.importorskip("ziglang")
pytestmark = needs_chromium
LARGEST = 1_000_000     # bytes of a page
TIME = "zerodrift.time(zerodrift.live.mechanism)"


def opened(browser, view, folder):
    browser.open(view.save(folder / "live").as_uri(), width=900, height=600, still=False)
    browser.until("globalThis.zerodrift ? zerodrift.live.pictures > 5 : false")
    return view


def slide(browser, place, value):
    """Moves a slider; the message that follows."""
    return browser.evaluate(f"""(() => {{ const slider = document.querySelectorAll("input[type=range]")[{place}];
        slider.value = {value}; slider.dispatchEvent(new Event("input"));
        return [slider.value, document.getElementById("told").textContent]; }})()""")


@pytest.mark.parametrize("exhibit", gallery.exhibits(), ids=lambda each: each.name)
def test_it_simulates_on_its_constraints_without_an_error(browser, exhibit, tmp_path):
    """Every model, with the steps of its page."""
    made = live_view(exhibit.made(), step=min(exhibit.step, 0.01), speed=exhibit.speed, **dict(exhibit.options))
    view = opened(browser, made, tmp_path)
    assert len(view.page) < LARGEST
    assert len(view.linked("core_bytes.js", "player.js")) < LARGEST / 10
    browser.evaluate(f"globalThis.began = {{time: {TIME}, picture: document.getElementById('picture').toDataURL()}}; null")
    browser.until(f"{TIME} > began.time + {0.1 * exhibit.speed} && "
                  "document.getElementById('picture').toDataURL() !== began.picture")
    violation, told = browser.evaluate("""[
        zerodrift.violation(zerodrift.live.mechanism), document.getElementById("told").textContent]""")
    assert violation < 1e-9
    assert told == ""
    assert browser.errors == []


def test_violations_are_drawn_and_the_energy_error_is_that_of_a_run(browser, tmp_path):
    opened(browser, zd.view(zd.models.slider_crank(), live=True), tmp_path)
    browser.evaluate("document.getElementById('play').click()")
    t, found, drawn, times = browser.evaluate(f"""[{TIME}, zerodrift.energyViolation(zerodrift.live.mechanism),
        zerodrift.live.trust.map(each => each.values.length), zerodrift.live.times]""")
    assert {len(times)} == {*drawn}     # at which they are drawn
    assert times == sorted(times)
    sol = zd.simulate(zd.models.slider_crank(), round(t, 3), step=1e-3, closed_form=False, vector="baseline")
    assert found == pytest.approx(sol.energy_violation[-1], abs=1e-13)       # rounding of energies of some joules
    assert min(drawn) > 3
    assert browser.evaluate("""(() => { const empty = document.createElement('canvas'), strip = document.getElementById('trust');
        [empty.width, empty.height] = [strip.width, strip.height]; return empty.toDataURL() !== strip.toDataURL(); })()""")
    assert browser.errors == []


@pytest.mark.parametrize("model", [zd.models.four_bar(), zd.models.chain(2)], ids=["plane", "space"])
def test_a_part_is_pulled_by_keys_while_time_stands(browser, tmp_path, model):
    opened(browser, zd.view(model, live=True, sliders={}), tmp_path)
    browser.evaluate("document.getElementById('picture').focus()")
    browser.press(" ")
    before = browser.evaluate("globalThis.before = zerodrift.save(zerodrift.live.mechanism)")
    browser.press("n")
    browser("Input.dispatchKeyEvent", type="keyDown", key="ArrowLeft", code="ArrowLeft")
    browser.until("zerodrift.save(zerodrift.live.mechanism).p.some((each, i) => Math.abs(each - before.p[i]) > 1e-3)")
    browser("Input.dispatchKeyEvent", type="keyUp", key="ArrowLeft", code="ArrowLeft")
    after = browser.evaluate("zerodrift.save(zerodrift.live.mechanism)")
    assert after["t"] == before["t"]
    assert max(abs(a - b) for a, b in zip(after["p"], before["p"], strict=True)) > 1e-3
    assert browser.errors == []


def test_a_length_of_jansens_leg_is_dragged(browser, tmp_path):
    """Each change assembles the leg once and makes no step, so that it is done within a picture."""
    opened(browser, zd.view(zd.models.jansen(), live=True), tmp_path)
    sliders, calls = browser.evaluate("""(() => { const m = zerodrift.live.mechanism, {core} = m, calls = {};
        m.core = Object.fromEntries(Object.entries(core).map(([name, own]) => [name, typeof own !== "function" ? own
          : (...given) => { calls[name] = (calls[name] ?? 0) + 1; return own(...given); }]));
        const sliders = document.querySelectorAll("input[type=range]"), [slider] = sliders;
        for (let i = 0; i < 20; i++) {
          slider.value = +slider.value + (i < 10 ? 1 : -1) * +slider.step;
          slider.dispatchEvent(new Event("input"));
        }
        m.core = core;
        return [sliders.length, calls]; })()""")
    assert calls.pop("page_set_parameter") == 20
    assert calls.pop("page_parameter") < 20 * (sliders + 2)     # numbers that are shown, and move points of the drawing
    assert calls == {}
    assert browser.evaluate("zerodrift.violation(zerodrift.live.mechanism)") < 1e-10
    assert browser.evaluate("document.getElementById('told').textContent") == ""


def distance(name, first=0, last=1):
    """Distance in m between two points of a drawn shape, as the page locates them."""
    return f"""(() => {{ const bars = zerodrift.scene.shapes.filter(each => ["link", "bar", "rod"].includes(each[0]));
        const [, , numbers] = bars.find(each => each[1] === "{name}");
        const [a, b] = [numbers[{first}], numbers[{last}]].map(zerodrift.at);
        return Math.hypot(...a.map((x, i) => x - b[i])); }})()"""


@pytest.mark.parametrize(("name", "link"), [("four_bar", "coupler"), ("flyball_governor", "rod 0")])
def test_a_length_is_changed_and_one_that_cannot_close_is_refused(browser, tmp_path, name, link):
    model = getattr(zd.models, name)()
    value = model.system().parameters[f"{link}.length"]
    opened(browser, zd.view(model, live=True, sliders={f"{link}.length": (0.5 * value, 5 * value)}), tmp_path)
    browser.evaluate("document.getElementById('play').click()")
    assert slide(browser, 0, 1.1 * value)[1] == ""
    changed = browser.evaluate(distance(link))
    assert changed == pytest.approx(1.1 * value, abs=0.03 * value)       # steps of the slider
    place, told = slide(browser, 0, 5 * value)
    with pytest.raises(zd.CorrectionFailed) as refusal:
        model.system()._with({f"{link}.length": 5 * value}).start_at(0.0)
    assert told == f"{link}.length cannot be {5 * value:#.4g} m: {sentence(refusal.value)}"
    assert float(place) == pytest.approx(changed, abs=0.03 * value)
    assert browser.evaluate(distance(link)) == pytest.approx(changed, abs=1e-9)
    assert browser.errors == []


def pulled(browser, part, x, y, seconds=0.8):
    """Way of a part's first point on the screen, pulled by the pointer for some time of the mechanism, and the message."""
    return browser.evaluate(f"""new Promise(done => {{
        const canvas = document.getElementById("picture"), box = canvas.getBoundingClientRect();
        const {{point}} = zerodrift.parts.find(each => each.name === "{part}"), [a, b] = zerodrift.spot(point);
        const event = (kind, x, y) => canvas.dispatchEvent(new PointerEvent(kind,
            {{clientX: x + box.left, clientY: y + box.top, pointerId: 1, bubbles: true}}));
        canvas.setPointerCapture = () => {{}};
        event("pointerdown", a, b); event("pointermove", a + {x}, b + {y});
        const end = {TIME} + {seconds}, look = () => {{
            if (zerodrift.live.playing && {TIME} < end) return requestAnimationFrame(look);
            const [c, d] = zerodrift.spot(point); event("pointerup", a, b);
            done([c - a, d - b, document.getElementById("told").textContent]); }};
        look(); }})""")


def test_a_point_is_pulled_parallel_to_the_screen(browser, tmp_path):
    """The end of a chain follows the pointer, and the violation stays at rounding."""
    opened(browser, zd.view(zd.models.chain(3), live=True, sliders={}), tmp_path)
    x, y, told = pulled(browser, "link 2", 40, -60)
    assert told == ""
    assert x == pytest.approx(40, abs=25)
    assert y == pytest.approx(-60, abs=25)
    assert browser.evaluate("zerodrift.violation(zerodrift.live.mechanism)") < 1e-9
    assert browser.evaluate("zerodrift.input(zerodrift.live.mechanism, 'grip.force.x')") == 0
    assert browser.errors == []


def test_a_point_is_dragged_in_the_plane_and_what_a_motor_holds_is_refused(browser, tmp_path):
    opened(browser, zd.view(zd.models.four_bar(), live=True, sliders={}), tmp_path)
    assert abs(pulled(browser, "coupler", 30, 30)[0]) > 1
    opened(browser, zd.view(zd.models.jansen(), live=True, sliders={}), tmp_path)
    assert pulled(browser, "crank", 30, 30, 0.1)[2].startswith("This point cannot be pulled: a motor")
    assert browser.evaluate("zerodrift.live.dragged") is None
    assert browser.errors == []


def test_a_finger_drags_as_the_pointer_does(browser, tmp_path):
    opened(browser, zd.view(zd.models.four_bar(), live=True, sliders={}), tmp_path)
    spot = """(() => { const box = document.getElementById("picture").getBoundingClientRect();
        const [x, y] = zerodrift.spot(zerodrift.parts.find(each => each.name === "coupler").point);
        return [x + box.left, y + box.top]; })()"""
    browser.evaluate("document.getElementById('play').click()")
    x, y = browser.evaluate(spot)
    browser("Input.dispatchTouchEvent", type="touchStart", touchPoints=[{"x": x, "y": y}])
    browser("Input.dispatchTouchEvent", type="touchMove", touchPoints=[{"x": x + 20, "y": y + 10}])
    browser.until(f"Math.hypot({spot}[0] - {x}, {spot}[1] - {y}) > 3")      # points of the screen
    assert browser.evaluate("zerodrift.live.dragged") is not None
    browser("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
    assert browser.evaluate("zerodrift.live.dragged") is None
    assert browser.errors == []


def test_restart_goes_back_to_the_start_with_its_parameters(browser, tmp_path):
    opened(browser, zd.view(zd.models.gyroscope(), live=True, sliders={"outer.mass": (0.5, 2)}), tmp_path)
    browser.evaluate("document.getElementById('play').click()")
    slide(browser, 0, 1.5)
    browser.evaluate("document.getElementById('restart').click()")
    t, mass, slider = browser.evaluate(f"""[{TIME}, zerodrift.parameter(zerodrift.live.mechanism, "outer.mass"),
        document.querySelector("input[type=range]").value]""")
    assert t == 0
    assert mass == zd.models.gyroscope().system().parameters["outer.mass"]
    assert float(slider) == pytest.approx(mass, abs=0.01)
    assert browser.errors == []


def test_every_drawn_point_is_carried_by_its_body(browser, tmp_path):
    """The page's points are those of the drawing at the page's own state."""
    model = zd.models.double_wishbone()
    opened(browser, zd.view(model, live=True, sliders={}), tmp_path)
    browser.evaluate("document.getElementById('play').click()")
    p, found = browser.evaluate("""[zerodrift.save(zerodrift.live.mechanism).p,
        zerodrift.scene.shapes.flatMap(each => each[2].map(zerodrift.at))]""")
    drawn = np.concatenate([shape.points for shape in model.system()._sketches([np.array(p)])[0]])
    np.testing.assert_allclose(found, drawn, atol=1e-8)         # digits of the page


def test_wrong_arguments_are_refused():
    with refused("not-available", "simulates its block"):
        zd.view(zd.System(1, mass=np.eye(1), p0=[1.0]), live=True)
    with refused("conflicting-arguments", "of 2"):
        zd.view(zd.models.four_bar(), zd.models.four_bar(), live=True)


def test_labels_are_refused():
    with refused("conflicting-arguments", "labels must be left out with live=True"):
        zd.view(zd.models.four_bar(), live=True, labels=["crank"])


def test_it_has_graphs_paths_forces_and_units(browser, tmp_path):
    """At rest, the graph, the way and the arrow are those of a run's first sample."""
    m = zd.models.four_bar()
    opened(browser, zd.view(m, live=True, path="C", graphs=["crank.angle", "C.position.y"], forces=["B"],
                            display={"force": "kN"}), tmp_path)
    browser.evaluate("document.getElementById('play').click()")
    browser.evaluate("document.getElementById('restart').click()")
    browser.until("zerodrift.live.times.length > 0 && zerodrift.live.times[0] === 0")
    way, y, force, scale, unit = browser.evaluate("""(({paths, arrows, at}) => [paths[0][0], zerodrift.live.graphs[1].values[0],
        at[arrows[0].to].map(x => x * arrows[0].scale), [arrows[0].factor, arrows[0].unit],
        document.querySelector("#sliders output").textContent])(zerodrift.scene.layers[0])""")
    sol = zd.simulate(m, 0.01, step=0.001)
    assert way == pytest.approx(sol["C.position"][0].tolist())
    assert y == pytest.approx(way[1])
    assert force == pytest.approx(sol["B.force"][0].tolist(), rel=1e-6)
    assert scale == [1e-3, "kN"]
    assert unit.endswith(" m")
    assert browser.errors == []
    with refused("wrong-name", "must be measures of the mechanism, not 'C.x'"):
        zd.view(m, live=True, graphs=["C.x"])


def test_numbers_of_sliders_are_within_their_cells(browser, tmp_path):
    browser.open(zd.view(zd.models.andrews(), live=True).save(tmp_path / "live").as_uri(), width=560, height=600)
    browser.until("document.querySelectorAll('#sliders output').length > 3")
    assert browser.evaluate("""[...document.querySelectorAll("#sliders label")]
        .every(each => each.lastElementChild.getBoundingClientRect().right <= each.getBoundingClientRect().right + 1)""")


@pytest.mark.parametrize("name", ["four_bar", "slider_crank", "quick_return", "coin"])
def test_forces_of_hinges_on_the_ground_and_of_slots_are_arrows(browser, name, tmp_path):
    m = getattr(zd.models, name)()
    view = opened(browser, zd.view(m, live=True, forces=True), tmp_path)
    arrows = browser.evaluate("zerodrift.scene.layers[0].arrows.map(each => [each.name, each.at])")
    assert [each for each, _ in arrows] == view._scene["arrows"]
    assert all(isinstance(at, int) for _, at in arrows)
    assert browser.evaluate("document.getElementById('told').textContent") == ""
    assert browser.errors == []


def test_a_cylinder_has_a_slider_for_its_stroke(browser, tmp_path):
    """The slider assembles the mechanism anew: two sides and the angle between them by the cosine rule."""
    m = zd.Mechanism("jack", gravity=(0, -9.81))
    m.revolute("A", m.ground, m.link("arm", (0, 0), (1, 0), mass=2.0).start)
    m.actuator("cylinder", m.ground.point((0.0, -0.5)), m["arm"].point((0.6, 0)), length=0.7)
    view = opened(browser, zd.view(m, live=True), tmp_path)
    assert view._scene["sliders"][0]["name"] == "cylinder.length"
    slide(browser, 0, 0.8)
    length = browser.evaluate("zerodrift.parameter(zerodrift.live.mechanism, 'cylinder.length')")
    assert length == pytest.approx(0.8, abs=0.005)
    angle = browser.evaluate("zerodrift.poses(zerodrift.live.mechanism)[2]")
    assert np.sin(angle) == pytest.approx((length**2 - 0.5**2 - 0.6**2) / (2 * 0.5 * 0.6), abs=1e-9)
    m.replace("cylinder", force=30.0)
    assert {"cylinder.force"} == {each["name"] for each in zd.view(m, live=True)._scene["sliders"] if each["kind"] == "input"}
    assert browser.errors == []


def test_sliders_are_refused_without_a_live_view():
    sol = zd.simulate(zd.models.four_bar(), 0.1, step=0.01)
    with refused("conflicting-arguments", "sliders must be left out without live=True"):
        zd.view(sol, sliders={"crank.length": (1.0, 2.0)})


@pytest.mark.parametrize("names", [False, True])
def test_names_are_passed_on(names):
    assert zd.view(zd.models.four_bar(), live=True, sliders={}, names=names)._scene["names"] is names
