"""Files, changes of room and climbs in the calls of one step: how far its reader has to go.

    PYTHONPATH=python:tests:tests/support python tests/stress/step_trace.py [name=folder ...]

Compiles the core in each folder (without arguments, this repository's `csrc`) with `-O0 -finstrument-functions` and traces step
23 of the four-bar with projection and energy correction, in closed form and by matrices. A change of room is a call into another
folder; a climb is one into a folder above in the order of `room_order.py`, calls through tables included. Kernels of
`linalg/` are left out. Prints a table in Markdown; `step_trace.md` is the one of this version and of the one before it.
"""

import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from room_order import height
from support import ROOT

FLAGS = ("-O0", "-g1", "-gdwarf-4", "-std=c11", "-ffp-contract=off", "-fno-pic", "-finstrument-functions")
STEP = 23
ENTRIES = ("zd_step", "zd_step_loop_take_step", "zd_course_take_step")     # of this version and earlier ones
EARLIER = {"stepping": "step"}      # names of rooms in earlier versions
PATHS = {"closed form": 1, "by matrices": 0}


def program(csrc, folder):
    """The tracing program, linked with the core in a folder."""
    sources = [*sorted(csrc.rglob("*.c")), ROOT / "tests" / "stress" / "step_trace.c"]

    def compile_one(source):
        target = folder / f"{len(list(source.parents))}-{'-'.join(source.parts[-3:])}.o"
        subprocess.run(["cc", "-c", *FLAGS, "-I", csrc, "-o", target, source], check=True)
        return target

    with ThreadPoolExecutor(2) as pool:
        objects = list(pool.map(compile_one, sources))
    subprocess.run(["cc", "-no-pie", "-o", folder / "trace", *objects, "-lm"], check=True)
    return folder / "trace"


def address_of_step(trace):
    """The address of the function that makes a step."""
    lines = subprocess.run(["nm", trace], check=True, capture_output=True, text=True).stdout.split("\n")
    addresses = {line.split()[2]: line.split()[0] for line in lines if len(line.split()) == 3}
    return next(addresses[name] for name in ENTRIES if name in addresses)


def units(trace, csrc, addresses):
    """The file of each address, without its ending and relative to the core."""
    text = subprocess.run(["addr2line", "-e", trace, *addresses], check=True, capture_output=True, text=True).stdout
    files = [Path(line.rpartition(":")[0]).resolve() for line in text.splitlines()]
    return [file.relative_to(csrc.resolve()).with_suffix("").as_posix() for file in files]


def follow(trace, csrc, closed_form):
    """The calls of a step, as pairs of files, caller first; the first caller is the outer loop."""
    run = subprocess.run([trace, str(STEP), str(closed_form), address_of_step(trace)], check=True, capture_output=True, text=True)
    depths, addresses = zip(*(line.split() for line in run.stdout.splitlines()), strict=True)
    stack, pairs = ["simulate"], []
    for depth, unit in zip(map(int, depths), units(trace, csrc, addresses), strict=True):
        del stack[depth + 1:]
        pairs.append((stack[-1], unit))
        stack.append(unit)
    return [(a, b) for a, b in pairs if not b.startswith("linalg/")]


def room(unit):
    folder = unit.rpartition("/")[0] or unit
    return EARLIER.get(folder, folder)


def measure(pairs):
    """Files, calls, changes of room and climbs."""
    rooms = [(room(a), room(b)) for a, b in pairs]
    return len({b for _, b in pairs}), len(pairs), sum(a != b for a, b in rooms), sum(height(b) > height(a) for a, b in rooms)


def main(versions):
    print("| version | path | files | calls | changes of room | climbs |", "|---|---|---:|---:|---:|---:|", sep="\n")
    for name, csrc in versions:
        with tempfile.TemporaryDirectory() as folder:
            trace = program(csrc, Path(folder))
            for path, closed_form in PATHS.items():
                print("|", " | ".join(map(str, (name, path, *measure(follow(trace, csrc, closed_form))))), "|", flush=True)


if __name__ == "__main__":
    named = [each.partition("=") for each in sys.argv[1:]] or [("this version", "", ROOT / "csrc")]
    main([(name, Path(folder)) for name, _, folder in named])
