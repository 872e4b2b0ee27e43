"""Writes the examples of the README and of docstrings as files of a user, for type checkers.

PYTHONPATH=python:tests:tests/support python tests/support/user_files.py FOLDER
"""

import doctest
import importlib
import pkgutil
import re
import sys
from pathlib import Path

import zerodrift
from support import ROOT


def examples():
    """Examples by names of files: statements of a docstring, or a block of the README."""
    for i, block in enumerate(re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)):
        yield f"readme_{i}", block
    for module in pkgutil.walk_packages(zerodrift.__path__, "zerodrift."):
        if not module.name.endswith("__main__"):
            for found in doctest.DocTestFinder().find(importlib.import_module(module.name)):
                if found.examples:
                    yield found.name.replace(".", "_"), "".join(each.source for each in found.examples)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in examples():
        (folder / f"{name}.py").write_text(text, encoding="utf-8")
