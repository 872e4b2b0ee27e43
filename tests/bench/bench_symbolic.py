"""Symbolic systems: a step against the system in C, and what deriving and compiling cost, for the closed chain of n links.

Run it with ``python tests/bench/bench_symbolic.py``; it needs SymPy and a C compiler, and writes ``results/symbolic.csv``
and ``results/symbolic_chain.csv``.
"""

import csv
import functools
import itertools
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

import zerodrift as zd
from measuring import least, record
from zerodrift.symbolics.arguments import Definition
from zerodrift.symbolics.cache_key import fingerprint
from zerodrift.symbolics.compile import compilers, shared_library
from zerodrift.symbolics.emit.writers import CWriter
from zerodrift.symbolics.graph.blocks import Blocks
from zerodrift.symbolics.graph.derivation import Derivation
from zerodrift.symbolics.graph.lowering import Lowering

HERE = Path(__file__).resolve().parent
T = dynamicsymbols._t
STEPS, STEP = 800, 0.01
OPTIONS = {"step": STEP, "energy": True, "save_every": STEPS}


def chain(n, lengths, masses, ground, relative=False):
    """Chain of n slender links with pin joints, its end fixed at (ground, 0); angles from the x axis, or between links."""
    angles, names, m = dynamicsymbols(f"a1:{n + 1}"), sp.symbols(f"l1:{n + 1}"), sp.symbols(f"m1:{n + 1}")
    g, l0 = sp.symbols("g l0")
    kinetic = potential = x = y = angle = sp.S.Zero
    for each, length, mass in zip(angles, names, m, strict=True):
        angle = angle + each if relative else each
        arm = sp.Matrix([sp.cos(angle), sp.sin(angle)]) * length
        middle = sp.Matrix([x, y]) + arm / 2
        kinetic += mass * middle.diff(T).dot(middle.diff(T)) / 2 + mass * length**2 / 24 * angle.diff(T) ** 2
        potential += mass * g * middle[1]
        x, y = x + arm[0], y + arm[1]
    return {"coordinates": angles, "kinetic": kinetic, "potential": potential, "constraints": [x - l0, y],
            "parameters": dict(zip([*names, *m, g, l0], [*lengths, *masses, 9.81, ground], strict=True))}


def four_bar():
    """The paper's."""
    core = zd.systems.four_bar()
    return zd.symbolic(**chain(3, (0.3, 1.0, 0.6), (1.5, 5.0, 3.0), 1.0), p0=core.p0, v0=core.v0, name="symbolic")


def steps(rounds=200):
    """For each formulation: the least time of a run of the symbolic four-bar over that of the system in C."""
    def seconds(system, formulation):
        return zd.simulate(system, STEP * STEPS, formulation=formulation, **OPTIONS).stats["seconds"]

    systems = (four_bar(), zd.systems.four_bar())
    for formulation in zd.formulations():
        mine, core = least(rounds, *(functools.partial(seconds, system, formulation) for system in systems))
        yield formulation, mine / core


def costs(n, relative, rounds=3):
    """Seconds for SymPy's writing of the energies, for derivation, elimination, writing C, compiling; and the operations."""
    best = [float("inf")] * 5
    for _ in range(rounds):
        times = [time.perf_counter()]
        given = chain(n, [1.0] * n, [1.0] * n, 1.0, relative)
        times.append(time.perf_counter())
        definition = Definition(given["coordinates"], given["kinetic"], given["potential"], None, given["constraints"], (), None,
                                None, given["parameters"], None, None, None, ())
        fingerprint(definition.expressions)
        reader, nodes = definition.read()
        terms = Derivation(reader.graph, nodes).terms()
        times.append(time.perf_counter())
        lowering = Lowering(reader.graph)
        blocks = Blocks(lowering, {name: [lowering.lower(node) for node in row] for name, row in terms.items()})
        times.append(time.perf_counter())
        source, _, _ = CWriter(blocks).source([], len(definition.values))
        times.append(time.perf_counter())
        shared_library._build(source, compilers.find().line(
            shared_library.SOURCE, shared_library.PRODUCT, zd.get_include(), ["-O3"], []))
        times.append(time.perf_counter())
        best = [min(a, after - before) for a, before, after in zip(best, times, times[1:], strict=False)]
    return *best, sum(1 for terms in blocks.users if terms)


AGAIN = """
import sys, time
import sympy
from sympy.physics.mechanics import dynamicsymbols
import zerodrift as zd
sys.path.insert(0, sys.argv[1])
from bench_symbolic import chain
given = [chain(3, [1.0] * 3, [1.0] * 3, 1.0), chain(10, [1.0] * 10, [1.0] * 10, 1.0)]
zd.symbolic                     # imported; what comes is the cache's
for each in given:
    start = time.perf_counter()
    system = zd.symbolic(**each)
    print(1e3 * (time.perf_counter() - start))
"""


def hits(rounds=10):
    """Milliseconds of `symbolic` from the second process on, for three and for ten links."""
    best = [float("inf")] * 2
    for _ in range(rounds + 1):
        said = subprocess.run([sys.executable, "-c", AGAIN, str(HERE)], check=True, capture_output=True, text=True).stdout
        best = [min(a, float(b)) for a, b in zip(best, said.split(), strict=True)]
    return best


def measured():
    """Rows (what, value, unit, limit)."""
    for formulation, ratio in steps():
        yield f"{formulation}: symbolic to C, a step", ratio, "", 1.3
    for n, milliseconds in zip((3, 10), hits(), strict=True):
        yield f"symbolic again in another process, {n} links", milliseconds, "ms", 10


PARTS = ("energies in SymPy", "derivation", "elimination", "writing C", "compilation")


def chains():
    """Rows of the table of the closed chain: angles, links, milliseconds of each part, operations."""
    for angles in ("from the x axis", "from link to link"):
        for n in range(2, 11):
            *seconds, operations = costs(n, angles == "from link to link")
            yield [angles, n, *(f"{1e3 * each:.3g}" for each in seconds), operations]


def main():
    """Measure, print and write."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ["ZERODRIFT_CACHE"] = folder
        record("symbolic", measured(), ("what", "value", "unit", "at most"))
        with (HERE / "results" / "symbolic_chain.csv").open("w", newline="") as file:
            table = csv.writer(file, lineterminator="\n")
            heading = ["angles", "links", *(f"{part} [ms]" for part in PARTS), "operations"]
            for row in itertools.chain([heading], chains()):
                print(*(f"{each!s:>22}" for each in row), flush=True)
                table.writerow(row)


if __name__ == "__main__":
    main()
