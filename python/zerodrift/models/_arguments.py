"""The arguments of models: numbers are checked by the names that they have there, before anything is made of them."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import ParamSpec

from .._private import checks
from ..errors import WrongType
from ..mechanisms.mechanism import Mechanism

Given = ParamSpec("Given")
NOT_NEGATIVE = ("mass", "inertia", "stiffness", "damping", "density")      # quantities, as the last word of an argument's name


def checked(model: Callable[Given, Mechanism]) -> Callable[Given, Mechanism]:
    """A model whose arguments that are annotated as float are finite numbers, at least 0 where they have to be."""
    signature = inspect.signature(model)
    numbers = [name for name, parameter in signature.parameters.items() if str(parameter.annotation).startswith("float")
               and parameter.kind is not parameter.VAR_KEYWORD]

    @functools.wraps(model)
    def make(*given: Given.args, **named: Given.kwargs) -> Mechanism:
        try:
            taken = signature.bind(*given, **named)
        except TypeError as error:
            raise WrongType(f"{model.__name__}(): {error}") from None
        for name in numbers:
            if name in taken.arguments and not (taken.arguments[name] is None and signature.parameters[name].default is None):
                least = 0 if name.rpartition("_")[2] in NOT_NEGATIVE else None
                taken.arguments[name] = checks.number(name, taken.arguments[name], least=least)
        return model(*taken.args, **taken.kwargs)

    return make
