"""Verbs made from rows of the core's table of elements: they do to bodies what the verbs written by hand do."""

import doctest
import inspect

import numpy as np
import pytest
import sympy as sp

import tolerances as tol
import zerodrift as zd
from zerodrift.mechanisms.building.table_force_verbs import force_verb, taken
from zerodrift.mechanisms.elements.frames import about
from zerodrift.mechanisms.elements.table_forces import ELEMENTS, FORCES_BY_ROW, WRITTEN, made_force
from zerodrift.mechanisms.files import from_json, to_json

OF = {"w": "B1.angular_velocity", "x": "B0.position.x"}
LAW = sp.Symbol("w") * 2 - sp.Symbol("x")
SPACE_LAW = 3 * sp.cos(5 * sp.Symbol("t")) + sp.Symbol("B0.position.x")


def two_bodies():
    """A mechanism, and points of two free bodies, turned, that lie apart."""
    m = zd.Mechanism("two bodies")
    bodies = [m.body(f"B{i}", 1.0 + i, 0.1, at=(i, 0.3), angle=0.3 + i, com=(0.05, 0.02 * i)) for i in range(2)]
    m.revolute("pin", m.ground, bodies[0], at=(0.1, 0.1))
    m.revolute("elbow", *bodies, at=(0.6, 0.5))
    return m, bodies[0].point((0.2, 0.1)), bodies[1].point((-0.1, 0.3))


BY_HAND = {     # on the points P and Q, and by the row's own verb
    "spring": (lambda m, P, Q: m.spring("F", P, Q, stiffness=3.0, damping=0.2, length=0.4),
               {"stiffness": 3.0, "damping": 0.2, "length": 0.4}),
    "torsion_spring": (lambda m, P, Q: m.torsion_spring("F", "elbow", stiffness=3.0, damping=0.2),
                       {"stiffness": 3.0, "damping": 0.2}),
    "bushing": (lambda m, P, Q: m.bushing("F", P, Q, stiffness=(1, 2), damping=(3, 4), torsion=5, torsion_damping=6),
                {"stiffness": (1, 2, 5), "damping": (3, 4, 6)}),
    "force": (lambda m, P, Q: m.force("F", Q, along=(0.6, 0.8), value=LAW, of=OF, frame="B0"), {"value": LAW, "of": OF}),
    "torque": (lambda m, P, Q: m.torque("F", "B1", against="B0", value=1.7), {"value": 1.7})}


def added(m, P, Q, kind):
    """An element by the verb from its row; a bushing's axis is the first body's x axis, as by the verb by hand."""
    force = made_force(kind)
    axis = P.body.pose.direction(np.array([1.0, 0.0])) if kind == "bushing" else (0.6, 0.8)
    given = BY_HAND[kind][1] if kind in BY_HAND else {"stiffness": 2.0} if force.row.is_spring else {"value": LAW, "of": OF}
    return force_verb(force)(m, "F", P, Q, **({"axis": axis} if "axis" in taken(force) else {}), **given)


def test_every_kind_has_a_verb():
    assert {*ELEMENTS} == {*WRITTEN} | {*FORCES_BY_ROW} == {*BY_HAND} | {*FORCES_BY_ROW}
    assert all(callable(getattr(zd.Mechanism, kind)) for kind in ELEMENTS)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("kind", BY_HAND)
def test_a_verb_from_the_row_makes_what_the_verb_by_hand_makes(kind, layout):
    hand, row = two_bodies(), two_bodies()
    BY_HAND[kind][0](*hand)
    element = added(*row, kind)
    one, other = (each[0].system(layout) for each in (hand, row))
    assert {name for name in other.measures if name.startswith("F.")} <= {*one.measures}
    assert repr(element) == f"<{kind} F: B0 - B1>"
    rng = np.random.default_rng(3)
    for _ in range(3):
        p, v = rng.normal(size=one.nq), rng.normal(size=one.nv)
        mine, its = (system.evaluate(p, v, 0.3) for system in (one, other))
        np.testing.assert_allclose(its.f, mine.f, rtol=0, atol=tol.SAME * max(1, np.abs(mine.f).max()))
    sols = [zd.simulate(system, 0.2, step=0.01) for system in (one, other)]
    for name in [name for name in other.measures if name.startswith("F.")]:
        np.testing.assert_allclose(sols[1][name], sols[0][name], atol=1e-10)    # rounding, grown by the motion


@pytest.mark.parametrize("kind", ELEMENTS)
def test_it_is_saved_and_read_again(kind, monkeypatch, tmp_path):
    """To the last bit, its numbers with their paths."""
    force = made_force(kind)
    monkeypatch.setattr(zd.Mechanism, kind, force_verb(force))
    monkeypatch.setitem(to_json.WRITTEN, kind, to_json._made_force)
    monkeypatch.setitem(from_json.MADE, kind, from_json._force_by_row(force))
    m, P, Q = two_bodies()
    added(m, P, Q, kind)
    one, other = (each.system("absolute") for each in (m, zd.load(m.save(tmp_path / "m"))))
    for name in one._measuring.tables._fields:
        assert getattr(one._measuring.tables, name) == getattr(other._measuring.tables, name), name
    assert one.parameters == other.parameters


@pytest.mark.parametrize("kind", ELEMENTS)
def test_its_documentation_says_what_it_takes_and_its_example_runs(kind, monkeypatch):
    monkeypatch.setattr(zd.Mechanism, kind, force_verb(made_force(kind)))
    verb = getattr(zd.Mechanism, kind)
    doc = inspect.getdoc(verb)
    assert doc.startswith(ELEMENTS[kind].card.summary)
    assert all(word in doc for word in inspect.signature(verb).parameters if word != "self")
    examples = doctest.DocTestParser().get_doctest(doc, {}, kind, None, 0)
    assert len(examples.examples) == 4
    assert doctest.DocTestRunner().run(examples).failed == 0


def test_its_numbers_can_be_changed():
    m, P, Q = two_bodies()
    added(m, P, Q, "bushing")
    system = m.system("absolute")
    assert system.parameters["F.stiffness.across"] == 2
    stiffer = system.with_parameters({"F.stiffness.across": 20.0})
    assert [force.stiffness for force in stiffer._tables.forces] == [1, 20, 5]


IN_SPACE = {        # on the points P and Q, by hand and by the entry's own method
    "spring": (lambda m, P, Q: m.spring("F", P, Q, stiffness=30.0, damping=0.2, length=0.4),
               {"stiffness": 30.0, "damping": 0.2, "length": 0.4}),
    "force": (lambda m, P, Q: m.force("F", Q, along=(0.6, 0.0, 0.8), value=SPACE_LAW, frame="B0"),
              {"axis": (0.6, 0.0, 0.8), "value": SPACE_LAW})}


def two_bodies_in_space():
    m = zd.Mechanism("two bodies", dimension=3, gravity=(0.1, 0.2, -9.81))
    bodies = [m.body(f"B{i}", 1.0 + i, (0.1, 0.2, 0.15), at=(i, 0.3, 0.1), rotation=about((1, 2, 3), 0.4 + i),
                     com=(0.05, 0.02, 0.1))
              for i in range(2)]
    m.revolute("pin", m.ground, bodies[0], at=(0.1, 0.1, 0), axis=(0, 1, 0.2))
    m.spherical("elbow", *bodies, at=(0.6, 0.5, 0))
    return m, bodies[0].point((0.2, 0.1, 0.1)), bodies[1].point((-0.1, 0.3, 0.2))


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("kind", IN_SPACE)
def test_in_space_it_does_what_the_method_by_hand_does(kind, layout, monkeypatch, tmp_path):
    """And is drawn, saved and read again."""
    force = made_force(kind)
    by_hand, given = IN_SPACE[kind]
    hand, row = two_bodies_in_space(), two_bodies_in_space()
    by_hand(*hand)
    force_verb(force)(row[0], "F", *row[1:], **given)
    one, other = (zd.simulate(each[0].system(layout), 0.3, step=0.01) for each in (hand, row))
    assert np.abs(one["F.force"]).max() > 1
    for name in ("F.force", "B0.position", "B1.position", "B1.rotation", "elbow.force"):
        np.testing.assert_allclose(other[name], one[name], atol=1e-10)      # rounding, grown by the motion
    assert [shape.name for shape in other.system._shapes(other.p[0])].count("F") == 1
    monkeypatch.setattr(zd.Mechanism, kind, force_verb(force))
    monkeypatch.setitem(to_json.WRITTEN, kind, to_json._made_force)
    monkeypatch.setitem(from_json.MADE, kind, from_json._force_by_row(force))
    again = zd.simulate(zd.load(row[0].save(tmp_path / "m")).system(layout), 0.3, step=0.01)
    np.testing.assert_array_equal(again.p, other.p)


def test_in_space_there_are_those_that_need_one_axis_at_most():
    m, P, Q = two_bodies_in_space()
    assert {kind for kind in ELEMENTS if made_force(kind).is_in_space()} >= {"spring", "force"}
    with pytest.raises(ValueError, match="bushing is there for mechanisms in the plane"):
        force_verb(made_force("bushing"))(m, "F", P, Q, axis=(1, 0, 0), stiffness=1.0)


def test_what_is_drawn():
    """A spring between its points with a damper beside it, and of others where they are."""
    for kind, drawn in (("spring", ["spring", "damper"]), ("bushing", ["bushing"]), ("force", ["load"]), ("torque", ["moment"])):
        m, P, Q = two_bodies()
        added(m, P, Q, kind)
        system = m.system()
        assert [shape.kind for shape in system._shapes(system.p0) if shape.name == "F"] == drawn
        assert "1 other force" in repr(m)


def test_each_refusal_names_what_is_wrong():
    m, P, Q = two_bodies()
    bob = m.particle("bob", 1.0, at=(0, 1))
    spring, bushing, force, torque = (force_verb(made_force(kind)) for kind in ("spring", "bushing", "force", "torque"))
    for call, error, text in (
            (lambda: spring(m, "F", P.body, Q, stiffness=1), TypeError, "first must be a point"),
            (lambda: spring(m, "F", P, Q), TypeError, r"spring\(\): missing a required .*argument: 'stiffness'"),
            (lambda: spring(m, "F", P, Q, stiffness=-1), ValueError, "stiffness of 'F' must be at least 0"),
            (lambda: spring(m, "F", P, Q, stiffness=(1, 2)), ValueError, "stiffness of 'F'"),
            (lambda: spring(m, "F", P, Q, stiffness=1, length=-1), ValueError, "length of 'F' must be at least 0"),
            (lambda: bushing(m, "F", P, Q, axis=(1, 0), stiffness=(1, -2, 3)), ValueError, "stiffness.across of 'F'"),
            (lambda: bushing(m, "F", P, Q, axis=(0, 0), stiffness=1), ValueError, "axis of 'F' must be a direction"),
            (lambda: force(m, "F", bob, Q, axis=(1, 0), value=1), ValueError, "axis of 'F' needs an orientation, and 'bob'"),
            (lambda: force(m, "F", P, Q, axis=(1, 0), value="much"), TypeError, "value of force 'F'"),
            (lambda: torque(m, "F", bob, Q, value=1), ValueError, "torque 'F' needs an orientation, and 'bob'")):
        with pytest.raises(error, match=text):
            call()
    assert "F" not in m._elements
