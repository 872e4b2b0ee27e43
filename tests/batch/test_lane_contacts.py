"""Contacts of runs in vector lanes, which make those in which none closes: as `simulate` on the matrix path, up to rounding."""

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from lanes import ALONE, LANES
from native_systems import needs_compiler

pytestmark = needs_compiler
BY_PYTHON = 0


def pendulum():
    """On a bar, with walls and a floor that the lowest point reaches where its depth is less than 1."""
    x, y, vx, vy, g, depth = sp.symbols("x y vx vy g depth")
    return zd.symbolic([x, y], speeds=[vx, vy], kinetic=vx**2 + vy**2, potential=2 * g * y, constraints=[x**2 + y**2 - 1],
                       parameters={g: 9.81, depth: 2.0}, p0=[1, 0], v0=[0, 0],
                       one_sided={"wall": zd.OneSided(x + 1.5, slip=vy, friction=0.1),
                                  "floor": zd.OneSided(y + depth, restitution=0.5)})


@pytest.fixture(scope="module")
def bob():
    return pendulum()


GRAZING = np.random.default_rng(2)
DEPTHS = 1 + GRAZING.uniform(-1, 1, 60) * 10.0**GRAZING.uniform(-12, -1, 60)
SETTINGS = {"rk4": {"step": 0.02}, "dop853": {"rtol": 1e-12, "integrator": "dop853"}}


@pytest.mark.parametrize("settings", SETTINGS.values(), ids=SETTINGS)
def test_a_run_leaves_the_lanes_where_a_contact_closes(bob, settings):
    """However short the contact: depths differ from the lowest point by as little as rounding, of which a grazing impact depends
    by the inverse square root of that difference.
    """
    ens = zd.ensemble(bob, 1.0, parameters={"depth": DEPTHS}, outputs=["x", "y", "vy"], t_eval=np.linspace(0, 1, 11), **settings)
    hits = DEPTHS < 1
    assert (ens._part.paths[hits] == ALONE).all()
    assert (ens._part.paths[~hits] == LANES).any()
    for i, depth in enumerate(DEPTHS):
        sol = zd.simulate(bob.with_parameters({"depth": depth}), 1.0, t_eval=np.linspace(0, 1, 11), closed_form=False, **settings)
        assert (len(sol.phases) > 1) == hits[i]
        bound = 1e-11 + (1e-14 / np.sqrt(1 - depth) if hits[i] else 0)
        for name in ("x", "y", "vy"):
            assert np.abs(ens[name][i] - sol[name]).max() < bound


def test_a_run_has_the_multipliers_of_all_constraints(bob):
    ens = zd.ensemble(bob, 1.0, parameters={"depth": [2.0, 3.0]}, outputs=["constraint0", "floor", "wall"], step=0.01)
    sol = zd.simulate(bob, 1.0, step=0.01, closed_form=False)
    assert (ens._part.paths == LANES).all()
    assert np.abs(ens["constraint0"] - sol["constraint0"]).max() < 1e-10
    assert not ens["floor"].any()
    assert not ens["wall"].any()
    again = ens[1]
    assert (again["constraint0"] == ens["constraint0"][1]).all()
    assert len(again.phases) == 1


def test_events_are_located_beside_contacts(bob):
    depths = [0.8, 2.0, 2.5]
    ens = zd.ensemble(bob, 1.0, parameters={"depth": depths}, step=0.01, t_eval=[1.0], events=[zd.Event("y", value=-0.9)])
    assert list(ens._part.paths) == [ALONE, LANES, LANES]
    for i, depth in enumerate(depths):
        sol = zd.simulate(bob.with_parameters({"depth": depth}), 1.0, step=0.01, events=[zd.Event("y", value=-0.9)])
        assert ens.t_events[i][0] == pytest.approx(sol.t_events[0], abs=1e-12)


def test_a_run_that_begins_at_a_contact_is_made_alone(bob):
    starts = np.array([[1.0, 0.0], [0.6, 0.8], [1.0, 0.0], [0.8, 0.6]])
    ens = zd.ensemble(bob.with_parameters({"depth": 0.0}), 0.1, p0=starts, v0=np.zeros((4, 2)), step=0.01, t_eval=[0.1],
                      outputs=["floor"])
    assert list(ens._part.paths) == [ALONE, LANES, ALONE, LANES]
    assert -ens["floor"][:, 0] == pytest.approx([2 * 9.81, 0, 2 * 9.81, 0])


def test_samples_of_changes_of_phase_are_kept(bob):
    """Without times of samples their number is not known before a run with changes of phase, which Python makes."""
    ens = zd.ensemble(bob, 1.0, parameters={"depth": [0.8, 2.0]}, step=0.01, outputs=["y"])
    assert list(ens._part.paths) == [BY_PYTHON, LANES]
    sol = zd.simulate(bob.with_parameters({"depth": 0.8}), 1.0, step=0.01)
    assert len(ens["y"][0]) == len(sol.t) > 101 == len(ens["y"][1])
    assert (ens["y"][0] == sol["y"]).all()
