"""The fingerprint of the sources: a core that is older than they are is noticed."""

import os
import shutil
import subprocess
import sys

import pytest

from support import ROOT
from zerodrift import _core


@pytest.fixture
def tree(tmp_path):
    """A copy of the source tree with its compiled core."""
    for name in ("csrc", "python"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info", "*.so", "*.pyd"))
    shutil.copy(_core.__file__, tmp_path / "python" / "zerodrift")
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
