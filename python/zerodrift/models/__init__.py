"""Worked models, each one short file whose function takes the parameters as keywords.

From their energies, as examples of `zerodrift.symbolic`: `andrews`, `bicycle`, `closed_pendulum`, `slider_crank`. Linkages, as
examples of `zerodrift.linkage`, with a motor: `chebyshev_lambda`, `hoecken`, `jansen`, `klann`, `peaucellier`, `stephenson`,
`watt`. From bodies and joints: `four_bar`, `four_bars`. They need SymPy, the extra `symbolic`.

>>> import zerodrift as zd
>>> chain = zd.models.closed_pendulum(links=5)
>>> sol = zd.simulate(chain, 1.0, step=0.01)
>>> bool(abs(sol.position_violation).max() < 1e-12)
True
"""

from ..symbolics import define  # noqa: F401  (where SymPy is missing, it says what to install)
from .andrews import andrews
from .bicycle import bicycle
from .chebyshev_lambda import chebyshev_lambda
from .closed_pendulum import closed_pendulum
from .four_bar import four_bar
from .four_bars import four_bars
from .hoecken import hoecken
from .jansen import jansen
from .klann import klann
from .peaucellier import peaucellier
from .slider_crank import slider_crank
from .stephenson import stephenson
from .watt import watt

__all__ = ["andrews", "bicycle", "chebyshev_lambda", "closed_pendulum", "four_bar", "four_bars", "hoecken", "jansen", "klann",
           "peaucellier", "slider_crank", "stephenson", "watt"]


def __dir__() -> list[str]:
    return __all__      # and not what is imported
