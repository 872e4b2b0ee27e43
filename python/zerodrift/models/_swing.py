"""Prescribed oscillations of drives, as expressions, so that mechanisms can be saved and exported."""

from __future__ import annotations

import importlib
from typing import Any

from .._private import checks
from ..errors import MissingPackage


def sympy() -> Any:
    """SymPy; where it is missing, the error says what to install."""
    try:
        return importlib.import_module("sympy")
    except ImportError as error:
        raise MissingPackage("drives and profiles of some models are expressions of SymPy: "
                          "pip install 'zerodrift[symbolic]'") from error


def symbol(name: str) -> Any:
    """A symbol: of time, or of a measure."""
    return sympy().Symbol(name)


def swing(amplitude: Any, rate: Any) -> Any:
    """The expression amplitude sin(rate t)."""
    return checks.number("amplitude", amplitude) * sympy().sin(checks.number("rate", rate) * symbol("t"))


def swing_from(amplitude: Any, rate: Any, phase: float) -> Any:
    """The expression amplitude (sin(rate t + phase) - sin(phase)), which is zero at t = 0."""
    turned = sympy().sin(checks.number("rate", rate) * symbol("t") + phase) - sympy().sin(sympy().Float(phase))
    return checks.number("amplitude", amplitude) * turned
