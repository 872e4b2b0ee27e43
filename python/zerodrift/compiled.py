"""Systems whose equations are compiled code of one's own: see `zerodrift.native`.

`BIT` and `SLOT` name the terms in such a function, and `INTERFACE_VERSION` is what it is to be compiled with.
"""

from .systems.native import BIT, INTERFACE_VERSION, SLOT, get_include, native, numba_signature

__all__ = ["BIT", "INTERFACE_VERSION", "SLOT", "get_include", "native", "numba_signature"]


def __dir__() -> list[str]:
    return __all__      # and not what is imported
