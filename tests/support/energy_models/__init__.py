"""Four models from their energies: examples of `zd.symbolic`, compared with those from bodies and joints.

They need SymPy, the extra `symbolic`. Their arguments are those of the models of the same names; parameters and coordinates
are their own.

>>> import zerodrift as zd
>>> import energy_models
>>> chain = energy_models.closed_pendulum(links=5)
>>> sol = zd.simulate(chain, 1.0, step=0.01)
>>> bool(abs(sol.position_violation).max() < 1e-12)
True
"""

from zerodrift.symbolics import define  # noqa: F401  (where SymPy is missing, it says what to install)

from .andrews import andrews
from .bicycle import bicycle
from .closed_pendulum import closed_pendulum
from .slider_crank import slider_crank

ALL = {"andrews": andrews, "bicycle": bicycle, "closed_pendulum": closed_pendulum, "slider_crank": slider_crank}
