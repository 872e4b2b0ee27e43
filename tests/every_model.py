"""The models of `zd.models`, for tests of all of them; they need SymPy, which `support` does not."""

import energy_models
import zerodrift as zd

IN_SPACE = {name: getattr(zd.models, name) for name in zd.models.space.__all__}
MECHANISMS = {name: getattr(zd.models, name) for name in zd.models.__all__ if name not in IN_SPACE}     # those in the plane
MODELS = energy_models.ALL | {"closed_pendulum of 7": lambda: energy_models.closed_pendulum(7)}
