"""Statements of the documentation, measured: actions that steps may miss, directions that turn with a body."""

import warnings

import numpy as np
import pytest

import zerodrift as zd
from few_bodies import kicked
from support import called

DURATION = 0.02     # s


def peak(form=called, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", zd.StabilityWarning)     # at rest, stability limits the steps of an explicit method
        return zd.simulate(kicked(1000.0, 0.5, form=form), 0.8, **options)["mass.position.y"].max()


def test_an_action_shorter_than_a_step_may_be_missed_and_is_found_with_max_step():
    """As `simulate` says of `max_step`; the height is that of fixed steps a twentieth of the duration long.

    Steps end at the jumps of a function that is recorded.
    """
    options = {"integrator": "dormand_prince", "rtol": 1e-8, "atol": 1e-8}
    high = peak(step=DURATION / 20)
    assert high == pytest.approx(0.41, abs=0.01)
    assert peak(**options) < 1e-6
    assert peak(lambda law: law, **options) == pytest.approx(high, rel=1 / 20)
    assert peak(max_step=DURATION, **options) == pytest.approx(high, rel=1 / 20)      # of its steps


def test_the_directions_of_a_knife_edge_in_space_turn_with_the_body():
    """As `knife_edge` says of `along` and `normal`: a body that rolls about its blade takes the free directions along."""
    m = zd.Mechanism("skate", dimension=3)
    body = m.body("body", 1.0, (0.1, 0.2, 0.3))
    m.knife_edge("blade", body, along=(1, 0, 0), normal=(0, 0, 1))
    m.start({body.angular_velocity.x: 1.0, body.velocity.x: 1.0, body.velocity.z: 0.5})
    sol = zd.simulate(m, 1.0, rtol=1e-9)
    v, turned = sol["body.velocity"], sol.t         # rad, at 1 rad/s
    assert np.abs(np.cos(turned) * v[:, 1] + np.sin(turned) * v[:, 2]).max() < 1e-12       # across the blade
    assert v[-1, 1] < -0.4      # along y, which would be across it if the ice were fixed
