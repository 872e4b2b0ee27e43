"""Methods made from the core's tables of force elements: arguments, effects, files, pictures, documentation."""

import doctest
import inspect

import numpy as np
import pytest
import sympy as sp

import tolerances as tol
import zerodrift as zd
from support import refused
from zerodrift.mechanisms.building.table_force_verbs import force_verb, sides, words
from zerodrift.mechanisms.building.table_verbs import FORCES
from zerodrift.mechanisms.elements.frames import about
from zerodrift.mechanisms.elements.table_forces import ELEMENTS, FORCES_OF_TABLE, SPACE_ELEMENTS, WRITTEN, made_force
from zerodrift.mechanisms.elements.table_forces import parameters as parameters_of
from zerodrift.mechanisms.elements.table_forces import paths as paths_of
from zerodrift.mechanisms.files import from_json, to_json

OF = {"w": "B1.angular_velocity", "x": "B0.position.x"}
LAW = sp.Symbol("w") * 2 - sp.Symbol("x") + 3
SPACE_LAW = 3 * sp.cos(5 * sp.Symbol("t")) + sp.Symbol("B0.position.x")
EACH = [(kind, dimension) for dimension, table in ((2, ELEMENTS), (3, SPACE_ELEMENTS)) for kind in table]


def two_bodies(dimension=2):
    """A mechanism, and points of two bodies, turned, that lie apart; they hang on a hinge and are joined by a hinge."""
    if dimension == 3:
        m = zd.Mechanism("two bodies", dimension=3, gravity=(0.1, 0.2, -9.81))
        bodies = [m.body(f"B{i}", 1.0 + i, (0.1, 0.2, 0.15), at=(i, 0.3, 0.1), rotation=about((1, 2, 3), 0.4 + i),
                         com=(0.05, 0.02, 0.1)) for i in range(2)]
        m.revolute("pin", m.ground, bodies[0], at=(0.1, 0.1, 0), axis=(0, 1, 0.2))
        m.revolute("elbow", *bodies, at=(0.6, 0.5, 0), axis=(0.3, 1, 0.2))
        return m, bodies[0].point((0.2, 0.1, 0.1)), bodies[1].point((-0.1, 0.3, 0.2))
    m = zd.Mechanism("two bodies")
    bodies = [m.body(f"B{i}", 1.0 + i, 0.1, at=(i, 0.3), angle=0.3 + i, com=(0.05, 0.02 * i)) for i in range(2)]
    m.revolute("pin", m.ground, bodies[0], at=(0.1, 0.1))
    m.revolute("elbow", *bodies, at=(0.6, 0.5))
    return m, bodies[0].point((0.2, 0.1)), bodies[1].point((-0.1, 0.3))


def force_of(kind):
    """Class of a kind whose method is made from its entries; of others one that is made for this."""
    return FORCES.get(kind) or made_force(kind)


def added(m, P, Q, kind):
    """An element by the method from its entries, on two points or the joint of their bodies; each number is another."""
    force = force_of(kind)
    entry, number = force.entries[m.dimension], iter(range(20, 40))
    given = {word: [float(next(number)) for _ in each] if len(each) > 1 else 0.4 if word == "length" else float(next(number))
             for word, each in parameters_of(entry).items()}
    given = given or ({"value": LAW, "of": OF} if m.dimension == 2 else {"value": SPACE_LAW})
    axis = {"axis": (0.6, 0.8) if m.dimension == 2 else (0.6, 0.0, 0.8)} if entry.axes == 1 else {}
    return force_verb(force)(m, "F", *(("elbow",) if sides(force) == ("joint",) else (P, Q)), **axis, **given)


def by_their_entries(monkeypatch, kind, dimension):
    """Has a kind's method, and its form in files, made from its entries, where they are handwritten."""
    if kind not in FORCES:
        force = made_force(kind)
        monkeypatch.setattr(zd.Mechanism, kind, force_verb(force))
        for written, made in ((to_json.WRITTEN, from_json.MADE), (to_json.WRITTEN_IN_SPACE, from_json.MADE_IN_SPACE)):
            monkeypatch.setitem(written, kind, to_json._table_force)
            monkeypatch.setitem(made, kind, from_json._table_force(force, dimension))


def test_every_kind_has_a_method_and_a_class():
    kinds = {*ELEMENTS, *SPACE_ELEMENTS}
    assert kinds == {*WRITTEN} | {*FORCES_OF_TABLE} == {*FORCES, "force", "torque"}
    assert all(callable(getattr(zd.Mechanism, kind)) for kind in kinds)


BY_HAND = {     # on the points P and Q
    ("force", 2): lambda m, P, Q: m.force("F", Q, along=(0.6, 0.8), value=LAW, of=OF, frame="B0"),
    ("torque", 2): lambda m, P, Q: m.torque("F", "B1", against="B0", value=LAW, of=OF),
    ("force", 3): lambda m, P, Q: m.force("F", Q, along=(0.6, 0.0, 0.8), value=SPACE_LAW, frame="B0"),
    ("torque", 3): lambda m, P, Q: m.torque("F", "B1", against="B0", axis=(0.6, 0.0, 0.8), value=SPACE_LAW)}


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize(("kind", "dimension"), BY_HAND)
def test_a_method_from_the_table_makes_what_the_handwritten_one_makes(kind, dimension, layout):
    hand, row = two_bodies(dimension), two_bodies(dimension)
    BY_HAND[kind, dimension](*hand)
    element = added(*row, kind)
    one, other = (each[0].system(layout) for each in (hand, row))
    assert {name for name in other.measures if name.startswith("F.")} <= {*one.measures}
    assert repr(element) == f"<{kind} F: B0 - B1>"
    sols = [zd.simulate(system, 0.2, step=0.01) for system in (one, other)]
    for name in (f"F.{kind}", "B0.position", "B1.position", "elbow.force"):
        np.testing.assert_allclose(sols[1][name], sols[0][name], atol=1e-10)    # rounding, grown by the motion
    assert np.abs(sols[0][f"F.{kind}"]).max() > 0.1


@pytest.mark.parametrize(("kind", "dimension"), [
    (kind, dimension) for kind, dimension in EACH if (ELEMENTS, SPACE_ELEMENTS)[dimension - 2][kind].is_spring])
def test_the_force_of_a_spring_is_the_slope_of_its_energy(kind, dimension):
    """Without damping, by differences of V along each velocity."""
    m, P, Q = two_bodies(dimension)
    element = added(m, P, Q, kind)
    system = m.system("absolute").with_parameters({f"F.{pair[1]}": 0.0 for pair in paths_of(element.row)})
    weightless = system.with_parameters({f"gravity.{axis}": 0.0 for axis in "xyz"[:dimension]})
    rng, core, h = np.random.default_rng(3), weightless._core, 1e-6
    p = core.moved(weightless.p0, 0.2 * rng.normal(size=weightless.nv))
    f = weightless.evaluate(p, np.zeros(weightless.nv)).f
    V = [[weightless.evaluate(core.moved(p, sign * h * unit)).V for sign in (1, -1)] for unit in np.eye(weightless.nv)]
    slopes = np.array([(above - below) / (2 * h) for above, below in V])
    np.testing.assert_allclose(f, -slopes, rtol=0, atol=1e-7 * np.abs(f).max() + tol.SAME)      # differences of h = 1e-6
    assert np.abs(f).max() > 0.1


@pytest.mark.parametrize(("kind", "dimension"), EACH)
def test_it_is_saved_and_read_again(kind, dimension, monkeypatch, tmp_path):
    """To the last bit, its numbers with their paths; and drawn."""
    by_their_entries(monkeypatch, kind, dimension)
    m, P, Q = two_bodies(dimension)
    added(m, P, Q, kind)
    one, other = (each.system("absolute") for each in (m, zd.load(m.save(tmp_path / "m"))))
    for name in one._measuring.tables._fields:
        assert getattr(one._measuring.tables, name) == getattr(other._measuring.tables, name), name
    assert one.parameters == other.parameters


@pytest.mark.parametrize("kind", [*dict.fromkeys(kind for kind, _ in EACH)])
def test_its_documentation_says_what_it_takes_and_its_example_runs(kind, monkeypatch):
    monkeypatch.setattr(zd.Mechanism, kind, force_verb(force_of(kind)))
    verb = getattr(zd.Mechanism, kind)
    doc = inspect.getdoc(verb)
    assert doc.startswith((ELEMENTS | SPACE_ELEMENTS)[kind].card.summary)
    assert max(map(len, doc.splitlines())) <= 120
    assert all(f"{word} : " in doc or f", {word} : " in doc or f"{word}, " in doc
               for word in inspect.signature(verb).parameters if word != "self")
    examples = doctest.DocTestParser().get_doctest(doc, {}, kind, None, 0)
    assert len(examples.examples) == 4
    assert doctest.DocTestRunner().run(examples).failed == 0


def test_a_planar_one_that_space_has_is_lifted():
    """A spring and a torsion spring: the same motion in space."""
    m, P, Q = two_bodies()
    m.spring("S", P, Q, stiffness=30.0, damping=0.2, length=0.4)
    added(m, P, Q, "torsion_spring")
    plane, space = (zd.simulate(each, 0.2, step=0.01) for each in (m, m.lifted()))
    np.testing.assert_allclose(space["S.force"], plane["S.force"], atol=1e-8)       # other coordinates: errors of the steps
    np.testing.assert_allclose(space["F.torque"], plane["F.torque"], atol=1e-8)


def test_its_numbers_can_be_changed():
    m, P, Q = two_bodies()
    m.bushing("F", P, Q, stiffness=(1, 2), damping=(3, 4), torsion=5, torsion_damping=6)
    system = m.system("absolute")
    assert system.parameters["F.stiffness.y"] == 2
    stiffer = system.with_parameters({"F.stiffness.y": 20.0})
    assert [(force.stiffness, force.damping) for force in stiffer._tables.forces] == [(1, 3), (20, 4), (5, 6)]


def test_its_arguments_are_those_that_scripts_rely_on():
    """Keyword arguments with their defaults; those of force and torque are handwritten."""
    expected = {"spring": {"stiffness": None, "damping": 0.0, "length": None, "force": None, "of": None},
                "torsion_spring": {"stiffness": None, "angle": None, "damping": 0.0, "torque": None, "of": None},
                "bushing": {"at": None, "stiffness": 0.0, "damping": 0.0, "torsion": 0.0, "torsion_damping": 0.0, "axis": None,
                            "normal": None, "force": None, "torque": None, "of": None}}
    for kind, given in expected.items():
        known = inspect.signature(getattr(zd.Mechanism, kind)).parameters.values()
        assert {each.name: ... if each.default is each.empty else each.default for each in known
                if each.kind is each.KEYWORD_ONLY} == given
    assert {word for word in words(SPACE_ELEMENTS["force"])} == {"at", "axis", "value", "of"}


def test_what_is_drawn():
    """A spring between its points with a damper beside it, and of others where they are."""
    for kind, drawn in (("spring", ["spring", "damper"]), ("bushing", ["bushing"]), ("force", ["load"]), ("torque", ["moment"]),
                        ("torsion_spring", ["spiral"])):
        m, P, Q = two_bodies()
        added(m, P, Q, kind)
        system = m.system()
        assert [shape.kind for shape in system._sketches([system.p0])[0] if shape.name == "F"] == drawn
        assert f"1 {kind.replace('_', ' ')}" in repr(m)


def test_each_refusal_names_what_is_wrong():
    m, P, Q = two_bodies()
    bob = m.particle("bob", 1.0, at=(0, 1))
    spring, bushing, force, torque = (force_verb(made_force(kind)) for kind in ("spring", "bushing", "force", "torque"))
    for call, error, text in (
            (lambda: spring(m, "F", 3.0, Q, stiffness=1), TypeError, "first must be a point"),
            (lambda: spring(m, "F", P, Q), TypeError, r"spring 'F' must have stiffness or force, not neither"),
            (lambda: spring(m, "F", P, Q, stiffness=-1), ValueError, "stiffness of 'F' must be at least 0"),
            (lambda: spring(m, "F", P, Q, stiffness=(1, 2)), ValueError, "stiffness of 'F'"),
            (lambda: spring(m, "F", P, Q, stiffness=1, length=-1), ValueError, "length of 'F' must be at least 0"),
            (lambda: bushing(m, "F", P, Q, stiffness=(1, -2)), ValueError, "stiffness.y of 'F'"),
            (lambda: bushing(m, "F", P, Q, axis=(1, 0), normal=(0, 1)), ValueError, "axis and normal of 'F' are for mechanisms"),
            (lambda: force(m, "F", P, Q, axis=(0, 0), value=1), ValueError, "axis of 'F' must be a direction"),
            (lambda: force(m, "F", bob, Q, axis=(1, 0), value=1), ValueError, "axis of 'F' needs an orientation, and 'bob'"),
            (lambda: force(m, "F", P, Q, axis=(1, 0), value="much"), TypeError, "value of force 'F'"),
            (lambda: torque(m, "F", bob, Q, value=1), ValueError, "torque 'F' needs an orientation, and 'bob'")):
        with pytest.raises(error, match=text):
            call()
    m, P, Q = two_bodies(3)
    with refused("missing-argument", "'F'"):
        torque(m, "F", P, Q, value=1)
    assert "F" not in m._elements


@pytest.mark.parametrize("dimension", [2, 3])
def test_refusals_name_what_can_be_given_instead(dimension):
    """Whole bodies, and rods, which are joints, in place of points."""
    m = zd.Mechanism("refused", dimension=dimension)
    body, origin = m.body("one", 1.0, (1.0,) * dimension if dimension == 3 else 1.0), (0.0,) * dimension
    rod = m.rod("stay", m.ground.point((1.0,) * dimension), body.point(origin))
    for given, remedy in ((body, r"one\.point\(\(0\.0, 0\.0.* one\.point\(at=\.\.\.\)"), (rod, "'stay'.*a link has points")):
        with refused("wrong-element", f"second must be a point.*{remedy}"):
            m.rod("rod", m.ground.point(origin), given)
        with refused("wrong-element", f"at must be a point.*{remedy}"):
            m.particle("mass", 1.0, at=given)


def test_an_inertia_of_no_body_names_the_likely_mistake():
    """Moments 3.33, 7.78 and 11.89, with the opposite products 2.80, 9.35 and 10.85; signs do not help a diagonal."""
    m = zd.Mechanism("inertia", dimension=3)
    with refused("inertia", r"must be that of a body: .*11\.89.*opposite signs of its products"):
        m.body("one", 25.0, [[10, 1, 2], [1, 7, 3], [2, 3, 6]])
    with refused("inertia", "must be that of a body: .*about the centre of mass"):
        m.body("two", 25.0, (1.0, 1.0, 3.0))
