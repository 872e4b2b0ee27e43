"""Live views in Chromium: they simulate in real time, sliders and dragged points change them, and nothing fails."""

import time

import pytest

import zerodrift as zd
from browser import Browser, needs_chromium

pytest.importorskip("ziglang")
pytestmark = needs_chromium
LARGEST = 1_000_000     # bytes of a page
TIME = "zerodrift.time(zerodrift.live.mechanism)"


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    with Browser(tmp_path_factory.mktemp("profile")) as opened:
        yield opened


def opened(browser, view, folder):
    browser.open(view.save(folder / "live").as_uri(), width=900, height=600, still=False)
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline and not browser.evaluate("globalThis.zerodrift ? zerodrift.live.pictures > 5 : false"):
        time.sleep(0.05)
    return view


def slide(browser, place, value):
    """Moves a slider; the message that follows."""
    return browser.evaluate(f"""(() => {{ const slider = document.querySelectorAll("input[type=range]")[{place}];
        slider.value = {value}; slider.dispatchEvent(new Event("input"));
        return [slider.value, document.getElementById("told").textContent]; }})()""")


@pytest.mark.parametrize("name", ["four_bar", "jansen", "andrews", "quarter_car"])
def test_it_simulates_on_its_constraints_without_an_error(browser, name, tmp_path):
    view = opened(browser, zd.view(getattr(zd.models, name)(), live=True), tmp_path)
    assert len(view.page) < LARGEST
    assert len(view.linked("core_bytes.js")) < LARGEST / 10
    begin, picture = browser.evaluate(f"[{TIME}, document.getElementById('picture').toDataURL()]")
    time.sleep(0.6)
    end, later, violation, told = browser.evaluate("""[
        zerodrift.time(zerodrift.live.mechanism), document.getElementById('picture').toDataURL(),
        zerodrift.violation(zerodrift.live.mechanism), document.getElementById("told").textContent]""")
    assert end > begin
    assert picture != later
    assert violation < 1e-9
    assert told == ""
    assert browser.errors == []


def test_violations_are_drawn_and_the_energy_error_is_that_of_a_run(browser, tmp_path):
    opened(browser, zd.view(zd.models.slider_crank(), live=True), tmp_path)
    browser.evaluate("document.getElementById('play').click()")
    t, found, drawn = browser.evaluate(f"""[{TIME}, zerodrift.energyViolation(zerodrift.live.mechanism),
        zerodrift.live.trust.map(each => each.length)]""")
    sol = zd.simulate(zd.models.slider_crank(), round(t, 3), step=1e-3, direct=False, vector="baseline")
    assert found == pytest.approx(sol.energy_violation[-1], abs=1e-13)       # rounding of energies of some joules
    assert min(drawn) > 3
    assert browser.evaluate("""(() => { const empty = document.createElement('canvas'), strip = document.getElementById('trust');
        [empty.width, empty.height] = [strip.width, strip.height]; return empty.toDataURL() !== strip.toDataURL(); })()""")
    assert browser.errors == []


def test_a_point_is_pulled_by_keys(browser, tmp_path):
    opened(browser, zd.view(zd.models.four_bar(), live=True, sliders={}), tmp_path)
    browser.evaluate("document.getElementById('picture').focus()")
    browser.press(" ")
    before = browser.evaluate("zerodrift.save(zerodrift.live.mechanism)")
    browser.press("n")
    browser.press("n")      # the first is a pin of the ground
    browser("Input.dispatchKeyEvent", type="keyDown", key="ArrowLeft", code="ArrowLeft")
    time.sleep(0.2)
    browser("Input.dispatchKeyEvent", type="keyUp", key="ArrowLeft", code="ArrowLeft")
    after = browser.evaluate("zerodrift.save(zerodrift.live.mechanism)")
    assert after["t"] == before["t"]
    assert max(abs(a - b) for a, b in zip(after["p"], before["p"], strict=True)) > 1e-3
    assert browser.errors == []


def test_a_length_of_jansens_leg_is_dragged(browser, tmp_path):
    """Each change assembles the leg within a picture; the bound is for a machine that does other things, too."""
    opened(browser, zd.view(zd.models.jansen(), live=True), tmp_path)
    times = browser.evaluate("""(() => { const slider = document.querySelector("input[type=range]"), found = [];
        for (let i = 0; i < 20; i++) {
          slider.value = +slider.value + (i < 10 ? 1 : -1) * +slider.step;
          const begin = performance.now();
          slider.dispatchEvent(new Event("input"));
          found.push(performance.now() - begin);
        }
        return found.sort((a, b) => a - b); })()""")
    assert times[len(times) // 2] < 16
    assert browser.evaluate("zerodrift.violation(zerodrift.live.mechanism)") < 1e-10
    assert browser.evaluate("document.getElementById('told').textContent") == ""


def test_a_length_is_changed_and_one_that_cannot_close_is_refused(browser, tmp_path):
    opened(browser, zd.view(zd.models.four_bar(), live=True, sliders={"coupler.length": (0.5, 5.0)}), tmp_path)
    length = """(() => { const m = zerodrift.live.mechanism, a = zerodrift.read(m, "coupler.start.position");
        return Math.hypot(...zerodrift.read(m, "coupler.end.position").map((x, i) => x - a[i])); })()"""
    assert slide(browser, 0, 1.1)[1] == ""
    changed = browser.evaluate(length)
    assert changed == pytest.approx(1.1, abs=0.03)       # steps of the slider
    value, told = slide(browser, 0, 4.9)
    assert told.startswith("coupler.length cannot be")
    assert float(value) == pytest.approx(changed, abs=0.03)
    assert browser.evaluate(length) == pytest.approx(changed, abs=1e-9)
    assert browser.errors == []


def test_a_point_is_dragged(browser, tmp_path):
    opened(browser, zd.view(zd.models.four_bar(), live=True, sliders={}), tmp_path)
    browser.evaluate("document.getElementById('play').click()")
    moved = browser.evaluate("""new Promise(done => {
        const m = zerodrift.live.mechanism, canvas = document.querySelector("canvas");
        const at = () => [...zerodrift.read(m, "crank.end.position")];
        const before = at(), [x, y] = zerodrift.live.place(before), event = (kind, x, y) => canvas.dispatchEvent(
            new PointerEvent(kind, {clientX: x, clientY: y, pointerId: 1, bubbles: true}));
        canvas.setPointerCapture = () => {};
        event("pointerdown", x, y); event("pointermove", x + 30, y + 30);
        setTimeout(() => { event("pointerup", x, y); const after = at();
            done([Math.hypot(after[0] - before[0], after[1] - before[1]), zerodrift.violation(m)]); }, 500); })""")
    assert moved[0] > 1e-2
    assert moved[1] < 1e-9
    assert browser.errors == []


def test_wrong_arguments_are_refused():
    with pytest.raises(ValueError, match="a live view must be of a mechanism in the plane"):
        zd.view(zd.models.coin(), live=True)
    with pytest.raises(TypeError, match="a live view must be of one mechanism, not of 2 arguments"):
        zd.view(zd.models.four_bar(), zd.models.four_bar(), live=True)
