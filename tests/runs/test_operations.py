"""Operations without a run: `zd.assemble`, and what it holds."""

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from support import along_manifold, assert_close, numbers, refused, violated_states


def test_assembling_holds_what_is_named(system):
    """As many coordinates and rates as there are degrees of freedom, chosen so that the others follow from them."""
    for t, p, v in violated_states(system, 2):
        C = numbers(system, t, p, v).C
        free = system.nq - system.mh if system.nq == system.nv else 0
        D = along_manifold(C[:system.mh], system.nv)
        held, basis = [], np.zeros((0, D.shape[1]))
        for i in np.argsort(-np.linalg.norm(D, axis=1))[:system.nv]:
            trial = np.vstack([basis, D[i]])
            if len(held) < free and np.linalg.svd(trial)[1][-1] > 0.2:
                held, basis = [*held, i], trial
        names = [system.coordinates[i].name for i in held]
        names += [system.velocities[i].name for i in held] if system.mn == 0 else []
        q, w = zd.assemble(system, p, v, hold=names, t=t)
        assert np.array_equal(q[held], p[held])
        if system.mn == 0:
            assert_close(w[held], v[held], tol.VELOCITY, scale=1)
        e = numbers(system, t, q, w)
        assert np.abs(e.Phi).max(initial=0) <= 1e-12
        assert np.abs(e.C @ w + e.Phi_t).max(initial=0) <= tol.VELOCITY * (np.abs(e.C) @ np.abs(w)).max(initial=1)


def test_assembling_starts_from_rest(bar):
    p, v = zd.assemble(bar, bar.p0, hold="alpha1")
    assert p[0] == bar.p0[0]
    assert not v.any()


def test_assembling_changes_nothing_it_was_given(bar):
    p, v = np.array([1.2, 0.3, -1.5]), np.array([2.0, 0.0, 0.0])
    zd.assemble(bar, p, v)
    zd.project(bar, p, v)
    assert p.tolist() == [1.2, 0.3, -1.5]
    assert v.tolist() == [2.0, 0.0, 0.0]


BAR = zd.systems.four_bar()


def test_variables_are_held_as_their_names_are():
    guess, rates = [1.2, 0.3, -1.5], [2.0, 0.0, 0.0]
    named = zd.assemble(BAR, guess, rates, hold=("alpha1", "alpha1_dot"))
    given = zd.assemble(BAR, guess, rates, hold=(BAR.coordinates[0], BAR.velocities[0]))
    assert all((a == b).all() for a, b in zip(named, given, strict=True))
    assert zd.assemble(BAR, guess, hold=BAR.coordinates[0])[0][0] == 1.2
    with refused("unknown-choice", "^hold must"):
        zd.assemble(BAR, guess, hold=zd.systems.oscillator().coordinates[0])


@pytest.mark.parametrize("far", [10.0, 30.0, 1e3, 1e6, 1e9])
def test_what_is_assembled_from_far_away_is_a_start(far):
    """The tolerance holds in the scale of the result, a length of 1 m, not in that of the guess. 1e-10: what a start may have."""
    pendulum = zd.systems.pendulum()
    p, v = zd.assemble(pendulum, [far, 1.0])
    assert abs(np.hypot(*p) - 1) <= 1e-10
    assert zd.simulate(pendulum, 0.01, p, v, step=0.01).success
    held, _ = zd.assemble(pendulum, [far, 0.6], hold="y")
    assert held[1] == 0.6
    assert abs(held[0] - 0.8) <= 1e-10


def test_a_guess_beyond_all_scales_is_refused():
    with refused("correction-failed", r"the position correction left"):
        zd.assemble(zd.systems.pendulum(), [1e100, 1.0])


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_mechanism_stands_for_its_system(dimension):
    """A rod on a pin, held horizontally by nothing: 3 g / 2 l, in whichever coordinates its system has."""
    m = zd.Mechanism("pendulum", dimension=dimension, gravity=(0, -9.81, 0)[:dimension])
    link = m.link("link", (0, 0, 0)[:dimension], (2, 0, 0)[:dimension], mass=1.0)
    m.revolute("pin", m.ground, link.start, **({"axis": (0, 0, 1)} if dimension == 3 else {}))
    vdot, _ = zd.acceleration(m, m.p0, m.v0)
    assert_close(vdot, zd.acceleration(m.system(), m.p0, m.v0)[0], 0)
    assert np.abs(np.abs(vdot).max() - 0.75 * 9.81) < 1e-2      # a round bar in space is thicker than a line
    for given, plain in zip(zd.project(m, m.p0, m.v0), zd.project(m.system(), m.p0, m.v0), strict=True):
        assert_close(given, plain, 0)
