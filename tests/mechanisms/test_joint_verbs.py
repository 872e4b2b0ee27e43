"""Verbs made from rows of the core's table of joints: where there is a verb written by hand as well, both make the same joint."""

import doctest
import inspect

import numpy as np
import pytest

import zerodrift as zd
from mechanisms.every_joint_by_row import AXIS, LENGTH, NORMAL, added, by_row, two_bodies
from zerodrift.mechanisms.building.table_joint_verbs import verb
from zerodrift.mechanisms.elements.joints import BY_ROW, JOINTS, made
from zerodrift.mechanisms.files import from_json

BY_HAND = {     # on the bodies, and by the points, that `added` takes
    "revolute": lambda m, first, second: m.revolute("J", first, second, damping=0.1),
    "prismatic": lambda m, first, second: m.prismatic("J", first, second, axis=AXIS, damping=0.1),
    "weld": lambda m, first, second: m.weld("J", first, second),
    "rod": lambda m, first, second: m.rod("J", first, second, length=LENGTH),
    "slot": lambda m, first, second: m.slot("J", first.body, second, axis=AXIS),
    "rolling": lambda m, first, second: m.rolling("J", first.body, second, radius=LENGTH, at=first, normal=NORMAL),
    "knife_edge": lambda m, first, second: m.knife_edge("J", second, along=AXIS)}


def by_their_rows(monkeypatch, kind):
    """Has a kind's verb, and what reads it from a file, made from its row."""
    joint = made(kind)
    monkeypatch.setattr(zd.Mechanism, kind, verb(joint))
    monkeypatch.setitem(from_json.MADE, kind, from_json._by_row(joint))
    return joint


def public(element):
    """Public names of an element, its measures among them."""
    return {name for name in dir(element) if not name.startswith("_")}


def assert_same_tables(one, other):
    for layout in ("joint", "absolute"):
        mine, its = (m.system(layout)._measuring.tables for m in (one, other))
        for name in mine._fields:
            assert getattr(mine, name) == getattr(its, name), name


def test_every_kind_has_a_class_and_a_verb():
    assert {*JOINTS} == {*BY_HAND} | {*BY_ROW}
    assert all(callable(getattr(zd.Mechanism, kind)) for kind in JOINTS)


@pytest.mark.parametrize("kind", BY_HAND)
def test_a_verb_from_the_row_makes_what_the_verb_by_hand_makes(kind):
    hand, row = two_bodies(kind), two_bodies(kind)
    joint = BY_HAND[kind](hand[0], *hand[1:])
    other = added(*row, made(kind), damping=joint.damping)
    assert_same_tables(hand[0], row[0])
    assert repr(other) == repr(joint)
    assert public(joint) - {"radius", "normal"} == public(other)
    p = hand[0].system("absolute").p0
    for one, same in zip(*(m.system("absolute")._sketches([p])[0] for m in (hand[0], row[0])), strict=True):
        assert (one.kind, one.name) == (same.kind, same.name)
        np.testing.assert_array_equal(one.points, same.points)


@pytest.mark.parametrize("kind", JOINTS)
def test_it_is_saved_and_read_again(kind, monkeypatch, tmp_path):
    """To the last bit, though the bodies are turned in the drawing."""
    joint = by_their_rows(monkeypatch, kind)
    m = two_bodies(kind)[0]
    added(*two_bodies(kind, m), joint)
    assert_same_tables(m, zd.load(m.save(tmp_path / "m")))


@pytest.mark.parametrize("kind", JOINTS)
def test_its_documentation_says_what_it_takes_and_its_example_runs(kind, monkeypatch):
    joint = by_their_rows(monkeypatch, kind)
    doc, words = inspect.getdoc(getattr(zd.Mechanism, kind)), inspect.signature(verb(joint)).parameters
    assert doc.startswith(joint.row.card.summary)
    assert max(map(len, doc.splitlines())) <= 120
    assert all(f"{word}" in doc for word in words if word != "self")
    examples = doctest.DocTestParser().get_doctest(doc, {}, kind, None, 0)
    assert len(examples.examples) == 4
    assert doctest.DocTestRunner().run(examples).failed == 0


def test_each_refusal_names_what_is_wrong():
    m, first, second = two_bodies("prismatic")
    bob = m.particle("bob", 1.0, at=(0, 1))
    slide, hinge, rod, weld = (verb(made(kind)) for kind in ("prismatic", "revolute", "rod", "weld"))
    for call, error, text in (
            (lambda: slide(m, "J", first, second), TypeError, r"prismatic\(\): missing a required .*argument: 'axis'"),
            (lambda: hinge(m, "J", first, secnd=second), TypeError, r"revolute\(\): missing a required .*argument: 'second'"),
            (lambda: slide(m, "J", first, second, axis=(0, 0)), ValueError, "axis of 'J' must be a direction"),
            (lambda: slide(m, "J", bob, second, axis=(1, 0)), ValueError, "prismatic 'J' needs an orientation, and 'bob'"),
            (lambda: weld(m, "J", bob, second), ValueError, "weld 'J' needs an orientation, and 'bob'"),
            (lambda: hinge(m, "J", bob, second, damping=1.0), ValueError, "damping of 'J' needs an orientation, and 'bob'"),
            (lambda: hinge(m, "J", first, second, damping=-1.0), ValueError, "damping of 'J' must be at least 0"),
            (lambda: hinge(m, "J", first, second, cut=1), TypeError, "cut of 'J' must be True or False"),
            (lambda: hinge(m, "J", first, second, length=1.0), TypeError, r"revolute\(\): got an unexpected keyword"),
            (lambda: rod(m, "J", first, second, length=0.0), ValueError, "length of 'J' must be greater than 0"),
            (lambda: rod(m, "J", first, second, at=(0, 0)), TypeError, r"rod\(\): got an unexpected keyword"),
            (lambda: weld(m, "J", first, second.body, at=(0, 0)), TypeError, "at= of 'J' must be given with two bodies"),
            (lambda: rod(m, "J", second, m.ground.point(at=second)), ValueError, "length of 'J', as drawn, must be greater"),
            (lambda: hinge(m, "bob", first, second), ValueError, "'bob'")):
        with pytest.raises(error, match=text):
            call()
    assert "J" not in m._elements


def test_what_is_not_given_is_as_the_row_says():
    m, first, second = two_bodies("rod")
    rod, (_, hinge_first, hinge_second) = verb(made("rod"))(m, "R", first, second), two_bodies("revolute", m)
    assert rod.numbers() == {"length": pytest.approx(LENGTH, rel=1e-15)}
    hinge = verb(made("revolute"))(m, "H", hinge_first, hinge_second)
    assert (hinge.damping, hinge.cut, hinge.numbers()) == (0.0, False, {"damping": 0.0})


def test_a_wheel_that_rolls_has_a_displacement_and_can_be_driven_along_it():
    """As its row says; the wheel turns back by the displacement over the radius, and the drive's force is inertia's, 3/2 m a."""
    m = zd.Mechanism("wheel")
    wheel = m.body("wheel", *zd.inertia.disc(mass=2.0, radius=0.5), at=(0, 0.5))
    road = m.rolling("road", m.ground, wheel, radius=0.5)
    m.motor("pull", road, displacement=lambda t: 0.3 * t**2)
    sol = zd.simulate(m, 1.0, step=0.01)
    np.testing.assert_allclose(sol[road.displacement], 0.3 * sol.t**2, atol=1e-11)      # the corrections' tolerance
    np.testing.assert_allclose(sol["wheel.angle"], -0.3 * sol.t**2 / 0.5, atol=1e-11)
    np.testing.assert_allclose(sol["pull.force"], 1.5 * 2.0 * 0.6, rtol=1e-9)


def test_all_of_them_stand_in_one_mechanism():
    assert [type(joint).kind for joint in by_row().joints] == list(JOINTS)
