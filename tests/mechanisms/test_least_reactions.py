"""Least reactions of redundant constraints: the same for all coordinates, cuts of loops and orientations of the drawing."""

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import zerodrift as zd
from zerodrift._private.gateway import Record, Run
from zerodrift._private.gateway.mechanisms.blocks import BlockCore

JOINTS = "ABCD"
PLACES = np.array([(0.0, 0, 0), (0, 0.4, 0), (1.2, 0.9, 0), (1.0, 0, 0)])
LENGTH = max(np.linalg.norm(a - b) for a in PLACES for b in PLACES)


def four_bar(R, cut="C", load=0.0):
    """Planar four-bar of full hinges in the plane of the first two columns of R, whose loop is cut at a joint."""
    m = zd.Mechanism("four-bar", dimension=3, gravity=R @ (0.3, -9.81, load))
    places, normal = PLACES @ R.T, R[:, 2]
    crank, coupler, rocker = (m.link(name, places[i], places[i + 1], mass)
                              for i, (name, mass) in enumerate([("crank", 1.0), ("coupler", 2.0), ("rocker", 1.5)]))
    sides = {"A": (m.ground, crank.start), "B": (crank.end, coupler.start), "C": (coupler.end, rocker.start),
             "D": (m.ground, rocker.end)}
    for name, (first, second) in sides.items():
        m.revolute(name, first, second, axis=normal, cut=name == cut)
    return m


def wrenches(sol, R):
    """Forces and torques (k, 4, 6) of the joints in the axes of the mechanism's plane."""
    return np.stack([np.hstack([sol[f"{name}.force"] @ R, sol[f"{name}.torque"] @ R]) for name in JOINTS], axis=1)


def rotation(seed):
    return Rotation.from_rotvec(np.random.default_rng(seed).standard_normal(3)).as_matrix() if seed else np.eye(3)


def run(m, coordinates):
    return zd.simulate(m.system(coordinates), 0.05, step=0.01)


@pytest.mark.parametrize("load", [0.0, 2.0])
def test_reactions_depend_neither_on_coordinates_nor_on_cuts_nor_on_the_axes_of_the_drawing(load):
    want = wrenches(run(four_bar(np.eye(3), load=load), "absolute"), np.eye(3))
    for seed, (cut, coordinates) in enumerate(itertools.product("BCD", ("joint", "absolute"))):
        R = rotation(seed)
        got = wrenches(run(four_bar(R, cut, load), coordinates), R)
        np.testing.assert_allclose(got, want, rtol=0, atol=1e-9 * np.abs(want).max())
    if not load:
        assert np.abs(want[:, :, 2:5]).max() < 1e-9


def self_stresses():
    """Basis (s, 24) of weighted wrenches in balance with each other on the drawn four-bar, from the balances of its bodies."""
    ends = {"crank": [(0, 1), (1, -1)], "coupler": [(1, 1), (2, -1)], "rocker": [(2, 1), (3, 1)]}
    rows = []
    for joints in ends.values():
        forces, moments = np.zeros((3, 4, 6)), np.zeros((3, 4, 6))
        for joint, sign in joints:
            x, y, z = PLACES[joint]
            forces[:, joint, :3] = sign * np.eye(3)
            moments[:, joint, :3] = sign * np.array([(0, -z, y), (z, 0, -x), (-y, x, 0)])
            moments[:, joint, 3:] = sign * LENGTH * np.eye(3)
        rows += [*forces.reshape(3, 24), *moments.reshape(3, 24)]
    about_axes = np.zeros((4, 4, 6))
    about_axes[range(4), range(4), 5] = 1
    A = np.vstack([*rows, about_axes.reshape(4, 24)])
    _u, s, V = np.linalg.svd(A)
    return V[(s > 1e-9 * s[0]).sum():]


def test_no_self_stress_is_in_the_least_reactions():
    stresses = self_stresses()
    assert len(stresses) == 3
    for coordinates in ("joint", "absolute"):
        found = wrenches(run(four_bar(np.eye(3), load=2.0), coordinates), np.eye(3))[0]
        found[:, 3:] /= LENGTH
        assert np.abs(stresses @ found.ravel()).max() < 1e-9 * np.abs(found).max()


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
@pytest.mark.parametrize("turn", [0.0, 0.7, 2.1])
def test_a_beam_on_three_hinges(turn, coordinates):
    """Forces across the beam are W (1/3 + (x - 1) (c - 1) / 2) at x = 0, 1, 2 m, of a centre of mass at c."""
    along, across = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
    for order in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        m = zd.Mechanism("beam", gravity=-9.81 * across)
        beam = m.body("beam", 2.0, 0.3, at=0.7 * along)
        for x in order:
            m.revolute(f"hinge {x}", m.ground, beam, at=x * along)
        sol = run(m, coordinates)
        for x in range(3):
            want = 2.0 * 9.81 * (1 / 3 + (x - 1) * (0.7 - 1) / 2) * across
            np.testing.assert_allclose(sol[f"hinge {x}.force"], np.tile(want, (len(sol.t), 1)), rtol=0, atol=1e-9 * 20)


def test_two_hinges_in_line_share_a_load_to_one_side():
    for coordinates in ("joint", "absolute"):
        m = zd.Mechanism("door", dimension=3, gravity=(0, 0, -9.81))
        frame = m.body("frame", 2.0, (0.1, 0.1, 0.1), at=(0, 0, -0.5))
        lump = m.body("lump", 3.0, (0.01, 0.01, 0.01), at=(0.3, 0, -1))
        m.weld("fix", frame, lump, at=(0.3, 0, -1))
        for name, x in (("left", -0.5), ("right", 0.5)):
            m.revolute(name, m.ground, frame, at=(x, 0, 0), axis=(1, 0, 0))
        sol = run(m, coordinates)
        # F and -F besides W / 2, and equal moments M: F d + 2 M = 3 g 0.3 in total, with F^2 + (M / L)^2 least
        d, L, moment = 1.0, np.hypot(0.8, 1.0), 3 * 9.81 * 0.3
        ratio = 2 * L**2 / d        # M / F of the least sum 2 F^2 + 2 (M / L)^2 on the line F d + 2 M = moment
        F = moment / (d + 2 * ratio)
        np.testing.assert_allclose(sol["left.force"][0], (0, 0, 2.5 * 9.81 - F), rtol=0, atol=1e-8)
        np.testing.assert_allclose(sol["right.force"][0], (0, 0, 2.5 * 9.81 + F), rtol=0, atol=1e-8)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_components_along_the_axes_of_a_body_are_unique_or_not(seed):
    for coordinates in ("joint", "absolute"):
        R = rotation(seed)
        sol = run(four_bar(R), coordinates)
        in_plane = [bool(abs(axis[2]) < 1e-6) for axis in R]
        assert sol.unique("C.force").tolist() == in_plane
        of_body = sol["coupler.rotation"][0].T @ R[:, 2]
        assert sol.unique("C.force", "coupler").tolist() == [bool(abs(each) < 1e-6) for each in of_body]


def test_a_block_has_the_reactions_of_its_mechanism():
    names = ["A.force", "C.torque"]
    for coordinates in ("joint", "absolute"):
        system = four_bar(np.eye(3), load=2.0).system(coordinates)
        sol = zd.simulate(system, 0.1, step=0.01, vector="baseline", outputs=names)
        core = BlockCore(zd.block(system, step=0.01, outputs=names))
        options = core.settings
        options.t1 = 0.1
        record = Record(core, 20, type("Width", (), {"width": 6}))
        assert Run(core, options, *core.start).advance(record, 1e3) == 0
        np.testing.assert_array_equal(record.take()["outputs"], np.column_stack([sol[name] for name in names]))


def blocks(dimension, masses, **constraints):
    """Blocks on guides along x, at distances of 1 m, with own constraints of their heights."""
    up = (0, 1, 0)[:dimension]
    m = zd.Mechanism("blocks", dimension=dimension, gravity=-10.0 * np.array(up))
    of = {}
    for i, mass in enumerate(masses):
        at = (float(i), 0, 0)[:dimension]
        body = m.body(f"b{i}", mass, 0.1 if dimension == 2 else (0.1, 0.1, 0.1), at=at)
        m.prismatic(f"guide{i}", m.ground, body, at=at, axis=(1, 0, 0)[:dimension])
        of[f"y{i}"] = f"b{i}.position.y"
    for name, value in constraints.items():
        m.constraint(name, value, of={each: of[each] for each in value.__code__.co_varnames if each != "k"})
    return m


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_own_constraints_count_with_the_largest_force_on_a_body(dimension, coordinates):
    for factor in (1.0, 3.0):
        sol = run(blocks(dimension, [2.0], hold=lambda y0, k=factor: k * y0), coordinates)
        np.testing.assert_allclose(sol["guide0.force.y"], 10.0, rtol=0, atol=1e-9)
        # (W0 - 2 z)^2 + (W1 + z)^2 + (2 z)^2 is least at z = (4 W0 - 2 W1) / 18, whatever the factor
        sol = run(blocks(dimension, [2.0, 5.0], gear=lambda y0, y1, k=factor: k * (2 * y0 - y1)), coordinates)
        z = (4 * 20.0 - 2 * 50.0) / 18
        np.testing.assert_allclose(sol["guide0.force.y"], 20.0 - 2 * z, rtol=0, atol=1e-9)
        np.testing.assert_allclose(sol["guide1.force.y"], 50.0 + z, rtol=0, atol=1e-9)
        assert not sol.unique("guide0.force.y")
        assert sol.unique("guide0.force.x")


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_own_constraints_count_with_the_largest_moment_about_the_mass_centre(coordinates):
    """F + z = W and T + r z = 0 with F^2 + T^2 + z^2 (1 + r^2) least, as L is 1 m with one joint."""
    m, r = blocks(2, [2.0]), 0.5
    tip = m["b0"].point((r, 0), name="tip")
    m.constraint("hold", lambda y: y, of={"y": tip.position.y})
    sol, z = run(m, coordinates), 20.0 / (2 + 2 * r**2)
    np.testing.assert_allclose(sol["guide0.force.y"], 20.0 - z, rtol=0, atol=1e-9)
    np.testing.assert_allclose(sol["guide0.torque"], -r * z, rtol=0, atol=1e-9)


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_given_torques_at_a_joint_do_not_count(coordinates):
    """Two motors that prescribe one angle share its torque, although the first joint has damping, too."""
    m = zd.Mechanism("shaft", dimension=3)
    shaft = m.body("shaft", 1.0, (0.1, 0.1, 0.1), at=(0, 0, 0))
    for name, z, damping in (("left", 0.0, 5.0), ("right", 1.0, 0.0)):
        m.revolute(name, m.ground, shaft, at=(0, 0, z), axis=(0, 0, 1), damping=damping)
        m.motor(f"m {name}", name, angle=lambda t: 0.5 * t**2)
    sol = run(m, coordinates)
    for name in ("m left.torque", "m right.torque"):
        np.testing.assert_allclose(sol[name], (0.1 + 5.0 * sol.t) / 2, rtol=0, atol=1e-9)


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_all_ways_to_read_a_reaction_give_the_same(coordinates):
    system = four_bar(rotation(5), load=2.0).system(coordinates)
    names = ["A.force", "C.torque"]
    sol = zd.simulate(system, 0.02, step=0.01, outputs=names)
    bare = zd.simulate(system, 0.02, step=0.01)
    compiled = zd.simulate(four_bar(rotation(5), load=2.0).system(coordinates, compiled=True), 0.02, step=0.01, outputs=names)
    ens = zd.ensemble(system, 0.02, parameters={"crank.mass": [1.0, 1.0]}, step=0.01, outputs=names)
    run = zd.Run(system, step=0.01)
    run.step(2)
    many = zd.ManyRuns(system, runs=2, step=0.01)
    many.step(2)
    now = zd.Instant(system, sol.t[-1], sol.p[-1], sol.v[-1])
    load = zd.Event("A.force.z", value=float(sol["A.force.z"].mean()), terminal=True)
    at_event = zd.simulate(system, 0.02, step=0.01, events=load)
    assert abs(at_event["A.force.z"][-1] - load.value) < 1e-9 * np.abs(sol["A.force"]).max()
    for name in names:
        bound = 1e-9 * np.abs(sol[name]).max()
        np.testing.assert_allclose(bare[name], sol[name], rtol=0, atol=bound)
        np.testing.assert_allclose(compiled[name], sol[name], rtol=0, atol=bound)
        np.testing.assert_allclose(many[name][1], sol[name][-1], rtol=0, atol=bound)
        np.testing.assert_allclose(run[name], sol[name][-1], rtol=0, atol=bound)
        np.testing.assert_allclose(ens[name][1], sol[name], rtol=0, atol=bound)
        np.testing.assert_allclose(now[name], sol[name][-1], rtol=0, atol=bound)


def test_beyond_200_constraints_the_multipliers_of_the_motion_are_reported():
    """A chain of 100 links on a doubled hinge: each half of it carries half, as the two have one effect."""
    m = zd.Mechanism("chain", gravity=(0, -9.81))
    side = m.ground.point((0, 0))
    for i in range(100):
        link = m.link(f"link{i}", (i * 0.1, 0), ((i + 1) * 0.1, 0), mass=0.01)
        m.revolute(f"pin{i}", side, link.start)
        if not i:
            m.revolute("double", side, link.start)
        side = link.end
    sol = run(m, "absolute")
    assert sol.system.m == 202
    np.testing.assert_allclose(sol["double.force"], sol["pin0.force"], rtol=0, atol=1e-8)
    assert not sol.unique("double.force.y")
    assert sol.unique("pin1.force.y")


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
@pytest.mark.parametrize("start", [zd.Run, lambda system, step: zd.simulate(system, 0.02, step=step)])
def test_laws_must_read_reactions_that_are_unique(start, coordinates):
    m = four_bar(np.eye(3))
    m.motor("friction", "A", torque=lambda N: -0.01 * N, of={"N": "C.force.x"})
    assert start(m.system(coordinates), step=0.01)
    m = four_bar(rotation(1))
    m.motor("friction", "A", torque=lambda N: -0.01 * N, of={"N": "C.force.x"})
    with pytest.raises(ValueError, match=r"torque of motor 'friction' must .*'C.force.x' is not.*not-unique"):
        start(m.system(coordinates), step=0.01)
