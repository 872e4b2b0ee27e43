"""A mechanism is the same in joint and in absolute coordinates: the tree and its cuts against three coordinates a body."""

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from mechanism_tables import (
    Body,
    GeneralizedForce,
    Joint,
    Quantity,
    Relation,
    Tabled,
    Tables,
    determined,
    in_absolute_coordinates,
    kind,
    random_mechanism,
)
from support import assert_close


def pairs():
    """Mechanisms in both coordinates, whose joints are independent and leave some freedom."""
    for seed in range(60):
        joint = random_mechanism(seed, bodies=2 + seed % 5, loops=seed % 3)
        absolute = in_absolute_coordinates(joint)
        if determined(absolute):
            yield pytest.param(joint, absolute, id=str(seed))


PAIRS = list(pairs())


def test_there_are_enough_of_them():
    assert len(PAIRS) > 25
    assert sum(pair.values[0].m > 0 for pair in PAIRS) > 8


@pytest.mark.parametrize(("joint", "absolute"), PAIRS)
def test_accelerations_and_reactions_agree(joint, absolute):
    """Reactions of tree joints come from a pass over the tree in joint coordinates, from multipliers in absolute ones."""
    there, here = zd.acceleration(joint, joint.p0, joint.v0), zd.acceleration(absolute, absolute.p0, absolute.v0)
    for measure in joint._core.measures:
        one = joint.measured(measure.name, 0, joint.p0, joint.v0, *there)
        other = absolute.measured(measure.name, 0, absolute.p0, absolute.v0, *here)
        assert_close(one, other, tol.REACTION, scale=10, what=measure.name)


@pytest.mark.parametrize(("joint", "absolute"), PAIRS[::4])
def test_motions_agree(joint, absolute):
    one, other = (zd.simulate(system, 0.2, step=1e-3, save_every=200) for system in (joint, absolute))
    there, here = joint._core.poses(one.p[-1])[0], absolute._core.poses(other.p[-1])[0]
    assert_close(there, here, tol.CONVERGED, scale=1)
    assert_close(one.kinetic_energy[-1] + one.potential_energy[-1], other.kinetic_energy[-1] + other.potential_energy[-1],
                 tol.CONVERGED, scale=1)


def test_the_order_of_bodies_does_not_matter():
    """A body may come before the one that it hangs on."""
    system = random_mechanism(3, bodies=4)
    tables = system._core.tables
    turned = {b: len(tables.bodies) + 1 - b if b else 0 for b in range(len(tables.bodies) + 1)}
    joints = [joint._replace(first=turned[joint.first], second=turned[joint.second]) for joint in tables.joints]
    quantities = [each._replace(first=turned[each.first], second=turned[each.second]) for each in tables.quantities]
    other = type(system)(tables._replace(bodies=tables.bodies[::-1], joints=joints, quantities=quantities))
    poses, rates = system._core.poses(system.p0, system.v0)
    p, v = other._core.state(poses[::-1].copy(), rates[::-1].copy())
    there, here = zd.acceleration(system, system.p0, system.v0), zd.acceleration(other, p, v)
    for measure in tables.measures:
        assert_close(system.measured(measure.name, 0, system.p0, system.v0, *there), other.measured(measure.name, 0, p, v, *here),
                     tol.REACTION, scale=1, what=measure.name)


def test_sliders_that_start_at_zero_have_the_size_of_their_mechanism():
    """Their coordinates are rounding there, and no row has a lever: lengths are compared to those of the drawing."""
    joints = [Joint(kind("prismatic"), 0, 1), Joint(kind("prismatic"), 0, 2, (1.0, 0.0))]
    quantities = [Quantity("along", 0, 1), Quantity("along", 0, 2, (1.0, 0.0))]
    tables = Tables([Body(1.0, 1.0, inboard=0), Body(1.0, 1.0, inboard=1)], joints, quantities, [Relation([0, 1], [1.0, -1.0])],
                    [GeneralizedForce("constant", 0, value=1.0)])
    system = Tabled(tables, np.array([1e-16, 0.9e-16]), np.zeros(2))
    assert zd.simulate(system, 0.1, step=0.01).p[-1] == pytest.approx(0.1**2 / 4, rel=tol.CONVERGED)


def test_absolute_coordinates_declare_bodies_and_joints():
    """Blocks are bodies with a constant diagonal mass, groups the rows of each joint. With a tree there is none of it."""
    joints = [Joint(kind("revolute"), 0, 1), Joint(kind("slot"), 2, 1), Joint(kind("rod"), 2, 3, length=1.0),
              Joint(kind("knife_edge"), 1, 1)]
    bodies = [Body(2.0, 3.0), Body(1.0, 1.0), Body(4.0, is_particle=True)]
    tables = Tables(bodies, joints, [Quantity("angle", 0, 1), Quantity("x", 0, 0)], [Relation([0])])
    structure = Tabled(tables)._core.c.structure
    assert [structure.velocities[b] for b in range(structure.blocks)] == [3, 3, 2]
    groups = [(structure.rows[g], [structure.block[i] for i in range(structure.first[g], structure.first[g + 1])])
              for g in range(structure.groups)]
    assert groups == [(2, [0]), (1, [0, 1]), (1, [1, 2]), (1, [0]), (1, [0])]
    assert np.array_equal(np.diag(Tabled(tables).evaluate(np.ones(8), np.ones(8)).M), [2, 2, 3, 1, 1, 1, 4, 4])
    assert not Tabled(tables._replace(bodies=[bodies[0]._replace(inboard=0), *bodies[1:]]))._core.c.structure
    assert not Tabled(tables._replace(relations=[Relation([1])]))._core.c.structure
