"""Writes `table_verbs.pyi`, the declarations of the methods that are made from the core's tables, from their signatures.

PYTHONPATH=python:tests:tests/support python tests/mechanisms/stub_of_verbs.py
"""

import inspect
import textwrap
from pathlib import Path

from zerodrift.mechanisms.building import table_verbs

STUB = Path(table_verbs.__file__).with_suffix(".pyi")
HEAD = '''"""Methods of `Mechanism` made from the core's tables; written by tests/mechanisms/stub_of_verbs.py."""

from typing import Any

from ..elements.bodies import Body, Point
from ..elements.joints import Joint
from ..elements.space_joints import SpaceJoint
from ..elements.table_forces import TableForce
from .registry import Elements

PLANE: dict[str, type[Joint]]
FORCES: dict[str, type[TableForce]]
Side = Body | Point | str

class TableVerbs(Elements):
'''


def declared(method):
    """The declaration of a method, with its docstring."""
    signature = inspect.signature(method)
    parts = []
    for name, parameter in signature.parameters.items():
        if parameter.kind is parameter.KEYWORD_ONLY and "*" not in parts:
            parts.append("*")
        kind = "" if name == "self" else f": {parameter.annotation}" if parameter.annotation is not parameter.empty else ": Any"
        parts.append(f"{name}{kind}" + ("" if parameter.default is parameter.empty else f" = {parameter.default!r}"))
    kind = "Any" if signature.return_annotation is signature.empty else signature.return_annotation
    doc, head = textwrap.indent(inspect.getdoc(method), "        ").lstrip(), f"    def {method.__name__}("
    arguments = ", ".join(part.replace(" ", "~") for part in parts)     # lines break between arguments
    lines = textwrap.wrap(f"{arguments})~->~{kind}:", 130, initial_indent=head, subsequent_indent=" " * len(head))
    return "\n".join(lines).replace("~", " ") + f'\n        """{doc}\n        """\n'


def stub():
    """The text of the stub."""
    methods = [method for name, method in vars(table_verbs.TableVerbs).items() if not name.startswith("_")]
    return HEAD + "\n".join(map(declared, methods))


if __name__ == "__main__":
    STUB.write_text(stub(), encoding="utf-8")
