"""Drawings with open joints: a run warns, unless a dimension or a coordinate of the loop is given."""

import warnings

import numpy as np
import pytest

import zerodrift as zd

HALF_OPEN = "joint 'C' of 'linkage' is drawn open by 0.5 m, and to close it the start moves"


def drawn_linkage(dimension, gap, **given):
    """A four-bar of 4 m x 1 m, with the upper end of its rocker drawn aside of the coupler's, at the same distance from D."""
    m = zd.Mechanism("linkage", dimension=dimension)
    z, about_z = (0,) * (dimension - 2), {"axis": (0, 0, 1)} if dimension == 3 else {}
    a = m.link("a", (0, 0, *z), (0, 1, *z), mass=1.0)
    b = m.link("b", (0, 1, *z), (4, 1, *z), mass=1.0, **given)
    c = m.link("c", (4 + gap, 1, *z), (4, 0, *z), mass=1.0)
    for name, first, second in (("A", m.ground, a.start), ("B", a.end, b.start), ("C", b.end, c.start)):
        m.revolute(name, first, second, **about_z)
    m.revolute("D", c.end, m.ground.point((4, 0, *z)), **about_z)
    return m


def warned(run, system, *given, **options):
    """Messages of DrawingWarnings of a run."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run(system, *given, **options)
    return [str(each.message) for each in caught if each.category is zd.DrawingWarning]


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_each_kind_of_run_warns_once_of_a_joint_that_is_drawn_open(dimension, layout):
    system = drawn_linkage(dimension, 0.5).system(layout)
    for run, given in ((zd.simulate, {"t_span": 0.01, "step": 0.01}), (zd.Run, {"step": 0.01}),
                       (zd.ManyRuns, {"runs": 3, "step": 0.01}),
                       (zd.ensemble, {"t_span": 0.01, "parameters": {"a.mass": [1.0, 2.0, 3.0]}, "step": 0.01}),
                       (zd.ensemble, {"t_span": 0.01, "start": {"A.speed": [0.1, 0.2]}, "step": 0.01})):
        said = warned(run, system, **given)
        assert len(said) == 1
        assert said[0].startswith(HALF_OPEN)
    assert not warned(zd.simulate, system, 0.01, system.p0, system.v0, step=0.01)       # a state, not the drawing


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_gap_of_a_hundredth_of_the_size_is_a_rounded_number(dimension):
    for gap, count in ((0.038, 0), (0.042, 1)):        # 4 m
        assert len(warned(zd.simulate, drawn_linkage(dimension, gap), 0.01, step=0.01)) == count


@pytest.mark.parametrize("slope", [0.0, 1.0])
@pytest.mark.parametrize("dimension", [2, 3])
def test_the_size_is_the_extent_of_all_that_is_drawn(dimension, slope):
    """Two links of 1 m in line: a hundredth is 0.02 m."""
    for gap, count in ((0.019, 0), (0.021, 1)):
        m, z = zd.Mechanism("links", dimension=dimension), (0,) * (dimension - 2)
        along = np.array([np.cos(slope), np.sin(slope), *z])
        a, b = m.link("a", 0 * along, along, mass=1.0), m.link("b", (1 + gap) * along, (2 + gap) * along, mass=1.0)
        for name, one, other in (("A", m.ground, a.start), ("B", a.end, b.start)):
            m.revolute(name, one, other, **({"axis": (0, 0, 1)} if dimension == 3 else {}))
        assert len(warned(zd.simulate, m, 0.01, step=0.01)) == count


def test_bodies_with_local_points_are_advised_to_have_a_place():
    m = zd.Mechanism("arm")
    one, other = m.body("one", 1.0, 0.1), m.body("other", 1.0, 0.1)
    m.revolute("A", m.ground, one, at=(0, 0))
    m.revolute("B", one.point((1, 0)), other.point((0, 0)))
    m.revolute("C", other.point((0, 1)), one.point((2, 0)))
    said, = warned(zd.simulate, m, 0.01, step=0.01)
    assert "joint 'C' of 'arm'" in said
    assert "give 'other' and 'one' a place by at=, as points such as body.point((x, y)) are in the frame of their body" in said


SKETCHES = {"length": lambda m: None, "held": lambda m: m.start({"A.angle": 0.01}),
            "wished": lambda m: m.start(wish={"A.angle": 0.01}),
            "place": lambda m: m.start({"b.end.position.x": 4.05}), "driven": lambda m: m.motor("drive", "A", speed=1.0)}


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("sketch", SKETCHES)
def test_a_sketch_does_not_warn(dimension, sketch):
    m = drawn_linkage(dimension, 0.3, **({"length": 4.2} if sketch == "length" else {}))
    SKETCHES[sketch](m)
    assert not warned(zd.simulate, m, 0.01, step=0.01)


@pytest.mark.parametrize("dimension", [2, 3])
def test_what_is_given_elsewhere_or_of_speeds_alone_makes_no_sketch(dimension):
    """A pendulum beside the loop has a length and a held angle; of the loop a velocity is held."""
    m = drawn_linkage(dimension, 0.3)
    z = (0,) * (dimension - 2)
    pendulum = m.link("pendulum", (0, 1, *z), (-1, 1, *z), mass=1.0, length=0.9)
    m.revolute("P", m["a"].end, pendulum.start, **({"axis": (0, 0, 1)} if dimension == 3 else {}))
    m.start({"P.angle": 0.2, "a.angular_velocity" if dimension == 2 else "A.speed": 0.1})
    assert len(warned(zd.simulate, m, 0.01, step=0.01)) == 1
    assert not warned(zd.simulate, m.with_parameters({"b.length": 4.1}), 0.01, step=0.01)


def test_lifted_and_saved_mechanisms_warn_as_they_did(tmp_path):
    for given, count in (({}, 1), ({"length": 4.2}, 0)):
        m = drawn_linkage(2, 0.3, **given)
        for i, each in enumerate((m.lifted(), zd.load(m.save(tmp_path / "plane")), zd.load(m.lifted().save(tmp_path / "space")))):
            assert len(warned(zd.simulate, each, 0.01, step=0.01)) == count, i


def test_points_of_a_joint_in_the_axes_of_another_body_are_noticed():
    """A chain whose hinges were given in the axes of the ground, by a body length at each."""
    m = zd.Mechanism("line", dimension=3, gravity=(0, -9.81, 0))
    before = m.ground
    for i in range(3):
        body = m.body(f"b{i}", 1.0, (0.01, 0.01, 0.01), at=(0, 0, i + 1.0))
        m.revolute(f"r{i}", before.point(at=(0, 0, i + 0.5)), body.point(at=(0, 0, i + 1.5)), axis=(1, 0, 0))
        before = body
    said, = warned(zd.simulate, m, 0.01, step=0.01)
    assert "is drawn open by 1 m, and to close it the start moves 'b2' by 3 m, 'b1' by 2 m" in said
