"""Inputs of a run: numbers that the caller sets, and their places in the data of the systems that the run evaluates."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..core import ffi
from .base import doubles


class Place(NamedTuple):
    """Memory that the core writes an input to: a double, or the three doubles of a speed."""

    name: str
    is_speed: bool
    address: Any


class Bound(NamedTuple):
    """A system with data of its own, in which inputs have places."""

    core: Any
    places: Sequence[Place]
    derivations: Sequence[tuple[int, Any]]      # address of a function of the data, and the data
    keep: Any


class Following(NamedTuple):
    """Way in which speeds reach their inputs: by jumps, or over a time in s; 0: over one fixed step."""

    jumps: bool = False
    ramp: float = 0.0


class Inputs:
    """Inputs of one run.

    Parameters
    ----------
    names : sequence of str
    initial, lower, upper : ndarray (k,)
    bound : sequence of Bound
        Systems with places of these inputs.
    values : ndarray (k,), optional
        Memory for the values, which holds the initial ones.
    follows : Following
        Way in which speeds reach their inputs.

    Attributes
    ----------
    values : ndarray (k,)
        Writable; the core reads it at the start of each advance, and events set it.
    """

    def __init__(self, names: Sequence[str], initial: np.ndarray, lower: np.ndarray, upper: np.ndarray,
                 bound: Iterable[Bound], values: np.ndarray | None = None, follows: Following | None = None) -> None:
        self.names, self.lower, self.upper = tuple(names), lower, upper
        self.values = initial.copy() if values is None else values
        self._bound, self._initial = tuple(bound), initial
        places = [place for each in self._bound for place in each.places]
        derivations = [each for bound in self._bound for each in bound.derivations]
        rows = ffi.new("zd_input_slot[]", [(self.names.index(each.name), each.is_speed, each.address) for each in places])
        functions = ffi.new("void (*[])(double *)", [ffi.cast("void (*)(double *)", address) for address, _ in derivations])
        data = ffi.new("double *[]", [each for _, each in derivations])
        k = len(names)
        follows = follows or Following()
        texts = [ffi.new("char[]", name.encode()) for name in names]
        listed = ffi.new("const char *[]", texts)
        self._memory = rows, functions, data, texts, listed, places
        self.c = ffi.new("zd_inputs *", {
            "count": k, "value": doubles(self.values, k, writable=True), "lower": doubles(lower, k), "upper": doubles(upper, k),
            "places": len(places), "place": rows, "derivations": len(derivations), "derive": functions, "data": data,
            "name": listed, "jumps": follows.jumps, "ramp": follows.ramp})

    @property
    def at_places(self) -> np.ndarray:
        """Numbers at all places."""
        return np.array([place.address[i] for place in self._memory[-1] for i in range(3 if place.is_speed else 1)])

    def restore(self, values: np.ndarray, at_places: np.ndarray) -> None:
        """Set values, and the numbers at all places."""
        self.values[:], numbers = values, iter(at_places.tolist())
        for place in self._memory[-1]:
            for i in range(3 if place.is_speed else 1):
                place.address[i] = next(numbers)
        for function, data in zip(*self._memory[1:3], strict=True):
            function(data)

    def set_constant(self, values: np.ndarray) -> None:
        """Set values (k,) and write them to their places at once, speeds as constant ones."""
        numbers = dict(zip(self.names, values.tolist(), strict=True))
        at_places = [[numbers[place.name]] + [0.0, 0.0] * place.is_speed for place in self._memory[-1]]
        self.restore(values, np.array([number for each in at_places for number in each]))

    @contextlib.contextmanager
    def initially(self) -> Iterator[None]:
        """Initial values, and the present ones again after an error."""
        before = self.values.copy(), self.at_places
        self.set_constant(self._initial)
        try:
            yield
        except BaseException:
            self.restore(*before)
            raise

    def adopt(self, memory: np.ndarray) -> None:
        """Move the values to other memory (k,), which is read from now on."""
        memory[:] = self.values
        self.values = memory
        self.c.value = doubles(memory, memory.size, writable=True)

    def refused(self) -> str:
        """Rule that an input violates; empty: none does."""
        columns = (each.tolist() for each in (self.values, self.lower, self.upper))
        for name, value, least, most in zip(self.names, *columns, strict=True):
            if not np.isfinite(value):
                return f"input {name!r} must be finite, not {value}"
            if not least <= value <= most:
                return f"input {name!r} must be between {least:g} and {most:g}, not {value:g}"
        return ""
