"""Code of the documentation runs: examples of docstrings, and the Python code of the README."""

import contextlib
import doctest
import importlib
import inspect
import pkgutil
import re
import warnings

import matplotlib
import matplotlib.pyplot as plt
import pytest

import zerodrift
from support import ROOT

README = ROOT / "README.md"
MODULES = [module.name for module in pkgutil.walk_packages(zerodrift.__path__, "zerodrift.")
           if not module.name.endswith("__main__")]


@pytest.mark.parametrize("name", ["zerodrift", *MODULES])
def test_examples_of_docstrings(name):
    """Each example runs by itself, with the names that it imports and no others."""
    matplotlib.use("Agg")
    runner = doctest.DocTestRunner()
    for examples in doctest.DocTestFinder().find(importlib.import_module(name), globs={}):
        runner.run(examples)
    plt.close("all")
    assert runner.summarize(verbose=False).failed == 0


def texts():
    """Texts that users read, by where they stand: modules with their docstrings, the README and notebooks."""
    files = [*(ROOT / "python" / "zerodrift").rglob("*.py"), README, *(path for path in (ROOT / "notebooks").rglob("*.*")
             if path.suffix in (".md", ".ipynb") and path.parts[len(ROOT.parts) + 1] != "generated")]
    return {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in files}


def is_there(name):
    """Existence of a dotted name such as ``zd.plot.path`` or ``zerodrift.plot.path``."""
    place = zerodrift
    for part in name.split(".")[1:]:
        if inspect.ismodule(place) and not name.startswith("zd."):      # `zd.` has what an import of the package brings
            with contextlib.suppress(ModuleNotFoundError):
                importlib.import_module(f"{place.__name__}.{part}")
        if not hasattr(place, part):
            return False
        place = getattr(place, part)
        if not (inspect.ismodule(place) or inspect.isclass(place)):
            return True         # attributes of results and instances are beyond
    return True


def test_names_in_documentation_exist():
    dotted = re.compile(r"(?<![\w/])(?:zd|zerodrift)(?:\.[a-zA-Z_]\w*)+")
    named = {(where, name) for where, text in texts().items() for name in dotted.findall(text)}
    assert len(named) > 400
    assert not [each for each in sorted(named) if not is_there(each[1])]


@pytest.mark.parametrize("name", [name for name in zerodrift.__all__ if callable(getattr(zerodrift, name))])
def test_every_public_name_is_documented(name):
    assert getattr(zerodrift, name).__doc__


def test_the_code_of_the_readme_runs(capsys, tmp_path, monkeypatch):
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", README.read_text(), re.DOTALL)
    assert len(blocks) == 2
    for block in blocks:
        with warnings.catch_warnings():
            warnings.simplefilter("error")      # AccuracyWarning, too, which other tests ignore
            exec(compile(block, "README.md", "exec"), {})
    printed = capsys.readouterr().out
    assert "freedom 0" in printed
    assert "Solution of" in printed


def test_the_readme_is_short():
    assert len(README.read_text().split()) < 900


def section(title):
    return re.search(rf"^## {title}\n(.*?)(?=^## )", README.read_text(), re.DOTALL | re.MULTILINE).group(1)


def test_the_readme_has_five_strengths_and_five_limits():
    assert [len(re.findall(r"^\* ", section(title), re.MULTILINE)) for title in ("Strengths", "Limits")] == [5, 5]


def test_the_examples_of_the_readme_are_fifteen_and_ten_lines():
    blocks = re.findall(r"```python\n(.*?)```", README.read_text(), re.DOTALL)
    assert [len([line for line in block.splitlines() if line]) for block in blocks] == [15, 10]


def test_the_readme_counts_the_models():
    assert f"`zd.models` has {len(zerodrift.models.__all__)} known mechanisms" in README.read_text()


def test_links_of_the_readme_lead_to_files():
    links = re.findall(r"\]\((?!https?:)([^)#]+)\)", README.read_text())
    assert len(links) >= 5
    assert not [link for link in links if not (ROOT / link).is_file()]


def test_files_that_contributors_change_and_run_exist():
    page = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    written = re.sub(r"[\w./]*<\w+>[\w.]*", "", page)      # what is to be added
    named = set(re.findall(r"(?:csrc|python|tests|notebooks|\.ci)/[\w./]*\w|\w+\.(?:cff|md)\b", written))
    assert len(named) > 25
    assert not [name for name in sorted(named) if not (ROOT / name).exists()]
    for table in ("ZD_INTEGRATOR_LIST", "joints[]", "elements[]"):
        assert table in page
    assert "ZD_INTEGRATOR_LIST" in (ROOT / "csrc" / "methods.h").read_text(encoding="utf-8")
    assert len(page.split()) < 800


def test_paths_of_the_architecture_page_exist():
    """Files and folders that the page names, and the functions that it names beside a file."""
    page = (ROOT / "notebooks" / "theory" / "architecture.md").read_text(encoding="utf-8")
    files = re.findall(r"`((?:csrc|python|tests)/[\w./]+)`", page)
    assert len(files) >= 20
    assert not [file for file in files if not (ROOT / file).exists()]
    for file, function in re.findall(r"`((?:csrc|python)/[\w./]+)`, `(\w+)(?:\(\))?`", page):
        assert re.search(rf"\b{function}\b", (ROOT / file).read_text(encoding="utf-8")), f"{function} in {file}"
    rooms = set(re.findall(r"`(\w+)/`", page))
    assert {path.name for path in (ROOT / "csrc").iterdir() if path.is_dir()} - rooms == {"python"}     # which is the binding
