"""Elements whose public attributes do not change, as systems and solutions share them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...errors import WrongAttribute


class Fixed:
    """Base of elements: a public attribute is set once, when the element is made, and its arrays are read-only.

    Raises
    ------
    AttributeError
        When it is set again; the message names what makes a system with another value.
    """

    name: Any

    @property
    def measured_name(self) -> str:
        """First part of the names of its measures."""
        return self.name

    @property
    def laws(self) -> Mapping[str, Any]:
        """User functions by the argument that takes each."""
        law = getattr(self, "law", None)
        return {} if law is None else {getattr(self, "drives", "law"): law}

    @property
    def constants(self) -> dict[str, float]:
        """User functions that are plain numbers, likewise."""
        return {path: law.constant for path, law in self.laws.items() if law.constant is not None}

    @property
    def refers_to(self) -> set[str]:
        """Names of the elements that it is made of, or whose measures it reads."""
        found = {name.partition(".")[0] for law in self.laws.values() for name in getattr(law, "reads", ())}
        found |= {each.partition(".")[0] for each in getattr(self, "of", ())}
        for value in vars(self).values():
            for each in value if isinstance(value, tuple | list) else (value,):
                if isinstance(each, Fixed):
                    found |= {each.name, getattr(getattr(each, "body", None), "name", None)} - {None}
        return found - {self.name}

    def __setattr__(self, name: str, value: Any) -> None:
        if name[0] != "_":
            if name in self.__dict__:
                element = self.__dict__.get("name", "")
                raise WrongAttribute(
                    f"{name} of {element!r} must not change, as systems and solutions share their elements: "
                    f"m.with_parameters({{'{element}.{name}': value}}) makes a system with another value")
            if isinstance(value, np.ndarray):
                value = value.copy()
                value.flags.writeable = False
        object.__setattr__(self, name, value)


def amend(element: Fixed, **values: Any) -> None:
    """Set attributes of an element that does not belong to a system yet, for example while reading a file."""
    for name, value in values.items():
        element.__dict__.pop(name, None)
        setattr(element, name, value)
