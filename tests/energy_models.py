"""Four models from their energies: examples of `zd.symbolic`, compared with those from bodies and joints; they need SymPy."""

from zerodrift.models._energies import andrews, bicycle, closed_pendulum, slider_crank

ALL = {"andrews": andrews, "bicycle": bicycle, "closed_pendulum": closed_pendulum, "slider_crank": slider_crank}
