"""Expressions without narrow features: polynomials, sines and cosines.

Values and derivatives of other functions, such as an exponential or a quotient, at some points do not bound those between them.
"""

from __future__ import annotations

from typing import Any

TURNS = ("sin", "cos")
SUMS = ("leaf", "number", "+", "-", "*", "negative")


def is_plain_program(program: dict[str, Any] | str) -> bool:
    """True if all operations on the state and on time are polynomials, sines and cosines; False if the program was not stored."""
    if isinstance(program, str):
        return False
    varies: list[bool] = []
    for code, *arguments in program["operations"]:
        operands = [] if code in ("leaf", "number") else arguments[1:] if code in ("call", "comparison", "logic") else arguments
        varies.append((code == "leaf" and arguments[0] != "parameter") or any(varies[number] for number in operands))
        if varies[-1] and not _is_plain(code, arguments, operands, varies, program["operations"]):
            return False
    return True


def _is_plain(code: str, arguments: list[Any], operands: list[int], varies: list[bool], operations: list[Any]) -> bool:
    if code in SUMS:
        return True
    if code == "/":
        return not varies[operands[1]]
    if code == "power" or (code == "call" and arguments[0] == "Pow"):
        kind, *value = operations[operands[1]]
        return kind == "number" and value[0] >= 0 and float(value[0]).is_integer()
    return code == "call" and arguments[0] in TURNS
