"""Arguments are checked at the door: each error names the argument, its value and what is allowed."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterable, Mapping, Sequence
from numbers import Integral, Real
from types import UnionType
from typing import Any

import numpy as np

from ..errors import WrongType, WrongValue

MAX_LISTED = 12     # largest number of allowed words that an error lists in full


def shown(value: Any) -> str:
    """A value in a message: in one line, and not all of what is long."""
    text = " ".join(repr(value).split())
    return text if len(text) <= 80 else f"{text[:60]} ... ({type(value).__name__})"


def instance(name: str, value: Any, kinds: type | UnionType | tuple[type, ...], allowed: str) -> Any:
    """An object of one of these kinds."""
    if not isinstance(value, kinds):
        raise WrongType(f"{name} must be {allowed}, not {shown(value)}")
    return value


def number(name: str, value: Any, *, above: float | None = None, least: float | None = None, code: str = "") -> float:
    """A finite real number, more than `above` or at least `least`; `code` is that of its errors, if it is not the usual one."""
    if type(value) is not float:        # as most are: the questions take longer than all else here
        if isinstance(value, bool | np.bool_) or not isinstance(value, Real):
            raise WrongType(f"{name} must be a real number, not {value!r}")
        value = _double(value)
    if not math.isfinite(value):
        raise WrongValue(f"{name} must be finite, not {value}", code or "not-finite")
    if above is not None and not value > above:
        raise WrongValue(f"{name} must be greater than {above:g}, not {value:g}", code or "out-of-range")
    if least is not None and not value >= least:
        raise WrongValue(f"{name} must be at least {least:g}, not {value:g}", code or "out-of-range")
    return value


def restitution(name: str, value: Any) -> float:
    """A coefficient of restitution, 0 to 1."""
    value = number(name, value, least=0)
    if value > 1:
        raise WrongValue(f"{name} must be at most 1, not {value:g}", "out-of-range")
    return value


def friction(name: str, value: Any) -> tuple[float, float]:
    """Static and sliding friction, from one number for both or a pair."""
    pair = (value, value) if np.ndim(value) == 0 else value
    if len(pair) != 2:
        raise WrongValue(f"{name} must be a number, or those of static and of sliding friction, not {value!r}", "shape")
    static, sliding = (number(name, each, least=0) for each in pair)
    if sliding > static:
        raise WrongValue(f"sliding {name} must be at most the static one, and {sliding:g} is more than {static:g}",
                         "out-of-range")
    return static, sliding


def varies(given: Any) -> bool:
    """True of functions, expressions, formulas and tables, and of arrays that have one."""
    return any(callable(each) or hasattr(each, "free_symbols") or hasattr(each, "operations")
               for each in np.ravel(np.array(given, dtype=object)))


def constant(name: str, given: Any, hint: str) -> None:
    """Refuse functions, expressions and tables in the place of numbers, with a hint."""
    if varies(given):
        raise WrongType(f"{name} must be a number, not a function: {hint}")


def _double(value: Real) -> float:
    try:
        return float(value)
    except OverflowError:       # whole numbers may be larger than doubles
        return math.inf


def count(name: str, value: Any, *, least: int = 1) -> int:
    """A whole number, at least `least`."""
    if type(value) is not int and (isinstance(value, bool | np.bool_) or not isinstance(value, Integral)):
        raise WrongType(f"{name} must be a whole number, not {value!r}")
    whole = int(value)
    if not least <= whole < 2**31:
        raise WrongValue(f"{name} must be between {least} and {2**31 - 1}, not {whole}", "out-of-range")
    return whole


def choice(name: str, value: Any, allowed: Iterable[str]) -> str:
    """Check that a value is one of the allowed words."""
    words = allowed if isinstance(allowed, tuple | dict) else list(allowed)
    if isinstance(value, str) and value in words:
        return value
    if len(words) > MAX_LISTED:
        raise WrongValue(f"{name} must be a known name, not {value!r}; {closest(value, words)}", "unknown-choice")
    raise WrongValue(f"{name} must be one of {', '.join(map(repr, words))}, not {value!r}", "unknown-choice")


def counted(number: int, noun: str) -> str:
    """Number with its noun, in the plural unless it is one."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def closest(name: Any, known: Iterable[str], most: int = 5) -> str:
    """Hint for an unknown name, as the end of an error: all known names if they are few, else the most similar ones."""
    known = list(dict.fromkeys(known))
    if len(known) <= 2 * most:
        return f"there are {', '.join(known)}"
    import difflib  # rarely needed, and slow to import

    close = difflib.get_close_matches(str(name).lower(), {each.lower() for each in known}, n=most, cutoff=0.5)
    found = [each for lower in close for each in known if each.lower() == lower]
    if not found:
        return f"there are {', '.join(known[:most])} and {len(known) - most} more"
    return f"the closest of {len(known)} names {'is' if len(found) == 1 else 'are'} {', '.join(found)}"


def names(name: str, value: Any, prefix: str, *, least: int = 1) -> list[str]:
    """List of different names, given as a sequence, in one string, or as a count of names prefix0, prefix1, ..."""
    if isinstance(value, str):
        value = value.replace(",", " ").split()
    if not isinstance(value, Sequence):
        return [f"{prefix}{i}" for i in range(count(name, value, least=least))]
    words = list(value)
    if len(words) < least or not all(isinstance(word, str) and word for word in words) or len(set(words)) != len(words):
        raise WrongValue(f"{name} must be a number or different names, not {words!r}", "duplicate-name")
    return words


DOUBLE = np.dtype(np.float64)
EXACT = 2.0**53     # below, whole numbers are doubles
FEW = 64        # up to this many numbers, Python checks faster than NumPy that all are finite


def _is_plain(value: Any) -> bool:
    """True for an array of doubles, the usual argument, which needs few further checks."""
    return type(value) is np.ndarray and value.dtype is DOUBLE


def vector(name: str, value: Any, size: int) -> np.ndarray:
    """A fresh, contiguous float64 array of shape (size,), all finite."""
    if _is_plain(value) and value.shape == (size,) and size <= FEW and all(map(math.isfinite, value.tolist())):
        return value.copy()
    if type(value) is tuple and len(value) == size and all(type(each) in (float, int) and abs(each) < EXACT for each in value):
        return np.array(value, dtype=np.float64)
    shape = f"{name} must have shape ({size},), not"
    array = real(f"{name} must hold", value, ragged=f"{shape} be")
    if array.shape != (size,):
        raise WrongValue(f"{shape} {array.shape}", "shape")
    return _finite(name, array)


def times(name: str, value: Any, first: float, last: float) -> np.ndarray:
    """A fresh float64 array of any shape, of times between the first and the last."""
    array = _finite(name, real(f"{name} must hold", value, ragged=f"{name} must be a regular array of times, not be"))
    outside = (array < first) | (array > last)
    if outside.any():
        raise WrongValue(f"{name} must be between {first:g} and {last:g}, not {_at(array, outside)}", "out-of-range")
    return array


def increasing(name: str, value: Any, first: float, last: float) -> np.ndarray:
    """A fresh float64 array (k,) of times that increase, between the first and the last."""
    if _is_plain(value) and value.ndim == 1 and value.size and first <= value[0] and value[-1] <= last and (
            np.logical_and.reduce(value[1:] > value[:-1])):
        return value.copy()
    array = times(name, value, first, last)
    if array.ndim != 1:
        raise WrongValue(f"{name} must have shape (k,), not {array.shape}", "shape")
    if not array.size:
        raise WrongValue(f"{name} must increase, and have at least one time", "not-increasing")
    falls = np.diff(array, prepend=-np.inf) <= 0
    if falls.any():
        raise WrongValue(f"{name} must increase, but {_at(array, falls)} comes after {float(array[falls.argmax() - 1])}",
                         "not-increasing")
    return array


def _finite(name: str, array: np.ndarray) -> np.ndarray:
    array = np.array(array, dtype=np.float64, order="C")
    infinite = ~np.isfinite(array)
    if infinite.any():
        raise WrongValue(f"{name} must be finite, not {_at(array, infinite)}", "not-finite")
    return array


def _at(array: np.ndarray, where: np.ndarray) -> str:
    """The first of an array's entries that is meant, and where it is."""
    place = np.argwhere(where)[0]
    value = str(float(array[tuple(place)]))
    return f"{value} (entry {', '.join(map(str, place))})" if array.size > 1 else value


def real(must: str, value: Any, where: str = "", *, objects: bool = False, ragged: str = "") -> np.ndarray:
    """An array of real numbers; of objects that are such, as fractions are, if allowed.

    `must` says whose it is and begins the error, "p0 must hold", and `where` ends it; `ragged` begins that of no array at all.
    """
    if is_masked(value):
        raise WrongValue(f"{must} real numbers, none of them masked, not {shown(value)}{where}", "not-finite")
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise WrongValue(f"{ragged or f'{must} an array of real numbers, not'} a ragged sequence{where}", "shape") from error
    if array.dtype.kind == "O" and objects:
        return _as_floats(array, must, value, where)
    if array.dtype.kind not in "fiu":
        raise WrongType(f"{must} real numbers, not {array.dtype}: {shown(value)}{where}")
    return array


def is_masked(value: Any) -> bool:
    """True if a value has masked entries, which conversion to a plain array would unmask."""
    if isinstance(value, np.ma.MaskedArray):
        return bool(np.ma.is_masked(value))
    return isinstance(value, list | tuple) and any(map(is_masked, value))


def _as_floats(array: np.ndarray, must: str, value: Any, where: str) -> np.ndarray:
    numbers = np.empty(array.shape)
    for place, entry in np.ndenumerate(array):
        if isinstance(entry, str | bytes | bool | np.bool_):
            raise WrongType(f"{must} real numbers, not {entry!r}{where}")
        try:
            numbers[place] = float(entry)
        except (TypeError, ValueError) as error:
            raise WrongType(f"{must} real numbers, not {shown(value)}{where}") from error
        except OverflowError:       # whole numbers may be larger than doubles
            numbers[place] = np.inf
    return numbers


def frozen(array: np.ndarray) -> np.ndarray:
    """Immutable copy: its memory is a bytes object, so that it cannot be made writable."""
    return np.ndarray(array.shape, array.dtype, array.tobytes())


STATE = ("t", "p", "v")     # the names by which functions get time, coordinates and velocities


def parameters(given: Any) -> dict[str, Any]:
    """The argument `parameters`: a fresh dict, by names that do not stand for something else."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise WrongType(f"parameters must be a dict of values by name, not {given!r}")
    for name in given:
        if not isinstance(name, str):
            raise WrongType(f"parameters must have strings for names, not {name!r}")
        if name in STATE:
            raise WrongValue(f"parameters cannot have {name!r}: {', '.join(STATE)} are time, coordinates and velocities",
                             "duplicate-name")
    return dict(given)


def tell(error: BaseException, note: str) -> None:
    """Add a note of where an error was raised, once, unless it is of a kind that cannot be changed."""
    with contextlib.suppress(Exception):
        if note not in getattr(error, "__notes__", ()):
            error.add_note(note)


def span(value: Any) -> tuple[float, float]:
    """`t_span`: an end time, or (t0, t1)."""
    if type(value) is float or isinstance(value, Real):     # the second question takes longer than all else here
        t0, t1 = 0.0, number("t_span", value)
    else:
        try:
            t0, t1 = value
        except (TypeError, ValueError):
            raise WrongType(f"t_span must be an end time or a pair (t0, t1), not {value!r}") from None
        t0, t1 = number("t_span[0]", t0), number("t_span[1]", t1)
    if not t1 > t0:
        raise WrongValue(f"t_span must run forwards: {t1:g} is not after {t0:g}", "not-increasing")
    number("the length of t_span", t1 - t0)
    return t0, t1
