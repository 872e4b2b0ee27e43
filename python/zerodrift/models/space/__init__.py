"""Worked models in space, each one short file; `zerodrift.models` has them beside those of the plane.

>>> import zerodrift as zd
>>> zd.models.heavy_top().dimension
3
"""

from .bennett import bennett
from .chain import chain
from .coin import coin
from .delta_robot import delta_robot
from .double_cardan import double_cardan
from .double_wishbone import double_wishbone
from .flyball_governor import flyball_governor
from .gyroscope import gyroscope
from .heavy_top import heavy_top
from .hookes_joint import hookes_joint
from .rattleback import rattleback
from .rolling_disc import rolling_disc
from .spatial_slider_crank import spatial_slider_crank
from .stewart_platform import stewart_platform
from .whipple_bicycle import whipple_bicycle

__all__ = ["bennett", "chain", "coin", "delta_robot", "double_cardan", "double_wishbone", "flyball_governor", "gyroscope",
           "heavy_top", "hookes_joint", "rattleback", "rolling_disc", "spatial_slider_crank", "stewart_platform",
           "whipple_bicycle"]
