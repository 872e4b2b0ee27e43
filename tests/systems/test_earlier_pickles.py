"""Pickles of an earlier version load: mechanisms, systems and solutions; their classes have moved to other modules since."""

import gzip
import importlib
import pickle
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from zerodrift import earlier_names

# Of a crank and a rod with a slot, Hooke's joint and a symbolic pendulum, written by commit 7bff94b.
EARLIER = Path(__file__).with_name("earlier_pickles.gz")


@pytest.fixture(scope="module")
def earlier():
    return pickle.loads(gzip.decompress(EARLIER.read_bytes()))


def drawn():
    m = zd.Mechanism("pickled", gravity=(0, -9.81))
    crank, rod = m.link("crank", (0, 0), (0.3, 0.4), 1.0), m.link("rod", (0.3, 0.4), (1.3, 0.0), 2.0)
    m.revolute("A", m.ground, crank.start)
    m.revolute("B", crank.end, rod.start)
    m.slot("C", m.ground, rod.end, axis=(1, 0))
    m.spring("s", crank.end, m.ground.point((1, 1)), stiffness=20.0, damping=0.1)
    m.start({"A.speed": 2.0})
    return m


def pendulum():
    x, y, u, v, g = sp.symbols("x y u v g")
    return zd.symbolic([x, y], speeds=[u, v], kinetic=(u**2 + v**2) / 2, potential=g * y, constraints=[x**2 + y**2 - 1],
                       parameters={g: 9.81}, p0=[1.0, 0.0], name="pendulum")


SAME = {"joint": lambda: drawn().system("joint"), "absolute": lambda: drawn().system("absolute"),
        "space": lambda: zd.models.hookes_joint().system("joint"), "symbolic": pendulum}


@pytest.mark.parametrize("name", SAME)
def test_systems_move_as_those_made_now(earlier, name):
    ours, theirs = (zd.simulate(system, 0.1, step=0.01) for system in (SAME[name](), earlier[name]))
    np.testing.assert_allclose(theirs.p, ours.p, rtol=0, atol=1e-13)
    assert np.abs(np.diff(ours.p, axis=0)).max() > 1e-3       # something moves


def test_a_mechanism_makes_systems(earlier):
    expected = zd.simulate(drawn().system("joint"), 0.1, step=0.01)
    theirs = zd.simulate(earlier["mechanism"].system("joint"), 0.1, step=0.01)
    np.testing.assert_allclose(theirs.p, expected.p, rtol=0, atol=1e-13)


def test_a_solution_has_its_samples_and_measures(earlier):
    expected = zd.simulate(drawn().system("joint"), 0.1, step=0.01)
    np.testing.assert_allclose(earlier["solution"]["C.force"], expected["C.force"], rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize("name", earlier_names.MOVED)
def test_each_module_of_an_earlier_version_has_a_module_of_today(name):
    if name == "models.symbolic":
        pytest.importorskip("sympy")
    importlib.import_module(f"zerodrift.{earlier_names.MOVED[name]}")
    with pytest.raises(AttributeError):
        importlib.import_module(f"zerodrift.{name}").no_such_name  # noqa: B018
