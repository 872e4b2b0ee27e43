"""Errors for what space does not have or allow: they name the element and say what is allowed."""

import re

import numpy as np
import pytest

import zerodrift as zd
from support import refused
from zerodrift.mechanisms.elements.frames import about


def drawing():
    m = zd.Mechanism("m", dimension=3, gravity=(0, 0, -9.81))
    link = m.link("link", (0, 0, 0), (1, 0, 0), 1.0)
    wheel = m.body("wheel", 1.0, (0.1, 0.1, 0.2), at=(2, 0, 0))
    bead = m.particle("bead", 0.1, at=(0, 1, 0))
    return m, link, wheel, bead


@pytest.mark.parametrize(("add", "code", "message"), [
    (lambda m, *_: m.body("b", 1.0, (1, 1, 3)), "inertia", "'b'.*3"),
    (lambda m, *_: m.body("b", 1.0, [[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]), "inertia", "0, 1.*is 0.5"),
    (lambda m, *_: m.body("b", 1.0, [[1, 2, 0], [2, 1, 0], [0, 0, 2]]), "inertia", None),
    (lambda m, *_: m.body("b", 1.0, 0.3), "inertia", "'b'.*3, 3"),
    (lambda m, *_: m.body("b", 1.0, angle=0.3), "wrong-dimension", "'b'"),
    (lambda m, *_: m.body("b", 1.0, rotation=np.diag([1, 1, -1.0])), "geometry", "'b'"),
    (lambda m, *_: m.body("b", 1.0, rotation=(1, 1, 0, 0)), "geometry", r"length 1.*length 1\.41"),
    (lambda m, *_: m.body("b", 1.0, rotation=(1, 0)), "shape", "3, 3"),
    (lambda m, *_: m.body("b", 1.0, at=(1, 0)), "shape", "'b'"),
    (lambda m, *_: m.link("l", (0, 0, 0), (0, 0, 0)), "geometry", "'l'"),
    (lambda m, *_: m.link("l", (0, 0, 0), (0, 2, 0), normal=(0, 1, 0)), "geometry", "'l'"),
    (lambda m, *_: m.link("l", (0, 0, 0), (0, 2, 0), thickness=0), "out-of-range", "'l'"),
    (lambda m, link, *_: m.revolute("A", m.ground, link.start), "missing-argument", "'A'"),
    (lambda m, link, *_: m.revolute("A", m.ground, link.start, axis=(0, 0, 0)), "geometry", "'A'"),
    (lambda m, link, *_: m.revolute("A", m.ground, link.start, axis=(0, 1)), "shape", "'A'"),
    (lambda m, link, *_: m.revolute("A", m.ground, link.start, axis=(0, 1, 0), damping=-1), "out-of-range", "'A'"),
    (lambda m, link, *_: m.universal("A", m.ground, link.start, axes=((0, 0, 1), (0, 0, -1))), "geometry", "parallel"),
    (lambda m, link, *_: m.universal("A", m.ground, link.start, axes=((0, 0, 1),)), "shape", None),
    (lambda m, link, *_: m.universal("A", m.ground, link.start, axes=3), "shape", None),
    (lambda m, link, *_: m.screw("A", m.ground, link.start, axis=(0, 0, 1), pitch=0), "out-of-range", "'A'.*be 0"),
    (lambda m, *_: m.rod("A", m.ground.point((0, 1, 0)), "bead"), "out-of-range", "'A'"),
    (lambda m, *_: m.revolute("A", m.ground, "bead", axis=(0, 0, 1)), "wrong-element", "'bead'"),
    (lambda m, link, *_: m.slot("A", "bead", link.end, axis=(0, 0, 1)), "wrong-element", "'bead'"),
    (lambda m, link, *_: m.spherical("A", link, link.end), "wrong-element", "'A'.*'link'"),
    (lambda m, *_: m.rolling("A", m.ground, "wheel", at=(0, 0, -1)), "missing-argument", "'A'"),
    (lambda m, *_: m.rolling("A", m.ground, "wheel", radius=1.0), "geometry", None),
    (lambda m, *_: m.rolling("A", m.ground, "wheel", radius=1.0, axle=(0, 0, 1)), "geometry", None),
    (lambda m, *_: m.rolling("A", m.ground, "wheel", semiaxes=(1, 1, 0)), "out-of-range", "'A'"),
    (lambda m, *_: m.rolling("A", m.ground, "wheel", semiaxes=(1, 1, 1), axle=(1, 0, 0)), "conflicting-arguments", None),
    (lambda m, *_: m.rolling("A", m.ground, "bead", radius=1.0, at=(0, 0, -1)), "wrong-element", "'bead'"),
    (lambda m, *_: m.knife_edge("A", "wheel", along=(0, 0, 1)), "geometry", "'A'"),
    (lambda m, *_: m.bushing("A", m.ground, "wheel", at=(0, 0, 0), stiffness=(1, 2)), "shape", "'A'"),
    (lambda m, *_: m.bushing("A", m.ground, "wheel", at=(0, 0, 0), torsion=(1, -2, 0)), "out-of-range", "torsion.y.*'A'"),
    (lambda m, *_: m.bushing("A", m.ground, "wheel", at=(0, 0, 0), axis=(0, 0, 0)), "geometry", "'A'"),
    (lambda m, *_: m.bushing("A", m.ground, "wheel", at=(0, 0, 0), normal=(0, 0, 1)), "missing-argument", "'A'"),
    (lambda m, *_: m.bushing("A", m.ground, "wheel", at=(0, 0, 0), axis=(0, 0, 1), normal=(0, 0, 2)), "geometry",
     "'A'"),
    (lambda m, *_: m.torsion_spring("A", "x", stiffness=1.0), "wrong-name", "'A'.*'x'"),
    (lambda m, *_: m.torque("A", "wheel", value=1.0), "missing-argument", "'A'"),
    (lambda m, *_: m.torque("A", "wheel", value=1.0, axis=(1, 0, 0), against="link", frame="link"),
     "conflicting-arguments", None),
    (lambda m, link, *_: link.angle, "wrong-attribute", "'link'"),
    (lambda m, link, *_: link.rotation.euler("zzx"), "unknown-choice", "order"),
    (lambda m, *_: m.start({"link.angle": 1.0}), "wrong-name", "'link'.*link.angular_velocity"),
    (lambda m, *_: m.start({"link.angular_velocity": (1.0, 2.0)}), "shape", "angular_velocity"),
])
def test_what_there_is_not(add, code, message):
    m, *rest = drawing()
    with refused(code, message):
        add(m, *rest)


@pytest.mark.parametrize(("add", "message"), [
    (lambda m, link: m.spherical("A", m.ground, link.start), "spherical is a joint of space"),
    (lambda m, link: m.universal("A", m.ground, link.start, axes=((1, 0), (0, 1))), "universal is a joint of space"),
    (lambda m, link: m.cylindrical("A", m.ground, link.start, axis=(1, 0)), "cylindrical is a joint of space"),
    (lambda m, link: m.screw("A", m.ground, link.start, axis=(1, 0), pitch=1), "screw is a joint of space"),
    (lambda m, link: m.planar("A", m.ground, link.start, normal=(1, 0)), "planar is a joint of space"),
    (lambda m, link: m.revolute("A", m.ground, link.start, axis=(1, 0)), "axis of 'A' is for mechanisms in space"),
    (lambda m, link: m.body("b", 1.0, rotation=np.eye(3)), "rotation of 'b' is for mechanisms in space"),
    (lambda m, link: m.link("l", (0, 0), (1, 0), thickness=0.1), "thickness and normal of 'l' are for mechanisms in space"),
    (lambda m, link: m.rolling("r", m.ground, link, radius=1, axle=(1, 0)), "axle and semiaxes of 'r' are for mechanisms"),
    (lambda m, link: m.knife_edge("k", link, along=(1, 0), normal=(0, 1)), "normal of 'k' is for mechanisms in space"),
    (lambda m, link: m.bushing("b", m.ground, link, at=(0, 0), axis=(1, 0)), "axis of 'b' is for mechanisms"),
    (lambda m, link: m.torque("t", link, value=1.0, axis=(1, 0)), "axis and frame of 't' are for mechanisms in space"),
])
def test_what_there_is_in_space_alone(add, message):
    m = zd.Mechanism("m")
    link = m.link("link", (0, 0), (1, 0), 1.0)
    with refused("wrong-dimension", message):
        add(m, link)


@pytest.mark.parametrize("dimension", [1, 4, True, "3", None])
def test_a_dimension_that_there_is_not(dimension):
    with refused("wrong-dimension", "dimension.*be 2.*or 3"):
        zd.Mechanism("m", dimension=dimension)


def joined(axis=(0, 0, 1)):
    m, link, wheel, _ = drawing()
    m.revolute("A", m.ground, link.start, axis=axis)
    m.cylindrical("B", m.ground, wheel, axis=(0, 0, 1))
    return m


def test_motors_say_which_coordinate():
    m = joined()
    with refused("missing-argument", "'drive'.*'B'"):
        m.motor("drive", "B", speed=1.0)
    m.motor("turn", "B", angle=lambda t: t)
    m.motor("push", "B", displacement=lambda t: t**2)
    with refused("prescribed-twice", "'B'"):
        m.motor("again", "B", angle=1.0)
    m.spherical("C", "link", "bead")
    with refused("wrong-element"):
        m.motor("ball", "C", speed=1.0)


def test_a_loop_that_does_not_close_says_where():
    m = zd.Mechanism("open", dimension=3)
    one, two = m.link("one", (0, 0, 0), (1, 0, 0), 1.0), m.link("two", (1, 0, 0), (2, 0, 0), 1.0, length=0.4)
    m.spherical("A", m.ground, one.start)
    m.spherical("B", one.end, two.start)
    m.spherical("C", two.end, m.ground.point((3, 0, 0)))
    with pytest.raises(zd.CorrectionFailed, match=r"cannot all close: nearest to it there stay open '[ABC]' by 0\.\d+, "):
        zd.simulate(m, 1.0, step=0.1)


def test_a_drawing_may_be_rough():
    """Lengths count: the loop is closed from a sketch that is some centimetres off."""
    R = about((1, 1, 0), 0.4)
    m = zd.Mechanism("sketch", dimension=3)
    crank = m.link("crank", R @ (0, 0, 0), R @ (0, 0.3, 0), 1.0)
    rod = m.link("rod", R @ (0.02, 0.33, 0.05), R @ (0.9, 0.1, 0.3), 1.0, length=1.0)
    slider = m.body("slider", 1.0, (0.1, 0.1, 0.1), at=R @ (0.9, 0, 0.3))
    m.revolute("A", m.ground, crank.start, axis=R @ (0, 0, 1))
    m.spherical("B", crank.end, rod.start)
    m.universal("C", rod.end, slider.point((0, 0, 0)), axes=(R @ (0, 0, 1), R @ (0, 1, 0)))
    m.prismatic("D", m.ground, slider, axis=R @ (1, 0, 0))
    m.start({"A.angle": 0.2})
    system = m.system()
    assert np.abs(system.evaluate().Phi).max() < 1e-12
    sol = zd.simulate(system, 0.1, step=0.01)
    assert abs(sol["A.angle"][0] - 0.2) < 1e-12
    assert "freedom 1 (Gruebler 1)" in str(m)


def test_a_body_without_inertia_is_named():
    m = zd.Mechanism("m", dimension=3)
    m.body("light", 1.0)
    with pytest.raises(zd.SingularSystem, match="'light' can move without moving any mass"):
        zd.simulate(m, 1.0, step=0.1)


def test_what_is_traced_in_the_plane_alone():
    m = joined()
    with refused("wrong-dimension", "'m'"):
        zd.trace(m, "A.angle")
    with refused("wrong-dimension", "transmission_angle"):
        zd.transmission_angle(m, "A")


def test_names_that_matrices_do_not_have():
    sol = zd.simulate(joined(), 0.01, step=0.01)
    assert sol["link.rotation"].shape == (2, 3, 3)
    for name in ("link.rotation.x", "link.quaternion.x", "link.euler", "link.euler.zz", "bead.rotation", "link.angle"):
        with refused("wrong-name"):
            sol[name]


def test_start_and_motor_in_each_others_way():
    m = joined()
    m.motor("drive", "A", angle=lambda t: t)
    with refused("prescribed-twice", r"'A\.speed'.*'drive'"):
        m.start({"A.speed": 1.0})


def test_a_disc_that_falls_flat():
    tilt = about((1, 0, 0), 0.5)
    m = zd.Mechanism("coin", dimension=3, gravity=(0, 0, -9.81))
    coin = m.body("coin", 1.0, (0.0125, 0.025, 0.0125), at=(0, 0, 0.1 * np.cos(0.5)), rotation=tilt)
    m.rolling("floor", m.ground, coin, radius=0.1, axle=tilt @ (0, 1, 0))
    with pytest.raises(zd.ZerodriftError, match=r"disc 'coin' of 'floor' falls flat: its axle is .* degrees off"):
        zd.simulate(m, 2.0, step=1e-3)


def hinged(bent):
    """A four-bar whose second and third axes are bent by so many rad."""
    m = zd.Mechanism("four-bar", dimension=3, gravity=(0, -9.81, 0))
    places = (0, 0, 0), (0, 0.3, 0), (0.95, 0.6, 0), (1, 0, 0)
    links = [m.link(f"link{i}", places[i], places[i + 1], 1.0) for i in range(3)]
    ends = [m.ground.point(places[0]), *(end for link in links for end in (link.start, link.end)), m.ground.point(places[3])]
    for i, (name, bend) in enumerate(zip("ABCD", (0, bent, -2 * bent, 0), strict=True)):
        m.revolute(name, ends[2 * i], ends[2 * i + 1], axis=about((1, 0, 0), bend) @ (0, 0, 1))
    return m


def test_hinges_whose_axes_are_skew_are_named():
    """No assembly moves: which of them, and by how much; it stays where it is. Where all are parallel it runs."""
    with pytest.warns(zd.LockedWarning, match=r"no body any motion.* 'B' 11\.5 degrees off, 'C' 22\.9 degrees off that of 'A'"):
        sol = zd.simulate(hinged(0.2), 0.1, step=0.01)
    np.testing.assert_allclose(sol.p[-1], sol.p[0], atol=1e-15)
    m = hinged(0.2)
    m.start({"A.speed": 1.0})
    with pytest.raises(zd.InconsistentStart, match=r"'A\.speed' asks for a velocity that the joints 'A', 'B', 'C', 'D' do"):
        zd.simulate(m, 0.1, step=0.01)
    assert zd.simulate(hinged(0.0), 0.02, step=0.01).success


def test_shafts_at_a_right_angle():
    """Hooke's joint hands no turning on past its singularity."""
    m = zd.Mechanism("Hooke", dimension=3)
    one, other = m.link("one", (-1, 0, 0), (0, 0, 0), 1.0), m.link("other", (0, 0, 0), (0, 1, 0), 1.0)
    m.revolute("in", m.ground, one.start, axis=(1, 0, 0))
    m.cylindrical("out", m.ground, other.end, axis=(0, 1, 0))
    m.universal("cross", one.end, other.start, axes=((0, 0, 1), (-1, 0, 0)))
    m.motor("drive", "in", speed=3.0)
    with pytest.raises(zd.ZerodriftError, match=r"universal joint 'cross' about the axes of 'in' and 'out' are 90 degrees apart"):
        zd.simulate(m, 2.0, step=2e-3)


def test_a_singular_pose_has_a_way_out():
    """A parallelogram in line: told apart from redundant rows, refused with what helps, and it runs from beside."""
    m = zd.Mechanism("parallelogram", dimension=3)
    places = (0, 0, 0), (1, 0, 0), (3, 0, 0), (2, 0, 0)
    links = [m.link(f"link{i}", places[i], places[i + 1], 1.0) for i in range(3)]
    ends = [m.ground.point(places[0]), *(end for link in links for end in (link.start, link.end)), m.ground.point(places[3])]
    for i, name in enumerate("ABCD"):
        m.revolute(name, ends[2 * i], ends[2 * i + 1], axis=(0, 0, 1))
    said = str(m)
    assert "3 of 20 constraints are redundant" in said
    assert "a singular pose: " in said
    with pytest.raises(zd.Bifurcation, match=r"zd\.assemble\(m, nudge=True\) starts beside it"):
        zd.simulate(m, 0.1, step=0.01)
    p, v = zd.assemble(m, nudge=True)
    sol = zd.simulate(m.system(), 0.1, p, v, step=0.01)
    assert sol.success
    assert np.abs(sol.position_violation).max() < 1e-11


# ---- universal joints whose shafts are at a right angle ----


def shafts(bend, turned=0.0):
    """Two shafts, one along x and one at an angle of so many degrees to it; the arm on the first has turned so far from z."""
    bend, turned = np.radians((bend, turned))
    out = np.array([np.round(np.cos(bend), 15), np.sin(bend), 0])
    arm = np.array([0, -np.sin(turned), np.round(np.cos(turned), 15)])
    across = np.cross(out, arm)
    m = zd.Mechanism("shafts", dimension=3)
    one, other = m.link("one", (-1, 0, 0), (0, 0, 0), 1.0), m.link("other", (0, 0, 0), out, 1.0)
    m.revolute("in", m.ground, one.start, axis=(1, 0, 0))
    m.cylindrical("out", m.ground, other.end, axis=out)
    m.universal("cross", one.end, other.start, axes=(arm, across if across.any() else (1, 0, 0)))
    return m


FLAT = "as the cross of universal joint 'cross' lies in the plane of its shafts, the axes of 'in' and 'out'"


def test_a_flat_cross_is_distinguished_from_redundancy():
    """Rows that follow anywhere are redundant; the one that follows where both arms lie along the shafts is a singular pose."""
    said = str(shafts(90, turned=90))
    assert "freedom 1 (" in said
    assert "2 of 13 constraints are redundant" in said
    assert re.search(rf"pose: [^;]+ (is|are) redundant as drawn, and not nearby, {FLAT}; zd\.assemble\(m, nudge=", said)
    for bend, turned in ((90, 0), (90, 80), (60, 90), (89.9, 90)):
        said = str(shafts(bend, turned))
        assert "2 of 13 constraints are redundant" in said
        assert "a singular pose" not in said
        assert ("are 90 degrees apart: at a right angle it hands no turning on" in said) == (bend == 90)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize(("moves", "stays"), [("in.speed", "out"), ("out.angle_speed", "in")])
def test_assemble_leads_out_of_a_flat_cross_on_either_branch(layout, moves, stays):
    """With angles a, b of the shafts cos(a) sin(b) = 0, from a right angle on: that turns which is to, the other is stuck."""
    m = shafts(90, turned=90)
    m.start({moves: 2.0})
    system = m.system(layout)
    with pytest.raises(zd.Bifurcation, match=rf"{FLAT}: zd\.assemble\(m, nudge=True\) starts beside it"):
        zd.simulate(system, 0.1, step=0.01)
    p, v = zd.assemble(system, nudge=0.1)
    sol = zd.simulate(system, 0.5, p, v, step=0.01)
    np.testing.assert_allclose(sol[f"{moves.split('.')[0]}.angle"], 0.1 + 2.0 * sol.t, rtol=1e-9)
    assert np.abs(sol[f"{stays}.angle"]).max() < 1e-9


def test_a_driven_flat_cross_starts_where_the_start_has_it():
    """A drive holds its pose at t = 0, so that no nudge leads out: none is offered."""
    m = shafts(90, turned=90)
    m.motor("drive", "in", speed=1.0)
    assert f"{FLAT}; start a little aside, or drive another joint" in str(m)
    with pytest.raises(zd.Bifurcation, match=f"{FLAT}: start a little aside, or drive another joint"):
        zd.simulate(m, 0.1, step=0.01)
    m.start({"in.angle": 0.1})
    np.testing.assert_allclose(zd.simulate(m, 0.5, step=0.01)["in.angle"][-1], 0.6, rtol=1e-9)


def test_how_far_a_nudge_goes():
    m = shafts(90, turned=90)
    m.start({"in.speed": 1.0})
    for nudge, far in ((True, 1e-3), (np.True_, 1e-3), (0.25, 0.25), (False, 0.0)):
        assert abs(zd.assemble(m, nudge=nudge)[0][0] - far) < 1e-12
    with refused("out-of-range", "nudge.*than 0, not -1"):
        zd.assemble(m, nudge=-1)


def test_angles_that_shafts_do_not_let_a_cross_have():
    """They tilt it by 30 degrees either way, as drawn about its first arm; what is left over is in rad."""
    kept = "the shafts of universal joint 'cross' stay 30 degrees apart in 'in' and 'out', which limits its angles"
    for angle, value, left in (("angle1", -1.3, f"{1.3 - np.pi / 3:.3g} rad"),
                               ("angle2", 7, f"{7 - np.pi / 6:.3g} rad. Angles are in rad: 7 degrees are 0.1222")):
        m = shafts(30)
        m.start({f"cross.{angle}": value})
        with pytest.raises(zd.InconsistentStart, match=rf"'cross\.{angle}' by {left}; {kept}"):
            m.system().start_at(0.0)
    m = shafts(30)
    m.start({"cross.angle1": -0.1})     # from where no step changes it, as it is as large as can be
    sol = zd.simulate(m, 0.01, step=0.01)
    np.testing.assert_allclose(np.tan(sol["in.angle"]) * np.cos(np.pi / 6), np.tan(sol["out.angle"]), rtol=1e-9)
    assert abs(sol["cross.angle1"][0] + 0.1) < 1e-9
