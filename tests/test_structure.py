"""The package: no file and no folder needs, through however many others, something that needs it. And tests mirror the rooms."""

import ast
import importlib.util
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
    return ".".join(module.split(".")[:2])


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


@pytest.mark.parametrize("source", [
    "from ..systems import base",
    "from ..systems.base import BaseSystem",
    "import zerodrift.systems.base",
    "def f():\n    from ..systems.base import BaseSystem",
    "if TYPE_CHECKING:\n    from ..systems.base import BaseSystem",
])
def test_every_way_to_import_counts(source):
    assert imported("zerodrift.runs.settings", source) == {"zerodrift.systems.base"}


def test_a_circle_is_found():
    assert circle({"a": {"b"}, "b": {"c"}, "c": set()}) is None
    assert set(circle({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}})) == {"a", "b", "c"}


def test_folders_of_tests_are_named_after_rooms():
    """The folders of `csrc/` and `python/zerodrift/`, where `run/` and `runs/` are one."""
    files = [*ROOT.glob("csrc/*/*.c"), *ROOT.glob("python/zerodrift/*/*.py")]
    rooms = {path.parent.name.removeprefix("_") for path in files}
    assert {path.parent.name for path in ROOT.glob("tests/*/**/test_*.py")} == rooms - {"run"}
