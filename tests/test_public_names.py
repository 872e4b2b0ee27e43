"""The names that the package and its modules offer, and what importing it brings along."""

import importlib
import inspect
import pydoc
import re
import subprocess
import sys
from pathlib import Path

import pytest

import zerodrift as zd

PACKAGE = Path(zd.__file__).parent


def public_modules():
    """Modules that `zerodrift` names, and those from which its documentation imports."""
    named = {getattr(zd, name).__name__ for name in zd.__all__ if type(getattr(zd, name)) is type(zd)}
    written = "".join(path.read_text() for path in [*PACKAGE.rglob("*.py"), PACKAGE.parents[1] / "README.md"] if path.is_file())
    imported = re.findall(r"(?:>>> |^|    )(?:from|import) (zerodrift(?:\.[a-z]\w*)*)", written, flags=re.MULTILINE)
    packages = {f"zerodrift.{path.parent.name}" for path in PACKAGE.glob("[a-z]*/__init__.py") if "__all__" in path.read_text()}
    return sorted({"zerodrift", *named, *imported, *packages})


@pytest.mark.parametrize("name", public_modules())
def test_completion_shows_only_what_is_public(name):
    module = importlib.import_module(name)
    assert set(dir(module)) == set(module.__all__)
    assert all(hasattr(module, public) for public in module.__all__)


def test_the_module_has_what_it_lists():
    assert all(hasattr(zd, name) for name in zd.__all__ if name != "plot")
    with pytest.raises(AttributeError, match="module 'zerodrift' has no attribute 'System2'"):
        _ = zd.System2


def test_help_opens_with_tasks_and_has_each_function_with_its_arguments():
    """Functions that are imported at first use, too; of modules, those that are not private."""
    opening, _, rest = pydoc.plain(pydoc.render_doc(zd)).partition("PACKAGE CONTENTS")
    tasks = set(re.findall(r"zd\.(\w+)", opening))
    assert {"Mechanism", "System", "simulate", "plot", "view", "equilibrium", "linearize", "kinematics", "inverse_dynamics",
            "ensemble", "load", "fmu"} <= tasks
    assert tasks < set(zd.__all__)
    assert not re.findall(r"^    (_[a-z].*)", rest.partition("SUBMODULES")[0], re.MULTILINE), "modules that are private"
    for name in zd.__all__:
        if inspect.isroutine(getattr(zd, name)):
            assert re.search(rf"^    {name}\(.*\)", rest, re.MULTILINE), name
        elif inspect.isclass(getattr(zd, name)):
            assert re.search(rf"^    class {name}\(", rest, re.MULTILINE), name


def test_what_is_not_used_is_not_imported():
    heavy = ["matplotlib", "sympy", "zerodrift.mechanisms", "zerodrift._private.gateway.mechanisms", "zerodrift.inertia",
             "zerodrift.symbolics"]
    code = f"import sys, zerodrift; print([name for name in {heavy} if name in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"


def test_matplotlib_waits_until_something_is_drawn():
    """A film is drawn by its page."""
    code = ("import sys, zerodrift as zd; sol = zd.simulate(zd.models.four_bar(), 1, step=0.05); zd.view(sol).page;"
            "print('matplotlib' in sys.modules)")
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "False\n"
