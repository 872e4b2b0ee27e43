"""Mechanisms in space in joint coordinates: against absolute ones, and an independent model of bodies."""

import functools

import numpy as np
import pytest

import zerodrift as zd
from covering import spread
from mechanisms.plain_space import ON_GROUND, Compared, Plain
from mechanisms.test_in_space import four_bar
from support import FORMULATIONS, assert_close, refused

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
    """Trees and up to three loops, rolling and gliding; where rows are redundant, reactions are not determined."""
    m = moving(seed, 2 + seed % 4, seed % 4, [None, *ON_GROUND, "blade"][seed % 5])
    formulation = FORMULATIONS[seed % len(FORMULATIONS)]
    found = compared(m, formulation=formulation)
    unique = "no redundant constraints" in str(m)
    off = dict(differences(m, found, reactions=unique))
    assert max(off.values()) < SAME, max(off, key=off.get)
    assert found[0].system.nv < found[1].system.nv


@pytest.mark.parametrize(("seed", "on_ground"), spread([(64, None), (124, None), (844, None), (924, None), (299, "disc")], 2))
def test_redundant_constraints_do_not_hold_up_independent_coordinates(seed, on_ground):
    """Redundant constraints have nearly zero gradients here, so that their rounding is large in units of these."""
    case = Compared(seed, on_ground, loops=3, coordinates="joint")
    assert case.can_be
    assert max(case.accelerations("independent")) < NEAR
    assert case.motion("independent") < NEAR


# ---- cuts, roots and names ----

AT, AXIS, NORMAL = (0.3, 0.2, 0.1), (0.0, 0.6, 0.8), (1.0, 0.0, 0.0)
GIVEN = {"revolute": {"axis": AXIS}, "prismatic": {"axis": AXIS}, "cylindrical": {"axis": AXIS}, "planar": {"normal": AXIS},
         "screw": {"axis": AXIS, "pitch": 0.2}, "universal": {"axes": (AXIS, NORMAL)}, "spherical": {}}
OWN = {"revolute": 1, "prismatic": 1, "cylindrical": 2, "planar": 3, "screw": 1, "universal": 2, "spherical": 3}


def two_bodies(kind, **options):
    """A pendulum on a ball, and a body on it by the joint looked at."""
    m = zd.Mechanism("two", dimension=3, gravity=(0, 1, -9.81))
    arm, tool = m.body("arm", 1.0, (1, 2, 2), at=(0.5, 0, 0)), m.body("tool", 2.0, (1, 1.5, 2), at=(0.4, 0.3, 0.1))
    m.spherical("shoulder", m.ground, arm, at=(0, 0, 0))
    getattr(m, kind)("wrist", tool, arm, at=AT, **GIVEN[kind], **options)
    m.start({"arm.angular_velocity": (1.0, 0.5, -0.3)})
    return m


@pytest.mark.parametrize("kind", OWN)
def test_a_joint_is_in_the_tree_or_cut_by_its_user(kind):
    """Cut, it is rows; and the body that nothing else carries is free, or carries what it is joined to."""
    tree, cut = two_bodies(kind).system("joint"), two_bodies(kind, cut=True).system("joint")
    assert (tree.nv, tree.m) == (3 + OWN[kind], 0)
    assert (cut.nv, cut.m) == (3 + 6, 6 - OWN[kind])
    found = [zd.simulate(system, 0.02, step=1e-3) for system in (tree, cut)]
    assert max(off for _, off in differences(two_bodies(kind), found)) < SAME


@pytest.mark.parametrize(("kind", "rows"), [("weld", 6), ("slot", 2)])
def test_welds_and_slots_are_cut_too(kind, rows):
    """A tool that hangs on a ball, and what it is welded to, or a bead on its wire."""
    def made(**options):
        m = zd.Mechanism("two", dimension=3, gravity=(0, 1, -9.81))
        tool = m.body("tool", 2.0, (1, 1.5, 2), at=(0.4, 0.3, 0.1))
        m.spherical("shoulder", m.ground, tool, at=(0, 0, 0))
        if kind == "weld":
            m.weld("glue", tool, m.body("arm", 1.0, (1, 2, 2), at=(0.5, 0, 0)), at=AT, **options)
        else:
            m.slot("wire", tool, m.particle("bead", 0.3, at=AT), axis=AXIS, **options)
        m.start({"tool.angular_velocity": (1.0, 0.5, -0.3)})
        return m

    tree, cut = made().system("joint"), made(cut=True).system("joint")
    assert (tree.m, cut.m) == (0, rows)
    assert max(off for _, off in differences(made(), [zd.simulate(system, 0.02, step=1e-3) for system in (tree, cut)])) < SAME
    with refused("wrong-type", r"cut of '(glue|wire)' must be True or False, not 1"):
        made(cut=1)


def test_a_free_root_is_the_heaviest_body():
    m = zd.Mechanism("kite", dimension=3, gravity=(0, 0, -9.81))
    tail = m.body("tail", 1.0, (1, 1, 1), at=(1, 0, 0))
    m.revolute("hinge", tail, m.body("kite", 3.0, (1, 2, 3)), at=(0.5, 0, 0), axis=(0, 1, 0))
    m.particle("bird", 0.2, at=(0, 0, 3))
    system = m.system("joint")
    assert [name for name, _ in system.coordinates] == [
        "hinge.angle", "kite.x", "kite.y", "kite.z", "kite.e0", "kite.e1", "kite.e2", "kite.e3", "bird.x", "bird.y", "bird.z"]
    assert [name for name, _ in system.velocities] == [
        "hinge.speed", "kite.x_dot", "kite.y_dot", "kite.z_dot", "kite.x_spin", "kite.y_spin", "kite.z_spin",
        "bird.x_dot", "bird.y_dot", "bird.z_dot"]
    assert max(off for _, off in differences(m, compared(m))) < SAME


def test_names_of_coordinates_are_those_of_measures():
    system = two_bodies("planar").system("joint")
    assert [name for name, _ in system.coordinates] == [
        "shoulder.e0", "shoulder.e1", "shoulder.e2", "shoulder.e3", "wrist.along normal", "wrist.along third", "wrist.angle"]
    assert [name for name, _ in system.velocities] == [
        "shoulder.x_spin", "shoulder.y_spin", "shoulder.z_spin", "wrist.along normal_dot", "wrist.along third_dot", "wrist.speed"]
    sol = zd.simulate(two_bodies("cylindrical").system("joint"), 0.02, step=1e-3)
    for i, name in enumerate(("displacement", "angle")):
        np.testing.assert_allclose(sol[f"wrist.{name}"], sol.p[:, 4 + i], rtol=0, atol=1e-14)
        np.testing.assert_allclose(sol[f"wrist.{name}_speed"], sol.v[:, 3 + i], rtol=0, atol=1e-14)


def test_rows_between_welded_bodies_are_zero_to_the_last_bit():
    """So what closes a loop of welds is known to follow from nothing, however it is rounded."""
    m = two_bodies("revolute")
    m.weld("glue", "tool", m.body("tip", 1.0, (1, 1, 1), at=(1, 1, 1)), at=(1, 1, 0))
    m.spherical("again", "tip", "tool", at=(0.7, 0.6, 0.3), cut=True)
    system = m.system("joint")
    assert not system.evaluate().C.any()
    assert max(off for _, off in differences(m, compared(m), reactions=False)) < SAME


def test_what_is_welded_to_the_ground_does_not_move():
    m = zd.Mechanism("post", dimension=3)
    m.weld("foot", m.ground, m.body("post", 1.0, (1, 1, 1)), at=(0, 0, 0))
    with pytest.raises(zd.ZerodriftError, match="no joint coordinates to move in"):
        zd.simulate(m.system("joint"), 1.0, step=0.1)


def test_a_cut_is_yes_or_no():
    with refused("wrong-type", "'wrist'.*'yes'"):
        two_bodies("spherical", cut="yes")


# ---- angles ----


def crank_and_rocker():
    """Whose crank a torsion spring turns at a joint that closes the loop, so that the spring knows how often it went round."""
    m = zd.Mechanism("crank and rocker", dimension=3, gravity=(0, 0, -9.81))
    crank, rocker = m.link("crank", (0, 0, 0), (0, 0, 0.2), 1.0), m.link("rocker", (1, 0.1, 0), (1.1, 0.2, 0.7), 1.0)
    rod = m.link("rod", (0, 0, 0.2), (1.1, 0.2, 0.7), 0.5)
    m.revolute("A", m.ground, crank.start, axis=(0, 1, 0.1), cut=True)
    m.revolute("D", m.ground, rocker.start, axis=(0.2, 1, 0))
    m.spherical("B", crank.end, rod.start)
    m.universal("C", rod.end, rocker.end, axes=((0, 0, 1), (0, 1, 0)))
    m.torsion_spring("spring", "A", stiffness=0.3)
    m.start({"A.speed": 25.0})
    return m


def four_bar_of_revolutes():
    """In a plane of space: no coordinate but angles, of which that of the cut follows the others."""
    m = four_bar(np.eye(3))
    m.start({"A.speed": 15.0})
    return m


TURNS = {"quaternion": (crank_and_rocker, ("A.angle", "C.angle1")),
         "angles alone": (four_bar_of_revolutes, ("A.angle", "C.angle"))}
FINE = {"integrator": "dop853", "step": 5e-3}


@functools.cache
def in_absolute_coordinates(which):
    return zd.simulate(TURNS[which][0]().system("absolute"), 0.5, **FINE)


@pytest.mark.parametrize("which", TURNS)
def test_angles_of_cuts_count_turns(which, formulation):
    make, angles = TURNS[which]
    other = in_absolute_coordinates(which)
    sol = zd.simulate(make().system("joint"), 0.5, formulation=formulation, **FINE)
    assert (sol.system.m, sol.system.nq - sol.system.nv) == (5, 1 + (make is crank_and_rocker))
    assert np.abs(other["A.angle"]).max() > 2 * np.pi
    for name in angles:
        assert_close(sol[name], other[name], 1e-7)
