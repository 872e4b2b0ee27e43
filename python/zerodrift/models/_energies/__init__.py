"""Four of the models from their energies, as examples of `zerodrift.symbolic`, and to compare with those from bodies and joints.

They need SymPy, the extra `symbolic`. Their arguments are those of the models of the same names; parameters and coordinates
are their own.

>>> import zerodrift as zd
>>> from zerodrift.models import _energies
>>> chain = _energies.closed_pendulum(links=5)
>>> sol = zd.simulate(chain, 1.0, step=0.01)
>>> bool(abs(sol.position_violation).max() < 1e-12)
True
"""

from ...symbolics import define  # noqa: F401  (where SymPy is missing, it says what to install)
from .andrews import andrews
from .bicycle import bicycle
from .closed_pendulum import closed_pendulum
from .slider_crank import slider_crank

__all__ = ["andrews", "bicycle", "closed_pendulum", "slider_crank"]


def __dir__() -> list[str]:
    return __all__      # and not what is imported
