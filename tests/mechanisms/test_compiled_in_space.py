"""Mechanisms in space written out and compiled, against the same ones whose tables are interpreted."""

import functools
import pickle

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from covering import spread
from every_model import IN_SPACE
from mechanisms.every_element import coupled_bodies
from mechanisms.plain_space import Plain
from mechanisms.test_compiled import TERM_ROUNDING, differences
from mechanisms.test_files_of_space import everything
from support import called, refused
from zerodrift.mechanisms.elements.immutable import amend
from zerodrift.mechanisms.elements.space_joints import JOINTS
from zerodrift.mechanisms.equations import generated_code
from zerodrift.symbolics.compile import shared_library
from zerodrift.symbolics.emit import closed_form_writer

SAME = 1e-11        # of the largest value of a measure: some ten steps of other roundings, of spins of 150 rad/s


@pytest.fixture(scope="module", autouse=True)
def _quickly_compiled():
    """Compile without optimization, as the code is evaluated only a few times."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(shared_library, "library", functools.partial(shared_library.library, optimized=("-O0",)))
        yield


def all_cut():
    """All kinds of joint and force, and each joint is rows."""
    m = everything()
    for joint in m._elements.values():
        if getattr(joint, "cut", None) is False:
            amend(joint, cut=True)
    return m


def random_one(seed):
    return Plain(np.random.default_rng(seed), 4, 2, "disc").m


MADE = {"everything": everything, "everything as rows": all_cut, "random": lambda: random_one(1),
        "coupled": coupled_bodies}


def assert_same_terms(m):
    system = m.system("joint", compiled=True)
    assert system.compiled
    for term, difference in differences(m.system("joint"), system):
        assert difference < TERM_ROUNDING, term


def test_every_kind_of_joint_is_among_them():
    kinds = {joint.kind for joint in everything()._elements.values() if hasattr(joint, "frames")}
    assert kinds >= set(JOINTS)


@pytest.mark.parametrize("name", MADE)
def test_terms_are_those_of_the_tables(name):
    assert_same_terms(MADE[name]())


@pytest.mark.parametrize("name", spread(IN_SPACE, 6))
def test_terms_of_models_are_those_of_the_tables(name):
    assert_same_terms(IN_SPACE[name](**({"links": 3} if name == "chain" else {})))


def off(one, other):
    """The largest difference of any measure, of the largest value of it."""
    return max(np.abs(one[name] - other[name]).max() / max(1.0, np.abs(one[name]).max()) for name in one.system.measures)


RUN = [("spatial_slider_crank", "joint"), ("heavy_top", "absolute"), ("rolling_disc", "absolute")]


@pytest.mark.parametrize(("name", "layout"), RUN)
def test_motions_and_all_measures_are_the_same_on_the_closed_form_path(name, layout, formulation):
    """Quaternions, angles that follow them, reactions, rolling: in all formulations."""
    m = IN_SPACE[name]()
    one, other = (zd.simulate(m.system(layout, compiled=written), 0.01, step=1e-3, formulation=formulation, energy=True)
                  for written in (False, True))
    takes_none = formulation == "independent" and layout == "absolute"     # a quaternion is one coordinate more than velocities
    assert ("no closed form" in repr(other)) == takes_none
    assert off(one, other) < SAME
    for energy in ("kinetic_energy", "potential_energy", "energy_input"):
        a, b = getattr(one, energy), getattr(other, energy)
        assert np.abs(a - b).max() < SAME * max(1.0, np.abs(a).max()), energy


def driven():
    """A wheel on a hinge that is cut, whose turns its angle counts, with a spring about it and drives by expressions."""
    m = zd.Mechanism("driven", dimension=3, gravity=(0, 0, -9.81))
    wheel = m.body("wheel", 2.0, (0.1, 0.2, 0.1), com=(0.1, 0, 0))
    hinge = m.revolute("hinge", m.ground, wheel, at=(0, 0, 0), axis=(0, 1, 0), cut=True)
    m.torsion_spring("coil", hinge, stiffness=0.3)
    m.motor("engine", hinge, torque=2 * sp.cos(sp.Symbol("t")))
    return m


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_angles_count_turns_on_both_paths(layout):
    m = driven()
    one, other, general = (zd.simulate(m.system(layout, compiled=written), 4.0, step=1e-2, save_every=40, closed_form=closed_form)
                           for written, closed_form in ((False, None), (True, None), (True, False)))
    assert np.ptp(one["hinge.angle"]) > 2 * np.pi
    assert other.settings["closed_form"] is not False
    for sol in (other, general):
        assert off(one, sol) < 1e-9     # 400 steps


def test_numbers_stay_numbers_and_what_is_sent_is_the_same():
    m = driven()
    system = m.system(compiled=True)
    assert system.layout == "joint"
    changed = system.with_parameters({"wheel.mass": 3.0, "coil.stiffness": 0.5})
    assert changed._written.key == system._written.key
    for term, difference in differences(m.with_parameters({"wheel.mass": 3.0, "coil.stiffness": 0.5}), changed):
        assert difference < TERM_ROUNDING, term
    sent = pickle.loads(pickle.dumps(changed))
    one, other = (zd.simulate(each, 0.1, step=1e-2) for each in (changed, sent))
    assert one.p.tobytes() == other.p.tobytes()


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_callables_are_refused_by_the_name_of_their_element(layout):
    m = driven()
    m.torque("gust", m["wheel"], value=called(lambda t: t), axis=(0, 1, 0))
    with refused("not-portable", "'gust'"):
        m.system(layout, compiled=True)


def test_many_bodies_in_absolute_coordinates_keep_the_path_of_the_tables():
    m = IN_SPACE["chain"](links=generated_code.MAX_VELOCITIES // 6 + 1)
    one, other = (zd.simulate(m.system("absolute", compiled=written), 0.002, step=1e-3) for written in (False, True))
    assert closed_form_writer.TOO_LARGE in repr(other)
    assert one.p.tobytes() == other.p.tobytes()


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_without_a_compiler_tables_are_interpreted(monkeypatch, tmp_path, layout):
    monkeypatch.setenv("ZERODRIFT_CACHE", str(tmp_path))
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.warns(zd.NoCompilerWarning, match="the tables of driven are interpreted"):
        system = driven().system(layout, compiled=True)
    assert not system.compiled
    assert (zd.simulate(system, 0.1, step=1e-2).p == zd.simulate(driven().system(layout), 0.1, step=1e-2).p).all()
