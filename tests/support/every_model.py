"""The models of `zd.models`, for tests of all of them; they need SymPy, which `support` does not."""

import numpy as np
import pytest

import energy_models
import zerodrift as zd
from covering import WHOLE
from support import allowed_velocity
from zerodrift.analysis.state import state
from zerodrift.analysis.tangent import Tangent

IN_SPACE = {name: getattr(zd.models, name) for name in zd.models.space.__all__}
MECHANISMS = {name: getattr(zd.models, name) for name in zd.models.__all__ if name not in IN_SPACE}     # those in the plane
MODELS = energy_models.ALL | {"closed_pendulum of 7": lambda: energy_models.closed_pendulum(7)}
MANY_PARAMETERS = 40


def assert_right(system):
    """`zd.check` finds nothing wrong, also not in derivatives by tangent directions, which driven mechanisms lack, or parameters.

    Of systems with many parameters only all products compare the derivatives by each of them, which takes seconds.
    """
    with pytest.MonkeyPatch.context() as patch:
        if len(system.parameters) > MANY_PARAMETERS and not WHOLE:
            patch.setattr("zerodrift.studies.check.derivatives_by_parameters", lambda *_: {})
        report = zd.check(system)
    assert report, report
    is_driven = not zd.mass_matrix(system, tangent=True).size
    assert is_driven or "derivatives of accelerations" in report.checks


def moving(share, name, *layout):
    """A model and its state, with a share of a random velocity in all free directions."""
    system = getattr(zd.models, name)().system(*layout)
    p, v = system.start_at(0.0)
    at = state(system, 0.0, p, v)
    push = share * allowed_velocity(Tangent(at).velocities, at.M, np.random.default_rng(3))
    return system, *zd.project(system, p, v + push, projection=zd.Projection(tol=1e-13))
