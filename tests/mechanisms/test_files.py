"""Mechanisms in files: read again they are the same to the last bit, and what cannot be read or saved is named with its place."""

import json

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from support import assert_close, called, refused
from zerodrift.laws.formula import of_expression
from zerodrift.mechanisms.elements.joints import BY_ROW
from zerodrift.mechanisms.elements.table_forces import ELEMENTS, FORCES_OF_TABLE
from zerodrift.mechanisms.files.expressions_json import from_json, to_json
from zerodrift.mechanisms.files.from_json import MADE
from zerodrift.mechanisms.files.to_json import WRITTEN
from zerodrift.runs.samples.saving import Described

t, x = sp.symbols("t x")


def everything():
    """A mechanism with every kind of element, turned so that no axis is a global one, and with numbers that are not round."""
    m = zd.Mechanism("all sorts", gravity=(0.1, sp.cos(t) - 9.81), parameters={"k": 1 / 3})
    arm = m.link("arm", (0, 0), (1, 0.3), mass=1.1, length=1.05)
    bar = m.link("bar", arm.end, (1.7, -0.4), mass=0.7, inertia=0.05)
    box = m.body("box", 2.0, 0.3, at=(3, 1), angle=0.7, com=(0.05, -0.02))
    lid = m.body("lid", 0.4, 0.02, at=(3.2, 1.1), angle=0.2)
    wheel = m.body("wheel", 1.0, 0.2, at=(-2, 0.5), angle=0.3)
    sleigh = m.body("sleigh", 1.0, 0.2, at=(-4, 0), angle=0.4)
    bob, nut, bead = m.particle("bob", 0.2, at=(0, 2)), m.particle("nut", 0.1, at=arm.end), m.particle("bead", 0.3, at=(4, 2))
    corner, eye = box.point((0.2, 0.1), name="corner"), m.point("eye", wheel, at=(-2.1, 0.6))
    hinge = m.revolute("hinge", m.ground, arm.start, damping=0.01)
    elbow = m.revolute("elbow", arm.end, bar.start, cut=False)
    rail = m.prismatic("rail", m.ground, box, axis=(1, 0.3), damping=0.2)
    m.weld("glue", box, lid, at=(3.1, 1.05))
    m.rod("string", m.ground.point((0.3, 3)), bob)
    m.rod("brace", m.ground.point((2, 3)), bob, length=2.4)
    wire = m.slot("wire", m.ground, bead, axis=(1, 2))
    m.rolling("road", m.ground, wheel, radius=0.5, at=(0.2, 0.01), normal=(0.01, 1))
    m.knife_edge("blade", sleigh.point((-0.1, 0.05)), along=(1, 0.5))
    m.gear("mesh", hinge, elbow, ratio=-1 / 3)
    m.rack_pinion("teeth", hinge, rail, ratio=0.07)
    m.coupler("cage", {bead.position.x: 1.0, bob.position.x: -0.1, bead.position.y: 0.3})
    m.cam("table", hinge, wire, profile=(np.linspace(0, 6, 9), np.cos(np.linspace(0, 6, 9)) / 7))
    m.cam("formula", hinge, "bead.position.y", profile=0.1 * (1 - sp.cos(x)) ** 2)
    m.constraint("mine", x**2 - sp.Symbol("bob.position.y") + sp.Symbol("k"), of={"x": bob.position.x})
    m.nonholonomic("skate", x * sp.Rational(1, 3) - sp.Symbol("sleigh.velocity.y") * sp.cos(t), of={"x": sleigh.velocity.x})
    m.motor("turn", hinge, speed=sp.sin(t / 3) + sp.pi)
    m.motor("push", rail, force=-0.1)
    m.actuator("jack", m.ground.point((-3, 1)), sleigh.point((0.1, 0.2)), length=2 + sp.sin(t) / 7)
    m.actuator("pump", corner, bead, force=x * 3, of={"x": bead.position.x})
    m.spring("coil", corner, bead, stiffness=10.1, damping=0.3)
    m.spring("band", box.center, nut, stiffness=10.1, length=0.9)
    m.torsion_spring("clock", hinge, stiffness=0.3, angle=0.1)
    m.bushing("mount", m.ground, sleigh, at=(-4.1, 0.2), stiffness=(10, 20), damping=(0.1, 0.2), torsion=3, torsion_damping=0.1)
    m.force("wind", sleigh, along=(1, 3), value=sp.Piecewise((x, x < 1), (sp.exp(-x), True)), of={"x": sleigh.velocity.x},
            frame=sleigh)
    m.torque("air", wheel, value=0.3, against=sleigh)
    m.force("eyed", eye, along=(0, 2), value=1e-17)
    m.measure("share", lambda F, x: x * F, of={"F": "eyed.force", "x": "bob.position.x"}, unit="J")
    m.group("both", ["bob", m.bodies[0]])
    m.start({arm.angle: 0.3, "bob.velocity": (0.1, 0.2)}, wish={"sleigh.position.x": -4.2})
    return m


def there_and_back(m, tmp_path):
    return zd.load(m.save(tmp_path / "mechanism"))


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_every_number_is_the_same_to_the_last_bit(layout, tmp_path):
    """The tables are all that the core receives of a mechanism."""
    m = everything()
    mine, its = (system.system(layout)._measuring.tables for system in (m, there_and_back(m, tmp_path)))
    for name in mine._fields:
        assert getattr(mine, name) == getattr(its, name), name
    first, second = m.system(layout).parameters, there_and_back(m, tmp_path).system(layout).parameters
    assert first == second


def test_every_kind_of_element_is_there(tmp_path):
    elements = json.loads(everything().save(tmp_path / "m").read_text())["elements"]
    by_their_rows = {*BY_ROW, *(FORCES_OF_TABLE.keys() & ELEMENTS)}       # which test_joint_verbs.py and test_force_verbs.py save
    switched = {"contact", "stop", "latch"}     # saved by tests/contact
    assert {element["kind"] for element in elements} | by_their_rows | switched == set(WRITTEN) == set(MADE)


def test_laws_and_starts_are_the_same(tmp_path):
    m = everything()
    again = there_and_back(m, tmp_path)
    for name in ("turn", "skate", "wind", "mine", "formula", "table", "cage"):
        first, second = m[name].law, again[name].law
        values = 0.3 + np.arange(len(first.measures)) / 7
        assert first.measures == second.measures
        assert first.value(0.3, values, m.parameters) == second.value(0.3, values, again.parameters)
    assert again._held.keys() == m._held.keys()
    assert again._wished == m._wished
    assert np.array_equal(again._held["bob.velocity"], [0.1, 0.2])


def test_a_file_that_is_written_again_is_the_same_text(tmp_path):
    m = everything()
    first = m.save(tmp_path / "first").read_text()
    assert zd.load(tmp_path / "first.json").save(tmp_path / "second.json").read_text() == first
    assert max(map(len, first.splitlines())) < 500          # a line for an element


def crank(**law):
    m = zd.Mechanism("crank", gravity=(0, -9.81))
    link = m.link("link", (0, 0), (1, 0.1), mass=1.0)
    pin = m.revolute("pin", m.ground, link.start)
    if law:
        m.motor("drive", pin, **law)
    return m


def test_a_motion_repeats_itself_with_the_mechanism_that_was_read(tmp_path):
    m = crank(speed=sp.cos(t))
    first, second = (zd.simulate(each, 0.5, step=0.01) for each in (m, there_and_back(m, tmp_path)))
    assert np.array_equal(first.p, second.p)
    assert np.array_equal(first["pin.force"], second["pin.force"])


# ---- callables ----

LAWS = {
    "speed of motor 'drive'": lambda m, pin, law: m.motor("drive", pin, speed=law(lambda t: 0.3 * t if t < 0.2 else 0.06)),
    "value of force 'gas'": lambda m, pin, law: m.force("gas", "link.end", along=(1, 0), value=law(lambda t: np.sin(t))),
    "value of torque 'air'": lambda m, pin,
    law: m.torque("air", "link", value=law(lambda t, a: -a % 0.3 - t // 0.1), of={"a": pin.angle}),
    "coupler 'c'": lambda m, pin, law: m.coupler("c", law(lambda a, x: a - 2 * x), of={"a": pin.angle, "x": "rail.displacement"}),
    "constraint 'c'": lambda m, pin, law: m.constraint("c", law(lambda a, x: np.hypot(a, 1) - 1 - x),
                                                       of={"a": pin.angle, "x": "rail.displacement"}),
    "nonholonomic 'c'": lambda m, pin, law: m.nonholonomic("c", law(lambda a, u: a - u), of={"a": pin.speed, "u": "rail.speed"}),
    "cam 'c'": lambda m, pin, law: m.cam("c", pin, "rail", profile=law(lambda angle: np.sin(angle) / 3)),
}


def sliding():
    m = crank()
    m.prismatic("rail", m.ground, m.body("slider", 0.3, 0.1, at=(2, 0)), axis=(0, 1), at=(2, 0))
    return m


@pytest.mark.parametrize("what", LAWS)
def test_functions_are_saved_as_expressions(what, tmp_path):
    m = sliding()
    LAWS[what](m, m["pin"], lambda function: function)
    first, second = (zd.simulate(each, 0.4, step=0.01) for each in (m, there_and_back(m, tmp_path)))
    assert_close(second.p, first.p, 1e-11, scale=1.0)


@pytest.mark.parametrize("what", LAWS)
def test_calls_are_named(what, tmp_path):
    m = sliding()
    LAWS[what](m, m["pin"], called)
    with refused("not-portable", f"^{what} must be a number, .* to be saved: it has a try or with statement"):
        m.save(tmp_path / "m")
    assert not list(tmp_path.iterdir())


# ---- solutions ----


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_solution_keeps_its_mechanism(layout, tmp_path):
    """With its changed numbers; so all can be read from it, and the run repeated."""
    system = crank(speed=sp.cos(t)).system(layout).with_parameters({"link.mass": 3.0})
    sol = zd.simulate(system, 0.3, step=0.01)
    again = zd.load(sol.save(tmp_path / "motion"))
    for name in ("pin.force", "drive.torque", "link.end.position.y"):
        assert np.array_equal(again[name], sol[name])
    assert again.unique("pin.force").all()
    assert again.system.parameters["link.mass"] == 3.0
    assert np.array_equal(zd.simulate(again.system, again.t_span, **again.settings).p, sol.p)


def test_without_its_mechanism_a_solution_has_what_was_recorded_and_says_why_not_more(tmp_path):
    sol = zd.simulate(crank(speed=called(lambda t: 1.0 + 0 * t)), 0.3, step=0.01, outputs=["pin.force"])
    again = zd.load(sol.save(tmp_path / "motion"))
    assert isinstance(again.system, Described)
    assert np.array_equal(again["pin.force.y"], sol["pin.force"][:, 1])
    with refused("not-available", "'pin.torque'.*'drive'.*'pin.torque'"):
        again["pin.torque"]


def test_tables_within_functions_are_saved(tmp_path):
    data = zd.table([0, 1, 2], [0, 1, 4.0], argument="x", kind="linear", beyond="hold")
    m = crank(speed=lambda t: data(t) + np.interp(t, [0.0, 0.5, 1.0], [1.0, -1.0, 3.0]) * np.sin(t))
    path = m.save(tmp_path / "m")
    one, other = (zd.simulate(each, 1.0, step=0.01) for each in (m, zd.load(path)))
    assert np.array_equal(one.p, other.p)


# ---- expressions ----


@pytest.mark.parametrize("expression", [
    sp.Float(0.1) * t, sp.sqrt(t) / 3, sp.Piecewise((t, (t > 0) & ~(x > 1)), (sp.Abs(x), sp.Eq(t, x)), (sp.E, True)),
    sp.Max(t, 0, x) + sp.atan2(x, t), sp.Symbol("a.b.x", real=True) ** sp.Rational(-2, 7), sp.pi, sp.Integer(10) ** 30 * t,
    sp.Float(1e-300) + sp.Mod(t, 2), sp.Piecewise((x, sp.Ne(t, 1) | (t <= x)), (2, True)), sp.Heaviside(t),
    sp.Add(t, t, evaluate=False),
    sp.Float("0.123456789012345678") * t, sp.Float("0.1", 5) ** x, t ** x / (1 + sp.exp(x)), sp.tan(t) - sp.acosh(x)], ids=str)
def test_expressions_come_back(expression):
    formula = of_expression("law", expression)
    again = from_json(json.loads(json.dumps(to_json(formula, "law"))), "law")
    for at in np.random.default_rng(4).uniform(0.1, 3, (20, 3)):
        known = dict(zip(("t", "x", "a.b.x"), at.tolist(), strict=True))
        assert again.value(known) == pytest.approx(formula.value(known), rel=1e-15, nan_ok=True)


@pytest.mark.parametrize("written",
                         [["sign", "t"], ["Min", "t", 1, "x"], ["Max", "t", "x"], ["Mod", "t", 0.7], ["Heaviside", "t"],
                                     ["Heaviside", ["+", "x", -1], 0.25], ["^", ["pi"], ["/", 1, 3]], ["*", ["e"], "t"]], ids=str)
def test_operations_of_older_files_are_read(written):
    names = {"sign": "sign", "Min": "Min", "Max": "Max", "Mod": "Mod", "Heaviside": "Heaviside", "^": "Pow", "*": "Mul",
             "+": "Add"}

    def of(part):
        if isinstance(part, list):
            word, *parts = part
            return {"pi": sp.pi, "e": sp.E}[word] if not parts else sp.Rational(*parts) if word == "/" else getattr(
                sp, names[word])(*map(of, parts))
        return known[part] if isinstance(part, str) else part

    for at in (-1.5, 0.0, 0.3, 1.0, 2.0):
        known = {"t": at, "x": 1.0}
        assert from_json(written, "law").value(known) == pytest.approx(float(of(written)), rel=1e-15)


def test_laws_that_cannot_be_saved(tmp_path):
    for law, sentence in ((sp.gamma(t), "gamma"), (sp.Float("1e400") * t, "beyond the range")):
        with refused("not-portable", sentence):
            crank(speed=law).save(tmp_path / "m")


@pytest.mark.parametrize(("written", "sentence"), [
    (["system", "t"], "law has the operation 'system'"), ([], "law has the operation 'None'"),
    ([["sin"], "t"], "law has the operation"),
    ({"sin": "t"}, "which is not part of an expression"), (["+", None], "law has None"), (["+", True], "law has True"),
    (["/", 1, 0], "law has the operation '/'"), (["cases", 3], "law has the operation 'cases'"),
    (["table", 3, "t"], "law has the operation 'table' of parts"),
    (["table", {"knots": [[0, 0, 0, 0, 0]]}, "t"], "'table' of parts"),
    (["table", {"argument": "t", "knots": [[1, 0, 0, 0, 0], [0, 0, 0, 0, 0]]}, "t"], "'table' of parts"),
    (["table", {"argument": "t", "knots": [[0, 0, 0, 0, 0], [1, 0, 0, 0, 0]]}, ["<", "t", 1]], "'table' of parts"),
    (["sin", "t", "t", "t"], "law has the operation 'sin' of parts"), (["<", ["true"], 1], "law has the operation '<'"),
], ids=str)
def test_what_is_not_an_expression(written, sentence):
    with refused("unreadable-file", sentence):
        from_json(written, "law")


def test_nothing_in_a_file_is_run(tmp_path):
    """Text is the name of a symbol, whatever it says."""
    assert from_json("__import__('os').system('true')", "law").names == ["__import__('os').system('true')"]


# ---- files that are wrong ----


def changed(path, change):
    description = json.loads(path.read_text())
    change(description)
    path.write_text(json.dumps(description))
    return path


WRONG = {
    "key": (lambda d: d.update(colour=1), r"m\.json has the key 'colour', which is not known; there are zerodrift, version"),
    "no key": (lambda d: d.pop("gravity"), r"m\.json lacks the key 'gravity'"),
    "version": (lambda d: d.update(version=7), r"m\.json is a mechanism of version 7, and version 1 is known here"),
    "version with other keys": (lambda d: d.update(version=2, wheels=[]), r"m\.json is a mechanism of version 2, and version 1"),
    "version that is no number": (lambda d: d.update(version=True), r"m\.json is a mechanism of version True, and version 1 is"),
    "no version": (lambda d: d.pop("version"), r"m\.json lacks the key 'version'"),
    "dimension": (lambda d: d.update(dimension=4), r"m\.json: dimension must be 2, the plane, or 3, space, not 4"),
    "kind": (lambda d: d["elements"][1].update(kind="hinge"), r"element 1 is of kind 'hinge', which is not known; there are"),
    "element's key": (lambda d: d["elements"][0].update(colour=1),
                      r"element 0 \(link 'link'\) has the key 'colour', which is not known; there are kind, name, start"),
    "no element's key": (lambda d: d["elements"][0].pop("mass"), r"element 0 \(link 'link'\) lacks the key 'mass'"),
    "value": (lambda d: d["elements"][0].update(mass=-1.0), r"element 0 \(link 'link'\): mass of 'link' must be at least 0"),
    "kind of value": (lambda d: d["elements"][0].update(mass="much"), r"\(link 'link'\): mass of 'link' must be a real"),
    "name twice": (lambda d: d["elements"][1].update(name="link"), r"element 1 \(revolute 'link'\): name 'link' is tak"),
    "no point": (lambda d: d["elements"][1].update(second="link.tip"), r"\(revolute 'pin'\): a point names 'link.tip'"),
    "point": (lambda d: d["elements"][1].update(first=[0, 0]), r"a point must be a name, or have a body and local coordinates"),
    "no element": (lambda d: d["elements"].append(3), r"m\.json, element 3: an element must be a dict with kind"),
    "elements": (lambda d: d.update(elements={}), r"m\.json: elements must be a list"),
    "start": (lambda d: d["start"].update({"link.angles": 1.0}), r"m\.json, start: start must name a measure .*'link.angles'"),
    "law": (lambda d: d["elements"][2].update(law={"callable": 1}), r"\(motor 'drive'\): law must be a number, or"),
    "operation": (lambda d: d["elements"][2]["law"].update(expression=["exec", "t"]), r"law has the operation 'exec'"),
    "drive": (lambda d: d["elements"][2].update(drives="power"), r"\(motor 'drive'\): drives must be one of|drives .*'power'"),
}


@pytest.mark.parametrize("what", WRONG)
def test_what_is_wrong_is_named_with_its_place(what, tmp_path):
    change, sentence = WRONG[what]
    path = changed(crank(speed=sp.cos(t)).save(tmp_path / "m"), change)
    with refused("unreadable-file", sentence):
        zd.load(path)


@pytest.mark.parametrize(("old", "new", "sentence"), [
    ('"mass": 1.0', '"mass": NaN', "has NaN where a finite number is needed"),
    ('"mass": 1.0', '"mass": 1.0, "mass": 2.0', "has the key 'mass' twice"),
    ('"mechanism"', '"machine"', "must be a solution, an ensemble or a mechanism saved by zerodrift"),
    ('"mass"', "mass", "must be a solution, an ensemble or a mechanism saved by zerodrift"),
])
def test_text_that_is_wrong(old, new, sentence, tmp_path):
    path = crank().save(tmp_path / "m")
    path.write_text(path.read_text().replace(old, new, 1))
    with refused("unreadable-file", sentence):
        zd.load(path)


@pytest.mark.parametrize(("kind", "key", "value", "sentence"), [
    ("prismatic", "axis", [2.0, 0.0], "axis must have length 1"), ("rolling", "normal", [0.0, 0.0], "normal must have length 1"),
    ("coupler", "law", 1.0, "it must have law or sum"), ("slot", "first", "bob", "a point must be a point of a body")])
def test_parts_of_joints_that_are_wrong(kind, key, value, sentence, tmp_path):
    def change(description):
        next(element for element in description["elements"] if element["kind"] == kind)[key] = value

    with refused("unreadable-file", rf"\({kind} '\w+'\): {sentence}"):
        zd.load(changed(everything().save(tmp_path / "m"), change))
