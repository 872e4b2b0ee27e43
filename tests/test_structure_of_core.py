"""The core's files and folders depend on each other one way: from the story in simulate.c down to the kernels in linalg/."""

import re
import shutil
import subprocess
import sys
from collections import Counter, defaultdict

import pytest

from core_objects import CSRC, unit_of
from room_order import ORDER, height
from support import ROOT

LONGEST = 40        # lines of a function
TALLEST = 350       # lines of a file
WIDEST = 142        # columns of a line


def name_of(path):
    return unit_of(path) + path.suffix * (path.suffix == ".h")


def includes():
    """Who includes whom, as pairs: sources as their units, headers, which may announce several sources, with their ending."""
    pairs = set()
    for path in CSRC.rglob("*.[ch]"):
        for name in re.findall(r'^#include "(.+)"', path.read_text(), re.MULTILINE):
            beside = path.parent / name
            found = beside if beside.exists() else CSRC / name
            assert found.exists(), f"{path} includes {name}"
            pairs.add((name_of(path), name_of(found.resolve())))
    return pairs


def symbols(objects):
    """Who uses a function or table that another file defines, as pairs; and who defines each."""
    defined, used, units = {}, defaultdict(set), {str(path): unit for unit, path in objects.items()}
    for line in subprocess.run(["nm", "-A", *objects.values()], check=True, capture_output=True, text=True).stdout.splitlines():
        path, _, rest = line.partition(":")
        (*_, kind, name), unit = rest.split(), units[path]
        if kind == "U":
            used[unit].add(name)
        elif kind.isupper():
            assert name not in defined, f"{unit} and {defined[name]} both define {name}"
            defined[name] = unit
    return {(unit, defined[name]) for unit, names in used.items() for name in names & defined.keys()}


def folder_of(unit):
    """The room; a file at the top stands for itself. What all may include, the public interface, has its own."""
    return unit.rpartition("/")[0] or unit.removesuffix(".h")


def circles(pairs):
    """The sets of more than one node that can reach each other."""
    reached = defaultdict(set)
    for a, b in pairs:
        if a != b:
            reached[a].add(b)
    for middle in sorted({node for pair in pairs for node in pair}):
        for node in list(reached):
            if middle in reached[node]:
                reached[node] |= reached[middle]
    return {frozenset(b for b in reached[a] if a in reached[b]) for a in list(reached) if a in reached[a]}


@pytest.fixture(scope="module")
def uses(core_objects):
    """The pairs of files of which one includes the other, or uses a symbol that the other defines."""
    if sys.platform != "linux" or not shutil.which("nm"):
        pytest.skip("needs Linux and nm")
    return includes() | symbols(core_objects)


def test_a_circle_is_found():
    assert circles({("a", "b"), ("b", "c"), ("c", "d")}) == set()
    assert circles({("a", "b"), ("b", "c"), ("c", "b"), ("c", "d")}) == {frozenset("bc")}


def test_there_are_no_circles_of_files(uses):
    assert circles(uses) == set()


def test_there_are_no_circles_of_folders(uses):
    assert circles({(folder_of(a), folder_of(b)) for a, b in uses}) == set()


def test_rooms_depend_downward(uses):
    """The order that `tests/stress/step_trace.py` counts climbs by."""
    ordered, found = {room for line in ORDER for room in line}, {(folder_of(a), folder_of(b)) for a, b in uses}
    assert ordered <= {room for pair in found for room in pair}
    assert {(a, b) for a, b in found if a != b and {a, b} <= ordered and height(b) >= height(a)} == set()


def test_the_step_knows_no_closed_form_beyond_its_paths():
    """The motion, integrators, corrections, checks and output do not ask which path a step is on. The step asks for the path's
    functions; a snapshot has the accelerations of one elimination order; runs that are repeated, started elsewhere or made in
    lanes ask whether there is a closed form.
    """
    asked = re.compile(r"path(\.|->)(is_plain|embeds|finishes|continues|was_taken|closed_form|order)\b"
                       r"|zd_(has|finishes_in)_closed_form|zd_path_of\b")
    asking = Counter(unit_of(path).split("/")[0] for path in CSRC.rglob("*.[ch]") for line in path.read_text().splitlines()
                     if asked.search(line))
    assert asking.keys() == {"paths", "state", "step", "run", "batch"}
    assert asking["step"] + asking["run"] + asking["batch"] <= 7


@pytest.mark.parametrize("room", ["integrators", "corrections"])
def test_integrators_and_corrections_see_the_motion_and_no_run(uses, room):
    """They include nothing from the rooms above them; below the motion they may use all that it is made of."""
    below = {"motion", "formulations", "constraints", "point", "linalg", "step_limits", "zerodrift", "include", "workspace"}
    assert {folder_of(b).split("/")[0] for a, b in uses if a.split("/")[0] == room} <= below | {room}


def test_plane_and_space_share_the_room_common_alone():
    """Neither includes a file of the other, and `common` includes none of both."""
    included = defaultdict(set)
    for a, b in includes():
        if a.startswith("mechanisms/") and b.startswith("mechanisms/"):
            room, of = (unit.split("/")[1].removesuffix("_tree") for unit in (a, b))     # space_tree is of space
            included[room].add(of)
    assert included == {"common": {"common"}, "plane": {"plane", "common"}, "space": {"space", "common"}}


def is_generated(path):
    """True for closed forms, series and double-double kernels of the core's own systems, which are written by a program."""
    return path.parent.parent == CSRC / "systems"


def functions():
    """The lines of each function, from its name to the closing brace: both are at the margin, and nothing else of it is."""
    for path in CSRC.rglob("*.[ch]"):
        if is_generated(path):
            continue
        for match in re.finditer(r"^[A-Za-z][^;={}/]*?(\w+)\([^;{}]*\)\n\{\n.*?^\}$", path.read_text(), re.MULTILINE | re.DOTALL):
            yield f"{unit_of(path)}: {match[1]}", match[0].count("\n") + 1


def test_files_are_short():
    lines = {unit_of(path) + path.suffix: len(path.read_text(encoding="utf-8").splitlines()) for path in CSRC.rglob("*.[ch]")
             if not is_generated(path)}
    assert len(lines) > 300
    assert {name: count for name, count in lines.items() if count > TALLEST} == {}


def test_functions_are_short():
    lengths = dict(functions())
    assert len(lengths) > 300
    assert {name: lines for name, lines in lengths.items() if lines > LONGEST} == {}


def test_lines_of_c_are_within_their_columns():
    """The core, what exported models contain, and the tests' own programs."""
    files = [path for folder in (CSRC, ROOT / "python", ROOT / "tests") for path in folder.rglob("*.[ch]")
             if not is_generated(path)]
    assert len(files) > 300
    assert [f"{path.relative_to(ROOT)}:{number}" for path in files
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1) if len(line) > WIDEST] == []


def test_lanes_and_single_runs_share_the_limits_of_steps():
    """Each name of step_limits.h is used by single runs; those used in batch/ are defined nowhere else."""
    limits = set(re.findall(r"^(?:#define|    )\s*(ZD_\w+) ", (CSRC / "step_limits.h").read_text(), re.MULTILINE))
    files = [path for path in CSRC.rglob("*.[ch]") if path.name != "step_limits.h"]
    lanes = " ".join(path.read_text() for path in files if CSRC / "batch" in path.parents)
    runs = " ".join(path.read_text() for path in files if CSRC / "batch" not in path.parents)
    in_lanes, in_runs = (set(re.findall(r"\bZD_\w+", text)) for text in (lanes, runs))
    assert len(limits) > 20
    assert limits - in_runs == set()
    assert len(limits & in_lanes) > 15
    assert limits & set(re.findall(r"\b(ZD_\w+) = ", lanes + runs) + re.findall(r"#define (ZD_\w+)", lanes + runs)) == set()
