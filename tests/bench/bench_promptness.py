"""Delays and memory that users notice, as ratios to what causes them: Ctrl-C, a request to stop, a slider of a live page, values
between samples of a file, and a long run.

Run it with ``python tests/bench/bench_promptness.py``; it writes ``results/promptness.csv``. Delays are medians. The
page needs Chromium and the package ziglang.
"""

import signal
import sys
import tempfile
import threading
import time
import tracemalloc
from pathlib import Path

import numpy as np

import zerodrift as zd
from measuring import record

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from browser import Browser
from zerodrift._private import gateway
from zerodrift.ensembles.plan import checked
from zerodrift.ensembles.run_range import run_range
from zerodrift.ensembles.runs import Runs
from zerodrift.runs.simulate import SLICE

BAR = zd.systems.four_bar()
BATCH_SLICE = 0.02      # s: SLICE of csrc/batch/single_run.c
ROUNDS = 9
PAGE = """(() => {
  const timed = (count, call) => {
    const begin = performance.now();
    for (let i = 0; i < count; i++) call(i);
    return (performance.now() - begin) / count;
  };
  const m = zerodrift.live.mechanism, slider = document.querySelector("input[type=range]");
  document.getElementById("play").click();
  const change = timed(200, (i) => {
    slider.value = +slider.value + (i % 20 < 10 ? 1 : -1) * +slider.step;
    slider.dispatchEvent(new Event("input"));
  });
  return change / timed(2000, () => m.core.page_step(m.run, 1)); })()"""


def after_a_while(action):
    """A time, and a thread that acts then and adds the time to it."""
    sent = []
    threading.Timer(0.2, lambda: (sent.append(time.perf_counter()), action())).start()
    return sent


def of_ctrl_c():
    sent = after_a_while(lambda: signal.raise_signal(signal.SIGINT))
    zd.simulate(BAR, 1e5, step=1e-3, save_every=1000, on_failure="return")
    return (time.perf_counter() - sent[0]) / SLICE


def of_a_stop():
    stop, runs = gateway.Stop(), Runs(BAR, {"gravity": [1.0]}, None, None, None, (), assembles=True)
    sent = after_a_while(stop.set)
    run_range(checked(runs, 1e6, None, None, keeps=False, step=1e-3, save_every=10**8), 0, 1, stop)
    return (time.perf_counter() - sent[0]) / BATCH_SLICE


def of_a_slider(folder):
    with Browser(folder / "profile") as browser:
        browser.open(zd.view(zd.models.jansen(), live=True).save(folder / "live").as_uri(), still=False)
        browser.until("globalThis.zerodrift ? zerodrift.live.pictures > 5 : false")
        return browser.evaluate(PAGE)


def of_values_between(folder):
    sol = zd.simulate(BAR, 2.5, step=1e-5, save_to=folder / "run")
    sol(1.0)
    tracemalloc.start()
    sol([0.1234567, 2.3456789])
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return most / sol.t.nbytes


def of_a_long_run():
    pages = []
    zd.simulate(BAR, 1500.0, step=1e-3, save_every=10**5,
                progress=lambda part: pages.append(int(Path("/proc/self/statm").read_text().split()[1])))
    return (pages[-1] - pages[1]) * 4096 / zd.record_size(BAR, 1500.0, step=1e-3).total


def main():
    stopped, pressed = (sorted(delay() for _ in range(ROUNDS))[ROUNDS // 2] for delay in (of_a_stop, of_ctrl_c))
    with tempfile.TemporaryDirectory() as name:
        rows = [("Ctrl-C in a run, in the time between two looks at the keyboard", pressed, 3),
                ("a request to stop a run of an ensemble, in the time between two looks", stopped, 3),
                ("a length of Jansen's leg by a slider of a live page, in steps of the page", of_a_slider(Path(name)), None),
                ("two values between 250,001 samples in a file, in memory of their times", of_values_between(Path(name)), 0.1),
                ("growth of memory in 1.5 million steps, in that of all their samples", of_a_long_run(), 0.01)]
    record("promptness", rows, digits=2)
    assert all(np.isfinite(value) for _, value, _ in rows)


if __name__ == "__main__":
    main()
