"""User functions of mechanisms: calls of Python functions by the core with their errors stored, and expressions as programs."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from ....errors import WrongValue
from ...core import ffi, lib
from ..base import CALLBACK, DONE, doubles

Law = Callable[[int, float, np.ndarray, np.ndarray], Any]


class LawOwner:
    """Evaluation of the user functions of one run; stores exceptions that they raise, and errors for values that are not finite.

    Attributes
    ----------
    error : exception or None
        Raised by a user function, or else `refusal`.
    refusal : WrongValue or None
        For the last values that were not finite, which shorter steps may have avoided since.
    seconds : dict
        Time spent in each user function that was called, in s, by its number.
    """

    def __init__(self, law: Law, sizes: dict[int, tuple[int, int]]) -> None:
        self._error: BaseException | None = None
        self.refusal: WrongValue | None = None
        self._law, self._sizes, self.seconds = law, sizes, dict[int, float]()

    @property
    def error(self) -> BaseException | None:
        return self._error or self.refusal

    def evaluate(self, law: int, t: float, x: Any, xdot: Any, out: Any) -> int:
        """Evaluate a user function for the core; `sizes` are the numbers of its marker quantities and results."""
        begin = time.perf_counter()
        try:
            k, size = self._sizes[law]
            values = np.asarray(self._law(law, t, np.array(ffi.unpack(x, k)), np.array(ffi.unpack(xdot, k))), dtype=float)
            if values.shape != (size,):
                raise WrongValue(f"law {law} must give {size} numbers, not an array of shape {values.shape}", "shape")
            for i, value in enumerate(values):
                out[i] = value
        except BaseException as error:      # raised again where the run was started
            if isinstance(error, WrongValue) and error.code == "not-finite":
                self.refusal = error
                return lib.ZD_NOT_FINITE
            self._error = error
            return CALLBACK
        self.seconds[law] = self.seconds.get(law, 0.0) + time.perf_counter() - begin
        return DONE

    @property
    def calls(self) -> dict[str, float]:
        """Time spent in each user function that was called, in s, by its description."""
        rows = getattr(self._law, "rows", ())
        return {rows[law].law.what: seconds for law, seconds in self.seconds.items() if law < len(rows)}


def table_of_programs(law: Law, sizes: dict[int, tuple[int, int]]) -> Any:
    """The core's array of user functions that are expressions, NULL if there are none, and the memory to keep with it.

    Where `law` has a method `programs`, this gives for each law a `zd_expressions` with what it refers to, and its numbers; or
    None.
    """
    found = law.programs(sizes) if hasattr(law, "programs") else []
    if not any(found):
        return ffi.NULL, None
    arrays = [each and each[1].copy() for each in found]      # inputs are written into those of one run
    kept = [array if array is None else doubles(array, array.size) for array in arrays]
    rows = [(each[0][0], numbers, lib.zd_expressions_have_ends(each[0][0], numbers)) if each else ()
            for each, numbers in zip(found, kept, strict=True)]
    return ffi.new("zd_law_program[]", rows), (kept, found)


def breaks_of(law: Any, span: tuple[float, float] | None = None) -> Any:
    """The core's breaks of user functions, NULL if there are none, and the memory to keep with it; in a span all are known."""
    found = law.breaks(span) if hasattr(law, "breaks") else ()
    times = [np.array(each, dtype=float) for _, each in found]
    if not times:
        return ffi.NULL, None
    rows = [(period, t.size, doubles(t, t.size)) for (period, _), t in zip(found, times, strict=True)]
    groups = ffi.new("zd_break_group[]", rows)
    made = ffi.new("zd_breaks *", (len(times), groups))
    return made, (made, groups, times)


def switches_of(law: Any, programs: tuple[Any, Any], evaluate: Any) -> tuple[Any, Any]:
    """The core's comparisons at which user functions jump, NULL if there are none, and the memory to keep with it."""
    table, kept = programs
    found = law.differences if kept and hasattr(law, "differences") else {}
    if not found:
        return ffi.NULL, None
    places, memory = list[Any](), list[Any]()
    for i, each in found.items():
        (expressions, _), numbers = each.program
        memory.append(doubles(numbers, numbers.size))
        table[i].differences, table[i].numbers_of_differences, table[i].first_difference = expressions, memory[-1], len(places)
        places += [kept[0][i] + place for place in each.places]
    place = ffi.new("double *[]", places)
    made = ffi.new("zd_switches *", (len(places), place, evaluate))
    return made, (made, memory, place)


@ffi.def_extern(error=lib.ZD_CALLBACK)
def zd_law_in_python(owner: Any, *arguments: Any) -> int:
    return ffi.from_handle(owner).evaluate(*arguments)
