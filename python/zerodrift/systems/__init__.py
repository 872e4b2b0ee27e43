"""The built-in systems: ``zd.systems.four_bar(...)`` and the others of the core's table.

Each function takes the parameters of its system as keywords, with the units its docstring gives, and returns the system.
"""

from .builtin import FACTORIES

globals().update(FACTORIES)
__all__ = list(FACTORIES)


def __dir__() -> list[str]:
    return __all__      # and not what is imported
