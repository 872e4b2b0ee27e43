"""Joints whose points coincide: products with their rows that take no stored C, against the equations with the stored one."""

import numpy as np
import pytest

import zerodrift as zd
from space_tables import KINDS, random_frame, random_state
from support import assert_close
from tolerances import REACTION, SAME
from zerodrift._private.gateway.mechanisms.space import Body, Joint, SpaceCore, Tables
from zerodrift._private.gateway.operations import acceleration, accelerations

SOCKETS = ("spherical", "universal", "revolute", "weld")
TREE = ((0, 1), (1, 2), (3, 1), (1, 4), (4, 0))     # joints by their bodies: a fork, and a loop through the ground
SWINGING = TREE[:4]     # without the loop


def mechanism(rng, kinds, ends):
    """Four bodies, of which one has up to four joints, so that blocks of C W C^T stand in either order."""
    bodies = [Body(rng.uniform(1, 2), tuple(rng.uniform(1, 1.5, 3))) for _ in range(4)]
    joints = [Joint(KINDS[kind].number, *pair, *(0.4 * rng.normal(size=(2, 3))).tolist(), random_frame(rng), random_frame(rng))
              for kind, pair in zip(kinds, ends, strict=True)]
    return SpaceCore(Tables(bodies, joints, gravity=(0.3, -0.2, -9.81)))


@pytest.fixture(params=[*SOCKETS, "mixed"])
def case(request):
    rng = np.random.default_rng(len(request.param))
    ends = TREE if request.param in ("spherical", "universal", "mixed") else SWINGING
    mixed = ["spherical", "revolute", "weld", "universal", "spherical"]
    core = mechanism(rng, mixed if request.param == "mixed" else [request.param] * len(ends), ends)
    return core, *random_state(core, rng)


def solved(core, p, v):
    """Solution (vdot, lambda) of (13) by NumPy with dense matrices."""
    terms = core.evaluate(0.0, p, v)
    C, W, force = terms["C"], 1 / np.diag(terms["M"]), terms["f"] - terms["d"]
    multipliers = np.linalg.solve(C * W @ C.T, C @ (W * force) - terms["xi"])
    return W * (force - C.T @ multipliers), multipliers


def test_accelerations_and_multipliers_are_those_of_the_stored_rows(case, formulation):
    core, p, v = case
    number = list(zd.formulations()).index(formulation)
    vdot, multipliers = acceleration(core, number, 0, 0.0, p, v)
    for found, expected in zip((vdot, multipliers), solved(core, p, v), strict=True):
        assert_close(found, expected, REACTION)
    assert_close(accelerations(core, number, 0, np.zeros(1), p[None], v[None])[0][0], vdot, SAME)
