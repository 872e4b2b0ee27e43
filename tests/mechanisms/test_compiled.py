"""Mechanisms written out and compiled, against the same ones whose tables are interpreted."""

import os
import pickle
import subprocess
import sys

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from caching import cache_folder, compiler  # noqa: F401  (fixtures)
from mechanisms.every_element import hinged, machinery, vehicles
from mechanisms.every_joint_by_row import by_row
from mechanisms.known import four_bar
from mechanisms.random_mechanisms import Maker
from support import called, refused
from tolerances import EPS
from zerodrift._private.gateway.mechanisms.plane import element_kinds
from zerodrift.mechanisms.elements.joints import JOINTS

TERM_ROUNDING = 1024 * EPS  # the same sums in another order, of a chain of four bodies
MOVED = 1e-10               # after 0.1 s: rounding, multiplied by the motion and by solves of condition 1e3
LAYOUTS = "joint", "absolute"


def drawn(seed):
    """A random mechanism, whose drive is an expression."""
    return Maker(seed, law=lambda a, w: a * sp.sin(w * sp.Symbol("t"))).m


def swinging():
    """A pendulum with a spring."""
    m = zd.Mechanism("swinging", gravity=(0, -9.81))
    link = m.link("link", (0, 0), (0.6, -0.3), mass=2.5)
    pin = m.revolute("pin", m.ground, link.start, damping=0.1)
    m.torsion_spring("coil", pin, stiffness=3.0, angle=0.2)
    return m


MADE = {"machinery": machinery, "vehicles": vehicles, "hinged": hinged, "by row": by_row,
        "random 3": lambda: drawn(3), "random 7": lambda: drawn(7)}


def both(m, layout):
    return m.system(layout), m.system(layout, compiled=True)


def differences(interpreted, compiled, states=3):
    """The largest difference of each term, of its size, at random states."""
    random = np.random.default_rng(1)
    for _ in range(states):
        t, p, v = random.uniform(0, 2), random.normal(size=interpreted.nq), random.normal(size=interpreted.nv)
        one, other = interpreted.evaluate(p, v, t), compiled.evaluate(p, v, t)
        for name in one.__slots__:
            a, b = getattr(one, name), getattr(other, name)
            if a is not None:       # a term that vanishes is left out of code
                yield name, np.abs(a - (0 if b is None else b)).max(initial=0.0) / max(1.0, np.abs(a).max(initial=0.0))


def test_every_joint_and_element_is_among_them():
    made = [element for m in (machinery(), vehicles(), by_row()) for element in m._elements.values()]
    assert {*JOINTS} <= {getattr(each, "kind", None) for each in made}
    assert {kind.card.name for kind in element_kinds().values()} <= {getattr(each, "kind", None) for each in made}


@pytest.mark.each_value
@pytest.mark.pairs(name=[*MADE], layout=LAYOUTS)
def test_terms_are_those_of_the_tables(name, layout):
    interpreted, compiled = both(MADE[name](), layout)
    assert compiled.structure == interpreted.structure
    for term, difference in differences(interpreted, compiled):
        assert difference < TERM_ROUNDING, term


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("name", ["random 3", "random 7"])
def test_motions_and_all_measures_are_the_same(name, layout):
    one, other = (zd.simulate(system, 0.1, step=1e-3, save_every=50, energy=True, formulation="augmented")
                  for system in both(MADE[name](), layout))
    assert other.settings["closed_form"] == one.settings["closed_form"]
    for measure in one.system.measures:
        a, b, same = one[measure], other[measure], np.atleast_1d(one.unique(measure))
        off = np.abs(a - b).reshape(len(a), -1)[:, same]
        assert off.max(initial=0.0) < MOVED * max(1.0, np.abs(a).max()), measure
    for energy in ("kinetic_energy", "potential_energy", "energy_input"):
        a, b = getattr(one, energy), getattr(other, energy)
        assert np.abs(a - b).max() < MOVED * max(1.0, np.abs(a).max()), energy


def test_the_four_bar_takes_closed_form_functions_and_comes_to_the_same():
    system = four_bar().system(compiled=True)
    sol, slow = zd.simulate(system, 1.0, step=1e-3), zd.simulate(four_bar(), 1.0, step=1e-3)
    assert "closed form" in repr(sol)
    for measure in ("crank.angle", "C.force", "A.torque"):
        assert np.abs(sol[measure] - slow[measure]).max() < 1e-9 * max(1.0, np.abs(slow[measure]).max())
    recorded = zd.simulate(system, 1.0, step=1e-3, outputs=["C.force"])
    assert np.abs(recorded["C.force"] - slow["C.force"]).max() < 1e-9 * np.abs(slow["C.force"]).max()
    event = zd.Event("crank.angle", value=1.9)
    times = [zd.simulate(each, 2.0, step=1e-3, events=[event]).t_events for each in (system, four_bar())]
    assert np.abs(np.concatenate(times[0]) - np.concatenate(times[1])).max() < 1e-9


def test_numbers_stay_numbers_and_zeros_and_ones_are_in_the_code():
    system = swinging().system(compiled=True)
    for changes, is_same in (({"link.mass": 3.0}, True), ({"link.length": 0.9, "coil.stiffness": 2.0}, True),
                             ({"gravity.x": 0.5}, False), ({"coil.stiffness": 0.0}, False), ({"pin.damping": 1.0}, False)):
        changed, interpreted = system.with_parameters(changes), swinging().with_parameters(changes)
        assert (changed._written.key == system._written.key) == is_same, changes
        assert changed.parameters == interpreted.parameters
        for term, difference in differences(interpreted, changed):
            assert difference < TERM_ROUNDING, (changes, term)


def test_a_changed_system_keeps_its_closed_form_functions_and_so_does_one_that_was_sent():
    system = four_bar().system(compiled=True)
    changed = system.with_parameters({"coupler.mass": 4.0})
    sent = pickle.loads(pickle.dumps(changed))
    assert sent._closed_form[1].source == changed._closed_form[1].source == system._closed_form[1].source
    one, other = (zd.simulate(each, 0.5, step=1e-3) for each in (changed, sent))
    assert (one.p == other.p).all()
    assert (one.multipliers == other.multipliers).all()
    assert (one["C.force"] == other["C.force"]).all()
    assert not (one.p == zd.simulate(system, 0.5, step=1e-3).p).all()


def test_own_parameters_are_numbers_too():
    m = swinging()
    m.parameters["k"] = 2.0
    m.torque("wind", m["link"], value=sp.Symbol("k") * sp.cos(sp.Symbol("t")))
    system = m.system(compiled=True)
    for k in (2.0, 0.0):
        changed = system.with_parameters(k=k)
        assert changed._written.key == system._written.key
        for term, difference in differences(m.with_parameters(k=k), changed):
            assert difference < TERM_ROUNDING, term


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize(("add", "named"), [
    (lambda m: m.motor("drive", m["pin"], angle=called(lambda t: np.sin(t))), "angle of motor 'drive'"),
    (lambda m: m.torque("gust", m["link"], value=called(lambda t: t)), "value of torque 'gust'"),
    (lambda m: m.constraint("rope", called(lambda x: x), of={"x": "link.position.x"}), "constraint 'rope'"),
    (lambda m: m.cam("cam", m["pin"], m["link"].position.x, profile=called(lambda x: np.sin(x))), "cam 'cam'"),
])
def test_callables_are_refused_by_the_name_of_their_element(layout, add, named):
    m = swinging()
    add(m)
    with refused("not-portable", f"{named} must be a function that can be recorded"):
        m.system(layout, compiled=True)
    with refused("wrong-type", "compiled.*'yes'"):
        m.system(layout, compiled="yes")


def test_a_cam_by_an_expression_is_written_out():
    m = swinging()
    m.cam("cam", m["pin"], m.prismatic("rail", m.ground, m.body("tappet", 0.2, 0.1, at=(2, 0)), axis=(0, 1), at=(2, 0)),
          profile=0.1 * sp.sin(sp.Symbol("turn")))
    for term, difference in differences(*both(m, "joint")):
        assert difference < TERM_ROUNDING, term


def test_without_expressions_there_need_be_no_sympy(tmp_path):
    script = """
import sys
sys.modules["sympy"] = None
import numpy as np, zerodrift as zd
m = zd.Mechanism("swinging", gravity=(0, -9.81))
pin = m.revolute("pin", m.ground, m.link("link", (0, 0), (0.6, -0.3), mass=2.5).start)
slide = m.prismatic("slide", m.ground, m.body("tappet", 0.2, 0.1), axis=(0, 1), at=(0, 0))
m.cam("cam", pin, slide, profile=([0, 2, 4], [0, 0.1, 0.2]))
sol = zd.simulate(m.system(compiled=True), 0.1, step=0.01)
assert "closed form" in repr(sol) and abs(sol["link.angle"] - zd.simulate(m, 0.1, step=0.01)["link.angle"]).max() < 1e-12
"""
    subprocess.run([sys.executable, "-c", script], check=True, env=os.environ | {"ZERODRIFT_CACHE": str(tmp_path)})


def test_without_a_compiler_tables_are_interpreted(cache_folder, monkeypatch):  # noqa: F811
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.warns(zd.NoCompilerWarning, match="the tables of swinging are interpreted"):
        system = swinging().system(compiled=True)
    assert not system.compiled
    assert (zd.simulate(system, 0.1, step=1e-2).p == zd.simulate(swinging(), 0.1, step=1e-2).p).all()


def test_what_was_derived_is_kept_for_the_next_process(cache_folder, monkeypatch):  # noqa: F811
    from zerodrift.mechanisms.equations import generated_code

    monkeypatch.setattr(generated_code, "_codes", {})
    system = swinging().system(compiled=True)
    generated_code._codes.clear()
    monkeypatch.setattr(generated_code.Written, "_derive", lambda self, equations: pytest.fail("it is derived again"))
    assert swinging().system(compiled=True)._written._code == system._written._code
