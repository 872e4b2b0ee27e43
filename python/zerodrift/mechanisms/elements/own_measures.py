"""Measures of one's own, as defined."""

from __future__ import annotations

from .immutable import Fixed
from .user_functions import Law


class OwnMeasure(Fixed):
    """A function of time and measures that acts on nothing, `Mechanism.measure`.

    Attributes
    ----------
    name : str
    law : Law
    unit : str
    """

    kind = "measure"

    def __init__(self, name: str, law: Law, unit: str) -> None:
        self.name, self.law, self.unit = name, law, unit

    def __repr__(self) -> str:
        return f"<measure {self.name}>"
