"""What the documentation shows, runs: examples of docstrings, and the Python code of the README."""

import doctest
import importlib
import pkgutil
import re

import matplotlib
import matplotlib.pyplot as plt
import pytest

import zerodrift
from support import ROOT

README = ROOT / "README.md"
MODULES = [module.name for module in pkgutil.walk_packages(zerodrift.__path__, "zerodrift.")
           if not module.name.endswith(("__main__", "_core"))]


@pytest.mark.parametrize("name", ["zerodrift", *MODULES])
def test_examples_of_docstrings(name):
    matplotlib.use("Agg")
    failed, _ = doctest.testmod(importlib.import_module(name))
    plt.close("all")
    assert failed == 0


@pytest.mark.parametrize("name", [name for name in zerodrift.__all__ if callable(getattr(zerodrift, name))])
def test_every_public_name_is_documented(name):
    assert getattr(zerodrift, name).__doc__


def test_the_code_of_the_readme_runs(capsys):
    matplotlib.use("Agg")
    blocks = re.findall(r"```python\n(.*?)```", README.read_text(), re.DOTALL)
    assert len(blocks) == 4
    for block in blocks:
        exec(compile(block, "README.md", "exec"), {})
    printed = capsys.readouterr().out
    assert "left the range of doubles" in printed
    assert "nothing wrong" in printed
