"""Weights of films and of the first page, and time to draw a picture: ``bench_window.py SITE COLUMN`` writes a column.

SITE is a folder with the built site. It needs Chromium and ``PYTHONPATH=tests:tests/support``, and should run alone.
"""

import csv
import functools
import gzip
import http.server
import sys
import tempfile
import threading
import warnings
from pathlib import Path

import zerodrift as zd
from browser import Browser

RESULTS = Path(__file__).parent / "results" / "window.csv"
FILMS = {"four-bar": (zd.models.four_bar, (), 4.0),
         "Stewart platform": (zd.models.stewart_platform, (), 2.0),
         "100 links in the plane": (zd.models.closed_pendulum, (100,), 1.0),
         "300 links in the plane": (zd.models.closed_pendulum, (300,), 4.0),
         "300 links in space": (zd.models.chain, (300,), 0.9),
         "1000 links in the plane": (zd.models.closed_pendulum, (1000,), 0.05)}
PICTURE = """(() => { const times = [];
  for (let i = 0; i < 60; i++) {
    const begin = performance.now();
    zerodrift.show(i % zerodrift.film.samples + 0.3);
    times.push(performance.now() - begin);
  }
  return times.sort((a, b) => a - b)[30]; })()"""
PAGES = {"first page": "index.html", "gallery": "generated/gallery.html"}


def films(browser, folder):
    for name, (model, arguments, span) in FILMS.items():
        sol = zd.simulate(model(*arguments), span, step=2e-3, save_every=5 if arguments == (300,) else 1)
        path = zd.view(sol).save(folder / "film")
        browser.open(path.as_uri(), width=960, height=500)
        yield f"film of {name}", "kB", path.stat().st_size / 1000
        yield f"picture of {name}", "ms", browser.evaluate(PICTURE)


def pages(browser, site):
    sent = {}

    class Server(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

        def copyfile(self, source, to):     # what is packed already is not packed again
            data = source.read()
            sent[self.path] = len(data) if self.path.split("?")[0].endswith((".png", ".woff2")) else len(gzip.compress(data))
            to.write(data)

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Server, directory=str(site)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    for name, page in PAGES.items():
        sent.clear()
        browser("Network.clearBrowserCache")
        browser.open(f"http://127.0.0.1:{server.server_address[1]}/{page}", still=False)
        browser.evaluate("new Promise(done => setTimeout(done, 3000)).then(() => 0)")
        yield f"{name}, sent with gzip", "kB", sum(sent.values()) / 1000
        first = browser.evaluate("performance.getEntriesByName('first-contentful-paint')[0].startTime")
        yield f"{name}, first picture", "ms", first
        yield f"{name}, loaded", "ms", browser.evaluate("performance.getEntriesByType('navigation')[0].loadEventEnd")


if __name__ == "__main__":
    site, column = Path(sys.argv[1]).resolve(), sys.argv[2]
    warnings.simplefilter("ignore")
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder, Browser(Path(folder) / "profile") as browser:
        found = [*films(browser, Path(folder)), *pages(browser, site)]
    known = {}
    if RESULTS.exists():
        with RESULTS.open(newline="") as file:
            known = {row["what"]: row for row in csv.DictReader(file)}
    for what, unit, value in found:
        known.setdefault(what, {"what": what, "unit": unit})[column] = f"{value:.3g}"
    columns = list(dict.fromkeys(name for row in known.values() for name in row))
    with RESULTS.open("w", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(known.values())
