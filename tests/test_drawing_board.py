"""The drawing board of the site: its blocks are those of `zd.block`, its Python text makes its file, hands and keys draw, and
what does not fit is refused.
"""

import base64
import functools
import http.server
import importlib
import json
import math
import re
import shutil
import subprocess
import sys
import threading

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from browser import Browser, needs_chromium
from support import ROOT
from zerodrift import errors, gallery
from zerodrift.export import wasm
from zerodrift.mechanisms.files import from_json
from zerodrift.mechanisms.files.to_json import described

BOARD = ROOT / "notebooks" / "board"
NODE = shutil.which("node")
needs_node = pytest.mark.skipif(not NODE, reason="there is no node")
LARGEST = 1_000_000     # bytes of the page with the core

sys.path.insert(0, str(ROOT / "notebooks" / "site"))
boards, live = (importlib.import_module(name) for name in ("boards", "live"))
sys.path.pop(0)


def quick_return():
    """A slot on a moving link, a weld, a slider, damping, a torque, a given length, and a point between the ends of a link."""
    m = zd.Mechanism("quick return", gravity=(0.5, -9.81))
    m.link("crank", (0, 0), (0.3, 0.4), mass=1.0)
    m.link("arm", (0, -0.9), (0.6, 1.7), mass=2.0)
    m.link("top", (0.6, 1.7), (0.9, 1.7), mass=1.0, length=0.3)
    m.link("ram", (1.5, 0.5), (2.0, 0.5), mass=1.0)
    m.revolute("A", m.ground.point((0, 0)), "crank.start", damping=0.1)
    m.revolute("B", m.ground.point((0, -0.9)), "arm.start")
    m.slot("groove", "arm", "crank.end", axis=(0.6, 2.6))
    m.weld("W", "arm.end", "top.start")
    m.prismatic("guide", m.ground.point((2.0, 0.5)), "ram.end", axis=(1, 0), damping=2.0)
    m.spring("spring", m["arm"].point((0.5, 0)), "ram.start", stiffness=30.0, length=1.2, damping=0.5)
    m.motor("drive", "A", torque=3.0)
    m.motor("sway", "B", speed=lambda t: 0.25 * math.cos(3.5 * t))
    m.motor("push", "guide", speed=lambda t: 0.3 * math.cos(7.0 * t))
    return m


def portal():
    """The same parts with links along the axes, whose angles have the same bits in every library."""
    m = zd.Mechanism("portal", gravity=(0.5, -9.81))
    m.link("left", (0, 0), (0, 0.7), mass=1.0)
    m.link("beam", (0, 0.7), (1.1, 0.7), mass=2.0)
    m.link("right", (1.1, 0.7), (1.1, 0), mass=1.0)
    m.link("top", (1.1, 0.7), (1.1, 0.9), mass=1.0, length=0.3)
    m.link("ram", (0.3, 0.7), (0.3, 0.2), mass=1.0)
    m.revolute("A", m.ground.point((0, 0)), "left.start", damping=0.1)
    m.revolute("B", "left.end", "beam.start")
    m.revolute("C", "beam.end", "right.start")
    m.slot("rail", "ground", "right.end", axis=(0, 1))
    m.weld("W", "beam.end", "top.start")
    m.slot("groove", "beam", "ram.start", axis=(1, 0))
    m.prismatic("guide", m.ground.point((0.3, 0.2)), "ram.end", axis=(1, 0), damping=2.0)
    m.spring("spring", m["beam"].point((0.5, 0)), "ram.end", stiffness=30.0, length=1.2, damping=0.5)
    m.motor("drive", "A", speed=3.0)
    m.motor("push", "guide", force=-1.0)
    return m


MECHANISMS = {name: functools.partial(live.drawn().__getitem__, name) for name in live.drawn()}
MECHANISMS |= {"quick return": quick_return, "portal": portal}



def in_node(script, folder):
    """Objects that a script prints, with all functions of the board."""
    for path in BOARD.glob("*.js"):
        shutil.copy(path, folder)
    (folder / "package.json").write_text('{"type": "module"}')
    imports = "".join(f'import * as {name} from "./{name}.js";\n' for name in ("model", "block", "python", "fields"))
    (folder / "main.mjs").write_text(imports + 'import {readFileSync, writeFileSync} from "node:fs";\n'
                                     "const tell = (value) => console.log(JSON.stringify(value));\n" + script)
    result = subprocess.run([NODE, "main.mjs"], cwd=folder, capture_output=True, text=True, check=False, timeout=tol.HUNG)
    assert result.returncode == 0, result.stderr
    return [json.loads(line) for line in result.stdout.splitlines()]


def saved(mechanism):
    return json.dumps(described(mechanism._drawing()))


@needs_node
@pytest.mark.parametrize("name", MECHANISMS)
def test_its_blocks_are_those_of_the_package(name, tmp_path):
    m = MECHANISMS[name]()
    (tmp_path / "m.json").write_text(saved(m))
    start, = in_node("""const m = model.parsedModel(readFileSync("m.json", "utf8"));
        writeFileSync("m.block", block.blockOf(m)); tell(block.drawnStart(m));""", tmp_path)
    system = m.system("absolute")
    outputs = [each for each in system._watching.known if each.endswith((".force", ".torque", ".power"))
               and not each.startswith("ground.")]
    ours, found = zd.block(system, start["p"], start["v"], step=1e-3, outputs=outputs), (tmp_path / "m.block").read_bytes()
    if name == "portal":
        assert found == ours
        return
    # arc tangents of JavaScript and of C are rounded differently: angles, and coordinates that follow from them
    words, expected = np.frombuffer(found), np.frombuffer(ours)
    assert words.shape == expected.shape
    differ = np.flatnonzero(words.view(np.uint64) != expected.view(np.uint64))
    assert np.abs(words[differ] - expected[differ]).max(initial=0.0) < 1e-15
    assert not np.any(expected[differ] == np.round(expected[differ]))


@needs_node
@pytest.mark.parametrize("name", MECHANISMS)
def test_its_python_text_makes_its_file_and_runs(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    m = MECHANISMS[name]()
    (tmp_path / "m.json").write_text(saved(m))
    (text, again), = in_node("""const m = model.parsedModel(readFileSync("m.json", "utf8"));
        tell([python.pythonOf(m, 0.01), model.modelOfAddress(model.addressOf(m))]);""", tmp_path)
    names = {}
    exec(compile(text, "board", "exec"), names)
    assert names["sol"].t[-1] == pytest.approx(0.01)
    assert (tmp_path / f"{m.name}.html").is_file()
    made = described(names["m"]._drawing())
    for ours, theirs in zip(made.pop("elements"), again["elements"], strict=True):
        assert ours.keys() == theirs.keys()
        for key, value in ours.items():
            near = pytest.approx(value, abs=1e-15) if key == "axis" else value     # turned there and back
            assert theirs[key] == near, key
    assert made == {key: value for key, value in again.items() if key != "elements"}


@needs_node
def test_angles_and_swings_are_typed(tmp_path):
    (tmp_path / "m.json").write_text(saved(MECHANISMS["four-bar"]()))
    before, after = in_node("""const m = model.parsedModel(readFileSync("m.json", "utf8"));
        const type = (name, label, value) => fields.fieldsOf(m, name).find(each => each.label === label).set(m, value);
        tell(m.elements);
        type("crank", "angle, °", 30), type("drive", "sets", "swing");
        type("drive", "amplitude, °", 20), type("drive", "frequency, Hz", 0.25);
        tell(model.checkedModel(m).elements);""", tmp_path)
    crank, turned = ({each["name"]: each for each in elements}["crank"] for elements in (before, after))
    length = np.hypot(*np.subtract(crank["end"], crank["start"]))
    assert turned["end"] == pytest.approx(np.add(crank["start"], length * np.array([np.sqrt(0.75), 0.5])), abs=1e-12)
    (_, speed, (_, (_, rate, _))), = (each["law"]["expression"] for each in after if each["kind"] == "motor")
    assert (rate, speed) == pytest.approx((np.pi / 2, np.radians(20) * np.pi / 2))


ON_BOARD = {each.name: each for each in gallery.exhibits() if boards.boarded(each.made())}


@needs_node
def test_models_of_the_gallery_are_opened_by_the_board(tmp_path):
    assert {"jansen", "hoecken", "watt", "klann", "slider_crank", "four_bar", "quick_return", "toggle_press"} <= ON_BOARD.keys()
    found = {name: boards.boarded(each.made()) for name, each in ON_BOARD.items()}
    (tmp_path / "all.json").write_text(json.dumps(list(found.values())))
    again, = in_node("""tell(JSON.parse(readFileSync("all.json", "utf8")).map(each => model.checkedModel(each)));""", tmp_path)
    assert again == list(found.values())


@pytest.mark.parametrize(("name", "point"), [("jansen", "F"), ("hoecken", "P"), ("klann", "F"), ("chebyshev_lambda", "P")])
def test_points_of_driven_models_on_the_board_have_the_same_paths(name, point):
    """Links that are uniform move by the same geometry."""
    m = ON_BOARD[name].made()
    made = from_json.mechanism(zd.Mechanism, boards.boarded(m), name)
    ours, theirs = (zd.simulate(each, 0.5, step=2e-3)[f"{point}.position"] for each in (m, made))
    assert np.ptp(theirs, axis=0).max() > 0.05
    np.testing.assert_allclose(ours, theirs, atol=1e-8)


def unclosed():
    """Beside parts that close, links of 1, 0.5 and 0.25 m between pins that are 2 m apart."""
    m = portal()
    m.link("one", (5, 0), (5, 1), mass=1.0, length=1.0)
    m.link("two", (5, 1), (7, 1), mass=1.0, length=0.5)
    m.link("three", (7, 1), (7, 0), mass=1.0, length=0.25)
    m.revolute("P", m.ground.point((5, 0)), "one.start")
    m.revolute("Q", "one.end", "two.start")
    m.revolute("R", "two.end", "three.start")
    m.revolute("S", "three.end", m.ground.point((7, 0)))
    m.link("alone", (8, 0), (9, 1), mass=1.0)
    return m


@needs_node
def test_what_cannot_close_is_reported_in_the_words_of_python(tmp_path):
    pytest.importorskip("ziglang")
    m = unclosed()
    (tmp_path / "m.json").write_text(saved(m))
    (tmp_path / "core.wasm").write_bytes(wasm.core())
    (tmp_path / "core.js").write_text(wasm.text("core.js"))
    told, = in_node("""const core = await import("./core.js");
        const compiled = await core.load(readFileSync("core.wasm")), m = model.parsedModel(readFileSync("m.json", "utf8"));
        try { core.create(compiled, block.blockOf(m), 0, true); tell(""); } catch (error) { tell(error.message); }""", tmp_path)
    with pytest.raises(zd.CorrectionFailed, match=r"the loop of ground, one, two, three, .* by 0\.25 m") as refusal:
        m.system().p0.any()
    assert told == errors.sentence(refusal.value)


HOSTILE = {
    "m.zerodrift = 'film'": "a mechanism must begin with",
    "m.dimension = 3": "in the plane",
    "m.more = 1": "must not have more",
    "delete m.gravity": "must have gravity",
    "m.gravity = [0, null]": "must be a number",
    "m.gravity = [0, 1e300]": "must be a number",
    "m.elements = Array(201).fill(m.elements[0])": "at most 200 elements",
    "m.elements[0].kind = 'constructor'": "must be one of link",
    "m.elements[0].kind = '__proto__'": "must be one of link",
    "m.elements[0].name = '<img onerror=alert(1)>'": "must have a name",
    "m.elements[0].name = 'a\\\"; import os'": "must have a name",
    "m.elements[1].name = m.elements[0].name": "is taken",
    "m.elements[0].name = 'ground'": "is taken",
    "m.elements[0].mass = -1": "must be a number from 0",
    "m.elements[0].mass = '1'": "must be a number",
    "m.elements[0].end = m.elements[0].start": "different places",
    "m.elements[0].length = 0": "must be positive",
    "m.elements[0].script = ''": "must not have script",
    "m.elements[4].first = 'nothing.end'": "a link that stands before",
    "m.elements[4].first = 'crank.end.start'": "a link that stands before",
    "m.elements[4].second = m.elements[4].first": "must join two bodies",
    "m.elements[3].first.local = [0]": "two numbers",
    "m.elements[3].cut = true": "must be false",
    "m.elements[7].joint = 'rocker'": "must have a joint",
    "m.elements[7].drives = 'torque.x'": "must drive speed or torque",
    "m.elements[7].law = {}": "must be a number",
    "m.elements.push({...m.elements[7], name: 'again'})": "the only motor",
    "m.start = {x: 1}": "must not have x",
    "m.elements[0] = null": "must be one of",
}


@needs_node
def test_hostile_files_and_addresses_are_refused_with_a_sentence(tmp_path):
    (tmp_path / "m.json").write_text(saved(MECHANISMS["four-bar"]()))
    cases = json.dumps(list(HOSTILE))
    told = in_node(f"""const text = readFileSync("m.json", "utf8");
        for (const change of {cases}) {{
          const m = JSON.parse(text);
          new Function("m", change)(m);
          try {{ model.checkedModel(m); tell("accepted"); }} catch (error) {{ tell(error.message); }}
        }}
        for (const given of ["[]", "null", "{{", "1", "x".repeat(100001), '{{"__proto__": {{}}}}'])
          try {{ model.parsedModel(given); tell("accepted"); }} catch (error) {{ tell(error.message); }}
        const part = model.addressOf(JSON.parse(text)).slice(0, -9);
        for (const given of ["#m=", "#m=!!", "#m=abc", "#m=" + "A".repeat(200001), "#m=////", part])
          try {{ model.modelOfAddress(given); tell("accepted"); }} catch (error) {{ tell(error.message); }}""", tmp_path)
    for (change, sentence), found in zip(HOSTILE.items(), told, strict=False):
        assert sentence in found, (change, found)
    assert all(" must " in each for each in told), told


# ---- in Chromium ----


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    """Address of a folder with the board, on this machine."""
    pytest.importorskip("ziglang")
    folder = tmp_path_factory.mktemp("board")
    live.write(folder)
    assert sum(each.stat().st_size for each in folder.iterdir()) < LARGEST
    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

    serving = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=str(folder)))
    threading.Thread(target=serving.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{serving.server_address[1]}/board.html"
    serving.shutdown()
    serving.server_close()


def opened(browser, url, **look):
    """Opens the board."""
    browser.open("about:blank")
    browser.open(url, **look)
    browser.until("globalThis.zerodrift ? zerodrift.board.pictures > 0 : false")


def told(browser):
    return browser.evaluate("document.getElementById('told').textContent")


def address(mechanism):
    return boards.address(described(mechanism._drawing())).partition("#")[2]


def on_screen(browser, x, y):
    return browser.evaluate(f"""(() => {{ const box = document.getElementById("board").getBoundingClientRect(),
        [x, y] = zerodrift.painter.toScreen([{x}, {y}]); return [x + box.left, y + box.top]; }})()""")


def draw(browser, tool, *places):
    browser.evaluate(f"document.querySelector('[data-tool={tool}]').click()")
    for place in places:
        browser.click(*on_screen(browser, *place))


def model(browser):
    return browser.evaluate("zerodrift.board.model")


def count(browser):
    return browser.evaluate("zerodrift.freedoms(zerodrift.board.mechanism)")


@needs_chromium
def test_a_four_bar_is_drawn_by_a_mouse_and_its_address_opens_it_in_another_browser(browser, server, tmp_path):
    opened(browser, server, width=1280, height=800)
    browser.evaluate("zerodrift.painter.show([-1.5, -0.5], [2.5, 1.8])")
    for ends in (((0, 0), (0, 0.5)), ((0, 0.5), (1.5, 1)), ((1.5, 1), (1, 0))):
        draw(browser, "link", *ends)
    draw(browser, "pin", (0, 0), (1, 0))
    assert count(browser) == {"freedoms": 1, "rank": 8, "redundant": []}
    draw(browser, "motor", (0, 0))
    assert count(browser)["freedoms"] == 0
    draw(browser, "spring", (2, 1), (0.75, 0.75))
    drawn = model(browser)
    kinds = [each["kind"] for each in drawn["elements"]]
    assert kinds == ["link", "link", "revolute", "link", "revolute", "revolute", "revolute", "motor", "spring"]
    assert drawn["elements"][-1]["second"] == {"body": "link2", "local": [pytest.approx(0.79, abs=0.01), 0]}
    assert told(browser) == ""
    url = browser.evaluate("location.href")
    reactions = browser.evaluate("document.getElementById('reactions').textContent")
    with Browser(tmp_path / "another profile") as another:
        opened(another, url)
        assert model(another) == drawn
        assert another.errors == []
    (tmp_path / "board.json").write_text(json.dumps(drawn))
    m = zd.load(tmp_path / "board.json")
    sol = zd.simulate(m, 1e-3, step=1e-3)
    assert "pin1.force" in reactions
    shown = browser.evaluate("[...zerodrift.read(zerodrift.board.mechanism, 'pin3.force')]")
    assert shown == pytest.approx(sol["pin3.force"][0].tolist(), rel=1e-9, abs=1e-9)
    assert browser.errors == []


@needs_chromium
def test_it_plays_and_an_end_is_pulled(browser, server):
    opened(browser, f"{server}#{address(MECHANISMS['double pendulum']())}")
    browser.press("p")
    browser.until("zerodrift.board.mechanism && zerodrift.time(zerodrift.board.mechanism) > 0.2")
    assert browser.evaluate("zerodrift.violation(zerodrift.board.mechanism)") < 1e-10
    browser.press("p")
    far = "(() => { const p = zerodrift.positions(zerodrift.board.mechanism); return Math.hypot(p[3] - 0.5, p[4] + 0.5); })()"
    at = browser.evaluate("""(() => { const p = zerodrift.positions(zerodrift.board.mechanism);
        return [p[3] + Math.cos(p[5]) * 0.39, p[4] + Math.sin(p[5]) * 0.39]; })()""")
    before, place = browser.evaluate(far), on_screen(browser, *at)
    goal = on_screen(browser, 0.7, -0.8)

    def mouse(kind, at, **more):
        browser("Input.dispatchMouseEvent", type=kind, x=at[0], y=at[1], button="left", clickCount=1, **more)

    mouse("mousePressed", place, buttons=1)
    for share in (0.5, 1):
        mouse("mouseMoved", (1 - share) * np.array(place) + share * np.array(goal), buttons=1)
    browser.until(f"Math.abs({far} - {before}) > 0.05")
    mouse("mouseReleased", goal)
    assert browser.evaluate("zerodrift.violation(zerodrift.board.mechanism)") < 1e-10
    assert browser.errors == []


@needs_chromium
def test_it_is_drawn_by_keys_alone(browser, server):
    opened(browser, server)
    browser.evaluate("document.getElementById('board').focus()")
    browser.press("l")
    for key in ("ArrowRight", "Enter", *["ArrowRight"] * 8, "Enter"):
        browser.press(key)
    browser.press("g")
    browser.press("Enter")
    browser.press("m")
    browser.press("Enter")
    assert [each["kind"] for each in model(browser)["elements"]] == ["link", "revolute", "motor"]
    assert count(browser)["freedoms"] == 0
    browser.press("Delete")
    assert [each["kind"] for each in model(browser)["elements"]] == ["link", "revolute"]
    browser.press("p")
    browser.until("zerodrift.time(zerodrift.board.mechanism) > 0.05")
    assert browser.errors == []


@needs_chromium
def test_it_is_drawn_by_a_finger_on_a_telephone(browser, server):
    opened(browser, server, width=400, height=800)
    browser("Emulation.setTouchEmulationEnabled", enabled=True)
    browser.evaluate("zerodrift.painter.show([-0.3, -0.3], [1.6, 1.8])")

    def finger(kind, *place):
        points = [dict(zip("xy", on_screen(browser, *place), strict=True))] if place else []
        browser("Input.dispatchTouchEvent", type=kind, touchPoints=points)

    browser.evaluate("document.querySelector('[data-tool=link]').click()")
    for kind, *place in (("touchStart", 0, 0), ("touchMove", 0.5, 0.2), ("touchMove", 1, 0.5), ("touchEnd",)):
        finger(kind, *place)
    assert model(browser)["elements"][0]["end"] == pytest.approx([1, 0.5], abs=0.06)
    browser.evaluate("document.querySelector('[data-tool=move]').click()")
    for kind, *place in (("touchStart", 1, 0.5), ("touchMove", 1, 0.8), ("touchMove", 1, 1), ("touchEnd",)):
        finger(kind, *place)
    browser("Emulation.setTouchEmulationEnabled", enabled=False)
    assert model(browser)["elements"][0]["end"] == pytest.approx([1, 1], abs=0.06)
    assert browser.errors == []


@needs_chromium
def test_a_typed_length_is_kept_and_one_that_cannot_close_is_refused(browser, server):
    opened(browser, f"{server}#{address(MECHANISMS['four-bar']())}")

    def type_length(value):
        browser.evaluate(f"""(() => {{
            const type = (field, value) => {{ field.value = value; field.dispatchEvent(new Event("change")); }};
            type(document.getElementById("parts"), "coupler");
            type(document.querySelectorAll("#values input")[1], "{value}"); }})()""")
        return next(each for each in model(browser)["elements"] if each["name"] == "coupler")

    coupler = type_length(1.4)
    assert coupler["length"] == 1.4
    assert np.hypot(*np.subtract(coupler["end"], coupler["start"])) == pytest.approx(1.4, abs=1e-12)
    assert told(browser) == ""
    assert browser.evaluate("zerodrift.violation(zerodrift.board.mechanism)") < 1e-12
    assert type_length(9) == coupler
    assert told(browser).startswith("length, m cannot be 9: ")
    assert type_length("long") == coupler
    assert told(browser) == "length, m cannot be long: A number is needed"
    assert count(browser)["freedoms"] == 0
    assert browser.errors == []


@needs_chromium
def test_a_hostile_address_says_so_and_nothing_else_happens(browser, server):
    hostile = described(MECHANISMS["double pendulum"]()._drawing())
    hostile["elements"][0]["name"] = "<img src=x onerror=alert(1)>"
    data = base64.urlsafe_b64encode(json.dumps(hostile).encode()).decode().rstrip("=")
    for text in (data, data[:-5], "%3Cscript%3E"):
        opened(browser, f"{server}#m={text}")
        assert told(browser).startswith("The address is refused: ")
        assert model(browser)["elements"] == []
        assert browser.errors == []


@needs_chromium
@pytest.mark.parametrize(("width", "dark"), [(1280, False), (400, True)])
def test_it_can_be_read_by_everybody(browser, server, width, dark):
    opened(browser, f"{server}#{address(MECHANISMS['slider-crank']())}", width=width, height=800, dark=dark)
    assert browser.evaluate((ROOT / "tests" / "support" / "page_checks.js").read_text(encoding="utf-8")) == []
    assert browser.errors == []


def click_on(browser, name):
    browser.evaluate(f"document.getElementById('{name}').click()")


def point_joints(browser):
    """Pins on the ground."""
    return [each for each in model(browser)["elements"] if each["kind"] == "revolute" and isinstance(each["first"], dict)]


def motion(browser):
    return browser.evaluate("document.getElementById('count').textContent.split('\\n')")


@needs_chromium
def test_a_points_path_and_all_measures_over_a_turn_are_those_of_python(browser, server):
    m = MECHANISMS["four-bar"]()
    opened(browser, f"{server}#{address(m)}")
    browser.until("zerodrift.board.turn !== null")
    assert motion(browser)[0] == "moves: yes, driven by drive; freedom 0 (1 without it)"
    head, *rows = browser.evaluate("zerodrift.table()").splitlines()
    names, values = head.replace('"', "").split(","), np.array([[float(each) for each in row.split(",")] for row in rows])
    t = values[:, 0]
    sol = zd.simulate(m, t[-1], step=t[1] / 6)
    for name in ("P.position.x", "P.position.y", "A.force.x", "C.force.y", "drive.torque", "rocker.angle"):
        column = next(i for i, each in enumerate(names) if each.startswith(f"{name} ["))
        np.testing.assert_allclose(values[:, column], np.interp(t, sol.t, sol[name]), rtol=1e-4, atol=1e-3)
    assert t[-1] == pytest.approx(2 * np.pi / 3)
    assert browser.evaluate("zerodrift.film.layers[0].paths[0].length") == len(t)
    assert browser.errors == []


@needs_chromium
def test_a_crank_that_locks_says_so_in_words_of_mechanisms(browser, server):
    m = zd.Mechanism("locked", gravity=(0, -9.81))
    for name, start, end in (("crank", (0, 0), (0, 0.8)), ("coupler", (0, 0.8), (0.9, 0.9)), ("rocker", (0.9, 0.9), (1.4, 0))):
        m.link(name, start, end, mass=1.0)
    m.revolute("A", m.ground.point((0, 0)), "crank.start")
    m.revolute("B", "crank.end", "coupler.start")
    m.revolute("C", "coupler.end", "rocker.start")
    m.revolute("D", m.ground.point((1.4, 0)), "rocker.end")
    m.motor("drive", "A", speed=2.0)
    opened(browser, f"{server}#{address(m)}")
    browser.press("p")
    browser.until("document.getElementById('told').textContent !== ''")
    assert "drive can turn crank no further than " in told(browser)
    assert "coupler and rocker lie in one line there" in told(browser)
    assert browser.evaluate("zerodrift.board.stretched") == ["coupler", "rocker"]
    with pytest.raises(zd.ZerodriftError):
        zd.simulate(m, 4.0, step=1e-3)
    assert browser.errors == []


@needs_chromium
def test_what_is_undone_is_done_again_and_an_empty_field_is_an_error(browser, server):
    m = MECHANISMS["double pendulum"]()
    opened(browser, f"{server}#{address(m)}")
    assert motion(browser)[0] == "moves: yes; freedom 2"
    draw(browser, "point", (0.4, 0.05), (0.5, 0.5))
    assert [each["kind"] for each in model(browser)["elements"]][-1] == "point"
    click_on(browser, "undo")
    assert len(model(browser)["elements"]) == 4
    click_on(browser, "redo")
    point = model(browser)["elements"][-1]
    assert point["local"] == pytest.approx([0.558, 0.434], abs=0.02)
    browser.evaluate("""(() => { const parts = document.getElementById("parts");
        parts.value = "P1"; parts.dispatchEvent(new Event("change"));
        const field = document.querySelectorAll("#values input")[1];
        field.value = " "; field.dispatchEvent(new Event("change")); })()""")
    assert told(browser) == "along the link, m cannot be empty: A number is needed"
    assert model(browser)["elements"][-1] == point
    typed = """(() => { const parts = document.getElementById("parts"); parts.value = "O";
        parts.dispatchEvent(new Event("change"));
        const field = [...document.querySelectorAll("#values label")].find(each => each.textContent.startsWith("x, m")).lastChild;
        field.value = "0.25"; field.dispatchEvent(new Event("change")); })()"""
    browser.evaluate(typed.replace('"O"', json.dumps(next(each["name"] for each in point_joints(browser)))))
    assert point_joints(browser)[0]["first"]["local"] == pytest.approx([0.25, 0.0], abs=1e-9)
    assert " on upper" in browser.evaluate("document.getElementById('reactions').textContent")
    click_on(browser, "undo")
    draw(browser, "link", (0.0, 0.4), (0.2, 0.6))
    assert "nothing joins link1 to the ground" in motion(browser)
    assert browser.errors == []


@needs_chromium
@pytest.mark.parametrize(("speed", "way"), [(2.0, 1), (-2.0, -1)])
def test_the_arrow_of_a_motor_turns_as_its_speed(browser, server, speed, way):
    m = zd.Mechanism("crank", gravity=(0, 0))
    m.link("crank", (0, 0), (1, 0), mass=1.0)
    m.motor("drive", m.revolute("A", m.ground.point((0, 0)), "crank.start"), speed=speed)
    opened(browser, f"{server}#{address(m)}")
    turn = browser.evaluate("""new Promise(done => {
        const brush = CanvasRenderingContext2D.prototype, line = brush.lineTo, way = [];
        brush.lineTo = function (x, y) { way.push([x, y]); return line.call(this, x, y); };
        requestAnimationFrame(() => requestAnimationFrame(() => {
          brush.lineTo = line;
          const [a, b] = zerodrift.painter.toScreen([0, 0]), scale = zerodrift.painter.toScreen([1, 0])[0] - a;
          const arms = way.map(([x, y]) => [x - a, b - y]);
          const onArc = ([x, y]) => Math.abs(Math.hypot(x, y) - 3.1 * zerodrift.film.pin * scale) < 0.5;
          const arc = arms.filter(onArc).slice(0, 10);
          done(arc.slice(1).reduce((sum, [x, y], i) => sum + Math.sign(arc[i][0] * y - arc[i][1] * x), 0)); })); })""")
    assert np.sign(turn) == way
    assert browser.errors == []


@needs_chromium
def test_an_example_is_opened_on_an_empty_board(browser, server):
    opened(browser, server)
    browser.evaluate("""[...document.querySelectorAll('#examples button')]
        .find(each => each.textContent === 'Watt linkage').click()""")
    assert motion(browser)[0] == "moves: yes, driven by drive; freedom 0 (1 without it)"
    assert browser.evaluate("document.getElementById('examples').hidden")
    click_on(browser, "new")
    assert model(browser)["elements"] == []
    click_on(browser, "undo")
    assert len(model(browser)["elements"]) == 14
    assert browser.errors == []


@needs_chromium
def test_the_graph_is_read_by_the_mouse_and_moves_the_picture(browser, server):
    opened(browser, f"{server}#{address(MECHANISMS['four-bar']())}", width=1280, height=900)
    browser.evaluate("""(() => { const parts = document.getElementById("parts");
        parts.value = "A"; parts.dispatchEvent(new Event("change")); })()""")
    browser.until("zerodrift.board.turn !== null && document.getElementById('turn').drawn")
    box = browser.evaluate("""(() => { const element = document.getElementById("turn"); element.scrollIntoView();
        const box = element.getBoundingClientRect(), [left, right] = element.drawn.area;
        return [box.left + left, box.left + right, box.top + 60]; })()""")
    browser("Input.dispatchMouseEvent", type="mouseMoved", x=(box[0] + box[1]) / 2, y=box[2])
    browser.until("zerodrift.board.shown !== null")
    assert browser.evaluate("zerodrift.board.shown") == pytest.approx(180, abs=1)
    browser.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    number = browser.evaluate("zerodrift.film.layers[0].shapes.find(each => each[0] === 'link' && each[1] === 'crank')[2][1]")
    end = browser.evaluate(f"zerodrift.film.layers[0].at[{number}]")
    sol = zd.simulate(MECHANISMS["four-bar"](), np.pi / 3, step=1e-3)
    half = browser.evaluate("zerodrift.board.shown") / 180 * np.pi
    angle = sol["crank.angle"][0] + half
    assert end == pytest.approx([0.4 * np.cos(angle), 0.4 * np.sin(angle)], abs=1e-6)
    sizes = np.linalg.norm(zd.simulate(MECHANISMS["four-bar"](), 2 * np.pi / 3, step=1e-3)["A.force"], axis=1)
    told = browser.evaluate("document.getElementById('turn-hint').textContent")
    assert float(re.search(r"Largest A.force: ([-\d.]+) N at", told)[1]) == pytest.approx(sizes.max(), rel=1e-3)
    assert browser.errors == []


@needs_chromium
def test_travel_and_speed_of_a_slider_are_read(browser, server):
    """A slider-crank against its closed form."""
    m = live.drawn()["slider-crank"]
    opened(browser, f"{server}#{address(m)}")
    browser.until("zerodrift.board.turn !== null")
    head, *rows = browser.evaluate("zerodrift.table()").splitlines()
    names, values = head.replace('"', "").split(","), np.array([[float(each) for each in row.split(",")] for row in rows])
    t, travel, speed = (values[:, names.index(each)] for each in ("t [s]", "guide.displacement [m]", "guide.speed [m/s]"))
    r, rod, turn = np.hypot(0.2, 0.3), np.hypot(1.0, 0.3), np.arctan2(0.3, 0.2) + 5.0 * t
    place = r * np.cos(turn) + np.sqrt(rod**2 - (r * np.sin(turn))**2)
    assert travel - travel[0] == pytest.approx(place - place[0], abs=1e-8)
    assert speed[1:-1] == pytest.approx(np.gradient(place, t)[1:-1], abs=1e-6)
    assert browser.errors == []


@needs_chromium
def test_a_block_replaces_the_slot_of_its_end(browser, server):
    opened(browser, server, width=1280, height=800)
    browser.evaluate("zerodrift.painter.show([-1.5, -0.5], [2.5, 1.8])")
    draw(browser, "link", (0, 0), (1, 0))
    draw(browser, "pin", (0, 0))
    draw(browser, "slot", (1, 0))
    draw(browser, "block", (1, 0))
    assert [each["kind"] for each in model(browser)["elements"]] == ["link", "revolute", "link", "revolute", "prismatic"]
    assert browser.errors == []


@needs_chromium
def test_links_snap_along_others_and_a_motor_that_they_stop_is_named(browser, server):
    opened(browser, server, width=1280, height=800)
    browser.evaluate("zerodrift.painter.show([-1.5, -0.5], [2.5, 1.8])")
    draw(browser, "link", (0, 0), (1, 0))
    draw(browser, "link", (0.513, 0.01), (0.5, 1))
    assert model(browser)["elements"][2]["first"] == {"body": "link1", "local": [0.5, 0]}
    draw(browser, "pin", (0, 0), (0.5, 1), (1, 0))
    assert motion(browser)[0] == "moves: no, its links hold each other"
    draw(browser, "motor", (0, 0))
    assert told(browser).startswith("motor1 cannot turn: the links hold each other")
    assert motion(browser)[0] == "moves: no, its links hold each other"
    assert browser.errors == []


@needs_chromium
def test_two_fingers_zoom_about_the_place_between_them(browser, server):
    opened(browser, server, width=400, height=800)
    browser("Emulation.setTouchEmulationEnabled", enabled=True)
    box = browser.evaluate("(each => [each.left, each.top])(document.getElementById('board').getBoundingClientRect())")
    middle, before = [box[0] + 200, box[1] + 150], browser.evaluate("zerodrift.painter.toDrawing([200, 150])")
    for kind, far in (("touchStart", 40), ("touchMove", 60), ("touchMove", 80), ("touchEnd", None)):
        points = [{"x": middle[0] + sign * far, "y": middle[1], "id": i} for i, sign in enumerate((-1, 1))] if far else []
        browser("Input.dispatchTouchEvent", type=kind, touchPoints=points)
    browser("Emulation.setTouchEmulationEnabled", enabled=False)
    assert browser.evaluate("zerodrift.painter.toDrawing([200, 150])") == pytest.approx(before, abs=1e-6)
    wide = "zerodrift.painter.toDrawing([250, 0])[0] - zerodrift.painter.toDrawing([150, 0])[0]"
    zoomed = browser.evaluate(wide)
    click_on(browser, "fit")
    assert zoomed == pytest.approx(browser.evaluate(wide) / 2)
    assert model(browser)["elements"] == []
    assert browser.errors == []
