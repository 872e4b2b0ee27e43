"""Assembly: from sketches to closed positions, with what is held and wished; what cannot be is named."""

import warnings

import numpy as np
import pytest

import zerodrift as zd
from mechanisms import known
from support import refused


def linkage(lengths=(0.8, 2.2, 1.1), ground=2.0):
    """A four-bar from a sketch: crank, coupler and rocker of these lengths, in all of one kilogram each."""
    m = zd.Mechanism("linkage", gravity=(0, -9.81))
    a = m.link("crank", (0, 0), (0.1, 0.9), mass=1.0, length=lengths[0])
    b = m.link("coupler", (0.1, 0.9), (2.1, 1.2), mass=1.0, length=lengths[1])
    c = m.link("rocker", (2.1, 1.2), (ground, 0), mass=1.0, length=lengths[2])
    m.revolute("A", m.ground, a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.start)
    m.revolute("D", c.end, m.ground.point((ground, 0)))
    return m


def violation(system, t=0.0):
    e = system.evaluate(*system.start_at(t), t)
    phi_t = 0.0 if e.Phi_t is None else e.Phi_t
    return np.abs(e.Phi).max(), np.abs(e.C @ system.start_at(t)[1] + phi_t).max()


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_lengths_override_the_drawing(layout):
    system = linkage().system(layout)
    assert max(violation(system)) < 1e-14


def test_both_coordinates_start_from_the_same_state():
    m = linkage()
    m.start({"crank.angular_velocity": 1.0}, wish={"rocker.angle": 4.9})
    poses = [system._core.poses(system.p0, system.v0) for system in (m.system("joint"), m.system("absolute"))]
    np.testing.assert_allclose(poses[0], poses[1], atol=1e-13)


def test_an_assembled_mechanism_is_not_moved():
    m, again = linkage(), zd.Mechanism("again")
    poses, _ = m.system()._core.poses(m.system().p0)
    bodies = [again.body(f"b{i}", 1.0, 0.1, at=pose[:2], angle=pose[2]) for i, pose in enumerate(poses)]
    again.revolute("A", again.ground, bodies[0].point(at=(0, 0)))
    again.revolute("B", bodies[0].point((0.4, 0)), bodies[1].point((-1.1, 0)))
    again.revolute("C", bodies[1].point((1.1, 0)), bodies[2].point((-0.55, 0)))
    again.revolute("D", bodies[2].point((0.55, 0)), again.ground.point((2, 0)))
    moved = again.system("absolute").p0.reshape(-1, 3) - poses
    assert np.abs(moved).max() < 1e-14


def test_the_closed_position_is_that_nearest_to_the_drawing():
    """In the mass metric: no free direction leads nearer, to the order of the steps that were looked at."""
    system = linkage().system("absolute")
    start = system._start
    assembly, p = start.assembled(0.0)
    drawn = start._tables({}).drawn().ravel()
    M, free = assembly.free_motions(p)
    downhill = free.T @ M @ ((p - drawn) / assembly.scale)
    assert np.abs(downhill).max() < 1e-2 * np.linalg.norm(M @ ((p - drawn) / assembly.scale))


def test_a_loop_that_cannot_close_is_named_with_what_stays_open():
    """Links of 1, 0.5 and 0.25 m between pins that are 2 m apart: 0.25 m are missing."""
    with pytest.raises(zd.CorrectionFailed, match=r"the loop of ground, crank, coupler, rocker, through A, B, C, D, "
                                                  r"cannot close: it stays open by 0.25 m at 'C'"):
        _ = linkage((1.0, 0.5, 0.25)).system().p0
    assert "it cannot start: the loop of ground, crank, coupler, rocker" in str(linkage((1.0, 0.5, 0.25)))


def test_the_loop_that_is_named_is_the_one_that_is_open():
    m = linkage()
    a = m.link("left", (5, 0), (5, 1), mass=1.0)
    b = m.link("right", (6, 0), (5, 1), mass=1.0, length=0.2, inertia=0.1)
    m.revolute("P", m.ground, a.start)
    m.revolute("Q", m.ground, b.start)
    m.revolute("R", a.end, b.end)
    m.rod("rod", m.ground.point((7, 0)), b.point((0, 0)), length=4.0)
    with pytest.raises(zd.CorrectionFailed, match="the loop of ground, right, through Q, rod, cannot close"):
        _ = m.system().p0


def test_where_each_loop_could_close_alone_the_joints_are_named():
    """Rods of 1, 0.5 and 0.25 m between pins that are 2 m apart: a twelfth of a metre is left to each at the least squares."""
    m = zd.Mechanism("rods")
    a, b = m.particle("a", 1.0, (0, 1)), m.particle("b", 1.0, (2, 1))
    m.rod("P", m.ground.point((0, 0)), a, length=1.0)
    m.rod("Q", a, b, length=0.5)
    m.rod("R", b, m.ground.point((2, 0)), length=0.25)
    with pytest.raises(zd.CorrectionFailed, match=r"cannot all close: .* open 'P' by 0\.0833, 'Q' by 0\.0833, 'R' by 0\.0833"):
        _ = m.system().p0


# ---- what is held and wished ----


@pytest.mark.parametrize("angle", [0.3, 1.2, 2.5])
def test_what_is_held_is_met(angle):
    m = linkage()
    m.start({"crank.angle": angle, "crank.angular_velocity": 2.0})
    system = m.system()
    assert max(violation(system)) < 1e-13
    np.testing.assert_allclose((system.p0[0], system.v0[0]), (angle, 2.0), rtol=1e-13)


def test_vectors_and_points_are_held_in_the_drawings_axes():
    m = zd.Mechanism("free")
    m.link("link", (0, 0), (1, 0), mass=1.0)
    m.start({"link.end.position": (3.0, 4.0), "link.end.velocity.x": 2.0, "link.angle": 0.5})
    sol = zd.simulate(m, 0.1, step=0.1)
    np.testing.assert_allclose(sol["link.end.position"][0], (3.0, 4.0), atol=1e-13)
    np.testing.assert_allclose(sol["link.end.velocity"][0, 0], 2.0, atol=1e-13)


def test_large_angles_are_reached_by_turning_and_count_turns():
    m = zd.Mechanism("pendulum")
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, link.start)
    m.start({pin.angle: 9.0})
    assert m.system().p0[0] == pytest.approx(9.0, rel=1e-14)


def test_what_cannot_be_held_is_named_with_what_remains():
    m = linkage()
    m.start({"coupler.end.position": (9.0, 0.0)})
    with pytest.raises(zd.InconsistentStart, match=r"cannot be met together; the nearest positions miss "
                                                   r"'coupler.end.position.x' by 6\.\d+ m, .* by 0\.\d+ m; "
                                                   r"in the loop of ground, crank, coupler, rocker, through A, B, C, D \[zd"):
        _ = m.system().p0


def test_velocities_that_contradict_each_other_are_named():
    m = linkage()
    m.start({"crank.angular_velocity": 1.0, "rocker.angular_velocity": -3.0})
    with pytest.raises(zd.InconsistentStart, match=r"start: the velocities of '(crank|rocker).angular_velocity' and "
                                                   r"'(crank|rocker).angular_velocity' contradict each other.* wish={'"):
        _ = m.system().p0


def test_joints_that_block_a_drive_are_named():
    """A slot keeps a bar on a pin from turning, and a motor is to turn it; the joint of another body has no part in it."""
    m = zd.Mechanism("blocked")
    bar, free = (m.body(name, 1.0, 1.0, at=(0, 0)) for name in ("bar", "free"))
    pin = m.revolute("pin", m.ground, bar, at=(0, 0))
    m.revolute("hook", m.ground, free, at=(0, 1))
    m.slot("stop", m.ground, bar.point(at=(2, 0)), axis=(1, 0))
    m.motor("drive", pin, angle=lambda t: 0.3 * np.sin(4 * t))
    with pytest.raises(zd.InconsistentStart, match=r"'drive' asks for a velocity that the joints 'pin', 'stop' do not allow in "
                                                   r"this pose; it is off by 1\.2\. At a dead centre, start a little aside"):
        zd.simulate(m, 0.1, step=0.01)      # the law's rate at t = 0 is 0.3 times 4, and the joints leave none


def test_what_is_welded_has_no_joint_coordinates():
    m = zd.Mechanism("bracket", gravity=(0, -9.81))
    m.weld("bolt", m.ground, m.body("plate", 2.0, 0.1, at=(0.5, 0)), at=(0, 0))
    with pytest.raises(zd.ZerodriftError, match="mechanism 'bracket' has no joint coordinates to move in"):
        zd.simulate(m.system("joint"), 0.1, step=0.05)
    assert "a simulation takes absolute coordinates" in str(m)
    with warnings.catch_warnings():
        warnings.simplefilter("error")      # the energy of what is at rest is rounding
        sol = zd.simulate(m, 0.1, step=0.01)
    assert np.allclose(sol["bolt.force"], [0.0, 2.0 * 9.81], atol=1e-12)
    assert np.allclose(sol["bolt.torque"], 2.0 * 9.81 * 0.5, atol=1e-12)     # about the bolt, half a metre from the centre


def test_joints_between_what_is_welded_have_no_coordinates_to_move_in():
    """The planar joint's angle is a coordinate, but has no velocity."""
    m = zd.Mechanism("bracket", dimension=3)
    plate = m.body("plate", 2.0, (0.1, 0.1, 0.1), at=(0.5, 0, 0))
    m.weld("bolt", m.ground, plate, at=(0, 0, 0))
    m.planar("plane", m.ground, plate, at=(0, 0, 0), normal=(0, 0, 1))
    with pytest.raises(zd.ZerodriftError, match="mechanism 'bracket' has no joint coordinates to move in"):
        zd.simulate(m.system("joint"), 0.1, step=0.05)


def test_held_values_that_agree_are_accepted():
    m = linkage()
    m.start({"crank.angular_velocity": 1.0})
    v = m.system().v0
    m.start({"rocker.angular_velocity": v[2], "A.speed": 1.0})
    np.testing.assert_allclose(m.system().v0, v, atol=1e-9)


def test_a_start_against_a_drive_is_named():
    m = linkage()
    m.motor("drive", m["A"], angle=lambda t: 0.1 * np.sin(t))
    m.start({"crank.angle": 3.0})
    with pytest.raises(zd.InconsistentStart, match=r"'crank.angle'.*'drive'|'drive'.*'crank.angle'"):
        _ = m.system().p0


def test_wishes_are_met_as_nearly_as_possible():
    m = linkage()
    m.start(wish={"rocker.angle": 100.0})
    far = m.system().p0[2]
    for angle in (far - 1e-3, far + 1e-3):
        m.start({"rocker.angle": angle}, wish={"rocker.angle": None})
        if angle > far:
            with pytest.raises(zd.InconsistentStart):
                _ = m.system().p0
        else:
            assert max(violation(m.system())) < 1e-13
    m.start({"rocker.angle": None}, wish={"crank.angular_velocity": 1.5})
    assert m.system().v0[0] == pytest.approx(1.5, rel=1e-9)


def test_assemble_takes_positions_and_velocities_of_a_mechanism():
    m = linkage()
    p, v = zd.assemble(m, {"crank.angle": 1.0, "crank.angular_velocity": 2.0}, wish={"rocker.angle": 4.0})
    np.testing.assert_allclose((p[0], v[0]), (1.0, 2.0), rtol=1e-12)
    with refused("wrong-type", "p of a mechanism must be a dict of values by measure"):
        zd.assemble(m, [1.0, 2.0, 3.0])
    with refused("conflicting-arguments", "four_bar"):
        zd.assemble(zd.systems.four_bar(), zd.systems.four_bar().p0, nudge=True)
    with refused("wrong-type", "four_bar"):
        zd.assemble(zd.systems.four_bar(), {"alpha1": 1.0})


# ---- drives ----


def test_a_drive_of_constant_speed_starts_where_the_start_has_it():
    m = linkage()
    m.motor("drive", m["A"], speed=2.0)
    m.start({"crank.angle": 1.2})
    np.testing.assert_allclose(m.system().start_at(0.5)[0][0], 1.2 + 2.0 * 0.5, rtol=1e-13)
    sol = zd.simulate(m, (0.5, 1.0), step=0.01)
    np.testing.assert_allclose(sol["crank.angle"], 1.2 + 2.0 * sol.t, rtol=1e-12)


def test_a_law_of_the_angle_starts_at_its_own_time():
    m = linkage()
    m.motor("drive", m["A"], angle=lambda t: 0.3 * np.sin(2 * t))
    sol = zd.simulate(m, (0.25, 0.75), step=0.01)
    np.testing.assert_allclose(sol["A.angle"], 0.3 * np.sin(2 * sol.t), atol=1e-12)
    np.testing.assert_allclose(sol["A.speed"], 0.6 * np.cos(2 * sol.t), atol=1e-12)


def test_with_parameters_assembles_again():
    system = linkage().with_parameters({"coupler.length": 2.2, "rocker.length": 1.3})
    assert max(violation(system)) < 1e-14
    sol = zd.simulate(system, 0.1, step=0.01)
    np.testing.assert_allclose(np.hypot(*(sol["coupler.end.position"] - sol["coupler.start.position"]).T), 2.2, rtol=1e-12)


# ---- what has no mass ----


def test_massless_bodies_that_nothing_holds_are_named():
    m = zd.Mechanism("loose")
    a, b = m.link("a", (0, 0), (1, 0), mass=1.0), m.link("b", (1, 0), (2, 0))
    m.revolute("A", m.ground, a.start)
    m.revolute("B", a.end, b.start)
    with pytest.raises(zd.SingularSystem, match="'b' can move without moving any mass: give it mass and inertia"):
        _ = m.system().p0


def test_massless_links_may_be_held_by_loops():
    m = linkage()
    system = m.with_parameters({"coupler.mass": 0.0, "coupler.inertia": 0.0})
    sol = zd.simulate(system, 0.5, step=1e-3, formulation="augmented")
    assert np.ptp(sol.kinetic_energy + sol.potential_energy) < 1e-8


# ---- counting ----


def parallelogram(arms=3):
    m = zd.Mechanism("parallelogram")
    bar = m.link("bar", (0, 1), (2, 1), mass=2.0)
    for i in range(arms):
        arm = m.link(f"arm{i}", (i, 0), (i, 1), mass=1.0)
        m.revolute(f"P{i}", m.ground, arm.start)
        m.revolute(f"Q{i}", arm.end, bar)
    return m


def test_what_print_says_of_the_papers_four_bar():
    first, second, *rest = str(known.four_bar()).splitlines()
    assert first == "<Mechanism four_bar: plane, 3 bodies, 4 joints; no forces but gravity (0, -9.81)>"
    assert second == (" freedom 1 (Gruebler 1); joint coordinates 3, 2 constraints closing 1 loop at C; "
                      "absolute 9, 8 constraints; no redundant constraints")
    assert [line.partition(":")[0] for line in rest] == [       # its links are drawn by rounded lengths
        " drawn open, and closed at the start (m, or rad)", " moved from the drawing", " a simulation takes joint coordinates"]
    assert repr(known.four_bar()) == first


def test_what_print_says_of_drives():
    text = str(known.slider_crank())
    assert "freedom 0 (Gruebler 0)" in text
    assert "driven: main by drive (speed)" in text


def test_redundant_rows_are_named_by_joint():
    text = str(parallelogram())
    assert "freedom 1 (Gruebler 0)" in text
    assert "1 of 12 constraints is redundant: Q2.y" in text
    assert "reactions not determined: P0.y, Q0.y, P1.y, Q1.y, P2.y, Q2.y" in text
    assert "singular" not in text


def test_a_drawing_that_is_singular_is_distinguished_from_redundancy():
    """A four-bar stretched along a line: one row is redundant there, and nowhere near."""
    m = zd.Mechanism("flat", gravity=(0, -1))
    a, b, c = m.link("a", (0, 0), (1, 0), 1.0), m.link("b", (1, 0), (3, 0), 1.0), m.link("c", (3, 0), (4, 0), 1.0)
    for name, first, second in (("A", m.ground, a.start), ("B", a.end, b.start), ("C", b.end, c.start)):
        m.revolute(name, first, second)
    m.revolute("D", c.end, m.ground.point((4, 0)))
    text = str(m)
    assert "no redundant constraints" in text
    assert "a singular pose: D.x is redundant as drawn, and not nearby" in text


def test_reactions_that_are_not_determined_are_not_unique():
    m = parallelogram()
    m.start({"arm0.angular_velocity": 1.0})
    sols = [zd.simulate(m.system(layout), 0.3, step=0.01) for layout in ("joint", "absolute")]
    for sol in sols:
        assert not sol.unique("P0.force.y")
        assert sol.unique("bar.position").all()
        assert sol.unique("arm0.angle") is True
        with pytest.raises(KeyError):
            sol.unique("colour")
    total = [sum(sol[f"P{i}.force"] for i in range(3)) for sol in sols]
    np.testing.assert_allclose(*total, atol=1e-9)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_massless_link_in_a_loop_is_named(layout):
    m = zd.Mechanism("four-bar", gravity=(0, -9.81))
    links = [m.link("crank", (0, 0), (0, 0.3), mass=1.5), m.link("coupler", (0, 0.3), (0.9, 0.6)),
             m.link("rocker", (0.9, 0.6), (1, 0), mass=3.0)]
    for name, first, second in (("A", m.ground, links[0].start), ("B", links[0].end, links[1].start),
                                ("C", links[1].end, links[2].start), ("D", links[2].end, m.ground.point((1, 0)))):
        m.revolute(name, first, second)
    with pytest.raises(zd.SingularSystem, match=r"; 'coupler' has no mass or no inertia: give some, or take formulation="):
        zd.simulate(m.system(layout), 0.1, step=0.01, formulation="schur")
    assert zd.simulate(m.system(layout), 0.1, step=0.01, formulation="augmented").success


def test_joints_that_do_not_let_a_held_velocity_be_are_named():
    """Two links that have to be stretched, so that they cannot turn."""
    m = zd.Mechanism("stretched")
    first, second = (m.link(name, (x, y), (x + 1, 0.3 - y), mass=1.0, length=1.0)
                     for name, x, y in (("a", 0, 0), ("b", 1, 0.3)))
    m.revolute("A", m.ground, first.start)
    m.revolute("B", first.end, second.start)
    m.revolute("C", second.end, m.ground.point((2, 0)))
    m.start({first.angular_velocity: 1.0})
    with pytest.raises(zd.InconsistentStart, match=r"'a\.angular_velocity' asks for .* that the joints '[ABC]'.* do not allow"):
        zd.assemble(m)


def test_angles_in_degrees_are_noticed_where_they_cannot_be_met():
    m = linkage()
    m.start({"rocker.angle": 180.0, "crank.angle": 0.1})
    with pytest.raises(zd.InconsistentStart, match=r"Angles are in rad: 180 degrees are 3\.142; in the loop of ground, crank"):
        zd.assemble(m)


def test_a_system_of_a_mechanism_is_assembled_as_the_mechanism_is():
    m = linkage()
    for mine, its in zip(zd.assemble(m.system("absolute")), m.system("absolute").start_at(0.0), strict=True):
        assert np.array_equal(mine, its)


def slider_crank(angle, **drive):
    m = zd.Mechanism("slider-crank")
    tip = 0.1 * np.array([np.cos(angle), np.sin(angle)])
    pin = (tip[0] + np.sqrt(0.09 - tip[1]**2), 0.0)
    crank, rod = m.link("crank", (0, 0), tip, mass=0.5), m.link("rod", tip, pin, mass=0.3)
    piston = m.body("piston", 0.4, 0.1, at=pin)
    m.revolute("main", m.ground, crank.start)
    m.revolute("crank pin", crank.end, rod.start)
    m.revolute("wrist", rod.end, piston.point((0, 0)))
    m.motor("drive", m.prismatic("slide", m.ground, piston, axis=(1, 0)), **drive)
    return m


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_motor_that_comes_to_a_dead_centre_is_named(layout):
    """The slide cannot go further than crank and rod in line, 0.4 m."""
    with pytest.raises(zd.ZerodriftError) as caught:
        zd.simulate(slider_crank(0.5, speed=1.0).system(layout), 1.0, step=1e-3)
    assert caught.value.solution["wrist.force"].shape[1] == 2
    assert "'drive' must not drive the mechanism beyond its reach" in str(caught.value)


def test_no_dead_centre_is_named_for_what_fails_elsewhere():
    m = slider_crank(0.5, speed=lambda t: 0.1 / (0.05 - t))     # no number at t = 0.05
    with pytest.raises((zd.ZerodriftError, ZeroDivisionError)) as caught:
        zd.simulate(m, 0.01, step=1e-3, max_steps=None, events=lambda t, p, v: 1 / (t - 0.002))
    assert not any("dead centre" in note for note in getattr(caught.value, "__notes__", ()))


def test_at_a_dead_centre_a_drive_is_refused_with_the_names_of_rows_and_what_helps():
    with pytest.raises(zd.InconsistentStart, match=r"'drive' asks for a velocity .* At a dead centre, start a little aside"):
        zd.simulate(slider_crank(0.0, speed=-0.1), 0.1, step=1e-3)
    with pytest.raises(zd.SingularSystem, match=r"row 2 'drive' .*; in this pose 'slider-crank' is singular, as links in "
                                                "line are: start a little aside, or drive another joint"):
        zd.simulate(slider_crank(0.0, displacement=lambda t: -0.1 * t * t), 0.1, step=1e-3)


def test_a_flat_parallelogram_is_reported_by_the_names_of_its_rows_and_starts_beside():
    m = zd.Mechanism("parallelogram", gravity=(0, -9.81))
    a, b, c = (m.link(name, (x, 0), (x + length, 0), mass=1.0) for name, x, length in (("a", 0, 1), ("b", 1, 2), ("c", 2, 1)))
    m.revolute("A", m.ground, a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    m.revolute("D", c.start, m.ground.point((2, 0)))
    with pytest.raises(zd.Bifurcation, match=r"row \d '[CD].x' .*; in this pose 'parallelogram' is singular, .* nudge=True"):
        zd.simulate(m, 0.1, step=1e-3)
    p, v = zd.assemble(m, nudge=True)
    assert zd.simulate(m.system("joint"), 0.1, p, v, step=1e-3).success


def test_rows_that_all_but_vanish_in_a_stretched_drawing_do_not_violate():
    """Two links that just reach: rounding of Phi over a row of 4e-8 m is not a violation. (It is their only pose.)"""
    m = zd.Mechanism("stretched")
    first, second = m.link("a", (0, 0), (0.6, 0.8), mass=1.0), m.link("b", (0.6, 0.8), (2, 0), mass=1.0, length=1.0)
    m.revolute("A", m.ground, first.start)
    m.revolute("B", first.end, second.start)
    m.revolute("C", second.end, m.ground.point((2, 0)))
    with pytest.raises(zd.ZerodriftError) as caught:
        zd.simulate(m, 0.1, step=1e-3)
    assert not isinstance(caught.value, zd.InconsistentStart)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_joints_that_close_elsewhere_are_not_said_to_stay_open(layout):
    """Two equal cranks at 30 degrees below the horizontal carry a bar, and a third 30 degrees above it a point 1 m over it."""
    m = zd.Mechanism("three cranks")
    cranks = [m.link(f"crank{i}", (i, 0), (i, 1), mass=1.0) for i in range(3)]
    bar = m.link("bar", (0, 1), (2, 1), mass=2.0)
    for i, (crank, side) in enumerate(zip(cranks, (bar.start, bar.point((1, 1)), bar.end), strict=True)):
        m.revolute(f"A{i}", m.ground, crank.start)
        m.revolute(f"B{i}", crank.end, side)
    with pytest.raises(zd.CorrectionFailed, match=r"^the drawing must be near a position in which all joints close"):
        m.system(layout).p0.copy()
