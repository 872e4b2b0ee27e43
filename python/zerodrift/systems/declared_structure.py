"""Packed terms of Python systems with a declared structure: callables return dense matrices, the core receives stored entries."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _gateway
from ..errors import WrongValue, sentence

SAID = {"A": "kinematics", "M": "mass", "C": "the constraint matrix"}


class PackedWriter:
    """Writer that packs the dense matrices of another writer; nonzero entries outside the structure are refused."""

    def __init__(self, writer: Any, packing: _gateway.Packing) -> None:
        self._writer, self._packing, self.provides = writer, packing, writer.provides

    def __call__(self, want: int, t: float, arrays: dict[str, np.ndarray]) -> None:
        packed = [name for name in _gateway.PACKED if name in arrays]
        dense = arrays | {name: np.zeros(self._packing.shapes[name]) for name in packed}
        if "C" in dense:
            dense["C_H"], dense["C_NH"] = dense["C"][: self._writer.mh], dense["C"][self._writer.mh :]
        self._writer(want, t, dense)
        for name in packed:
            if want & _gateway.TERMS[name].bit:
                try:
                    arrays[name][...] = self._packing.pack(name, dense[name])
                except ValueError as error:
                    raise WrongValue(f"{SAID[name]}{sentence(error)} (at t = {t:g})", "declared-structure") from None

    def not_finite(self, name: str, t: float, value: np.ndarray) -> Exception:
        """The error for a term that is not finite."""
        return self._writer.not_finite(name, t, self._packing.expand(name, value) if name in _gateway.PACKED else value)
