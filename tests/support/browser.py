"""Chromium without a window, over a pipe: pages at a size, in light or dark, with their errors and pictures. Needs no package."""

import base64
import json
import os
import shutil
import subprocess
import time

import pytest

import tolerances as tol

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium")
FLAGS = ("--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--no-first-run", "--disable-extensions",
         "--mute-audio", "--disable-background-networking", "--disable-component-update", "--disable-dev-shm-usage",
         "--remote-debugging-pipe", "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1")      # no network


class Browser:
    """A browser with one page at a time; `errors` has what its console reported since the page was opened."""

    def __init__(self, profile):
        theirs, self._to = os.pipe()
        self._from, others = os.pipe()

        def connect():      # Chromium reads commands from descriptor 3 and writes answers to 4
            kept = os.dup(theirs), os.dup(others)
            os.dup2(kept[0], 3)
            os.dup2(kept[1], 4)

        self._process = subprocess.Popen([CHROMIUM, *FLAGS, f"--user-data-dir={profile}", "about:blank"], preexec_fn=connect,
                                         close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(theirs)
        os.close(others)
        self._buffer, self._number, self._session, self.errors, self._loaded = b"", 0, None, [], set()
        target = next(each for each in self("Target.getTargets")["targetInfos"] if each["type"] == "page")["targetId"]
        self._session = self("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self(f"{domain}.enable")
        self("Page.setLifecycleEventsEnabled", enabled=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.kill()
        self._process.wait()
        os.close(self._to)
        os.close(self._from)

    def __call__(self, method, **arguments):
        """A command of the DevTools protocol."""
        self._number += 1
        number = self._number
        message = {"id": number, "method": method, "params": arguments} | ({"sessionId": self._session} if self._session else {})
        os.write(self._to, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._read()
            if answer.get("id") == number:
                assert "error" not in answer, (method, answer)
                return answer["result"]

    def _read(self):
        while b"\0" not in self._buffer:
            more = os.read(self._from, 1 << 20)
            assert more, "the browser ended"
            self._buffer += more
        text, _, self._buffer = self._buffer.partition(b"\0")
        answer = json.loads(text)
        self._note(answer.get("method"), answer.get("params", {}))
        return answer

    def _note(self, method, found):
        if method == "Runtime.exceptionThrown":
            details = found["exceptionDetails"]
            self.errors.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Log.entryAdded" and found["entry"]["level"] == "error":
            self.errors.append(f"{found['entry']['text']} {found['entry'].get('url', '')}")
        elif method == "Runtime.consoleAPICalled" and found["type"] in ("error", "assert"):
            self.errors.append(str([each.get("value") for each in found["args"]]))
        elif method == "Page.lifecycleEvent":
            self._loaded.add((found["loaderId"], found["name"]))

    def open(self, url, width=1280, height=900, dark=False, still=True):
        """Open a page and wait for all of it."""
        self.errors = []
        self("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        media = {"prefers-color-scheme": "dark" if dark else "light",
                 "prefers-reduced-motion": "reduce" if still else "no-preference"}
        self("Emulation.setEmulatedMedia", features=[{"name": name, "value": value} for name, value in media.items()])
        loader = self("Page.navigate", url=url)["loaderId"]
        end = time.monotonic() + tol.HUNG
        while (loader, "load") not in self._loaded:
            assert time.monotonic() < end, url
            self._read()

    def evaluate(self, expression):
        """Value of an expression of JavaScript; of a promise, once it is known."""
        found = self("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in found, found
        return found["result"].get("value")

    def until(self, condition):
        """Wait until an expression of JavaScript is true."""
        end = time.monotonic() + tol.HUNG
        while not self.evaluate(condition):
            assert time.monotonic() < end, (condition, self.errors)
            time.sleep(0.02)

    def screenshot(self, path, whole=True):
        """PNG file of the page."""
        path.write_bytes(base64.b64decode(self("Page.captureScreenshot", captureBeyondViewport=whole)["data"]))

    def press(self, key, text=""):
        """Press and release a key, on what has the focus."""
        for kind in ("keyDown", "keyUp"):
            self("Input.dispatchKeyEvent", type=kind, key=key, code=key, text=text if kind == "keyDown" else "")

    def click(self, x, y):
        """Click at a place."""
        for kind in ("mousePressed", "mouseReleased"):
            self("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    with Browser(tmp_path_factory.mktemp("profile")) as opened:
        yield opened
