"""Fingerprints of the sources: a core that is older than they are is noticed, and what states of runs depend on."""

import os
import shutil
import subprocess
import sys

import pytest

from support import ROOT
from zerodrift._private import core
from zerodrift._private.fingerprint import layout_fingerprint


@pytest.fixture
def tree(tmp_path):
    """A copy of the source tree with its compiled core."""
    for name in ("csrc", "python"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info", "*.so", "*.pyd"))
    shutil.copy(core.__file__, tmp_path / "python" / "zerodrift" / "_private")
    return tmp_path


def imported(tree):
    """The outcome of importing the package of a tree."""
    code = "import zerodrift; print(zerodrift.__file__)"
    return subprocess.run([sys.executable, "-c", code], env=os.environ | {"PYTHONPATH": str(tree / "python")}, cwd=tree,
                          capture_output=True, text=True, check=False)


def test_a_fresh_core_is_taken(tree):
    result = imported(tree)
    assert str(tree) in result.stdout, result.stderr


@pytest.mark.parametrize("change", [
    lambda csrc: (csrc / "linalg" / "newton.c").write_text((csrc / "linalg" / "newton.c").read_text() + "\n"),
    lambda csrc: (csrc / "zerodrift.h").write_text((csrc / "zerodrift.h").read_text() + "\n"),
    lambda csrc: (csrc / "integrators" / "new.c").touch(),
    lambda csrc: (csrc / "linalg" / "newton.c").unlink(),
    lambda csrc: (csrc / "linalg" / "newton.c").rename(csrc / "linalg" / "newtons.c"),
    lambda csrc: (csrc.parent / "python" / "build_core.py").write_text(
        (csrc.parent / "python" / "build_core.py").read_text().replace("-O3", "-O2")),
], ids=["source", "header", "new file", "no file", "renamed", "flags"])
def test_a_stale_core_is_noticed(tree, change):
    change(tree / "csrc")
    result = imported(tree)
    assert result.returncode
    assert f"StaleCore: the compiled core is older than {tree / 'csrc'}; " in result.stderr
    assert result.stderr.rstrip().endswith(f"rebuild it with: pip install -e {tree} [zd:stale-core]")


@pytest.mark.parametrize(("name", "old", "new", "is_another"), [
    ("linalg/newton.c", "\n}", "\n    /* another line */ ;\n}", False),
    ("run/saved_state.c", "0x100000001b3", "0x100000001b5", False),
    ("linalg/dense.h", "int rows, rank;", "int rank, rows;", True),
    ("linalg/dense.h", "int rows, rank;", "int rows, rank;     /* a comment */", False),
    ("zerodrift/settings.h", "ZD_STOP, ZD_CONTINUE", "ZD_CONTINUE, ZD_STOP", True),
    ("linalg/row_space.c", "columns * rows", "2 * columns * rows", True),
    ("constraints/rank_monitor.c", ".weight = zd_arena_doubles(arena, m),", ".weight = zd_arena_doubles(arena, 2 * m),", True),
    ("run/open.c", "    zd_reactions_create(motion, arena);\n", "", True),
], ids=["function", "constant", "structure", "comment", "enumeration", "memory", "memory of a part", "order of memory"])
def test_layouts_of_runs_are_of_structures_enumerations_and_memory(tree, name, old, new, is_another):
    path, before = tree / "csrc" / name, layout_fingerprint(tree)
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    assert (layout_fingerprint(tree) != before) == is_another
