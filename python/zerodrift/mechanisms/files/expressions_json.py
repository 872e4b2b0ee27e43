"""SymPy expressions as JSON: numbers, names of symbols, and lists of an operation and its parts, ``["*", 0.5, ["sin", "t"]]``.

They are read without evaluating text as code, and only operations of the table below.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping
from typing import Any

from ...errors import WrongValue
from ...laws.formula import Formula, operands

SIGNS = {"+": "Add", "*": "Mul", "^": "Pow", "<": "StrictLessThan", "<=": "LessThan", ">": "StrictGreaterThan",
         ">=": "GreaterThan", "=": "Equality", "!=": "Unequality", "and": "And", "or": "Or", "not": "Not", "cases": "Piecewise"}
FUNCTIONS = ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "exp",
             "log", "Abs", "sign", "Min", "Max", "floor", "ceiling", "Mod", "Heaviside")
DEEPEST = 100       # nested operations, at most, for Python's stack
LARGEST = 10**309       # largest whole number, near the largest double
MAX_WORDS = 100_000     # of a formula
MAX_BITS = 3000        # bits, at most, of powers of numbers, which SymPy evaluates exactly while reading
CONSTANTS = {"pi": "pi", "e": "Exp1", "true": "true", "false": "false"}


@functools.cache
def _operations() -> dict[str, Callable[..., Any]]:
    """Classes of SymPy by their names in files."""
    import sympy as sp

    return {sign: getattr(sp, name) for sign, name in SIGNS.items()} | {name: getattr(sp, name) for name in FUNCTIONS}


@functools.cache
def _constants() -> dict[str, Any]:
    import sympy as sp

    return {word: getattr(sp.S, name, None) if name == "Exp1" else getattr(sp, name) for word, name in CONSTANTS.items()}


def to_json(expression: Any, what: str) -> Any:
    """Expression as lists of words and numbers; errors name its owner `what`."""
    written = _written(expression, what)
    if _in_order(_written(from_json(written, what), what)) != _in_order(written):
        raise WrongValue(f"{what} is an expression that would be simplified where it is read, {expression}: it cannot be saved",
                         "not-portable")
    return written


def _in_order(written: Any) -> Any:
    """Expression with terms and factors in one order, whatever is assumed of symbols."""
    if not isinstance(written, list):
        return written
    word, *parts = [_in_order(part) for part in written]
    return [word, *(sorted(parts, key=str) if word in ("+", "*", "and", "or") else parts)]


def _written(expression: Any, what: str) -> Any:
    words = {operation: word for word, operation in _operations().items()}
    constants = {constant: word for word, constant in _constants().items()}
    if expression.is_Symbol:
        return expression.name
    if expression.is_Integer:
        return int(expression)
    if expression.is_Float and math.isfinite(float(expression)):    # a double, as in every run
        return float(expression)
    if expression.is_Rational:
        return ["/", int(expression.p), int(expression.q)]
    if expression in constants:
        return [constants[expression]]
    word = words.get(expression.func)
    if word is None:
        raise WrongValue(f"{what} is an expression with {expression.func.__name__}, and cannot be saved: there are "
                         f"{', '.join(map(str, words.values()))}", "not-portable")
    if word == "cases":
        return [word, *([_written(value, what), _written(condition, what)] for value, condition in expression.args)]
    return [word, *(_written(part, what) for part in expression.args)]


def of_formula(formula: Formula, what: str, leaves: Mapping[str, Any]) -> Any:
    """Formula of a function as lists of words and numbers."""
    written: list[Any] = []
    for code, *arguments in formula.operations:
        parts = [written[each] for each in operands((code, *arguments))]
        match code:
            case "leaf":
                made = leaves.get(arguments[0], arguments[0])
            case "number":
                made = arguments[0]
            case "-":
                made = ["+", parts[0], ["*", -1, parts[1]]]
            case "/":
                made = ["*", parts[0], ["^", parts[1], -1]]
            case "negative":
                made = ["*", -1, parts[0]]
            case "choice":
                made = ["cases", [parts[1], parts[0]], [parts[2], ["true"]]]
            case "call":
                made = _of_call(arguments[0], parts, what)
            case "spline":
                raise WrongValue(f"{what} must not read tables, to be saved", "not-portable")
            case _:
                word = arguments[0] if code in ("comparison", "logic") else code
                made = [{"power": "^", "==": "="}.get(word, word), *parts]
        written.append(made)
    result = written[formula.result]
    if _size(result) > MAX_WORDS:
        raise WrongValue(f"{what} must have at most {MAX_WORDS} operations, each written where it is used, to be saved",
                         "not-portable")
    return result


def _of_call(name: str, parts: list[Any], what: str) -> Any:
    if name == "fmod":      # x less so many times y, towards zero
        ratio = ["*", parts[0], ["^", parts[1], -1]]
        whole = ["cases", [["ceiling", ratio], ["<", ratio, 0]], [["floor", ratio], ["true"]]]
        return ["+", parts[0], ["*", -1, parts[1], whole]]
    if name == "hypot":
        return ["^", ["+", *(["^", part, 2] for part in parts)], ["/", 1, 2]]
    if name in ("log2", "log10"):
        return ["*", ["log", *parts], 1 / math.log(float(name[3:]))]
    if name == "expm1":
        return ["+", ["exp", *parts], -1]
    if name == "log1p":
        return ["log", ["+", 1, *parts]]
    if name not in (*FUNCTIONS, "Pow"):
        raise WrongValue(f"{what} must not have the function {name}, to be saved", "not-portable")
    return ["^" if name == "Pow" else name, *parts]


def _size(written: Any) -> int:
    """Number of words of an expression whose parts may be shared."""
    sizes: dict[int, int] = {}

    def of(part: Any) -> int:
        if not isinstance(part, list):
            return 1
        if id(part) not in sizes:
            sizes[id(part)] = sum(map(of, part))
        return sizes[id(part)]

    return of(written)


def from_json(written: Any, what: str, depth: int = 0) -> Any:
    """Expression from lists of words and numbers; errors name its owner `what` and the wrong part."""
    import sympy as sp

    if depth > DEEPEST:
        raise WrongValue(f"{what} must have at most {DEEPEST} operations within operations", "unreadable-file")
    if isinstance(written, bool) or written is None or isinstance(written, dict):
        raise WrongValue(f"{what} has {written!r}, which is not part of an expression", "unreadable-file")
    if isinstance(written, str):
        return sp.Symbol(written)
    if not isinstance(written, list):
        return _integer(written, what) if isinstance(written, int) else sp.Float(written)
    word, *parts = written or [None]
    word = word if isinstance(word, str) else str(word)
    if word in CONSTANTS and not parts:
        return _constants()[word]
    if word == "/" and len(parts) == 2 and all(type(part) is int for part in parts) and parts[1]:
        return sp.Rational(*parts)
    if word not in _operations():
        raise WrongValue(f"{what} has the operation {word!r}; there are {', '.join([*_operations(), *CONSTANTS, '/'])}",
                         "unreadable-file")
    if word == "cases" and all(isinstance(part, list) and len(part) == 2 for part in parts):
        read = [tuple(from_json(each, what, depth + 1) for each in part) for part in parts]
    else:
        read = [from_json(part, what, depth + 1) for part in parts]
    if word == "^" and len(read) == 2:
        _check_power(read[0], read[1], what)
    try:
        return _operations()[word](*read)
    except Exception as error:      # classes of SymPy raise different errors
        raise WrongValue(f"{what} has the operation {word!r} of {', '.join(map(str, read))}, which cannot be: {error}",
                         "unreadable-file") from None


def _integer(written: int, what: str) -> Any:
    import sympy as sp

    if abs(written) > LARGEST:
        raise WrongValue(f"{what} must have whole numbers of at most 1e309, not one of {written.bit_length()} bits",
                         "unreadable-file")
    return sp.Integer(written)


def _check_power(base: Any, exponent: Any, what: str) -> None:
    """Check that a power of numbers does not fill the memory."""
    if not (base.is_Rational and exponent.is_Rational):
        return
    bits = max(int(base.p).bit_length(), int(base.q).bit_length())
    if abs(exponent) > LARGEST or (bits > 1 and bits * abs(float(exponent)) > MAX_BITS):
        raise WrongValue(f"{what} must not have the power {base}^{exponent}, whose digits would fill the memory",
                         "unreadable-file")
