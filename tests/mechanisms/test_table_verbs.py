"""Methods of `Mechanism` that are made from the core's tables: interface, checks, documentation, and their declarations."""

import ast
import doctest
import inspect

import pytest

import zerodrift as zd
from mechanisms.stub_of_verbs import stub
from support import refused
from zerodrift.mechanisms.building.table_verbs import BY_HAND, JOINTS, TableVerbs
from zerodrift.mechanisms.elements import joints, space_joints

SIGNATURES = {      # those that scripts rely on: keyword arguments, with their defaults
    "revolute": {"axis": None, "at": None, "damping": 0.0, "cut": False, "friction_torque": None, "friction": None,
                 "radius": None},
    "prismatic": {"axis": ..., "at": None, "damping": 0.0, "cut": False, "friction_force": None, "friction": None, "guide": None},
    "weld": {"at": None, "cut": False},
    "rod": {"length": None},
    "spherical": {"at": None, "damping": 0.0, "cut": False},
    "universal": {"axes": ..., "at": None, "damping": 0.0, "cut": False},
    "cylindrical": {"axis": ..., "at": None, "cut": False},
    "screw": {"axis": ..., "pitch": ..., "at": None, "cut": False},
    "planar": {"normal": ..., "at": None, "cut": False},
    "slot": {"axis": ..., "at": None, "cut": False},
    "knife_edge": {"along": ..., "normal": None}}


def test_every_kind_of_both_tables_has_a_method():
    kinds = {*joints.JOINTS, *space_joints.JOINTS}
    assert len(kinds) > 10
    assert {*SIGNATURES} <= {*JOINTS}
    assert kinds == {*JOINTS} | {*BY_HAND}
    assert all(callable(getattr(zd.Mechanism, kind)) for kind in kinds)


@pytest.mark.parametrize("kind", SIGNATURES)
def test_its_arguments_are_those_that_scripts_rely_on(kind):
    parameters = inspect.signature(getattr(zd.Mechanism, kind)).parameters
    assert [*parameters][:4] == ["self", "name", *(["point", "along"] if kind == "knife_edge" else ["first", "second"])]
    given = {name: each.default for name, each in parameters.items() if each.kind is each.KEYWORD_ONLY}
    assert {name: ... if value is inspect.Parameter.empty else value for name, value in given.items()} == {
        **SIGNATURES[kind], "active": None}


@pytest.mark.parametrize("kind", JOINTS)
def test_its_documentation_names_its_arguments_and_its_example_runs(kind):
    method = getattr(zd.Mechanism, kind)
    doc = inspect.getdoc(method)
    assert max(map(len, doc.splitlines())) <= 120
    assert all(f"{word} : " in doc or f", {word} : " in doc or f"{word}, " in doc
               for word in inspect.signature(method).parameters if word != "self")
    examples = doctest.DocTestParser().get_doctest(doc, {}, kind, None, 0)
    assert len(examples.examples) == 4
    assert doctest.DocTestRunner().run(examples).failed == 0


def test_the_declarations_for_editors_are_those_of_the_methods():
    """That they are written anew, `test_types.py` asserts."""
    declared = next(each for each in ast.parse(stub()).body if getattr(each, "name", None) == "TableVerbs")
    assert {each.name for each in declared.body} == {name for name in vars(TableVerbs) if not name.startswith("_")}


@pytest.mark.parametrize(("call", "code", "text"), [
    (lambda m, a, b: m.revolute("A", a, b, at=(0, 0), axis=(1, 0)), "wrong-dimension", "'A'"),
    (lambda m, a, b: m.prismatic("A", a, b), "wrong-type", "axis"),
    (lambda m, a, b: m.rod("A", a, b.center), "wrong-element", "first.*'a'"),
    (lambda m, a, b: m.rod("A", a.center, b.center, at=(0, 0)), "wrong-type", "'at'"),
    (lambda m, a, b: m.weld("A", a, b, at=(0, 0), cut=1), "wrong-type", "'A'"),
    (lambda m, a, b: m.planar("A", a, b, normal=(0, 1)), "wrong-dimension", None)])
def test_refusals_in_the_plane_name_what_is_wrong(call, code, text):
    m = zd.Mechanism("refused")
    bodies = [m.body(name, 1.0, 0.1, at=(i, 0)) for i, name in enumerate("ab")]
    with refused(code, text):
        call(m, *bodies)
    assert [*m.joints] == []


@pytest.mark.parametrize(("call", "code", "text"), [
    (lambda m, a, b: m.revolute("A", a, b, at=(0, 0, 0)), "missing-argument", "'A'"),
    (lambda m, a, b: m.revolute("A", a, b, at=(0, 0, 0), axis=(0, 0, 1), damping=-1), "out-of-range", "'A'"),
    (lambda m, a, b: m.screw("A", a, b, axis=(0, 0, 1), pitch=0), "out-of-range", "'A'.*be 0"),
    (lambda m, a, b: m.universal("A", a, b, at=(0, 0, 0), axes=((1, 0, 0), (-1, 0, 0))), "geometry", "parallel"),
    (lambda m, a, b: m.rod("A", a.center, b.center, length=0), "out-of-range", "'A'.*than 0"),
    (lambda m, a, b: m.spherical("A", a, b), "missing-argument", None)])
def test_refusals_in_space_name_what_is_wrong(call, code, text):
    m = zd.Mechanism("refused", dimension=3)
    bodies = [m.body(name, 1.0, (0.1, 0.1, 0.1), at=(i, 0, 0)) for i, name in enumerate("ab")]
    with refused(code, text):
        call(m, *bodies)
    assert [*m.joints] == []
