"""Joint coordinates in space: against absolute coordinates of the same bodies, and against differences."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from space_tables import KINDS, random_frame, unit
from support import assert_close, refused
from zerodrift._private.gateway.base import doubles
from zerodrift._private.gateway.mechanisms.plane import GeneralizedForce, Relation
from zerodrift._private.gateway.mechanisms.space import Body, Joint, Quantity, SpaceCore, Tables
from zerodrift._private.gateway.mechanisms.space_tree import SpaceTreeCore
from zerodrift._private.rotations import rotation_of

CARRYING = [name for name, kind in KINDS.items() if kind.freedoms is not None]
OF_PARTICLES = [name for name in CARRYING if KINDS[name].freedoms and KINDS[name].freedoms[-1].kind == "swings"]
H = 1e-5            # s: of central differences, whose error is some H^2 and round-off over H
NEAR = 3e-8         # that error, of terms of order one to ten
EXACT = 1e-12       # round-off of some hundred operations on numbers of order one


def body(rng, inboard=-1, is_particle=False):
    return Body(rng.uniform(1, 2), (0.0, 0.0, 0.0) if is_particle else tuple(rng.uniform(1, 1.5, 3)), is_particle, inboard)


def joint(rng, kind, first, second, particle=0):
    points = [(0.0, 0.0, 0.0) if particle and end == particle else tuple(rng.normal(size=3)) for end in (first, second)]
    return Joint(KINDS[kind].number, first, second, *points, random_frame(rng), random_frame(rng), (0.3, 0.5, 0.8),
                 0.0 if kind == "universal" else 0.3, 0.2)


def with_forces(rng, bodies, joints):
    """Tables with a spring, a force, a row that holds a distance, and a nonholonomic one, between the last body and others."""
    last, point = len(bodies), (0.0, 0.0, 0.0) if bodies[-1].is_particle else tuple(rng.normal(size=3))
    own = {"point2": point, "a": unit(rng), "b": unit(rng)}
    quantities = [Quantity("distance", 0, last, **own), Quantity("glide", 0, last, **own), Quantity("distance", 1, last, **own)]
    forces = [GeneralizedForce("spring", 0, 3.0, 0.2), GeneralizedForce("constant", 1, value=1.5)]
    relations = [Relation([0], [1.0], 0.3), Relation([1, 2], [1.0, 0.5], 0.3, nonholonomic=True)]
    return Tables(bodies, joints, quantities, relations, forces, (), (0.3, -0.2, -9.81))


def chain(rng, kind, is_second):
    """A body on the ground by a revolute joint, one on it by the joint looked at, and one on that by a ball, backwards."""
    ends = (1, 2) if is_second else (2, 1)
    return with_forces(rng, [body(rng, 0), body(rng, 1), body(rng, 2)],
                       [joint(rng, "revolute", 0, 1), joint(rng, kind, *ends), joint(rng, "spherical", 3, 2)])


def around_particle(rng, kind, is_second):
    """A particle that the joint looked at carries, on a free body, and a body on it by a ball; or that carries a body by it."""
    bodies = [body(rng), body(rng, 0, is_particle=True), body(rng, 1)]
    if is_second:
        return with_forces(rng, bodies, [joint(rng, kind, 1, 2, particle=2), joint(rng, "spherical", 2, 3, particle=2)])
    bodies = [body(rng, 0, is_particle=True), body(rng, 1)]
    return with_forces(rng, bodies, [joint(rng, "spherical", 0, 1, particle=1), joint(rng, kind, 2, 1, particle=1)])


CASES = [pytest.param(make, kind, side, id=f"{make.__name__}-{kind}-{'second' if side else 'first'}")
         for make, kinds in ((chain, CARRYING), (around_particle, OF_PARTICLES)) for kind in kinds for side in (True, False)]


class Both:
    """A mechanism in joint coordinates and in absolute ones, at a state that the tree allows."""

    def __init__(self, tables, seed):
        rng = np.random.default_rng(seed)
        self.tree = SpaceTreeCore(tables)
        self.free = SpaceCore(tables._replace(bodies=[each._replace(inboard=-1) for each in tables.bodies]))
        self.p, self.v = rng.normal(size=self.tree.nq), rng.normal(size=self.tree.nv)
        for i in range(self.tree.c.quaternions):
            at = self.tree.c.quaternion[i]
            self.p[at:at + 4] = Rotation.random(random_state=rng).as_quat(scalar_first=True)
        self.pdot = self.kinematic(self.p) @ self.v

    def kinematic(self, p):
        A = self.tree.evaluate(0.0, p, self.v).get("A")
        return np.eye(self.tree.nv) if A is None else A

    def absolute(self, p, v):
        return self.free.state(*self.tree.poses(p, v), self.tree.angles(p))

    def D(self, p):
        """Matrix from the tree's velocities (nv,) to those in absolute coordinates."""
        return np.stack([self.absolute(p, each)[1] for each in np.eye(self.tree.nv)], axis=1)

    def rate(self, function):
        """Time derivative of a function of p along the motion, by central differences."""
        return (function(self.p + H * self.pdot) - function(self.p - H * self.pdot)) / (2 * H)


@pytest.mark.parametrize(("make", "kind", "is_second"), CASES)
class TestTree:
    def test_joints_of_the_tree_are_closed(self, make, kind, is_second):
        both = Both(make(np.random.default_rng(1), kind, is_second), 2)
        own = len(both.free.rows) - both.tree.m
        at = [i for i, row in enumerate(both.free.rows) if row.owner == "joint"]
        terms = both.free.evaluate(0.0, *both.absolute(both.p, both.v))
        assert len(at) == own
        Phi = np.remainder(terms["Phi"][at] + 0.1, 2 * np.pi * 0.2) - 0.1 if kind == "screw" else terms["Phi"][at]
        assert np.abs(Phi).max(initial=0.0) < EXACT
        assert np.abs((terms["C"] @ both.D(both.p))[at]).max(initial=0.0) < EXACT

    def test_equations_are_those_of_absolute_coordinates(self, make, kind, is_second):
        both = Both(make(np.random.default_rng(1), kind, is_second), 2)
        D, gamma = both.D(both.p), both.rate(lambda p: both.absolute(p, both.v)[1])
        tree, free = both.tree.evaluate(0.0, both.p, both.v), both.free.evaluate(0.0, *both.absolute(both.p, both.v))
        relations = [i for i, row in enumerate(both.free.rows) if row.owner == "relation"]
        assert_close(tree["M"], D.T @ free["M"] @ D, EXACT)
        assert_close(tree["f"], D.T @ free["f"], EXACT)
        assert_close(tree["C"], free["C"][relations] @ D, EXACT)
        assert_close(tree["Phi"], free["Phi"][[i for i in relations if i < both.free.mh]], EXACT, scale=1.0)
        assert_close(tree["Phi_t"], free["Phi_t"][relations], EXACT, scale=1.0)
        assert tree["V"] == pytest.approx(free["V"], rel=EXACT)
        assert tree["power"] == pytest.approx(free["power"], rel=EXACT)
        assert_close(tree["d"], D.T @ (free["M"] @ gamma + free["d"]), NEAR, scale=1.0)
        assert_close(tree["xi"], free["xi"][relations] - free["C"][relations] @ gamma, NEAR, scale=1.0)

    def test_kinematics(self, make, kind, is_second):
        """Bodies move as (1) moves coordinates; and poses and twists lead back to the state."""
        both = Both(make(np.random.default_rng(1), kind, is_second), 2)
        poses, rates = both.tree.poses(both.p, both.v)
        before, after = (both.tree.poses(both.p + sign * H * both.pdot)[0] for sign in (-1, 1))
        assert_close((after - before)[:, :3] / (2 * H), rates[:, :3], NEAR, scale=1.0)
        one, other = (Rotation.from_quat(each[:, 3:], scalar_first=True) for each in (before, after))
        assert_close((one.inv() * other).as_rotvec() / (2 * H), rates[:, 3:], NEAR, scale=1.0)
        p, v = both.tree.state(poses, rates, both.tree.angles(both.p))
        again = both.tree.poses(p)[0]
        assert_close(again[:, :3], poses[:, :3], EXACT, scale=1.0)
        assert_close(rotation_of(again[:, 3:]), rotation_of(poses[:, 3:]), EXACT)
        assert_close(v, both.v, EXACT, scale=1.0)


def test_a_screw_counts_turns():
    rng = np.random.default_rng(0)
    tree = SpaceTreeCore(Tables([body(rng, 0)], [joint(rng, "screw", 0, 1)]))
    p = np.array([25.0])
    assert_close(tree.state(tree.poses(p)[0])[0], p, EXACT)


def test_angles_count_turns():
    """Angles of tree joints are coordinates; that of a loop joint is counted by its rate and its principal value."""
    rng = np.random.default_rng(3)
    joints = [joint(rng, "cylindrical", 0, 1), joint(rng, "universal", 2, 1), joint(rng, "revolute", 0, 2)]
    both = Both(Tables([body(rng, 0), body(rng, 1)], joints), 4)
    assert (both.tree.nq, both.tree.nv, both.tree.c.followers) == (5, 4, 1)
    p = np.array([0.1, 9.0, -15.0, 20.0, 31.0])
    both.tree.c.follow(both.tree.c.data, doubles(p, 5, writable=True))
    assert_close(both.tree.angles(p), p[1:], 0.0)
    assert abs(p[4] - 31.0) < np.pi
    assert_close(both.tree.state(both.tree.poses(p)[0], None, both.tree.angles(p))[0], p, EXACT)
    again = both.free.angles(both.absolute(p, both.v)[0])
    assert_close(again, p[1:], EXACT)


@pytest.mark.parametrize(("tables", "message"), [
    (lambda rng: Tables([body(rng, 3)], [joint(rng, "revolute", 0, 1)]), "must be at least -1 and below 1, not 3"),
    (lambda rng: Tables([body(rng, 0), body(rng)], [joint(rng, "weld", 0, 2)]), "its inboard joint 0 must connect it"),
    (lambda rng: Tables([body(rng, 0)], [joint(rng, "rod", 0, 1)]), "joint 0 must be of a kind for trees, not a rod"),
    (lambda rng: Tables([body(rng, 0, is_particle=True)], [joint(rng, "revolute", 0, 1, particle=1)]),
     "must not be a revolute, as a particle has no axes"),
    (lambda rng: Tables([body(rng, 0), body(rng, 0)], [joint(rng, "weld", 1, 2)]),
     "joint 0 must be the inboard joint of one body, not of bodies 1 and 2"),
    (lambda rng: Tables([body(rng, 0), body(rng, 1)], [joint(rng, "weld", 1, 2), joint(rng, "weld", 2, 1)]), "must have no loop"),
], ids=["no joint", "elsewhere", "rod", "particle", "twice", "circle"])
def test_trees_that_cannot_be(tables, message):
    with refused("wrong-value", message):
        SpaceTreeCore(tables(np.random.default_rng(0)))
