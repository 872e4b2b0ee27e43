"""Laws as functions, tables, coefficients and expressions: the same terms in all elements, in plane and space."""

import math

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from digits import in_core, slope_of
from support import assert_close
from zerodrift.mechanisms.elements.user_functions import Law
from zerodrift.mechanisms.equations.function_calls import Holonomic

FUNCTIONS = {"Max": max, "Min": min, "Abs": abs, "Piecewise": lambda *cases: next(value for value, holds in cases if holds),
             **{name: getattr(math, name) for name in ("sin", "cos", "exp", "tanh", "sqrt", "atan", "log")}}
OF_TIME = ["0.2*t**3 - 0.1*t + 0.05", "sin(3*t)*exp(-t)/5"]
OF_BOTH = ["0.3*x**3*u - 0.5*u + 0.2*x**2",
           "-u*Abs(u)*sqrt(1 + x**2) + Max(0, x - 0.1)**2",
           "Piecewise((x*u, x > 0.1), (tanh(u), True))"]
POSITIONS = ["2*x - 3*y", "y - 0.2*x**3*y + 0.1*x", "y - atan(x)*cos(x + y)"]
SPEEDS = ["2*u - 3*w", "u + 0.3*w", "u*cos(t) + 0.5*w - log(2 + t)"]
OF_X = ["0.1*x**3 - 0.2*x", "cos(x)/5"]
BOTH = {"x": "pin.angle", "u": "slide.speed"}
ANGLES = {"x": "pin.angle", "y": "slide.displacement"}
ELEMENTS = {            # texts of laws, measures, and what makes the element
    "motor": (OF_BOTH, BOTH, lambda m, at, law, of: m.motor("e", "pin", torque=law, of=of)),
    "thrust": (OF_BOTH, BOTH, lambda m, at, law, of: m.motor("e", "slide", force=law, of=of)),
    "angle": (OF_TIME, {}, lambda m, at, law, of: m.motor("e", "pin", angle=law)),
    "displacement": (OF_TIME, {}, lambda m, at, law, of: m.motor("e", "slide", displacement=law)),
    "speed": ([*OF_TIME, "x**2 - x/2", "exp(-x)*sin(t)"], {"x": "slide.displacement"},
              lambda m, at, law, of: m.motor("e", "pin", speed=law, of=of)),
    "spring": (OF_BOTH, {"x": "e.length", "u": "e.speed"}, lambda m, at, law, of: m.spring("e", *ends(m, at), force=law, of=of)),
    "torsion spring": (OF_BOTH, BOTH, lambda m, at, law, of: m.torsion_spring("e", "pin", torque=law, of=of)),
    "length": (["1 + t**2/9", "1.5 + sin(t)/9"], {}, lambda m, at, law, of: m.actuator("e", *ends(m, at), length=law)),
    "actuator": (OF_BOTH, BOTH, lambda m, at, law, of: m.actuator("e", *ends(m, at), force=law, of=of)),
    "force": (OF_BOTH, BOTH, lambda m, at, law, of: m.force("e", ends(m, at)[0], at(0.6, -0.8), value=law, of=of, frame="arm")),
    "torque": (OF_BOTH, BOTH, lambda m, at, law, of: m.torque("e", "arm", value=law, of=of, against="block", **axis(at))),
    "coupler": (POSITIONS, ANGLES, lambda m, at, law, of: m.coupler("e", law, of=of)),
    "constraint": (POSITIONS, ANGLES, lambda m, at, law, of: m.constraint("e", law, of=of)),
    "nonholonomic": (SPEEDS, {"u": "slide.speed", "w": "pin.speed"}, lambda m, at, law, of: m.nonholonomic("e", law, of=of)),
    "cam": (OF_X, {}, lambda m, at, law, of: m.cam("e", "pin", "slide", profile=law)),
    "measure": (OF_BOTH, BOTH, lambda m, at, law, of: m.measure("e", law, of=of, unit="W")),
}


def ends(m, at):
    return m["arm"].point(at(0.7, 0.1)), m["block"].point(at(0.1, -0.2))


def axis(at):
    return {"axis": (0.6, 0.0, 0.8)} if len(at(0, 0)) == 3 else {}


def forms(text, of, what):
    """A law in all its forms, by name, with the measures that each takes."""
    expression = sp.sympify(text)
    names = sorted(map(str, expression.free_symbols))
    of = {name: of[name] for name in names if name in of}
    function = eval(f"lambda {', '.join(names)}: {text}", dict(FUNCTIONS))
    yield "expression", expression, of
    yield "function", function, of
    if expression.is_polynomial() and "Abs" not in text and "Max" not in text:
        x = np.linspace(-1, 2, 7)
        if len(names) == 1:
            table = zd.table(x, function(x), argument=names[0], beyond="line")
        else:
            table = zd.table((x, x), function(*np.meshgrid(x, x, indexing="ij")), argument=tuple(names), beyond="line")
        yield "table", table, of
        yield "function of a table", eval(f"lambda {', '.join(names)}: table({', '.join(names)})", {"table": table}), of
    if what == "coupler" and expression.is_polynomial() and sp.Poly(expression).is_linear:
        yield "coefficients", {of[name]: float(expression.coeff(name)) for name in names}, None


def system(dimension, coordinates, element, law, of):
    m = zd.Mechanism("stand", dimension=dimension, gravity=(0.3, -9.81, 0.2)[:dimension])

    def at(*x):
        return (*x, 0)[:dimension]

    inertia, turn = (0.1, {}) if dimension == 2 else ((0.1, 0.2, 0.15), {"axis": (0.1, 0.2, 1)})
    arm, block = m.body("arm", 1.0, inertia, at=at(0.2, 0)), m.body("block", 2.0, inertia, at=at(2, 0.2), com=at(0.1, 0.1))
    m.revolute("pin", m.ground, arm, at=at(0.1, 0), **turn)
    m.prismatic("slide", m.ground, block, axis=at(0.6, 0.8), at=at(2, 0))
    element(m, at, law, of)
    return m.system(coordinates)


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("what", ELEMENTS)
def test_all_forms_of_a_law_have_the_same_terms(what, dimension, coordinates):
    texts, of, element = ELEMENTS[what]
    chance = np.random.default_rng(7)
    for text in texts:
        systems = {form: system(dimension, coordinates, element, law, measures) for form, law, measures in forms(text, of, what)}
        first = systems["expression"]
        for _ in range(3):
            p, v, t = first.p0 + chance.uniform(-0.3, 0.3, first.p0.size), chance.normal(size=first.v0.size), chance.uniform(0, 1)
            terms = {form: each.evaluate(p, v, t) for form, each in systems.items()}
            for form, each in terms.items() if what != "measure" else ():
                for name in ("f", "Phi", "C", "xi", "Phi_t"):
                    if (desired := getattr(terms["expression"], name)) is not None:
                        assert_close(getattr(each, name), desired, 1e-14, scale=1.0, what=f"{text} as {form}: {name}")
        if what == "measure":
            runs = {form: zd.simulate(each, 0.1, step=0.01)["e"] for form, each in systems.items()}
            for form, each in runs.items():
                assert_close(each, runs["expression"], 1e-14, scale=1.0, what=f"{text} as {form}")


@pytest.mark.parametrize("text", [*OF_TIME, *OF_BOTH, *POSITIONS, *SPEEDS, *OF_X])
def test_derivatives_of_all_forms_are_differences_in_many_digits(text):
    chance = np.random.default_rng(8)
    laws = {form: Law(form, law, of=of) for form, law, of in forms(text, {name: f"{name}.angle" for name in "xyuw"}, "")}
    for form, law in laws.items():
        own = [name for name in law.names if name != "t"]
        points = chance.uniform(-0.9, 1.9, (5, 1 + len(own)))
        found = in_core(law, Holonomic)(points[:, 0].copy(), points[:, 1:].copy())
        for point, (_, *slopes) in zip(points, found, strict=True):
            known = dict(zip(("t", *own), point, strict=True))
            for name, slope in zip((*own, "t"), slopes, strict=False):
                assert_close(slope, slope_of(laws["expression"].formula, known, name), 1e-12, scale=1.0, what=f"{text} as {form}")
