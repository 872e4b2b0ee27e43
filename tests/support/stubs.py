"""Writes the declarations of what is imported or made on demand, from the package itself: `__init__.pyi` of the package and of
`systems`; `types.pyi`, the types of arguments, with the names in the core's tables; `table_verbs.pyi`, methods of `Mechanism`.

PYTHONPATH=python:tests:tests/support python tests/support/stubs.py
"""

import inspect
import textwrap
from pathlib import Path

import zerodrift as zd
from mechanisms import stub_of_verbs
from zerodrift.runs.arguments import methods, settings
from zerodrift.runs.simulate import _read, simulate
from zerodrift.systems import builtin

PACKAGE = Path(zd.__file__).parent
WRITTEN = "written by tests/support/stubs.py."
TYPES = f'''"""Types of arguments, for type checkers and editors; {WRITTEN}"""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike as _PathLike
from typing import Any, Literal, Protocol, TypedDict

import numpy as np
from numpy.typing import ArrayLike as ArrayLike

from ..mechanisms.elements.bodies import Body as Body
from ..mechanisms.elements.bodies import Point as Point
from ..mechanisms.elements.measures import Measure as Measure
from ..mechanisms.mechanism import Mechanism as Mechanism
from ..runs.arguments.events import Event
from ..runs.arguments.methods import RowSettings
from ..runs.open.control import Every
from ..runs.states.instant import Reading as Reading
from ..systems.base import BaseSystem

class Expression(Protocol):
    """An expression of SymPy."""

    @property
    def free_symbols(self) -> Any: ...

SystemLike = Mechanism | BaseSystem
StateLike = ArrayLike | Reading
MeasureLike = Measure | str
Measures = Sequence[MeasureLike]
Display = Mapping[str, str]
EventLike = Event | Measure | str | Expression | Callable[[float, np.ndarray, np.ndarray], float]
Events = EventLike | Sequence[EventLike]
Names = MeasureLike | Measures
Points = Point | MeasureLike | Sequence[Point | MeasureLike]
Inputs = MeasureLike | Sequence[MeasureLike] | Mapping[str, tuple[float, float] | None]
LawLike = float | Expression | Callable[..., Any]
Laws = LawLike | Sequence[LawLike] | np.ndarray
UserFunction = Callable[..., Any]
TermLike = ArrayLike | UserFunction
Equations = Sequence[Expression] | Mapping[str, Expression]
Bindings = Mapping[str, MeasureLike]
Values = Mapping[str, ArrayLike] | Mapping[Measure, ArrayLike] | Mapping[MeasureLike, ArrayLike]
Motions = Mapping[str, ArrayLike | LawLike] | Mapping[Measure, ArrayLike | LawLike] | Mapping[MeasureLike, ArrayLike | LawLike]
PathLike = str | _PathLike[str]

'''
SYSTEMS = f'''"""Systems of the core's table; {WRITTEN}"""

from typing import Literal

from numpy.typing import ArrayLike

from .builtin import BuiltIn as BuiltIn

'''


def wrapped(head, parts, end):
    """Code that breaks between its parts."""
    text = ", ".join(part.replace(" ", "~") for part in parts) + end.replace(" ", "~")
    return "\n".join(textwrap.wrap(text, 130, initial_indent=head, subsequent_indent=" " * len(head))).replace("~", " ")


def literal(words):
    """A type of some words."""
    return f"Literal[{', '.join(map(repr, words))}]"


def declared_fields(parameters):
    """Keys of a dictionary of settings, of the types of these parameters."""
    return "\n".join(f"    {parameter.name}: {parameter.annotation}" for parameter in parameters)


def type_of(parameter):
    """The type of a parameter of an entry."""
    if parameter.rule == "choice":
        return literal(parameter.words)
    return methods.KINDS.get(parameter.rule, "float") if parameter.size == 1 else "ArrayLike"


def keywords(parameters, initial):
    """Keyword arguments of these parameters."""
    return [f"{parameter.name}: {type_of(parameter)}{' | None' * (initial(parameter) is None)} = {initial(parameter)!r}"
            for parameter in parameters]


def documented(obj, indent):
    return textwrap.indent(f'"""{inspect.getdoc(obj)}\n"""', indent)


def settings_class(name):
    """Declaration of a class of settings."""
    card = methods.CARDS[name]
    fields = "".join(f"    {parameter.name}: {type_of(parameter)}\n" for parameter in card.parameters)
    arguments = keywords(card.parameters, methods._initial)
    return (f"class {name}(RowSettings):\n{documented(card.settings, '    ')}\n\n{fields}"
            f"{wrapped('    def __init__(', ['self', *arguments], ') -> None: ...')}\n")


def types():
    """The text of `types.pyi`."""
    names = {"Formulation": methods.TABLES["formulations"], "Integrator": methods.TABLES["integrators"],
             "Correction": methods.TABLES["corrections"], "StabilizationName": settings.STABILIZATIONS,
             "VectorUnit": settings.VECTOR_UNITS}
    run = list(inspect.signature(settings.Arguments).parameters.values())[2:]
    own = [each for each in inspect.signature(_read).parameters.values()
           if each.kind is each.KEYWORD_ONLY and each.name not in settings.DEFAULTS]
    dictionaries = {"Settings": ("TypedDict, total=False", "Settings of steps and methods, as of `simulate`.", run),
                    "SimulateSettings": ("Settings, total=False", "Settings of `simulate`.", own),
                    "ExploreOptions": ("SimulateSettings, total=False", "Arguments of `simulate` and of `view`.", [
                        *(inspect.signature(simulate).parameters[name] for name in ("step", "t_eval", "events", "outputs")),
                        *list(inspect.signature(zd.view).parameters.values())[1:6]]),
                    "EnsembleOptions": ("Settings, total=False", "Arguments of `simulate` for the runs of an ensemble.",
                                        [inspect.signature(simulate).parameters[name] for name in ("step", "t_eval", "events")])}
    return TYPES + "\n".join([
        *(wrapped(f"{name} = Literal[", map(repr, words), "]") for name, words in names.items()), "",
        *(f'class {name}({base}):\n    """{doc}"""\n\n{declared_fields(parameters)}\n'
          for name, (base, doc, parameters) in dictionaries.items()), *map(settings_class, methods.CLASSES)])


def systems():
    """The text of `systems/__init__.pyi`."""
    def one(kind):
        arguments = keywords(builtin._KINDS[kind].parameters, lambda p: builtin._as_given(p, builtin._as_numbers(p, None)))
        return f"{wrapped(f'def {kind}(', ['*', *arguments], ') -> BuiltIn:')}\n{documented(builtin.FACTORIES[kind], '    ')}\n"

    return SYSTEMS + "\n".join(map(one, builtin.FACTORIES))


def package():
    """The text of `__init__.pyi`."""
    lines = set()
    for name in zd.__all__:
        value = getattr(zd, name)
        where, _, what = (value.__name__ if inspect.ismodule(value) else f"{value.__module__}.{name}").rpartition(".")
        where = "._private.types" if name in methods.CLASSES else where.removeprefix("zerodrift") or "."
        lines.add(f"from {where} import {what} as {name}")
    lines = sorted(lines, key=lambda line: (line.split()[1], line.split()[-1].islower(), line.split()[-1].lower()))
    return "\n".join([f'"""{inspect.getdoc(zd)}\n"""\n', f"# {WRITTEN.capitalize()}", *lines, "",
                      "__version__: str", ""])


STUBS = {PACKAGE / "_private" / "types.pyi": types, PACKAGE / "__init__.pyi": package,
         PACKAGE / "systems" / "__init__.pyi": systems, stub_of_verbs.STUB: stub_of_verbs.stub}

if __name__ == "__main__":
    for path, text in STUBS.items():
        path.write_text(text(), encoding="utf-8")
