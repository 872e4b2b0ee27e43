"""The models of `zd.models`, for tests of all of them; they need SymPy, which `support` does not."""

import pytest

import energy_models
import zerodrift as zd
from covering import WHOLE

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
