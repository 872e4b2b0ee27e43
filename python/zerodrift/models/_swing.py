"""What drives prescribe that swing to and fro; as expressions, so that the mechanism can be saved and written out."""

from __future__ import annotations

from typing import Any

from .. import _check


def swing(amplitude: Any, rate: Any) -> Any:
    """The SymPy expression amplitude sin(rate t)."""
    try:
        import sympy as sp
    except ImportError as error:
        raise ImportError("a drive that swings needs SymPy: pip install 'zerodrift[symbolic]'") from error
    return _check.number("amplitude", amplitude) * sp.sin(_check.number("rate", rate) * sp.Symbol("t"))
