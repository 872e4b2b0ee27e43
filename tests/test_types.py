"""Types that editors and type checkers read: declarations of what is made or imported on demand, signatures, and completions."""

import inspect
import typing

import pytest

import zerodrift as zd
from stubs import STUBS

jedi = pytest.importorskip("jedi")
CODE = """import zerodrift as zd
m = zd.Mechanism("pendulum", gravity=(0, -9.81))
link = m.link("link", (0, 0), (1, 0), mass=1.0)
pin = m.revolute("pin", m.ground, link.start)
sol = zd.simulate(m, 1.0)
"""
PUBLIC = [name for name in zd.__all__ if callable(getattr(zd, name)) and not (
    inspect.isclass(getattr(zd, name)) and issubclass(getattr(zd, name), Exception))]


@pytest.mark.parametrize("path", STUBS, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_declarations_are_those_of_the_package(path):
    """Written anew by ``python tests/support/stubs.py``."""
    assert path.read_text(encoding="utf-8") == STUBS[path]()


def test_the_signature_of_simulate_is_read_in_ten_lines():
    lines = inspect.getsource(zd.simulate).splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("def "))
    assert next(i for i, line in enumerate(lines) if line.endswith(":")) - first < 10
    assert len(str(inspect.signature(zd.simulate))) < 800       # ten lines of a terminal


def completed(written):
    """Names that an editor offers after what was written."""
    return {each.name for each in jedi.Script(CODE + written).complete() if not each.name.startswith("_")}


@pytest.mark.parametrize("name", PUBLIC)
def test_every_public_function_completes_with_its_arguments(name):
    signature, = jedi.Script(CODE + f"zd.{name}(").get_signatures()
    known = {parameter.name for parameter in signature.params}
    asked = inspect.signature(getattr(zd, name)).parameters
    assert {parameter.name for parameter in asked.values() if parameter.kind is not parameter.VAR_KEYWORD} <= known


def test_types_of_settings_exist():
    assert typing.TYPE_CHECKING is False
