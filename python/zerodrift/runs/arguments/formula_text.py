"""Expressions of measures as text, such as "wheel.angle - 0.3": names, numbers, + - * / and brackets."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from ..._private import checks
from ...errors import WrongValue

NUMBER = re.compile(r"(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


class Parser:
    """Parser of one text; at each place the longest known name is taken, as names have blanks, dots and hyphens."""

    def __init__(self, what: str, text: str, names: Iterable[str]) -> None:
        import sympy  # slow to import

        self.what, self.text, self.place = what, text, 0
        self.names = sorted(names, key=len, reverse=True)
        self.symbol, self.number = sympy.Symbol, sympy.Float

    def expression(self) -> Any:
        """SymPy expression of the whole text, with a symbol for each measure."""
        found = self._sum()
        if self._rest():
            self._fail("an operator")
        return found

    def _rest(self) -> str:
        rest = self.text[self.place:].lstrip()
        self.place = len(self.text) - len(rest)
        return rest

    def _take(self, operators: str) -> str:
        """The operator at the present place, if it is one of these; otherwise empty."""
        rest = self._rest()
        if rest and rest[0] in operators:
            self.place += 1
            return rest[0]
        return ""

    def _sum(self) -> Any:
        found = self._product()
        while operator := self._take("+-"):
            other = self._product()
            found = found + other if operator == "+" else found - other
        return found

    def _product(self) -> Any:
        found = self._factor()
        while operator := self._take("*/"):
            other = self._factor()
            found = found * other if operator == "*" else found / other
        return found

    def _factor(self) -> Any:
        if sign := self._take("+-"):
            return self._factor() if sign == "+" else -self._factor()
        if self._take("("):
            found = self._sum()
            if not self._take(")"):
                self._fail("a closing bracket")
            return found
        rest = self._rest()
        if name := next((name for name in self.names if rest.startswith(name)), None):
            self.place += len(name)
            return self.symbol(name)
        if number := NUMBER.match(rest):
            self.place += number.end()
            return self.number(float(number.group()))
        return self._fail("a measure or a number")

    def _fail(self, wanted: str) -> Any:
        rest = self._rest()
        known = checks.closest(rest.split(" ")[0] or "?", self.names) if "measure" in wanted and rest else ""
        raise WrongValue(f"{self.what} must have {wanted} at {rest or 'its end'!r} of {self.text!r}{'; ' * bool(known)}{known}",
                         "expression")
