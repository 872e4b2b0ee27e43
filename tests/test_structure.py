"""The package: no file and no folder needs, through however many others, something that needs it. And tests mirror the rooms."""

import ast
import importlib.util
import inspect
import re
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import zerodrift
from support import ROOT

PACKAGE = Path(zerodrift.__file__).parent


def module_of(path):
    """The name under which a file of the package is imported."""
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


FILES = {module_of(path): path for path in PACKAGE.rglob("*.py")}


def imported(module, source):
    """The package's modules that a source imports, anywhere: at the top, in functions, and for types only."""
    package = module if FILES[module].name == "__init__.py" else module.rpartition(".")[0]
    found = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            origin = importlib.util.resolve_name("." * node.level + (node.module or ""), package)
            members = {f"{origin}.{alias.name}" for alias in node.names}
            found |= {member if member in FILES else origin for member in members}
    return (found & set(FILES)) - {module}


def folder_of(module):
    """The folder that a file is in; a file directly in the package stands for itself."""
    return ".".join(module.replace("._private", "").split(".")[:2])


def circle(graph):
    """The nodes of a circle in a graph {node: its dependencies}, or None."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return error.args[1]
    return None


@pytest.fixture(scope="module")
def files():
    """Imports of each file. The package itself offers everything, so a file that imports from it is in a circle."""
    graph = {module: imported(module, path.read_text(encoding="utf-8")) for module, path in FILES.items()}
    return graph | {"zerodrift": set(FILES) - {"zerodrift", "zerodrift.__main__"}}


def test_no_files_import_each_other_in_a_circle(files):
    assert len(files) > 40
    assert circle(files) is None


def test_no_folders_import_each_other_in_a_circle(files):
    folders = {}
    for module, dependencies in files.items():
        folder = folder_of(module)
        folders.setdefault(folder, set()).update({folder_of(other) for other in dependencies} - {folder})
    assert {"zerodrift.runs", "zerodrift.systems"} <= set(folders)
    assert circle(folders) is None


def room_of(module):
    """The sub-package of `mechanisms` or `symbolics` that a module is in, or its own name; None for the package itself."""
    parts = module.split(".")[2:]
    return parts[0] if parts else None


def arrows_between_rooms(files):
    """Pairs of rooms of `mechanisms`, of which the first imports the second."""
    return {(room_of(module), room_of(other)) for module in files if is_of_mechanisms(module) for other in files[module]
            if is_of_mechanisms(other)} - {(room, room) for room in map(room_of, files)}


def is_of_mechanisms(module):
    return module.startswith("zerodrift.mechanisms.")


def test_mechanisms_have_few_rooms_and_few_arrows_between_them(files):
    """An import from a facade, an `__init__.py` that imports, would hide arrows, so there is none."""
    rooms = {room_of(module) for module in files if is_of_mechanisms(module)}
    arrows = arrows_between_rooms(files)
    graph = {room: {other for one, other in arrows if one == room} for room in rooms}
    assert rooms == {"elements", "building", "equations", "assembly", "reports", "files", "pictures", "loads",
                     "mechanism", "system", "linkage"}
    assert len(rooms) <= 11
    assert len(arrows) <= 30
    assert circle(graph) is None
    facades = [module for module, path in FILES.items() if is_of_mechanisms(module) and path.name == "__init__.py"]
    assert len(facades) == 8
    assert not any(files[module] for module in facades)


def test_no_room_of_mechanisms_has_more_than_seventeen_files():
    rooms = [path for path in (PACKAGE / "mechanisms").iterdir() if path.is_dir() and path.name != "__pycache__"]
    assert len(rooms) == 8
    assert {room.name: len(list(room.glob("*.py"))) for room in rooms if len(list(room.glob("*.py"))) > 17} == {}


ENDINGS = re.compile("(|s|es|e|ed?|d|ers?|ings?|ions?|or|ant|ance|ancy|ment|able|y)")


def differ_in_an_ending(one, other):
    """True if two names are one word with different grammatical endings, such as "partition" and "partitioned"."""
    return one != other and any(one[:k] == other[:k] and ENDINGS.fullmatch(one[k:]) and ENDINGS.fullmatch(other[k:])
                                for k in range(4, min(len(one), len(other)) + 1))


@pytest.mark.parametrize(("one", "other", "expected"), [
    ("partition", "partitioned", True), ("redundancy", "redundant", True), ("measures", "measuring", True),
    ("rate", "rates", True),
    ("bodies", "space_bodies", False), ("tables", "trees", False), ("force_verbs", "force_shapes", False)])
def test_names_that_differ_in_an_ending_are_found(one, other, expected):
    assert differ_in_an_ending(one, other) is expected
    assert differ_in_an_ending(other, one) is expected


def test_no_two_modules_of_mechanisms_differ_in_an_ending():
    names = sorted({module.rpartition(".")[2] for module in FILES if is_of_mechanisms(module)})
    pairs = [(one, other) for one in names for other in names if one < other and differ_in_an_ending(one, other)]
    assert len(names) > 60
    assert pairs == []


def test_no_two_modules_of_systems_and_symbolics_differ_in_an_ending():
    files = [path for room in ("systems", "symbolics") for path in (PACKAGE / room).rglob("*.py")]
    names = sorted({path.stem for path in files} - {"__init__"})
    pairs = [(one, other) for one in names for other in names if one < other and differ_in_an_ending(one, other)]
    assert len(names) > 45
    assert pairs == []


@pytest.mark.parametrize(("folder", "expected"), [
    ("symbolics", {"graph", "elimination", "emit", "compile"}), ("runs", {"arguments", "states", "samples", "open"})])
def test_rooms_are_small_and_import_each_other_in_no_circle(files, folder, expected):
    """A file that is directly in the folder counts as a room."""
    modules = [module for module in files if module.startswith(f"zerodrift.{folder}.")]
    rooms = {room_of(module): set() for module in modules}
    for module in modules:
        rooms[room_of(module)] |= {room_of(other) for other in files[module] & set(modules)} - {room_of(module)}
    assert expected <= set(rooms)
    assert circle(rooms) is None
    sizes = {path.name: len(list(path.glob("*.py"))) for path in (PACKAGE / folder).iterdir() if path.is_dir()}
    assert set(sizes) - {"__pycache__"} == expected
    assert max(sizes.values()) <= 15


def test_no_file_is_long():
    """The files of the core have their limit in `test_structure_of_core.py`."""
    lengths = {module: path.read_text(encoding="utf-8").count("\n") for module, path in FILES.items()}
    assert {module: lines for module, lines in lengths.items() if lines > 400} == {}


def signatures(tree):
    """Functions of a module with their arguments, and classes with those of their instances."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef):
            yield from ((node.name, each.args) for each in node.body if getattr(each, "name", "") == "__init__")
        elif isinstance(node, ast.FunctionDef) and node.name != "__init__":
            yield node.name, node.args


def test_functions_inside_the_package_have_at_most_a_dozen_arguments():
    """Public functions and classes have as many as their users choose from; they hand them on together."""
    found = set()
    for path in FILES.values():
        for name, of in signatures(ast.parse(path.read_text(encoding="utf-8"))):
            names = [each.arg for each in (*of.posonlyargs, *of.args, *of.kwonlyargs, of.vararg, of.kwarg) if each]
            if len(names) - (names[:1] in (["self"], ["cls"])) > 12:
                found.add(name)
    assert {"System"} <= found
    assert found - set(zerodrift.__all__) == set()


def test_no_public_function_has_the_name_of_a_module():
    """A module `zerodrift.NAME` would replace the function `zerodrift.NAME` when it is first imported."""
    modules = {module.split(".")[1] for module in FILES if module != "zerodrift"}
    functions = {name for name in zerodrift.__all__ if inspect.isfunction(getattr(zerodrift, name))}
    assert len(functions) > 20
    assert modules & functions == set()


@pytest.mark.parametrize("source", [
    "from ..systems import base",
    "from ..systems.base import BaseSystem",
    "import zerodrift.systems.base",
    "def f():\n    from ..systems.base import BaseSystem",
    "if TYPE_CHECKING:\n    from ..systems.base import BaseSystem",
])
def test_every_way_to_import_counts(source):
    assert imported("zerodrift.runs.simulate", source) == {"zerodrift.systems.base"}


def test_constants_have_a_noun():
    """ROUNDING once had eight values in 17 files."""
    words = "ROUNDING|SMALL|LARGE|LONG|SHORT|LEAST|CALM|AMPLE|ENOUGH"
    bare = re.compile(rf"^(?:static const \w+ |#define (?:ZD_)?)?({words})\b(?! *\()", re.MULTILINE)
    texts = {path: path.read_text(encoding="utf-8") for folder in ("csrc", "python", "tests")
             for path in (ROOT / folder).rglob("*.*") if path.suffix in (".c", ".h", ".py")}
    assert len(texts) > 800
    assert bare.findall("static const double ROUNDING = 1e-12;\n#define ZD_LONG 3\nSMALL = 1") == ["ROUNDING", "LONG", "SMALL"]
    assert {path.name: found for path, text in texts.items() if (found := bare.findall(text))} == {}


def test_a_circle_is_found():
    assert circle({"a": {"b"}, "b": {"c"}, "c": set()}) is None
    assert set(circle({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}})) == {"a", "b", "c"}


def test_folders_of_tests_are_named_after_rooms():
    """The folders of `csrc/`, nested ones alone or with the room around them, and of `python/zerodrift/`; `run/` is `runs/`."""
    of_core = {path.parent.relative_to(ROOT / "csrc").as_posix() for path in ROOT.glob("csrc/*/**/*.c")}
    of_package = {path.parent.name for path in [*PACKAGE.glob("[!_]*/*.py"), *PACKAGE.glob("_private/*/*.py")]}
    rooms = {room for room in of_core if room.split("/")[0] != "run"} | of_package
    folders = {path.parent.relative_to(ROOT / "tests").as_posix() for path in ROOT.glob("tests/*/**/test_*.py")}
    assert {room for room in rooms if not {room, room.rpartition("/")[0]} & folders} == set()
    assert {folder for folder in folders - rooms if folder.count("/") == 0 or folder.startswith("mechanisms/")} == set()


def test_scripts_that_are_started_by_hand_find_what_they_import():
    """Path of shared helpers: pytest's configuration has it; a script sets it, or its first lines name the PYTHONPATH."""
    helpers = {path.stem for path in ROOT.glob("tests/support/*.py")}
    for path in [*ROOT.glob("tests/stress/*.py"), *ROOT.glob("tests/bench/**/*.py")]:
        source = path.read_text(encoding="utf-8")
        if helpers & set(re.findall(r"^(?:from|import) (\w+)", source, re.MULTILINE)):
            assert re.search(r'/ "support"\)|tests/support', source), path


def test_the_gateway_has_small_rooms():
    """The room of the core's systems and runs, and within it those of mechanisms and of compiled functions."""
    rooms = {path.parent.name: len(list(path.parent.glob("*.py"))) for path in (PACKAGE / "_private" / "gateway").rglob("*.py")}
    assert set(rooms) == {"gateway", "compiled", "mechanisms"}
    assert max(rooms.values()) <= 15
