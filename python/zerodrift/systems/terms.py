"""The terms of the equations of motion, as a user reads them."""

from __future__ import annotations

import numpy as np

from .. import _gateway


class Terms:
    __doc__ = "\n".join([
        "The terms of the equations of motion at one (t, p, v); what a system does not have is None.", "",
        "Attributes", "----------",
        *(f"{name} : ndarray {term.sizes}\n    {term.text[0].upper()}{term.text[1:]}." for name, term in _gateway.TERMS.items())])

    __slots__ = tuple(_gateway.TERMS)

    def __init__(self, **arrays: np.ndarray) -> None:
        for name in self.__slots__:
            setattr(self, name, arrays.get(name))

    def __repr__(self) -> str:
        present = (f"{name} {array.shape}" for name in self.__slots__ if (array := getattr(self, name)) is not None)
        return f"Terms({', '.join(present)})"
