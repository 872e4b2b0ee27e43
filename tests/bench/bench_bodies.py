"""Cost of a step against the number of bodies: ``python tests/bench/bench_bodies.py``.

Rows of N parallelograms that swing as one, in absolute coordinates: as mechanisms, and as compiled systems that only fill
blocks. The floor is ``planar_floor.c``, a hand-written program of the same steps: RK4 on (13) with one position iteration and one
velocity correction. It is compiled with plain flags and runs in turn with the others. Times are processor times, the minimum of
many short windows.
"""

import ctypes
import multiprocessing
import platform
import re
import subprocess
import sys
import tempfile
import time
from datetime import date
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

import numpy as np

import zerodrift as zd
from bench_structure import memory
from measuring import record
from structured import four_bars
from support import handed
from zerodrift._private import gateway

ROUNDS, WINDOWS, ANGLE, STEP = 4, 40, -0.7, 0.01
FLAGS = ["-O3", "-std=c11", "-ffp-contract=off", "-D_GNU_SOURCE", f"-I{zd.get_include()}"]
SIZES = (2, 10, 40, 200, 1000, 10_000)


def mechanism(n):
    """N parallelograms of links of 1 m and 1 kg."""
    m = zd.Mechanism(f"{n} four-bars", gravity=(0, -9.81))
    tip = np.array([np.cos(ANGLE), np.sin(ANGLE)])
    cranks = [m.link(f"crank{i}", (i, 0), (i + tip[0], tip[1]), mass=1.0) for i in range(n + 1)]
    for i, crank in enumerate(cranks):
        m.revolute(f"ground{i}", m.ground, crank.start)
    for i in range(n):
        bar = m.link(f"bar{i}", (i + tip[0], tip[1]), (i + 1 + tip[0], tip[1]), mass=1.0)
        m.revolute(f"left{i}", cranks[i].end, bar.start)
        m.revolute(f"right{i}", bar.end, cranks[i + 1].end)
    return m.system("absolute")


def hanging_links(n):
    """A chain of links of 1 m and 1 kg that hangs a little aside, whose fastest waves are resolved by steps of 1 ms."""
    m = zd.Mechanism("chain", gravity=(0, -9.81))
    last, tip = m.ground.point((0, 0)), np.array([np.sin(0.05), -np.cos(0.05)])
    for i in range(n):
        link = m.link(f"link{i}", i * tip, (i + 1) * tip, mass=1.0)
        m.revolute(f"pin{i}", last, link.start)
        last = link.end
    return m


class Steps:
    """A run that stands still between windows of some steps, and the least microseconds of a step so far."""

    def __init__(self, system, p, v, steps, step=STEP):
        self.system, self.start, self.steps, self.step, self.least = system, (p, v), steps, step, np.inf

    def measure(self, windows):
        options = handed(formulation=list(zd.formulations()).index("schur"), integrator=list(zd.integrators()).index("rk4"),
                         step=self.step, t1=windows * self.steps * self.step, save_every=self.steps,
                         vector=gateway.PROCESSOR_UNIT)
        run, row = gateway.Run(self.system._core, options, *self.start), gateway.Record(self.system._core, 1)
        for _ in range(windows):
            begin = time.process_time()
            status = run.advance(row, 60.0)
            self.least = min(self.least, 1e6 * (time.process_time() - begin) / self.steps)
            if status < 0:
                raise run.error(status)
            row.c.rows = 0


class Floor:
    """The program, and the least microseconds that it has printed so far."""

    def __init__(self):
        self.program, self.least = Path(tempfile.mkdtemp()) / "floor", {}
        source = Path(__file__).with_name("planar_floor.c")
        subprocess.run(["cc", *FLAGS, "-o", self.program, source, "-lm"], check=True)

    def measure(self, *sizes):
        told = subprocess.run([self.program, *map(str, sizes)], check=True, capture_output=True, text=True).stdout
        for line in told.splitlines():
            kind, n, microseconds, *_ = line.split()
            key = kind, int(n)
            self.least[key] = min(self.least.get(key, np.inf), float(microseconds))


def cases():
    """(name, N) and the steps of each; the twin of 2 parallelograms has dense matrices."""
    all_cases = {}
    for n in SIZES:
        steps, rods = max(2, 4000 // n if n > 2 else 1000), four_bars(n, angle=ANGLE)
        system = mechanism(n)
        all_cases["mechanism", n] = Steps(system, system.p0, system.v0, steps)
        if n <= 1000:
            all_cases["blocks", n] = Steps(rods.system(), rods.p0, np.zeros(len(rods.p0)), steps)
        if n == 2:
            all_cases["dense", n] = Steps(rods.system(packed=False), rods.p0, np.zeros(len(rods.p0)), 100)
    return all_cases


def ratios(times, floor):
    bodies, blocks = ({n: floor.least[kind, n] for n in SIZES} for kind in ("bodies", "blocks"))
    yield "40 four-bars, mechanism, to the floor's bodies", times["mechanism", 40] / bodies[40], 1.55
    yield "40 four-bars, blocks, to the floor's blocks", times["blocks", 40] / blocks[40], 1.5
    yield "per body, mechanism, 10,000 four-bars to 40", times["mechanism", 10_000] / times["mechanism", 40] * 81 / 20_001, 1.5
    yield "per body, the floor's bodies, 10,000 four-bars to 40", bodies[10_000] / bodies[40] * 81 / 20_001, None
    yield "2 four-bars, blocks, to the same system dense", times["blocks", 2] / times["dense", 2], 0.12
    yield "2 four-bars, mechanism, to a dense system of the same equations", times["mechanism", 2] / times["dense", 2], 0.12
    growth = np.log(times["mechanism", 1000] / times["mechanism", 40]) / np.log(2001 / 81)
    yield "growth exponent of a step from 40 to 1000 four-bars, mechanism", growth, None


def of_chains(floor):
    system = hanging_links(1000).system("absolute")
    begin = time.process_time()
    solution = zd.simulate(system, 1.0, step=1e-3, save_every=10)
    taken = (time.process_time() - begin) * 1e6
    hand = 1000 * floor.least["bodies", 1000] * 1000 / 2001
    yield "chain of 1000 links, 1 s at 1 ms from Python, 100 rows, to the floor's steps of as many bodies", taken / hand, 1.6
    yield "omega h of that chain", solution.stats["omega_h"], None
    yield "kB of a run per body, chain of 1000 links", memory(system, system.p0, system.v0, "schur") * 1.024 / 1000, 3


def of_creation(links=10_000):
    """Processor time of what stands between a drawing and the first step, the least of five drawings."""
    options = handed(formulation=list(zd.formulations()).index("schur"), step=1e-3)
    least = np.inf
    for _ in range(5):
        drawn = hanging_links(links)
        begin = time.process_time()
        system = drawn.system("absolute")
        run = gateway.Run(system._core, options, system.p0, system.v0)
        least = min(least, time.process_time() - begin)
        del run
    yield f's of m.system("absolute"), its start and the creation of a run, chain of {links:,} links', least, 0.5


def referenced():
    """Bytes of the pages that this process has used since they were last forgotten, but those of files, which libraries are."""
    mappings = re.split(r"^(?=[0-9a-f]+-[0-9a-f]+ )", Path("/proc/self/smaps").read_text(), flags=re.M)[1:]
    own = (text for text in mappings if "/" not in text.partition("\n")[0])
    return 1024 * sum(int(re.search(r"^Referenced:\s+(\d+)", text, re.M)[1]) for text in own)


def touched(system, bodies, integrator, **corrections):
    """Bytes for each body of the pages that sixteen steps in a row use, the least of some, less those that asking uses."""
    options = {"t1": 1.0, "step": STEP, "rtol": 1e-6, "atol": 1e-9, "save_every": 100, "correction": corrections,
               "vector": gateway.PROCESSOR_UNIT, "formulation": list(zd.formulations()).index("schur"),
               "integrator": list(zd.integrators()).index(integrator)}
    run, row = gateway.Run(system._core, gateway.settings(options), system.p0, system.v0), gateway.Record(system._core, 1)
    least = np.inf
    for _ in range(6):
        used = []
        for advances in (False, True):
            Path("/proc/self/clear_refs").write_text("1")
            if advances:
                run.advance(row, 1e-9)      # sixteen steps are made however little time there is
            used.append(referenced())
        least = min(least, used[1] - used[0])
    return least / bodies


def of_memory(channel):
    """Sends rows; on Linux. Euler's own are, for each body, the state, where the step began, twice, a rate and a stage."""
    ctypes.CDLL(None, use_errno=True).prctl(41, 1, 0, 0, 0)     # PR_SET_THP_DISABLE: of a huge page all 2 MiB count as used
    system = mechanism(5000)
    of_projection = [parameter.initial[0] for parameter in zd.corrections()["projection"].parameters]
    whole, plain = touched(system, 10_001, "rk4", projection=of_projection), touched(system, 10_001, "euler")
    of_evaluation = "kB per body that an evaluation touches: sixteen steps of euler, less the 30 doubles of its own"
    channel.send([("kB per body that sixteen corrected steps of rk4 touch", whole / 1000, None),
                  (of_evaluation, (plain - 240) / 1000, 1)])


def by_itself(measured):
    """Rows that are measured in a fresh process: NumPy asks for huge pages for its large arrays, and what it lets go a run is
    given next.
    """
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe(duplex=False)
    process = context.Process(target=measured, args=(there,))
    process.start()
    there.close()
    rows = here.recv()
    process.join()
    return rows


def main():
    floor, of = Floor(), cases()
    for _ in range(ROUNDS):
        floor.measure(*SIZES)
        for (_, n), steps in of.items():
            steps.measure(WINDOWS if n <= 200 else 5)
    times = {key: steps.least for key, steps in of.items()}
    rows = [(f"microseconds of a step: {kind}, {n} four-bars", times[kind, n], None) for kind, n in times]
    rows += [(f"microseconds of a step: floor of {kind}, {n} four-bars", us, None) for (kind, n), us in floor.least.items()]
    rows += [*ratios(times, floor), *of_chains(floor)]
    rows += by_itself(of_memory) if Path("/proc/self/clear_refs").exists() else []
    rows += of_creation()
    machine = f"{date.today()}, {platform.machine()}, python {platform.python_version()}"
    record("bodies", rows, ("what", f"value ({machine})", "at most"))


if __name__ == "__main__":
    main()
