"""Sines and cosines of sums of angles from those of their parts.

Where a mechanism's terms have sin a, cos a, sin b and cos b, those of a + b and a - b take two products and a sum each,

    sin(a + b) = sin a cos b + cos a sin b,    cos(a + b) = cos a cos b - sin a sin b,

a fraction of what a sine takes. Sines are therefore computed of as few angles as possible, the simplest ones, and all others
follow. Each added angle causes an error of some parts in 1e16 of sin a and sin b, as the rounding of a and b does: near
cancellation, the lost digits are those that the angles as numbers do not have.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

Form = tuple[tuple[int, float], ...]    # an angle as a sum of whole multiples: (operation, how many of it), sorted
Operations = list[list[Any]]            # (code, arguments ...), as `direct.as_json` keeps them
MAX_PARTS = 8      # of a sum: what has more is one angle


class Sum(NamedTuple):
    """An angle that is sign_a a + sign_b b, both of them operations that are angles, too; or sign_a a, where b is none."""

    sign_a: int
    a: int
    sign_b: int
    b: int | None


def sums(operations: Operations, needed: Iterable[int]) -> dict[int, Sum]:
    """Angles that are sums of other angles, in an order in which their sines and cosines can be computed."""
    forms = _Forms(operations)
    waiting = sorted({operations[number][2] for number in needed if is_turn(operations[number])}, key=forms.simplicity)
    known: dict[Form, int] = {}
    found: dict[int, Sum] = {}
    while waiting:
        fresh = [waiting.pop(0)]
        while fresh:
            angle = fresh.pop(0)
            known.setdefault(forms.of(angle), angle)
            made = {each: way for each in waiting if (way := _way(forms.of(each), angle, forms.of(angle), known)) is not None}
            found |= made
            fresh += made
            waiting = [each for each in waiting if each not in made]
    return found


def is_turn(operation: list[Any]) -> bool:
    """True if the operation is a sine or a cosine."""
    return operation[0] == "call" and operation[1] in ("sin", "cos")


def _way(form: Form, angle: int, with_form: Form, known: dict[Form, int]) -> Sum | None:
    """The angle of this form as a sum of a given angle and at most one other known angle; None if there is no such sum."""
    for sign in (1, -1):
        rest = _added(form, _times(-sign, with_form))
        if not rest:
            return Sum(sign, angle, 1, None)
        for sign_b in (1, -1):
            if (b := known.get(_times(sign_b, rest))) is not None:
                return Sum(sign, angle, sign_b, b)
    return None


def _times(factor: float, form: Form) -> Form:
    return tuple((atom, factor * count) for atom, count in form)


def _added(*forms: Form) -> Form:
    total: dict[int, float] = {}
    for form in forms:
        for atom, count in form:
            total[atom] = total.get(atom, 0) + count
    return tuple(sorted((atom, count) for atom, count in total.items() if count))


class _Forms:
    """Operations as sums of integer multiples of operations that are not sums."""

    def __init__(self, operations: Operations) -> None:
        self._operations = operations
        self._forms: dict[int, Form] = {}

    def simplicity(self, angle: int) -> tuple[float, int]:
        """Sort key of angles, simplest first; angles of parameters alone are simplest, as their sines are constants."""
        size = sum(abs(count) for _, count in self.of(angle))
        return 0 if self._is_fixed(angle) else size, angle

    def _is_fixed(self, number: int) -> bool:
        return all(self._operations[atom][:2] == ["leaf", "parameter"] or self._operations[atom][0] == "number"
                   for atom, _ in self.of(number))

    def of(self, number: int) -> Form:
        """The form of an operation."""
        if number not in self._forms:
            form = self._sum(*self._operations[number])
            self._forms[number] = ((number, 1),) if form is None or len(form) > MAX_PARTS else form
        return self._forms[number]

    def _sum(self, code: str, *arguments: Any) -> Form | None:
        match code:
            case "+":
                return _added(*map(self.of, arguments))
            case "-":
                return _added(self.of(arguments[0]), _times(-1, self.of(arguments[1])))
            case "negative":
                return _times(-1, self.of(arguments[0]))
            case "*":
                for one, other in (arguments, arguments[::-1]):
                    kind, *value = self._operations[one]
                    if kind == "number" and value[0] and value[0] == int(value[0]):
                        return _times(int(value[0]), self.of(other))
        return None
