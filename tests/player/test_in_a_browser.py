"""Films in Chromium: they move without an error, answer to keys and clicks, keep their time when replaced, and draw few lines."""

import numpy as np
import pytest

import zerodrift as zd
from browser import needs_chromium
from zerodrift import gallery

pytestmark = needs_chromium
# Calls of the canvas while one picture is drawn, by name.
CALLS = """(() => {
  const calls = {}, all = CanvasRenderingContext2D.prototype, own = {};
  for (const [name, {value}] of Object.entries(Object.getOwnPropertyDescriptors(all))) if (typeof value === "function") {
    own[name] = value;
    all[name] = function (...given) { calls[name] = (calls[name] ?? 0) + 1; return value.apply(this, given); };
  }
  zerodrift.show(zerodrift.now + 1);
  Object.assign(all, own);
  return calls;
})()"""


@pytest.fixture(scope="module")
def crank():
    return zd.simulate(zd.models.slider_crank(), 4.0, step=0.005)


def shown(browser, film, folder, **how):
    browser.open(film.save(folder / "film").as_uri(), **how)
    browser.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))).then(() => null)")
    return film


@pytest.mark.parametrize("name", [each.name for each in gallery.exhibits()])
def test_every_model_moves_without_an_error(browser, name, tmp_path):
    exhibit = gallery.exhibit(name)
    shown(browser, zd.view(exhibit.run(), path=list(exhibit.path), names=True), tmp_path, width=480, height=400)
    changed = browser.evaluate("""(() => {
      const canvas = document.querySelector("canvas"), n = zerodrift.film.samples;
      const at = t => { zerodrift.show(t); return canvas.toDataURL(); };
      const begin = at(0);
      return [begin !== at(n / 3), begin === at(0)];
    })()""")
    assert changed == [True, True]
    assert browser.errors == []


def test_names_do_not_lie_over_each_other(browser, tmp_path):
    """And of those of a joint on a rail, the name is at the slider."""
    m = zd.models.stewart_platform()
    shown(browser, zd.view(zd.simulate(m, 0.1, step=0.005), names=True), tmp_path)
    boxes = browser.evaluate("""(() => {
      const boxes = [], brush = CanvasRenderingContext2D.prototype, fill = brush.fillText, {film} = zerodrift;
      const names = new Set(film.layers[0].shapes.map(each => each[1]));
      brush.fillText = function (text, x, y, ...rest) {
        if (names.has(text)) boxes.push([x, y - 11, x + this.measureText(text).width, y + 2]);
        fill.call(this, text, x, y, ...rest);
      };
      zerodrift.show(1);
      return boxes;
    })()""")
    assert len(boxes) > 5
    assert all(a[2] < b[0] or a[0] > b[2] or a[3] < b[1] or a[1] > b[3] for i, a in enumerate(boxes) for b in boxes[:i])


def test_a_box_that_is_turned_over_looks_different(browser, tmp_path):
    """By its axes alone, as those of a wing nut that flips."""
    m = zd.Mechanism("nut", dimension=3, gravity=(0, 0, 0))
    m.body("nut", 1.0, np.diag([0.02, 0.05, 0.06]), at=(0, 0, 0))
    seen = []
    for turned in ([1, 0, 0, 0], [0, 0, 1, 0]):
        sol = zd.simulate(m.system("joint"), 0.01, step=1e-3, p0=[0, 0, 0, *turned])
        shown(browser, zd.view(sol), tmp_path)
        seen.append(browser.evaluate("zerodrift.show(0), document.querySelector('canvas').toDataURL()"))
    assert seen[0] != seen[1]
    assert browser.errors == []


def test_a_link_leads_to_a_moment_and_the_table_has_the_graphs(browser, crank, tmp_path):
    path = zd.view(crank, graphs=["crank.angle"]).save(tmp_path / "film")
    browser.open(path.as_uri() + "#t=2.5", still=False)
    browser.until("globalThis.zerodrift !== undefined")
    assert not browser.evaluate("zerodrift.playing")
    assert browser.evaluate("zerodrift.now / (zerodrift.film.samples - 1)") == pytest.approx(2.5 / 4.0)
    head, *rows = browser.evaluate("zerodrift.table()").splitlines()
    assert head == '"t [s]","crank.angle [rad]","position violation [m]","energy error [J]"'
    t, angle = np.array([[float(each) for each in row.split(",")[:2]] for row in rows]).T
    np.testing.assert_allclose(angle, np.interp(t, crank.t, crank["crank.angle"]), atol=1e-6)


@pytest.mark.parametrize("model", [zd.models.closed_pendulum(300), zd.models.chain(300)], ids=["plane", "space"])
def test_a_long_chain_is_drawn_as_a_line(browser, model, tmp_path):
    """Its links are shorter than a pin would be: their colour is seen, and no pin's paper."""
    sol = zd.simulate(model, 0.01, step=1e-3)
    shown(browser, zd.view(sol, speed=0.02), tmp_path)
    calls = browser.evaluate(CALLS)
    assert "arc" not in calls
    dark = browser.evaluate("""(() => { const canvas = document.querySelector("canvas"), {width, height} = canvas;
        const {data} = canvas.getContext("2d").getImageData(0, 0, width, height);
        return data.filter((each, i) => i % 4 === 0 && data[i + 3] > 200 && each < 120).length; })()""")
    assert dark > 500


def test_keys(browser, crank, tmp_path):
    film = shown(browser, zd.view(crank), tmp_path)
    places = []
    for key in ("Home", "ArrowRight", "PageDown", "End"):
        browser.press(key)
        places.append(browser.evaluate("zerodrift.now"))
    assert places == [0, 1, 11, film.samples - 1]
    browser.press(" ")
    assert browser.evaluate("zerodrift.playing")
    browser.press(" ")
    assert not browser.evaluate("zerodrift.playing")


def test_every_control_has_a_name_and_takes_the_focus(browser, crank, tmp_path):
    shown(browser, zd.view(crank, graphs=["crank.angle"]), tmp_path)
    found = []
    for _ in range(5):
        browser.press("Tab")
        found.append(browser.evaluate("(each => [each.tagName, each.ariaLabel || each.textContent])(document.activeElement)"))
    assert [tag for tag, _ in found] == ["CANVAS", "BUTTON", "INPUT", "SELECT", "SELECT"]
    assert all(name for _, name in found)
    assert browser.evaluate("[...document.querySelectorAll('canvas')].every(each => each.ariaLabel)")


def test_a_click_on_a_joint_shows_its_name_and_its_force(browser, crank, tmp_path):
    """Also where no arrow is drawn."""
    film = shown(browser, zd.view(crank), tmp_path)
    sample = 30
    browser.evaluate(f"zerodrift.show({sample})")
    t = np.linspace(0.0, 4.0, film.samples)[sample]
    for joint in ("pin", "main"):
        x, y = browser.evaluate(f"zerodrift.spots.find(each => each.name === '{joint}').at.slice(0, 2)")
        browser.click(x, y)
        name, force = browser.evaluate("zerodrift.told").split(": ")
        known = np.interp(t, crank.t, np.linalg.norm(crank[f"{joint}.force"], axis=1))
        assert name == joint
        assert float(force.split(" N")[0]) == pytest.approx(known, rel=6e-3)      # three digits are shown


def test_an_arrow_has_the_size_of_its_force(browser, crank, tmp_path):
    film = shown(browser, zd.view(crank, forces=["pin"]), tmp_path)
    sample = 30
    size = browser.evaluate(f"(zerodrift.show({sample}), zerodrift.film.layers[0].arrows[0].size)")
    t = np.linspace(0.0, 4.0, film.samples)[sample]
    assert size == pytest.approx(np.interp(t, crank.t, np.linalg.norm(crank["pin.force"], axis=1)), rel=1e-3)


def test_n_chooses_the_next_part(browser, crank, tmp_path):
    shown(browser, zd.view(crank), tmp_path)
    browser.press("n", "n")
    first = browser.evaluate("zerodrift.told")
    browser.press("n", "n")
    assert first
    assert browser.evaluate("zerodrift.told") not in ("", first)


def test_a_film_that_replaces_another_goes_on_at_its_time(browser, crank, tmp_path):
    """As sliders do it: the new frame asks those beside it."""
    explored = zd.explore(zd.models.slider_crank(), {"spring.stiffness": (0.5, 5.0)}, 4.0, step=0.01)
    frames = [explored.film.frame(), explored.set({"spring.stiffness": 3.0}).film.frame()]
    other = zd.view(crank).frame()
    (tmp_path / "page.html").write_text(f"<!DOCTYPE html><title>x</title>{other}{frames[0]}", encoding="utf-8")
    browser.open((tmp_path / "page.html").as_uri())
    found = browser.evaluate(f"""(async () => {{
      const film = n => document.querySelectorAll("iframe")[n].contentWindow;
      const post = (n, data) => film(n).postMessage({{group: {explored.group!r}, ...data}}, "*");
      const at = (n, time) => new Promise(done => {{        // asks a film until it is at a time
        const timer = setInterval(() => post(n, {{zerodrift: "where"}}), 50);
        addEventListener("message", function hear(each) {{
          if (each.source !== film(n) || each.data.zerodrift !== "state" || Math.abs(each.data.time - time) > 0.01) return;
          clearInterval(timer);
          removeEventListener("message", hear);
          done(each.data);
        }});
      }});
      post(1, {{zerodrift: "state", time: 2.5, playing: false, rate: 1, view: [1, -0.9, 0.42, [0, 0]], chosen: "pin"}});
      await at(1, 2.5);
      document.body.insertAdjacentHTML("beforeend", {frames[1]!r});
      return at(2, 2.5);
    }})()""")
    assert found["time"] == pytest.approx(2.5, abs=0.01)
    assert (found["playing"], found["chosen"]) == (False, "pin")


def words_of_graphs(browser, name, sample):
    return browser.evaluate(f"""(() => {{
      const words = [], brush = CanvasRenderingContext2D.prototype, fill = brush.fillText;
      brush.fillText = function (text, ...rest) {{ words.push(text); fill.call(this, text, ...rest); }};
      zerodrift.show({sample});
      return words.filter(each => each.includes("{name}"));
    }})()""")


def test_rounding_is_shown_as_zero_beside_a_graph(browser, tmp_path):
    m = zd.Mechanism("thrown")
    m.particle("ball", 1.0, at=(1e-12, 0))
    m.start({"ball.velocity": (5.0, 0.0)})
    shown(browser, zd.view(zd.simulate(m, 1.0, step=0.1), graphs=["ball.position"]), tmp_path)
    assert words_of_graphs(browser, "position.x", 0) == ["ball.position.x 0 m"]
    assert words_of_graphs(browser, "position.x", "zerodrift.film.samples - 1") == ["ball.position.x 5.00 m"]


def test_a_graph_that_ends_shows_no_number_after_its_end(browser, crank, tmp_path):
    short = zd.simulate(zd.models.slider_crank(), 1.0, step=0.005)
    shown(browser, zd.view(crank, short, graphs=["crank.angle"], labels=["long", "short"]), tmp_path)
    found = words_of_graphs(browser, "crank.angle", "zerodrift.film.samples - 1")
    assert found[0].endswith(" rad")
    assert found[1:] == ["short crank.angle "]
    assert browser.errors == []


@pytest.mark.parametrize("speed", [1.0, 30.0])
def test_a_link_keeps_its_length_between_samples(browser, speed, tmp_path):
    """Straight lines between samples shortened this crank, at 1800 turns in a minute, to a hundredth."""
    m = zd.Mechanism("engine")
    crank = m.link("crank", (0, 0), (0.04, 0), mass=0.5)
    m.motor("drive", m.revolute("main", m.ground, crank.start), speed=speed * 2 * np.pi)
    shown(browser, zd.view(zd.simulate(m, 3.0, step=1e-3)), tmp_path)
    lengths = browser.evaluate("""(layer => Array.from({length: 200}, (_, i) => {
      zerodrift.show(i * zerodrift.film.samples / 200);
      return Math.hypot(...layer.at[layer.shapes.find(each => each[0] === "link")[2][1]]);
    }))(zerodrift.film.layers[0])""")
    assert lengths == pytest.approx([0.04] * 200, rel=0.01)


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("width", [320, 1280])
def test_nothing_is_cut_off(browser, crank, width, dark, tmp_path):
    shown(browser, zd.view(crank, graphs=["crank.angle", "pin.force"]), tmp_path, width=width, height=460, dark=dark)
    assert browser.evaluate("document.documentElement.scrollWidth") <= width
    assert browser.evaluate("[...document.querySelectorAll('canvas, button, select')].every(each => each.offsetWidth > 20)")


def test_a_card_shows_the_picture_alone(browser, crank, tmp_path):
    shown(browser, zd.view(crank, graphs=["crank.angle", "pin.force"]), tmp_path, width=214, height=160)
    seen = browser.evaluate("""[...document.body.querySelectorAll("*")].filter(each => each.offsetHeight)
        .map(each => [each.tagName, each.offsetWidth, each.offsetHeight])""")
    assert seen == [["DIV", 214, 160], ["CANVAS", 214, 160]]


def test_graphs_of_a_low_frame_end_above_the_controls(browser, crank, tmp_path):
    shown(browser, zd.view(crank, graphs=["crank.angle", "pin.force"]), tmp_path, width=420, height=315)
    end, controls = browser.evaluate("""(box => [
        Math.max(...[...document.querySelectorAll(".stage canvas")].map(each => box(each).bottom)),
        box(document.querySelector(".controls")).top])(each => each.getBoundingClientRect())""")
    assert end <= controls


@pytest.mark.parametrize("dark", [False, True])
def test_colours_of_words_have_contrast(browser, crank, dark, tmp_path):
    """WCAG AA: 4.5 between words and paper, 3 between lines and paper."""
    shown(browser, zd.view(crank), tmp_path, dark=dark)
    tones = browser.evaluate("zerodrift.tones")
    for name in ("ink", "accent", "second", "third", "force"):
        assert contrast(tones[name], tones["paper"]) >= 4.5, name
    for name in ("grey", "line", "path"):
        assert contrast(tones[name], tones["paper"]) >= 3, name


def contrast(one, other):
    """Ratio of luminances of two colours "rgb(r, g, b)", by WCAG 2."""
    def luminance(tone):
        parts = np.array([float(each) for each in tone[tone.index("(") + 1:-1].split(",")[:3]]) / 255
        return np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4) @ (0.2126, 0.7152, 0.0722)
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize(("bodies", "most"), [(100, 500), (1000, 30)])
def test_a_picture_of_many_bodies_is_drawn_within_a_frame(browser, bodies, most, tmp_path):
    """Lines and areas, which cost most: a few for each body, and where there are many bodies, all of a colour are one."""
    sol = zd.simulate(zd.models.closed_pendulum(bodies), 0.01, step=1e-3)
    shown(browser, zd.view(sol, speed=0.02), tmp_path)
    calls = browser.evaluate(CALLS)
    assert calls["lineTo"] > bodies
    assert 0 < calls["stroke"] + calls["fill"] < most
