"""The text of `table_verbs.pyi`: declarations of the methods that are made from the core's tables, from their signatures.

tests/support/stubs.py writes it.
"""

import inspect
import textwrap
from pathlib import Path
from types import SimpleNamespace

from zerodrift.mechanisms.building import table_verbs
from zerodrift.mechanisms.elements import forces
from zerodrift.mechanisms.elements.measures import Measure, VectorMeasure
from zerodrift.mechanisms.elements.space_joints import BY_KIND

STUB = Path(table_verbs.__file__).with_suffix(".pyi")
HEAD = '''"""Methods of `Mechanism` made from the core's tables; written by tests/support/stubs.py."""

from ..._private.types import {types}
from ..elements import forces
from ..elements.bodies import Body, Point
from ..elements.joints import Joint
from ..elements.measures import Measure, VectorMeasure3
from ..elements.space_joints import SpaceJoint
from ..elements.table_forces import TableForce
from .registry import Elements

PLANE: dict[str, type[Joint]]
FORCES: dict[str, type[TableForce]]
Side = Body | Point | str

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


def measures(kinds):
    """Measures of an element of these classes, of the plane and of space, by name: a vector if one of them has a vector."""
    element = SimpleNamespace(measured_name="element", dimension=3)
    found = [(name, value.fget(element)) for kind in kinds for name, value in vars(kind).items()
             if isinstance(value, property) and value.fget.__module__ == Measure.__module__]
    vectors = {name for name, measure in found if isinstance(measure, VectorMeasure)}
    return {name: "VectorMeasure3" if name in vectors else "Measure" for name, _ in found}


def declared_class(name, base, kinds, numbers=()):
    """The declaration of the class of an element, with what its entries in the tables define."""
    attributes = {number: "float" for number in numbers} | measures(kinds)
    return f"class {name}({base}):\n" + "".join(f"    {name}: {kind}\n" for name, kind in attributes.items()) + (
        "" if attributes else "    ...\n")


def stub():
    """The text of the stub."""
    joints = [[kind for kind in (table_verbs.PLANE.get(name), BY_KIND.get(name)) if kind] for name in table_verbs.JOINTS]
    classes = [declared_class(kinds[0].__name__, kinds[0].__base__.__name__, kinds) for kinds in joints]
    classes += [declared_class(force.__name__, f"forces.{force.__name__}" if hasattr(forces, force.__name__) else "TableForce",
                               [force], getattr(force, "stored", {}).values()) for force in table_verbs.FORCES.values()]
    methods = [method for name, method in vars(table_verbs.TableVerbs).items() if not name.startswith("_")]
    body = "\n".join([*classes, "class TableVerbs(Elements):", *map(declared, methods)])
    return HEAD.format(types=", ".join(each for each in ("ArrayLike", "Bindings", "LawLike", "Laws") if each in body)) + body
