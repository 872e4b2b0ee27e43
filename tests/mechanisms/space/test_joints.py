"""Each joint in space against what it is for: the motions that it leaves free, and no others."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from space_tables import KINDS, random_frame
from support import assert_close
from zerodrift._private.core import ffi, lib
from zerodrift._private.gateway.mechanisms.plane import OutputSpec
from zerodrift._private.gateway.mechanisms.space import Body, Joint, SpaceCore, Tables, coordinate_quantity

PITCH = 0.4         # m for each turn
LENGTH = 0.7        # m: of a rod
AXIS, NORMAL = np.eye(3)[:2]


def turned(axis, angle):
    return Rotation.from_rotvec(np.asarray(axis) * angle)


def still(*_):
    return Rotation.identity()


# By kind: how many numbers a motion has; from them the rotation and the way of the second body's frame in the first's, whose axes
# are the joint's axis, normal and third direction; and what its coordinates are.
MOTIONS = {
    "revolute": (1, lambda x: (turned(AXIS, x[0]), np.zeros(3)), lambda x: {"angle": x[0]}),
    "prismatic": (1, lambda x: (still(), x[0] * AXIS), lambda x: {"displacement": x[0]}),
    "weld": (0, lambda x: (still(), np.zeros(3)), lambda x: {}),
    "cylindrical": (2, lambda x: (turned(AXIS, x[0]), x[1] * AXIS), lambda x: {"angle": x[0], "displacement": x[1]}),
    "screw": (1, lambda x: (turned(AXIS, x[0]), PITCH / (2 * np.pi) * x[0] * AXIS),
              lambda x: {"angle": x[0], "displacement": PITCH / (2 * np.pi) * x[0]}),
    "universal": (2, lambda x: (turned(AXIS, x[0]) * turned(NORMAL, x[1]), np.zeros(3)),
                  lambda x: {"angle1": x[0], "angle2": x[1]}),
    "spherical": (3, lambda x: (Rotation.from_rotvec(x), np.zeros(3)), lambda x: {}),
    "planar": (3, lambda x: (turned(AXIS, x[0]), np.array([0.0, x[1], x[2]])), lambda x: {"angle": x[0]}),
    "rod": (5, lambda x: (Rotation.from_rotvec(x[:3]), LENGTH * (turned([0, 0, 1], x[3]) * turned(NORMAL, x[4])).apply(AXIS)),
            lambda x: {}),
    "slot": (4, lambda x: (Rotation.from_rotvec(x[:3]), x[3] * AXIS), lambda x: {"displacement": x[3]}),
}


MOTIONS["bearing"] = MOTIONS["revolute"]


def test_all_are_here():
    assert {*MOTIONS, "rolling", "sphere", "knife_edge"} == KINDS.keys()


def drawn(kind, rng, along=0.0):
    """A joint between two bodies, anywhere on them."""
    length = {"rod": LENGTH, "screw": PITCH / (2 * np.pi)}.get(kind, 0.0)
    return placed_anywhere(kind, (1, 2), rng)._replace(along=along, length=length)


def placed_anywhere(kind, ends, rng):
    return Joint(KINDS[kind].number, *ends, *rng.normal(size=(2, 3)).tolist(), random_frame(rng), random_frame(rng))


def placed(core, joint, first, rotation, way, angles=None):
    """Positions in which the first body is somewhere, and the frames of the joint are so to each other, with such turns."""
    at, R = first
    F1, F2 = (np.array(frame).T for frame in (joint.frame1, joint.frame2))
    second = R * Rotation.from_matrix(F1) * rotation * Rotation.from_matrix(F2).inv()
    point = at + R.apply(np.array(joint.point1) + F1 @ way)
    poses = [[*at, *R.as_quat(scalar_first=True)], [*(point - second.apply(joint.point2)), *second.as_quat(scalar_first=True)]]
    return core.state(np.array(poses), angles=angles)[0]


@pytest.mark.parametrize("kind", MOTIONS)
def test_it_leaves_its_motions_free_and_no_others(kind):
    rng = np.random.default_rng(7)
    count, motion, coordinates = MOTIONS[kind]
    for _ in range(5):
        joint = drawn(kind, rng)
        names = [name for name, _ in KINDS[kind].coordinates]
        read = [coordinate_quantity(joint, i, 0) for i in range(len(names))]
        core = SpaceCore(Tables([Body(1.0, (1.0, 1.0, 1.0))] * 2, [joint], read))
        first = rng.normal(size=3), Rotation.random(random_state=rng)
        for x in rng.uniform(-1.4, 1.4, size=(4, count)):
            p = placed(core, joint, first, *motion(x))
            terms = core.evaluate(0.0, p, np.zeros(core.nv))
            assert_close(terms["Phi"], np.zeros(core.m), 1e-14, scale=5.0)
            assert np.linalg.matrix_rank(terms["C"]) == core.m == 6 - count
            measured = {name: measure(core.tables.quantities[i], core, p) for i, name in enumerate(names)}
            assert measured == pytest.approx(coordinates(x), abs=1e-13)


def measure(quantity, core, p):
    """Value of a marker quantity, from a system with a measure of it."""
    reader = SpaceCore(core.tables._replace(quantities=[quantity], measures=[OutputSpec("it", "", "values", 0)]))
    return float(reader.measure_at(0, 0.0, p, np.zeros(core.nv))["value"][0])


@pytest.mark.parametrize("kind", MOTIONS)
def test_its_zero_is_along_the_axis(kind):
    """The displacement of a joint is zero in the reference configuration."""
    rng = np.random.default_rng(8)
    joint = drawn(kind, rng, along=0.0 if kind == "universal" else 0.25)
    core = SpaceCore(Tables([Body(1.0, (1.0, 1.0, 1.0))] * 2, [joint]))
    count, motion, _ = MOTIONS[kind]
    rotation, way = motion(rng.uniform(-1, 1, size=count))
    shift = 0.25 * AXIS if kind in ("prismatic", "cylindrical", "screw", "slot") else np.zeros(3)
    p = placed(core, joint, (rng.normal(size=3), Rotation.random(random_state=rng)), rotation, way + shift)
    assert_close(core.evaluate(0.0, p, np.zeros(core.nv))["Phi"], np.zeros(core.m), 1e-14, scale=5.0)


@pytest.mark.parametrize("turns", [0.9, 1.5, -3.3])
def test_a_screw_goes_on_through_all_turns(turns):
    rng = np.random.default_rng(9)
    joint = drawn("screw", rng)
    core = SpaceCore(Tables([Body(1.0, (1.0, 1.0, 1.0))] * 2, [joint]))
    p = placed(core, joint, (rng.normal(size=3), Rotation.random(random_state=rng)), *MOTIONS["screw"][1]([2 * np.pi * turns]),
               np.array([2 * np.pi * turns]))
    assert_close(core.evaluate(0.0, p, np.zeros(core.nv))["Phi"], np.zeros(5), 1e-14, scale=5.0)


@pytest.mark.parametrize("semiaxes", [(0.3, 0.3, 0.3), (0.0, 0.5, 0.5), (0.2, 0.3, 0.7)], ids=["sphere", "disc", "ellipsoid"])
def test_what_rolls_touches_and_does_not_slip(semiaxes):
    """Its point that is farthest against the normal lies in the plane; and the rows are the velocities of what is there."""
    rng = np.random.default_rng(10)
    for _ in range(5):
        joint = placed_anywhere("rolling", (1, 2), rng)._replace(semiaxes=semiaxes)
        core = SpaceCore(Tables([Body(1.0, (1.0, 1.0, 1.0))] * 2, [joint]))
        (first, R1), R2 = (rng.normal(size=3), Rotation.random(random_state=rng)), Rotation.random(random_state=rng)
        normal, *plane = R1.apply(joint.frame1)
        D = R2.apply(joint.frame2).T * semiaxes         # the ellipsoid is D x with x on the unit sphere
        contact = first + R1.apply(joint.point1) + rng.normal(size=2) @ plane
        centre = contact + D @ (D.T @ normal) / np.linalg.norm(D.T @ normal)
        second = centre - R2.apply(joint.point2)
        p = core.state(np.array([[*at, *R.as_quat(scalar_first=True)] for at, R in ((first, R1), (second, R2))]))[0]
        v = rng.normal(size=12)
        terms = core.evaluate(0.0, p, v)
        assert abs(terms["Phi"][0]) < 1e-14 * 5
        velocity = [own[:3] + np.cross(R.apply(own[3:]), contact - at)
                    for own, R, at in ((v[:6], R1, first), (v[6:], R2, second))]
        assert_close(terms["C"] @ v, np.array([normal, *plane]) @ (velocity[1] - velocity[0]), 1e-13)
        around = D @ (lambda x: x / np.linalg.norm(x, axis=0))(rng.normal(size=(3, 200)))
        assert ((centre - contact) @ normal + normal @ around > -1e-14).all()     # nothing of it is below the plane


def test_a_blade_glides_along_itself():
    rng = np.random.default_rng(11)
    joint = placed_anywhere("knife_edge", (0, 1), rng)
    core = SpaceCore(Tables([Body(1.0, (1.0, 1.0, 1.0))], [joint]))
    assert (core.mh, core.mn) == (0, 1)
    R = Rotation.random(random_state=rng)
    v = rng.normal(size=6)
    p = np.array([*rng.normal(size=3), *R.as_quat(scalar_first=True)])
    velocity = v[:3] + np.cross(R.apply(v[3:]), R.apply(joint.point2))
    assert_close(core.evaluate(0.0, p, v)["C"] @ v, R.apply(joint.frame2)[1:2] @ velocity, 1e-14)


def test_there_are_no_other_rows():
    assert lib.zd_space_joint_kind_of(-1) == lib.zd_space_joint_kind_of(lib.zd_space_joint_kinds()) == ffi.NULL
