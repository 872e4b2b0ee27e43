"""Time to derive and compile the code of symbolic systems with an empty cache: terms, and closed-form functions.

Run it with ``python tests/bench/bench_programs.py [ROUNDS]``; it needs SymPy and a C compiler, and writes
``results/programs.csv``. Another version is measured with its own package in PYTHONPATH and with ``--name``; its entries are
added to the table. Seconds are processor time, the compiler's included, the minimum of the rounds; the last two columns are wall
clock, which other work on the machine lengthens. Closed-form functions are those of one formulation for the machine's vector
unit; they are written while the compiler works on the terms, and that time is counted for them. CC must name the compiler itself,
not a compiler cache.
"""

import argparse
import csv
import datetime
import json
import os
import platform
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
RESULTS = HERE / "results" / "programs.csv"
SYSTEMS = {
    "four-bar": "four_bar()",
    **{f"closed chain of {links} links": f"energy_models.closed_pendulum({links})" for links in (4, 6, 20, 80)},
    "Andrews": "energy_models.andrews()", "bicycle": "energy_models.bicycle()"}
STAGES = ("energies in SymPy", "deriving", "eliminating common subexpressions", "writing C", "compiling", "start",
          "closed-form functions")
COLUMNS = ["what", "version", *(f"{stage} [s]" for stage in STAGES), "terms together [s]", "terms by the clock [s]",
           "all by the clock [s]"]

MEASURED = """
import json, resource, sys, time
import sympy, sympy.physics.mechanics
import zerodrift as zd
from zerodrift.symbolics import define
from zerodrift.symbolics.compile import closed_form_library
from zerodrift._private.gateway import PROCESSOR_UNIT
sys.path.insert(0, sys.argv[3])
import energy_models
zd.symbolic

def spent():
    mine, of_compiler = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return mine.ru_utime + mine.ru_stime + of_compiler.ru_utime + of_compiler.ru_stime

class Stages(define.Progress):
    def __enter__(self):
        self.begin("energies in SymPy")
        return super().__enter__()
    def __call__(self, what):
        self.begin(what)
    def __exit__(self, *error):
        self.begin("start")
        return super().__exit__(*error)
    @staticmethod
    def begin(what):
        marks.append((what, spent()))

def four_bar():
    sys.path.insert(0, sys.argv[1])
    from bench_symbolic import chain
    core = zd.systems.four_bar()
    return zd.symbolic(**chain(3, (0.3, 1.0, 0.6), (1.5, 5.0, 3.0), 1.0), p0=core.p0, v0=core.v0)

def prepare(functions):
    before = spent()
    prepared(functions)
    meanwhile.append(spent() - before)

meanwhile, prepared = [], getattr(closed_form_library.ClosedFormFunctions, "prepare", None)
if prepared:
    closed_form_library.ClosedFormFunctions.prepare = prepare
define.Progress, marks = Stages, [("energies in SymPy", spent())]
began = time.perf_counter()
system = eval(sys.argv[2])
clock = time.perf_counter() - began
marks.append(("end", spent()))
seconds = {}
for (stage, before), (_, after) in zip(marks, marks[1:]):
    seconds[stage] = seconds.get(stage, 0) + after - before
seconds["compiling"] -= sum(meanwhile)
before = spent()
system._closed_form.library(list(closed_form_library.LANES)[PROCESSOR_UNIT])
seconds["closed-form functions"] = spent() - before + sum(meanwhile)
print(json.dumps([seconds, clock, time.perf_counter() - began]))
"""


def costs(expression):
    """Seconds by stage; and by the clock, of terms and of all."""
    with tempfile.TemporaryDirectory() as folder:
        said = subprocess.run([sys.executable, "-c", MEASURED, str(HERE), expression, str(HERE.parent / "support")], check=True,
                              capture_output=True, text=True, env=os.environ | {"ZERODRIFT_CACHE": folder})
    return json.loads(said.stdout)


def row(what, version, rounds):
    """The least of the rounds, of each stage and of all."""
    measured = [costs(SYSTEMS[what]) for _ in range(rounds)]
    stages = [min(seconds.get(stage, 0.0) for seconds, *_ in measured) for stage in STAGES]
    together = min(sum(seconds.values()) - seconds["closed-form functions"] for seconds, *_ in measured)
    clocks = (min(each) for each in zip(*(clocks for _, *clocks in measured), strict=True))
    return [what, version, *(f"{value:.3f}" for value in (*stages, together, *clocks))]


def facts():
    """The day and the machine."""
    model = next((line.split(":")[1].strip() for line in Path("/proc/cpuinfo").read_text().splitlines()
                  if line.startswith("model name")), platform.machine()) if Path("/proc/cpuinfo").exists() else platform.machine()
    compiler = subprocess.run(["cc", "--version"], capture_output=True, text=True, check=False).stdout.partition("\n")[0]
    return f"{datetime.date.today()}; {model}, {os.cpu_count()} cores; {compiler}; Python {platform.python_version()}"


def main():
    """Measure, print, and write the rows beside those of other versions."""
    parser = argparse.ArgumentParser()
    parser.add_argument("rounds", nargs="?", type=int, default=3)
    parser.add_argument("--name", default="now")
    parser.add_argument("--only", choices=SYSTEMS, nargs="*", default=list(SYSTEMS))
    given = parser.parse_args()
    kept = list(csv.reader(RESULTS.open(newline=""))) if RESULTS.exists() else []
    rows = {(line[0], line[1]): line for line in kept if line and line[0] in SYSTEMS}
    for what in given.only:
        rows[what, given.name] = row(what, given.name, given.rounds)
        print(*rows[what, given.name], sep=", ", flush=True)
    with RESULTS.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        table.writerows(sorted(rows.values(), key=lambda line: list(SYSTEMS).index(line[0])))
        table.writerow([facts()])


if __name__ == "__main__":
    main()
