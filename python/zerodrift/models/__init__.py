"""Worked models, each one short file whose function takes the parameters as keywords.

All are mechanisms, from bodies and joints or, linkages, from a sketch: in the plane, and in space those of
`zerodrift.models.space`. Those whose drives swing, or follow a cam, need SymPy, the extra `symbolic`.

>>> import zerodrift as zd
>>> sol = zd.simulate(zd.models.closed_pendulum(links=5), 1.0, step=0.01)
>>> bool(abs(sol.position_violation).max() < 1e-12)
True
"""

from .anchor_escapement import anchor_escapement
from .andrews import andrews
from .bicycle import bicycle
from .cam_follower import cam_follower
from .chebyshev_lambda import chebyshev_lambda
from .closed_pendulum import closed_pendulum
from .compass_gait import compass_gait
from .four_bar import four_bar
from .four_bars import four_bars
from .geneva import geneva
from .hoecken import hoecken
from .jansen import jansen
from .klann import klann
from .pantograph import pantograph
from .peaucellier import peaucellier
from .planetary_gear import planetary_gear
from .quarter_car import quarter_car
from .quick_return import quick_return
from .scissor_lift import scissor_lift
from .slider_crank import slider_crank
from .snakeboard import snakeboard
from .space import (
    bennett,
    chain,
    coin,
    delta_robot,
    double_cardan,
    double_wishbone,
    flyball_governor,
    gyroscope,
    heavy_top,
    hookes_joint,
    rattleback,
    rolling_disc,
    spatial_slider_crank,
    stewart_platform,
    whipple_bicycle,
)
from .stephenson import stephenson
from .suspension import suspension
from .toggle_press import toggle_press
from .trebuchet import trebuchet
from .watt import watt

__all__ = ["anchor_escapement", "andrews", "bennett", "bicycle", "cam_follower", "chain", "chebyshev_lambda", "closed_pendulum",
           "coin", "compass_gait", "delta_robot", "double_cardan", "double_wishbone", "flyball_governor", "four_bar",
           "four_bars", "geneva", "gyroscope", "heavy_top", "hoecken", "hookes_joint", "jansen", "klann", "pantograph",
           "peaucellier", "planetary_gear", "quarter_car", "quick_return", "rattleback", "rolling_disc", "scissor_lift",
           "slider_crank", "snakeboard", "spatial_slider_crank", "stephenson", "stewart_platform", "suspension", "toggle_press",
           "trebuchet", "watt", "whipple_bicycle"]


def __dir__() -> list[str]:
    return __all__      # and not what is imported
