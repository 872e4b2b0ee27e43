"""The models of `zd.models`, for tests of all of them; they need SymPy, which `support` does not."""

import zerodrift as zd

MODELS = {"andrews": zd.models.andrews, "bicycle": zd.models.bicycle, "slider_crank": zd.models.slider_crank,
          "closed_pendulum": zd.models.closed_pendulum, "closed_pendulum of 7": lambda: zd.models.closed_pendulum(7)}
LINKAGES = {name: getattr(zd.models, name) for name in zd.models.__all__ if name not in MODELS}
