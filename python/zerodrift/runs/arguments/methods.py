"""Formulations, integrators and corrections of the core: a card for each, and a class of its settings.

All of it is read from the core's tables: a method that is added there appears here, with parameters, checks and documentation.
"""

from __future__ import annotations

import dataclasses
import functools
import textwrap
from typing import Any, ClassVar

from ..._private import checks, gateway
from ..._private.types import Correction, Formulation, Integrator, SystemLike
from ...errors import WrongValue
from ...systems.base import BaseSystem, core_of, system_of

WIDTH = 100     # characters of a printed line

# Exceptions to the rule: arguments of `simulate` that select a correction, and names of classes of settings.
ARGUMENTS = {"projection": "stabilization", "baumgarte": "stabilization", "energy": "energy"}
CLASS_NAMES = {"energy": "EnergyCorrection"}
KINDS = {"any": "float", "positive": "float", "not negative": "float", "count": "int", "switch": "bool"}


class RowSettings:
    """Parameters of a method, checked. Settings are equal if method and parameters are."""

    __slots__ = ()
    card: ClassVar[Row]
    table: ClassVar[str]
    __dataclass_fields__: ClassVar[dict[str, dataclasses.Field[Any]]]       # of the classes of methods

    def __post_init__(self) -> None:
        for parameter in self.card.parameters:      # as Python's own numbers, so that equal settings are saved alike
            object.__setattr__(self, parameter.name, _checked(parameter, getattr(self, parameter.name)))
        if clash := gateway.clash(self.table, self.card.name, self._values()):
            raise WrongValue(clash, "conflicting-arguments")

    def _values(self) -> list[float]:
        """Parameters as a flat list of numbers for the core."""
        return [number for parameter in self.card.parameters for number in _numbers(parameter, getattr(self, parameter.name))]


def _checked(parameter: gateway.Parameter, value: Any) -> Any:
    """Check a value by the rule of its parameter."""
    name = parameter.name
    match parameter.rule:
        case "choice":
            return checks.choice(name, value, parameter.words)
        case "count":
            return checks.count(name, value)
        case "switch":
            return checks.instance(name, value, bool, "True or False")
    above, least = (0 if parameter.rule == rule else None for rule in ("positive", "not negative"))
    if parameter.size == 1:
        return checks.number(name, value, above=above, least=least)
    values = checks.vector(name, value, parameter.size)
    return tuple(checks.number(f"{name}[{i}]", each, above=above, least=least) for i, each in enumerate(values))


def _numbers(parameter: gateway.Parameter, value: Any) -> tuple[float, ...]:
    if parameter.rule == "choice":
        return (float(parameter.words.index(value)),)
    return tuple(map(float, value)) if parameter.size > 1 else (float(value),)


def _initial(parameter: gateway.Parameter) -> Any:
    """Default value of a parameter, as a user would write it."""
    assert parameter.initial      # as no parameter of a method is derived from others
    first = parameter.initial[0]
    match parameter.rule:
        case "choice":
            return parameter.words[int(first)]
        case "count":
            return int(first)
        case "switch":
            return bool(first)
    return first if parameter.size == 1 else parameter.initial


class Row(gateway.Card):
    """A formulation, integrator or correction; it prints as a page.

    Attributes
    ----------
    name, summary, equations : str
        `equations` are those of the paper, or where it comes from.
    description, reference : str
        Purpose and recommended use; the literature.
    order, error_order : int
        Order of an integrator and of its error estimate; 0: it has none.
    stability : float
        Largest omega h of fixed steps without a `StabilityWarning`; 0: any. A motion with little damping may grow before.
    parameters : tuple of Parameter
        Parameters that may be set.
    settings : type
        Class of its settings, an argument of `simulate`.
    """

    __slots__ = ()

    @property
    def settings(self) -> type[Any]:
        return _class_of(self)

    def __repr__(self) -> str:
        lines = [f"{self.name}: {self.summary}", "", *_paragraph(self.description)]
        for parameter in self.parameters:
            lines += [f"  {_kind(parameter)}, initially {_initial(parameter)!r}", *_paragraph(parameter.text, "      ")]
        numbers = {"order": self.order, "order of the error estimate": self.error_order, "stable up to omega h": self.stability}
        lines += [f"  {name}: {number:g}" for name, number in numbers.items() if number]
        return "\n".join([*lines, "", *_paragraph(_source(self))]).rstrip()


def _source(card: gateway.Card) -> str:
    return f"Source: {card.equations}" + (f"; {card.reference}." if card.reference else ".")


def _paragraph(text: str, indent: str = "  ") -> list[str]:
    lines = textwrap.wrap(text, WIDTH, initial_indent=indent, subsequent_indent=indent, break_on_hyphens=False)
    return [*lines, ""] if text else []


def _kind(parameter: gateway.Parameter) -> str:
    """Name of a parameter, its type, shape, unit and range."""
    if parameter.rule == "choice":
        return f"{parameter.name} : {{{', '.join(map(repr, parameter.words))}}}"
    shape = "" if parameter.size == 1 else f" ({parameter.size},)"
    unit = f" in {parameter.unit}" if parameter.unit else ""
    rule = f", {parameter.rule}" if parameter.rule in ("positive", "not negative") else ""
    return f"{parameter.name} : {KINDS[parameter.rule]}{shape}{unit}{rule}"


class CardTable(dict[Any, Row]):
    """Cards of a table of the core by name; it prints as a table."""

    def __repr__(self) -> str:
        width = max(map(len, self), default=0)
        return "\n".join(f"{card.name:{width}}  {card.equations:24}  {card.summary}" for card in self.values())


TABLES = {table: CardTable({card.name: Row(*card) for card in gateway.cards(table)})
          for table in ("formulations", "integrators", "corrections")}


def _documentation(table: str, card: Row, name: str) -> str:
    lines = [card.summary, "", *_paragraph(card.description, "")]
    if card.parameters:
        lines += ["Parameters", "----------"]
        for parameter in card.parameters:
            lines += [_kind(parameter), *_paragraph(parameter.text, "    ")[:-1]]
    lines += ["", "Notes", "-----", *_paragraph(_source(card), "")]
    argument = ARGUMENTS.get(card.name, "correction") if table == "corrections" else table.removesuffix("s")
    known = name if name in CLASSES else f'{table}()["{card.name}"].settings'
    return "\n".join([*lines, "Examples", "--------", ">>> import zerodrift as zd",
                      f">>> sol = zd.simulate(zd.systems.four_bar(), 8.0, step=0.01, {argument}=zd.{known}())"])


def _class_name(card: Row) -> str:
    return CLASS_NAMES.get(card.name, "".join(word.capitalize() for word in card.name.split("_")))


@functools.cache        # made at first use: making all takes a quarter of the import time
def _class_of(card: Row) -> type[RowSettings]:
    """Class of the settings of a method: a frozen dataclass whose fields are its parameters."""
    name, table = _class_name(card), next(table for table, cards in TABLES.items() if cards.get(card.name) == card)
    fields = [(parameter.name, "str" if parameter.rule == "choice" else KINDS[parameter.rule], _initial(parameter))
              for parameter in card.parameters]
    words = {f"{parameter.name.upper()}S": parameter.words for parameter in card.parameters if parameter.rule == "choice"}
    return dataclasses.make_dataclass(name, fields, bases=(RowSettings,), frozen=True, slots=True, namespace={
        "__doc__": _documentation(table, card, name), "card": card, "table": table, "__module__": __name__,
        "__reduce__": _reduced, **words})       # the class may not be an attribute of a module


def _reduced(settings: RowSettings) -> tuple[Any, ...]:
    values = (getattr(settings, field.name) for field in dataclasses.fields(settings))
    return _again, (settings.table, settings.card.name, *values)


def _again(table: str, name: str, *values: Any) -> RowSettings:
    """Recreate settings from a pickle or a copy."""
    return TABLES[table][name].settings(*values)


CARDS = {_class_name(card): card for cards in TABLES.values() for card in cards.values()}       # by the names of their classes
CLASSES = ("Projection", "Baumgarte", "EnergyCorrection")       # of this module, and of the package


def _class_named(name: str) -> Any:
    if name in CLASSES:
        return CARDS[name].settings
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


__getattr__ = _class_named


def formulations(system: SystemLike | None = None) -> dict[Formulation, Row]:
    """Formulations by name: all of them, or those that suit a system.

    Examples
    --------
    >>> import zerodrift as zd
    >>> zd.formulations()["schur"].equations
    '(13), (27)'
    >>> "independent" in zd.formulations(zd.systems.four_bar())
    True
    """
    table = TABLES["formulations"]
    if system is None:
        return CardTable(table)
    core = core_of(system_of(system))
    return CardTable({name: card for row, (name, card) in enumerate(table.items()) if core.suits_formulation(row)})


def integrators(system: SystemLike | None = None) -> dict[Integrator, Row]:
    """Integrators by name: all of them, or those that suit a system.

    `order` is the order of the method; `stability` is the largest product omega h of angular frequency and step without
    a `StabilityWarning`, 0 if there is no such limit.

    Examples
    --------
    >>> import zerodrift as zd
    >>> zd.integrators()["rk4"].order
    4
    >>> "rattle" in zd.integrators(zd.systems.knife_edge())
    False
    """
    table = TABLES["integrators"]
    if system is None:
        return CardTable(table)
    made = system_of(system)
    core = core_of(made)
    return CardTable({name: card for row, (name, card) in enumerate(table.items())
                      if core.suits(row) or (gateway.row_takes_series(row) and made._brings_series)})


def evaluating_integrators(system: BaseSystem) -> dict[Integrator, Row]:
    """Integrators that suit a system and need only its terms, no Taylor coefficients."""
    return CardTable({name: card for row, (name, card) in enumerate(TABLES["integrators"].items())
                      if core_of(system).suits(row) and not gateway.row_takes_series(row)})


def corrections() -> dict[Correction, Row]:
    """Corrections by name, in the order in which they are applied.

    Examples
    --------
    >>> import zerodrift as zd
    >>> zd.corrections()["projection"].settings is zd.Projection
    True
    >>> zd.corrections()["baumgarte"].settings(alpha=20.0, beta=100.0)
    Baumgarte(alpha=20.0, beta=100.0, integral=0.0)
    """
    return CardTable(TABLES["corrections"])


def name_of(table: str, value: Any) -> Any:
    """Name of a method that an argument selects by its name or by its settings."""
    if isinstance(value, RowSettings) and value.table == table:
        return value.card.name
    return checks.choice(table.removesuffix("s"), value, TABLES[table])


NUMBERS = {table: {name: number for number, name in enumerate(cards)} for table, cards in TABLES.items()}


def row_of(table: str, value: Any) -> int:
    """Index of that method in the core's table."""
    return NUMBERS[table][name_of(table, value)]
