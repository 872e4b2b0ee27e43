"""The site: it builds without a warning, needs no network, its code runs, and its pages can be read by everybody."""

import contextvars
import os
import re
import runpy
import subprocess
import sys
import time
import unicodedata
from pathlib import Path

import matplotlib
import pytest

from browser import Browser, needs_chromium
from support import ROOT, environment_of_tests

PAGES = ROOT / "notebooks"
PACKAGES = ("sphinx", "myst_nb", "numpydoc", "pydata_sphinx_theme", "latex2mathml")
LOOKS = [(1280, False), (400, True), (1280, True), (400, False)]       # width in points, and whether it is dark
# In all looks.
FIRST = ("index", "use/how_to", "theory/computation", "generated/gallery", "generated/errors", "generated/models/jansen")


def code_of(page):
    """Blocks of Python code of a page; those that are marked `py` are not run."""
    return re.findall(r"```python\n(.*?)```", (PAGES / f"{page}.md").read_text(encoding="utf-8"), re.DOTALL)


WRITTEN = [path.relative_to(PAGES).with_suffix("").as_posix() for path in sorted(PAGES.rglob("*.md"))
           if "generated" not in path.parts]


@pytest.mark.parametrize("page", [page for page in [*WRITTEN, "../tests/bench/tried"] if code_of(page)])
def test_code_of_pages_runs(page, tmp_path, monkeypatch, capsys):
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    blocks = code_of(page)
    names = {}
    here = contextvars.copy_context()       # a choice of units ends with the page, also where a package is missing
    for block in blocks:
        here.run(exec, compile(block, f"{page}.md", "exec"), names)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The site, built once for all processes that run these tests; ZERODRIFT_SITE names one that is built."""
    if built := os.environ.get("ZERODRIFT_SITE"):
        return Path(built).resolve()
    for package in PACKAGES:
        pytest.importorskip(package)
    folder = tmp_path_factory.getbasetemp()
    folder = (folder.parent if folder.name.startswith("popen-") else folder) / "site"
    done = folder.with_name("site is built")
    try:
        folder.mkdir()
    except FileExistsError:
        while not done.exists():
            time.sleep(0.2)
    else:
        built = subprocess.run([sys.executable, "-m", "sphinx", "-q", "-W", "-n", "-d", f"{folder} doctrees", str(PAGES),
                                str(folder)], capture_output=True, text=True, check=False, env=environment_of_tests())
        notices = "zerodrift: "         # of compilers, where their objects are not kept yet
        said = "".join(line for line in built.stderr.splitlines(keepends=True) if not line.startswith(notices))
        said += f"code {built.returncode}" if built.returncode else ""
        (folder / "messages").write_text(said, encoding="utf-8")
        done.touch()
    return folder


def test_the_site_builds_without_a_warning(site):
    messages = site / "messages"
    assert not messages.exists() or messages.read_text(encoding="utf-8") == ""
    for page in ("index", "use/how_to", "generated/errors", "generated/api/zerodrift.simulate"):
        assert (site / f"{page}.html").is_file()


def test_pages_need_no_network_and_pictures_have_words(site):
    equations = (site / "theory" / "computation.html").read_text(encoding="utf-8")
    assert equations.count("<math") > 60
    assert 'id="equation-25a"' in equations
    for letter in ("CAPITAL PHI", "SMALL LAMDA", "CAPITAL M", "SMALL V"):
        assert unicodedata.lookup(f"MATHEMATICAL BOLD ITALIC {letter}") in equations
    for written in site.rglob("*.html"):
        page = written.read_text(encoding="utf-8")
        assert not re.search(r"<(script|img|link)[^>]*(src|href)=.https?://[^>]*(\.js|\.css|\.png)", page), written.name
        for picture in re.findall(r"<img[^>]*>", page):
            words = re.search(r'alt="([^"]*)"', picture)
            assert words, (written.name, picture)
            assert not re.search(r"\.(png|svg|jpe?g)$|^[0-9a-f]{16,}", words[1]), (written.name, words[1])
        if "_static" not in written.parts:
            links = re.findall(r'\b(?:href|src)="(?![a-z]+:)([^"#?]+)', page)
            assert [each for each in links if not (written.parent / each).exists()] == [], written.name


def test_links_to_the_repository_stand_where_it_is_known(monkeypatch):
    for package in PACKAGES:
        pytest.importorskip(package)
    monkeypatch.setattr(sys, "path", [*sys.path])       # to which it adds its folder
    found = {}
    for repository in ("owner/name", ""):
        monkeypatch.setenv("GITHUB_REPOSITORY", repository)
        conf = runpy.run_path(str(PAGES / "conf.py"))
        found[conf["html_baseurl"]] = [each["url"] for each in conf["html_theme_options"]["icon_links"]]
    known = "https://github.com/owner/name"
    assert found == {"https://owner.github.io/name/": [known, f"{known}/issues"], "": []}


def pages_of(folder):
    """Pages but those of single functions, which are all alike: one of these is enough."""
    found = sorted(path.relative_to(folder).with_suffix("").as_posix() for path in folder.rglob("*.html"))
    return [page for page in found if not page.startswith(("_static", "films/", "live/"))
            and (not page.startswith("generated/api/") or page.endswith("zerodrift.simulate"))]


@needs_chromium
def test_pages_can_be_read_by_everybody(site, tmp_path):
    """In light and in dark, on a desk and on a telephone: no error, enough contrast, no picture or control without words, no
    page that is wider than the screen.
    """
    lacks, checks = {}, (ROOT / "tests" / "support" / "page_checks.js").read_text(encoding="utf-8")
    with Browser(tmp_path / "profile") as browser:
        for number, page in enumerate(pages_of(site)):
            for width, dark in LOOKS if page in FIRST else [LOOKS[number % 4]]:
                browser.open((site / f"{page}.html").as_uri(), width=width, dark=dark)
                if found := [*browser.evaluate(checks), *browser.errors]:
                    lacks[page, width, dark] = found
    assert lacks == {}


@needs_chromium
def test_the_leg_of_the_first_page_walks_and_is_dragged(site, tmp_path):
    pytest.importorskip("ziglang")
    with Browser(tmp_path / "profile") as browser:
        browser.open((site / "live" / "leg.html").as_uri(), width=600, height=430, still=False)
        browser.until("globalThis.zerodrift?.live.mechanism && zerodrift.time(zerodrift.live.mechanism) > 0.1")
        part = "zerodrift.parts.find(each => each.name === 'foot').point"
        x, y = browser.evaluate(f"zerodrift.spot({part}).slice(0, 2)")
        browser("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, button="left", clickCount=1, buttons=1)
        assert browser.evaluate("zerodrift.live.dragged !== null")
        assert browser.evaluate("document.getElementById('told').textContent") == ""
        assert browser.errors == []


@needs_chromium
def test_films_of_cards_play_when_pointed_at_and_are_reached_by_keys(site, tmp_path):
    with Browser(tmp_path / "profile") as browser:
        browser.open((site / "generated" / "gallery.html").as_uri(), still=False)
        assert browser.evaluate("document.querySelectorAll('.films a iframe[loading=lazy]').length") == 41
        assert browser.evaluate("""[...document.querySelectorAll(".films a")].every((each) => { each.focus();
            return document.activeElement === each && each.querySelector("iframe").title.length > 20; })""")
        heard = browser.evaluate("""(() => { const card = document.querySelector(".films a"), heard = [];
            const value = {postMessage: each => heard.push(each.on)};
            Object.defineProperty(card.querySelector("iframe"), "contentWindow", {value});
            card.dispatchEvent(new Event("pointerenter")); card.dispatchEvent(new Event("pointerleave")); return heard; })()""")
        assert heard[-2:] == [True, False]
