"""Mechanisms in space in joint coordinates: against absolute ones, an independent model of bodies, and a reference."""

import numpy as np
import pytest

import zerodrift as zd
from mechanisms.plain_space import ON_GROUND, Compared, Plain
from support import FORMULATIONS

NEAR = 1e-6         # of the largest acceleration: the model's differences have some 1e-8
SAME = 1e-8         # of the largest value of a measure: 20 steps of RK4 in different coordinates, whose errors are 1e-11 or so
ALIKE = {"position", "velocity", "acceleration", "rotation", "angular_velocity", "angular_acceleration"}


def compared(m, span=0.02, step=1e-3, **settings):
    """Runs in both coordinates, from the same state of bodies that move."""
    systems = [m.system(which) for which in ("joint", "absolute")]
    return [zd.simulate(system, span, step=step, **settings) for system in systems]


def differences(m, found, *, reactions=True):
    """By measure: how far both are apart, of the largest value of it and of the like."""
    joint, absolute = found
    for name in joint.system.measures:
        is_reaction = name.rpartition(".")[2] in ("force", "torque", "tension")
        if (name.rpartition(".")[2] in ALIKE or is_reaction) and (reactions or not is_reaction):
            scale = max(np.abs(absolute[name]).max(), 1.0)
            yield name, np.abs(joint[name] - absolute[name]).max() / scale


def moving(seed, bodies, loops, on_ground=None):
    """A random mechanism that is moving as its joints allow."""
    plain = Plain(np.random.default_rng(seed), bodies, loops, on_ground)
    rng = np.random.default_rng(seed + 100)
    plain.m.start({}, wish={f"b{i}.angular_velocity": rng.normal(size=3) for i in range(bodies)})
    return plain.m


@pytest.mark.parametrize("seed", [0, 1, 2, 3, 4, 6, 9, 11, 22, 27, 31])
def test_joint_coordinates_equal_absolute_ones(seed):
    """Trees and up to three loops, rolling and gliding; where rows follow from others, reactions are not determined."""
    m = moving(seed, 2 + seed % 4, seed % 4, [None, *ON_GROUND, "blade"][seed % 5])
    formulation = FORMULATIONS[seed % len(FORMULATIONS)]
    found = compared(m, formulation=formulation)
    unique = "no redundant rows" in str(m)
    off = dict(differences(m, found, reactions=unique))
    assert max(off.values()) < SAME, max(off, key=off.get)
    assert found[0].system.nv < found[1].system.nv


@pytest.mark.parametrize(("seed", "wanted"), [(5, "augmented")])
def test_accelerations_and_reactions(seed, wanted):
    case = Compared(seed, coordinates="joint")
    assert case.can_be
    assert max(case.accelerations(wanted)) < NEAR
