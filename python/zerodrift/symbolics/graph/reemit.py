"""Operations of a stored program emitted again: only the needed ones, with as few sines as possible."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from . import angles
from .arithmetic import Arithmetic
from .lowering import Lowering, Operation

Key = int | tuple[str, int]     # an operation of the program, or ("sin" or "cos", operation of an angle)


def restored(lowering: Lowering, operations: angles.Operations, outputs: dict[str, list[int]],
             function_of: Callable[[str], Any]) -> dict[str, list[int]]:
    """The outputs as operations of `lowering`; functions are found by their names."""
    needed = _needed(operations, [number for numbers in outputs.values() for number in numbers])
    emission = _Emission(lowering, operations, angles.sums(operations, needed), function_of)
    return {name: [emission.of(number) for number in numbers] for name, numbers in outputs.items()}


def _needed(operations: angles.Operations, outputs: list[int]) -> list[int]:
    """Operations that the given ones depend on, in order."""
    found, waiting = set(outputs), list(outputs)
    while waiting:
        more = [number for number in _operands(operations[waiting.pop()]) if number not in found]
        found.update(more)
        waiting += more
    return sorted(found)


def _operands(operation: list[Any]) -> tuple[int, ...]:
    code, *arguments = operation
    return Lowering.operands(Operation(code, tuple(arguments), 0))


class _Emission:
    """Emission of operations on demand, operands first."""

    def __init__(self, lowering: Lowering, operations: angles.Operations, sums: dict[int, angles.Sum],
                 function_of: Callable[[str], Any]) -> None:
        self._do, self._operations, self._sums, self._function_of = Arithmetic(lowering), operations, sums, function_of
        self._emitted: dict[Key, int] = {}

    def of(self, wanted: int) -> int:
        """Number of the new operation for one of the program; its operands are emitted first."""
        waiting: list[Key] = [wanted]
        while waiting:
            more = [key for key in self._behind(waiting[-1]) if key not in self._emitted]
            if not more:
                key = waiting.pop()
                self._emitted[key] = self._turned(*key) if isinstance(key, tuple) else self._emit(key)
            waiting += reversed(more)
        return self._emitted[wanted]

    def _behind(self, key: Key) -> list[Key]:
        if isinstance(key, tuple):
            way = self._sums.get(key[1])
            return [key[1]] if way is None else [(name, part) for part in (way.a, way.b) if part is not None
                                                 for name in ("sin", "cos")]
        operation = self._operations[key]
        return [(operation[1], operation[2])] if angles.is_turn(operation) else list(_operands(operation))

    def _emit(self, number: int) -> int:
        code, *arguments = operation = self._operations[number]
        if angles.is_turn(operation):
            return self._emitted[arguments[0], arguments[1]]
        numbers = [self._emitted[operand] for operand in _operands(operation)]
        kept = arguments[:len(arguments) - len(numbers)]
        return self._do.lowering.emit(code, *(map(self._function_of, kept) if code == "call" else kept), *numbers)

    def _turned(self, name: str, angle: int) -> int:
        """The sine or cosine of an angle."""
        way, do = self._sums.get(angle), self._do
        if way is None:
            return do.lowering.emit("call", self._function_of(name), self._emitted[angle])
        sine, cosine = self._turn_of(way.sign_a, way.a)
        if way.b is not None:
            sine_b, cosine_b = self._turn_of(way.sign_b, way.b)
            sine, cosine = (do.plus(do.times(sine, cosine_b), do.times(cosine, sine_b)),
                            do.difference(do.times(cosine, cosine_b), do.times(sine, sine_b)))
        return sine if name == "sin" else cosine

    def _turn_of(self, sign: int, angle: int) -> tuple[int, int]:
        """Sine and cosine of plus or minus an angle."""
        sine, cosine = self._emitted["sin", angle], self._emitted["cos", angle]
        return sine if sign > 0 else self._do.minus(sine), cosine
